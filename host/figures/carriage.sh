#!/bin/sh
# carriage.sh WHIRL speed|radius|ratio: the eccentric-mass rig on its free carriage, while one thing
# changes: the arms' speed [rpm], the discs' radius [in], or the eccentric weight over the carriage's.
# Prints that, `amplitude_mm` of the carriage, `frequency_Hz` of its motion and `relative_force`, the
# largest pin force over that of the carriage held fast at 330 rpm.
set -eu
whirl=$1 what=$2
held_N=$("$whirl" run carriage_fixed --quiet --columns - | awk '
    NR == 1 { for (i = 2; i <= NF; i++) if ($i == "pin_force") f = i - 1; next }
    { if ($f > most) most = $f }
    END { printf "%.9g", most }')
echo "$what,amplitude_mm,frequency_Hz,relative_force"
case $what in
speed) values="60 90 120 150 180 210 240 270 300 330 360" ;;
radius) values="1 2 3 4 5 6 6.5 7 8" ;;
ratio) values="0.01 0.05 0.1 0.15 0.2 0.25 0.333333333333 0.4 0.5 0.6 0.7 0.8 0.9 1" ;;
esac
for value in $values; do
    case $what in
    speed) set -- --start "theta'=$value [rpm]" --until 4s ;;
    radius) set -- --set "r_disc=$value [in]" ;;
    ratio) set -- --set "ratio=$value" ;;
    esac
    "$whirl" run carriage_free "$@" --quiet --columns - | awk -v value="$value" -v held_N="$held_N" '
        NR == 1 { for (i = 2; i <= NF; i++) if ($i == "pin_force") f = i - 1; next }
        {
            if (NR == 2 || $3 > high) high = $3
            if (NR == 2 || $3 < low) low = $3
            force = $f < 0 ? -$f : $f
            if (force > most) most = force
            # whole periods of the velocity, from one upward passage of zero to the last
            if (NR > 2 && before < 0 && $5 >= 0) {
                last = $1 - 0.001 * $5 / ($5 - before)
                if (n++ == 0) first = last
            }
            before = $5
        }
        END { printf "%s,%.6f,%.6f,%.6f\n", value, 500 * (high - low), (n - 1) / (last - first),
                most / held_N }'
done
