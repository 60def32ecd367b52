#!/bin/sh
# doc_examples.sh: every ```whirl block of the documents is a complete file that derives. The C programs of pages end by
# themselves, whatever flags they are built with. (gate-docs runs the commands of all pages.)
. "$(dirname "$0")/../checks.sh"

count=0

for document in README.md docs/*.md docs/dev/*.md; do
    [ -f "$document" ] || continue
    awk -v stem="$scratch/$(echo "$document" | tr / _)" '
        /^```whirl/ { file = stem "-" NR ".whirl"; next }
        /^```/ { file = "" }
        file != "" { print > file }' "$document"
done

for example in "$scratch"/*.whirl; do
    [ -f "$example" ] || continue
    count=$((count + 1))
    name=$(basename "$example" .whirl) # the document and the line
    "$whirl" derive "$example" >/dev/null 2>"$scratch/err"
    verdict $? "$name"
done

# --- a reader works in one folder, so no page's `whirl new` may write a file that README tells the reader to save
for page in docs/*.md docs/howto/*.md; do
    for name in $(sed -n 's/^[$] build\/whirl new //p' "$page"); do
        ! grep -q "^\`\`\`whirl $name[.]whirl$" README.md
        verdict $? "$page: whirl new $name after README" /dev/null
    done
done

# --- the programs of pages: blocks with a file name, and the commands that derive and compile them. They end by themselves
# with status 0 or 1, also if the start is refused: here an object file makes the processor flush small numbers, as linking
# with -ffast-math does. WHIRL_FULL: twelve sets of flags.
mkdir "$scratch/bin"
real=$(command -v gcc)
cat >"$scratch/bin/cc" <<END
#!/bin/sh
exec $real "\$@" \$SET
END
chmod +x "$scratch/bin/cc"
flushing=$(gcc -print-file-name=crtfastmath.o)
[ "$flushing" != crtfastmath.o ] || flushing=-O1 # this processor has no such file
echo "$flushing" >"$scratch/sets"
[ -z "${WHIRL_FULL:-}" ] || printf '%s\n' -O0 -O3 -Os "-std=gnu11 -Og" -DWH_DOUBLE=1 -ffast-math -Ofast -funsafe-math-optimizations \
    -ffinite-math-only -mfpmath=387 -fsingle-precision-constant >>"$scratch/sets"
for page in docs/tutorial.md docs/howto/firmware.md docs/howto/observer.md; do
    into=$scratch/$(echo "$page" | tr / _)
    mkdir -p "$into/build"
    ln -s "$PWD/core" "$into/core"
    case $whirl in /*) ln -s "$whirl" "$into/build/whirl" ;; *) ln -s "$PWD/$whirl" "$into/build/whirl" ;; esac
    awk -v into="$into/" '
        /^```(c|whirl) [a-z]+[.][a-z]+$/ { file = into $2; next }
        /^```/ { file = "" }
        file != "" { print > file; next }
        sub(/^[$] /, "") && /^(build\/whirl (new|derive .*--header) |cc |[.]\/[a-z]+$)/ { print > (into "commands") }' "$page"
    while read -r SET; do
        export SET
        ended=0
        while read -r command; do
            case $command in build/whirl*) [ ! -e "$into/derived" ] || continue ;; esac
            (cd "$into" && PATH=$scratch/bin:$PATH sh -c "$command" </dev/null) >"$scratch/out" 2>"$scratch/err"
            status=$?
            [ $status -le 1 ] || ended=$status
        done <"$into/commands"
        : >"$into/derived" # `whirl new` writes over no file
        [ "$ended" -eq 0 ] && [ -s "$into/commands" ]
        verdict $? "$page: its program ends by itself, built with $SET (status $ended)"
    done <"$scratch/sets"
done

for flag in -DWH_DOUBLE=0 -DWH_DOUBLE=1; do
    (cd "$scratch/docs_howto_firmware.md" && cc -std=c11 -O1 -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off $flag -I. \
        -o strict main.c swing_swing.c core/scene.c core/angle.c && ./strict) >/dev/null 2>"$scratch/err"
    verdict $? "docs/howto/firmware.md: without a warning, $flag"
done

[ "$count" -ge 4 ]
verdict $? "$count examples found (run from the project's root)" /dev/null
exit $failed
