/* test_stepping.c: measures of one run of a sweep (host/study/point.h), compared with the test's own samples and
 * closed forms. Covers the choice of samples, early stops, and runs without measures. Also settings of a sweep. */
#include "core/version.h"
#include "host/base/alloc.h"
#include "host/check/run_checks.h"
#include "host/check/slow.h"
#include "host/cli/commands.h"
#include "host/os/system.h"
#include "host/study/point.h"
#include "host/study/session.h"

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "made_sweep.h"

/* === stepping ================================================================================= */

#define PI 3.14159265358979323846

enum { MEASURES_MOST = 8, SAMPLES_MOST = 6000 };

static dice die;

typedef struct measured_point {
    bool good;
    double value[MEASURES_MOST + 1];
    point_notes notes;
    char *reason;
    char *errors;
} measured_point;

static measured_point measure_stepping(const measuring *w, const image *im) {
    measured_point p = {.reason = NULL};
    size_t length[2];
    FILE *reason = alloc_text(&p.reason, &length[0]);
    FILE *out = alloc_text(&p.errors, &length[1]);
    diags *errors = diags_new();
    p.good = stepping_measure(w, im, p.value, errors, reason, &p.notes);
    diags_flush(errors, out);
    diags_free(errors);
    alloc_text_end(reason);
    alloc_text_end(out);
    return p;
}

static void drop(measured_point *p) {
    free(p->reason);
    free(p->errors);
}

static derived scene_of(const char *text) {
    derived s = derived_scene(text, "s");
    derived_expect(&s, text);
    return s;
}

static const engine_kind *drawn_kind(void) {
    return dice_one_of(&die, 2) == 0 ? &engine_float : &engine_double;
}

/* --- against samples of one's own ------------------------------------------------------------------------------*/

static derived drawn_swing(double *omega_radps) {
    char text[1000];
    const double k = dice_between(&die, 250.0, 900.0);
    *omega_radps = sqrt(k / 2.0);
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
             "T = 1 [kg]*x'^2 + 0.5 [kg*m^2]*a'^2\nV = %.17g [N/m]*x^2/2\n"
             "output both [m] = 2*x + 0.1 [m]*sin(a)\noutput rate [m/s] = x'\n"
             "output little [m] = 1 [m] + 1e-9*x\n"
             "scene s { start x = 0.5 [m], a' = %.6f [rad/s]; step 1 [ms]; until %.4f [s] }\n",
             k, dice_between(&die, -3.0, 3.0), dice_between(&die, 1.5, 3.0));
    return scene_of(text);
}

static double sample_of(const engine_kind *kind, void *run, channel from) {
    double angle_rad[8];
    double real[16];
    double output[8];
    kind->state(run, angle_rad, real);
    kind->outputs(run, output);
    switch (from.where) {
    case FROM_ANGLE: return angle_rad[from.index];
    case FROM_REAL: return real[from.index];
    case FROM_OUTPUT: break;
    }
    return output[from.index];
}

static double worth(measure_kind kind, const double *sample, int from, int count) {
    double least = sample[from];
    double most = sample[from];
    long double sum = 0.0L;
    for (int i = from; i < count; i++) {
        least = fmin(least, sample[i]);
        most = fmax(most, sample[i]);
        sum += (i == from || i == count - 1 ? 0.5L : 1.0L) * (long double)sample[i];
    }
    switch (kind) {
    case MEASURE_FINAL: return sample[count - 1];
    case MEASURE_MAX: return most;
    case MEASURE_MIN: return least;
    case MEASURE_AMPLITUDE: return (most - least) / 2.0;
    case MEASURE_MEAN: return (double)(sum / (long double)(count - 1 - from));
    case MEASURE_PERIOD: break;
    }
    return (double)NAN;
}

