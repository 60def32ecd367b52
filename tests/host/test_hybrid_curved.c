/* test_hybrid_curved.c: random curved hybrids: whatever happens at dead centres, the energy is accounted for. */
#include "contacts.h"
#include "curved.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

void suite_hybrid_curved(void);

static long wanted_runs(long usual) {
    const char *wanted = getenv("WHIRL_CURVED_RUNS");
    const long count = wanted != NULL ? strtol(wanted, NULL, 10) : 0;
    return count > 0 ? count : usual;
}

/* What the books of energy leave over, by the energy at the start; with its sign. */
static double unbooked(uint64_t seed, const engine_kind *kind, uint64_t *overruns, bool *failed) {
    char text[2000];
    motion m;
    const double energy_J = curved_text(seed, 1e-3, 2.0, text, sizeof text);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    *failed = motion_step(&m, contacts_steps(&m)) != WH_OK;
    double total[64] = {0.0};
    double left[8] = {0.0};
    m.kind->ledger(m.run, total, left);
    *overruns = contacts_overruns(&m);
    motion_close(&m);
    return left[0] / energy_J;
}

static void test_energy_is_accounted_for(void) {
    const long runs = wanted_runs(200);
    const char *first = getenv("WHIRL_CURVED_SEED");
    const uint64_t from = first != NULL ? strtoull(first, NULL, 10) : 1;
    double worst = 0.0;
    int beyond = 0;
    int over = 0;
    int failures = 0;
    for (uint64_t seed = from; seed < from + (uint64_t)runs; seed++) {
        uint64_t overruns;
        bool failed;
        const double share = fabs(unbooked(seed, &engine_double, &overruns, &failed));
        over += overruns > 0;
        if (overruns > 0 && getenv("WHIRL_CURVED_SHOW") != NULL) printf("  seed %llu: %llu overruns, leaves %.1e\n", (unsigned long long)seed, (unsigned long long)overruns, share);
        failures += failed;
        if (!failed && overruns == 0) {
            worst = fmax(worst, share);
        }
        if (!failed && overruns == 0 && !(share <= 1e-4)) {
            beyond++;
            printf("  seed %llu leaves %.2e\n", (unsigned long long)seed, share);
        }
    }
    char line[200];
    snprintf(line, sizeof line,
             "%ld runs from seed %llu: %d leave more than 1e-4, worst %.1e; %d with overruns, %d refused",
             runs, (unsigned long long)from, beyond, worst, over, failures);
    puts(line);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, beyond, line);
}

void suite_hybrid_curved(void) { RUN_TEST(test_energy_is_accounted_for); }
