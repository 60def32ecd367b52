#!/bin/sh
# columns.sh: `whirl run --columns` writes the numbers of --csv as plain columns, or an error if it cannot.
. "$(dirname "$0")/../checks.sh"

"$whirl" run epicyclic_from_rest --until 1s --every 10ms --quiet \
    --csv "$scratch/run.csv" --columns "$scratch/run.txt"

printf '%% time theta X der(theta) der(X) projection x_2 x_cm\n' >"$scratch/header"
head -n 1 "$scratch/run.txt" >"$scratch/first"
check "columns: the header is a comment with the columns' names" \
    cmp "$scratch/header" "$scratch/first"

tr -d '\r' <"$scratch/run.csv" | tail -n +2 | tr ',' ' ' >"$scratch/csv_numbers"
tail -n +2 "$scratch/run.txt" >"$scratch/numbers"
check "columns: the same digits as the CSV" cmp "$scratch/csv_numbers" "$scratch/numbers"
check "columns: a record for each 10 ms, and one at zero" test "$(wc -l <"$scratch/numbers")" -eq 101

"$whirl" run epicyclic_from_rest --until 1s --every 10ms --columns - \
    >"$scratch/standard" 2>"$scratch/summary"
check "columns: - is standard output" cmp "$scratch/run.txt" "$scratch/standard"
check "columns: the summary then goes to standard error" grep -q '^state hash' "$scratch/summary"

# refused WHAT OPTION...: exit status 2 and a message that names the cause.
refused() {
    what=$1
    shift
    "$whirl" run epicyclic_from_rest --quiet "$@" >/dev/null 2>"$scratch/err"
    [ $? -eq 2 ] && grep -q error: "$scratch/err"
    verdict $? "$what"
}
refused "columns: a file that cannot be made" --columns "$scratch/missing/run.txt"
refused "columns: not the same file as --csv" --csv - --columns -
# The last state is recorded once, whatever the spacing.
for every in 1 2 3 7 13 125 333 999 1000 1001 5000; do
    "$whirl" run epicyclic_from_rest --until 1s --every ${every}ms --csv - --quiet | tr -d '\r' >"$scratch/e.csv"
    [ "$(tail -n 1 "$scratch/e.csv" | cut -d, -f1)" = 1 ] && [ "$(grep -c '^1,' "$scratch/e.csv")" -eq 1 ] &&
        [ "$(wc -l <"$scratch/e.csv")" -eq $(((1000 + every - 1) / every + 2)) ]
    verdict $? "records each $every ms end with the last state"
done
exit $failed
