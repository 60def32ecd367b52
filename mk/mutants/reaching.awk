# reaching.awk -v file=FILE -v line=N SOURCE FOUND: prints the tests that reach a line, one a line, such as "host.diag";
# "all" if this cannot be determined. SOURCE is the text of FILE. FOUND has the output of lines.awk for that file: a first
# line "counted:FILE line ..." with all lines that have code, then "host.diag.lines:FILE line ..." for each test.
#
# A line without code of its own, such as a declaration or a line that the compiler joined with others, counts as reached
# if the nearest line with code before or after it in its function is reached. A line outside functions, such as a table,
# counts as reached if any line of its file is. If a function or a file has no code of its own, the result is "all".
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