TEST(stepping, samples) {
    static double sample[MEASURES_MOST][SAMPLES_MOST];
    for (unsigned c = 0; c < dice_cases(usual_or(12, 5)); c++) {
        double omega_radps;
        derived s = drawn_swing(&omega_radps);
        const image *im = s.image;
        const engine_kind *kind = drawn_kind();
        const int from = c % 3 == 0 ? 0 : (int)dice_one_of(&die, (unsigned)im->steps - 1U);
        gauged list[MEASURES_MOST];
        measuring w = {.kind = kind,
                       .from_s = 0.001 * from,
                       .list = list,
                       .count = 1 + (int)dice_one_of(&die, MEASURES_MOST)};
        TEST_ASSERT_TRUE(im->angles == 1 && im->reals == 3 && im->steps < SAMPLES_MOST);
        for (int i = 0; i < w.count; i++) {
            const unsigned where = dice_one_of(&die, c % 4 == 0 ? 2 : 3); /* without outputs, too */
            list[i] = (gauged){.kind = (measure_kind)dice_one_of(&die, MEASURE_MEAN + 1),
                               .name = "m",
                               .from = {.where = FROM_ANGLE}};
            if (where == 1) {
                list[i].from.where = FROM_REAL;
                list[i].from.index = (int)dice_one_of(&die, 3);
            } else if (where == 2) {
                list[i].from.where = FROM_OUTPUT;
                list[i].from.index = (int)dice_one_of(&die, 2);
            }
        }
        void *run = kind->start(im);
        run_checks *v = run_checks_open(im, NULL, kind, run, NULL);
        for (int step = 0; step <= (int)im->steps; step++) {
            run_checks_enter(v);
            for (int i = 0; i < w.count; i++) {
                sample[i][step] = sample_of(kind, run, list[i].from);
            }
            TEST_ASSERT_EQUAL_INT(WH_OK, step < (int)im->steps ? kind->step(run) : WH_OK);
        }
        run_checks_end(v, WH_OK);
        measured_point p = measure_stepping(&w, im);
        TEST_ASSERT_TRUE_MESSAGE(p.good, p.reason);
        TEST_ASSERT_EQUAL_STRING("", p.reason);
        for (int i = 0; i < w.count; i++) {
            const double wanted = worth(list[i].kind, sample[i], from, (int)im->steps + 1);
            const bool is_sum = list[i].kind == MEASURE_MEAN || list[i].kind == MEASURE_AMPLITUDE;
            TEST_ASSERT_TRUE(fabs(p.value[i] - wanted) <= (is_sum ? 1e-11 : 0.0));
        }
        TEST_ASSERT_TRUE(v->balance.known && p.value[w.count] == v->balance.ratio);
        for (int id = 0; id < FINDINGS; id++) {
            TEST_ASSERT_EQUAL(v->found[id].told, (p.notes.found >> id & 1U) != 0);
        }
        run_checks_close(v);
        kind->stop(run);
        drop(&p);
        derived_free(&s);
    }
}

/* The period is that of the spring, whatever the other measures are. Slow float angles are counted. */
TEST(stepping, period) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        double omega_radps;
        derived s = drawn_swing(&omega_radps);
        const gauged list[] = {{MEASURE_FINAL, "f", {FROM_OUTPUT, 0}},
                               {MEASURE_PERIOD, "p", {FROM_OUTPUT, 1}},
                               {MEASURE_PERIOD, "q", {FROM_REAL, 0}}};
        const measuring w = {.kind = drawn_kind(), .from_s = 0.1, .list = list, .count = 3};
        measured_point p = measure_stepping(&w, s.image);
        TEST_ASSERT_TRUE_MESSAGE(p.good, p.reason);
        for (int i = 1; i < 3; i++) {
            TEST_ASSERT_TRUE(fabs(p.value[i] * omega_radps / (2.0 * PI) - 1.0) < 1e-3);
        }
        drop(&p);
        derived_free(&s);
    }
    /* a small swing has a period if its numbers resolve it */
    double omega_radps;
    derived little = drawn_swing(&omega_radps);
    const gauged period = {MEASURE_PERIOD, "l", {FROM_OUTPUT, 2}};
    const engine_kind *const kinds[] = {&engine_float, &engine_double};
    for (int i = 0; i < 2; i++) {
        const measuring w = {.kind = kinds[i], .list = &period, .count = 1};
        measured_point p = measure_stepping(&w, little.image);
        TEST_ASSERT_TRUE(i == 0 ? isnan(p.value[0])
                                : fabs(p.value[0] * omega_radps / (2.0 * PI) - 1.0) < 1e-3);
        TEST_ASSERT_TRUE_MESSAGE(p.good, p.reason);
        drop(&p);
    }
    derived_free(&little);
    derived slow = scene_of("mechanism m\ncoordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\n"
                            "scene s { start a' = 1e-7 [rad/s]; step 1 [ms]; until 1 [s] }\n");
    const gauged end = {MEASURE_FINAL, "a", {FROM_ANGLE, 0}};
    for (int i = 0; i < 2; i++) {
        const measuring w = {.kind = kinds[i], .list = &end, .count = 1};
        measured_point p = measure_stepping(&w, slow.image);
        TEST_ASSERT_EQUAL(i == 0, (p.notes.found & FINDING_BIT(FINDING_DIGITS)) != 0);
        drop(&p);
    }
    derived_free(&slow);
}

