#!/bin/sh
# price.sh: `whirl price` and `whirl choose --predict` (counts: measure.sh). The error of every row is measured again from
# the row's own command line, against closed forms. Choices are run. Also bad input of every option, and interrupts.
# WHIRL_FEW=1: fewer rows of fewer scenes.
. "$(dirname "$0")/../checks.sh"

usual() { # usual COMMAND...: runs it, except if few cases are wanted
    [ -n "${WHIRL_FEW:-}" ] || "$@"
}

cat >"$scratch/spring.whirl" <<'END'
mechanism spring "a mass on a spring"
coordinate x [m]
input push = 0 [N]
T = 1 [kg]*x'^2/2
V = 64 [N/m]*x^2/2
Q(x) = push
output x_mm [mm] = x
output shaky [m] = 3*x
noise shaky deviation 0.01 [m] seed 3
scene spring_rings { start x = 1 [m]; step 1 [ms]; until 2 [s] }
END
cat >"$scratch/decay.whirl" <<'END'
mechanism decay "what fades away"
state y
equation y' + 2 [1/s]*y = 0
scene decay_fades { start y = 3; step 1 [ms]; until 2 [s] }
END
cat >"$scratch/pendulum.whirl" <<'END'
mechanism pendulum "keeps its energy"
coordinate a [rad]
T = 1 [kg*m^2]*a'^2/2
V = -8 [J]*cos(a)
output energy [J] = a'^2*1 [kg*m^2]/2 - 8 [J]*cos(a)
scene pendulum_swings { start a = 1 [rad], a' = 2 [rad/s]; step 1 [ms]; until 2 [s] }
END

# again TARGET COLUMN FORMULA OPTION...: runs some rows of a table again. COLUMN's largest deviation from FORMULA, a
# function of t, must be the row's error to the printed digits ($scale: the column's size), or at most the row's bound.
# Takes every $every-th row whose command line contains $only.
only=whirl
every=${WHIRL_FEW:+30}
every=${every:-9}
least=${WHIRL_FEW:+2} # smallest number of rows
least=${least:-5}
again() {
    target=$1
    column=$2
    formula=$3
    shift 3
    "$whirl" price "$target" --effort 2e7 "$@" --csv "$scratch/rows.csv" >"$scratch/table" 2>"$scratch/err"
    verdict $? "price $target $*"
    spacing=$(sed -n 's/^  horizon *\([0-9.e-]*\) s, \([0-9]*\) records$/\1 \2/p' "$scratch/table" | awk '{ print $1 / $2 }')
    tr -d '\r' <"$scratch/rows.csv" | awk -F, -v only="$only" -v every="$every" '
        NR == 1 { for (i = 1; i <= NF; i++) { at[$i] = i } next }
        index($(at["run"]), only) && seen++ % every == 0 { print $(at["error"]), $(at["error_bound"]), $(at["step_s"]), $(at["run"]) }' >"$scratch/some"
    rows=0
    bad=0
    while read -r error bound step line; do
        rows=$((rows + 1))
        "$whirl" ${line#whirl } --csv - --quiet 2>/dev/null | tr -d '\r' | awk -F, -v name="$column" -v each="$spacing" \
            -v step="$step" -v wanted="$error" -v bound="$bound" -v digits="$(case $line in *float* | *fixed*) echo 6e-9 ;; *) echo 3e-15 ;; esac)" '
            function abs(v) { return v < 0 ? -v : v }
            NR == 1 { for (i = 1; i <= NF; i++) { if ($i == name) { at = i } } next }
            { t = $1; n = t / (step > each ? step : each); if (abs(n - int(n + 0.5)) > 1e-6) { next }
              records++
              off = abs($at - ('"$formula"')); if (off > worst) { worst = off } }
            END { if (!at || records < 3 || (bound + 0 && worst < wanted ? 0 : abs(worst - wanted)) > 1e-6 * wanted + digits * '"$scale"') {
                printf "%s: %s instead of %s of %d records\n", name, worst, wanted, records; exit 1 } }' >>"$scratch/err" ||
            bad=1
    done <"$scratch/some"
    [ $rows -ge $least ] && [ $bad -eq 0 ]
    verdict $? "$target: $rows rows of $only are off the closed form by what they say"
}
scale=1
again "$scratch/spring.whirl" x 'cos(8 * t)' --of x
scale=8
usual again "$scratch/spring.whirl" 'der(x)' '-8 * sin(8 * t)' --of "x'" --board atmega328p
scale=1000
usual again "$scratch/spring.whirl" 'x_mm [mm]' '1000 * cos(8 * t)' --of x_mm
scale=3
again "$scratch/decay.whirl" y '3 * exp(-2 * t)' --of y
scale=30
usual again spherical_flight z '5 * cos(1.25) + (8 * cos(1.25) + 0.75 * 5 * sin(1.25)) * t - 9.81 * t * t / 2' --of z --horizon 0.25s
scale=10
again "$scratch/pendulum.whirl" energy '2 - 8 * cos(1)' --of energy

# Along the front, prices rise and errors fall. A row beside the front that is as cheap must have a larger error.
awk_front='NR > 1 { e[NR] = $2; p[NR] = $7; f[NR] = $1 }
    END { for (i = 2; i <= NR; i++) { beaten = 0; matched = 0
              for (k = 2; k <= NR; k++) { beaten += p[k] <= p[i] && e[k] < e[i]
                                          matched += k != i && p[k] <= p[i] && e[k] <= e[i] }
              if (f[i] ? beaten : !matched) { print i, e[i], p[i], f[i]; bad = 1 } on += f[i] }
          exit bad || on < 3 }'
check "the front is what nothing beats" awk -F, "$awk_front" "$scratch/rows.csv"

# --- a step as one matrix, and tables: each row is measured again, and such rows exist only for suitable scenes -------
every=${WHIRL_FEW:+80}
every=${every:-29}
only='--tables linear'
again "$scratch/pendulum.whirl" energy '2 - 8 * cos(1)' --of energy
only='--tables cubic'
again "$scratch/pendulum.whirl" energy '2 - 8 * cos(1)' --of energy
scale=1
every=1
only='--number fixed'
scale=3
again "$scratch/decay.whirl" y '3 * exp(-2 * t)' --of y --board mps2-an385-m0
scale=30
again "$scratch/pendulum.whirl" energy '2 - 8 * cos(1)' --of energy --board mps2-an385
awk -F, 'NR > 1 && /--number fixed/ { n++; on += $1; line[n] = $0 } END { exit !(n >= 5 && on >= 3) }' "$scratch/rows.csv"
verdict $? "without an FPU, fixed point is on the front" "$scratch/rows.csv"
scale=1
only='--matrix exact'
again "$scratch/spring.whirl" x 'cos(8 * t)' --of x
# The exact matrix has only round-off errors, with any step. So no row with an error below 1e-6 is cheaper. (Rows are
# sorted by price.)
awk -F, 'NR > 1 && $2 < 1e-6 && !seen++ { exit !($1 == 1 && /--matrix exact/) } END { if (!seen) { exit 1 } }' "$scratch/rows.csv"
verdict $? "the cheapest that is near a linear scene is the exact matrix" "$scratch/rows.csv"
only='--matrix rk4'
again "$scratch/decay.whirl" y '3 * exp(-2 * t)' --of y
# A setting that the scene does not accept is absent, without a message.
cat >"$scratch/root.whirl" <<'END'
mechanism root "a square root has no fixed-point form"
coordinate x [m]
T = 1 [kg]*x'^2/2
V = 9 [N]*sqrt(x^2 + 1 [m^2])
scene root_swings { start x = 1 [m]; step 1 [ms]; until 2 [s] }
END
for scene in "$scratch/root.whirl" ball_bounces; do
    "$whirl" price "$scene" --effort 2e7 --board mps2-an385-m0 --csv "$scratch/p.csv" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 0 ] && ! grep -q -e '--number fixed' "$scratch/p.csv" && ! grep -q 'error:' "$scratch/err"
    verdict $? "$scene has no step in fixed point, which is no error" "$scratch/err"
done
# A motion that leaves its ranges cannot be trusted: it has no row.
sed "s/until 2/range a' = -1 .. 2 [rad\/s]; until 2/" "$scratch/pendulum.whirl" >"$scratch/narrow.whirl"
"$whirl" price "$scratch/narrow.whirl" --effort 2e7 --board mps2-an385-m0 --csv "$scratch/p.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && ! grep -q -e '--number fixed' "$scratch/p.csv" && ! grep -q 'error:' "$scratch/err"
verdict $? "nor where its declared ranges are too small" "$scratch/p.csv"
"$whirl" price "$scratch/pendulum.whirl" --effort 2e7 --csv "$scratch/p.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && ! grep -q -e '--matrix' "$scratch/p.csv" && ! grep -q 'error:' "$scratch/err"
verdict $? "a pendulum has no matrix, which is no error" "$scratch/err"
"$whirl" price "$scratch/spring.whirl" --effort 2e7 --csv "$scratch/p.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && ! grep -q -e '--tables' "$scratch/p.csv" && ! grep -q 'error:' "$scratch/err"
verdict $? "a spring has no tables, which is no error" "$scratch/err"
"$whirl" price "$scratch/spring.whirl" --effort 2e7 --csv "$scratch/p.csv" --quiet >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && grep -q '^front,' "$scratch/p.csv" && [ ! -s "$scratch/out" ]
verdict $? "--quiet says nothing"
"$whirl" price "$scratch/spring.whirl" --effort 2e7 --error 1e-4 2>&1 | grep -A1 '^the cheapest setting within 1e-4' | tail -n 1 |
    grep -q '^  whirl run .* --step '
verdict $? "the cheapest within an error"
for way in '--of x --error 0.1mm' '--error x=0.1mm'; do
    "$whirl" price "$scratch/spring.whirl" --effort 2e7 $way >"$scratch/out" 2>&1
    grep -A1 '^the cheapest setting within' "$scratch/out" | tail -n 1 >>"$scratch/ways"
done
[ "$(sort "$scratch/ways" | uniq -c | awk '{ print $1, $2 }')" = '2 whirl' ]
verdict $? "--error x=0.1mm is --of x --error 0.1mm" "$scratch/ways"
"$whirl" price "$scratch/spring.whirl" --effort 2e7 --error 1e-30 >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'no tried setting has an error below' "$scratch/err"
verdict $? "none within 1e-30: exit status 1"

# --- --vary: the worst place is at an end, and the printed line repeats it ------------------------------------------
"$whirl" price "$scratch/spring.whirl" --of x --effort 1e8 --vary push=0..64 --csv "$scratch/v.csv" >"$scratch/out" 2>"$scratch/err"
verdict $? "price --vary"
grep -q 'worst of 3 combinations of the varied values' "$scratch/out" && grep -q -- '--set push=0' "$scratch/v.csv"
verdict $? "three places, and the worst is named" "$scratch/out"
# the spring is pushed with the force that holds it, so it does not move and has no error: the other end is the worst
awk -F, 'NR > 1 { n++; if ($0 ~ /push=0 /) { zero++ } } END { exit !(n > 10 && zero > 0.9 * n) }' "$scratch/v.csv"
verdict $? "the worst place is where it moves most" "$scratch/v.csv"
# The code of a product has the scene's own values, whichever place is the worst.
awk -F, 'NR > 1 && $NF ~ /--(set|start)/ { bad = 1 } END { exit bad }' "$scratch/v.csv"
verdict $? "the line that writes C changes no value" "$scratch/v.csv"
# The scene's own start is always sampled: the error of a linear spring rises with the distance of its start. Random
# ranges, with the scene's start of 1 m outside, between two places, and at a place.
awk 'BEGIN { srand(71); for (i = 0; i < 6; i++) {
    to = i % 3 == 0 ? 0.2 + 0.7 * rand() : i % 3 == 1 ? 1.2 + rand() : 1
    n = 2 + int(3 * rand()); from = 0.01 + 0.1 * rand()
    print from, to, n, n + (to != 1), (to > 1 ? "far" : "") } }' >"$scratch/ranges"
