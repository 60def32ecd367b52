/* test_swings.c: energy warnings of `whirl run` for nonlinear systems. Predator and prey have the invariant H = u -
 * ln u + v - ln v, whose drift is compared with the warning, for any method, step and number type. Also a forced
 * swing. */
#include "host/cli/commands.h"

#include "command.h"
#include "motion.h"
#include "named_cures.h"

/* === suite swings ============================================================================= */

/* The energy of the swing is H - 2 for a = b = 1. If it changes by more than TOLD of itself, there must be a
 * warning. If it changes by less than SILENT, and the errors of u and v are below RIGHT of their ranges, there must
 * be none. */
#define TOLD 0.03
#define SILENT 1e-3
#define RIGHT 4e-3

typedef struct prey {
    double a; /* rates a and b, 1/s */
    double b;
    double u; /* start of u; v starts at 1 */
    double step_ms;
    wh_method method;
    const engine_kind *kind;
} prey;

static prey drawn(dice *d) {
    static const wh_method methods[] = {WH_EULER, WH_HEUN, WH_RK4, WH_NYSTROEM5};
    const prey p = {.a = dice_between(d, 0.5, 2.0),
                    .b = dice_between(d, 0.5, 2.0),
                    .u = dice_between(d, 1.3, 3.0),
                    .method = methods[dice_one_of(d, 4)],
                    .kind = dice_one_of(d, 4) == 0 ? &engine_float : &engine_double};
    return p;
}

static double kept(const prey *p, double u, double v) {
    return p->b * (u - 1.0 - log(u)) + p->a * (v - 1.0 - log(v));
}

/* Relative change of the energy in a run; NaN if the run fails. *off: largest error of u and v relative to their
 * ranges. The reference has a twentieth of the step, order 5, and double. */
static double lost_of(const prey *p, const char *text, double *off) {
    enum { PARTS = 20 };
    motion m;
    motion fine;
    motion_open_text(&m, text, (stepping){.kind = p->kind, .method = p->method});
    motion_open_text(&fine, text,
                     (stepping){.kind = &engine_double,
                                .method = WH_NYSTROEM5,
                                .step_s = p->step_ms * 1e-3 / PARTS});
    static const char *const names[] = {"u", "v"};
    double low[] = {p->u, 1.0};
    double high[] = {p->u, 1.0};
    double apart[] = {0.0, 0.0};
    bool ran = true;
    for (uint64_t k = 0; k < m.image->steps && ran; k++) {
        ran = motion_step(&m, 1) == WH_OK;
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&fine, PARTS));
        for (int i = 0; i < 2; i++) {
            const double right = motion_value(&fine, names[i]);
            low[i] = fmin(low[i], right);
            high[i] = fmax(high[i], right);
            apart[i] = fmax(apart[i], fabs(motion_value(&m, names[i]) - right));
        }
    }
    const double left = kept(p, motion_value(&m, "u"), motion_value(&m, "v"));
    motion_close(&m);
    motion_close(&fine);
    *off = fmax(apart[0] / (high[0] - low[0]), apart[1] / (high[1] - low[1]));
    return ran ? fabs(left / kept(p, p->u, 1.0) - 1.0) : (double)NAN;
}

