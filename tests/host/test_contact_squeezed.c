/* test_contact_squeezed.c: more impacts than a step holds: a light body between heavier ones and walls is hit to and
 * fro, ever faster; or one between slanting walls. Nothing passes through anything, nobody gains energy, and where friction
 * is everywhere, all that moves loses some. */
#include "contacts.h"
#include "derived.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

void suite_contact_squeezed(void);

enum { BODIES = 4, STEPS = 300, TEXT = 4000 };

/* What is watched of a mechanism: the least gap of its stops, m, and its energy, which is all kinetic, J. */
typedef double look(const void *of, const motion *m);

typedef struct watched {
    const void *of;
    look *least_gap;
    look *energy;
    bool rubs; /* friction at every coordinate: who moves on loses something */
    int steps;
    double bound_m[2];  /* beyond a stop by no more: in double, in float */
    double rounding[2]; /* the energy rises by no more, of what there was at the start */
} watched;

/* Runs one, in double or in float; returns its overruns. */
static uint64_t watch(const watched *w, const char *text, bool in_float, double *deepest_m) {
    motion m;
    motion_open_text(&m, text, in_float ? IN_FLOAT : IN_DOUBLE);
    double before_J = w->energy(w->of, &m);
    const double none_J = w->rounding[in_float] * before_J;
    for (int i = 0; i < w->steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double gap_m = w->least_gap(w->of, &m);
        const double after_J = w->energy(w->of, &m);
        const bool rises = after_J > before_J + none_J;
        const bool stays = w->rubs && after_J >= before_J && after_J > none_J;
        deepest_m[in_float] = fmin(deepest_m[in_float], gap_m);
        if (gap_m < -w->bound_m[in_float] || rises || stays) {
            printf("  step %d: gap %.3g m, energy %.17g J after %.17g J\n%s", i, gap_m, after_J,
                   before_J, text);
            TEST_FAIL();
        }
        before_J = after_J;
    }
    const uint64_t overruns = contacts_overruns(&m);
    motion_close(&m);
    return overruns;
}

/* Of so many drawn ones by `run`, from seeds 1 on. */
static void watch_many(uint64_t run(uint64_t seed, double *deepest_m)) {
    const char *wanted = getenv("WHIRL_CASES");
    const long runs = wanted != NULL ? strtol(wanted, NULL, 10) : 100;
    uint64_t overruns = 0;
    double deepest_m[2] = {0.0, 0.0};
    for (long i = 1; i <= runs; i++) {
        overruns += run((uint64_t)i * 0x9e3779b97f4a7c15U, deepest_m);
    }
    printf("seeds 1 to %ld: beyond a stop by at most %.1e m, in float %.1e m; %llu overruns\n",
           runs, -deepest_m[0], -deepest_m[1], (unsigned long long)overruns);
    TEST_ASSERT_TRUE(overruns > 0); /* else this was no test */
}

/* --- in a row --------------------------------------------------------------------------------------------------- */

/* A row of bodies between two walls, without forces but friction. */
typedef struct row {
    int n;
    double mass_kg[BODIES];
    double place_m[BODIES];
    double speed_mps[BODIES];
    double end_m; /* the other wall's place; the first is at 0 */
    double restitution[BODIES + 1];
    double normal_N; /* 0: no friction */
} row;

static row row_drawn(uint64_t seed) {
    row r = {.n = 2 + (int)(random_bits(&seed) % (BODIES - 1))};
    double at_m = 0.0;
    for (int i = 0; i < r.n; i++) {
        at_m += random_between(&seed, 0.0, 0.02);
        r.mass_kg[i] = pow(10.0, random_between(&seed, -2.0, 1.0));
        r.place_m[i] = at_m;
        r.speed_mps[i] = random_between(&seed, -3.0, 3.0);
    }
    r.end_m = at_m + random_between(&seed, 0.0, 0.02);
    for (int i = 0; i <= r.n; i++) {
        r.restitution[i] = random_between(&seed, 0.0, 1.0);
    }
    r.normal_N = random_bits(&seed) % 2U == 0 ? 0.0 : pow(10.0, random_between(&seed, -1.0, 2.0));
    return r;
}

