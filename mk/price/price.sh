#!/bin/sh
# price.sh: what every effect of the built-in mechanisms costs; `make price-effects` calls it with
#
#   WHIRL=build/whirl OUT=build/price BOARD=... BOARD_CC=... BOARD_CFLAGS=... BOARD_LDFLAGS=... \
#   BOARD_LDLIBS=... BOARD_OBJECTS=... LIB_BOARD=... BOARD_NM=... BOARD_SIZE=... PLUGIN=... FLAGS=... \
#   EMULATE="qemu-system-arm ... -kernel @" price.sh core/models/*.whirl
#
# Writes OUT/effects.csv, a line an effect:
#   board,compiler,flags,mechanism,effect,kind, then without,with of each: instructions a step (median and
#   largest of STEPS steps), instructions a record (median), flash and RAM bytes of the smallest firmware, stack
#   bytes, step error; then the worst step of WORST random ones (effects with contacts), and how far the effect
#   moves the coordinates
# and OUT/tables.md, the same for people. Executed instructions, not cycles.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"
STEPS=2000
WORST=100000
export WHIRL OUT BOARD_CC BOARD_CFLAGS BOARD_LDFLAGS BOARD_LDLIBS BOARD_OBJECTS LIB_BOARD BOARD_SIZE

rm -rf "$OUT"
mkdir -p "$OUT"
"$WHIRL" list --as table "$@" | awk -f "$here/pairs.awk" >"$OUT/pairs"
n=$(($(wc -l <"$OUT/pairs") + 1))
# A flexibility is a mechanism of its own: the rig with it against the rig without.
echo "$n eccentric_fixed eccentric_coupled mechanism 0.001 10 core/models/eccentric.whirl" >>"$OUT/pairs"

PAIRS=$n
export PAIRS
tr '\n' '\0' <"$OUT/pairs" | xargs -0 -n 1 -P 2 sh "$here/pair.sh"

# All scenes in one program, counted as `make bench` counts.
# shellcheck disable=SC2046 # a list of words
"$here/../count/index.sh" $(ls "$OUT" | sed -n 's/^\(p[0-9]*_with.*\)\.c$/\1/p' | sort -V) >"$OUT/scenes.c"
count() { # count PROGRAM DEFINES MORE: to OUT/PROGRAM.csv
    # shellcheck disable=SC2086
    $BOARD_CC $BOARD_CFLAGS $2 -c "boards/programs/$1.c" -o "$OUT/$1.o"
    $BOARD_CC $BOARD_CFLAGS -c "$OUT/scenes.c" -o "$OUT/scenes.o"
    $BOARD_CC $BOARD_LDFLAGS -o "$OUT/$1.elf" "$OUT/$1.o" "$OUT/scenes.o" "$OUT"/p*_with*.o $BOARD_OBJECTS \
        "$LIB_BOARD" $BOARD_LDLIBS
    echo "  counting: $1" >&2
    BOARD=$BOARD CC=$BOARD_CC NM=$BOARD_NM FLAGS=$FLAGS PLUGIN=$PLUGIN MORE=$3 \
        EMULATE=$(echo "$EMULATE" | sed "s|@|$OUT/$1.elf|") \
        "$here/../count/count_board.sh" "$OUT/$1.elf" "$OUT/$1.csv" >"$OUT/$1.txt"
}
count bench "-DCOUNTED_STEPS=${STEPS}U -DCOUNT_RECORDS=1" ""
count worst "-DWORST_STEPS=${WORST}U" ",every=$WORST"

for list in bytes change; do
    for file in "$OUT"/*.$list; do
        echo "$list $(basename "$file" ".$list") $(cat "$file")"
    done
done >"$OUT/figures"
awk -v compiler="$(compiler_of "$BOARD_CC")" -v flags="$FLAGS" -v board="$BOARD" -v steps="$STEPS" -v worst="$WORST" \
    -v csv="$OUT/effects.csv" -v tables="$OUT/tables.md" -f "$here/tables.awk" "$OUT/pairs" "$OUT/figures" \
    "$OUT/bench.csv" "$OUT/worst.csv"
