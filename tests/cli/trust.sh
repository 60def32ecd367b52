#!/bin/sh
# trust.sh: `whirl trust`, the line of `whirl run` and the shade of its plot agree. They change no bit of a run and no
# output for programs. Also refusals. build/tests/host trust trust_drawn trust_scenes checks that they are right.
. "$(dirname "$0")/../checks.sh"
about=trust

# end_of FILE: prints the earliest end in the rows of --csv, or "end"
end_of() { awk -F, '$3 == "until" && (least == "" || $4 + 0 < least + 0) { least = $4 } END { print least == "" ? "end" : least }' "$1"; }

# --- one answer, three places ------------------------------------------------------------------------------------------
# Under the sanitizers every third row.
every=${WHIRL_FEW:+3}
row=0
while read -r scene options; do
    row=$((row + 1))
    [ $((row % ${every:-1})) -eq 0 ] || continue
    "$whirl" trust "$scene" $options --csv "$scratch/rows" >"$scratch/words" 2>"$scratch/err"
    status=$?
    end=$(end_of "$scratch/rows")
    if [ "$end" = end ]; then
        [ $status -eq 0 ] && grep -q '^trusted to the end, t = ' "$scratch/words"
    else
        [ $status -eq 0 ] && grep -q "^trusted until t = $end s of " "$scratch/words"
    fi
    verdict $? "$scene $options: $end, in words and in rows" "$scratch/words"
    "$whirl" run "$scene" $options --plot "$scratch/plot.svg" >"$scratch/summary" 2>"$scratch/err"
    if [ "$end" = end ]; then
        grep -q '^trusted  *to the end: every coordinate to 0.001 of its range$' "$scratch/summary" &&
            ! grep -q "only energy and momenta" "$scratch/plot.svg"
    else
        short=$(awk -v x="$end" 'BEGIN { printf "%.6g", x }')
        grep -q "^trusted  *until t = $short s: after that" "$scratch/summary" &&
            grep -q "after $short s only energy and momenta are meaningful" "$scratch/plot.svg"
    fi
    verdict $? "$scene $options: and so say whirl run and its plot" "$scratch/summary"
done <<'END'
thomson_a --number float --step 1ms
thomson_a --number float --step 1ms --compensated
thomson_a
epicyclic_from_rest
epicyclic_from_rest --number fixed
epicyclic_from_rest --method semi-implicit-euler
epicyclic_conserved --number float --tables linear
rig_coupled --number float --with ledger
carriage_stop --number float
tests/mechanisms/lorenz.whirl --start x=1 --step 2ms --until 30s
tests/mechanisms/van_der_pol.whirl --step 10ms --until 20s
END

# --- what both runs jump over: their agreement is no reason to trust them -------------------------------------------------
# The wall is 10 um thick. The steps of both runs meet it only at its middle, where nothing pushes.
for speed in 1 2 5; do
    cat >"$scratch/wall.whirl" <<END
mechanism wall "A ball whose steps jump through a wall"
coordinate x [m]
T = 1 [kg]*x'^2/2
V = 1000 [J]*exp(-((x - 1 [m])/1e-5 [m])^2)
scene through { start x' = $speed [m/s]
step 1 [ms]
until 2 [s] }
END
    "$whirl" run "$scratch/wall.whirl" >"$scratch/summary" 2>"$scratch/err"
    until=$(sed -n 's/^trusted  *until t = \([0-9.]*\) s: .*/\1/p' "$scratch/summary")
    grep -q 'energy balance fails' "$scratch/err" && {
        grep -q '^trusted  *unknown: ' "$scratch/summary" ||
            awk -v until="${until:-9}" -v speed="$speed" 'BEGIN { exit !(until * speed <= 1) }'
    }
    verdict $? "a wall that $speed m/s pass unseen: not believed, and not trusted behind it" "$scratch/summary"
done

# --- a step that is the exact motion: trusted to the end, with sums of either kind -----------------------------------------
for number in double float; do
    for sums in '' --compensated; do
        "$whirl" trust mk/stability/spring.whirl --matrix exact --step 100ms --until 10s --number $number $sums --csv "$scratch/rows" >"$scratch/words" 2>"$scratch/err" &&
            [ "$(end_of "$scratch/rows")" = end ] && grep -q '^  x  *to the end .* of its range of 0.2 m$' "$scratch/words"
        verdict $? "an exact matrix, $number $sums: to the end" "$scratch/words"
    done
done

