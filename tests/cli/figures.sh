#!/bin/sh
# figures.sh: the dissertation's figures are drawn, each with its axes and curves, twice the same. A wrong description is
# refused.
. "$(dirname "$0")/../checks.sh"

sh mk/figures/figures.sh "$whirl" "$scratch/one" mk/figures/fig*.fig >"$scratch/log" 2>&1
verdict $? "all are drawn" "$scratch/log"

# Number of the figure, number of curves and laws in all panels, x axis of the last panel, y axis of the first.
while IFS='|' read -r number drawn x y; do
    svg=$scratch/one/fig$number.svg
    png=$scratch/one/fig$number.png
    wrong=""
    [ "$(wc -c <"$svg")" -gt 5000 ] || wrong="$wrong, small SVG"
    [ "$(dd if="$png" bs=1 skip=1 count=3 2>/dev/null)" = PNG ] || wrong="$wrong, no PNG"
    [ "$(wc -c <"$png")" -gt 5000 ] || wrong="$wrong, small PNG"
    [ "$(grep -c 'id="gnuplot_plot_' "$svg")" -eq "$drawn" ] || wrong="$wrong, not $drawn curves"
    grep -qF ">$x</" "$svg" || wrong="$wrong, no axis $x"
    grep -qF ">$y</" "$svg" || wrong="$wrong, no axis $y"
    [ -z "$wrong" ]
    verdict $? "$number${wrong:- has its curves and axes}"
done <<'END'
11|2|motor's frequency / spring's natural frequency|deflection / deflection at rest
17|6|time [s]|load [lbf]
19|2|time [s]|pin force [lbf]
20|4|eccentric weight / carriage weight|free / fixed pin force
24|6|time [s]|load and pulses [V]
26|5|time [s]|carriage [m]
32|2|time [s]|position [in]
33|2|time [s]|stretch [in]
34|2|time [s]|position [in]
36|1|time [s]|theta [rad]
37|1|time [s]|X [m]
38|1|time [s]|2 r cos(theta) [m]
39|1|time [s]|x of the planet [m]
40|2|time [s]|x of the centre of mass [m]
44|1|time [s]|theta1 [rad]
45|1|time [s]|theta2 [rad]
46|3|time [s]|theta1 - theta2 [rad]
50|2|time [s]|theta1 [rad]
51|1|time [s]|X' [m/s]
52|1|time [s]|theta1' [rad/s]
53|2|time [s]|along the slider [m]
54|2|time [s]|along the slider [m]
55|2|time [s]|x of the centre of mass [m]
57|1|time [s]|X [m]
58|2|X [m]|Y [m]
END

# The numbers of Fig. 20 are compared with the closed form, at every point of the sweep.
awk -F, 'NR > 1 { n++; d = $2 / $3 * (1 + $1) - 1; if (d < 0) d = -d; if (d > 0.001) bad++ }
    END { exit !(n == 21 && bad == 0) }' "$scratch"/one/data/sweep-carriage_ratio*.csv
verdict $? "20 is 1/(1 + ratio) within 0.1 %, at 21 ratios"

# Fig. 11 is compared with the forced oscillation. Peaks are those of samples, which are 9 degrees apart at the
# smallest damping.
awk -F, 'NR > 1 {
        n++; x = $4; due = 1 / sqrt((1 - x * x) ^ 2 + (13 / (0.33 * 188.4956) * x * x) ^ 2)
        d = $2 / $3 / due - 1; if (d < 0) d = -d; if (d > 0.005) bad++; if (x > 1) above++
    }
    END { exit !(n == 61 && above > 20 && above < 41 && bad == 0) }' "$scratch"/one/data/sweep-halvorson_smooth*.csv
verdict $? "11 is a forced oscillation within 0.5 %, at 61 springs"

