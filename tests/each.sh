#!/bin/sh
# each.sh PROGRAM SUITE...: run each suite of a test program in a process of its own. Suites start processes themselves, and what
# others have left in memory makes that dear: more than half of the time, where the memory is guarded. And one that crashes
# takes no others with it.
set -u

program=${1:?usage: each.sh PROGRAM SUITE...}
shift
bad=0
for suite; do
    "$program" "$suite"
    status=$?
    [ $status -eq 0 ] && continue
    bad=1
    [ $status -eq 1 ] || echo "not ok - $suite: its program ended with status $status"
done
exit $bad
