#!/bin/sh
# curves.sh OUT ROWS.csv SCENE... -- BOARD... -- COUNTED BOARD...: prices and fronts, from the output of runs.sh in OUT.
#
# On boards after the second "--", the front is counted down to the first error within FINEST. A step of each setting
# without a predicted price is counted, too. Rows:
#
#   scene,board,error,component,records,step_s,until_s,price_of,per_s,instructions,cycles,basis,flash,ram,stack,method,
#   number,run,front
#
# per_s: cycles per simulated second, or instructions if there is no count of cycles. basis: `counted`; `predicted`; or
# `counted at S`, if the counted step had S seconds. Instructions and cycles are per step; unknown values are empty.
set -eu
here=$(dirname "$0")
out=$1
csv=$2
shift 2
work=$out/counted
rm -rf "$work"
mkdir -p "$work"
scenes=
files=
until [ "$1" = -- ]; do
    # without a reference, or without a setting that reaches the smallest error, there is no file
    [ ! -s "$out/$1.csv" ] || scenes="$scenes $out/$1.csv"
    shift
done
shift
until [ "$1" = -- ]; do
    for scene in $scenes; do
        [ ! -s "${scene%.csv}@$1.csv" ] || files="$files ${scene%.csv}@$1.csv"
    done
    shift
done
shift
counted=$*
: "${FINEST:=1e-9}"

# prices MORE...: prints the rows on every board
prices() {
    awk -F, -v OFS=, -v out="$out" -f "$here/words.awk" -f "$here/priced.awk" "$@" $files $scenes
}
# sorted: by scene, board, price, error
sorted() { sort -t, -k1,1 -k2,2 -k9,9g -k3,3g; }

echo "scene,board,instructions,cycles,obtained,flash,ram,stack,compiler,run" >"$work/settings.csv"
for board in $counted; do
    prices -v missing="$board" | sort >"$work/cases"
    [ ! -s "$work/cases" ] || sh "$here/count.sh" "$board" "$work/out" <"$work/cases" | sed 1d >>"$work/settings.csv"
done
prices "$work/settings.csv" | sorted >"$work/rows"
awk -F, -v OFS=, -f "$here/front.awk" "$work/rows" >"$work/fronts"
for board in $counted; do
    awk -F, -v board="$board" -v finest="$FINEST" '
        $2 == board && $NF == 1 && !($1 in ended) { print $1 "," $18; if ($3 <= finest) { ended[$1] = 1 } }' "$work/fronts" |
        sh "$here/count.sh" "$board" "$work/out" >"$work/counted_$board.csv"
done
{
    echo "scene,board,error,component,records,step_s,until_s,price_of,per_s,instructions,cycles,basis,flash,ram,stack,method,number,run,front"
    awk -F, -v OFS=, -f "$here/words.awk" -f "$here/recount.awk" $(find "$work" -name 'counted_*.csv') "$work/rows" |
        sorted | awk -F, -v OFS=, -v counted="$counted" -f "$here/front.awk"
} >"$csv.new"
mv "$csv.new" "$csv"
