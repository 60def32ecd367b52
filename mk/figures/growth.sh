#!/bin/sh
# growth.sh WHIRL SCENE CHANGE SIZE OPTIONS...: the growth of a small change of the start. Runs SCENE twice, once with
# `--start CHANGE`, and prints `time,growth`: the largest difference of any coordinate or rate, divided by SIZE.
set -eu
whirl=$1 scene=$2 change=$3 size=$4
shift 4
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$whirl" run "$scene" "$@" --quiet --columns "$scratch/one"
"$whirl" run "$scene" --start "$change" "$@" --quiet --columns "$scratch/other"
paste -d ' ' "$scratch/one" "$scratch/other" | awk -v size="$size" '
    NR > 1 && /^%/ { next }
    NR == 1 { # a percent sign, the names, and both once more
        for (i = 3; i <= NF / 2; i++) {
            if ($i ~ /^der\(/) last = i - 1
        }
        print "time,growth"
        next
    }
    {
        worst = 0
        for (i = 2; i <= last; i++) {
            d = $i - $(i + NF / 2)
            if (d < 0) d = -d
            if (d > worst) worst = d
        }
        printf "%s,%.6g\n", $1, worst / size
    }'
