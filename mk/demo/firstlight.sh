#!/bin/sh
# firstlight.sh OUT COMMAND: runs a board's first-light image by its emulator's COMMAND until it has printed a whole
# record, and stores the record in OUT. A flashed image never ends by itself.
set -u

: >"$1"
sh -c "exec $2" >"$1" 2>"$1.err" &
emulator=$!
trap 'kill $emulator 2>/dev/null' EXIT
until grep -q '^end 0x[0-9a-f]\{8\}' "$1"; do
    if ! kill -0 $emulator 2>/dev/null; then
        wait $emulator
        grep -q '^end 0x' "$1" && exit 0
        echo "firstlight: no record came: $2" >&2
        cat "$1" "$1.err" >&2
        exit 1
    fi
    sleep 0.2
done
