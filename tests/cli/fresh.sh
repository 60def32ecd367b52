#!/bin/sh
# fresh.sh: in a fresh clone, make first builds what a file needs: the generated scenes come before their library and before
# any source that includes them. Checks make's plan; nothing is built.
. "$(dirname "$0")/../checks.sh"

cp -R Makefile mk core hal boards host tests "$scratch/" || exit 1
plan() { # plan WORD...: prints what make would do
    (cd "$scratch" && rm -rf build && env -i PATH="$PATH" HOME="$HOME" make -n V=1 "$@") >"$scratch/plan" 2>"$scratch/err"
}
# before FIRST SECOND: in the plan, a line that matches FIRST must precede all lines that match SECOND
before() {
    awk -v first="$1" -v second="$2" '$0 ~ first && !at { at = NR } $0 ~ second && !then { then = NR }
        END { exit !(at && then && at < then) }' "$scratch/plan"
}
for target in build/mps2-an386/firmware.elf build/tests/core_float; do
    plan $target && before 'emit-scenes' 'libscenes.a' && before 'emit-scenes' "-o $target\$|-o $target "
    verdict $? "$target"
done
before 'emit-scenes' '-c tests/core/test_scenes.c'
verdict $? "what includes the scenes' headers is compiled after they are there"
plan B=build/other build/other/tests/core_float && before 'build/gen/.stamp' 'libscenes.a'
verdict $? "another configuration has the main one make them"
exit $failed
