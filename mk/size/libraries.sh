#!/bin/sh
# libraries.sh: bytes of all that each library holds; a program takes only the parts that it calls.
#
#   SIZE=arm-none-eabi-size libraries.sh LIBRARY...
set -eu

printf '%-28s %8s %8s\n' "library, all of it" "flash B" "ram B"
for library in "$@"; do
    "$SIZE" -t "$library" | awk -v name="$(basename "$library" .a)" '
        $NF == "(TOTALS)" { printf "%-28s %8d %8d\n", name, $1 + $2, $2 + $3 }'
done
