#!/bin/sh
# pair.sh "N MECHANISM EFFECT KIND STEP_s UNTIL_s FILE": price one effect (price.sh calls it).
#
# Needs, in the environment, what price.sh has, and OUT/N.scenes and OUT/N.bare of pairs.awk. Leaves
# OUT/pN_without.c and pN_with.c with their objects, OUT/N.bytes ("flash ram" without, with) and
# OUT/N.change ("step error without, with; change of the motion"). Fails if the mechanism without the effect
# is not what a file without any effect gives.
set -eu
set -- $1
n=$1 mechanism=$2 effect=$3 step_s=$5 until_s=$6 file=$7
strip=$(dirname "$0")/strip.awk
out=$OUT
model=$out/$n.whirl

awk -v drop=scene -f "$strip" "$file" | cat - "$out/$n.scenes" >"$model"
for side in without with; do
    if ! "$WHIRL" derive "$model:p${n}_$side" --as c >"$out/p${n}_$side.c" 2>"$out/$n.errors"; then
        cp "$out/$n.errors" "$out/$n.skipped" # such as a ledger of equations that have no energies
        rm -f "$out/p${n}_without.c" "$out/p${n}_with.c"
        exit 0
    fi
done
if [ -e "$out/$n.bare" ]; then
    awk -v drop="scene effect" -f "$strip" "$file" | cat - "$out/$n.bare" >"$out/$n.bare.whirl"
    "$WHIRL" derive "$out/$n.bare.whirl:p${n}_without" --as c >"$out/$n.bare.c"
    sed 1d "$out/$n.bare.c" >"$out/$n.bare.body" # the first line names the file
    if ! sed 1d "$out/p${n}_without.c" | cmp - "$out/$n.bare.body" >&2; then
        echo "pair.sh: $mechanism without $effect is not what a file without effects gives" >&2
        exit 1
    fi
fi

number_of() { # number_of NAME FILE: of the scene's structs
    sed -n "s/^    \.$1 = \([0-9]*\)U\{0,1\},.*/\1/p" "$2" | tail -n 1
}
# bytes_of SIDE: flash and RAM of the smallest image around the scene
bytes_of() {
    c=$out/p${n}_$1
    entries=$(sed -n 's/.*\.entries = \([0-9]*\).*/\1/p' "$c.c")
    accounts=$(sed -n 's/.*\.accounts = \([0-9]*\).*/\1/p' "$c.c")
    contacts=$(number_of contacts "$c.c")
    outputs=$(number_of outputs "$c.c")
    words="WH_STATE_WORDS($(number_of angles "$c.c"),$(number_of reals "$c.c"),$(number_of inputs "$c.c"))"
    [ -z "$contacts" ] || words="$words+WH_CONTACT_WORDS($contacts)"
    [ -z "$entries" ] || words="$words+WH_LEDGER_WORDS($entries,$accounts)"
    $BOARD_CC $BOARD_CFLAGS -c "$c.c" -o "$c.o"
    $BOARD_CC $BOARD_CFLAGS "-DPRICE_SCENE=p${n}_$1" "-DPRICE_WORDS=($words)" \
        "-DPRICE_OUTPUTS=$((outputs > 0 ? outputs : 1))" -c boards/programs/size.c -o "$c.image.o"
    $BOARD_CC $BOARD_LDFLAGS -o "$c.elf" "$c.image.o" "$c.o" $BOARD_OBJECTS "$LIB_BOARD" $BOARD_LDLIBS
    "$BOARD_SIZE" -A "$c.elf" | awk '
        $1 == ".text" || $1 == ".ARM.exidx" { flash += $2 }
        $1 == ".data" { flash += $2; ram += $2 }
        $1 == ".bss" { ram += $2 }
        END { print flash, ram }'
    rm -f "$c.elf" "$c.image.o"
}
without=$(bytes_of without)
echo "$without $(bytes_of with)" >"$out/$n.bytes"

# The coordinates after a while, "NAME VALUE" lines: the state's columns stand before their rates.
last_s=$(awk -v u="$until_s" 'BEGIN { print u < 4 ? u : 4 }')
state() { # state SIDE STEP_s
    "$WHIRL" run "$model:p${n}_$1" --quiet --csv - --step "$2" --until "$last_s" --every "$last_s" 2>/dev/null |
        tr -d '\r' | awk -F, '
            NR == 1 { columns = split($0, name, ",") }
            { last = $0 }
            END {
                split(last, value, ",")
                for (i = 2; i <= columns && name[i] !~ /^der\(/; i++) { print name[i], value[i] }
            }'
}
distance() { # the largest difference between two such lists, of names in both
    awk 'NR == FNR { first[$1] = $2; next }
        $1 in first { d = $2 - first[$1]; d = d < 0 ? -d : d; if (!(d <= worst)) { worst = d } }
        END { printf "%.3g\n", worst }' "$1" "$2"
}
fine_s=$(awk -v s="$step_s" 'BEGIN { printf "%.17g", s / 8 }')
for side in without with; do
    state "$side" "$step_s" >"$out/$n.$side.coarse"
    state "$side" "$fine_s" >"$out/$n.$side.fine"
done
echo "$(distance "$out/$n.without.fine" "$out/$n.without.coarse") $(distance "$out/$n.with.fine" \
    "$out/$n.with.coarse") $(distance "$out/$n.without.fine" "$out/$n.with.fine")" >"$out/$n.change"
echo "  priced $mechanism $effect ($n of $PAIRS)" >&2
