#!/bin/sh
# turn_tables.sh: what a step costs whose accelerations are looked up in tables (--tables), beside those that compute them:
# instructions, cycles and flash of SCENES on BOARD. `make bench-tables` calls it for each board with the variables of
# price.sh, and TIMING; EMULATE runs the image IMAGE; SMALL is 1 where memory is small.
#
# Each image's state after 300 steps must be the interpreter's, to the bit. Writes OUT/rows: lines "BOARD SCENE SETTING INSTRUCTIONS CYCLES FLASH", flash being that of the smallest firmware around
# the scene.
set -eu
here=$(dirname "$0")
: "${SCENES:=epicyclic_conserved rig_fixed}"
: "${SETTINGS:=turned lookup linear_64 linear_256 linear_1024 cubic_32 cubic_64 cubic_256}"
rm -rf "$OUT"
mkdir -p "$OUT"

options_of() { # options_of SETTING
    case $1 in
    turned | lookup) echo "--angles $1" ;;
    *) echo "--tables ${1%_*} --cells ${1#*_}" ;;
    esac
}

names=
for scene in $SCENES; do
    for setting in $SETTINGS; do
        name=${scene}_$setting
        names="$names $name"
        # shellcheck disable=SC2046 # a list of words
        "$WHIRL" derive "$scene" --as c --name "$name" --header "$OUT/$name.h" $(options_of "$setting") >"$OUT/$name.c"
        "$here/../count/index.sh" "$name" >"$OUT/index_$name.c"
        # shellcheck disable=SC2086
        {
            $BOARD_CC $BOARD_CFLAGS -c "$OUT/$name.c" -o "$OUT/$name.o"
            $BOARD_CC $BOARD_CFLAGS -DPRICE_SCENE="$name" -include "$OUT/$name.h" -c boards/programs/size.c \
                -o "$OUT/size_$name.o"
            $BOARD_CC $BOARD_LDFLAGS -o "$OUT/size_$name.elf" "$OUT/size_$name.o" "$OUT/$name.o" $BOARD_OBJECTS "$LIB_BOARD" \
                $BOARD_LDLIBS
            $BOARD_CC $BOARD_CFLAGS -I"$OUT" -include "$OUT/$name.h" -DWH_SCENE_WORDS="${name}_MEMORY_WORDS" \
                -DBENCH_SMALL="$SMALL" $BOARD_LDFLAGS -o "$OUT/bench_$name.elf" boards/programs/bench.c \
                "$OUT/index_$name.c" "$OUT/$name.o" $BOARD_OBJECTS "$LIB_BOARD" $BOARD_LDLIBS
            $BOARD_CC $BOARD_CFLAGS -I"$OUT" -include "$OUT/$name.h" -DWH_SCENE_WORDS="${name}_MEMORY_WORDS" \
                -DSCENE_STEPS_MOST=300U $BOARD_LDFLAGS -o "$OUT/bits_$name.elf" boards/programs/scenes.c \
                "$OUT/index_$name.c" "$OUT/$name.o" $BOARD_OBJECTS "$LIB_BOARD" $BOARD_LDLIBS
        }
        # what costs less must end in the same bits as the interpreter
        there=$(sh -c "$(echo "$EMULATE" | sed "s:IMAGE:$OUT/bits_$name.elf:")" | sed -n 's/.* hash \(0x[0-9a-f]*\) ok.*/\1/p')
        # shellcheck disable=SC2046
        here_too=$("$WHIRL" run "$scene" --number float --until 0.3s $(options_of "$setting") |
            sed -n 's/^state hash *//p')
        if [ -z "$there" ] || [ "$there" != "$here_too" ]; then
            echo "turn_tables.sh: error: $BOARD $name ends with ${there:-nothing}, the interpreter with $here_too" >&2
            exit 1
        fi
    done
done
# shellcheck disable=SC2086
BOARD=$BOARD CC=$BOARD_CC NM=$BOARD_NM SIZE=$BOARD_SIZE "$here/../count/board_rows.sh" "$OUT/boards.csv" "$OUT" $names
awk -F, '
    FNR > 1 {
        setting = $5
        match(setting, /_(turned|lookup|linear_[0-9]+|cubic_[0-9]+)$/)
        print $4, substr(setting, 1, RSTART - 1), substr(setting, RSTART + 1), $7, $8, $10
    }' "$OUT/boards.csv" >"$OUT/rows"
