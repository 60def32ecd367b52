#!/bin/sh
# count_host.sh: instructions a step of every scene on this machine, under valgrind's callgrind.
#
#   CC=gcc FLAGS="-O2" count_host.sh bench figures.csv
#
# bench is boards/programs/bench.c with boards/host, built in float or in double, or a program of
# tests/tools with a naive_step(). Appends rows to figures.csv (with a header if it is new) and prints
# them as a table.
#
# Only wh_scene_step(), bench_pair(), bench_one(), bench_two() and naive_step() are collected; a part is dumped and cleared at
# either end of each interval, so every second part is one interval.
set -eu
. "$(dirname "$0")/common.sh"

bench=$1
csv=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

status=0
valgrind --tool=callgrind --callgrind-out-file="$work/parts" --combine-dumps=yes \
    --toggle-collect=wh_scene_step --toggle-collect=wh_scene_step_d --toggle-collect=bench_pair \
    --toggle-collect=bench_one --toggle-collect=bench_two --toggle-collect=naive_step \
    --dump-before=wh_count_begin --dump-after=wh_count_end \
    "$bench" >"$work/console" 2>"$work/log" || status=$?
if ! grep -q '^count ' "$work/console"; then
    cat "$work/console" "$work/log" >&2
    exit 1
fi

awk '
    /^part: / { part = $2 }
    /^(summary|totals): / { total[part] = $2 }
    END {
        for (i = 2; i in total; i += 2) {
            print "interval", i / 2 - 1, total[i]
        }
    }' "$work/parts" >"$work/counts"

awk -v commit="$(commit_of_checkout)" -v board=host -v compiler="$(compiler_of "$CC")" \
    -v flags="$FLAGS" -f "$(dirname "$0")/figures.awk" "$work/console" "$work/counts" >"$work/rows"
[ -s "$csv" ] || echo "$CSV_HEADER" >"$csv"
cat "$work/rows" >>"$csv"
table <"$work/rows"
exit "$status"
