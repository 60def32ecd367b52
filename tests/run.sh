#!/bin/sh
# run.sh LOGS [WHAT COMMAND]...: runs test programs, stores their output in the folder LOGS, and adds up the results.
#
# A program ends with Unity's line ("3 Tests 0 Failures 0 Ignored"); a script prints "ok - what" and "not ok - what"
# lines. A program that crashes, hangs, fails without a reason, or runs no test counts as a failure. The last line is "N
# passed, N failed"; the exit status is 0 if none failed. TEST_SECONDS limits the processor time of each process
# (limit.sh). TEST_JOBS processes run at the same time; the default is the number of processors. Each is reported when
# it ends, with the seconds that passed and the processor's seconds, which depend less on other work. With TEST_BEGINS=1
# each is also named when it begins.
set -u

# --- one program, in a process of its own: run.sh LOGS --one NUMBER ----------------------------------
report() { # what it came to
    if [ "$failed" -eq 0 ]; then
        word=PASS
    else
        word=FAIL
    fi
    printf '  %s  %-34s %4d passed %3d failed' "$word" "$what" "$passed" "$failed"
    [ "$skipped" -eq 0 ] || printf ' %3d skipped' "$skipped"
    printf ' %4d s %4d s of processor\n' "$(($(date +%s) - start))" "$processor"
    if [ "$failed" -ne 0 ]; then
        grep -E ':FAIL|^not ok|ERROR: |runtime error:' "$log" | head -n 20 | sed 's/^/        /'
        if [ -n "$why" ]; then
            echo "        $why; its last lines:"
            tail -n 5 "$log" | sed 's/^/          /'
        fi
        echo "        all it said: $log"
    fi
}

run_one() {
    log=$logs/$1.log
    what=$(cat "$logs/$1.what")
    limit=${TEST_SECONDS:-300}
    start=$(date +%s)
    [ -z "${TEST_BEGINS:-}" ] || printf '  RUN   %s\n' "$what"
    sh tests/limit.sh "$limit" sh "$logs/$1.command" </dev/null >"$log.raw" 2>&1
    status=$?
    # What it and its children took: the second line of `times`, "0m3.21s 0m0.45s".
    times >"$log.times"
    processor=$(awk 'NR == 2 { gsub(/[ms]/, " "); printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' "$log.times")
    rm -f "$log.times"
    tr -d '\r' <"$log.raw" >"$log" # the emulated console ends its lines with carriage returns
    rm -f "$log.raw"
    read -r passed failed skipped <<END
$(awk '/^[0-9]+ Tests [0-9]+ Failures [0-9]+ Ignored/ { tests += $1; bad += $3; skip += $5 }
       /^ok( |$)/ { tests++ }
       /^not ok( |$)/ { tests++; bad++ }
       END { print tests - bad - skip, bad + 0, skip + 0 }' "$log")
END
    why=""
    if [ "$status" -eq 152 ]; then
        why="used more than $limit s of processor"
    elif [ "$status" -eq 124 ] || [ "$status" -eq 137 ]; then
        why="did not end"
    elif [ "$status" -ne 0 ] && [ "$failed" -eq 0 ]; then
        why="exit status $status, though no test failed"
    elif [ "$status" -eq 0 ] && [ "$failed" -ne 0 ]; then
        why="exit status 0, though tests failed"
    elif [ $((passed + failed)) -eq 0 ]; then
        why="ran no test"
    fi
    [ -z "$why" ] || failed=$((failed + 1))
    report >"$logs/$1.report"
    cat "$logs/$1.report"
    echo "$passed $failed" >"$logs/$1.result"
}

logs=${1:?usage: run.sh LOGS [WHAT COMMAND]...}
shift
if [ "${1:-}" = --one ]; then
    run_one "$2"
    exit 0
fi

# --- all of them -------------------------------------------------------------------------------------
rm -rf "$logs"
mkdir -p "$logs"
number=0
while [ $# -ge 2 ]; do
    number=$((number + 1))
    echo "$1" >"$logs/$number.what"
    echo "$2" >"$logs/$number.command"
    shift 2
done
if [ "$number" -eq 0 ]; then
    echo "  FAIL  there was nothing to run"
    echo "0 passed, 1 failed"
    exit 1
fi
jobs=${TEST_JOBS:-$(nproc 2>/dev/null || echo 1)}
seq "$number" | xargs -P "$jobs" -n 1 sh "$0" "$logs" --one

# A program whose result is missing was broken off, and has failed.
all_passed=0
all_failed=0
while [ "$number" -gt 0 ]; do
    read -r passed failed <"$logs/$number.result" 2>/dev/null || { passed=0 && failed=1; }
    all_passed=$((all_passed + passed))
    all_failed=$((all_failed + failed))
    number=$((number - 1))
done
echo "$all_passed passed, $all_failed failed"
[ "$all_failed" -eq 0 ]
