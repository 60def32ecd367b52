#!/bin/sh
# size.sh: flash, memory and worst stack of a board's images.
#
#   BOARD=mps2-an386 CC=arm-none-eabi-gcc FLAGS="-O2" SIZE=arm-none-eabi-size \
#   NM=arm-none-eabi-nm OBJECTS=build/mps2-an386 size.sh figures.csv ELF...
#
# Appends rows to figures.csv (with a header if it is new; columns as for instruction counts, with the program in place
# of the scene) and prints a table.
#   flash     code, constants and initial values
#   ram       variables, without the stack
#   computed  worst stack by the call graph, from gcc's .ci files. They are in the folders OBJECTS, and the linker's map
#             beside the image (.map for .elf) names the image's objects. For an image that is optimised as a whole, they
#             are beside it
#   handlers  stack of the deepest interrupt handler (on_NAME), if there is one: all have one priority
# Fails on recursion, on a frame of unbounded size, and if the stack's room is too small. It must hold the computed
# worst case, a handler, and what the processor stacks for the handler and for a fault. Images MOST_OF must have at most
# FLASH_MOST and RAM_MOST (variables and this stack), if these are set.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"

figures_into "$1"
shift
failed() { echo "size.sh: $elf: $1" >&2; touch "$work/failed"; }

# of_image FILE...: prints those whose object is in the image. Members of archives go by their name.
of_image() {
    awk -v map="${elf%.elf}.map" '
        BEGIN {
            while ((getline line <map) > 0) {
                if (line ~ /^LOAD .*\.o$/) { sub(/^LOAD /, "", line); whole[line] }
                else if (line ~ /^[^ ].*\.a\([^()]*\.o\)/) { sub(/^.*\.a\(/, "/", line); sub(/\).*/, "", line); member[line] }
                if (line ~ /ltrans\.o$/) as_a_whole = 1
            }
        }
        {
            object = name = $0
            sub(/\.ci$/, ".o", object)
            sub(/^.*\//, "/", name)
            sub(/\.ci$/, ".o", name)
            if (object in whole || (name in member && !as_a_whole)) print
        }'
}
# graphs: the .ci files of the image's objects. Objects from a compiler's cache have none; these are compiled again.
graphs() {
    find $OBJECTS -name '*.o' | of_image | while read -r object; do [ -e "${object%.o}.ci" ] || echo "$object"; done >"$work/without"
    if grep -q '^LOAD .*ltrans\.o$' "${elf%.elf}.map"; then
        ls "$elf".ltrans*.ci
    elif [ -s "$work/without" ]; then
        xargs rm -f <"$work/without"
        CCACHE_DISABLE=1 xargs make -j "$(nproc)" "BOARD=$BOARD" <"$work/without" >&2
    fi
    find $OBJECTS -name '*.ci' | sort | of_image
}
# worst_stack ROOT: writes the output of stack.awk to $work/stack.
worst_stack() {
    { sed 's/^/symbol /' "$work/symbols" && sed '/^#/d; s/^/pointer /' "$here/pointers.rows" && xargs cat <"$work/graphs"; } |
        awk -v root="$1" -f "$here/stack.awk" | sort -u >"$work/stack"
    ! grep -E '^(recursion|unbounded)' "$work/stack" >&2 || failed "the stack of $1 has no bound"
    sed -n 's/^stack //p' "$work/stack"
}
# at_most WHAT BYTES MOST: prints the distance from the limit, or an error.
at_most() {
    if [ "$2" -gt "$3" ]; then
        failed "$2 $1, $(($2 - $3)) more than the $3 that it may have"
    else
        echo "             $2 $1, of at most $3"
    fi
}
bytes_of() { awk -v want="$1" 'index(" " want " ", " " $1 " ") { sum += $2 } END { print sum + 0 }' "$work/sections"; }

printf '%-12s %-12s %8s %8s %9s %9s %11s\n' board program flash ram "stack of" computed "fault stack"
for elf in "$@"; do
    name=$(basename "$elf" .elf)
    "$NM" "$elf" | awk 'NF == 3 && $2 ~ /[tTwW]/ { print $3, $1 }' >"$work/symbols"
    "$SIZE" -A "$elf" >"$work/sections"
    flash=$(bytes_of ".vectors .text .ARM.exidx .data")
    ram=$(bytes_of ".data .bss .noinit")
    room=$("$NM" -t d "$elf" | awk '
        $3 == "board_stack_limit" { low = $1 } $3 == "board_stack_top" { top = $1 } END { print top - low }')
    graphs >"$work/graphs"
    [ -s "$work/graphs" ] || { failed "no call graphs in $OBJECTS"; exit 1; }
    computed=$(worst_stack board_reset)
    path=$(sed -n 's/^path //p' "$work/stack")
    unknown=$(sed -n 's/^unknown //p' "$work/stack" | tr '\n' ' ')
    printf '%-12s %-12s %8d %8d %9d %9d %11d\n' "$BOARD" "$name" "$flash" "$ram" "$room" \
        "$computed" "$(worst_stack board_fault_report)"
    echo "             deepest: $path"
    [ -z "$unknown" ] || echo "             without a figure: $unknown"
    row "flash bytes" "$flash"
    row "ram bytes (without stack)" "$ram"
    row "stack bytes (computed)" "$computed"
    handlers=0
    for handler in $("$NM" "$elf" | awk '$2 ~ /[tT]/ && $3 ~ /^on_/ { print $3 }'); do
        deep=$(worst_stack "$handler")
        [ "$deep" -le "$handlers" ] || handlers=$deep
    done
    if [ "$handlers" -gt 0 ]; then
        stacked=112 # 26 words with the FPU's registers, and the alignment (Armv7-M Architecture Reference Manual, B1.5.7)
        computed=$((computed + handlers + 2 * stacked))
        echo "             with the deepest interrupt, $handlers, and a fault in it: $computed"
    fi
    case " ${MOST_OF:-} " in
    *" $elf "*)
        case " $unknown " in *" main "*) failed "no call graph of main(): it is not known how much stack that takes" ;; esac
        at_most "bytes of flash" "$flash" "$FLASH_MOST"
        at_most "bytes of memory, the worst stack included" $((ram + computed)) "$RAM_MOST"
        ;;
    esac
    [ "$computed" -le "$room" ] || failed "the stack needs $computed bytes and has $room"
done
[ ! -e "$work/failed" ]