while read -r from to count places far; do
    "$whirl" price "$scratch/spring.whirl" --of x --method rk4 --effort 2e7 --vary "x=$from..$to:$count" --csv "$scratch/v.csv" >"$scratch/out" 2>&1
    grep -q "worst of $places combinations" "$scratch/out" &&
        awk -F, -v far="$far" 'NR > 1 && $2 > 1e-10 && !/--number/ { n++; own = $(NF - 1) !~ /--start x=/ || $(NF - 1) ~ /--start x=1 /
            if (own == (far != "")) { bad++ } } END { exit n < 5 || bad > 0 }' "$scratch/v.csv"
    verdict $? "--vary x=$from..$to:$count samples the scene's own start as well" "$scratch/out"
done <"$scratch/ranges"

first() { sed -n "s/^$1//p" "$scratch/out" | head -n 1; } # first HEAD: prints the text after it in the first of the two answers

# --- choose: the chosen setting is run ------------------------------------------------------------------------------
for request in '1e-3 200Hz' '1e-2 100Hz' '1e-4 500Hz' '1e-5 1kHz'; do
    [ -z "${WHIRL_FEW:-}" ] || [ "$request" = '1e-3 200Hz' ] || continue
    set -- $request
    "$whirl" choose --predict "$scratch/spring.whirl" --of x --error "$1" --rate "$2" --clock 16MHz --effort 8e7 >"$scratch/out" 2>"$scratch/err"
    verdict $? "choose --error $1 --rate $2"
    line=$(first '  to run *whirl ')
    "$whirl" $line --csv - --quiet | tr -d '\r' | awk -F, -v allowed="$1" '
        function abs(v) { return v < 0 ? -v : v }
        NR == 1 { next } { off = abs($2 - cos(8 * $1)); if (off > worst) { worst = off } n++ }
        END { if (n < 10 || worst * 2 > allowed * 1.02) { print worst, n; exit 1 } }' >"$scratch/err"
    verdict $? "choose --error $1: the line it prints keeps it twice"
    derive=$(first '  to print C *whirl ')
    "$whirl" $derive 2>"$scratch/err" | grep -q 'wh_scene'
    verdict $? "choose --error $1: its code"
    grep -q '^  load  .*%.* of a period of' "$scratch/out" && grep -q '^least flash ' "$scratch/out" &&
        grep -q '^  flash  .*predicted' "$scratch/out"
    verdict $? "choose --error $1: load, flash and the least flash" "$scratch/out"
