#!/bin/sh
# kept.sh PROGRAM...: gives each program FUZZER.kept (kept.c) the inputs in tests/fuzz/kept/FUZZER.tar.gz. Programs that
# are built with sanitizers fail at errors of memory or arithmetic, too. A program that hangs is killed.
set -u

bad=0
for program in "$@"; do
    name=$(basename "$program" .kept)
    said=$program.said
    [ -x "$program" ] || { echo "kept.sh: error: there is no program $program" >&2 && exit 2; }
    inputs=$program.inputs
    rm -rf "$inputs" && mkdir -p "$inputs" && tar -xzf "tests/fuzz/kept/$name.tar.gz" -C "$inputs" || exit 2
    sh tests/limit.sh 600 "$program" "$inputs/$name"/* >/dev/null 2>"$said"
    status=$?
    tr '\r' '\n' <"$said" >"$said.lines"
    if [ $status -eq 0 ]; then
        printf '%s: %s\n' "$name" "$(tail -n 1 "$said.lines")"
    else
        echo "FAIL $name: exit status $status (124: it hangs) at $(grep "^$inputs/" "$said.lines" | tail -n 1)"
        grep -E 'ERROR|SUMMARY|runtime error|error:' "$said.lines" | head -n 5 | sed 's/^/    /'
        bad=1
    fi
done
exit $bad
