/* test_stepping.c: the measures of one run of a sweep (host/study/point.h), compared with closed forms: the choice
 * of samples, early ends, and runs without measures. Also settings of a sweep. */
#include "host/base/alloc.h"
#include "host/check/run_checks.h"
#include "host/check/slow.h"
#include "host/cli/commands.h"
#include "host/os/system.h"
#include "host/study/point.h"
#include "host/study/session.h"

#include "command.h"
#include "derived.h"
#include "made_sweep.h"

/* === suite stepping =========================================================================== */

#define PI 3.14159265358979323846

enum { MEASURES_MOST = 8 };

static dice die;

typedef struct measured_point {
    bool good;
    double value[MEASURES_MOST + 1];
    point_notes notes;
    char *reason;
    char *errors;
} measured_point;

/* Measures one run of the scene in the text. */
static measured_point measured_run(const char *text, const char *const *asked, int count,
                                   const engine_kind *kind, double from_s) {
    made_sweep m;
    measured_point p = {.reason = NULL};
    size_t length[2];
    made_sweep_open(&m, text, NULL, 0, asked, count, kind);
    m.sweep.from_s = from_s;
    FILE *reason = alloc_text(&p.reason, &length[0]);
    FILE *out = alloc_text(&p.errors, &length[1]);
    p.good = sweep_measure(&m.sweep, m.image, p.value, m.errors, reason, &p.notes);
    diags_flush(m.errors, out);
    alloc_text_end(reason);
    alloc_text_end(out);
    made_sweep_close(&m);
    return p;
}

static void drop(measured_point *p) {
    free(p->reason);
    free(p->errors);
}

static const engine_kind *drawn_kind(void) {
    return dice_one_of(&die, 2) == 0 ? &engine_float : &engine_double;
}

enum { TEXT = 1000 };
static void drawn_swing(double *omega_radps, char text[TEXT]) {
    const double k = dice_between(&die, 250.0, 900.0);
    *omega_radps = sqrt(k / 2.0);
    snprintf(text, TEXT,
             "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
             "T = 1 [kg]*x'^2 + 0.5 [kg*m^2]*a'^2\nV = %.17g [N/m]*x^2/2\n"
             "output both [m] = 2*x + 0.1 [m]*sin(a)\noutput rate [m/s] = x'\n"
             "output little [m] = 1 [m] + 1e-9*x\n"
             "scene s { start x = 0.5 [m], a' = %.6f [rad/s]; step 1 [ms]; until %.4f [s] }\n",
             k, dice_between(&die, -3.0, 3.0), dice_between(&die, 1.5, 3.0));
}

/* The period must be that of the spring, whatever the other measures are. */
TEST(stepping, period) {
    char text[TEXT];
    double omega_radps;
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        static const char *const asked[] = {"both", "period(rate)", "period(x)"};
        drawn_swing(&omega_radps, text);
        measured_point p = measured_run(text, asked, 3, drawn_kind(), 0.1);
        TEST_ASSERT_TRUE_MESSAGE(p.good, p.reason);
        for (int i = 1; i < 3; i++) {
            TEST_ASSERT_TRUE(fabs(p.value[i] * omega_radps / (2.0 * PI) - 1.0) < 1e-3);
        }
        drop(&p);
    }
    /* a small swing must have a period if its number type resolves it */
    static const char *const little[] = {"both", "rate", "period(little)"};
    const engine_kind *const kinds[] = {&engine_float, &engine_double};
    drawn_swing(&omega_radps, text);
    for (int i = 0; i < 2; i++) {
        measured_point p = measured_run(text, little, 3, kinds[i], 0.0);
        TEST_ASSERT_TRUE(i == 0 ? isnan(p.value[2])
                                : fabs(p.value[2] * omega_radps / (2.0 * PI) - 1.0) < 1e-3);
        TEST_ASSERT_TRUE_MESSAGE(p.good, p.reason);
        drop(&p);
    }
}

#define CLOCK "mechanism m\nstate x [s]\nequation x' = 1\n"