# The firmware's points of Fig. 20: force on the carriage relative to that on a fixed mount. The carriage makes the speed
# ripple, which raises the force by 6 A^2, with A = D/(8 (I - D/2)), D = S^2/(M + m) (docs/rig.md).
awk -F, 'NR > 1 {
        n++; x = $1; d = 0.0351631^2 / 0.2739698 * x / (1 + x); a = d / 8 / (0.0057708 - d / 2)
        off = $2 * (1 + x) / (1 + 6 * a * a) - 1; if (off < -0.001 || off > 0.002 || $2 > before) bad++
        if (NR > 2 && $2 * (1 + x) < 1.00005 && x > 0.1) bad++
        before = NR > 1 ? $2 : 2
    } BEGIN { before = 2 }
    END { exit !(n == 12 && bad == 0) }' "$scratch"/one/data/table-rig.sh_ratios*.csv
verdict $? "and what the firmware measures, at 12 ratios, within 0.2 % of that and its ripple"

# Fig. 17: 2 s of samples with zero mean, within the limits. Their once-per-turn part is that of the firmware's
# formula.
awk -F, 'NR > 1 {
        n++; if (n > 1 && ($1 - t < 0.00199 || $1 - t > 0.00201)) bad++; t = $1
        if (!(low < $2)) low = $2; if (high < $2) high = $2
        if ($1 < 20 / 11 - 1e-6) { mean += $2; x += $2 * cos(34.5575 * $1); y += $2 * sin(34.5575 * $1); k++ }
    } BEGIN { low = 1e9; high = -1e9 }
    END { f = 2 / k * sqrt(x * x + y * y); m = mean / k
        exit !(n == 1000 && bad == 0 && low < -37.5 && low > -38.8 && high > 45.8 && high < 47 && m < 0.3 && m > -0.3 &&
            f > 41.6 && f < 42.3) }' "$scratch"/one/data/table-rig.sh_samples*.csv
verdict $? "17 has 1,000 samples of a force of 42 N, from -38.0 to 46.3"

# Fig. 24: ten or eleven spikes of each sensor. At sensor 1's spikes the load is at its peak, at sensor 2's it has the
# theoretical value, in volts.
awk -F, 'NR > 1 && NF == 3 && $2 != "" { if (one % 3 != 1) { if ($2 < 6.15 || $2 > 6.35) bad++ } else if ($2 < 16.15 || $2 > 16.35) bad++; one++ }
    NR > 1 && NF == 3 && $3 != "" { if (two % 3 != 1) { if ($3 < -0.26 || $3 > -0.11) bad++ } else if ($3 < 5.74 || $3 > 5.89) bad++; two++ }
    END { exit !(bad == 0 && one % 3 == 0 && two % 3 == 0 && one >= 30 && two >= 30) }' "$scratch"/one/data/table-rig.sh_spikes*.csv
verdict $? "24 has sensor 1's spikes on the peak and sensor 2's 1.4 N below zero"

# Fig. 26: the remaining swing at the end is S/(all masses), about a place that the carriage no longer leaves.
awk -F, 'NR > 1 && $1 > 55 { if (!n++ || $3 > high) high = $3; if (n == 1 || $3 < low) low = $3 }
    END { a = (high - low) / 2 * 1000 / 32.0864 - 1; exit !(n > 1000 && a > -0.01 && a < 0.01 && low > 5) }' \
    "$scratch"/one/data/run-carriage_stop*every_4ms*.csv
verdict $? "26 ends in a swing of 32.09 mm, metres from the stop"

# The swing's action stays within 0.5 % from 4 s on, while its energy grows.
sh mk/figures/swing.sh "$whirl" cycles | awk -F, '
    NR > 1 && $1 > 4 { n++; if ($3 < 6.965 || $3 > 7.035 || $4 <= energy) bad++ }
    { energy = $4 }
    END { exit !(n > 20 && bad == 0) }'
verdict $? "the swing's action stays, its energy grows"

# An initial difference of 1e-9 grows a thousandfold by 5 s, and to the size of the motion by 10 s.
sh mk/figures/growth.sh "$whirl" thomson_a theta1=1e-9 1e-9 --step 0.25ms --every 1s | awk -F, '
    $1 == 5 { five = $2 }
    $1 == 10 { ten = $2 }
    END { exit !(five > 5e3 && five < 7e3 && ten > 3e8 && ten < 4e9) }'
