#!/bin/sh
# interrupt.sh: real signals interrupt `whirl run`, `whirl sweep` and `whirl map`: exit status 130, a message about the
# point reached, and whole records and summary up to it.
. "$(dirname "$0")/../checks.sh"

# said FILE END: standard error names the time of the last record and the end, and nothing else.
said() {
    last=$(tail -n 1 "$1" | tr -d '\r' | sed 's/[, ].*//')
    printf 'whirl run: interrupted at t = %s s of %s s; the records so far are kept\n' "$last" "$2" >"$scratch/wanted"
    cmp -s "$scratch/wanted" "$scratch/err"
}

# whole FILE SEPARATOR STEP: each record has all columns, at a step after the one before.
whole() {
    tr -d '\r' <"$1" | awk -F"$2" -v step="$3" '
        /^%/ { next }
        NR == 1 { columns = NF; next }
        NF < 5 || (columns && NF != columns) { bad = 1 }
        { late = $1 - seen * step; if (late > 1e-9 * (1 + $1) || late < -1e-9 * (1 + $1)) bad = 1; seen++ }
        END { exit bad || seen < 100 }'
}

for signal in INT TERM; do
    for quiet in '' --quiet; do
        stop $signal "has_bytes 20000 $scratch/r.csv.part" run epicyclic_from_rest --until 1000000s --csv "$scratch/r.csv" $quiet
        name="run, $signal${quiet:+, }$quiet"
        [ "$code" -eq 130 ]
        verdict $? "$name: exit status 130"
        said "$scratch/r.csv" 1000000
        verdict $? "$name: says at what time, which is the last record's"
        check "$name: the records are whole" whole "$scratch/r.csv" , 0.001
        if [ -n "$quiet" ]; then
            [ ! -s "$scratch/out" ]
            verdict $? "$name: no summary"
        else
            grep -q "steps to t = $last s\$" "$scratch/out" && grep -q '^state hash' "$scratch/out"
            verdict $? "$name: the summary of what was reached" "$scratch/out"
        fi
        rm -f "$scratch/r.csv"
    done
done

# the state at the interrupt is that of a run to this time
stop INT "has_bytes 20000 $scratch/r.dat.part" run epicyclic_from_rest --until 1000000s --columns "$scratch/r.dat"
said "$scratch/r.dat" 1000000
verdict $? "run, columns: says at what time"
check "run, columns: the records are whole" whole "$scratch/r.dat" ' ' 0.001
"$whirl" run epicyclic_from_rest --until "$last" >"$scratch/again"
[ "$(grep '^state hash' "$scratch/again")" = "$(grep '^state hash' "$scratch/out")" ]
verdict $? "run, columns: the state of a run that ends there"

# a run without records leaves none
stop INT "has_worked 20" run epicyclic_from_rest --until 1000000s --with ledger
[ "$code" -eq 130 ] && grep -Eq '^whirl run: interrupted at t = [0-9.]+ s of 1000000 s$' "$scratch/err"
verdict $? "run without records: exit status 130, and when"
grep -q '^energy balance' "$scratch/out"
verdict $? "run without records: its books are there" "$scratch/out"

stop INT "has_worked 20" plot epicyclic_from_rest --until 1000000s --out "$scratch/plot.svg"
[ "$code" -eq 130 ] && grep -q '^whirl: interrupted at t = ' "$scratch/err"
verdict $? "plot: exit status 130, and no name of another command"

# a run in fixed point first determines its ranges
cat >"$scratch/long.whirl" <<'END'
mechanism long
coordinate x [m]
T = 1 [kg]*x'^2/2
V = 40 [N/m]*x^2/2
scene long { start x = 0.1 [m]; until 1000000 [s]; step 1 [ms] }
END
stop INT "has_worked 20" run "$scratch/long.whirl" --number fixed
[ "$code" -eq 130 ] && grep -q '^whirl run: interrupted in the first run, in double, which measures the ranges' "$scratch/err" && [ ! -s "$scratch/out" ]
verdict $? "run in fixed point, before it began: exit status 130, and why there is nothing" "$scratch/err"

# a second signal ends a process that waits, here for a reader that never comes
mkfifo "$scratch/pipe"
# shellcheck disable=SC2217 # it holds the pipe open and reads nothing
sleep 100 <"$scratch/pipe" &
reader=$!
"$whirl" run epicyclic_from_rest --until 1000000s --csv "$scratch/pipe" --quiet 2>/dev/null &
process=$!
sleep 0.3
kill -INT $process
sleep 0.2
kill -INT $process
wait $process
[ $? -eq 130 ] # ended by signal 2
verdict $? "a second Ctrl-C ends a run that cannot write"
kill $reader

for signal in INT TERM; do
    stop $signal "has_bytes 20000 $scratch/s.csv" sweep carriage_free --until 50ms --over duty=0..1:1000000 --measure X --measure "X'" \
        --measure 'max(pin_force)' --jobs 2 --csv "$scratch/s.csv"
    rows=$(($(wc -l <"$scratch/s.csv") - 1))
    [ "$code" -eq 130 ]
    verdict $? "sweep, $signal: exit status 130"
    grep -q "^whirl sweep: interrupted after $rows of 1000000 points; their rows are kept\$" "$scratch/err"
    verdict $? "sweep, $signal: says how far it came: $rows rows"
    rm -f "$scratch/s.csv" "$scratch/s.csv.sweep"
