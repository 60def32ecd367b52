#!/bin/sh
# size.sh: flash, RAM and worst stack of images of an AVR. Their compiler writes no call graphs, so the stack comes from
# their code.
#
#     BOARD=atmega2560 CC=avr-gcc FLAGS="-Os" SIZE=avr-size NM=avr-nm OBJDUMP=avr-objdump FLASH_MOST=262144 MEMORY_TOP=0x802200 \
#     size.sh figures.csv ELF...
#
# Appends rows to figures.csv and prints a table, as mk/size/size.sh does. `computed` is the deepest path from the start,
# plus an interrupt on it (interrupts do not nest) with its return address of three bytes. Fails on recursion, on too much
# flash, and if the RAM between the variables and MEMORY_TOP is too small for the stack.
set -eu
here=$(dirname "$0")
root=$here/../..
. "$root/mk/count/common.sh"

figures_into "$1"
shift
status=0

# worst_stack ROOT: writes the answers of code_stack.awk to $work/stack.
worst_stack() {
    { sed '/^#/d; s/^/pointer /' "$root/mk/size/pointers.rows" && cat "$work/code"; } |
        awk -v root="$1" -v address=3 -f "$here/code_stack.awk" >"$work/stack" || status=1
    grep '^recursion' "$work/stack" >&2 || true
    sed -n 's/^stack //p' "$work/stack"
}

printf '%-12s %-12s %8s %8s %9s %9s %11s\n' board program flash ram "stack of" computed interrupts
for elf in "$@"; do
    name=$(basename "$elf" .elf)
    "$OBJDUMP" -d "$elf" >"$work/code"
    "$SIZE" -A "$elf" >"$work/sections"
    bytes_of() {
        awk -v want="$1" 'index(" " want " ", " " $1 " ") { sum += $2 } END { print sum + 0 }' "$work/sections"
    }
    flash=$(bytes_of ".text .data")
    ram=$(bytes_of ".data .bss .noinit")
    end=$("$NM" "$elf" | awk '$3 == "_end" { print $1 }')
    room=$((MEMORY_TOP - 0x$end))
    interrupts=0
    for handler in $("$NM" "$elf" | awk '$2 == "T" && $3 ~ /^__vector_[0-9]+$/ { print $3 }'); do
        deep=$(worst_stack "$handler")
        [ "$deep" -le "$interrupts" ] || interrupts=$deep
    done
    computed=$(($(worst_stack board_run) + interrupts + 3))
    printf '%-12s %-12s %8d %8d %9d %9d %11d\n' "$BOARD" "$name" "$flash" "$ram" "$room" "$computed" "$interrupts"
    sed -n 's/^path /             deepest: /p' "$work/stack"
    row "flash bytes" "$flash"
    row "ram bytes (without stack)" "$ram"
    row "stack bytes (computed)" "$computed"
    if [ "$flash" -gt "$FLASH_MOST" ] || [ "$computed" -gt "$room" ]; then
        echo "code.sh: $elf: $flash bytes of flash, of $FLASH_MOST; the stack needs $computed and has $room" >&2
        status=1
    fi
done
exit "$status"
