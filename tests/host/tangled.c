#include "tangled.h"

#include "derived.h"

enum { BODIES = 4, STATEMENTS = 16, LINE = 160 };

typedef struct statements {
    int count;
    char line[STATEMENTS][LINE];
} statements;

__attribute__((format(printf, 2, 3))) static void add(statements *s, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(s->line[s->count++], LINE, format, arguments);
    va_end(arguments);
}

static bool chance(uint64_t *seed, unsigned of) { return random_bits(seed) % of == 0; }

static uint64_t seed_of(uint64_t seed) { return seed * 0x9e3779b97f4a7c15U + 7U; }

int tangled_bodies(uint64_t seed) {
    uint64_t s = seed_of(seed);
    return 2 + (int)(random_bits(&s) % (BODIES - 1));
}

static void shuffle(statements *s, uint64_t order) {
    uint64_t seed = order * 0xd1342543de82ef95U + 3U;
    for (int i = s->count - 1; i > 0 && order != 0; i--) {
        const int j = (int)(random_bits(&seed) % (uint64_t)(i + 1));
        char kept[LINE];
        memcpy(kept, s->line[i], LINE);
        memcpy(s->line[i], s->line[j], LINE);
        memcpy(s->line[j], kept, LINE);
    }
}

/* Adds stops between neighbours, which often touch, and walls at the ends. */
static void add_stops(statements *s, uint64_t *seed, int n, const double *x) {
    static const double restitutions[] = {0.0, 0.5, 1.0};
    for (int i = 0; i <= n; i++) {
        const double gap = chance(seed, 2) ? 0.0 : random_between(seed, 0.0, 0.2);
        const double e =
            chance(seed, 4) ? random_between(seed, 0.0, 1.0) : restitutions[random_bits(seed) % 3U];
        if (i == 0) {
            add(s, "stop x1 >= %.17g [m] restitution %.17g", x[0] - gap, e);
        } else if (i < n) {
            add(s, "stop x%d - x%d >= %.17g [m] restitution %.17g", i + 1, i, x[i] - x[i - 1] - gap,
                e);
        } else if (chance(seed, 2)) {
            add(s, "stop x%d <= %.17g [m] restitution %.17g", n, x[n - 1] + gap, e);
        }
    }
}

double tangled_text(const tangle *of, char *text, size_t size) {
    static const double speeds[] = {-1.0, 0.0, 1.0};
    uint64_t seed = seed_of(of->seed);
    const int n = 2 + (int)(random_bits(&seed) % (BODIES - 1));
    const bool equal = chance(&seed, 2); /* equal masses and speeds make events at the same time */
    double m[BODIES];
    double x[BODIES];
    double v[BODIES];
    double energy_J = 0.0;
    statements s = {0};
    for (int i = 0; i < n; i++) {
        m[i] = equal ? 1.0 : random_between(&seed, 0.3, 3.0);
        x[i] = 0.5 * i;
        v[i] = equal ? speeds[random_bits(&seed) % 3U] : random_between(&seed, -2.0, 2.0);
        energy_J += 0.5 * m[i] * v[i] * v[i];
    }
    add_stops(&s, &seed, n, x);
    for (int i = 1; i <= n && !of->plain; i++) {
        if (chance(&seed, 2)) {
            const double mu = random_between(&seed, 0.05, 0.5);
            add(&s, "friction x%d static %.17g kinetic %.17g normal %.17g [N]", i, mu,
                mu * (chance(&seed, 2) ? 1.0 : random_between(&seed, 0.5, 1.0)),
                random_between(&seed, 1.0, 10.0));
        }
    }
    if (chance(&seed, 3) && !of->plain) {
        const int i = 1 + (int)(random_bits(&seed) % (uint64_t)(n - 1));
        add(&s, "hold x%d - x%d while x%d > %.17g [m]", i + 1, i, i, random_between(&seed, 0, 0.4));
    }
    if (chance(&seed, 4) && !of->plain) {
        add(&s, "when x1 crosses %.17g [m] rising { set x%d' = %.17g*x%d' }",
            random_between(&seed, 0.05, 0.3), n, random_between(&seed, -0.9, 0.5), n);
    }
    shuffle(&s, of->order);
    size_t at = 0;
#define PUT(...) at += (size_t)snprintf(text + at, at < size ? size - at : 0, __VA_ARGS__)
    PUT("mechanism tangled\n");
    for (int i = 1; i <= n; i++) {
        PUT("coordinate x%d [m]\n", i);
    }
    for (int i = 0; i < n; i++) {
        PUT("%s%.17g [kg]*x%d'^2/2", i == 0 ? "T = " : " + ", m[i], i + 1);
    }
    PUT("\nV = 0 [J]");
    for (int i = 0; i < n && !of->plain; i++) {
        const double load = equal ? 5.0 : random_between(&seed, -5.0, 10.0);
        PUT(" + %.17g [N]*x%d", load, i + 1);
        energy_J += load < 0.0 ? -load : load;
        if (chance(&seed, 2)) {
            const double k = random_between(&seed, 10.0, 300.0);
            PUT(" + %.17g [N/m]*(x%d - %.17g [m])^2/2", k, i + 1, x[i]);
        }
    }
    PUT("\n");
    for (int i = 0; i < s.count; i++) {
        PUT("%s\n", s.line[i]);
    }
    PUT("scene s {\n  with ledger\n");
    for (int i = 0; i < n; i++) {
        PUT("  start x%d = %.17g [m], x%d' = %.17g [m/s]\n", i + 1, x[i], i + 1, v[i]);
    }
    PUT("  step %.17g [s]\n  until %.17g [s]\n}\n", of->step_s, of->until_s);
#undef PUT
    return energy_J > 0.0 ? energy_J : 1.0;
}
