#!/bin/sh
# choose_check.sh SEED: is what `whirl choose` answers true? `make choose-check CHOOSE_SEED=7`, from the tree's root.
#
# Draws twenty requests (choose_draw.awk), asks, and then ten more, each an answered one with a limit tightened until it
# should fail. What is answered is run: its error is measured anew against RK4 in double with compensated sums and angles looked up,
# by steps a 32nd to a quarter of the chosen one (and by twice these, which tells what that reference does not know itself);
# of a linear scene also against the motion as one matrix. It is built for the board by the line that is printed, and
# counted. Where nothing is said to fit, choose_prove.sh tries everything. Tables and a summary go to standard output, rows
# to build/figures/choose.csv; the exit status is 1 where something does not hold.
#
#   CHOOSE_ASKED=20 CHOOSE_TIGHTENED=10   how many requests
#   CHOOSE_EFFORT=0.03                    of `whirl choose`
#   CHOOSE_ONLY=contacts                  scenes whose row has this, a pattern of grep's
#   CHOOSE_OUT=build/choose_check          a folder to work in
#   CHOOSE_WORDS=--predict                more words for it. By itself it counts
set -eu
here=$(dirname "$0")
seed=${1:-1}
: "${CHOOSE_ASKED:=20}" "${CHOOSE_TIGHTENED:=10}" "${CHOOSE_EFFORT:=0.03}" "${CHOOSE_WORDS:=}"
case $seed$CHOOSE_ASKED$CHOOSE_TIGHTENED in
*[!0-9]*) echo "choose_check.sh: error: seed and numbers of requests are whole numbers" >&2 && exit 2 ;;
esac
whirl=build/whirl
out=${CHOOSE_OUT:-build/choose_check}
csv=build/figures/choose.csv
rm -rf "$out"
mkdir -p "$out" build/figures
. "$here/choose_parts.sh"
. "$here/choose_prove.sh"
[ -s "$csv" ] || echo "commit,seed,request,board,scene,asked,verdict,setting,allowed,said,measured,unknown,holds,promised,counted,promised_most,counted_most,unit,flash,flash_most,ram,ram_most,stack,stack_most" >"$csv"
commit=$(. "$here/../count/common.sh" && commit_of_checkout)

# ask ID: the request of $out/ID.ask ("scene|board|..." as choose_draw.awk has it, E in its unit); the answer to $out/ID.told,
# its exit status to $out/ID.code
ask() {
    IFS='|' read -r scene board horizon of error vary rate clock flash ram <"$out/$1.ask"
    set -- "$1" "$scene" --board "$board" --effort "$CHOOSE_EFFORT" --error "$error"
    [ "$of" = - ] || set -- "$@" --of "$(named "$of")"
    [ "$horizon" = - ] || set -- "$@" --horizon "${horizon}s"
    [ "$vary" = - ] || set -- "$@" --vary "$vary"
    [ "$rate" = - ] || set -- "$@" --rate "${rate}Hz"
    [ "$clock" = - ] || set -- "$@" --clock "$clock"
    [ "$flash" = - ] || set -- "$@" --flash "$flash"
    [ "$ram" = - ] || set -- "$@" --ram "$ram"
    id=$1
    shift
    echo "whirl choose $*" >"$out/$id.asked"
    set +e
    # shellcheck disable=SC2086 # words
    $nicely "$whirl" choose "$@" $CHOOSE_WORDS --quiet >"$out/$id.told" 2>"$out/$id.errors"
    echo $? >"$out/$id.code"
    set -e
}

# into_unit ERROR: the digits as a part of the column's largest value, in the column's unit, such as 0.0012rad
into_unit() {
    [ "$of" = - ] && echo "$1" && return
    places "$vary" "$scene" | head -n 1 >"$out/place"
    # shellcheck disable=SC2046 # options without blanks
    "$whirl" run "$scene" $(cat "$out/place") --quiet --csv "$out/scale.csv" $([ "$horizon" = - ] || echo "--until ${horizon}s") \
        --step 0.0005 --every 0.005 2>"$out/errors"
    awk -F, -v of="$of" -f "$here/choose_error.awk" "$out/scale.csv" "$out/scale.csv" |
        awk -v part="$1" -v unit="$(echo "$of" | sed -n 's/.*\[\(.*\)\]/\1/p')" '{ printf "%.2g%s\n", $1 * part, unit }'
}

