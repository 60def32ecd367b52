/* test_aliasing.c: forces that are faster than a step. Frequencies and steps are round numbers, so a step is often a
 * whole number of periods and every stage sees the same force. Masses on springs, free masses and low passes have
 * closed forms. A ripple on a slow force adds up to a drift, and so does a ripple in the normal force of a friction.
 * Wrong runs must have a warning and must not be trusted to the end; right runs must have no warning; the remedy
 * that a warning names must work. */
#include "host/cli/commands.h"

#include "command.h"
#include "named_cures.h"

/* === suite aliasing =========================================================================== */

#define TURN 6.283185307179586
/* A run is wrong if its error is larger than this part of the true or the computed motion. */
#define WRONG 0.05
#define RIGHT 1e-3

typedef enum driven_kind { SPRING, FREE, LOW_PASS, KINDS } driven_kind;

typedef struct driven {
    driven_kind kind;
    double frequency_Hz;
    double step_s;
    double phase;
    double rate; /* natural frequency of the spring, rad/s, or rate of the low pass, 1/s */
    double until_s;
    char text[700];
} driven;

static double round_of(dice *d, double low, double high) {
    static const double digits[] = {1.0, 2.0, 2.5, 4.0, 5.0};
    return digits[dice_one_of(d, 5)] * pow(10.0, floor(dice_between(d, low, high)));
}

/* If `whole`, half a step is a whole number of periods too, so the half-step run makes the same error. */
static driven drawn(dice *d, driven_kind kind, bool whole) {
    driven m = {.kind = kind,
                .frequency_Hz = round_of(d, 1.0, 4.0),
                .step_s = round_of(d, -4.0, -1.0),
                .phase = dice_between(d, 0.0, TURN)};
    const double steps = 200.0 * (1 + dice_one_of(d, 5));
    if (whole) {
        m.frequency_Hz = 4.0 * (1 + dice_one_of(d, 4)) / m.step_s;
    }
    m.until_s = steps * m.step_s;
    m.rate = dice_between(d, 1.0, 10.0) / m.until_s;
    static const char *const bodies[KINDS] = {
        "coordinate x [m]\ncoordinate t [s]\nT = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
        "V = 1 [kg]*R^2*x^2/2\nQ(x) = 1 [N]*cos(W*t + p)\nscene s { start t' = 1\n",
        "coordinate x [m]\ncoordinate t [s]\nT = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
        "Q(x) = 1 [N]*cos(W*t + p)\nscene s { start t' = 1\n",
        "state x [m]\nstate t [s]\nequation t' = 1\nequation x' + R*x = R*1 [m]*cos(W*t + p)\n"
        "scene s { \n"};
    snprintf(m.text, sizeof m.text,
             "mechanism driven\nparameter W = 2*pi*%.17g [Hz]\nparameter p = %.17g\n"
             "parameter R = %.17g [1/s]\n%sstep %.17g [s]\nuntil %.17g [s] }\n",
             m.frequency_Hz, m.phase, m.rate, bodies[kind], m.step_s, m.until_s);
    return m;
}

static double truth(const driven *m, double t) {
    const double w = TURN * m->frequency_Hz;
    const double c = cos(m->phase);
    const double s = sin(m->phase);
    const double now = w * t + m->phase;
    if (m->kind == FREE) {
        return (c - cos(now)) / (w * w) - s * t / w;
    }
    if (m->kind == SPRING) {
        const double r = m->rate;
        return (cos(now) - c * cos(r * t) + w / r * s * sin(r * t)) / (r * r - w * w);
    }
    const double r = m->rate;
    const double all = r * r + w * w;
    return r * (r * cos(now) + w * sin(now) - exp(-r * t) * (r * c + w * s)) / all;
}

static double range_of(const driven *m) {
    double most = 0.0;
    for (int k = 0; k <= 4000; k++) {
        most = fmax(most, fabs(truth(m, m->until_s * (k + 0.37 * (k % 2)) / 4000.0)));
    }
    return most;
}

static void run_with(const char *text, const named_cure *cure, bool is_float, said *what) {
    const char *words[12] = {model_keep(text)};
    named_words(cure, "rk4", is_float ? "float" : "double", words, 1);
    command_say(command_run, words, what);
    model_drop();
}

static double x_of(const said *what) {
    const char *at = strstr(what->out, "\n  x ");
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what->err);
    return strtod(at + 5, NULL);
}

