#!/bin/sh
# undefined.sh: generated C of a scene for each kind of contact expression that becomes undefined. It refuses the step as
# the interpreter does, with WH_E_UNDEFINED, the contact's number and the last good state, in float.
. "$(dirname "$0")/../checks.sh"

cat >"$scratch/main.c" <<'END'
#include <stdio.h>

#include "core/scene.h"

extern const wh_scene trial;

static uint64_t memory[512];

int main(void) {
    wh_state state;
    wh_status status = wh_scene_start(&trial, &state, memory, sizeof memory);
    while (status == WH_OK && state.steps < trial.steps) {
        status = wh_scene_step(&trial, &state);
    }
    const uint64_t hash = wh_scene_hash(&trial, &state);
    const wh_status again = wh_scene_step(&trial, &state);
    printf("%d %d %d %d 0x%016llx\n", status == WH_E_UNDEFINED, state.fault,
           again == status && hash == wh_scene_hash(&trial, &state), wh_status_text(status)[0] != '\0',
           (unsigned long long)hash);
    return 0;
}
END

# model STATEMENT [MORE]: a mass that passes x = 1 m at 1 s with y at rest, and a friction that is number 1 or 0 beside.
model() {
    cat <<END
mechanism m
coordinate x [m]
coordinate y [m]
coordinate z [m]
parameter u = 1 [m]
let d = 1 - x/u
T = 1 [kg]*(x'^2 + y'^2 + z'^2)/2
friction z static 0.5 kinetic 0.4 normal 1 [N]
$1
scene trial { start x' = 1 [m/s]${2:-}; step 1 [ms]; until 3 [s] }
END
}

for part in scene angle root; do
    ${CC:-cc} -std=c11 -O2 -ffp-contract=off -I. -c -o "$scratch/$part.o" core/$part.c || exit 1
done

# Contacts are numbered stops, holds, frictions, crossings. The suite contact_undefined has every expression of each: one
# of each is enough here, WHIRL_FULL=1 takes all.
try() { # try NAME NUMBER STATEMENT [MORE]
    model "$3" "${4:-}" >"$scratch/$1.whirl"
    "$whirl" run "$scratch/$1.whirl:trial" --number float >"$scratch/out" 2>"$scratch/err"
    check "$1: the interpreter ends with status 1" test $? -eq 1
    check "$1: it names the expression" grep -qF "is not a finite number: ${3% \}}" "$scratch/err"
    hash=$(awk '/state hash/ { print $3 }' "$scratch/out")
    "$whirl" derive "$scratch/$1.whirl:trial" --as c >"$scratch/$1.c" 2>"$scratch/err"
    ${CC:-cc} -std=c11 -O0 -ffp-contract=off -I. -o "$scratch/$1" "$scratch/main.c" "$scratch/$1.c" \
        "$scratch/scene.o" "$scratch/angle.o" "$scratch/root.o" 2>"$scratch/err"
    verdict $? "$1: generated C compiles"
    "$scratch/$1" >"$scratch/got"
    echo "1 $2 1 1 $hash" >"$scratch/wanted"
    check "$1: generated C refuses the same step, to the bit" cmp "$scratch/wanted" "$scratch/got"
}

also() { [ -z "${WHIRL_FULL:-}" ] || try "$@"; }

try gap 0 'stop y + u*sqrt(d) >= -9 [m] restitution 0.5'
also restitution 0 'stop x <= 1.2 [m] restitution sqrt(d)'
try condition 0 'hold y while sqrt(d) > 9 and y < 1 [m]'
also either 0 'hold y while y > 1 [m] or sqrt(d) > 9'
also held 0 'hold y + u*sqrt(d) while y > 1 [m]'
# 2: the crossing at which the normal force vanishes is looked at first
try sticks 2 'friction y static 0.5 kinetic 0.4 normal 1 [N]*sqrt(d)'
also slides 1 'friction y static 0.5 kinetic 0.4*sqrt(d) normal 1 [N]' ", y' = 9 [m/s]"
try crossing 1 'when sqrt(d) crosses 9 { set y = 1 [m] }'

exit $failed
