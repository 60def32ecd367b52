#!/bin/sh
# drift.sh WHIRL SCENE COLUMN: prints the largest distance of COLUMN, which should be constant, from its start, for
# steps of 0.03125 to 4 ms. The motion is sampled every millisecond or every step, whichever is longer. Prints
# `step_ms,drift` in SI.
set -eu
whirl=$1 scene=$2 column=$3
echo step_ms,drift
for step_ms in 0.03125 0.0625 0.125 0.25 0.5 1 2 4; do
    case $step_ms in
        0.*) every=1ms ;;
        *) every=${step_ms}ms ;;
    esac
    "$whirl" run "$scene" --step "${step_ms}ms" --every "$every" --quiet --columns - |
        awk -v name="$column" -v step="$step_ms" '
        NR == 1 { for (i = 2; i <= NF; i++) if ($i == name) c = i - 1; next }
        /^%/ { next }
        !seen++ { start = $c }
        { d = $c - start; if (d < 0) d = -d; if (d > worst) worst = d }
        END { printf "%s,%.6g\n", step, worst }'
done
