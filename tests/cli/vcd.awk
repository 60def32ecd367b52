# vcd.awk: `awk -f vcd.awk FILE.vcd FILE.csv` reads a value change dump of a run by IEEE 1364's grammar, as much of it as there
# may be, and holds it against the records of the same run: at each record's time every column must have the CSV's value, as
# printed. Writes a row for each record: time, columns, then each wire, and of each event how often it was and when last.
# Standard error has what is wrong, and the status is 1.
function wrong(what) {
    print FILENAME ":" FNR ": " what | "cat 1>&2"
    bad = 1
    exit 1
}
# what the dump is to call a column
function called(column) {
    sub(/ \[/, "_", column)
    gsub(/\[|\]/, "", column)
    return column ~ /^[A-Za-z_][A-Za-z0-9_$]*$/ ? column : "\\" column
}
# changes up to this time are done
function go_on_to(tick,    mark) {
    for (; at <= changes && tick_of[at] <= tick; at++) {
        mark = mark_of[at]
        if (kind[mark] == "event") {
            times[mark]++
            last[mark] = tick_of[at]
        } else {
            value[mark] = value_of[at]
        }
    }
}
BEGIN { depth = 0; ticks = -1; at = 1; empty = 0 }

# --- the dump ------------------------------------------------------------------------------------------------------
FNR == NR && !defined && ($1 == "$comment" || $1 == "$version") {
    if ($NF != "$end") wrong("a comment without end")
    for (i = 2; i < NF; i++) if ($i == "$end") wrong("a comment that ends early")
    next
}
FNR == NR && !defined && $1 == "$timescale" {
    if (NF != 3 || $2 !~ /^(1|10|100)([munpf]?s)$/ || $3 != "$end") wrong("no time scale: " $0)
    size = $2 + 0
    unit = $2; sub(/^[0-9]*/, "", unit)
    per_s = unit == "s" ? 1 : unit == "ms" ? 1e3 : unit == "us" ? 1e6 : unit == "ns" ? 1e9 : unit == "ps" ? 1e12 : 1e15
    per_s /= size
    next
}
FNR == NR && !defined && $1 == "$scope" { if (NF != 4 || $2 != "module" || $4 != "$end") wrong("no scope: " $0); scope[++depth] = $3; next }
FNR == NR && !defined && $1 == "$upscope" { if (depth-- < 1) wrong("a scope too few"); next }
FNR == NR && !defined && $1 == "$var" {
    if (NF != 6 || $6 != "$end" || depth < 1) wrong("no variable: " $0)
    if ($2 " " $3 != "real 64" && $2 " " $3 != "wire 1" && $2 " " $3 != "event 1") wrong("of no kind: " $0)
    if ($4 in kind) wrong("a mark twice: " $0)
    if ($4 !~ /^[!-~]+$/) wrong("no mark: " $0)
    if ($5 !~ /^[A-Za-z_][A-Za-z0-9_$]*$/ && $5 !~ /^\\[!-~]+$/ || $5 ~ /\[|\]|:/) wrong("no name: " $0)
    if ((depth, scope[depth], $5) in named) wrong("a name twice: " $0)
    named[depth, scope[depth], $5] = 1
    kind[$4] = $2
    name[$4] = $5
    marks[++signals] = $4
    if ($2 == "real" && depth == 1) column_mark[++columns] = $4
    next
}
FNR == NR && !defined && $1 == "$enddefinitions" { if (depth != 0 || !per_s) wrong("ends in a scope, or without time scale"); defined = 1; next }
FNR == NR && /^#/ {
    tick = substr($0, 2)
    if (tick !~ /^[0-9]+$/ || tick + 0 <= ticks) wrong("time does not rise: " $0)
    if (empty) wrong("a time before it at which nothing changes")
    if (ticks < 0 && tick + 0 != 0) wrong("does not begin at 0")
    ticks = tick + 0
    empty = 1
    next
}
FNR == NR {
    if (!defined) wrong("in the head: " $0)
    if (/^r/ && NF == 2) { mark = $2; to = substr($1, 2) } else if (/^[01x]/ && NF == 1) { mark = substr($0, 2); to = substr($0, 1, 1) } else wrong("no change: " $0)
    if (!(mark in kind) || (kind[mark] == "real") != (NF == 2)) wrong("of no signal: " $0)
    if (ticks < 0) wrong("a change before all time")
    if (kind[mark] == "event" ? to != 1 : now[mark] == to) wrong("no change: " $0)
    if (to == "x") wrong("unknown: " name[mark])
    now[mark] = to
    changes++
    tick_of[changes] = ticks; mark_of[changes] = mark; value_of[changes] = to
    empty = 0
    next
}

# --- the records ---------------------------------------------------------------------------------------------------
{ sub(/\r$/, ""); fields = split($0, field, ",") }
FNR == 1 {
    if (!defined) wrong("the dump has no end of its head")
    if (fields - 1 != columns) wrong(fields - 1 " columns, but the dump has " columns)
    for (i = 2; i <= fields; i++) if (name[column_mark[i - 1]] != called(field[i])) wrong(field[i] " is " name[column_mark[i - 1]])
    next
}
{
    tick = sprintf("%.0f", field[1] * per_s) + 0
    if (sprintf("%.15g", tick / per_s) != field[1] && per_s < 1e15) wrong("the time " field[1] " is lost")
    if (tick <= record_tick && FNR > 2) wrong("two records at " tick)
    earlier_tick = record_tick + 0
    record_tick = tick
    go_on_to(tick)
    line = field[1]
    for (i = 2; i <= fields; i++) {
        if (value[column_mark[i - 1]] != field[i] "") wrong("at " field[1] " " name[column_mark[i - 1]] " is " value[column_mark[i - 1]] ", not " field[i])
        line = line "," field[i]
    }
    for (i = 1; i <= signals; i++) {
        mark = marks[i]
        if (kind[mark] == "wire") line = line "," value[mark]
        if (kind[mark] == "event") line = line "," times[mark] + 0 "," sprintf("%.15g", last[mark] / per_s)
    }
    print line
}
END {
    if (!bad && (FNR == NR || FNR < 2)) { print "no records" | "cat 1>&2"; bad = 1 }
    if (!bad && (ticks < record_tick || FNR > 2 && ticks >= record_tick + (record_tick - earlier_tick))) {
        print "the dump ends at " ticks ", the records at " record_tick | "cat 1>&2"
        bad = 1
    }
    exit bad
}
