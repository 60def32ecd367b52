#!/bin/sh
# swing.sh: a run that ends in a free swing finds the angle of sensor 1, and the verdict follows. The bench of
# docs/plants/rig.whirl has a soft coupling and dry friction in bearings and brushes. SWINGS=100: number of random rotors
# (default 5; with WHIRL_FULL 60); FRICTION=0.05: largest value of either friction, N m.
. "$(dirname "$0")/../checks.sh"

build=$(dirname "$whirl")
rig="docs/plants/rig.whirl --firmware $build/pil_swing --step 200us --jitter 60us"
runs=${SWINGS:-$([ -n "${WHIRL_FULL:-}" ] && echo 60 || echo 5)}

[ -x "$build/pil_swing" ]
verdict $? "build/pil_swing is there (make pil-images)"

# swing WORD...: runs the rig to the end; the report's words on the swing are in $why
swing() {
    sh tests/limit.sh 120 "$whirl" pil $rig "$@" </dev/null >"$scratch/run" 2>"$scratch/err" || [ $? -eq 1 ]
    ended=$?
    why=$(sed -n 's/^Free swing at the end of the run: //p' "$scratch/run")
}
# place: prints the number of the report's line "sensor 1 stands"; the next function reads the line after it
place() { sed -n 's/^  sensor 1 stands  *\([-0-9.]*\) deg.*/\1/p' "$scratch/run"; }
half() { sed -n '/^  sensor 1 stands/{n;s/^ *known to within  *\([0-9.]*\) deg.*/\1/p;}' "$scratch/run"; }

for stands in 0 2.5; do
    swing --place $stands,0
    [ "$ended" -eq 0 ] && [ "$why" = found ] &&
        awk -v a="$(place)" -v b=$stands 'BEGIN { d = a - b; exit !(a != "" && d < 0.15 && d > -0.15) }'
    verdict $? "sensor 1 at $stands degrees is found" "$scratch/run"
done
grep -aq 'verdict  *doubtful' "$scratch/run"
verdict $? "and what it measures is doubtful" "$scratch/run"
# both sensors are turned: the second sensor's marks fit the rotor, and only the swing shows the error
swing --place 1.5,1.5
grep -aq 'verdict  *doubtful: sensor 1 is not where the arms hang' "$scratch/run"
verdict $? "with both sensors turned nothing else tells, and the verdict says so" "$scratch/run"
swing --place 2,0 --set bearing_friction=0.1
[ "$why" = 'too few swings: friction stops the rotor' ]
verdict $? "with too much friction it is refused by name" "$scratch/run"

# Random rotors: half to twice the inertia, friction from a tenth of the largest value on, a coupling of a quarter to
# twice the stiffness, and sensor 1 turned by -3 to 3 degrees.
awk -v runs="$runs" -v most="${FRICTION:-0.025}" '
function drawn() { x = (x * 16807) % 2147483647; return x / 2147483647 }
function between(a, b) { return a * exp(drawn() * log(b / a)) }
BEGIN {
    x = 20061; drawn()
    for (i = 1; i <= runs; i++)
        printf "%.3f %.4f %.4f %.2f %.3f %d\n", between(0.5, 2), between(most / 10, most), between(most / 10, most), between(5, 40), 6 * drawn() - 3, i
}' >"$scratch/drawn"
: >"$scratch/found"
while read -r inertia bearing brush stiff stands seed; do
    swing --place "$stands,0" --seed "$seed" --set "inertia=$inertia" --set "bearing_friction=$bearing" \
        --set "motor_friction=$brush" --set "k=$stiff" --until 90s
    case $why in
    found) echo "found $(place) $(half) $stands" ;;
    'too few'*) echo few ;;
    *) echo "other $why" ;;
    esac >>"$scratch/found"
done <"$scratch/drawn"
awk '
$1 == "found" { d = $2 - $4; if (d < 0) d = -d; n++; sum += d * d; if (d <= $3) held++; if (d > worst) worst = d }
$1 == "few" { few++ }
END {
    printf "# of %d drawn rotors %d are found, off by %.3f deg rms, %.2f at most; %d intervals hold it; %d have too few swings\n",
        NR, n, (n ? sqrt(sum / n) : 0), worst, held, few
    exit !(n > 0 && worst <= 0.3 && held >= 0.85 * n && n + few >= 0.9 * NR)
}' "$scratch/found"
verdict $? "drawn rotors: to 0.3 degrees, or refused" "$scratch/found"
exit $failed
