#!/bin/sh
# worst.sh: compares the declared largest number of instructions of a step with events with the longest of random steps.
#
#   BOARD=... CC=... NM=... OBJCOPY=... FLAGS=... PLUGIN=count.so EMULATE="qemu-system-arm ... -kernel worst.elf" \
#   worst.sh worst.elf figures.csv STEPS
#
# worst.elf makes STEPS random steps of each scene with each of two seeds. It prints how often a step of each scene may
# evaluate the accelerations and the signals (worst.c). The code between two evaluations is short, so its longest path is
# found soon. From the longest stretches of the first seed, to the first evaluation (B), after an evaluation of the
# accelerations (A) and after one of the signals (S), the script computes
#
#   declared instructions = B + evaluations A + signals S
#
# and compares the steps of the second seed with this number. Prints a table, appends rows to figures.csv, and fails if a
# step exceeded a declared number.
set -eu
. "$(dirname "$0")/common.sh"

elf=$1 csv=$2 steps=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Pairs of words: an address, whose lowest bit the linker may have set for Thumb code, and a kind.
"$OBJCOPY" --dump-section .wh_marks="$work/section" "$elf" "$work/copy"
od -A n -v -t u4 -w8 "$work/section" | awk '{ print $1 - $1 % 2, $2 }' >"$work/marks"
if [ ! -s "$work/marks" ]; then
    echo "worst.sh: $elf has no marks" >&2
    exit 1
fi
count ",every=$steps,marks=$work/marks"

[ -s "$csv" ] || echo "$CSV_HEADER" >"$csv"
awk -v commit="$(commit_of_checkout)" -v board="$BOARD" -v compiler="$(compiler_of "$CC")" -v flags="$FLAGS" \
    -v csv="$csv" -v steps="$steps" '
    function row(scene, metric, value) {
        printf "%s,%s,%s,\"%s\",%s,%s,%s,%s,%s\n", commit, board, compiler, flags, scene, number[scene],
            method[scene], metric, value >>csv
    }
    function check(scene, what, measured, bound) {
        checked++
        if (measured > bound + 0) {
            print "worst.sh: " scene ": " measured " " what ", above " bound >"/dev/stderr"
            broken = 1
        }
    }
    { sub(/\r$/, "") }
    $1 == "declared" { evaluations[$2] = $3; signals[$2] = $4 }
    $1 == "interval" { instructions[$2] = $3 }
    $1 == "stretches" { longest[$2, $3] = $4; most[$2, $3] = $5 }
    $1 == "unfinished" { broken = 1 }
    $1 == "count" { method[$2] = $3; number[$2] = $4; group[$2, ++seeds[$2]] = $5; if (seeds[$2] == 1) order[++scenes] = $2 }
    END {
        printf "Most of %d random steps, all effects on (executed instructions, not cycles):\n", steps
        printf "%-24s %16s   %16s   %19s\n", "", "accelerations", "signals", "instructions"
        printf "%-24s %9s %6s   %9s %6s   %10s %8s\n", "scene", "declared", "most", "declared", "most",
            "declared", "most"
        for (i = 1; i <= scenes; i++) {
            name = order[i]
            one = group[name, 1]
            two = group[name, 2]
            e = evaluations[name]
            if (e == "" || two == "" || most[two, 1] == "") {
                print "worst.sh: " name ": a figure is missing" >"/dev/stderr"
                broken = 1
                continue
            }
            bound = longest[one, 0] + e * longest[one, 1] + signals[name] * longest[one, 2]
            printf "%-24s %9d %6d   %9d %6d   %10d %8d\n", name, e, most[two, 1], signals[name], most[two, 2],
                bound, instructions[two]
            check(name, "evaluations of the accelerations", most[two, 1], e)
            check(name, "evaluations of the signals", most[two, 2], signals[name])
            check(name, "instructions", instructions[two], bound)
            row(name, "instructions per step (declared)", bound)
            row(name, "instructions per step (maximum)", instructions[two])
        }
        exit broken || checked == 0
    }' "$work/counts" "$work/console" || status=1
exit "$status"
