#!/bin/sh
# guard.sh BOARD: on BOARD, a store into the strip of memory below the stack must fault, at the strip's top and bottom. So
# must a stack that grows into the strip. The board must name the fault. The images in build/BOARD are from
# tests/boards/guard_*.c.
set -u

board=$1
emulate=$(MAKEFLAGS="" make -s BOARD="$board" emulate-command) || exit 1
failed=0
said=$(mktemp)
trap 'rm -f "$said"' EXIT

for case in top bottom overflow; do
    sh -c "$(echo "$emulate" | sed "s:IMAGE:build/$board/guard_$case.elf:")" >"$said" 2>&1
    status=$?
    why=""
    [ "$status" -eq 70 ] || why="exit status $status, not 70"
    grep -q "the stack's last word holds" "$said" || why="the word above the strip cannot be written"
    grep -q "went on" "$said" && why="nothing faulted"
    grep -q "^fault: " "$said" || why="no fault is named"
    if [ "$case" = overflow ]; then
        grep -q "stack overflow" "$said" || why="it is not called a stack overflow"
    fi
    if [ -z "$why" ]; then
        echo "ok - $board, $case: $(tr -d '\r' <"$said" | grep '^fault: ')"
    else
        echo "not ok - $board, $case: $why"
        sed 's/^/    /' "$said"
        failed=1
    fi
done
exit $failed
