#!/bin/sh
# count_run.sh CASES ROW.csv: counts every step of a scene's run on a board, and computes the bound on a step.
# measure_one.sh --whole-run calls it with the settings TO_PRICE of mk/price.mk and these:
#
#   OUT         working folder
#   NUMBER      float or double; LIB_DOUBLE is the core's library in double
#   RUN_EVERY   number of intervals that the counter reports as one. Default: 100
#   WORST       number of random steps (boards/programs/worst.c) whose stretches give the bound. Default: 2000
#
# CASES has one line "ID TARGET OPTIONS OF whirl derive...". Writes a header and a row:
#
#   board,number,steps,instructions,instructions_most,instructions_bound,cycles,cycles_most,cycles_bound,cycles_obtained,
#   flash_bytes,ram_bytes,stack_bytes
#
# The mean and the largest number are those of all steps from the start to --until. The bound is that of
# docs/dev/events.md: the longest stretch to a step's first evaluation, after an evaluation of the accelerations and after
# one of the signals, each times the declared number of such evaluations in a step. Stretches come from WORST random
# steps, with marks in a build of their own. There is no bound if the emulator knows no marks (AVR). Bytes are as in
# measure.sh. Exit status 1, with a message: the scene cannot be derived, does not fit or does not run.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"
: "${RUN_EVERY:=100}" "${WORST:=2000}"
NM=${BOARD_NM:-nm}
cases=$1
csv=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mine=$OUT/$BOARD/$NUMBER
rm -rf "$mine"
mkdir -p "$mine"

fail() {
    echo "count_run.sh: $*" >&2
    exit 1
}

set -f # so that no word is taken for a pattern
set -- $(head -n 1 "$cases")
set +f
id=$1 target=$2
shift 2
gen=$mine/$id
"$WHIRL" derive "$target" --as c --name "$id" --header "$gen.h" "$@" >"$gen.c" 2>"$work/errors" ||
    fail "$target $*: it cannot be derived so: $(head -n 1 "$work/errors")"
lib=$LIB_BOARD
if [ "$NUMBER" = double ]; then
    BOARD_CFLAGS="$BOARD_CFLAGS -DWH_DOUBLE=1"
    lib=$LIB_DOUBLE
fi
"$here/../count/index.sh" "$id" >"$mine/scenes.c"
memory="-I$mine -include $gen.h -DWH_SCENE_WORDS=${id}_MEMORY_WORDS"

# compile FILE OBJECT FLAG...
compile() {
    from=$1 to=$2
    shift 2
    $BOARD_CC $BOARD_CFLAGS -w "$@" -c "$from" -o "$to" 2>"$work/errors" ||
        fail "$target: $BOARD's compiler refuses it: $(grep -m 1 error "$work/errors")"
}

# link ELF OBJECT...
link() {
    to=$1
    shift
    $BOARD_CC $BOARD_LDFLAGS -o "$to" "$@" $BOARD_OBJECTS "$lib" "$LIB_BOARD" $BOARD_LDLIBS 2>"$work/errors" ||
        fail "$target: it does not fit into $BOARD: $(head -n 1 "$work/errors")"
}

# emulated ELF: prints the emulator's command, with a longer time limit than usual
emulated() { echo "$EMULATE" | sed "s|@|$1|; s|limit.sh [0-9]*|limit.sh 120|"; }

compile "$gen.c" "$mine/plain.o"
compile boards/programs/size.c "$mine/size.o" -include "$gen.h" "-DPRICE_SCENE=$id"
link "$mine/size.elf" "$mine/size.o" "$mine/plain.o"
bytes_of "$BOARD_SIZE" "$mine/size.elf" >"$work/bytes"

