#!/bin/sh
# worst_step_marks.sh: `make worst-step` finds what it counts: every scene with contacts, with all effects, the largest
# number of evaluations in a step, and the marks in the code.
. "$(dirname "$0")/../checks.sh"

mk/count/all_effects.sh "$whirl" "$scratch/all" core/models/*.whirl >"$scratch/out" 2>"$scratch/err" &&
    [ "$(grep -c '_EVALUATIONS, ' "$scratch/all/scenes.c")" -ge 20 ]
verdict $? "every scene with contacts, all effects on"
(cd "$scratch/all" && "${CC:-gcc}" -std=c11 -I"$OLDPWD" -c scenes.c -o scenes.o) 2>"$scratch/err"
verdict $? "a table of them, with what a step of each may evaluate"

# An AVR or Arm assembler accepts the marks; the counter uses the Arm one.
if command -v arm-none-eabi-gcc >/dev/null 2>&1; then
    for scene in carriage_stop ${WHIRL_FULL:+ball_bounces}; do
        arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -std=c11 -I. -include boards/programs/mark.h -c "$scratch/all/$scene.c" \
            -o "$scratch/marked.o" 2>"$scratch/err" &&
            arm-none-eabi-objcopy -O binary --set-section-flags .wh_marks=alloc -j .wh_marks "$scratch/marked.o" \
                "$scratch/marks" 2>>"$scratch/err" &&
            [ "$(od -A n -v -t u4 -w8 "$scratch/marks" | awk '{ print $2 }' | sort -u | tr '\n' ' ')" = "1 2 " ]
        verdict $? "$scene: accelerations and signals are marked"
        arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -std=c11 -I. -c "$scratch/all/$scene.c" -o "$scratch/plain.o" 2>"$scratch/err" &&
            ! arm-none-eabi-objdump -h "$scratch/plain.o" | grep -q wh_marks
        verdict $? "$scene: and not unless they are asked for"
    done
fi
exit $failed
