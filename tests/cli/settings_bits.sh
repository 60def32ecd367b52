#!/bin/sh
# settings_bits.sh: `make hashes-settings` (mk/settings.mk) covers every word of every axis of settings, and the interpreter's
# hashes are those of `whirl run`. (runners.sh shows that a hash that differs is found.)
. "$(dirname "$0")/../checks.sh"

steps=60
scenes="13 two_mass_relative 13 epicyclic_conserved 13 mk/price/separable.whirl 13 tests/boards/settings.whirl:mixed_turns
    13 tests/boards/settings.whirl:clapper_claps"
here=$scratch/settings
mkdir "$here"
"$whirl" emit-settings "$here" $steps $scenes >"$scratch/out" 2>"$scratch/err"
verdict $? "scenes with settings are written" "$scratch/err"
"$whirl" emit-settings "$here" 0 1 two_mass_relative 2>"$scratch/err"
[ $? -eq 2 ] && grep -q '^usage: ' "$scratch/err"
verdict $? "steps that are none are refused"

# --- every word -------------------------------------------------------------------------------------------------------
for option in method angles matrix tables; do
    words=$("$whirl" run two_mass_relative --$option '?' 2>&1 | sed -n 's/,//g; s/^hint: one of //p')
    [ -n "$words" ] || verdict 1 "--$option has words"
    for word in $words; do
        case $word in turned | none) continue ;; esac # what stands without the option
        grep -q -e "--$option $word " "$here/settings.txt" || verdict 1 "--$option $word is among the settings" "$here/settings.txt"
    done
done
grep -q -e --compensated "$here/settings.txt" && [ -s "$here/fixed.hashes" ] && grep -q 'events [1-9]' "$here/settings.txt"
verdict $? "so are compensated sums, fixed point, and a run with events"

# --- the interpreter's hashes are those of whirl run ------------------------------------------------------------------
as_run() { # as_run LIST NAME TARGET OPTION...: the hash of a line of LIST
    list=$1 name=$2
    shift 2
    step=$("$whirl" describe "$1" | sed -n 's/.*, step \([0-9.e-]*\) s,.*/\1/p' | head -n 1)
    until=$(awk -v h="$step" -v n=$steps 'BEGIN { print n * h }')
    hash=$("$whirl" run "$@" --until "$until" 2>/dev/null | sed -n 's/^state hash *//p')
    grep -q "^scene $name steps $steps hash $hash ok$" "$list"
    verdict $? "whirl run $* ends in the same state" "$list"
}
compared=0
while read -r name words; do
    compared=$((compared + 1))
    set -- ${words% events *}
    case $name in
    *_fixed) as_run "$here/fixed.hashes" "$name" "$@" ;;
    *)
        [ $((compared % 5)) -eq 1 ] || continue
        as_run "$here/float.hashes" "$name" "$@" --number float
        as_run "$here/double.hashes" "$name" "$@" --number double
        ;;
    esac
done <"$here/settings.txt"
[ $compared -ge 20 ]
verdict $? "$compared settings were looked at"
exit $failed
