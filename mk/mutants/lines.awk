# lines.awk [-v all=1] [BLOCKS MAP]...: the lines that a test reached, of each file one line: "file line line ...". BLOCKS are of
# blocks.awk, MAP what cmp -l says of that program's map and /dev/zero: the places of bytes that are set (one line at least). With
# `all` there are no MAPs: all lines that there is code of.
FNR == 1 && (table = all || ++file % 2 == 1) { split("", block) }
table && !all { block[$1] = $0; next }
table || $1 in block {
    n = split(table ? $0 : block[$1], part, " ")
    for (i = 2; i <= n; i++) {
        if (!(part[i] in reached)) {
            reached[part[i]]
            split(part[i], at, ":")
            lines[at[1]] = lines[at[1]] " " at[2]
        }
    }
}
END { for (name in lines) print name lines[name] }
