#!/bin/sh
# gates.sh LOGS MAKE GATE...: runs the quality gates `make gate-GATE`, with a line for each. The last line is "N passed,
# N failed"; the exit status is 0 if none failed. Gates joined by a plus, a+b, run at the same time, because each leaves
# processors idle. A line has the seconds that passed and the processor's seconds, which depend less on other work.
set -u

logs=${1:?usage: gates.sh LOGS MAKE GATE...}
make=${2:?usage: gates.sh LOGS MAKE GATE...}
shift 2
mkdir -p "$logs"
passed=0
failed=0

# run GATE: writes to a file the exit status, the seconds that passed and the processor's. The shell that waited has the
# latter in the second line of `times`, "0m3.21s 0m0.45s".
run() {
    start=$(date +%s)
    $make "gate-$1" >"$logs/$1.log" 2>&1 </dev/null
    status=$?
    times >"$logs/$1.times"
    echo "$status $(($(date +%s) - start)) $(awk 'NR == 2 { gsub(/[ms]/, " "); printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' "$logs/$1.times")" >"$logs/$1.times"
}

report() {
    log=$logs/$1.log
    read -r status passing worked <"$logs/$1.times"
    took=$(printf '%4d s %4d s of processor' "$passing" "$worked")
    if [ "$status" -eq 0 ]; then
        passed=$((passed + 1))
        printf '  PASS  %-12s %s\n' "$1" "$took"
        # Sizes are worth seeing at every change, not only when the gate fails.
        [ "$1" != size ] || grep -v '^ *\(CC\|AR\|LINK\|GEN\) ' "$log" | sed 's/^/        /'
    else
        failed=$((failed + 1))
        printf '  FAIL  %-12s %s   make gate-%s; %s\n' "$1" "$took" "$1" "$log"
        # Errors come first in a compiler's log and last in a script's. Warnings alone fail only gates in which they are
        # errors.
        { grep -E -A 6 '(error[: ]|ERROR|FAIL|^not ok|differs)' "$log" || tail -n 8 "$log"; } |
            head -n 24 | cut -c 1-160 | sed 's/^/        /'
    fi
}

# Background processes do not receive Ctrl-C.
trap 'trap - TERM; kill 0; exit 130' INT
for gates in "$@"; do
    together=$(echo "$gates" | tr '+' ' ')
    for gate in $together; do
        (run "$gate") &
    done
    wait
    for gate in $together; do
        report "$gate"
    done
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
