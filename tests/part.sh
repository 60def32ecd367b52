#!/bin/sh
# part.sh LIST WHICH OF: every OF-th of the suites in LIST (file names, test_NAME.c), from WHICH on, 0 the first: their
# names.
awk -v which="$2" -v of="$3" '
    /^test_.*\.c$/ && n++ % of == which { sub(/^test_/, ""); sub(/\.c$/, ""); print }' "$1"
