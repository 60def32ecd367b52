# chart.awk: writes a gnuplot script, without a terminal, that draws error against price of one scene:
#
#   awk -F, -v scene=SCENE -v boards="BOARD..." -f words.awk -f chart.awk ROWS.csv    a panel for each board
#   awk -F, -v scene=SCENE -v fronts="BOARD..." -f words.awk -f chart.awk PRICE.csv   one panel: only the boards' fronts
#
# A panel shows the front and the seven settings with the most rows on it. Each method has its colour and shape
# (host/io/gnuplot.h), each number type its dash; points go from coarse to fine steps, in the cheapest form of the other
# choices. ROWS.csv comes from curves.sh, PRICE.csv from published.awk. `title` is the chart's title.

BEGIN {
    colour_count = split(colours, colour, " ")
    shape_count = split(shapes, point, " ")
    for (known = split(methods, known_method, " "); known > 0; known--) { place[known_method[known]] = known }
    panels = split(boards != "" ? boards : fronts, board, " ")
}

FNR == 1 { header(); next }

{ plain_row() }

field("scene") != scene { next }

{
    b = field("board")
    x = field("per_s") + 0
    y = field("error") + 0
    unit[b] = field("price_of")
    until_s = field("until_s")
    if ("core" in at) { core[b] = field("core") }
}

fronts != "" || field("front") == 1 {
    front[b] = front[b] x " " y "\n"
    ends[b] = field("basis")
}

fronts == "" && y <= 1 && y >= 1e-10 {
    series = field("method") SUBSEP field("number")
    if (!((b, series) in hits)) { hits[b, series] = 0; line[b, ++lines[b]] = series }
    hits[b, series] += field("front") == 1
    if (!(field("number") in dash)) { dash[field("number")] = ++numbers }
    # rows come by rising price
    if (!((b, series, field("step_s")) in drawn)) {
        drawn[b, series, field("step_s")] = 1
        points[b, series] = points[b, series] x " " y "\n"
        if (field("basis") ~ /^counted at/) { at_one_step[b] = " or counted once" }
    }
}

function quoted(text) {
    gsub(/["\\]/, "\\\\&", text)
    return "\"" text "\""
}

function data(name, rows) {
    printf "$%s << EOD\n%sEOD\n", name, rows
}

function axes(what) {
    print "set xlabel " quoted(what) " noenhanced"
    print "set ylabel " quoted("largest error / largest value, to " until_s " s") " noenhanced"
    print "set logscale xy"
    print "set format '10^{%L}'"
    print "set yrange [1e-10:1]"
}

# Colour and shape of a method (host/io/gnuplot.h).
function look(name) {
    return "pt " point[(place[name] - 1) % shape_count + 1] " lc rgb '" colour[(place[name] - 1) % colour_count + 1] "'"
}

# Returns the series of that panel with the most rows on the front; "" if all are drawn already.
function next_series(b,    i, best) {
    for (i = 1; i <= lines[b]; i++) {
        if (!((b, line[b, i]) in shown) && (best == "" || hits[b, line[b, i]] > hits[b, best])) { best = line[b, i] }
    }
    if (best != "") { shown[b, best] = 1 }
    return best
}

function panel(b,    k, n, plot, series, part) {
    data("front", front[b])
    plot = "$front using 1:2 with lines lw 4 lc rgb '#767676' title 'front: the least error for its price'"
    for (k = 1; k <= 7 && (series = next_series(b)) != ""; k++) {
        split(series, part, SUBSEP)
        data("d" (++n), points[b, series])
        plot = plot ", \\\n     $d" n " using 1:2 with linespoints lw 1 ps 0.6 dt " dash[part[2]] " " look(part[1]) \
            " title " quoted(part[1] ", " part[2])
    }
    plot = plot ", \\\n     $front using 1:2 with points pt 6 ps 1.3 lw 1.5 lc rgb '#000000' title " \
        quoted("on the front, " ends[b])
    axes(unit[b] " a simulated second, " b " (without a ring: predicted" at_one_step[b] ")")
    print "plot " plot
}

function lines_of_boards(    i, plot) {
    for (i = 1; i <= panels; i++) {
        data("f" i, front[board[i]])
        plot = plot (i > 1 ? ", \\\n     " : "") "$f" i " using 1:2 with linespoints lw 2 pt " (ends[board[i]] == "counted" ? 7 : 6) \
            " ps 0.8 lc rgb '" colour[i] "' title " quoted(core[board[i]] ", " board[i] ", " ends[board[i]])
    }
    axes("cycles a simulated second")
    print "plot " plot
}

END {
    if (failed) { exit 1 }
    for (i = 1; i <= panels; i++) {
        if (front[board[i]] == "") { wrong("no front of " scene " on " board[i]) }
    }
    print "set encoding utf8"
    print "set border lw 1 lc rgb '#767676'"
    print "set grid lt 1 lw 0.7 lc rgb '#d8d8d8'"
    print "set tics nomirror textcolor rgb 'black'"
    print "set lmargin 12"
    if (fronts != "") {
        print "set key inside bottom left Left reverse samplen 2 font ',12' noenhanced"
        print "set title " quoted(title) " noenhanced"
        lines_of_boards()
    } else {
        print "set rmargin 34\nset key at graph 1.02,1 left top Left reverse samplen 2 font ',12' noenhanced"
        print "set multiplot layout " panels ",1 title " quoted(title) " noenhanced"
        for (i = 1; i <= panels; i++) { panel(board[i]) }
        print "unset multiplot"
    }
    print "unset output"
}
