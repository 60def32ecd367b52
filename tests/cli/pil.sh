#!/bin/sh
# pil.sh: `whirl pil`: the rig and another mechanism in the loop, on this machine and on an emulated board. Also tapes, the
# time that computing takes, refusals, and that nothing remains after any process is killed. WHIRL_FULL: more kills, and a
# Cortex-M3.
. "$(dirname "$0")/../checks.sh"
about=pil

build=$(dirname "$whirl")
rig=docs/plants/rig.whirl
m4=build/mps2-an386/pil_rig.elf
rounds=1
[ -z "${WHIRL_FULL:-}" ] || rounds=6

[ -x "$build/pil_rig" ] && [ -x "$build/pil_cart" ]
verdict $? "build/pil_rig and build/pil_cart are there (make pil-images)"

# line NAME FILE: prints the rest of the report's line of that name; number NAME FILE: prints its first number
line() { grep -a "^ *$1  *" "$2" | sed "s/^ *$1  *//"; }
number() { line "$1" "$2" | head -n 1 | sed 's/^[^-0-9]*\([-0-9.]*\).*/\1/'; }
# close_to VALUE WANTED MOST
close_to() { awk -v a="$1" -v b="$2" -v most="$3" 'BEGIN { d = a - b; exit !(a != "" && d <= most && d >= -most) }'; }

# --- the rig's plant ---------------------------------------------------------------------------------------------------
# With the drive on, it is the coupled mechanism of core/models, except for the rounding of sums in another order.
end_of_arms() { sh tests/limit.sh 60 "$whirl" run "$@" --set duty=0.6 --step 200us --until 5s | awk '$1 == "theta" { print $2 }'; }
coupled=$(end_of_arms rig_coupled --with dry_friction)
close_to "$(end_of_arms $rig --set enable=1)" "$coupled" 1e-9
verdict $? "docs/plants/rig.whirl moves as rig_coupled with dry friction ($coupled)"
# after ...: lets the rotor run at 330 rpm for 0.2 s with this drive stage, and prints the remaining speed, in rad/s
after() { sh tests/limit.sh 60 "$whirl" run $rig --start "theta'=34.6" --start "motor'=34.6" --step 200us --until 200ms "$@" |
    awk '$1 == "motor\047" { print $2 }'; }
above() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a > b + 0.2) }'; }
off=$(after)
brakes=$(after --set enable=1)
above "$off" "$brakes" && above "$(after --set enable=1 --set freewheel=1)" "$brakes"
verdict $? "a drive that is on brakes with zero duty; one that is off, or freewheels, does not"
[ "$(after --set enable=1 --set duty=0.4 --set freewheel=1)" = "$off" ]
verdict $? "nor does one that freewheels whose voltage is below the back-EMF"
[ "$(after --set enable=1 --set duty=0.9 --set freewheel=1)" = "$(after --set enable=1 --set duty=0.9)" ] &&
    [ "$(after --set enable=1 --set runaway=1)" = "$(after --set enable=1 --set duty=1)" ] &&
    [ "$(after --set runaway=1)" = "$off" ] &&
    [ "$(after --set runaway=1 --set enable_stuck=1)" = "$(after --set enable=1 --set duty=1)" ]
verdict $? "one that runs away obeys its enable, unless that is stuck"
above "$(after --set enable=1 --set duty=0.9)" "$(after --set enable=1 --set duty=0.9 --set 'volts=18 [V]')"
verdict $? "a lower supply drives less"

# --- the whole rig -------------------------------------------------------------------------------------------------------
# The plant has a coupling and dry friction that the controller does not know. The force is that of the formula.
sh tests/limit.sh 60 "$whirl" pil $rig --firmware "$build/pil_rig" --tape "$scratch/pc.tape" >"$scratch/pc" 2>"$scratch/err"
verdict $? "the rig's software on this machine runs to its end"
close_to "$(number speed "$scratch/pc")" 330 0.5 && close_to "$(number 'measured \/ formula' "$scratch/pc")" 100 0.5 &&
    close_to "$(number 'mean force' "$scratch/pc")" 0 0.05
