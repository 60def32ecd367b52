#!/bin/sh
# command_line.sh: messages and exit status of `whirl`: help, versions, errors in every option, broken mechanisms. Exit
# status 0: done; 2: bad input. Errors go to standard error, with a hint if one helps.
. "$(dirname "$0")/../checks.sh"

regex=-E

# prints PATTERN WORD...: exit status 0, a matching line on standard output, nothing on standard error.
prints() {
    pattern=$1
    shift
    sh tests/limit.sh 60 "$whirl" "$@" >"$scratch/out" 2>"$scratch/err" </dev/null && [ ! -s "$scratch/err" ] &&
        grep -Eq -- "$pattern" "$scratch/out"
    verdict $? "whirl $*: $pattern"
}

# --- help ---------------------------------------------------------------------------------------------
prints '^usage: whirl COMMAND' --help
prints '^usage: whirl COMMAND' -h
prints '^whirl [0-9]+\.[0-9]+\.[0-9]+$' --version
prints '^usage: whirl run' run thomson_a --bogus --help
prints '^whirl [0-9]+\.[0-9]+\.[0-9]+$' version
prints '^usage: whirl COMMAND' help
prints '^scene +thomson_a ' list
exits 2 "unknown command 'frobnicate'" help frobnicate
exits 2 "did you mean 'price'" help prise
! "$whirl" rnu 2>&1 | grep -q '^usage'
verdict $? "a mistyped command is answered by its hint, not by the whole list"

# --- new and check --------------------------------------------------------------------------------------
# A file that `new` writes has no errors, whatever its name. An existing file is kept.
program=$(cd "$(dirname "$whirl")" && pwd)/$(basename "$whirl")
for name in swing A _ x9 "$(printf '%057d' 0 | tr 0 n)"; do
    (cd "$scratch" && "$program" new "$name") >"$scratch/out" 2>"$scratch/err" && [ ! -s "$scratch/err" ] &&
        "$whirl" check "$scratch/$name.whirl" 2>"$scratch/err" | grep -q 'no errors; mechanisms: 1, scenes: 1$' &&
        "$whirl" run "$scratch/$name.whirl" --until 10ms --quiet 2>>"$scratch/err" && [ ! -s "$scratch/err" ]
    verdict $? "whirl new $name, checked and run"
done
cp "$scratch/swing.whirl" "$scratch/before"
(cd "$scratch" && "$program" new swing) >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q '^hint: whirl new swing_2$' "$scratch/err" && cmp -s "$scratch/before" "$scratch/swing.whirl"
verdict $? "whirl new leaves a file that exists as it is"
for name in 1x 'a b' ä a/b a.b '' "$(printf '%058d' 0 | tr 0 n)"; do
    exits 2 'is not a valid name' new "$name"
