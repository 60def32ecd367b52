# choose_prove.sh: "nothing fits" proved by trying everything; to be sourced by choose_check.sh.
#
# Every method, number and form that the scene takes is built for the board, counted, and, as far as flash, RAM and clock let its steps
# be, run by 1, 2, ... steps a period at every place of the range. What keeps half the error allowed then (a margin of 2 is
# part of the answer) fits by what was counted. That is proof against `whirl choose` where even the most that could have
# been promised of it fits: the counted figure times the promise's bound, twice. Else the caution of the promise refused it,
# and that is told. With contacts the longest step of the whole run by the coarsest step that keeps the error is counted for every
# setting, and what does not fit by that fits by none (a step without an event, counted, bounds how many there can be). An answer that says to have left settings for want of effort claims no proof, and gets none.

# forms: option words of every setting, one a line, "NUMBER|WORDS". The axes are those of `whirl price --csv`.
forms() {
    "$whirl" price two_mass_relative --effort 0.0001 --quiet --csv "$out/axes.csv" >/dev/null 2>"$out/errors" || true
    head -n 1 "$out/axes.csv" | tr ',' '\n' | sed -n '/^step_s$/,/^flash_bytes$/p' | sed '1d;$d' >"$out/axes"
    "$whirl" run two_mass_relative --method '?' 2>&1 | sed -n 's/,//g; s/^hint: one of //p' | tr ' ' '\n' |
        sed 's/^/--method /' >"$out/forms"
    while read -r axis; do
        case $axis in
        method) continue ;;
        number) words='|,| --compensated' ;;
        angles) words='|,| --angles lookup' ;;
        tables) words='|,| --tables linear,| --tables cubic' ;;
        matrix) words='|,| --matrix exact,| --matrix rk4' ;;
        *) echo "choose_prove.sh: a new axis of settings: $axis" >&2 && return 1 ;;
        esac
        awk -v words="$words" '{ n = split(words, w, ","); for (i = 1; i <= n; i++) { sub(/^\|/, "", w[i]); print $0 w[i] } }' \
            "$out/forms" >"$out/more"
        mv "$out/more" "$out/forms"
    done <"$out/axes"
    # sums are compensated in float; double is predicted where a board's rows have it, and counted where there is one
    sed 's/^/float|/' "$out/forms"
    case $board in
    atmega*) ;;
    mps2-an386 | host) grep -v -e --compensated "$out/forms" | sed 's/^/double|/' ;;
    *) case " $CHOOSE_WORDS " in *" --predict "*) ;; *) grep -v -e --compensated "$out/forms" | sed 's/^/double|/' ;; esac ;;
    esac
}

# count_forms ID: "NUMBER|WORDS|CYCLES|FLASH|RAM|STACK" of what can be built, to $out/ID.costs
count_forms() {
    forms >"$out/$1.forms"
    : >"$out/$1.costs"
    : >"$out/$1.unfit"
    for kind in float double; do
        # a form that the scene does not take cannot be derived, and gets no row
        grep "^$kind|" "$out/$1.forms" | cut -d'|' -f2 | awk -v scene="$scene" '{ print "f" NR, scene, $0 }' >"$out/$1.cases"
        [ -s "$out/$1.cases" ] || continue
        rm -rf "$out/build" "$out/$1.rows"
        $nicely make -s BOARD="$board" price-measure-board PRICE_CASES="$out/$1.cases" PRICE_CSV="$out/$1.rows" \
            PRICE_OUT="$out/build" NUMBERS=$kind STEPS=20 WORST=0 >"$out/made" 2>&1 || true
        grep 'does not fit into' "$out/made" >>"$out/$1.unfit" || true
        # where nobody counts cycles, the most that is promised of an instruction (docs/price.md)
        case $board in *an500 | *an505 | host) each=3 ;; rv32imac) each=4 ;; *) each=5 ;; esac
        # a row has its words written together, as measure.sh does
        awk -v kind=$kind -v each=$each '
            FILENAME ~ /cases$/ {
                key = "rk4"; more = ""; words = ""
                for (i = 3; i <= NF; i++) {
                    words = words (i > 3 ? " " : "") $i
                    if ($i == "--method") { i++; key = $i; words = words " " $i }
                    else if ($i == "--angles") { i++; more = more ($i == "turned" ? "" : "-" $i); words = words " " $i }
                    else { option = $i; sub(/^--/, "", option); more = more (option ~ /=/ ? ":" : "-") option }
                }
                of[key more] = words
                next
            }
            { split($0, f, ",") }
            f[7] in of { print kind "|" of[f[7]] "|" (f[11] == "" ? f[9] * each : f[11]) "|" f[13] "|" f[14] "|" f[15] }' "$out/$1.cases" "$out/$1.rows" >>"$out/$1.costs"
    done
}

