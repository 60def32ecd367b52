#!/bin/sh
# run.sh WHIRL SCENES_ELF FIRMWARE_ELF EMULATE...: energies, equations, motion and firmware, for a first look at
# Whirl. `make run` builds everything and then calls this script. EMULATE is the command that runs an image; it has
# IMAGE in place of the image's path. Exit status 0 if everything agreed.
set -eu

whirl=$1 scenes=$2 firmware=$3
shift 3
emulate="$*"
out=build/run
rm -rf "$out"
mkdir -p "$out"
failed=0

title() { printf '\n=== %s\n\n' "$*"; }
run_image() { sh -c "$(printf '%s' "$emulate" | sed "s|IMAGE|$1|")"; } # the image's console output

title "1. The energies of an epicyclic gear on a carriage (core/models/epicyclic.whirl)"
# from the mechanism's name to its first effect
lines=$("$whirl" list --as table core/models/epicyclic.whirl | awk -F '\t' '
    $1 == "mechanism" { first = $5 } $1 == "effect" { print first "," $5 - 1; exit }')
sed -n "${lines}p" core/models/epicyclic.whirl

title "2. Its equations of motion (build/whirl derive core/models/epicyclic.whirl)"
"$whirl" derive core/models/epicyclic.whirl | sed -n '/^equations of motion/,$p'

title "3. The motion, on this computer, in double and in the boards' float"
for scene in epicyclic_from_rest thomson_a; do
    "$whirl" run "$scene" --number float >"$out/$scene.float.txt"
    "$whirl" run "$scene" --every 1ms --csv "$out/$scene.csv" --plot "$out/$scene.svg" >"$out/$scene.txt"
    "$whirl" run "$scene" --plot "$out/$scene.png" --quiet
    sed -n '1,2p' "$out/$scene.txt"
    # the centre of mass must stay at its start; the difference is the method's error
    tr -d '\r' <"$out/$scene.csv" | awk -F, '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "x_cm") c = i; next }
        NR == 2 { start = $c }
        { d = $c - start; if (d < 0) d = -d; if (d > worst) worst = d }
        END { printf "%.1e", worst }' >"$out/$scene.spread"
    printf '  the centre of mass moves by at most %s m\n' "$(cat "$out/$scene.spread")"
done

title "4. The same scenes on an emulated Cortex-M4F (QEMU, mps2-an386)"
run_image "$scenes" >"$out/board_scenes.txt"
for scene in epicyclic_from_rest thomson_a; do
    board=$(sed -n "s/^scene $scene steps [0-9]* hash \(0x[0-9a-f]*\) ok\$/\1/p" "$out/board_scenes.txt")
    here=$(sed -n 's/^state hash *//p' "$out/$scene.float.txt")
    if [ -n "$board" ] && [ "$board" = "$here" ]; then
        echo "the same bits"
    else
        echo DIFFERENT
        failed=1
    fi >"$out/$scene.same"
    printf '  %-22s PC float %s   board %s\n' "$scene" "$here" "${board:-missing}"
done

title "5. The eccentric-mass rig: its controller as firmware, motor and sensors emulated"
rig="ran to its end and stopped safely"
run_image "$firmware" >"$out/rig.txt" || { rig=FAILED; failed=1; }
cat "$out/rig.txt"
"$whirl" run rig_fixed --plot "$out/rig_fixed.svg" --csv "$out/rig_fixed.csv" --quiet
"$whirl" run rig_fixed --plot "$out/rig_fixed.png" --quiet

title "Plots and records"
printf "  $out/%s.svg  .png  .csv\n" epicyclic_from_rest thomson_a rig_fixed

title "Summary"
row() { printf '  %-44s %s\n' "$1" "$2"; }
row "epicyclic gear: centre of mass moves at most" "$(cat "$out/epicyclic_from_rest.spread") m in 9 s"
row "Thomson's device: centre of mass at most" "$(cat "$out/thomson_a.spread") m in 10 s"
row "epicyclic gear, PC and controller" "$(cat "$out/epicyclic_from_rest.same")"
row "Thomson's device, PC and controller" "$(cat "$out/thomson_a.same")"
# measured NAME, formula NAME: numbers of the rig's report
measured() { sed -n '/^Measured/,/^Formula/s/^ *'"$1"'  *//p' "$out/rig.txt"; }
formula() { sed -n '/^Formula/,$s/^ *'"$1"'  *//p' "$out/rig.txt"; }
row "rig: speed, asked for $(formula speed)" "$(measured speed)"
row "rig: force, formula $(formula force)" "$(measured 'force, once per turn')"
row "rig: phase to the masses, formula $(formula phase)" "$(measured 'phase, force to masses')"
row "rig: firmware" "$rig"
exit $failed
