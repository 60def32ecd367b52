#!/bin/sh
# coverage.sh FOLDER: run the portable suites that were built in FOLDER with gcc's counters, and print how many lines and
# branches of the core they reach, file by file (coverage.awk says what counts). What was not reached stands in
# FOLDER/missed.txt. LINES_LEAST, BRANCHES_LEAST: the least of each, in per cent (exit status 1 below).
set -u
folder=$1
mkdir -p "$folder/log"
find "$folder" -name '*.gcda' -delete
for program in core_float core_double; do
    log=$folder/log/$program
    "$folder/tests/$program" >"$log" 2>&1 || { grep FAIL "$log" || tail -n 3 "$log"; exit 1; }
done
: >"$folder/missed.new"
find "$folder" -name '*.gcda' | sort | xargs -n 1 gcov -b -c -t 2>"$folder/log/gcov" |
    awk -v only='^core/' -v missed="$folder/missed.new" -v lines_least="${LINES_LEAST:-0}" \
        -v branches_least="${BRANCHES_LEAST:-0}" -f mk/coverage/coverage.awk >"$folder/files.txt"
status=$?
cat "$folder/files.txt"
# A file with functions that no test includes would otherwise not even count as missed.
for file in $(grep -lx '}' core/*.c core/*/*.c) $(grep -lE '^(WH_INLINE|WH_APART|static inline)' core/*.h core/*/*.h); do
    grep -q "^$file " "$folder/files.txt" || { echo "make coverage: no test of tests/core includes $file"; status=1; }
done
sort -t : -k 1,1 -k 2,2n "$folder/missed.new" >"$folder/missed.txt"
rm -f "$folder/missed.new"
echo "What nothing reached: $folder/missed.txt"
exit "$status"
