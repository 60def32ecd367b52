# boards_table.awk: the rows of mk/price/measure.sh as a table in Markdown: the last of each board and scene.
#
#   awk -F, -f boards_table.awk build/figures/boards.csv

NF == 15 && $1 != "commit" {
    if (!($4 in known)) { known[$4] = 1; board[++boards] = $4 }
    if (!($5 in seen)) { seen[$5] = 1; scene[++scenes] = $5 }
    key = $4 SUBSEP $5
    instructions[key] = $8
    cycles[key] = $10 == "" ? "" : sprintf("%.0f", $10)
    obtained[key] = $12
    flash[key] = $13
    ram[key] = $14
    stack[key] = $15
    flags[$4] = $3
    gsub(/"/, "", flags[$4])
    compiler[$4] = $2
}

END {
    for (s = 1; s <= scenes; s++) {
        printf "%s`%s`:\n\n", (s > 1 ? "\n" : ""), scene[s]
        print "| board | instructions | cycles | flash, B | RAM, B | stack, B |"
        print "|---|---|---|---|---|---|"
        for (b = 1; b <= boards; b++) {
            key = board[b] SUBSEP scene[s]
            if (key in instructions) {
                printf "| `%s` | %.0f | %s | %d | %d | %d |\n", board[b], instructions[key], \
                    cycles[key] == "" ? "not counted" : cycles[key] ", " obtained[key], flash[key], ram[key], stack[key]
            }
        }
    }
    print "\n| board | compiler | flags |"
    print "|---|---|---|"
    for (b = 1; b <= boards; b++) {
        printf "| `%s` | %s | `%s` |\n", board[b], compiler[board[b]], flags[board[b]]
    }
}
