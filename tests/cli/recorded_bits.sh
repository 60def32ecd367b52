#!/bin/sh
# recorded_bits.sh: every built-in scene ends with the bits on record in tests/reference/bits.txt. `make hashes` says
# that compilers and boards agree with each other; this, that they agree with yesterday. Whoever means to move bits
# writes the record anew, with `WHIRL=build/whirl sh tests/cli/recorded_bits.sh --write`, and says so in CHANGELOG.md.
. "$(dirname "$0")/../checks.sh"

record=$(dirname "$0")/../reference/bits.txt

"$whirl" hashes >"$scratch/all" 2>"$scratch/err"
verdict $? "every scene runs"
LC_ALL=C sort "$scratch/all" >"$scratch/now"
if [ "${1:-}" = --write ]; then
    cp "$scratch/now" "$record"
fi
diff "$record" "$scratch/now" >"$scratch/diff"
verdict $? "all end with the bits on record ($(wc -l <"$record") scenes)"
sed 's/^/    /' "$scratch/diff" | head -n 20
exit $failed
