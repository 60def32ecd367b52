#!/bin/sh
# emitted_c.sh: the C of `whirl derive --as c` compiles alone without a warning, in float and double, with gcc and
# clang. It steps to the interpreter's bits and outputs, with one or many steps per call. The scenes are every built-in
# one, every file of tests/mechanisms, and scenes for rare operations.
# There are four builds. The list of scenes has four parts, two of which are an eighth of it. `make gate-long` compiles
# the first part by the usual build, the second by the build that differs most. WHIRL_FULL=rest compiles the other parts
# by these builds and the first two by the other builds; WHIRL_FULL=1 all by all. WHIRL_FEW=1 derives and interprets
# every other scene and compiles none.
. "$(dirname "$0")/../checks.sh"

compared=0
warnings="-std=c11 -ffp-contract=off -I. -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Werror"

# --- the list of comparisons: lines "NUMBER WHAT", with the options in NUMBER.options ----------------
number=0
add() { # add TARGET OPTION...: adds a target to derive and run
    number=$((number + 1))
    echo "$number $1" >>"$scratch/list"
    printf '%s\n' "$@" >"$scratch/$number.options"
}

for scene in $("$whirl" list | awk '$1 == "scene" { print $2 }'); do
    add "$scene" --until 0.3s
done
# the energy balance leaves the bits unchanged, and compiles
for scene in thomson_a epicyclic_conserved; do
    add "$scene" --with ledger --until 0.3s --angles lookup
    add "$scene" --with ledger --until 0.3s --compensated --method rk38
done
for scene in thomson_a epicyclic_conserved $("$whirl" list | awk '$1 == "scene" { print $2 }' | grep -E 'ball|walk|magnet|creep'); do
    add "$scene" --with ledger --until 0.3s
done
# with --stabilized
for scene in spherical_flight docs/hard/long.whirl:gear_turns docs/hard/long.whirl:pendulum_swings; do
    for more in "" --compensated "--angles lookup" "--method nystroem5 --compensated"; do
        add "$scene" --stabilized --until 0.3s $more
    done
done
# compositions are refused if accelerations depend on rates
no_rates=$(sed -n 's/^ *X(WH_[A-Z0-9_]*, "\([a-z0-9-]*\)", .*WH_NO_RATES.*/\1/p' core/method.h)
for method in $no_rates; do
    for more in "" --compensated "--angles lookup"; do
        add mk/price/separable.whirl --until 0.3s --method "$method" $more
    done
done
for scene in thomson_b spherical_flight two_mass_relative epicyclic_conserved; do
    add "$scene" --until 0.3s --compensated
    for method in $("$whirl" derive "$scene" --as c --method '?' 2>&1 | sed -n 's/,//g; s/^hint: choose one of //p'); do
        case " $(echo $no_rates) " in *" $method "*) continue ;; esac
        add "$scene" --until 0.2s --method "$method"
    done
    add "$scene" --until 0.2s --method heun --compensated
    add "$scene" --until 0.2s --angles lookup
    add "$scene" --until 0.2s --angles lookup --compensated
done

# tables of one angle's functions; also folded, as on boards without an FPU
tabled() { # tabled FOLD TARGET OPTION...
    [ "$1" = whole ] || : >"$scratch/$((number + 1)).folded"
    shift
    add "$@" --until 0.3s
}
for scene in epicyclic_conserved epicyclic_from_rest rig_fixed halvorson_smooth laskowitz_uneven carriage_free; do
    folds="whole folded"
    case $scene in halvorson_smooth | laskowitz_uneven) folds=whole ;; esac # neither even nor odd
    for fold in $folds; do
        tabled "$fold" "$scene" --tables linear
        tabled "$fold" "$scene" --tables cubic --cells 32 --compensated
    done
    tabled "${folds##* }" "$scene" --tables linear --cells 1024 --method heun
    tabled whole "$scene" --tables cubic --cells 8 --method rk38