static bool told(const said *what) { return strstr(what->err, "[aliased]") != NULL; }

static bool trusted(const said *what) { return strstr(what->out, "to the end: every") != NULL; }

TEST(aliasing, wrong_runs_are_warned_of) {
    static const named_cure none;
    dice d = dice_of("aliasing", 20261127);
    const unsigned cases = dice_cases(few_or_all(usual_or(36, 12), 600));
    unsigned wrong = 0;
    unsigned by_this = 0;
    unsigned right = 0;
    for (unsigned i = 0; i < cases; i++) {
        const driven m = drawn(&d, (driven_kind)(i % KINDS), i % 4 == 1);
        const bool is_float = i % 4 == 3;
        said what;
        run_with(m.text, &none, is_float, &what);
        const double is = x_of(&what);
        const double off = fabs(is - truth(&m, m.until_s)) / fmax(range_of(&m), fabs(is));
        char about[SAID_SIZE + 900];
        snprintf(about, sizeof about, "%.3g Hz, off by %.3g:\n%s%s", m.frequency_Hz, off, m.text,
                 what.err);
        if (off > WRONG) {
            named_cure list[NAMED_CURES];
            wrong++;
            by_this += told(&what);
            TEST_ASSERT_TRUE_MESSAGE(what.err[0] != '\0', about);
            TEST_ASSERT_FALSE_MESSAGE(trusted(&what), about);
            if (told(&what)) {
                said trust;
                COMMAND_SAY(command_trust, &trust, model_keep(m.text), "--number",
                            is_float ? "float" : "double");
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(trust.out, "\ntrusted until t = 0 s of "),
                                             about);
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(trust.out, "the steps alias a fast force"),
                                             trust.out);
            }
            if (named_cures(what.err, list) > 0 && list[0].tried) {
                said then;
                run_with(m.text, &list[0], is_float, &then);
                const double left_m = fabs(x_of(&then) - truth(&m, m.until_s));
                const bool all = trusted(&then);
                TEST_ASSERT_TRUE_MESSAGE(!told(&then), about);
                /* the error: below the true range plus 5 % of the first result; if trusted, below 5 % of the range */
                TEST_ASSERT_TRUE_MESSAGE(left_m < WRONG * fabs(is) + range_of(&m), about);
                TEST_ASSERT_TRUE_MESSAGE(!all || left_m < WRONG * range_of(&m), about);
            }
        } else if (off < RIGHT) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(told(&what), about);
        }
    }
    TEST_ASSERT_TRUE(wrong > cases / 5 && 3 * by_this >= wrong && right > cases / 10);
}

TEST(aliasing, sweeps_count_aliased_points) {
    dice d = dice_of("aliasing, swept", 20261201);
    unsigned counted = 0;
    for (unsigned i = 0; i < 12 && counted < 3; i++) {
        static const named_cure none;
        const driven m = drawn(&d, (driven_kind)(i % KINDS), true);
        char over[80];
        said what;
        run_with(m.text, &none, false, &what);
        if (!told(&what)) {
            continue;
        }
        snprintf(over, sizeof over, "R=%.17g..%.17g:2", m.rate, 1.001 * m.rate);
        COMMAND_SAY(command_sweep, &what, model_keep(m.text), "--over", over);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "2 of 2 points alias a force"), what.err);
        counted++;
    }
    model_drop();
    TEST_ASSERT_EQUAL_UINT(3, counted);
}

/* A small fast ripple on a slow force. A step is a whole number of ripple periods, so the steps see a constant force
 * instead of the ripple, and the error grows. */