done
# Without an FPU fixed point is chosen. The printed lines contain everything that its bits depend on.
"$whirl" choose --predict "$scratch/pendulum.whirl" --error 1e-4 --rate 100Hz --effort 8e7 --board mps2-an385-m0 >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && grep -q '^fewest cycles .*--number fixed' "$scratch/out" &&
    grep -q '^  to count .* mps2-an385-m0 fixed .* --until 2$' "$scratch/out"
verdict $? "choose on a Cortex-M0: fixed point" "$scratch/out"
derive=$(first '  to print C *whirl ')
"$whirl" $derive 2>"$scratch/err" | grep -q 'wh_fixed_scene'
verdict $? "and its code"
for effort in 4e5 8e5; do
    "$whirl" choose --predict "$scratch/pendulum.whirl" --effort $effort --error 1e-8 --rate 200Hz >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 1 ] && grep -q '^no setting fits among the tried steps: raise --effort$' "$scratch/out" &&
        grep -q '; for [1-9][0-9]* settings, finer steps need more than one setting.s share of --effort' "$scratch/out"
    verdict $? "settings that take more than --effort $effort are counted" "$scratch/out"
done
# Named methods replace the default ones, and the same effort gives the same table again.
"$whirl" price "$scratch/pendulum.whirl" --effort 2e7 --method rk38,heun --csv "$scratch/m.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && awk -F, 'NR > 1 { n[$13]++ } END { exit !(length(n) == 2 && n["heun"] > 5 && n["rk38"] > 5) }' "$scratch/m.csv"
verdict $? "--method rk38,heun: these two" "$scratch/m.csv"
"$whirl" price "$scratch/pendulum.whirl" --effort 2e7 --method rk38,heun --csv "$scratch/again.csv" --quiet && cmp "$scratch/m.csv" "$scratch/again.csv"
verdict $? "again, to the bit"

