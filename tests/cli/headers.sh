#!/bin/sh
# headers.sh: every header of core, hal and host includes what it needs, and depends on no order of headers. Each compiles
# alone, and all compile in both orders, in float and double, without a warning.
. "$(dirname "$0")/../checks.sh"

compiler=${CC:-cc}
flags="-std=c11 -ffp-contract=off -D_POSIX_C_SOURCE=200809L -I. -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion
    -Wno-unused-function -Wno-unused-const-variable -Werror -fsyntax-only"
headers=$(find core hal host -name '*.h' | sort)

bad=0
count=0
for header in $headers; do
    count=$((count + 1))
    echo "#include \"$header\"" >"$scratch/alone.c"
    $compiler $flags "$scratch/alone.c" >"$scratch/said" 2>&1 || {
        bad=1
        cat "$scratch/said" >>"$scratch/err"
    }
done
[ "$bad" -eq 0 ] && [ "$count" -gt 100 ]
verdict $? "each of $count headers alone"

for order in "sort" "sort -r"; do
    for real in 0 1; do
        printf '%s\n' "$headers" | $order | sed 's/.*/#include "&"/' >"$scratch/all.c"
        $compiler $flags -DWH_DOUBLE=$real "$scratch/all.c" >"$scratch/err" 2>&1
        verdict $? "all of them, $order, WH_DOUBLE=$real"
    done
done
exit $failed
