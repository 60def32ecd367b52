#!/bin/sh
# examine.sh: `whirl examine` of every built-in mechanism, and of devices with a hidden outside force. Drawn mechanisms are
# compared with a reference in tests/host/test_symmetry.c.
. "$(dirname "$0")/../checks.sh"

says() { # says WHAT PATTERN WORD...: a line of the answer matches
    what=$1
    pattern=$2
    shift 2
    "$whirl" examine "$@" >"$scratch/out" 2>"$scratch/err" && grep -q -- "$pattern" "$scratch/out"
    verdict $? "$what" "$scratch/out"
}

# The conserved momenta of each mechanism are those that the balance of a run finds, for every coordinate.
"$whirl" list | awk '$1 == "mechanism" { print $2 }' | while read -r name; do
    "$whirl" examine "$name" >"$scratch/out" 2>"$scratch/err"
    case $? in
    0) echo "$name $(sed -n 's/^directions.*conserved momenta: //p' "$scratch/out")" ;;
    *) grep -q 'is given by equations' "$scratch/err" && echo "$name equations" ;;
    esac
done >"$scratch/all"
cat >"$scratch/wanted" <<'END'
epicyclic 1
thomson 1
thomson_plane 2
laskowitz 2
laskowitz_shifting 3
spherical_particle 1
cartesian_particle 3
halvorson 1
eccentric 1
eccentric_fixed 0
eccentric_ratio equations
END
grep -vxFf "$scratch/all" "$scratch/wanted" >"$scratch/err"
[ ! -s "$scratch/err" ] && [ "$(wc -l <"$scratch/all")" -eq "$("$whirl" list | grep -c '^mechanism')" ]
verdict $? "conserved momenta of the built-in mechanisms" "$scratch/all"

says "the rail's momentum of the gear" "^   dP1/dt = 0: conserved$" epicyclic
says "what is not affine is not decided" "^not decided: a direction or rotation that is not affine" spherical_particle
says "a stop is an outside force" "the stop, line [0-9]* (effect left_stop)" carriage_stop
says "LaTeX" '^  P_{1} &= 2 \\, m' epicyclic --as latex

# If the centre of mass of a device moves, there is an outside force. Each one is named with its line.
for hidden in 'V += 1e-6 [N/m]*X^2/2' 'F += 1e-6 [N*s/m]*(X'"'"' + 0.01 [m]*theta'"'"')^2/2' 'Q(X) += 1e-6 [N]' 'stop X <= 9 [m] restitution 1' \
    'friction X static 0.2 kinetic 0.1 normal 3 [N]' "when X crosses 8 [m] rising { set X' = -X' }"; do
    where=mechanism
    case $hidden in when*) where=scene ;; esac
    { echo 'mechanism device "a hidden force"'
        echo 'coordinate X [m]'
        echo 'coordinate theta [rad]'
        echo "T = 3 [kg]*X'^2/2 + 0.2 [kg*m]*X'*theta'*cos(theta) + 0.1 [kg*m^2]*theta'^2/2"
        [ $where = scene ] || echo "effect hidden \"hidden\" { $hidden }"
        [ $where = scene ] && echo "scene go { $hidden; step 1 [ms]; until 1 [s] }" || echo 'scene go { step 1 [ms]; until 1 [s] }'
    } >"$scratch/device.whirl"
    if [ $where = mechanism ]; then
        says "without: $hidden" 'conserved momenta: 1' "$scratch/device.whirl"
        says "$hidden is found" 'conserved momenta: 0' "$scratch/device.whirl" --with hidden
        says "and named" "line 5 (effect hidden)" "$scratch/device.whirl" --with hidden
    else
        says "$hidden is found" 'conserved momenta: 0' "$scratch/device.whirl"
    fi
done
# Two carts with forces of drawn signs and sizes: only equal and opposite ones keep the total momentum. A potential energy of
# the left cart is named by its line.
awk -v seed="${WHIRL_SEED:-46}" 'BEGIN { srand(seed); for (i = 0; i < 12; i++) {
    left = (rand() < 0.5 ? -1 : 1) * int(1 + 4 * rand())
    print left, i % 3 == 0 ? -left : (rand() < 0.5 ? -1 : 1) * int(1 + 4 * rand()), int(1 + 5 * rand()) } }' >"$scratch/pairs"
while read -r left right lines; do
    { echo 'mechanism carts "two carts"'
        printf 'coordinate u [m]\ncoordinate v [m]\nlet f = 3 [N/m]*(v - u)\n'
        echo "T = 2 [kg]*u'^2/2 + 5 [kg]*v'^2/2"
        printf 'Q(u) = %s*f\nQ(v) = %s*f\n' "$left" "$right"
        yes '# another line' | head -n "$lines"
        echo 'effect tied "a spring" { V += 1 [N/m]*u^2/2 }'
        echo 'scene go { step 1 [ms]; until 1 [s] }'
    } >"$scratch/carts.whirl"
    "$whirl" examine "$scratch/carts.whirl" >"$scratch/out" 2>&1
    remarks=$(grep -c '^     this symmetry shifts u and v by different amounts: if both are positions along the same fixed direction, its momentum is not the total momentum' "$scratch/out")
    [ "$remarks" -eq $((left + right != 0)) ] && grep -q 'conserved momenta: 1$' "$scratch/out"
    verdict $? "forces $left f and $right f: the total momentum or not" "$scratch/out"
    says "the spring's line" "potential energy V, line $((lines + 8)) (effect tied): -u$" "$scratch/carts.whirl" --with tied
done <"$scratch/pairs"
"$whirl" examine eccentric_ratio >"$scratch/out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q '^hint: write the mechanism with T and V instead$' "$scratch/err"
verdict $? "a system of equations is refused with a hint"
exit $failed
