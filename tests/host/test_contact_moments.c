/* test_contact_moments.c: many events in a short time: flights shorter than a step, and impacts that cause impacts
 * at the same moment. */
#include "command.h"
#include "contacts.h"
#include "derived.h"
#include "motion.h"

/* === suite contact_moments ==================================================================== */

static const engine_kind *const KINDS[] = {&engine_double, &engine_float};

/* A ball that bounces for ever, with flights of `share` of a step. Every bounce must be counted and keep the energy.
 * The floor is at 0, because at another height float has no digits for flights of 1e-7 m. */
static void hop(double share, double mass, double gravity, const engine_kind *kind) {
    char text[600];
    motion m;
    double total[16] = {0.0};
    double left[4] = {0.0};
    const double h = 1e-3;
    const double speed = 0.5 * gravity * share * h;
    snprintf(
        text, sizeof text,
        "mechanism ball\ncoordinate y [m]\nT = %.17g [kg]*y'^2/2\nV = %.17g [N]*y\n"
        "stop y >= 0 restitution 1\n"
        "scene s {\n  with ledger\n  start y' = %.17g [m/s]\n  step 1 [ms]\n  until 5 [s]\n}\n",
        mass, mass * gravity, speed);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4});
    motion_to(&m, 5.0);
    const double hops = 5.0 / (share * h);
    const bool fine = kind == &engine_double;
    expect_between("impacts less hops", fine ? -1.5 : -1e-3 * hops, fine ? 1.0 : 1e-3 * hops,
                   (double)contacts_events(&m) - hops);
    TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
    m.kind->ledger(m.run, total, left);
    const double energy = 0.5 * mass * speed * speed;
    expect_between("left over, of the energy", fine ? -1e-11 : -2e-3, fine ? 1e-11 : 2e-3,
                   left[0] / energy);
    motion_close(&m);
}

TEST(contact_moments, hops_shorter_than_a_step) {
    uint64_t seed = 5;
    for (int i = 0; i < 12; i++) {
        const double share = random_between(&seed, 0.145, 1.2);
        const double mass = exp(random_between(&seed, -3.0, 3.0));
        const double gravity = exp(random_between(&seed, 0.0, 4.0));
        printf("  hops of %.3f h, %.3f kg, %.3f m/s2\n", share, mass, gravity);
        hop(share, mass, gravity, KINDS[i % 2]);
    }
}

/* A ball bounces until it rests. Its last gap must be closed and its last energy entered, so that the balance has no
 * residual beyond this energy. */
TEST(contact_moments, last_gap_is_in_the_ledger) {
    uint64_t seed = 6;
    for (int i = 0; i < 20; i++) {
        char text[600];
        motion m;
        double total[16] = {0.0};
        double left[4] = {0.0};
        const double slope = i % 2 ? random_between(&seed, -0.8, 0.8) : 0.0;
        snprintf(text, sizeof text,
                 "mechanism ball\ncoordinate y [m]\ncoordinate x [m]\nT = 1 [kg]*(y'^2 + x'^2)/2\n"
                 "V = 9.81 [N]*y\nstop y + %.17g*x >= 0 restitution %.17g\n"
                 "scene s {\n  with ledger\n  start y = %.17g [m], x' = %.17g [m/s]\n"
                 "  step %.17g [ms]\n  until 2 [s]\n}\n",
                 slope, random_between(&seed, 0.1, 0.6), random_between(&seed, 1e-4, 0.3),
                 random_between(&seed, -1.0, 1.0), random_between(&seed, 0.3, 8.0));
        motion_open_text(&m, text, IN_DOUBLE);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, m.instance->steps));
        m.kind->ledger(m.run, total, left);
        expect_between("left over, J, of up to 100", -1e-11, 1e-11, left[0]);
        motion_close(&m);
    }
}

enum { BODIES = 4 };

typedef struct chain {
    double mass[BODIES], speed[BODIES], restitution;
} chain;

