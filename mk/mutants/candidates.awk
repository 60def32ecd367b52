# candidates.awk FILE...: lists every small change that could be made to C files, one a line, separated by tabs:
#   file  line  column  length  replacement  kind
# The `length` characters at `column` (from 1) are replaced. Comments, strings, assertions and preprocessor lines are not
# changed. A change may fail to compile. The files must be laid out by clang-format: spaces stand around binary operators,
# but not around the star of a type.

FNR == 1 { in_comment = in_directive = in_assert = 0; before = ";" }
{
    code = masked($0) " "
    if (in_directive || code ~ /^[ ]*#/) { in_directive = code ~ /\\ $/; next }
    if (in_assert || code ~ /(^|[^a-z_])(_Static_assert|static_assert|assert|WH_ASSERT)[ ]*\(/) {
        in_assert = code !~ /;[ ]*$/
        next
    }
    if (code ~ /^[ ]*$/) next
    operators()
    signs()
    constants()
    conditions()
    choices()
    returns()
    statements()
    arguments()
    places()
    trimmed = code
    sub(/[ ]+$/, "", trimmed)
    before = substr(trimmed, length(trimmed))
}

# Returns the line with comments replaced by spaces, and characters inside quotes by underscores.
function masked(line,    out, i, c, two, quote) {
    for (i = 1; i <= length(line); i++) {
        c = substr(line, i, 1)
        two = substr(line, i, 2)
        if (in_comment) {
            if (two == "*/") { in_comment = 0; out = out " "; i++ }
            out = out " "
        } else if (quote != "") {
            if (c == "\\") { out = out "_"; i++; c = "_" }
            else if (c == quote) quote = ""
            else c = "_"
            out = out c
        } else if (two == "/*") {
            in_comment = 1
            out = out "  "
            i++
        } else if (two == "//") {
            break
        } else {
            if (c ~ /["']/) quote = c
            out = out c
        }
    }
    return out
}

function change(column, size, replacement, kind) {
    if (size > 0 && substr(code, column, size) != replacement)
        printf "%s\t%d\t%d\t%d\t%s\t%s\n", FILENAME, FNR, column, size, replacement, kind
}

# find(PATTERN): finds the next match in the code from `from` on (0: none): `at` and `found`. The next search begins
# after the first `skip` characters of the match, or after the whole match if `skip` is not given.
function find(pattern, skip) {
    if (!match(substr(code, from), pattern)) return from = 0
    at = from + RSTART - 1
    found = substr(code, at, RLENGTH)
    return from = at + (skip ? skip : RLENGTH)
}

# --- operators --------------------------------------------------------------------------------------
BEGIN {
    count = split("+ -;- +;* /;/ *;% *;< <=;<= <;> >=;>= >;== !=;!= ==;&& ||;|| &&;" \
        "+= -=;-= +=;*= /=;/= *=;& |;| &;<< >>;>> <<;^ &", rows, ";")
    for (i = 1; i <= count; i++) {
        split(rows[i], both, " ")
        before_[i] = " " both[1] " "
        after_[i] = " " both[2] " "
        kinds[i] = both[1] ~ /^[<>=!]/ && both[1] !~ /<<|>>/ ? "comparison" : both[1] ~ /&&|\|\|/ ? "and, or" : "operator"
    }
}

function operators(    i, to) {
    for (i = 1; i <= count; i++)
        for (from = 1; (to = index(substr(code, from), before_[i])) > 0; from += to)
            change(from + to - 1, length(before_[i]), after_[i], kinds[i])
    for (from = 1; find("\\+\\+|--");) change(at, 2, found == "++" ? "--" : "++", "operator")
}

# Removes a sign or a "not".
function signs() {
    for (from = 1; find("[(\\[ ][-!][A-Za-z_(0-9]", 2);)
        change(at + 1, 1, "", substr(found, 2, 1) == "!" ? "condition" : "operator")
}

# --- constants --------------------------------------------------------------------------------------
function constants() {
    for (from = 1; find("[A-Za-z0-9_.]+([eEpP][-+][0-9]+)?[uUlLfF]*");) {
        if (found == "true" || found == "false") change(at, length(found), found == "true" ? "false" : "true", "constant")
        else if (found ~ /^[0-9]/) constant(length(found), found)
    }
}

function constant(size, word,    digits, suffix, last, power) {
    if (word ~ /^0[xX].*[pP]/) { # twice the value
        match(word, /[pP][-+]?[0-9]+/)
        power = substr(word, RSTART + 1, RLENGTH - 1) + 1
        change(at, size, substr(word, 1, RSTART) (power < 0 ? "" : "+") power substr(word, RSTART + RLENGTH), "constant")
        return
    }
    match(word, word ~ /^0[xX]/ ? "^0[xX][0-9a-fA-F]+" : "^[0-9]+")
    digits = substr(word, 1, RLENGTH)
    suffix = substr(word, RLENGTH + 1)
    if (word ~ /^0[xX]/) { # another last digit
        last = substr(digits, RLENGTH)
        change(at, size, substr(digits, 1, RLENGTH - 1) (last == "0" ? "1" : "0") suffix, "constant")
    } else if (length(digits) <= 15) { # one more before the point; a whole number becomes one less
        change(at, size, sprintf("%.0f", digits + 1) suffix, "constant")
        if (digits + 0 > 0 && suffix !~ /[.eE]/) change(at, size, sprintf("%.0f", digits - 1) suffix, "constant")
    }
}

# --- conditions -------------------------------------------------------------------------------------
# Returns the column of the bracket that closes the one at `open`; 0 if it is on another line.
function closing(open,    depth, i, c) {
    for (i = open; i <= length(code); i++) {
        c = substr(code, i, 1)
        if (c ~ /[([{]/) depth++
        else if (c ~ /[])}]/ && --depth == 0) return i
    }
    return 0
}

function conditions(    open, end) {
    if (match(code, /(^|[^a-z_])(if|while) \(/)) {
        open = RSTART + RLENGTH - 1
        end = closing(open)
        if (end > 0) change(open, end - open + 1, "(!" substr($0, open, end - open + 1) ")", "condition")
    }
}

# Exchanges b and c in a ? b : c.
function choices(    ask, i, c, depth, colon, end) {
    ask = index(code, " ? ")
    for (i = ask + 3; ask > 0 && i <= length(code) && end == 0; i++) {
        c = substr(code, i, 1)
        if (c ~ /[([{]/) depth++
        else if (c ~ /[])}]/) { if (--depth < 0) end = i }
        else if (depth == 0 && c ~ /[;,?]/) end = i
        else if (depth == 0 && c == ":" && !colon) colon = i
    }
    if (colon > 0 && end > colon)
        change(ask + 3, end - ask - 3, substr($0, colon + 2, end - colon - 2) " : " substr($0, ask + 3, colon - ask - 4), "branches")
}

# --- statements -------------------------------------------------------------------------------------
function returns(    start, size, what) {
    if (match(code, /(^|[^a-z_])return [^;]+;/)) {
        start = RSTART + index(substr(code, RSTART), "return ") + 6
        size = RSTART + RLENGTH - 1 - start
        what = substr($0, start, size)
        if (what !~ /^(0|0\.0|NULL|false)$/) change(start, size, "0", "return")
        if (what !~ /^(0|NULL|true|false)$/) change(start, size, "!(" what ")", "return")
    }
}

# Removes a statement that has a line of its own.
function statements(    start) {
    if (before !~ /[;{}:]/ || code !~ /;[ ]*$/ || code ~ /^[ ]*(return|goto|for|while|if|}|typedef)/ ||
        code !~ /[=(]|\+\+|--|(break|continue);/) return
    start = match(code, /[^ ]/)
    change(start, match(code, /;[ ]*$/) - start, "", "statement")
}

# Exchanges two neighbouring arguments of a call.
function arguments(    end, i, c, depth, n, first, last) {
    for (from = 1; find("[A-Za-z_0-9]+\\(");) {
        end = closing(from - 1)
        if (end == 0) continue
        depth = n = 0
        first[0] = from
        for (i = from; i < end; i++) {
            c = substr(code, i, 1)
            if (c ~ /[([{]/) depth++
            else if (c ~ /[])}]/) depth--
            else if (c == "," && depth == 0) { last[n++] = i - 1; first[n] = i + 2 }
        }
        last[n] = end - 1
        for (i = 0; i < n; i++) exchange(first[i], last[i], first[i + 1], last[i + 1])
    }
}

function exchange(a, b, c, d,    left, right) {
    left = substr($0, a, b - a + 1)
    right = substr($0, c, d - c + 1)
    if (left != right) change(a, d - a + 1, right ", " left, "arguments")
}

# Takes the neighbour in an array.
function places(    what) {
    for (from = 1; find("\\[[a-z_]+\\]");) {
        what = substr(found, 2, length(found) - 2)
        change(at, length(found), "[" what " + 1]", "place")
        change(at, length(found), "[" what " - 1]", "place")
    }
}
