/* test_angle_places.c: fractions of an angle in every place where the language accepts an angle. A fraction in the
 * equations of motion, a contact or an event makes the coordinate a real. A fraction elsewhere, such as in an output,
 * changes neither the run nor the other outputs. */
#include "derived.h"
#include "host/engine/engine.h"
#include "motion.h"

static const struct {
    const char *text;
    double times;
} multiples[] = {{"th", 1},           {"2*th", 2},       {"-3*th", -3},
                 {"th/2", 0.5},       {"3*th/2", 1.5},   {"th/3", 1.0 / 3},
                 {"1.5*th", 1.5},     {"0.37*th", 0.37}, {"th*sqrt(2)", 1.4142135623730951},
                 {"100.5*th", 100.5}, {"th/1000", 1e-3}};
enum { MULTIPLES = sizeof multiples / sizeof multiples[0] };

enum { NOWHERE, IN_STEP, IN_SIGNALS };

/* @ stands for a row of `multiples`. Result 0 of the list is then scale * function(multiple) + offset. */
static const struct {
    const char *text;
    int list;
    bool sine;
    bool scaled; /* scaled by the number of the multiple */
    double offset;
} places[] = {
    {"V = 1 [J]*cos(@)\n", IN_STEP, true, true, 0},
    {"Q(th) = 1 [N*m]*cos(@)\n", IN_STEP, false, false, 0},
    {"Q(x) = 1 [N]*abs(cos(@))\n", NOWHERE, false, false, 0},
    {"V = 1 [J]*tan(@)/(3 + cos(@))\n", NOWHERE, false, false, 0},
    {"F = 0.1 [N*s/m]*x'^2*(2 + sin(@))\n", NOWHERE, false, false, 0},
    {"stop cos(@) >= -2 restitution 0.5\n", IN_SIGNALS, false, false, 2},
    {"stop x <= 1e6 [m] restitution (2 + sin(@))/4\n", NOWHERE, false, false, 0},
    {"hold x while cos(@) > 5\n", IN_SIGNALS, false, false, -5},
    {"hold x - sin(@)*1 [m] while x > 1e6 [m]\n", NOWHERE, false, false, 0},
    {"when cos(@) crosses 5 { set x = 0 }\n", IN_SIGNALS, false, false, -5},
    {"when x crosses 1e6 [m] { set x' = sin(@)*1 [m/s] }\n", NOWHERE, false, false, 0},
    {"friction x static 0.4 kinetic 0.3 normal 2 [N]*(2 + cos(@))\n", NOWHERE, false, false, 0},
    {"friction x static 0.5 + 0.1*cos(@) kinetic 0.3 normal 2 [N]\n", NOWHERE, false, false, 0},
    {"friction x static 0.5 kinetic 0.3 + 0.1*cos(@) normal 2 [N]\n", NOWHERE, false, false, 0}};

static void check_place(const derived *d, size_t which, double times, const char *text) {
    const bool in_step = places[which].list == IN_STEP;
    double result[64];
    state_values s = {.instance = d->instance};
    uint64_t seed = which;
    for (int i = 0; i < 10; i++) {
        const double th = random_between(&seed, -5000.0, 5000.0);
        s.value[0][0] = th;
        derived_run(in_step ? d->image->list[IMAGE_STEP] : d->image->list[IMAGE_SIGNALS], d, &s,
                    result);
        /* if th is an angle, it is the only one and its acceleration comes first */
        const double got = result[in_step ? d->image->place[0] : 0];
        const double trig_value = places[which].sine ? sin(times * th) : cos(times * th);
        const double wanted =
            (places[which].scaled ? times : 1.0) * trig_value + places[which].offset;
        TEST_ASSERT_TRUE_MESSAGE(fabs(got - wanted) <=
                                     1e-15 * (8.0 + 4.0 * fabs(times * th)) * (1.0 + fabs(times)),
                                 text);
    }
}

/* A coordinate is kept as a turn angle only if all places that act on the motion use integer multiples. */
TEST(angle_places, all_that_acts_takes_part) {
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++) {
        for (int i = 0; i < MULTIPLES; i++) {
            char text[512];
            char *at = text;
            at += sprintf(at, "mechanism m\ncoordinate th [rad]\ncoordinate x [m]\n"
                              "T = 0.5 [kg*m^2]*th'^2 + 0.5 [kg]*x'^2\n");
            for (const char *c = places[k].text; *c != '\0'; c++) {
                at += *c == '@' ? sprintf(at, "%s", multiples[i].text) : sprintf(at, "%c", *c);
            }
            derived d = derived_text(text);
            derived_expect(&d, text);
            const bool whole = multiples[i].times == floor(multiples[i].times);
            TEST_ASSERT_EQUAL_INT_MESSAGE(whole ? 1 : 0, d.image->angles, text);
            TEST_ASSERT_FALSE_MESSAGE(op_list_reads_turns(d.image->list[IMAGE_STEP]), text);
            if (places[k].list != NOWHERE) {
                check_place(&d, k, multiples[i].times, text);
            }
            derived_free(&d);
        }
    }
}

