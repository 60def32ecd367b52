#!/bin/sh
# pair.sh "N MECHANISM EFFECT KIND STEP_s UNTIL_s TARGET": price one effect (price.sh calls it).
#
# Needs, in the environment, what price.sh has. Leaves OUT/pN_without.c and pN_with.c with their headers and objects,
# OUT/N.bytes ("flash ram" without, with) and OUT/N.change ("step error without, with; change of the motion").
# KIND mechanism: TARGET is a file, MECHANISM in it what is without, EFFECT what is with.
set -eu
set -- $1
n=$1 mechanism=$2 effect=$3 kind=$4 step_s=$5 until_s=$6 target=$7
out=$OUT

# ask SIDE COMMAND WORDS...: whirl COMMAND of that side: nothing of the scene's effects but this one
ask() {
    side=$1 command=$2
    shift 2
    case $kind-$side in
    mechanism-without) "$WHIRL" "$command" "$target:$mechanism" --set duty=0.6 "$@" ;;
    mechanism-with) "$WHIRL" "$command" "$target:$effect" --set duty=0.6 "$@" ;;
    *-without) "$WHIRL" "$command" "$target" --without all,ledger,conserve "$@" ;;
    ledger-with) "$WHIRL" "$command" "$target" --without all,conserve --with ledger "$@" ;;
    *-with) "$WHIRL" "$command" "$target" --without all,ledger,conserve --with "$effect" "$@" ;;
    esac
}

for side in without with; do
    c=$out/p${n}_$side
    if ! ask $side derive --as c --name "p${n}_$side" --header "$c.h" >"$c.c" 2>"$out/$n.errors"; then
        cp "$out/$n.errors" "$out/$n.skipped" # such as a ledger of equations that have no energies
        rm -f "$out/p${n}_without".? "$out/p${n}_with".?
        exit 0
    fi
done

# bytes_of SIDE: flash and RAM of the smallest image around the scene
bytes_of() {
    c=$out/p${n}_$1
    $BOARD_CC $BOARD_CFLAGS -c "$c.c" -o "$c.o"
    $BOARD_CC $BOARD_CFLAGS "-DPRICE_SCENE=p${n}_$1" -include "$c.h" -c boards/programs/size.c -o "$c.image.o"
    $BOARD_CC $BOARD_LDFLAGS -o "$c.elf" "$c.image.o" "$c.o" $BOARD_OBJECTS "$LIB_BOARD" $BOARD_LDLIBS
    "$BOARD_SIZE" -A "$c.elf" | awk '
        $1 == ".vectors" || $1 == ".text" || $1 == ".ARM.exidx" { flash += $2 }
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
    ask "$1" run --quiet --csv - --step "$2" --until "$last_s" --every "$last_s" 2>/dev/null |
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
