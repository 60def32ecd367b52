#!/bin/sh
# count_rows.sh FIGURES.csv ELF...: counts the instructions of a step of each image's scenes. Prints a table, and appends
# rows to FIGURES.csv, with a header if the file is new. An image is boards/programs/bench.c, or a program of tests/tools
# with a naive_step().
#
#   BOARD=mps2-an386 CC=arm-none-eabi-gcc NM=arm-none-eabi-nm FLAGS="-O2" PLUGIN=count.so TIMING=m4 \
#   EMULATE="qemu-system-arm ... -kernel IMAGE" count_rows.sh figures.csv bench.elf
#
# Without PLUGIN the emulator counts (simavr); for BOARD=host callgrind counts. These are instructions, not cycles.
set -eu
. "$(dirname "$0")/common.sh"

csv=$1
shift
status=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for elf in "$@"; do counted "$elf"; done
[ -s "$csv" ] || echo "$CSV_HEADER" >"$csv"
cat "$work/rows" >>"$csv"
table <"$work/rows"
exit "$status"