static const char pendulums[] =
    "mechanism m\ncoordinate th [rad]\ncoordinate ph [rad]\n"
    "T = 0.5 [kg*m^2]*(th'^2 + ph'^2) + 0.1 [kg*m^2]*th'*ph'*cos(th - ph)\nV = -2 [J]*cos(th)\n"
    "output double_angle = sin(2*th)\noutput sum = cos(th + 3*ph)*sin(ph)\n"
    "output small = 1 - cos(2*ph)\n";
static const char scene_of_them[] =
    "scene s { start th = 6283, ph = -4e4, th' = 3 [rad/s], ph' = -40 [rad/s]; until 0.2 [s] }\n";
enum { NEIGHBOURS = 3 };

static uint64_t run_to(const char *more, const engine_kind *kind, double *output) {
    char text[1200];
    snprintf(text, sizeof text, "%s%s%s", pendulums, more, scene_of_them);
    derived d = derived_scene(text, "s");
    derived_expect(&d, more);
    const image *p = d.image;
    TEST_ASSERT_EQUAL_INT_MESSAGE(2, p->angles, more);
    void *run = kind->start(p);
    for (int i = 0; i < 200; i++) {
        TEST_ASSERT_TRUE(kind->step(run) == WH_OK);
    }
    TEST_ASSERT_TRUE(p->outputs <= 16);
    kind->outputs(run, output);
    const uint64_t hash = kind->hash(run) ^ p->hash;
    kind->stop(run);
    derived_free(&d);
    return hash;
}

TEST(angle_places, outputs_leave_all_else_alone) {
    static const engine_kind *const kinds[] = {&engine_double, &engine_float};
    static const char *const outputs[] = {
        "output h = cos(th/2)\n",
        "output h = sin(1.5*th)\n",
        "output h = sin(1.5*th)\noutput g = cos(th/2)\n", /* 2 th is the sum of both */
        "output h = tan(th/2) + tan(ph/3)\n",
        "output h = sin(th/3 + 2*ph)*exp(1)\n",
        "output h = cos(sqrt(2)*(th + ph))^2\n",
        "output h = th/2*sin(th/4 + 0.1*cos(0.37*ph))/(2 + cos(ph/7))\n",
        "output h = sin(th/2)\noutput g = h*th\noutput k = cos(2.5*ph - th/2)\n"};
    for (int k = 0; k < 2; k++) {
        double alone[16];
        const uint64_t hash = run_to("", kinds[k], alone);
        for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++) {
            double beside[16];
            TEST_ASSERT_TRUE_MESSAGE(run_to(outputs[i], kinds[k], beside) == hash, outputs[i]);
            TEST_ASSERT_TRUE_MESSAGE(memcmp(alone, beside, NEIGHBOURS * sizeof *alone) == 0,
                                     outputs[i]);
        }
    }
}

/* An angle from its momentum: ph = ph0 + p t - 0.37 (th - th0), whatever the outputs are. */
TEST(angle_places, recovered_angle) {
    static const engine_kind *const kinds[] = {&engine_double, &engine_float};
    derived d = derived_scene(
        "mechanism m\ncoordinate th [rad]\ncoordinate ph [rad]\n"
        "T = 0.5 [kg*m^2]*th'^2 + 0.5 [kg*m^2]*(ph' + 0.37*th')^2\nV = -2 [J]*cos(th)\n"
        "output one = sin(ph)\noutput half = cos(ph/2)\noutput both = sin(th/2 + ph)\n"
        "scene s { conserve ph; start th = 6283, ph = 0.5, th' = 3 [rad/s], ph' = -2 [rad/s] }\n",
        "s");
    derived_expect(&d, d.errors);
    const image *p = d.image;
    TEST_ASSERT_EQUAL_INT(1, p->angles);
    for (int k = 0; k < 2; k++) {
        void *run = kinds[k]->start(p);
        for (int i = 0; i < 50; i++) {
            TEST_ASSERT_TRUE(kinds[k]->step(run) == WH_OK);
        }
        double th;
        double real[8];
        double output[8];
        kinds[k]->state(run, &th, real);
        kinds[k]->outputs(run, output);
        const double ph = 0.5 + (-2.0 + 0.37 * 3.0) * 0.05 - 0.37 * (th - 6283.0);
        const double bound = k == 0 ? 4e-12 : 3e-7; /* round-off of 6283 * 0.37; t and sines */
        TEST_ASSERT_TRUE(fabs(output[0] - sin(ph)) <= bound);
        TEST_ASSERT_TRUE(fabs(output[1] - cos(ph / 2.0)) <= bound);
        TEST_ASSERT_TRUE(fabs(output[2] - sin(th / 2.0 + ph)) <= bound);
        kinds[k]->stop(run);
    }
    derived_free(&d);
}

