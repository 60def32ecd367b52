#!/bin/sh
# gates.sh LOGS MAKE GATE...: run the quality gates `make gate-GATE`, a line for each. The last line
# is "N passed, N failed"; the exit status is 0 if none failed. A line has the seconds that passed and those that processors
# worked, which other work on the machine lengthens less.
set -u

logs=${1:?usage: gates.sh LOGS MAKE GATE...}
make=${2:?usage: gates.sh LOGS MAKE GATE...}
shift 2
mkdir -p "$logs"
passed=0
failed=0

# Into $worked: what the shell's children took so far, in seconds: the second line of `times`, "0m3.21s 0m0.45s". Only the shell
# itself can ask, no $(...) of it.
look() {
    times >"$logs/times"
    worked=$(awk 'NR == 2 { gsub(/[ms]/, " "); printf "%.0f", 60 * ($1 + $3) + $2 + $4 }' "$logs/times")
}

for gate in "$@"; do
    log=$logs/$gate.log
    start=$(date +%s)
    look
    before=$worked
    $make "gate-$gate" >"$log" 2>&1 </dev/null
    status=$?
    look
    took=$(printf '%4d s %4d s of processor' "$(($(date +%s) - start))" $((worked - before)))
    if [ $status -eq 0 ]; then
        passed=$((passed + 1))
        printf '  PASS  %-12s %s\n' "$gate" "$took"
        # Sizes are worth seeing at every change, not only when the gate fails.
        [ "$gate" != size ] || grep -v '^ *\(CC\|AR\|LINK\|GEN\) ' "$log" | sed 's/^/        /'
    else
        failed=$((failed + 1))
        printf '  FAIL  %-12s %s   make gate-%s; %s\n' "$gate" "$took" "$gate" "$log"
        # What counts comes first in a compiler's log and last in a script's; warnings alone fail no gate but those where
        # they are errors.
        { grep -E -A 2 '(error[: ]|ERROR|FAIL|^not ok|differs)' "$log" || tail -n 8 "$log"; } |
            head -n 16 | cut -c 1-160 | sed 's/^/        /'
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
