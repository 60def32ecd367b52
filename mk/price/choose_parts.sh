# choose_parts.sh: what choose_check.sh reads and reckons with; to be sourced.

nicely="nice -n 5"
wrong() { echo "$2" >>"$out/$1.wrong"; }
# within A B: A <= B
within() { echo "$1 $2" | awk '{ exit !($1 != "" && $2 != "" && $1 + 0 <= $2 + 0) }'; }
product() { echo "$1 $2" | awk '{ printf "%.9g", $1 * $2 }'; }

# named COLUMN: as --of has it: der(X) is X', and a unit is left out
named() { echo "$1" | sed "s/ \[.*//; s/^der(\(.*\))\$/\1'/"; }

# bare_error: --error without its unit, which is the column's
bare_error() { echo "$error" | sed 's/^\([0-9.]*\(e[-+]*[0-9]*\)\{0,1\}\).*/\1/'; }

# places RANGE: the options of its three places, one a line; of none, an empty line
places() {
    [ "$1" != - ] || { echo; return; }
    echo "$1" | sed "s/=\|\.\./ /g" | awk -v q="'" '{
        option = index($1, q) ? "--start" : "--set"
        for (i = 0; i < 3; i++) { printf "%s %s=%.15g\n", option, $1, $2 + i * ($3 - $2) / 2 } }'
}
# between RANGE: one that is none of them
between() {
    echo "$1" | sed "s/=\|\.\./ /g" | awk -v q="'" '{
        printf "%s %s=%.15g\n", index($1, q) ? "--start" : "--set", $1, $2 + 0.3 * ($3 - $2) }'
}

# references SCENE PLACE STEP UNTIL ID: $out/ID.fine and .coarse, and $every, the spacing of their records; $matrix: what
# the motion as one matrix differs from them by, where that can be had, else -
references() {
    echo "$3 $4" | awk '{
        n = $2 / $1
        k = int(n / 2500) + 1
        m = 32
        while (m > 4 && n * m > 4e5) { m /= 2 }
        print k, m }' >"$out/steps"
    read -r spaced finer <"$out/steps"
    every="$spaced*$3"
    # shellcheck disable=SC2086 # options without blanks
    for times_finer in "fine $finer" "coarse $((finer / 2))"; do
        $nicely "$whirl" run $1 $2 --until "$4" --compensated --angles lookup --step "$3/${times_finer#* }" --every "$every" \
            --quiet --csv "$out/$5.${times_finer% *}" 2>"$out/errors"
    done
    matrix=-
    # shellcheck disable=SC2086
    if "$whirl" run $1 $2 --until "$4" --compensated --matrix exact --step "$3" --every "$every" --quiet --csv "$out/matrix" \
        2>"$out/errors"; then
        matrix=$(awk -F, -v of="$([ "$of" = - ] || echo "$of")" -f "$here/choose_error.awk" "$out/$5.fine" "$out/$5.coarse" "$out/matrix" |
            awk '{ print $1 }')
    fi
}

# figure NAME, figure_most NAME: of the answer in $told; "" where it is not known. Steps are rounded to whole numbers there.
# What was counted has no other most.
figure() { sed -n "s/^  $1  *\([0-9][0-9]*\) .*/\1/p" "$told"; }
figure_most() {
    most=$(sed -n "s/^  $1 .*at most \([0-9]*\):.*/\1/p" "$told")
    [ -n "$most" ] || most=$(figure "$1")
    echo "$most"
}

# eventful SCENE: has it contacts?
eventful() { grep -q "^$1|.*|contacts\$" "$here/choose_scenes.rows"; }

