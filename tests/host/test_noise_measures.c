/* test_noise_measures.c: noise must depend only on the output's name, the seed and the step, in records and in
 * sweeps, whatever other measures there are. Mechanisms and lists of measures are generated. */
#include "derived.h"

#include "host/engine/engine.h"
#include "host/study/point.h"

enum { OUTPUTS = 6, MEASURES_MAX = 12, STEPS = 25 };

typedef struct made_up {
    char text[4000];
    bool noisy[OUTPUTS]; /* does the scene have noise? */
} made_up;

/* Writes outputs o0, o1, ... of a pendulum on a carriage. Some have noise, either in the mechanism or in an effect
 * that the scene may use. */
static made_up make_up(uint64_t *seed) {
    made_up m = {.text = "mechanism noisy\ncoordinate th [rad]\ncoordinate x [m]\n"
                         "parameter l = 0.7 [m]\n"
                         "T = 1 [kg*m^2]*th'^2 + 1 [kg]*x'^2 + 0.5 [kg*m]*x'*th'*cos(th)\n"
                         "V = 3 [J]*(1 - cos(th)) + 2 [N/m]*x^2\n"};
    static const char *const values[] = {"x",           "l*sin(th)",          "0.3*x + 1 [m]",
                                         "1 [s]*x'",    "x*cos(th)^2 - l",    "1 [m]*th'*1 [s]",
                                         "1 [s^2]*x''", "x^2/1 [m] - 0.2 [m]"};
    char effects[1500] = "effect called { parameter sigma = 2 [mm]\n";
    char silent[1500] = "effect silent { parameter tau = 50 [mm]\n";
    char line[200];
    for (int i = 0; i < OUTPUTS; i++) {
        snprintf(line, sizeof line, "output o%d [m] = %s%s\n", i,
                 values[random_bits(seed) % (sizeof values / sizeof values[0])],
                 i > 0 && random_bits(seed) % 3 == 0 ? " + o0" : "");
        strcat(m.text, line);
    }
    for (int i = 0; i < OUTPUTS; i++) {
        const unsigned where = (unsigned)(random_bits(seed) % 4);
        const unsigned noise_seed = (unsigned)(random_bits(seed) % 3);
        m.noisy[i] = where == 1 || where == 2;
        if (where == 1) {
            snprintf(line, sizeof line, "noise o%d deviation 7 [mm] seed %u\n", i, noise_seed);
            strcat(m.text, line);
        } else if (where == 2 || where == 3) {
            snprintf(line, sizeof line, "noise o%d deviation %s seed %u\n", i,
                     where == 2 ? "sigma" : "tau", noise_seed);
            strcat(where == 2 ? effects : silent, line);
        }
    }
    strcat(m.text, effects);
    strcat(m.text, "}\n");
    strcat(m.text, silent);
    strcat(m.text, "}\nscene s { with called\nstart th = 0.7, x = 0.1 [m]\nuntil 25 [ms] }\n");
    return m;
}

/* Records every output after every step: [STEPS + 1][count]. */
static double *record(const mechanism *of, const scene *in, const engine_kind *kind) {
    diags *errors = diags_new();
    instance *inst = instance_make(of, in, NULL, errors);
    TEST_ASSERT_NOT_NULL(inst);
    if (inst == NULL) { /* the linter wants this check */
        TEST_FAIL();
        return NULL;
    }
    equations *e = equations_derive(inst, errors);
    TEST_ASSERT_NOT_NULL(e);
    image *p = e == NULL ? NULL : image_make(e, NULL, &plainly, IMAGE_TO_RUN, errors);
    TEST_ASSERT_NOT_NULL(p);
    void *run = kind->start(p);
    const size_t count = (size_t)of->output_count;
    double *all = calloc((STEPS + 1) * count + 1, sizeof *all);
    TEST_ASSERT_NOT_NULL(all);
    for (size_t step = 0; step <= STEPS; step++) {
        kind->outputs(run, all + step * count);
        TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(run));
    }
    kind->stop(run);
    image_free(p);
    equations_free(e);
    instance_free(inst);
    diags_free(errors);
    return all;
}

/* A measure of the formula factor * output a + output b. */
typedef struct wanted {
    char text[60];
    double factor;
    int a;
    int b; /* output b; -1: only output a */
} wanted;

