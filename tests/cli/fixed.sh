#!/bin/sh
# fixed.sh: fixed point. `whirl derive --as c --number fixed` compiles without warnings with gcc and clang, has no
# floating-point operation, and steps to the bits of `whirl run --number fixed`, by both ways to a product. For every
# built-in scene that allows it, and generated mechanisms; other scenes are refused with a hint. `make gate-long` takes one
# build by each compiler and, for each small core, the calls of every fourth scene. WHIRL_FULL takes all.
. "$(dirname "$0")/../checks.sh"

warnings="-std=c11 -I. -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Werror"

# --- made-up mechanisms: N of each of five kinds, numbered
# -----------------------------------------------------------
mkdir "$scratch/w"
awk -v folder="$scratch/w" 'function r() { state = (state * 16807) % 2147483647; return 0.5 + 1.5 * state / 2147483647 }
BEGIN {
    state = 20061
    for (i = 1; i <= 20; i++) {
        file = folder "/made_" i ".whirl"
        printf "mechanism made_%d\ninput u = %.4f\n", i, r() >file
        if (i % 5 == 0) {
            printf "state p [rad]\nstate v\nstate q\nequation p\047 = %.4f [1/s]*(1 + 0.3*sin(p)) + 0.1 [1/s]*q\n", 3*r() >file
            printf "equation v\047 = %.4f [1/s]*(u - v + min(cos(2*p - 1), abs(q)))\n", 3*r() >file
            printf "equation q\047\047/(30 [1/s^2]) + %.4f*q\047/(5 [1/s]) + q = v\n", r() >file
        } else {
            n = i % 5
            for (k = 1; k <= n; k++) { printf "coordinate q%d%s\n", k, (i + k) % 2 ? " [rad]" : " [m]" >file }
            printf "T = 0" >file
            for (k = 1; k <= n; k++) {
                unit = (i + k) % 2 ? "kg*m^2" : "kg"
                printf " + %.4f [%s]*q%d\047^2/2", 1 + r(), unit, k >file
                if (k > 1) {
                    printf " + %.4f [kg*m]*q%d\047*q%d\047*cos(q%d)/3", r(), k, k - 1, (i + k) % 2 ? k : k - 1 >file
                }
            }
            printf "\n" >file
            for (k = 1; k <= n; k++) {
                if ((i + k) % 2) { printf "V += -%.4f [J]*cos(q%d + %.3f)\n", 4*r(), k, r() >file }
                else { printf "V += %.4f [N/m]*q%d^2 + 3 [N/m]*max(q%d, 0 [m])^2\n", 20*r(), k, k >file }
                printf "F += %.4f [%s]*q%d\047^2/2\n", 0.2*r(), (i + k) % 2 ? "N*m*s" : "N*s/m", k >file
            }
            printf "Q(q1) = u*1 [%s]\n", (i + 1) % 2 ? "N*m" : "N" >file
        }
        printf "scene made_scene_%d { until 0.5 [s]; step %d [us]; range u = -5 .. 5", i, 500 + 100 * (i % 7) >file
        if (i % 5) { printf "; start q1%s = %.3f%s", (i % 2 ? "" : "\047"), 0.3*r(), (i + 1) % 2 ? (i % 2 ? "" : " [rad/s]") : (i % 2 ? " [m]" : " [m/s]") >file }
        print " }" >file
        close(file)
    }
}'
sed -i 's/^V += \(.*\)$/V += \1/' "$scratch"/w/*.whirl
for file in "$scratch"/w/*.whirl; do # the first statement of an energy has =; further ones go into effects
    awk '/^V \+=/ && !v { sub(/\+=/, "="); v = 1 } /^F \+=/ && !f { sub(/\+=/, "="); f = 1 }
        /^[VF] \+=/ { print "effect more_" ++n " { " $0 " }"; next } { print }' "$file" >"$scratch/one"
    mv "$scratch/one" "$file"
done

# --- deriving and interpreting ----------------------------------------------------------------------------------------
number=0
refused=0
: >"$scratch/numbers"
try() { # try TARGET OPTION...
    number=$((number + 1))
    "$whirl" derive "$@" --as c --number fixed --name "scene_$number" --header "$scratch/scene_$number.h" >"$scratch/scene_$number.c" 2>"$scratch/err"
    derived=$?
    "$whirl" run "$@" --number fixed >"$scratch/$number.run" 2>"$scratch/$number.err"
    ran=$?
    if [ $derived -eq 2 ] && [ $ran -eq 2 ] && grep -q '^hint: ' "$scratch/err"; then
        refused=$((refused + 1))
        rm -f "$scratch/scene_$number.c"
        return
    fi
    [ $derived -eq 0 ] && [ $ran -le 1 ] || { verdict 1 "$*: derive says $derived, run says $ran"; rm -f "$scratch/scene_$number.c"; return; }
    echo "$number $*" >>"$scratch/numbers"
}
for scene in $("$whirl" list | awk '$1 == "scene" { print $2 }'); do
    try "$scene" --until 0.2s
done
for file in "$scratch"/w/*.whirl; do
    try "$file" --with all
done
for step in 0.1ms 4ms; do
    try two_mass_relative --until 0.5s --step $step
    try epicyclic_conserved --until 0.5s --step $step
done
try epicyclic_from_rest --until 1s --without conserve
compared=$(wc -l <"$scratch/numbers")
[ "$compared" -ge 30 ] && [ "$(grep -c made_ "$scratch/numbers")" -ge 16 ]
verdict $? "$compared scenes have a step in fixed point, $refused are refused with a hint" "$scratch/numbers"

# --- one program of all scenes ----------------------------------------------------------------------------------------
mk/count/index.sh --fixed $(sed 's/ .*//; s/^/scene_/' "$scratch/numbers") >"$scratch/table.c"
build() { # build COMPILER FLAGS
    $1 $warnings $2 -I"$scratch" -o "$scratch/program" "$scratch"/scene_*.c "$scratch/table.c" boards/programs/fixed_scenes.c \
        boards/host/board.c core/*.c >"$scratch/err" 2>&1
    verdict $? "$1 $2 compiles them without a warning"
    "$scratch/program" | sed -n 's/^scene scene_\([0-9]*\) .* hash \(0x[0-9a-f]*\) .*/\1 \2/p' >"$scratch/hashes"
    differ=0
    while read -r number hash; do
        grep -q "state hash.*$hash" "$scratch/$number.run" || {
            differ=$((differ + 1))
            sed -n "s/^$number /    other bits: /p" "$scratch/numbers"
        }
    done <"$scratch/hashes"
    [ $differ -eq 0 ] && [ "$(wc -l <"$scratch/hashes")" -eq "$compared" ]
    verdict $? "$1 $2: the interpreter's bits in all of them"
}
if [ -n "${WHIRL_FEW:-}" ]; then # the sanitizers test the program, not the code that it writes
    echo "ok - derived and interpreted, not compiled"
