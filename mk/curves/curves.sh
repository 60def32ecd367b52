#!/bin/sh
# curves.sh OUT ROWS.csv SCENE... -- BOARD... -- COUNTED BOARD...: prices and fronts, from what runs.sh has left in OUT.
#
# On boards behind the second -- the front is counted down to the first error within FINEST, and so is a step of each setting that has no predicted price. Rows:
#
#   scene,board,error,component,records,step_s,until_s,price_of,per_s,instructions,cycles,basis,flash,ram,stack,method,
#   number,run,front
#
# per_s: cycles a simulated second, or instructions where nobody counts cycles. basis: `counted`; `predicted`; `counted at S`,
# a step of that setting of S seconds was. Instructions and cycles are those of a step, what is not known is empty.
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
    # without a reference or a setting within the values themselves there is none
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

# prices MORE...: the rows on every board
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
