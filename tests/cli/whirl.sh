#!/bin/sh
# whirl.sh: the command line as a user meets it: help, exit status, messages, records, failed and
# interrupted runs. Nothing that goes wrong may crash, and what was recorded must survive.
set -u

whirl=${WHIRL:-build/whirl}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failed=0

verdict() { # verdict STATUS WHAT
    if [ "$1" -eq 0 ]; then
        echo "ok - $2"
    else
        echo "not ok - $2"
        sed 's/^/    /' "$scratch/out" "$scratch/err" 2>/dev/null | head -n 6
        failed=1
    fi
}

# gives STATUS PATTERN WHAT COMMAND...: exit status, and a line of standard error (2) or output (0)
gives() {
    status=$1 pattern=$2 what=$3
    shift 3
    "$@" >"$scratch/out" 2>"$scratch/err" </dev/null
    got=$?
    stream=err
    [ "$status" -eq 0 ] && stream=out
    [ "$got" -eq "$status" ] && grep -q -e "$pattern" "$scratch/$stream"
    verdict $? "$what"
}

# --- help ---------------------------------------------------------------------------------------
gives 0 '^usage: whirl COMMAND' "whirl --help" "$whirl" --help
gives 0 '^whirl [0-9]' "whirl --version" "$whirl" --version
for command in list derive accel run sweep; do
    gives 0 "^usage: whirl $command" "whirl $command --help" "$whirl" $command --help
done
gives 2 '^usage:' "no command" "$whirl"
gives 2 "did you mean 'run'" "a misspelt command" "$whirl" rum

# --- what there is ------------------------------------------------------------------------------
gives 0 '^scene  *thomson_a ' "list names the scenes" "$whirl" list
gives 0 '^mechanism  *epicyclic ' "list names the mechanisms" "$whirl" list

# --- bad input ----------------------------------------------------------------------------------
gives 2 "did you mean 'thomson_a'" "a misspelt scene" "$whirl" run thomsan_a
gives 2 'no_such.whirl: error: cannot be read' "a missing file" "$whirl" run no_such.whirl
gives 2 'core: error: cannot be read' "a folder" "$whirl" accel core
gives 2 'no scene or mechanism' "a missing scene of a file" "$whirl" run core/models/thomson.whirl:x
gives 2 'more than one scene' "a file with several scenes" "$whirl" run core/models/thomson.whirl
gives 2 'did you mean --method' "a misspelt option" "$whirl" run thomson_a --metod rk4
gives 2 'one of euler' "an unknown method" "$whirl" run thomson_a --method rk5
gives 2 'one of double, float' "an unknown number" "$whirl" run thomson_a --number half
gives 2 'needs a value' "a missing value" "$whirl" run thomson_a --step
gives 2 'whole number of steps' "records off the steps" "$whirl" run thomson_a --every 1.5ms
gives 2 'error' "a step of nothing" "$whirl" run thomson_a --step 0
gives 2 'error' "an end before the start" "$whirl" run thomson_a --until -1s
gives 2 'error' "a step that is a mass" "$whirl" run thomson_a --step "1 [kg]"
gives 2 'error' "an unknown effect" "$whirl" run epicyclic_from_rest --with rail_drug
gives 2 'error' "an unknown parameter" "$whirl" run thomson_a --set q=1
gives 2 'error' "a parameter in a wrong unit" "$whirl" run thomson_a --set "m=1 [m]"
gives 2 'error' "an unknown coordinate" "$whirl" accel core/models/epicyclic.whirl thta=1
gives 2 'cannot be written' "records to nowhere" "$whirl" run thomson_a --csv "$scratch/no/x.csv"
gives 2 '.svg and .png' "a plot of a kind that is not drawn" "$whirl" run thomson_a --plot x.pdf
gives 2 'there is no form' "an unknown form" "$whirl" derive thomson_a --as pascal
gives 2 'does not offer in float' "a function the core has not" \
    "$whirl" run tests/mechanisms/morse.whirl --number float
gives 2 'does not offer on boards' "the same as C" "$whirl" derive tests/mechanisms/morse.whirl --as c

# --- accelerations ------------------------------------------------------------------------------
gives 0 "^theta'' = 3.7037037037037033\$" "accel: M/(4 m r^2 + 4 I) with the arm along the rail" \
    "$whirl" accel core/models/epicyclic.whirl theta=0 M=4
gives 0 "^X'' = " "accel: a line a coordinate" "$whirl" accel core/models/epicyclic.whirl

# --- records ------------------------------------------------------------------------------------
"$whirl" run epicyclic_from_rest --until 0.01s --csv "$scratch/x.csv" --quiet >"$scratch/out" 2>&1
[ ! -s "$scratch/out" ]
verdict $? "--quiet says nothing"
[ "$(head -n 1 "$scratch/x.csv" | tr -d '\r')" = "time,theta,X,der(theta),der(X),projection,x_2,x_cm" ]
verdict $? "the header has FMI's names"
[ "$(wc -l <"$scratch/x.csv")" -eq 12 ] && [ "$(tr -cd '\r' <"$scratch/x.csv" | wc -c)" -eq 12 ]
verdict $? "eleven records of ten steps, lines ended as RFC 4180 says"
"$whirl" run epicyclic_from_rest --until 0.01s --csv - --number float 2>/dev/null | tr -d '\r' |
    awk -F, 'NR > 1 { for (i = 2; i <= NF; i++) { v = $i; gsub(/^-?0*\.?0*|e.*$|[-.]/, "", v)
        if (length(v) > 9) bad = 1 } } END { exit bad || NR != 12 }'
verdict $? "float records have nine significant digits at most"

# --- runs that fail -----------------------------------------------------------------------------
cat >"$scratch/blow.whirl" <<'END'
mechanism blow "a spring with the wrong sign"
coordinate x [m]
parameter m = 1 [kg]
parameter k = 1e6 [N/m]
T = m*x'^2/2
V = -k*x^2/2
scene up { start x = 1 [m]; step 1 [ms]; until 10 [s] }
END
gives 1 'diverged in the step after t = .*hint\|diverged' "a run that diverges says so" \
    "$whirl" run "$scratch/blow.whirl" --csv "$scratch/blow.csv"
grep -q "hint: a smaller --step" "$scratch/err"
verdict $? "and what to try"
tail -n 1 "$scratch/blow.csv" | awk -F, '{ exit !(NF == 3 && $2 + 0 > 1 && $2 !~ /inf|nan/) }'
verdict $? "the records so far are kept and finite"

# --- interrupted --------------------------------------------------------------------------------
"$whirl" run thomson_a --until 100000s --every 100ms --csv "$scratch/long.csv" --quiet 2>/dev/null &
pid=$!
while [ ! -s "$scratch/long.csv" ]; do sleep 0.1; done
kill -INT $pid
wait $pid
[ $? -eq 130 ]
verdict $? "an interrupted run ends with status 130"
awk -F, 'NR > 1 && NF != 11 { bad = 1 } END { exit bad || NR < 2 }' "$scratch/long.csv"
verdict $? "and leaves whole records"
"$whirl" run thomson_a --csv - 2>/dev/null | head -n 1 >"$scratch/out"
grep -q '^time,' "$scratch/out"
verdict $? "a reader that goes away is no accident"

exit $failed
