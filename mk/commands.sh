#!/bin/sh
# commands.sh page commands|commands_bench: that page of docs, its part below the mark made from the help texts, on standard output.
# commands.sh man FOLDER: both pages as man pages, whirl.1 and whirl-COMMAND.1.
set -u
whirl=${WHIRL:-build/whirl}

page() {
    sed '/^<!-- generated/q' "docs/$1.md"
    [ "$1" = commands ] && cut='/^@bench/,$d' || cut='1,/^@bench/d'
    { "$whirl" help | awk '
        BEGIN { print "\n| command | does |\n|---|---|" }
        /^  whirl / { head = substr($0, 3, 36); text = substr($0, 40); sub(/ +$/, "", head); gsub(/[|]/, "\\|", head)
                      print "| [`" head "`](" ($2 ~ /^(pil|monitor|firstlight)$/ ? "commands_bench.md" : "") "#whirl-" $2 ") | " text " |" }'
    for command in $("$whirl" help | sed -n 's/^  whirl \([a-z]*\) .*/\1/p'); do
        echo "@$command"
        "$whirl" "$command" --help
    done | awk '
        function links(text,   at) { # makes links of pages, and escapes stars outside code
            if (text !~ /`/) { gsub(/[*]/, "\\*", text) }
            while (match(text, /docs\/[a-z_\/]+[.]md/)) {
                at = substr(text, RSTART + 5, RLENGTH - 5)
                text = substr(text, 1, RSTART - 1) "[" at "](" at ")" substr(text, RSTART + RLENGTH)
            }
            return text
        }
        function wrapped(text,   n, word, i, line) {
            n = split(text, word, " ")
            for (i = 1; i <= n; i++) {
                if (length(line word[i]) > 98) { print line; line = "" }
                line = line (line == "" ? "" : " ") word[i]
            }
            print line
        }
        function flush(   word, of) { # writes the paragraph or the option that was read
            if (kind == "text") { print ""; wrapped(links(text)) }
            if (kind == "option" && text !~ /^as for/ && (head text) in from && length(text) > 30) {
                split(head, word, " ")
                of = from[head text]
                if (!(of in same)) { owner[++owners] = of }
                same[of] = same[of] " `" word[1] "`"
            } else if (kind == "option") {
                from[head text] = now
                gsub(/[|]/, "\\|", head); gsub(/[|]/, "\\|", text)
                print (table++ ? "" : "\n| option | meaning |\n|---|---|\n") "| `" head "` | " links(text) " |"
            }
            kind = head = text = ""
        }
        function shared(   i) { # options with the words of an earlier command
            for (i = 1; i <= owners; i++) { print "|" same[owner[i]] " | as for `whirl " owner[i] "` |" }
            split("", same)
            owners = table = 0
        }
        function ended() { flush(); shared(); if (ends != "") { print ""; wrapped(ends ".") } ends = "" }
        function option(at, next_at) { kind = "option"; head = substr($0, 3, at - 3); text = substr($0, next_at); sub(/ +$/, "", head); sub(/^ +/, "", text) }
        sub(/^@/, "") { ended(); now = $0; if (now == "pil") { print "@bench" } printf "\n## `whirl %s`\n\n", now; next }
        /^usage: / || /^       whirl/ || (used && /^ /) { used = 1; more = 0; print "    " substr($0, 8); next }
        { used = 0 }
        /^$/ { flush(); next }
        /^Exit status:/ { flush(); shared(); next }
        /^  [0-9]/ { if (/:/) { ends = ends (ends == "" ? "Exit status " : "; ") $1 substr($0, index($0, ":")); more = 1 } else { more = 0 } next }
        more && /^       / { sub(/^ +/, " "); ends = ends $0; next }
        /^ +whirl / { flush(); print "\n  " $0; next }
        kind == "list" || /^  --[a-z]+ (--|[(]as)/ {
            if (kind != "list") { flush(); kind = "list"; head = "" }
            sub(/^ +/, ""); head = head (head == "" ? "" : " ") $0
            if (sub(/ *[(]as for `whirl run`[)]/, "", head)) { kind = "option"; text = "as for `whirl run`" }
            next
        }
        /^  --/ {
            flush()
            if (match($0, /, with --as /)) { option(RSTART, RSTART + 2) }
            else if (match(substr($0, 5), /  +/)) { option(RSTART + 4, RSTART + 4) }
            else { option(substr($0, 23, 1) == " " ? 23 : 200, substr($0, 23, 1) == " " ? 24 : 200) }
            next
        }
        kind != "" && (kind == "text" || /^      /) { sub(/^ +/, ""); text = text (text == "" ? "" : " ") $0; next }
        { flush(); if (table) { shared() } kind = "text"; text = $0 }
        END { ended() }'; } | sed "$cut"
}

man() {
    mkdir -p "$1" && for page in commands commands_bench; do sed '1,/^<!-- generated/d' "docs/$page.md"; done | awk -v folder="$1" -v version="$("$whirl" version)" '
        function plain(text) { gsub(/\\[|]/, "|", text); gsub(/\\[*]/, "*", text); gsub(/\[`|`\]\([^)]*\)|`|\]\([a-z_\/]*[.]md\)/, "", text)
                               while (match(text, /\[[a-z_\/]+[.]md/)) { text = substr(text, 1, RSTART - 1) substr(text, RSTART + 1) }
                               gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); return (text ~ /^[.\047]/ ? "\\&" : "") text }
        function begin(name, does) { file = folder "/" name ".1"
            print ".TH " toupper(name) " 1 \"\" \"" version "\" Whirl\n.SH NAME\n" plain(name " - " does) "\n.SH SYNOPSIS" >file }
        BEGIN { begin("whirl", "from the energies of a mechanism to its motion and firmware"); print "whirl COMMAND ...\n.SH COMMANDS" >file }
        /^[|](---| command| option)/ { next }
        /^[|] \[/ { does[$3] = $0; gsub(/.* [|] | [|]$/, "", does[$3]) }
        /^## / { name = $3; gsub(/`/, "", name); begin("whirl-" name, does[name]); synopsis = 1; next }
        /^$/ { if (!synopsis) { print ".PP" >file } next }
        synopsis && !/^    / { print ".SH DESCRIPTION" >file; synopsis = 0 }
        /^    / { sub(/^ +/, ""); print plain($0) "\n.br" >file; next }
        /^[|]/ { at = index($0, " | "); print ".TP\n.B " plain(substr($0, 3, at - 3)) "\n" plain(substr($0, at + 3, length($0) - at - 4)) >file; next }
        { print plain($0) >file }'
}

"$@"