/* Applies impacts between neighbours until no pair closes. Returns the number of impacts. *first_Ns: the sum of the
 * impulses on body 0. */
static int collide(chain *c, double *first_Ns) {
    int count = 0;
    bool again = true;
    *first_Ns = 0.0;
    while (again && count < 50) {
        again = false;
        for (int i = 0; i + 1 < BODIES; i++) {
            const double closing = c->speed[i] - c->speed[i + 1];
            if (closing > 1e-12) {
                const double impulse =
                    (1.0 + c->restitution) * closing / (1.0 / c->mass[i] + 1.0 / c->mass[i + 1]);
                c->speed[i] -= impulse / c->mass[i];
                c->speed[i + 1] += impulse / c->mass[i + 1];
                *first_Ns += i == 0 ? impulse : 0.0;
                again = true;
                count++;
            }
        }
    }
    return count;
}

/* The lower body stands on the floor, and the upper one hits it. Then a strong force pulls the lower body up before
 * the step ends. The impact on the floor must still be found. */
TEST(contact_moments, impact_that_ends_within_a_step) {
    uint64_t seed = 8;
    for (int i = 0; i < 40; i++) {
        const double u = random_between(&seed, 0.2, 1.0);
        const double e = random_between(&seed, 0.2, 0.9);
        double mass[2] = {exp(random_between(&seed, -1.0, 1.0)), 0.0};
        /* light enough that the upper body does not hit again */
        mass[1] = random_between(&seed, 0.05, 0.3) * e * mass[0];
        chain c = {{1e300, mass[0], mass[1], 1.0}, {0.0, 0.0, -u, 1e300}, e};
        double floor_Ns;
        if (collide(&c, &floor_Ns) > 6) {
            continue;
        }
        /* the pull lifts the body within the step, but so slowly that the flight is too long to count as rest */
        const double down = (1.0 + e) * u * mass[1] / (mass[0] + mass[1]);
        const double pull = random_between(&seed, 4.0, 10.0) * mass[0] * down / 1e-3;
        const char *const stops[] = {"stop low >= 0 restitution %.17g\n",
                                     "stop high - low >= 0.25 [m] restitution %.17g\n"};
        char text[900];
        int at = snprintf(text, sizeof text,
                          "mechanism pair\ncoordinate low [m]\ncoordinate high [m]\n"
                          "T = (%.17g [kg]*low'^2 + %.17g [kg]*high'^2)/2\nQ(low) = %.17g [N]\n",
                          mass[0], mass[1], pull);
        for (int k = 0; k < 2; k++) {
            at += snprintf(text + at, sizeof text - (size_t)at, stops[(k + i) % 2], e);
        }
        snprintf(text + at, sizeof text - (size_t)at,
                 "scene s {\n  with ledger\n  start high = 0.25 [m], high' = %.17g [m/s]\n"
                 "  step 1 [ms]\n  until 1 [s]\n}\n",
                 -u);
        for (int n = 0; n < 2; n++) {
            double total[32] = {0.0};
            double left[8] = {0.0};
            motion m;
            motion_open_text(&m, text, (stepping){.kind = KINDS[n], .method = WH_RK4});
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            m.kind->ledger(m.run, total, left);
            double booked = 0.0;
            for (int k = 0; k < 32; k++) {
                booked = fabs(total[k] - floor_Ns) < fabs(booked - floor_Ns) ? total[k] : booked;
            }
            expect_between("floor's impulse over what it must be", n ? 0.9999 : 1.0 - 1e-9,
                           n ? 1.0001 : 1.0 + 1e-9, booked / floor_Ns);
            motion_close(&m);
        }
    }
}

/* === suite contact_scenes ===================================================================== */
/* Every scene with contacts, some with several on one mechanism. References come from another program, which locates
 * event by event (tests/reference/contacts.txt).
 *
 * The location uses a cubic and the method has order 4, so errors fall with h^4. The test asks for order 3, because
 * the errors of many events may cancel at one step. */

/* Error of the references: two of their runs differ by up to 5e-10, which contacts.py prints. */
#define REFERENCE_ERROR 1e-9