TEST(aliasing, small_ripples) {
    static const named_cure none;
    dice d = dice_of("aliasing, ripples", 20261129);
    const unsigned cases = dice_cases(usual_or(24, 8));
    unsigned wrong = 0;
    unsigned right = 0;
    for (unsigned i = 0; i < cases; i++) {
        const double step_s = round_of(&d, -4.0, -2.0);
        const double until_s = 1000.0 * (1 + dice_one_of(&d, 5)) * step_s;
        const double slow = TURN * dice_between(&d, 1.0, 8.0) / until_s;
        const double fast = TURN * (double)(1U + dice_one_of(&d, 8)) / step_s;
        const double part = i % 4 == 3 ? 0.0 : pow(10.0, dice_between(&d, -3.5, -0.5));
        char text[700];
        said what;
        snprintf(text, sizeof text,
                 "mechanism rippled\ncoordinate x [m]\ncoordinate t [s]\n"
                 "T = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
                 "Q(x) = 1 [N]*cos(%.17g [1/s]*t) + %.17g [N]*cos(%.17g [1/s]*t)\n"
                 "scene s { start t' = 1\nstep %.17g [s]\nuntil %.17g [s] }\n",
                 slow, part, fast, step_s, until_s);
        run_with(text, &none, false, &what);
        const double range_m = 2.0 / (slow * slow);
        const double truth_m = (1.0 - cos(slow * until_s)) / (slow * slow) +
                               part * (1.0 - cos(fast * until_s)) / (fast * fast);
        const double is_m = x_of(&what);
        const double off = fabs(is_m - truth_m) / fmax(range_m, fabs(is_m));
        if (off > 2.0 * RIGHT) {
            wrong++;
            TEST_ASSERT_TRUE_MESSAGE(what.err[0] != '\0', text);
            TEST_ASSERT_FALSE_MESSAGE(trusted(&what), text);
        } else if (off < 0.5 * RIGHT) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(told(&what), text);
        }
    }
    printf("  %u ripples: %u wrong, all warned of; %u right\n", cases, wrong, right);
    TEST_ASSERT_TRUE(4 * wrong > cases && 8 * right > cases);
}

/* Blocks that are pulled below the mean friction limit or slide to rest. Except for resolved ripples, a step is a
 * whole number of periods of the normal force. */
TEST(aliasing, rippling_normals) {
    static const named_cure none;
    dice d = dice_of("aliasing, normals", 20261130);
    const unsigned cases = dice_cases(usual_or(12, 4));
    for (unsigned i = 0; i < cases; i++) {
        const bool slides = i % 2 == 0;
        const bool still = i % 3 == 2; /* true: the step resolves the ripple */
        const double step_s = round_of(&d, -4.0, -3.0);
        const double ripple = dice_between(&d, 2.0, 6.0);
        const double fast = TURN * (still ? 0.02 : (double)(1U + dice_one_of(&d, 8))) / step_s;
        char text[700];
        said what;
        snprintf(text, sizeof text,
                 "mechanism block\ncoordinate x [m]\ncoordinate t [s]\n"
                 "T = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\nV = %s3 [N]*x\n"
                 "friction x static 0.5 kinetic %s normal 9.81 [N] + %.17g [N]*%s(%.17g [1/s]*t)\n"
                 "scene s { start t' = 1, x' = %s [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
                 slides ? "0*" : "-", slides ? "0.3" : "0.1", ripple, slides ? "cos" : "sin", fast,
                 slides ? "0.5" : "0", step_s, 2000.0 * step_s);
        run_with(text, &none, false, &what);
        const double truth_m = 0.5 * 0.5 / (2.0 * 0.3 * 9.81);
        const double off = fabs(x_of(&what) - truth_m) / truth_m;
        if (slides && 2000.0 * step_s > 1.0) {
            TEST_ASSERT_TRUE_MESSAGE(off < 0.02 || (what.err[0] != '\0' && !trusted(&what)), text);
            TEST_ASSERT_TRUE_MESSAGE(off > RIGHT || !told(&what), text);
            /* the lowest friction limit is below the pull of 3 N, so the block moves */
        } else if (!still && ripple > 4.0) {
            TEST_ASSERT_FALSE_MESSAGE(trusted(&what), text);
        }
        TEST_ASSERT_FALSE_MESSAGE(still && told(&what), text);
    }
}

/* === suite pulse_trains ======================================================================= */
/* Forces that act for a small part of their period. The period is in a simple ratio to the step, so the force is
 * zero at every stage and nothing moves. The references are closed forms. A wrong run must have a warning or not be
 * trusted. Pulses that the steps resolve must cause no warning. */

static const char *const methods[] = {"rk4", "rk4", "rk38", "nystroem5", "heun"};
enum { METHODS = sizeof methods / sizeof methods[0] };

typedef struct verdict_of {
    double value; /* final value of the state `name` */
    bool warned;
    bool too_fast; /* a warning says that the run aliases a fast force */
    bool trusted;  /* the run is trusted to its end */
} verdict_of;

