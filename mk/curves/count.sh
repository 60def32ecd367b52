#!/bin/sh
# count.sh BOARD OUT <CASES >ROWS: counts the steps of cases on BOARD, as mk/price/measure.sh does.
#
# CASES has lines "NAME,whirl run SCENE ... --step S --until U". NAME is SCENE, or SCENE+4s for a part of its motion. ROWS
# has a header. The counted steps are more than a motion with coarse steps has. If they do not stay finite, the case is
# reported on standard error and omitted. Any other case that cannot be counted is an error: exit status 1.
set -eu
here=$(dirname "$0")
board=$1
out=$2
rm -rf "$out"
mkdir -p "$out"
sort -u >"$out/all"
echo "scene,board,instructions,cycles,obtained,flash,ram,stack,compiler,run"
numbers=$(awk -F, -f "$here/words.awk" -f /dev/stdin "$out/all" <<'AWK' | sort -u
{ print number_of($2) }
AWK
)
for number in $numbers; do
    # ID SCENE OPTIONS, and the command of the same line. All IDs have the same length, because an image contains them
    awk -F, -v number="$number" -v out="$out" -f "$here/words.awk" -f /dev/stdin "$out/all" <<'AWK'
number_of($2) == number {
    printf "c%04d %s %s\n", ++n, scene_of($2), derive_options($2) > (out "/cases_" number)
    print $0 > (out "/lines_" number)
}
AWK
    [ -s "$out/cases_$number" ] || continue
    if ! nice -n 5 make -s BOARD="$board" price-measure-board PRICE_CASES="$out/cases_$number" \
        PRICE_CSV="$out/rows_$number" PRICE_OUT="$out/$number" NUMBERS="$number" >"$out/log_$number" 2>&1; then
        sed -n 's/^measure.sh: \(c[0-9]*\): the state diverged.*/\1/p' "$out/log_$number" >"$out/diverged"
        rows=$(sed 1d "$out/rows_$number" | wc -l)
        if [ $(($(wc -l <"$out/diverged") + rows)) -ne "$(wc -l <"$out/lines_$number")" ]; then
            grep -E 'measure.sh|error' "$out/log_$number" | head -n 5 >&2
            exit 1
        fi
        awk 'FNR == NR { left[substr($1, 2) + 0] = 1; next }
            !(FNR in left) { print; next } { print "count.sh: diverges when counted: " $0 >"/dev/stderr" }' \
            "$out/diverged" "$out/lines_$number" >"$out/lines_left"
        mv "$out/lines_left" "$out/lines_$number"
    fi
    sed 1d "$out/rows_$number" | paste -d, "$out/lines_$number" - |
        awk -F, '{ split($2, word, " "); if ($7 != word[3]) { exit 1 } print $1, $6, $10, $12, $14, $15, $16, $17, $4, $2 }' OFS=,
    rm -rf "${out:?}/$number"
done