typedef struct reference_case {
    const char *name;
    const char *time;
    double time_s;
    double step_s;     /* the coarse step; the fine step is a quarter */
    double error_most; /* bound on the error with the fine step, in double */
    /* bound with the scene's own step in float: round-off of all steps, amplified by the events */
    double error_float;
} reference_case;

static const reference_case CASES[] = {
    {"hopper_hops", "0.05", 0.05, 5e-3, 1e-8, 2e-4},
    {"table_slips", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"table_drifts", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"belt_stick_slip", "5.0", 5.0, 8e-3, 1e-7, 2e-4},
    {"belt_stiffening", "5.0", 5.0, 8e-3, 1e-7, 2e-4},
    {"plank_shaken", "5.0", 5.0, 4e-3, 1e-8, 1e-2},
    {"crash_cart", "3.0", 3.0, 8e-3, 1e-6, 2e-4},
    {"crash_both", "3.0", 3.0, 8e-3, 1e-6, 2e-4},
    {"shuttle_buffers", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"shuttle_clamped", "5.0", 5.0, 8e-3, 1e-8, 2e-4},
    {"escapement_ticks", "60.0", 60.0, 8e-3, 1e-5, 1e-2},
    {"carriage_stop", "5.0", 5.0, 4e-3, 1e-6, 1e-2},
    {"carriage_stop_smooth", "5.0", 5.0, 4e-3, 1e-6, 1e-2},
    {"carriage_stop_start", "5.0", 5.0, 4e-3, 2e-9, 1e-2},
    {"thomson_magnet", "5.0", 5.0, 1e-3, 1e-6, 1e-2},
    {"halvorson_ground", "1.0", 1.0, 4e-4, 1e-5, 1e-2},
    {"halvorson_smooth", "1.0", 1.0, 4e-4, 1e-5, 1e-2},
};

enum { CASE_COUNT = sizeof CASES / sizeof CASES[0] };

static double error_of(const reference_case *c, stepping how) {
    motion m;
    motion_open(&m, c->name, how);
    motion_to(&m, c->time_s);
    const double error = motion_error(&m, "tests/reference/contacts.txt", c->name, c->time);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, contacts_overruns(&m), c->name);
    motion_close(&m);
    return error;
}

TEST(contact_scenes, every_scene_meets_its_reference) {
    for (unsigned i = 0; i < CASE_COUNT; i++) {
        const reference_case *c = &CASES[i];
        const double coarse = error_of(c, IN_DOUBLE_STEP(c->step_s));
        const double fine = error_of(c, IN_DOUBLE_STEP(c->step_s / 4.0));
        const double order = log2(coarse / fine) / 2.0;
        printf("  %-22s error %.2e at %g ms, %.2e at %g ms: order %.2f\n", c->name, coarse,
               1e3 * c->step_s, fine, 250.0 * c->step_s, order);
        TEST_ASSERT_TRUE_MESSAGE(fine <= c->error_most, c->name);
        TEST_ASSERT_TRUE_MESSAGE(coarse > 1e-14, c->name); /* a smaller error shows no order */
        TEST_ASSERT_TRUE_MESSAGE(order >= 3.0 || fine <= REFERENCE_ERROR, c->name);
        const double in_float = error_of(c, IN_FLOAT);
        TEST_ASSERT_TRUE_MESSAGE(in_float <= c->error_float && in_float > 1e-9, c->name);
    }
}

/* === suite contact_squeezed =================================================================== */
/* More impacts than a step allows: a light body is hit ever faster between heavier bodies and walls, or between
 * slanting walls. Bodies must pass through nothing and gain no energy. With friction, all moving bodies must lose
 * energy. */

enum { CONTACT_SQUEEZED_BODIES = 4, STEPS = 300, TEXT = 4000 };

/* A quantity of the present state: the smallest gap of the stops, m, or the energy (all kinetic), J. */
typedef double look(const void *of, const motion *m);

