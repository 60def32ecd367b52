#!/bin/sh
# prove.sh: `whirl prove`: what it says of a run, and what it refuses. Whether it is true is asked by
# build/tests/host enclosure prove.
. "$(dirname "$0")/../checks.sh"

# proved PATTERN WORD...: status 0, and these words on standard output
proved() {
    pattern=$1
    shift
    "$whirl" prove "$@" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 0 ] && grep -qE -- "$pattern" "$scratch/out" && [ ! -s "$scratch/err" ]
    verdict $? "whirl prove $*: $pattern" "$scratch/out"
}
# refused PATTERN WORD...: status 2, these words on standard error, nothing on standard output
refused() {
    pattern=$1
    shift
    "$whirl" prove "$@" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 2 ] && grep -q -- "$pattern" "$scratch/err" && [ ! -s "$scratch/out" ]
    verdict $? "whirl prove $*: $pattern" "$scratch/err"
}

proved '^proved to the end, t = 1 s$' epicyclic_from_rest --until 1s
proved '^  X  *to the end  *within 1.00e-03 m: off by at most' epicyclic_from_rest --until 1s --number float --within X=1mm
proved '^proved to the end, t = 1 s$' epicyclic_conserved --until 1s --number float
proved '^proved to the end, t = 5 s$' tests/mechanisms/lorenz.whirl --start x=1 --step 2ms --until 5s
# a step that is too coarse is off, and that is proved, too
proved 'behind it off by more: proved$' epicyclic_from_rest --until 3s --method semi-implicit-euler --step 10ms --tolerance 1e-4

refused 'the stop changes the equations' carriage_stop
refused 'the hold changes the equations' thomson_magnet
refused 'abs of what moves cannot be enclosed' epicyclic_from_rest --with air_drag
refused 'a number above zero is wanted' epicyclic_from_rest --within X=-1mm
refused "'Y' is unknown" epicyclic_from_rest --within Y=1mm
refused "'X' is given twice" epicyclic_from_rest --within X=1mm --within X=2mm
refused "there is no number 'fixed'" epicyclic_from_rest --number fixed
refused '--tolerance takes a number' epicyclic_from_rest --tolerance 2
exit $failed
