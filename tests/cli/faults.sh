#!/bin/sh
# faults.sh: `whirl pil --fault` and the campaign of faults. Every kind is accepted, an unknown one is refused with a hint.
# A small campaign gives the same on one process and on two, finds no violation, and its command repeats a run. WHIRL_FULL:
# a larger campaign, and one in the emulator. WHIRL_FEW: a smaller one.
. "$(dirname "$0")/../checks.sh"

build=$(dirname "$whirl")
runs=45
[ -z "${WHIRL_FEW:-}" ] || runs=12
[ -z "${WHIRL_FULL:-}" ] || runs=120
rig="docs/plants/rig.whirl --step 200us --firmware $build/pil_rig"
about="pil $rig"

# --- words ------------------------------------------------------------------------------------------------------------
"$whirl" pil --faults >"$scratch/kinds" 2>"$scratch/err" && [ "$(wc -l <"$scratch/kinds")" -ge 30 ]
verdict $? "whirl pil --faults lists the kinds"
awk '{ print $1 }' "$scratch/kinds" | while read -r kind; do
    sh tests/limit.sh 20 "$whirl" pil $rig --until 30ms --fault "$kind" >"$scratch/out" 2>"$scratch/err" || echo "$kind"
    grep -Eq "^ +$kind +(=.* {2,})?[a-z0-9]+( [^ ]+){2,}\$" "$scratch/kinds" || echo "no words: $kind"
done >"$scratch/bad"
[ ! -s "$scratch/bad" ]
verdict $? "each is taken, and the list says what it does" "$scratch/bad"
grep -q '^`whirl pil --faults` lists' docs/pil.md
verdict $? "docs/pil.md names the list"
exits 2 "did you mean 'supply'" --fault suply=2
exits 2 'a number from 0 to 10' --fault supply=11
exits 2 'this kind has no size' --fault jam,freewheel=1
exits 2 'a number from 0.01 to 1' --fault stuck=1.2
exits 2 'not a valid time' --fault jam@noon
exits 2 'not a valid duration' --fault jam@1+long
exits 2 "declares no note 'mood'" --fault jam@mood=3
exits 2 'has only 2 channels of this kind' --fault edge-dead:3
for when in jam@100s jam@state=99 reset@100s edge-lost@trip=77 "supply=0.5@state=4~300"; do
    exits 1 "the fault '${when%%[=@]*}' did not occur" --until 30ms --fault "cell-noise=0.07,$when"
done
about=pil
exits 2 "has no input 'runaway'" docs/plants/cart.whirl --firmware "$build/pil_cart" --fault runaway
exits 2 'excludes --fault' --replay "$scratch/none" --firmware "$build/pil_rig" --fault jam

# --- effects of faults ------------------------------------------------------------------------------------------------------
# told WORD FILE: prints the value of the firmware's note of that name
told() { sed -n "s/^notes .*$1 \([-0-9.e]*\).*/\1/p" "$2"; }
# run FAULTS: runs the rig with these faults
run() {
    sh tests/limit.sh 60 "$whirl" pil $rig --fault "$1" >"$scratch/run" 2>"$scratch/err"
}
run cell-noise=0.07
verdict $? "with noise alone the rig's run is done" "$scratch/run"
healthy=$(told amplitude "$scratch/run")
run cell-noise=0.07
[ "$(told amplitude "$scratch/run")" = "$healthy" ]
verdict $? "and again to the bit"
run cell-dead@6s
[ "$(told trip "$scratch/run")" -ne 0 ]
verdict $? "a load cell that dies trips it" "$scratch/run"
run edge-dead@6s
[ "$(told trip "$scratch/run")" -ne 0 ]
verdict $? "and so do sensors that die" "$scratch/run"
run hang=100ms@5s
grep -aq '^watchdog .* t = 5.02' "$scratch/run" && [ "$(told trip "$scratch/run")" -ne 0 ]
verdict $? "one that hangs is cut by the watchdog" "$scratch/run"
run watchdog-resets,hang=100ms@5s
! grep -aq '^watchdog' "$scratch/run" && grep -aq '^resets  *1, the last at t = 5.02' "$scratch/run" &&
    grep -aq '^RESET by the watchdog: the motor stays off' "$scratch/run" && [ "$(told reset "$scratch/run")" -eq 1 ]
verdict $? "or is reset by it, and then leaves the rig alone" "$scratch/run"
run stop@5s+10ms
grep -aq '^STOPPED: ' "$scratch/run" && grep -aq '^5.002 s  \(coast\|brake\)' "$scratch/run" && ! grep -aq '^Measured' "$scratch/run"
verdict $? "stop is heard in the next control step" "$scratch/run"
run cell-open:3@5s+10ms
grep -aq '^STOPPED: ' "$scratch/run" && grep -aq '^5.00[024] s  \(coast\|brake\)' "$scratch/run"
verdict $? "a stop line that is broken counts as pressed" "$scratch/run"
run stop@0.5s+10ms
grep -aq '^STOPPED: ' "$scratch/run" && ! grep -aq armed "$scratch/run"
verdict $? "and one that was pressed before it armed is not forgotten" "$scratch/run"
# The controller is late in each step while the rotor brakes, or its orders are lost: at the end the motor is
# disabled.
awk -v seed="$(date +%j)" 'BEGIN { srand(seed); for (i = 0; i < 4; i++) { printf "%s=%.5f %.2f\n", i % 2 ? "orders-lost" : "late",
        i % 2 ? 0.3 * rand() : 0.0021 + 0.004 * rand(), 20 + 12 * rand() } }' |
    while read -r fault speed; do
        "$whirl" pil docs/plants/rig.whirl --step 200us --firmware "$build/pil_dialled" --tape "$scratch/late" \
            --fault "cell-noise=0.07,reads:4=$speed,reads:6=1,$fault@state=14" </dev/null >"$scratch/run" 2>&1
        "$whirl" pil --read "$scratch/late" | awk -F, '$5 == "enable" { on = $6 } END { exit on != 0 }' || echo "$fault at $speed rad/s"
    done >"$scratch/bad"