else
    [ "${WHIRL_FULL:-}" = rest ] || build gcc "-O2"
    [ -z "${WHIRL_FULL:-}" ] || build gcc "-O1 -DWH_FIXED_NARROW=1"
    [ "${WHIRL_FULL:-}" = rest ] || ! command -v clang >/dev/null 2>&1 || build clang "-O2 -DWH_FIXED_NARROW=1"
fi

# --- integers only ---------------------------------------------------------------------------------------------------
if [ -z "${WHIRL_FEW:-}" ] && command -v arm-none-eabi-gcc >/dev/null 2>&1; then
    for cpu in cortex-m0 cortex-m3; do
        : >"$scratch/symbols"
        turn=0
        [ $cpu = cortex-m3 ] || turn=1
        for file in core/fixed.c "$scratch"/scene_*.c; do
            turn=$(((turn + 1) % 4))
            [ "$file" = core/fixed.c ] || [ -n "${WHIRL_FULL:-}" ] || [ $turn -eq 1 ] || continue
            arm-none-eabi-gcc -std=c11 -O2 -mcpu=$cpu -mthumb -I. -c "$file" -o "$scratch/one.o" 2>/dev/null
            arm-none-eabi-nm "$scratch/one.o" >>"$scratch/symbols"
        done
        ! grep -E ' U __aeabi_([fdl]|i2f|ui2f|[a-z]*2[fd])' "$scratch/symbols" >"$scratch/err"
        verdict $? "$cpu: no call for floating-point or 64-bit arithmetic"
    done
fi

