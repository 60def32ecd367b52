#!/bin/sh
# coverage.sh FOLDER [SUITES]: run the suites that were built in FOLDER with gcc's counters (those of the program only
# as far as named; all without), and print how many lines and branches of the core they reach, file by file. What was not
# reached stands in FOLDER/core.txt. LINES and BRANCHES: the least of each, in per cent (exit status 1 below).
set -u
folder=$1
suites=${2:-}
mkdir -p "$folder/log"
find "$folder" -name '*.gcda' -delete
for program in core_float core_double; do
    "$folder/tests/$program" >"$folder/log/$program" 2>&1 || { tail -n 3 "$folder/log/$program"; exit 1; }
done
# shellcheck disable=SC2086 # a list of words
"$folder/tests/host" $suites >"$folder/log/host" 2>&1 || { grep FAIL "$folder/log/host"; exit 1; }
gcovr --root . --object-directory "$folder" --filter 'core/' --exclude 'core/models/' --exclude-unreachable-branches \
    --txt "$folder/core.txt" --json "$folder/core.json" "$folder" || exit 1
gcovr --root . --add-tracefile "$folder/core.json" --branches --txt "$folder/branches.txt" || exit 1
gcovr --root . --add-tracefile "$folder/core.json" --print-summary --txt /dev/null \
    --fail-under-line "${LINES_LEAST:-0}" --fail-under-branch "${BRANCHES_LEAST:-0}"
