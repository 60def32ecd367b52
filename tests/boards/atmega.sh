#!/bin/sh
# atmega.sh [RPM FAULTS RESETS SEED]: what is flashed onto an ATmega2560, in simavr with the rig round its pins (tests/tools/atmega.c):
# console, a run to its result with each control step's cycles, slot edges, a storm of them, faults and resets in every state,
# settings torn. "more" in the place of RPM: runs at four speeds, and while it is asked all the time. Images are those of
# build/atmega2560. Prints "ok - ..." and "not ok - ..." lines.
set -u

image=build/atmega2560/station.elf
atmega=build/tools/atmega
seed=${4:-1}
failed=0
$atmega boot $image || failed=1
$atmega orders $image 200 "$seed" || failed=1
case ${1:-330} in
more)
    for rpm in 170 230 330 360; do
        $atmega run $image $rpm || failed=1
    done
    $atmega busy $image 330 || failed=1
    ;;
*) $atmega run $image "${1:-330}" || failed=1 ;;
esac
$atmega slots $image 100 "$seed" || failed=1
$atmega storm $image 5000 "$seed" || failed=1
$atmega faults $image "${2:-12}" "$seed" || failed=1
$atmega resets $image "${3:-24}" "$seed" || failed=1
$atmega supply $image 4 "$seed" || failed=1
$atmega settings $image || failed=1
exit $failed