verdict $? "330 rpm, and the formula's force" "$scratch/pc"
grep -aq '^notes .* quality 0, amplitude .* N, .* turns 10, reset 0$' "$scratch/pc" &&
    close_to "$(sed -n 's/^notes .* amplitude \([0-9.]*\) N.*/\1/p' "$scratch/pc")" "$(number 'force, once per turn' "$scratch/pc")" 0.006
verdict $? "and it tells so" "$scratch/pc"

boards=
if [ -n "${WHIRL_FEW:-}" ]; then
    echo "ok - few cases: no emulated board, which nothing instruments # SKIP"
elif command -v qemu-system-arm >/dev/null 2>&1 && [ -f "$m4" ]; then
    boards=mps2-an386
    [ -z "${WHIRL_FULL:-}" ] || [ ! -f build/mps2-an385/pil_rig.elf ] || boards="$boards mps2-an385"
else
    echo "ok - no qemu-system-arm, or no $m4: no emulated board # SKIP"
fi
for board in $boards; do
    # if computing takes no time, all processors give the same orders
    sh tests/limit.sh 60 "$whirl" pil $rig --firmware "build/$board/pil_rig.elf" --board "$board" --cycles 0 --tape "$scratch/$board.tape" \
        >"$scratch/board" 2>"$scratch/err"
    verdict $? "and on an emulated $board"
    [ "$(line 'command stream' "$scratch/board")" = "$(line 'command stream' "$scratch/pc")" ] &&
        [ "$(line "plant's state" "$scratch/board")" = "$(line "plant's state" "$scratch/pc")" ]
    verdict $? "with the same orders, to the bit, and the same motion" "$scratch/board"
    [ "$(number overruns "$scratch/board")" = 0 ]
    verdict $? "no overrun with --cycles 0" "$scratch/board"
    sh tests/limit.sh 60 "$whirl" pil --replay "$scratch/pc.tape" --firmware "build/$board/pil_rig.elf" --board "$board" >"$scratch/out" 2>"$scratch/err" &&
        grep -aq "^command stream  *$(line 'command stream' "$scratch/pc"), as on the tape$" "$scratch/out"
    verdict $? "the tape of this machine gives the same answers on $board"
    sh tests/limit.sh 60 "$whirl" pil --replay "$scratch/$board.tape" --firmware "$build/pil_rig" >"$scratch/out" 2>"$scratch/err" &&
        grep -aq "^command stream  *$(line 'command stream' "$scratch/board"), as on the tape$" "$scratch/out"
    verdict $? "and the other way round"
done
if [ -n "$boards" ]; then
    # ten times slower: a step that prints the state is late by more than a period
    for cycles in 0 1.5 15; do
        sh tests/limit.sh 60 "$whirl" pil $rig --firmware "$m4" --cycles $cycles --until 8.7s >"$scratch/out.$cycles" 2>"$scratch/err"
        verdict $? "--cycles $cycles"
    done
    [ "$(number overruns "$scratch/out.0")" -eq 0 ] && [ "$(number overruns "$scratch/out.1.5")" -eq 0 ] &&
        [ "$(number overruns "$scratch/out.15")" -ge 1 ] &&
        [ "$(number 'reading -> outputs' "$scratch/out.0")" = "$(number 'reading -> outputs' "$scratch/out.1.5")" ] &&
        [ "$(line 'command stream' "$scratch/out.1.5")" != "$(line 'command stream' "$scratch/out.15")" ]
    verdict $? "what is slower overruns, with as many instructions" "$scratch/out.1.5"
fi

# --- a board of the user's own ------------------------------------------------------------------------------------------
if [ -n "$boards" ]; then
    mkdir -p "$scratch/boards/bench" && echo 'BOARD_MACHINE  := mps2-an386' >"$scratch/boards/bench/board.mk"
    here=$PWD
    (cd "$scratch" && timeout 60 "$(cd "$here" && realpath "$whirl")" pil "$here/$rig" --until 20ms --board bench \
        --firmware "$here/$m4") >"$scratch/out" 2>"$scratch/err"
    verdict $? "--board takes a folder of boards/ by its BOARD_MACHINE"
fi

