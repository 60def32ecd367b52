# again.awk: computes the error of one row again, from the records of its own command line, of a reference, and of a
# coarser reference:
#
#   awk -F, -v component="X'" -v each=SPACING -v wanted=ERROR -f again.awk REFERENCE COARSER RECORDS
#
# The error is the component's largest deviation at the records, relative to its largest value. Prints the error, the
# difference of the two references, and whether the row agrees. The allowed difference is a hundredth, plus three times the
# difference of the references, plus the round-off of the records' last digit: floats and fixed point have nine digits.

FNR == 1 {
    which++
    column = component
    rate = sub(/'$/, "", column)
    if (rate) { column = "der(" column ")" }
    at = 0
    for (i = 1; i <= NF; i++) {
        name = $i
        sub(/\r$/, "", name)
        sub(/ \[.*\]$/, "", name)
        if (name == column) { at = i }
    }
    if (!at) {
        print "there is no column " column > "/dev/stderr"
        failed = 1
        exit 2
    }
    next
}

{
    n = int($1 / each + 0.5)
    value = $at + 0
}

which == 1 {
    true_[n] = value
    if (size(value) > largest) { largest = size(value) }
    next
}

!(n in true_) { next }

{
    off = size(value - true_[n])
    if (off > worst[which]) { worst[which] = off }
    if (which == 3 && places($at) > digits) { digits = places($at) }
    count[which]++
}

function size(v) { return v < 0 ? -v : v }

# number of significant digits in the text
function places(text) {
    sub(/[eE].*/, "", text)
    gsub(/[^0-9]/, "", text)
    sub(/^0+/, "", text)
    return length(text)
}

END {
    if (failed) { exit 2 }
    if (count[3] < 3 || count[2] < 3 || largest == 0) {
        print "too few records" > "/dev/stderr"
        exit 2
    }
    again = worst[3] / largest
    unsure = worst[2] / largest
    last = 10 ^ (int(log(largest) / log(10) + 1000) - 999 - digits) / largest
    good = size(again - wanted) <= 0.01 * wanted + 3 * unsure + last / 2
    printf "%.3e,%.1e,%s\n", again, unsure, good ? "agrees" : "differs"
}
