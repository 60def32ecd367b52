#!/bin/sh
# monitor.sh: `whirl monitor` records a rig's telemetry without loss, or counts losses as the tests' own decoder does.
# Readers do not disturb the rig, and the line may go and come back. Simulated time (tests/tools/sim_board.c): TEL_SECONDS,
# a minute by default, at 115,200 baud and less.
. "$(dirname "$0")/../checks.sh"
about=monitor

tools=${TOOLS:-build/tools}
seconds=${TEL_SECONDS:-60}
trap 'kill $running 2>/dev/null; rm -rf "$scratch"' EXIT
running=

# record BAUD: writes to $scratch: raw, csv, vcd, text (the rig's), said (monitor's), plant, counts
record() {
    rm -f "$scratch/tty"
    SIM_LINK=$scratch/tty SIM_SECONDS=$seconds SIM_BAUD=$1 "$tools/sim_station" 2>"$scratch/plant" </dev/null &
    rig=$!
    await test -e "$scratch/tty"
    "$whirl" monitor "$scratch/tty" --csv "$scratch/csv" --vcd "$scratch/vcd" --raw "$scratch/raw" \
        >"$scratch/text" 2>"$scratch/said" </dev/null &
    running=$!
    wait $rig
    kill -INT $running
    wait $running
    status=$?
    running=
    "$tools/tel_check" "$scratch/raw" >"$scratch/counts"
    verdict $status "$1 baud: Ctrl-C ends it in order" "$scratch/said"
}
# of NAME: prints a count of the tests' decoder
of() { sed -n "s/.*$1 \([0-9]*\).*/\1/p" "$scratch/counts"; }
# told NAME: prints the same count in monitor's summary
told() {
    grep -q ": $(of samples) samples, $(of pulses) pulses in $(of frames) frames; lost: $(of missing) frames ($(of dropped) because the rig's buffer was full), $(of gaps) samples; damaged frames: 0\$" \
        "$scratch/said"
}

SIM_ALONE=1 SIM_SECONDS=$seconds "$tools/sim_station" 2>"$scratch/alone"
SIM_ALONE=1 SIM_TEL=1 SIM_SECONDS=$seconds "$tools/sim_station" 2>"$scratch/unread"
cmp -s "$scratch/alone" "$scratch/unread" && grep -q '^plant .* steps$' "$scratch/alone"
verdict $? "telemetry that nobody reads does not disturb the rig" "$scratch/unread"

whole=115200
[ "$seconds" -le 60 ] || whole="115200 57600"
for baud in $whole; do
    record $baud
    [ "$(of missing)" = 0 ] && [ "$(of twice)" = 0 ] && [ "$(of damaged)" = 0 ] && [ "$(of gaps)" = 0 ] &&
        [ "$(of samples)" -gt $((seconds * 500 - 1000)) ] && [ "$(of pulses)" -gt $((seconds * 3 / 2)) ]
    verdict $? "$baud baud, $seconds s: none lost, none twice ($(cat "$scratch/counts"))" "$scratch/counts"
    told
    verdict $? "$baud baud: monitor counts as much" "$scratch/said"
    cmp -s "$scratch/alone" "$scratch/plant"
    verdict $? "$baud baud: somebody who reads does not disturb the rig" "$scratch/plant"
    [ "$(grep -c '^\(OK\|ERR\) ' "$scratch/text")" -eq $((4 * (seconds / 60))) ]
    verdict $? "$baud baud: every order's answer has come through" "$scratch/text"
done

# The pulses have the length that the rig's monostable reports with the first end (150 us). Until then they are drawn
# with 100 us.
awk '/^\$var wire 1 . slot/ { slot[$4] = 1 }
     /^#/ { now = substr($0, 2) }
     /^[01]./ && (substr($0, 2) in slot) {
         id = substr($0, 2)
         if ($0 ~ /^1/) { rose[id] = now } else if (id in rose) { n++; long += now - rose[id] == 150; delete rose[id] }
     }
     END { print n " pulses, " long " of 150 us"; exit !(n > 50 && long >= n - 1) }' "$scratch/vcd" >"$scratch/err"
verdict $? "a wave's pulses are as long as they were ($(cat "$scratch/err"))" "$scratch/err"

# Compares the record with the tests' decoder, and with a second record made from the --raw file.
"$tools/tel_check" "$scratch/raw" --csv 0.00678744752 2>/dev/null >"$scratch/wanted"
tr -d '\r' <"$scratch/csv" | sed 1d | awk -F, '{ printf "%s,%.6g\n", $1, $2 }' |
    awk -F, -v wanted="$scratch/wanted" '
        { getline line <wanted; split(line, is, ","); off = is[2] - $2
          if (is[1] != $1 || off > 2e-4 || off < -2e-4) { print NR ": " $0 " is " line; exit 1 } n = NR }
        END { exit !(n > 1000) }' >"$scratch/err"
