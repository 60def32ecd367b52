# recount.awk: prints the rows of priced.awk. Rows that were counted get the counted figures:
#
#   awk -F, -f words.awk -f recount.awk COUNTED.csv... ROWS

FILENAME != last {
    last = FILENAME
    rows = FILENAME !~ /counted[^\/]*\.csv$/
    if (!rows) {
        header()
        next
    }
}

!rows {
    key = field("board") "," field("run")
    counted[key] = field("instructions") "," field("cycles")
    of[key] = field("cycles") == "" ? field("instructions") : field("cycles")
    bytes[key] = field("flash") "," field("ram") "," field("stack")
    next
}

{
    key = $2 "," $18
    if (key in counted) {
        print $1, $2, $3, $4, $5, $6, $7, $8, sprintf("%.6g", of[key] / $6), counted[key], "counted", bytes[key], $16, $17, $18
    } else {
        print
    }
}
