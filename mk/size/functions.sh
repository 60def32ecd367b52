#!/bin/sh
# functions.sh: bytes of flash of the core's own functions, each with all that it calls, and of all together.
#
#   CC=arm-none-eabi-gcc CPU="-mcpu=cortex-m4 ..." SIZE=arm-none-eabi-size functions.sh libwhirl.a
#
# Each is linked alone, from the library that firmware is linked from.
set -eu

library=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

bytes_of() { # bytes_of FUNCTION...: code and constants of an image of these
    wanted=
    for function in "$@"; do
        wanted="$wanted -Wl,-u,$function"
    done
    # shellcheck disable=SC2086 # lists of words
    $CC $CPU -nostdlib -Wl,--gc-sections -Wl,-e,"$1" $wanted -o "$work/image" \
        "$library" -lgcc
    "$SIZE" "$work/image" | awk 'NR == 2 { print $1 + $2 }'
}

# All that core/function.h lists.
all=$(printf '#include "core/function.h"\n#define NAME(name) wh_##name\nWH_FUNCTIONS(NAME, NAME)\n' |
    $CC -ffreestanding -E -P -I. -x c - | tail -n 1)
printf '%-28s %8s\n' "function" "flash B"
for function in $all; do
    printf '%-28s %8d\n' "$function" "$(bytes_of "$function")"
done
# shellcheck disable=SC2086 # a list of words
printf '%-28s %8d\n' "all of them" "$(bytes_of $all)"
