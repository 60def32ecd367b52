# strip.awk: a .whirl text without its blocks of some kinds: what a file that never mentions them says.
#
#   awk -v drop="effect scene" -f strip.awk FILE
#
# A block is a word of `drop` at the beginning of a line outside braces, up to the brace that closes it.
# Braces in texts ("...") and comments (# to the end of the line) do not count.

BEGIN {
    count = split(drop, words, " ")
    for (i = 1; i <= count; i++) {
        wanted[words[i]] = 1
    }
}

{
    if (depth == 0 && !dropping && ($1 in wanted)) {
        dropping = 1
        opened = 0
    }
    was = dropping
    quoted = 0
    for (i = 1; i <= length($0); i++) {
        c = substr($0, i, 1)
        if (c == "\"") {
            quoted = !quoted
        } else if (!quoted && c == "#") {
            break
        } else if (!quoted && c == "{") {
            depth++
            opened = 1
        } else if (!quoted && c == "}") {
            depth--
        }
    }
    if (dropping && opened && depth == 0) {
        dropping = 0
    }
    if (!was) {
        print
    }
}
