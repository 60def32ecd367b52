#!/bin/sh
# setup.sh: missing packages are named before installation, with their purpose and size; if they cannot be installed, the
# command is printed. The machine has made-up commands: nothing is installed.
. "$(dirname "$0")/../checks.sh"

bin=$scratch/bin
said=$scratch/said
log=$scratch/log # the packages that apt-get was asked for

# machine ROOT LISTS NETWORK: makes a fresh machine with the commands of every Debian. ROOT is yes or no; LISTS: are
# there package lists?
machine() {
    rm -rf "$bin" "$log" "$scratch/lists"
    mkdir "$bin"
    : >"$log"
    for tool in sh env cat cut grep mktemp rm sed tail chmod cp; do
        ln -s "$(command -v $tool)" "$bin/$tool"
    done
    [ "$2" = no ] || : >"$scratch/lists"
    printf '#!/bin/sh\necho %s\n' "$([ "$1" = yes ] && echo 0 || echo 1000)" >"$bin/id"
    cat >"$bin/apt-get" <<END
#!/bin/sh
echo "\$*" >>"$log"
case " \$* " in
*" update "*)
    [ $3 = yes ] || { echo "Err: Temporary failure resolving" >&2; exit 100; }
    : >"$scratch/lists" ;;
*" --print-uris "*)
    [ -e "$scratch/lists" ] || { echo "E: Unable to locate package" >&2; exit 100; }
    echo "Need to get 12.3 MB of archives."
    echo "After this operation, 45.6 MB of additional disk space will be used." ;;
*)
    cp "$said" "$scratch/before"
    [ $3 = yes ] || { echo "E: Failed to fetch" >&2; exit 100; }
    for tool in gcc ar gnuplot arm-none-eabi-gcc qemu-system-arm; do
        # this compiler finds no library
        printf '#!/bin/sh\necho /dev/null\n' >"$bin/\$tool"
        chmod +x "$bin/\$tool"
    done ;;
esac
END
    chmod +x "$bin/id" "$bin/apt-get"
}

# deps GROUP...: returns its exit status; its output is in $said
deps() {
    PATH=$bin /bin/sh mk/setup/deps.sh "$@" >"$said" 2>&1 </dev/null
}

line='apt-get install --no-install-recommends -y gcc binutils gnuplot-nox gcc-arm-none-eabi'

machine yes yes yes
deps host plot firmware
verdict $? "a fresh machine: installed" "$said"
for words in 'gcc  *whirl  *the C compiler' 'gnuplot-nox  *plots  *plots' 'gcc-arm-none-eabi  *boards  *the compiler' \
    'qemu-system-arm  *boards  *the emulated boards' 'To be fetched: 12.3 MB' 'On disk: 45.6 MB' "^Installing them: $line"; do
    grep -q "$words" "$scratch/before"
    verdict $? "told before: $words" "$said"
done
! grep -q update "$log"
verdict $? "the package lists were there" "$log"
: >"$log"
deps host plot firmware && [ ! -s "$said" ] && [ ! -s "$log" ]
verdict $? "the second time there is nothing to say or do" "$said"

machine yes no yes
deps host plot firmware && grep -q 'Updating the package lists' "$said" && grep -q 'On disk: 45.6 MB' "$scratch/before"
verdict $? "package lists are fetched to know the size" "$said"

machine yes no no
! deps host plot firmware && grep -q 'Installing did not work.*try again' "$said" && grep -q "^    $line" "$said"
verdict $? "no network: the line to run, and failure" "$said"

machine no yes yes
! deps host plot firmware && grep -q "root's rights" "$said" && grep -q "^    $line" "$said" && grep -q 'On disk' "$said"
verdict $? "no root: the size, the line to run, and failure" "$said"
! grep -v -e --print-uris "$log" | grep -q .
verdict $? "and nothing was tried" "$log"

machine yes yes yes
rm "$bin/apt-get"
! deps host plot firmware && grep -q 'no Debian' "$said" && grep -q "^    $line" "$said"
verdict $? "no Debian: the packages' names, and failure" "$said"

machine yes yes yes
printf '#!/bin/sh\necho "$*" >>"%s"\n' "$log" >"$bin/apt-get" # installs nothing
! deps host && grep -q 'Still missing after installing' "$said"
verdict $? "what is still missing after installing is told" "$said"

machine yes yes yes
! DEPS_DRY_RUN=1 deps host plot && grep -q 'gnuplot-nox' "$said" && [ ! -s "$log" ]
verdict $? "a dry run says it and does nothing" "$said"

# every target of the Makefile that needs a package asks for it first
for target in run test check bench size figures emulate hashes; do
    env -u MAKELEVEL -u MFLAGS MAKEFLAGS= make -n "$target" 2>/dev/null | head -n 1 | grep -q 'mk/setup/deps.sh'
    verdict $? "make $target looks first at what is there" /dev/null
done
# --- long targets print their stages -------------------------------------------------------------------------------------
for goal in rig-now run-now; do
    env -u MAKEFLAGS -u MAKELEVEL make -n $goal 2>&1 | grep -o 'echo "[0-9] of [0-9]: .*' >"$said"
    [ "$(cut -c7 "$said" | tr -d '\n')" = 12 ] && ! grep -v ' of 2: ' "$said"
    verdict $? "make ${goal%-now} tells its stages" "$said"
done
exit $failed