# --- contacts: no price on a board, but evaluations that were counted ----------------------------------------------
"$whirl" price ball_bounces --effort 5e7 --csv "$scratch/b.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && grep -q 'eval./s' "$scratch/out" && grep -q 'both compute sines and events like the run' "$scratch/out"
verdict $? "a scene with contacts: by evaluations, and its reference says what it is" "$scratch/out"
awk -F, 'NR > 1 { n++; if ($8 != "evaluations" || $9 != "measured" || !($7 > 0)) { bad = 1 } } END { exit bad || n < 10 }' "$scratch/b.csv"
verdict $? "which are measured" "$scratch/b.csv"

# --- no reference ---------------------------------------------------------------------------------------------------
"$whirl" price incline_sticks >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'no table: without a reliable reference the errors are unknown' "$scratch/out"
verdict $? "where nothing moves there is no front" "$scratch/out"
chaos() {
    "$whirl" price thomson_b --effort 1e7 >"$scratch/out" 2>"$scratch/err"
    grep -q '^  horizon     [2-8][.0-9]* s of 10 s: after .* the two references differ' "$scratch/out"
    verdict $? "chaos cuts the horizon, and it is said how it was found" "$scratch/out"
}
usual chaos

# --- odd input without a mistake -----------------------------------------------------------------------------------------
cat >"$scratch/odd file.whirl" <<'END'
mechanism odd "stays at zero in parts, by rounding alone, and is stiff"
coordinate x [m]
coordinate y [m]
parameter k = 64 [N/m]
T = 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2
V = k*x^2/2 + 64 [N/m]*y^2/2
output zero [m] = x - x
output sum [m] = (x + 0.1 [m]) - x - 0.1 [m]
scene odd_rings { start x = 1 [m]; step 1 [ms]; until 2 [s] }
scene odd_rests { start x = 0 [m]; step 1 [ms]; until 2 [s] }
scene odd_tiny { start x = 1e-12 [m]; step 1 [ms]; until 2 [s] }
END
odd="$scratch/odd file.whirl"
asked() { # asked EXIT-STATUS TEXT WORD...: choose ends in time, prints TEXT, and prints no invalid number
    wanted=$1
    text=$2
    shift 2
    sh tests/limit.sh 120 "$whirl" choose --predict "$@" --effort 2e7 --quiet >"$scratch/out" 2>"$scratch/err" </dev/null
    [ $? -eq "$wanted" ] && cat "$scratch/out" "$scratch/err" | grep -q -e "$text" &&
        ! grep -qiE '[^a-z](nan|inf)[^a-z]' "$scratch/out"
    verdict $? "choose $*: exit status $wanted, $text" "$scratch/out"
}
# an output that stays zero, or is only round-off, suits any setting: its error is relative to the requested one
for output in zero sum y; do
    asked 0 '^fewest cycles' "$odd:odd_rings" --of $output --error 1um
