#!/bin/sh
# tape.sh: what `whirl monitor --tape` records of a rig's station, `whirl pil --replay` gives to its controller again, which must
# answer the same to the bit: whole runs, and drawn ones with settings, orders, an unsteady supply and hardware that fails
# (tests/tools/sim_board.c, in simulated time). A recording with a loss says so, and ends there. WHIRL_SEED, WHIRL_CASES: other
# drawn ones, and how many.
. "$(dirname "$0")/../checks.sh"

ulimit -f 400000 # a writer that does not end is ended
build=$(dirname "$whirl")
tools=${TOOLS:-build/tools}
seed=${WHIRL_SEED:-1}
cases=${WHIRL_CASES:-${WHIRL_FULL:+12}}
cases=${cases:-2}
trap 'kill $running 2>/dev/null; rm -rf "$scratch"' EXIT
running=

# record NAME SECONDS BAUD SEED: $scratch/NAME.tape, .raw, .csv, .said (what monitor said); SEED 0: orders of every minute
record() {
    rm -f "$scratch/tty"
    SIM_LINK=$scratch/tty SIM_SECONDS=$2 SIM_BAUD=$3 SIM_SEED=$4 "$tools/sim_station" 2>"$scratch/plant" </dev/null &
    rig=$!
    await test -e "$scratch/tty"
    "$whirl" monitor "$scratch/tty" --tape "$scratch/$1.tape" --raw "$scratch/$1.raw" --csv "$scratch/$1.csv" \
        >"$scratch/text" 2>"$scratch/$1.said" </dev/null &
    running=$!
    wait $rig
    kill -INT $running
    wait $running
    status=$?
    running=
    return $status
}
# steps NAME: how many there are, as monitor says
steps() { sed -n 's/^whirl monitor: tape: \([0-9]*\) control steps.*/\1/p' "$scratch/$1.said"; }
# replays NAME [IMAGE]: the whole of it is answered as on the tape; with the begin it is an exchange more
replays() {
    sh tests/limit.sh 60 "$whirl" pil --replay "$scratch/$1.tape" --firmware "${2:-$build/pil_taped}" >"$scratch/out" 2>"$scratch/err" &&
        grep -q '^command stream .*, as on the tape$' "$scratch/out" &&
        [ "$(sed -n 's/^exchanges  *\([0-9]*\) .*/\1/p' "$scratch/out")" -eq $(($(steps "$1") + 1)) ]
}
# rows NAME: what it has
rows() { "$whirl" pil --read "$scratch/$1.tape" | tr -d '\r'; }
stream() { sed -n 's/^command stream  *\([^,]*\).*/\1/p' "$scratch/out"; }

# --- a whole run -----------------------------------------------------------------------------------------------------
record run 80 115200 0
verdict $? "a run is recorded" "$scratch/run.said"
grep -q 'tape: [0-9]* control steps, [78][09]\.[0-9]* s; no more of it was heard$' "$scratch/run.said" && grep -q 'lost: 0 frames' "$scratch/run.said"
verdict $? "from its begin on, without a loss" "$scratch/run.said"
rows run | awk -F, '$5 == "state" { printf "%s ", $6 }' >"$scratch/states"
[ "$(cat "$scratch/states")" = "0 1 9 10 11 12 13 14 15 0 " ]
verdict $? "armed, started, measured, at rest" "$scratch/states"
replays run
verdict $? "its tape gives the same answers here" "$scratch/err"
wanted=$(stream)
if [ -e "$build/mps2-an386/pil_taped.elf" ] && command -v qemu-system-arm >/dev/null; then
    replays run "$build/mps2-an386/pil_taped.elf" && [ "$(stream)" = "$wanted" ]
    verdict $? "and on an emulated Cortex-M4F" "$scratch/err"
