#!/bin/sh
# again.sh PRICE.csv OUT [SCENE...]: repeats the counted rows of PRICE.csv (published.awk) from their command lines.
#
# WHIRL: the program. SOME=N: only every N-th row. COUNT=0: only the errors. BOARDS: only these boards.
#
# Error: the row's own line is run and compared with a reference that `whirl price` does not use: the classic Runge-Kutta
# method in double with compensated sums, with a step of a hundredth of the records' spacing. This reference is compared
# with twice its step. Errors must agree within a hundredth. Step: the code is built and counted again. Instructions and
# bytes must agree within a thousandth. If there are fewer rows, they have other neighbours in the image. This changes
# the estimate of cycles by some hundredths, so a difference of three or four cycles is accepted. Prints the rows that
# disagree, and the number that agree. Exit status 1: a row disagrees.
set -eu
here=$(dirname "$0")
: "${WHIRL:=build/whirl}" "${SOME:=1}" "${COUNT:=1}" "${BOARDS:=}"
csv=$1
out=$2
shift 2
rm -rf "$out"
mkdir -p "$out"
awk -F, -v OFS=, -v scenes="$*" -v boards="$BOARDS" -v some="$SOME" -f "$here/words.awk" -f /dev/stdin "$csv" >"$out/rows" <<'AWK'
FNR == 1 { header(); next }
function named(list, name) { return list == "" || index(" " list " ", " " name " ") > 0 }
field("basis") == "counted" && named(scenes, field("scene")) && named(boards, field("board")) && ++n % some == 0 {
    print field("scene"), field("board"), field("error"), field("component"), field("until_s") / field("records"), \
        field("step_s"), field("until_s"), field("instructions"), field("cycles"), field("flash"), field("ram"), field("run")
}
AWK
[ -s "$out/rows" ] || { echo "again.sh: error: $csv has no counted row of this" >&2 && exit 2; }

# records FILE LINE...: stores the records of `whirl run`, without the text
records() {
    file=$1
    shift
    [ -s "$file" ] || "$WHIRL" run "$@" --strict=off --csv - --quiet 2>"$out/err" >"$file" || {
        sed 's/^/again.sh: /' "$out/err" >&2
        exit 1
    }
}

bad=0
done=0
sort -u -t, -k1,1 -k12,12 "$out/rows" >"$out/errors"
while IFS=, read -r scene _ error component each step until _ _ _ _ run; do
    fine=$(awk -v each="$each" 'BEGIN { print each / 100 }')
    coarse=$(awk -v each="$each" 'BEGIN { print each / 50 }')
    records "$out/$scene.reference" "${scene%+*}" --compensated --step "$fine" --every "$each" --until "$until"
    records "$out/$scene.coarser" "${scene%+*}" --compensated --step "$coarse" --every "$each" --until "$until"
    every=$(awk -v each="$each" -v step="$step" 'BEGIN { print (step > each ? step : each) }')
    rm -f "$out/records"
    records "$out/records" ${run#whirl run } --every "$every"
    said=$(awk -F, -v component="$component" -v each="$each" -v wanted="$error" -f "$here/again.awk" \
        "$out/$scene.reference" "$out/$scene.coarser" "$out/records")
    done=$((done + 1))
    case $said in
    *agrees) ;;
    *)
        bad=$((bad + 1))
        echo "$run: an error of $error, again $said"
        ;;
    esac
done <"$out/errors"
echo "$done errors again, $((done - bad)) of them agree"

boards=$(cut -d, -f2 "$out/rows" | sort -u)
[ "$COUNT" = 1 ] || boards=
for board in $boards; do
    awk -F, -v OFS=, -v board="$board" '$2 == board { print $1, $12 }' "$out/rows" | sh "$here/count.sh" "$board" "$out/count" >"$out/counted"
    awk -F, -v board="$board" '
        function near(a, b, part) { return a == b || (a - b <= part * b && b - a <= part * b) }
        FNR == NR { if (FNR > 1) { counted[$10] = $3 "," $4 "," $6 "," $7 } next }
        $2 != board { next }
        {
            split(counted[$12], now, ",")
            n++
            if (!near(now[1], $8, 0.001) || !near(now[2], $9, $9 > 0 ? 0.03 + 4 / $9 : 0) || !near(now[3], $10, 0.001) || !near(now[4], $11, 0.001)) {
                bad++
                print board ": " $12 ": " $8 " instructions, " $9 " cycles, " $10 ", " $11 " B; again " counted[$12]
            }
        }
        END { print board ": " n " steps counted again, " n - bad " of them agree"; exit bad > 0 }' "$out/counted" "$out/rows" || bad=1
done
[ "$bad" -eq 0 ]
