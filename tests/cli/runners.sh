#!/bin/sh
# runners.sh: tests/run.sh, tests/each.sh, tests/hashes.sh and tests/part.sh end with the right line and exit status,
# whatever their programs do.
. "$(dirname "$0")/../checks.sh"

# expect WHAT STATUS LINE COMMAND...: checks the exit status and the last printed line
expect() {
    what=$1
    status=$2
    line=$3
    shift 3
    "$@" >"$scratch/said" 2>&1
    got=$?
    [ $got -eq "$status" ] && [ "$(tail -n 1 "$scratch/said")" = "$line" ]
    verdict $? "$what" "$scratch/said"
}

# --- run.sh ------------------------------------------------------------------------------------------------
run="sh tests/run.sh $scratch/log"
expect "tests that pass" 0 "5 passed, 0 failed" \
    $run one "echo ok - a; echo ok - b" two "echo '3 Tests 0 Failures 0 Ignored'"
expect "one that fails" 1 "2 passed, 1 failed" $run one "echo ok - a; echo not ok - b; exit 1" two "echo ok - c"
expect "a failure, and exit status 0" 1 "0 passed, 2 failed" $run one "echo not ok - b"
expect "an exit status, and no failure" 1 "1 passed, 1 failed" $run one "echo ok - a; exit 3"
expect "a crash" 1 "1 passed, 1 failed" $run one "echo ok - a; kill -9 \$\$"
expect "no test" 1 "0 passed, 1 failed" $run one true
expect "nothing to run" 1 "0 passed, 1 failed" $run
expect "one that is blocked" 1 "1 passed, 1 failed" env LIMIT_WALL=1 $run one "echo ok - a; sleep 9"
grep -q 'did not end; its last lines' "$scratch/said"
verdict $? "which is told" "$scratch/said"
endless="while :; do :; done"
expect "one that does not end" 1 "1 passed, 1 failed" env TEST_SECONDS=1 $run one "echo ok - a; $endless"
grep -q 'used more than 1 s of processor' "$scratch/said"
verdict $? "which is told" "$scratch/said"
expect "a process of one that does not end" 1 "1 passed, 1 failed" env TEST_SECONDS=1 $run one "echo ok - a; sh -c '$endless'"
expect "one that waits longer than it may work" 0 "1 passed, 0 failed" env TEST_SECONDS=1 $run one "sleep 2; echo ok - a"
expect "skipped ones are neither" 0 "2 passed, 0 failed" $run one "echo '3 Tests 0 Failures 1 Ignored'"
TEST_BEGINS=1 $run one "echo ok - a" >"$scratch/said"
grep -q '^  RUN   one$' "$scratch/said" && grep -Eq '^  PASS  one .* [0-9]+ s +[0-9]+ s of processor$' "$scratch/said"
verdict $? "one that begins, and the seconds that it took" "$scratch/said"

# --- each.sh -----------------------------------------------------------------------------------------------
cat >"$scratch/suites" <<'END'
#!/bin/sh
[ $# -eq 1 ] || exit 9
case $1 in
fails) echo "2 Tests 1 Failures 0 Ignored"; exit 1 ;;
crashes) kill -9 $$ ;;
*) echo "3 Tests 0 Failures 0 Ignored" ;;
esac
END
chmod +x "$scratch/suites"
each="sh tests/each.sh $scratch/suites"
expect "suites by themselves" 0 "6 passed, 0 failed" $run one "$each good better"
expect "others go on behind one that fails" 1 "7 passed, 1 failed" $run one "$each good fails better"
expect "and behind one that crashes" 1 "6 passed, 1 failed" $run one "$each crashes good better"
grep -q 'not ok - crashes: its program ended with status 137' "$scratch/said"
verdict $? "which is named" "$scratch/said"
expect "no suite" 1 "0 passed, 1 failed" $run one "$each"

# --- hashes.sh ---------------------------------------------------------------------------------------------
hashes="sh tests/hashes.sh $scratch/hashes"
two="echo scene a hash 1; echo scene b hash 2"
back="echo scene b hash 2; echo other; echo scene a hash 1"
none="0 of 0 runs of the scenes differ or failed"
expect "the same bits, in any order" 0 "2 runs of the scenes: the same bits in all" $hashes x "$two" y "$back"
expect "other bits" 1 "1 of 2 runs of the scenes differ or failed" $hashes x "$two" y "echo scene a hash 1; echo scene b hash 3"
expect "a scene is missing" 1 "1 of 2 runs of the scenes differ or failed" $hashes x "$two" y "echo scene a hash 1"
expect "a scene too many" 1 "1 of 2 runs of the scenes differ or failed" $hashes x "echo scene a hash 1" y "$two"
expect "a scene that has no room" 0 "2 runs of the scenes: the same bits in all" \
    $hashes x "$two" y "echo scene a hash 1; echo without b"
expect "no scene" 1 "1 of 2 runs of the scenes differ or failed" $hashes x "$two" y true
expect "a program that fails behind its lines" 1 "1 of 2 runs of the scenes differ or failed" $hashes x "$two" y "$two; exit 2"
expect "one that is blocked" 1 "1 of 2 runs of the scenes differ or failed" env LIMIT_WALL=1 $hashes x "$two" y "$two; sleep 9"
expect "one that does not end" 1 "1 of 2 runs of the scenes differ or failed" env HASH_SECONDS=1 $hashes x "$two" y "$two; $endless"
expect "one that waits longer than it may work" 0 "2 runs of the scenes: the same bits in all" \
    env HASH_SECONDS=1 $hashes x "$two" y "sleep 2; $two"
expect "the first of all fails" 1 "1 of 1 runs of the scenes differ or failed" $hashes x "exit 1"
expect "nothing is compared" 1 "$none" $hashes
expect "others, with a first of their own" 0 "4 runs of the scenes: the same bits in all" \
    $hashes x "$two" y "$two" -- "Fewer steps:" v "echo scene a hash 5" w "echo scene a hash 5"
grep -q '^Fewer steps:$' "$scratch/said"
verdict $? "under their title" "$scratch/said"
expect "they go on behind what differs" 1 "2 of 4 runs of the scenes differ or failed" \
    $hashes x "$two" y true -- "Fewer steps:" v "echo scene a hash 5" w "echo scene a hash 6"

# --- part.sh -----------------------------------------------------------------------------------------------
(cd tests/host && printf '%s\n' *) >"$scratch/list"
sed -n 's/^test_\(.*\)\.c$/\1/p' "$scratch/list" | sort >"$scratch/all"
wrong=0
for of in 1 2 3 4 7; do
    for part in $(seq 0 $((of - 1))); do
        sh tests/part.sh "$scratch/list" "$part" $of
    done | sort | cmp -s - "$scratch/all" || wrong=$((wrong + 1))
done
[ $wrong -eq 0 ] && [ -s "$scratch/all" ]
verdict $? "all parts together are all suites, once each" "$scratch/all"
exit $failed