verdict $? "the records are what the tests' decoder reads"
grep -qx "whirl = \"$("$whirl" --version | sed 's/.* //')\"" "$scratch/csv.toml"
verdict $? "FILE.toml has the version" "$scratch/csv.toml"
head -n 1 "$scratch/csv" | tr -d '\r' | grep -qxF 'time,load [N],speed [rpm],drive [V],state'
verdict $? "their columns have units" "$scratch/csv"
"$whirl" monitor "$scratch/raw" --csv - --vcd "$scratch/vcd2" --quiet >"$scratch/csv2" 2>"$scratch/err" &&
    cmp -s "$scratch/csv" "$scratch/csv2" && cmp -s "$scratch/vcd" "$scratch/vcd2"
verdict $? "and the same from the file that --raw has kept"
awk -v pulses="$(of pulses)" '
    /^\$timescale 1us \$end/ { scale = 1 }
    /^\$var/ { if (!($2 == "wire" && $3 == 1) && !($2 == "real" && $3 == 64)) bad = "$var " $0
               if ($5 ~ /^slot/) wire[$4] = 1
               signals++ }
    /^#/ { at = substr($0, 2) + 0; if (!timed++) last = -1; if (at <= last && timed > 1) bad = "time " $0; last = at }
    /^[01]/ { if (substr($0, 1, 1) == 1) rises++ }
    END { if (rises != pulses) bad = rises " pulses of " pulses
          if (bad || !scale || signals != 7) { print bad; exit 1 } }' "$scratch/vcd" >"$scratch/err"
verdict $? "waves: wires of one bit and reals, time that goes on, every pulse"

record 9600
[ "$(of dropped)" -gt 100 ] && [ "$(of missing)" = "$(of dropped)" ] && [ "$(of twice)" = 0 ] && [ "$(of damaged)" = 0 ]
verdict $? "9600 baud: what is lost is counted by the rig ($(cat "$scratch/counts"))" "$scratch/counts"
told
verdict $? "9600 baud: and by monitor" "$scratch/said"
cmp -s "$scratch/alone" "$scratch/plant"
verdict $? "9600 baud: the rig is not disturbed" "$scratch/plant"
"$whirl" monitor "$scratch/raw" --strict >/dev/null 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'error: data were lost (--strict)' "$scratch/err"
verdict $? "--strict fails of that" "$scratch/err"
"$whirl" monitor "$scratch/raw" --csv /dev/full >/dev/null 2>"$scratch/err"
[ $? -eq 1 ] && grep -q '^/dev/full: error: ' "$scratch/err"
verdict $? "records that cannot be written are no records" "$scratch/err"

if command -v gnuplot >/dev/null; then
    "$whirl" monitor "$scratch/raw" --plot "$scratch/plot.svg" --quiet >/dev/null 2>"$scratch/err" && grep -q '<svg' "$scratch/plot.svg"
    verdict $? "it is drawn" "$scratch/err"
    (
        trap '' XFSZ # the file accepts no more bytes, as on a full disk
        ulimit -f 8
        "$whirl" monitor "$scratch/raw" --plot "$scratch/plot.svg" --quiet
    ) >/dev/null 2>"$scratch/err"
    [ $? -eq 1 ] && grep -q 'could not draw' "$scratch/err"
    verdict $? "half a picture is none" "$scratch/err"
fi
exits 2 'usage: whirl monitor PORT' --rate 500
exits 2 'cannot be opened' "$scratch/none"
exits 2 'cannot be opened: Is a directory' "$scratch"
exits 2 '--rate takes a whole number' "$scratch/raw" --rate 2.5
exits 2 'this speed is not supported' "$scratch/raw" --baud 7
exits 2 'draws .svg, .pdf and .png files' "$scratch/raw" --plot a.txt
exits 2 "takes a file's name" "$scratch/raw" --vcd -
exits 2 '--for takes a number from' "$scratch/raw" --for 0
exits 2 'takes only one line' "$scratch/raw" "$scratch/csv"
if [ -r /proc/self/mem ]; then # a file whose first byte cannot be read
    "$whirl" monitor /proc/self/mem --csv "$scratch/x" >/dev/null 2>"$scratch/err" </dev/null
    [ $? -eq 1 ] && grep -q '^/proc/self/mem: error: reading stopped: ' "$scratch/err"
    verdict $? "a file that cannot be read to its end" "$scratch/err"
fi

