#!/bin/sh
# race.sh WHIRL PROGRAMS TABLE: steps and derivations by other tools beside Whirl's, in one run, as ratios.
#
# PEERS, SYSTEMS, SCENES   PROGRAMS/PEER_SYSTEM is a program of tests/tools/naive_main.c; the scene is Whirl's
# PYTHON                   one that has SymPy
# ROUNDS                   how often each is timed, in turns, so that what slows the machine down slows all (15)
#
# Instructions a step: what callgrind counts of COUNTED more steps, everything included, over COUNTED. Times: the
# median of the rounds' ratios to Whirl's in the same round.
set -eu
whirl=$1
programs=$2
table=$3
: "${ROUNDS:=15}" "${STEPS:=200000}" "${PYTHON:=/usr/bin/python3}"
COUNTED=1000
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

counted() { # counted PROGRAM STEPS: instructions of the whole program
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$1" steps "$2" 2>&1 >/dev/null |
        awk '/Collected/ { print $NF }'
}

median() { sort -g | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

# --- steps --------------------------------------------------------------------------------------------
for system in $SYSTEMS; do
    for peer in $PEERS; do
        program=$programs/${peer}_$system
        "$program" >/dev/null # that it computes the right motion
        few=$(counted "$program" 3000)
        many=$(counted "$program" $((3000 + COUNTED)))
        echo "$peer $system instructions $(((many - few + COUNTED / 2) / COUNTED))"
    done
    for round in $(seq "$ROUNDS"); do
        for peer in $PEERS; do
            echo "$peer $round $("$programs/${peer}_$system" time "$STEPS")"
        done
    done >"$work/times"
    for peer in $PEERS; do
        awk -v peer="$peer" '$1 == "whirl" { own[$2] = $3 } $1 == peer { its[$2] = $3 }
            END { for (round in its) print its[round] / own[round] }' "$work/times" | median |
            sed "s/^/$peer $system ratio /"
    done
    awk '$1 == "whirl" { print $3 }' "$work/times" | median >"$work/own_ns.$system"
done >"$work/rows"

# --- Octave's step and SymPy's derivation -------------------------------------------------------------
cp mk/peers/step.m "$work"
set -- $SYSTEMS
for scene in $SCENES; do
    system=$1
    shift
    [ "$system" != reduced ] || continue # what derives finds that by itself
    "$whirl" derive "$scene" --as octave --folded >"$work/$scene.m"
    ns=$(cd "$work" && octave-cli --norc --no-history --quiet --eval "step('$scene')")
    awk -v ns="$ns" -v own="$(cat "$work/own_ns.$system")" -v of="$system" \
        'BEGIN { print "octave", of, "ratio", ns / own }'
    echo "sympy $system derivation $("$PYTHON" mk/peers/derive.py "$whirl" "$system" "$scene")"
done >>"$work/rows"

awk -f mk/peers/table.awk "$work/rows" >"$table"
