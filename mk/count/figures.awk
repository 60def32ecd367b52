# figures.awk: joins the lines of the counted program (count and stack) with those of the counter (interval), and writes
# rows of
#     commit,board,compiler,flags,scene,number,method,metric,value
# Interval 0 is empty; its instructions are subtracted from every other interval.
# An interval of a method "...-multistep" holds 100 steps (boards/programs/bench.c).
# Cycles are written if the counter has them. `obtained` states their source ("estimated", "simulated"); a board that
# counts cycles itself prints silicon lines.
# Variables: commit, board, compiler, flags, obtained. Fails if an interval is missing.

function row(scene, number, method, metric, value) {
    printf "%s,%s,%s,\"%s\",%s,%s,%s,%s,%s\n", commit, board, compiler, flags, scene, number,
        method, metric, value
}

function row_cycles(how, least, median, most,    what) {
    what = how " cycles per " (name[g] == "wh_sincos" ? "sine-cosine pair" : "step")
    row(name[g], number[g], method[g], what " (minimum)", least)
    row(name[g], number[g], method[g], what " (median)", median)
    row(name[g], number[g], method[g], what " (maximum)", most)
}

function fail(what) {
    print "figures.awk: " what > "/dev/stderr"
    failed = 1
    exit 1
}

# Sorts value[1..n] by insertion.
function sort(value, n,    i, j, key) {
    for (i = 2; i <= n; i++) {
        key = value[i]
        for (j = i - 1; j >= 1 && value[j] > key; j--) {
            value[j + 1] = value[j]
        }
        value[j + 1] = key
    }
}

{ sub(/\r$/, "") }

$1 == "interval" { counted[$2] = $3 }
$1 == "cycles" { cycles[$2] = $3; timed = 1 }
$1 == "silicon" { silicon[$2] = $3 " " $4 " " $5 }
$1 == "unfinished" { fail("the program ended inside an interval") }
$1 == "failed" { print "figures.awk: " $0 > "/dev/stderr" }
$1 == "stack" { stack[$2] = $3 }

$1 == "count" {
    groups++
    name[groups] = $2
    method[groups] = $3
    number[groups] = $4
    first[groups] = $5
    last[groups] = $6
    held[groups] = $3 ~ /-multistep$/ ? 100 : 1
}

END {
    if (failed) {
        exit 1
    }
    if (groups == 0 || !(0 in counted)) {
        fail("nothing was counted")
    }
    for (g = 1; g <= groups; g++) {
        n = 0
        for (i = first[g]; i <= last[g]; i++) {
            if (!(i in counted)) {
                fail("interval " i " of " name[g] " is missing")
            }
            value[++n] = (counted[i] - counted[0]) / held[g]
        }
        sort(value, n)
        what = "instructions per " (name[g] == "wh_sincos" ? "sine-cosine pair" : "step")
        row(name[g], number[g], method[g], what " (minimum)", value[1])
        row(name[g], number[g], method[g], what " (median)", value[int((n + 1) / 2)])
        row(name[g], number[g], method[g], what " (maximum)", value[n])
        if (timed) {
            for (i = 1; i <= n; i++) {
                value[i] = (cycles[first[g] + i - 1] - cycles[0]) / held[g]
            }
            sort(value, n)
            row_cycles(obtained, value[1], value[int((n + 1) / 2)], value[n])
        }
        if (name[g] in silicon && held[g] == 1 && method[g] != "record") {
            split(silicon[name[g]], value, " ")
            row_cycles("measured", value[1], value[2], value[3])
        }
        if (name[g] in stack && stack[name[g]] > 0) {
            row(name[g], number[g], method[g], "stack bytes (measured)", stack[name[g]])
        }
    }
}
