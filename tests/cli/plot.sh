#!/bin/sh
# plot.sh: `whirl plot`, the choices of `whirl run --plot`, and `whirl figure`: a picture from a CSV file has the run's
# points. Panels, several runs, wrong choices with hints; SVG is XML with a title and alternative text. Generated
# mechanisms; the seed is printed.
. "$(dirname "$0")/../checks.sh"

if ! command -v gnuplot >/dev/null 2>&1; then
    echo "ok - no gnuplot here: nothing to draw"
    exit 0
fi
seed=${PLOT_SEED:-11}
echo "# seed $seed"

# Writes a mechanism with coordinates in random units, an output, and a stop in every second one.
generate() { # generate NUMBER
    awk -v seed="$seed$1" -v number="$1" 'BEGIN {
        srand(seed)
        split("m mm cm in", unit, " ")
        printf "mechanism drawn \"a mass on a spring, of seed %s\"\ncoordinate x [%s] \"mass & <spring>\"\n", seed, unit[1 + int(rand() * 4)]
        print "coordinate a [" (rand() < 0.5 ? "rad" : "deg") "]\nparameter k = " 5 + int(rand() * 50) " [N/m]"
        print "T = 2 [kg]*x\047^2/2 + 0.1 [kg*m^2]*a\047^2/2\nV = k*x^2/2 - 3 [J]*cos(a)\noutput pull [N] = k*x"
        if (number % 2) print "stop x >= -1 [cm] restitution 0.6"
        print "scene drawn_swings \"let go\" { start x = 5 [cm], a = 1 [rad]; step 1 [ms]; until 1.5 [s] }"
    }' >"$scratch/m$1.whirl"
}

# well_formed FILE: the file must be XML, its first title TITLE, and its description not gnuplot's.
well_formed() {
    if command -v xmllint >/dev/null 2>&1; then
        xmllint --noout "$1" || return 1
    fi
    grep -q '^<svg role="img"' "$1" && grep -qF "<title>$2</title>" "$1" && grep -q '<desc>Curves over ' "$1" && ! grep -q 'Produced by GNUPLOT' "$1"
}

for number in 1 2; do
    generate $number
    model=$scratch/m$number.whirl
    for choice in "" "--y=x',a" "--panel=x --panel=x' --panel=a',a'" "--y=pull --x=x"; do
        rm -f "$scratch"/*.svg "$scratch/run.csv"
        "$whirl" run "$model" --plot "$scratch/run.svg" --csv "$scratch/run.csv" $choice >/dev/null 2>"$scratch/err" &&
            "$whirl" plot "$scratch/run.csv" --out "$scratch/csv.svg" $choice 2>"$scratch/err" &&
            "$whirl" plot "$model" --out "$scratch/scene.svg" $choice 2>"$scratch/err"
        verdict $? "mechanism $number${choice:+ $choice}: drawn"
        cmp "$scratch/run.svg" "$scratch/csv.svg" >"$scratch/err" 2>&1 && cmp "$scratch/run.svg" "$scratch/scene.svg" >"$scratch/err" 2>&1
        verdict $? "its CSV read back, and its scene, give the run's picture to the byte"
        check "it is XML, with title and alternative text" well_formed "$scratch/run.svg" "drawn_swings: let go"
        case $choice in
        '') wanted=3 ;;
        --y=x*) wanted=2 ;;
        --panel*) wanted=3 ;;
        *) wanted=1 ;;
        esac
        [ "$(grep -c 'class="gridline"' "$scratch/run.svg")" -gt 0 ] &&
            [ "$(sed -n "s/.* d='M[0-9.]*,[0-9.]* L[0-9.]*,[0-9.]* L[0-9.]*,.* Z  '.*/x/p" "$scratch/run.svg" | wc -l)" -eq $((2 * wanted)) ]
        verdict $? "and has $wanted panels"
    done
    # compares the points with the CSV's numbers: the extremes in the alternative text
    tr -d '\r' <"$scratch/run.csv" | awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "pull") c = i; next }
        { v = $c + 0; if (NR == 2 || v < low) low = v; if (NR == 2 || v > high) high = v }
        END { printf "pull lies between %.4g and %.4g N.", low, high }' >"$scratch/told"
    grep -qF "$(cat "$scratch/told")" "$scratch/csv.svg"
    verdict $? "its extremes are the CSV's: $(cat "$scratch/told")" "$scratch/told"
    grep -c '^marks_s = \[[0-9]' "$scratch/run.csv.toml" >"$scratch/marks"
    [ "$(cat "$scratch/marks")" -eq $((number % 2)) ] && "$whirl" plot "$scratch/run.csv" --out "$scratch/marks.svg" &&
        [ "$(grep -c '<text.*>event<' "$scratch/marks.svg")" -eq $((number % 2)) ]
    verdict $? "events are marked where a stop is hit: $((number % 2))"