static void row_text(const row *r, char *text) {
    int at = 0;
#define PUT(...) at += snprintf(text + at, (size_t)(TEXT - at), __VA_ARGS__)
    PUT("mechanism squeezed\n");
    for (int i = 1; i <= r->n; i++) {
        PUT("coordinate x%d [m]\n", i);
    }
    for (int i = 0; i < r->n; i++) {
        PUT("%s%.17g [kg]*x%d'^2/2", i == 0 ? "T = " : " + ", r->mass_kg[i], i + 1);
    }
    PUT("\nstop x1 >= 0 [m] restitution %.17g\n", r->restitution[0]);
    for (int i = 1; i < r->n; i++) {
        PUT("stop x%d >= x%d restitution %.17g\n", i + 1, i, r->restitution[i]);
    }
    PUT("stop x%d <= %.17g [m] restitution %.17g\n", r->n, r->end_m, r->restitution[r->n]);
    for (int i = 1; i <= r->n && r->normal_N > 0.0; i++) {
        PUT("friction x%d static 0.4 kinetic 0.3 normal %.17g [N]\n", i, r->normal_N);
    }
    PUT("scene s {\n");
    for (int i = 0; i < r->n; i++) {
        PUT("  start x%d = %.17g [m], x%d' = %.17g [m/s]\n", i + 1, r->place_m[i], i + 1,
            r->speed_mps[i]);
    }
    PUT("  step 1 [ms]\n  until %d [ms]\n}\n", STEPS);
#undef PUT
}

static double value(const motion *m, int body, const char *of) {
    char name[16];
    snprintf(name, sizeof name, "x%d%s", body + 1, of);
    return motion_value(m, name);
}

static double row_gap_m(const void *of, const motion *m) {
    const row *r = of;
    double least = value(m, 0, "");
    for (int i = 1; i < r->n; i++) {
        least = fmin(least, value(m, i, "") - value(m, i - 1, ""));
    }
    return fmin(least, r->end_m - value(m, r->n - 1, ""));
}

static double row_energy_J(const void *of, const motion *m) {
    const row *r = of;
    double sum = 0.0;
    for (int i = 0; i < r->n; i++) {
        const double v = value(m, i, "'");
        sum += 0.5 * r->mass_kg[i] * v * v;
    }
    return sum;
}

static uint64_t watch_row(const row *r, double *deepest_m) {
    const watched w = {r,     row_gap_m,     row_energy_J, r->normal_N > 0.0,
                       STEPS, {1e-12, 1e-7}, {1e-13, 1e-6}};
    char text[TEXT];
    row_text(r, text);
    return watch(&w, text, false, deepest_m) + watch(&w, text, true, deepest_m);
}

static uint64_t run_row(uint64_t seed, double *deepest_m) {
    const row r = row_drawn(seed);
    return watch_row(&r, deepest_m);
}

static void test_nothing_is_squeezed_through(void) { watch_many(run_row); }

/* The pair that was found: it ended 0.6 mm beyond. */
static void test_a_pair_against_a_wall(void) {
    const row r = {.n = 2,
                   .mass_kg = {1.0, 0.1},
                   .place_m = {0.01, 0.02},
                   .speed_mps = {1.0, 0.0},
                   .end_m = 0.03,
                   .restitution = {0.5, 0.5, 0.5}};
    double deepest_m[2] = {0.0, 0.0};
    (void)watch_row(&r, deepest_m);
}

/* --- between slanting walls, and with friction ------------------------------------------------------------------ */

enum { WALLS_MOST = 5, CAGE_STEPS = 60 };

/* One body of two coordinates and any inertia among walls that close the origin in, some with friction in both
 * directions. */
typedef struct cage {
    double mass_kg[3]; /* xx, xy, yy */
    int walls;
    double row[WALLS_MOST][2];
    double off_m[WALLS_MOST];
    double restitution[WALLS_MOST];
    double speed_mps[2];
    double normal_N; /* 0: no friction */
} cage;

