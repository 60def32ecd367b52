#!/bin/sh
# pil_line.sh: `whirl pil --port`: firmware at the other end of a serial line. It is this machine's program on a
# pseudo-terminal (build/pil_line), or a board's own UART in QEMU. The command stream equals the one through pipes. Dials,
# ends and refusals come over the line, and faults of the line are reported.
. "$(dirname "$0")/../checks.sh"
about=pil

build=$(dirname "$whirl")
plant=docs/plants/rig.whirl
board=
trap 'kill -9 $board 2>/dev/null; rm -rf "$scratch"' EXIT

wait_for_tty() { await test -e "$scratch/tty"; }
# plug: starts a board at $scratch/tty
plug() {
    rm -f "$scratch/tty"
    RIG_TTY=$scratch/tty "$build/pil_line" >"$scratch/said" 2>&1 &
    board=$!
    wait_for_tty
}
unplug() {
    kill -9 $board 2>/dev/null
    wait $board 2>/dev/null
    board=
}
# run WORD...: runs the plant over the line
run() {
    sh tests/limit.sh 120 "$whirl" pil "$plant" --port "$scratch/tty" --step 200us "$@" >"$scratch/out" 2>"$scratch/err"
}
stream() { sed -n 's/^command stream  *//p' "$1"; }

# --- runs ---------------------------------------------------------------------------------------------------------------
for case in '--set speed=330rpm' '--set speed=120rpm --jitter 20us --seed 5' '--set speed=250rpm --fault edge-dead:2@9s'; do
    sh tests/limit.sh 120 "$whirl" pil "$plant" --firmware "$build/pil_dialled" --step 200us --cycles 0 $case >"$scratch/pipes" 2>/dev/null
    wanted=$?
    plug
    run --tape "$scratch/tape" $case
    got=$?
    wait $board
    ended=$?
    board=
    [ $got -eq $wanted ] && [ $ended -eq $wanted ] && [ -n "$(stream "$scratch/out")" ] &&
        [ "$(stream "$scratch/out")" = "$(stream "$scratch/pipes")" ]
    verdict $? "$case: status $wanted, and the same command stream as through pipes" "$scratch/err"
done
"$whirl" pil --replay "$scratch/tape" --firmware "$build/pil_dialled" >"$scratch/out" 2>&1
[ "$(stream "$scratch/out" | cut -d, -f1)" = "$(stream "$scratch/pipes")" ]
verdict $? "its tape is one of any firmware's" "$scratch/out"
plug
sh tests/limit.sh 120 "$whirl" pil --replay "$scratch/tape" --port "$scratch/tty" >"$scratch/out" 2>"$scratch/err"
[ $? -le 1 ] && grep -q 'as on the tape' "$scratch/out"
verdict $? "a tape is replayed over the line" "$scratch/err"
unplug

# --- errors on the line --------------------------------------------------------------------------------------------------
exits 2 'excludes --firmware' "$plant" --port "$scratch/tty" --firmware "$build/pil_rig"
exits 2 'excludes --board' "$plant" --port "$scratch/tty" --board mps2-an386
exits 2 'this speed is not supported' "$plant" --port "$scratch/tty" --baud 12345
exits 2 'cannot be opened' "$plant" --port "$scratch/none"
exits 2 "^'': error: cannot be opened" "$plant" --port ''
exits 2 'Is a directory' "$plant" --port "$scratch"
exits 2 'not a serial line' "$plant" --port /dev/null
plug
kill -STOP $board
exits 1 'has sent no message for 0.6 s' "$plant" --port "$scratch/tty" --patience 0.6 # but its hello
kill -CONT $board
run --until 1s --set speed=330rpm
[ $? -eq 0 ]
verdict $? "who was asked before there was an answer is not confused by it" "$scratch/err"
exits 2 '(hello) has not come over the line in 0.6 s' "$plant" --port "$scratch/tty" --patience 0.6
unplug
rm -f "$scratch/tty" # a rig that answers all the time, but never sends its hello
RIG_TTY=$scratch/tty "$build/station" >"$scratch/said" 2>&1 &
board=$!
wait_for_tty
while printf 'id\r'; do sleep 0.02; done >"$scratch/tty" 2>/dev/null &
asks=$!
sh tests/limit.sh 10 "$whirl" pil "$plant" --port "$scratch/tty" --patience 0.6 >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q '(hello) has not come' "$scratch/err"
verdict $? "who babbles is as good as silent" "$scratch/err"
kill -9 $asks 2>/dev/null
wait $asks 2>/dev/null
unplug
for seed in 1 2 3; do # the line is lost at some instant: when the tape has so many bytes
    plug
    : >"$scratch/tape"
    (
        while [ "$(wc -c <"$scratch/tape")" -lt $((seed * 30000)) ]; do sleep 0.02; done
        kill -9 $board
    ) &
    run --seed $seed --set speed=330rpm --tape "$scratch/tape"
    [ $? -eq 1 ] && grep -q 'serial line is disconnected' "$scratch/err" && grep -q '^exchanges' "$scratch/out"
    verdict $? "a board that goes away is told, and what it had done" "$scratch/err"
    unplug
done 2>/dev/null

# --- a board's UART, in the emulator ---------------------------------------------------------------------------------------
image=build/mps2-an386/pil_line.elf
if command -v qemu-system-arm >/dev/null 2>&1 && [ -e "$image" ]; then
    qemu-system-arm -M mps2-an386 -display none -monitor none -serial pty -icount shift=6,align=off,sleep=off \
        -semihosting-config enable=on,target=native -kernel "$image" >"$scratch/qemu" 2>&1 &
    board=$!
    await grep -qs /dev/pts "$scratch/qemu"
    sh tests/limit.sh 120 "$whirl" pil "$plant" --port "$(grep -o '/dev/pts/[0-9]*' "$scratch/qemu")" --step 200us --until 0.3s \
        --set speed=330rpm --patience 60 --tape "$scratch/tape" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 0 ] && grep -q 'on board mps2-an386' "$scratch/out"
    verdict $? "firmware on an emulated board's UART" "$scratch/err"
    unplug
    "$whirl" pil --replay "$scratch/tape" --firmware "$build/pil_dialled" >"$scratch/out" 2>&1
    grep -q 'as on the tape' "$scratch/out"
    verdict $? "answers as this machine's does" "$scratch/out"
fi
exit $failed
