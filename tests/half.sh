#!/bin/sh
# half.sh LIST WHICH: every second of the suites in LIST (file names, test_NAME.c), WHICH 0 or 1: their names.
awk -v which="$2" '/^test_.*\.c$/ && n++ % 2 == which { sub(/^test_/, ""); sub(/\.c$/, ""); print }' "$1"
