#!/bin/sh
# weight.sh: the lines of the tracked files, and the words of the user's pages, against the budget; `table` prints a line for
# each subsystem too.
# A limit is lowered when lines have gone. Growth is paid for by removal, not by a higher limit.
set -u

# The name, its limit, and the aim for the state that is tagged 0.3.0.
budget='
product 84900 80000
tests 100000 100000
mk 7990 8000
files 1430 1700
words 50000 50000
'

files() { # files SUBSYSTEM
    case $1 in
    product) git ls-files core hal boards host | grep -E '\.(c|h|inc|js|mjs|html)$' ;;
    files) git ls-files ;;
    tests) git ls-files tests | grep -E '\.(c|h|cpp|sh|py|mjs|awk)$' ;;
    mk) git ls-files mk ;;
    words) git ls-files README.md 'docs/*.md' 'docs/howto/*.md' | grep -v -e ^docs/dev/ -e ^docs/hard/ ;;
    esac
}
weight() {
    if [ "$1" = files ]; then
        files files | wc -l
    elif [ "$1" = words ]; then
        files words | xargs cat | wc -w
    else
        files "$1" | xargs cat | wc -l
    fi
}

if [ "${1:-}" = table ]; then
    printf '| folder | files | lines |\n| :-- | --: | --: |\n'
    for folder in core hal boards host/*/ tests/*/ mk; do
        listed=$(git ls-files "$folder" | grep -E '\.(c|h|cpp|inc|js|mjs|sh|py|awk|mk)$')
        [ -z "$listed" ] ||
            printf '| %s | %d | %d |\n' "${folder%/}" "$(echo "$listed" | wc -l)" "$(echo "$listed" | xargs cat | wc -l)"
    done
    printf '\n| weighed | now | limit | aim |\n| :-- | --: | --: | --: |\n'
fi
bad=0
for name in product tests mk files words; do
    now=$(weight $name)
    limit=$(echo "$budget" | sed -n "s/^$name \([0-9]*\) .*/\1/p")
    aim=$(echo "$budget" | sed -n "s/^$name [0-9]* //p")
    [ "${1:-}" != table ] || echo "| $name | $now | $limit | $aim |"
    if [ "$now" -gt "$limit" ]; then
        echo "error: $name: $now, more than $limit; hint: remove as much as you add (sh tests/weight.sh table)"
        bad=1
    fi
done
exit $bad
