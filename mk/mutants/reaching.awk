# reaching.awk -v file=FILE -v line=N SOURCE FOUND: the tests that reach a line, one a line, such as "host.diag"; "all" where that
# cannot be told. SOURCE is the text of FILE; FOUND what lines.awk said of that file, a line for each test that reaches it,
# "counted:FILE line ..." (the lines that there is code of) before all others, "host.diag.lines:FILE line ...".
#
# A line without code of its own, such as a declaration or what the compiler joined with its neighbours, counts as reached
# where the nearest line with code before it or behind it in its function is; one outside functions, such as a table,
# where any line of its file is. Where a function, or a file, has no code of its own: all.
FILENAME == ARGV[1] {
    if (!inside && /^[A-Za-z_]/ && !/^extern "C"/) begins = FNR
    if (begins && !inside && /\{$/) { inside = 1; is_function = /\) \{$/ }
    if (/^}/) {
        if (inside && is_function && begins <= line && line <= FNR) { first = begins; last = FNR }
        begins = inside = 0
    }
    next
}
{ split($1, part, ":") }
part[2] != file { next }
part[1] == "counted" {
    for (i = 2; i <= NF && before != line; i++) {
        if ($i + 0 == line) before = behind = line
        else if (first <= $i && $i < line && $i > before) before = $i + 0
        else if (line < $i && $i <= last && (!behind || $i < behind)) behind = $i + 0
    }
    outside = before != line && !first
    known = outside || before || behind
    next
}
known {
    for (i = 2; i <= NF; i++) {
        if (outside || $i + 0 == before || $i + 0 == behind) {
            sub(/\.lines$/, "", part[1])
            print part[1]
            next
        }
    }
}
END { if (!known) print "all" }
