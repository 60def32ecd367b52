#!/bin/sh
# links.sh: how derivation and step grow with a mechanism: pendulums of 1 to LINKS links. `make bench-links` calls it with
# the variables of price.sh.
#
# Writes OUT/links.md, a table: operations of a right-hand side, instructions of deriving to C (callgrind, the whole
# program), instructions a step and flash (code and constants of the scene alone) on the board.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"
: "${LINKS:=12}"
[ "$LINKS" -gt 0 ] 2>/dev/null || {
    echo "links.sh: error: LINKS=$LINKS: a number of links, 1 or more" >&2
    exit 2
}
rm -rf "$OUT"
mkdir -p "$OUT"

for n in $(seq "$LINKS"); do
    awk -v n="$n" -v scene=1 -f "$here/links.awk" >"$OUT/links_$n.whirl"
    derive="$WHIRL derive $OUT/links_$n.whirl:swing_$n --as c --name links_$n --header $OUT/links_$n.h"
    $derive >"$OUT/links_$n.c"
    instructions=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null $derive 2>&1 >/dev/null |
        awk '/Collected/ { print $NF }')
    # shellcheck disable=SC2086
    $BOARD_CC $BOARD_CFLAGS -c "$OUT/links_$n.c" -o "$OUT/links_$n.o"
    flash=$("$BOARD_SIZE" "$OUT/links_$n.o" | awk 'NR == 2 { print $1 + $2 }')
    operations=$("$WHIRL" describe "$OUT/links_$n.whirl:swing_$n" | awk '$1 == "step" && NF == 7 { print $3 + $4 + $5 }')
    echo "$n $operations $instructions $flash"
done >"$OUT/rows"

# shellcheck disable=SC2046 # a list of words
"$here/../count/index.sh" $(seq -f 'links_%g' "$LINKS") >"$OUT/scenes.c"
for file in boards/programs/bench.c "$OUT/scenes.c"; do
    # shellcheck disable=SC2086
    $BOARD_CC $BOARD_CFLAGS -I"$OUT" -c "$file" -o "$OUT/$(basename "$file" .c).o"
done
# shellcheck disable=SC2086
$BOARD_CC $BOARD_LDFLAGS -o "$OUT/bench.elf" "$OUT/bench.o" "$OUT/scenes.o" "$OUT"/links_*.o $BOARD_OBJECTS \
    "$LIB_BOARD" $BOARD_LDLIBS
BOARD=$BOARD CC=$BOARD_CC NM=$BOARD_NM FLAGS=$FLAGS PLUGIN=$PLUGIN EMULATE=$(echo "$EMULATE" | sed "s|@|$OUT/bench.elf|") \
    "$here/../count/count_board.sh" "$OUT/bench.elf" "$OUT/bench.csv" >"$OUT/bench.txt"
awk '
    FNR == NR { if ($2 ~ /^links_/) { steps[substr($2, 7)] = $6 }; next }
    FNR == 1 {
        print "| links | operations | deriving, million instructions | a step, instructions | scene, bytes of flash |"
        print "|---|---|---|---|---|"
    }
    { printf "| %d | %d | %.1f | %d | %d |\n", $1, $2, $3 / 1e6, steps[$1], $4 }' "$OUT/bench.txt" "$OUT/rows" >"$OUT/links.md"
