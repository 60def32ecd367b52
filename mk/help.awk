# help.awk: the public targets of makefiles, by section, for `make help`.
#
#   ##@ Section               what follows belongs to it; sections may come again in a later file
#   target: ... ## words      a target
#   target: ... ##- words     one that authors use: listed with all=1
#   ## target-NAME: words     a family of targets, whatever NAME is (##- with all=1)
/^##@ / {
    section = substr($0, 5)
    if (!(section in lines)) { sections[++count] = section; lines[section] = "" }
}
(/^[a-z][a-z0-9-]*:.*##-? / || /^##-? [a-z][a-zA-Z0-9-]*: /) && (all || !/##- /) {
    target = words = $0
    sub(/^##-? /, "", target)
    sub(/:.*/, "", target)
    sub(/^##-? [^ ]* |^.*##-? /, "", words)
    lines[section] = lines[section] sprintf("  make %-22s %s\n", target, words)
}
END { for (i = 1; i <= count; i++) if (lines[sections[i]] != "") printf "\n%s\n%s", sections[i], lines[sections[i]] }
