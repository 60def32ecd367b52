#!/bin/sh
# count_board.sh: instructions a step of every scene, on an emulated board.
#
#   BOARD=mps2-an386 CC=arm-none-eabi-gcc NM=arm-none-eabi-nm FLAGS="-O2" PLUGIN=count.so \
#   EMULATE="qemu-system-arm ... -kernel bench.elf" count_board.sh bench.elf figures.csv [SCENE]
#
# MORE is further arguments of the plugin (",every=1000"); TIMING the core whose cycles it estimates (m4), if any.
#
# Appends rows to figures.csv (with a header if it is new) and prints them as a table. With SCENE,
# prints instead where that scene's instructions go, by function (the one call of the end marker
# included). Executed instructions, not cycles.
set -eu
. "$(dirname "$0")/common.sh"

elf=$1
csv=$2
scene=${3:-}
more=${MORE:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

count "$more"

if [ -z "$scene" ]; then
    awk -v commit="$(commit_of_checkout)" -v board="$BOARD" -v compiler="$(compiler_of "$CC")" \
        -v flags="$FLAGS" -v obtained=estimated -f "$(dirname "$0")/figures.awk" "$work/console" "$work/counts" \
        >"$work/rows"
    [ -s "$csv" ] || echo "$CSV_HEADER" >"$csv"
    cat "$work/rows" >>"$csv"
    table <"$work/rows"
    exit "$status"
fi

range=$(awk -v scene="$scene" '$1 == "count" && $2 == scene { print ",first=" $5 ",last=" $6 + 0 }' \
    "$work/console")
if [ -z "$range" ]; then
    echo "count_board.sh: there is no scene $scene" >&2
    exit 1
fi
count ",profile=on$range"
"$NM" -S -t d "$elf" | awk 'NF == 4 && $3 ~ /[tTwW]/ { print "symbol", $1 + 0, $2 + 0, $4 }' |
    cat - "$work/counts" | awk -v steps="$(echo "$range" | awk -F'[=,]' '{ print $5 - $3 + 1 }')" '
    $1 == "symbol" { n++; start[n] = $2; size[n] = $3; name[n] = $4 }
    $1 == "address" {
        total += $3
        for (i = 1; i <= n; i++) {
            if ($2 >= start[i] && $2 < start[i] + size[i]) {
                of[name[i]] += $3
                next
            }
        }
        of["(no symbol)"] += $3
    }
    END {
        for (i in of) {
            printf "%10.1f %5.1f%%  %s\n", of[i] / steps, 100 * of[i] / total, i
        }
        printf "%10.1f 100.0%%  instructions a step, all\n", total / steps
    }' | sort -rn
