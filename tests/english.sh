#!/bin/sh
# english.sh: the English of comments and of the user's pages in figures, against limits; `table` prints the figures, and
# `long` the sentences of more than 35 words.
#
# "what" is counted together with whoever, whatever, nobody, none, behind, anew and likewise. docs/dev/style.md has the
# rules; a figure shows only a part of them. A limit is lowered when sentences have been rewritten.
set -u

# The name, and the limits: "what" in 1,000 words, vague words in 1,000, words of a mean sentence, sentences of more than 35.
budget='
core 2 4 13 0
hal-boards 2 6 13 0
host 2 3 13 0
tests 2 4 13 0
pages 2 2 14 0
'

files() { # files NAME
    case $1 in
    core) git ls-files core | grep -E '\.(c|h)$' ;;
    hal-boards) git ls-files hal boards | grep -E '\.(c|h)$' ;;
    host) git ls-files host | grep -E '\.(c|h|inc)$' ;;
    tests) git ls-files tests | grep -E '\.(c|h)$' ;;
    pages) git ls-files README.md 'docs/*.md' 'docs/howto/*.md' | grep -v -e ^docs/dev/ -e ^docs/hard/ ;;
    esac
}

# prose NAME: prints its paragraphs, as lines "FILE<tab>TEXT", without the code, tables and headings of pages.
prose() {
    if [ "$1" = pages ]; then
        files "$1" | xargs awk '
            function flush() {
                gsub(/`[^`]*`/, "X", text); gsub(/\]\([^)]*\)/, "", text); gsub(/\[/, "", text)
                if (text != "") { print file "\t" text }
                text = ""
            }
            FNR == 1 { flush(); file = FILENAME; code = 0 }
            /^ *```/ { code = !code; flush(); next }
            code || /^ *\|/ || /^#/ || /^</ { flush(); next }
            /^ *$/ || (text == "" && /^    /) { flush(); next }
            /^ *([-*]|[0-9]+\.) / { flush(); sub(/^ *([-*]|[0-9]+\.) /, "") }
            { text = text " " $0 }
            END { flush() }'
    else
        files "$1" | xargs awk '
            function flush() { if (text ~ /[a-z]/) { print file "\t" text } text = "" }
            FNR == 1 { flush(); file = FILENAME; inside = 0 }
            {
                line = $0
                if (!inside) {
                    gsub(/"([^"\\]|\\.)*"/, "", line)
                    if (match(line, /\/\/ /)) { flush(); text = substr(line, RSTART + 3); flush(); next }
                    if (!match(line, /\/\*/)) { next }
                    flush()
                    line = substr(line, RSTART + 2)
                    inside = 1
                }
                ended = match(line, /\*\//)
                if (ended) { line = substr(line, 1, RSTART - 1) }
                sub(/^ *\*? ?/, "", line)
                if (line ~ /^ *- /) { flush(); item = 1 }
                if (line ~ /^ *$/ || line ~ /^=+ .*=+ *$/) { flush(); item = 0 }
                else if (!item && line ~ /^(  |[^ ]+  )/) { flush() } # code, or a table
                else { text = text " " line }
                if (ended) { flush(); inside = 0; item = 0 }
            }
            END { flush() }'
    fi
}

# figures NAME: words, "what" in 1,000, vague words in 1,000, mean sentence, sentences over 30 and over 35 words
figures() {
    prose "$1" | awk -F'\t' -v long="${LONG:-0}" -v limit="${2:-35}" '
        {
            n = split($2, word, " ")
            count = 0
            first = 1
            for (i = 1; i <= n; i++) {
                bare = tolower(word[i])
                gsub(/[^a-z]/, "", bare)
                if (bare != "") { words++; count++ }
                what += bare ~ /^(what|whats|whoever|whatever|nobody|none|behind|anew|likewise)$/
                vague += bare ~ /^(told|held|kept|behind|anew|likewise|none|off)$/ || (bare == "left" && word[i + 1] ~ /^over/)
                if (word[i] ~ /[.!?][)"*]*$/ || i == n) {
                    if (count >= 3) { sentences++; total += count }
                    over30 += count > 30
                    over35 += count > 35
                    if (long && count > limit) {
                        line = $1 ":"
                        for (k = first; k <= i; k++) { line = line " " word[k] }
                        print line
                    }
                    count = 0
                    first = i + 1
                }
            }
        }
        END {
            if (!long) { printf "%d %.1f %.1f %.1f %d %d\n", words, 1000 * what / words, 1000 * vague / words, total / sentences, over30, over35 }
        }'
}

if [ "${1:-}" = long ]; then
    for name in core hal-boards host tests pages; do LONG=1 figures $name "${2:-35}"; done
    exit 0
fi
[ "${1:-}" != table ] || printf '| read | words | "what" in 1,000 | vague in 1,000 | mean sentence | over 30 words | over 35 words |\n| :-- | --: | --: | --: | --: | --: | --: |\n'
bad=0
for name in core hal-boards host tests pages; do
    read -r words what vague mean over30 over35 <<END
$(figures $name)
END
    [ "${1:-}" != table ] || echo "| $name | $words | $what | $vague | $mean | $over30 | $over35 |"
    read -r what_most vague_most mean_most long_most <<END
$(echo "$budget" | sed -n "s/^$name //p")
END
    if awk "BEGIN { exit !($what > $what_most || $vague > $vague_most || $mean > $mean_most || $over35 > $long_most) }"; then
        echo "error: $name: $what of \"what\" and $vague vague words in 1,000, $mean words a sentence, $over35 sentences above 35 words; the limits are $what_most, $vague_most, $mean_most and $long_most"
        echo "hint: docs/dev/style.md; sh tests/english.sh long"
        bad=1
    fi
done
exit $bad
