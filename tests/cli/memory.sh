#!/bin/sh
# memory.sh: every command ends in the same way when memory runs out. Under any limit a command does its work or prints
# "whirl: out of memory" last and returns 1. It does not crash and leaves no partial result that looks whole.
. "$(dirname "$0")/../checks.sh"

# A sanitizer's build needs more address space than any limit allows.
if ! (ulimit -v 200000 && "$whirl" --version) >/dev/null 2>&1; then
    echo "ok - this build runs under no limit of memory # SKIP"
    exit 0
fi

# A text that is long enough to need many blocks.
{
    echo "mechanism many"
    i=1
    while [ "$i" -le 400 ]; do
        echo "parameter p$i = $i [kg]"
        i=$((i + 1))
    done
    echo "coordinate x [m]"
    printf 'let m = p1'
    i=2
    while [ "$i" -le 400 ]; do
        printf ' + p%d' "$i"
        i=$((i + 1))
    done
    printf '\nT = m*x'"'"'^2/2\nV = p1*9.81 [m/s^2]*x\n'
} >"$scratch/many.whirl"

# The smallest limit, in steps of 64 kB, under which the program starts at all.
least=0
limit=1024
while [ "$limit" -le 200000 ]; do
    if (ulimit -v "$limit" && "$whirl" --version) >/dev/null 2>&1; then
        least=$limit
        break
    fi
    limit=$((limit + 64))
done 2>/dev/null # the kernel ends a program that it cannot load

# short WHAT WORDS...: runs `whirl WORDS` with limits that rise in quarters of the memory that it needs after its
# start.
short() {
    what=$1
    shift
    "$whirl" "$@" >"$scratch/whole" 2>/dev/null </dev/null
    status=$?
    beyond=16
    told=0
    bad=0
    while :; do
        (ulimit -v $((least + beyond)) && exec "$whirl" "$@") >"$scratch/out" 2>"$scratch/err" </dev/null
        now=$?
        if [ "$now" -eq "$status" ] && cmp -s "$scratch/whole" "$scratch/out"; then
            break
        elif [ "$now" -eq 1 ] && tail -n 1 "$scratch/err" | grep -q '^whirl: out of memory$'; then
            told=$((told + 1))
        else
            echo "limit $((least + beyond)): status $now" >>"$scratch/err"
            bad=1
            break
        fi
        beyond=$((beyond + beyond / 8 + 4))
    done
    [ "$bad" -eq 0 ] && [ "$told" -gt 0 ]
    verdict $? "$what: refused under $told limits, whole from the next on"
}

short "run of a long text" run "$scratch/many.whirl" --until 0.01s
short "a run with its books" run carriage_stop --with ledger --until 0.05s
short "derive as text" derive thomson --as text
short "derive as C" derive thomson_magnet --as c
short "accelerations" accel thomson
short "the list of scenes" list
exit $failed
