#!/bin/sh
# single_rows.sh ELF...: cycles and instructions a step of the scene of each image, on a board that has one image a scene and an
# emulator that counts both (simavr), as a table.
#
#   BOARD=atmega328p CC=avr-gcc EMULATE="build/avr_run mcu=atmega328p hz=16000000 IMAGE" single_rows.sh bench_SCENE.elf
set -eu
. "$(dirname "$0")/common.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
image=$EMULATE
for elf in "$@"; do
    EMULATE=$(echo "$image" | sed "s:IMAGE:$elf:")
    sh -c "$EMULATE counts=$work/counts" >"$work/console"
    awk -v commit="$(commit_of_checkout)" -v board="$BOARD" -v compiler="$(compiler_of "$CC")" -v flags="" \
        -v obtained=simulated -f "$(dirname "$0")/figures.awk" "$work/console" "$work/counts" >>"$work/rows"
done
table <"$work/rows"