done
for method in $("$whirl" derive epicyclic_conserved --as c --method '?' 2>&1 | sed -n 's/,//g; s/^hint: choose one of //p'); do
    case " $(echo $no_rates) " in *" $method "*) continue ;; esac
    tabled folded epicyclic_conserved --tables cubic --method "$method"
done
tabled whole epicyclic_conserved --tables cubic --with ledger
# turning fast, and backwards
tabled folded epicyclic_from_rest --tables cubic --start "theta'=-700"
tabled whole epicyclic_conserved --tables cubic --cells 256 --start "theta'=-700"

# Prints starts for a mechanism's file: every value and rate has a different number.
start_of() {
    "$whirl" accel "$1" 2>/dev/null | awk '{
        name = $1; order = gsub("\047", "", name); rate = name
        printf "--start\n%s=%s\n", name, 0.35 + 0.11 * NR
        for (i = 1; i < order; i++) { rate = rate "\047"; printf "--start\n%s=%s\n", rate, 0.4 - 0.17 * NR * i }
    }'
}
add_file() {
    number=$((number + 1))
    echo "$number $1" >>"$scratch/list"
    { echo "$1"; start_of "$1"; printf '%s\n' --until 0.3s; } >"$scratch/$number.options"
}
for file in tests/mechanisms/*.whirl; do
    add_file "$file"
done

mkdir "$scratch/w"
cat >"$scratch/w/offsets.whirl" <<'END'
mechanism offsets "phases with offsets, negative and large multiples, sums"
coordinate a [rad]
coordinate b [rad]
input push = 0.7 [N*m]
parameter J = 0.3 [kg*m^2]
T = J*(a'^2 + b'^2 + a'*b'*cos(a - 2*b + 0.7)/3)/2
V = 1 [J]*(sin(a + 0.3) + cos(0.5 - 3*a) + sin(-2*b - 1.25)*cos(5*a + b) + cos(40*a)/50)
F = 0.05 [N*m*s]*(a' - b')^2/2
Q(b) = push*cos(a + 1)
output height [m] = 1 [m]*sin(a - 0.4)
output turned [rad] = a + 2*b
END
cat >"$scratch/w/outside.whirl" <<'END'
mechanism outside "an angle outside sines, a sine of a length, half an angle, a tangent"
coordinate a [rad]
coordinate c [rad]
coordinate x [m]
parameter m = 1.5 [kg]
parameter L = 0.8 [m]
T = m*x'^2/2 + m*L^2*(a'^2 + c'^2)/2
V = 3 [J]*a^2/2 - m*9.81 [m/s^2]*L*cos(a) + 2 [J]*sin(x/L)*cos(c) + 1 [J]*cos(c/2) + 0.1 [J]*tan(x/(2*L))
END
cat >"$scratch/w/roots.whirl" <<'END'
mechanism roots "square roots, absolute values, signs, smaller and larger"
coordinate x [m]
coordinate y [m]
coordinate z [m]
parameter m = 2 [kg]
parameter k = 8 [N/m]
let s = sqrt(x^2 + y^2 + 0.01 [m^2])
T = m*(x'^2 + y'^2 + z'^2)/2
V = k*(s - 1 [m])^2/2 + k*abs(z)*z^2/3 [m] + k*max(x, 0 [m])^2 + k*min(z, y)^2/4 + k*s^1.5*1 [m^(1/2)]/9
F = 0.3 [kg/m]*abs(x')^3/3 + 0.2 [kg/m]*abs(y' - z')^3/3
Q(z) = -0.1 [N]*sign(z') + 0.2 [N]*sign(x)
END
cat >"$scratch/w/first.whirl" <<'END'
mechanism first "first and second order together, a turning phase, an input"
state phase [rad]
state u [V]
state q
parameter w = 3 [1/s]
input drive = 0.25 [V]
equation phase' = w*(1 + 0.2*sin(phase + 0.3)*sqrt(1 + q^2))
equation u' = w*(drive - u + 0.5 [V]*cos(2*phase - 1))
equation q''/w^2 + 0.3*abs(q')/w*q + q = min(u/1 [V], 0.4) + max(0, -q)
output level [V] = u*cos(phase)
END
cat >"$scratch/w/bare.whirl" <<'END'
mechanism bare "one length, nothing acts"
coordinate x [m]
T = 3 [kg]*x'^2/2
END
# the balance is not that of T + V, and an input occurs in the energies
cat >"$scratch/w/hoop.whirl" <<'END'
mechanism hoop "a bead on a hoop whose rate is an input"
coordinate th [rad]
input push = 0.01 [N*m]
input w = 10 [rad/s]
T = 2e-3 [kg*m^2]*(th'^2 + w^2*sin(th)^2)
V = -0.2 [J]*cos(th)
Q(th) = push
stop th <= 0.7 restitution 0.5
END
# angles that only the energy balance needs outside sines
cat >"$scratch/w/gauge.whirl" <<'END'
mechanism gauge "a total derivative in the energies"
coordinate a [rad]
coordinate b [rad]
T = 1 [kg*m^2]*(2*a'^2 + b'^2 + 2*a'*b'*cos(a - b))/2 + 0.3 [N*m*s]*(2*a*b*a' + a^2*b')
V = -9 [J]*(2*cos(a) + cos(b))
stop sin(b) >= -0.9 restitution 0.5
END
for file in "$scratch"/w/*.whirl; do
    add_file "$file"
done
for file in offsets outside roots first; do
    add_file "$scratch/w/$file.whirl"
    echo --compensated >>"$scratch/$number.options"
done
# Nyström methods: with balance, contacts, sums of angles, systems of first order
for method in nystroem3 nystroem4 nystroem5; do
    add thomson_a --with ledger --until 0.3s --method "$method"
    add thomson_a --until 0.3s --method "$method" --compensated
    add thomson_a --until 0.3s --method "$method" --angles lookup
    add crash_cart --until 0.3s --method "$method"
    add two_mass_relative --until 0.3s --method "$method" --compensated
    for file in offsets outside roots first; do
        add_file "$scratch/w/$file.whirl"
        printf '%s\n' --method "$method" >>"$scratch/$number.options"
    done
done
# angles whose change in a step is too large for turned sines (core/step/stage_turn.h), some by a factor of 100
for more in "" --compensated "--method rk38" "--method nystroem5"; do
    add "$scratch/w/offsets.whirl" --start "a'=900" --start "b'=-700" --until 0.3s $more
done
# a pendulum of seven links, whose list is too large to be inlined
awk -v n=7 -f mk/price/links.awk >"$scratch/w/links.whirl"
add_file "$scratch/w/links.whirl"
links=scene_$number.c
for file in hoop gauge; do
    add_file "$scratch/w/$file.whirl"
    printf '%s\n' --with ledger >>"$scratch/$number.options"
done

# inputs with a rate: in stops and holds, only in the energies, with a ledger, and with an acceleration
cat >"$scratch/driven.whirl" <<'END'
mechanism driven "a ball on a rope that is taken in, at a wall that comes"
coordinate x [m]
coordinate y [m]
input L rate Lv = 1 [m]
input W = 0.3 [m] rate Wv
input Wv = -0.9 [m/s]
input Lv = -0.4 [m/s] rate La
input La = 0.7 [m/s^2]
T = 2 [kg]*(x'^2 + y'^2)/2
V = 2 [kg]*9.81 [m/s^2]*y
hold sqrt(x^2 + y^2) - L while y < 0
stop x >= -W restitution 0.6
scene hung { start x = 0.6 [m], y = -0.8 [m], x' = -3 [m/s], y' = 1 [m/s]; until 0.3 [s] }
mechanism drawn "a pendulum that is taken in"
coordinate a [rad]
input L rate Lv = 1 [m]
input Lv = -0.4 [m/s]
let px = L*sin(a)
let py = -L*cos(a)
T = 2 [kg]*(px'^2 + py'^2)/2
V = 2 [kg]*9.81 [m/s^2]*py
F = 0.1 [N*s/m]*py'^2/2
scene swung { start a = 1; until 0.3 [s] }
END
for scene in hung swung; do
    for more in "" "--with ledger" "--compensated --method rk38"; do
        add "$scratch/driven.whirl:$scene" $more
    done
done

# a conserved clock on which a force depends is integrated
cat >"$scratch/w/clock.whirl" <<'END'
mechanism clock "a force of time"
coordinate t [s]
coordinate x [m]
T = 1e-9 [J]*t'^2/2 + 2 [kg]*x'^2/2
V = 50 [N/m]*x^2/2
Q(x) = 4 [N]*sin(3 [rad/s]*t)
scene clock_drives { start t' = 1; conserve t }
END
add "$scratch/w/clock.whirl:clock_drives" --until 0.3s

# a whole step as one matrix: masses, a rotor whose angle occurs in no force, an input, gravity, a free mass; first
# order
cat >"$scratch/w/rotor.whirl" <<'END'
mechanism rotor "a rotor with friction, and masses between springs, one of them free"
coordinate th [rad]
coordinate x [m]
coordinate y [m]
coordinate z [m]
input M = 3 [N*m]
input push = 0.5 [N]
T = 2 [kg*m^2]*th'^2/2 + 1.5 [kg]*(x' + y')^2/2 + 0.7 [kg]*y'^2/2 + 3 [kg]*z'^2/2
V = 160 [N/m]*(x - 0.1 [m])^2/2 + 33 [N/m]*(x - y)^2/2 + 29.43 [N]*z
F = 0.5 [N*m*s]*th'^2/2 + 0.25 [N*s/m]*(x' - 0.125 [m]*th')^2/2
Q(th) = M
Q(y) = push
output wave = sin(th)
END
cat >"$scratch/w/filter.whirl" <<'END'
mechanism filter "first and second order, an angle that a voltage turns"
state a [rad]
state u [V]
state q
input d = 2 [V]
equation a' = u/(1 [V*s]) + 3 [1/s]
equation u' = (d - u)/(0.25 [s]) + 1 [V/s]*q
equation q''/(400 [1/s^2]) + 0.3*q'/(20 [1/s]) + q = u/(1 [V])
output level = sin(a)
END
cat >"$scratch/w/balance.whirl" <<'END'
mechanism balance "unstable: refused at the same step"
coordinate q [m]
T = 1 [kg]*q'^2/2
V = -90000 [N/m]*q^2/2
END
for matrix in exact rk4; do
    for more in "" --compensated; do
        for scene in two_mass_relative two_mass_absolute two_mass_relative_physical cartesian_flight; do
            add "$scene" --until 0.3s --matrix $matrix $more
        done
        for file in rotor filter balance; do
            add_file "$scratch/w/$file.whirl"
            printf '%s\n' --matrix $matrix $more >>"$scratch/$number.options"
        done
    done
done

# random planar linkages; tests/host/test_arm.c compares the interpreter's motions with their energies
few=8
[ -z "${WHIRL_FULL:-}" ] || few=16
[ "${WHIRL_FULL:-rest}" = rest ] || few=40
"$(dirname "$whirl")/tools/linkages" "${WHIRL_LINKAGES:-$few}" "${WHIRL_SEED:-14}" >"$scratch/w/linkages.whirl"
for scene in $(sed -n 's/^scene \([a-z0-9_]*\) .*/\1/p' "$scratch/w/linkages.whirl"); do
    add "$scratch/w/linkages.whirl:$scene"
