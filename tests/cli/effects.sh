#!/bin/sh
# effects.sh: `whirl effects` at the command line: a user's file, units, effects that did not act, scenes that need an
# effect, printed command lines, errors. build/tests/host effect_subsets checks its figures.
. "$(dirname "$0")/../checks.sh"

cat >"$scratch/cart.whirl" <<'END_OF_FILE'
mechanism cart "Cart on a spring"
coordinate x [mm]
coordinate a [deg]
coordinate b [rad]
T = 2 [kg]*x'^2/2 + 0.1 [kg*m^2]*a'^2/2 + 1 [kg*m^2]*b'^2/2
V = 8 [N/m]*x^2/2 + 9 [J]*(1 - cos(a))
output speed [m/s] = x'
effect drag "on the rail" {
  parameter c = 1e-3 [N*s/m]
  F += c*x'^2/2
}
effect pull { Q(x) += 0.5 [N] }
effect buffer { stop x >= -9 [m] restitution 0.5 }
effect far_spring { V += 5 [N/m]*max(x - 7 [m], 0)^2/2 }
effect weight { V += 3 [J]*(1 - cos(b)) }
effect lift { when x crosses -8 [m] falling { set x' = 0 [m/s] } }
scene swings {
  with drag, pull, buffer, far_spring, weight, lift
  start x = 1 [m], a = 60 [deg]
  step 2 [ms]
  until 3 [s]
}
scene bare { start x = 1 [m]; until 1 [s] }
END_OF_FILE
cart=$scratch/cart.whirl:swings

# ask WORD...: runs `whirl effects`; output in $scratch/out and $scratch/err
ask() { "$whirl" effects "$@" >"$scratch/out" 2>"$scratch/err"; }
# says PATTERN: the output has a line with the pattern
says() {
    grep -qE -- "$1" "$scratch/out"
    verdict $? "the answer has: $1" "$scratch/out"
}
# refused PATTERN HINT WORD...: status 2, pattern and hint on standard error, nothing on standard output
refused() {
    pattern=$1
    hint=$2
    shift 2
    ask "$@"
    [ $? -eq 2 ] && grep -q -- "error: .*$pattern" "$scratch/err" && grep -q -- "$hint" "$scratch/err" && [ ! -s "$scratch/out" ]
    verdict $? "whirl effects $*: $pattern"
}
# row NAME: prints that row's cells, blanks and verdict unchanged
row() { sed -n "s/^$1  *//p" "$scratch/out"; }
# cells ROW WANTED: the row has this text; each # stands for a number
cells() {
    [ "$(row "$1" | sed -E 's/-?[0-9][0-9.e+-]*/#/g; s/ +/ /g')" = "$2" ]
    verdict $? "$1: $2" "$scratch/out"
}

# --- verdicts, units, and the line that runs ------------------------------------------------------------------------
check "a file of one's own" ask "$cart" --error "x=5mm,a'=1deg/s,speed=1"
says '^effect  *x \[mm\]  *a \[deg\]  *b \[rad\]  *a. \[deg/s\]  *speed \[m/s\]  *cycles  *evaluations  *flash \[B\]  *RAM \[B\]  *verdict$'
says '^allowed  *5  *-  *-  *1  *1  *-  *-  *-  *-$'
cells drag '# # # # # # # # # may be left out'
cells pull '# # # # # # # # # needed'
for effect in buffer far_spring weight lift; do
    says "^$effect .* not tested: the effect did not act in this run$"
done
says '^smallest set within the error: pull, buffer, far_spring, weight, lift$'
says '^kept, because this run does not test them: buffer, far_spring, weight, lift$'
run=$(sed -n 's/^  whirl run/run/p' "$scratch/out")
# the differences between the two runs, over all rows, compared with the answer
eval "\"\$whirl\" $run --csv \"\$scratch/less.csv\" --quiet" && "$whirl" run "$cart" --csv "$scratch/all.csv" --quiet
paste -d, "$scratch/all.csv" "$scratch/less.csv" | awk -F, -v told="$(row drag)" '
    NR > 1 { off = $2 - $(NF / 2 + 2); off = off < 0 ? -off : off; most = off > most ? off : most }
    END { printf "%.3g, told %.3g\n", most, told; exit !(most > 0 && sprintf("%.3g", most) == sprintf("%.3g", told + 0)) }' >"$scratch/err"
verdict $? "$run moves x by what the answer says: $(cat "$scratch/err") mm"

check "without --error" ask "$cart"
says '^allowed  *[0-9.]+  *0\.12  *1e-12  *-  *-  *-  *-  0\.1 % of the range$'
ask "$cart" --error x=5mm --set c=2e-3 --until 1.5s --start "a=30 [deg]"
says '^smallest set .*: pull, buffer, far_spring, weight, lift$'
says '^  whirl run .*cart.whirl:swings --start "a=30 \[deg\]" --until 1.5s --without drag$'
ask "$cart" --error x=5mm --set c=20
says '^  whirl run .*cart.whirl:swings --set c=20$'
ask "$scratch/cart.whirl:bare" --with drag,pull --error x=1mm
says '^  whirl run .*cart.whirl:bare --with pull$'
# the printed line names each effect of the smallest set once, for random effects of both scenes
awk -v seed="${WHIRL_SEED:-47}" 'BEGIN { srand(seed); n = split("drag pull buffer far_spring weight lift", name, " ")
    for (i = 0; i < 6; i++) { with = "all"; for (k = 1; k <= n; k++) if (rand() < 0.5) with = with "," name[k]
        if (i % 3) sub(/^all,?/, "", with); print (i % 2 ? "swings" : "bare"), with } }' >"$scratch/drawn"
while read -r scene with; do
    ask "$scratch/cart.whirl:$scene" --until 0.5s ${with:+--with "$with"} --error x=1mm
    run=$(sed -n 's/^  whirl run/run/p' "$scratch/out")
    row 'smallest set within the error:' | sed 's/no effect//; s/, /\n/g' | sort | sed '/^$/d' >"$scratch/set"
    eval "\"\$whirl\" $run" 2>"$scratch/err" | sed -n 's/^  with \([a-z_]*\).*/\1/p' | sort >"$scratch/has"
    cmp -s "$scratch/set" "$scratch/has" && [ -z "$(echo "$run" | tr ' ,' '\n\n' | grep -xE 'drag|pull|buffer|far_spring|weight|lift' | sort | uniq -d)" ]
    verdict $? "$run" "$scratch/out"
done <"$scratch/drawn"

# --- prices -------------------------------------------------------------------------------------------------------------
check "a board that counts no cycles" ask "$scratch/cart.whirl:bare" --with drag --board mps2-an505
says 'price on mps2-an505 \(Cortex-M33\), float, predicted$'
says '^effect .* instructions  *evaluations '
cells drag '# # # # # # # may be left out'
ask "$cart"
cells buffer '# # # - # - - not tested: the effect did not act in this run'
cells drag '# # # # # # # may be left out'

# --- what cannot run without an effect --------------------------------------------------------------------------------------
cat >"$scratch/odd.whirl" <<'END_OF_FILE'
mechanism odd
coordinate x [m]
coordinate y [m]
T = 1 [kg]*x'^2/2
V = 2 [N/m]*x^2/2 - 3 [N/m]*y^2/2
output place [m] = y
effect mass { T += 1 [kg]*y'^2/2 }
effect wall { V += 9 [N/m^3]*y^4/4 }
effect reader { parameter sigma = 0 [m]; noise place deviation sigma seed 1 }
scene s { with mass, wall, reader; start x = 1 [m], y = 0.1 [m]; step 1 [ms]; until 300 [s] }
END_OF_FILE
check "a scene that needs its effects to run" ask "$scratch/odd.whirl" --until 900s --step 10ms
cells mass '- - - - - - needed: no run can start without it'
says '^wall .* needed: the run diverges without it$'
says '^reader .* not tested: the effect did not act'
says '^smallest set within the error: mass, wall, reader$'
ask "$scratch/odd.whirl" --without wall --until 900s --step 10ms
[ $? -eq 1 ] && grep -q '^hint: a smaller --step' "$scratch/err" && grep -q 'with all effects the run diverges' "$scratch/err"
verdict $? "a scene that diverges with all its effects: status 1"

# --- errors ---------------------------------------------------------------------------------------------------------------
refused "'X' is not a coordinate, rate or output of 'cart'" '^hint: --error x=' "$cart" --error X=1mm
refused "'sped' is not a coordinate" '^hint: --error speed=' "$cart" --error sped=1
refused "'x''' is not a coordinate" '^hint: --error' "$cart" --error "x''=1"
refused '--error x has no value' '^hint: --error "x=1e-3 \[mm\]"' "$cart" --error x
refused "'x' is given twice" '^hint: leave one out' "$cart" --error x=1mm,x=2mm
refused 'this is mass' '1kg' "$cart" --error x=1kg
refused 'unit' '^hint: ' "$cart" --error x=1mmm
refused 'a number above zero, not x=-1mm' '' "$cart" --error x=-1mm
refused "no effect is selected in 'bare'" '^hint: --with all, or --with drag' "$scratch/cart.whirl:bare"
refused "no effect is selected in 'two_mass_absolute'" 'docs/effects.md' two_mass_absolute
refused 'the run has no steps, so there is nothing to compare' '^hint: --until 1s' "$cart" --until 0
refused "there is no board 'mps'" '^hint: choose one of' "$cart" --board mps
refused "unknown effect 'darg'" "^hint: did you mean 'drag'" "$cart" --without darg
refused 'no scene' '' "$scratch/cart.whirl:nothing"
"$whirl" help effects | grep -q '^usage: whirl effects' && "$whirl" effects >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q '^usage: whirl effects' "$scratch/err"
verdict $? "whirl help effects; no scene: the usage, status 2"
exit $failed
