#!/bin/sh
# files.sh MAP: bytes of flash of each file in an image, by the linker's map, most first, and their sum. Texts are shared: they
# count for the first file that has them, or has them as the end of a longer one.
set -eu

awk '
/^Linker script and memory map/ { on = 1 }
!on { next }
/^ \.[^ ]+$/ { held = $1; next } # a long name: the rest stands on the next line
held != "" { $0 = " " held $0; held = "" }
/^ \.(vectors|text|rodata|ARM\.exidx|data)/ && NF >= 4 && $2 ~ /^0x/ && $3 != "0x0" && $2 != "0x00000000" {
    file = $4
    sub(/^.*\//, "", file)
    folder = $4
    if (file ~ /\.a\(/) {
        sub(/^lib/, "", file)
        sub(/\.a\(/, "/", file)
        sub(/\.o\)$/, "", file)
    } else {
        sub(/\.o$/, "", file)
        sub(/\/[^\/]*$/, "", folder)
        sub(/^.*\//, "", folder)
        file = folder "/" file
    }
    print $2, $3, file
}' "$1" | while read -r at size file; do
    echo "$((at)) $((size)) $file"
done | sort -k 1,1n -k 2,2n | awk '
    # What the next one begins within, or where it begins too, is not counted twice.
    held != "" { bytes[held] += $1 < end ? $1 - begin : end - begin }
    { begin = $1; held = $3; end = begin + $2 }
    END {
        bytes[held] += end - begin
        for (file in bytes) { sum += bytes[file]; print bytes[file], file }
        print sum, "all"
    }' | sort -k 1,1nr -k 2,2 | awk '{ printf "%8d  %s\n", $1, $2 }'
