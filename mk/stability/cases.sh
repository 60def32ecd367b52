#!/bin/sh
# cases.sh [WHIRL]: draws the plots of docs/hard_cases.md anew, from the scenes of docs/hard and the descriptions beside this
# file, into docs/figures/hard. The numbers behind them stay in build/figures/hard/data.
set -eu
whirl=${1:-build/whirl}
here=$(dirname "$0")
out=build/figures/hard
command -v gnuplot >/dev/null || { echo "cases.sh: gnuplot is missing; 'make deps' installs it" >&2; exit 1; }
rm -rf "$out"
mkdir -p "$out"
# What a run says of the step, the range or the angle is what the page is about.
sh "$here/../figures/figures.sh" "$whirl" "$out" "$here"/*.fig 2>"$out.said" || { cat "$out.said" >&2; exit 1; }
mkdir -p docs/figures/hard
for fig in "$here"/*.fig; do
    cp "$out/$(basename "$fig" .fig).svg" docs/figures/hard/
done