/* --- given up, and failed --------------------------------------------------------------------------------------*/

#define CLOCK "mechanism m\nstate x [s]\nequation x' = 1\n"

/* The run is interrupted: its measures cover the steps until then. */
TEST(stepping, given_up) {
    derived longest =
        scene_of(CLOCK "scene s { start x = 3 [s]; step 1 [ms]; until 200000 [s] }\n");
    const gauged most = {MEASURE_MAX, "x", {FROM_REAL, 0}};
    const measuring w = {.kind = &engine_double, .list = &most, .count = 1};
    interrupted = 1;
    measured_point p = measure_stepping(&w, longest.image);
    interrupted = 0;
    TEST_ASSERT_TRUE(p.good && p.value[0] == 3.0 && isnan(p.value[1])); /* it has no energies */
    drop(&p);
    derived_free(&longest);
}

/* A run without measures has a reason on a line of its own, or an error with its place. */
static void expect_failed(const char *text, const measuring *w, const char *reason,
                          const char *error) {
    derived s = scene_of(text);
    measured_point p = measure_stepping(w, s.image);
    TEST_ASSERT_FALSE(p.good);
    TEST_ASSERT_EQUAL_STRING(reason, p.reason);
    TEST_ASSERT_TRUE_MESSAGE(
        error[0] != '\0' ? strstr(p.errors, error) != NULL : p.errors[0] == '\0', p.errors);
    drop(&p);
    derived_free(&s);
}

TEST(stepping, failed) {
    gauged list = {MEASURE_MEAN, "mean(x)", {FROM_REAL, 0}};
    measuring w = {.kind = &engine_double, .list = &list, .count = 1};
    w.from_s = 1.5;
    expect_failed(CLOCK "scene s { step 1 [ms]; until 1 [s] }\n", &w,
                  "--from 1.5 s is after the last step", "");
    list.kind = MEASURE_FINAL; /* needs no series: any time will do */
    derived good = scene_of(CLOCK "scene s { step 1 [ms]; until 1 [s] }\n");
    measured_point p = measure_stepping(&w, good.image);
    TEST_ASSERT_TRUE(p.good && fabs(p.value[0] - 1.0) < 1e-12);
    drop(&p);
    w.from_s = 1.0; /* the last step's end is one sample */
    list.kind = MEASURE_MAX;
    p = measure_stepping(&w, good.image);
    TEST_ASSERT_TRUE(p.good && fabs(p.value[0] - 1.0) < 1e-12);
    drop(&p);
    derived_free(&good);
    list.kind = MEASURE_PERIOD;
    w.from_s = 0.0;
    expect_failed(CLOCK "scene s { step 1 [ms]; until 100000 [s] }\n", &w,
                  "period() takes at most 1e+08 samples: a later --from or a larger step", "");
    /* 1/x of x = 1 - t: the step to 0 is the last good one, and the output is undefined there */
    list = (gauged){MEASURE_FINAL, "1/x", {FROM_OUTPUT, 0}};
    expect_failed("mechanism m\nstate x\nequation x' = -1 [1/s]\noutput y = log(x)\n"
                  "scene s { start x = 0.4995; step 1 [ms]; until 1 [s] }\n",
                  &w, "the expression of the measure '1/x' is not a finite number at every step",
                  "");
    /* each is finite, their sum is not */
    list = (gauged){MEASURE_MEAN, "large", {FROM_OUTPUT, 0}};
    expect_failed("mechanism m\nstate x\nequation x' = 0*x/(1 [s])\noutput y = 1e308*(1 + x)\n"
                  "scene s { step 1 [ms]; until 0.1 [s] }\n",
                  &w, "the measure 'large' is not a finite number: its expression is too large",
                  "");
}

/* x' = x^2 from 1/t1 is 1/(t1 - t): it ends in the step of t1 or the next. Also a root undefined from t1 on, reported
 * with its place. */