done

# --- several runs ---------------------------------------------------------------------------------------------------
model=$scratch/m2.whirl
"$whirl" run "$model" --quiet --csv "$scratch/soft.csv" --set k=5
"$whirl" run "$model" --quiet --csv "$scratch/stiff.csv" --set k=90
"$whirl" plot "$scratch/soft.csv" "$scratch/stiff.csv" --y "x, x'" --out "$scratch/two.svg" 2>"$scratch/err" &&
    [ "$(grep -c 'id="gnuplot_plot_' "$scratch/two.svg")" -eq 4 ] && [ "$(grep -c '<text>let go, k=5<' "$scratch/two.svg")" -eq 2 ] &&
    grep -q '<text>let go, k=90<' "$scratch/two.svg" && ! grep -qF "$scratch" "$scratch/two.svg"
verdict $? "two runs in two panels: four curves, named by their changes, and no path"
"$whirl" plot "$scratch/soft.csv" "$scratch/stiff.csv" --y x --legend "soft, stiff" --title "Two springs" --out "$scratch/two.svg" 2>"$scratch/err" &&
    grep -q '<text>soft<' "$scratch/two.svg" && grep -q '<text>stiff<' "$scratch/two.svg" && well_formed "$scratch/two.svg" "Two springs"
verdict $? "a legend and a title of one's own"
"$whirl" plot "$scratch/soft.csv" --y "x, x'" --xlabel "after release" --ylabel "place, speed [m/s]" --out "$scratch/two.svg" 2>"$scratch/err" &&
    grep -q '>after release<' "$scratch/two.svg" && grep -q '>place<' "$scratch/two.svg" && grep -qF '>speed [m/s]<' "$scratch/two.svg" &&
    ! grep -qF 'time [s]' "$scratch/two.svg"
verdict $? "axis titles of one's own"
# readable without colours: up to five curves of a panel have different dashes, whatever runs and quantities they show
for drawn in "1 2" "1 3" "1 4" "1 5" "2 2"; do
    set -- $drawn
    quantities=$(echo x,x0 | cut -d, -f1-"$1")
    runs=
    for k in $(seq "$2"); do
        awk -v k="$k" -v seed="$seed" 'BEGIN { srand(seed + k); print "time,x,x0"; for (i = 0; i < 9; i++) print i "," rand() "," rand() }' >"$scratch/dash$k.csv"
        runs="$runs $scratch/dash$k.csv"
    done
    "$whirl" plot $runs --panel "$quantities" --out "$scratch/dashes.svg" 2>"$scratch/err" &&
        [ "$(sed -n "s/.*dasharray='\([^']*\)'.*M.* L.*/\1/p" "$scratch/dashes.svg" | sort -u | wc -l)" -eq $(($1 * $2 - 1)) ]
    verdict $? "$2 runs of $1 quantities in a panel: their curves differ without colours"