done
exits 2 '^usage: whirl new' new
exits 2 '^usage: whirl check' check
exits 2 'cannot be read' check "$scratch/nothing.whirl"
# every broken text of tests/bad is refused with its place; good files named beside it are still checked
sh tests/bad.sh "$scratch/bad"
for file in "$scratch"/bad/*; do
    "$whirl" check "$file" "$scratch/swing.whirl" >"$scratch/out" 2>"$scratch/err" </dev/null
    [ $? -eq 2 ] && grep -q "^$file:[0-9]*:[0-9]*: error: " "$scratch/err" && grep -q 'swing.whirl: no errors' "$scratch/out" ||
        echo "$file"
done >"$scratch/accepted"
[ ! -s "$scratch/accepted" ]
verdict $? "whirl check refuses what tests/bad has, by line and column" "$scratch/accepted"
for i in 1 2 3 4 5; do # of these mechanisms, the first, third and fifth cannot be derived
    printf "mechanism m$i\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + $((1 - i % 2))*y'^2)/2\nscene s$i { until 1 [s] }\n"
done >"$scratch/five.whirl"
"$whirl" check "$scratch/five.whirl" 2>&1 | grep -o '^.*five.whirl:[0-9]*:[0-9]*: error' | sed 's/.*whirl//' | tr '\n' ' ' >"$scratch/places"
[ "$(cat "$scratch/places")" = ":3:12: error :13:12: error :23:12: error " ]
verdict $? "whirl check goes on after a mechanism with an error, without its scenes" "$scratch/places"
for scene in 'start y = '-2 'start y = '-0.5 'start y = '0 'start y = '2 'conserve z' 'conserve y' 'conserve y, z'; do
    unit=$(case $scene in start*) echo ' [m]' ;; esac)
    printf "mechanism m\ncoordinate y [m]\ncoordinate z [m]\nT = 1 [kg]*(y'^2 + z'^2)/2\nV = 1 [N]*y\nstop y >= 0\nscene s { %s }\n" \
        "$scene$unit; step 1 [ms]; until 10 [ms]" >"$scratch/start.whirl"
    "$whirl" run "$scratch/start.whirl" >"$scratch/out" 2>"$scratch/runs" </dev/null
    runs=$?
    "$whirl" check "$scratch/start.whirl" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq $runs ] && cmp "$scratch/runs" "$scratch/err" >>"$scratch/out"
    verdict $? "whirl check finds what run refuses: $scene" "$scratch/out"
done
for form in OCTAVE Matlab matlab; do
    "$whirl" derive epicyclic --as octave >"$scratch/octave" && "$whirl" derive epicyclic --as $form | cmp -s - "$scratch/octave"
    verdict $? "--as $form is --as octave"
done
exits 2 '^usage: whirl COMMAND'
exits 2 "did you mean 'derive'" deriv epicyclic
exits 2 "unknown command 'frobnicate'" frobnicate
for command in derive describe accel run; do
    exits 2 "^usage: whirl $command" "$command"
done

# --- the model to work on -----------------------------------------------------------------------------
exits 2 "did you mean 'epicyclic'" derive epicylic
exits 2 '`whirl list` shows' run nosuchthing
exits 2 'no file and no built-in' run ''
exits 2 'nofile.whirl: error: cannot be read: No such file' derive nofile.whirl
exits 2 'error: cannot be read: Is a directory' derive /tmp
for file in /dev/zero /dev/full; do # a file without an end is read up to the limit
    for command in run prove derive describe list; do
        [ ! -c $file ] || exits 2 "$file:1:1: error: the text is longer than" $command $file
    done
done
if [ -r /proc/self/mem ]; then # a file that breaks off while it is read must not be taken for a shorter model
    exits 2 '/proc/self/mem: error: cannot be read: ' run /proc/self/mem
    exits 2 '/proc/self/mem: error: cannot be read: ' list /proc/self/mem
fi
exits 2 'the file has more than one scene' run core/models/thomson.whirl
exits 2 'hint: name one: core/models/thomson.whirl:thomson_a ' run core/models/thomson.whirl:foo
# if a file has several scenes, the message names exactly these; for a mechanism, all its effects
for file in core/models/*.whirl; do
    awk -v file="$file" '/^mechanism/ { mechanisms++; name = $2; effects = "" }
        /^effect/ { effects = effects $2 ", " }
        /^scene/ { scenes = scenes " " file ":" $2; count++ }
        END { print mechanisms, count, name, (effects == "" ? "-" : effects "ledger"); print "hint: name one:" scenes }' "$file" >"$scratch/of"
    read -r mechanisms count name effects <"$scratch/of"
    [ "$mechanisms" -eq 1 ] || continue
    if [ "$count" -gt 1 ]; then
        for command in run describe "derive --as c" "derive --as octave"; do
            "$whirl" $command "$file" >"$scratch/out" 2>"$scratch/err"
            [ $? -eq 2 ] && [ "$(sed -n 2p "$scratch/err")" = "$(sed -n 2p "$scratch/of")" ]
            verdict $? "$command $file: $count scenes are named"
        done
    fi
    if [ "$effects" != - ]; then
        exits 2 "hint: choose one of $effects\$" run "$file:$name" --with zzzzzzzzz
    fi
done
prints 'no scene was named: every coordinate and rate without --start starts at zero' run core/models/thomson.whirl:thomson --until 2ms
exits 2 'this text contains no mechanism' derive -
exits 2 "the command takes only one scene or mechanism: 'thomson' is a second one" derive epicyclic thomson
exits 2 "the command takes only one scene: 'thomson_b' is a second one" run thomson_a thomson_b
prints '^thomson_a: ' run core/models/thomson.whirl:thomson_a --until 2ms
prints '^thomson_a: ' run thomson:thomson_a --until 2ms
prints '^mechanism thomson' derive thomson:thomson_a
prints "^theta1'' = " accel thomson:thomson_a
prints '^  mechanism thomson of core/models/thomson.whirl, model hash 0x' describe thomson:thomson_a
prints '^  "method": "heun",$' describe thomson_a --json --method heun
prints '^  "compensated": true,$' describe thomson_a --json --compensated
prints '^    "asked": true,$' describe thomson_a --json --with ledger
exits 2 "the command takes only one scene or mechanism: 'thomson' is a second one" describe epicyclic thomson
exits 2 'did you mean --json' describe epicyclic --jsn
exits 2 "there is no method 'foo'" describe epicyclic --method foo
prints '^start[(]theta1[)],' sweep thomson:thomson_a --until 2ms --over theta1=0..1:2 --quiet
exits 2 "no built-in scene or mechanism 'thomson:foo'" run thomson:foo
"$whirl" accel - x=0.5 <<'END' >"$scratch/out" 2>"$scratch/err"
mechanism oscillator
coordinate x [m]
T = 2 [kg]*x'^2/2
V = 8 [N/m]*x^2/2
END
[ "$(cat "$scratch/out")" = "x'' = -2" ]
verdict $? "a mechanism from standard input"

# --- options ------------------------------------------------------------------------------------------
exits 2 "unknown option '--metod'" run thomson_a --metod rk4
exits 2 'hint: did you mean --method' run thomson_a --metod rk4
exits 2 'hint: whirl run --help lists' run thomson_a --bogus
exits 2 'whirl list: error: unknown option' list --all
exits 2 "there is no form 'fortran'" derive epicyclic --as fortran
exits 2 'hint: choose one of text, latex, octave, c' derive epicyclic --as fortran
exits 2 "there is no method 'rk5'" run thomson_a --method rk5
methods_of() { # prints the words of the matching rows of core/method.h
    sed -n "s/^ *X(WH_[A-Z0-9_]*, \"\([a-z0-9-]*\)\", .*$1.*/\1/p" core/method.h
}
methods=$(methods_of WH_ | tr '\n' ',' | sed 's/,$//; s/,/, /g')
of_any=$(methods_of WH_ANY_SYSTEM | tr '\n' ',' | sed 's/,$//; s/,\([^,]*\)$/ or \1/; s/,/, /g')
exits 2 "hint: choose one of $methods$" run thomson_a --method rk5
# a method that the form does not accept is refused before anything runs, with its place and a remedy
for command in run "sweep --over step=1..2[ms]:2" "derive --as c"; do
    exits 2 "lorenz.whirl:2:7: error: semi-implicit Euler is not defined here: 'x' is of order 1" $command \
        tests/mechanisms/lorenz.whirl --method semi-implicit-euler
    exits 2 "hint: .* choose --method $of_any$" $command tests/mechanisms/lorenz.whirl --method semi-implicit-euler
