#!/bin/sh
# measure.sh: what `whirl choose --measure` promises is what the line that it prints counts; mechanisms drawn anew, on the
# emulated board of `make test`.
. "$(dirname "$0")/../checks.sh"

if ! command -v arm-none-eabi-gcc >/dev/null 2>&1 || ! command -v qemu-system-arm >/dev/null 2>&1; then
    echo "ok - (no emulated board here)"
    exit 0
fi

choose() { # OPTION...: to $scratch/out
    "$whirl" choose "$@" --effort 0.01 --quiet >"$scratch/out" 2>"$scratch/err"
}

# figure WORD: the number behind it
figure() { sed -n "s/^  $1  *\([0-9.e+]*\) .*/\1/p" "$scratch/out"; }

awk -v n=3 -v seed=23 -f mk/price/scenes.awk </dev/null >"$scratch/drawn.whirl"
for scene in r23_1 r23_3; do
    choose "$scratch/drawn.whirl:$scene" --error 1e-2 --measure
    code=$?
    if [ $code -eq 1 ] && grep -q '^nothing fits' "$scratch/out"; then
        echo "ok - $scene: nothing fits, and nothing is promised"
        continue
    fi
    [ $code -eq 0 ] && grep -q 'flash .*measured' "$scratch/out" && ! grep -q 'predicted' "$scratch/out"
    verdict $? "$scene: what is chosen has no predicted figure" "$scratch/out"
    line=$(sed -n 's/^counted by  //p' "$scratch/out")
    sh -c "$line" 2>"$scratch/err" | tail -n 1 >"$scratch/row"
    awk -F, -v cycles="$(figure 'the longest')" -v flash="$(figure flash)" -v ram="$(figure RAM)" -v stack="$(figure stack)" \
        '{ ok = $(NF - 4) + 0 == cycles && $(NF - 2) == flash && $(NF - 1) == ram && $NF == stack } END { exit !ok }' "$scratch/row"
    verdict $? "$scene: cycles, flash, RAM and stack are those that the printed line counts" "$scratch/row"
    cp "$scratch/out" "$scratch/measured"
    choose "$scratch/drawn.whirl:$scene" --error 1e-2
    [ $? -eq 0 ] && grep -q 'predicted' "$scratch/out"
    verdict $? "$scene: without --measure all is predicted" "$scratch/out"
done

# A limit that lies between what is counted and the most that is promised of it is kept by what is counted.
most=$(sed -n 's/^  flash .* at most \([0-9]*\).*/\1/p' "$scratch/out")
counted=$(sed -n 's/^  flash  *\([0-9]*\) .*/\1/p' "$scratch/measured")
if [ "${most:-0}" -gt "${counted:-0}" ]; then
    choose "$scratch/drawn.whirl:r23_3" --error 1e-2 --measure --flash "$counted"
    [ $? -eq 0 ] && [ "$(figure flash)" -le "$counted" ]
    verdict $? "flash that is there is used" "$scratch/out"
fi

# A table's front is counted; one of its rows again, from the line that derives it.
"$whirl" price "$scratch/drawn.whirl:r23_1" --effort 0.001 --measure --csv "$scratch/rows.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && awk -F, 'NR > 1 && $1 == 1 { n++; bad += $9 == "predicted" || $20 == "predicted" } END { exit bad || n < 3 }' "$scratch/rows.csv"
verdict $? "nothing on the front is predicted" "$scratch/rows.csv"
awk -F, '$1 == 1 && $15 == "float" { cycles = $7 * $13; line = $NF } END { print cycles; print line }' "$scratch/rows.csv" >"$scratch/last"
line=$(sed -n '2s/^whirl derive \(.*\) --until .*/sh mk\/price\/measure_one.sh mps2-an386 float \1/p' "$scratch/last")
sh -c "$line" 2>"$scratch/err" | tail -n 1 >"$scratch/row"
awk -F, -v row="$(head -n 1 "$scratch/last")" '{ off = $(NF - 5) / row - 1; exit !(off < 1e-6 && off > -1e-6) }' "$scratch/row"
verdict $? "and its last row in float is what its line counts: $line" "$scratch/row"

MAKEFLAGS="BOARD_CC=no-such-compiler" choose "$scratch/drawn.whirl:r23_1" --error 1e-2 --measure
[ $? -eq 2 ] && grep -q 'a tool is missing that counts on mps2-an386' "$scratch/err" && [ ! -s "$scratch/out" ]
verdict $? "a tool that is missing: exit status 2, and who says which" "$scratch/err"
program=$(cd "$(dirname "$whirl")" && pwd)/whirl
(cd "$scratch" && "$program" choose drawn.whirl:r23_1 --error 1e-2 --measure >"$scratch/out" 2>"$scratch/err")
[ $? -eq 2 ] && grep -q "counts in Whirl's source tree" "$scratch/err"
verdict $? "outside of the source tree: exit status 2" "$scratch/err"

exit $failed
