# choose_error.awk: how far a run is off a reference, from records of `whirl run --csv`:
#
#   awk -F, -v of="der(X)" -f choose_error.awk FINER.csv COARSER.csv [RUN.csv]
#
# The references are two runs, the second by twice the step: what they differ by is what is not known. Without `of`, the error is
# that of each coordinate and rate (a column x that has a der(x), and that one) as a part of its largest value, and of
# these the worst; a column that the references do not know to a hundredth of its largest value, or that is below 1e-12 of
# the largest number there is, is left out, for it is nothing but rounding. Prints "ERROR UNKNOWN COLUMN ROWS"; inf for a run that ends early. Without RUN, of `of`:
# "LARGEST UNKNOWN COLUMN ROWS".
function size(v) { return v < 0 ? -v : v }
{ sub(/\r$/, "") } # CSV's lines end so
FNR == 1 {
    file++
    if (file == 1) {
        columns = NF
        for (i = 1; i <= NF; i++) { at[$i] = i; name[i] = $i; gsub(/ /, "_", name[i]) }
        for (i = 2; i <= NF; i++) {
            if (of != "" ? $i == of : ($i in at) && ("der(" $i ")" in at || $i ~ /^der\(/)) { wanted[i] = 1; found = 1 }
        }
        if (!found) { print "choose_error.awk: there is no column " of > "/dev/stderr"; failed = 1; exit 1 }
    }
    next
}
file == 1 {
    rows = FNR
    time[FNR] = $1
    for (i in wanted) {
        value[FNR, i] = $i
        if (size($i) > largest[i]) { largest[i] = size($i) }
        if (size($i) > all) { all = size($i) }
    }
    next
}
file == 2 {
    for (i in wanted) {
        off = size($i - value[FNR, i])
        if (off > unknown[i]) { unknown[i] = off }
    }
    next
}
{
    if (size($1 - time[FNR]) > 1e-9 * time[rows]) { next } # the end, where it is no multiple
    seen = FNR
    for (i in wanted) {
        if (of == "" && !(unknown[i] < 0.01 * largest[i] && largest[i] > 1e-12 * all)) { continue }
        off = size($i - value[FNR, i]) / (of == "" ? largest[i] : 1)
        if (!(off <= error)) { error = off; worst = i }
    }
}
END {
    if (failed) { exit 1 }
    if (file == 2) {
        for (i in wanted) { print largest[i] + 0, unknown[i] + 0, name[i], rows - 1 }
        exit 0
    }
    if (!worst) { for (i in wanted) { worst = i } }
    if (seen < rows - 1 || error != error) { error = "inf" }
    printf "%s %.3g %s %d\n", error == "inf" ? error : sprintf("%.6g", error), \
        unknown[worst] / (of == "" ? largest[worst] : 1), name[worst], seen - 1
}