done
# lowest FILE: prints the height of the lowest frame, in tenths of a pixel
lowest() {
    sed -n "s/.* d='M[0-9.]*,\([0-9.]*\) L[0-9.]*,\([0-9.]*\) L[0-9.]*,.* Z  '.*/\1 \2/p" "$1" |
        awk '{ h = $1 - $2; h = h < 0 ? -h : h; if (NR == 1 || h < least) { least = h } } END { printf "%d", 10 * least }'
}
"$whirl" plot "$scratch/soft.csv" --y "x, a" --out "$scratch/one.svg" 2>"$scratch/err"
one=$(lowest "$scratch/one.svg")
for runs in 2 20; do
    words=$(awk -v runs=$runs -v seed="$seed" 'BEGIN { srand(seed + runs); letters = "moderately long names of a run with words"
        for (i = 0; i < runs; i++) { printf "%s%s %d", i ? "," : "", substr(letters, 1, 1 + int(rand() * 40)), i } }')
    files=$(for k in $(seq $runs); do echo "$scratch/soft.csv"; done)
    for choice in $([ $runs = 20 ] || echo --y=x,a) "--panel=x --panel=a,a"; do
        "$whirl" plot $files $choice --legend "$words" --out "$scratch/many.svg" 2>"$scratch/err"
        [ "$one" -gt 1000 ] && [ "$(lowest "$scratch/many.svg")" -ge "$one" ]
        verdict $? "$runs runs, $choice: panels $(lowest "$scratch/many.svg") high, of one run $one"
    done
done
# a file of another program, with a comment and quotes, and without a file that describes it
printf '# made by hand\n"time","x [mm]",other\n0,1,2\n1,2.5,\n2,3,4\n' >"$scratch/hand.csv"
"$whirl" plot "$scratch/hand.csv" --out "$scratch/hand.svg" 2>"$scratch/err" && grep -q 'x lies between 1 and 3 mm\.' "$scratch/hand.svg" &&
    grep -q 'other lies between 2 and 4\.' "$scratch/hand.svg" && well_formed "$scratch/hand.svg" hand
verdict $? "a CSV of another program's, with a comment"
"$whirl" sweep "$model" --over k=5..50:6 --measure 'max(x)' --quiet --csv "$scratch/sweep.csv" >/dev/null && "$whirl" plot "$scratch/sweep.csv" --out "$scratch/sweep.svg" 2>"$scratch/err" &&
    grep -q 'Curves over k\.' "$scratch/sweep.svg"
verdict $? "a sweep, over the swept value"
for kind in png pdf; do
    "$whirl" plot "$scratch/soft.csv" --out "$scratch/two.$kind" 2>"$scratch/err" && head -c 8 "$scratch/two.$kind" | grep -qaE 'PNG|%PDF'
    verdict $? "a $kind"
done

# --- what cannot be plotted -----------------------------------------------------------------------------------------
refused() { # refused ERROR HINT WORD...: exit status 2, with error and hint, and nothing is drawn
    error=$1 hint=$2
    shift 2
    rm -f "$scratch/no.svg"
    "$whirl" "$@" >"$scratch/out" 2>"$scratch/err"
    [ $? -eq 2 ] && grep -qF -- "$error" "$scratch/err" && grep -qF -- "hint: $hint" "$scratch/err" && [ ! -s "$scratch/no.svg" ]
    verdict $? "refused: $error"
}
out="--out=$scratch/no.svg"
case $whirl in /*) program=$whirl ;; *) program=$PWD/$whirl ;; esac
refused "there is no quantity 'pul'" "did you mean pull?" plot "$scratch/soft.csv" --y pul "$out"
refused "there is no quantity 'zzzzzz'" "the quantities are time, x, a, x', a', pull" plot "$scratch/soft.csv" --y zzzzzz "$out"
refused "there is no quantity 'pul'" "did you mean pull?" run "$model" --y pul --plot "$scratch/no.svg"
refused "one panel has one unit" '--y "x, pull" makes a panel for each unit' plot "$scratch/soft.csv" --panel x,pull "$out"
refused "No such file" "whirl run SCENE --csv $scratch/none.csv writes one" plot "$scratch/none.csv" "$out"
refused "the unit of x is" "draw them in two pictures" plot "$scratch/hand.csv" "$scratch/inch.csv" --y x "$out" 2>/dev/null <<END
$(printf 'time,x [in]\n0,1\n1,2\n' >"$scratch/inch.csv")
END
refused "the first line is no header" "begin the file with the names" plot "$scratch/bare.csv" "$out" <<END
$(printf '0,1\n1,2\n' >"$scratch/bare.csv")
END
refused "no file for the picture" "--out picture.svg" plot "$scratch/soft.csv"
refused "draws .svg, .pdf and .png files" "--out picture.svg" plot "$scratch/soft.csv" --out "$scratch/no.txt"
refused "--ylabel has 3 texts for 1 panel" 'write a comma between' plot "$scratch/soft.csv" --y x --ylabel "a, b, c" "$out"
refused "--legend has 1 name for 2 runs" '--legend "first, second"' plot "$scratch/soft.csv" "$scratch/stiff.csv" --legend one "$out"
refused "--set changes a scene" "whirl plot SCENE --set" plot "$scratch/soft.csv" --set k=1 "$out"
refused "'k' is given twice on the command line" "leave one of them out" plot "$model" --set k=5 "$model" --set=k=90 "$out"
for name in k "x'"; do
    refused "--y is given twice" "--y \"a, $name\"" plot "$model" --y a --y="$name" "$out"
done
refused "and other plot options need --plot" "--plot picture.svg" run "$model" --y x
refused "no figure is called '999'" '`whirl list --figures` lists them' figure 999
PATH=/nonexistent "$(command -v "$whirl" || echo "$whirl")" plot "$scratch/soft.csv" "$out" 2>"$scratch/err"
[ $? -eq 2 ] && grep -q 'plots need gnuplot' "$scratch/err" && grep -q '^hint: make deps' "$scratch/err"
verdict $? "without gnuplot that is said"

# --- figures ----------------------------------------------------------------------------------------------------------
"$whirl" list --figures >"$scratch/figures"
[ "$(wc -l <"$scratch/figures")" -eq "$(ls mk/figures/*.fig | wc -l)" ]
verdict $? "all figures are listed" "$scratch/figures"
sed -n 's/^\([^ ]*\) .* (make figures)$/\1/p' "$scratch/figures" >"$scratch/marked"
grep -l '^table ' mk/figures/*.fig | sed 's:.*/::; s/^fig//; s/[.]fig$//' | diff - "$scratch/marked" >"$scratch/err" && [ -s "$scratch/marked" ]
verdict $? "those that need a script are marked"
while read -r figure; do
    refused 'which whirl cannot run' 'run `make figures`, or use --data' figure "$figure" --out "$scratch/f.svg"
