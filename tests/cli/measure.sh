#!/bin/sh
# measure.sh: if `whirl choose` can count, it promises what its printed command line counts. For random mechanisms and, with
# WHIRL_FULL, more of them and built-in scenes with contacts; on the emulated board of `make test`.
. "$(dirname "$0")/../checks.sh"

if ! command -v arm-none-eabi-gcc >/dev/null 2>&1 || ! command -v qemu-system-arm >/dev/null 2>&1; then
    echo "ok - (no emulated board here)"
    exit 0
fi

choose() { # choose OPTION...: writes the answer to $scratch/out
    "$whirl" choose "$@" --effort 4e7 --quiet >"$scratch/out" 2>"$scratch/err"
}

# figure WORD: prints the number after the word, in the first of the two answers
figure() { sed -n "s/^  $1  *\([0-9.e+]*\) .*/\1/p" "$scratch/out" | head -n 1; }
# step: prints the step of the answer
step() { sed -n 's/^fewest cycles .*--step //p' "$scratch/out"; }

# counted: runs the printed line, and writes the row that it counts to $scratch/row
counted() { sh -c "$(sed -n 's/^  to count    //p' "$scratch/out" | head -n 1)" 2>"$scratch/err" | tail -n 1 >"$scratch/row"; }

awk -v n=3 -v seed=23 -f mk/price/scenes.awk </dev/null >"$scratch/drawn.whirl"
for scene in ${WHIRL_FULL:+r23_1 r23_2} r23_3; do
    choose "$scratch/drawn.whirl:$scene" --error 1e-2
    code=$?
    if [ $code -eq 1 ] && grep -q '^no setting fits' "$scratch/out"; then
        echo "ok - $scene: nothing fits, and nothing is promised"
        continue
    fi
    [ $code -eq 0 ] && grep -q '^  prices  *counted' "$scratch/out" && grep -q 'flash .*measured' "$scratch/out" &&
        ! grep -q 'predicted' "$scratch/out"
    verdict $? "$scene: what is chosen has no predicted figure" "$scratch/out"
    counted
    awk -F, -v cycles="$(figure 'the longest')" -v flash="$(figure flash)" -v ram="$(figure RAM)" -v stack="$(figure stack)" \
        '{ ok = $(NF - 4) + 0 == cycles && $(NF - 2) == flash && $(NF - 1) == ram && $NF == stack } END { exit !ok }' "$scratch/row"
    verdict $? "$scene: cycles, flash, RAM and stack are those that the printed line counts" "$scratch/row"
    cp "$scratch/out" "$scratch/measured"
    choose "$scratch/drawn.whirl:$scene" --error 1e-2 --predict
    [ $? -eq 0 ] && grep -q '^  flash .*predicted' "$scratch/out" && grep -q '^  prices  *predicted, as --predict asks' "$scratch/out"
    verdict $? "$scene: with --predict all is predicted" "$scratch/out"
done

# A limit equal to the counted flash is met.
flash=$(sed -n 's/^  flash  *\([0-9]*\) .*/\1/p' "$scratch/measured" | head -n 1)
choose "$scratch/drawn.whirl:r23_3" --error 1e-2 --flash "$flash"
[ $? -eq 0 ] && [ "$(figure flash)" -le "$flash" ]
verdict $? "flash that is there is used" "$scratch/out"

