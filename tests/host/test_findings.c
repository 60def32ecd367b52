/* test_findings.c: findings of short runs and of small numbers, compared with closed forms; the report of a sweep;
 * each finding on both sides of its limit. */
#include "host/base/exit.h"
#include "host/check/finding.h"
#include "host/cli/commands.h"
#include "host/engine/engine.h"

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "json_check.h"
#include "made_sweep.h"

static dice die;

/* === suite short_runs ========================================================================= */
/* Runs of one to nine steps, compared with closed forms: a force or a spring pulls a body back, with or without a
 * stop that is not reached. The energy balance integrates pairs of steps, and an odd number leaves the last step
 * without a pair. Accurate runs must cause no warning, and wrong runs must not be trusted. */

typedef struct short_run {
    double swing_radps;
    double start_m;
    double step_s;
    int steps;
    bool by_force; /* true: a force pulls, and does work; false: a spring */
    bool stop;
    double beside_N; /* force on a second, falling body, which may have most of the energy */
} short_run;

static short_run draw(dice *d) {
    short_run r = {.start_m = pow(10.0, dice_between(d, -3.0, 1.0)),
                   .step_s = pow(10.0, dice_between(d, -4.0, -1.0)),
                   .steps = 1 + (int)(dice_one_of(d, 4) == 0 ? 0 : dice_one_of(d, 9)),
                   .by_force = dice_one_of(d, 3) > 0,
                   .stop = dice_one_of(d, 2) == 0};
    r.swing_radps = pow(10.0, dice_between(d, -2.5, 0.5)) / r.step_s;
    r.beside_N = dice_one_of(d, 2) == 0 ? 0.0 : 1e3 * r.swing_radps * r.swing_radps * r.start_m;
    return r;
}

static void write(const short_run *r, char *text, size_t size) {
    char stop[80] = "";
    char law[160];
    const double stiffness = r->swing_radps * r->swing_radps;
    snprintf(law, sizeof law,
             r->by_force ? "Q(x) = -%.17g [N/m]*x\nV = -%.17g [N]*z"
                         : "V = %.17g [N/m]*x^2/2 - %.17g [N]*z",
             stiffness, r->beside_N);
    if (r->stop) {
        snprintf(stop, sizeof stop, "stop x >= -%.17g [m] restitution 0.3\n", 1000.0 * r->start_m);
    }
    snprintf(text, size,
             "mechanism short\ncoordinate x [m]\ncoordinate z [m]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg]*z'^2/2\n%s\n%s"
             "scene s { start x = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             law, stop, r->start_m, r->step_s, r->steps * r->step_s);
}

/* Largest error, relative to the ranges of position and rate. */
static double off_by(const short_run *r, const char *csv) {
    double off[2] = {0.0, 0.0};
    double low[2] = {r->start_m, 0.0};
    double high[2] = {r->start_m, 0.0};
    double value[5]; /* time, two positions, two rates */
    for (const char *row = csv; (row = said_row(row, 5, value)) != NULL;) {
        const double phase = r->swing_radps * value[0];
        const double is[2] = {r->start_m * cos(phase), -r->start_m * r->swing_radps * sin(phase)};
        for (int i = 0; i < 2; i++) {
            off[i] = fmax(off[i], fabs(value[1 + 2 * i] - is[i]));
            low[i] = fmin(low[i], is[i]);
            high[i] = fmax(high[i], is[i]);
        }
    }
    return fmax(off[0] / (high[0] - low[0]), off[1] / (high[1] - low[1]));
}

static void hold(const char *number) {
    dice d = dice_of("short runs", 4463);
    const unsigned cases = dice_cases(few_or_all(usual_or(200, 50), 1000));
    unsigned wrong = 0;
    unsigned right = 0;
    for (unsigned i = 0; i < cases; i++) {
        const short_run r = draw(&d);
        char text[600];
        said what;
        write(&r, text, sizeof text);
        COMMAND_SAY(command_run, &what, model_keep(text), "--number", number, "--csv", "-");
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const double off = off_by(&r, what.out);
        const bool warns = strstr(what.err, "warning: ") != NULL;
        if (off > 0.03) {
            wrong++;
            TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "to the end: every"), text);
            TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "[aliased]"), text); /* nothing is faster */
        } else if (off < 3e-4) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(warns, what.err);
        }
    }
    model_drop();
    printf("  %s: of %u short runs %u right, none warned of; %u off, none trusted to the end\n",
           number, cases, right, wrong);
    TEST_ASSERT_TRUE(right > cases / 3 && wrong > cases / 20);
}

TEST(short_runs, in_float) { hold("float"); }
TEST(short_runs, in_double) { hold("double"); }

