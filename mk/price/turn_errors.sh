#!/bin/sh
# turn_errors.sh: how far off the motion is whose accelerations are looked up in tables (--tables), beside the forms that
# compute them. `make bench-tables` calls it with WHIRL and OUT.
#
# Prints, for each of SCENES and SETTINGS, float, float with compensated sums and double: the largest error of the angle at the scene's own step until
# UNTIL against the exact form in double at a sixteenth of the step, compensated; and of the same mechanism turning freely
# (its inputs and losses 0) what energy it has gained or lost, of what it had, at the end of STEPS steps.
set -eu
: "${WHIRL:=build/whirl}"
: "${OUT:=build/turn_errors}"
: "${SETTINGS:=turned lookup linear_64 linear_256 linear_1024 cubic_16 cubic_32 cubic_64 cubic_128 cubic_256}"
: "${STEPS:=1000000}"
mkdir -p "$OUT"

options_of() { # options_of SETTING
    case $1 in
    turned | lookup) echo "--angles $1" ;;
    *) echo "--tables ${1%_*} --cells ${1#*_}" ;;
    esac
}

# scene_of SCENE: until when; and what makes it free
until_of() { case $1 in rig_*) echo 10s ;; *) echo 9s ;; esac; }
free_of() {
    case $1 in
    rig_*) echo "--set duty=0 --set b=0 --set stall=0 --start theta'=30" ;;
    *) echo "--set M=0 --start theta'=6" ;;
    esac
}

motion() { # motion FILE SCENE OPTION...: time and angle, every 10 ms
    file=$1
    shift
    "$WHIRL" run "$@" --strict=off --quiet --every 10ms --csv "$file"
}

# The largest difference in column 2.
most() {
    awk -F, 'FNR == 1 { next }
        FNR == NR { at[FNR] = $2; next }
        { off = $2 - at[FNR]; if (off < 0) off = -off; if (off > worst) worst = off }
        END { printf "%.1e", worst }' "$1" "$2"
}

drift() { # drift SCENE OPTION...: the energy's, of what there was
    "$WHIRL" run "$@" --step 1ms --until "$((STEPS / 1000))s" | awk '
        /^energy book/ { book = 1 }
        book && $1 == "kinetic" { begin += $2; finish += $4 }
        book && $1 == "left" { left = $3 }
        END { printf "%.1e", (left < 0 ? -left : left) / begin }'
}

echo "scene setting float compensated double drift_float drift_double"
for scene in ${SCENES:-epicyclic_conserved rig_fixed}; do
    end=$(until_of "$scene")
    motion "$OUT/exact.csv" "$scene" --until "$end" --step 0.0625ms --compensated
    for setting in $SETTINGS; do
        how=$(options_of "$setting")
        row="$scene $setting"
        for number in float "float --compensated" double; do
            # shellcheck disable=SC2086 # a list of words
            motion "$OUT/now.csv" "$scene" --until "$end" --number $number $how
            row="$row $(most "$OUT/exact.csv" "$OUT/now.csv")"
        done
        for number in float double; do
            # shellcheck disable=SC2046,SC2086
            row="$row $(drift "$scene" $(free_of "$scene") --number $number $how)"
        done
        echo "$row"
    done
done