TEST(swings, predator_and_prey) {
    dice d = dice_of("swings", 14004);
    const unsigned cases = dice_cases(few_or_all(16, 100));
    unsigned told = 0;
    unsigned silent = 0;
    for (unsigned i = 0; i < cases; i++) {
        prey p = drawn(&d);
        const double coarse_ms = p.method == WH_EULER ? 10.0 : p.method == WH_HEUN ? 60.0 : 200.0;
        p.step_ms = floor(coarse_ms * pow(10.0, dice_between(&d, -1.0, 0.2))) + 1.0;
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism prey\nstate u\nstate v\nequation u' = %.17g [1/s]*u*(1 - v)\n"
                 "equation v' = %.17g [1/s]*v*(u - 1)\n"
                 "scene s { start u = %.17g, v = 1; step %.17g [ms]; until 40 [s] }\n",
                 p.a, p.b, p.u, p.step_ms);
        double off = 0.0;
        const double lost = lost_of(&p, text, &off);
        if (!(lost >= 0.0)) {
            continue; /* diverged runs have another warning */
        }
        said what;
        COMMAND_SAY(command_run, &what, model_keep(text), "--method", wh_methods[p.method].word,
                    "--number", p.kind == &engine_float ? "float" : "double");
        char about[sizeof what.err + 600];
        snprintf(about, sizeof about, "%s, %s: H changes by %.3g; it says %s", text,
                 wh_methods[p.method].word, lost, what.err);
        const bool is_told = strstr(what.err, "[accuracy]") != NULL;
        if (lost > TOLD) {
            told++;
            TEST_ASSERT_TRUE_MESSAGE(is_told, about);
        } else if (lost < SILENT && off < RIGHT) {
            silent++;
            TEST_ASSERT_FALSE_MESSAGE(is_told, about);
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(told > cases / 8 && silent > cases / 8);
}

/* === suite forced_swing ======================================================================= */
/* A body on a spring, with or without damping, under a force whose phase advances by 0.3 to 1.8 rad in a step: too
 * much for the quadrature of the force's power, but not for the method. The reference is the closed form. A right
 * run must have no warning, even with an energy residual; a wrong run must have a warning or not be trusted. */

enum { RECORDS = 20 }; /* divides the number of steps of a run */

typedef struct forced_case {
    /* the clock is a real number instead of a turn angle, so the force's phase may advance by more than half a turn
     * in a step */
    bool summed;
    double swing_radps;
    double damping; /* relative to critical damping */
    double force_N; /* amplitude of the force on 1 kg */
    double clock_radps;
    double step_s;
    int steps;
} forced_case;

static const double start_m = 0.05;

static forced_case draw(dice *d) {
    static const int lengths[] = {40, 100, 400, 2000};
    static const double dampings[] = {0.0, 0.0, 0.01, 0.1};
    static const double steps_s[] = {1e-3, 5e-3, 0.02, 0.1, 1.0};
    forced_case c = {.step_s = steps_s[dice_one_of(d, 5)],
                     .damping = dampings[dice_one_of(d, 4)],
                     .steps = lengths[dice_one_of(d, 4)]};
    c.swing_radps = pow(10.0, dice_between(d, -2.5, -0.2)) / c.step_s;
    c.clock_radps = dice_between(d, 0.3, 1.8) / c.step_s;
    c.force_N = start_m * c.swing_radps * c.swing_radps * pow(10.0, dice_between(d, -3.0, 2.0));
    return c;
}

static void write(const forced_case *c, char *text, size_t size) {
    char clock[160];
    char angle[60];
    char rate[60];
    if (c->summed) {
        snprintf(clock, sizeof clock, "coordinate phi [s]\nT = 1e-9 [J]*phi'^2/2");
        snprintf(angle, sizeof angle, "%.17g [1/s]*phi", c->clock_radps);
        snprintf(rate, sizeof rate, "1");
    } else {
        snprintf(clock, sizeof clock, "coordinate phi [rad]\nT = 1e-9 [kg*m^2]*phi'^2/2");
        snprintf(angle, sizeof angle, "phi");
        snprintf(rate, sizeof rate, "%.17g [rad/s]", c->clock_radps);
    }
    snprintf(text, size,
             "mechanism forced\ncoordinate x [m]\n%s + 1 [kg]*x'^2/2\nV = %.17g [N/m]*x^2/2\n"
             "F = %.17g [N*s/m]*x'^2/2\nQ(x) = %.17g [N]*sin(%s)\n"
             "scene s { start x = %.17g [m], phi' = %s\nstep %.17g [s]\nuntil %.15g [s] }\n",
             clock, c->swing_radps * c->swing_radps, 2.0 * c->damping * c->swing_radps, c->force_N,
             angle, start_m, rate, c->step_s, c->steps * c->step_s);
}

static void closed_form(const forced_case *c, double time_s, double is[2]) {
    const double w = c->swing_radps;
    const double z = c->damping;
    /* the forced part is p sin + q cos of the clock's angle */
    const double stiff = w * w - c->clock_radps * c->clock_radps;
    const double lossy = 2.0 * z * w * c->clock_radps;
    const double p = c->force_N * stiff / (stiff * stiff + lossy * lossy);
    const double q = -c->force_N * lossy / (stiff * stiff + lossy * lossy);
    const double phi = c->clock_radps * time_s;
    const double way = w * sqrt(1.0 - z * z);
    const double a = start_m - q;
    const double b = (z * w * a - c->clock_radps * p) / way;
    const double left = exp(-z * w * time_s);
    const double cosine = cos(way * time_s);
    const double sine = sin(way * time_s);
    is[0] = p * sin(phi) + q * cos(phi) + left * (a * cosine + b * sine);
    is[1] = c->clock_radps * (p * cos(phi) - q * sin(phi)) +
            left * (way * (b * cosine - a * sine) - z * w * (a * cosine + b * sine));
}

/* Largest error of x and x', relative to the range. The columns are time, x, the other coordinate, and the two
 * rates. */
static double off_by(const forced_case *c, const char *csv) {
    double low[2] = {(double)INFINITY, (double)INFINITY};
    double high[2] = {-(double)INFINITY, -(double)INFINITY};
    double off[2] = {0.0, 0.0};
    double value[5];
    for (const char *row = csv; (row = said_row(row, 5, value)) != NULL;) {
        double is[2];
        closed_form(c, value[0], is);
        for (int i = 0; i < 2; i++) {
            low[i] = fmin(low[i], is[i]);
            high[i] = fmax(high[i], is[i]);
            off[i] = fmax(off[i], fabs(value[1 + 2 * i] - is[i]));
        }
    }
    return fmax(off[0] / (high[0] - low[0]), off[1] / (high[1] - low[1]));
}

typedef struct tally {
    unsigned right;
    unsigned wrong;
    unsigned told;
    unsigned cured;
} tally;

static double run_with(const forced_case *c, const char *const *words, said *what) {
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, what->err);
    return off_by(c, what->out);
}

