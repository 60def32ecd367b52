#!/bin/sh
# functions.sh OBJECTS LIST LIBRARY...: prints the bytes of each library, although a program links only the parts that
# it calls. Then come the core's own functions, each linked alone from the first library with all that it calls, and all
# of them together. No step of a scene in LIST (lines "SCENE BYTES", objects in OBJECTS) may be longer than its bytes
# there. Those are the bytes of steps that looked up every sine at every stage (commit 31fbe43). Exit status 1: a step
# is longer, or a scene is missing. CC, CPU and SIZE are those of the board.
set -eu
objects=$1 list=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

printf '%-28s %8s %8s\n' "library, all of it" "flash B" "ram B"
for library in "$@"; do
    "$SIZE" -t "$library" | awk -v name="$(basename "$library" .a)" '
        $NF == "(TOTALS)" { printf "%-28s %8d %8d\n", name, $1 + $2, $2 + $3 }'
done

function_bytes() { # function_bytes NAME FUNCTION...: prints code and constants of an image of these functions
    name=$1
    shift
    $CC $CPU -nostdlib -Wl,--gc-sections -Wl,-e,"$1" $(printf ' -Wl,-u,%s' "$@") -o "$work/image" "$library" -lgcc
    "$SIZE" "$work/image" | awk -v name="$name" 'NR == 2 { printf "%-28s %8d\n", name, $1 + $2 }'
}
library=$1
# All functions that core/function.h lists.
all=$(printf '#include "core/function.h"\n#define NAME(name) wh_##name\nWH_FUNCTIONS(NAME, NAME)\n' |
    $CC -ffreestanding -E -P -I. -x c - | tail -n 1)
printf '%-28s %8s\n' "function" "flash B"
for function in $all; do function_bytes "$function" "$function"; done
function_bytes "all of them" $all

[ -f "$list" ] || exit 0
passed=0 failed=0
while read -r scene most; do
    bytes=$($SIZE -A "$objects/$scene.o" | awk '$1 == ".text.advance" { print $2 }')
    if [ -n "$bytes" ] && [ "$bytes" -le "$most" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "not ok - $scene: a step of ${bytes:-no} bytes, of at most $most"
    fi
done <"$list"
echo "steps of scenes without contacts, bytes: $passed within their most, $failed not"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