TEST(stepping, diverged) {
    const gauged list = {MEASURE_FINAL, "x", {FROM_REAL, 0}};
    for (int c = 0; c < 6; c++) {
        char text[400];
        const measuring w = {
            .kind = c % 2 == 0 ? &engine_float : &engine_double, .list = &list, .count = 1};
        const double t1_s = 0.2505 + 0.1 * (double)dice_one_of(&die, 5);
        snprintf(text, sizeof text,
                 "mechanism m\nstate x\nequation x' = 1 [1/s]*x^2\n"
                 "scene s { start x = %.17g; step 1 [ms]; until 1 [s] }\n",
                 1.0 / t1_s);
        derived s = scene_of(text);
        measured_point p = measure_stepping(&w, s.image);
        double when_s = 0.0;
        TEST_ASSERT_FALSE(p.good);
        (void)said_number(said_exactly(p.reason, "diverged in the step after t = "), &when_s);
        TEST_ASSERT_TRUE_MESSAGE(when_s >= t1_s - 0.002 && when_s < t1_s + 0.006, p.reason);
        TEST_ASSERT_EQUAL_STRING("", p.errors);
        drop(&p);
        derived_free(&s);
        snprintf(
            text, sizeof text,
            "mechanism m\nstate x\nequation x' = -1 [1/s] + 0 [1/s]*x\nstate y\n"
            "equation y' = sqrt(x)/(1 [s])\nscene s { start x = %.17g; step 1 [ms]; until 1 [s] }\n",
            t1_s);
        s = scene_of(text);
        p = measure_stepping(&w, s.image);
        TEST_ASSERT_TRUE(!p.good && p.reason[0] == '\0');
        const char *at = strstr(p.errors, "in the step after t = ");
        TEST_ASSERT_NOT_NULL_MESSAGE(at, p.errors);
        (void)said_number(at + strlen("in the step after t = "), &when_s);
        TEST_ASSERT_TRUE_MESSAGE(fabs(when_s - (t1_s - 0.0005)) < 1.1e-3, p.errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(p.errors, ":5:15: error: "), p.errors);
        drop(&p);
        derived_free(&s);
    }
}

/* An energy becomes undefined while the motion goes on: reported with place and time. */
TEST(stepping, energies) {
    const gauged list = {MEASURE_FINAL, "x", {FROM_REAL, 0}};
    for (int c = 0; c < 2; c++) {
        const measuring w = {
            .kind = c == 0 ? &engine_float : &engine_double, .list = &list, .count = 1};
        expect_failed(
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 0.001 [J]*log(x/(1 [m]))\n"
            "scene s { start x = 0, x' = 1 [m/s]; step 1 [ms]; until 0.1 [s] }\n",
            &w, "", "at t = 0 s");
    }
}

TEST(stepping, contacts) {
    derived s = scene_of("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9.81 [N]*x\n"
                         "stop x >= 0 [m] restitution 0.5\n"
                         "scene s { start x = 1 [m]; step 1 [ms]; until 2 [s] }\n");
    const gauged list[] = {{MEASURE_MIN, "x", {FROM_REAL, 0}}, {MEASURE_MAX, "x'", {FROM_REAL, 1}}};
    const measuring w = {.kind = &engine_double, .list = list, .count = 2};
    measured_point p = measure_stepping(&w, s.image);
    TEST_ASSERT_TRUE_MESSAGE(p.good, p.reason);
    TEST_ASSERT_TRUE(fabs(p.value[0]) < 1e-6);
    TEST_ASSERT_TRUE(fabs(p.value[1] - 0.5 * sqrt(2.0 * 9.81)) <
                     0.011); /* within a step of the bounce */
    drop(&p);
    derived_free(&s);
}

/* --- whole runs ------------------------------------------------------------------------------- */

/* Measures of `whirl sweep` over whole runs with closed forms: of coordinates, outputs and expressions, from the
 * start or later, with few steps. */

/* A free motion x = a + v t at each of n + 1 ends of steps. */
static void write_free(char *text, size_t size, double a, unsigned steps) {
    snprintf(text, size,
             "mechanism free\ncoordinate x [m]\nparameter u = 1 [m]\nT = 1 [kg]*x'^2/2\n"
             "output twice [m] = 2*x\nscene s { start x = %.17g [m]\nstep 0.125 [s]\n"
             "until %.17g [s] }\n",
             a, 0.125 * steps);
}

