#!/bin/sh
# rig_steps.sh: counts the instructions of the rig's control steps on an emulated board.
#
#   BOARD=... CC=... NM=... PLUGIN=count.so EMULATE="qemu-system-arm ... -kernel rig_steps.elf" \
#   rig_steps.sh rig_steps.elf MOST
#
# For each run of rig_steps.c, prints the number of steps, and the median, the 99th percentile and the largest number of
# instructions of a step. Fails if a step takes more than MOST. These are instructions, not cycles. With TIMING=CORE
# (m0, m3, m4), also prints the largest number of cycles, as estimated for that core.
set -eu
. "$(dirname "$0")/common.sh"

elf=$1 most=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count ""
sed 's/\r$//' "$work/console" >"$work/said"
printf '%-24s %7s %7s %7s %7s %9s   %s\n' "$BOARD" steps median "99 %" most "${TIMING:+cycles, ~}" "turns measured"
grep '^run ' "$work/said" | while read -r _ name first last turns quality; do
    cycles=$(awk -v first="$first" -v last="$last" '
        $1 == "cycles" && $2 >= first && $2 <= last && $3 > most { most = $3 }
        END { print most }' "$work/counts")
    awk -v first="$first" -v last="$last" '$1 == "interval" && $2 >= first && $2 <= last { print $3 }' "$work/counts" |
        sort -n | awk -v name="$name" -v turns="$turns" -v quality="$quality" -v cycles="$cycles" '
        { of[NR] = $1 }
        END {
            printf "%-24s %7d %7d %7d %7d %9s   %d, %s\n", name, NR, of[int((NR + 1) / 2)], of[int(NR * 0.99 + 0.5)],
                of[NR], cycles, turns, quality
        }'
done
worst=$(awk '$1 == "interval" && $3 > most { most = $3 } END { print most + 0 }' "$work/counts")
if [ "$worst" -eq 0 ] || [ "$worst" -gt "$most" ]; then
    echo "rig_steps.sh: a control step takes $worst instructions, more than $most" >&2
    status=1
fi
exit "$status"
