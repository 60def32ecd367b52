#!/bin/sh
# price_pages.sh: the blocks, charts and rows that `make price` writes. Blocks must follow from the committed rows,
# rows must be consistent, some rows are run and counted again, and planted errors must be found.
. "$(dirname "$0")/../checks.sh"
pages="docs/price.md docs/dev/fronts.md"
mkdir -p "$scratch/docs/dev"

# --- blocks ----------------------------------------------------------------------------------------------------------
blocks=0
for page in $pages; do
    cp "$page" "$scratch/$page"
    sh mk/curves/pages.sh docs/figures "$scratch/$page" 2>"$scratch/err" && diff "$page" "$scratch/$page" >>"$scratch/err"
    verdict $? "$page: blocks are what docs/figures/price*.csv give (make price)"
    blocks=$((blocks + $(grep -c '^<!-- price-table .*: begin -->$' "$page")))
done
[ "$blocks" -ge 15 ]
verdict $? "$blocks blocks" /dev/null
# changes digits in the blocks; the generator must restore every digit
sed '/price-table.*begin/,/price-table.*end/s/[0-9]k/9k/' docs/price.md >"$scratch/docs/price.md"
! cmp -s docs/price.md "$scratch/docs/price.md" && sh mk/curves/pages.sh docs/figures "$scratch/docs/price.md" &&
    cmp docs/price.md "$scratch/docs/price.md" >"$scratch/err"
verdict $? "what is edited by hand is renewed"
for block in 'chips nothing mps2-an386' 'chips rig_fixed nowhere' 'nix rig_fixed'; do
    printf '<!-- price-table %s: begin -->\n<!-- price-table %s: end -->\n' "$block" "$block" >"$scratch/bad.md"
    ! sh mk/curves/pages.sh docs/figures "$scratch/bad.md" >"$scratch/out" 2>"$scratch/err" && grep -q error "$scratch/err"
    verdict $? "refused: a block of '$block'"
done
! sh mk/curves/runs.sh "$scratch/runs" 1 no_such_scene >"$scratch/out" 2>"$scratch/err" && grep -q 'no scene no_such_scene' "$scratch/err"
verdict $? "refused: a scene that is not there"

# --- rows ------------------------------------------------------------------------------------------------------------
# A price is a step's figure divided by the step. A counted row has instructions, and cycles if its price is in cycles.
# Along a counted front, prices rise and errors fall.
cat >"$scratch/rows.awk" <<'AWK'
FNR == 1 { header(); next }
{
    plain_row()
    rows++
    a_step = field("price_of") == "cycles" ? field("cycles") : field("instructions")
    off = a_step / field("step_s") / field("per_s") - 1
    if (off > 1e-5 || off < -1e-5) { print FNR ": the price is not that of a step over the step"; bad = 1 }
    if (field("basis") !~ /^(counted|predicted)$/) { print FNR ": basis"; bad = 1 }
    name = field("scene")
    sub(/[+].*/, "", name) # removes the part that limits the motion
    if (field("run") !~ ("^whirl run " name " .*--step " field("step_s") " --until " field("until_s") "$")) {
        print FNR ": another line"; bad = 1
    }
    key = field("scene") " " field("board")
    if (field("basis") == "counted") {
        counted++
        if (!(field("instructions") > 0 && field("cycles") > field("instructions"))) { print FNR ": no count"; bad = 1 }
        if ((key in price) && !(price[key] <= field("per_s") + 0 && error[key] > field("error") + 0)) { print FNR ": no front"; bad = 1 }
    }
    price[key] = field("per_s") + 0
    error[key] = field("error") + 0
    if (!(key in seen)) { seen[key] = 1; n++ }
}
END { if (!bad && !failed) { print rows, counted, n } exit bad || rows < 200 || counted < 200 || n < 8 * 9 }
AWK
awk -F, -f mk/curves/words.awk -f "$scratch/rows.awk" docs/figures/price.csv >"$scratch/said" 2>&1
verdict $? "rows, counted ones, scenes on boards: $(tail -n 1 "$scratch/said")" "$scratch/said"

# --- the generator: fronts of random rows, compared with a comparison of all pairs; numbers in three digits ----------------
awk 'BEGIN {
    srand(20)
    for (scene = 1; scene <= 4; scene++) { for (board = 1; board <= 2; board++) { for (i = 0; i < 60; i++) {
        # values in steps of a tenth, so that some are equal
        printf "s%d,b%d,%.9g,x,1,1,1,cycles,%.6g,,1,%s,1,1,1,rk4,float,run\n", scene, board, 10 ^ (-int(rand() * 40) / 10), \
            10 ^ (int(rand() * 40) / 10), rand() < 0.5 ? "counted" : "predicted"
    } } }
}' | sort -t, -k1,1 -k2,2 -k9,9g -k3,3g >"$scratch/drawn"
awk -F, -v OFS=, -v counted=b2 -f mk/curves/front.awk "$scratch/drawn" | awk -F, '
    { group[NR] = $1 "," $2; e[NR] = $3; p[NR] = $9; may[NR] = $2 == "b1" || $12 == "counted"; on[NR] = $NF }
    END {
        for (i = 1; i <= NR; i++) {
            beaten = !may[i]
            for (k = 1; k <= NR; k++) {
                if (k != i && may[k] && group[k] == group[i] && p[k] <= p[i] && e[k] <= e[i]) {
                    beaten = beaten || p[k] < p[i] || e[k] < e[i] || k < i # of equal rows, the first is marked
                }
            }
            if (beaten == on[i]) { print i, e[i], p[i], on[i]; bad = 1 }
            marked += on[i]
        }
        exit bad || marked < 30 || NR != 480
    }' >"$scratch/err"
