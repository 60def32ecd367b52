#!/bin/sh
# cases.sh FOLDER SEED COUNT float|fixed: prints COUNT cases whose steps are counted for the table of figures, a line
# "ID TARGET OPTIONS..." each. The files that it writes go to FOLDER. WHIRL is the program.
#
# The scenes have no contacts, and are in a random order by SEED: built-in ones, pendulums of 1 to 6 links, mechanisms that
# call functions (build/tools/mechanisms), and random ones (scenes.awk), of which some rest or fly. Each scene takes the
# next of the settings below in which it can be written.
set -eu
here=$(dirname "$0")
folder=$1 seed=$2 count=$3 number=$4
mkdir -p "$folder"

# drawn N [KIND]: writes N random scenes of a kind
drawn() {
    file=$folder/drawn$2_$seed.whirl
    awk -v n="$1" -v seed="$seed" ${2:+-v "$2=1"} -f "$here/scenes.awk" </dev/null >"$file"
    "$WHIRL" list --as table "$file" | awk -F'\t' -v file="$file" '$1 == "scene" { print file ":" $2 }'
}
{
    "$WHIRL" list --as table | awk -F'\t' '$1 == "scene" { print $2 }'
    for n in 1 2 3 4 5 6; do
        awk -v n=$n -v scene=1 -f "$here/links.awk" </dev/null >"$folder/links_$n.whirl"
        echo "$folder/links_$n.whirl:swing_$n"
    done
    generated=$folder/generated_$seed.whirl
    build/tools/mechanisms 12 "$seed" >"$generated" 2>/dev/null
    "$WHIRL" list --as table "$generated" | awk -F'\t' -v file="$generated" '$1 == "scene" { print file ":" $2 }'
    drawn 50 ''
    drawn 12 rest
    drawn 6 flies
} | awk -v seed="$seed" 'BEGIN { srand(seed) } { print rand(), $0 }' | sort -k1,1g | cut -d' ' -f2- >"$folder/scenes"

# One list of settings that every scene accepts, and one of settings that few scenes accept.
if [ "$number" = fixed ]; then
    printf '%s\n' '--step 1ms' '--step 0.3ms' | tee "$folder/few" >"$folder/most"
else
    cat >"$folder/most" <<'END'
--method rk4
--method nystroem5
--method nystroem4 --compensated
--method nystroem3
--angles lookup
--method nystroem5 --compensated
--compensated
--method nystroem4 --angles lookup
--method heun
--method rk38 --compensated
--method euler
--method semi-implicit-euler
--method nystroem3 --compensated --angles lookup
END
    cat >"$folder/few" <<'END'
--tables linear
--matrix exact
--tables cubic --compensated
--tables linear --cells 64 --method nystroem5
--matrix exact --compensated
--tables cubic --method nystroem4
--method leapfrog
--tables linear --cells 1024 --method nystroem3
--matrix rk4
--tables cubic --cells 32 --method rk4
END
fi
form=
[ "$number" != fixed ] || form='--number fixed'

# Prints a scene with the first setting of a list that it accepts, beginning after the setting that was taken last.
take() {
    settings=$(wc -l <"$1")
    more=1
    while [ "$more" -le "$settings" ]; do
        at=$((($3 + more - 1) % settings + 1))
        options=$(sed -n "${at}p" "$1")
        more=$((more + 1))
        if "$WHIRL" derive "$2" --as c $form --header "$folder/h" $options </dev/null >/dev/null 2>&1; then
            ! grep -q '_CONTACTS = [1-9]' "$folder/h" || return 1
            return 0
        fi
    done
    return 1
}
done=0
most=0
few=0
while [ "$done" -lt "$count" ]; do
    while read -r scene && [ "$done" -lt "$count" ]; do
        if take "$folder/few" "$scene" "$few"; then
            few=$at
            done=$((done + 1))
            echo "c${seed}_$done $scene $options"
        fi
        if [ "$number" != fixed ] && [ "$done" -lt "$count" ] && take "$folder/most" "$scene" "$most"; then
            most=$at
            done=$((done + 1))
            echo "c${seed}_$done $scene $options"
        fi
    done <"$folder/scenes"
done
