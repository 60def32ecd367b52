#!/bin/sh
# sweep.sh: `whirl sweep`: the same bytes from any number of jobs, from shards, and after being killed;
# files of other sweeps left alone; points that fail; and closed forms of the eccentric-mass rig.
. "$(dirname "$0")/../checks.sh"

# status WANTED COMMAND...: checks the exit status; the output is in $scratch/said.
status() {
    wanted=$1
    shift
    "$@" >"$scratch/rows" 2>"$scratch/said"
    [ $? -eq "$wanted" ]
}

# --- the same bytes ------------------------------------------------------------------------------
# 2,000 points that share one program, and some that are derived each.
many() {
    "$whirl" sweep carriage_free --until 20ms --over "theta'=100..400 [rpm]:100" \
        --over duty=0..1:20 --measure 'max(pin_force)' --measure 'mean(X)' --measure "theta'" \
        --quiet "$@"
}
derived() {
    "$whirl" sweep carriage_free --until 0.2s --over ratio=0.01..1:20,log \
        --over 'r_disc=4..8 [in]:5' --measure 'amplitude(X)' --measure 'max(ratio, 0.5)' --quiet "$@"
}

many --jobs 1 --csv "$scratch/many1.csv"
many --jobs 2 --csv "$scratch/many2.csv"
many --jobs 7 --csv - >"$scratch/many7.csv"
check "2,000 points and a header" test "$(wc -l <"$scratch/many1.csv")" -eq 2001
check "the same from 1 job and 2" cmp "$scratch/many1.csv" "$scratch/many2.csv"
check "the same from 7 jobs on standard output" cmp "$scratch/many1.csv" "$scratch/many7.csv"
derived --jobs 1 --csv "$scratch/derived1.csv"
derived --jobs 3 --csv "$scratch/derived3.csv"
check "the same from 1 job and 3, each point derived" \
    cmp "$scratch/derived1.csv" "$scratch/derived3.csv"
printf 'ratio,r_disc [in],amplitude(X),"max(ratio, 0.5)",energy_residual\r\n' >"$scratch/header"
head -n 1 "$scratch/derived1.csv" >"$scratch/first"
check "the header, quoted where it must be" cmp "$scratch/header" "$scratch/first"
check "values in the header's units" test "$(sed -n '2,6p' "$scratch/derived1.csv" | cut -d, -f2 | tr '\n' ' ')" = "4 5 6 7 8 "
check "every line ends as RFC 4180 says" \
    test "$(grep -c "$(printf '\r')\$" "$scratch/many1.csv")" -eq 2001

for k in 1 2 3; do
    many --shard $k/3 --csv "$scratch/shard$k.csv"
done
cat "$scratch"/shard[123].csv >"$scratch/shards.csv"
check "shards in order are the whole file" cmp "$scratch/many1.csv" "$scratch/shards.csv"

# A point gives the same result as `whirl run` with its values.
"$whirl" run carriage_free --until 0.5s --set ratio=0.25 --csv - --quiet | tail -n 1 |
    cut -d, -f2-5 >"$scratch/run"
"$whirl" sweep carriage_free --until 0.5s --over ratio=0.25..0.5:2 --csv - --quiet | sed -n 2p |
    cut -d, -f2-5 >"$scratch/point"
check "a point's final state is that of run" cmp "$scratch/run" "$scratch/point"

# --- killed, torn, interrupted -------------------------------------------------------------------
span=${WHIRL_FEW:+0.2s} # under the sanitizers, which take as long for it
long() {
    exec "$whirl" sweep carriage_free --until "${span:-0.5s}" --over ratio=0.01..1:10 --over duty=0..1:20 \
        --measure 'max(pin_force)' --measure X --quiet "$@"
}
# background ROWS SIGNAL FILE: starts a sweep, waits for so many rows, and sends the signal; the status is in $code.
background() {
    long --jobs 2 --csv "$3" >/dev/null 2>"$scratch/said" &
    process=$!
    while kill -0 $process 2>/dev/null && [ "$(wc -l 2>/dev/null <"$3" || echo 0)" -lt "$1" ]; do
        sleep 0.01
    done
    kill "-$2" $process 2>/dev/null
    wait $process 2>/dev/null
    code=$?
}
(long --jobs 1 --csv "$scratch/whole.csv")
: >"$scratch/killed.csv"
no_workers() { ! grep -aqs "$(basename "$scratch").[k]illed" /proc/[0-9]*/cmdline; }
for rows in 20 90; do
    background $rows KILL "$scratch/killed.csv"
    check "killed at row $rows before its end" test "$code" -eq 137
    check "killed at row $rows: its workers end" await no_workers
    check "killed at row $rows: rows are there" test "$(wc -l <"$scratch/killed.csv")" -ge $rows
