#!/bin/sh
# vcd.sh: `whirl run --vcd`, read by a reader of its own (tests/cli/vcd.awk): of generated mechanisms every value is the CSV's of
# the same run, as printed; of generated carts between stops, with dry friction and a level that is crossed, the contacts'
# wires and events are what the motion says of them. WHIRL_CASES: so many of each; WHIRL_SEED: others.
. "$(dirname "$0")/../checks.sh"

ulimit -f 200000 # a writer that does not end is ended
tools=${TOOLS:-build/tools}
reader=tests/cli/vcd.awk
cases=${WHIRL_CASES:-${WHIRL_FULL:+60}}
cases=${cases:-8}
seed=${WHIRL_SEED:-1}

run() { "$whirl" run "$@" >"$scratch/out" 2>"$scratch/err" </dev/null; }
# same TARGET [OPTION...]: a run with both, held against each other; what the reader makes of it is in $scratch/read
same() {
    rm -f "$scratch/v.csv" "$scratch/v.vcd"
    run "$@" --quiet --csv "$scratch/v.csv" --vcd "$scratch/v.vcd"
    [ -s "$scratch/v.vcd" ] && awk -f "$reader" "$scratch/v.vcd" "$scratch/v.csv" >"$scratch/read" 2>>"$scratch/err"
}
# all_same WHAT: of the targets, with their options, on standard input
all_same() {
    count=0
    bad=0
    while read -r line; do
        count=$((count + 1))
        same $line || { bad=1 && echo "$line" >>"$scratch/differ" && head -n 2 "$scratch/err" >>"$scratch/differ"; }
    done
    [ $bad -eq 0 ] && [ $count -ge "$2" ]
    verdict $? "$1 ($count)" "$scratch/differ"
}

# --- generated mechanisms ------------------------------------------------------------------------------------------
"$tools/mechanisms" "$cases" "$seed" >"$scratch/m.whirl" 2>"$scratch/err"
"$tools/linkages" $((cases / 2)) "$seed" >"$scratch/l.whirl"
for file in m l; do
    sed -n 's/^scene \([a-z0-9_]*\).*/\1/p' "$scratch/$file.whirl" | awk -v file="$scratch/$file.whirl" '
        { split("1ms 0.25ms 3ms 0.7ms", step, " "); split("double float", number, " ")
          at = step[1 + NR % 4]
          printf "%s:%s --step %s --number %s --until %gms --every %gms\n", file, $1, at, number[1 + NR % 2], 280 * at, at * (1 + NR % 3) }'
done >"$scratch/list"
all_same "generated mechanisms: the values of the CSV, as printed, seed $seed" $((cases + cases / 2)) <"$scratch/list"

# --- carts ---------------------------------------------------------------------------------------------------------
# A cart with dry friction, a spring and two stops, shaken by a wheel that turns evenly. A coordinate counts how often the
# level is crossed, in the direction that is asked for.
awk -v seed="$seed" -v cases="$cases" '
    function draw(low, high) { return low + (high - low) * rand() }
    BEGIN { srand(seed); split("m mm ft", unit, " "); split("rad deg rev", turn, " "); split(" rising: falling", way, ":")
        for (k = 1; k <= cases; k++) {
            e = k % 3 ? draw(0, 0.9) : 0
            printf "mechanism c%d \"a cart of several $end $end$ words\"\n", k
            printf "coordinate x [%s] \"ends at no $end $end\"\ncoordinate a [%s]\ncoordinate n [m]\n", unit[1 + k % 3], turn[1 + k % 2]
            printf "input push = %.6g [N] \"and pulls\"\ninput pull_2 = 3 [kN]\n", draw(-0.5, 0.5)
            printf "T = 1 [kg]*x%s^2/2 + 1 [kg*m^2]*a%s^2/2 + 1 [kg]*n%s^2/2\n", "\047", "\047", "\047"
            printf "V = %.6g [N/m]*x^2/2\n", draw(1, 20)
            printf "Q(x) = push + %.6g [N]*sin(a)\n", draw(2, 12)
            printf "output wheel_speed [rpm] = a%s\noutput x_squared [mm^2] = x^2\noutput der_x [m] = 0.5*x\n", "\047"
            print "effect works {"
            printf "  stop x >= %.6g [m] restitution %.6g\n", -draw(0.02, 0.2), e
            printf "  stop x <= %.6g [m] restitution %.6g\n", draw(0.02, 0.2), e
            mu = draw(0, 0.4)
            printf "  friction x static %.6g kinetic %.6g normal 9 [N]\n", mu * 1.2, mu
            printf "  when x crosses %.6g [m] %s { set n = n + 1 [m] }\n}\n", draw(-0.015, 0.015), way[1 + int(k / 2) % 2]
            printf "scene cart%d { use c%d; with works; start a%s = %.6g [rad/s]; step 1 [ms]; until 3 [s] }\n", k, k, "\047", draw(3, 40)
        } }' >"$scratch/carts.whirl"
