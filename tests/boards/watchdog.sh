#!/bin/sh
# watchdog.sh BOARD: tests the watchdog of BOARD, if there is one (tests/boards/watchdog.c, in build/BOARD). If it is kicked
# in time, the watchdog must do nothing. Otherwise it must interrupt, but not before its timeout, and reset within three
# times the timeout, by the board's own clock.
set -u

board=$1
image=build/$board/watchdog.elf
[ -e "$image" ] || exit 0
emulate=$(MAKEFLAGS="" make -s BOARD="$board" emulate-command) || exit 1
said=$(mktemp)
trap 'rm -f "$said"' EXIT
sh -c "$(echo "$emulate" | sed "s:IMAGE:$image:") -icount shift=5" >"$said" 2>&1
status=$?
if tr -d '\r' <"$said" | awk -v status="$status" '
    /^kicked for / && $3 >= 1800000 && $3 < 1810000 { kicked = 1 }
    kicked && /^interrupted after / && $3 >= 50000 && $3 < 50100 { interrupted = 1 }
    interrupted && /^reset after / && $3 >= 50000 && $3 <= 150000 { reset = 1 }
    END { exit !(reset && status == 0) }'; then
    echo "ok - $board, watchdog: $(tr -d '\r' <"$said" | grep ' after ' | paste -sd, -); 50,000 us are allowed without a kick"
else
    echo "not ok - $board, watchdog: exit status $status, and it said"
    sed 's/^/    /' "$said"
    exit 1
fi
