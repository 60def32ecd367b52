# stack.awk: the worst stack of a program by its call graph, from gcc's -fcallgraph-info=su files.
#
# Input: lines "symbol NAME ADDRESS" for what the linker kept, then the .ci files. Functions that were found to be alike stand at one
# address, and one of them has the figure. Variable root: where to begin. Prints "stack BYTES" and "path A > B > C"; "unknown NAME"
# for each function called on the way without a figure (assembly of libgcc); "unbounded NAME" for a dynamic frame; on recursion
# "recursion NAME" and fails.
#
# A call through a pointer may reach any kept function that nobody calls by name: that is never too little as long as functions
# whose address is taken are not also called directly. Lines "pointer CALLER CALLEE..." (pointers.rows) say of a caller that it
# reaches these alone.

function plain(title) { sub(/^.*:/, "", title); return title } # file-local functions are titled file:name
function text(key) { return match($0, key ": \"[^\"]*\"") ? substr($0, RSTART + length(key) + 3, RLENGTH - length(key) - 4) : "" }

# Returns the bytes from `at` downwards. next_of[] gets the deepest path.
function depth(at,    i, best) {
    if (at in known) return known[at]
    if (at in busy) { print "recursion " plain(at); failed = 1; return 0 }
    busy[at]
    best = 0
    if (at == "__indirect_call") {
        for (i = 1; i <= nodes; i++) {
            if (!(node[i] in called) && plain(node[i]) in kept && node[i] != root && plain(node[i]) !~ /^board_(reset|fault)/)
                best = deeper(at, node[i], best)
        }
    } else {
        for (i = 1; i <= edges[at]; i++) best = deeper(at, edge[at, i], best)
        if (!(at in frame)) print "unknown " plain(at)
        else if (at in dynamic) print "unbounded " plain(at)
    }
    delete busy[at]
    return known[at] = best + frame[at]
}
function deeper(at, to, best,    deep) {
    deep = depth(to)
    if (deep < best) return best
    next_of[at] = to
    return deep
}
# Returns the functions that a call of `to` reaches.
function reached(to,    name) {
    name = plain(to)
    return !(to in frame) && name in kept && kept[name] in at_address ? at_address[kept[name]] : to
}
function add_edge(from, to) { edge[from, ++edges[from]] = to }

$1 == "symbol" { kept[$2] = $3 }
$1 == "pointer" { for (i = 3; i <= NF; i++) leads[$2] = leads[$2] " " $i }
$1 == "node:" {
    title = text("title")
    label = text("label")
    if (match(label, /[0-9]+ bytes \([a-z,]+\)/)) {
        if (!(title in frame)) node[++nodes] = title
        title_of[plain(title)] = title
        if (plain(title) in kept) at_address[kept[plain(title)]] = title
        frame[title] = substr(label, RSTART, RLENGTH) + 0
        if (substr(label, RSTART, RLENGTH) ~ /dynamic\)/) dynamic[title]
    }
}
$1 == "edge:" {
    from = text("sourcename")
    to = text("targetname")
    if (to == "__indirect_call" && plain(from) in leads) { led[++leds] = from; next }
    add_edge(from, to)
    if (plain(from) in kept) called[to] # only callers that are themselves in the program count as direct callers
}

END {
    for (i = 1; i <= leds; i++) {
        n = split(leads[plain(led[i])], callees, " ")
        for (k = 1; k <= n; k++) {
            if (callees[k] in title_of) { add_edge(led[i], title_of[callees[k]]); called[title_of[callees[k]]] }
        }
    }
    for (from in edges) {
        for (k = 1; k <= edges[from]; k++) {
            to = edge[from, k]
            edge[from, k] = reached(to)
            if (to in called) called[edge[from, k]]
        }
    }
    bytes = depth(root)
    path = plain(root)
    for (at = root; at in next_of && !(at in shown); at = next_of[at]) {
        shown[at]
        path = path " > " (next_of[at] == "__indirect_call" ? "(pointer)" : plain(next_of[at]))
    }
    print "path " path
    print "stack " bytes
    exit failed
}