# --- the page's bytes ----------------------------------------------------------------------------------------------------
# page_bytes NAME...: prints the bytes of these frames in docs/dev/pil.md, as octal escapes of printf
page_bytes() {
    for frame in "$@"; do
        awk -v name="$frame" '/^```/ { on = $0 == "```bytes"; next }
            on { here = /^[a-z]/ ? $1 == name : here
                for (i = /^[a-z]/ ? 2 : 1; here && i <= NF; i++) {
                    printf "\\%03o", 16 * (index("0123456789abcdef", substr($i, 1, 1)) - 1) + index("0123456789abcdef", substr($i, 2)) - 1
                } }' docs/dev/pil.md
    done
}
# shellcheck disable=SC2059 # they are escapes
put_bytes() { printf "$(page_bytes "$@")"; }
timeout 60 "$whirl" pil $rig --firmware "$build/pil_dialled" --until 10ms --tape "$scratch/first.tape" >"$scratch/out" 2>"$scratch/err"
put_bytes hello read_0 orders_0 read_1 orders_1 >"$scratch/page"
[ "$(wc -c <"$scratch/page")" -gt 700 ] && head -c "$(wc -c <"$scratch/page")" "$scratch/first.tape" | cmp - "$scratch/page"
verdict $? "docs/dev/pil.md: the first frames of a run, byte by byte"
put_bytes hello read_0 orders_0 edge remember drive hello reset restarted >"$scratch/page.tape"
timeout 60 "$whirl" pil --read "$scratch/page.tape" >"$scratch/rows" 2>"$scratch/err"
awk '/^```/ { on = 0 } on; /^`whirl pil --read` prints of a tape with these/ { getline; getline; on = 1 }' docs/dev/pil.md >"$scratch/wanted"
tail -n +13 "$scratch/rows" | diff "$scratch/wanted" - >"$scratch/diff"
verdict $? "and those of the other kinds say what stands there" "$scratch/diff"

# --- a trip, then resets -------------------------------------------------------------------------------------------------
# Two resets with a trip latched. After each, the program is a new one, which knows only the trip; all processors agree.
fault='cell-open@6s,reset@6.4003,reset=0.05@7.7'
sh tests/limit.sh 60 "$whirl" pil $rig --step 200us --fault "$fault" --firmware "$build/pil_rig" --tape "$scratch/reset.tape" >"$scratch/reset" 2>"$scratch/err"
[ $? -eq 1 ] && grep -aq '^TRIPPED: the load cell' "$scratch/reset" && grep -aq '^RESET: the motor stays off' "$scratch/reset" &&
    [ "$(grep -ac '^Eccentric-mass rig on board' "$scratch/reset")" = 3 ] && [ "$(grep -ac '^0.000 s  tripped' "$scratch/reset")" = 2 ] &&
    grep -aq '^resets  *2, the last at t = 7.7' "$scratch/reset" && grep -aq '^notes .* state 4, trip 5, .* reset 2$' "$scratch/reset"
verdict $? "a trip is latched through two resets, and told" "$scratch/reset"
for board in $boards pc; do
    image=build/$board/pil_rig.elf
    [ $board != pc ] || image=$build/pil_rig
    sh tests/limit.sh 60 "$whirl" pil --replay "$scratch/reset.tape" --firmware "$image" ${boards:+--board ${boards%% *}} >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 1 ] && grep -aq "^command stream  *$(line 'command stream' "$scratch/reset"), as on the tape$" "$scratch/out" &&
        [ "$(line exchanges "$scratch/out" | cut -d' ' -f1-3)" = "$(line exchanges "$scratch/reset" | cut -d' ' -f1-3)" ]
    verdict $? "its tape gives the same answers on $board" "$scratch/out"
done

# --- readings that are late, or missing ----------------------------------------------------------------------------------
# The readings are late by this much, and the run begins. The phase error is the delay times 1980 degrees a second (330 rpm).
first=$(number 'phase, force to masses' "$scratch/pc")
for delay in $(awk -v n=$((2 * rounds)) 'BEGIN { srand(5); for (i = 0; i < n; i++) print 0.05 + 9 * rand() }'); do
    sh tests/limit.sh 60 "$whirl" pil $rig --step 200us --firmware "$build/pil_rig" --delay "${delay}ms" >"$scratch/late" 2>"$scratch/err"
    close_to "$(number 'phase, force to masses' "$scratch/late")" "$(awk -v d="$delay" -v p="$first" 'BEGIN { print p - 1.98 * d }')" 0.1 &&
        close_to "$(number 'measured \/ formula' "$scratch/late")" 100 0.5
    verdict $? "--delay ${delay}ms: the rig runs, and its phase is off by as much" "$scratch/late"
