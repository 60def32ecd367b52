#!/bin/sh
# fixed.sh: what a step in fixed point costs on BOARD, counted. `make price-fixed` calls it with the variables of TO_PRICE
# (mk/price.mk); SCENES has lines "TARGET OPTIONS OF whirl derive...". Prints a line each:
#
#   BOARD TARGET OPTIONS: INSTRUCTIONS (most) [CYCLES], FLASH bytes of the scene's own code and constants, STACK bytes
#
# Each image's state behind the counted steps must be that of the same code on this machine, to the bit: else the exit
# status is 1. HOST_LIB is the core's library in float, HOST_BOARD the object that plays a board here.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"
: "${SCENES:=two_mass_relative
epicyclic_conserved
thomson_a_conserved --until 2s}"
NM=${BOARD_NM:-nm}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
STEPS=100
emulate=$EMULATE

one() { # one TARGET OPTIONS...
    "$WHIRL" derive "$@" --as c --number fixed --name counted --header "$work/counted.h" >"$work/counted.c" 2>/dev/null || {
        "$WHIRL" derive "$@" --as c --number fixed 2>&1 >/dev/null | grep -m 1 'error' | sed "s|^|$BOARD $*: |"
        return 0
    }
    elf=$work/counted.elf
    # shellcheck disable=SC2086
    {
        $BOARD_CC $BOARD_CFLAGS -c "$work/counted.c" -o "$work/counted.o"
        $BOARD_CC $BOARD_CFLAGS -DFIXED_SCENE=counted -DCOUNTED_STEPS="${STEPS}U" -include "$work/counted.h" \
            $BOARD_LDFLAGS -o "$elf" boards/programs/fixed.c "$work/counted.o" $BOARD_OBJECTS "$LIB_BOARD" $BOARD_LDLIBS
    }
    EMULATE=$(echo "$emulate" | sed "s|@|$elf|")
    rm -f "$work/counts"
    if [ -n "${PLUGIN:-}" ]; then
        count ""
    else
        sh -c "$EMULATE counts=$work/counts" >"$work/console"
    fi
    # the interpreter's bits on this machine are the generated code's (tests/cli/fixed.sh)
    cc -std=c11 -O2 -w -I. -DFIXED_SCENE=counted -DCOUNTED_STEPS="${STEPS}U" -include "$work/counted.h" -o "$work/here" \
        boards/programs/fixed.c "$work/counted.c" "$HOST_BOARD" "$HOST_LIB"
    "$work/here" | tr -d '\r' | grep '^fixed' >"$work/expected"
    tr -d '\r' <"$work/console" | grep '^fixed' | cmp -s - "$work/expected" || {
        echo "fixed.sh: error: $BOARD $*: the board says $(cat "$work/console"), this machine $(cat "$work/expected")" >&2
        exit 1
    }
    flash=$("$BOARD_SIZE" "$work/counted.o" | awk 'NR == 2 { print $1 + $2 }')
    awk -v what="$BOARD $*" -v flash="$flash" '
        { sub(/\r$/, "") }
        $1 == "interval" { counted[$2] = $3 }
        $1 == "cycles" { cycles[$2] = $3; timed = 1 }
        $1 == "stack" { stack = $3 }
        $1 == "fixed" { first = $3; last = $4 }
        END {
            for (i = first; i <= last; i++) {
                now = counted[i] - counted[0]; sum += now; most = now > most ? now : most
                sum_c += cycles[i] - cycles[0]; n++
            }
            printf "%s: %.0f instructions (most %d)", what, sum / n, most
            if (timed) { printf ", %.0f cycles", sum_c / n }
            printf ", %d bytes of its own, stack %s\n", flash, stack
        }' "$work/counts" "$work/console"
}

echo "$SCENES" | while read -r words; do
    # shellcheck disable=SC2086
    [ -z "$words" ] || one $words </dev/null
done
