#!/bin/sh
# suites.sh: a test program runs the named suites, or all without a name, and refuses an unknown name.
. "$(dirname "$0")/../checks.sh"

folder=$(dirname "$whirl")/tests

for name in host chip_netduinoplus2 core_double core_float; do
    program=$folder/$name
    "$program" no_such_suite >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 2 ] && [ ! -s "$scratch/out" ] &&
        grep -q "^error: there is no suite 'no_such_suite'$" "$scratch/err"
    verdict $? "$name refuses a suite that is not there"

    case $name in
    host) sources=tests/host ;;
    chip_*) sources=tests/chip ;;
    *) sources=tests/core ;;
    esac
    listed=$(sed -n 's/^hint: one of //p' "$scratch/err" | tr -d ',' | tr ' ' '\n' | sort)
    there=$(sed -nE 's/^(void suite_|SUITE\(|TEST\()([a-z0-9_]*)[(,)].*\{.*/\2/p' "$sources"/test_*.c | sort -u)
    [ -n "$there" ] && [ "$listed" = "$there" ]
    verdict $? "$name lists the suites of $sources"

    first=$(echo "$there" | head -n 1)
    "$program" "$first" no_such_suite >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 2 ] && [ ! -s "$scratch/out" ]
    verdict $? "$name refuses it beside one that is there, before running any"
done

# A line begins with the file of its suite, whichever suite ran before.
"$folder/core_double" sine root text >"$scratch/out" 2>"$scratch/err" &&
    sed -n 's/^\([^:]*\):[0-9]*:.*:PASS$/\1/p' "$scratch/out" | grep -v '^tests/main.c$' | uniq >"$scratch/files" &&
    printf 'tests/core/test_%s.c\n' root sine text | diff - "$scratch/files" >"$scratch/err"
verdict $? "lines name the file of their suite"
for kind in core host chip; do
    sh tests/suites.sh tests/$kind/test_*.c | sed -n 's/^    {"suite_\(.*\)", "\(.*\)", .*/\2:\1/p' >"$scratch/table"
    grep -oHE '^(void suite_|SUITE\(|TEST\()[a-z0-9_]*' tests/$kind/test_*.c | sed -E 's/(void suite_|SUITE\(|TEST\()//' | sort -u >"$scratch/there"
    [ -s "$scratch/there" ] && sort "$scratch/table" | diff "$scratch/there" - >"$scratch/err"
    verdict $? "the suites of tests/$kind have their own files"
done

exit $failed
