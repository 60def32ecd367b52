#!/bin/sh
# records.sh: the CSV of a run: form (RFC 4180), names, digits, spacing; its state after a run that diverges; and the same
# numbers as plain columns. (interrupt.sh interrupts runs, odd_values.sh fills the disk.)
. "$(dirname "$0")/../checks.sh"

# Every line ends in CR LF and has as many fields as the header; every field below it is a finite number.
well_formed() {
    awk -F, 'BEGIN { RS = "\r\n" } /\n/ { bad = 1 } NR == 1 { fields = NF }
        NF != fields { bad = 1 }
        NR > 1 { for (i = 1; i <= NF; i++) if ($i !~ /^-?[0-9]+(\.[0-9]+)?(e[-+][0-9]+)?$/) bad = 1 }
        END { exit bad || NR < 2 }' "$1" && [ "$(tail -c 2 "$1" | od -An -tx1 | tr -d ' ')" = 0d0a ]
}

header_is() { # header_is FILE TEXT: compares the header
    [ "$(head -n 1 "$1")" = "$(printf '%s\r' "$2")" ]
}

run() { "$whirl" run "$@" >"$scratch/out" 2>"$scratch/err" </dev/null; }

# --- form ---------------------------------------------------------------------------------------------
run thomson_a --until 0.5s --every 2ms --quiet --csv "$scratch/a.csv"
verdict $? "thomson_a is recorded"
well_formed "$scratch/a.csv"
verdict $? "records are well formed"
header_is "$scratch/a.csv" 'time,theta1,theta2,X,der(theta1),der(theta2),der(X),projection,x_26,x_33,x_cm'
verdict $? "time, coordinates, rates, outputs"
awk -F, 'NR > 1 && ($1 - 0.002*(NR - 2))^2 > 1e-24 { bad = 1 } END { exit bad || NR != 252 }' "$scratch/a.csv"
verdict $? "a record every 2 ms, the start and the end included"

run thomson_a --until 0.5s --quiet --csv - && [ ! -s "$scratch/err" ] && well_formed "$scratch/out"
verdict $? "--csv - writes records, and nothing else, to standard output"
run thomson_a --until 0 --quiet --csv "$scratch/z.csv" && [ "$(wc -l <"$scratch/z.csv")" -eq 2 ]
verdict $? "a run of no length records its start"