/* A system's state is stored as a turn angle, too. If a multiple is too large for a phase factor, it is stored as a
 * real. */
TEST(angle_places, systems_and_large_multiples) {
    derived d = derived_scene(
        "mechanism m\nstate th [rad]\nstate q\nparameter w = 3 [1/s]\n"
        "equation th' = w*(2 + sin(th))\nequation q' = w*cos(2*th)\n"
        "output half = cos(th/2)\noutput third = sin(th/3 - 1)\n"
        "output large = sin(3e9*th)\noutput larger = cos(-4294967299.25*th)\noutput tiny = sin(-1e-13*th)\n"
        "scene s { start th = -6283 }\n",
        "s");
    derived_expect(&d, d.errors);
    const image *p = d.image;
    TEST_ASSERT_EQUAL_INT(1, p->angles);
    void *run = engine_float.start(p);
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_TRUE(engine_float.step(run) == WH_OK);
        double th;
        double real[4];
        double output[5];
        engine_float.state(run, &th, real);
        engine_float.outputs(run, output);
        TEST_ASSERT_TRUE(fabs(output[0] - cos(th / 2.0)) < 7e-8);
        TEST_ASSERT_TRUE(fabs(output[1] - sin(th / 3.0 - 1.0)) < 7e-8);
        const double two_pi = 6.283185307179586477;
        const int64_t units = (int64_t)rint(th * (4294967296.0 / two_pi));
        const uint32_t phase = (uint32_t)((uint64_t)units * UINT64_C(3000000000));
        TEST_ASSERT_TRUE(fabs(output[2] - sin((double)phase / 4294967296.0 * two_pi)) < 7e-8);
        /* 2^32 + 3 + 1/4 times the angle */
        const uint64_t quarters = (uint64_t)units * (4 * UINT64_C(4294967299) + 1);
        const double turns = (double)(quarters & UINT64_C(0x3ffffffff)) / 17179869184.0;
        TEST_ASSERT_TRUE(fabs(output[3] - cos(turns * two_pi)) < 7e-8);
        TEST_ASSERT_TRUE(fabs(output[4] - sin(-1e-13 * th)) < 2e-9);
    }
    engine_float.stop(run);
    derived_free(&d);
}

/* Half of the angle appears in T: th' cos(th/2) is the rate of 2 sin(th/2). A total derivative moves nothing, so no
 * equation contains half of th. */
static const char gauge[] =
    "mechanism m\ncoordinate th [rad]\n"
    "T = 0.5 [kg*m^2]*th'^2 + 0.7 [kg*m^2/s]*th'*cos(th/2)\nV = -2 [J]*cos(th)\n";

TEST(angle_places, books_of_a_part) {
    derived d = derived_text(gauge);
    derived_expect(&d, gauge);
    TEST_ASSERT_EQUAL_INT(1, d.image->angles);
    state_values s = {.instance = d.instance};
    s.value[0][0] = 6283.0;
    s.value[0][1] = 1.5;
    double result[16];
    derived_run(d.image->list[IMAGE_BOOKS], &d, &s, result);
    const double extra = 0.7 * cos(6283.0 / 2.0);
    TEST_ASSERT_TRUE(fabs(result[1 + BOOK_MOMENTA] - (1.5 + extra)) < 1e-12);
    TEST_ASSERT_TRUE(fabs(result[1 + BOOK_KINETIC] - (1.125 + 1.5 * extra)) < 1e-12);
    derived_free(&d);
}

/* No equation contains the fraction, but the momentum changes with it: the ledger's powers use the whole angle. */
TEST(angle_places, ledger_takes_a_part) {
    char text[1024];
    snprintf(text, sizeof text, "%sscene s { start th = 1000, th' = 3 [rad/s]; until 5 [s] }\n",
             gauge);
    for (int n = 0; n < 2; n++) {
        double total[32] = {0.0};
        double left[8] = {0.0};
        motion m;
        motion_open_text(&m, text,
                         (stepping){.kind = n ? &engine_float : &engine_double,
                                    .method = WH_RK4,
                                    .ledger = true});
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 5000));
        m.kind->ledger(m.run, total, left);
        const double bound = n ? 1e-4 : 1e-9;
        TEST_ASSERT_TRUE(fabs(left[0]) < bound && fabs(left[1]) < bound);
        motion_close(&m);
    }
}
