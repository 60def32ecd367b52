#!/bin/sh
# plots.sh: `whirl run --plot`: the time axes of all panels are aligned, whatever their numbers and names. No message of
# gnuplot appears unless it fails. Generated outputs; the seed is printed.
. "$(dirname "$0")/../checks.sh"

if ! command -v gnuplot >/dev/null 2>&1; then
    echo "ok - no gnuplot here: nothing to draw"
    exit 0
fi
seed=${PLOT_SEED:-7}
echo "# seed $seed"

# Writes outputs of many sizes, constant ones, some without a value, with short and long names, each with a unit of
# its own.
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

# aligned FILE: all frames must begin and end at the same places, and there is one for each unit: x and the six
# outputs.
aligned() {
    sed -n "s/.* d='M\([0-9.]*\),[0-9.]* L[0-9.]*,[0-9.]* L\([0-9.]*\),.* Z  '.*/\1 \2/p" "$1" >"$scratch/frames"
    [ "$(sort -u "$scratch/frames" | wc -l)" -eq 1 ] && [ "$(wc -l <"$scratch/frames")" -eq 14 ]
}

for number in 1 2 3 4 5 6; do
    generate $number
    for until in 2s 0; do
        for quiet in '' --quiet; do
            "$whirl" run "$scratch/drawn.whirl" --until $until $quiet --plot "$scratch/drawn.svg" \
                >"$scratch/out" 2>"$scratch/err"
            code=$?
            # the run reports an output without a value, and fails; gnuplot prints nothing
            sed '/: error: at t = .* is not a finite number: output /,/^hint: give it a value/d' "$scratch/err" >"$scratch/more"
            [ $code -eq "$(grep -c ': error: ' "$scratch/err")" ] && [ ! -s "$scratch/more" ]
            verdict $? "mechanism $number until $until $quiet: drawn without a word of gnuplot's"
            check "mechanism $number until $until $quiet: the time axes stand below each other" aligned "$scratch/drawn.svg"
        done
    done
done

# --- a model's texts are never commands, and are shown unchanged -------------------------------------
# Generated titles and file names have characters that are special to gnuplot, a shell or XML. Each would create a file if
# it were executed. Control characters in titles become blanks in the picture.
case $whirl in /*) ;; *) whirl=$PWD/$whirl ;; esac
pieces='` $( ) ${ \ \\ \n \" _ ^ { } @ & &amp; &#65; < > ]]> ~ % %d # ; | ! ~a{.8b} a^2 a_{i} {/=30 @x ä µ → ° 𝄞 word'
mkdir "$scratch/in"
nasty() { # nasty NUMBER: prints a title
    printf '%s\n' "$pieces" | awk -v seed="$seed" -v number="$1" '{
        srand(seed * 1000 + number)
        made = ""
        for (i = 0; i < 9; i++) made = made $(1 + int(rand() * NF)) (rand() < 0.5 ? " " : "")
        split("`touch made`,\047.system(\"touch made\").\047,\"\n!touch made\n\",$(touch made),\\\047`touch made`", command, ",")
        gsub(/"/, "", command[1 + number % 5])
        print made command[1 + number % 5] "w\047s" made "x"
    }' | tr -d '"' | tr '\n' ' ' | sed 's/ $//'
}
number=0
while [ $number -lt "${PLOT_CASES:-5}" ]; do
    number=$((number + 1))
    title=$(nasty $number)
    printf 'mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'"'"'^2/2\noutput k_x [m^(1/2)*kg] = 1 [m^(1/2)*kg]\nscene s "' >"$scratch/in/m.whirl"
    printf '%s" { until 10 [ms] }\n' "$title" >>"$scratch/in/m.whirl"
    file=$(printf '%s' "$title" | tr '/' '-').svg
    case $number in
    *[02468]) file="|touch made;$file" ;;
    *5) file="~$file" ;;
    esac
    (cd "$scratch/in" && "$whirl" run m.whirl --quiet --plot "$file") >"$scratch/out" 2>"$scratch/err"
    code=$?
    [ $code -eq 0 ] && [ ! -s "$scratch/err" ] && [ ! -e "$scratch/in/made" ] && [ -s "$scratch/in/$file" ]
    verdict $? "title $number: drawn, nothing is executed"
    wanted=$(printf '<text>s: %s</text>' "$(printf '%s' "$title" | sed 's/&/\&amp;/g; s/</\&lt;/g')")
    sed 's/'"$(printf '\342\201\240')"'//g; s/<text xml:space="preserve">/<text>/' "$scratch/in/$file" >"$scratch/svg"
    grep -qF -- "$wanted" "$scratch/svg" && ! grep -qF ']]>' "$scratch/in/$file" && grep -qF '<text>k_x</text>' "$scratch/svg"
    verdict $? "title $number: stands as it is written"
    rm -rf "$scratch/in"
    mkdir "$scratch/in"
done

# --- the picture shows the whole run -------------------------------------------------------------------
# If there are too many swings to be seen singly, the curve reaches the top and the bottom of the frame in each part. The
# curve is the longest path of the picture, after its sample in the legend.
printf 'mechanism swings\ncoordinate x [m]\nT = 1 [kg]*x'"'"'^2/2\nV = 39.4784176 [N/m]*x^2/2\nscene s { start x = 1 [m]\nstep 10 [ms]\nuntil 4000 [s] }\n' >"$scratch/swings.whirl"
"$whirl" run "$scratch/swings.whirl" --quiet --plot "$scratch/swings.svg"
tr "\n'" ' \n' <"$scratch/swings.svg" | awk 'length > longest { longest = length; path = $0 } END { sub(/.*M/, "L", path); print path }' |
    tr ' ' '\n' | sed -n 's/^L*\([0-9.][0-9.]*\),\([0-9.][0-9.]*\)$/\1 \2/p' |
    awk '{ y[++n] = $2; if (n == 1 || $2 < low) low = $2; if ($2 > high) high = $2 }
        END {
            for (i = 1; i <= n; i++) { if (y[i] < low + 15) top++; if (y[i] > high - 15) bottom++ }
            print n, top, bottom; exit !(high - low > 150 && top >= 2000 && bottom >= 2000 && n - top - bottom < 200)
        }' >"$scratch/swings"
verdict $? "4000 swings in 400000 steps: drawn as the band that they fill ($(cat "$scratch/swings"))"
"$whirl" run "$scratch/swings.whirl" --quiet --until 0 --plot "$scratch/point.svg"
check "a single point is drawn" grep -q "<use xlink:href='#gpPt6'.*/>" "$scratch/point.svg"