done

# --- deriving and interpreting ----------------------------------------------------------------------
: >"$scratch/numbers"
[ -z "${WHIRL_FEW:-}" ] || sed -i 'n;d' "$scratch/list"
# part_of NUMBER: prints the part of the list to which the case belongs, 0 to 3. A checksum decides, because the list
# has a rhythm. Folded tables exist only in float, in which parts 0 and 2 are compiled.
part_of() {
    drawn=$(($(echo "$1" | cksum | cut -d ' ' -f 1) % 8)) # parts 0 and 1 have an eighth of the cases each
    [ $drawn -lt 2 ] || drawn=$((2 + drawn % 2))
    [ ! -e "$scratch/$1.folded" ] || drawn=$((drawn / 2 * 2))
    echo $drawn
}
# wanted NUMBER: is the case in one of the two parts that gate-long compiles? Other runs need all parts.
wanted() { # NUMBER
    [ -n "${WHIRL_FULL:-}${WHIRL_FEW:-}" ] || [ "$(part_of "$1")" -lt 2 ]
}
while read -r number what; do
    wanted "$number" || continue
    set --
    while read -r word; do
        set -- "$@" "$word"
    done <"$scratch/$number.options"
    # each scene has a name of its own
    "$whirl" derive "$@" --as c --name "scene_$number" >"$scratch/scene_$number.c" 2>"$scratch/errors"
    derived=$?
    if [ -e "$scratch/$number.folded" ]; then
        { printf '#if !WH_DOUBLE\n#define WH_TABLE_FOLD 1\n#endif\n'; cat "$scratch/scene_$number.c"; } >"$scratch/folded.c"
        grep -q 'wh_table_half' "$scratch/folded.c" || verdict 1 "$what: its tables fold"
        mv "$scratch/folded.c" "$scratch/scene_$number.c"
    fi
    real=float
    [ -n "${WHIRL_FULL:-}${WHIRL_FEW:-}" ] || [ "$(part_of "$number")" -eq 0 ] || real=double
    "$whirl" run "$@" --number "$real" >"$scratch/$number.$real" 2>"$scratch/$number.run"
    ran=$?
    # status 1: the run diverges, after the same step in both
    if [ $derived -ne 0 ] || [ $ran -gt 1 ]; then
        verdict 1 "$what: derive says $derived, run says $ran"
        sed 's/^/    /' "$scratch/errors" "$scratch/$number.run" | head -n 5
        rm -f "$scratch/scene_$number.c"
        continue
    fi
    [ -z "${WHIRL_FULL:-}${WHIRL_FEW:-}" ] || "$whirl" run "$@" --number double >"$scratch/$number.double" 2>&1
    echo "$number" >>"$scratch/numbers"
