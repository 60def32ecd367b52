#!/bin/sh
# prove.sh: `whirl prove`: its answer, rows, bounds and refusals. build/tests/host enclosure prove prove_drawn checks that
# they are right.
. "$(dirname "$0")/../checks.sh"
about=prove

# proved PATTERN WORD...: status 0, and the pattern on standard output
proved() {
    pattern=$1
    shift
    "$whirl" prove "$@" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 0 ] && grep -qE -- "$pattern" "$scratch/out" && [ ! -s "$scratch/err" ]
    verdict $? "whirl prove $*: $pattern" "$scratch/out"
}
# ended STATUS PATTERN WORDS WORD...: that status, the pattern on standard error, the words on standard output
ended() {
    status=$1
    pattern=$2
    words=$3
    shift 3
    "$whirl" prove "$@" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq "$status" ] && grep -q -- "$pattern" "$scratch/err" && grep -q -- "$words" "$scratch/out" &&
        ! grep -q '^proved to the end' "$scratch/out"
    verdict $? "whirl prove $*: status $status, $pattern" "$scratch/err"
}

# --- what is proved ------------------------------------------------------------------------------------------------------
proved '^proved to the end, t = 1 s$' epicyclic_from_rest --until 1s
proved '^  X  *to the end  *within 1.00e-03 m: error at most' epicyclic_from_rest --until 1s --number float --within X=1mm
proved "^  theta'  *to the end  *within 5.00e-01 rad/s: error at most" epicyclic_from_rest --until 1s --within "theta'=0.5" --within=X=1mm
proved '^proved to the end, t = 1 s$' epicyclic_conserved --until 1s --number float
proved '^proved to the end, t = 5 s$' tests/mechanisms/lorenz.whirl --start x=1 --step 2ms --until 5s
proved '^proved to the end, t = 0 s$' epicyclic_from_rest --until 0
"$whirl" prove epicyclic_from_rest --until 0.1s --csv - >"$scratch/rows" 2>"$scratch/err"
"$whirl" trust epicyclic_from_rest --until 0.1s --proved --csv - 2>&1 >"$scratch/out" | cmp - "$scratch/err" && cmp "$scratch/rows" "$scratch/out" && [ -s "$scratch/rows" ]
verdict $? "whirl trust --proved says the same"
# with a step that is too coarse, the error is larger, and that is proved, too
proved 'proved: error too large after that$' epicyclic_from_rest --until 3s --method semi-implicit-euler --step 10ms --tolerance 1e-4
# a start that float cannot represent has an error from the beginning
proved '^  theta  *never  *within 1.00e-12 rad: proved: the error is too large at the start$' epicyclic_from_rest --until 0.1s --number float --start theta=0.1 --within theta=1e-12
grep -q '^nothing is proved: theta is not within its tolerance at the start$' "$scratch/out"
verdict $? "a start that is off: nothing is proved" "$scratch/out"
# noise is added to records only: the motion is the same
cat >"$scratch/noisy.whirl" <<'END'
mechanism noisy "a swing whose angle is read with noise"
coordinate a [rad]
parameter g = 9.81 [m/s^2]
parameter l = 0.7 [m]
T = 1 [kg]*l^2*a'^2/2
V = -1 [kg]*g*l*cos(a)
output read [rad] = a
noise read deviation 0.1 [rad] seed 7
scene swings { start a = 2 [rad]; step 1 [ms]; until 1 [s] }
END
proved '^proved to the end, t = 1 s$' "$scratch/noisy.whirl" --number float
# --- rows ------------------------------------------------------------------------------------------------------------------
"$whirl" prove epicyclic_from_rest --until 0.5s --number float --csv "$scratch/rows" --quiet >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && [ ! -s "$scratch/out" ] && [ ! -s "$scratch/err" ]
verdict $? "--csv and --quiet: no words" "$scratch/err"
tr -d '\r' <"$scratch/rows" | awk -F, '
    NR == 1 { bad = $0 !~ /^time \[s\],theta least \[rad\],theta most \[rad\],theta run \[rad\],theta. least \[rad\/s\],/; next }
    NF != 13 { bad = 1 }
    { late = $1 - (NR - 2) * 0.001; if (late > 1e-12 || late < -1e-12) bad = 1
      for (i = 2; i < 13; i += 3) {
          if ($i > $(i + 1) || $(i + 1) - $i > 1e-9) bad = 1
          off = $(i + 2) - $i; if (off > 1e-4 || off < -1e-4) bad = 1
          if (off != 0) moved = 1 } }
    END { exit bad || !moved || NR != 502 }'
