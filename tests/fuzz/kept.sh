#!/bin/sh
# kept.sh PROGRAM...: give each FUZZER.kept (kept.c) what is in tests/fuzz/kept/FUZZER. With the sanitizers' build, any slip
# in memory or arithmetic fails; what hangs is ended.
set -u

bad=0
for program in "$@"; do
    name=$(basename "$program" .kept)
    if timeout --kill-after=5 600 "$program" tests/fuzz/kept/"$name"/* >/dev/null 2>"$program.said"; then
        printf '%s: %s\n' "$name" "$(tr '\r' '\n' <"$program.said" | tail -n 1)"
    else
        echo "FAIL $name: at $(tr '\r' '\n' <"$program.said" | grep -m 1 -B 1 -E 'ERROR|runtime error|error:' | head -n 1)"
        tr '\r' '\n' <"$program.said" | grep -E 'ERROR|SUMMARY|runtime error|error:' | head -n 5 | sed 's/^/    /'
        bad=1
    fi
done
exit $bad
