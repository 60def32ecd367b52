#!/bin/sh
# plots.sh: `whirl run --plot`: panels whose time axes stand below each other whatever their numbers and names, and no
# word of gnuplot's unless it fails. Generated outputs; the seed is printed.
. "$(dirname "$0")/../checks.sh"

if ! command -v gnuplot >/dev/null 2>&1; then
    echo "ok - no gnuplot here: nothing to draw"
    exit 0
fi
seed=${PLOT_SEED:-7}
echo "# seed $seed"

# Outputs of many sizes, flat ones, some without a value, with short and long names; each of a unit of its own.
generate() { # generate NUMBER
    awk -v seed="$seed$1" 'BEGIN {
        srand(seed)
        print "mechanism drawn \"generated, of seed " seed "\""
        print "coordinate x [m]\nT = 1 [kg]*x\047^2/2\nV = 40 [N/m]*x^2/2"
        units[1] = "N"; units[2] = "W"; units[3] = "V"; units[4] = "A"; units[5] = "kg"; units[6] = "J"
        for (i = 1; i <= 6; i++) {
            name = "o" i
            for (k = int(rand() * 20); k > 0; k--) name = name "_w"
            size = exp((rand() * 60 - 30) * log(10) / 2)
            kind = int(rand() * 5)
            value = kind == 0 ? "0" : kind == 1 ? "3" : kind == 2 ? "sqrt(-1 - x^2/1 [m^2])" : \
                    kind == 3 ? "1 + 1e-13*x/1 [m]" : "x/1 [m]"
            printf "output %s [%s] = %.6e [%s]*(%s)\n", name, units[i], size, units[i], value
        }
        print "scene drawn_swings { start x = 0.1 [m]; until 2 [s] }"
    }' >"$scratch/drawn.whirl"
}

# aligned FILE: all frames begin and end at the same places, and there are as many as units: x and the six outputs.
aligned() {
    sed -n "s/.* d='M\([0-9.]*\),[0-9.]* L[0-9.]*,[0-9.]* L\([0-9.]*\),.* Z  '.*/\1 \2/p" "$1" >"$scratch/frames"
    [ "$(sort -u "$scratch/frames" | wc -l)" -eq 1 ] && [ "$(wc -l <"$scratch/frames")" -eq 14 ]
}

for number in 1 2 3 4 5 6; do
    generate $number
    for until in 2s 0; do
        for quiet in '' --quiet; do
            # shellcheck disable=SC2086 # perhaps no word
            "$whirl" run "$scratch/drawn.whirl" --until $until $quiet --plot "$scratch/drawn.svg" \
                >"$scratch/out" 2>"$scratch/err"
            code=$?
            [ $code -eq 0 ] && [ ! -s "$scratch/err" ]
            verdict $? "mechanism $number until $until $quiet: drawn without a word"
            check "mechanism $number until $until $quiet: the time axes stand below each other" aligned "$scratch/drawn.svg"
        done
    done
done

# --- gnuplot's own words: a stand-in that warns, and one that fails -----------------------------------
mkdir "$scratch/bin"
for code in 0 1; do
    printf '#!/bin/sh\ncat >/dev/null\necho "a word of gnuplot" >&2\nexit %s\n' $code >"$scratch/bin/gnuplot"
    chmod +x "$scratch/bin/gnuplot"
    PATH=$scratch/bin:$PATH "$whirl" run epicyclic_from_rest --until 10ms --plot "$scratch/x.svg" >"$scratch/out" 2>"$scratch/err"
    got=$?
    if [ $code -eq 0 ]; then
        [ $got -eq 0 ] && [ ! -s "$scratch/err" ]
        verdict $? "gnuplot warns: nothing of it is shown"
    else
        [ $got -ne 0 ] && grep -q '^a word of gnuplot$' "$scratch/err" && grep -q 'could not draw' "$scratch/err"
        verdict $? "gnuplot fails: what it said is shown"
    fi
done
exit $failed
