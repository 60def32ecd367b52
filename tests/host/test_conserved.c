/* test_conserved.c: a coordinate that is recovered from its momentum, compared with the function from which the
 * momentum was made.
 *
 * T = M x'^2/2 + x' dG/dt + terms in q and r, with a random G(q, r). So p = M x' + dG/dt is constant, and
 * x = (p t + G(start) - G)/M. G has powers, waves and their products; conserve.c can integrate some of these. */
#include "derived.h"
#include "host/derive/conserve.h"

enum { TERMS = 3 };

typedef struct wave_term {
    double size;
    int q_power;
    int r_power;
    bool turns; /* has the factor sin(k q + l r + c) */
    int k;
    int l;
    double c;
    bool grows; /* has the factor exp(r) */
} wave_term;

static double term_value(const wave_term *t, double q, double r) {
    return t->size * pow(q, t->q_power) * pow(r, t->r_power) *
           (t->turns ? sin(t->k * q + t->l * r + t->c) : 1.0) * (t->grows ? exp(r) : 1.0);
}

static double g_value(const wave_term *terms, double q, double r) {
    double sum = 0.0;
    for (int i = 0; i < TERMS; i++) {
        sum += term_value(&terms[i], q, r);
    }
    return sum;
}

/* Writes dG/dq (which = 0) or dG/dr (which = 1) as text. */
static void write_slope(char *text, size_t size, const wave_term *terms, int which) {
    size_t at = (size_t)snprintf(text, size, "(0");
    for (int i = 0; i < TERMS; i++) {
        const wave_term *t = &terms[i];
        char wave[96] = "";
        char turned[96] = "";
        const char *grows = t->grows ? "*exp(r)" : "";
        if (t->turns) {
            snprintf(wave, sizeof wave, "*sin(%d*q + %d*r + %.17g)", t->k, t->l, t->c);
            snprintf(turned, sizeof turned, "*cos(%d*q + %d*r + %.17g)", t->k, t->l, t->c);
        }
        const int power = which == 0 ? t->q_power : t->r_power;
        const int times = which == 0 ? t->k : t->l;
        if (power > 0) {
            at +=
                (size_t)snprintf(text + at, size - at, " + %.17g*q^%d*r^%d%s%s", t->size * power,
                                 t->q_power - (which == 0), t->r_power - (which == 1), wave, grows);
        }
        if (t->turns && times != 0) {
            at += (size_t)snprintf(text + at, size - at, " + %.17g*q^%d*r^%d%s%s", t->size * times,
                                   t->q_power, t->r_power, turned, grows);
        }
        if (t->grows && which == 1) {
            at += (size_t)snprintf(text + at, size - at, " + %.17g*q^%d*r^%d%s%s", t->size,
                                   t->q_power, t->r_power, wave, grows);
        }
    }
    snprintf(text + at, size - at, ")");
}

/* Powers of q and r, a wave of both, or a wave of one angle times powers of the other. Of terms without powers of r,
 * a third has the factor exp(r). */
static wave_term random_term(uint64_t *seed) {
    wave_term t = {.size = random_between(seed, -2.0, 2.0)};
    const unsigned kind = (unsigned)(random_bits(seed) % 4);
    t.turns = kind > 0;
    t.c = random_between(seed, 0.1, 1.0);
    t.k = kind == 2 ? 0 : 1 + (int)(random_bits(seed) % 3);
    t.l = kind == 3 ? 0 : 1 - (int)(random_bits(seed) % 3);
    t.l = kind == 2 && t.l == 0 ? 2 : t.l;
    t.q_power = kind == 0 || kind == 2 ? (int)(random_bits(seed) % 4) : 0;
    t.r_power = kind == 0 || kind == 3 ? (int)(random_bits(seed) % 4) : 0;
    return t;
}

typedef struct moment {
    double q[3][2]; /* value and rate of x, q and r */
    double time;
} moment;

static double moment_value(void *context, const symbol *sym, int primes) {
    const moment *now = context;
    return sym == &conservation_time ? now->time : now->q[sym->index][primes];
}

