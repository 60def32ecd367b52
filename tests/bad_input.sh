#!/bin/sh
# bad_input.sh WHIRL: WHIRL refuses every text of tests/bad with exit status 2 and a message. Texts named effect_mass_* are
# run, all others derived. With the sanitizers' build, a memory or arithmetic error shows as another exit status.
set -u

whirl=${1:?usage: bad_input.sh WHIRL}
export ASAN_OPTIONS=exitcode=99 UBSAN_OPTIONS=print_stacktrace=1
count=0
bad=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
out=$scratch/out

sh tests/bad.sh "$scratch/bad"
for file in "$scratch"/bad/*; do
    count=$((count + 1))
    case $file in
    */effect_mass_*) command=run ;;
    *) command=derive ;;
    esac
    sh tests/limit.sh 20 "$whirl" "$command" "$file" >"$out" 2>&1 </dev/null
    status=$?
    if [ "$status" -ne 2 ] || ! grep -q 'error:' "$out"; then
        echo "FAIL $file: exit status $status, wanted 2 and a message; it said:"
        head -n 5 "$out" | cut -c 1-200 | sed 's/^/    /'
        bad=$((bad + 1))
    fi
done
echo "$count texts, $bad not refused as they should"
[ "$count" -gt 0 ] && [ "$bad" -eq 0 ]
