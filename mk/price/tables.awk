# tables.awk: joins the pairs, their bytes and changes with the counts; writes `csv` and `tables` (price.sh).

function value(scene, metric) {
    return (scene, metric) in count ? count[scene, metric] : ""
}

function two(n, metric) {
    return value("p" n "_without", metric) "," value("p" n "_with", metric)
}

# "182 -> 231", or "182" where nothing changes.
function change(before, after) {
    return before == "" && after == "" ? "" : before == after ? before : before " → " after
}

function changed(n, metric) {
    return change(value("p" n "_without", metric), value("p" n "_with", metric))
}

function row(n, cells) {
    print "| `" mechanism[n] "` | `" effect[n] "` | " cells " |" >tables
}

function common(n) {
    return change(bytes[n, 1], bytes[n, 3]) " | " change(bytes[n, 2], bytes[n, 4]) " | " \
        change(moved[n, 1], moved[n, 2]) " | " (kind[n] == "noise" || kind[n] == "ledger" ? "none" : moved[n, 3])
}

function additive_row(n) {
    row(n, changed(n, "step median") " | " common(n))
}

function noise_row(n) {
    row(n, changed(n, "step median") " | " changed(n, "record median") " | " \
        change(bytes[n, 1], bytes[n, 3]) " | " change(bytes[n, 2], bytes[n, 4]))
}

function contact_row(n) {
    row(n, changed(n, "step median") " | " value("p" n "_with", "step maximum") " | " \
        value("p" n "_with", "worst") " | " common(n))
}

function ledger_row(n) {
    print "| `" mechanism[n] "` | " changed(n, "step median") " | " change(bytes[n, 1], bytes[n, 3]) " | " \
        change(bytes[n, 2], bytes[n, 4]) " |" >tables
}

FILENAME ~ /pairs$/ {
    pairs++
    mechanism[$1] = $2
    effect[$1] = $3
    kind[$1] = $4
    next
}

$1 == "bytes" { for (i = 3; i <= 6; i++) { bytes[$2, i - 2] = $i }; next }
$1 == "change" { for (i = 3; i <= 5; i++) { moved[$2, i - 2] = $i }; next }

# commit,board,compiler,"flags",scene,number,method,metric,value
/,/ {
    columns = split($0, part, ",")
    scene = part[columns - 4]
    what = part[columns - 1]
    of = part[columns - 2] == "record" ? "record" : "step"
    if (FILENAME ~ /worst/) {
        if (what ~ /maximum/) { count[scene, "worst"] = part[columns] }
    } else if (what ~ /median/) {
        count[scene, of " median"] = part[columns]
    } else if (what ~ /maximum/) {
        count[scene, of " maximum"] = part[columns]
    } else if (what ~ /stack/) {
        count[scene, "stack"] = part[columns]
    }
}

END {
    print "board,compiler,flags,mechanism,effect,kind," \
        "step_instructions_without,step_instructions_with,step_maximum_without,step_maximum_with," \
        "record_instructions_without,record_instructions_with,flash_bytes_without,flash_bytes_with," \
        "ram_bytes_without,ram_bytes_with,stack_bytes_without,stack_bytes_with," \
        "step_error_without,step_error_with,worst_step_with,moved" >csv
    for (n = 1; n <= pairs; n++) {
        if (!((n, 1) in bytes)) {
            continue
        }
        print board "," compiler ",\"" flags "\"," mechanism[n] "," effect[n] "," kind[n] "," two(n, "step median") "," \
            two(n, "step maximum") "," two(n, "record median") "," bytes[n, 1] "," bytes[n, 3] "," \
            bytes[n, 2] "," bytes[n, 4] "," two(n, "stack") "," moved[n, 1] "," moved[n, 2] "," \
            value("p" n "_with", "worst") "," moved[n, 3] >csv
        if (value("p" n "_with", "step median") == "") {
            print "tables.awk: " mechanism[n] " with " effect[n] " was not counted" >"/dev/stderr"
            failed = 1
        }
    }

    print "Board `" board "`, " compiler ",\n`" flags "`, float, RK4.\n" >tables
    print "### Additive effects\n" >tables
    print "| mechanism | effect | instructions a step | flash | RAM | step error | moves by |" >tables
    print "|---|---|---|---|---|---|---|" >tables
    for (n = 1; n <= pairs; n++) {
        if ((n, 1) in bytes && (kind[n] == "additive" || kind[n] == "mechanism")) { additive_row(n) }
    }
    print "\n### Stops, friction, holds, crossings\n" >tables
    print "| mechanism | effect | instructions a step | most of " steps " steps | most of " worst \
        " random steps | flash | RAM | step error | moves by |" >tables
    print "|---|---|---|---|---|---|---|---|---|" >tables
    for (n = 1; n <= pairs; n++) {
        if ((n, 1) in bytes && kind[n] == "contact") { contact_row(n) }
    }
    print "\n### Noise\n" >tables
    print "| mechanism | effect | instructions a step | a record | flash | RAM |" >tables
    print "|---|---|---|---|---|---|" >tables
    for (n = 1; n <= pairs; n++) {
        if ((n, 1) in bytes && kind[n] == "noise") { noise_row(n) }
    }
    print "\n### The ledger\n" >tables
    print "| mechanism | instructions a step | flash | RAM |" >tables
    print "|---|---|---|---|" >tables
    for (n = 1; n <= pairs; n++) {
        if ((n, 1) in bytes && kind[n] == "ledger") { ledger_row(n) }
    }
    exit failed
}
