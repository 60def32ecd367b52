/* test_angle_places.c: fractions of an angle wherever the language accepts an angle. If a fraction of a coordinate
 * is in the equations of motion, a contact or an event, the coordinate is stored as a real. A fraction elsewhere,
 * such as in an output, changes neither the run nor the other outputs. */
#include "derived.h"
#include "host/engine/engine.h"
#include "motion.h"
#include "wave_exprs.h"

static const struct {
    const char *text;
    double times;
} multiples[] = {{"th", 1},           {"2*th", 2},       {"-3*th", -3},
                 {"th/2", 0.5},       {"3*th/2", 1.5},   {"th/3", 1.0 / 3},
                 {"1.5*th", 1.5},     {"0.37*th", 0.37}, {"th*sqrt(2)", 1.4142135623730951},
                 {"100.5*th", 100.5}, {"th/1000", 1e-3}};
enum { MULTIPLES = sizeof multiples / sizeof multiples[0] };

enum { NOWHERE, IN_STEP, IN_SIGNALS };

/* @ stands for a multiple of th. Then result 0 of the list is scale * function(multiple) + offset. */
static const struct {
    const char *text;
    int list;
    bool sine;
    /* true: the result is a derivative, so the number of the multiple is a factor of it */
    bool scaled;
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
        /* th is the only angle, if it is one; `place` says which result is its acceleration */
        const double got = result[in_step ? d->image->place[0] : 0];
        const double trig_value = places[which].sine ? sin(times * th) : cos(times * th);
        const double wanted =
            (places[which].scaled ? times : 1.0) * trig_value + places[which].offset;
        TEST_ASSERT_TRUE_MESSAGE(fabs(got - wanted) <=
                                     1e-15 * (8.0 + 4.0 * fabs(times * th)) * (1.0 + fabs(times)),
                                 text);
    }
}

/* A coordinate is stored as a turn angle only if everything that acts on the motion uses integer multiples of it. */
TEST(angle_places, turn_angles_need_integer_multiples) {
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

TEST(angle_places, outputs_do_not_change_the_run) {
    static const engine_kind *const kinds[] = {&engine_double, &engine_float};
    static const char *const outputs[] = {
        "output h = cos(th/2)\n", "output h = sin(1.5*th)\n",
        /* sin(3/2 th + 1/2 th) contains only 2 th */
        "output h = sin(1.5*th)\noutput g = cos(th/2)\n", "output h = tan(th/2) + tan(ph/3)\n",
        "output h = sin(th/3 + 2*ph)*exp(1)\n", "output h = cos(sqrt(2)*(th + ph))^2\n",
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

/* An angle that is recovered from its momentum: ph = ph0 + p t - 0.37 (th - th0), whatever the outputs are. */
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
        /* round-off of 6283 * 0.37, of the time and of the sines */
        const double bound = k == 0 ? 4e-12 : 3e-7;
        TEST_ASSERT_TRUE(fabs(output[0] - sin(ph)) <= bound);
        TEST_ASSERT_TRUE(fabs(output[1] - cos(ph / 2.0)) <= bound);
        TEST_ASSERT_TRUE(fabs(output[2] - sin(th / 2.0 + ph)) <= bound);
        kinds[k]->stop(run);
    }
    derived_free(&d);
}

/* A state of a system is stored as a turn angle, too. If a multiple is too large for a phase factor, the state is
 * stored as a real. */
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
        /* expected phase of (2^32 + 3 + 1/4) th, in quarters of a unit */
        const uint64_t quarters = (uint64_t)units * (4 * UINT64_C(4294967299) + 1);
        const double turns = (double)(quarters & UINT64_C(0x3ffffffff)) / 17179869184.0;
        TEST_ASSERT_TRUE(fabs(output[3] - cos(turns * two_pi)) < 7e-8);
        TEST_ASSERT_TRUE(fabs(output[4] - sin(-1e-13 * th)) < 2e-9);
    }
    engine_float.stop(run);
    derived_free(&d);
}

/* T contains th' cos(th/2), which is the rate of 2 sin(th/2). A total derivative has no effect on the motion, so no
 * equation contains half of th. */
static const char gauge[] =
    "mechanism m\ncoordinate th [rad]\n"
    "T = 0.5 [kg*m^2]*th'^2 + 0.7 [kg*m^2/s]*th'*cos(th/2)\nV = -2 [J]*cos(th)\n";

