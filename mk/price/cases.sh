#!/bin/sh
# cases.sh FOLDER SEED GENERATED DRAWN: the cases whose steps are counted to fit prices by, a line "ID TARGET OPTIONS..."
# each, on standard output; files that it writes itself go to FOLDER. WHIRL is the program.
#
# Scenes: with SEED 1 every built-in one, the mechanisms of tests/mechanisms and pendulums of 1 to 10 links; with any
# seed so many GENERATED mechanisms (build/tools/mechanisms), which call every function of the language, and so many
# DRAWN ones (scenes.awk). Settings: each scene with the default, and with two others, in turn, so that every setting
# meets scenes of every kind. A setting that whirl gets is one more word of the list below.
set -eu
here=$(dirname "$0")
folder=$1 seed=$2 generated=$3 drawn=$4
mkdir -p "$folder"

{
    [ "$seed" -ne 1 ] || {
        "$WHIRL" list --as table | awk -F'\t' '$1 == "scene" { print $2 }'
        ls tests/mechanisms/*.whirl
        for n in 1 2 3 4 5 6 7 8 9 10; do
            awk -v n=$n -v scene=1 -f "$here/links.awk" </dev/null >"$folder/links_$n.whirl"
            echo "$folder/links_$n.whirl:swing_$n"
        done
    }
    build/tools/mechanisms "$generated" "$seed" >"$folder/generated_$seed.whirl" 2>/dev/null
    "$WHIRL" list --as table "$folder/generated_$seed.whirl" |
        awk -F'\t' -v file="$folder/generated_$seed.whirl" '$1 == "scene" { print file ":" $2 }'
    awk -v n="$drawn" -v seed="$seed" -f "$here/scenes.awk" </dev/null >"$folder/drawn_$seed.whirl"
    awk -v n="$drawn" -v seed="$seed" -v file="$folder/drawn_$seed.whirl" \
        'BEGIN { for (i = 1; i <= n; i++) { print file ":r" seed "_" i } }'
} | awk -v seed="$seed" '
    BEGIN {
        n = split("--compensated|--method heun|--angles lookup|--method rk38|--method euler|" \
            "--method rk38 --compensated|--method semi-implicit-euler|--method heun --angles lookup|" \
            "--compensated --angles lookup|--method heun --compensated|--method euler --compensated|" \
            "--method rk38 --angles lookup", setting, "|")
        for (i = 1; i <= n; i++) { more[i] = setting[i] }
    }
    {
        print "c" seed "_" ++id, $1
        print "c" seed "_" ++id, $1, more[(2 * NR) % n + 1]
        print "c" seed "_" ++id, $1, more[(2 * NR + 1) % n + 1]
    }'
