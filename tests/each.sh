#!/bin/sh
# each.sh PROGRAM SUITE...: runs each suite of a test program in a process of its own, so that a crash ends no other suite,
# and the processes that a suite starts copy little memory.
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
