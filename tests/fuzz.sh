#!/bin/sh
# fuzz.sh SECONDS FUZZER...: runs each fuzzer for so many seconds, on a copy of the inputs that are kept from earlier
# runs (tests/fuzz/kept). Fuzzers of the language also get the built-in models and the broken files.
# tests/fuzz/NAME.dict, if it exists, has words to try.
set -u

seconds=${1:?usage: fuzz.sh SECONDS FUZZER...}
shift
[ $# -gt 0 ] || { echo "fuzz.sh: there is no fuzzer" >&2; exit 1; }
status=0
for fuzzer in "$@"; do
    corpus=${fuzzer%.fuzzer}.corpus
    found=${fuzzer%.fuzzer}.found
    mkdir -p "$corpus" "$found"
    case $fuzzer in
    *fuzz_lang.fuzzer | *fuzz_derive.fuzzer) cp core/models/*.whirl "$corpus/" && sh tests/bad.sh "$corpus" ;;
    esac
    kept=tests/fuzz/kept/$(basename "$fuzzer" .fuzzer).tar.gz
    [ ! -f "$kept" ] || tar -xzf "$kept" --strip-components=1 -C "$corpus"
    log=${fuzzer%.fuzzer}.log
    words=tests/fuzz/$(basename "$fuzzer" .fuzzer).dict
    if [ -f "$words" ]; then words=-dict=$words; else words=; fi
    if "$fuzzer" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=2048 -max_len=8192 \
        -artifact_prefix="$found/" ${words:+"$words"} "$corpus" >"$log" 2>&1; then
        printf '  PASS  %-30s %s\n' "$fuzzer" "$(grep '^Done' "$log")"
    else
        printf '  FAIL  %-30s see %s and %s\n' "$fuzzer" "$log" "$found"
        grep -E 'ERROR|SUMMARY' "$log" | head -n 3 | sed 's/^/        /'
        status=1
    fi
done
exit $status
