# turn_tables.awk: what tables of an angle's functions cost, as tables in Markdown: one a scene.
#
#   awk -f turn_tables.awk ERRORS ROWS
#
# ERRORS is what turn_errors.sh prints, ROWS the lines of turn_tables.sh of all boards.

function words(setting) {
    if (setting ~ /_/) {
        split(setting, part, "_")
        return "`" part[1] "`, " part[2] " cells"
    }
    return "computed, `" setting "`"
}

FNR == NR { off[$1, $2] = $3; next }

{
    if (!($1 in known)) { known[$1] = 1; board[++boards] = $1 }
    if (!($2 in seen)) { seen[$2] = 1; scene[++scenes] = $2 }
    if (!($3 in named)) { named[$3] = 1; setting[++settings] = $3 }
    cost[$1, $2, $3] = $4 ", " $5 ", " sprintf("%.1f", $6 / 1024)
}

END {
    for (s = 1; s <= scenes; s++) {
        printf "%s`%s`:\n\n| accelerations | error, rad |", (s > 1 ? "\n" : ""), scene[s]
        for (b = 1; b <= boards; b++) { printf " `%s` |", board[b] }
        printf "\n|---|---|"
        for (b = 1; b <= boards; b++) { printf "---|" }
        print ""
        for (i = 1; i <= settings; i++) {
            printf "| %s | %s |", words(setting[i]), off[scene[s], setting[i]]
            for (b = 1; b <= boards; b++) { printf " %s |", cost[board[b], scene[s], setting[i]] }
            print ""
        }
    }
}