/* === suite small_motions ====================================================================== */
/* The figures in reports on small numbers: an angle that moves by a few of its units in a step (host/check/slow.h),
 * and a motion of a few of float's smallest numbers. */

static void expect_figure(double wanted, double is, const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 0.06 * wanted, text);
}

/* In each step, the run rounds the angle's motion to a whole number of units of 2^-32 turn. */
TEST(small_motions, slow_angles) {
    for (unsigned n = 0; n < dice_cases(usual_or(16, 6)); n++) {
        char text[400];
        double figure[3] = {0.0};
        said what;
        const double unit_rad = 2.0 * 3.14159265358979323846 / 4294967296.0;
        const double part = (double)(n % 4U) + dice_between(&die, n % 4U == 0 ? 0.15 : -0.45, 0.45);
        const double step_s = dice_between(&die, 0.001, 0.1);
        const unsigned steps = 200 + dice_one_of(&die, 300);
        const double off_rad = fabs(nearbyint(part) - part) * unit_rad * steps;
        const double span_rad = part * unit_rad * steps;
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\n"
            "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n"
            "scene s { start a' = %.17g [rad/s], x' = 1 [m/s]; step %.17g [s]; until %.17g [s] }\n",
            part * unit_rad / step_s, step_s, step_s * steps);
        for (int compensated = 0; compensated < 2; compensated++) {
            COMMAND_SAY(command_run, &what, model_keep(text), "--quiet", "--number", "float",
                        compensated > 0 ? "--compensated" : NULL);
            TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
            if (off_rad < 1.02e-3 * span_rad || off_rad < 3.1e-9 || compensated > 0) {
                continue;
            }
            const char *note = strstr(what.err, "whirl run: note:");
            TEST_ASSERT_NOT_NULL_MESSAGE(note, what.err);
            const char *at = said_exactly(
                note,
                "whirl run: note: 'a' turns so slowly that rounding its change in each step to 1.5e-9 "
                "rad, as float does, causes an error of up to ");
            at = said_exactly(said_number(at, &figure[0]), " rad (");
            at = said_exactly(said_number(at, &figure[1]), " % of its true change, ");
            at = said_exactly(
                said_number(at, &figure[2]),
                " rad)\nhint: use --compensated or a larger --step: both reduce round-off\n");
            TEST_ASSERT_TRUE_MESSAGE(
                *at == '\0' || strncmp(at, "whirl run: exit status 1 ", 25) == 0, at);
            expect_figure(off_rad, figure[0], what.err);
            expect_figure(100.0 * off_rad / span_rad, figure[1], what.err);
            expect_figure(span_rad, figure[2], what.err);
        }
        TEST_ASSERT_EQUAL_STRING("", what.err);
    }
    model_drop();
}

/* A spring with a start value of 2e-44 to 1e-36 m, so that products of rates are too small for float. Whirl must report round-off if it is above a twentieth of the start value, and must be silent below
 * 1e-4. */
TEST(small_motions, small_numbers) {
    unsigned told = 0;
    for (unsigned n = 0; n < dice_cases(usual_or(40, 20)); n++) {
        char text[400];
        said what;
        const double size = exp(dice_between(&die, log(2e-44), log(n % 3U == 0 ? 1e-36 : 1e-42)));
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N/m]*x^2/2\n"
                 "scene s { start x = %.17g [m]; step 10 [ms]; until 2 [s] }\n",
                 n % 2U == 0 ? 1.0 : 9.0, size);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        void *run = engine_float.start(d.image);
        double off = 0.0;
        const double w = n % 2U == 0 ? 1.0 : 3.0;
        for (int i = 1; i <= 200; i++) {
            double real[2];
            TEST_ASSERT_EQUAL_INT(WH_OK, engine_float.step(run));
            engine_float.state(run, NULL, real);
            off = i <= 50 ? fmax(off, fabs(real[0] - size * cos(w * 0.01 * i)) / size) : off;
        }
        engine_float.stop(run);
        derived_free(&d);
        COMMAND_SAY(command_run, &what, model_keep(text), "--quiet", "--number", "float");
        const bool is_told = strstr(what.err, "[accuracy]") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(off < 0.05 || is_told, what.err);
        TEST_ASSERT_TRUE_MESSAGE(off > 1e-4 || what.err[0] == '\0', what.err);
        told += is_told ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(told > 3);
    model_drop();
}

/* A damper whose power is too small for float. Because of the stop, the run itself computes the energy balance. The
 * motion is right, so the balance must not be reported. */