{
    compile boards/programs/whole_run.c "$mine/whole_run.o" $memory "-DRUN_EVERY=${RUN_EVERY}U"
    compile "$mine/scenes.c" "$mine/scenes.o" $memory
}
elf=$mine/whole_run.elf
link "$elf" "$mine/whole_run.o" "$mine/scenes.o" "$mine/plain.o"
whole=$(emulated "$elf")
if [ -n "${PLUGIN:-}" ]; then
    EMULATE_WAS=$EMULATE
    EMULATE=$whole
    (count ",every=$RUN_EVERY") >/dev/null 2>&1 || true
    EMULATE=$EMULATE_WAS
else
    sh -c "$whole counts=$work/counts every=$RUN_EVERY" >"$work/console" 2>/dev/null || true
fi
grep -q "^run " "$work/console" 2>/dev/null ||
    fail "$target $*: its run does not come to an end on $BOARD: $(grep -m 1 '^failed' "$work/console" 2>/dev/null || echo 'it takes too long')"
mv "$work/counts" "$work/run"
mv "$work/console" "$work/said"

# The stretches, from code with marks.
: >"$work/counts"
if [ -n "${PLUGIN:-}" ]; then
    {
        compile "$gen.c" "$mine/marked.o" -include boards/programs/mark.h
        compile boards/programs/worst.c "$mine/worst.o" $memory "-DWORST_STEPS=${WORST}U"
    }
    elf=$mine/worst.elf
    link "$elf" "$mine/worst.o" "$mine/scenes.o" "$mine/marked.o"
    "$BOARD_OBJCOPY" --dump-section .wh_marks="$work/section" "$elf" "$work/copy"
    od -A n -v -t u4 -w8 "$work/section" | awk '{ printf "%.0f %d\n", $1 - $1 % 2, $2 }' >"$work/marks"
    EMULATE=$(emulated "$elf")
    (count ",every=$WORST,marks=$work/marks") >/dev/null 2>&1 || true
    mv "$work/console" "$work/declared"
else
    : >"$work/declared"
fi

obtained=
[ -z "${TIMING:-}" ] || obtained=estimated
[ -n "${PLUGIN:-}" ] || obtained=simulated
[ -s "$csv" ] || echo "board,number,steps,instructions,instructions_most,instructions_bound,cycles,cycles_most,cycles_bound,cycles_obtained,flash_bytes,ram_bytes,stack_bytes" >"$csv"
awk -v head="$BOARD,$NUMBER" -v obtained="$obtained" '
    { sub(/\r$/, "") }
    FILENAME ~ /bytes$/ { bytes = $1 "," $2; next }
    $1 == "stack" { stack = $3 }
    $1 == "run" { steps = $3 }
    $1 == "declared" { evaluations = $3; signals = $4 }
    FILENAME ~ /run$/ && $1 == "interval" { if ($2 == 0) { around = $3 } else if ($3 > most) { most = $3 } }
    FILENAME ~ /run$/ && $1 == "cycles" { if ($2 == 0) { around_c = $3 } else if ($3 > most_c) { most_c = $3 } }
    FILENAME ~ /run$/ && $1 == "sums" && $2 > 0 { members += $3; sum += $4; sum_c += $5 }
    FILENAME ~ /counts$/ && $1 == "stretches" && $2 == 1 { longest[$3] = $4; longest_c[$3] = $6 }
    END {
        if (members != steps || steps == 0) { exit 1 }
        bound = longest[0] + evaluations * longest[1] + signals * longest[2]
        bound_c = longest_c[0] + evaluations * longest_c[1] + signals * longest_c[2]
        if (evaluations == "" || bound < most - around) { bound = bound_c = "" } # then there is no bound
        printf "%s,%d,%.6f,%d,%s,", head, steps, sum / steps - around, most - around, bound
        if (obtained != "") { printf "%.6f,%d,%s,", sum_c / steps - around_c, most_c - around_c, bound_c }
        else { printf ",,," }
        printf "%s,%s,%s\n", obtained, bytes, stack
    }' "$work/bytes" "$work/said" "$work/run" "$work/declared" "$work/counts" >"$work/row" ||
    fail "$target $*: the counter did not see all steps"
cat "$work/row" >>"$csv"
