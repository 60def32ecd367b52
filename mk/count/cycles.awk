# cycles.awk: the cycle estimate of thumb_cycles.h a second time, from the disassembler's words and how often each address
# was executed, to check the first: what it says is summed over addresses, not over time.
#
#   awk -v core=m4 -f cycles.awk DISASSEMBLY COUNTS
#
# DISASSEMBLY is objdump -d, COUNTS the log of count_plugin.c with profile=on,cycles=CORE. Prints "plugin CYCLES" (the
# sum of the intervals), "disassembly CYCLES" and "instructions NUMBER"; fails if an executed address is not in the
# disassembly. The profile must be of all intervals.
#
# Of two instructions behind each other in memory, executed one after the other E - J times (the first's executions less
# its jumps), the first may make the second cheaper or dearer.

function number_of(name) {
    sub(/!$/, "", name)
    return name == "sp" ? "r13" : name == "lr" ? "r14" : name == "pc" ? "r15" : name == "ip" ? "r12" : \
        name == "fp" ? "r11" : name == "sl" ? "r10" : name
}

# Registers in a list "r4, r5, s16-s19, d8": how many words.
function words_in(list,    part, n, i, ends, many) {
    n = split(list, part, /, */)
    many = 0
    for (i = 1; i <= n; i++) {
        if (split(part[i], ends, "-") == 2) {
            many += (substr(ends[2], 2) - substr(ends[1], 2) + 1) * (part[i] ~ /^d/ ? 2 : 1)
        } else {
            many += part[i] ~ /^d/ ? 2 : 1
        }
    }
    return many
}

# All registers in some operands, " r1 r2 ".
function registers(operands,    part, n, i, all) {
    gsub(/[\[\]{}!]/, "", operands)
    n = split(operands, part, /, */)
    all = " "
    for (i = 1; i <= n; i++) {
        if (part[i] ~ /^(r[0-9]+|s[0-9]+|sp|lr|ip|fp|sl)$/) {
            all = all number_of(part[i]) " "
        }
    }
    return all
}

function share(some, others,    part, n, i) {
    n = split(some, part, " ")
    for (i = 1; i <= n; i++) {
        if (index(others, " " part[i] " ")) {
            return 1
        }
    }
    return 0
}

function floating(at, word, operand, operands,    rest) {
    rest = operands
    sub(/^[^,]*,? */, "", rest)
    if (word ~ /^v(ldr|str)/) {
        cycles[at] = 2
        overlaps[at] = 1
        loads[at] = word ~ /^vldr/
        address[at] = registers(substr(operands, index(operands, "[")))
        if (loads[at]) { writes[at] = " " operand[1] " " } else { reads[at] = " " operand[1] " " }
    } else if (word ~ /^v(push|pop|ldm|stm)/) {
        match(operands, /\{[^}]*\}/)
        cycles[at] = 1 + words_in(substr(operands, RSTART + 1, RLENGTH - 2))
        address[at] = word ~ /^v(push|pop)/ ? " r13 " : " " number_of(operand[1]) " "
        if (word ~ /^v(push|stm)/) { reads[at] = singles(substr(operands, RSTART + 1, RLENGTH - 2)) }
    } else if (word ~ /^v(mrs|msr)/) {
        cycles[at] = 1
    } else if (word ~ /^vmov/) {
        cycles[at] = operands ~ /^r[0-9a-z]*, *r/ || rest ~ /, *(r[0-9]+|lr|ip|fp|sl)$/ ? 2 : 1
        if (cycles[at] == 1) {
            writes[at] = " " number_of(operand[1]) " "
            reads[at] = registers(rest)
        }
    } else {
        cycles[at] = word ~ /^v(div|sqrt)/ ? 14 : word ~ /^v(f?n?mla|f?n?mls|fma|fms|fnma|fnms)/ ? 3 : 1
        reads[at] = word ~ /^v(f?n?ml[as]|fm[as]|fnm[as]|cmp)/ ? registers(operands) : registers(rest)
        if (word !~ /^vcmp/) {
            writes[at] = " " operand[1] " "
            result[at] = word !~ /^v(neg|abs)/
        }
    }
}

# The single registers of a list, of which ranges are written short.
function singles(list,    part, n, i, ends, k, all) {
    n = split(list, part, /, */)
    all = " "
    for (i = 1; i <= n; i++) {
        if (split(part[i], ends, "-") < 2) { ends[2] = ends[1] }
        for (k = substr(ends[1], 2); k <= substr(ends[2], 2) + 0; k++) {
            all = part[i] ~ /^d/ ? all "s" (2 * k) " s" (2 * k + 1) " " : all "s" k " "
        }
    }
    return all
}