# judge_answer ID: appends "what does not hold" to $out/ID.wrong, and the figures to $out/ID.row
judge_answer() {
    told=$out/$1.told
    again=$(sed -n 's/^again *whirl run //p' "$told")
    counted=$(sed -n 's/^counted by *//p' "$told")
    code=$(sed -n 's/^as code *whirl //p' "$told")
    setting=$(sed -n 's/^chosen *//p' "$told")
    step=$(echo "$setting" | sed 's/.*--step //')
    until=$(echo "$again" | sed 's/.*--until //')
    allowed=$(bare_error)
    said=$(sed -n 's/^  error *\(at most \)\{0,1\}\([0-9.e+-]*\) .*/\2/p' "$told")
    eval "\"$whirl\" $code" >"$out/$1.c" 2>"$out/errors" && grep -qE 'wh_(fixed_)?scene' "$out/$1.c" || wrong "$1" "its code is not derived"
    : >"$out/$1.places"
    places "$vary" "$scene" >"$out/$1.where"
    [ "$vary" = - ] || between "$vary" "$scene" >>"$out/$1.where"
    place=0
    while read -r where; do
        place=$((place + 1))
        references "$scene" "$where" "$step" "$until" "$1"
        # the line as printed is the worst place's; elsewhere the place is another, and all else the same
        line="$scene $where $setting --until $until"
        case " $again " in *" $where "*) line=$again ;; esac
        # shellcheck disable=SC2086 # words without blanks
        $nicely "$whirl" run $line --every "$every" --quiet --csv "$out/$1.run" >"$out/errors" 2>&1 || true
        awk -F, -v of="$([ "$of" = - ] || echo "$of")" -f "$here/choose_error.awk" "$out/$1.fine" "$out/$1.coarse" "$out/$1.run" |
            sed "s/\$/ $place $matrix/" >>"$out/$1.places"
    done <"$out/$1.where"
    # of a range, the three places that are promised; the one between is told, not held
    awk -v allowed="$allowed" -v vary="$vary" '
        { part = $1 == "inf" ? 1e9 : ($1 + $2) / allowed }
        vary != "-" && $5 == 4 { between = part; next }
        !any++ || part > worst { worst = part; error = $1; unknown = $2 }
        $6 != "-" && $6 > 0.01 * allowed { matrix = 1 }
        END { print error, unknown, worst, (between == "" ? "-" : between), matrix + 0 }' "$out/$1.places" >"$out/$1.error"
    read -r measured unknown part inside matrix_off <"$out/$1.error"
    within "$part" 1 || wrong "$1" "its error is $part of what is allowed"
    [ "$matrix_off" = 0 ] || wrong "$1" "the reference is not the motion as one matrix"
    # the printed error is of some records, the measured one of others: no smaller than a third of it
    within "$said" "$(product "$measured" 3)" || within "$said" "$unknown" || wrong "$1" "its error is told as $said, and measured as $measured"
    eval "$nicely $counted" >"$out/$1.counted" 2>"$out/errors" || wrong "$1" "the line that counts it fails: $(head -n 1 "$out/errors")"
    judge_price "$1"
    part_shown=$(echo "$part" | awk '{ printf "%.3f", $1 }')
    [ "$inside" = - ] || part_shown="$part_shown ($(echo "$inside" | awk '{ printf "%.3f", $1 }') between)"
}

# judge_price ID: what was counted against what was promised, and against the limits
judge_price() {
    what=cycles column=10
    grep -q '^  a step .*cycles' "$told" || { what=instructions column=8; }
    promised=$(figure 'a step') promised_most=$(figure_most 'a step') longest_most=$(figure_most 'the longest')
    # a whole run has a row of its own (count_run.sh)
    awk -F, -v c="$column" '
        FNR == 1 { runs = /^board,number,steps/; c = runs ? (c == 10 ? 7 : 4) : c; next }
        { print $c, $(c + 1), $(runs ? 11 : 13) + 0, $(runs ? 12 : 14) + 0, $(runs ? 13 : 15) + 0 }' "$out/$1.counted" >"$out/figures"
    read -r mean most flash_is ram_is stack_is <"$out/figures"
    off=$(echo "$promised $mean" | awk '{ printf "%.1f", ($2 > 0 ? 100 * ($1 / $2 - 1) : 0) }')
    # a mean is told as a whole number; of a range it is that of the dearest place
    within "$mean" "$(echo "$promised_most" | awk '{ print $1 + 0.5 }')" || wrong "$1" "a step takes $mean $what, above the promised $promised_most"
    within "$most" "$longest_most" || wrong "$1" "the longest step takes $most $what, above the promised $longest_most"
    for one in "flash $flash_is" "RAM $ram_is" "stack $stack_is"; do
        least=$(figure_most "${one% *}")
        [ -z "$least" ] || within "${one#* }" "$least" || wrong "$1" "${one% *} is ${one#* }, above the promised $least"
    done
    hertz=$(clock_of "$clock" "$board")
    if [ "$hertz" != 0 ]; then
        loaded=$(sed -n 's/^  load .*at most \([0-9.e+-]*\) %.*/\1/p; s/^  load .* to \([0-9.e+-]*\) %.*/\1/p' "$told")
        within "$loaded" 100 || wrong "$1" "the load is told as $loaded %"
        if [ $what = cycles ]; then
            load=$(echo "$most $step $hertz" | awk '{ print 100 * $1 / $2 / $3 }')
            within "$load" "$(product "$loaded" 1.006)" || wrong "$1" "the load is $load %, above the promised $loaded %"
        fi
    fi
    limit=$(bytes_of "$flash" "$board" flash)
    [ "$limit" = 0 ] || within "$flash_is" "$limit" || wrong "$1" "flash is $flash_is of $limit"
    limit=$(bytes_of "$ram" "$board" RAM)
    [ "$limit" = 0 ] || within $((ram_is + stack_is)) "$limit" || wrong "$1" "RAM with the stack is $((ram_is + stack_is)) of $limit"
}

