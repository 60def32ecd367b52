# precision.awk: what each error costs, from counts (scene method sums instructions) and what tests/tools/precision says. The step
# that an error takes lies between two that were run, on the line between their logarithms; where inputs jump, at one that
# was run. A step counts with the larger error of its own and of the next smaller one: none is chosen for its luck. Writes
# tables of thousand instructions a simulated second; the least of each column is bold. -v all=1: one table a scene.
function log10(x) { return log(x) / log(10) }

FILENAME ~ /counts$/ { price[$1, $2, $3] = $4; next }
$1 == "reference" { order[++scenes] = $2 " " $3; apart[$2 " " $3] = $4; next }
$1 == "error" {
    key = $2 " " $3 SUBSEP $4 SUBSEP $5
    n = ++count[key]
    step[key, n] = $6
    off[key, n] = $7 == "inf" ? 1e30 : $7 + 0
    if (!($4 in seen)) { seen[$4] = 1; method[++methods] = $4 }
}

# Thousand instructions a second that keep method m below `target`; -1: no step does. Steps come largest first.
function cost(where, m, sums, target,    key, n, i, part, worse, before, h, instructions) {
    key = where SUBSEP m SUBSEP sums
    n = count[key]
    split(where, part, " ")
    instructions = price[part[1], m, sums]
    if (instructions == "") { return -1 }
    before = 0
    for (i = 1; i < n; i++) {
        worse = off[key, i] > off[key, i + 1] ? off[key, i] : off[key, i + 1]
        if (worse <= target) {
            h = step[key, i]
            if (before && before < 1e29 && part[2] == "steady" && worse < before) {
                h *= (step[key, i - 1] / h) ^ (log(target / worse) / log(before / worse))
            }
            return instructions / h * 1e3
        }
        before = worse
    }
    return -1
}

function shown(value) { return value < 100 ? sprintf("%.1f", value) : sprintf("%.0f", value) }

END {
    split("float compensated double", kinds, " ")
    for (k = 1; k <= 3; k++) {
        sums = kinds[k]
        first = 1
        last = sums == "float" ? 5 : sums == "compensated" ? 6 : 10
        for (s = 1; s <= scenes; s++) {
            where = order[s]
            if (all || s == 1) {
                if (all) { printf "\n%s, %s (references %s apart)\n", where, sums, apart[where] }
                else { printf "\n%s:\n\n", sums }
                printf all ? "| method |" : "| scene, inputs |"
                for (t = first; t <= last; t++) { printf " 1e-%d |", t }
                printf "\n|---|"
                for (t = first; t <= last; t++) { printf "---|" }
                printf "\n"
            }
            for (t = first; t <= last; t++) {
                least[t] = -1
                for (m = 1; m <= methods; m++) {
                    c = at[m, t] = cost(where, method[m], sums, 10 ^ -t)
                    if (c >= 0 && (least[t] < 0 || c < least[t])) { least[t] = c; by[t] = method[m] }
                }
                if (least[t] >= 0) { wins[by[t]] = wins[by[t]] " " where "/" sums "/1e-" t }
            }
            if (all) {
                for (m = 1; m <= methods; m++) {
                    printf "| %s |", method[m]
                    for (t = first; t <= last; t++) {
                        c = at[m, t]
                        printf c < 0 ? " |" : c == least[t] ? " **%s** |" : " %s |", shown(c)
                    }
                    printf "\n"
                }
            } else {
                sub(" ", ", ", where)
                printf "| %s |", where
                for (t = first; t <= last; t++) {
                    rk4 = -1
                    for (m = 1; m <= methods; m++) { if (method[m] == "rk4") { rk4 = at[m, t] } }
                    if (least[t] < 0) { printf " |" }
                    else if (by[t] == "rk4") { printf " `rk4` %s |", shown(least[t]) }
                    else { printf " `%s` %s (%s) |", by[t], shown(least[t]), rk4 < 0 ? "-" : shown(rk4) }
                }
                printf "\n"
            }
        }
    }
    if (all) { for (m = 1; m <= methods; m++) { print method[m] " wins:" wins[method[m]] } }
}