# --- the command changes nothing else ----------------------------------------------------------------------------------
"$whirl" run thomson_a --step 1ms --csv - --every 50ms >"$scratch/loud" 2>"$scratch/said"
"$whirl" run thomson_a --step 1ms --csv - --every 50ms --quiet >"$scratch/still" 2>"$scratch/err"
cmp "$scratch/loud" "$scratch/still" >"$scratch/diff" 2>&1 && grep -q '^trusted ' "$scratch/said" && [ ! -s "$scratch/err" ]
verdict $? "records on standard output are clean; the line goes with the summary; --quiet says nothing" "$scratch/diff"
hash=$("$whirl" run thomson_a --number float --step 1ms --until 9s | sed -n 's/^state hash *//p')
whole=$("$whirl" run thomson_a --number float --step 1ms --until 9s --plot "$scratch/p.svg" | sed -n 's/^state hash *//p')
[ -n "$hash" ] && [ "$hash" = "$whole" ]
verdict $? "the state hash is the same with a plot" /dev/null
[ "$("$whirl" run thomson_a | grep -c '^trusted ')" -eq 1 ] && ! "$whirl" run thomson_a --until 0 | grep -q '^trusted '
verdict $? "one line; none where nothing runs" /dev/null
"$whirl" run thomson_a --step 0.001ms --until 1s | grep -q '^trusted  *not computed, because that takes more than a second'
verdict $? "a hint where it would take seconds" /dev/null

# --- tolerances: a larger one never gives an earlier end -----------------------------------------------------------------
last=0
for tolerance in 1e-9 1e-7 1e-5 1e-4 1e-3 1e-2 0.1; do
    "$whirl" trust thomson_a --number float --step 1ms --tolerance $tolerance --csv "$scratch/rows" --quiet 2>"$scratch/err"
    end=$(end_of "$scratch/rows")
    awk -v a="$last" -v b="$end" 'BEGIN { exit !(b == "end" || b + 0 >= a + 0) }'
    verdict $? "to $tolerance: until $end s, not before $last s"
    last=$end
done
awk -v x="$last" 'BEGIN { exit !(x > 8 && x < 10) }'
verdict $? "to a tenth until $last s"

# --- runs that cannot be made ----------------------------------------------------------------------------------------------
cat >"$scratch/pole.whirl" <<'END'
mechanism pole "x'' = 2 x^3 is infinite at 1 s"
coordinate x [m]
T = 1 [kg]*x'^2/2
V = -0.5 [N/m^3]*x^4
scene blows { start x = 1 [m], x' = 1 [m/s]; step 1 [ms]; until 2 [s] }
END
"$whirl" trust "$scratch/pole.whirl" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'error: the run diverged in the step after t = 1' "$scratch/err" && grep -q '^trusted until t = 0.9' "$scratch/out"
verdict $? "a run that diverges: status 1, and until when it was right" "$scratch/out"
"$whirl" run "$scratch/pole.whirl" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && ! grep -q '^trusted' "$scratch/out"
verdict $? "whirl run says nothing of trust where it fails" "$scratch/out"
"$whirl" trust thomson_a --until 0 >"$scratch/out" 2>"$scratch/err" && grep -q '^trusted to the end, t = 0 s' "$scratch/out"
verdict $? "a run of no step" "$scratch/out"
"$whirl" trust ball_between >"$scratch/out" 2>"$scratch/err" && grep -q '^trusted until t = 0 s of .*: a later step of this run or of the finer run had more than eight moments with events' "$scratch/out"
verdict $? "steps with more events than they take: nothing is known" "$scratch/out"

# --- what is refused -------------------------------------------------------------------------------------------------------
for bad in 0 -1 2 1e-16 nan x 1e-3m ''; do
    exits 2 "error: --tolerance takes a number from 1e-15 to 1" thomson_a --tolerance "$bad"
    exits 2 "error: --effort takes a number from 10000 to 1e+15" thomson_a --effort "${bad%2}x"
done
exits 2 "error: this would take about [1-9][0-9]* s:" thomson_a --until 1e3s --effort 1e4
exits 2 "error: this would take about [1-9][0-9]* ms:" thomson_a --until 1s --effort 1e4
exits 2 "^hint: use an earlier --until, .*; or --effort [0-9.e+]*$" thomson_a --until 1e5s
exits 2 ", less than one step of" thomson_a --until 0.0001s
exits 2 "there is no file and no built-in scene" nothing
exits 2 "takes only one scene" thomson_a thomson_b
exits 2 "unknown option '--plot'" thomson_a --plot x.svg
exits 2 "is not defined here" thomson_a --method leapfrog
exits 2 "fixed point does not support events" carriage_stop --number fixed

# --- what docs/dev/stability.md prints -----------------------------------------------------------------------------------------
mkdir "$scratch/board" "$scratch/board/build"
ln -s "$PWD/core" "$scratch/board/core"
ln -s "$(realpath "$whirl")" "$scratch/board/build/whirl"
awk -v into="$scratch/board" '
    /^## A twin on a board$/ { on = 1; next }
    /^## / { on = 0 }
    !on { next }
    /^```c$/ { file = into "/main.c"; next }
    /^```sh/ { file = into "/commands"; next }
    /^```/ { file = ""; next }
    /^    / && !/^    [$]/ && main && !printed && file == "" { sub(/^    /, ""); print > (into "/wanted"); printed = 1 }
    file ~ /main[.]c$/ { main = 1 }
    file != "" { print > file }' docs/dev/stability.md
(cd "$scratch/board" && sh -e commands) >"$scratch/board/said" 2>"$scratch/err" && cmp "$scratch/board/said" "$scratch/board/wanted" 2>"$scratch/err"
verdict $? "docs/dev/stability.md: the twin of a board builds, and says what stands there: $(cat "$scratch/board/said")"
exit $failed