# The line goes away and comes back. Then typed text goes to the rig.
RIG_TTY=$scratch/rig.tty RIG_SETTINGS=$scratch/settings
export RIG_TTY RIG_SETTINGS
station() {
    build/station >/dev/null 2>&1 </dev/null &
    rig=$!
    await test -e "$RIG_TTY"
}
# until_said TEXT FILE: waits for the text
until_said() {
    await grep -qs "$1" "$2"
}
rm -f "$scratch/raw" "$scratch/csv"
station
# Old data on the line, half a word and telemetry of a killed program, must not be taken for the rig's.
"$whirl" monitor "$RIG_TTY" --csv "$scratch/csv" >/dev/null 2>&1 </dev/null &
running=$!
until_said '^[0-9]' "$scratch/csv"
verdict $? "records are in their file before it ends" "$scratch/csv"
kill -9 $running && wait $running 2>/dev/null
rm -f "$scratch/csv"
printf sta >"$RIG_TTY"
"$whirl" monitor "$RIG_TTY" --csv "$scratch/csv" --strict >"$scratch/text" 2>"$scratch/said" </dev/null &
running=$!
until_said '^[0-9]' "$scratch/csv"
exits 2 'another program uses this line' "$RIG_TTY" --for 1
kill -INT $running
wait $running && [ ! -s "$scratch/text" ] && ! grep -qv ' samples, 0 pulses in .* lost: 0 .*damaged frames: 0$' "$scratch/said"
verdict $? "what was in the line before is nobody's answer, nobody's words and no loss" "$scratch/said"
running=
"$whirl" monitor "$RIG_TTY" --csv "$scratch/csv" --rate 7 --quiet >"$scratch/text" 2>"$scratch/said" </dev/null &
running=$!
until_said 'refused' "$scratch/said"
kill -INT $running
wait $running
[ $? -eq 1 ] && grep -q 'refused: tel rate 7: ERR 116 ' "$scratch/said" && grep -q 'error: nothing was recorded' "$scratch/said"
verdict $? "a rate that the rig refuses is no success" "$scratch/said"
kill -STOP $rig
"$whirl" monitor "$RIG_TTY" --csv "$scratch/csv" --for 0.2 --quiet >"$scratch/text" 2>"$scratch/said" </dev/null
[ $? -eq 1 ] && grep -q 'nothing was recorded: .* has not answered' "$scratch/said"
verdict $? "nor a rig that does not answer" "$scratch/said"
kill -CONT $rig
rm -f "$scratch/csv"
mkfifo "$scratch/keys"
"$whirl" monitor "$RIG_TTY" --raw "$scratch/raw" --csv "$scratch/csv" >"$scratch/text" 2>"$scratch/said" <"$scratch/keys" &
running=$!
exec 4>"$scratch/keys"
until_said '^[0-9]' "$scratch/csv" # waits for samples
kill $rig && wait $rig 2>/dev/null
until_said 'is disconnected; waiting' "$scratch/said"
verdict $? "it is told that the line is gone" "$scratch/said"
: >"$scratch/raw"
station
until_said 'rate=500 ' "$scratch/raw"
echo id >&4
until_said '^OK program=rig board=host' "$scratch/text"
verdict $? "the rig is back, asked anew, and what is typed goes to it" "$scratch/text"
echo 'tel off' >&4
sleep 0.2
echo 'tel rate 250' >&4
sleep 0.3
kill -INT $running
wait $running
status=$?
running=
exec 4>&-
[ $status -eq 0 ] && grep -q 'opened 2 times, the rig restarted 1 times' "$scratch/said" && grep -q ' lost: 0 frames .*, 0 samples; damaged frames: 0$' "$scratch/said"
verdict $? "nothing is taken for lost that another rig would have sent, or that nobody has asked for" "$scratch/said"
tr -d '\r' <"$scratch/csv" | awk -F, 'NR > 1 { if ($1 <= last && NR > 2) bad = 1; last = $1 } END { exit bad || NR < 100 }'
verdict $? "and time goes on in the records" "$scratch/csv"
kill $rig && wait $rig 2>/dev/null

# If nobody types for three times the `host` limit, the run continues while it is recorded. It ends when the recorder
# hangs.
station
"$whirl" monitor "$RIG_TTY" --csv "$scratch/csv" --quiet >"$scratch/text" 2>"$scratch/said" <"$scratch/keys" &
running=$!
exec 4>"$scratch/keys"
until_said '^[0-9]' "$scratch/csv"
sleep 1.6 # until the rig rests
printf 'host 1\nconf get host\narm\nstart 330\n' >&4
sleep 3
echo status >&4
until_said '^OK state=.* host_losses=0 run=1 ended=none' "$scratch/text"
verdict $? "a run that is recorded does not lose its host" "$scratch/text"
kill -STOP $running
sleep 1.6
kill -CONT $running
echo status >&4
until_said '^OK state=.* host_losses=1 run=1 ended=host_lost' "$scratch/text"
verdict $? "and does when the recorder hangs" "$scratch/text"
kill -INT $running
wait $running 2>/dev/null
running=
exec 4>&-
kill $rig && wait $rig 2>/dev/null
exit $failed