# --- messages ----------------------------------------------------------------------------------------------------------
"$whirl" run two_mass_relative --number fixed --until 0.1s >"$scratch/out" 2>"$scratch/err"
grep -q "note: range X' = .*not declared, taken from the results of a run in double" "$scratch/err" && grep -q '^0 values saturated' "$scratch/out"
verdict $? "a range that is not declared is told, and how many values were saturated"
"$whirl" derive two_mass_relative --as c --number fixed 2>/dev/null | grep -q "^ \* range X' = .*not declared"
verdict $? "and in generated code"
cat >"$scratch/w/cart.whirl" <<'END'
mechanism cart
coordinate x [m]
T = 1 [kg]*x'^2/2
V = 50 [N/m]*x^2/2
scene cart_narrow { start x = 0.1 [m]; range x = -0.2 .. 0.2 [m], x' = -300 .. 300 [mm/s]; until 1 [s] }
scene cart_wide { start x = 0.1 [m]; range x = -0.2 .. 0.2 [m], x' = -900 .. 900 [mm/s]; until 1 [s] }
END
"$whirl" run "$scratch/w/cart.whirl:cart_narrow" --number fixed >"$scratch/out" 2>"$scratch/err"
grep -q '^[1-9][0-9]* values saturated' "$scratch/out" && grep -q 'warning: .* values saturated' "$scratch/err"
verdict $? "a range that is too small shows"
grep -q 'warning: .* values saturated' "$scratch/err" && ! grep -q 'smaller --step' "$scratch/err"
verdict $? "and nothing else is blamed for it"
cat >"$scratch/w/slow.whirl" <<'END'
mechanism slow
coordinate x [m]
coordinate b [rad]
input u = 6e-6 [N]
T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*b'^2/2
V = -1e-3 [J]*cos(b)
Q(x) = u
scene slow { step 1 [ms]; until 1 [s]; range x = -10 .. 10 [m], x' = -10 .. 10 [m/s], u = -1 .. 1 [N], b = -5 .. 5 [deg], b' = -1 .. 1 [rad/s] }
mechanism round
coordinate th [rad]
coordinate ph [rad]
T = 1 [kg*m^2]*(th'^2 + sin(th)^2*ph'^2)/2
V = -9.81 [J]*cos(th)
scene round { start th = 1, ph' = 3 [rad/s]; until 1 [s] }
END
"$whirl" run "$scratch/w/slow.whirl:slow" --number fixed >"$scratch/out" 2>"$scratch/err"
grep -q "note: 'x'' moves so slowly that rounding" "$scratch/err" && grep -q '^hint: use a larger --step' "$scratch/err" && ! grep -q 'smaller --step' "$scratch/err"
verdict $? "steps lost in rounding are told, with hints that help"
grep -q "note: 'b' is a turn angle.* its declared range is not used" "$scratch/err"
verdict $? "a range of a turn angle is not used, and that is told"
"$whirl" run "$scratch/w/cart.whirl:cart_wide" --number fixed >"$scratch/out" 2>"$scratch/err"
grep -q '^0 values saturated' "$scratch/out" && [ ! -s "$scratch/err" ]
verdict $? "one that is large enough is quiet"
refuse() { # refuse WORDS TARGET OPTION...
    words=$1
    shift
    exits 2 "$words" derive "$@" --as c --number fixed
    grep -q '^hint: ' "$scratch/err" || verdict 1 "a hint: $words"
}
refuse "fixed point does not support events" carriage_stop
cat >"$scratch/w/stopped.whirl" <<'END'
mechanism stopped "a stop in an effect"
coordinate x [m]
T = 1 [kg]*x'^2/2
V = 9 [N/m]*x^2/2
effect end { stop x >= -0.5 [m] restitution 0.5 }
scene stopped_rings { with end; start x = 1 [m]; step 1 [ms]; until 1 [s]; range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }
END
refuse "fixed point does not support events" "$scratch/w/stopped.whirl"
grep -q 'put this statement into an effect, and use --without EFFECT$' "$scratch/err" &&
    "$whirl" derive "$scratch/w/stopped.whirl" --without end --as c --number fixed >"$scratch/out" 2>"$scratch/err" && [ -s "$scratch/out" ]
verdict $? "and as the hint says, it has a step in fixed point without the effect"
sed "s/x' = -300 .. 300/x' = 300 .. -300/" "$scratch/w/cart.whirl" >"$scratch/w/empty.whirl"
refuse "the range of 'x'' is empty: from 0.3 to -0.3" "$scratch/w/empty.whirl:cart_narrow"
refuse "keeps a ledger" two_mass_relative --with ledger
refuse "supports only --method rk4, not heun" two_mass_relative --method heun
refuse "are not compensated" two_mass_relative --compensated
refuse "no --matrix exact in fixed point" two_mass_relative --matrix exact
refuse "no --tables linear in fixed point" epicyclic_conserved --tables linear
refuse "may be zero within the ranges" "$scratch/w/slow.whirl:round"
grep -q '^hint: choose --number float: a turn angle takes all values' "$scratch/err"
verdict $? "and not with the hint to narrow a range that is none"
# the example of core/fixed_scene.h
"$whirl" derive epicyclic_conserved --as c --number fixed --name gear --until 1s --header "$scratch/gear.h" >"$scratch/gear.c" 2>/dev/null
{
    echo '#include "gear.h"'
    echo 'int main(void) {'
    sed -n 's/^ \*     //p' core/fixed_scene.h
    echo 'return state.steps == gear.steps && theta_rad > 0 && rate_rad_s > 0 ? 0 : 3; }'
} >"$scratch/example.c"
gcc $warnings -I"$scratch" -o "$scratch/example" "$scratch/example.c" "$scratch/gear.c" core/*.c 2>"$scratch/err" && "$scratch/example"
verdict $? "the example in core/fixed_scene.h compiles and runs to its end" "$scratch/err"
! grep -q 'wh_angle_to_rad' "$scratch/gear.h" && grep -q 'wh_fixed_angle()' "$scratch/gear.h"
verdict $? "a header names the functions that there are in fixed point"
units() { sed -n "s/^#define gear_$1_OF_OUTPUTS //p" "$2"; }
"$whirl" derive epicyclic_conserved --as c --name gear --header "$scratch/float.h" >/dev/null 2>&1
[ -n "$(units UNITS "$scratch/gear.h")" ] && [ "$(units UNITS "$scratch/gear.h")" = "$(units UNITS "$scratch/float.h")" ] &&
    [ "$(units NAMES "$scratch/gear.h")" = "$(units NAMES "$scratch/float.h")" ]
verdict $? "it lists the outputs and units that the header in floating point lists" "$scratch/gear.h"
exits 2 '--number fixed needs --as c' derive two_mass_relative --number fixed
exits 2 "no number 'fixed'" sweep two_mass_relative --number fixed
exit $failed