typedef struct watched {
    const void *of;
    look *least_gap;
    look *energy;
    bool rubs; /* friction acts on every coordinate, so that moving bodies lose energy */
    int steps;
    double bound_m[2];  /* allowed penetration, in double and in float */
    double rounding[2]; /* allowed rise of the energy, relative to the start */
} watched;

/* Runs a scene in double or float and checks gaps and energy. Returns the number of overruns. */
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

static void watch_many(uint64_t run(uint64_t seed, double *deepest_m)) {
    const long runs = (long)dice_cases(100);
    uint64_t overruns = 0;
    double deepest_m[2] = {0.0, 0.0};
    for (long i = 1; i <= runs; i++) {
        overruns += run((uint64_t)i * 0x9e3779b97f4a7c15U, deepest_m);
    }
    printf("seeds 1 to %ld: beyond a stop by at most %.1e m, in float %.1e m; %llu overruns\n",
           runs, -deepest_m[0], -deepest_m[1], (unsigned long long)overruns);
    TEST_ASSERT_TRUE(overruns > 0); /* without overruns the test would be empty */
}

/* A row of bodies between two walls. The only force is friction. */
typedef struct row {
    int n;
    double mass_kg[CONTACT_SQUEEZED_BODIES];
    double place_m[CONTACT_SQUEEZED_BODIES];
    double speed_mps[CONTACT_SQUEEZED_BODIES];
    double end_m; /* position of the second wall; the first is at 0 */
    double restitution[CONTACT_SQUEEZED_BODIES + 1];
    double normal_N; /* 0: no friction */
} row;