verdict $? "fronts of 480 drawn rows are what nothing beats"
awk -f mk/curves/decades.awk -f /dev/stdin >"$scratch/said" <<'AWK'
BEGIN {
    srand(7)
    for (i = 0; i < 2000; i++) {
        value = 10 ^ (rand() * 12)
        text = short(value)
        back = text + 0
        unit = substr(text, length(text))
        back *= unit == "k" ? 1e3 : unit == "M" ? 1e6 : unit == "G" ? 1e9 : unit == "T" ? 1e12 : 1
        off = back / value - 1
        digits = text
        gsub(/[^0-9]/, "", digits)
        if ((off > 0.00502 || off < -0.00502) && value > 100 || value >= 999.5 && length(digits) != 3) { print value, text; bad = 1 }
    }
    print short(999.4), short(999.6), short(9996), short(999600), step_words(0.0025), step_words(0.0005)
    exit bad
}
AWK
[ $? -eq 0 ] && [ "$(cat "$scratch/said")" = "999 1.00k 10.0k 1.00M 2.5 ms 500 us" ]
verdict $? "numbers in three digits" "$scratch/said"

# --- charts: a ring for each counted row -----------------------------------------------------------------------------
for scene in epicyclic_from_rest thomson_a thomson_a+4s rig_fixed; do
    svg=docs/figures/price_$(echo "$scene" | tr + _).svg
    rows=$(awk -F, -v scene="$scene" -f mk/curves/words.awk -f /dev/stdin docs/figures/price.csv <<'AWK'
FNR == 1 { header(); next }
field("scene") == scene && field("basis") == "counted" && field("error") >= 1e-10 { n++ }
END { print n }
AWK
    )
    rings=$(grep -o "<use xlink:href='#gpPt5' [^>]*color='rgb(  0,   0,   0)'" "$svg" | wc -l)
    cat $pages | grep -q "${svg#docs/}" && [ "$rings" -eq $((rows + 2)) ] # one more in each of the two legends
    verdict $? "$svg: $rings rings, $rows counted rows and two in the keys" "$svg"
done
if command -v gnuplot >/dev/null; then
    sh mk/curves/chart.sh "$scratch/fronts.svg" docs/figures/price.csv epicyclic_from_rest fronts mps2-an386 mps2-an385-m0 atmega328p \
        2>"$scratch/err" && [ "$(grep -c 'id="gnuplot_plot_' "$scratch/fronts.svg")" -eq 3 ] && grep -q 'price_fronts.svg' docs/price.md
    verdict $? "the chart of fronts is drawn, three boards"
fi

# --- rows run again from their command lines: errors compared with another reference -------------------------------------
COUNT=0 SOME=7 sh mk/curves/again.sh docs/figures/price.csv "$scratch/again" two_mass_relative rig_fixed spherical_flight >"$scratch/said" 2>&1
verdict $? "$(tail -n 1 "$scratch/said")" "$scratch/said"
awk -F, -v OFS=, 'NR > 1 { $4 *= 1.03 } { print }' docs/figures/price.csv >"$scratch/off.csv"
! COUNT=0 SOME=7 sh mk/curves/again.sh "$scratch/off.csv" "$scratch/again" rig_fixed >"$scratch/said" 2>&1 && grep -q differs "$scratch/said"
verdict $? "errors that are off by three hundredths are seen" "$scratch/said"

# --- some steps counted again ------------------------------------------------------------------------------------------
BOARDS=mps2-an386 SOME=5 sh mk/curves/again.sh docs/figures/price.csv "$scratch/again" rig_fixed >"$scratch/said" 2>&1
verdict $? "$(tail -n 1 "$scratch/said")" "$scratch/said"
awk -F, -v OFS=, 'NR > 1 { $11 *= 1.01 } { print }' docs/figures/price.csv >"$scratch/off.csv"
! BOARDS=mps2-an386 SOME=5 sh mk/curves/again.sh "$scratch/off.csv" "$scratch/again" rig_fixed >"$scratch/said" 2>&1 &&
    grep -q 'again [0-9]' "$scratch/said"
verdict $? "counts that are off by a hundredth are seen" "$scratch/said"
exit $failed
