#!/bin/sh
# board_rows.sh FIGURES.csv FOLDER SCENE...: what a step of each SCENE costs on BOARD, and what an image around it takes.
#
# FOLDER holds size_SCENE.elf, the smallest firmware around each (boards/programs/size.c), and bench_SCENE.elf where a board
# has one image a scene; else BENCH is the image of them all. In the environment: BOARD, CC, NM, SIZE, FLAGS, EMULATE (a
# command that runs the image IMAGE), and what counts: PLUGIN and TIMING in QEMU, nothing on simavr.
#
# Appends rows to FIGURES.csv, with a header if it is new:
#     commit,compiler,flags,board,scene,setting,instructions,cycles,cycles_obtained,flash_bytes,ram_bytes,stack_bytes
# Instructions and cycles are the median of a step's; where nobody counts cycles, the field is empty. The stack is that of
# the bench program during the steps, measured; it is not in ram_bytes.
set -eu
. "$(dirname "$0")/common.sh"

csv=$1
folder=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ -n "${BENCH:-}" ]; then
    counted "$BENCH"
else
    for scene in "$@"; do
        counted "$folder/bench_$scene.elf"
    done
fi

[ -s "$csv" ] || echo "commit,compiler,flags,board,scene,setting,instructions,cycles,cycles_obtained,flash_bytes,ram_bytes,stack_bytes" >"$csv"
for scene in "$@"; do
    bytes=$(bytes_of "$SIZE" "$folder/size_$scene.elf" | tr " " ,)
    awk -F, -v scene="$scene" -v bytes="$bytes" '
        $5 == scene && $7 != "record" {
            begin = $1 "," $3 "," $4 "," $2 "," $5 "," $7
            if ($8 ~ /^instructions.*median/) { instructions = $9 }
            if ($8 ~ /cycles.*median/ && obtained != "measured") { cycles = $9; obtained = $8; sub(/ .*/, "", obtained) }
            if ($8 ~ /^stack/) { stack = $9 }
        }
        END {
            if (begin == "") { print "board_rows.sh: nothing was counted of " scene > "/dev/stderr"; exit 1 }
            print begin "," instructions "," cycles "," obtained "," bytes "," stack
        }' "$work/rows" >>"$csv"
done
