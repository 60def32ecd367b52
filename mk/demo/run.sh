#!/bin/sh
# run.sh: the whole way once, for someone who sees Whirl for the first time: energies, equations,
# motion, firmware. Called by `make run`, which has built everything that is used here.
#
#     sh mk/demo/run.sh WHIRL SCENES_ELF FIRMWARE_ELF EMULATE...
#
# WHIRL is the program, the two images are for the emulated board, and EMULATE is the command that
# runs an image, with IMAGE where its path belongs. Exit status 0 when everything agreed.
set -eu

whirl=$1 scenes=$2 firmware=$3
shift 3
emulate="$*"
out=build/run
rm -rf "$out"
mkdir -p "$out"
failed=0

title() { printf '\n=== %s\n\n' "$*"; }
run_image() { # run_image FILE: the image's console output
    sh -c "$(printf '%s' "$emulate" | sed "s|IMAGE|$1|")"
}

# --- energies -------------------------------------------------------------------------------------
title "1. The energies of an epicyclic gear on a carriage (core/models/epicyclic.whirl)"
# from the mechanism's name to its first effect
lines=$("$whirl" list --as table core/models/epicyclic.whirl | awk -F '\t' '
    $1 == "mechanism" { first = $5 } $1 == "effect" { print first "," $5 - 1; exit }')
sed -n "${lines}p" core/models/epicyclic.whirl

title "2. Its equations of motion (build/whirl derive core/models/epicyclic.whirl)"
"$whirl" derive core/models/epicyclic.whirl | sed -n '/^equations of motion/,$p'

# --- motion ---------------------------------------------------------------------------------------
title "3. The motion, on this computer, in double and in the boards' float"
# simulate SCENE CM: runs both ways; sets hash_SCENE and spread_SCENE.
simulate() {
    scene=$1 cm=$2
    "$whirl" run "$scene" --number float >"$out/$scene.float.txt"
    "$whirl" run "$scene" --every 1ms --csv "$out/$scene.csv" --plot "$out/$scene.svg" >"$out/$scene.txt"
    "$whirl" run "$scene" --every 1ms --plot "$out/$scene.png" --quiet
    sed -n '1,2p' "$out/$scene.txt"
    hash=$(sed -n 's/^state hash *//p' "$out/$scene.float.txt")
    eval "hash_$scene=$hash"
    # the centre of mass must stay where it started; anything else is the method's error
    spread=$(tr -d '\r' <"$out/$scene.csv" | awk -F, -v name="$cm" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i; next }
        NR == 2 { start = $c }
        { d = $c - start; if (d < 0) d = -d; if (d > worst) worst = d }
        END { printf "%.1e", worst }')
    eval "spread_$scene=$spread"
    printf '  the centre of mass moves by at most %s m\n' "$spread"
}
simulate epicyclic_from_rest x_cm
simulate thomson_a x_cm

# --- the same bits on a controller ----------------------------------------------------------------
title "4. The same scenes on an emulated Cortex-M4F (QEMU, mps2-an386)"
run_image "$scenes" >"$out/board_scenes.txt"
compare() {
    scene=$1
    board=$(sed -n "s/^scene $scene steps [0-9]* hash \(0x[0-9a-f]*\) ok\$/\1/p" "$out/board_scenes.txt")
    eval "here=\$hash_$scene"
    if [ -n "$board" ] && [ "$board" = "$here" ]; then
        eval "same_$scene='the same bits'"
    else
        eval "same_$scene=DIFFERENT"
        failed=1
    fi
    printf '  %-22s PC float %s   board %s\n' "$scene" "$here" "${board:-missing}"
}
compare epicyclic_from_rest
compare thomson_a

# --- the rig --------------------------------------------------------------------------------------
title "5. The eccentric-mass rig: its controller as firmware, motor and sensors emulated"
if run_image "$firmware" >"$out/rig.txt"; then
    rig="ran to its end and stopped safely"
else
    rig=FAILED
    failed=1
fi
cat "$out/rig.txt"
"$whirl" run rig_fixed --plot "$out/rig_fixed.svg" --csv "$out/rig_fixed.csv" --quiet
"$whirl" run rig_fixed --plot "$out/rig_fixed.png" --quiet

# --- where to look --------------------------------------------------------------------------------
title "Plots and records"
for scene in epicyclic_from_rest thomson_a rig_fixed; do
    printf '  %s/%s.svg  .png  .csv\n' "$out" "$scene"
done

title "Summary"
row() { printf '  %-44s %s\n' "$1" "$2"; }
row "epicyclic gear: centre of mass moves at most" "$spread_epicyclic_from_rest m in 9 s"
row "Thomson's device: centre of mass at most" "$spread_thomson_a m in 10 s"
row "epicyclic gear, PC and controller" "$same_epicyclic_from_rest"
row "Thomson's device, PC and controller" "$same_thomson_a"
# measured NAME: what the rig's report says of it, from the measured part
measured() { sed -n '/^Measured/,/^Formula/s/^ *'"$1"'  *//p' "$out/rig.txt"; }
formula() { sed -n '/^Formula/,$s/^ *'"$1"'  *//p' "$out/rig.txt"; }
row "rig: speed, asked for $(formula speed)" "$(measured speed)"
row "rig: force, formula $(formula force)" "$(measured 'force, once per turn')"
row "rig: phase to the masses, formula $(formula phase)" "$(measured 'its phase to the masses')"
row "rig: firmware" "$rig"
exit $failed
