#!/bin/sh
# conclusions.sh: the table of the dissertation's claims (mk/conclusions) judges random rows by their tolerance. A page with
# another verdict or figure fails. SEED=n: other rows.
. "$(dirname "$0")/../checks.sh"
table="sh mk/conclusions/table.sh"

# 60 rows of one or two numbers. The verdict of each is drawn first, and Whirl's number follows from it.
awk -v seed="${SEED:-45}" -v into="$scratch/" 'BEGIN {
    srand(seed)
    for (row = 1; row <= 60; row++) {
        holds = rand() < 0.5; relative = rand() < 0.5; count = 1 + int(2 * rand()); wrong = 1 + int(count * rand())
        theirs = ours = ""
        tolerance = relative ? int(1 + 9 * rand()) : sprintf("%.2g", 0.01 + rand())
        for (i = 1; i <= count; i++) {
            number = sprintf("%.3g", (rand() - 0.5) * 200)
            allowed = relative ? (number < 0 ? -number : number) * tolerance / 100 : tolerance
            off = !holds && i == wrong ? 1.1 + rand() : 0.9 * rand()
            x = number + (rand() < 0.5 ? -1 : 1) * off * allowed
            theirs = theirs (i > 1 ? " to " : "") number
            ours = ours " " sprintf("%.12g", x)
        }
        printf "section %d\nclaim drawn\ntheirs %s m\nrun echo \"v%s\"\ntake { print substr($0, 3) }\nwithin %s\n\n", row, theirs, ours,
            tolerance (relative ? " %" : "") > (into "drawn.rows")
        print holds ? "holds" : "does not hold" > (into "expected")
    }
    print "section 61\nclaim a word\ntheirs moves\nrun echo stays\ntake { print }\n\nsection 62\nclaim none\ntheirs -\nverdict not yet" > (into "drawn.rows")
    print "does not hold\nnot yet" > (into "expected")
}'
$table print "$scratch/drawn.rows" >"$scratch/page" 2>"$scratch/err"
awk -F ' [|] ' 'NR > 2 { print $6 }' "$scratch/page" | diff "$scratch/expected" - >"$scratch/said" && [ "$(wc -l <"$scratch/expected")" -eq 62 ]
verdict $? "62 drawn rows get the verdicts they were drawn for" "$scratch/said"
$table check "$scratch/page" "$scratch/drawn.rows" 2>"$scratch/err"
verdict $? "a page with this table passes"

# refused WHAT WORDS SED: the page with this change must fail, and the message must have these words
refused() {
    sed "$3" "$scratch/page" >"$scratch/changed"
    ! $table check "$scratch/changed" "$scratch/drawn.rows" 2>"$scratch/err" && grep -q "$2" "$scratch/err"
    verdict $? "a page with $1 fails"
}
refused "another verdict" 'verdict has changed from "holds" to "does not hold"' '63s/does not hold/holds/'
refused "another figure of ours" 'another table' '5s/| echo/&/; 5s/ m | \([^|]*\) | \([a-z]\)/1 m | \1 | \2/'
refused "a row less" 'another table' '7d'

# bad WHAT WORDS ROW: this row must be refused with these words
bad() {
    printf '%b\n' "$3" >"$scratch/bad.rows"
    ! $table print "$scratch/bad.rows" >"$scratch/said" 2>"$scratch/err" && grep -q "$2" "$scratch/err"
    verdict $? "$1 is refused"
}
row='section 1\nclaim c\ntheirs 1 m\n'
bad "a command that fails" 'error: false' "${row}run false\ntake { print 1 }\nwithin 1"
bad "a row without a number" 'no number' "${row}run echo 1\ntake /x/ { print 1 }\nwithin 1"
bad "a number too many" '2 numbers' "${row}run echo 1\ntake { print 1, 2 }\nwithin 1"
bad "a row without tolerance" 'within what' "${row}run echo 1\ntake { print 1 }"
bad "a verdict by hand" 'a verdict is computed' "${row}verdict holds"
bad "an unknown field" 'no such field' "${row}runs echo 1"
# The teacher's table must make the same statements about each section as the list of all claims.
awk -F ' [|] ' 'FNR == NR { if (/^[|]/) said[substr($1, 3), $6] = 1; next }
    /^[|] (I|V)/ { rows++; if (!((substr($1, 3), $3) in said)) print $1 ": " $3 }
    END { if (rows < 8) print rows " rows" }' docs/conclusions.md docs/howto/class.md >"$scratch/said"
[ ! -s "$scratch/said" ]
verdict $? "docs/howto/class.md has the verdicts of docs/conclusions.md" "$scratch/said"
exit $failed
