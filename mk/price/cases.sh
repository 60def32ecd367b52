#!/bin/sh
# cases.sh FOLDER SEED GENERATED DRAWN: the cases whose steps are counted to fit prices by, a line "ID TARGET OPTIONS..."
# each, on standard output; files that it writes itself go to FOLDER. WHIRL is the program.
#
# Scenes: with SEED 1 every built-in one and pendulums of 1 to 10 links; with any
# seed so many GENERATED mechanisms (build/tools/mechanisms), which call every function of the language, and so many
# DRAWN ones (scenes.awk), three tenths as many of which something rests, and a tenth that flies. Settings: each scene with the default, and with
# two others, in turn, so that every setting meets scenes of every kind; a setting that whirl gets is one more word of the
# list below. What few scenes take (a step as one matrix, tables, leapfrog) is tried with each, and those that take it are
# counted so, too.
set -eu
here=$(dirname "$0")
folder=$1 seed=$2 generated=$3 drawn=$4
mkdir -p "$folder"

# of_kind KIND LETTER N: so many drawn scenes of this kind
of_kind() {
    awk -v n="$3" -v seed="$seed" -v "$1=1" -f "$here/scenes.awk" </dev/null >"$folder/$1_$seed.whirl"
    awk -v n="$3" -v name="$folder/$1_$seed.whirl:$2$seed" 'BEGIN { for (i = 1; i <= n; i++) { print name "_" i } }'
}

{
    [ "$seed" -ne 1 ] || {
        "$WHIRL" list --as table | awk -F'\t' '$1 == "scene" { print $2 }'
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
    few=$((drawn / 10 > 0 ? drawn / 10 : 1))
    of_kind rest q $((3 * few))
    of_kind flies p $few
} >"$folder/scenes"

# takes NAME OPTIONS...: a line "NAME SCENE" for each scene that can be written so
takes() {
    name=$1
    shift
    while read -r scene; do
        if "$WHIRL" derive "$scene" --as c "$@" </dev/null >/dev/null 2>&1; then echo "$name $scene"; fi
    done <"$folder/scenes"
}
{
    takes matrix --matrix exact
    takes tables --tables linear
    takes leapfrog --method leapfrog
} >"$folder/taken"

awk -v seed="$seed" '
    function put(options) { print "c" seed "_" ++id, $1 (options != "" ? " " options : "") }
    function fill(name, words) { count[name] = split(words, list, "|"); for (i in list) { setting[name, i] = list[i] } }
    function turn(name,    n) { n = count[name]; put(setting[name, turned[name]++ % n + 1]) }
    BEGIN {
        fill("", "--compensated|--method heun|--angles lookup|--method rk38|--method euler|--method nystroem4|" \
            "--method rk38 --compensated|--method semi-implicit-euler|--method heun --angles lookup|" \
            "--method nystroem3|--compensated --angles lookup|--method heun --compensated|" \
            "--method nystroem5|--method euler --compensated|--method rk38 --angles lookup|" \
            "--method nystroem4 --compensated|--method nystroem3 --angles lookup|" \
            "--method nystroem4 --angles lookup|--method nystroem5 --compensated")
        fill("matrix", "--matrix exact --compensated|--matrix rk4|--matrix exact --compensated")
        fill("tables", "--tables linear --method heun|--tables cubic --compensated|--tables linear --cells 1024|" \
            "--tables cubic --method nystroem4|--tables linear --method euler|" \
            "--tables cubic --cells 32 --method rk38|--tables linear --compensated|" \
            "--tables linear --cells 64 --method nystroem5|--tables cubic --method heun|" \
            "--tables linear --method nystroem3")
        fill("leapfrog", "--method leapfrog --compensated")
    }
    FILENAME ~ /taken$/ { taken[$1, $2] = 1; next }
    {
        put(""); turn(""); turn("")
        if (("matrix", $1) in taken) { put("--matrix exact"); turn("matrix") }
        if (("tables", $1) in taken) { put("--tables linear"); put("--tables cubic"); turn("tables"); turn("tables") }
        if (("leapfrog", $1) in taken) { put("--method leapfrog"); turn("leapfrog") }
    }' "$folder/taken" "$folder/scenes"
