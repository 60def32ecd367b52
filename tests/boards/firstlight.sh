#!/bin/sh
# firstlight.sh BOARD: checks the record of first light that BOARD's image prints in the emulator. It is whole and has the
# interpreter's hashes. Fields that the emulator cannot give are `none` and named, and only a missing rig causes other
# differences. Also checks that the image cannot enable the motor.
set -u

board=$1
whirl=${WHIRL:-build/whirl}
said=$(mktemp)
trap 'rm -f "$said"' EXIT
failed=0
verdict() {
    if [ "$1" -eq 0 ]; then echo "ok - $board, $2"; else
        echo "not ok - $board, $2"
        sed 's/^/    /' "$said"
        failed=1
    fi
}

emulate=$(MAKEFLAGS="" make -s BOARD="$board" emulate-command) || exit 1
elf=build/$board/firstlight.elf
sh mk/demo/firstlight.sh "build/$board/firstlight.txt" "$(echo "$emulate" | sed "s:IMAGE:$elf:")" >"$said" 2>&1
verdict $? "first light: a record"
cycles=$(sed -n 's/^    X(\([a-z_]*\)).*/cycles.\1,/p' core/light_fields.h | tr '\n' ' ')
none="none: ${cycles}clock, period_us, period_cycles, load, supply"
case $board in
mps2-* | rv32*)
    wanted=0
    none="$none, stop, slots, selftest"
    differs=-
    ;;
*) # boards of the rig: the emulator has no converter, no crystal and no stop line
    wanted=1
    none="none: chip, ${cycles}clock, period_us, period_cycles, load, supply"
    differs="stop, selftest"
    ;;
esac
case $board in rv32*) none="none: chip, ${none#none: }" ;; esac
"$whirl" firstlight "build/$board/firstlight.txt" --board "$board" >"$said" 2>&1
[ $? -eq $wanted ] && grep -qx 'hashes: 5 of 5 equal' "$said"
verdict $? "first light: all hashes are the interpreter's"
grep -qx "$none" "$said" && grep -qx "differs: $differs" "$said" && grep -q '^row: not added, ' "$said"
verdict $? "first light: what the emulator cannot give is named"
"$whirl" firstlight "build/$board/firstlight.txt" --emulated "build/$board/firstlight.txt" >"$said" 2>&1
[ $? -eq $wanted ] && grep -q '^stack  *- ' "$said" && grep -q "^compiler  *equal" "$said"
verdict $? "first light: beside the emulator's record"
# on a serial line, Enter requests the record
if [ "$board" = netduinoplus2 ]; then
    null="-serial null"
    qemu-system-arm -M netduinoplus2 -display none -monitor none $null $null $null $null $null -serial pty \
        -kernel "$elf" >"$said" 2>&1 &
    emulator=$!
    until grep -q /dev/pts "$said" || ! kill -0 $emulator; do sleep 0.1; done
    "$whirl" firstlight "$(sed -n 's|.* \(/dev/pts/[0-9]*\) .*|\1|p' "$said")" --wait 100 --keep "$said.kept" >"$said" 2>&1
    [ $? -eq 1 ] && grep -qx 'hashes: 5 of 5 equal' "$said" && "$whirl" firstlight "$said.kept" | cmp -s - "$said"
    verdict $? "first light over a serial line"
    kill $emulator
    rm -f "$said.kept"
fi
# an image that can enable the motor must be found
elf=build/$board/firmware.elf
if [ "$board" = mps2-an386 ] && [ -e "$elf" ]; then
    UNDRIVEN=$elf sh boards/check_image.sh "$elf" >"$said" 2>&1
    [ $? -ne 0 ] && grep -q ': it can drive the motor: hal_motor_start' "$said"
    verdict $? "an image that can drive the motor is refused where it must not"
fi
exit $failed
