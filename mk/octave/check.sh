#!/bin/sh
# check.sh WHIRL OUT: generate Octave files for the dissertation's scenes, run them with ode45 and
# compare with `whirl run` (check.m). Everything is left in the folder OUT.
set -eu

whirl=${1:?usage: check.sh WHIRL OUT}
out=${2:?usage: check.sh WHIRL OUT}
rm -rf "$out"
mkdir -p "$out"
# The names are those of check.m's table. A step of 0.25 ms keeps Whirl's own error below ode45's.
for scene in two_mass_absolute two_mass_relative epicyclic_from_rest driven_hinge_from_rest \
    thomson_a thomson_b; do
    "$whirl" derive "$scene" --as octave >"$out/$scene.m"
    # What the file's comments tell the user to type, typed.
    sed -n 's/^% \(options = \|\[T, Y\] = \|K = \)/\1/p' "$out/$scene.m" >"$out/${scene}_as_is.m"
    [ "$(wc -l <"$out/${scene}_as_is.m")" -eq 3 ] || {
        echo "$scene: the generated file does not tell how to run it" >&2
        exit 1
    }
    "$whirl" run "$scene" --step 0.25ms --every 5ms --quiet --columns "$out/whirl_$scene.txt"
done
cp mk/octave/check.m "$out/check.m"
cd "$out"
octave-cli --norc --no-history --quiet check.m
