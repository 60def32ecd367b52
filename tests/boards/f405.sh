#!/bin/sh
# f405.sh [TIMES_FAULTS TIMES_RESETS SEED]: tests the flashed image of an STM32F405 in QEMU's netduinoplus2: boot, console,
# time base, faults and resets of the rig in every state (tests/tools/f405.c). Images are in
# build/netduinoplus2.
set -u

images=build/netduinoplus2
f405=build/tools/f405
seed=${3:-1}
failed=0
for test in boot console time; do
    $f405 $test $images/station.elf || failed=1
done
$f405 faults $images/bench_plant.elf "${1:-12}" "$seed" || failed=1
$f405 resets $images/bench_plant.elf "${2:-20}" "$seed" || failed=1
exit $failed
