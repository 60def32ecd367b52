# help.awk: the public targets of makefiles, by section, for `make help`.
#
#   ##@ Section               what follows belongs to it; sections may come again in a later file
#   target: ... ## words      a target
#   target: ... ##- words     one that authors use: listed with all=1
#   ## target-NAME: words     a family of targets, whatever NAME is (##- with all=1)

/^##@ / {
    section = substr($0, 5)
    if (!(section in lines)) {
        sections[++count] = section
    }
    next
}

/##- / && !all {
    next
}

/^[a-z][a-z0-9-]*:.*##-? / {
    target = $0
    sub(/:.*/, "", target)
    words = $0
    sub(/^.*##-? /, "", words)
    add(target, words)
}

/^##-? [a-z][a-zA-Z0-9-]*: / {
    target = $2
    sub(/:$/, "", target)
    words = $0
    sub(/^##-? [^ ]* /, "", words)
    add(target, words)
}

function add(target, words) {
    lines[section] = lines[section] sprintf("  make %-22s %s\n", target, words)
}

END {
    for (i = 1; i <= count; i++) {
        if (lines[sections[i]] == "") {
            continue
        }
        printf "\n%s\n%s", sections[i], lines[sections[i]]
    }
}