k=0
bad=0
hits=0
: >"$scratch/said"
while [ $k -lt "$cases" ]; do
    k=$((k + 1))
    same "$scratch/carts.whirl:cart$k" &&
        awk -F, -v cart=$k -f tests/cli/vcd_cart.awk "$scratch/carts.whirl" "$scratch/read" >"$scratch/said" 2>>"$scratch/err" || {
        bad=1
        echo "cart$k" >>"$scratch/carts"
        cat "$scratch/err" "$scratch/said" >>"$scratch/carts"
    }
    hits=$((hits + $(sed -n 's/ hits$//p' "$scratch/said") + 0))
done
[ $bad -eq 0 ]
verdict $? "carts between stops: wires and events are what the motion says, seed $seed" "$scratch/carts"
[ "$hits" -gt "$cases" ]
verdict $? "and they are hit ($hits)" "$scratch/said"

# --- times ---------------------------------------------------------------------------------------------------------
scale_is() { grep -qx "\$timescale $1 \$end" "$scratch/v.vcd"; }
cart=$scratch/carts.whirl:cart1
same thomson_a --until 50ms --step 1ms && scale_is 1ms
verdict $? "records 1 ms apart are told in milliseconds"
same thomson_a --until 50ms --step 0.25ms && scale_is 10us
verdict $? "records 0.25 ms apart in tens of microseconds"
same thomson_a --until 50ms --step 0.25ms --every 2ms && scale_is 1ms
verdict $? "of every eighth, in milliseconds"
same "$cart" --until 50ms --step 0.25ms && scale_is 100ns
verdict $? "with contacts a thousandth of a step, or less"
same thomson_a --until 50ms --step 1/3000 && scale_is 1fs
verdict $? "thirds of a millisecond are the nearest femtosecond's"
same thomson_a --until 150ms --step 1/3000 --every 1ms && scale_is 1ms
verdict $? "and every third of them a millisecond's"

# --- as --csv does -------------------------------------------------------------------------------------------------
run thomson_a --until 50ms --vcd - && grep -q '^state hash' "$scratch/err" && mv "$scratch/out" "$scratch/first" &&
    run thomson_a --until 50ms --quiet --vcd "$scratch/v.vcd" && cmp -s "$scratch/first" "$scratch/v.vcd"
verdict $? "- is standard output; the summary then goes to standard error"
exits 2 'error: --csv and --vcd cannot share a file' run thomson_a --csv "$scratch/x" --vcd "$scratch/x"
exits 2 'error: --columns and --vcd cannot share a file' run thomson_a --columns - --vcd -
exits 2 'error: --vcd would write over the model' run "$scratch/carts.whirl:cart1" --vcd "$scratch/carts.whirl"
exits 2 'error: cannot be written: ' run thomson_a --vcd "$scratch/none/x"
[ ! -e /dev/full ] || exits 1 '^/dev/full: error: cannot be written: ' run thomson_a --until 2s --quiet --vcd /dev/full
exits 2 'error: these records are too close for --vcd' run thomson_a --step 1e-16 --until 1e-13 --vcd "$scratch/x"

run thomson_b --method euler --step 0.1 --until 100 --quiet --csv "$scratch/v.csv" --vcd "$scratch/v.vcd"
[ $? -eq 1 ] && awk -f "$reader" "$scratch/v.vcd" "$scratch/v.csv" >/dev/null 2>"$scratch/err"
verdict $? "a run that diverges leaves its records"
rm -f "$scratch/v.csv" "$scratch/v.vcd"
"$whirl" run thomson_b --until 1e6s --csv "$scratch/v.csv" --vcd "$scratch/v.vcd" >"$scratch/out" 2>"$scratch/err" &
pid=$!
await test -s "$scratch/v.vcd.part"
await test -s "$scratch/v.csv.part"
kill -INT $pid
wait $pid
[ $? -eq 130 ] && grep -q 'the records so far are kept$' "$scratch/err" && awk -f "$reader" "$scratch/v.vcd" "$scratch/v.csv" >/dev/null 2>"$scratch/err"
verdict $? "an interrupt leaves them, too"

# --- size ----------------------------------------------------------------------------------------------------------
# What does not move is written once: a block that sticks for ten minutes.
run incline_sticks --quiet --csv "$scratch/v.csv" --vcd "$scratch/v.vcd" && [ "$(wc -c <"$scratch/v.csv")" -gt 500000 ] && [ "$(wc -c <"$scratch/v.vcd")" -lt 2000 ] &&
    [ "$(tail -n 1 "$scratch/v.vcd")" = "#60000000" ]
verdict $? "ten minutes without moving: $(wc -c <"$scratch/v.vcd") bytes, and their end"
exit $failed
