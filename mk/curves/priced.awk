# priced.awk: writes every row of runs.sh for each board, with the price of a step on that board:
#
#   awk -F, -v out=OUT -f words.awk -f priced.awk [COUNTED/settings.csv] OUT/SCENE@BOARD.csv... OUT/SCENE.csv...
#
# A setting without a predicted price on a board gets its price from settings.csv of count.sh, whatever step was counted.
# If settings.csv lacks the setting, the row is omitted. `-v missing=BOARD` prints such rows instead, for count.sh.

FNR == 1 {
    header()
    board = FILENAME
    sub(/.*\//, "", board)
    sub(/\.csv$/, "", board)
    scene = board
    sub(/@.*/, "", scene)
    counts = scene == "settings"
    if (board !~ /@/) { board = "" }
    sub(/.*@/, "", board)
    if (!counts && board == "") { horizon(scene) }
    next
}

{ plain_row() }

# Returns the end of the motion as the rows show it ("9.54 s of 10 s" if the horizon ends earlier), and the number of
# records: 1000 to 2500 for the whole motion, with a spacing of 1, 2 or 5 times a power of ten.
function horizon(scene,    line, part, whole, spacing) {
    while ((getline line < (out "/" scene ".txt")) > 0) {
        if (line ~ /^  horizon /) {
            split(line, part, " ")
            until_s = part[2]
            whole = part[4] == "of" ? part[5] : part[2]
            for (spacing = 1e-9; whole / (10 * spacing) > 999.999; spacing *= 10) { }
            spacing *= whole / (5 * spacing) > 999.999 ? 5 : whole / (2 * spacing) > 999.999 ? 2 : 1
            records = int(until_s / spacing + 0.5)
        }
    }
    close(out "/" scene ".txt")
}

function put(scene, board, key, unit, instructions, cycles, basis, bytes) {
    if (!((scene, board) in known)) {
        known[scene, board] = 1
        boards[scene] = boards[scene] " " board
    }
    of[scene, board, key] = unit
    a_step[scene, board, key] = unit == "cycles" ? cycles : instructions
    rest[scene, board, key] = instructions "," cycles "," basis "," bytes
}

counts {
    put(field("scene"), field("board"), setting_of(field("run")), field("cycles") == "" ? "instructions" : "cycles", \
        field("instructions"), field("cycles"), "counted at " option_of(field("run"), "--step"), \
        field("flash") "," field("ram") "," field("stack"))
    next
}

board != "" {
    key = setting_of(field("run"))
    if (!((scene, board, key) in of) && field("price_of") != "evaluations") {
        step = sprintf("%.6g", field("price_per_s") * field("step_s"))
        put(scene, board, key, field("price_of"), field("price_of") == "instructions" ? step : "", \
            field("price_of") == "cycles" ? step : "", "predicted", \
            sprintf("%.0f,%.0f,%.0f", field("flash_bytes"), field("ram_bytes"), field("stack_bytes")))
    }
    next
}

missing != "" {
    key = setting_of(field("run"))
    if (!((scene, missing, key) in of) && (!((scene, key) in case_of) || field("error") > 1e-4)) {
        case_of[scene, key] = scene "," field("run")
    }
    next
}

{
    key = setting_of(field("run"))
    n = split(boards[scene], each, " ")
    for (i = 1; i <= n; i++) {
        if ((scene, each[i], key) in of) {
            print scene, each[i], field("error"), field("component"), records, field("step_s"), until_s, \
                of[scene, each[i], key], sprintf("%.6g", a_step[scene, each[i], key] / field("step_s")), \
                rest[scene, each[i], key], field("method"), field("number"), field("run")
        }
    }
}

END {
    for (key in case_of) { print case_of[key] }
}
