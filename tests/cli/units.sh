#!/bin/sh
# units.sh: quantities are shown in their declared units, everywhere. Coordinates, rates and outputs in random units of all
# names, in CSV, plain columns and summary, are compared with the same mechanism in SI. UNITS_CASES=N makes N mechanisms.
. "$(dirname "$0")/../checks.sh"

seed=${UNITS_SEED:-5}
cases=${UNITS_CASES:-16}
echo "seed $seed"

# "NAME SI VALUE": every unit the language knows, the SI unit of its dimension, and how much of that it is.
"$whirl" list --units 2>"$scratch/err" | sed 1d >"$scratch/names"
[ "$(wc -l <"$scratch/names")" -ge 60 ] && ! grep -qv "^[A-Za-z]*	[A-Za-z1/]*	[0-9.e+-]*$" "$scratch/names"
verdict $? "the program lists its units" "$scratch/names"
# the documents must list the same units in the same order
sed -n 's/^| \(length\|mass\|time\|angle\|frequency.*\|force\|energy.*\|power\|pressure\|current.*\|voltage.*\|capacitance.*\|magnetic.*\|temperature\) | \(.*\) |$/\2/p' \
    docs/language.md | grep -o '`[A-Za-z]*`' | tr -d '`' >"$scratch/documented"
cut -f 1 "$scratch/names" | diff "$scratch/documented" - >"$scratch/err"
verdict $? "docs/language.md lists the same"
# Writes CASES pairs of files, N.declared.whirl and N.si.whirl, that differ only in their declarations.
awk -v seed="$seed" -v cases="$cases" -v folder="$scratch" '
function pick(n) { return int(rand() * n) }
function one(bound,    k, e) { # one more factor of as_is and as_si; each name has its turn
    do { # because coordinates beyond 1e15 are refused
        k = !bound && used < names ? used++ : pick(names)
    } while (bound && name[k] ~ /^[GMnpu]./)
    e = pick(6)
    e = e == 0 ? "^2" : e == 1 ? "^(1/2)" : e == 2 && !bound ? "^-3" : ""
    as_is = as_is name[k] e
    as_si = as_si (si[k] ~ "/" ? "(" si[k] ")" : si[k]) e
}
function some(most,    parts, i, sign) { # some(most): a unit of up to `most` factors
    as_is = as_si = ""
    parts = 1 + pick(most)
    for (i = 0; i < parts; i++) {
        sign = i == 0 ? "" : pick(2) ? "*" : "/"
        as_is = as_is (sign == "" ? "" : (pick(3) ? sign : " " sign " "))
        as_si = as_si sign
        one(most < 3)
    }
}
{ name[NR - 1] = $1; si[NR - 1] = $2; names = NR }
END {
    srand(seed)
    for (n = 0; n < cases; n++) {
        declared = folder "/" n ".declared.whirl"
        plain = folder "/" n ".si.whirl"
        T = V = start = outputs = ""
        print "mechanism m" >declared
        print "mechanism m" >plain
        for (i = 0; i < 6; i++) {
            some(2)
            q = "q" i
            first = i == 0 ? as_is : first
            print "coordinate " q " [" as_is "]" >declared
            print "coordinate " q " [" as_si "]" >plain
            T = T (i ? " + " : "T = ") "1 [J*s^2]*(" q "\047/1 [" as_is "])^2/2"
            V = V (i ? " + " : "V = ") (i + 1) " [J]*(" q "/1 [" as_is "])^2"
            start = start (i ? ", " : "start ") q " = " 0.1 + rand() " [" as_is "]"
            outputs = outputs "output f_" q " = 1 [" as_is "]\n"
        }
        print T "\n" V >declared
        print T "\n" V >plain
        for (i = 0; i < 10; i++) {
            some(3)
            value = " = " rand() - 0.5 " [" as_is "]*cos(q0/1 [" first "])"
            print "output o" i " [" as_is "]" value >declared
            print "output o" i value >plain
            outputs = outputs "output f_o" i " = 1 [" as_is "]\n"
        }
        printf "%s", outputs >declared
        printf "%s", outputs >plain
        print "scene s {\n" start "\nuntil 20 [ms] }" >declared
        print "scene s {\n" start "\nuntil 20 [ms] }" >plain
        close(declared)
        close(plain)
    }
}' "$scratch/names"
verdict $? "mechanisms are made up" "$scratch/names"

