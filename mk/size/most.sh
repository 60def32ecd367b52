#!/bin/sh
# most.sh OBJECTS LIST: no scene of LIST, lines "SCENE BYTES", has a longer step than it may have. SIZE is the board's size;
# OBJECTS holds the scenes' objects. Where steps still looked every sine up at every stage (commit 31fbe43) they took the
# bytes of boards/mps2-an386/most_bytes.txt; what is cheaper since must not be larger. Exit status 1: a step is longer, or
# there is none of that name.
set -eu
passed=0 failed=0
while read -r scene most; do
    bytes=$($SIZE -A "$1/$scene.o" | awk '$1 == ".text.advance" { print $2 }')
    if [ -n "$bytes" ] && [ "$bytes" -le "$most" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "not ok - $scene: a step of ${bytes:-no} bytes, of at most $most"
    fi
done <"$2"
echo "steps of scenes without contacts, bytes: $passed within their most, $failed not"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
