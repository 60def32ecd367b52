# tables.awk: writes the blocks of the pages from docs/figures/price.csv:
#
#   awk -F, -v block=BLOCK -f words.awk -f decades.awk -f tables.awk docs/figures/price.csv
#
# BLOCK is one of: `chips SCENE BOARD...`, for each board a table of the cheapest setting within each decade of the error;
# `boards SCENE`, the prices on every board; `first SCENE BOARD...`, some decades on these boards, in one table.

FNR == 1 {
    header()
    words = split(block, word, " ")
    next
}

{ plain_row() }

field("scene") == word[2] {
    board = field("board")
    if (!(board in core)) {
        order[++boards] = board
        core[board] = field("core")
        unit[board] = field("price_of")
    }
    for (d = 1; d <= DECADES; d++) {
        if (field("error") <= decade(d) && (!((board, d) in price) || field("per_s") < price[board, d])) {
            price[board, d] = field("per_s") + 0
            error[board, d] = field("error") + 0
            basis[board, d] = field("basis")
            flash[board, d] = field("flash")
            ram[board, d] = field("ram") + field("stack")
            run[board, d] = field("run")
            method[board, d] = field("method")
            number[board, d] = field("number")
            step[board, d] = field("step_s") + 0
        }
    }
}

function about(board, d) { return basis[board, d] == "predicted" ? "~" : "" }

# Bytes; predicted ones have three digits.
function rounded(board, d, value,    unit) {
    if (about(board, d) == "") { return sprintf("%d", value) }
    for (unit = 1; value >= 1000 * unit; unit *= 10) { }
    return sprintf("~%d", int(value / unit + 0.5) * unit)
}

function chips(    i, board, d) {
    for (i = 3; i <= words; i++) {
        board = word[i]
        if (!(board in core)) { wrong("no row of " word[2] " on " board) }
        printf "%s%s, `%s`:\n\n", (i > 3 ? "\n" : ""), core[board], board
        print "| error within | it is | " unit[board] "/s | flash, B | RAM and stack, B | setting |"
        print "|---|---|---|---|---|---|"
        for (d = 1; d <= DECADES; d++) {
            if ((board, d) in price) {
                printf "| %s | %.1e | %s%s | %s | %s | `%s --step %s` |\n", decade_words(d), error[board, d], \
                    about(board, d), short(price[board, d]), rounded(board, d, flash[board, d]), \
                    rounded(board, d, ram[board, d]), setting_of(run[board, d]), option_of(run[board, d], "--step")
            } else {
                print "| " decade_words(d) " | – | | | | |"
            }
        }
    }
}

function all_boards(    i, d, line) {
    printf "| board | core | a second |"
    for (d = 1; d <= DECADES; d++) { printf " %s |", decade_words(d) }
    printf "\n|---|---|---|"
    for (d = 1; d <= DECADES; d++) { printf "---|" }
    print ""
    for (i = 1; i <= boards; i++) {
        line = "| `" order[i] "` | " core[order[i]] " | " unit[order[i]] " |"
        for (d = 1; d <= DECADES; d++) {
            line = line " " ((order[i], d) in price ? about(order[i], d) short(price[order[i], d]) : "–") " |"
        }
        print line
    }
}

# The words for the form, if an option selects one.
function form_words(run) {
    return (run ~ / --tables / ? ", " option_of(run, "--tables") " tables" : "") \
        (run ~ / --matrix / ? ", one matrix" : "")
}

function first(    i, d) {
    printf "| error within |"
    for (i = 3; i <= words; i++) { printf " %s, `%s` |", core[word[i]], word[i] }
    printf "\n|---|"
    for (i = 3; i <= words; i++) { printf "---|" }
    print ""
    for (d = 2; d <= 8; d += 2) {
        printf "| %s |", decade_words(d)
        for (i = 3; i <= words; i++) {
            if ((word[i], d) in price) {
                printf " %s%s: %s, %s%s, %s |", about(word[i], d), short(price[word[i], d]), method[word[i], d], \
                    number[word[i], d], form_words(run[word[i], d]), step_words(step[word[i], d])
            } else {
                printf " – |"
            }
        }
        print ""
    }
}

END {
    if (failed) { exit 1 }
    if (boards == 0) { wrong("no row of " word[2]) }
    if (word[1] == "chips") { chips() }
    else if (word[1] == "boards") { all_boards() }
    else if (word[1] == "first") { first() }
    else { wrong("what is " word[1] "?") }
}