done <"$scratch/list"
if [ -e "$scratch/$links" ]; then # otherwise the sanitizers' gate has omitted it
    grep -q '^static void accelerations(' "$scratch/$links"
    verdict $? "a large list is called"
fi

# --- one program of all cases, or of some -----------------------------------------------------------
program_of() { # FILE: of the scenes whose numbers it holds
    echo '#include <inttypes.h>'
    echo '#include <stdio.h>'
    echo '#include "core/scene.h"'
    sed 's/.*/extern const wh_scene scene_&;/' "$1"
    echo 'static const struct { int number; const wh_scene *scene; } all[] = {'
    sed 's/.*/    {&, \&scene_&},/' "$1"
    cat <<'END'
};
static uint64_t memory[WH_STATE_WORDS(64, 128, 64) + WH_CONTACT_WORDS(16) + WH_LEDGER_WORDS(2048, 195)];
int main(void) {
    for (unsigned i = 0; i < sizeof all / sizeof all[0]; i++) {
        wh_state state;
        wh_status status = wh_scene_start(all[i].scene, &state, memory, sizeof memory);
        while (status == WH_OK && state.steps < all[i].scene->steps) {
#if WH_MULTI_STEP /* many a call, of every number */
            const uint64_t left = all[i].scene->steps - state.steps;
            static uint32_t many;
            many = many % 97U + 1U;
            status = wh_scene_steps(all[i].scene, &state, left < many ? (uint32_t)left : many);
#else
            status = wh_scene_step(all[i].scene, &state);
#endif
        }
        wh_real output[64];
        const unsigned outputs = all[i].scene->observe != NULL && all[i].scene->outputs <= 64 ? all[i].scene->outputs : 0;
        if (outputs > 0) {
            all[i].scene->observe(all[i].scene, &state, output);
        }
        printf("%d 0x%016" PRIx64, all[i].number, wh_scene_hash(all[i].scene, &state));
        for (unsigned k = 0; k < outputs; k++) {
            printf(" %.*g", WH_DOUBLE ? 17 : 9, (double)output[k]);
        }
        putchar('\n');
    }
    return 0;
}
END
}
while read -r number; do
    echo "$number" >>"$scratch/numbers.$(part_of "$number")"
