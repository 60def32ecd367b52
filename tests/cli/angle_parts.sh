#!/bin/sh
# angle_parts.sh: outputs with fractions and multiples of turn angles, as C for the core, give the numbers that `whirl run`
# records, to the last digit, in float and double. The suite angle_parts checks that these are right; its random mechanisms
# are compiled here (WHIRL_RANDOM_OUTPUTS=2000 of them; half a minute).
. "$(dirname "$0")/../checks.sh"

warnings="-std=c11 -O0 -ffp-contract=off -I. -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Werror"

WHIRL_OUTPUTS_TO=$scratch WHIRL_RANDOM_OUTPUTS=${WHIRL_RANDOM_OUTPUTS:-200} \
    "$(dirname "$whirl")/tests/host" angle_parts >"$scratch/err"
verdict $? "the suite angle_parts makes mechanisms"

number=0
for file in "$scratch"/parts_*.whirl; do
    number=$((number + 1))
    "$whirl" derive "$file" --as c >"$scratch/emitted" 2>"$scratch/err" || verdict 1 "derive $file"
    { echo "#define parts_turn scene_$number"; cat "$scratch/emitted"; } >"$scratch/scene_$number.c"
    for real in float double; do # the outputs follow the time, five coordinates and their rates
        "$whirl" run "$file:parts_turn" --number $real --quiet --csv - 2>"$scratch/err" | tail -n 1 |
            tr -d '\r' | cut -d, -f12- >>"$scratch/recorded_$real"
    done
done
if grep -q 'wh_sincos(,' "$scratch"/scene_*.c; then
    verdict 1 "no phase is empty"
fi
{
    echo '#include <stdio.h>'
    echo '#include "core/scene.h"'
    for i in $(seq $number); do echo "extern const wh_scene scene_$i;"; done
    echo 'static const wh_scene *const all[] = {'
    for i in $(seq $number); do echo "    &scene_$i,"; done
    cat <<'END'
};
static uint64_t memory[WH_STATE_WORDS(8, 16, 1)];
int main(void) {
    for (unsigned i = 0; i < sizeof all / sizeof all[0]; i++) {
        wh_state state;
        wh_real output[64];
        wh_status status = wh_scene_start(all[i], &state, memory, sizeof memory);
        while (status == WH_OK && state.steps < all[i]->steps) {
            status = wh_scene_step(all[i], &state);
        }
        if (status != WH_OK || all[i]->outputs > 64) {
            return 1;
        }
        all[i]->observe(all[i], &state, output);
        for (unsigned k = 0; k < 25 && k < all[i]->outputs; k++) { /* then X, where it is recovered */
            printf(WH_DOUBLE ? "%s%.17g" : "%s%.9g", k > 0 ? "," : "", (double)output[k]);
        }
        printf("\n");
    }
    return 0;
}
END
} >"$scratch/main.c"

for real in float double; do
    is_double=$([ $real = float ]; echo $?)
    ${CC:-gcc} $warnings -DWH_DOUBLE="$is_double" -o "$scratch/$real" "$scratch"/scene_*.c \
        "$scratch/main.c" core/*.c >"$scratch/err" 2>&1
    verdict $? "$number mechanisms compile in $real without a warning"
    "$scratch/$real" >"$scratch/computed_$real"
    cmp "$scratch/computed_$real" "$scratch/recorded_$real" >"$scratch/err" 2>&1
    verdict $? "$(tr ',' '\n' <"$scratch/recorded_$real" | wc -l) outputs in $real are what run records" "$scratch/err"
done
[ $number -ge 8 ]
verdict $? "$number mechanisms"
exit $failed