done
# compositions do not accept accelerations that depend on rates
for command in run "sweep --over step=1..2[ms]:2" "derive --as c"; do
    exits 2 "epicyclic.whirl:[0-9:]* error: leapfrog is not defined here: the accelerations depend on the rate of 'theta'" \
        $command epicyclic_conserved --method leapfrog
    exits 2 "error: leapfrog is not defined with contacts" $command ball_bounces --method leapfrog
    exits 2 "error: leapfrog is not defined with a ledger" \
        $command mk/price/separable.whirl --with ledger --method leapfrog
    exits 2 "hint: .* choose --method euler, semi-implicit-euler, heun, .* or nystroem5$" \
        $command epicyclic_conserved --method leapfrog
    exits 2 "error: leapfrog is not defined here: 'x' is of order 1" $command tests/mechanisms/lorenz.whirl \
        --method leapfrog
done
prints 'leapfrog, double' run mk/price/separable.whirl --method leapfrog --until 100ms
prints 'semi-implicit Euler, double' run epicyclic_from_rest --method semi-implicit-euler --until 100ms
prints '^system lorenz' derive tests/mechanisms/lorenz.whirl --method semi-implicit-euler
exits 2 'hint: choose one of double, float' run thomson_a --number half
exits 2 "hint: --as VALUE" derive epicyclic --as