done <"$scratch/numbers"

build() { # build COMPILER OPTIMISATION REAL WH_DOUBLE WH_MULTI_STEP NUMBERS
    program_of "$6" >"$scratch/main.c"
    $1 $warnings $2 -DWH_DOUBLE="$4" -DWH_MULTI_STEP="$5" -o "$scratch/$1_$3" $(sed "s|.*|$scratch/scene_&.c|" "$6") "$scratch/main.c" \
        core/*.c >"$scratch/$1_$3.log" 2>&1
    status=$?
    verdict $status "$1 $2 compiles $(wc -l <"$6") emitted scenes in $3 without a warning"
    [ $status -eq 0 ] || { grep -E "error|warning|undefined" "$scratch/$1_$3.log" | head -n 5; return; }
    "$scratch/$1_$3" >"$scratch/$1_$3.hashes"
    while read -r number hash outputs; do
        compared=$((compared + 1))
        # outputs that the run prints in SI
        sed -n '/^outputs$/,/^[^ o]/s/^  [^ ]* *\([^ ]*\) *\(.*\)/\1 \2/p' "$scratch/$number.$3" |
            awk -v all="$outputs" 'BEGIN { split(all, own) }
                !/mm|cm|km|deg|rev|rpm|min|h$|k[NJW]/ && $1 != own[NR] { exit 1 }' || verdict 1 "$1 $3: outputs of $number: $outputs"
        if ! grep -q "state hash.*$hash" "$scratch/$number.$3"; then
            verdict 1 "$1 $3: $(tr '\n' ' ' <"$scratch/$number.options"): $hash, interpreted $(sed -n 's/^state hash *//p' "$scratch/$number.$3")"
        fi
    done <"$scratch/$1_$3.hashes"
}

