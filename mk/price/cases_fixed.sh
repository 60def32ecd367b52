#!/bin/sh
# cases_fixed.sh FOLDER SEED DRAWN: the cases whose steps in fixed point are counted to fit prices by (`make price-rows-fixed`),
# as cases.sh has them of reals: a line "ID TARGET OPTIONS..." each. WHIRL is the program.
#
# With SEED 1 every built-in scene and pendulums of 1 to 3 links; with any seed so many DRAWN mechanisms (scenes.awk). Of
# these all that have a step in fixed point. A setting more there is not: every third is counted by another step as well, whose
# binary points are others.
set -eu
here=$(dirname "$0")
folder=$1 seed=$2 drawn=$3
mkdir -p "$folder"
{
    [ "$seed" -ne 1 ] || {
        "$WHIRL" list --as table | awk -F'\t' '$1 == "scene" { print $2 }'
        for n in 1 2 3; do
            awk -v n=$n -v scene=1 -f "$here/links.awk" </dev/null >"$folder/links_$n.whirl"
            echo "$folder/links_$n.whirl:swing_$n"
        done
    }
    awk -v n="$drawn" -v seed="$seed" -f "$here/scenes.awk" </dev/null >"$folder/drawn_$seed.whirl"
    awk -v n="$drawn" -v seed="$seed" -v file="$folder/drawn_$seed.whirl" \
        'BEGIN { for (i = 1; i <= n; i++) { print file ":r" seed "_" i } }'
} >"$folder/scenes"
count=0
while read -r scene; do
    count=$((count + 1))
    for options in "" "--step 0.3ms"; do
        [ -z "$options" ] || [ $((count % 3)) -eq 0 ] || continue
        # shellcheck disable=SC2086 # words without blanks
        if "$WHIRL" derive "$scene" --as c --number fixed $options </dev/null >/dev/null 2>&1; then
            echo "f${seed}_$count${options:+s} $scene $options"
        fi
    done
done <"$folder/scenes"