exits 2 "'q' is unknown in mechanism 'thomson'" run thomson_a --set q=3
exits 2 'hint: write NAME=VALUE' run thomson_a --set m
exits 2 'division by zero' run thomson_a --set m=1/0
exits 2 "'sqrt' of a negative|not a finite number|finite" run thomson_a --set 'm=sqrt(-1)'
exits 2 "unknown name 'nan'" run thomson_a --set m=nan
exits 2 "unknown name 'inf'" run thomson_a --until inf
exits 2 'too large' run thomson_a --set m=1e400
exits 2 "'foo' is unknown" run thomson_a --start foo=1
exits 2 "unknown effect 'spin'" run thomson_a --with spin
# parameters and inputs of an effect can be changed only if the effect takes part
for call in 'run --set b=1' 'derive --set b=1' 'sweep --over b=1..2:2' 'sweep --over X=0..0:1 --set b=1'; do
    exits 2 "'b' belongs to the effect 'rail_drag', which is not selected here" $call epicyclic_from_rest
    exits 2 'hint: add --with rail_drag' $call epicyclic_from_rest
    exits 2 "'b' belongs to the effect" $call epicyclic_rail_drag --without rail_drag
    check "$call --with E: accepted" "$whirl" $call epicyclic_from_rest --with ' rail_drag , ledger'
done
exits 2 "'b' belongs to the effect 'rail_drag'" accel epicyclic b=1
exits 2 'hint: name a scene that selects rail_drag' accel epicyclic_from_rest b=1
prints "^X'' = " accel epicyclic_rail_drag b=1
for list in '' ' ' , 'rail_drag,' ',rail_drag' 'rail_drag, ,ledger'; do
    exits 2 'a name is missing in --with "' run epicyclic_from_rest --with "$list"
    exits 2 'a name is missing in --without "' sweep epicyclic_rail_drag --over X=0..0:1 "--without=$list"
done
exits 2 'step must be above zero' run thomson_a --step -1ms
exits 2 'until must be at most 1e\+18 s, and this is 1e\+300 s' run thomson_a --until 1e300
exits 2 'a step must be from 1e-18 s to 1e\+18 s, and this is 1e-300 s' run thomson_a --step 1e-300
exits 2 'more than 2\^63 steps of 1e-09 s' run thomson_a --step 1ns --until 1e11
exits 2 "hint: use a larger 'step' or an earlier 'until'" run thomson_a --step 1ns --until 1e11
exits 2 "hint: use a later 'until' or a shorter 'step'" run thomson_a --until 1s --step 3s
prints ', 0 steps to t = 0 s' run thomson_a --until 0
prints ', 1 steps to t = 3 s' run ball_elastic --until 3s --step 3s
# the number of steps is the nearest integer; a tie gives the lower one
prints ', 1000 steps to t = 1 s' run ball_elastic --until 1.0005s --step 1ms
prints ', 1001 steps to t = 1.001 s' run ball_elastic --until 1.0007s --step 1ms
# numbers of steps beyond 32 bits: a year at 1 ms, 50 years at 1 ns
prints 'steps = UINT64_C\(31536000000\),' derive ball_elastic --as c --step 1ms --until 31536000s
prints 'step = \{UINT64_C\(1\), UINT64_C\(1000000000\)\},' derive ball_elastic --as c --step 1ns --until 1577880000s
prints 'steps = UINT64_C\(1577880000000000000\),' derive ball_elastic --as c --step 1ns --until 1577880000s
prints ', 100 steps to t = 0.01 s' run ball_elastic --until 10ms --step 0.1ms --every 0.5ms --vcd /dev/null
exits 2 '--every needs records' run epicyclic_from_rest --every 2ms
exits 2 'hint: --strict=off or --strict=1e-6' run epicyclic_from_rest --strict 1e-3
exits 2 'hint: whirl run --help lists the options' run epicyclic_from_rest --
exits 2 "--over sweeps 'm', but --set sets it, too" sweep epicyclic_from_rest --over m=1..2:2 --measure theta --set m=3
exits 2 '--every 1.5ms is not a multiple of the step' run epicyclic_from_rest --every 1.5ms
exits 2 'hint: use a multiple of 0.001 s' run epicyclic_from_rest --every 1.5ms
exits 2 '--every 0 is not a multiple' run thomson_a --every 0
exits 2 "--every '-1ms' is not a time" run thomson_a --every -1ms
exits 2 "--every 'often' is not a time" run thomson_a --every often
# An output that cannot be opened is bad input, found before any work. One that cannot be written is a failure.
mkdir "$scratch/folder.svg" "$scratch/late.toml"
exits 1 'late.toml: error: cannot be written' run epicyclic_from_rest --until 20ms --csv "$scratch/late"
[ ! -c /dev/full ] || ln -s /dev/full "$scratch/full.svg"
map='map --over step=1ms..2ms:2 --over m=1..2:2'
for words in 'run --csv' 'run --columns' 'run --vcd' 'run --plot' 'plot --out' 'sweep --over step=1ms..2ms:2 --csv' "$map --csv" "$map --plot" \
    'price --csv' 'trust --csv' 'prove --csv' 'derive --as c --header'; do
    exits 2 '/nonexistent/x.svg: error: cannot be written' $words /nonexistent/x.svg epicyclic_from_rest --until 20ms
    exits 2 "^hint: mkdir -p '/nonexistent/a b'\$" $words "/nonexistent/a b/x.svg" epicyclic_from_rest --until 20ms
    exits 2 'folder.svg: error: cannot be written' $words "$scratch/folder.svg" epicyclic_from_rest --until 20ms
    [ ! -c /dev/full ] || exits 1 'full.svg' $words "$scratch/full.svg" epicyclic_from_rest --until 20ms