# Compiled for size, without constants passed into functions, as an image may be: gcc once warned of contacts' loops.
if [ -z "${WHIRL_FEW:-}${WHIRL_FULL:-}" ]; then
    (cd "$scratch" && grep -l 'WH_CONTACTS_OF' scene_*.c | xargs grep -l '^#define WH_COORDS [12]$' | head -n 6) >"$scratch/small"
    [ "$(wc -l <"$scratch/small")" -eq 6 ]
    verdict $? "six scenes of contacts have one or two coordinates"
    while read -r file; do
        gcc $warnings -Os -fno-ipa-cp -S -o /dev/null "$scratch/$file" >"$scratch/said" 2>&1
        verdict $? "-Os -fno-ipa-cp: $(sed -n 's/^ \* scene  *//p' "$scratch/$file") compiles without a warning" "$scratch/said"
    done <"$scratch/small"
fi

other=gcc
! command -v clang >/dev/null 2>&1 || other=clang
if [ -n "${WHIRL_FEW:-}" ]; then
    [ "$(wc -l <"$scratch/numbers")" -ge 100 ]
    verdict $? "$(wc -l <"$scratch/numbers") scenes derived and interpreted"
    exit $failed
fi
case ${WHIRL_FULL:-} in
'')
    build gcc -O2 float 0 1 "$scratch/numbers.0"
    build $other -O0 double 1 0 "$scratch/numbers.1"
    ;;
rest)
    build gcc -O2 float 0 1 "$scratch/numbers.2"
    build $other -O0 double 1 0 "$scratch/numbers.3"
    build $other -O1 float 0 0 "$scratch/numbers.0"
    build gcc -O1 double 1 1 "$scratch/numbers.1"
    ;;
*)
    build gcc -O2 float 0 1 "$scratch/numbers"
    build $other -O0 double 1 0 "$scratch/numbers"
    build $other -O1 float 0 0 "$scratch/numbers"
    build gcc -O1 double 1 1 "$scratch/numbers"
    ;;
esac

[ "$compared" -ge "$(wc -l <"$scratch/numbers")" ] && [ "$compared" -ge 60 ]
verdict $? "$compared comparisons with the interpreter"
exit $failed