done
sh tests/limit.sh 60 "$whirl" pil $rig --step 200us --firmware "$build/pil_dialled" --set speed=250rpm --delay 12ms >"$scratch/late" 2>"$scratch/err"
close_to "$(number speed "$scratch/late")" 250 0.5
verdict $? "a dial that is read late is waited for" "$scratch/late"
sh tests/limit.sh 60 "$whirl" pil $rig --step 200us --firmware "$build/pil_dialled" --fault cell-dead:4 >"$scratch/late" 2>"$scratch/err"
[ $? -eq 1 ] && grep -aq '^NOT STARTED: the dials cannot be read' "$scratch/late"
verdict $? "and one that is not heard starts nothing" "$scratch/late"
# A stop input with a broken line counts as pressed, from the start or at any time: the motor is off.
for when in $(awk -v n=$((2 * rounds)) 'BEGIN { srand(6); print 0; for (i = 0; i < n; i++) print 1.7 + 9 * rand() }'); do
    sh tests/limit.sh 60 "$whirl" pil $rig --step 200us --firmware "$build/pil_rig" --fault "cell-dead:3@${when}s" --tape "$scratch/silent.tape" \
        >"$scratch/silent" 2>"$scratch/err"
    [ $? -eq 1 ] && grep -aq '^STOPPED: the stop input cannot be read' "$scratch/silent" &&
        "$whirl" pil --read "$scratch/silent.tape" |
        awk -F, -v when="$when" '$5 == "duty" { duty = $6 } $2 > when + 0.054 && duty != 0 { bad++ } END { exit bad != 0 }'
    verdict $? "a stop input that is silent from $when s on stops the rig" "$scratch/silent"
done

# --- any scene ----------------------------------------------------------------------------------------------------------
for start in 0.1 -0.1 0.17; do
    sh tests/limit.sh 60 "$whirl" pil docs/plants/cart.whirl --start theta=$start --firmware "$build/pil_cart" >"$scratch/cart" 2>"$scratch/err" &&
        close_to "$(number rod "$scratch/cart")" 0 0.02 && close_to "$(number cart "$scratch/cart")" 0 0.03 &&
        [ "$(line exchanges "$scratch/cart" | cut -d' ' -f1)" = 10000 ]
    verdict $? "a rod on a cart, leaning by $start rad, comes to stand" "$scratch/cart"
done
sh tests/limit.sh 60 "$whirl" pil docs/plants/cart.whirl --start theta=1.2 --firmware "$build/pil_cart" >"$scratch/cart" 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'the firmware ended with status 1' "$scratch/err"
verdict $? "by 1.2 rad it does not, and whirl says so"
sed 's/^\(input  *\)push/\1motor/; s/= push$/= motor/' docs/plants/cart.whirl >"$scratch/renamed.whirl"
sh tests/limit.sh 60 "$whirl" pil "$scratch/renamed.whirl" --bind push=motor --until 1s --firmware "$build/pil_cart" >"$scratch/cart" 2>"$scratch/err" &&
    [ "$(line exchanges "$scratch/cart" | cut -d' ' -f1)" = 1000 ]
verdict $? "--bind, and --until lets the firmware go" "$scratch/cart"
sh tests/limit.sh 60 "$whirl" pil docs/plants/cart.whirl --until 2s --firmware "$build/pil_cart" >"$scratch/plain" 2>"$scratch/err"
for option in '--delay 5ms' '--place 0.02' '--jitter 3ms' '--set l=0.4' '--step 200us'; do
    sh tests/limit.sh 60 "$whirl" pil docs/plants/cart.whirl --until 2s --firmware "$build/pil_cart" $option --tape "$scratch/cart.tape" >"$scratch/cart" 2>"$scratch/err"
    verdict $? "$option"
    sh tests/limit.sh 60 "$whirl" pil --replay "$scratch/cart.tape" --firmware "$build/pil_cart" >"$scratch/out" 2>"$scratch/err"
    verdict $? "and its tape"
done