function learn(at, word, operands,    operand, n, indexed) {
    n = split(operands, operand, /, */)
    jump[at] = 2
    if (word ~ /^v/) {
        floating(at, word, operand, operands)
    } else if (word ~ /^(ldrd|strd)/) {
        cycles[at] = 3
        address[at] = registers(substr(operands, index(operands, "[")))
    } else if (word ~ /^(ldr|str)/) {
        address[at] = registers(substr(operands, index(operands, "[")))
        indexed = operands ~ /\[[a-z0-9]+, *[a-z]/
        loads[at] = core != "m0" && word ~ /^ldr/
        overlaps[at] = core != "m0" && (word ~ /^ldr/ || indexed)
        cycles[at] = core == "m0" || overlaps[at] ? 2 : 1
        if (word ~ /^ldr/) { writes[at] = " " number_of(operand[1]) " " }
    } else if (word ~ /^(push|pop|ldm|stm)/) {
        match(operands, /\{[^}]*\}/)
        cycles[at] = 1 + words_in(substr(operands, RSTART + 1, RLENGTH - 2))
        address[at] = word ~ /^(push|pop)/ ? " r13 " : " " number_of(operand[1]) " "
        if (core == "m0" && word ~ /^(push|pop)/) { jump[at] = 3 }
    } else if (word ~ /^(tbb|tbh)/) {
        cycles[at] = 2
    } else if (word ~ /^(cbz|cbnz|it[te]*|nop|b|bl|bx|blx|b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)|bx(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le))$/) {
        cycles[at] = core == "m0" && word == "bl" ? 2 : 1
    } else if (word ~ /^(cmp|cmn|tst|teq)/) {
        cycles[at] = 1
    } else if (word ~ /^(mrs|msr|dmb|dsb|isb)/) {
        cycles[at] = core == "m0" ? 4 : 1
    } else {
        cycles[at] = word ~ /^[us]div/ ? 7 : core != "m3" ? 1 : word ~ /^[us]mull/ ? 4 : word ~ /^[us]mlal/ ? 6 : \
            word ~ /^ml[as]/ ? 2 : 1
        writes[at] = " " number_of(operand[1]) " "
        if (word ~ /^[us]ml?[ua]l/ || word ~ /^[us]mull/) { writes[at] = writes[at] number_of(operand[2]) " " }
        late[at] = core != "m0" && operand[1] != "pc"
    }
}

# "  116:\tb510      \tpush\t{r4, lr}"
FNR == NR {
    if (!match($0, /^ *[0-9a-f]+:\t[0-9a-f ]+\t[a-z]/)) {
        next
    }
    split($0, field, "\t")
    at = field[1]
    gsub(/[ :]/, "", at)
    code = field[2]
    gsub(/ /, "", code)
    word = field[3]
    sub(/\.[wn]$/, "", word)
    operands = field[4]
    sub(/ *[;@<].*$/, "", operands)
    text[at] = word
    size[at] = length(code) / 2
    if (have_before && number[before] + size[before] == address_number(at)) { previous[at] = before }
    number[at] = address_number(at)
    learn(at, word, operands)
    before = at
    have_before = 1
    next
}

function address_number(hex,    i, value) {
    value = 0
    for (i = 1; i <= length(hex); i++) {
        value = 16 * value + index("0123456789abcdef", substr(hex, i, 1)) - 1
    }
    return value
}

$1 == "address" { executed[sprintf("%x", $2)] = $3; jumps[sprintf("%x", $2)] = $4 }
$1 == "cycles" { plugin += $3 }

END {
    for (at in executed) {
        if (!(at in text)) {
            print "cycles.awk: nothing is known of address " at > "/dev/stderr"
            exit 1
        }
        instructions += executed[at]
        sum = cycles[at] * executed[at] + jump[at] * jumps[at]
        if (at in previous) {
            p = previous[at]
            both = executed[p] - jumps[p]
            if (loads[p] && overlaps[at] && !share(writes[p], address[at])) { sum -= both }
            if (late[p] && share(writes[p], address[at])) { sum += both }
            if (result[p] && share(writes[p], reads[at])) { sum += both }
        }
        total += sum
        if (verbose) { printf "%s %s %d %d %d\n", at, text[at], executed[at], jumps[at], sum > "/dev/stderr" }
    }
    printf "plugin %d\ndisassembly %d\ninstructions %d\n", plugin, total, instructions
}