done
ln -s /nonexistent/deep/x.csv "$scratch/x.csv"
for folder in -no "it's" "$scratch"; do # two names that the hint would have to escape; a folder that exists
    "$whirl" run epicyclic_from_rest --until 20ms --csv "$folder/x.csv" >"$scratch/out" 2>&1
    [ $? -eq 2 ] && ! grep -q hint "$scratch/out"
    verdict $? "$folder: no mkdir that would fail or not help" "$scratch/out"
done
printf "mechanism m\\ncoordinate x [m]\\nT = 1 [kg]*x'^2/2\\nV = 50 [N/m]*x^2\\nscene s { start x = 1 [m]; step 10 [ms]; until 2 [s] }\\n" >"$scratch/osc.whirl"
"$whirl" run "$scratch/osc.whirl" --strict=1e-9 --json >"$scratch/out" 2>"$scratch/err"
[ $? -eq 1 ] && ! grep -q '(tried)' "$scratch/err" && grep -q '"error": "the energy balance fails' "$scratch/out"
verdict $? "a limit of --strict: the error in --json, and no remedy that was tried for other limits" "$scratch/err"
for many in 2 5 9; do # records until the first output is finite; the second never is
    printf 'mechanism m\ncoordinate x [m]\nT = 1 [kg]*x%s^2/2\noutput a = 1/max(0, x/1 [m] - %s.5)\noutput b = sqrt(-1 - (x/1 [m])^2)\nscene s { start x%s = 1 [m/s]\nstep 1 [s]\nuntil 20 [s] }\n' \
        "'" $((many - 1)) "'" >"$scratch/two.whirl"
    exits 1 "and in $((many - 1)) more records. the output 'a'" run "$scratch/two.whirl" --csv "$scratch/two.csv"
done
for plot in x.gif '' -; do
    exits 2 "plot draws .svg, .pdf and .png files, not '$plot'" run thomson_a --plot "$plot"
done
exits 2 'error' accel epicyclic theta
exits 2 "unknown option '--angles'" accel epicyclic --angles lookup
exits 2 "there is no form of angles 'sideways'" run epicyclic --angles sideways
exits 2 "unknown option '--tables'" accel epicyclic --tables linear
exits 2 "there is no form of tables 'square'" run epicyclic_from_rest --tables square
for cells in 100 4 131072 0 -8 64.5 6x4 "" 99999999999999999999; do
    exits 2 "error: --cells .*$cells.*" run epicyclic_from_rest --tables linear --cells "$cells"
done
for command in run describe "derive --as c"; do
    exits 2 'error: --cells sets the size of tables' $command epicyclic_from_rest --cells 64
    exits 2 "thomson.whirl:22:12: error: --tables: the accelerations of 'thomson' depend on the sines of more than one turn angle, such as 'theta1'" $command thomson_a --tables cubic
done
exits 2 'contacts.whirl:23:3: error: --tables: a scene with events cannot use tables' run ball_bounces --tables linear
prints 'theta' derive epicyclic --as latex --tables cubic # its equations are the same
prints '"form": "cubic",' describe epicyclic_from_rest --json --tables cubic
prints '"cells": 256,' describe epicyclic_from_rest --json --tables linear
prints '^  "tables": null,' describe epicyclic_from_rest --json
exits 2 "'thetta' is unknown" accel epicyclic thetta=1

# --- what cannot be derived or run --------------------------------------------------------------------
exits 2 'core/models/epicyclic.whirl:[0-9]+:11: error: singular mass matrix' derive epicyclic --set m=0
for file in "$scratch"/bad/derive_*; do
    place=$(sed -n '1s/^# expect: \([0-9]*:[0-9]*\): .*/\1/p' "$file")
    [ -n "$place" ] || place='no expectation on the first line'
    for call in derive describe accel run; do
        exits 2 "$file:$place: error: " "$call" "$file"
    done