# --- invalid tapes --------------------------------------------------------------------------------------------------------
head -c 3000 "$scratch/pc.tape" >"$scratch/cut.tape"
exits 2 'the tape is damaged' --replay "$scratch/cut.tape" --firmware "$build/pil_rig"
{ head -c 3000 "$scratch/pc.tape" && printf X && tail -c +3002 "$scratch/pc.tape"; } >"$scratch/flip.tape"
exits 2 'not a tape of this version' --replay "$build/pil_rig" --firmware "$build/pil_rig"
exits 2 'cannot be read' --replay "$scratch/none" --firmware "$build/pil_rig"
exits 2 "the firmware 'rig' on this tape" --replay "$scratch/pc.tape" --firmware "$build/pil_cart"
# the beginning of one run with the end of another: frames end in zeros
sh tests/limit.sh 60 "$whirl" pil docs/plants/cart.whirl --until 2s --set l=0.5 --firmware "$build/pil_cart" --tape "$scratch/long.tape" >"$scratch/out" 2>"$scratch/err"
{ tr '\0\n' '\n\0' <"$scratch/cart.tape" | head -n 1001 && tr '\0\n' '\n\0' <"$scratch/long.tape" | tail -n +1002; } | tr '\0\n' '\n\0' >"$scratch/mixed.tape"
exits 1 'exchange 50[0-9], .*outputs differ from the tape' --replay "$scratch/mixed.tape" --firmware "$build/pil_cart"

# --- a tape as rows --------------------------------------------------------------------------------------------------------
# rows KIND FILE: prints the number of rows of that kind
rows() { awk -F, -v kind="$1" '$3 == kind { n++ } END { print n + 0 }' "$2"; }
"$whirl" pil --read "$scratch/pc.tape" >"$scratch/rows" 2>"$scratch/err" &&
    [ "$(head -n 1 "$scratch/rows")" = time,heard,kind,channel,signal,value,unit,status ] &&
    [ "$(line readings "$scratch/pc")" = "$(rows edge "$scratch/rows") edges, $(rows sample "$scratch/rows") samples, 0 lost" ]
verdict $? "--read has each edge and sample of the report" "$scratch/pc"
awk -F, 'NF != 8 || $1 > $2 || ($3 == "sample") != ($8 == "good") || ($3 == "edge") != ($6 == "") ||
    ($3 == "sample" && $5 == "cell_force" && ($1 != $2 || ++n * 0.002 - $1 > 1e-9 || $1 - n * 0.002 > 1e-9)) { bad++ }
    END { exit !(NR > 15000 && bad == 1) }' "$scratch/rows" # the only other line is the header
verdict $? "its rows have eight columns, and a sample every 2 ms"
# a supply of 24 V, the tare at rest, pulses in whole turns, and the firmware's last notes
awk -F, -v told="$(sed -n 's/^notes .* amplitude \([0-9.]*\) N.*/\1/p' "$scratch/pc")" '
    BEGIN { before = -1 }
    $5 == "supply" && ($6 < 23.98 || $6 > 24.02) { bad++ }
    $5 == "cell_force" && $1 < 2 && ($6 < 56.05 || $6 > 56.08) { bad++ }
    $3 == "edge" && $1 > 3 && $1 < 12 { if ($4 == last) bad++; last = $4 }
    $5 == "amplitude" { amplitude = $6 }
    $5 == "state" && $6 == before { bad++ }
    $5 == "state" { before = $6 }
    END { d = amplitude - told; exit !(bad == 0 && d < 1e-4 && d > -1e-4 && before == 0) }' "$scratch/rows"
verdict $? "values are those of plant and firmware"
"$whirl" pil --read "$scratch/reset.tape" >"$scratch/resets" 2>"$scratch/err" &&
    awk -F, 'NR == 1 { next } $1 < before - 1e-3 { bad++ } { before = $2 } $3 == "reset" { n++; at[n] = $2; bad += $8 != "other" || NF != 8 }
        END { exit !(n == 2 && bad == 0 && at[1] > 6.41 && at[1] < 6.411 && at[2] > 7.749 && at[2] < 7.751) }' "$scratch/resets"