# row ID VERDICT: a line of the table, and one of the CSV
row() {
    holds=yes
    [ ! -s "$out/$1.wrong" ] || holds=NO
    if [ "$2" = answered ]; then
        printf '%-4s %-13s %-38s error %-22s %s %8.8s of %6s (%+6.1f %%)  %s\n' "$1" "$board" "$scene${setting#*--method}" "$part_shown" \
            "$what" "$promised" "$mean" "$off" "$holds"
        echo "$1 $part $off $inside $holds" >>"$out/answered"
        echo "$commit,$seed,$1,$board,$scene,$(tr ',' ';' <"$out/$1.asked"),$2,$setting,$allowed,$said,$measured,$unknown,$holds,$promised,$mean,$longest_most,$most,$what,$flash_is,$(figure_most flash),$ram_is,$(figure_most RAM),$stack_is,$(figure_most stack)" >>"$csv"
    else
        printf '%-4s %-13s %-38s %s: %s  %s\n' "$1" "$board" "$scene" "$2" "$proof" "$holds"
        echo "$1 $holds $proof" >>"$out/none"
        echo "$commit,$seed,$1,$board,$scene,$(tr ',' ';' <"$out/$1.asked"),$2 ($proof),,$(bare_error),,,,$holds,,,,,,,,,,," >>"$csv"
    fi
    [ ! -s "$out/$1.wrong" ] || sed 's/^/     /' "$out/$1.wrong" "$out/$1.asked"
}

# treat ID: ask and judge
treat() {
    ask "$1"
    : >"$out/$1.wrong"
    case $(cat "$out/$1.code") in
    0) judge_answer "$1"; row "$1" answered ;;
    1)
        if grep -q '^nothing fits' "$out/$1.told"; then
            prove "$1"
            row "$1" "nothing fits"
        else
            wrong "$1" "no answer: $(tail -n 1 "$out/$1.errors")"
            proof="no reference"
            row "$1" refused
        fi
        ;;
    *) wrong "$1" "refused: $(head -n 1 "$out/$1.errors")"; proof=refused; row "$1" refused ;;
    esac
}

: >"$out/answered"
: >"$out/none"
grep -e "${CHOOSE_ONLY:-.}" "$here/choose_scenes.rows" | grep -v '^#' >"$out/rows"
echo "seed $seed: error as a part of what was allowed; cycles or instructions a step, promised of counted"
awk -v seed="$seed" -v n="$CHOOSE_ASKED" -f "$here/choose_draw.awk" "$out/rows" >"$out/drawn"
i=0
while [ $i -lt "$CHOOSE_ASKED" ]; do
    i=$((i + 1))
    sed -n "${i}p" "$out/drawn" >"$out/r$i.ask"
    IFS='|' read -r scene board horizon of error vary rate clock flash ram <"$out/r$i.ask"
    echo "$scene|$board|$horizon|$of|$(into_unit "$error")|$vary|$rate|$clock|$flash|$ram" >"$out/r$i.ask"
    treat "r$i"
done
i=0
while [ $i -lt "$CHOOSE_TIGHTENED" ]; do
    i=$((i + 1))
    tighten $i || continue
    treat "t$i"
done
echo
awk -f "$here/choose_summary.awk" -v enough=$((CHOOSE_TIGHTENED * 8 / 10)) "$out/answered" "$out/none"
