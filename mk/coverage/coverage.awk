# coverage.awk: sums what gcov -b -c -t said of many objects (read one behind the other), over the files that `only`, a
# regular expression, matches. Prints a line for each file and their sum; what nothing reached goes into `missed`.
#
# A line counts once, however many objects hold it, and is reached if one of them ran it. A branch is one of the ways
# out of one condition (each operand of && and || is one, each case of a switch). Objects in which the compiler settled some
# of a line's conditions have fewer of its branches: these cannot be told apart by their numbers, so that only those
# objects speak of a line's branches that have the most of them; a branch is reached if one of these took it.
/^ *[-0-9#=*]+: *0:Source:/ {
    settle()
    file = $0
    sub(/^.*0:Source:/, "", file)
    sub(/^\.\//, "", file)
    counted = file ~ only
    line = 0
    next
}
!counted { next }

# COUNT: LINE:TEXT
/^ *[-0-9#=]+\*?: *[0-9]+:/ {
    settle()
    split($0, part, ":")
    line = part[2] + 0
    if (line == 0 || part[1] ~ /-/) {
        line = 0
        next
    }
    at = file SUBSEP line
    if (!(at in runs)) {
        runs[at] = 0
        lines[++all] = at
        text[at] = substr($0, length(part[1]) + length(part[2]) + 3)
    }
    if (part[1] !~ /#|=/) {
        runs[at] = 1
    }
    next
}

/^branch / {
    ways++
    took[ways] = $3 == "taken" && $4 + 0 > 0
    next
}

# The branches of the last line of one object: joined to those of other objects that have as many.
function settle(    at, i) {
    if (line > 0 && ways > 0) {
        at = file SUBSEP line
        if (ways > most[at]) {
            most[at] = ways
            for (i = 1; i <= ways; i++) {
                taken[at, i] = 0
            }
        }
        for (i = 1; i <= ways && ways == most[at]; i++) {
            taken[at, i] = taken[at, i] || took[i]
        }
    }
    ways = 0
}

function share(part, whole) { return whole > 0 ? 100 * part / whole : 100 }

function told(name, l, ll, b, bb) {
    printf "%-34s %5d of %5d %6.2f %%   %5d of %5d %6.2f %%\n", name, l, ll, share(l, ll), b, bb, share(b, bb)
}

END {
    settle()
    for (n = 1; n <= all; n++) {
        at = lines[n]
        split(at, part, SUBSEP)
        file = part[1]
        if (!(file in line_all)) {
            files[++count] = file
        }
        line_all[file]++
        line_run[file] += runs[at]
        if (!runs[at]) {
            printf "%s:%d: line:%s\n", file, part[2], text[at] > missed
        }
        for (i = 1; i <= most[at]; i++) {
            way_all[file]++
            way_run[file] += taken[at, i]
            if (runs[at] && !taken[at, i]) {
                printf "%s:%d: branch %d of %d:%s\n", file, part[2], i, most[at], text[at] > missed
            }
        }
    }
    sort_files()
    printf "%-34s %-26s %s\n", "", "lines reached", "branches reached"
    for (n = 1; n <= count; n++) {
        file = files[n]
        told(file, line_run[file], line_all[file], way_run[file], way_all[file])
        l += line_run[file]
        ll += line_all[file]
        b += way_run[file]
        bb += way_all[file]
    }
    told("all", l, ll, b, bb)
    if (ll == 0 || share(l, ll) < lines_least || share(b, bb) < branches_least) {
        printf "make coverage: less than %s %% of lines or %s %% of branches\n", lines_least, branches_least
        exit 1
    }
}

function sort_files(    i, j, one) {
    for (i = 2; i <= count; i++) {
        one = files[i]
        for (j = i - 1; j > 0 && files[j] > one; j--) {
            files[j + 1] = files[j]
        }
        files[j + 1] = one
    }
}
