#!/bin/sh
# carriage.sh WHIRL speed|radius: the eccentric-mass rig on its free carriage, while one thing
# changes: the arms' speed [rpm] or the discs' radius [in]. Prints that, `amplitude_mm` of the carriage
# and `frequency_Hz` of its motion.
set -eu
whirl=$1 what=$2
echo "$what,amplitude_mm,frequency_Hz"
case $what in
speed) values="60 90 120 150 180 210 240 270 300 330 360" ;;
radius) values="1 2 3 4 5 6 6.5 7 8" ;;
esac
for value in $values; do
    case $what in
    speed) set -- --start "theta'=$value [rpm]" --until 4s ;;
    radius) set -- --set "r_disc=$value [in]" ;;
    esac
    "$whirl" run carriage_free "$@" --quiet --columns - | awk -v value="$value" '
        /^%/ { next }
        {
            if (!seen || $3 > high) high = $3
            if (!seen || $3 < low) low = $3
            # whole periods of the velocity, from one upward passage of zero to the last
            if (seen && before < 0 && $5 >= 0) {
                last = $1 - 0.001 * $5 / ($5 - before)
                if (n++ == 0) first = last
            }
            before = $5
            seen = 1
        }
        END { printf "%s,%.6f,%.6f\n", value, 500 * (high - low), (n - 1) / (last - first) }'
done