# keeps ID NUMBER|WORDS STEPS: does so many steps a period keep half the error at all places?
keeps() {
    number=$([ "${2%%|*}" = double ] || echo "--number float")
    place=0
    while read -r where; do
        place=$((place + 1))
        # shellcheck disable=SC2086 # words
        "$whirl" run "$scene" $where ${2#*|} $number --step "1/$rate/$3" --every "$every" --until "$until" --quiet \
            --csv "$out/$1.run" >"$out/errors" 2>&1 || return 1
        awk -F, -v of="$([ "$of" = - ] || echo "$of")" -f "$here/choose_error.awk" "$out/$1.fine$place" "$out/$1.coarse$place" \
            "$out/$1.run" | awk -v most="$(bare_error)" '{ exit !($1 != "inf" && 2 * $1 <= most) }' || return 1
    done <"$out/$1.where"
}

# run_fits ID NUMBER|WORDS STEPS: with contacts, do the counted steps of its whole run keep the limits, at all places? 0 where they
# do; their longest step, flash, RAM and stack to $out/run_figures
run_fits() {
    number=${2%%|*}
    : >"$out/run_rows"
    while read -r where; do
        # shellcheck disable=SC2086 # words
        $nicely sh "$here/measure_one.sh" --whole-run "$board" "$number" "$scene" $where ${2#*|} --step "1/$rate/$3" --until "$until" \
            2>"$out/errors" | tail -n 1 >>"$out/run_rows" || true
    done <"$out/$1.where"
    [ "$(grep -c "^$board," "$out/run_rows")" -eq "$(wc -l <"$out/$1.where")" ] || return 1
    case $board in *an500 | *an505) each=3 ;; rv32imac) each=4 ;; *) each=5 ;; esac
    awk -F, -v each=$each '
        { longest = $8 != "" ? $8 : $5 * each
          if (longest > c) { c = longest } if ($11 > f) { f = $11 } if ($12 > r) { r = $12 } if ($13 > s) { s = $13 } }
        END { print c, f, r, s }' "$out/run_rows" >"$out/run_figures"
    echo "$limits $rate $3 $(cat "$out/run_figures")" |
        awk '{ exit !(!($1 && $6 * $4 * $5 > $1) && !($2 && $7 > $2) && !($3 && $8 + $9 > $3)) }'
}

