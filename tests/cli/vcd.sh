#!/bin/sh
# vcd.sh: `whirl run --vcd` beside --csv: standard output, what is refused, and runs that end early. build/tests/host traces vcd
# reads dumps of drawn bodies: their grammar, names, units of time, values beside the CSV's, and the contacts' wires and events.
. "$(dirname "$0")/../checks.sh"

ulimit -f 200000 # ends a writer that does not end
run() { "$whirl" run "$@" >"$scratch/out" 2>"$scratch/err" </dev/null; }
# ends_alike TICKS: the last time of the dump, with TICKS ticks per second, must be that of the CSV's last record, or
# up to one tick later
ends_alike() {
    tail -n 1 "$scratch/v.csv" | tr -d '\r' | awk -F, -v per_s="$1" -v last="$(grep '^#' "$scratch/v.vcd" | tail -n 1)" \
        '{ off = substr(last, 2) / per_s - $1; exit !(last != "" && off > -1e-9 && off < 0.1 + 1e-9) }'
}

run thomson_a --until 50ms --vcd - && grep -q '^state hash' "$scratch/err" && mv "$scratch/out" "$scratch/first" &&
    run thomson_a --until 50ms --quiet --vcd "$scratch/v.vcd" && cmp -s "$scratch/first" "$scratch/v.vcd"
verdict $? "- is standard output; the summary then goes to standard error"
cp core/models/epicyclic.whirl "$scratch/model.whirl"
exits 2 'error: --vcd would overwrite .*model.whirl' run "$scratch/model.whirl:epicyclic_from_rest" --vcd "$scratch/model.whirl"
exits 2 'error: --vcd cannot resolve the times of these records' run thomson_a --step 1e-16 --until 1e-13 --vcd "$scratch/x"

run thomson_b --method euler --step 0.1 --until 100 --quiet --csv "$scratch/v.csv" --vcd "$scratch/v.vcd"
[ $? -eq 1 ] && grep -q '^.timescale 100us .end$' "$scratch/v.vcd" && ends_alike 1e4
verdict $? "a run that diverges leaves its records"
rm -f "$scratch/v.csv" "$scratch/v.vcd"
begun() { [ -s "$scratch/v.vcd.part" ] && [ -s "$scratch/v.csv.part" ]; }
stop INT begun run thomson_b --until 1e6s --csv "$scratch/v.csv" --vcd "$scratch/v.vcd"
[ "$code" -eq 130 ] && grep -q 'the records so far are kept$' "$scratch/err" && grep -q '^.timescale 10ns .end$' "$scratch/v.vcd" && ends_alike 1e8
verdict $? "an interrupt leaves them, too"

# Words of the model must not end a comment.
sed 's/^mechanism epicyclic "/&ends at no $end /; s/^scene epicyclic_from_rest "/&no $end $end /' "$scratch/model.whirl" >"$scratch/words.whirl"
run "$scratch/words.whirl:epicyclic_from_rest" --until 10ms --quiet --vcd "$scratch/v.vcd" &&
    awk '/^[$]comment/ { n++; for (i = 2; i < NF; i++) { bad += $i == "$end" } words += /[$] end / } END { exit bad || n < 5 || !words }' "$scratch/v.vcd"
verdict $? "a comment ends at its own end" "$scratch/v.vcd"

# A value that does not change is written once: a block that sticks for ten minutes.
run incline_sticks --quiet --csv "$scratch/v.csv" --vcd "$scratch/v.vcd" && [ "$(wc -c <"$scratch/v.csv")" -gt 500000 ] && [ "$(wc -c <"$scratch/v.vcd")" -lt 2000 ] &&
    [ "$(tail -n 1 "$scratch/v.vcd")" = "#60000000" ]
verdict $? "ten minutes without moving: $(wc -c <"$scratch/v.vcd") bytes, and their end"
exit $failed