done
prints 'state hash' run tests/mechanisms/morse.whirl --number float
prints 'wh_exp\(' derive tests/mechanisms/morse.whirl --as c
prints '^function dy = ' derive tests/mechanisms/morse.whirl --as octave

# --- files that are read are not written ------------------------------------------------------------------
cat >"$scratch/own.whirl" <<'END'
mechanism own "a mass on a spring"
coordinate x [m]
T = 2 [kg]*x'^2/2
V = 8 [N/m]*x^2/2
output rate [kg*m/s^3] = 8 [N/m]*x'
scene own_swings { start x = 1 [m]; step 10 [ms]; until 0.1 [s] }
END
cp "$scratch/own.whirl" "$scratch/kept"
cp "$scratch/own.whirl" "$scratch/own.svg"
ln -s own.whirl "$scratch/soft"
ln "$scratch/own.whirl" "$scratch/hard"
own=$scratch/own.whirl:own_swings
for file in own.whirl ./own.whirl soft hard; do
    for option in --csv --columns; do
        exits 2 "error: $option would overwrite $scratch/own.whirl, which whirl reads" run "$own" "$option" "$scratch/$file"
    done
done
exits 2 'hint: give the output another name' run "$scratch/soft:own_swings" --csv "$scratch/hard"
exits 2 'error: --plot would overwrite .*own.svg' run "$scratch/own.svg" --plot "$scratch/own.svg"
cp "$scratch/own.whirl" "$scratch/x.sweep"
exits 2 'error: --csv would overwrite .*x.sweep' \
    sweep "$scratch/x.sweep" --over x=1..2:2 --csv "$scratch/x"
"$whirl" run - --csv "$scratch/own.whirl" <"$scratch/own.whirl" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'would overwrite /dev/stdin, which whirl reads' "$scratch/err"
verdict $? "nor is what standard input reads"
cmp -s "$scratch/own.whirl" "$scratch/kept" && cmp -s "$scratch/own.svg" "$scratch/kept" &&
    cmp -s "$scratch/x.sweep" "$scratch/kept"
verdict $? "the models are as they were"
# Each output, with the files beside it, is apart from each other output and from what is read.
for ending in '' .part .toml .toml.part .sweep; do
    beside=$scratch/b.svg$ending
    for one in --csv --columns --vcd --plot; do
        for other in --csv --columns --vcd; do
            [ $one = $other ] || exits 2 "error: --[a-z]* and --[a-z]* cannot share a file" run "$own" $one "$scratch/b.svg" $other "$scratch/./b.svg$ending"
        done
    done
    exits 2 'error: --csv and --plot cannot share a file' map "$own" --over x=1..2:2 --over step=1ms..2ms:2 --plot "$scratch/b.svg" --csv "$beside"
    exits 2 'error: --csv and --vcd cannot share a file' monitor "$scratch/kept" --vcd "$scratch/b.svg" --csv "$beside"
    exits 2 'error: --csv and --tape cannot share a file' pil "$own" --firmware "$scratch/kept" --csv "$scratch/b.svg" --tape "$beside"
    cp "$scratch/kept" "$beside"
    for command in run trust prove price 'sweep --over x=1..2:2' 'map --over x=1..2:2 --over step=1ms..2ms:2'; do
        exits 2 "error: --csv would overwrite $beside" $command "$beside" --csv "$scratch/b.svg"
    done
    exits 2 "error: --csv would overwrite $beside" pil "$own" --firmware "$beside" --csv "$scratch/b.svg"
    exits 2 "error: --raw would overwrite $beside" monitor "$beside" --raw "$scratch/b.svg"
done
exits 2 'error: --csv and --columns cannot share a file' run "$own" --csv - --columns -
echo >"$scratch/b"
ln "$scratch/b" "$scratch/c"
exits 2 'error: --csv and --columns cannot share a file' run "$own" --csv "$scratch/b" --columns "$scratch/c"
prints '^own_swings$' run "$own" --csv /dev/null
prints '^  rate +[-0-9.e]+ kg\*m/s\^3$' run "$own"

