#!/bin/sh
# part.sh LIST WHICH OF: prints every OF-th suite in LIST (file names, test_NAME.c), from number WHICH (0 the first).
if [ $# -ne 3 ] || [ ! -r "$1" ] || ! [ "$2" -ge 0 ] 2>/dev/null || ! [ "$3" -gt "$2" ] 2>/dev/null; then
    echo "part.sh: error: LIST, a file, WHICH from 0 on, and OF, more than that, are wanted, not: $*" >&2
    exit 2
fi
awk -v which="$2" -v of="$3" '
    /^test_.*\.c$/ && n++ % of == which { sub(/^test_/, ""); sub(/\.c$/, ""); print }' "$1"