# clock_of CLOCK BOARD: in Hz; 0: no limit. bytes_of LIMIT BOARD flash|RAM: what is asked for, or what the chip has (data sheets)
clock_of() {
    case $1$2 in
    -atmega*) echo 16000000 ;;
    -*) echo 0 ;;
    *) echo "$1" | sed "s/$2\$//; s/MHz\$//; s/Hz\$/ 1/" | awk '{ print $1 * (NF > 1 ? 1 : 1e6) }' ;;
    esac
}
bytes_of() {
    case $1$2$3 in
    -atmega328pflash) echo 32768 ;;
    -atmega328pRAM) echo 2048 ;;
    -atmega2560flash) echo 262144 ;;
    -atmega2560RAM) echo 8192 ;;
    -*) echo 0 ;;
    *) echo "$1" | sed 's/KB$/ 1024/' | awk '{ print $1 * (NF > 1 ? $2 : 1) }' ;;
    esac
}

# tighten N: the N-th tightened request to $out/tN.ask, of what was answered with a rate on a board whose cycles are counted; 1:
# there is none. Which request, which limit and how far follow from the seed.
tighten() {
    awk '$NF == "yes" { print $1 }' "$out/answered" | while read -r id; do
        IFS='|' read -r _ on _ _ _ _ at _ _ _ <"$out/$id.ask"
        case $at$on in -* | *host | *an500 | *an505 | *rv32*) ;; *) echo "$id" ;; esac
    done >"$out/bases"
    [ -s "$out/bases" ] || return 1
    awk -v seed="$seed" -v n="$1" -v all="$(wc -l <"$out/bases")" 'BEGIN {
        state = (seed * 6271 + n * 104729) % 2147483646 + 1
        for (i = 0; i < 20; i++) { state = (state * 16807) % 2147483647 }
        which = state % all + 1
        for (i = 0; i < 9; i++) { state = (state * 16807) % 2147483647 }
        print which, state % 4 }' >"$out/draw"
    read -r which far <"$out/draw"
    base=$(sed -n "${which}p" "$out/bases")
    told=$out/$base.told
    IFS='|' read -r scene board horizon of error vary rate clock flash ram <"$out/$base.ask"
    step=$(sed -n 's/^chosen .*--step //p' "$told")
    # what the chosen setting takes of a second, at the most; and a board's clock, whole Hz
    needs=$(echo "$(figure_most 'the longest') $step" | awk '{ print $1 / $2 }')
    [ "$clock" != - ] || clock=$(echo "$needs" | awk '{ printf "%.0fHz", 8 * $1 }')
    case $(($1 % 5)) in
    0 | 1 | 3) clock=$(echo "$needs $far" | awk '{ split("0.05 0.1 0.2 0.3", f, " "); printf "%.0fHz", $1 * f[$2 + 1] }') ;;
    esac
    case $(($1 % 5)) in
    2)
        clock=$(echo "$needs $far" | awk '{ split("1.2 2 3 4", f, " "); printf "%.0fHz", $1 * f[$2 + 1] }')
        error=$(echo "$error $(bare_error) $far" | awk '{ n = length($2); printf "%.2g%s\n", $2 * 10 ^ -(3 + $3), substr($1, n + 1) }')
        ;;
    3) flash=$(echo "$(figure flash) $far" | awk '{ split("0.5 0.6 0.7 0.85", f, " "); printf "%.0f", $1 * f[$2 + 1] }') ;;
    4) ram=$(echo "$(figure RAM) $(figure stack) $far" | awk '{ split("0.3 0.4 0.5 0.7", f, " "); printf "%.0f", ($1 + $2) * f[$3 + 1] }') ;;
    esac
    echo "$scene|$board|$horizon|$of|$error|$vary|$rate|$clock|$flash|$ram" >"$out/t$1.ask"
    # bounds of this board's promises, as factors
    echo "$(figure 'the longest') $(figure_most 'the longest') $(figure flash) $(figure_most flash) $(figure RAM) $(figure_most RAM) $(figure stack) $(figure_most stack)" |
        awk '{ print $2 / $1, $4 / $3, $6 / $5, $8 / $7 }' >"$out/t$1.bounds"
}