done <"$scratch/marked"
named=$(sed -n 's/^Figures \(.*\) and five findings need scripts.*/\1/p' docs/plot.md)
[ "$named" = "$(grep -v finding "$scratch/marked" | tr '\n' ' ' | sed 's/\([0-9]*\) \([0-9]*\) \([0-9]*\) /\1, \2 and \3/')" ] &&
    [ "$(grep -c finding "$scratch/marked")" -eq 5 ]
verdict $? "docs/plot.md names them: $named"
"$whirl" figure 33 --out "$scratch/f.svg" --until 1s 2>"$scratch/err" && "$whirl" figure 33 --out "$scratch/g.svg" --until 1s --set "m1=9 [kg]" 2>"$scratch/err" &&
    grep -qF "<title>$(sed -n 's/^33  *//p' "$scratch/figures"), varied: --until 1s</title>" "$scratch/f.svg" &&
    grep -q '<desc>Varied by --until 1s --set m1=9 \[kg\]</desc>' "$scratch/g.svg" && ! cmp -s "$scratch/f.svg" "$scratch/g.svg"
verdict $? "a figure, and the same varied"
# marks of the motion without changes: not on a curve with a changed parameter
printf '%s\n' 'title Marked' 'caption Marked.' 'run a thomson_a --until 1s' "panel X' [m/s]" \
    "set arrow from 0.4, graph 0 to 0.4, graph 1 nohead lc rgb '#123456'" "set label 'read here' at 0.5, graph 0.5" \
    'curve a | {time} | {der(X)} | -' >"$scratch/marked.fig"
marks() { grep -ciE 'read here|rgb\( *18, *52, *86\)' "$scratch/marked.svg"; }
"$whirl" figure "$scratch/marked.fig" --out "$scratch/marked.svg" 2>"$scratch/err" && [ "$(marks)" -ge 2 ]
verdict $? "a figure with its marks" "$scratch/err"
"$whirl" figure "$scratch/marked.fig" --set r=60mm --out "$scratch/marked.svg" 2>"$scratch/err" && [ "$(marks)" -eq 0 ]
verdict $? "and varied, without them" "$scratch/err"
exit $failed
