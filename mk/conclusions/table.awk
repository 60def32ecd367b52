# table.awk: writes a line of the table for each row of rows.awk. The verdict follows from theirs, ours and the
# tolerance `within`. The text of ours has the words of theirs, with the numbers in FROM/N.ours. A tolerance of "2 %"
# is relative to theirs; a bare number has theirs' unit.
BEGIN {
    FS = "\t"
    print "| section | claim | theirs | ours | within | verdict | command |\n|---|---|---|---|---|---|---|"
}
function abs(x) { return x < 0 ? -x : x }
function fail(why) { print "error: " why ": " $2 > "/dev/stderr"; exit 1 }
# ours(): returns the words of theirs with our numbers, and sets `verdict`
function ours(    said, line, word, count, rest, text, taken, right, number, x) {
    while ((getline line <(from NR ".ours")) > 0) said = said (said == "" ? "" : " ") line
    count = split(said, word, " ")
    if (count == 0) fail("no number for")
    rest = $3
    right = 1
    while (match(rest, /(^|[ (])[-+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?/)) {
        number = substr(rest, RSTART, RLENGTH)
        text = text substr(rest, 1, RSTART - 1)
        rest = substr(rest, RSTART + RLENGTH)
        if (number ~ /^[ (]/) { text = text substr(number, 1, 1); number = substr(number, 2) }
        x = word[++taken]
        text = text sprintf(number ~ /^[+]/ ? "%+.*g" : "%.*g", $5, x + 0)
        if (!(abs(x - number) <= ($4 ~ /%/ ? abs(number) * $4 / 100 : $4 + 0)) || x !~ /^[-+]?[0-9.]/) right = 0
    }
    text = text rest
    if (taken == 0) { text = said; right = said == $3 }
    else if (taken != count) fail(count " numbers for")
    else if ($4 == "") fail("within what?")
    verdict = right ? "holds" : "does not hold"
    return text
}
{
    verdict = $6
    text = verdict == "" ? ours() : "-"
    if ($7 != "") text = text == "-" ? $7 : text " (" $7 ")"
    printf "| %s | %s | %s | %s | %s | %s | %s |\n", $1, $2, $3, text, $4, verdict, $8 == "" ? "" : $8 == before ? "as above" : "`" $8 "`"
    before = $8
}