verdict $? "a row for each step: the time, least, most and the run's" "$scratch/rows"
"$whirl" run epicyclic_from_rest --until 0.5s --number float --csv - --quiet 2>"$scratch/err" | tr -d '\r' | tail -n 1 >"$scratch/last"
tail -n 1 "$scratch/rows" | tr -d '\r' | awk -F, -v run="$(cut -d, -f2 "$scratch/last")" \
    '{ d = $4 - run; exit !(d < 1e-6 && d > -1e-6) }'
verdict $? "the run's column is what whirl run says" "$scratch/last"
"$whirl" prove epicyclic_from_rest --until 0.5s --number float --csv - >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && cmp "$scratch/out" "$scratch/rows" >"$scratch/diff" && grep -q '^proved to the end' "$scratch/err"
verdict $? "--csv -: the rows, and the words on standard error" "$scratch/diff"

# --- the C that boards run: its floats are the compared ones, and lie within a millimetre of all possible motions -------------
cat >"$scratch/main.c" <<'END'
#include <stdio.h>

#include "gear.h"

static uint64_t memory[gear_MEMORY_WORDS];

int main(void) {
    wh_state state;
    wh_status status = wh_scene_start(&gear, &state, memory, sizeof memory);
    while (status == WH_OK) {
        printf("%.17g\n", (double)state.real[gear_REAL_X]);
        if (state.steps == gear.steps) {
            break;
        }
        status = wh_scene_step(&gear, &state);
    }
    return status == WH_OK ? 0 : 1;
}
END
if [ -z "${WHIRL_FEW:-}" ]; then
    "$whirl" derive epicyclic_from_rest --as c --until 3s --name gear --header "$scratch/gear.h" >"$scratch/gear.c" 2>"$scratch/err" &&
        "${CC:-cc}" -std=c11 -O2 -I. -I"$scratch" -o "$scratch/gear" "$scratch/main.c" "$scratch/gear.c" core/*.c 2>"$scratch/err" &&
        "$scratch/gear" >"$scratch/board" &&
        "$whirl" prove epicyclic_from_rest --until 3s --number float --within X=1mm --csv "$scratch/rows" >"$scratch/out" 2>"$scratch/err" &&
        grep -q '^  X  *to the end  *within 1.00e-03 m' "$scratch/out"
    verdict $? "until 3 s the generated C's X is within 1 mm of the exact motion: proved"
    tr -d '\r' <"$scratch/rows" | sed 1d | cut -d, -f8-10 | paste -d, - "$scratch/board" | awk -F, '
        NF != 4 || $3 != $4 || $4 - $1 > 1e-3 || $2 - $4 > 1e-3 { bad = 1 }
        $1 <= $4 && $4 <= $2 { inside++ }
        END { exit bad || NR != 3001 || inside > 300 }'
    verdict $? "its records are those that were held" "$scratch/board"
fi

# --- what ends a proof -------------------------------------------------------------------------------------------------------
ended 0 '^whirl prove: the effort is used up at t = [0-9.]* s of 10 s$' 'at that time the effort is used up$' thomson_a --step 1ms --effort 7.5e7
ended 0 '^hint: use a larger --effort' '^proved until t = [0-9.]* s of 10 s$' thomson_a --step 1ms --effort 7.5e7
cat >"$scratch/pole.whirl" <<'END'
mechanism pole "x'' = 2 x^3 is infinite at 1 s"
coordinate x [m]
T = 1 [kg]*x'^2/2
V = -0.5 [N/m^3]*x^4
scene blows { start x = 1 [m], x' = 1 [m/s]; step 1 [ms]; until 2 [s] }
END
ended 1 'error: the run diverged in the step after t = 1 s' '^proved until t = 0.99' "$scratch/pole.whirl"
ended 1 'the proof ends at t = 0.99.* s: Whirl cannot enclose the exact motion after that' 'at that time the tube ends$' "$scratch/pole.whirl" --within x=1e9m --within "x'=1e9m/s"
# the first step is already impossible
cat >"$scratch/root.whirl" <<'END'
mechanism root "a force that has no slope at the start"
coordinate x [m]
T = 1 [kg]*x'^2/2
Q(x) = 1 [N]*sqrt(x/1 [m])
scene begins { start x = 0 [m]; step 1 [ms]; until 1 [s] }
END
ended 0 'the proof ends at t = 0 s' 'at that time the tube ends$' "$scratch/root.whirl"
# the run fails first
ended 1 'error: the run diverged in the step after t = 0 s' '^proved until t = 0 s of' tests/mechanisms/kepler.whirl
proved '^proved to the end, t = 10 s$' tests/mechanisms/double_pendulum.whirl # it hangs at rest
for signal in INT TERM; do
    stop $signal "has_bytes 200000 $scratch/i.csv.part" prove thomson_a --csv "$scratch/i.csv"
    [ "$code" -eq 130 ] && grep -q '^whirl prove: interrupted at t = [0-9.]* s of 10 s$' "$scratch/err" &&
        grep -q 'at that time the proof was interrupted$' "$scratch/out" &&
        grep -q "^proved until t = $(tail -n 1 "$scratch/i.csv" | cut -d, -f1) s of 10 s" "$scratch/out"
    verdict $? "$signal: status 130, and what is proved until the last row" "$scratch/out"
    rm -f "$scratch/i.csv"
done

stop INT "has_worked 50" prove thomson_a --until 100000s --effort 1e15 --csv "$scratch/i.csv"
[ "$code" -eq 130 ] && grep -q '^whirl prove: interrupted in the first run, which measures the range' "$scratch/err" &&
    [ ! -s "$scratch/out" ] && [ ! -e "$scratch/i.csv" ]
verdict $? "interrupted before anything is proved: no rows" "$scratch/err"

# --- what is refused -------------------------------------------------------------------------------------------------------
exits 2 'the stop changes the equations' carriage_stop
exits 2 'the hold changes the equations' thomson_magnet
exits 2 'the friction changes the equations' incline_slides
exits 2 'whirl prove has no bounds for abs of a quantity that changes in the run' epicyclic_from_rest --with air_drag
exits 2 'give a number above zero' epicyclic_from_rest --within X=-1mm
exits 2 'give a number above zero' epicyclic_from_rest --within X=0
exits 2 "'Y' is unknown" epicyclic_from_rest --within Y=1mm
exits 2 "'X' is given twice" epicyclic_from_rest --within X=1mm --within X=2mm
exits 2 '--within needs a value' epicyclic_from_rest --within
exits 2 "there is no number 'fixed'" epicyclic_from_rest --number fixed
exits 2 '--csv is given twice' epicyclic_from_rest --csv a --csv b
exits 2 'error: this would take about .*: two runs of .* steps, before the proof' thomson_a --until 1e6s
exits 2 'or --effort [0-9.e+]*$' thomson_a --until 1e6s
exits 2 'takes only one scene' thomson_a thomson_b
exits 2 "unknown option '--plot'" thomson_a --plot x.svg
exits 2 'is not defined here' thomson_a --method leapfrog

exit $failed