done
kept=$(wc -l <"$scratch/killed.csv")
(long --jobs 2 --csv "$scratch/killed.csv")
check "killed twice: the same in the end" cmp "$scratch/whole.csv" "$scratch/killed.csv"
check "killed before it was whole" test "$kept" -lt 201

: >"$scratch/stopped.csv"
background 30 INT "$scratch/stopped.csv"
check "interrupted: exit status 130" test "$code" -eq 130
check "interrupted: ends with a whole line" \
    test "$(tail -c 1 "$scratch/stopped.csv" | od -An -tx1 | tr -d ' ')" = 0a
(long --csv "$scratch/stopped.csv")
check "interrupted: the same in the end" cmp "$scratch/whole.csv" "$scratch/stopped.csv"

# --- files of other sweeps -----------------------------------------------------------------------
small() { "$whirl" sweep carriage_free --until 10ms --over ratio=0.1..0.5:5 "$@"; }
small --csv "$scratch/small.csv" --measure X --quiet
cp "$scratch/small.csv" "$scratch/kept.csv"
check "a whole file: nothing to do" status 0 small --csv "$scratch/small.csv" --measure X
check "a whole file: says so" grep -q '5 of them found' "$scratch/said"
for other in '--measure theta' '--measure X --step 0.5ms' '--measure X --set duty=0.1' \
    '--measure X --number float' '--measure X --shard 1/2' '--measure X --over duty=0..1:2'; do
    check "refused: $other" status 2 small --csv "$scratch/small.csv" $other
    check "refused with a way out: $other" grep -q -e '--fresh' "$scratch/said"
done
check "refused: nothing was changed" cmp "$scratch/small.csv" "$scratch/kept.csv"
# Columns have the units that the file declares, as in `whirl run`; expressions are in SI. A file of an older version,
# which had only SI, is refused, and the difference is shown.
cat >"$scratch/shown.whirl" <<'END'
mechanism shown "a pendulum in degrees"
coordinate th [deg]
parameter m = 1 [kg]
parameter l = 40 [cm]
T = m*l^2*th'^2/2
V = -m*9.81 [m/s^2]*l*cos(th)
output h [mm] = l*(1 - cos(th))
scene shown_swings { start th = 80 [deg]; until 1 [s] }
END
shown() { "$whirl" sweep "$scratch/shown.whirl" --over 'l=40..80 [cm]:2' --quiet "$@"; }
shown >"$scratch/rows"
"$whirl" run "$scratch/shown.whirl" --quiet --csv - >"$scratch/run"
check "columns and final values are those of run" test "$(sed -n '1,2p' "$scratch/rows" | cut -d, -f2-4)" = \
    "$({ grep ^time "$scratch/run" && tail -n 1 "$scratch/run"; } | tr -d '\r' | cut -d, -f2-4)"
check "among them degrees and millimetres" grep -q '^l \[cm\],th \[deg\],der(th) \[deg/s\],h \[mm\],' "$scratch/rows"
shown --csv "$scratch/shown.csv" --measure 'max(th)' --measure 'max(2*th)' --measure 'period(th)'
check "measures of a quantity in its unit, others in SI" \
    sh -c "tr -d '\r' <'$scratch/shown.csv' | awk -F, 'NR == 1 && \$2 != \"max(th) [deg]\" { exit 1 }
        NR == 2 { d = \$2*3.14159265358979/90 - \$3; exit !(d*d < 1e-20 && \$3 > 1) }'"
check "and so in JSON" sh -c "'$whirl' sweep '$scratch/shown.whirl' --over 'm=1..1:1' --measure 'max(th)' --json --quiet | grep -A 1 '\"max(th)\"' | grep -q '\"unit\": \"deg\"'"
sed -i 's/^measure: max(th) .*/measure: max(th)/' "$scratch/shown.csv.sweep"
check "refused: an older file, in SI" status 2 shown --csv "$scratch/shown.csv" --measure 'max(th)' --measure 'max(2*th)' \
    --measure 'period(th)'
