#!/bin/sh
# measure_one.sh [--whole-run] BOARD NUMBER FILE[:SCENE] [OPTIONS OF whirl derive...]: what a step of one scene costs, counted.
#
# Call it from the tree's root. BOARD is a folder of boards/, or `host`; NUMBER is float, double or fixed. Builds the missing
# parts of the board's core, and prints the header and one row of host/study/cost.h (COST_HEADER). Exit status 2: wrong
# arguments, or a tool is missing; 1: the scene cannot be derived, does not fit or does not run.
#
# --whole-run, for a scene with contacts: counts all steps to its end (--until), and prints the output of count_run.sh.
set -eu
way=price-measure
if [ "${1:-}" = --whole-run ]; then
    way=price-count-run
    shift
fi
if [ $# -lt 3 ]; then
    sed -n '2s/^# //p' "$0" >&2
    exit 2
fi
board=$1 number=$2
shift 2
case $number in
float | double) ;;
fixed)
    [ "$board" != host ] || { echo "measure_one.sh: error: number fixed is counted on boards, not on host" >&2 && exit 2; }
    ;;
*) echo "measure_one.sh: error: number $number: float, double or fixed" >&2 && exit 2 ;;
esac
if [ "$board" != host ] && [ ! -f "boards/$board/board.mk" ]; then
    echo "measure_one.sh: error: there is no boards/$board (from the tree's root?)" >&2
    exit 2
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# A case is words between blanks: a file with blanks in its name gets another name; values need none ("k=20[N/m]").
case $1 in
*[[:blank:]]*)
    case $1 in
    *.whirl:*) cp "${1%:*}" "$work/scene.whirl" && target=$work/scene.whirl:${1##*:} ;;
    *) cp "$1" "$work/scene.whirl" && target=$work/scene.whirl ;;
    esac || exit 1
    shift
    set -- "$target" "$@"
    ;;
esac
for word in "$@"; do
    printf ' %s' "$(printf '%s' "$word" | tr -d '[:blank:]')"
done | sed 's/^/one/; s/$/\n/' >"$work/case"
if [ "$way" = price-count-run ] && [ "$board$number" != "${board#host}${number#fixed}" ]; then
    echo "measure_one.sh: error: whole runs are counted on boards, in float and double" >&2
    exit 2
fi
if ! make -s $([ "$board" = host ] || echo "BOARD=$board") "$way-$([ "$board" = host ] && echo host || echo board)" \
    PRICE_CASES="$work/case" PRICE_CSV="$work/rows" PRICE_OUT="$work/out" NUMBERS="$number" >"$work/log" 2>&1; then
    grep -vE '^make|Error [0-9]|^  [A-Z]+ ' "$work/log" | head -n 20 >&2
    grep -qE 'is missing' "$work/log" && exit 2
    exit 1
fi
cat "$work/rows"
