#!/bin/sh
# printed_zeros.sh: no output contains "-0" or "-nan": summaries, the balance, records, rows of sweeps, accelerations,
# derived text, for every built-in scene, also from starts that are zeros with a sign. The state keeps its own sign.
. "$(dirname "$0")/../checks.sh"

# signed FILE...: prints lines with a zero that has a sign; "-0.5" and "1e-05" do not count.
signed() {
    grep -nE -e '-nan|(^|[^0-9A-Za-z_.)-])-0(\.0*)?(e[-+]?[0-9]+)?($|[^0-9.e])' "$@"
}

printf '%s\n' '-0' 'x = -0' 'a,-0,b' ' -0 J' '-0.000' '-0.00e+00' '-0 -> 1' 'x -nan' >"$scratch/probe"
[ "$(signed "$scratch/probe" | wc -l)" -eq 8 ]
verdict $? "the check knows a zero with a sign"
printf '%s\n' '-0.5' '1e-05' '-0.01e-3' 'x-0' '2-0' '0' '-1' '1.5e-0' >"$scratch/probe"
! signed "$scratch/probe" >/dev/null
verdict $? "and leaves the others"

scenes=$("$whirl" list | awk '$1 == "scene" { print $2 }')
count=0
for scene in $scenes; do
    # in double with the ledger inside the run, in float with the balance beside it
    for more in 'double --with ledger' 'float --without ledger'; do
        number=${more%% *}
        "$whirl" run "$scene" --until 5ms --number $more --csv "$scratch/$scene.$number.csv" \
            --columns "$scratch/$scene.$number.dat" >"$scratch/$scene.$number.txt" 2>/dev/null ||
            rm -f "$scratch/$scene.$number."*
    done
    count=$((count + 1))
done
signed "$scratch"/*.txt "$scratch"/*.csv "$scratch"/*.dat >"$scratch/found"
[ ! -s "$scratch/found" ] && [ $count -gt 40 ]
verdict $? "records, summaries and books of $count scenes" "$scratch/found"

cat >"$scratch/still.whirl" <<'END'
mechanism still "zeros everywhere"
coordinate x [m]
coordinate th [rad]
parameter k = -0 [N/m]
input push = -0 [N]
T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*th'^2/2
V = -3 [N/m]*x^2/2 - 2 [N*m]*sin(th)^2
F = 0.1 [kg/s]*x'^2/2
Q(x) = push - k*x
output mirrored [m] = -x
output pull [N] = -3 [N/m]*x
output none [m] = sqrt(x^2 - 1 [m^2])
output neither [m] = -none
effect drag { Q(th) += -1 [N*m*s]*th' }
scene still_rests { start x = -0, th = -0, x' = -0 [m/s], th' = -0 [rad/s]; with drag; until 10 [ms] }
END
still=$scratch/still.whirl:still_rests
for number in double float; do
    for more in '' '--with ledger' '--until 0' '--method euler'; do
        {
            "$whirl" run "$still" --number $number $more
            "$whirl" run "$still" --number $number $more --quiet --csv -
            "$whirl" run "$still" --number $number $more --quiet --columns -
        } >>"$scratch/still.out"
    done
    "$whirl" sweep "$still" --number $number --over x=-0..-0:1 --over push=-1..0:2 --over "th'=-0..1:2" --quiet \
        --measure mirrored --measure 'min(pull)' --measure 'mean(mirrored)' --measure none --measure neither --measure "x''" >>"$scratch/still.out"
    "$whirl" sweep "$still" --number $number --over x=-0..-0:1 --quiet >>"$scratch/still.out"
done
"$whirl" accel "$still" x=-0 "th'=-0" >>"$scratch/still.out"
"$whirl" derive "$still" --set k=-0 >>"$scratch/still.out"
signed "$scratch/still.out" >"$scratch/found"
[ ! -s "$scratch/found" ] && [ "$(wc -l <"$scratch/still.out")" -gt 100 ]
verdict $? "a mechanism of zeros with a sign" "$scratch/found"

# two starts that are printed alike may differ: the start's sign is in the state
"$whirl" run "$still" --until 0 >"$scratch/minus"
"$whirl" run "$still" --until 0 --start x=0 >"$scratch/plus"
[ "$(sed -n 's/^state hash//p' "$scratch/minus")" != "$(sed -n 's/^state hash//p' "$scratch/plus")" ]
verdict $? "the state keeps its sign"
exit $failed
