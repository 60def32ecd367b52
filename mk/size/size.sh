#!/bin/sh
# size.sh: flash, memory and worst stack of a board's images.
#
#   BOARD=mps2-an386 CC=arm-none-eabi-gcc FLAGS="-O2" SIZE=arm-none-eabi-size \
#   NM=arm-none-eabi-nm OBJECTS=build/mps2-an386 size.sh figures.csv ELF...
#
# Appends rows to figures.csv (with a header if it is new; columns as for instruction counts, the
# program in place of the scene) and prints a table.
#   flash     code, constants and initial values
#   ram       variables, without the stack
#   computed  worst stack from the call graph: the folders OBJECTS hold the objects with gcc's .ci files, and
#             the linker's map beside the image (.map for .elf) says which of them are in it; of an image that is optimised
#             as a whole they are beside it
#   handlers  the deepest interrupt handler (on_NAME), where the image has some: all have one priority
# Fails on recursion, on a frame of unbounded size, and if the stack's room is too small for the
# computed worst case, a handler and what the processor stacks for it and for a fault included. And where FLASH_MOST and RAM_MOST
# are given, on more flash, or more memory (variables and that worst case), of the images MOST_OF.
set -eu
here=$(dirname "$0")
. "$here/../count/common.sh"

figures_into "$1"
shift

# graphs: the .ci files of the objects in the image, from its map: objects by their path, members of
# archives by their name.
graphs() {
    map=${elf%.elf}.map
    sed -n 's/^LOAD \(.*\)\.o$/\1.ci/p' "$map" >"$work/loaded"
    sed -n 's/^[^ ].*\.a(\([^()]*\)\.o)$/\/\1.ci/p; s/^[^ ].*\.a(\([^()]*\)\.o) .*/\/\1.ci/p' "$map" |
        sort -u >"$work/members"
    if grep -q '^LOAD .*ltrans\.o$' "$map"; then
        ls "$elf".ltrans*.ci
        : >"$work/members"
    fi
    # shellcheck disable=SC2086 # folders
    find $OBJECTS -name '*.ci' | sort | awk -v loaded="$work/loaded" -v members="$work/members" '
        BEGIN {
            while ((getline line <loaded) > 0) { whole[line] = 1 }
            while ((getline line <members) > 0) { member[line] = 1 }
        }
        {
            name = $0
            sub(/^.*\//, "/", name)
            if ($0 in whole || name in member) { print }
        }'
}

# worst_stack ROOT: answers of stack.awk, to $work/stack.
worst_stack() {
    { sed 's/^/symbol /' "$work/symbols" && sed '/^#/d; s/^/pointer /' "$here/pointers.rows" && xargs cat <"$work/graphs"; } |
        awk -v root="$1" -f "$here/stack.awk" | sort -u >"$work/stack"
    if grep -E '^(recursion|unbounded)' "$work/stack" >&2; then
        echo "size.sh: $elf: the stack of $1 has no bound" >&2
        touch "$work/failed"
    fi
    sed -n 's/^stack //p' "$work/stack"
}

# at_most WHAT BYTES MOST: says how far below it is; or complains.
at_most() {
    if [ "$2" -gt "$3" ]; then
        echo "size.sh: $elf: $2 $1, $(($2 - $3)) more than the $3 that it may have" >&2
        touch "$work/failed"
    else
        echo "             $2 $1, of at most $3"
    fi
}

printf '%-12s %-12s %8s %8s %9s %9s %11s\n' board program flash ram "stack of" computed "fault stack"
for elf in "$@"; do
    name=$(basename "$elf" .elf)
    "$NM" "$elf" | awk 'NF == 3 && $2 ~ /[tTwW]/ { print $3, $1 }' >"$work/symbols"
    "$SIZE" -A "$elf" >"$work/sections"
    bytes_of() {
        awk -v want="$1" 'index(" " want " ", " " $1 " ") { sum += $2 } END { print sum + 0 }' \
            "$work/sections"
    }
    flash=$(bytes_of ".vectors .text .ARM.exidx .data")
    ram=$(bytes_of ".data .bss .noinit")
    room=$("$NM" -t d "$elf" | awk '
        $3 == "board_stack_limit" { low = $1 } $3 == "board_stack_top" { top = $1 }
        END { print top - low }')
    graphs >"$work/graphs"
    if ! [ -s "$work/graphs" ]; then
        echo "size.sh: no call graphs of $elf in $OBJECTS; from a compiler's cache objects come without: CCACHE_DISABLE=1, and anew" >&2
        exit 1
    fi
    computed=$(worst_stack board_reset)
    path=$(sed -n 's/^path //p' "$work/stack")
    unknown=$(sed -n 's/^unknown //p' "$work/stack" | tr '\n' ' ')
    fault=$(worst_stack board_fault_report)
    printf '%-12s %-12s %8d %8d %9d %9d %11d\n' "$BOARD" "$name" "$flash" "$ram" "$room" \
        "$computed" "$fault"
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
        case " $unknown " in
        *" main "*)
            echo "size.sh: $elf: no call graph of main(): it is not known how much stack that takes" >&2
            touch "$work/failed"
            ;;
        esac
        at_most "bytes of flash" "$flash" "$FLASH_MOST"
        at_most "bytes of memory, the worst stack included" $((ram + computed)) "$RAM_MOST"
        ;;
    esac
    if [ "$computed" -gt "$room" ]; then
        echo "size.sh: $elf: the stack needs $computed bytes and has $room" >&2
        touch "$work/failed"
    fi
done
[ ! -e "$work/failed" ]