static wanted random_measure(uint64_t *seed) {
    wanted w = {.factor = 1.0, .a = (int)(random_bits(seed) % OUTPUTS), .b = -1};
    switch (random_bits(seed) % 4) {
    case 0:
        w.factor = -2.5;
        snprintf(w.text, sizeof w.text, "-2.5*o%d", w.a);
        break;
    case 1:
        w.b = (int)(random_bits(seed) % OUTPUTS);
        snprintf(w.text, sizeof w.text, "o%d + o%d", w.a, w.b);
        break;
    default: snprintf(w.text, sizeof w.text, "o%d", w.a); break;
    }
    return w;
}

static void compare(const made_up *m, const mechanism *of, const scene *in, const engine_kind *kind,
                    uint64_t *seed) {
    const double rounding = kind == &engine_float ? 2e-6 : 1e-14;
    double *recorded = record(of, in, kind);
    wanted list[MEASURES_MAX];
    const char *texts[MEASURES_MAX];
    const int count = 1 + (int)(random_bits(seed) % MEASURES_MAX);
    for (int i = 0; i < count; i++) {
        list[i] = random_measure(seed);
        texts[i] = list[i].text;
    }
    diags *errors = diags_new();
    measures *taken = measures_new(of, texts, count, errors);
    TEST_ASSERT_NOT_NULL(taken);
    double *measured = record(&taken->mechanism, in, kind);
    for (int step = 0; step <= STEPS; step++) {
        for (int i = 0; i < count; i++) {
            const double *row = recorded + (size_t)step * OUTPUTS;
            const double b = list[i].b < 0 ? 0.0 : row[list[i].b];
            const double right = list[i].factor * row[list[i].a] + b;
            const double got = measured[(size_t)step * (size_t)count + (size_t)i];
            if (!(fabs(got - right) <= rounding * (1.0 + fabs(right)))) {
                printf("%s  measure %s, step %d: %.17g, recorded %.17g\n", m->text, list[i].text,
                       step, got, right);
                TEST_FAIL_MESSAGE("a measure has another noise than the records");
            }
        }
    }
    free(measured);
    measures_free(taken);
    diags_free(errors);
    free(recorded);
}

/* There must be noise: the standard deviation of a record with the effect is compared with that of a record without
 * it. */
static void expect_noise(const made_up *m, const mechanism *of, const scene *in) {
    scene bare = *in;
    mechanism quiet = *of;
    quiet.noise_count = 0;
    double *with = record(of, &bare, &engine_double);
    double *without = record(&quiet, &bare, &engine_double);
    for (int i = 0; i < OUTPUTS; i++) {
        double most = 0.0;
        for (int step = 0; step <= STEPS; step++) {
            most = fmax(most, fabs(with[step * OUTPUTS + i] - without[step * OUTPUTS + i]));
        }
        TEST_ASSERT_TRUE_MESSAGE((most > 1e-3 && most < 0.05) == m->noisy[i], m->text);
        TEST_ASSERT_TRUE_MESSAGE(m->noisy[i] || most == 0.0, m->text);
    }
    free(with);
    free(without);
}

TEST(noise_measures, measures_have_the_records_noise) {
    const char *more = getenv("WHIRL_NOISE_CASES");
    const int cases = more != NULL ? (int)strtol(more, NULL, 10) : 60;
    uint64_t seed = 20261121;
    printf("  %d mechanisms from seed %llu\n", cases, (unsigned long long)seed);
    for (int i = 0; i < cases; i++) {
        const made_up m = make_up(&seed);
        diags *errors = diags_new();
        whirl_model *parsed = model_parse("noise.whirl", m.text, strlen(m.text), errors);
        diags_flush(errors, stdout);
        TEST_ASSERT_NOT_NULL_MESSAGE(parsed, m.text);
        expect_noise(&m, parsed->mechanisms[0], parsed->scenes[0]);
        compare(&m, parsed->mechanisms[0], parsed->scenes[0], &engine_double, &seed);
        compare(&m, parsed->mechanisms[0], parsed->scenes[0], &engine_float, &seed);
        model_free(parsed);
        diags_free(errors);
    }
}