# --- statements with a better form ----------------------------------------------------------------------------
cat >"$scratch/hand.whirl" <<'END'
mechanism hand "friction by hand"
coordinate x [m]
T = 2 [kg]*x'^2/2
Q(x) = -3 [N]*sign(x')
END
for call in 'run' 'derive' 'sweep --over x=0..1:2 --until 1s'; do
    exits 0 "hand.whirl:4:1: note: this force changes its sign with x'" $call "$scratch/hand.whirl"
done
exits 0 'hint: write dry friction as: friction x static EXPR kinetic EXPR normal EXPR' run "$scratch/hand.whirl"
"$whirl" run "$scratch/hand.whirl" --quiet >"$scratch/out" 2>"$scratch/err"
[ $? -eq 0 ] && [ ! -s "$scratch/err" ]
verdict $? "--quiet says nothing of it"

# --- impossible starts ----------------------------------------------------------------------------------
cat >"$scratch/starts.whirl" <<'END'
mechanism starts "distances without a unit, and without end"
coordinate x [m]
coordinate n
T = 2 [kg]*x'^2/2 + 1 [J*s^2]*n'^2/2
stop 1/(1 [m] + x) >= 0.5 [1/m] restitution 0
stop n <= 2 restitution 0
END
exits 2 'starts.whirl:6:1: error: the run starts beyond this stop, by 1.5$' run "$scratch/starts.whirl" --start n=3.5
exits 2 'starts.whirl:5:1: error: the run starts beyond this stop, by 0.25 1/m$' run "$scratch/starts.whirl" --start x=3
exits 2 'starts.whirl:5:1: error: the distance to this stop is not a finite number where the run starts' \
    run "$scratch/starts.whirl" --start x=-1
exits 2 'error: the run starts beyond this stop' run "$scratch/starts.whirl" --start x=-1.5
exits 2 'error: a restitution is from 0 to 1, and this is 1.5' run "$scratch/bad/contact_input_restitution.whirl"
prints '^ball: ' run "$scratch/bad/contact_input_restitution.whirl" --set e=0.5 --until 1s
exits 2 'contacts.whirl:[0-9]+:[0-9]+: error: the run starts beyond this stop, by 0.25 m' run ball_bounces --start z=-0.25
exits 0 "" run ball_bounces --start z=0 --until 10ms --csv -

# --- sources of sines; a wheel that becomes too fast for turned sines keeps running -------------------------
cat >"$scratch/wheel.whirl" <<'END'
mechanism wheel
coordinate b [rad]
coordinate a [rad]
T = 1 [kg*m^2]*(a'^2 + b'^2)/2
V = 0.1 [J]*cos(a)
Q(a) = 3 [kN*m]
scene spin { start b' = 2 [rad/s]; step 1 [ms]; until 0.5 [s] }
END
prints '^spin$' run "$scratch/wheel.whirl"
prints '^spin$' run "$scratch/wheel.whirl" --number float
prints '^spin$' run "$scratch/wheel.whirl" --angles lookup
prints '^spin$' run "$scratch/wheel.whirl" --start "a'=1000"
exits 2 "there is no form of angles 'looked'" run "$scratch/wheel.whirl" --angles looked
prints '^  "sines": "turned",$' describe "$scratch/wheel.whirl" --json
prints '^  "sines": "lookup",$' describe "$scratch/wheel.whirl" --json --angles lookup
prints '^  "sines": "turned",$' describe "$scratch/wheel.whirl" --json --start "a'=3000"
exits 2 "there is no matrix 'exactly'" run two_mass_relative --matrix exactly
exits 2 "5:1: error: line 5 makes 'spin' nonlinear" describe "$scratch/wheel.whirl" --matrix exact
prints '^  "matrix": "none",$' describe two_mass_relative --json
prints '^  "matrix": "rk4",$' describe two_mass_relative --json --matrix rk4
prints '^  Phi  *X  *Y  *X. *Y.$' derive two_mass_relative --matrix exact
prints '^function .Phi, Gamma, g0. = two_mass_relative..$' derive two_mass_relative --matrix exact --as octave
prints 'sines of turn angles: looked up once per step, then rotated' describe "$scratch/wheel.whirl"

# --- float angles that turn too slowly ------------------------------------------------------------------
cat >"$scratch/rotor.whirl" <<'END'
mechanism rotor
coordinate a [rad]
coordinate b [rad]
T = 1 [kg*m^2]*(a'^2 + b'^2)/2
scene drift { start a' = 1e-7 [rad/s], b' = 3 [rad/s]; step 1 [ms]; until 3 [s] }
END
exits 0 "note: 'a' turns so slowly .* an error of up to 3e-07 rad \(100 % of its true change, 3e-07 rad\)" run "$scratch/rotor.whirl" --number float
exits 0 '^hint: use --compensated or' run "$scratch/rotor.whirl" --number float
exits 0 "note: 'a' turns so slowly" run "$scratch/rotor.whirl" --number float --quiet
prints 'float' run "$scratch/rotor.whirl" --number float --compensated
prints 'float' run "$scratch/rotor.whirl" --number float --start "a'=0.1"
prints 'double' run "$scratch/rotor.whirl"
! "$whirl" run "$scratch/rotor.whirl" --number float 2>&1 | grep -q "note: 'b'"
verdict $? "nothing is said of an angle that is fast"

# --- energy that --stabilized restores ------------------------------------------------------------------
prints '^  Runge-Kutta 4 compensated, stabilized, float, step' run docs/hard/long.whirl:gear_turns --number float --compensated --stabilized
prints '^energy balance' run docs/hard/long.whirl:pendulum_swings --stabilized
prints '^  "stabilized": true,$' describe docs/hard/long.whirl:gear_turns --json --stabilized
prints '^    .stabilized = true,$' derive docs/hard/long.whirl:gear_turns --as c --stabilized
prints 'Runge-Kutta 4 stabilized, double' trust docs/hard/long.whirl:pendulum_swings --stabilized --until 2s
exits 2 "contacts.whirl:[0-9]+:[0-9]+: error: --stabilized would undo the energy changes at the events of 'ball'" run ball_bounces --stabilized
exits 2 "error: --stabilized corrects .* 'lorenz' is given by equations" run "tests/mechanisms/lorenz.whirl" --stabilized
exits 2 'thomson.whirl:[0-9]+:[0-9]+: error: --stabilized is for motion without drive or damping, but this statement drives or damps' run thomson_a --stabilized
exits 2 "error: --stabilized needs a ledger, which is not possible with leapfrog" run docs/hard/long.whirl:pendulum_swings --stabilized --method leapfrog
exits 2 "error: --stabilized corrects an energy drift, but with semi-implicit Euler" run docs/hard/long.whirl:pendulum_swings --stabilized --method semi-implicit-euler
prints '^  energy correction \(--stabilized\) ' run docs/hard/long.whirl:gear_turns --stabilized
exits 2 'error: --stabilized needs the stages of a step' run two_mass_relative --stabilized --matrix exact
exits 2 'error: there is no --stabilized in fixed point' run docs/hard/long.whirl:gear_turns --stabilized --number fixed
exits 2 '^whirl price: error: ' price epicyclic_conserved --stabilized

# --- plots --------------------------------------------------------------------------------------------
if command -v gnuplot >/dev/null 2>&1; then
    for kind in svg png; do
        "$whirl" run epicyclic_from_rest --until 50ms --quiet --plot "$scratch/a b'\".$kind" \
            >"$scratch/out" 2>"$scratch/err"
        [ -s "$scratch/a b'\".$kind" ] && [ ! -s "$scratch/err" ]
        verdict $? "--plot FILE.$kind"
    done
fi

# --- an option given twice: one of the values would be lost ---------------------------------------------------------
for command in run derive price choose sweep map; do
    "$whirl" $command --help | grep -oE '^ +--[a-z-]+( [^ ]|=)|^ *--.*as for|--[a-z]+' | grep -oE -- '--[a-z]+' | sort -u |
        grep -vxE -- '--(set|start|with|without|over|measure|vary|help|quiet|strict|compensated|stabilized|all|resume|force|dry|steps|ranges)' >"$scratch/options"
    twice=0
    while read -r option; do
        "$whirl" $command epicyclic_from_rest "$option" 1 "$option=1" >"$scratch/out" 2>"$scratch/err"
        status=$?
        if grep -q 'is given twice' "$scratch/err"; then
            [ $status -eq 2 ] && grep -q '^hint: ' "$scratch/err" && twice=$((twice + 1))
        else # otherwise its value was wrong before, or it takes no value
            [ $status -eq 2 ] || echo "$command $option: $status" >>"$scratch/passed"
        fi
    done <"$scratch/options"
    [ $twice -ge 3 ] && [ ! -s "$scratch/passed" ]
    verdict $? "$command: $twice options, each refused where it is given twice" "$scratch/passed"
done
exits 2 '--step is given twice' run epicyclic_from_rest --step 1ms --until 1s --step=2ms
exits 2 '--csv is given twice' run epicyclic_from_rest --csv "$scratch/a" --csv "$scratch/b"
exit $failed