verdict $? "resets are rows, and time goes on behind them" "$scratch/resets"
"$whirl" pil --read "$scratch/pc.tape" --csv "$scratch/rows.csv" && cmp -s "$scratch/rows" "$scratch/rows.csv"
verdict $? "--csv FILE is the same"
sh tests/limit.sh 60 "$whirl" pil $rig --fault hang=0.1@3s --firmware "$build/pil_rig" --tape "$scratch/hang.tape" >"$scratch/out" 2>"$scratch/err"
"$whirl" pil --read "$scratch/hang.tape" >"$scratch/rows" 2>"$scratch/err" && [ "$(rows cut "$scratch/rows")" -eq 1 ] &&
    close_to "$(awk -F, '$3 == "cut" { print $1 }' "$scratch/rows")" 3.1 0.01
verdict $? "a watchdog that has cut is a row" "$scratch/out"
sh tests/limit.sh 60 "$whirl" pil $rig --fault edge-late=5ms@3s,cell-saturated@6s --firmware "$build/pil_rig" --tape "$scratch/late.tape" >"$scratch/out" 2>"$scratch/err"
"$whirl" pil --read "$scratch/late.tape" | awk -F, '$3 == "edge" && $1 > 3.1 && $1 < 6 { n++; if ($2 - $1 < 0.005 || $2 - $1 > 0.0091) bad++ }
    $8 == "saturated" && ($1 < 6 || $4 != 1) { bad++ } $8 == "saturated" { full++ } END { exit !(n > 5 && bad == 0 && full > 1) }'
verdict $? "what comes late has its stamp, and what is saturated says so" "$scratch/out"
"$whirl" pil --read "$scratch/flip.tape" >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'error: the tape is damaged after 20 exchanges' "$scratch/err" && [ "$(grep -c . "$scratch/out")" -gt 1 ]
verdict $? "a broken tape is read up to its fault" "$scratch/err"
exits 2 'this is not a tape of this version' --read "$build/pil_rig"
exits 2 'this is not a tape of this version' --read /dev/zero
exits 2 'cannot be read' --read "$scratch/none"
for step in 70:0.07 700:0.7 1500:1.5 3000:3 5000:5 1000:1 250:1 2500:2.5 500:1; do # us, and ms from row to row
    "$whirl" pil docs/plants/cart.whirl --firmware "$build/pil_cart" --until 21ms --step "${step%:*}us" --csv - 2>"$scratch/err" |
        awk -F, -v at="${step#*:}" 'NR == 3 { row = 1e3 * $1 } END { exit !(row >= at * 0.999 && row <= at * 1.001) }'
    verdict $? "without --every: with steps of ${step%:*} us, a row every ${step#*:} ms" "$scratch/err"
done
exits 2 'cannot be written' --read "$scratch/pc.tape" --csv "$scratch/no/rows"
[ ! -c /dev/full ] || exits 1 'cannot be written' --read "$scratch/pc.tape" --csv /dev/full
exits 2 'would overwrite .*pc.tape' --read "$scratch/pc.tape" --csv "$scratch/pc.tape"
exits 2 'only prints a tape, so it excludes --firmware' --read "$scratch/pc.tape" --firmware "$build/pil_rig"
exits 2 'it excludes scene' --read "$scratch/pc.tape" $rig
exits 2 'it excludes --replay' --read "$scratch/pc.tape" --replay "$scratch/pc.tape"
exits 2 '--replay excludes --csv' --replay "$scratch/pc.tape" --csv - --firmware "$build/pil_rig"

