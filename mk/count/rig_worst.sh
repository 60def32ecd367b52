#!/bin/sh
# rig_worst.sh: the longest control steps of a campaign of faults, counted once more from outside.
#
#   NM=... PLUGIN=count.so rig_worst.sh whirl pil_dialled.elf faults.md
#
# faults.md is what `make faults BOARD=...` has printed: the longest control steps by the guest's own timer, each with the words
# that repeat its run. Here each run is repeated under the counting plugin, an emulator of the same name in front of the
# path, and its longest step stands beside the timer's. The plugin counts the calls that mark a step as well, which the timer
# takes off: a few instructions, the same for every step. Fails where they are not, within 2 (a count of the timer is 0.6 of
# one), or are more than 20.
set -eu
. "$(dirname "$0")/common.sh"

whirl=$1 elf=$2 said=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

emulator=$(command -v qemu-system-arm)
begin=$(address_of hal_frames_step_begins)
end=$(address_of hal_frames_step_ends)
cat >"$work/qemu-system-arm" <<EOF
#!/bin/sh
exec $emulator "\$@" -plugin $PWD/$PLUGIN,begin=$begin,end=$end -d plugin -D $work/counts.\$\$
EOF
chmod +x "$work/qemu-system-arm"

# lines "RUN INSTRUCTIONS COMMAND..."
awk '/^    # run [0-9]+: step of / { run = $3 + 0; steps = $6; getline; sub(/^ */, ""); print run, steps, $0 }' "$said" >"$work/runs"
if [ ! -s "$work/runs" ]; then
    echo "rig_worst.sh: $said tells no control steps: make faults BOARD=... first" >&2
    exit 1
fi
printf '%6s  %10s  %10s\n' run timer plugin
while read -r run steps _ words; do
    rm -f "$work"/counts.*
    # shellcheck disable=SC2086 # words
    PATH="$work:$PATH" "$whirl" $words </dev/null >"$work/out" 2>&1 || true # a run that trips ends with 1
    for log in "$work"/counts.*; do # one a program: a reset starts another
        awk '$1 == "interval" && $3 > most { most = $3 } END { print most + 0 }' "$log"
    done | sort -n | awk -v run="$run" -v steps="$steps" 'END { printf "%6d  %10d  %10d\n", run, steps, $1 }'
done <"$work/runs" | tee "$work/table"
awk '{ d = $3 - $2; if (!n++ || d < least) least = d; if (n == 1 || d > most) most = d }
    END { exit !(n && least >= 0 && most <= 20 && most - least <= 2) }' "$work/table" || {
    echo "rig_worst.sh: timer and plugin differ" >&2
    exit 1
}