TEST(angle_places, ledger_with_half_an_angle) {
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

/* The momentum depends on th/2, although the equations of motion do not. So the powers of the energy balance need the
 * angle with its turns. */
TEST(angle_places, ledger_needs_the_unwrapped_angle) {
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

/* === suite angle_parts ========================================================================= */
/* Outputs with fractions and multiples of turn angles, such as cos(th/2), sin(1.5*th) or tan(th/3 - 0.37*ph), thousands
 * of turns from zero, compared with libm.
 *
 * WHIRL_RANDOM_OUTPUTS=N sets the number of random outputs instead of 2000. WHIRL_OUTPUTS_TO=FOLDER writes the
 * mechanisms to a folder, for tests/cli/angle_parts.sh to compile. */

enum { OUTPUTS = 25, STEPS = 40, TEXT_ROOM = 64 + OUTPUTS * (WAVE_TEXT + 32) };
static const uint64_t first_seed = UINT64_C(20261121);

/* X is recovered from its momentum 3 X' + a' cos(a)/2, which is constant. */
static const char front[] =
    "mechanism parts\n"
    "coordinate a [rad]\ncoordinate b [rad]\ncoordinate c [rad]\n"
    "coordinate x [m]\ncoordinate X [m]\n"
    "let u = x/(1 [m])\n"
    "T = 0.4 [kg*m^2]*(a'^2 + b'^2 + c'^2)/2 + 0.1 [kg*m^2]*a'*b'*cos(a - b) + x'^2*1 [kg]"
    " + 1.5 [kg]*X'^2 + 0.5 [kg*m]*X'*a'*cos(a)\n"
    "V = -0.7 [J]*cos(a) - 0.2 [J]*sin(2*b + c) + 5 [N/m]*x^2/2\n";

typedef struct sample {
    wave_expr expr[OUTPUTS];
    double start[5];
    bool conserves;
    char text[TEXT_ROOM + 2048];
    derived of;
} sample;

/* Opens a scene with random expressions as outputs; if `plain`, with simple ones. */
static void open_sample(sample *s, uint64_t *seed, bool plain, int outputs) {
    char *at = s->text;
    at += sprintf(at, "%s", front);
    for (int i = 0; i < outputs; i++) {
        s->expr[i] = plain ? wave_expr_plain(seed) : wave_expr_make(seed);
        at += sprintf(at, "output h%d = %s\n", i, s->expr[i].text);
    }
    at += sprintf(at, "scene parts_turn {\n%s", s->conserves ? "  conserve X\n" : "");
    for (int i = 0; i < 5; i++) {
        static const char *const symbols[] = {"a", "b", "c", "x", "X"};
        const bool turns = i < WAVE_ANGLES;
        /* some angles are near zero, others ten thousand turns away */
        const double most = turns ? pow(10.0, random_between(seed, 0.0, 4.8)) : 0.9;
        s->start[i] = random_between(seed, -most, most);
        at += sprintf(at, "  start %s = %.17g [%s], %s' = %.9g [%s/s]\n", symbols[i], s->start[i],
                      turns ? "rad" : "m", symbols[i], random_between(seed, -20.0, 20.0),
                      turns ? "rad" : "m");
    }
    sprintf(at, "  step 1 [ms]\n  until %d [ms]\n}\n", STEPS);
    s->of = derived_scene(s->text, "parts_turn");
    derived_expect(&s->of, s->text);
    TEST_ASSERT_EQUAL_INT(WAVE_ANGLES, s->of.image->angles);
}

/* The exact state of the run. In float, angles are integers with 2^32 units per turn. */
static void exact_state(const sample *s, const engine_kind *kind, void *run, long double *state) {
    static const long double two_pi = 6.28318530717958647692528676655900577L;
    const image *p = s->of.image;
    double angle_rad[WAVE_ANGLES];
    double real[16];
    TEST_ASSERT_TRUE(p->reals <= 16);
    kind->state(run, angle_rad, real);
    for (int i = 0; i < WAVE_ANGLES; i++) {
        TEST_ASSERT_EQUAL_INT(i, p->angle[i].unknown);
        const double units = rint(angle_rad[i] * (4294967296.0 / 6.283185307179586477));
        state[i] = kind == &engine_float ? (long double)units * (two_pi / 4294967296.0L)
                                         : (long double)angle_rad[i];
    }
    TEST_ASSERT_TRUE(p->real[0].unknown == WAVE_ANGLES && p->real[0].primes == 0);
    state[WAVE_ANGLES] = (long double)real[0];
}

typedef struct tally {
    int compared;
    int skipped;          /* number of tangents so near their pole that round-off dominates */
    long double ratio;    /* worst difference, divided by the bound on its round-off */
    long double relative; /* worst difference, divided by the sum of the absolute terms */
} tally;

static void compare(const sample *s, const engine_kind *kind, void *run, int count, tally *t) {
    long double state[WAVE_SYMBOLS];
    double output[OUTPUTS + 8];
    TEST_ASSERT_TRUE(s->of.image->outputs <= OUTPUTS + 8);
    exact_state(s, kind, run, state);
    kind->outputs(run, output);
    for (int i = 0; i < count; i++) {
        const wave_value wanted = wave_expr_value(&s->expr[i], state, kind == &engine_float);
        if (!(wanted.bound < 0.01L * wanted.scale)) {
            t->skipped++;
            continue;
        }
        const long double off = fabsl((long double)output[i] - wanted.value);
        t->compared++;
        t->ratio = fmaxl(t->ratio, off / wanted.bound);
        t->relative = fmaxl(t->relative, off / wanted.scale);
        if (!(off <= wanted.bound)) {
            printf(
                "%s: %s = %.17g, wanted %.19Lg +- %.3Lg at\n  a = %.19Lg, b = %.19Lg, c = %.19Lg, "
                "u = %.19Lg\n",
                kind->name, s->expr[i].text, output[i], wanted.value, wanted.bound, state[0],
                state[1], state[2], state[3]);
            TEST_FAIL_MESSAGE("an output is wrong by more than rounding");
        }
    }
    if (!s->conserves) {
        return;
    }
    /* an output with a fraction of an angle must not change X, which follows from its momentum */
    double angle_rad[WAVE_ANGLES];
    double real[16];
    kind->state(run, angle_rad, real);
    const double rounding = kind == &engine_float ? 0x1p-23 : 0x1p-52;
    const double *start = s->of.instance->start[WAVE_ANGLES + 1];
    const double momentum = 3.0 * start[1] + 0.5 * cos(s->start[0]) * s->of.instance->start[0][1];
    const double time_s = (double)kind->steps(run) * 1e-3;
    const double X =
        start[0] + (momentum * time_s + 0.5 * (sin(s->start[0]) - (double)sinl(state[0]))) / 3.0;
    TEST_ASSERT_TRUE(fabs(output[count] - X) <= 8.0 * rounding * (1.0 + fabs(momentum * time_s)));
}

static void keep(const sample *s, int number) {
    const char *folder = getenv("WHIRL_OUTPUTS_TO");
    if (folder != NULL) {
        char path[1024];
        snprintf(path, sizeof path, "%s/parts_%d.whirl", folder, number);
        FILE *out = fopen(path, "w");
        TEST_ASSERT_NOT_NULL_MESSAGE(out, path);
        fputs(s->text, out);
        TEST_ASSERT_EQUAL_INT(0, fclose(out));
    }
}

static sample drawn;

TEST(angle_parts, random_outputs) {
    static const engine_kind *const kinds[] = {&engine_double, &engine_float};
    const char *wanted = getenv("WHIRL_RANDOM_OUTPUTS");
    const int total = wanted != NULL ? (int)strtol(wanted, NULL, 10) : 2000;
    tally tallies[2] = {{0}};
    uint64_t seed = first_seed;
    TEST_ASSERT_TRUE(total > 0);
    for (int done = 0, number = 0; done < total; number++) {
        const int count = total - done < OUTPUTS ? total - done : OUTPUTS;
        drawn.conserves = number % 2 == 1;
        open_sample(&drawn, &seed, false, count);
        keep(&drawn, number);
        for (int k = 0; k < 2; k++) {
            void *run = kinds[k]->start(drawn.of.image);
            compare(&drawn, kinds[k], run, count, &tallies[k]);
            for (int step = 0; step < STEPS; step++) {
                TEST_ASSERT_TRUE(kinds[k]->step(run) == WH_OK);
            }
            compare(&drawn, kinds[k], run, count, &tallies[k]);
            kinds[k]->stop(run);
        }
        derived_free(&drawn.of);
        done += count;
    }
    for (int k = 0; k < 2; k++) {
        const tally *t = &tallies[k];
        printf(
            "  %d outputs from seed %llu in %s, at two states each: worst difference %.2Lg of what "
            "is added up, %.2Lg of the bound; %d skipped\n",
            total, (unsigned long long)first_seed, kinds[k]->name, t->relative, t->ratio,
            t->skipped);
        TEST_ASSERT_TRUE(t->skipped * 20 < t->compared);
    }
}

/* Sines and cosines of fractions of an angle, up to ten thousand turns from zero. In float, the error is that of any
 * sine (6.3e-8; docs/dev/numerics.md) plus one phase unit (1.5e-9 rad) for the multiplication. */
TEST(angle_parts, float_sines_of_parts) {
    uint64_t seed = first_seed;
    double worst = 0.0;
    int parts = 0;
    drawn.conserves = false;
    for (int number = 0; number < 40; number++) {
        open_sample(&drawn, &seed, true, OUTPUTS);
        void *run = engine_float.start(drawn.of.image);
        long double state[WAVE_SYMBOLS];
        double output[OUTPUTS + 8];
        exact_state(&drawn, &engine_float, run, state);
        engine_float.outputs(run, output);
        for (int i = 0; i < OUTPUTS; i++) {
            const wave_piece *p = &drawn.expr[i].term[0].factor[0].argument.piece[0];
            /* not tested: sines of whole multiples, which the program may compute from each other */
            if (p->number != rintl(p->number)) {
                const long double value = wave_expr_value(&drawn.expr[i], state, true).value;
                worst = fmax(worst, fabs((double)((long double)output[i] - value)));
                parts++;
            }
        }
        engine_float.stop(run);
        derived_free(&drawn.of);
    }
    printf("  %d sines of parts of angles in float, to 1e4 turns: worst error %.3g\n", parts,
           worst);
    TEST_ASSERT_TRUE(parts > 500 && worst < 6.6e-8 && worst > 3e-8);
}
