#!/bin/sh
# chart.sh OUT.svg ROWS.csv SCENE boards|fronts BOARD...: error against price, drawn by gnuplot (chart.awk).
set -eu
here=$(dirname "$0")
svg=$1 rows=$2 scene=$3 kind=$4
shift 4
height=460
[ "$kind" = fronts ] || height=$((60 + 400 * $#))
mkdir -p "$(dirname "$svg")"
awk -F, -v scene="$scene" -v "$kind=$*" -f "$here/words.awk" -f "$here/chart.awk" "$rows" >"${svg%.svg}.gp"
LC_ALL=C.UTF-8 gnuplot -e "set terminal svg size 900,$height dynamic font 'sans-serif,14' background rgb 'white'; set output '$svg'" \
    "${svg%.svg}.gp"
