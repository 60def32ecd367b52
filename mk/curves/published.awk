# published.awk: writes docs/figures/price.csv: the rows of curves.sh that the pages and charts show.
#
#   awk -F, -v out=OUT -v counted=BOARDS -f words.awk -f decades.awk -f published.awk ROWS.csv
#
# For boards with a counted front, these are the counted rows. For the others, whose prices are predicted, it is the
# cheapest row within each decade of the error. `core` is the name of the board's processor in `whirl price`.

FNR == 1 {
    header()
    columns = $0
    sub(/,front$/, "", columns)
    print "core," columns
    next
}

{
    board = field("board")
    rest = $0
    sub(/,[01]$/, "", rest)
    if (index(" " counted " ", " " board " ") > 0) {
        take = field("front") == 1 && field("basis") == "counted"
    } else {
        # rows come by rising price: the first within a decade is the cheapest
        take = 0
        for (d = 1; d <= DECADES; d++) {
            if (field("error") <= decade(d) && !((field("scene"), board, d) in has)) {
                has[field("scene"), board, d] = take = 1
            }
        }
    }
    if (take) { print core(field("scene"), board) "," rest }
}

function core(scene, board,    line) {
    if (!(board in name)) {
        name[board] = board
        if ((getline line < (out "/" scene "@" board ".txt")) > 0 && match(line, /\(.*\)/)) {
            name[board] = substr(line, RSTART + 1, RLENGTH - 2)
        }
        close(out "/" scene "@" board ".txt")
    }
    return name[board]
}
