#!/bin/sh
# measure.sh CASES ROWS.csv: counts the cost of a step of each case on a board. `make price-rows` and measure_one.sh
# call it with the settings TO_PRICE of mk/price.mk (BOARD, its compiler, flags, objects and emulator), and
#
#   OUT      working folder; generated C is kept there for the next board
#   NUMBERS  some of "float", "double", "fixed"; LIB_BOARD is the core's library in float, LIB_DOUBLE in double.
#            Default: float
#   STEPS    counted steps of each. Default: 50
#
# CASES has lines "ID TARGET OPTIONS OF whirl derive...", where ID is a C identifier. Appends a row to ROWS.csv for each
# case that runs, and a header if the file is new:
#
#   commit,compiler,flags,board,scene,number,setting,instructions,instructions_most,cycles,cycles_most,
#   cycles_obtained,flash_bytes,ram_bytes,stack_bytes
#
# Instructions and cycles are those of a step: the mean and the maximum of STEPS steps after the first twenty. Flash and
# RAM are those of the smallest firmware with the scene (boards/programs/size.c). The stack is what the steps used of
# it. A case that cannot be derived, has contacts, does not fit or does not run is reported on standard error and
# omitted; then the exit status is 1.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"
: "${NUMBERS:=float}" "${STEPS:=50}"
NM=${BOARD_NM:-nm}
export OUT BOARD BOARD_CC BOARD_CFLAGS BOARD_LDFLAGS BOARD_LDLIBS BOARD_OBJECTS LIB_BOARD LIB_DOUBLE BOARD_SIZE WHIRL

COST_HEADER="commit,compiler,flags,board,scene,number,setting,instructions,instructions_most,cycles,cycles_most,"
COST_HEADER="${COST_HEADER}cycles_obtained,flash_bytes,ram_bytes,stack_bytes"

# --- one case: derive it, compile it, link the smallest firmware (run by xargs, several at a time) ---------------
if [ "$1" = case ]; then
    set -f # so that no word is taken for a pattern: m=2[kg]
    set -- $2
    set +f
    id=$1 number=$2 target=$3
    shift 3
    gen=$OUT/gen/$id
    mine=$OUT/$BOARD/$number/$id
    if [ "$number" = fixed ]; then
        gen=$OUT/gen_fixed/$id
        set -- --number fixed "$@"
    fi
    if [ ! -s "$gen.h" ]; then
        "$WHIRL" derive "$target" --as c --name "$id" --header "$gen.h" "$@" >"$gen.c" 2>"$gen.errors" || {
            rm -f "$gen.h"
            echo "measure.sh: $target $*: it cannot be derived so: $(head -n 1 "$gen.errors")" >&2
            exit 0
        }
    fi
    if grep -q "_CONTACTS = [1-9]" "$gen.h"; then
        echo "measure.sh: $target $*: steps with contacts are counted over a whole run: measure_one.sh --whole-run" >&2
        exit 0
    fi
    lib=$LIB_BOARD
    [ "$number" != double ] || BOARD_CFLAGS="$BOARD_CFLAGS -DWH_DOUBLE=1" lib=$LIB_DOUBLE
    smallest="-DPRICE_SCENE=$id boards/programs/size.c"
    [ "$number" != fixed ] || smallest="-DFIXED_SCENE=$id boards/programs/size.c"
    if ! $BOARD_CC $BOARD_CFLAGS -w -c "$gen.c" -o "$mine.o" 2>"$mine.errors"; then # for example, a table is too large
        echo "measure.sh: $target $*: $BOARD's compiler refuses it: $(grep -m 1 error "$mine.errors")" >&2
        rm -f "$mine.o"
        exit 0
    fi
    {
        $BOARD_CC $BOARD_CFLAGS -w -include "$gen.h" -c $smallest -o "$mine.image.o"
        if $BOARD_CC $BOARD_LDFLAGS -o "$mine.elf" "$mine.image.o" "$mine.o" $BOARD_OBJECTS "$lib" "$LIB_BOARD" $BOARD_LDLIBS \
            2>"$mine.errors"; then
            echo "$id $(bytes_of "$BOARD_SIZE" "$mine.elf")" >"$mine.bytes"
        else
            echo "measure.sh: $target $*: its firmware does not fit into $BOARD: $(head -n 1 "$mine.errors")" >&2
            rm -f "$mine.o"
        fi
    }
    rm -f "$mine.elf" "$mine.image.o"
    exit 0
fi

cases=$1
csv=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$OUT/gen" "$OUT/gen_fixed"

