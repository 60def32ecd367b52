#!/bin/sh
# settings_bits.sh: `make hashes-settings` (mk/settings.mk) covers every word of every axis of settings. (runners.sh shows
# that a hash that differs is found.)
. "$(dirname "$0")/../checks.sh"

steps=60
scenes="13 two_mass_relative 13 epicyclic_conserved 13 mk/price/separable.whirl 13 tests/boards/settings.whirl:mixed_turns
    13 tests/boards/settings.whirl:clapper_claps"
here=$scratch/settings
mkdir "$here"
sh tests/settings_hashes.sh "$whirl" "$here" $steps $scenes >"$scratch/out" 2>"$scratch/err"
verdict $? "scenes with settings are written" "$scratch/err"

for option in method angles matrix tables; do
    words=$("$whirl" run two_mass_relative --$option '?' 2>&1 | sed -n 's/,//g; s/^hint: choose one of //p')
    [ -n "$words" ] || verdict 1 "--$option has words"
    for word in $words; do
        case $word in turned | none) continue ;; esac # used if the option is omitted
        grep -q -e "--$option $word " "$here/settings.txt" || verdict 1 "--$option $word is among the settings" "$here/settings.txt"
    done
done
grep -q -e --compensated "$here/settings.txt" && grep -q WH_CONTACTS_MAX "$here"/*.c
verdict $? "so are compensated sums, and contacts"
for number in float double fixed; do
    grep -q "^scene [a-z_0-9]* steps $steps hash 0x[0-9a-f]* ok$" "$here/$number.hashes"
    verdict $? "runs in $number have hashes"
done
exit $failed