check "with both units" grep -q '^  here:  measure: max(th) \[deg\]' "$scratch/said"
check "refused: another range" status 2 "$whirl" sweep "$scratch/shown.whirl" --over 'l=10..90 [cm]:2' --csv "$scratch/shown.csv"
check "with both in the declared unit" sh -c "grep -q 'there: over l \[cm\]: 40 to 80, 2 values' '$scratch/said' && grep -q 'here:  over l \[cm\]: 10 to 90, 2 values' '$scratch/said'"
rm "$scratch/shown.csv.sweep"
check "refused: rows without their settings" status 2 shown --csv "$scratch/shown.csv"
check "whose file is named" grep -q "shown.csv: error: .*/shown.csv.sweep is missing" "$scratch/said"
check "--fresh starts anew" status 0 small --csv "$scratch/small.csv" --measure X --fresh
check "--fresh: the right rows" cmp "$scratch/small.csv" "$scratch/kept.csv"

# --- points that fail ----------------------------------------------------------------------------
check "failing points: exit status 1" status 1 \
    "$whirl" sweep carriage_free --until 10ms --over ratio=-1..1:5 --measure X
check "failing points: which and why" grep -q 'point 1 (ratio=-1): the kinetic energy of .* is negative' "$scratch/said"
check "failing points: how many" grep -q '3 of 5 points failed' "$scratch/said"
check "a point that diverges: exit status 1" status 1 \
    "$whirl" sweep thomson_b --method euler --until 100s --over step=0.1..50:2 --measure X
check "a point that diverges: when" grep -q 'point 1 (step=0.1): diverged in the step after t = ' "$scratch/said"
cat >"$scratch/ends.whirl" <<'END'
mechanism ends "a contact whose condition ends at x = c"
coordinate x [m]
coordinate y [m]
parameter c = 1 [m]
T = 1 [kg]*(x'^2 + y'^2)/2
hold y while sqrt((c - x)/1 [m]) > 2
scene ends_at_c { start x' = 1 [m/s]; until 1 [s] }
END
check "a condition that is no number fails" status 1 "$whirl" sweep "$scratch/ends.whirl" --over 'c=0.5..2:4' --measure y
check "a condition that is no number: which, and when" grep -q 'point 1 (c=0.5): in the step after t = 0.499 s the condition of this hold is not a finite number: hold y while sqrt' "$scratch/said"
check "the balance of each point" sh -c "'$whirl' sweep epicyclic_from_rest --until 2s --over 'step=1..200 [ms]:2' --measure X --quiet |
    tr -d '\r' | awk -F, 'NR == 1 { bad = \$3 != \"energy_residual\" } NR == 2 { bad = bad || !(\$3 < 1e-9) }
    NR == 3 { bad = bad || !(\$3 > 1e-3) } END { exit bad }'"
check "points that fail the balance: exit status 1, with --quiet as well" status 1 \
    "$whirl" sweep epicyclic_from_rest --until 2s --over 'step=1..200 [ms]:2' --measure X --quiet
check "points that fail the balance: how many, and the first" \
    grep -qF 'warning: 1 of 2 points fail the energy balance: the residual exceeds its limit at the end or before (column energy_residual) [energy]; first: point 2 (step=0.2)' "$scratch/said"
again() { "$whirl" sweep epicyclic_from_rest --until 2s --over 'step=1..200 [ms]:2' --measure X --csv "$scratch/balance.csv" "$@"; }
again >"$scratch/rows" 2>&1
check "rows found in the file count too" status 1 again
check "rows found in the file count too: not with --strict=off" status 0 again --strict=off
check "no balance without energies" sh -c "! '$whirl' sweep carriage_ratio --until 0.1s --over ratio=0.1..0.2:2 --quiet | grep -q energy_residual"
check "no period: nan, and no failure" status 0 \
    "$whirl" sweep carriage_free --until 10ms --over ratio=0.1..0.2:2 --measure 'period(X)'
check "no period: nan" test "$(grep -c ',nan' "$scratch/rows")" -eq 2

# --- impossible starts ------------------------------------------------------------------------------
sed 's/parameter e = 0.5 .*/input e = 0.5/' core/models/contacts.whirl >"$scratch/inputs.whirl"
check "an input out of range fails, though points share a program" status 1 \
    "$whirl" sweep "$scratch/inputs.whirl:ball_bounces" --until 0.1s --over 'e=0..2:3' --measure z
check "an input out of range: why" grep -q 'point 3 (e=2): a restitution is from 0 to 1, and this is 2' "$scratch/said"

exit $failed
