#!/bin/sh
# count_callgrind.sh PROGRAM FOLDER: the intervals of a program of boards/programs on this machine, as the plugin says them:
# FOLDER/counts and FOLDER/console. Of a step, wh_scene_step() alone is collected (mk/count/count_host.sh).
set -eu
status=0
valgrind --tool=callgrind --callgrind-out-file="$2/parts" --combine-dumps=yes \
    --toggle-collect=wh_scene_step --toggle-collect=wh_scene_step_d --toggle-collect=bench_pair \
    --toggle-collect=bench_one --toggle-collect=bench_two --dump-before=wh_count_begin --dump-after=wh_count_end \
    "$1" >"$2/console" 2>"$2/log" || status=$?
if ! grep -q '^count ' "$2/console"; then
    cat "$2/console" "$2/log" >&2
    exit 1
fi
awk '/^part: / { part = $2 } /^(summary|totals): / { total[part] = $2 }
    END { for (i = 2; i in total; i += 2) { print "interval", i / 2 - 1, total[i] } }' "$2/parts" >"$2/counts"
rm -f "$2/parts"
