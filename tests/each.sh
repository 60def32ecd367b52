#!/bin/sh
# each.sh PROGRAM SUITE...: run each suite of a test program in a process of its own: one that crashes takes no others with it,
# and the processes that it starts have nothing of what others left in memory, a tenth of the time where that is guarded.
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
