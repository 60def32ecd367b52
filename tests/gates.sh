#!/bin/sh
# gates.sh LOGS MAKE GATE...: run the quality gates `make gate-GATE`, a line for each. The last line
# is "N passed, N failed"; the exit status is 0 if none failed.
set -u

logs=${1:?usage: gates.sh LOGS MAKE GATE...}
make=${2:?usage: gates.sh LOGS MAKE GATE...}
shift 2
mkdir -p "$logs"
passed=0
failed=0

for gate in "$@"; do
    log=$logs/$gate.log
    start=$(date +%s)
    if $make "gate-$gate" >"$log" 2>&1 </dev/null; then
        passed=$((passed + 1))
        printf '  PASS  %-12s %4d s\n' "$gate" "$(($(date +%s) - start))"
        # Sizes are worth seeing at every change, not only when the gate fails.
        [ "$gate" != size ] || grep -v '^ *\(CC\|AR\|LINK\|GEN\) ' "$log" | sed 's/^/        /'
    else
        failed=$((failed + 1))
        printf '  FAIL  %-12s %4d s   make gate-%s; %s\n' "$gate" "$(($(date +%s) - start))" \
            "$gate" "$log"
        # What counts comes first in a compiler's log and last in a script's; warnings alone fail no gate but those where
        # they are errors.
        { grep -E -A 2 '(error[: ]|ERROR|FAIL|^not ok|differs)' "$log" || tail -n 8 "$log"; } |
            head -n 16 | cut -c 1-160 | sed 's/^/        /'
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