/* Runs `whirl run` on the text and reads its warnings and the final value of the state `name`. */
static verdict_of ask(const char *text, const char *name, const char *method, const char *number) {
    static said what;
    COMMAND_SAY(command_run, &what, model_keep(text), "--method", method, "--number", number);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    const char *at = strstr(what.out, name);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what.out);
    verdict_of v = {.warned = strstr(what.err, "warning") != NULL,
                    .too_fast = strstr(what.err, "aliases a fast force") != NULL,
                    .trusted = strstr(what.out, "to the end: every") != NULL};
    TEST_ASSERT_NOT_NULL(said_number(at + strlen(name), &v.value));
    return v;
}

/* A mass with drag, at rest at the start. A force of 1 N acts during the part `duty` of each period. */
static void write_train(char *text, size_t size, double pulses_hz, double duty, double phase,
                        double end_s) {
    snprintf(text, size,
             "mechanism train\ncoordinate x [m]\ncoordinate t [s]\n"
             "let c = cos(2*pi*(%.17g [Hz]*t + %.17g))\n"
             "T = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\nF = 1 [N*s/m]*x'^2/2\n"
             "Q(x) = 1 [N]*(1 + sign(c - cos(pi*%.17g)))/2\n"
             "scene s { start t' = 1\nstep 1 [ms]\nuntil %.17g [s] }\n",
             pulses_hz, phase, duty, end_s);
}

TEST(pulse_trains, pulses_between_stages) {
    static const double turns[] = {0.5, 1.0, 1.0, 1.5, 2.0, 3.0, 5.0};
    dice d = dice_of("pulses", 6301);
    const unsigned cases = dice_cases(few_or_all(usual_or(8, 2), 200));
    unsigned wrong = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[700];
        const double duty = pow(10.0, dice_between(&d, -2.1, -0.6));
        const double off = pow(10.0, dice_between(&d, -7.0, -2.0));
        const double way = dice_one_of(&d, 2) == 0 ? 1.0 : -1.0;
        const double pulses_hz =
            1000.0 * turns[dice_one_of(&d, 7)] * (1.0 + (i % 3 == 0 ? way * off : 0.0));
        write_train(text, sizeof text, pulses_hz, duty, dice_between(&d, 0.0, 1.0), 1.0);
        const verdict_of v =
            ask(text, "  x' ", methods[i % METHODS], i / METHODS % 2 == 0 ? "double" : "float");
        const double right = duty * (1.0 - exp(-1.0));
        const bool is_off = !(fabs(v.value - right) < 0.1 * right);
        TEST_ASSERT_FALSE_MESSAGE(is_off && !v.warned && v.trusted, text);
        wrong += is_off ? 1U : 0U;
    }
    model_drop();
    TEST_ASSERT_TRUE(wrong > cases / 3);
}

/* The true final speed: each pulse adds a speed, which decays after the pulse. */
static double driven_mps(double pulses_hz, double duty, double phase, double end_s) {
    double sum = 0.0;
    for (int k = 0; (k - 0.5 * duty - phase) / pulses_hz < end_s; k++) {
        const double on_s = fmax((k - 0.5 * duty - phase) / pulses_hz, 0.0);
        const double off_s = fmin((k + 0.5 * duty - phase) / pulses_hz, end_s);
        sum += off_s > on_s ? exp(off_s - end_s) - exp(on_s - end_s) : 0.0;
    }
    return sum;
}

/* With 12 to 3,000 steps per period, the runs must be right and cause no warning. */
TEST(pulse_trains, pulses_that_steps_resolve) {
    dice d = dice_of("slow pulses", 6303);
    const unsigned cases = dice_cases(few_or_all(usual_or(10, 4), 400));
    unsigned right = 0;
    unsigned silent = 0;
    for (unsigned i = 0; i < cases; i++) {
        char text[700];
        const double pulses_hz = pow(10.0, dice_between(&d, -0.5, 1.9));
        const double duty = dice_between(&d, 0.1, 0.9);
        const double phase = dice_between(&d, 0.0, 1.0);
        write_train(text, sizeof text, pulses_hz, duty, phase, 5.0);
        const verdict_of v =
            ask(text, "  x' ", methods[i % METHODS], i % 2 == 0 ? "double" : "float");
        right += fabs(v.value - driven_mps(pulses_hz, duty, phase, 5.0)) < 0.01 ? 1U : 0U;
        silent += v.warned ? 0U : 1U;
        TEST_ASSERT_FALSE_MESSAGE(v.too_fast, text);
    }
    model_drop();
    TEST_ASSERT_TRUE(silent > cases / 2);
    TEST_ASSERT_EQUAL_UINT(cases, right);
}
