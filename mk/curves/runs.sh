#!/bin/sh
# runs.sh OUT EFFORT SCENE... [-- BOARD...]: runs `whirl price` for `make price`: error against price.
#
# SCENE+4s is the scene until 4 s: `whirl price SCENE --horizon 4s`.
#
# WHIRL: the program. JOBS: number of jobs at a time (2).
#
# Writes OUT/SCENE.csv and OUT/SCENE.txt: every setting with every step on a Cortex-M4F. All boards compute the same bits,
# so these errors are valid for all boards. For each BOARD, also writes OUT/SCENE@BOARD.csv and .txt: the price of a step
# with each setting, from few steps over a tenth of the motion; the errors in these files are meaningless.
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
    # Exit status 1: there is no reference, or no setting with a price. Then there is no file; the text says which.
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