# --- contacts: every step of the run is counted ----------------------------------------------------------------------
# with_contacts FILE...: prints the names of scenes with contacts
with_contacts() {
    "$whirl" list --as table core/models/*.whirl | awk -F '\t' '
        $8 ~ /contacts/ && $1 != "scene" { has[$3, $2] = 1 }
        $1 == "scene" { n = split($7, on, ","); for (i = 1; i <= n; i++) { if (($3, on[i]) in has) { print $2; next } }
            if (($3, $3) in has || $8 ~ /contacts/) { print $2 } }'
}
# field N: prints a field of the row that the printed line counts
field() { awk -F, -v n="$1" '{ printf "%.9g", $n }' "$scratch/row"; }

# A step without an event enters the mean. The mean is at most the longest step, and that is at most the declared one.
contacts() { # SCENE HORIZON RATE
    choose "$1" --error 0.1 --horizon "$2" --rate "$3" --clock 1000MHz
    if [ $? -eq 1 ] && grep -qE 'nothing moves|no reliable reference' "$scratch/out" "$scratch/err"; then
        echo "ok - $1: no reference, and nothing is promised"
        return
    fi
    grep -q '^fewest cycles' "$scratch/out" && ! grep -q 'predicted' "$scratch/out"
    verdict $? "$1: an answer, counted" "$scratch/out"
    horizon=$(sed -n 's/^  horizon *\([0-9.e-]*\) s.*/\1/p' "$scratch/out")
    counted
    steps=$(figure of)
    echo "$horizon $(step) $steps $(field 3)" | awk '{ off = $1 / $2 / $3 - 1; exit !($3 == $4 && off < 1e-9 && off > -1e-9) }'
    verdict $? "$1: $steps steps are the whole run" "$scratch/out"
    echo "$(figure 'a step') $(figure 'the longest') $(figure declared) $(figure flash) $(figure RAM) $(figure stack)" \
        "$(field 7) $(field 8) $(field 9) $(field 11) $(field 12) $(field 13)" | awk '{
            d = $1 - $7; exit !(NF == 12 && d <= 0.5 && d >= -0.5 && $2 == $8 && $3 == $9 && $4 == $10 && $5 == $11 && $6 == $12 &&
                $7 > 50 && $8 >= $7 && $9 > 3 * $8) }'
    verdict $? "$1: mean, longest and declared step, flash, RAM and stack are those that the line counts" "$scratch/row"
    sed -n 's/^  load  *\([0-9.e+-]*\) %.* from the longest of \([0-9]*\) counted steps; \([0-9.e+-]*\) % with the bound/\1 \2 \3/p' \
        "$scratch/out" >"$scratch/load"
    echo "$(cat "$scratch/load") $(figure 'the longest') $(figure declared) $(step) $steps" | awk '
        function near(a, b) { return a > 0.99 * b && a < 1.01 * b }
        { exit !(NF == 7 && near($1, $4 / $6 / 1e7) && near($3, $5 / $6 / 1e7) && $2 == $7) }'
    verdict $? "$1: the load is that of the longest step" "$scratch/out"
}
few="ball_bounces table_drifts"
if [ -n "${WHIRL_FULL:-}" ]; then
    for scene in $few; do contacts "$scene" 1s 200Hz; done
    with_contacts >"$scratch/names"
    [ "$(wc -l <"$scratch/names")" -ge 20 ]
    verdict $? "there are scenes with contacts" "$scratch/names"
    # one scene in seven, or more with MEASURE_EVERY=1; each takes some seconds
    awk -v every="${MEASURE_EVERY:-7}" 'NR % every == 0' "$scratch/names" >"$scratch/some"
    while read -r scene; do
        case " $few " in *" $scene "*) continue ;; esac
        contacts "$scene" 1s 200Hz
    done <"$scratch/some"
fi

# Limits are valid for contacts, too: clocks just below and above the longest step, and flash.
limits() {
    choose ball_bounces --error 0.1 --horizon 2s --rate 200Hz
    cycles=$(figure 'the longest')
    steps=$(figure 'a period')
    bytes=$(figure flash)
    choose ball_bounces --error 0.1 --horizon 2s --rate 200Hz --clock "$((cycles * 200 * steps + 1))Hz" --flash "$bytes"
    [ $? -eq 0 ] && [ "$(figure flash)" -le "$bytes" ]
    verdict $? "a clock that the longest step fits is enough" "$scratch/out"
    choose ball_bounces --error 0.1 --horizon 2s --rate 200Hz --clock "$((cycles * 20 * steps))Hz"
    [ $? -eq 1 ] && grep -q '^  a clock of' "$scratch/out"
    verdict $? "a tenth of it is not" "$scratch/out"
    choose ball_bounces --error 0.1 --horizon 2s --rate 200Hz --flash 4KB
    [ $? -eq 1 ] && grep -q '^no setting fits' "$scratch/out" && grep -q 'bytes of flash' "$scratch/out"
    verdict $? "nor is 4 KB of flash" "$scratch/out"
    # In a range, the longest step of all places counts.
    choose hopper_hops --error 0.1 --horizon 0.5s --rate 200Hz --vary e=0.2..0.9
    [ $? -eq 0 ] && [ "$(figure of)" -eq $((3 * 100 * $(figure 'a period'))) ]
    verdict $? "three places are counted" "$scratch/out"
}
[ -z "${WHIRL_FULL:-}" ] || limits

