#!/bin/sh
# starts.sh WHIRL SPEED HOLD: starts Thomson's device with the arm at SPEED [rad/s] and disc 33 at HOLD [rad], and
# eight more times with disc 33 a milliradian further each time. The motion is chaotic, so a single run says little.
# Prints `reversals,width_m`: the number of reversals of the carriage in 10 s, and the distance between its extremes.
# The scene's fine step is not needed for these.
set -eu
whirl=$1 speed=$2 hold=$3
echo reversals,width_m
for k in 0 1 2 3 4 5 6 7 8; do
    "$whirl" run thomson_b --start "theta1'=$speed" --start "theta2=$hold+0.001*$k" \
        --step 0.25ms --every 1ms --quiet --columns - | awk '
        /^%/ { next }
        { if (!seen || $4 > high) high = $4
          if (!seen++ || $4 < low) low = $4
          if (before * $7 < 0) reversals++
          before = $7 }
        END { printf "%d,%.6g\n", reversals, high - low }'
done
