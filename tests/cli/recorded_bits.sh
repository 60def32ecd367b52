#!/bin/sh
# recorded_bits.sh: every built-in scene ends with the bits on record in tests/reference/bits.txt. `make hashes` compares
# compilers and boards, this script compares with earlier versions. To change bits, renew the record with `WHIRL=build/whirl
# sh tests/cli/recorded_bits.sh --write` and say so in CHANGELOG.md.
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
