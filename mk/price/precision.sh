#!/bin/sh
# precision.sh: work against precision of every method: `make bench-precision` calls it with the variables of price.sh and
#
#   PRECISION=build/tools/precision BENCH_HOST="build/double/...: what a program that counts in double is linked with" \
#   HOST_CC=gcc HOST_CFLAGS="-O2" precision.sh SCENE|FILE:SCENE[@jumping]...
#
# Writes OUT/counts (scene, method, sums, instructions a step: float and compensated on the board, double on this machine),
# OUT/errors (of tests/tools/precision.c) and OUT/precision.md, tables: what each error costs least, and by which method.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"
rm -rf "$OUT"
mkdir -p "$OUT"
methods=$("$WHIRL" derive epicyclic_conserved --as c --method '?' 2>&1 | sed -n 's/,//g; s/^hint: one of //p')

for word in "$@"; do
    echo "${word%@*}"
done | sort -u >"$OUT/targets"
while read -r target; do
    scene=${target##*:}
    for method in $methods; do
        for sums in plain compensated; do
            name=${scene}__$(echo "$method" | tr - _)__$sums
            more=
            [ $sums = plain ] || more=--compensated
            # shellcheck disable=SC2086 # an option, or none
            "$WHIRL" derive "$target" --as c --name "$name" --header "$OUT/$name.h" --method "$method" $more \
                >"$OUT/$name.c" 2>"$OUT/errors" || { rm -f "$OUT/$name.c" "$OUT/$name.h"; continue; }
            # shellcheck disable=SC2086
            $BOARD_CC $BOARD_CFLAGS -c "$OUT/$name.c" -o "$OUT/$name.o"
            echo "$name" >>"$OUT/names"
            [ $sums = plain ] || continue
            # shellcheck disable=SC2086
            $HOST_CC $HOST_CFLAGS -I. -DWH_DOUBLE=1 -c "$OUT/$name.c" -o "$OUT/$name.host.o"
            echo "$name" >>"$OUT/double_names"
        done
    done
done <"$OUT/targets"

# shellcheck disable=SC2046 # a list of words
"$here/../count/index.sh" $(cat "$OUT/names") >"$OUT/scenes.c"
# shellcheck disable=SC2046
"$here/../count/index.sh" $(cat "$OUT/double_names") >"$OUT/double_scenes.c"
for file in boards/programs/bench.c "$OUT/scenes.c"; do
    # shellcheck disable=SC2086
    $BOARD_CC $BOARD_CFLAGS -DBENCH_SMALL=1 -I"$OUT" -c "$file" -o "$OUT/$(basename "$file" .c).o"
done
# shellcheck disable=SC2046,SC2086
$BOARD_CC $BOARD_LDFLAGS -o "$OUT/bench.elf" "$OUT/bench.o" "$OUT/scenes.o" $(sed "s|.*|$OUT/&.o|" "$OUT/names") \
    $BOARD_OBJECTS "$LIB_BOARD" $BOARD_LDLIBS
BOARD=$BOARD CC=$BOARD_CC NM=$BOARD_NM FLAGS=$FLAGS PLUGIN=$PLUGIN EMULATE=$(echo "$EMULATE" | sed "s|@|$OUT/bench.elf|") \
    "$here/../count/count_board.sh" "$OUT/bench.elf" "$OUT/bench.csv" >"$OUT/bench.txt"
# shellcheck disable=SC2046,SC2086
$HOST_CC $HOST_CFLAGS -DWH_DOUBLE=1 -DBENCH_SMALL=1 -I. -I"$OUT" -o "$OUT/bench_double" boards/programs/bench.c \
    "$OUT/double_scenes.c" $(sed "s|.*|$OUT/&.host.o|" "$OUT/double_names") $BENCH_HOST
CC=$HOST_CC FLAGS=-O2 "$here/../count/count_host.sh" "$OUT/bench_double" "$OUT/bench_double.csv" >"$OUT/bench_double.txt"

awk '$2 ~ /__/ && $5 ~ /^[0-9.]+$/ {
        split($2, part, "__")
        gsub("_", "-", part[2])
        sums = FILENAME ~ /double/ ? "double" : part[3] == "plain" ? "float" : part[3]
        print part[1], part[2], sums, $6
    }' "$OUT/bench.txt" "$OUT/bench_double.txt" >"$OUT/counts"
"$PRECISION" "$@" >"$OUT/errors"
awk -f "$here/precision.awk" "$OUT/counts" "$OUT/errors" >"$OUT/precision.md"