fi
# The load that the run's channel has is the tape's: so many counts, one after the other, from where the tape begins.
rows run | awk -F, '$5 == "load_raw" { print $6 }' >"$scratch/counts"
awk -F, -v counts="$scratch/counts" '
    BEGIN { while ((getline line <counts) > 0) count[n++] = line + 0 }
    FNR > 1 { load[m++] = $2 }
    END { scale = 222.41108 / 32768
        for (at = 0; at < 2000; at++) {
            for (i = 0; i < n && i + at < m; i++) { off = load[i + at] - count[i] * scale; if (off > 1e-4 || off < -1e-4) break }
            if (i + at >= m || i >= n) { if (i > 8000) exit 0 }
            for (i = 0; i < n && i < m; i++) { off = load[i] - count[i + at] * scale; if (i + at >= n) break; if (off > 1e-4 || off < -1e-4) break }
            if (i > 8000) exit 0
        }
        exit 1 }' "$scratch/run.csv"
verdict $? "its samples are those of the CSV" "$scratch/counts"
"$whirl" monitor "$scratch/run.raw" --tape "$scratch/again.tape" --quiet >/dev/null 2>"$scratch/err" && cmp "$scratch/run.tape" "$scratch/again.tape"
verdict $? "from what --raw has kept comes the same tape"
sh tests/limit.sh 60 "$whirl" pil --replay "$scratch/run.tape" --firmware "$build/pil_rig" >/dev/null 2>"$scratch/err"
[ $? -eq 2 ] && grep -q "is of 'rig_taped'" "$scratch/err"
verdict $? "another firmware does not take it"

# --- drawn ones ------------------------------------------------------------------------------------------------------
k=0
while [ $k -lt "$cases" ]; do
    record drawn 15 115200 $((seed + k)) && replays drawn
    verdict $? "seed $((seed + k)): $(steps drawn) steps, $(rows drawn | awk -F, '$5 == "order" { n++ } END { print n + 0 }') orders, the same answers" "$scratch/err"
    [ "$(rows drawn | grep -c ',setting,')" -ge 4 ]
    verdict $? "with the settings of the rig"
    k=$((k + 1))
done
# A replay that sees something else answers something else: of another seed's tape the inputs, of this one the answers.
rows run | grep -q ',volts,'
verdict $? "answers are on it"

# --- losses ----------------------------------------------------------------------------------------------------------
# cut NAME FROM BYTES: so many bytes of the run are not there
cut_out() {
    { head -c "$2" "$scratch/run.raw" && tail -c +$(($2 + $3 + 1)) "$scratch/run.raw"; } >"$scratch/$1.raw"
    "$whirl" monitor "$scratch/$1.raw" --tape "$scratch/$1.tape" >/dev/null 2>"$scratch/$1.said"
}
size=$(wc -c <"$scratch/run.raw")
for part in 3 5 7; do
    cut_out cut $((size * part / 10)) $((part * 30)) && grep -q 'it ends there: a frame of it was lost$' "$scratch/cut.said"
    verdict $? "$((part * 30)) bytes lost: told" "$scratch/cut.said"
    [ "$(steps cut)" -gt 1000 ] && [ "$(steps cut)" -lt "$(steps run)" ] && replays cut
    verdict $? "and $(steps cut) steps up to there replay" "$scratch/err"
    "$whirl" monitor "$scratch/cut.raw" --tape "$scratch/cut.tape" --strict >/dev/null 2>&1
    [ $? -eq 1 ]
    verdict $? "--strict fails of it"
done
record slow 8 19200 0 && grep -q 'it ends there: the line was too slow for it$' "$scratch/slow.said" && replays slow
verdict $? "a line that is too slow for it: told, $(steps slow) steps replay" "$scratch/slow.said"

# --- refused ---------------------------------------------------------------------------------------------------------
head -c 300 "$scratch/run.raw" >"$scratch/none.raw"
"$whirl" monitor "$scratch/none.raw" --tape "$scratch/none.tape" >/dev/null 2>"$scratch/err"
[ $? -eq 1 ] && grep -q 'error: no tape was begun' "$scratch/err" && grep -q '^hint: it begins while the rig is idle' "$scratch/err"
verdict $? "no tape is none"
"$whirl" monitor "$scratch/run.raw" --tape - >/dev/null 2>"$scratch/err"
[ $? -eq 2 ] && grep -q "error: --tape takes a file's name" "$scratch/err"
verdict $? "- is no tape"
"$whirl" monitor "$scratch/run.raw" --tape /dev/full >/dev/null 2>"$scratch/err"
[ $? -eq 1 ] && grep -q '^/dev/full: error: ' "$scratch/err"
verdict $? "a tape that cannot be written is told"
exit $failed
