#!/bin/sh
# map.sh: map, rows and picture of `whirl map` agree, and wrong input is refused. build/tests/host map checks that they are
# right.
. "$(dirname "$0")/../checks.sh"
about=map

spring=mk/stability/spring.whirl
steps=--over=step=10ms..1s:21,log
places=--over=k=50..200:5

# --- one answer, three places ------------------------------------------------------------------------------------------
while read -r scene options; do
    "$whirl" map "$scene" $options --csv "$scratch/rows" --plot "$scratch/map.svg" >"$scratch/words" 2>"$scratch/err"
    [ $? -eq 0 ] && [ ! -s "$scratch/err" ]
    verdict $? "whirl map $scene $options"
    awk -F, 'NR > 1 { seen[$3]++ } END { for (each in seen) { print each, seen[each] } }' "$scratch/rows" | sort >"$scratch/counted"
    sed -n 's/^  [^ ]  \([a-z][a-z]*\)  *\([0-9][0-9]*\)  .*/\1 \2/p' "$scratch/words" | sort | cmp - "$scratch/counted" >"$scratch/err" 2>&1 &&
        [ "$(wc -l <"$scratch/counted")" -ge 2 ]
    verdict $? "its words count as many of each as there are rows: $(tr '\n' ' ' <"$scratch/counted")" "$scratch/words"
    # the map has exactly the marks of the legend, in the numbers that it states
    awk '/^$/ { block++; next }
        block == 1 && lines++ { for (i = 1; i <= length($2); i++) { seen[substr($2, i, 1)]++ } }
        block == 2 { wanted[$1] = $3 }
        END { for (each in wanted) { if (seen[each] != wanted[each]) { exit 1 } } }' "$scratch/words"
    verdict $? "and as many marks" "$scratch/words"
    sed -n 's/.*<title>\([a-z]*\): .*<.title>.*/\1/p' "$scratch/map.svg" | grep -xE 'keeps|off|loses|diverges' | sort >"$scratch/drawn"
    sed 's/ .*//' "$scratch/counted" | cmp - "$scratch/drawn" >"$scratch/err" 2>&1
    verdict $? "and so does the picture's key" "$scratch/drawn"
    rm -f "$scratch/map.svg" "$scratch/rows"
done <<END
$spring $steps $places
$spring $places $steps --method nystroem5 --number float
$spring $steps $places --method euler
$spring --over=step=1s..10ms:21,log --over=k=200..50:5
belt_stick_slip --over=step=1..100[ms]:5,log --over=k=100..1e4:3 --until 2s
epicyclic_from_rest --over=M=1..3:3 --over=theta'=0..5:2 --until 1s --step 100ms --tolerance 1e-6
END

# --- in words and in rows -----------------------------------------------------------------------------------------------
"$whirl" map $spring $steps $places --csv - >"$scratch/rows" 2>"$scratch/words"
verdict $? "rows on standard output, the map on standard error" "$scratch/words"
"$whirl" map $spring --over=step=1s..10ms:21,log --over=k=200..50:5 2>"$scratch/err" | sed 's/^[^:]*: //' >"$scratch/falls"
"$whirl" map $spring $places $steps 2>"$scratch/err" | sed 's/^[^:]*: //' | cmp - "$scratch/falls" 2>"$scratch/err"
verdict $? "the same map, whichever way its ranges go" "$scratch/falls"
# --- pairs without a run ----------------------------------------------------------------------------------------------------
exits 1 'error: no pair of values can be run' $spring --over=m=0..0:1 $steps --csv "$scratch/n.csv" --quiet
exits 1 'error: no pair of values can be run' ball_bounces --over=z=-2..-1:3 --over=e=0.1..0.9:3 --plot "$scratch/n.svg" --quiet

# --- what is refused --------------------------------------------------------------------------------------------------------
exits 2 'usage: whirl map'
exits 2 'a map needs two --over: there is none' $spring
exits 2 'a map needs two --over: there is one' $spring "$steps"
exits 2 "a map needs exactly two --over, but 'm=1..2:2' is a third one" $spring "$steps" "$places" --over m=1..2:2
for bad in 'k=1..2' 'k=:3' '=1..2:3' 'k=1...2:3' '' 'k' 'k=1..2:x' 'k=1..2:0' 'k=1..2:1' 'k=1..2:-3' 'k=1..2:1.5' 'k=-1..2:3,log' \
    'k=0..2:3,log' 'k=nan..2:3' 'k=1..inf:3' 'k=1..nan:3' 'nothing=1..2:3' 'x=1..m:3' 'k=1..2:3,lin' 'k=1..2 [kg]:3' 'k=1..2:99999999999999'; do
    exits 2 'error: ' $spring "$steps" --over "$bad"
