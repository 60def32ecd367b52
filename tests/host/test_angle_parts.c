/* test_angle_parts.c: outputs with fractions and multiples of turn angles against libm, thousands of turns
 * from zero: cos(th/2), sin(1.5*th), tan(th/3 - 0.37*ph).
 *
 * WHIRL_RANDOM_OUTPUTS=N takes N random outputs instead of 2000. WHIRL_OUTPUTS_TO=FOLDER keeps the mechanisms, for
 * tests/cli/angle_parts.sh to compile. */
#include "derived.h"
#include "host/engine/engine.h"
#include "wave_exprs.h"

enum { OUTPUTS = 25, STEPS = 40, TEXT_ROOM = 64 + OUTPUTS * (WAVE_TEXT + 32) };
static const uint64_t first_seed = UINT64_C(20261121);

/* X has the constant momentum 3 X' + a' cos(a)/2, from which X is recovered. */
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

/* Opens `outputs` random expressions; if `plain`, simple ones. */
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
        /* some near zero, some ten thousand turns away */
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

/* The exact state of the run: float angles are integers, 2^32 per turn. */
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
    long double ratio;    /* worst difference over its round-off bound */
    long double relative; /* worst difference over the sum of the terms */
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
    /* X follows from its momentum; an output with a fraction of an angle must not disturb it */
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

TEST(angle_parts, made_up_outputs) {
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

/* The sine or cosine of a multiple of an angle, up to ten thousand turns from zero. In float its error is that of any sine
 * (6.3e-8; docs/dev/numerics.md) plus one phase unit (1.5e-9 rad) for the multiple. */
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
            if (p->number != rintl(p->number)) { /* the others may be computed from each other */
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