static row row_drawn(uint64_t seed) {
    row r = {.n = 2 + (int)(random_bits(&seed) % (CONTACT_SQUEEZED_BODIES - 1))};
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

static uint64_t run_row(uint64_t seed, double *deepest_m) {
    const row r = row_drawn(seed);
    const watched w = {&r,    row_gap_m,     row_energy_J, r.normal_N > 0.0,
                       STEPS, {1e-12, 1e-7}, {1e-13, 1e-6}};
    char text[TEXT];
    row_text(&r, text);
    return watch(&w, text, false, deepest_m) + watch(&w, text, true, deepest_m);
}

TEST(contact_squeezed, rows_of_bodies_stay_ordered) { watch_many(run_row); }

enum { WALLS_MOST = 5, CAGE_STEPS = 60 };

/* A body with two coordinates and any mass matrix, between walls around the origin, without friction or with
 * friction in both directions. */
typedef struct cage {
    double mass_kg[3]; /* entries xx, xy and yy of the mass matrix */
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

TEST(contact_squeezed, bodies_stay_in_a_cage) { watch_many(run_cage); }

/* === suite crossings ========================================================================== */
/* Several crossings with a `set`. Each must do its own `set`, at its own time. */

/* A body falls to or past a level under a pull of either sign. A crossing sets its rate to k x' + c, mostly in the
 * opposite direction. Each reversal must count as one crossing; the error of location must not cause another.
 * Between crossings the motion is a parabola, whose crossing times are known. */
typedef struct bounce {
    int direction; /* direction of the crossing: +1 rising, -1 falling, 0 both */
    double pull;   /* downwards, m/s^2 */
    double k;
    double c_mps;
    double x_m; /* height above the level */
    double v_mps;
} bounce;

enum { HITS_MOST = 12, HITS_IN_STEP = 5 };

/* Time until the next crossing; infinity if there is none. A body at the level first leaves the level. */
static double next_hit_s(const bounce *b) {
    if (b->x_m == 0.0) {
        const double back_s = b->pull == 0.0 ? -1.0 : 2.0 * b->v_mps / b->pull;
        return back_s > 0.0 ? back_s : (double)INFINITY;
    }
    if (b->pull == 0.0) {
        return b->x_m * b->v_mps < 0.0 ? -b->x_m / b->v_mps : (double)INFINITY;
    }
    const double root = b->v_mps * b->v_mps + 2.0 * b->pull * b->x_m;
    if (root < 0.0) {
        return (double)INFINITY;
    }
    const double first = (b->v_mps - sqrt(root)) / b->pull;
    const double second = (b->v_mps + sqrt(root)) / b->pull;
    const double low = fmin(first, second);
    const double high = fmax(first, second);
    return low > 0.0 ? low : high > 0.0 ? high : (double)INFINITY;
}

/* Moves the body until end_s and writes the crossing times to at[]. Returns their number; -1 if there are too many,
 * or if the body is still near the level at the end of a step with a crossing. */
static int go(bounce *b, double end_s, double step_s, double *at) {
    double time_s = 0.0;
    int hits = 0;
    for (;;) {
        const double next_s = next_hit_s(b);
        const double span_s = fmin(next_s, end_s - time_s);
        b->x_m = next_s <= end_s - time_s
                     ? 0.0
                     : b->x_m + b->v_mps * span_s - 0.5 * b->pull * span_s * span_s;
        b->v_mps -= b->pull * span_s;
        time_s += span_s;
        if (b->x_m != 0.0) {
            return hits;
        }
        const double rest_s = (floor(time_s / step_s) + 1.0) * step_s - time_s;
        const double beyond_m = b->v_mps * rest_s - 0.5 * b->pull * rest_s * rest_s;
        if (beyond_m * b->v_mps < 1e-4 * fabs(b->v_mps)) {
            return -1;
        }
        const bool taken = b->direction == 0 || (b->direction > 0) == (b->v_mps > 0.0);
        if (taken) {
            b->v_mps = b->k * b->v_mps + b->c_mps;
            at[hits++] = time_s;
        }
        if (hits == HITS_MOST || fabs(b->v_mps) < 0.02) {
            return -1;
        }
    }
}

TEST(crossings, reversed_motion_crosses_once) {
    static const char *const words[] = {" falling", "", " rising"};
    static const char *const values[] = {"x crosses 2 [m]", "3*x - 4 [m] crosses 2 [m]",
                                         "x*abs(x)/(2 [m]) crosses 2 [m]"};
    dice d = dice_of("what turns back", 5519);
    unsigned taken = 0;
    unsigned crowded = 0;
    for (unsigned i = 0; i < dice_cases(usual_or(1200, 600)); i++) {
        bounce b = {.direction = (int)dice_one_of(&d, 3) - 1,
                    .pull = dice_one_of(&d, 4) == 0 ? 0.0 : dice_between(&d, -10.0, 10.0),
                    .k = dice_one_of(&d, 4) == 0 ? dice_between(&d, 0.2, 1.5)
                                                 : dice_between(&d, -1.5, -0.2),
                    .c_mps = dice_one_of(&d, 3) == 0 ? dice_between(&d, -1.0, 1.0) : 0.0,
                    .x_m = dice_between(&d, -1.0, 1.0) * dice_between(&d, 0.0, 1.5),
                    .v_mps = dice_between(&d, -2.0, 2.0)};
        const double step_s = pow(10.0, dice_between(&d, -2.5, 0.3));
        const int steps = 2 + (int)(dice_between(&d, 1.0, 4.0) / step_s);
        double at_s[HITS_MOST];
        char text[900];
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N]*x\n"
            "when %s%s { set x' = %.17g*x' + %.17g [m/s] }\n"
            "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [m]\nstart x' = %.17g [m/s]\n}\n",
            b.pull, values[i % 3], words[b.direction + 1], b.k, b.c_mps, step_s, step_s * steps,
            2.0 + b.x_m, b.v_mps);
        const int hits = go(&b, step_s * steps, step_s, at_s);
        bool shared = false;
        bool twice = false;
        for (int k = 1; k < hits; k++) {
            twice = twice || at_s[k] - at_s[k - 1] < 0.5 * step_s;
        }
        for (int k = HITS_IN_STEP; k < hits; k++) {
            shared = shared || at_s[k] - at_s[k - HITS_IN_STEP] < step_s;
        }
        if (hits < 1 || shared) {
            continue;
        }
        taken++;
        crowded += twice ? 1U : 0U;
        motion m;
        motion_open_text(&m, text, i / 3 % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        const double allowed = i / 3 % 2 == 0 ? 1e-8 : 2e-2 * (1.0 + fabs(b.x_m));
        TEST_ASSERT_EQUAL_INT_MESSAGE(hits, (int)contacts_events(&m), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(allowed, 2.0 + b.x_m, motion_value(&m, "x"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(allowed, b.v_mps, motion_value(&m, "x'"), text);
        motion_close(&m);
    }
    printf("  %u bodies that cross a level and may turn back, %u of them twice within a step\n",
           taken, crowded);
    TEST_ASSERT_TRUE(taken > 10 && crowded > 1);
}

/* A body comes to rest at a crossing's level, with or without friction, until another crossing moves it on or back.
 * This must count as one crossing. Half a metre further the body crosses a second level, which counts, too. */
TEST(crossings, rest_at_a_crossings_level) {
    dice d = dice_of("what stands", 5521);
    for (unsigned i = 0; i < dice_cases(usual_or(300, 60)); i++) {
        char text[900];
        const double level_m = dice_one_of(&d, 4) == 0 ? 0.0 : dice_between(&d, -1.0, 1.0);
        const double speed_mps = dice_between(&d, 0.8, 3.0);
        const double away_m = dice_between(&d, 0.05, 0.35);
        const double side = dice_one_of(&d, 2) == 0 ? 1.0 : -1.0;
        const double then_mps = dice_between(&d, 1.5, 3.0) * (dice_one_of(&d, 2) == 0 ? 1.0 : -1.0);
        const double moved_s = dice_between(&d, 0.5, 0.6);
        const bool rubs = dice_one_of(&d, 2) == 0;
        const char *direction = dice_one_of(&d, 2) == 0 ? "" : side > 0.0 ? "rising" : "falling";
        const double step_s = 0.001 * (1.0 + dice_one_of(&d, 20));
        const int steps = (int)(1.0 / step_s);
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"
            "T = 1 [kg]*(x'^2 + y'^2)/2\n%s"
            "when x crosses %.17g [m] %s { set x' = 0 [m/s] }\n"
            "when y crosses 0 [m] rising { set x' = %.17g [m/s] }\n"
            "when x crosses %.17g [m] { set x' = x' }\n"
            "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [m], x' = %.17g [m/s]\n"
            "start y = %.17g [m], y' = 1 [m/s]\n}\n",
            rubs ? "friction x static 1 kinetic 1 normal 1e-5 [N]\n" : "", level_m, direction,
            then_mps, level_m + 0.5 * side, step_s, step_s * steps, level_m - away_m * side,
            speed_mps * side, -moved_s);
        motion m;
        motion_open_text(&m, text, i % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        const double way_m = then_mps * (step_s * steps - moved_s);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4, level_m + way_m, motion_value(&m, "x"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4, then_mps, motion_value(&m, "x'"), text);
        const int on = way_m * side > 0.5;
        TEST_ASSERT_EQUAL_INT_MESSAGE(2 + on + (rubs ? 1 : 0), (int)contacts_events(&m), text);
        motion_close(&m);
    }
}

/* A crossing sets a body exactly onto the level of another crossing, and the body moves on or back. Only a level
 * that the motion passes is crossed. So the second level counts neither when the body is set onto it nor when the
 * body leaves. */
TEST(crossings, set_onto_another_crossings_level) {
    dice d = dice_of("set onto", 5522);
    unsigned passed = 0;
    for (unsigned i = 0; i < dice_cases(usual_or(300, 60)); i++) {
        char text[900];
        const bool turns = dice_one_of(&d, 2) == 0;
        const double side = dice_one_of(&d, 2) == 0 ? 1.0 : -1.0;
        const double from = dice_between(&d, -1.0, 1.0);
        const double level = from + 0.3 * side;
        const double far = dice_between(&d, 0.05, 0.25);
        const double onto = level + (dice_one_of(&d, 2) == 0 ? far : -far);
        const double speed = side * dice_between(&d, 1.0, 3.0);
        const double then = dice_one_of(&d, 2) == 0 ? speed : -0.7 * speed;
        const unsigned way = (unsigned)dice_one_of(&d, 3); /* direction: 0 both, 1 up, 2 down */
        const int steps = 10 + (int)dice_one_of(&d, 200);
        const double end_s = 0.3 / fabs(speed) + 0.5 * far / fabs(then);
        const double step_s = end_s / steps;
        const char *unit = turns ? "rad" : "m";
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [%s]\nT = 1 [%s]*x'^2/2\n%s"
                 "when x crosses %.17g [%s] %s { set x = %.17g [%s], x' = %.17g [%s/s] }\n"
                 "when x crosses %.17g [%s] %s { set x' = x' }\n"
                 "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [%s], "
                 "x' = %.17g [%s/s]\n}\n",
                 unit, turns ? "kg*m^2" : "kg", turns ? "V = 1e-9 [J]*cos(x)\n" : "", level, unit,
                 side > 0.0 ? "rising" : "falling", onto, unit, then, unit, onto, unit,
                 way == 0   ? ""
                 : way == 1 ? "rising"
                            : "falling",
                 step_s, step_s * steps, from, unit, speed, unit);
        motion m;
        motion_open_text(&m, text, i % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        const bool passes = (onto - level) * side < 0.0 && (way == 0 || (way == 1) == (side > 0.0));
        passed += passes;
        TEST_ASSERT_EQUAL_INT_MESSAGE(1 + passes, (int)contacts_events(&m), text);
        const double end = onto + then * 0.5 * far / fabs(then);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4, end, motion_value(&m, "x"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4, then, motion_value(&m, "x'"), text);
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(passed > 5);
}

/* Each elastic bounce reverses the rate and so crosses the level upwards. Then gravity lowers the rate through the
 * level again: two crossings per bounce. */
TEST(crossings, impacts_across_a_rates_level) {
    dice d = dice_of("thrown across", 5523);
    unsigned bounced = 0;
    for (unsigned i = 0; i < dice_cases(usual_or(300, 60)); i++) {
        char text[900];
        const double height_m = dice_between(&d, 0.05, 0.5);
        const double g_mps2 = dice_between(&d, 1.0, 10.0);
        const double hit_mps = sqrt(2.0 * g_mps2 * height_m);
        const double level_mps = -hit_mps * dice_between(&d, 0.1, 0.9);
        const double step_s = 0.001 * (1.0 + dice_one_of(&d, 10));
        const int steps = (int)(3.0 / step_s);
        const double fall_s = hit_mps / g_mps2;
        const double passes_s = -level_mps / g_mps2;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nQ(x) = %.17g [N]\n"
                 "stop x >= 0 [m] restitution 1\nwhen x' crosses %.17g [m/s] { set x' = x' }\n"
                 "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [m]\n}\n",
                 -g_mps2, level_mps, step_s, step_s * steps, height_m);
        /* falls for fall_s; then each bounce takes 2 fall_s */
        const double end_s = step_s * steps;
        const int hits = end_s < fall_s ? 0 : 1 + (int)((end_s - fall_s) / (2.0 * fall_s));
        const double since_s = end_s - (hits == 0 ? 0.0 : fall_s + 2.0 * fall_s * (hits - 1));
        const double due_s = hits == 0 ? passes_s : fall_s + passes_s;
        const double next_s = hits == 0 ? fall_s : 2.0 * fall_s;
        if (fabs(since_s - due_s) < 1e-2 || since_s < 1e-2 || next_s - since_s < 1e-2) {
            continue; /* too near an event to decide in float */
        }
        motion m;
        motion_open_text(&m, text, i % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        bounced += hits > 1;
        TEST_ASSERT_EQUAL_INT_MESSAGE(3 * hits + (since_s > due_s), (int)contacts_events(&m), text);
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(bounced > 10);
}