# prove ID: $proof, words; `wrong` where something fits that had to be found
prove() {
    told=$out/$1.told
    asked_rate=$rate
    # without a rate any step will do: those that divide a tenth of a second are tried
    [ "$rate" != - ] || rate=10
    until=$(sed -n 's/^  horizon *\([0-9.e-]*\) s.*/\1/p' "$told")
    places "$vary" "$scene" >"$out/$1.where"
    place=0
    while read -r where; do
        place=$((place + 1))
        references "$scene" "$where" "1/$rate" "$until" "$1"
        mv "$out/$1.fine" "$out/$1.fine$place"
        mv "$out/$1.coarse" "$out/$1.coarse$place"
    done <"$out/$1.where"
    count_forms "$1"
    limits="$(clock_of "$clock" "$board") $(bytes_of "$flash" "$board" flash) $(bytes_of "$ram" "$board" RAM)"
    [ -s "$out/$1.bounds" ] || echo "3 2 2 3" >"$out/$1.bounds"
    ladder="1 2 3 4 5 6 7 8 9 10"
    for tens in 1 10 100; do
        for steps in 12 15 20 25 30 40 50 60 80 100; do ladder="$ladder $((steps * tens))"; done
    done
    by_run=
    ! eventful "$scene" || by_run=yes
    runs_counted=0
    tried=0
    small=0
    long=0
    fits=
    left=
    while IFS='|' read -r number words cycles flash_is ram_is stack_is; do
        # how many steps a period can have, and what of them even the promises let pass
        echo "$limits $rate $cycles $flash_is $ram_is $stack_is $(cat "$out/$1.bounds")" | awk '{
            fits = !($2 && $6 > $2 || $3 && $7 + $8 > $3)
            surely = !($2 && $6 * $10 * $10 > $2 || $3 && $7 * $11 * $11 + $8 * $12 * $12 > $3)
            n = $1 ? int($1 / $4 / $5) : 1e9
            print (fits ? n : 0), (surely ? ($1 ? int($1 / $4 / ($5 * $9 * $9)) : 1e9) : 0) }' >"$out/most"
        read -r steps_most steps_surely <"$out/most"
        counted_in=$number # keeps() has a word of its own
        [ -z "$by_run" ] || steps_surely=$steps_most
        [ "$steps_most" -gt 0 ] || small=$((small + 1))
        for steps in $ladder; do
            [ "$steps" -le "$steps_most" ] || break
            if ! within "$(product "$steps" "$(product "$rate" "$until")")" 2e5; then
                long=$((long + 1))
                break
            fi
            tried=$((tried + 1))
            keeps "$1" "$counted_in|$words" $steps || continue
            if [ -n "$by_run" ]; then
                runs_counted=$((runs_counted + 1))
                run_fits "$1" "$counted_in|$words" $steps || break
            fi
            echo "$counted_in $words, $steps in a period, $cycles cycles" >>"$out/$1.fits"
            fits="$counted_in $words"
            if grep -q '^nothing fits of .* raise --effort$' "$told"; then
                left=yes # it did not claim to have tried them all
            elif [ "$steps" -le "$steps_surely" ] && { [ -n "$by_run" ] || has_price "$1" "$counted_in" "$words"; }; then
                wrong "$1" "$counted_in $words fits: $steps in a period, $cycles cycles, $flash_is bytes of flash, $ram_is + $stack_is of RAM"
            fi
            break
        done
    done <"$out/$1.costs"
    settings=$(wc -l <"$out/$1.costs")
    # what cannot be linked fits no limit; what is too large with the program that counts alone, nobody has counted
    unfit=$(grep -c 'its firmware does not fit' "$out/$1.unfit" || true)
    uncounted=$(grep -c 'the program that counts' "$out/$1.unfit" || true)
    [ $((settings + unfit)) -gt 0 ] || wrong "$1" "no setting could be built and counted"
    rate=$asked_rate
    proof="proved, $settings settings, $small of them fit by no step, $unfit more cannot be linked, $tried runs"
    [ -z "$by_run" ] || proof="$proof, $runs_counted of them counted to their end"
    [ "$uncounted" -eq 0 ] || proof="not proved, $uncounted settings cannot be counted"
    [ $long -eq 0 ] || proof="not proved, $long of $settings settings have steps too fine to try; $tried runs"
    [ -z "$left" ] || proof="not claimed, $(wc -l <"$out/$1.fits") of $settings settings fit that may be among those left; "
    [ -z "$fits" ] || [ -n "$left" ] || proof="cautious, $settings settings, $(wc -l <"$out/$1.fits") fit by what was counted"
}

# has_price ID NUMBER WORDS: does `whirl choose` know a price of it? Its count of those without is no names; `whirl price` has them.
has_price() {
    case " $CHOOSE_WORDS " in *" --predict "*) ;; *) return 0 ;; esac # what can be built is counted
    [ -s "$out/$1.priced" ] ||
        "$whirl" price "$scene" --board "$board" --horizon 0.1s --effort 0.02 --quiet --csv "$out/$1.priced" >/dev/null 2>&1 || true
    run=$([ "$2" = double ] || echo " --number float")
    grep -q -e "$(echo "$3" | sed "s/^\(--method [a-z0-9-]*\)/\1$run/") --step" "$out/$1.priced"
}