done
asked 0 '^fewest cycles' "$odd:odd_tiny" --error 1e-3
# a motion that every setting computes exactly: its error is a bound, and a worst component is still named
cat >"$scratch/glide.whirl" <<'END'
mechanism glide "straight on, in whole numbers"
coordinate x [m]
T = 1 [kg]*x'^2/2
scene glides { start x = 0 [m], x' = 1 [m/s]; step 1 [ms]; until 1000 [s] }
END
asked 0 '^  error       at most 3.55e-15 of the largest value, measured (x' "$scratch/glide.whirl" --error 1e-3 --rate 1Hz
"$whirl" price "$scratch/glide.whirl" --effort 5e7 --csv "$scratch/g.csv" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && awk -F, 'NR > 1 { n += $2 < 1e-14 && $5 && $6 ~ /^x/ } END { exit !n }' "$scratch/g.csv"
verdict $? "price of a motion without errors names a component" "$scratch/g.csv"
asked 0 '^fewest cycles' "$odd:odd_tiny" --of x --error 1mm
asked 1 'nothing moves' "$odd:odd_rests" --error 1e-3
usual asked 0 'left out .*: X' laskowitz_shifted --error 1e-2 --horizon 0.2s
usual asked 0 '^    "X",$' laskowitz_shifted --error 1e-2 --horizon 0.2s --json
# places of a range at which nothing moves are omitted, and named
asked 0 'left out *combinations in which nothing moves: --start x=0$' "$odd:odd_rings" --error 1e-2 --vary "x=0..1 [m]"
asked 1 'with --start x=0: nothing moves' "$odd:odd_rings" --error 1e-2 --start "x=0 [m]" --vary "x=0..0 [m]:1"
# a component that rests at a single place of a range is kept
cat >"$scratch/two.whirl" <<'END'
mechanism two "one of them may rest"
coordinate x [m]
coordinate y [m]
T = 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2
V = 64 [N/m]*x^2/2 + 64 [N/m]*y^2/2
scene two_ring { start x = 1 [m], y = 1 [m]; step 1 [ms]; until 2 [s] }
END
asked 0 '^fewest cycles' "$scratch/two.whirl" --error 0.1 --vary "x=0..1 [m]"
! grep -q 'left out' "$scratch/out"
verdict $? "what moves at any place counts" "$scratch/out"
# rates that do not divide, that are slower than the motion, or that nothing follows; invalid clocks
for rate in 7Hz 333.333Hz 0.6Hz 123.456789123456Hz; do
    asked 0 '^fewest cycles' "$odd:odd_rings" --error 1e-2 --rate $rate
    step=$(first 'fewest cycles .*--step ')
    inside=$(first '  a period *' | sed 's/ .*//')
    echo "$step $inside ${rate%Hz}" | awk '{ off = $1 * $2 * $3 - 1; exit !(off < 1e-12 && off > -1e-12) }'
    verdict $? "a period of $rate takes whole steps" "$scratch/out"
done
asked 1 'no setting fits among the tried steps: raise --effort' "$odd:odd_rings" --error 1e-2 --rate 1e9Hz
asked 2 'faster than the shortest possible step' "$odd:odd_rings" --error 1e-2 --rate 1e15Hz
asked 2 'one period of --rate' "$odd:odd_rings" --error 1e-2 --rate 1e-15Hz
asked 1 'a clock of' "$odd:odd_rings" --error 1e-2 --clock 1Hz
asked 1 'a clock of' "$odd:odd_rings" --error 1e-2 --clock 1Hz --rate 100Hz
asked 1 'an error of' "$odd:odd_rings" --error 1e-300
asked 0 '^fewest cycles' "$odd:odd_rings" --error 1e300
for horizon in 1ms 1ns; do
    asked 0 '^fewest cycles' "$odd:odd_rings" --error 1e-2 --horizon $horizon
done
# the printed lines work although file and value contain blanks
asked 0 '^fewest cycles' "$odd:odd_rings" --error 1e-3 --rate 100Hz --set 'k=20 [N/m]' --start "x'=3 [m/s]"
again=$(first '  to run *whirl ')
eval "\"$whirl\" $again --quiet --csv $scratch/again.csv" && [ "$(wc -l <"$scratch/again.csv")" -gt 100 ]
verdict $? "a line with blanks runs" "$scratch/out"
# if no single limit can be met, all are named
asked 1 'a clock of' "$odd:odd_rings" --error 1e-3 --rate 100Hz --clock 1kHz --flash 1KB --ram 20B
grep -q 'bytes of flash and .* of RAM with the stack' "$scratch/out" && ! grep -q 'no tried setting' "$scratch/out"
verdict $? "and what all of them would have to be" "$scratch/out"
# with contacts there is no price; the message gives the reason and the alternative
for board in mps2-an386 atmega328p host; do
    asked 1 'the cost of contacts must be counted: leave out --predict' ball_bounces --error 1e-3 --board $board
done

# --- the command that a run prints works, also for a mechanism that does not move, and for two scenes -------------------
named=0
still=0
for target in $("$whirl" list | awk '$1 == "mechanism" { print $2 }') "thomson_a --step 0.1s" ball_bounces; do
    "$whirl" run $target --until 0.1s --board host >"$scratch/run" 2>/dev/null || continue
    command=$(sed -n 's/^accuracy and cost  not shown: .* shows them: whirl //p' "$scratch/run")
    if [ -n "$command" ]; then
        named=$((named + 1))
        eval "\"$whirl\" $command --effort 1e6 --quiet" >"$scratch/out" 2>"$scratch/err"
        verdict $? "the command that the run of $target names works: $command" "$scratch/err"
    fi
    if head -n 1 "$scratch/run" | grep -q '^Nothing moves'; then
        still=$((still + 1))
        grep -q '^accuracy and cost  not shown: nothing moves$' "$scratch/run"
        verdict $? "$target does not move" "$scratch/run"
    fi
done
[ $named -gt 0 ] && [ $still -gt 2 ]
verdict $? "$named runs name a command, $still do not move" "$scratch/run"

# --- bad input -------------------------------------------------------------------------------------------------------
s=$scratch/spring.whirl
for command in price choose; do
    e='--error=1e-3'
    exits 2 'usage: whirl' $command $e
    exits 2 'takes only one scene' $command "$s" other $e
    exits 2 "there is no board 'nix'" $command "$s" $e --board nix
    exits 2 'hint: --board mps2-an386 has the processor' $command "$s" $e --board stm32-h405
    exits 2 'is not an output, coordinate or rate' $command "$s" $e --of y
    exits 2 "did you mean 'x_mm'" $command "$s" $e --of x_mn
    exits 2 "is not an output, coordinate or rate" $command "$s" $e --of "x''"
    exits 2 'has noise' $command "$s" $e --of shaky
    exits 2 'length' $command "$s" --of x --error 1s
    exits 2 'error:' $command "$s" --error 1mm
    exits 2 'above zero' $command "$s" --error=-1
    for blank in =0.1mm " = 1 [mm]"; do exits 2 "a quantity is missing before '='" $command "$s" --error "$blank"; done
    exits 2 'above zero' $command "$s" --error 0
    exits 2 'the motion to compare has a length of 0 s' $command "$s" $e --horizon 0
    exits 2 'is not NAME=FROM..TO' $command "$s" $e --vary push
    exits 2 'error:' $command "$s" $e --vary nothing=1..2
    exits 2 'cannot change the step' $command "$s" $e --vary step=1..2
    exits 2 'the limit of 64' $command "$s" $e --vary push=0..1:100
    exits 2 'already sweeps this name' $command "$s" $e --vary push=0..1 --vary push=0..2
    exits 2 'from 10000 to 1e+15' $command "$s" $e --effort 0
    exits 2 'did you mean --board' $command "$s" $e --bord x
    exits 2 'unknown option' $command "$s" $e --step 1ms
    exits 2 'cannot be' $command "$scratch/none.whirl" $e
done
# An existing file stays if there is no result.
exits 2 'error:' price "$s" --csv "$s"
exits 2 'error is missing' choose "$s"
exits 2 'contradict each other' choose "$s" --error 1e-3 --predict --measure
exits 2 'error:' choose "$s" --error 1e-3 --rate 1ms
exits 2 'above zero' choose "$s" --error 1e-3 --rate 0
exits 2 'number of bytes' choose "$s" --error 1e-3 --flash 32XB
exits 2 'one period of --rate' choose "$s" --error 1e-3 --rate 0.1Hz

# --- interrupted ------------------------------------------------------------------------------------------------------
for signal in INT TERM; do
    stop $signal "has_worked 10" price thomson_b_conserved --effort 5e11 --csv "$scratch/i.csv"
    [ "$code" -eq 130 ] && grep -q '^whirl price: interrupted' "$scratch/err" && [ ! -e "$scratch/i.csv" ]
    verdict $? "price, $signal: exit status 130, and no file is begun"
done
exit $failed