done
exits 2 'step must be above zero' $spring "$places" --over step=0..1:3
exits 2 'step must be above zero' $spring "$places" --over step=-1..1:3
exits 2 'error: .*already sweeps' $spring "$steps" --over step=1ms..2ms:3
exits 2 'error: .*already sweeps' $spring "$places" "$places"
exits 2 "--over sweeps 'k', but --set sets it, too" $spring "$steps" "$places" --set 'k = 3'
exits 2 "--over sweeps 'x', but --start sets it, too" $spring "$steps" --over x=1..2:2 --start x=3
exits 2 "--over sweeps 'step', but --step sets it, too" $spring "$steps" "$places" --step 1ms
exits 2 '1000000 pairs exceed the limit of 250000' $spring --over k=1..2:1000 --over x=1..2:1000
exits 2 'pairs exceed the limit of 250000' $spring --over k=1..2:999999 --over x=1..2:999999
exits 2 'this would take about [1-9][0-9]* min: 105 pairs' $spring "$places" --over step=1e-9..1e-3:21,log
exits 2 'hint: use fewer pairs, .*; or --effort [0-9.e+]*$' $spring "$steps" "$places" --until 1e7s
exits 2 "belongs to the effect 'rail_drag', which is not selected" epicyclic_from_rest --over=b=1..2:3 "$steps"
exits 2 "there is no number 'fixed'" $spring "$steps" "$places" --number fixed
exits 2 'is not defined here' tests/mechanisms/lorenz.whirl "$steps" --over x=1..2:2 --method leapfrog
exits 2 'there is no file and no built-in scene' nothing "$steps" "$places"
exits 2 'takes only one scene' $spring thomson_a "$steps" "$places"
# refused before the work, which would take hours
slow="--over=step=1..2[us]:100 $places --until 10s --effort 1e15"
exits 2 'cannot be written' $spring $slow --csv "$scratch"
exits 2 'map.svg: error: cannot be written' $spring $slow --plot "$scratch/none/map.svg"
exits 2 'draws .svg, .pdf and .png files' $spring $slow --plot map.gif
cp $spring "$scratch/mine.whirl"
ln -s "$scratch/mine.whirl" "$scratch/mine.svg"
exits 2 'would overwrite .*mine.whirl' "$scratch/mine.whirl" $slow --plot "$scratch/mine.svg"
mkdir "$scratch/bin"
for tool in sh env timeout; do ln -s "$(command -v $tool)" "$scratch/bin/$tool"; done
program=$(realpath "$whirl")
PATH=$scratch/bin sh tests/limit.sh 60 "$program" map $spring $slow --plot "$scratch/map.svg" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'plots need gnuplot' "$scratch/err" && [ ! -s "$scratch/out" ]
verdict $? "no gnuplot: told before the work"

# --- progress, on a terminal alone ------------------------------------------------------------------------------------------
if command -v script >/dev/null 2>&1; then
    script -qec "'$whirl' map $spring $steps $places" "$scratch/typed" >/dev/null 2>&1 </dev/null
    tr '\r' '\n' <"$scratch/typed" | grep -q '^105.0 of 105 runs'
    verdict $? "progress on a terminal" "$scratch/typed"
    script -qec "'$whirl' map $spring $steps $places --quiet" "$scratch/typed" >/dev/null 2>&1 </dev/null
    ! grep -q ' of 105 runs' "$scratch/typed"
    verdict $? "none with --quiet" "$scratch/typed"
fi

# --- what docs/stability.md shows ------------------------------------------------------------------------------------------------
awk '/^## Stability maps/ { on = 1 } /^## Where the measurements/ { on = 0 } on' docs/stability.md >"$scratch/section"
# if gnuplot is installed, the commands draw the page's pictures again
mkdir "$scratch/docs"
cp docs/stability.md "$scratch/docs"
sh mk/stability/maps.sh "$whirl" "$scratch/docs" >"$scratch/out" 2>"$scratch/err"
verdict $? "mk/stability/maps.sh draws them"
pictures=0
for picture in $(sed -n 's/.*(\(figures\/map_[a-z0-9_]*[.]svg\)).*/\1/p' "$scratch/section"); do
    pictures=$((pictures + 1))
    { [ "$(grep '^<desc>' "$scratch/docs/$picture")" != "$(grep '^<desc>' "docs/$picture")" ] && [ -s "$scratch/docs/$picture" ]; } ||
        cmp "$scratch/docs/$picture" "docs/$picture" 2>"$scratch/err"
    verdict $? "docs/$picture is what its command draws (make stability)"
done
[ $pictures -ge 3 ] && [ "$pictures" -eq "$(find docs/figures -name 'map_*.svg' | wc -l)" ]
verdict $? "$pictures pictures, each of a command" /dev/null
exit $failed
