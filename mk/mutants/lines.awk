# lines.awk [-v all=1] [BLOCKS MAP]...: prints the lines that a test reached, a line for each file: "file line line
# ...". BLOCKS is an output of blocks.awk. MAP is the output of cmp -l for that program's map and /dev/zero: the
# places of bytes that are set (at least one line). With `all`, there are no MAPs, and all lines with code are
# printed.
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