TEST(small_motions, lost_powers) {
    for (unsigned n = 0; n < dice_cases(8); n++) {
        char text[300];
        said what;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate y [m]\nT = 1 [kg]*y'^2/2\nF = %.3g [N*s/m]*y'^2/2\n"
                 "stop y >= -1 [m] restitution 0.5\n"
                 "scene s { start y' = %.3g [m/s]; step 10 [ms]; until 1 [s] }\n",
                 dice_between(&die, 0.05, 0.2), dice_between(&die, 3e-22, 1e-21));
        COMMAND_SAY(command_run, &what, model_keep(text), "--quiet", "--number", "float");
        TEST_ASSERT_EQUAL_STRING_MESSAGE("", what.err, text);
    }
    model_drop();
}

SUITE(small_motions) { die = dice_of("small_motions", 90); }

/* === suite sweep_failures ===================================================================== */

static unsigned times_in(const char *text, const char *words) {
    unsigned times = 0;
    for (const char *at = strstr(text, words); at != NULL; at = strstr(at + 1, words)) {
        times++;
    }
    return times;
}

/* A start below the floor fails its point of the sweep. The first twenty failures must be listed in sequence, then
 * that there are more. */
TEST(sweep_failures, failures) {
    for (unsigned below = 19; below <= 21; below++) {
        char over[60];
        char wanted[200];
        said what;
        snprintf(over, sizeof over, "x=-%u..3:%u", below, below + 4);
        COMMAND_SAY(command_sweep, &what, model_keep(made_sweep_floor), "--over", over, "--quiet");
        const char *at = what.err;
        for (unsigned i = 0; i < 20 && i < below; i++) {
            snprintf(wanted, sizeof wanted,
                     "error: point %u (x=-%u): the run starts beyond this stop, by %u m", i + 1,
                     below - i, below - i);
            at = strstr(at, wanted);
            TEST_ASSERT_NOT_NULL_MESSAGE(at, what.err);
        }
        TEST_ASSERT_EQUAL_UINT(below < 20 ? below : 20, times_in(what.err, "error: point "));
        TEST_ASSERT_EQUAL_UINT(below > 20, times_in(what.err, "\nfurther failures are not listed"));
        snprintf(wanted, sizeof wanted, "error: %u of %u points failed", below, below + 4);
        TEST_ASSERT_EQUAL_UINT(1, times_in(what.err, wanted));
        TEST_ASSERT_EQUAL_INT(EXIT_RUN_FAILED, what.status);
    }
    model_drop();
}

/* === suite thresholds ========================================================================= */
/* Each finding on both sides of its limit (host/check/finding.h). A scene has one parameter, and is silent at one
 * end of a range and reported at the other. Bisection finds the parameter at the limit. On one side of it the
 * finding must be reported, with a value just beyond the limit; on the other side nothing. The parameter at the
 * limit is known, mostly in closed form, so a limit that is wrong by 5 % fails. The suites pole, missed and busy
 * have the findings that count steps. */

enum { TEXT = 1200, HALVINGS = 24 };

