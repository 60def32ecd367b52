#!/bin/sh
# float_range.sh: warnings about constants and inputs that float cannot represent, and about no others.
. "$(dirname "$0")/../checks.sh"

# model EXPONENT WHAT: a spring of 3eEXPONENT N/m on a kilogram, as a parameter or as an input.
model() {
    echo "mechanism spring
coordinate x [m]
$2 k = 3e$1 [N/m]
T = 1 [kg]*x'^2/2
Q(x) = -k*x
scene a {
  start x = 1 [m]
  step 1 [ms]
  until 2 [ms]
}"
}

wrong=""
for what in parameter input; do
    for exponent in -60 -46 -45 -44 -40 -39 -38 -37 -30 -10 0 10 30 37 38 39 45; do
        model $exponent $what >"$scratch/spring.whirl"
        wanted=0
        [ $exponent -gt -39 ] && [ $exponent -lt 39 ] || wanted=1
        [ $exponent -ne 38 ] || wanted=0 # 3e38 is below 3.4e38
        for command in "run --number float" "run --number float --quiet" "derive --as c"; do
            "$whirl" ${command%% *} "$scratch/spring.whirl" ${command#* } >"$scratch/out" 2>"$scratch/err"
            [ "$(grep -c 'warning: float cannot represent -*3e' "$scratch/err")" -eq $wanted ] ||
                wrong="$wrong $what:$exponent:$command"
        done
        "$whirl" run "$scratch/spring.whirl" --quiet 2>"$scratch/err" # stiff springs diverge
        ! grep -q 'cannot represent' "$scratch/err" || wrong="$wrong $what:$exponent:double"
    done
done
echo "$wrong" >"$scratch/err"
[ -z "$wrong" ]
verdict $? "sizes that float cannot represent are warned of, in runs and in C, and no others"

model -44 parameter >"$scratch/spring.whirl"
for number in float double; do
    "$whirl" sweep "$scratch/spring.whirl" --number $number --over "x=1..2:2" --measure "max(x)" --csv "$scratch/$number.csv" \
        2>"$scratch/$number.err" >"$scratch/out"
done
grep -q 'cannot represent -*3e-44' "$scratch/float.err" && ! grep -q 'cannot represent' "$scratch/double.err"
verdict $? "and in sweeps"

mkdir "$scratch/scenes"
"$whirl" emit-scenes "$scratch/scenes" 2>"$scratch/err" && "$whirl" run springs_ring --number float --quiet 2>>"$scratch/err" &&
    "$whirl" derive thomson_a --as c >"$scratch/out" 2>>"$scratch/err" && [ ! -s "$scratch/err" ]
verdict $? "built-in scenes have room"
exit $failed
