#!/bin/sh
# avr.sh WHIRL FOLDER: tests the core on an ATmega2560 in simavr. The core is built in FOLDER, in strict and GNU C and used
# from strict and GNU C++, and must give no warning. The sine's table must be in flash, with or without the newer
# instruction that reads flash. The results must have the same bits as on this machine. Prints errors.
set -u

whirl=$1
folder=$2
bad=0
rm -rf "$folder"
mkdir -p "$folder"

wrong() {
    echo "error: $1"
    shift
    [ $# -eq 0 ] || head -n 5 "$@" | sed 's/^/    /'
    bad=1
}

# gcc 5 reports an array that is filled up to a count as uninitialized
flags="-mmcu=atmega2560 -Os -ffp-contract=off -I. -I$folder -Wall -Wextra -pedantic -Werror -Wno-maybe-uninitialized"

# The sine's hash on this machine.
cat >"$folder/pc.c" <<'END'
#include <stdio.h>

#include "core/angle.h"
#include "core/hash.h"

int main(void) {
    uint64_t hash = WH_HASH_START;
    for (uint32_t i = 0; i < 1000; i++) {
        wh_real sine;
        wh_real cosine;
        wh_sincos(i * UINT32_C(4294967), &sine, &cosine);
        hash = wh_hash_real(wh_hash_real(hash, sine), cosine);
    }
    printf("%016llx\n", (unsigned long long)hash);
    return 0;
}
END
${CC:-cc} -std=c11 -ffp-contract=off -I. -o "$folder/pc" "$folder/pc.c" core/angle.c || exit 1
sines=$("$folder/pc")

# Scenes: sines of phases; an angle in radians; contacts; books and compensated sums.
compared=0
while read -r scene until options; do
    "$whirl" derive "$scene" --as c --until "$until" $options --name tested --header "$folder/generated.h" \
        >"$folder/generated.c" || exit 1
    run=$("$whirl" run "$scene" --until "$until" $options --number float | sed -n 's/^state hash *0x//p')
    # the other dialects are tested with the first scene only
    others="c11 gnu++11,gnu11 c++11,gnu11 gnu++11,c11 c++11 -U__AVR_HAVE_LPMX__,"
    [ $compared -eq 0 ] || others=
    echo "${others}c11 c++11" | tr ',' '\n' >"$folder/dialects"
    while read -r dialect; do
        set -- $dialect
        what="$scene, -std=$1, from -std=$2 ${3:-}"
        objects=""
        for file in core/scene.c core/angle.c core/text.c core/noise.c "$folder/generated.c"; do
            object=$folder/$(basename "$file" .c).o
            avr-gcc -std="$1" ${3:-} $flags -c "$file" -o "$object" >"$folder/log" 2>&1 || wrong "$what: $file" "$folder/log"
            objects="$objects $object"
        done
        avr-g++ -std="$2" ${3:-} -fno-exceptions -Wconversion $flags -o "$folder/image.elf" tests/embed/avr_main.cpp $objects \
            >"$folder/log" 2>&1 || { wrong "$what: it does not link" "$folder/log"; continue; }
        # addresses of flash begin at 0, those of RAM at 0x800000
        at=$(avr-nm "$folder/image.elf" | awk '$3 == "wh_sine_table" { print $1 }')
        case $at in
        0000*) ;;
        *) wrong "$what: the sine's table is at $at, not in flash" ;;
        esac
        sh tests/limit.sh 60 simavr -m atmega2560 -f 16000000 "$folder/image.elf" 2>&1 </dev/null | tr -dc '0-9a-f.\n' |
            grep -Eo '[0-9a-f]{16}\.' | tr -d '.' >"$folder/said"
        if [ "$(tr '\n' ' ' <"$folder/said")" = "$run $sines " ]; then
            compared=$((compared + 1))
        else
            wrong "$what: hashes are not $run and $sines" "$folder/said"
        fi
    done <"$folder/dialects"
done <<END
thomson_a 4ms
rig_fixed 20ms
ball_bounces 20ms --with ledger
epicyclic_from_rest 20ms --compensated
END
[ "$compared" -ge 8 ] || wrong "only $compared images had the right bits"
[ $bad -ne 0 ] || echo "$compared images on an ATmega2560 have this machine's bits, their table in flash"
exit $bad
