#!/bin/sh
# rig.sh WHIRL samples|spikes|ratios|speeds|radii: measurements of the rig's firmware in the loop with its bench
# (docs/plants), from the tape of a run or from its report. build/pil_rig and build/pil_carriage must be in WHIRL's folder.
#
#   samples   the load in 2 s of the record, after the firmware's tare: time [s], load [N]
#   spikes    as an oscilloscope shows the same 2 s: time [s], sensor 1, sensor 2 [V]. Each slot pulse is a spike as
#             high as the load at its time, with 6 V for 10 lbf; the pulses themselves have 10 V and 6 V
#   ratios    the force on a carriage, divided by that on a fixed mount: ratio of the weights, quotient
#   speeds    the carriage, by the measured force: speed [rpm], displacement [mm], frequency [Hz]
#   radii     the same, for radii of the discs [in] instead of speeds
set -eu
whirl=$1 what=$2
build=$(dirname "$whirl")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# carriage OPTION...: amplitude [N], displacement [m] and speed [rpm], as the firmware on the carriage reports them
carriage() {
    "$whirl" pil docs/plants/carriage.whirl --with cell_noise --firmware "$build/pil_carriage" "$@" >"$scratch/said" &&
        awk '$1 == "speed" && !n++ { speed = $2 }
            /^notes/ { for (i = 1; i < NF; i++) told[$i] = $(i + 1) }
            END { print told["amplitude"], told["displacement"], speed }' "$scratch/said"
}

case $what in
samples | spikes)
    "$whirl" pil docs/plants/rig.whirl --with cell_noise --jitter 20us --firmware "$build/pil_rig" --tape "$scratch/tape" \
        >"$scratch/said"
    "$whirl" pil --read "$scratch/tape" | awk -F, -v what="$what" '
        function volts(newtons) { return newtons / 4.4482216 * 0.6 }
        function spike(channel, at, from,    high) {
            high = from + (channel == 1 ? 10 : 6)
            printf channel == 1 ? "%.6f,%.4f,\n%.6f,%.4f,\n%.6f,%.4f,\n\n" : "%.6f,,%.4f\n%.6f,,%.4f\n%.6f,,%.4f\n\n",
                at, from, at, high, at, from
        }
        BEGIN { print what == "samples" ? "time,load" : "time,one,two" }
        $5 == "state" { state = $6; if (state == 13) begin = $1 } # states of core/rig: 9 is the tare, 13 the record
        $5 == "cell_force" && state == 9 { tare += $6; tares++ }
        state < 13 || $1 - begin > 2 { next }
        $5 == "cell_force" {
            load = $6 - tare / tares
            if (what == "samples") printf "%.6f,%.4f\n", $1 - begin, load
            else for (i = 1; i <= waiting; i++)
                spike(channel[i], edge[i] - begin, volts(before + (load - before) * (edge[i] - last) / ($1 - last)))
            waiting = 0; before = load; last = $1
        }
        $3 == "edge" && last > 0 { channel[++waiting] = $4; edge[waiting] = $1 }'
    ;;
ratios)
    echo "ratio,part"
    held=$(carriage --set ratio=1e-9 | cut -d' ' -f1)
    for ratio in 0.02 0.05 0.1 0.15 0.2 0.25 0.3 1/3 0.4 0.5 0.75 1; do
        carriage --set ratio=$ratio | awk -v ratio=$ratio -v held="$held" '
            { split(ratio, r, "/"); printf "%.4f,%.5f\n", r[1] / (r[2] ? r[2] : 1), $1 / held }'
    done
    ;;
speeds | radii)
    name=speed set=speed unit=rpm values="170 200 230 260 300 330 360"
    [ "$what" = speeds ] || { name=radius set=r_disc unit=in values="2 3 4 5 6 6.5 7"; }
    echo "$name,displacement_mm,frequency_Hz"
    for value in $values; do
        carriage --set "$set=$value [$unit]" | awk -v value="$value" '{ printf "%s,%.4f,%.5f\n", value, 1e3 * $2, $3 / 60 }'
    done
    ;;
*) echo "rig.sh: samples, spikes, ratios, speeds or radii, not '$what'" >&2; exit 2 ;;
esac
