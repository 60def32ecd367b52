# code_stack.awk: computes the worst stack of an AVR's program from its code, because that compiler (gcc 5) writes no call
# graphs.
#
# Input: lines "pointer CALLER CALLEE..." (pointers.rows), then `avr-objdump -d` of the image. Variables: root, the first
# function; address, the bytes of a return address. Like stack.awk, the program prints "stack BYTES" and "path A > B"; on
# recursion it prints "recursion NAME" and fails. A call through a pointer without a row may reach every function that is not
# called by name.
#
# A function's frame is its pushes, and its subtraction from the frame pointer between reading and writing the stack pointer.
# Each call of the function counts with the whole frame. A jump at the end of a function replaces the function.
function hex(digits,    i, n) {
    n = 0
    for (i = 1; i <= length(digits); i++) { n = 16 * n + index("0123456789abcdef", substr(digits, i, 1)) - 1 }
    return n
}
function number(text) { return text ~ /^0x/ ? hex(tolower(substr(text, 3))) : text + 0 }

# Returns the bytes of stack from `at` downwards, without the return address. next_of[] gets the deepest path.
function depth(at,    i, deep, best) {
    if (at in known) { return known[at] }
    if (at in busy) { print "recursion " at; failed = 1; return 0 }
    busy[at] = 1
    best = 0
    for (i = 1; i <= edges[at]; i++) {
        deep = (tail[at, i] ? -frame[at] : address) + depth(edge[at, i])
        if (deep > best) { best = deep; next_of[at] = edge[at, i] }
    }
    for (i = 1; (at in blind) && i <= names; i++) {
        if (!(named[i] in called) && named[i] !~ /^(__|atmega_|board_)/ && named[i] != root) {
            deep = address + depth(named[i])
            if (deep > best) { best = deep; next_of[at] = named[i] }
        }
    }
    delete busy[at]
    known[at] = frame[at] + best
    return known[at]
}
function leads(to, jumped) {
    if (to != name) { edge[name, ++edges[name]] = to; tail[name, edges[name]] = jumped; called[to] = 1 }
}

$1 == "pointer" { for (i = 3; i <= NF; i++) { pointed[$2] = pointed[$2] " " $i }; next }

/^[0-9a-f]+ <.*>:$/ {
    name = $2
    sub(/^</, "", name); sub(/>:$/, "", name)
    plain = name
    sub(/\..*/, "", plain) # parts that the compiler made of one function
    named[++names] = name
    taking = 0
    next
}
name == "" || NF < 2 { next }
{
    split($0, part, "\t") # address, bytes, instruction, operands, comment
    does = part[3]
    sub(/ +$/, "", does)
    with = part[4]
    to = ""
    if (match($0, /<[^>]*>$/)) { to = substr($0, RSTART + 1, RLENGTH - 2) }
}
does == "push" { frame[name]++ }
does == "in" && with ~ /^r28, 0x3d/ { taking = 4; next }
taking > 0 {
    taking--
    if (does == "sbiw" && with ~ /^r28,/) { sub(/^r28, /, "", with); frame[name] += number(with); taking = 0 }
    if (does == "subi" && with ~ /^r28,/) { sub(/^r28, /, "", with); low = number(with) }
    if (does == "sbci" && with ~ /^r29,/) {
        sub(/^r29, /, "", with)
        bytes = 256 * number(with) + low
        frame[name] += bytes < 32768 ? bytes : 0 # it gives back
        taking = 0
    }
}
does == "rcall" && with == ".+0" { frame[name] += address; next }
does ~ /^r?call$/ { sub(/\+0x.*/, "", to); leads(to, 0) }
does ~ /^r?jmp$/ && to !~ /\+0x/ { leads(to, 1) }
does ~ /^e?icall$/ {
    if (!(plain in pointed)) { blind[name] = 1 }
    n = split(pointed[plain], callees, " ")
    for (i = 1; i <= n; i++) { leads(callees[i], 0) }
}
END {
    bytes = depth(root)
    path = root
    for (at = root; at in next_of && !(at in shown); at = next_of[at]) {
        shown[at] = 1
        path = path " > " next_of[at]
    }
    print "path " path
    print "stack " bytes
    exit failed
}
