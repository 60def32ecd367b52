# table.awk: a line of the table for each row of rows.awk, its verdict from theirs, ours and what it is within. Ours has the words
# of theirs, with the numbers that FROM/N.ours holds. "2 %" is of theirs; a bare number is in theirs' unit.
BEGIN {
    FS = "\t"
    print "| section | claim | theirs | ours | within | verdict | command |"
    print "|---|---|---|---|---|---|---|"
}
function abs(x) { return x < 0 ? -x : x }
{
    split("", ours)
    count = 0
    verdict = $6
    said = ""
    if (verdict == "") {
        while ((getline line <(from NR ".ours")) > 0) {
            said = said (said == "" ? "" : " ") line
            k = split(line, word, " ")
            for (i = 1; i <= k; i++) ours[++count] = word[i]
        }
        if (count == 0) { print "error: no number for: " $2 > "/dev/stderr"; exit 1 }
        rest = $3
        text = ""
        taken = 0
        right = 1
        while (match(rest, /(^|[ (])[-+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?/)) {
            number = substr(rest, RSTART, RLENGTH)
            text = text substr(rest, 1, RSTART - 1)
            rest = substr(rest, RSTART + RLENGTH)
            if (number ~ /^[ (]/) { text = text substr(number, 1, 1); number = substr(number, 2) }
            x = ours[++taken]
            text = text sprintf(number ~ /^[+]/ ? "%+.*g" : "%.*g", $5 == "" ? 4 : $5, x + 0)
            most = $4 ~ /%/ ? abs(number) * $4 / 100 : $4 + 0
            if (!(abs(x - number) <= most) || x !~ /^[-+]?[0-9.]/) right = 0
        }
        text = text rest
        if (taken == 0) { text = said; right = said == $3 }
        else if (taken != count) { print "error: " count " numbers for: " $2 > "/dev/stderr"; exit 1 }
        else if ($4 == "") { print "error: within what? " $2 > "/dev/stderr"; exit 1 }
        verdict = right ? "holds" : "does not hold"
    } else text = "-"
    if ($7 != "") text = text == "-" ? $7 : text " (" $7 ")"
    printf "| %s | %s | %s | %s | %s | %s | %s |\n", $1, $2, $3, text, $4, verdict, $8 == "" ? "" : "`" $8 "`"
}