# --- the pictures of the pages: only colours of the palette, a title and an alternative text ------------------------------
allowed=$(grep -o '"#[0-9a-f]\{6\}"' host/io/gnuplot.h | tr -d '"#')
[ "$(echo "$allowed" | wc -l)" -ge 15 ]
verdict $? "the palette is read" /dev/null
# foreign: prints each colour of a picture that is in no palette, and what is missing
foreign() {
    grep -o "rgb([ 0-9,]*)" "$1" | sort -u | tr -d 'rgb() ' | awk -F, '{ printf "%02x%02x%02x\n", $1, $2, $3 }' | grep -vxF "$allowed
000000"
    grep -q '^<title>..*</title>' "$1" && ! grep -qE '^<title>(Gnuplot|[^<]*([a-z]{3}/[a-z]{3}|[.]whirl)[^<]*)</title>' "$1" || echo "no title in words"
    grep -q '^<desc>..*</desc>' "$1" && ! grep -q '^<desc>Produced by GNUPLOT' "$1" || echo "no alternative text"
}
sh mk/curves/chart.sh "$scratch/fronts.svg" docs/figures/price.csv epicyclic_from_rest fronts mps2-an386 atmega328p 2>"$scratch/err"
for picture in "$scratch/fronts.svg" docs/figures/fi*.svg docs/figures/map_*.svg docs/figures/hard/*.svg; do
    foreign "$picture" >"$scratch/said"
    [ ! -s "$scratch/said" ]
    verdict $? "${picture##*/}: the palette's colours, a title, a text" "$scratch/said"
done
foreign docs/figures/price.csv >"$scratch/said"
[ "$(wc -l <"$scratch/said")" -eq 2 ]
verdict $? "and a picture without them is seen" "$scratch/said"

# --- gnuplot's own messages: a stand-in that warns, and one that fails --------------------------------
mkdir "$scratch/bin"
for code in 0 1; do
    printf '#!/bin/sh\ncat >/dev/null\necho "<svg>a picture</svg>"\necho "a word of gnuplot" >&2\nexit %s\n' $code >"$scratch/bin/gnuplot"
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

# --- a file that accepts no more bytes, as on a full disk, although gnuplot reports success ------------
for kind in svg png; do
    "$whirl" run epicyclic_from_rest --until 1s --quiet --plot "$scratch/whole.$kind" 2>"$scratch/err"
    check "a whole picture is one: $kind" [ $? -eq 0 ]
    blocks=$((($(wc -c <"$scratch/whole.$kind") - 1) / 512))
    for most in 1 $((blocks / 2)) $blocks; do # in the last case, less than 512 bytes are missing
        (
            ulimit -f "$most"
            "$whirl" run epicyclic_from_rest --until 1s --quiet --plot "$scratch/half.$kind"
        ) 2>"$scratch/err"
        [ $? -eq 1 ] && grep -qE "could not draw $scratch/half.$kind|half.$kind: error: cannot be written" "$scratch/err" &&
            [ ! -e "$scratch/half.$kind" ]
        verdict $? "$most of $blocks blocks of a picture are none: $kind" "$scratch/err"
    done
done
exit $failed
