/* test_prove.c: the tube of `whirl prove` contains the exact motion at every record. References of 113 bits share
 * nothing with the program (quad_arms.h). With a parameter wrong by a millionth, the motion leaves the tube. */
#include "beside.h"
#include "command.h"
#include "horizons.h"

#define PARTS(above, below) ((quad)(above) / (quad)(below))

static quad_arms epicyclic(quad r) {
    const quad m = 2;
    quad_arms a = {.coordinates = 2, .carriage = 1, .bodies = 2};
    a.body[0] = (quad_body){m, 0, {{0, 0, 0}}};
    a.body[1] = (quad_body){m, 1, {{2 * r, 1, 0}}};
    a.spin_kgm2[0] = 4 * m * r * r / 2; /* turns twice as fast as the arm */
    a.load[0] = 2;
    return a;
}

/* Sun gear on the carriage, planet gear on the arm, disc on its rim. */
static quad_arms thomson(quad r) {
    const quad m = 2;
    quad_arms a = {.coordinates = 3, .carriage = 2, .bodies = 3};
    a.body[0] = (quad_body){m, 0, {{0, 0, 0}}};
    a.body[1] = (quad_body){m, 1, {{2 * r, 1, 0}}};
    a.body[2] = (quad_body){m, 3, {{2 * r, 1, 0}, {r, 2, 0}, {r, 1, 1}}};
    a.spin_kgm2[0] = 4 * m * r * r / 2;
    a.load[0] = -2;
    return a;
}

static quad_arms double_pendulum(quad l1) {
    quad_arms a = {.coordinates = 2, .carriage = -1, .bodies = 2, .gravity_mps2 = PARTS(981, 100)};
    a.body[0] = (quad_body){PARTS(3, 2), 1, {{l1, 1, 0}}};
    a.body[1] = (quad_body){PARTS(7, 10), 2, {{l1, 1, 0}, {PARTS(1, 2), 1, 1}}};
    return a;
}

typedef struct scene_case {
    const char *name;
    bool builtin;
    const char *file;
    const char *starts;
    quad_arms (*by_hand)(quad length_m);
    quad length_m;
    quad start[QUAD_STATES];
    const char *step;
    quad step_s;
    double usual_s; /* for make test */
    double until_s; /* for make check */
} scene_case;

static char *text_of(const scene_case *c, double until_s) {
    char more[600];
    snprintf(more, sizeof more,
             "\nscene proved {\n  use %s\n  start %s\n  step %s\n  until %g [s]\n}\n", c->name,
             c->starts, c->step, until_s);
    return c->builtin ? horizons_builtin(c->file, more) : horizons_file(c->file, more);
}

/* Runs until `until_s` against a reference whose length has this relative error. */
static containment_found hold_scene(const scene_case *c, double until_s, double part, beside *b) {
    const quad_arms of = c->by_hand(c->length_m * (1 + (quad)part));
    *b = (beside){.slopes = quad_arms_slopes, .of = &of, .step_s = c->step_s};
    memcpy(b->state, c->start, sizeof c->start);
    char *text = text_of(c, until_s);
    const containment_found h = beside_hold(text, "proved", &engine_double, b);
    free(text);
    return h;
}

/* The true motion stays inside to the end. One wrong by a millionth leaves early, where the tube is narrow. */
static void expect_proved(const scene_case *c, double widest) {
#ifdef QUAD_KNOWN
    beside b;
    const double until_s = few_or_all(0, 1) == 1 ? c->until_s : c->usual_s;
    containment_found h = hold_scene(c, until_s, 0.0, &b);
    printf("  %-20s %g s: %u records inside, widest %.2e, %u steps of the tube\n", c->name, until_s,
           (unsigned)b.records, b.widest, (unsigned)h.flowpipe_steps);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, b.outside, c->name);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(h.run_steps, b.records, c->name);
    TEST_ASSERT_TRUE_MESSAGE(b.widest < widest && b.widest > 1e-15, c->name);
    for (int i = 0; i < h.states; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(CONTAINMENT_TO_THE_END, h.state[i].verdict, c->name);
    }
    containment_free(&h);
    static const double parts[] = {1e-6, -1e-6, 1e-12};
    for (int i = 0; i < 3; i++) {
        h = hold_scene(c, 0.1, parts[i], &b);
        printf("    off by %.0e: outside from record %u on, widest %.2e\n", parts[i],
               (unsigned)b.outside, b.widest);
        TEST_ASSERT_TRUE_MESSAGE(b.outside > 0 && b.widest < 1e-13, c->name);
        containment_free(&h);
    }
#else
    (void)c;
    (void)widest;
    TEST_IGNORE_MESSAGE("no numbers of 113 bits here");
#endif
}

TEST(prove, epicyclic) {
    const scene_case c = {.name = "epicyclic",
                          .builtin = true,
                          .file = "epicyclic.whirl",
                          .starts = "theta = 0, X = 0, theta' = 0, X' = 0",
                          .by_hand = epicyclic,
                          .length_m = PARTS(3, 10),
                          .step = "10 [ms]",
                          .step_s = PARTS(1, 100),
                          .usual_s = 1.0,
                          .until_s = 9.0};
    expect_proved(&c, 1e-9);
}

TEST(prove, double_pendulum) {
    const scene_case c = {.name = "double_pendulum",
                          .file = "tests/mechanisms/double_pendulum.whirl",
                          .starts = "a = 2.5 [rad], b = 2 [rad]",
                          .by_hand = double_pendulum,
                          .length_m = PARTS(4, 5),
                          .start = {PARTS(5, 2), 0, 2, 0},
                          .step = "5 [ms]",
                          .step_s = PARTS(1, 200),
                          .usual_s = 0.75,
                          .until_s = 6.0};
    expect_proved(&c, 1e-6);
}

TEST(prove, thomson) {
    const scene_case c = {.name = "thomson",
                          .builtin = true,
                          .file = "thomson.whirl",
                          .starts =
                              "theta1 = 0, theta2 = 0, X = 0, theta1' = 0, theta2' = 0, X' = 0",
                          .by_hand = thomson,
                          .length_m = PARTS(3, 10),
                          .step = "5 [ms]",
                          .step_s = PARTS(1, 200),
                          .usual_s = 0.5,
                          .until_s = 5.0};
    expect_proved(&c, 1e-6);
}
