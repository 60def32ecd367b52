#!/bin/sh
# coverage.sh FOLDER [SUITES]: run the suites that were built in FOLDER with gcc's counters (those of the program only
# as far as named; all without), and print how many lines and branches of the core they reach, file by file
# (coverage.awk says what counts). What was not reached stands in FOLDER/missed.txt. LINES_LEAST, BRANCHES_LEAST: the least
# of each, in per cent (exit status 1 below).
set -u
folder=$1
suites=${2:-}
here=mk/coverage
mkdir -p "$folder/log"
find "$folder" -name '*.gcda' -delete
run() { # run NAME PROGRAM...
    log=$folder/log/$1
    shift
    "$@" >"$log" 2>&1 || {
        grep FAIL "$log" || tail -n 3 "$log"
        exit 1
    }
}
run core_float "$folder/tests/core_float"
run core_double "$folder/tests/core_double"
# shellcheck disable=SC2086 # a list of words
WHIRL_FEW=1 run host "$folder/tests/host" $suites

: >"$folder/missed.txt"
find "$folder" -name '*.gcda' | sort | while read -r counts; do
    gcov -b -c -t "$counts" 2>>"$folder/log/gcov"
done | awk -v only='^core/' -v missed="$folder/missed.new" -v lines_least="${LINES_LEAST:-0}" \
    -v branches_least="${BRANCHES_LEAST:-0}" -f "$here/coverage.awk"
status=$?
[ ! -e "$folder/missed.new" ] || sort -t : -k 1,1 -k 2,2n "$folder/missed.new" >"$folder/missed.txt"
rm -f "$folder/missed.new"
echo "What nothing reached: $folder/missed.txt"
exit "$status"
