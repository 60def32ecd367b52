# candidates.awk FILE...: every small change that could be made to C files, one a line, tab separated:
#   file  line  column  length  replacement  kind
# The text of `length` characters at `column` (from 1) is to be replaced. Comments, strings, assertions
# and lines of the preprocessor have none. Whether a change compiles is for the compiler to say. The
# files are laid out by clang-format: binary operators stand between spaces, a star of a type does not.

# --- lines ------------------------------------------------------------------------------------------
FNR == 1 { in_comment = 0; in_directive = 0; in_assert = 0; before = ";" }

{
    code = masked($0) " "
    if (in_directive || code ~ /^[ ]*#/) {
        in_directive = code ~ /\\ $/
        next
    }
    if (in_assert || code ~ /(^|[^a-z_])(_Static_assert|static_assert|assert|WH_ASSERT)[ ]*\(/) {
        in_assert = code !~ /;[ ]*$/
        next
    }
    if (code ~ /^[ ]*$/) {
        next
    }
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

# The line without what is no code: comments become spaces, characters inside quotes underscores.
function masked(line,    out, i, c, two, quote) {
    out = ""
    quote = ""
    for (i = 1; i <= length(line); i++) {
        c = substr(line, i, 1)
        two = substr(line, i, 2)
        if (in_comment) {
            if (two == "*/") {
                in_comment = 0
                out = out " "
                i++
            }
            out = out " "
        } else if (quote != "") {
            if (c == "\\") {
                out = out "_"
                i++
                c = "_"
            } else if (c == quote) {
                quote = ""
            } else {
                c = "_"
            }
            out = out c
        } else if (two == "/*") {
            in_comment = 1
            out = out "  "
            i++
        } else if (two == "//") {
            break
        } else {
            if (c == "\"" || c == "'") {
                quote = c
            }
            out = out c
        }
    }
    return out
}

function change(column, size, replacement, kind) {
    if (size == 0 || substr(code, column, size) != replacement) {
        printf "%s\t%d\t%d\t%d\t%s\t%s\n", FILENAME, FNR, column, size, replacement, kind
    }
}

# --- operators --------------------------------------------------------------------------------------
BEGIN {
    text = "+ -;- +;* /;/ *;% *;< <=;<= <;> >=;>= >;== !=;!= ==;&& ||;|| &&;" \
           "+= -=;-= +=;*= /=;/= *=;& |;| &;<< >>;>> <<;^ &"
    count = split(text, rows, ";")
    for (i = 1; i <= count; i++) {
        split(rows[i], both, " ")
        from[i] = " " both[1] " "
        to[i] = " " both[2] " "
        kinds[i] = both[1] ~ /^[<>=!]/ && both[1] !~ /<<|>>/ ? "comparison" : \
                   both[1] ~ /&&|\|\|/ ? "and, or" : "operator"
    }
}

function operators(    i, at, rest, shift) {
    for (i = 1; i <= count; i++) {
        shift = 0
        rest = code
        while ((at = index(rest, from[i])) > 0) {
            change(shift + at, length(from[i]), to[i], kinds[i])
            shift += at
            rest = substr(code, shift + 1)
        }
    }
    shift = 0
    rest = code
    while (match(rest, /\+\+|--/)) {
        at = RSTART
        change(shift + at, 2, substr(rest, at, 2) == "++" ? "--" : "++", "operator")
        shift += at + 1
        rest = substr(code, shift + 1)
    }
}

# A sign or a "not" that is lost.
function signs(    rest, shift, at) {
    shift = 0
    rest = code
    while (match(rest, /[(\[ ][-!][A-Za-z_(0-9]/)) {
        at = RSTART + 1
        change(shift + at, 1, "", substr(rest, at, 1) == "!" ? "condition" : "operator")
        shift += at
        rest = substr(code, shift + 1)
    }
}

# --- constants --------------------------------------------------------------------------------------
function constants(    rest, shift, at, size, word, digits, suffix, value) {
    shift = 0
    rest = code
    while (match(rest, /[A-Za-z0-9_.]+([eEpP][-+][0-9]+)?[uUlLfF]*/)) {
        at = RSTART
        size = RLENGTH
        word = substr(rest, at, size)
        if (word == "true" || word == "false") {
            change(shift + at, size, word == "true" ? "false" : "true", "constant")
        } else if (word ~ /^[0-9]/) {
            constant(shift + at, size, word)
        }
        shift += at + size - 1
        rest = substr(code, shift + 1)
    }
}

function constant(at, size, word,    digits, suffix, last, power) {
    if (word ~ /^0[xX].*[pP]/) { # twice the value
        match(word, /[pP][-+]?[0-9]+/)
        power = substr(word, RSTART + 1, RLENGTH - 1) + 1
        change(at, size, substr(word, 1, RSTART) (power < 0 ? "" : "+") power \
               substr(word, RSTART + RLENGTH), "constant")
    } else if (word ~ /^0[xX]/) { # another last digit
        match(word, /^0[xX][0-9a-fA-F]+/)
        digits = substr(word, 1, RLENGTH)
        suffix = substr(word, RLENGTH + 1)
        last = substr(digits, RLENGTH)
        change(at, size, substr(digits, 1, RLENGTH - 1) (last == "0" ? "1" : "0") suffix, "constant")
    } else { # one more before the point; one less of a whole number
        match(word, /^[0-9]+/)
        digits = substr(word, 1, RLENGTH)
        suffix = substr(word, RLENGTH + 1)
        if (length(digits) > 15) {
            return
        }
        change(at, size, sprintf("%.0f", digits + 1) suffix, "constant")
        if (digits + 0 > 0 && suffix !~ /[.eE]/) {
            change(at, size, sprintf("%.0f", digits - 1) suffix, "constant")
        }
    }
}

# --- conditions -------------------------------------------------------------------------------------
# The column of what closes the bracket at `open`; 0 if it stands on another line.
function closing(open,    depth, i, c) {
    depth = 0
    for (i = open; i <= length(code); i++) {
        c = substr(code, i, 1)
        if (c ~ /[([{]/) {
            depth++
        } else if (c ~ /[])}]/ && --depth == 0) {
            return i
        }
    }
    return 0
}

function conditions(    open, end) {
    if (match(code, /(^|[^a-z_])(if|while) \(/)) {
        open = RSTART + RLENGTH - 1
        end = closing(open)
        if (end > 0) {
            change(open, end - open + 1, "(!" substr($0, open, end - open + 1) ")", "condition")
        }
    }
}

# a ? b : c with b and c exchanged.
function choices(    ask, i, c, depth, colon, end, yes, no) {
    ask = index(code, " ? ")
    if (ask == 0) {
        return
    }
    depth = 0
    colon = 0
    end = 0
    for (i = ask + 3; i <= length(code) && end == 0; i++) {
        c = substr(code, i, 1)
        if (c ~ /[([{]/) {
            depth++
        } else if (c ~ /[])}]/) {
            if (--depth < 0) {
                end = i
            }
        } else if (depth == 0 && (c == ";" || c == "," || c == "?")) {
            end = i
        } else if (depth == 0 && c == ":" && colon == 0) {
            colon = i
        }
    }
    if (colon > 0 && end > colon) {
        yes = substr($0, ask + 3, colon - 1 - (ask + 3))
        no = substr($0, colon + 2, end - colon - 2)
        change(ask + 3, end - ask - 3, no " : " yes, "branches")
    }
}

# --- statements -------------------------------------------------------------------------------------
function returns(    start, end, what) {
    if (match(code, /(^|[^a-z_])return [^;]+;/)) {
        end = RSTART + RLENGTH - 1
        start = RSTART + index(substr(code, RSTART), "return ") - 1 + 7
        what = substr($0, start, end - start)
        if (what !~ /^(0|0\.0|NULL|false)$/) {
            change(start, end - start, "0", "return")
        }
        if (what !~ /^(0|NULL|true|false)$/) {
            change(start, end - start, "!(" what ")", "return")
        }
    }
}

# A statement on a line of its own that is left out.
function statements(    start, size) {
    if (before !~ /[;{}:]/ || code !~ /;[ ]*$/ || code ~ /^[ ]*(return|goto|for|while|if|}|typedef)/) {
        return
    }
    if (code !~ /[=(]|\+\+|--|(break|continue);/) {
        return
    }
    match(code, /[^ ]/)
    start = RSTART
    match(code, /;[ ]*$/)
    change(start, RSTART - start, "", "statement")
}

# Two neighbouring arguments of a call exchanged.
function arguments(    shift, rest, open, end, i, c, depth, n, from_, to_, name) {
    shift = 0
    rest = code
    while (match(rest, /[A-Za-z_0-9]+\(/)) {
        name = substr(rest, RSTART, RLENGTH - 1)
        open = shift + RSTART + RLENGTH - 1
        shift = open
        rest = substr(code, shift + 1)
        end = closing(open)
        if (end == 0) {
            continue
        }
        depth = 0
        n = 0
        from_[0] = open + 1
        for (i = open + 1; i < end; i++) {
            c = substr(code, i, 1)
            if (c ~ /[([{]/) {
                depth++
            } else if (c ~ /[])}]/) {
                depth--
            } else if (c == "," && depth == 0) {
                to_[n++] = i - 1
                from_[n] = i + 2
            }
        }
        to_[n] = end - 1
        for (i = 0; i < n; i++) {
            exchange(from_[i], to_[i], from_[i + 1], to_[i + 1])
        }
    }
}

function exchange(a, b, c, d,    left, right) {
    left = substr($0, a, b - a + 1)
    right = substr($0, c, d - c + 1)
    if (left != right) {
        change(a, d - a + 1, right ", " left, "arguments")
    }
}

# The neighbour in an array.
function places(    rest, shift, at, size, what) {
    shift = 0
    rest = code
    while (match(rest, /\[[a-z_]+\]/)) {
        at = shift + RSTART
        size = RLENGTH
        what = substr(code, at + 1, size - 2)
        change(at, size, "[" what " + 1]", "place")
        change(at, size, "[" what " - 1]", "place")
        shift = at + size - 1
        rest = substr(code, shift + 1)
    }
}