static const char *const measures_stepping[] = {"x",           "mean(x)",     "max(x)",
                                                "min(twice)",  "mean(twice)", "amplitude(x)",
                                                "mean(x^2/u)", "max(-twice)"};
enum { MEASURES = sizeof measures_stepping / sizeof measures_stepping[0] };

static double wanted(int measure_stepping, double a, double v, double from_s, double end_s) {
    const double first = a + v * from_s;
    const double last = a + v * end_s;
    const double n = (end_s - from_s) / 0.125;
    switch (measure_stepping) {
    case 0: return last;
    case 1: return 0.5 * (first + last);
    case 2: return fmax(first, last);
    case 3: return 2.0 * fmin(first, last);
    case 4: return first + last;
    case 5: return 0.5 * fabs(last - first);
    /* the mean over chords of a parabola is v^2 h^2/6 above that of the curve */
    case 6:
        return (first * first + first * last + last * last) / 3.0 +
               (n > 0.0 ? v * v * 0.125 * 0.125 / 6.0 : 0.0);
    default: return -2.0 * fmin(first, last);
    }
}

TEST(stepping, measures_of_whole_runs) {
    dice d = dice_of("swept", 41);
    for (unsigned k = 0; k < 12U; k++) {
        char text[400];
        char from[30];
        said what;
        const unsigned steps = 1U + (k < 4U ? k : dice_one_of(&d, 40));
        const unsigned left_out = k % 3U == 0 ? 0 : dice_one_of(&d, steps + 1U);
        const double a = dice_between(&d, -2.0, 2.0);
        const char *words[2 * MEASURES + 8] = {0};
        unsigned count = 0;
        write_free(text, sizeof text, a, steps);
        snprintf(from, sizeof from, "%.17g", 0.125 * left_out);
        words[count++] = model_keep(text);
        words[count++] = "--over";
        words[count++] = "x'=-3..3:3";
        words[count++] = "--from";
        words[count++] = from;
        words[count++] = "--quiet";
        for (int i = 0; i < MEASURES; i++) {
            words[count++] = "--measure";
            words[count++] = measures_stepping[i];
        }
        command_say(command_sweep, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const char *row = strchr(what.out, '\n');
        for (int point = 0; point < 3; point++) {
            TEST_ASSERT_NOT_NULL(row);
            const double v = 3.0 * (point - 1);
            char rest[400];
            snprintf(rest, sizeof rest, "%s", row + 1);
            char *at = rest;
            TEST_ASSERT_EQUAL_DOUBLE(v, strtod(rest, &at));
            for (int i = 0; i < MEASURES; i++) {
                const double got = strtod(at + 1, &at);
                const double is = wanted(i, a, v, 0.125 * left_out, 0.125 * steps);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-11 * (1.0 + fabs(is)), is, got,
                                                  measures_stepping[i]);
            }
            row = strchr(row + 1, '\n');
        }
    }
    model_drop();
}

SUITE(stepping) { die = dice_of("stepping", 51); }

/* === sweep settings =========================================================================== */
/* A sweep's header, the settings stored with its file, and its points as run by workers: each way a point ends frees
 * all memory. */

/* --- headers and settings ----------------------------------------------------------------------------------------*/

/* RFC 4180: parsed, the fields are the names. */
static void test_headers(void) {
    static const char *const asked[] = {"x",      "max(x, y)", "amplitude(x)", " x' ",
                                        "x\t+ y", "max(x,y)",  "min(y)",       "2*x"};
    for (unsigned c = 0; c < 30U; c++) {
        made_sweep m;
        const char *const axes[] = {"x=1..9:9", "y'=1..9:9", "step=1..2:2"};
        const char *names[8];
        const int count = 1 + (int)dice_one_of(&die, 8);
        const int swept = (int)dice_one_of(&die, 3) + 1;
        char *text = NULL;
        size_t length = 0;
        for (int i = 0; i < count; i++) {
            names[i] = asked[dice_one_of(&die, 8)];
        }
        made_sweep_open(&m, made_sweep_floor, axes, swept, names, count, &engine_double);
        FILE *out = alloc_text(&text, &length);
        sweep_header(&m.sweep, out);
        alloc_text_end(out);
        const char *at = text;
        for (int i = 0; i < swept + count + 1; i++) {
            char field[80];
            size_t size = 0;
            const bool quoted = *at == '"';
            at += quoted ? 1 : 0;
            while (quoted ? !(at[0] == '"' && at[1] != '"') : strchr(",\r", *at) == NULL) {
                at += *at == '"' ? 1 : 0;
                field[size++] = *at++;
            }
            field[size] = '\0';
            at += quoted ? 1 : 0;
            const char *name = i < swept           ? m.grid.axes[i].column
                               : i < swept + count ? names[i - swept]
                                                   : "energy_residual";
            TEST_ASSERT_EQUAL_STRING(name + (i < swept ? 0 : strspn(name, " ")), field);
            TEST_ASSERT_EQUAL(strchr(field, ',') != NULL, quoted);
            at = said_exactly(at, i < swept + count ? "," : swept == 3 ? ",end_s\r\n" : "\r\n");
        }
        TEST_ASSERT_EQUAL_STRING("", at);
        free(text);
        made_sweep_close(&m);
    }
}

