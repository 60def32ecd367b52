#!/bin/sh
# files.sh MAP: bytes of flash of each file in an image, by the linker's map, most first, and their sum. Texts are shared: they
# count for the first file that has them, or has them as the end of a longer one. Of an image that is optimised as a whole no map
# tells: there each function counts for the file that it stands in, whoever's code is in it, and texts and data for none. NM, SIZE.
set -eu

[ -r "$1" ] || { echo "files.sh: $1: no such map; what the linker made has it beside it" >&2; exit 2; }
if grep -q '^LOAD .*ltrans\.o$' "$1"; then
    elf=${1%.map}.elf
    all=$("${SIZE:-arm-none-eabi-size}" -A "$elf" | awk '$1 ~ /^\.(vectors|text|data)$/ { sum += $2 } END { print sum }')
    "${NM:-arm-none-eabi-nm}" -S -l "$elf" | tr -d '\r' | awk 'NF >= 5 && $3 ~ /[tTwW]/ && !($1 in seen) {
            seen[$1]
            sub(/\.[a-z]*(:[0-9]*)?$/, "", $5)
            n = split($5, part, "/")
            print $2, (n > 1 ? part[n - 1] "/" : "") part[n]
        }' | while read -r size file; do echo "$((0x$size)) $file"; done | awk -v all="$all" '
        { bytes[$2] += $1; sum += $1 }
        END {
            for (file in bytes) print bytes[file], file
            print all - sum, "texts, data and what has no file"
            print all, "all"
        }'
else
    awk '
    /^Linker script and memory map/ { on = 1 }
    !on { next }
    /^ \.[^ ]+$/ { held = $1; next } # a long name: the rest stands on the next line
    held != "" { $0 = " " held $0; held = "" }
    /^ \.(vectors|text|rodata|ARM\.exidx|data)/ && NF >= 4 && $2 ~ /^0x/ && $3 != "0x0" && $2 != "0x00000000" {
        n = split($4, part, "/")
        file = part[n]
        if (file ~ /\.a\(/) { sub(/^lib/, "", file); sub(/\.a\(/, "/", file); sub(/\.o\)$/, "", file) }
        else { sub(/\.o$/, "", file); file = part[n - 1] "/" file }
        print $2, $3, file
    }' "$1" | while read -r at size file; do echo "$((at)) $((size)) $file"; done | sort -k 1,1n -k 2,2n | awk '
    # A part that the next symbol overlaps is not counted twice.
    held != "" { bytes[held] += $1 < end ? $1 - begin : end - begin }
    { begin = $1; held = $3; end = begin + $2 }
    END {
        bytes[held] += end - begin
        for (file in bytes) { sum += bytes[file]; print bytes[file], file }
        print sum, "all"
    }'
fi | sort -k 1,1nr -k 2,2 | awk '{ bytes = $1; sub(/^[^ ]* /, ""); printf "%8d  %s\n", bytes, $0 }'
