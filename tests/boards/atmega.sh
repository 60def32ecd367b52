#!/bin/sh
# atmega.sh [RPM FAULTS RESETS SEED]: tests the flashed image of an ATmega2560 in simavr, with the rig at its pins
# (tests/tools/atmega.c): console, a run with the cycles of each control step, slot edges, a storm of edges, faults and
# resets in every state, torn settings. "more" in place of RPM: runs at four speeds, with continuous queries. Images are in
# build/atmega2560.
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