static const char settings_text[] =
    "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\nparameter m = 2 [kg]\ninput u = 3 [N]\n"
    "T = m*x'^2/2 + 1 [kg*m^2]*a'^2/2\nQ(x) = u\neffect drag \"d\" { parameter b = 4 [N*s/m]; "
    "F += b*x'^2/2 }\n"
    "effect tug { F += 1 [N*s/m]*x'^2 }\nscene s { step 1 [ms]; until 3 [s] }\n";

/* Every setting that affects the rows is stored exactly. */
static void test_settings(void) {
    for (unsigned c = 0; c < 60U; c++) {
        static const char *const axes[] = {"x=1..9:9", "m=0.1..7:70,log"};
        static const char *const asked[] = {"max(x)", "a"};
        made_sweep m;
        const int count = 1 + (int)dice_one_of(&die, 2);
        const engine_kind *kind = c % 2U == 0 ? &engine_float : &engine_double;
        made_sweep_open(&m, settings_text, axes, 2, asked, count, kind);
        instance *base = m.d.instance;
        base->parameter[0] = dice_between(&die, 1.0, 2.0);
        base->input[0] = dice_between(&die, 1.0, 2.0);
        base->start[0][0] = dice_between(&die, 1.0, 2.0);
        base->start[1][1] = dice_between(&die, 1.0, 2.0);
        base->with[0] = dice_one_of(&die, 2) == 0;
        base->step_s = dice_between(&die, 1.0, 2.0);
        base->until_s = dice_between(&die, 1.0, 2.0);
        m.sweep.from_s = dice_between(&die, 0.0, 1.0);
        m.sweep.engine.compensated = dice_one_of(&die, 2) == 0;
        m.sweep.engine.method = (wh_method)dice_one_of(&die, 3);
        m.sweep.engine.matrix = dice_one_of(&die, 2) == 0 ? MATRIX_NONE : MATRIX_EXACT;
        m.sweep.engine.tables = dice_one_of(&die, 2) == 0 ? TABLES_NONE : TABLES_LINEAR;
        m.image->list[IMAGE_STEP]->tables.bits = (int)dice_one_of(&die, 9);
        const shard part = {1 + dice_one_of(&die, 9), 10 + dice_one_of(&die, 90)};
        char *made =
            fingerprint_make(&m.sweep, c % 3U == 0 ? "text" : "other", base, m.image, part);
        char *text = NULL;
        size_t length = 0;
        FILE *out = alloc_text(&text, &length);
        fprintf(out, "whirl " WH_VERSION
                     " sweep: settings of the CSV beside this file, format 3\nscene: s\n");
        /* FNV-1a over eight bytes a letter, the first of which is the letter */
        uint64_t hash = 14695981039346656037ULL;
        for (const char *at = c % 3U == 0 ? "text" : "other"; *at != '\0'; at++) {
            hash = (hash ^ (unsigned char)*at) * 1099511628211ULL;
            for (int i = 1; i < 8; i++) {
                hash *= 1099511628211ULL;
            }
        }
        fprintf(out, "model text: 0x%016llx\n", (unsigned long long)hash);
        fprintf(out, "number: %s%s\n", c % 2U == 0 ? "float" : "double",
                m.sweep.engine.compensated ? ", compensated" : "");
        fprintf(out, "method: %s\nangles: turned\n", wh_methods[m.sweep.engine.method].word);
        if (m.sweep.engine.matrix == MATRIX_EXACT) {
            fprintf(out, "matrix: exact\n");
        }
        if (m.sweep.engine.tables == TABLES_LINEAR) {
            fprintf(out, "tables: linear, %.0f cells\n",
                    pow(2.0, m.image->list[IMAGE_STEP]->tables.bits));
        }
        fprintf(out, "step: %.17g s\nuntil: %.17g s\nmeasured from: %.17g s\n", base->step_s,
                base->until_s, m.sweep.from_s);
        fprintf(out, "effect drag: %s\n", base->with[0] ? "with" : "without");
        fprintf(out, "effect tug: without\n");
        fprintf(out, "set m: %.17g\nset b: 4\nset u: %.17g\n", base->parameter[0], base->input[0]);
        fprintf(out, "start x (0 primes): %.17g\nstart x (1 primes): 0\n", base->start[0][0]);
        fprintf(out, "start a (0 primes): 0\nstart a (1 primes): %.17g\n", base->start[1][1]);
        fprintf(out, "over x: 1 to 9, 9 values\n");
        fprintf(out, "over m: 0.10000000000000001 to 7, 70 values, logarithmic\n");
        fprintf(out, "measure: max(x)\n%sshard: %llu/%llu\noperations: 0x%016llx\n",
                count > 1 ? "measure: a\n" : "", (unsigned long long)part.number,
                (unsigned long long)part.of, (unsigned long long)m.image->hash);
        alloc_text_end(out);
        TEST_ASSERT_EQUAL_STRING(text, made);
        free(text);
        free(made);
        made_sweep_close(&m);
    }
}