cat >"$scratch/mixed.whirl" <<'END'
mechanism mixed "third, second and first order"
state a
state b [rad]
state c [V]
parameter s = 1 [s]
equation s^3*a''' + s*a' + a = sin(b)
equation s^2*b'' + b = c/1 [V]
equation s*c' + c = 1 [V]*cos(b)
output twice = 2*a
END
run "$scratch/mixed.whirl" --until 10ms --quiet --csv "$scratch/m.csv" &&
    header_is "$scratch/m.csv" 'time,a,b,c,der(a),der(b),der(der(a)),twice'
verdict $? "derivatives of higher order are der(der(a))"

# --- digits: the value that is read is the value that was written ------------------------------------------------
# If the state at 0.25 s is given as a start, the run must end as the run that went through it.
run thomson_plane_b --until 0.25s --quiet --csv "$scratch/h.csv"
set -- $(awk -F, 'NR == 1 { n = (NF - 1) / 2; for (i = 2; i <= NF; i++) name[i] = $i; next } { last = $0 }
    END { split(last, v, ",")
        for (i = 2; i <= 9; i++) { q = name[i]; p = ""
            if (q ~ /^der\(/) { q = substr(q, 5, length(q) - 5); p = "\047" }
            print "--start " q p "=" v[i] } }' "$scratch/h.csv" | tr -d '\r')
run thomson_plane_b --until 0.25s --quiet --csv "$scratch/second.csv" "$@"
run thomson_plane_b --until 0.5s --quiet --csv "$scratch/whole.csv"
[ $# -eq 16 ] && [ "$(tail -n 1 "$scratch/second.csv" | cut -d, -f2-)" = "$(tail -n 1 "$scratch/whole.csv" | cut -d, -f2-)" ]
verdict $? "seventeen digits carry a state through text to the bit"
run thomson_b --until 0.1s --number float --quiet --csv "$scratch/f.csv" && well_formed "$scratch/f.csv" &&
    awk -F, 'NR > 1 { for (i = 2; i <= NF; i++) { v = $i; sub(/\r/, "", v); sub(/e.*/, "", v); gsub(/[-.]/, "", v)
        sub(/^0+/, "", v); if (length(v) > 9) bad = 1; if (length(v) == 9) full = 1 } }
        END { exit bad || !full }' "$scratch/f.csv"
verdict $? "nine digits in float"

# --- runs that fail ---------------------------------------------------------------------------------------
run thomson_b --method euler --step 0.1 --until 100 --csv "$scratch/d.csv"
[ $? -eq 1 ] && grep -Eq '^whirl run: error: the run diverged in the step after t = 0\.[0-9]+ s: (theta1|theta2|X)' "$scratch/err" &&
    grep -q '^hint: ' "$scratch/err"
verdict $? "a step far too long: status 1, when, which coordinate, what to try"
well_formed "$scratch/d.csv"
verdict $? "its records so far are well formed and finite"
run spherical_flight --start theta=0 --csv "$scratch/p.csv" --quiet
[ $? -eq 1 ] && grep -q 'diverged in the step after t = 0 s: ' "$scratch/err" && well_formed "$scratch/p.csv"
verdict $? "a start on the pole of spherical coordinates: status 1, the start is recorded"
run tests/mechanisms/lorenz.whirl --start x=1 --step 1 --method euler --csv "$scratch/l.csv" --quiet --number float
[ $? -eq 1 ] && grep -Eq 'after t = [0-9]+ s: [xyz] grew without bound' "$scratch/err" && well_formed "$scratch/l.csv"
verdict $? "a system of first order in float: status 1, records well formed"

# --- two runs that write one file -------------------------------------------------------------------------
for output in csv columns vcd; do
    run epicyclic_from_rest --until 3s --quiet --$output "$scratch/alone"
    for way in part link; do # written as FILE.part, and in place
        rm -f "$scratch/place"; [ $way = part ] || ln -sf "$scratch/place" "$scratch/same.$way"
        "$whirl" run epicyclic_from_rest --until 1000000s --quiet --$output "$scratch/same.$way" 2>/dev/null &
        first=$!
        await has_bytes 9000 "$([ $way = part ] && echo "$scratch/same.part.part" || echo "$scratch/place")"
        exits 2 'same.*another whirl is writing it' run epicyclic_from_rest --quiet --$output "$scratch/same.$way"
        kill -INT $first
        wait $first
        head -n 99 "$scratch/alone" >"$scratch/wanted"
        head -n 99 "$scratch/same.$way" | cmp - "$scratch/wanted" 2>"$scratch/err"
        verdict $? "--$output, $way: the first run's records are whole"
    done
done

# --- plain columns ----------------------------------------------------------------------------------------
run epicyclic_from_rest --until 1s --every 10ms --quiet --csv "$scratch/run.csv" --columns "$scratch/run.txt"
[ "$(head -n 1 "$scratch/run.txt")" = '% time theta X der(theta) der(X) projection x_2 x_cm' ]
verdict $? "columns: the header is a comment with the columns' names" "$scratch/run.txt"
tr -d '\r' <"$scratch/run.csv" | sed '1d; s/,/ /g' >"$scratch/numbers"
sed 1d "$scratch/run.txt" | cmp - "$scratch/numbers" >"$scratch/err" && [ "$(wc -l <"$scratch/numbers")" -eq 101 ]
verdict $? "columns: the same digits as the CSV, a record for each 10 ms, and one at zero"
run epicyclic_from_rest --until 1s --every 10ms --columns - && cmp -s "$scratch/run.txt" "$scratch/out" && grep -q '^state hash' "$scratch/err"
verdict $? "columns: - is standard output; the summary then goes to standard error"

# The last state is recorded once, whatever the spacing.
for every in 1 2 3 7 13 125 333 999 1000 1001 5000; do
    "$whirl" run epicyclic_from_rest --until 1s --every ${every}ms --csv - --quiet | tr -d '\r' >"$scratch/e.csv"
    [ "$(tail -n 1 "$scratch/e.csv" | cut -d, -f1)" = 1 ] && [ "$(grep -c '^1,' "$scratch/e.csv")" -eq 1 ] &&
        [ "$(wc -l <"$scratch/e.csv")" -eq $(((1000 + every - 1) / every + 2)) ]
    verdict $? "records each $every ms end with the last state"
done
exit $failed
