#!/bin/sh
# price_predicts.sh: what host/price says of steps, against counted ones: mechanisms drawn anew (none of those that the
# figures were fitted to), on the emulated board of `make test`; with WHIRL_FULL more. (All boards: `make price-check`.)
. "$(dirname "$0")/../checks.sh"

fit=$(dirname "$whirl")/tools/price_fit
if ! command -v arm-none-eabi-gcc >/dev/null 2>&1 || ! command -v qemu-system-arm >/dev/null 2>&1; then
    echo "ok - (no emulated board here)"
    exit 0
fi

mkdir -p "$scratch/cost"
awk -v n=12 -v seed=77 -f mk/price/scenes.awk </dev/null >"$scratch/cost/drawn.whirl"
# Every setting that has a price: methods of all kinds, compensated, looked up, as one matrix, with tables.
while read -r scene options; do
    i=$((${i:-0} + 1))
    echo "t$i $scratch/cost/drawn.whirl:r77_$scene $options"
done >"$scratch/cost/cases" <<'END'
1
1 --method nystroem4 --angles lookup
2 --method heun
3 --angles lookup
4 --compensated
5 --method rk38
6 --matrix exact
6 --matrix rk4
7 --tables linear
7 --tables cubic --compensated
8 --matrix exact --compensated
8 --method nystroem4
9 --method heun --compensated
9
10 --method nystroem3
11 --tables linear --cells 64
11 --tables cubic --method nystroem4
11 --compensated --angles lookup
12 --method nystroem5
12 --method euler --compensated
END
# every other one, and one that looks up; each of the settings by itself stands among them
[ -n "${WHIRL_FULL:-}" ] || sed -i -n '1~2p; 4p' "$scratch/cost/cases"
cases=$(wc -l <"$scratch/cost/cases")
[ "$cases" -ge 11 ]
verdict $? "$cases cases"

# The rows name what they were derived from, so files of a temporary folder do.
make -s B=build BOARD=mps2-an386 price-measure-board PRICE_OUT="$scratch/cost" STEPS=20 WORST=0 >"$scratch/err" 2>&1
[ "$(grep -c ',mps2-an386,' "$scratch/cost/rows.csv")" -eq "$cases" ]
verdict $? "steps of $cases scenes and settings counted on the emulated board"

"$fit" --check "$scratch/cost/rows.csv" >"$scratch/told" 2>&1
verdict $? "instructions, cycles, flash, RAM and stack within the bounds that were promised" "$scratch/told"
awk '/^instructions:/ { for (i = 1; i <= NF; i++) { if ($i == "%" && !first) { first = $(i - 1) } } found = $2 }
    END { exit !(found >= '"$cases"' && first > 0 && first <= 10) }' "$scratch/told"
verdict $? "the middle one's instructions within 10 %" "$scratch/told"

# The test's own eye: a row whose count is half of the truth is beyond its bound.
awk -F, 'BEGIN { OFS = "," } $1 != "commit" { $8 = $8 / 2 } { print }' "$scratch/cost/rows.csv" >"$scratch/cost/halved.csv"
! "$fit" --check "$scratch/cost/halved.csv" >"$scratch/told" 2>&1 && grep -q 'not within its bound' "$scratch/told"
verdict $? "half of a count would be seen" "$scratch/told"

# The same of fixed point, which has figures and features of its own.
mkdir -p "$scratch/fixed"
drawn=9
[ -z "${WHIRL_FULL:-}" ] || drawn=18
fit_fixed=$(dirname "$whirl")/tools/price_fit_fixed
WHIRL=$whirl sh mk/price/cases_fixed.sh "$scratch/fixed" 78 "$drawn" >"$scratch/fixed/cases"
cases=$(wc -l <"$scratch/fixed/cases")
make -s B=build BOARD=mps2-an386 price-measure-board NUMBERS=fixed PRICE_OUT="$scratch/fixed" STEPS=20 >"$scratch/err" 2>&1
[ "$cases" -ge 8 ] && [ "$(grep -c ',mps2-an386,.*,fixed,' "$scratch/fixed/rows.csv")" -eq "$cases" ]
verdict $? "steps in fixed point of $cases scenes counted on the emulated board"
"$fit_fixed" --check "$scratch/fixed/rows.csv" >"$scratch/told" 2>&1
verdict $? "instructions, cycles, flash, RAM and stack within their bounds" "$scratch/told"
awk '/^instructions:/ { found = $2; off = $4 } END { exit !(found >= 8 && off <= 10) }' "$scratch/told"
verdict $? "the middle one's instructions within 10 %" "$scratch/told"
awk -F, 'BEGIN { OFS = "," } $1 != "commit" { $8 = $8 / 3 } { print }' "$scratch/fixed/rows.csv" >"$scratch/fixed/third.csv"
! "$fit_fixed" --check "$scratch/fixed/third.csv" >"$scratch/told" 2>&1 && grep -q 'not within its bound' "$scratch/told"
verdict $? "a third of a count would be seen" "$scratch/told"

# A user's own file and option, by the one command.
sh mk/price/measure_one.sh mps2-an386 float "$scratch/cost/drawn.whirl:r77_2" --compensated >"$scratch/row" 2>"$scratch/err" &&
    [ "$(awk -F, 'END { print NR, $4, $6, $7, ($8 > 50) }' "$scratch/row")" = "2 mps2-an386 float rk4-compensated 1" ]
verdict $? "measure_one.sh measures a file's scene"
sh mk/price/measure_one.sh mps2-an386 fixed "$(awk 'NR == 1 { print $2 }' "$scratch/fixed/cases")" --until 1s >"$scratch/row" 2>"$scratch/err" &&
    [ "$(awk -F, 'END { print NR, $4, $6, $7, ($8 > 50), ($15 > 50) }' "$scratch/row")" = "2 mps2-an386 fixed rk4-until:1s 1 1" ]
verdict $? "and in fixed point"
sh mk/price/measure_one.sh nowhere float thomson_a >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'there is no boards/nowhere' "$scratch/err"
verdict $? "and refuses a board that there is not"
sh mk/price/measure_one.sh mps2-an386 float "$scratch/none.whirl" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && [ ! -s "$scratch/out" ] && [ -s "$scratch/err" ]
verdict $? "and a file that there is not"
exit $failed