/* --- given back --------------------------------------------------------------------------------------------------*/

/* Points as run by workers, in this process, in each way they end; and whole sweeps. */
static void run_points(void) {
    static const struct {
        const char *text;
        const char *over;
        const char *measure;
        bool good;
    } points[] = {
        {made_sweep_floor, "x=-1..1:2", "x", false},        /* refused at the start */
        {made_sweep_floor, "x=1..2:2", "period(x)", true},  /* undefined: stored samples */
        {made_sweep_floor, "x=0..2:2", "mean(1/x)", false}, /* not a number */
        {settings_text, "m=1..2:2", "max(x)", true},        /* derived again */
        {settings_text, "m=0..2:2", "max(x)", false},       /* which fails */
        {"mechanism m\nstate x\nequation x' = 1 [1/s]*x^2\nscene s { step 1 [ms]; until 2 [s] }\n",
         "x=4..1:2", "x", false}, /* diverges */
        {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [J]*sqrt(x/(1 [m]))\n"
         "scene s { step 1 [ms]; until 2 [s] }\n",
         "x=-1..1:2", "x", false}, /* undefined */
    };
    for (size_t i = 0; i < sizeof points / sizeof points[0]; i++) {
        made_sweep m;
        char *text[2] = {NULL, NULL};
        size_t length[2];
        point_notes notes;
        made_sweep_open(&m, points[i].text, &points[i].over, 1, &points[i].measure, 1,
                        &engine_double);
        FILE *row = alloc_text(&text[0], &length[0]);
        FILE *reason = alloc_text(&text[1], &length[1]);
        const bool good = sweep_point(&m.sweep, 0, row, reason, &notes);
        alloc_text_end(row);
        alloc_text_end(reason);
        TEST_ASSERT_EQUAL_MESSAGE(points[i].good, good, text[1]);
        TEST_ASSERT_EQUAL(good, text[1][0] == '\0');
        TEST_ASSERT_TRUE(strlen(text[0]) > 2 && strchr(text[0], '\r') != NULL);
        free(text[0]);
        free(text[1]);
        made_sweep_close(&m);
    }
}

static void test_given_back(void) {
    static void (*const rounds[])(void) = {run_points, test_headers, test_settings};
    for (size_t i = 0; i < sizeof rounds / sizeof rounds[0]; i++) {
        long before = 0;
        for (int round = 0; round < (i == 0 ? 2 : 1); round++) { /* the others had one before */
            before = blocks_in_use();
            rounds[i]();
        }
        TEST_ASSERT_TRUE(blocks_in_use() == before);
    }
}

SUITE(sweep_settings) {
    die = dice_of("sweep_settings", 63);
    RUN_TEST(test_headers);
    RUN_TEST(test_settings);
    RUN_TEST(test_given_back);
}