# --- refused input ----------------------------------------------------------------------------------------------------------
exits 2 '--firmware IMAGE is missing' rig_coupled
exits 2 'scene for the plant is missing' --firmware "$build/pil_rig"
exits 2 'excludes scene' rig_coupled --replay "$scratch/pc.tape" --firmware "$build/pil_rig"
exits 2 'cannot be read' rig_coupled --firmware "$scratch/none"
exits 2 'not a firmware image' rig_coupled --firmware README.md
exits 2 'ended without its first message' rig_coupled --firmware "$build/whirl"
cp "$build/pil_rig" "$scratch/closed" && chmod a-x "$scratch/closed"
exits 2 'cannot be run' rig_coupled --firmware "$scratch/closed"
exits 2 "sets 'push', but 'rig_coupled' has no input 'push'" rig_coupled --firmware "$build/pil_cart"
sed 's/theta/tilt/g' docs/plants/cart.whirl >"$scratch/tilt.whirl"
exits 2 "reads 'theta', but" "$scratch/tilt.whirl" --firmware "$build/pil_cart"
exits 2 "'push' is in N, but 'duty' of 'rig_coupled' is in 1" rig_coupled --bind push=duty --firmware "$build/pil_cart"
exits 2 'no signal of that name' docs/plants/cart.whirl --bind pull=push --firmware "$build/pil_cart"
exits 2 'this is not NAME=OTHER' docs/plants/cart.whirl --bind push --firmware "$build/pil_cart"
exits 2 'already renames this signal' docs/plants/cart.whirl --bind push=push,push=push --firmware "$build/pil_cart"
timeout 60 "$whirl" pil docs/plants/rig.whirl --delay 0.1 --until 1s --firmware "$build/pil_rig" | grep -q ' 0 lost$'
verdict $? "a long delay loses no sample"
exits 2 'numbers with commas between them' docs/plants/cart.whirl --place 1,x --firmware "$build/pil_cart"
exits 2 'is not a time' docs/plants/cart.whirl --delay 3kg --firmware "$build/pil_cart"
exits 2 "no board 'pdp11'" rig_coupled --board pdp11 --firmware "$build/pil_rig"
exits 2 'takes a number' rig_coupled --cycles -1 --firmware "$build/pil_rig"
exits 2 'cannot be written' docs/plants/cart.whirl --tape "$scratch/no/tape" --firmware "$build/pil_cart"
# invalid values, in each option
cart="docs/plants/cart.whirl --until 0.02s --firmware $build/pil_cart"
while read -r option pattern values; do
    for value in $values; do
        [ "$value" != empty ] || value=
        exits 2 "$(echo "$pattern" | tr _ ' ')" $cart "$option" "$value"
    done
done <<'END'
--jitter --jitter_.*_is_not_a_time -1us nan inf 1kg 3601s 1e300 1e999 / empty
--delay --delay_.*_is_not_a_time -1ms nan inf 1kg 1e9s 1e300 1e999 / empty
--seed --seed_takes_a -1 1.5 nan inf 1e300 4294967296 0x10 empty
--clock --clock_takes_a_number 0 -1 999 nan inf 1e12 16MHz empty
--cycles --cycles_takes_a_number -1 nan inf 1e5 empty
--patience --patience_takes_a_number -1 0 nan inf 1e7 empty
--place --place_.*:_give_numbers_with_commas_between_them nan inf -inf 1e999 , 1, ,1 0x10 1,nan empty
--place --place_has_[2-9]_values,_but_the_firmware_has 0,0,0
--bind this_is_not_NAME=OTHER = =push , push=push, ,push=push push push= push=,push= empty
--board no_board nan , empty
--tape cannot_be_written /dev/null/x empty
END
for image in /dev/null /dev/zero .; do
    exits 2 'not a firmware image' docs/plants/cart.whirl --firmware $image
done
exits 2 'cannot be read' docs/plants/cart.whirl --firmware ''
[ ! -c /dev/full ] ||
    exits 1 'cannot be written' docs/plants/cart.whirl --until 0.02s --firmware "$build/pil_cart" --tape /dev/full
exits 2 'cannot be read: Is a directory' --replay "$scratch" --firmware "$build/pil_cart"
cp docs/plants/cart.whirl "$scratch/mine.whirl"
exits 2 'over' "$scratch/mine.whirl" --tape "$scratch/mine.whirl" --firmware "$build/pil_cart"
cmp -s docs/plants/cart.whirl "$scratch/mine.whirl"
verdict $? "and the scene is still there"

# --- a replay that is interrupted says how far it came, at whichever exchange (by one signal: the second ends it at once) ---
for after in 0.02 0.05 0.1 0.2; do
    timeout --foreground --signal=INT $after "$whirl" pil --replay "$scratch/pc.tape" --firmware "$build/pil_rig" >"$scratch/out" 2>"$scratch/err"
    case $(sed -n "s/^exchanges  *\([0-9]*\) .*/\1/p" "$scratch/out") in
    "$(sed -n "s/^exchanges  *\([0-9]*\) .*/\1/p" "$scratch/pc")") said=tape ;; # it was quicker
    *) said="tape so far; the remainder was not replayed" ;;
    esac
    [ ! -s "$scratch/out" ] || grep -aq "^command stream .*, as on the $said$" "$scratch/out"
    verdict $? "a replay interrupted after $after s: as on the $said"
