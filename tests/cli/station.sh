#!/bin/sh
# station.sh: the rig's console on a pseudo-terminal and on the UART of an emulated board. Each line has an answer, nothing
# moves without arm and start, and nothing remains, however the program ends.
. "$(dirname "$0")/../checks.sh"

station=${STATION:-build/station}
RIG_TTY=$scratch/rig.tty
RIG_SETTINGS=$scratch/rig.settings
export RIG_TTY RIG_SETTINGS
running=
trap 'kill $running 2>/dev/null; rm -rf "$scratch"' EXIT

begin() {
    "$station" >"$scratch/said" 2>"$scratch/err" </dev/null &
    running=$!
    await test -e "$RIG_TTY"
    exec 3<>"$RIG_TTY"
}
# ask LINE: sends the line; the answer is in $answer
ask() {
    printf '%s\r' "$1" >&3
    answer=
    hear
}
hear() {
    IFS= read -r answer <&3
    answer=${answer%"$(printf '\r')"}
}
# says LINE BEGIN WHAT: the answer to the line must begin in this way
says() {
    ask "$1"
    case $answer in
    "$2"*) status=0 ;;
    *) status=1 ;;
    esac
    echo "$1: $answer" >"$scratch/heard"
    verdict $status "$3" "$scratch/heard"
}
# soon BEGIN: waits up to ten minutes until status begins in this way
soon() {
    for _ in $(seq 1200); do
        ask status
        case $answer in "$1"*) return 0 ;; esac
        sleep 0.5
    done
    echo "status: $answer" >"$scratch/heard"
    return 1
}
# converse BOARD: a conversation from reset to a stop
converse() {
    says id "OK program=rig board=$1 dialogue=1" "$1: it says what it is"
    says 'start 330' 'ERR 1 ' "$1: nothing starts that is not armed"
    soon 'OK state=idle speed_rpm=0.00'
    verdict $? "$1: the rotor is known to rest" "$scratch/heard"
    says 'conf set phase_floor 0.5' 'OK phase_floor=0.5' "$1: a setting is set"
    says 'conf save' "OK sequence=${2:-1}" "$1: and saved"
    says arm 'OK arm' "$1: arm"
    says 'conf save' 'ERR 107 ' "$1: settings are written in idle only"
    says 'start 330' 'OK start' "$1: start"
    soon 'OK state=ramp '
    verdict $? "$1: the rotor turns" "$scratch/heard"
    says 'set 20' 'ERR 14 ' "$1: a set-point that cannot be held is refused while it runs"
    printf 'half a line\033' >&3
    hear
    [ "$answer" = 'OK stop' ]
    verdict $? "$1: Escape stops" "$scratch/heard"
    says 'talk on' 'OK' "$1: it will talk"
    ask fault
    [ "$answer" = fault ] && hear && [ "$answer" = 'OK trip=0 ended=stop_command: no fault' ]
    verdict $? "$1: what is typed is seen, and answered" "$scratch/heard"
}

begin
grep -qF "$RIG_TTY" "$scratch/said"
verdict $? "the terminal's name is said"
converse host
exec 3>&-
exec 3<>"$RIG_TTY"
ask 'talk off' # first the echo, then the answer
hear
says fault 'OK trip=0' "somebody else is at the terminal, and is answered"
exec 3>&-
for signal in INT TERM HUP; do
    if [ -z "$running" ]; then
        begin
        says 'conf get phase_floor' 'OK phase_floor=0.5 ' "$signal: what was saved is there the next time"
        exec 3>&-
    fi
    kill -s $signal "$running"
    wait "$running" 2>/dev/null
    status=$?
    running=
    [ ! -e "$RIG_TTY" ] && [ ! -L "$RIG_TTY" ] && [ $status -gt 128 ]
    verdict $? "ended by $signal ($status): no link is left"
done

# A link that an earlier run left is replaced; a file is not.
ln -s /nowhere "$RIG_TTY"
begin
says id 'OK ' "a dead link is replaced"
exec 3>&-
first=$running
: >"$scratch/said" # removes the first program's output before new output is awaited
RIG_SETTINGS=$scratch/others "$station" >"$scratch/said" 2>"$scratch/err" </dev/null &
running=$!
await grep -q 'console is' "$scratch/said"
kill "$first" && wait "$first" 2>/dev/null
grep -q "belonged to another running rig" "$scratch/err" && [ -e "$RIG_TTY" ]
verdict $? "a second rig says whose link it takes, and keeps it when the first one ends" "$scratch/err"
kill "$running" && wait "$running" 2>/dev/null
running=
echo mine >"$RIG_TTY"
"$station" >"$scratch/said" 2>"$scratch/err" </dev/null
[ $? -eq 2 ] && [ "$(cat "$RIG_TTY")" = mine ] && grep -q 'hint: choose another path: RIG_TTY' "$scratch/err"
verdict $? "a file in its place stays, and is named"
rm "$RIG_TTY"
RIG_TTY=$scratch/none/rig.tty "$station" >"$scratch/said" 2>"$scratch/err" </dev/null
[ $? -eq 2 ] && grep -q 'none/rig.tty: error: ' "$scratch/err"
verdict $? "a folder that is not there is named"

# The same image as on a board. Its UART is a pseudo-terminal of the emulator.
image=build/mps2-an386/station.elf
if [ -f $image ] && command -v qemu-system-arm >/dev/null; then
    qemu-system-arm -M mps2-an386 -display none -monitor none -serial pty -kernel $image \
        -semihosting-config enable=on,target=native >"$scratch/emulator" 2>&1 </dev/null &
    running=$!
    await grep -q '/dev/' "$scratch/emulator"
    terminal=$(grep -o '/dev/[^ ]*' "$scratch/emulator")
    stty -F "$terminal" raw -echo
    exec 3<>"$terminal"
    converse mps2-an386
    exec 3>&-
fi
exit $failed
