# figure.awk: one .fig file (figures.sh tells its form) as a gnuplot script without a terminal.
# Needs -v files=FILE with lines "NAME CSV".

function quoted(text) {
    gsub(/["\\]/, "\\\\&", text)
    return "\"" text "\""
}

# {name} -> column("name"), in brackets for gnuplot
function expression(text,    result) {
    result = ""
    while (match(text, /\{[^{}]*\}/)) {
        result = result substr(text, 1, RSTART - 1) "column(" \
            quoted(substr(text, RSTART + 1, RLENGTH - 2)) ")"
        text = substr(text, RSTART + RLENGTH)
    }
    return "(" result text ")"
}

function after_word(line) {
    sub(/^[a-z]+ +/, "", line)
    return line
}

function trim(text) {
    gsub(/^ +| +$/, "", text)
    return text
}

function wrong(what) {
    print FILENAME ":" FNR ": error: " what | "cat >&2"
    failed = 1
    exit 1
}

function finish_panel() {
    if (panels == 0) {
        return
    }
    if (curves[panels] == 0) {
        wrong("a panel without a curve")
    }
    text[panels] = text[panels] plot[panels] "\n"
}

BEGIN {
    while ((getline line < files) > 0) {
        split(line, part, " ")
        csv[part[1]] = part[2]
    }
    # Okabe and Ito's colours, apart for the colour-blind as well
    split("#0072B2 #D55E00 #009E73 #CC79A7 #E69F00 #56B4E9 #000000", colour, " ")
}

/^#/ || /^[ \t]*$/ { next }
$1 == "title" { title = after_word($0); next }
$1 == "caption" || $1 == "run" || $1 == "sweep" || $1 == "table" { next }
$1 == "panel" {
    finish_panel()
    panels++
    ylabel[panels] = after_word($0)
    next
}
panels == 0 { wrong("before the first panel: " $0) }
$1 == "xlabel" { xlabel[panels] = after_word($0); next }
$1 == "set" { text[panels] = text[panels] $0 "\n"; next }
$1 == "curve" || $1 == "law" {
    n = split(after_word($0), field, "|")
    for (i = 1; i <= n; i++) {
        field[i] = trim(field[i])
    }
    k = ++curves[panels]
    plot[panels] = plot[panels] (k == 1 ? "plot " : ", \\\n     ")
    if ($1 == "law") {
        name = field[2]
        plot[panels] = plot[panels] "(" field[1] ") with lines lw 1.2 dt 2 lc rgb '#444444'"
    } else {
        if (!(field[1] in csv)) {
            wrong("no run, sweep or table is called " field[1])
        }
        name = field[4]
        style = n >= 5 ? field[5] : "lines lw 1.8"
        plot[panels] = plot[panels] quoted(csv[field[1]]) " using " expression(field[2]) ":" \
            expression(field[3]) " with " style
        if (style !~ / lc /) {
            plot[panels] = plot[panels] " lc rgb '" colour[k] "'"
        }
    }
    named[panels] += name != "-"
    plot[panels] = plot[panels] (name == "-" ? " notitle" : " title " quoted(name))
    next
}
{ wrong("what is " $1 "?") }

END {
    if (failed) {
        exit 1
    }
    if (panels == 0 || title == "") {
        wrong("a figure needs a title and a panel")
    }
    finish_panel()
    print "set encoding utf8"
    print "set datafile separator comma"
    print "set samples 120"
    print "set border lw 1 lc rgb '#444444'"
    print "set grid lt 1 lw 0.7 lc rgb '#e2e2e2'"
    print "set tics nomirror textcolor rgb '#222222'"
    print "set lmargin 12"
    print "set rmargin 3"
    # a line of air between the title and a key below it
    print "set multiplot layout " panels ",1 title " quoted(title) (named[1] > 0 ? ".\"\\n\"" : "")
    for (p = 1; p <= panels; p++) {
        print "set key above center horizontal samplen 3"
        print "set xlabel " quoted(p in xlabel ? xlabel[p] : p == panels ? "time [s]" : "")
        print "set ylabel " quoted(ylabel[p])
        if (named[p] == 0) {
            print "unset key"
        }
        printf "%s", text[p]
        print "unset arrow; unset label; unset logscale; set format"
        print "set xrange [*:*]; set yrange [*:*]; set xtics autofreq; set ytics autofreq"
    }
    print "unset multiplot"
    print "unset output"
}