# agree DECLARED SI EPSILON: compares the last rows of two runs, in tab-separated columns with a header. f_NAME is the
# SI value of NAME's unit; der(NAME) is in NAME's unit per second.
cat >"$scratch/agree.awk" <<'END'
function abs(x) { return x < 0 ? -x : x }
FNR == 1 { run++; columns[run] = NF; for (i = 1; i <= NF; i++) head[run, i] = $i }
{ for (i = 1; i <= NF; i++) last[run, i] = $i }
function wrong(what) { print what; bad = 1 }
END {
    for (i = 1; i <= columns[2]; i++) { factor[head[2, i]] = last[2, i] }
    for (i = 1; i <= columns[2]; i++) {
        name = head[2, i]
        rate = name ~ /^der/
        base = rate ? substr(name, 5, length(name) - 5) : name
        f = ("f_" base) in factor ? factor["f_" base] : 1
        known = head[1, i]
        if (sub(/\].*/, "", known)) { sub(/ ?\[.*/, "", known) }
        if (known != name) { wrong(head[1, i] " is no " name) }
        has_unit = head[1, i] ~ /\[.*\]$/
        if (has_unit != (abs(f - 1) > 1e-12)) { wrong(head[1, i] ", where one is " f) }
        if (rate && has_unit && head[1, i] !~ /\/s\]$/) { wrong(head[1, i] " is no rate") }
        shown += has_unit
        if (epsilon > 1e-10 && abs(last[2, i]) < 1e-36) { continue } # too small for float
        if (abs(last[1, i]*f - last[2, i]) > epsilon*abs(last[2, i])) {
            wrong(head[1, i] " = " last[1, i] " of " f ", but in SI " last[2, i])
        }
    }
    exit bad || columns[1] != columns[2] || shown < 10
}
END
to_tabs() { tr -d '\r' <"$1" | tr ',' '\t'; }
n=0
while [ $n -lt "$cases" ]; do
    number=double epsilon=1e-14
    [ $((n % 2)) -eq 0 ] || number=float epsilon=2e-7 # f_NAME is then a float
    for kind in declared si; do
        "$whirl" run "$scratch/$n.$kind.whirl" --number $number --csv "$scratch/$kind.csv" \
            --columns "$scratch/$kind.txt" >"$scratch/$kind.out" 2>"$scratch/err" || verdict 1 "case $n runs"
        to_tabs "$scratch/$kind.csv" >"$scratch/$kind.tab"
        sed '1s/^% //' "$scratch/$kind.txt" | tr ' ' '\t' >"$scratch/$kind.columns"
    done
    bad=0
    awk -F '\t' -v epsilon=$epsilon -f "$scratch/agree.awk" "$scratch/declared.tab" "$scratch/si.tab" >"$scratch/why" || bad=1
    # plain columns must be equal, except for the blank before a unit
    sed '1s/ \[/[/g' "$scratch/declared.tab" | cmp -s - "$scratch/declared.columns" || { echo columns >>"$scratch/why"; bad=1; }
    # the summary: compares the last row, with each unit; the motion must be the same to the bit
    awk -F '\t' 'FNR == NR { for (i = 1; i <= NF; i++) { if (FNR == 1) head[i] = $i; else last[i] = $i }; n = NF; next }
        /^  [a-z]/ && seen < n - 1 && state {
            split($0, part, " ")
            i = ++seen + 1
            name = head[i]
            has_unit = sub(/ \[.*/, "", name)
            if (name ~ /^der/) { name = substr(name, 5, length(name) - 5) "\047" }
            unit = head[i]
            gsub(/.* \[|\]$/, "", unit)
            if (part[1] != name || part[2] != last[i] || (has_unit && part[3] != unit)) { print $0 " // " head[i] " = " last[i]; bad = 1 }
        }
        /^final state/ { state = 1 }
        END { exit bad || seen != n - 1 }' "$scratch/declared.tab" "$scratch/declared.out" >>"$scratch/why" || bad=1
    [ "$(grep '^state hash' "$scratch/declared.out")" = "$(grep '^state hash' "$scratch/si.out")" ] || { echo hash >>"$scratch/why"; bad=1; }
    [ $bad -eq 0 ]
    verdict $? "case $n, $number: CSV, columns and summary" "$scratch/why"
    n=$((n + 1))
done

# --- by hand ------------------------------------------------------------------------------------------------
cat >"$scratch/hand.whirl" <<'END'
mechanism hand
coordinate theta [deg]
coordinate z [ mm ]
parameter m = 400 [g]
parameter l = 0.6 [m]
T = m*l^2*theta'^2/2 + m*z'^2/2
output speed [rpm] = theta'
output turned [rev/min] = theta'
output angle [deg] = theta
output energy [J] = m*z'^2/2
output plain = z
scene hand_turning { start theta = 90 [deg], theta' = 90 [rpm], z = 2 [mm], z' = 5 [mm/s]
    until 0 }
END
run() { "$whirl" run "$scratch/hand.whirl" "$@" >"$scratch/out" 2>"$scratch/err"; }
run --quiet --csv "$scratch/h.csv" && printf '%s\r\n' \
    'time,theta [deg],z [mm],der(theta) [deg/s],der(z) [mm/s],speed [rpm],turned [rev/min],angle [deg],energy,plain' \
    '0,90,2,540,5,90,90,90,5.0000000000000004e-06,0.002' | cmp -s - "$scratch/h.csv"
verdict $? "the CSV of a simple case" "$scratch/h.csv"
run && grep -q '^  theta  *90 deg$' "$scratch/out" && grep -q "^  theta'  *540 deg/s\$" "$scratch/out" &&
    grep -q '^  speed  *90 rpm$' "$scratch/out" && grep -q '^  energy  *5.0000000000000004e-06 J$' "$scratch/out" &&
    grep -q '^  plain  *0.002 m$' "$scratch/out"
verdict $? "and its summary" "$scratch/out"
"$whirl" derive "$scratch/hand.whirl:hand" >"$scratch/out" && grep -q '^  coordinate z  *\[mm\]$' "$scratch/out" &&
    grep -q '^  output  *turned  *\[rev/min\]$' "$scratch/out" && grep -q '^  output  *plain  *\[m\]$' "$scratch/out"
verdict $? "derive lists units as declared, without blanks" "$scratch/out"

# a limit without its unit: of a stop and of a crossing, in each unit that is not SI; the hint pasted is taken
awk -F '\t' '$3 != 1 { print $1 }' "$scratch/names" | while read -r unit; do
    for limit in 'stop z <= %s restitution 1' 'stop z >= -%s restitution 1' "when z crosses %s rising { set z' = 0 }"; do
        for given in 30 "30 [$unit]" 0; do
            # shellcheck disable=SC2059 # the limit is a form
            { printf 'mechanism m\ncoordinate z [%s]\nT = 1 [J*s^2]*(z%s/1 [%s])^2/2\n' "$unit" "'" "$unit" && printf "$limit\n" "$given"; } >"$scratch/limit.whirl"
            "$whirl" check "$scratch/limit.whirl" >"$scratch/out" 2>"$scratch/err"
            code=$?
            case $given in
            30) [ $code -eq 2 ] && grep -q "write -\{0,1\}30 \[$unit\]" "$scratch/err" ;;
            *) [ $code -eq 0 ] ;;
            esac || { echo "$unit, $limit, $given" && cat "$scratch/out" "$scratch/err"; }
        done
    done