static cage cage_drawn(uint64_t seed) {
    cage c = {.walls = 3 + (int)(random_bits(&seed) % (WALLS_MOST - 2))};
    const double turned = random_between(&seed, 0.0, 6.28);
    c.mass_kg[0] = random_between(&seed, 1.0, 5.0);
    c.mass_kg[2] = random_between(&seed, 1.0, 5.0);
    c.mass_kg[1] = random_between(&seed, -0.9, 0.9) * sqrt(c.mass_kg[0] * c.mass_kg[2]);
    for (int k = 0; k < c.walls; k++) {
        const double at = turned + 6.2832 * (k + random_between(&seed, -0.2, 0.2)) / c.walls;
        const double size = random_between(&seed, 0.5, 2.0);
        c.row[k][0] = size * cos(at);
        c.row[k][1] = size * sin(at);
        c.off_m[k] = random_between(&seed, 0.0, 0.001);
        const uint64_t kind = random_bits(&seed) % 3U;
        c.restitution[k] = kind == 0 ? 0.0 : kind == 1 ? 1.0 : random_between(&seed, 0.0, 1.0);
    }
    c.speed_mps[0] = random_between(&seed, -30.0, 30.0);
    c.speed_mps[1] = random_between(&seed, -30.0, 30.0);
    c.normal_N = random_bits(&seed) % 2U == 0 ? 0.0 : pow(10.0, random_between(&seed, 0.0, 4.0));
    return c;
}

static void cage_text(const cage *c, char *text) {
    int at = 0;
#define PUT(...) at += snprintf(text + at, (size_t)(TEXT - at), __VA_ARGS__)
    PUT("mechanism cage\ncoordinate x [m]\ncoordinate y [m]\n");
    PUT("T = (%.17g*x'^2 + 2*%.17g*x'*y' + %.17g*y'^2)/2 * 1 [kg]\n", c->mass_kg[0], c->mass_kg[1],
        c->mass_kg[2]);
    for (int k = 0; k < c->walls; k++) {
        PUT("stop %.17g*x + %.17g*y >= %.17g [m] restitution %.17g\n", c->row[k][0], c->row[k][1],
            -c->off_m[k], c->restitution[k]);
    }
    for (int i = 0; i < 2 && c->normal_N > 0.0; i++) {
        const char coordinate = i == 0 ? 'x' : 'y';
        PUT("friction %c static 0.4 kinetic 0.3 normal %.17g [N]\n", coordinate, c->normal_N);
    }
    PUT("scene s {\n  start x' = %.17g [m/s], y' = %.17g [m/s]\n  step 1 [ms]\n  until %d [ms]\n}\n",
        c->speed_mps[0], c->speed_mps[1], CAGE_STEPS);
#undef PUT
}

static double cage_gap_m(const void *of, const motion *m) {
    const cage *c = of;
    double least = HUGE_VAL;
    for (int k = 0; k < c->walls; k++) {
        least = fmin(least, c->row[k][0] * motion_value(m, "x") +
                                c->row[k][1] * motion_value(m, "y") + c->off_m[k]);
    }
    return least;
}

static double cage_energy_J(const void *of, const motion *m) {
    const cage *c = of;
    const double vx = motion_value(m, "x'");
    const double vy = motion_value(m, "y'");
    return (c->mass_kg[0] * vx * vx + 2.0 * c->mass_kg[1] * vx * vy + c->mass_kg[2] * vy * vy) /
           2.0;
}

static uint64_t run_cage(uint64_t seed, double *deepest_m) {
    const cage c = cage_drawn(seed);
    const watched w = {&c,         cage_gap_m,   cage_energy_J, c.normal_N > 0.0,
                       CAGE_STEPS, {1e-8, 1e-5}, {1e-13, 1e-6}};
    char text[TEXT];
    cage_text(&c, text);
    return watch(&w, text, false, deepest_m) + watch(&w, text, true, deepest_m);
}

static void test_nothing_leaves_a_cage(void) { watch_many(run_cage); }

void suite_contact_squeezed(void) {
    RUN_TEST(test_nothing_is_squeezed_through);
    RUN_TEST(test_a_pair_against_a_wall);
    RUN_TEST(test_nothing_leaves_a_cage);
}