static void check_law(const conservation *c, const wave_term *terms, const moment *start,
                      double mass, uint64_t *seed) {
    const double h = 1e-6;
    double momentum = mass * start->q[0][1];
    for (int side = 0; side < 2; side++) { /* the value of dG/dt at the start */
        const double by = side == 0 ? -h : h;
        const double g = g_value(terms, start->q[1][0] + by * start->q[1][1],
                                 start->q[2][0] + by * start->q[2][1]);
        momentum += (side == 0 ? -g : g) / (2.0 * h);
    }
    const double g_start = mass * start->q[0][0] + g_value(terms, start->q[1][0], start->q[2][0]);
    for (int k = 0; k < 3; k++) {
        moment now = {.time = random_between(seed, 0.0, 5.0)};
        for (int i = 1; i < 3; i++) {
            now.q[i][0] = random_between(seed, 0.2, 1.2);
            now.q[i][1] = random_between(seed, -1.0, 1.0);
        }
        double dg = 0.0;
        for (int side = 0; side < 2; side++) {
            const double by = side == 0 ? -h : h;
            const double g =
                g_value(terms, now.q[1][0] + by * now.q[1][1], now.q[2][0] + by * now.q[2][1]);
            dg += (side == 0 ? -g : g) / (2.0 * h);
        }
        const double rate = (momentum - dg) / mass;
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, rate, poly_evaluate(c->rate[0], moment_value, &now));
        if (c->closed) {
            const double g = g_value(terms, now.q[1][0], now.q[2][0]);
            const double x = (g_start + momentum * now.time - g) / mass;
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, x, poly_evaluate(c->value[0], moment_value, &now));
        }
    }
}

TEST(conserved, a_coordinate_follows_from_its_momentum) {
    uint64_t seed = 53;
    int closed = 0;
    int open = 0;
    for (int round = 0; round < 300; round++) {
        wave_term terms[TERMS];
        for (int i = 0; i < TERMS; i++) {
            terms[i] = random_term(&seed);
        }
        if (round % 5 == 0) { /* exp(r) alone is neither a power nor a wave */
            terms[0].grows = true;
        }
        const double mass = random_between(&seed, 1.0, 3.0);
        moment start = {.time = 0.0};
        for (int i = 0; i < 3; i++) {
            start.q[i][0] = random_between(&seed, 0.2, 1.2);
            start.q[i][1] = random_between(&seed, -1.0, 1.0);
        }
        char slope[2][1024];
        write_slope(slope[0], sizeof slope[0], terms, 0);
        write_slope(slope[1], sizeof slope[1], terms, 1);
        char text[4096];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x\ncoordinate q\ncoordinate r\n"
                 "T = 1 [kg*m^2]*(%.17g*x'^2 + x'*(%s*q' + %s*r') + 500*(q'^2 + r'^2))\n"
                 "scene s {\nconserve x\n"
                 "start x = %.17g, q = %.17g, r = %.17g\n"
                 "start x' = %.17g [1/s], q' = %.17g [1/s], r' = %.17g [1/s]\n}\n",
                 0.5 * mass, slope[0], slope[1], start.q[0][0], start.q[1][0], start.q[2][0],
                 start.q[0][1], start.q[1][1], start.q[2][1]);
        diags *all = diags_new();
        whirl_model *parsed = model_parse("t", text, strlen(text), all);
        instance *inst = parsed == NULL
                             ? NULL
                             : instance_make(parsed->mechanisms[0], parsed->scenes[0], NULL, all);
        equations *e = inst == NULL ? NULL : equations_derive(inst, all);
        conservation *c = e == NULL ? NULL : conservation_make(e, parsed->scenes[0]->conserve, all);
        diags_flush(all, stdout);
        TEST_ASSERT_NOT_NULL_MESSAGE(c, text);
        TEST_ASSERT_EQUAL_INT(1, c->count);
        TEST_ASSERT_TRUE(c->unknown[0] == 0 && c->number[0] == 0 && c->number[1] == -1);
        const bool whole =
            !terms[0].grows || terms[0].q_power > 0 || (terms[0].turns && terms[0].k != 0);
        /* exp(r) together with q is integrated by q */
        TEST_ASSERT_TRUE_MESSAGE(c->closed == whole, text);
        check_law(c, terms, &start, mass, &seed);
        closed += c->closed;
        open += !c->closed;
        equations_free(e);
        instance_free(inst);
        model_free(parsed);
        diags_free(all);
    }
    printf("  %d with a place, %d with a rate only, seed 53\n", closed, open);
    TEST_ASSERT_GREATER_THAN_INT(200, closed);
    TEST_ASSERT_GREATER_THAN_INT(3, open);
}