/* If the run is interrupted, its measures must cover the steps until then. */
TEST(stepping, given_up) {
    static const char *const most = "max(x)";
    interrupted = 1;
    measured_point p =
        measured_run(CLOCK "scene s { start x = 3 [s]; step 1 [ms]; until 200000 [s] }\n", &most, 1,
                     &engine_double, 0.0);
    interrupted = 0;
    /* value[1] is the energy residual; this mechanism has no energies */
    TEST_ASSERT_TRUE(p.good && p.value[0] == 3.0 && isnan(p.value[1]));
    drop(&p);
}

/* Runs to 1 s with this measure, and runs without it, which give a reason. */
TEST(stepping, failed) {
    static const struct {
        const char *text;
        const char *measure;
        double from_s;
        const char *reason; /* "": the measure is 1 */
    } rows[] = {
        {CLOCK "scene s { step 1 [ms]; until 1 [s] }\n", "mean(x)", 1.5,
         "--from 1.5 s is after the last step"},
        /* needs no series, so any --from is accepted */
        {CLOCK "scene s { step 1 [ms]; until 1 [s] }\n", "x", 1.5, ""},
        /* begins at the end: one sample */
        {CLOCK "scene s { step 1 [ms]; until 1 [s] }\n", "max(x)", 1.0, ""},
        {CLOCK "scene s { step 1 [ms]; until 100000 [s] }\n", "period(x)", 0.0,
         "period() takes at most 1e+08 samples: use a later --from or a larger step"},
        {"mechanism m\nstate x\nequation x' = -1 [1/s]\n"
         "scene s { start x = 0.4995; step 1 [ms]; until 1 [s] }\n",
         "log(x)", 0.0,
         "the expression of the measure 'log(x)' is not a finite number at every step"},
        /* each sample is finite, but not the sum of all samples */
        {"mechanism m\nstate x\nequation x' = 0*x/(1 [s])\n"
         "scene s { step 1 [ms]; until 0.1 [s] }\n",
         "mean(1e308*(1 + x))", 0.0,
         "the measure 'mean(1e308*(1 + x))' is not a finite number: the values of its expression are too large"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        measured_point p =
            measured_run(rows[i].text, &rows[i].measure, 1, &engine_double, rows[i].from_s);
        TEST_ASSERT_EQUAL_STRING(rows[i].reason, p.reason);
        TEST_ASSERT_EQUAL(rows[i].reason[0] == '\0', p.good);
        TEST_ASSERT_TRUE(!p.good || fabs(p.value[0] - 1.0) < 1e-12);
        TEST_ASSERT_EQUAL_STRING("", p.errors);
        drop(&p);
    }
}

/* Measures of `whirl sweep` over whole runs with closed forms: of coordinates, outputs and expressions, from the
 * start or later, with few steps. */

/* Writes a free motion x = a + v t with n steps. */
static void write_free(char *text, size_t size, double a, unsigned steps) {
    snprintf(text, size,
             "mechanism free\ncoordinate x [m]\ncoordinate b [rad]\nparameter u = 1 [m]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*b'^2/2\noutput twice [m] = 2*x\n"
             "scene s { start x = %.17g [m], b' = 0.25 [rad/s]\nstep 0.125 [s]\n"
             "until %.17g [s] }\n",
             a, 0.125 * steps);
}

static const char *const measures_stepping[] = {"x",           "mean(x)",     "max(x)",
                                                "min(twice)",  "mean(twice)", "amplitude(x)",
                                                "mean(x^2/u)", "max(-twice)", "max(b)"};
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
    /* the mean over the chords of the parabola exceeds that over the curve by v^2 h^2/6, with h = 0.125 s */
    case 6:
        return (first * first + first * last + last * last) / 3.0 +
               (n > 0.0 ? v * v * 0.125 * 0.125 / 6.0 : 0.0);
    case 7: return -2.0 * fmin(first, last);
    default: return 0.25 * end_s;
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

/* === suite sweep_settings ===================================================================== */
/* A sweep's header, the settings that are stored beside its file, and its points as workers run them. */

static const char settings_text[] =
    "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\nparameter m = 2 [kg]\ninput u = 3 [N]\n"
    "T = m*x'^2/2 + 1 [kg*m^2]*a'^2/2\nQ(x) = u\neffect drag \"d\" { parameter b = 4 [N*s/m]; "
    "F += b*x'^2/2 }\n"
    "effect tug { F += 1 [N*s/m]*x'^2 }\nscene s { step 1 [ms]; until 3 [s] }\n";

/* The stored settings of a sweep. If bit k of `changed` is set, setting k differs: a number by one unit in the last
 * place. */
enum { SETTINGS = 18 };
static char *fingerprint_of(unsigned changed) {
    static const char *const axes[2][2] = {{"x=1..9:9", "m=0.1..7:70,log"},
                                           {"x=1..9:10", "m=0.1..7:70"}};
    static const char *const asked[2][2] = {{"max(x)", "a"}, {"max(x)", "2*a"}};
#define IS(k) (changed >> (k)&1U)
#define NUMBER(k) (IS(k) ? 0x1.0000000000001p0 : 1.0)
    made_sweep m;
    const char *const over[2] = {axes[IS(0)][0], axes[IS(1)][1]};
    made_sweep_open(&m, settings_text, over, 2, asked[IS(2)], 2,
                    IS(3) ? &engine_float : &engine_double);
    instance *base = m.d.instance;
    base->parameter[0] = NUMBER(4);
    base->input[0] = NUMBER(5);
    base->start[0][0] = NUMBER(6);
    base->start[1][1] = NUMBER(7);
    base->with[0] = IS(8);
    base->step_s = NUMBER(9);
    base->until_s = NUMBER(10);
    m.sweep.from_s = NUMBER(11);
    m.sweep.engine.compensated = IS(12);
    m.sweep.engine.method = IS(13) ? WH_HEUN : WH_RK4;
    m.sweep.engine.matrix = IS(14) ? MATRIX_EXACT : MATRIX_NONE;
    m.sweep.engine.tables = IS(15) ? TABLES_LINEAR : TABLES_NONE;
    const shard part = {IS(16) ? 2 : 1, 3};
    char *made = fingerprint_make(&m.sweep, IS(17) ? "text" : "other", base, m.image, part);
#undef IS
#undef NUMBER
    made_sweep_close(&m);
    return made;
}

/* A sweep can only be resumed with the same settings. So each setting that affects the rows must change the stored
 * text. */
TEST(sweep_settings, settings) {
    char *first = fingerprint_of(0);
    char *again = fingerprint_of(0);
    TEST_ASSERT_EQUAL_STRING(first, again);
    for (unsigned k = 0; k < SETTINGS; k++) {
        char *other = fingerprint_of(1U << k);
        TEST_ASSERT_TRUE_MESSAGE(strcmp(first, other) != 0, other);
        free(other);
    }
    free(first);
    free(again);
}

/* Runs points as workers do, but in this process. Each way in which a point can end occurs. */
TEST(sweep_settings, points) {
    static const struct {
        const char *text;
        const char *over;
        const char *measure;
        bool good;
    } points[] = {
        {made_sweep_floor, "x=-1..1:2", "x", false},        /* the start is refused */
        {made_sweep_floor, "x=1..2:2", "period(x)", true},  /* a point without a period is good */
        {made_sweep_floor, "x=0..2:2", "mean(1/x)", false}, /* 1/x is infinite at x = 0 */
        /* these scenes are derived again for each point */
        {settings_text, "m=1..2:2", "max(x)", true},
        {settings_text, "m=0..2:2", "max(x)", false}, /* mass 0 is refused */
        {"mechanism m\nstate x\nequation x' = 1 [1/s]*x^2\nscene s { step 1 [ms]; until 2 [s] }\n",
         "x=4..1:2", "x", false}, /* the run diverges */
        {"mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [J]*sqrt(x/(1 [m]))\n"
         "scene s { step 1 [ms]; until 2 [s] }\n",
         "x=-1..1:2", "x", false}, /* the output is undefined */
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