done

# a map keeps the finished points, in words and as rows
for signal in INT TERM; do
    stop $signal "has_worked 150" map epicyclic_from_rest --over m=1..3:1000 --over step=1..10[ms]:10 --effort 1e14 --csv "$scratch/m.csv"
    rows=$(($(wc -l <"$scratch/m.csv") - 1))
    [ "$code" -eq 130 ] && [ "$rows" -gt 0 ] && [ "$rows" -lt 10000 ]
    verdict $? "map, $signal: exit status 130, $rows rows"
    grep -q "^whirl map: interrupted after $rows of 10000 runs\$" "$scratch/err" &&
        grep -q "^  ?  untried  *$((10000 - rows)) " "$scratch/out" && ! grep -q untried "$scratch/m.csv"
    verdict $? "map, $signal: says how far it came"
    rm -f "$scratch/m.csv"
done

# trust has no rows yet: an ordinary file is removed, a pipe or device stays
mkfifo "$scratch/trusted"
for kind in file trusted; do # `trusted` is a pipe
    rm -f "$scratch/file"
    [ $kind = file ] || cat "$scratch/trusted" >"$scratch/read" &
    stop INT "has_worked 25" trust epicyclic_from_rest --until 3000s --step 1ms --effort 1e14 --csv "$scratch/$kind"
    [ $code -eq 130 ] && grep -q '^whirl trust: interrupted at t = ' "$scratch/err" && [ ! -e "$scratch/file" ] && [ -p "$scratch/trusted" ]
    verdict $? "trust to a file, $kind: exit status 130, an ordinary one goes and a pipe stays"
done

# A command ends within a tenth of a second of processor time, at random moments of expensive scenes.
# Hundredths of a second of processor time, of a process and its children.
spent_by() {
    cat /proc/[0-9]*/stat 2>/dev/null | sed 's/^\([0-9]*\) (.*) /\1 /' |
        awk -v p="$1" '$1 == p || $3 == p { sum += $13 + $14 } END { print sum + 0 }'
}
# A shell's background process ignores SIGINT until it catches it itself.
catches() { [ $((0x$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$1/status" 2>/dev/null || echo 2) & 2)) -ne 0 ]; }
has_spent() { ! kill -0 "$2" 2>/dev/null || { [ "$(spent_by "$2")" -ge "$1" ] && catches "$2"; }; }

seed=$(date +%s)
echo "  moments: seed $seed"
ends_soon() { # ends_soon WORD...
    at=$(awk -v seed="$seed" 'BEGIN { srand(seed); print int(2 + 50 * rand()) }')
    seed=$((seed + 1))
    rm -f "$scratch/process"
    # without emulators, which end by themselves
    sh -c 'PATH=/nowhere "$@" >"$0/out" 2>"$0/err" & echo $! >"$0/process"; wait $!; code=$?; times >"$0/times"; exit $code' \
        "$scratch" "$whirl" "$@" &
    shell=$!
    await test -s "$scratch/process"
    process=$(cat "$scratch/process")
    await has_spent "$at" $process
    kill -STOP $process 2>/dev/null
    at=$(spent_by $process)
    kill "-$([ $((seed % 2)) -eq 0 ] && echo INT || echo TERM)" $process 2>/dev/null
    kill -CONT $process 2>/dev/null
    wait $shell
    code=$?
    more=$(awk -v at="$at" 'NR == 2 { for (i = 1; i <= 2; i++) { split($i, part, "[ms]"); sum += 60 * part[1] + part[2] }
        print int(100 * sum) - at }' "$scratch/times")
    { { [ $code -eq 130 ] && grep -q interrupted "$scratch/err"; } || [ $code -le 1 ]; } && { [ "$more" -le 15 ] || [ "$at" -eq 0 ]; } # 0: it had ended
    verdict $? "$*: interrupted after $at hundredths, $more more, exit status $code"
}
# One moment of each command; WHIRL_FULL=1: eight.
for moment in 1 ${WHIRL_FULL:+2 3 4 5 6 7 8}; do
    ends_soon run tests/reference/stack.whirl
    ends_soon run halvorson_ground
    ends_soon sweep tests/reference/stack.whirl --over step=0.2..2[ms]:30 --measure 'max(y15)' --csv -
    ends_soon trust thomson_plane_b
    ends_soon effects halvorson_ground --with all --until 10000s
    ends_soon derive "$scratch/long.whirl" --as c --number fixed
    ends_soon map epicyclic_from_rest --over m=1..3:100 --over step=1..10[ms]:10 --effort 1e14
    ends_soon price epicyclic_from_rest
    ends_soon choose epicyclic_from_rest --error 1e-3 --effort 1e10
done
exit $failed
