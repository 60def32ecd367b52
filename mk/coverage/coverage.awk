# coverage.awk: sums what gcov -b -c -t said of many objects (read one behind the other), over the files that `only`, a
# regular expression, matches. Prints a line for each file, in order, and their sum; what nothing reached goes into `missed`.
#
# A line counts once, however many objects hold it, and is reached if one of them ran it. A branch is one of the ways
# out of one condition (each operand of && and || is one, each case of a switch). Objects in which the compiler settled some
# of a line's conditions have fewer of its branches: these cannot be told apart by their numbers, so that only those
# objects speak of a line's branches that have the most of them; a branch is reached if one of these took it.
/^ *[-0-9#=*]+: *0:Source:/ {
    settle()
    file = $0
    sub(/^.*0:Source:(\.\/)?/, "", file)
    counted = file ~ only
    at = ""
    next
}
!counted { next }

# COUNT: LINE:TEXT
/^ *[-0-9#=]+\*?: *[0-9]+:/ {
    settle()
    split($0, part, ":")
    at = part[2] + 0 == 0 || part[1] ~ /-/ ? "" : file SUBSEP part[2] + 0
    if (at == "") next
    if (!(at in runs)) {
        runs[at] = 0
        lines[++all] = at
        text[at] = substr($0, length(part[1]) + length(part[2]) + 3)
    }
    if (part[1] !~ /#|=/) runs[at] = 1
    next
}
/^branch / { took[++ways] = $3 == "taken" && $4 + 0 > 0 }

# The branches of the last line of one object: joined to those of other objects that have as many.
function settle(    i) {
    if (at != "" && ways > most[at]) {
        most[at] = ways
        for (i = 1; i <= ways; i++) taken[at, i] = 0
    }
    for (i = 1; at != "" && i <= ways && ways == most[at]; i++) taken[at, i] = taken[at, i] || took[i]
    ways = 0
}
function share(part, whole) { return whole > 0 ? 100 * part / whole : 100 }
function told(name) {
    printf "%-34s %5d of %5d %6.2f %%   %5d of %5d %6.2f %%\n", name, n[name, "l"], n[name, "L"], share(n[name, "l"], n[name, "L"]),
        n[name, "b"], n[name, "B"], share(n[name, "b"], n[name, "B"])
}
# Of a file and of all.
function add(file, what, one) { n[file, what] += one; n["all", what] += one }

END {
    settle()
    for (k = 1; k <= all; k++) {
        at = lines[k]
        split(at, part, SUBSEP)
        if (!((part[1], "L") in n)) {
            for (i = count++; i > 0 && files[i] > part[1]; i--) files[i + 1] = files[i]
            files[i + 1] = part[1]
        }
        add(part[1], "L", 1)
        add(part[1], "l", runs[at])
        if (!runs[at]) printf "%s:%d: line:%s\n", part[1], part[2], text[at] > missed
        for (i = 1; i <= most[at]; i++) {
            add(part[1], "B", 1)
            add(part[1], "b", taken[at, i])
            if (runs[at] && !taken[at, i]) printf "%s:%d: branch %d of %d:%s\n", part[1], part[2], i, most[at], text[at] > missed
        }
    }
    printf "%-34s %-26s %s\n", "", "lines reached", "branches reached"
    for (k = 1; k <= count; k++) told(files[k])
    told("all")
    if (all == 0 || share(n["all", "l"], n["all", "L"]) < lines_least || share(n["all", "b"], n["all", "B"]) < branches_least) {
        printf "make coverage: less than %s %% of lines or %s %% of branches\n", lines_least, branches_least
        exit 1
    }
}