done
for step in 1e-12s 1e-9s 10us; do # whatever the time to the next exchange
    timeout --foreground --kill-after=2 --signal=INT 0.15 "$whirl" pil docs/plants/rig.whirl --step $step --until 1000s \
        --firmware "$build/pil_rig" >"$scratch/out" 2>"$scratch/err"
    got=$? # 137 is the second signal's, 124 the time's
    [ $got -eq 124 ] && grep -q '^exchanges' "$scratch/out"
    verdict $? "a run with steps of $step is interrupted, and told ($got)" "$scratch/err"
done
exits 2 '--baud needs --port' docs/plants/rig.whirl --firmware "$build/pil_rig" --baud 9600

# --- nothing is left behind ----------------------------------------------------------------------------------------------
# Seconds of plant time in steps of 2 us: long enough to be killed in the middle.
# child PID: its first child; state PID: R, S, T, Z or nothing, as Linux has them
child() { sed -n "s/^\([0-9]*\) (.*) [A-Za-z] $1 .*/\1/p" /proc/[0-9]*/stat 2>/dev/null | head -n 1; }
state() { sed 's/.*) \([A-Za-z]\) .*/\1/' "/proc/$1/stat" 2>/dev/null; }
# begin IMAGE: starts $host and $guest, and waits until their line is busy; a slow machine may take half a minute
begin() {
    sh tests/limit.sh 60 "$whirl" pil $rig --step 2us --patience 1 --firmware "$1" >"$scratch/out" 2>"$scratch/err" &
    wrapper=$!
    host= guest=
    for _ in $(seq 30000); do
        host=$(child "$wrapper")
        [ -z "$host" ] || guest=$(child "$host")
        [ -z "$guest" ] || ! grep -aq tare "$scratch/out" || return 0
        sleep 0.02
    done
    return 1
}
# pause: waits up to 0.3 s, a random time
seed=$$
pause() {
    seed=$(((seed * 1103515245 + 12345) % 2147483648))
    sleep "0.$(((seed / 65536) % 3))$(((seed / 512) % 10))"
}
# is_gone PID: true if the process ends within a minute; a dead process that was not waited for counts, too
is_gone() {
    for _ in $(seq 3000); do
        case $(state "$1") in '' | Z) return 0 ;; esac
        sleep 0.02
    done
    return 1
}
end_of() { # end_of STATUS WHAT: checks how the host ended, and that both processes are gone
    wait "$wrapper" 2>/dev/null
    got=$?
    [ "$got" -eq "$1" ] && is_gone "$host" && is_gone "$guest" && [ -z "$(find "$scratch" -type p)" ]
    verdict $? "$2 (status $got), no process and no FIFO is left"
}
[ -r /proc/self/stat ] || echo "ok - no /proc: nobody is killed # SKIP"
for image in $([ -r /proc/self/stat ] && echo "$build/pil_rig" ${boards:+"$m4"}); do
    for round in $(seq $rounds); do
        begin "$image" && pause && kill -KILL "$guest"
        end_of 1 "$image, round $round: the guest is killed"
        grep -q 'process ended by signal 9' "$scratch/err"
        verdict $? "and that is said"
        begin "$image" && pause && kill -KILL "$host"
        end_of 137 "$image, round $round: the host is killed"
        begin "$image" && pause && kill -KILL "$host" "$guest"
        end_of 137 "$image, round $round: both are killed"
        begin "$image" && pause && kill -TERM "$host"
        end_of 130 "$image, round $round: the host is interrupted"
        begin "$image" && pause && kill -HUP "$host"
        end_of 130 "$image, round $round: the host's terminal goes away"
    done
    begin "$image" && pause && kill -STOP "$guest" && kill -KILL "$host"
    end_of 137 "$image: the guest stands still, and the host is killed"
    begin "$image" && pause && kill -STOP "$guest"
    end_of 1 "$image: the guest stands still"
    grep -q 'has sent no message for 1 s' "$scratch/err"
    verdict $? "and that is said"
done
# a firmware that reads nothing, and ignores the end of the line
many=$(command -v yes)
sh tests/limit.sh 60 "$whirl" pil rig_coupled --firmware "$many" --patience 0.2 >/dev/null 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'has sent no message for 0.2 s' "$scratch/err"
verdict $? "a program that is no firmware and does not end is ended"
exit $failed
