#!/bin/sh
# cycles_agree.sh BENCH.elf: the estimated cycles of all that this image counts, from the plugin (instructions' bits, as they
# are executed) and from the disassembly (its words, and how often each address was executed): within 1 %.
#
# In the environment: BOARD, NM, OBJDUMP, PLUGIN, TIMING, EMULATE.
set -eu
. "$(dirname "$0")/common.sh"
elf=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

count ",profile=on"
"$OBJDUMP" -d "$elf" >"$work/words"
awk -v core="$TIMING" -f "$(dirname "$0")/cycles.awk" "$work/words" "$work/counts" >"$work/both"
awk -v board="$BOARD" '
    { value[$1] = $2 }
    END {
        if (!(value["plugin"] > value["instructions"])) { print board ": no cycles"; exit 1 }
        off = 100 * (value["disassembly"] / value["plugin"] - 1)
        printf "%s: %d instructions; cycles estimated from bits %d, from words %d: %+.4f %%\n", board, value["instructions"],
            value["plugin"], value["disassembly"], off
        exit off > 1 || off < -1
    }' "$work/both"
