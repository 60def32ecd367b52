# default_methods.awk: for each scene, board and error of the tables, divides the price of the cheapest row of the
# default methods by that of the cheapest row: awk -F, -f words.awk -f decades.awk -f default_methods.awk
# docs/figures/price.csv

FNR == 1 { header(); next }
{
    for (d = 1; d <= DECADES && field("error") + 0 <= decade(d); d++) {
        point = field("scene") " " field("board") " " decade_words(d)
        price = field("per_s") + 0
        if (!(point in all) || price < all[point]) { all[point] = price }
        if (field("method") !~ /^(rk4|nystroem[345])$/) { continue }
        if (!(point in few) || price < few[point]) { few[point] = price }
    }
}
END {
    for (point in all) { print (point in few) ? few[point] / all[point] : "none", point | "sort -g" }
}
