#!/bin/sh
# docs.sh: tests/docs.sh finds every output in a page that differs from its command's, and renews it. Random pages have a
# line dropped, added or with another digit, a command that fails, or blocks that take too long.
. "$(dirname "$0")/../checks.sh"

page=$scratch/page.md

# draw SEED KIND: a page with three commands, each with 4 to 9 lines of two numbers as output. One line is changed by KIND:
# right (unchanged), dropped, added, digit, or word.
draw() {
    awk -v seed="$1" -v kind="$2" '
        function below(n) { seed = (seed * 69069 + 12345) % 4294967296; return int(seed / 65536) % n }
        BEGIN {
            print "```txt words.txt"; print "only a word"; print "```\n"
            print "```console"; print "$ cat words.txt"; print "only a word"; print "```\n"
            wrong = below(3)
            for (b = 0; b < 3; b++) {
                lines = 4 + below(6)
                print "```console"; printf "$ printf \"%%s\\n\""
                for (i = 0; i < lines; i++) { row[i] = "row " i " is " 10 + below(90) "." 100 + below(900) " m"; printf " \"%s\"", row[i] }
                print " \"took " below(100) " ns\""
                at = below(lines)
                elided = below(2) ? 1 + below(lines - 2) : -1; if (elided >= at - 1 && elided <= at + 1) { elided = -1 }
                for (i = 0; i < lines; i++) {
                    line = row[i]
                    if (b == wrong && i == at) {
                        if (kind == "dropped") { continue }
                        if (kind == "added") { print "row " i " is " 10 + below(90) " m, one more" }
                        if (kind == "digit") { d = substr(line, length(line) - 2, 1); line = substr(line, 1, length(line) - 3) (d + 1) % 10 " m" }
                        if (kind == "word") { sub(/row/, "line", line) }
                    }
                    print i == elided ? "..." : line
                }
                print "took ~" below(100) " ns"; print "```\n"
            }
        }'
}

for kind in right dropped added digit word; do
    pages=
    for seed in 1 2; do
        draw "$seed" $kind >"$scratch/drawn_$seed.md"
        pages="$pages $scratch/drawn_$seed.md"
    done
    sh tests/docs.sh check $pages >"$scratch/said" 2>&1
    status=$?
    [ $kind = right ] && wanted=0 || wanted=1
    [ $status -eq $wanted ] && [ "$(grep -c '^not ok' "$scratch/said")" -eq $((2 * wanted)) ]
    verdict $? "two drawn pages, $kind" "$scratch/said"
    sh tests/docs.sh renew $pages >"$scratch/said" 2>&1
    verdict $? "renewing them succeeds" "$scratch/said"
    sh tests/docs.sh check $pages >"$scratch/said" 2>&1
    verdict $? "and renewed they are right" "$scratch/said"
done

# found WHAT TEXT MODE [SETTING]: the page on standard input must be refused, with TEXT
found() {
    cat >"$page"
    env "${4:-X=}" sh tests/docs.sh "$3" "$page" >"$scratch/said" 2>&1
    [ $? -eq 1 ] && grep -q "^not ok.*$2" "$scratch/said"
    verdict $? "$1" "$scratch/said"
}
printf '```console\n$ true\n$ false\n```\n' | found "a command that fails and shows nothing" 'false$' check
printf '```sh run\ntrue\nexit 3\n```\n' | found "a command that fails in a block that is run" 'exit 3' check
printf '```sh\necho 1\n```\n\nprints\n\n```\n1\n```\n' | found "output that no command is run for" 'output below' check
printf 'It prints\n\n    $ echo 1\n    1\n' | found "a command in no block" 'belong into a block' check
printf '```console\n$ echo ~1k\n~2k\n```\n' | found "a mark that the output has, too" 'echo' check
work='i=0; while [ $i -lt 99999 ]; do i=$((i + 1)); done'
printf '```sh run\n%s\n```\n' "$work" | found "a block that takes too long" 'mark the block slow' check DOCS_MOST=0.01
printf '```sh run\n%s\n%s\n%s\n%s\n%s\n%s\n%s\n%s\n```\n' "$work" "$work" "$work" "$work" "$work" "$work" "$work" "$work" |
    found "blocks that take too long together" 'mark blocks slow' check DOCS_MOST_ALL=0
printf '```console slow\n$ echo 1\n2\n```\n' | found "a slow block, where all are run" 'echo 1' slow
sh tests/docs.sh check "$page" >"$scratch/said" 2>&1
verdict $? "which is left out in CI" "$scratch/said"
exit $failed
