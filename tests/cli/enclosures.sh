#!/bin/sh
# enclosures.sh: intervals (host/number/enclosure.h) contain the exact results under any compiler: build/tests/host
# enclosure by gcc and clang, not optimised or as far as possible, with fused multiply-add if available. fast-math is
# refused. `make test` takes two builds; WHIRL_FULL=1 all.
. "$(dirname "$0")/../checks.sh"

unity=$(dirname "$whirl")/unity
cat >"$scratch/main.c" <<'END'
#include <stdio.h>
#include <stdlib.h>

#include "core/number/arithmetic.h"
#include "tests/host/command.h"
#include "unity.h"

void suite_enclosure(void);

/* As in tests/host/command.c, which starts commands, too. */
dice dice_of(const char *suite, unsigned long seed) {
    const char *wished = getenv("WHIRL_SEED");
    (void)suite;
    return (dice){wished != NULL ? strtoul(wished, NULL, 10) : seed};
}
static unsigned long long next(dice *d) {
    unsigned long long x = d->state += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}
double dice_between(dice *d, double low, double high) {
    return low + (high - low) * ((double)(next(d) >> 11) * 0x1p-53);
}
unsigned dice_one_of(dice *d, unsigned count) { return (unsigned)(next(d) >> 33) % count; }
unsigned dice_cases(unsigned usual) { return usual / 5; }
unsigned few_or_all(unsigned few, unsigned all) { return getenv("WHIRL_FULL") != NULL ? all / 20 : few; }
unsigned usual_or(unsigned usual, unsigned fewest) {
    (void)fewest;
    return usual;
}
void setUp(void) {}
void tearDown(void) {}
int main(void) {
    if (wh_arithmetic_wrong(wh_arithmetic) != WH_PROBED_COUNT) { /* as whirl does */
        puts("other arithmetic");
        return 3;
    }
    UNITY_BEGIN();
    suite_enclosure();
    return UNITY_END();
}
END

sources="$scratch/main.c tests/host/test_enclosure.c tests/host/quad_arms.c host/number/enclosure.c host/number/functions.c $unity/unity.c"
plain="-std=c11 -DWH_DOUBLE=1 -DUNITY_INCLUDE_CONFIG_H -I. -Itests -isystem $unity"
for file in core/*.c; do
    "${CC:-cc}" $plain -O1 -ffp-contract=off -c -o "$scratch/core_$(basename "$file" .c).o" "$file" 2>>"$scratch/err"
done
[ ! -s "$scratch/err" ]
verdict $? "the core, for the functions of the language"

build() { # build COMPILER FLAGS...: makes $scratch/program
    by=$1
    shift
    rm -f "$scratch/program"
    for file in $sources; do
        "$by" $plain "$@" -c -o "$scratch/own_$(basename "$file" .c).o" "$file" || return 1
    done
    "$by" -o "$scratch/program" "$scratch"/own_*.o "$scratch"/core_*.o -lm
}
holds() { # holds COMPILER FLAGS...
    if ! command -v "$1" >/dev/null 2>&1; then
        echo "ok - $1 is not here # SKIP"
        return
    fi
    build "$@" >"$scratch/err" 2>&1 && "$scratch/program" >"$scratch/said" 2>&1 && grep -q '^OK$' "$scratch/said" &&
        [ "$(grep -c ':PASS$' "$scratch/said")" -ge 6 ]
    verdict $? "$*: $(grep -c ':PASS$' "$scratch/said" 2>/dev/null) tests" "$scratch/said"
}

holds gcc -O0
holds clang -O3
if [ -n "${WHIRL_FULL:-}" ]; then
    holds gcc -O2
    holds gcc -O3
    holds gcc -O2 -frounding-math
    holds clang -O0
    holds clang -O2
    if grep -q ' fma ' /proc/cpuinfo 2>/dev/null; then
        holds gcc -O3 -march=haswell -ffp-contract=fast
        # clang prefers its flag to the core's pragma, so whirl would not start
        if command -v clang >/dev/null 2>&1; then
            build clang -O3 -march=haswell -ffp-contract=fast >"$scratch/err" 2>&1
            "$scratch/program" >"$scratch/said" 2>&1
            grep -q '^other arithmetic$' "$scratch/said"
            verdict $? "clang -O3 -march=haswell -ffp-contract=fast is refused at the start" "$scratch/said"
        fi
    fi
fi
for by in gcc clang; do
    command -v $by >/dev/null 2>&1 || continue
    for fast in -ffast-math -Ofast -funsafe-math-optimizations; do
        $by $plain -O2 $fast -c -o "$scratch/fast.o" host/number/enclosure.c >"$scratch/said" 2>&1
        if [ $? -ne 0 ]; then
            grep -q 'Whirl computes the same bits everywhere' "$scratch/said"
            verdict $? "$by $fast is refused" "$scratch/said"
        else # no macro shows this flag
            build $by -O2 $fast >"$scratch/err" 2>&1 && "$scratch/program" >"$scratch/said" 2>&1
            grep -q '^other arithmetic$' "$scratch/said"
            verdict $? "$by $fast is refused at the start" "$scratch/said"
        fi
    done
done
exit $failed
