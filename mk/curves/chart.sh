#!/bin/sh
# chart.sh OUT.svg ROWS.csv SCENE boards|fronts BOARD...: draws error against price with gnuplot (chart.awk).
set -eu
here=$(dirname "$0")
svg=$1 rows=$2 scene=$3 kind=$4
shift 4
height=460
[ "$kind" = fronts ] || height=$((60 + 400 * $#))
mkdir -p "$(dirname "$svg")"
# The palette of all pictures: a colour and a shape for each method, in the order of core/method.h.
colours=$(sed -n '/PALETTE_LINE_ROWS/,/^$/s/.*X("\(#[0-9a-f]*\)").*/\1/p' host/io/gnuplot.h)
shapes=$(sed -n 's/.*int points\[\] = {\(.*\)};/\1/p' host/io/gnuplot.h | tr -d ,)
methods=$(sed -n 's/.*X(WH_[A-Z0-9_]*, "\([a-z0-9-]*\)".*/\1/p' core/method.h)
words=$(sed -n "s/^scene ${scene%+*} \"\([^\"]*\)\".*/\1/p" core/models/*.whirl)
title="Error against price: ${scene%+*}, $words"
awk -F, -v title="$title" \
    -v colours="$(echo $colours)" -v shapes="$shapes" -v methods="$(echo $methods)" -v scene="$scene" -v "$kind=$*" -f "$here/words.awk" -f "$here/chart.awk" "$rows" >"${svg%.svg}.gp"
# Adds a title, an alternative text and the style for dark pages, as `whirl plot` does.
dark=$(grep -m 1 '^<style>@media' docs/figures/fig51.svg)
[ "$kind" = fronts ] && what="The least error for its price on each of: $*." || what="The front and the settings with the most points on it, a panel each for: $*."
LC_ALL=C.UTF-8 gnuplot -e "set terminal svg size 900,$height dynamic font 'sans-serif,14' background rgb 'white'; set output '$svg'" \
    "${svg%.svg}.gp"
sed -i -e 's|^<svg|<svg role="img"|' -e "s|^<title>Gnuplot</title>|<title>$title</title>|" \
    -e "s|^<desc>.*|<desc>$what</desc>\\n${dark%\}</style>}[color='rgb(  0,   0,   0)']{color:#e6edf3}}</style>|" "$svg"
