# common.sh: shared functions of the counting scripts, to be sourced.

CSV_HEADER="commit,board,compiler,flags,scene,number,method,metric,value"

# The commit that the figures belong to, with "+" if files differ from it.
commit_of_checkout() {
    commit=$(git rev-parse --short HEAD 2>/dev/null) || commit=none
    if [ "$commit" != none ] && [ -n "$(git status --porcelain 2>/dev/null)" ]; then
        commit="$commit+"
    fi
    echo "$commit"
}

# Prints "gcc 12.2.0", from the compiler's command.
compiler_of() {
    version=$($1 -dumpfullversion 2>/dev/null || $1 -dumpversion)
    echo "${1##*/} $version"
}

# figures_into FILE: row() appends the rows of $BOARD's images to FILE. $work is a folder that is deleted at the end.
figures_into() {
    csv=$1
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    commit=$(commit_of_checkout)
    compiler=$(compiler_of "$CC")
    [ -s "$csv" ] || echo "$CSV_HEADER" >"$csv"
}

# row METRIC VALUE: writes a row for the image $name.
row() {
    echo "$commit,$BOARD,$compiler,\"$FLAGS\",$name,float,-,$1,$2" >>"$csv"
}

# Prints the CSV rows on standard input as a table, with a line for each scene.
table() {
    awk -F, '
        # The flags are one quoted field without commas; metric and value come last.
        {
            key = $5 " " $6 " " $7
            if (!(key in seen)) { order[++lines] = key; seen[key] = 1; board[key] = $2 }
            if ($8 ~ /cycles/) {
                if ($8 ~ /median/) { figure[key, 5] = $9; how[key] = $8; sub(/ .*/, "", how[key]) }
            } else {
                figure[key, $8 ~ /minimum/ ? 1 : $8 ~ /median/ ? 2 : $8 ~ /maximum/ ? 3 : 4] = $9
            }
        }
        END {
            printf "%-12s %-28s %-7s %-24s %8s %8s %8s %8s %8s\n", "board", "scene", "number",
                "method", "minimum", "median", "maximum", "stack B", "cycles"
            for (i = 1; i <= lines; i++) {
                key = order[i]
                split(key, part, " ")
                printf "%-12s %-28s %-7s %-24s %8s %8s %8s %8s %8s %s\n", board[key], part[1], part[2],
                    part[3], figure[key, 1], figure[key, 2], figure[key, 3], figure[key, 4], figure[key, 5], how[key]
            }
        }'
}

# address_of FUNCTION: prints the function's address in $elf.
address_of() {
    found=$("$NM" "$elf" | awk -v name="$1" '$3 == name { print "0x" $1 }')
    if [ -z "$found" ]; then
        echo "${0##*/}: $elf has no function $1" >&2
        exit 1
    fi
    echo "$found"
}

# count MORE-PLUGIN-ARGUMENTS: runs $elf once with $EMULATE and $PLUGIN. Writes the console to $work/console, the
# counts to $work/counts and the exit status to $status.
count() {
    begin=$(address_of wh_count_begin)
    end=$(address_of wh_count_end)
    case $PLUGIN in
    */*) ;;
    *) PLUGIN=./$PLUGIN ;;
    esac
    status=0
    [ -z "${TIMING:-}" ] || set -- "$1,cycles=$TIMING"
    sh -c "$EMULATE -plugin $PLUGIN,begin=$begin,end=$end$1 -d plugin -D $work/counts" \
        >"$work/console" || status=$?
    if [ "$status" -ne 0 ]; then
        echo "${0##*/}: the program under the counter ended with $status" >&2
        cat "$work/console" >&2
        if ! grep -q '^count ' "$work/console"; then
            exit 1
        fi
    fi
}

# callgrind ELF: runs a program of this machine, and writes its console and its intervals to $work/counts, as the
# plugin does. The counts are dumped and cleared at both ends of an interval, so every second part is an interval.
callgrind() {
    status=0
    valgrind --tool=callgrind --callgrind-out-file="$work/parts" --combine-dumps=yes \
        --toggle-collect=wh_scene_step --toggle-collect=wh_scene_step_d --toggle-collect=bench_pair \
        --toggle-collect=bench_one --toggle-collect=bench_two --toggle-collect=naive_step \
        --dump-before=wh_count_begin --dump-after=wh_count_end "$1" >"$work/console" 2>"$work/log" || status=$?
    if ! grep -q '^count ' "$work/console"; then
        cat "$work/console" "$work/log" >&2
        return 1
    fi
    awk '/^part: / { part = $2 } /^(summary|totals): / { total[part] = $2 }
        END { for (i = 2; i in total; i += 2) { print "interval", i / 2 - 1, total[i] } }' "$work/parts" >"$work/counts"
}

# counted ELF: writes the rows of an image (figures.awk) to $work/rows, counted by callgrind on this machine, by
# $PLUGIN, or by simavr. $EMULATE runs the image IMAGE.
counted() {
    elf=$1 image=${image:-${EMULATE:-}} obtained=
    EMULATE=$(echo "$image" | sed "s:IMAGE:$elf:")
    if [ "$BOARD" = host ]; then
        callgrind "$elf"
    elif [ -n "${PLUGIN:-}" ]; then
        obtained=estimated
        count ""
    else
        obtained=simulated
        sh -c "$EMULATE counts=$work/counts" >"$work/console"
    fi
    awk -v commit="$(commit_of_checkout)" -v board="$BOARD" -v compiler="$(compiler_of "$CC")" -v flags="${FLAGS:-}" \
        -v obtained=$obtained -f "$(dirname "$0")/figures.awk" "$work/console" "$work/counts" >>"$work/rows"
}

# bytes_of SIZE ELF: prints the flash and RAM of an image.
bytes_of() {
    "$1" -A "$2" | awk '
        $1 == ".vectors" || $1 == ".text" || $1 == ".ARM.exidx" || $1 == ".data" { flash += $2 }
        $1 == ".data" || $1 == ".bss" { ram += $2 }
        END { print flash, ram }'
}
