#!/bin/sh
# runs.sh OUT EFFORT SCENE... [-- BOARD...]: error against price by `whirl price`, for `make price`.
#
# SCENE+4s is the scene looked at until 4 s: `whirl price SCENE --horizon 4s`.
#
# WHIRL  the program; JOBS  so many at a time (2)
#
# Writes OUT/SCENE.csv and OUT/SCENE.txt, every setting by every step on a Cortex-M4F: the errors are those of all boards,
# which compute the same bits. And for each BOARD OUT/SCENE@BOARD.csv and .txt: what a step of each setting takes there,
# from a tenth of the motion by few steps, whose errors say nothing.
set -eu
: "${WHIRL:=build/whirl}" "${JOBS:=2}"
if [ "$1" = one ]; then
    name=$2 effort=$3 until_s=$4
    what=${name##*/}
    board=${what#*@}
    scene=${what%@*}
    set -- --effort "$effort" --method all
    if [ "$board" != "$what" ]; then
        set -- --effort 1e7 --method all --horizon "$until_s" --board "$board"
    elif [ "$scene" != "${scene%+*}" ]; then
        set -- "$@" --horizon "${scene#*+}"
    fi
    # Exit status 1: no reference, or no setting with a price; the text beside it says which, and there is no file.
    nice -n 5 "$WHIRL" price "${scene%+*}" "$@" --csv "$name.csv" >"$name.txt" 2>&1 || [ $? -eq 1 ]
    exit 0
fi
out=$1 effort=$2
shift 2
mkdir -p "$out"
"$WHIRL" list --as table | tr -d '\r' >"$out/scenes"
scenes=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    awk -F '\t' -v name="${1%+*}" '$1 == "scene" && $2 == name { found = 1 } END { exit !found }' "$out/scenes" || {
        echo "runs.sh: error: there is no scene ${1%+*}" >&2
        exit 2
    }
    scenes="$scenes $1"
    shift
done
[ $# -eq 0 ] || shift
for scene in $scenes; do
    rm -f "$out/$scene.csv" "$out/$scene"@*.csv
    awk -F '\t' -v effort="$effort" -v out="$out" -v boards="$*" -v name="$scene" '
        BEGIN { own = name; sub(/[+].*/, "", own); until_s = index(name, "+") ? substr(name, length(own) + 2) : "" }
        $1 == "scene" && $2 == own {
            until_s = until_s == "" ? $10 : until_s
            print out "/" name, effort, until_s
            n = split(boards, board, " ")
            for (i = 1; i <= n; i++) { print out "/" name "@" board[i], effort, until_s / 10 }
        }' "$out/scenes"
done | xargs -P "$JOBS" -L 1 sh "$0" one