verdict $? "chaos: growth of 6e3 by 5 s, 1e9 by 10 s"

sh mk/figures/figures.sh "$whirl" "$scratch/two" mk/figures/fig46.fig mk/figures/fig20.fig \
    >"$scratch/log" 2>&1 || sed 's/^/    /' "$scratch/log"
cmp -s "$scratch/one/fig46.svg" "$scratch/two/fig46.svg" &&
    cmp -s "$scratch/one/fig20.svg" "$scratch/two/fig20.svg" &&
    cmp -s "$scratch/one/fig46.png" "$scratch/two/fig46.png"
verdict $? "drawn twice, the same files"

sh mk/figures/page.sh mk/figures/fig*.fig | cmp -s - docs/figures.md
verdict $? "docs/figures.md is what the descriptions say (make figures-docs)"

# refused WHAT LINE...: a description with these lines must be refused.
refused() {
    what=$1
    shift
    printf '%s\n' "$@" >"$scratch/bad.fig"
    ! sh mk/figures/figures.sh "$whirl" "$scratch/bad" "$scratch/bad.fig" >/dev/null 2>&1
    verdict $? "$what is refused"
}
refused "an unknown scene" "title t" "run a no_such_scene" "panel y" "curve a | {time} | {X} | -"
refused "an unknown run" "title t" "panel y" "curve a | {time} | {X} | -"
for axes in "{no_such} | {X}" "{time} | {no_such}" "{time} | 2*{X} - {no_such}" "{tim} | {X}"; do
    refused "an unknown column ($axes)" "title t" "run a epicyclic_from_rest --until 1s" "panel y" "curve a | $axes | -"
    "$whirl" figure "$scratch/bad.fig" --out "$scratch/none.svg" 2>&1 | grep -qE "bad.fig:4: error: the records 'a' have no column '(no_such|tim)'"
    verdict $? "and named"
done
refused "a brace that nothing closes" "title t" "run a epicyclic_from_rest --until 1s" "panel y" "curve a | {time} | {X | -"
"$whirl" figure "$scratch/bad.fig" --out "$scratch/none.svg" 2>&1 | grep -q "bad.fig:4: error: there is no } after {X"
verdict $? "and named"
refused "an unknown statement" "title t" "panle y"
refused "a sweep of which a point fails" "title t" \
    "sweep a epicyclic_from_rest --over m=0..1:2 --measure X --until 10ms" "panel y" \
    "curve a | {m} | {X} | -"

# An option replaces the same option of the figure; --with adds to it.
for fig in mk/figures/f*.fig; do
    "$whirl" figure "$fig" --until 0.1s --with ledger --out "$scratch/varied.svg" 2>&1
done >"$scratch/log"
! grep -E 'twice|multiplot>' "$scratch/log" && grep -q 'error: a panel has no points' "$scratch/log"
verdict $? "every figure varied is drawn, or refused for another reason"
for own in "" "--until 9s --set=m=2kg --start \"theta'=1 [rpm]\" --with ledger"; do
    printf '%s\n' "title t" "run a epicyclic_from_rest $own" "panel y" "curve a | {time} | {X} | -" >"$scratch/own.fig"
    "$whirl" figure "$scratch/own.fig" --until=0.1s --set 'm =3kg' --start="theta'=2 [rpm]" --with rail_drag,ledger \
        --out "$scratch/own${own:+_replaced}.svg"
done
cmp "$scratch/own.svg" "$scratch/own_replaced.svg"
verdict $? "and an own option that is replaced leaves nothing behind"

# Of the working files only the numbers remain, after good and after bad runs.
left=$(find "$scratch" -path '*/data/*' ! -name '*.csv')
[ -z "$left" ] || echo "$left"
[ -z "$left" ] && [ -d "$scratch/one/data" ] && [ -d "$scratch/bad/data" ]
verdict $? "nothing half-done is left in data"
exit $failed
