# blocks.awk FILES -: prints, for each block of a program, the lines of FILES (a list of names) that have code in it,
# from the output of objdump -dl: "place file:line file:line ...". `place` is the number, from 1, of the byte that
# reach.c sets when the block is reached. A block's lines are those from the call at its head to the next such call.
# The objects may come from another folder (ccache), so a path counts from the point at which it is one of FILES.
FILENAME == ARGV[1] { is_file[$0]; next }
/^\// {
    at = $1
    if (!(at in place)) place[at] = place_of(at)
    enter(place[at])
    next
}
# The head of a function. The lines before its first call belong to its first block.
/^[0-9a-f]+ <.*>:$/ { tell(); begins = 1; next }
called && /^ *[0-9a-f]+:/ { address = substr($1, 1, length($1) - 1); called = 0 }
/call .*<__sanitizer_cov_trace_pc>/ {
    if (!begins) { tell(); enter(place[at]) }
    begins = 0
    called = 1
}
END { tell() }

function place_of(path,    line, from) {
    match(path, /:[0-9]+$/)
    line = substr(path, RSTART)
    path = substr(path, 2, RSTART - 2)
    while (!(path in is_file)) {
        from = index(path, "/")
        if (from == 0) return ""
        path = substr(path, from + 1)
    }
    return path line
}
function enter(what) {
    if (what != "" && !(what in entered)) { entered[what]; lines = lines " " what }
}
function decimal(hex,    i, n) {
    for (i = 1; i <= length(hex); i++) n = 16 * n + index("0123456789abcdef", substr(hex, i, 1)) - 1
    return n
}
function tell() {
    if (address != "" && lines != "") print decimal(address) + 1 lines
    address = lines = ""
    split("", entered)
}
