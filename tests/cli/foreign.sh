#!/bin/sh
# foreign.sh: an embedder's compiler flags and static analysis on core and generated code, in seconds: three sets of
# the flag matrix, and cppcheck with its defaults, which must understand the guards of core/real.h.
. "$(dirname "$0")/../checks.sh"

sh tests/flags.sh quick >"$scratch/flags" 2>&1
verdict $? "three sets of flags give the same bits or a refusal" "$scratch/flags"

if command -v cppcheck >/dev/null 2>&1; then
    "$whirl" derive epicyclic_from_rest --as c >"$scratch/scene.c"
    cat >>"$scratch/scene.c" <<'END'
int broken(int *p);
int broken(int *p) { if (p == 0) { return *p; } return 0; }
END
    cppcheck -q --enable=warning -I. "$scratch/scene.c" >"$scratch/said" 2>&1
    grep -q 'nullPointer' "$scratch/said" && ! grep -E ': (error|warning):' "$scratch/said" | grep -qv nullPointer
    verdict $? "cppcheck finds a planted fault in generated code, and nothing else" "$scratch/said"
fi
exit $failed
