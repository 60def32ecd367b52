#!/bin/sh
# pil.sh: the rig's control software in an emulator, with a plant that differs from the model in the firmware (`make pil`).
#
#     sh mk/demo/pil.sh WHIRL BOARD...
#
# Runs it on the first board, keeps a tape, and replays the tape on this PC and on all boards that are named. Exit status 0
# if the run was done and all answers were the same.
set -eu

whirl=$1
shift
build=$(dirname "$whirl")
out=build/pil
mkdir -p "$out"
failed=0

echo "=== The rig's control software on $1, the coupled mechanism with dry friction on this PC"
echo
"$whirl" pil docs/plants/rig.whirl --firmware "$build/$1/pil_rig.elf" --board "$1" \
    --tape "$out/rig.tape" || failed=1
echo
echo "=== Its tape, $(wc -c <"$out/rig.tape") bytes, on this PC and on $*"
"$whirl" pil --replay "$out/rig.tape" --firmware "$build/pil_rig" >"$out/replay.txt" || failed=1
for board in "$@"; do
    "$whirl" pil --replay "$out/rig.tape" --firmware "$build/$board/pil_rig.elf" --board "$board" >>"$out/replay.txt" || failed=1
done
grep -aE '^(firmware|exchanges|command stream) ' "$out/replay.txt"
echo
echo "=== Another plant: a rod upright on a cart"
echo
"$whirl" pil docs/plants/cart.whirl --firmware "$build/$1/pil_cart.elf" --board "$1" || failed=1
exit $failed