[ ! -s "$scratch/bad" ]
verdict $? "a controller that is late or not heard while it brakes ends with the enable off" "$scratch/bad"

# --- driven although the motor is off ----------------------------------------------------------------------------------------
# off TRIPS WORD...: at 60 s the motor is off, and the trip is one of TRIPS
off() {
    trips=$1
    shift
    timeout 200 "$whirl" pil docs/plants/rig.whirl --step 200us --firmware "$build/pil_dialled" --until 60s --tape "$scratch/tape" \
        "$@" >"$scratch/run" 2>"$scratch/err"
    "$whirl" pil --read "$scratch/tape" | awk -F, '$5 == "enable" { on = $6 } END { exit !(on == 0) }' &&
        case " $trips " in *" $(told trip "$scratch/run") "*) true ;; *) false ;; esac
    verdict $? "off, and tripped by $trips: $*" "$scratch/run"
}
off 12 --set brakes=1 --set speed=250rpm --fault supply=0.5,runaway@state=14
off '2 10' --fault stop@9s,stuck=0.9@9s
off '10 12' --set brakes=1 --fault stuck=0.4@state=15
off '10 12' --fault stop@9s,stuck@9s,edge-dead:1@9s
# a stage that obeys its enable line drives nothing, so the motor is off without a trip
off 0 --set speed=250rpm --fault supply=0.5,runaway@state=14
off 0 --fault stop@9s,runaway=0.4@9s
off 0 --fault stop@2.1s,runaway@2.1s,edge-dead:1

# --- stopped, and reset -------------------------------------------------------------------------------------------------------
# Some faults of each class at random instants: the motor is off at once, the state is idle or tripped as before, and nothing starts by itself.
few=8
[ -z "${WHIRL_FEW:-}" ] || few=2
[ -z "${WHIRL_FULL:-}" ] || few=30
for only in stop reset reset-tripped hang-resets runaway-share stuck-share; do
    sh tests/limit.sh 300 "$build/tools/faults" --firmware "$build/pil_dialled" --only $only --runs $few --seed 9 >"$scratch/halts" 2>"$scratch/err" &&
        grep -q "^| $only | $few |" "$scratch/halts"
    verdict $? "$few runs of $only" "$scratch/halts"
done

# --- the campaign -----------------------------------------------------------------------------------------------------
faults=$build/tools/faults
for jobs in 2 1; do
    sh tests/limit.sh 300 "$faults" --firmware "$build/pil_rig" --runs $runs --seed 7 --jobs $jobs >"$scratch/campaign.$jobs" 2>"$scratch/err"
    verdict $? "$runs runs on $jobs processes find nothing wrong" "$scratch/campaign.$jobs"
    [ -n "${WHIRL_FULL:-}" ] || break
done
if [ -n "${WHIRL_FULL:-}" ]; then
    cmp -s "$scratch/campaign.1" "$scratch/campaign.2"
    verdict $? "the same on one process as on two"
fi
if [ -z "${WHIRL_FEW:-}" ]; then
    [ "$(grep -c '^| none |' "$scratch/campaign.2")" -eq 2 ]
    verdict $? "healthy runs are among them" "$scratch/campaign.2"
fi
m4=build/mps2-an386/pil_rig.elf
if [ -n "${WHIRL_FULL:-}" ] && command -v qemu-system-arm >/dev/null 2>&1 && [ -f "$m4" ]; then
    sh tests/limit.sh 300 "$faults" --firmware "$m4" --runs 60 --seed 7 >"$scratch/campaign" 2>"$scratch/err"
    verdict $? "nor in the emulator" "$scratch/campaign"
fi
for words in '' '--firmware' "--firmware $build/pil_rig --runs x" "--firmware $build/pil_rig --only nothing" '--what 3'; do
    sh tests/limit.sh 20 "$faults" $words >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 2 ] && grep -q '^usage' "$scratch/err"
    verdict $? "faults $words: refused"
done
# an interrupted campaign reports the runs that were done; on a busy machine this may be none
for pause in 2 10 30; do
    sh tests/limit.sh 60 "$faults" --firmware "$build/pil_rig" --runs 100000 >"$scratch/out" 2>"$scratch/err" &
    wrapper=$!
    sleep $pause
    kill -INT $wrapper
    wait $wrapper
    interrupted=$?
    ! grep -q '^| fault' "$scratch/out" || break
done
[ $interrupted -eq 130 ] && grep -q '^| fault' "$scratch/out"
verdict $? "interrupted, it tells of what was done" "$scratch/out"
exit $failed