# bench ID...: builds one image of these cases; appends its counts to $work/counted: ID MEAN MOST CYCLES MOST STACK
bench() {
    elf=$mine/bench.elf
    one=
    case ${PLUGIN:-}$BOARD in
    *host) ;;
    $BOARD) one="-include $OUT/gen/$1.h -DWH_SCENE_WORDS=$1_MEMORY_WORDS -DBENCH_SMALL=1" ;;
    esac
    program=bench
    "$here/../count/index.sh" "$@" >"$mine/scenes.c"
    if [ "$number" = fixed ]; then
        program=fixed
        one="-include $OUT/gen_fixed/$1.h -DFIXED_SCENE=$1"
        echo "typedef int none;" >"$mine/scenes.c"
    fi
    objects=
    for id in "$@"; do objects="$objects $mine/$id.o"; done
    for file in boards/programs/$program.c "$mine/scenes.c"; do
        $BOARD_CC $flags -w "-I$OUT/gen" "-DCOUNTED_STEPS=${STEPS}U" $one -c "$file" -o "$mine/$(basename "$file" .c)_.o"
    done
    if ! $BOARD_CC $BOARD_LDFLAGS -o "$elf" "$mine/${program}_.o" "$mine/scenes_.o" $objects $BOARD_OBJECTS "$lib" "$LIB_BOARD" $BOARD_LDLIBS 2>"$mine/errors"; then
        echo "measure.sh: $*: the program that counts does not fit into $BOARD: $(head -n 1 "$mine/errors")" >&2
        return 0
    fi
    EMULATE=$(echo "$emulate" | sed "s|@|$elf|")
    rm -f "$work/console" "$work/counts"
    if [ "$BOARD" = host ]; then
        callgrind "$elf" || return 0
    elif [ -n "${PLUGIN:-}" ]; then
        (count "") 2>"$work/said" || { grep -q '^interval' "$work/counts" 2>/dev/null || cat "$work/said" >&2; }
    else
        sh -c "$EMULATE counts=$work/counts" >"$work/console" 2>"$work/said" || true
    fi
    awk '
        { sub(/\r$/, "") }
        $1 == "interval" { counted[$2] = $3 }
        $1 == "cycles" { cycles[$2] = $3; timed = 1 }
        $1 == "stack" { stack[$2] = $3 }
        $1 == "failed" { print "measure.sh: " $2 ": " $3 " " $4 " " $5 > "/dev/stderr" }
        $1 == "count" && $3 != "-" {
            sum = most = sum_c = most_c = n = 0
            for (i = $5; i <= $6; i++) {
                if (!(i in counted)) { next }
                now = counted[i] - counted[0]
                sum += now
                most = now > most ? now : most
                now = timed ? cycles[i] - cycles[0] : 0
                sum_c += now
                most_c = now > most_c ? now : most_c
                n++
            }
            if (n > 0) {
                print $2, sum / n, most, (timed ? sum_c / n : ""), (timed ? most_c : ""), (stack[$2] ? stack[$2] : "")
            }
        }' OFS=, "$work/counts" "$work/console" >>"$work/counted" || true
}

[ -s "$csv" ] || echo "$COST_HEADER" >"$csv"
emulate=$EMULATE
wanted=0
told=0
for number in $NUMBERS; do
    mine=$OUT/$BOARD/$number
    lib=$LIB_BOARD
    flags=$BOARD_CFLAGS
    rm -rf "$mine"
    mkdir -p "$mine"
    if [ "$number" = double ]; then
        lib=$LIB_DOUBLE
        flags="$flags -DWH_DOUBLE=1"
    fi
    awk -v number="$number" 'NF > 1 { id = $1; $1 = ""; printf "%s %s%s%c", id, number, $0, 0 }' "$cases" |
        xargs -0 -n 1 -P 2 sh "$0" case
    : >"$work/counted"
    ids=$(awk 'NF > 1 { print $1 }' "$cases" | while read -r id; do [ ! -s "$mine/$id.bytes" ] || [ ! -s "$mine/$id.o" ] || echo "$id"; done)
    each=60
    [ -n "${PLUGIN:-}" ] || [ "$BOARD" = host ] || each=1
    [ "$number" != fixed ] || each=1
    echo "$ids" | xargs -n "$each" >"$work/groups"
    while read -r group; do
        [ -z "$group" ] || bench $group </dev/null
    done <"$work/groups"
    obtained=
    [ -z "${TIMING:-}" ] || obtained=estimated
    [ -n "${PLUGIN:-}" ] || [ "$BOARD" = host ] || obtained=simulated
    cat "$mine"/*.bytes >"$work/bytes" 2>/dev/null || : >"$work/bytes"
    awk -v head="$(commit_of_checkout),$(compiler_of "$BOARD_CC"),\"$FLAGS\",$BOARD" -v number="$number" \
        -v obtained="$obtained" -v board="$BOARD" '
        FILENAME ~ /bytes$/ { bytes[$1] = board == "host" ? "," : $2 "," $3; next }
        FILENAME ~ /counted$/ {
            split($0, f, ",")
            found[f[1]] = f[2] "," f[3] "," f[4] "," f[5]; stack[f[1]] = board == "host" ? "" : f[6]; next }
        ($1 in found) && ($1 in bytes) {
            setting = $3
            for (i = 4; i <= NF; i++) { setting = setting " " $i }
            print head "," $2 "," number ",\"" setting "\"," found[$1] "," (board == "host" ? "" : obtained) "," bytes[$1] "," stack[$1]
        }' "$work/bytes" "$work/counted" "$cases" >"$work/rows"
    cat "$work/rows" >>"$csv"
    wanted=$((wanted + $(awk 'NF > 1' "$cases" | wc -l)))
    told=$((told + $(wc -l <"$work/rows")))
done
echo "measure.sh: $BOARD: $told of $wanted cases counted" >&2
[ "$told" -eq "$wanted" ]