/* %1$.17g is the parameter. Values from `silent` to `told`, and somewhat beyond, are tried. */
static const struct {
    finding_id id;
    const char *number;
    double silent;
    double told;
    double at; /* the parameter at the limit; 0: not known */
    double limit;
    const char *text;
} rows[] = {
    {FINDING_ENERGY, "double", 0.1, 10.0, 0.4335, 1e-3, /* energy error N (h w)^6/72 */
     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %1$.17g [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]\nstep 0.5 [s]\nuntil 40 [s] }\n"},
    {FINDING_ACCURACY, "double", 0.1, 4.0, 2.728, 0.5, /* phase error w t (h w)^4/120: 1 % */
     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %1$.17g [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]\nstep 0.25 [s]\nuntil 100 [s] }\n"},
    {FINDING_MASS, "double", 1e-10, 1e-13, 4e-12, 1e-4,
     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"
     "T = %1$.17g [kg]*x'^2/2 + 1 [kg]*(x' + y')^2/2\n"
     "V = 1 [N/m]*(x + y)^2/2 + %1$.17g [N/m]*x^2/2\n"
     "scene s { start y = 1 [m]\nstep 1 [ms]\nuntil 0.1 [s] }\n"},
    {FINDING_ALIASED, "double", 1e-5, 1.0, 1e-3, 1e-3,
     "mechanism m\ncoordinate x [m]\ncoordinate t [s]\nT = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
     "Q(x) = 1 [N] + %1$.17g [N]*cos(2*pi*400 [Hz]*t)\n"
     "scene s { start x' = 1 [m/s], t' = 1\nstep 10 [ms]\nuntil 2 [s] }\n"},
    {FINDING_APART, "double", 1e-8, 1e-4, 1.25e-6, 1e-6, /* 0.8 of the gap is along the rod */
     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
     "V = 9.81 [N]*y\nhold sqrt(x^2 + y^2) - 1 [m] while 1 > 0\n"
     "scene s { start x = 0.6 [m], y = 0.8 [m] + %1$.17g [m]\nstep 1 [ms]\nuntil 20 [ms] }\n"},
    {FINDING_DIGITS, "float", 1e-2, 1e-6, 0.0, 1e-3,
     "mechanism m\ncoordinate q [rad]\nT = 1 [kg*m^2]*q'^2/2\nV = 1e-9 [J]*cos(q)\n"
     "scene s { start q' = %1$.17g [rad/s]\nstep 1 [ms]\nuntil 2 [s] }\n"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* The value of the finding in the report; NaN if it is not reported. */
static double told_by(unsigned row, double parameter) {
    static said what;
    char text[TEXT];
    char value[100];
    snprintf(text, sizeof text, rows[row].text, parameter);
    COMMAND_SAY(command_run, &what, model_keep(text), "--json", "--number", rows[row].number);
    const int count = json_length(what.out, "findings");
    TEST_ASSERT_TRUE_MESSAGE(count >= 0, what.err);
    for (int i = 0; i < count; i++) {
        char path[60];
        snprintf(path, sizeof path, "findings/%d/id", i);
        if (strcmp(json_value(what.out, path, value), finding_rows[rows[row].id].word) == 0) {
            snprintf(path, sizeof path, "findings/%d/value", i);
            return strtod(json_value(what.out, path, value), NULL);
        }
    }
    return (double)NAN;
}

TEST(thresholds, both_sides_of_each_limit) {
    dice d = dice_of("thresholds", 4703);
    for (unsigned i = 0; i < ROWS; i++) {
        const double limit = rows[i].limit;
        const char *word = finding_rows[rows[i].id].word;
        const double off = rows[i].told > rows[i].silent ? 1.0 : -1.0;
        double silent = rows[i].silent * pow(2.0, -off * dice_between(&d, 0.0, 1.0));
        double told = rows[i].told * pow(2.0, off * dice_between(&d, 0.0, 1.0));
        TEST_ASSERT_TRUE_MESSAGE(isnan(told_by(i, silent)), word);
        TEST_ASSERT_FALSE_MESSAGE(isnan(told_by(i, told)), word);
        for (int k = 0; k < HALVINGS; k++) {
            const double middle = sqrt(silent * told);
            *(isnan(told_by(i, middle)) ? &silent : &told) = middle;
        }
        const double value = told_by(i, told);
        TEST_ASSERT_TRUE_MESSAGE(finding_rows[rows[i].id].limit == limit, word);
        const bool below = rows[i].id == FINDING_ACCURACY;
        printf("  %-9s limit %g %s, told from %.6g on\n", word, limit,
               finding_rows[rows[i].id].unit, value);
        TEST_ASSERT_TRUE_MESSAGE(below ? value <= limit : value >= limit, word);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.02 * limit, limit, value, word);
        TEST_ASSERT_TRUE_MESSAGE(rows[i].at == 0.0 || fabs(told / rows[i].at - 1.0) < 0.02, word);
    }
    model_drop();
}

/* Bodies cross a hill in a few steps. The energy residual exceeds its limit at the end, or only before it: there the
 * limit is larger. */
TEST(thresholds, json_has_the_limit_of_the_message) {
    dice d = dice_of("limits", 30112026);
    int seen[2] = {0, 0};                                   /* findings at the end, before it */
    double least[2] = {(double)INFINITY, (double)INFINITY}; /* of value / limit */
    for (unsigned i = 0; i < 300; i++) {
        static said what;
        char text[TEXT];
        char limit[100];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                 "V = %.17g [J]*exp(-(x/0.1 [m])^2)\n"
                 "scene s { start x = -0.5 [m], x' = 2 [m/s]\nstep %.17g [ms]\nuntil 1.2 [s] }\n",
                 dice_between(&d, 0.3, 1.9), dice_between(&d, 35.0, 60.0));
        COMMAND_SAY(command_run, &what, model_keep(text), "--json");
        const char *message = strstr(what.out, "the energy balance fails");
        if (message != NULL) {
            json_value(what.out, "findings/0/limit", limit);
            const double in_message = strtod(strstr(message, "(limit ") + strlen("(limit "), NULL);
            TEST_ASSERT_TRUE_MESSAGE(in_message == strtod(limit, NULL), what.out);
            const int before = strstr(message, "residual reached") != NULL;
            const double value = strtod(json_value(what.out, "findings/0/value", limit), NULL);
            least[before] = fmin(least[before], value / in_message);
            seen[before]++;
        }
    }
    for (int k = 0; k < 2; k++) {
        printf("  %s: %d, the least %.3g of the limit\n", k == 0 ? "at the end" : "before it",
               seen[k], least[k]);
        TEST_ASSERT_TRUE(seen[k] > 5 && least[k] >= 1.0 && least[k] < 1.3);
    }
    model_drop();
}