/* A run must be right without a warning, or wrong and not trusted. Each remedy in a warning is applied. */
static void hold_one(const forced_case *c, const char *number, const char *method, tally *t) {
    char text[900];
    char every[40];
    write(c, text, sizeof text);
    const int steps = c->steps / RECORDS;
    snprintf(every, sizeof every, "%.15gs", steps * c->step_s);
    const char *file = model_keep(text);
    const char *words[] = {file,    "--number", number,    "--method", method,
                           "--csv", "-",        "--every", every,      NULL};
    said what;
    const double off = run_with(c, words, &what);
    const bool warns = strstr(what.err, "warning: ") != NULL;
    if (off < 5e-4) {
        t->right++;
        TEST_ASSERT_FALSE_MESSAGE(warns, what.err);
    } else if (off > 0.02) {
        t->wrong++;
        t->told += warns ? 1U : 0U;
        TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "to the end: every"), text);
    }
    named_cure list[NAMED_CURES];
    const int count = warns ? named_cures(what.err, list) : 0;
    for (int i = 0; i < count; i++) {
        const char *again[20] = {file, "--csv", "-", "--every", every};
        said then;
        if (list[i].tried) {
            (void)named_words(&list[i], method, number, again, 5);
            const double left = run_with(c, again, &then);
            TEST_ASSERT_NULL_MESSAGE(strstr(then.err, "warning: "), then.err);
            TEST_ASSERT_TRUE_MESSAGE(left < 0.02, text);
            t->cured++;
        }
    }
}

static void hold(const char *number, const char *method) {
    dice d = dice_of("forced swings", 4441);
    const unsigned cases = dice_cases(few_or_all(usual_or(100, 10), 600));
    tally t = {0};
    for (unsigned i = 0; i < cases; i++) {
        const forced_case c = draw(&d);
        hold_one(&c, number, method, &t);
    }
    model_drop();
    TEST_ASSERT_TRUE(t.right > cases / 3 &&
                     (t.wrong > 0 || cases < 100 || strcmp(method, "rk4") != 0));
}

TEST(forced_swing, in_float) { hold("float", "rk4"); }
TEST(forced_swing, in_double) { hold("double", "rk4"); }
TEST(forced_swing, other_methods) {
    hold("double", "rk38");
    hold("double", "nystroem5");
}

/* The force turns by whole turns in a step, or slightly more or less. The difference looks like a slow force. */
TEST(forced_swing, nearly_whole_turns) {
    static const int turns[] = {1, 2, 3, 4, 5, 6, 8, 12, 16};
    static const char *const methods[] = {"rk4", "nystroem4", "nystroem5", "rk38", "heun"};
    dice d = dice_of("nearly whole turns", 4457);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 10), 400));
    tally t = {0};
    for (unsigned i = 0; i < cases; i++) {
        forced_case c = draw(&d);
        const double more = pow(10.0, dice_between(&d, -2.5, -0.05));
        c.summed = true;
        c.steps = RECORDS * 10 *
                  /* so that records are a whole number of any remedy's steps apart */
                  (1 + (int)dice_one_of(&d, 3));
        c.clock_radps = (6.283185307179586 * turns[dice_one_of(&d, 9)] +
                         (dice_one_of(&d, 2) == 0 ? more : -more)) /
                        c.step_s;
        /* the slow force may be resonant, or constant */
        c.swing_radps = dice_one_of(&d, 2) == 0 ? fmin(more, 0.1) / c.step_s : c.swing_radps;
        c.swing_radps = fmin(c.swing_radps, 0.1 / c.step_s);
        c.force_N =
            start_m * c.swing_radps * c.swing_radps * pow(10.0, dice_between(&d, -1.0, 2.0));
        hold_one(&c, "double", methods[dice_one_of(&d, 5)], &t);
    }
    model_drop();
    printf(
        "  of %u forces of nearly whole turns a step %u right, none warned of; %u off, %u warned "
        "of, none trusted to the end; %u cures, all silent and right\n",
        cases, t.right, t.wrong, t.told, t.cured);
    TEST_ASSERT_TRUE(t.wrong > cases / 4 && t.cured > cases / 8);
}
