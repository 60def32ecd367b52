#!/bin/sh
# docs.sh check|slow|renew PAGE...: runs the commands that pages print, and compares their output with the page.
#
# In a block ```console, a line "$ command" is run, and the lines below it are its output, on standard output and
# standard error. A line "..." stands for any lines, "..." inside a line for any text, and ~X for any word in place of
# X, a figure of this machine. A command without output below it must succeed, and so must each line of a block ```sh
# run. A block with a file name, such as ```whirl gear.whirl, is saved under that name. The commands of a page run in
# order, in a folder of their own with a copy of the project.
#
# `check` omits the blocks marked slow (```console slow). It fails if another block uses more than 15 s of processor
# time, or all use more than 120 s (DOCS_MOST, DOCS_MOST_ALL). `slow` runs all blocks. `renew` runs all and writes their
# output into the page.
set -u

# --- one page: docs.sh MODE --one FOLDER PAGE ---------------------------------------------------------

# split PAGE FOLDER: the page's steps as files: N.save and N.name; or N.command, N.wanted, and N.at with the lines of the block's
# begin and of the output's begin and end, and "slow" or "quick".
split() {
    awk -v into="$2/" -v page="$1" '
        function step(kind) { n++; base = sprintf("%s%04d", into, n); file = base "." kind; printf "" >file; close(file) }
        function ended(line) { # the output ends before this line
            if (wants) { print block, first, line - 1, speed >(base ".at"); close(base ".at") }
            wants = 0
        }
        function command(words) {
            step("command"); print words >file
            printf "" >(base ".wanted"); close(base ".wanted")
            more = words ~ /\\$/
            wants = 1; first = NR + 1
        }
        mode == "" && /^ *```[a-z]/ {
            block = NR; speed = / slow/ ? "slow" : "quick"; language = $1; sub(/```/, "", language)
            if (language == "console") { mode = "console" }
            else if (language == "sh" && ($2 == "run" || $2 == "slow")) { mode = "sh" }
            else if (NF == 2 && language != "sh") { mode = "save"; step("name"); print $2 >file; file = base ".save"; printf "" >file }
            else { mode = "other" }
            last = language; next
        }
        mode == "" && /^ *```/ {
            if (last == "sh" && prose <= 1) {
                print page ":" NR ": output below a ```sh block: write ```console, and \"$ \" before the commands" >(into "bad")
            }
            mode = "other"; last = ""; next
        }
        mode != "" && /^ *```$/ { ended(NR); mode = ""; more = 0; prose = 0; close(file); next }
        mode == "" && /^    [$] / {
            print page ":" NR ": a command and its output belong into a block ```console" >(into "bad")
        }
        mode == "" && NF { prose++; next }
        mode == "save" { print >file; next }
        mode == "" || mode == "other" { next }
        more { print >(base ".command"); more = /\\$/; first = NR + 1; next }
        mode == "console" && /^[$] / { ended(NR); command(substr($0, 3)); next }
        mode == "console" && !wants { next }
        mode == "console" { print >(base ".wanted"); next }
        mode == "sh" && NF && !/^#/ { ended(NR); command($0); wants = 0; print block, 0, 0, speed >(base ".at"); close(base ".at") }
    ' "$1"
}

