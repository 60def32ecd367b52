#!/bin/sh
# limit.sh SECONDS COMMAND...: a limit of processor time, which other work on the machine does not use up.
#
# A process of COMMAND that uses more than SECONDS of processor time is ended by SIGXCPU (exit status 152). A blocked process uses
# none, so COMMAND as a whole is ended after LIMIT_WALL seconds (exit status 124): 30 minutes, or 20 times SECONDS if that is more.
set -u
seconds=${1:?usage: limit.sh SECONDS COMMAND...}
shift
wall=$((20 * seconds))
[ "$wall" -ge 1800 ] || wall=1800
ulimit -S -t "$seconds"
exec timeout --kill-after=5 "${LIMIT_WALL:-$wall}" "$@"