# The front of a table is counted. One of its rows is counted again, from the line that derives it.
"$whirl" price "$scratch/drawn.whirl:r23_1" --effort 1e7 --measure --csv "$scratch/rows.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && awk -F, 'NR > 1 && $1 == 1 { n++; bad += $9 == "predicted" || $19 == "predicted" } END { exit bad || n < 3 }' "$scratch/rows.csv"
verdict $? "nothing on the front is predicted" "$scratch/rows.csv"
awk -F, '$1 == 1 && $14 == "float" { cycles = $7 * $12; line = $NF } END { print cycles; print line }' "$scratch/rows.csv" >"$scratch/last"
line=$(sed -n '2s/^whirl derive \(.*\) --until .*/sh mk\/price\/measure_one.sh mps2-an386 float \1/p' "$scratch/last")
sh -c "$line" 2>"$scratch/err" | tail -n 1 >"$scratch/row"
awk -F, -v row="$(head -n 1 "$scratch/last")" '{ off = $(NF - 5) / row - 1; exit !(off < 1e-6 && off > -1e-6) }' "$scratch/row"
verdict $? "and its last row in float is what its line counts: $line" "$scratch/row"

# --- what cannot be counted -------------------------------------------------------------------------------------------
missing() { # missing EXIT-STATUS SCENE TEXT OPTION...: runs choose without the compiler
    wanted=$1 scene=$2 text=$3
    shift 3
    MAKEFLAGS="BOARD_CC=no-such-compiler" choose "$scene" --error 1e-2 "$@"
    [ $? -eq "$wanted" ] && cat "$scratch/out" "$scratch/err" | grep -q "$text"
    verdict $? "a compiler that is missing, choose $scene $*: exit status $wanted, $text" "$scratch/out"
}
missing 2 "$scratch/drawn.whirl:r23_1" "whirl cannot count costs on mps2-an386: 'no-such-compiler' is missing" --measure
missing 0 "$scratch/drawn.whirl:r23_1" "^  prices  *predicted, because the instructions cannot be counted: 'no-such-compiler' is missing"
missing 1 ball_bounces 'the cost of contacts must be counted'
choose ball_bounces --error 1e-2 --board host --horizon 1s
[ $? -eq 1 ] && grep -q 'counted only in emulators' "$scratch/err"
verdict $? "a run with contacts is not counted on this machine, which is said" "$scratch/err"
program=$(cd "$(dirname "$whirl")" && pwd)/whirl
(cd "$scratch" && "$program" choose drawn.whirl:r23_1 --error 1e-2 --effort 4e7 --measure >"$scratch/out" 2>"$scratch/err")
[ $? -eq 2 ] && grep -q "only in the root of its source tree" "$scratch/err"
verdict $? "outside of the source tree --measure fails: exit status 2" "$scratch/err"
(cd "$scratch" && "$program" choose ball_bounces --error 1e-2 --horizon 1s >"$scratch/out" 2>"$scratch/err")
[ $? -eq 1 ] && grep -q "contacts must be counted: .*root of its source tree" "$scratch/err" && [ ! -s "$scratch/out" ]
verdict $? "nor does choose of a run with contacts, which says where to run it" "$scratch/err"
(cd "$scratch" && "$program" choose drawn.whirl:r23_1 --error 1e-2 --effort 4e7 >"$scratch/out" 2>"$scratch/err")
[ $? -eq 0 ] && grep -q "^  prices  *predicted, because .* only in the root of its source tree" "$scratch/out"
verdict $? "and without it prices are predicted, which is said" "$scratch/out"

# --- measure_one.sh ------------------------------------------------------------------------------------------------------
sh mk/price/measure_one.sh mps2-an386 float "$scratch/drawn.whirl:r23_2" --compensated >"$scratch/row" 2>"$scratch/err" &&
    [ "$(awk -F, 'END { print NR, $4, $6, $7, ($8 > 50) }' "$scratch/row")" = "2 mps2-an386 float \"--compensated\" 1" ]
verdict $? "measure_one.sh measures a file's scene"
sh mk/price/measure_one.sh mps2-an386 fixed epicyclic_conserved --until 1s >"$scratch/row" 2>"$scratch/err" &&
    [ "$(awk -F, 'END { print NR, $4, $6, $7, ($8 > 50), ($15 > 50) }' "$scratch/row")" = "2 mps2-an386 fixed \"--until 1s\" 1 1" ]
verdict $? "and in fixed point" "$scratch/err"
sh mk/price/measure_one.sh nowhere float thomson_a >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'there is no boards/nowhere' "$scratch/err"
verdict $? "and refuses a board that there is not"
sh mk/price/measure_one.sh mps2-an386 float "$scratch/none.whirl" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && [ ! -s "$scratch/out" ] && [ -s "$scratch/err" ]
verdict $? "and a file that there is not"
exit $failed