# Compares, and prints the renewed output. Lines of WANTED that are right stay. Any other line is replaced by the line
# of SAID that has the same words with other numbers. Exit status 1 if they differ.
compare='
    function key(line) { gsub(/~?[-+]?(0x[0-9a-f]+|[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?)/, "#", line); gsub(/[ \t]+/, " ", line); return line }
    function pattern(line,   i, n, word, out) {
        gsub(/[][\\.^$*+?(){}|]/, "\\\\&", line)
        gsub(/\\\.\\\.\\\./, ".*", line)
        n = split(line, word, /[ \t]+/)
        out = word[1]
        for (i = 1; i <= n; i++) {
            if (word[i] ~ /^~/) { word[i] = "(" word[i] "|[^~ ][^ ]*)" }
            out = i == 1 ? word[1] : out " " word[i]
        }
        return "^" out "$"
    }
    function alike(w, s) {
        if (w == s) { return 1 }
        if (w !~ /(^|[ \t])~/ && w !~ /[.][.][.]/) { return 0 }
        gsub(/[ \t]+/, " ", s)
        return s ~ pattern(w)
    }
    function marked(w, s,   i, n, a, b, at, out) { # the line s with the marks ~ of w
        n = split(w, a, /[ \t]+/)
        if (w !~ /(^|[ \t])~/ || split(s, b, /[ \t]+/) != n) { return s }
        for (i = 1; i <= n; i++) {
            at = index(s, b[i])
            out = out substr(s, 1, at - 1) (a[i] ~ /^~/ && b[i] !~ /^~/ ? "~" : "") b[i]
            s = substr(s, at + length(b[i]))
        }
        return out s
    }
    { sub(/[ \t\r]+$/, "") }
    FILENAME == ARGV[1] { W[++nw] = $0; next }
    { S[++ns] = $0 }
    END {
        same = 1; at = 0; gap = 0
        for (i = 1; i <= nw; i++) {
            if (W[i] ~ /^ *[.][.][.]$/) { gap = 1; out = out W[i] "\n"; continue }
            for (j = at + 1; j <= ns && !alike(W[i], S[j]); j++) { }
            if (j > ns || (!gap && j != at + 1)) {
                same = 0
                for (j = at + 1; j <= ns && key(S[j]) != key(W[i]); j++) { }
                if (j > ns && !gap) { j = at + 1 }
                if (j > ns) { continue }
                for (k = at + 1; !gap && k < j; k++) { out = out S[k] "\n" }
                out = out marked(W[i], S[j]) "\n"
            } else {
                out = out W[i] "\n"
            }
            at = j; gap = 0
        }
        if (!gap && at < ns) { same = 0; for (k = at + 1; k <= ns; k++) { out = out S[k] "\n" } }
        printf "%s", out
        exit !same
    }'

run_page() {
    mode=$1
    folder=$2
    page=$3
    mkdir -p "$folder/steps" "$folder/here/docs/figures"
    root=$PWD
    for part in * docs/*; do # pictures are drawn there, not in the project
        case $part in
        docs | docs/figures) ;;
        *) ln -s "$root/$part" "$folder/here/$part" ;;
        esac
    done
    split "$page" "$folder/steps"
    [ ! -s "$folder/steps/bad" ] || sed 's/^/not ok - /' "$folder/steps/bad"
    before=0
    : >"$folder/renewed"
    for step in "$folder"/steps/*.name "$folder"/steps/*.command; do
        echo "$step"
    done | sort | while read -r step; do
        base=${step%.*}
        [ -e "$step" ] || continue
        if [ "$step" = "$base.name" ]; then
            cp "$base.save" "$folder/here/$(cat "$base.name")"
            continue
        fi
        read -r block first last speed <"$base.at"
        [ "$mode" != check ] || [ "$speed" = quick ] || continue
        # Its processor time and that of its children: the second line of `times`.
        (cd "$folder/here" && env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL sh "$root/tests/limit.sh" 3600 sh "$base.command" </dev/null >"$base.said" 2>&1
            echo $? >"$base.status"
            times >"$base.times")
        took=$(awk 'NR == 2 { gsub(/[ms]/, " "); printf "%.2f", 60 * ($1 + $3) + $2 + $4 }' "$base.times")
        echo "$block $speed $took" >>"$folder/took"
        status=$(cat "$base.status")
        if [ ! -s "$base.wanted" ]; then
            [ "$status" -eq 0 ]
        else
            awk "$compare" "$base.wanted" "$base.said" >"$base.new"
        fi
        right=$?
        word="not ok"
        [ $right -ne 0 ] || word=ok
        [ $right -eq 0 ] || [ "$mode" != renew ] || [ ! -s "$base.wanted" ] || word="renewed"
        printf "%s - %s:%s: %s s: %s\n" "$word" "$page" "$block" "$took" "$(head -n 1 "$base.command")"
        if [ $right -ne 0 ]; then
            if [ -s "$base.wanted" ]; then
                diff "$base.wanted" "$base.new" | grep '^[<>]' | head -n 12 | sed 's/^/    /'
                echo "$first $last $base.new" >>"$folder/renewed"
            else
                { echo "exit status $status:" && tail -n 4 "$base.said"; } | sed 's/^/    /'
            fi
        fi
    done
    # What a block used, and what is too much for CI.
    [ "$mode" != check ] || [ ! -e "$folder/took" ] || awk -v page="$page" -v most="${DOCS_MOST:-15}" '
        { took[$1] += $3 }
        END { for (b in took) { if (took[b] > most) { print "not ok - " page ":" b ": " took[b] " s of processor: more than " most ", mark the block slow" } } }' "$folder/took"
    [ "$mode" != renew ] || [ ! -s "$folder/renewed" ] || awk -v list="$folder/renewed" '
        BEGIN { while ((getline line <list) > 0) { split(line, a, " "); to[a[1]] = a[2]; by[a[1]] = a[3] } }
        NR in by { while ((getline line <by[NR]) > 0) { print line } until = to[NR] }
        NR > until { print }' "$page" >"$folder/page"
    [ ! -s "$folder/page" ] || { cp "$folder/page" "$page" && echo "$page: renewed"; }
}

if [ "${2:-}" = --one ]; then
    run_page "$1" "$3/$(echo "$4" | tr '/.' '__')" "$4" >"$3/$(echo "$4" | tr '/.' '__').log" 2>&1
    exit 0
fi

mode=${1:?usage: docs.sh check|slow|renew PAGE...}
shift
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
printf '%s\n' "$@" | xargs -P "${DOCS_JOBS:-$(nproc 2>/dev/null || echo 1)}" -n 1 sh "$0" "$mode" --one "$scratch"
cat "$scratch"/*.log
all=$(cat "$scratch"/*/took 2>/dev/null | awk '{ all += $3 } END { printf "%.0f", all }')
most=${DOCS_MOST_ALL:-120}
[ "$mode" != check ] || [ "$all" -le "$most" ] || echo "not ok - $all s of processor: more than $most, mark blocks slow" | tee "$scratch/all.log"
echo "$(cat "$scratch"/*/took 2>/dev/null | wc -l) commands, $all s of processor"
! grep -q '^not ok' "$scratch"/*.log