done >"$scratch/limits"
[ ! -s "$scratch/limits" ]
verdict $? "a limit without its unit is refused, in each unit that is not SI" "$scratch/limits"

# a value without its unit, of each option that takes one; each of the two printed hints, pasted, is accepted
printf '%s\n' 'mechanism m' 'coordinate th [deg]' 'parameter l = 400 [mm]' 'parameter J = 1 [kg*m^2]' "T = J*th'^2/2" 'V = 5 [N]*l*th^2' \
    'effect e { V += 1 [J]*th^2 }' 'scene s { with e; start th = 5 [deg]; step 1 [ms]; until 50 [ms] }' >"$scratch/bare.whirl"
for command in run derive examine sweep map price choose effects trust prove; do
    "$whirl" $command --help >"$scratch/help"
    options_of "$scratch/help" | while read -r option value; do
        of=
        case "$option $value" in
        --set*) value=l=300 ;;
        --start* | *X=*) value="th=1" ;;
        --error*) of='--of th' value=1.5 ;;
        *RANGE) value=th=1..2:2 ;;
        *) continue ;;
        esac
        case "$command $option" in
        map\ --over | sweep\ --s*) of='--over J=1..2:2' ;;
        map*) of='--over J=1..2:2 --over step=1ms..2ms:2' ;;
        choose\ --error) of="--predict $of" ;;
        choose*) of='--predict --error 1e-3' ;;
        esac
        for typed in "$value" 1 2; do
            case $typed in [12]) typed=$(sed -n 's/^hint: "\(.*\)", or in SI: "\(.*\)"$/\'$typed'/p' "$scratch/hint") ;; esac
            "$whirl" $command "$scratch/bare.whirl" $of "$option" "$typed" >"$scratch/out" 2>"$scratch/err"
            code=$?
            [ "$typed" = "$value" ] && mv "$scratch/err" "$scratch/hint" && [ $code -eq 2 ] || [ $code -lt 2 ] ||
                { echo "$command $of $option '$typed': status $code" && cat "$scratch/err"; }
        done
        echo "$command $option" >>"$scratch/asked"
    done
done >"$scratch/hints"
[ ! -s "$scratch/hints" ] && [ "$(sort -u "$scratch/asked" | wc -l)" -ge 20 ]
verdict $? "the hint for a missing unit, pasted, is accepted: $(wc -l <"$scratch/asked") options" "$scratch/hints"
exit $failed
