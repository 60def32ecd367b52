#!/bin/sh
# settings_bits.sh: `make hashes-settings` (mk/settings.mk) covers every word of every axis of settings. The interpreter's
# hashes are those of `whirl run`, and one changed bit of a constant in one scene's code is found.
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

# --- a last bit of a constant ------------------------------------------------------------------------------------------
# Of these scenes' code, as it is and with the last digit of one constant another, in the accelerations, the matrix or a table.
ways=$(awk '!/^[^ ]*_fixed / && n++ % 4 == 0 { print $1 }' "$here/settings.txt")
cc -std=c11 -O1 -w -I. -c boards/host/board.c -o "$scratch/board.o" && for file in core/*.c; do
    cc -std=c11 -O1 -w -ffp-contract=off -I. -c "$file" -o "$scratch/$(basename "$file" .c).o" || exit 1
done
mk/count/index.sh $ways >"$here/table.c"
build() { # build PROGRAM: of what is in the folder now
    cc -std=c11 -O1 -w -ffp-contract=off -I. -I"$here" -o "$1" boards/programs/scenes.c "$here/table.c" \
        $(for name in $ways; do echo "$here/$name.c"; done) "$scratch"/*.o
}
grep -E "$(echo $ways | sed 's/ / |^scene /g; s/^/^scene /; s/$/ /')" "$here/float.hashes" >"$scratch/expected"
build "$scratch/same"
sh tests/hashes.sh "$scratch/log" "the interpreter" "cat $scratch/expected" compiled "$scratch/same" >"$scratch/out"
verdict $? "compiled as it was written: the same bits" "$scratch/out"
changed=0
for name in $ways; do
    cp "$here/$name.c" "$scratch/kept"
    # the first constant of the size of one in a table, a matrix or the accelerations, or any; its last digit in float:
    # 0x1.638e38p+2 -> 0x1.638e0p+2 and the like
    awk -v size="$(grep -qE '0x1\.[0-9a-f]+p(-1|\+[0-2])\)' "$scratch/kept" && echo '(-1|[+][0-2])[)]')" '
        /^static const wh_real cells|accelerations[(]const|step_matrix[(]const/ { inside = 1 }
        inside && !done && match($0, "0x1[.][0-9a-f]+p" size) {
            done = 1
            digits = substr(substr($0, RSTART + 4, RLENGTH - 4), 1)
            sub(/p.*/, "", digits)
            digits = substr(digits "00000", 1, 5)
            other = substr(digits, 1, 4) (substr(digits, 5, 1) == "8" ? "9" : "8")
            rest = substr($0, RSTART + 4)
            sub(/^[0-9a-f]+/, other, rest)
            $0 = substr($0, 1, RSTART + 3) rest
        }
        { print }' "$scratch/kept" >"$here/$name.c"
    if ! cmp -s "$scratch/kept" "$here/$name.c"; then
        changed=$((changed + 1))
        build "$scratch/other"
        sh tests/hashes.sh "$scratch/log" "the interpreter" "cat $scratch/expected" compiled "$scratch/other" >"$scratch/out"
        [ $? -eq 1 ] && grep -q ' differs ' "$scratch/out" && [ "$(grep -c "^        > scene $name " "$scratch/out")" -eq 1 ] &&
            [ "$(grep -c '^        > scene ' "$scratch/out")" -eq 1 ]
        verdict $? "one constant of $name is another: it differs, and no other scene" "$scratch/out"
    fi
    cp "$scratch/kept" "$here/$name.c"
done
[ $changed -ge 5 ]
verdict $? "$changed scenes had one constant changed"
exit $failed
