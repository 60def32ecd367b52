/* test_cures.c: every remedy in a warning must work. Nonlinear motions run with much too coarse steps by all
 * methods: a charge near another, a chemical bond, hardening springs, a double pendulum, and a spring that a heavy
 * clock drives. Each remedy is applied. Then no warning may remain, and the energy must agree with the formulas
 * below. A remedy that Whirl has not tried must be marked so. */
#include "command.h"

#include "host/cli/commands.h"
#include "motion.h"
#include "named_cures.h"

enum { TEXT = 900 };

/* Bound on the energy error with a remedy, relative to the exchanged energy. */
#define CURED 5e-3

typedef enum ruined_kind { ORBIT, BOND, HARDENING, DOUBLE_PENDULUM, CLOCKED, KINDS } ruined_kind;

typedef struct ruined {
    ruined_kind kind;
    double a, b; /* the parameters a and b of the motion */
    double step_s;
    unsigned steps;
    wh_method method;
    const char *number;
    char text[TEXT];
} ruined;

static const char *const bodies[KINDS] = {
    "T = M*(x'^2 + y'^2)/2\nV = -E/sqrt(x^2 + y^2)\n",
    "T = M*(x'^2 + y'^2)/2\nV = a*E*(1 - exp(-b*(x - 1)))^2 + E*(y - 0.3*x)^2\n",
    "T = M*(x'^2 + y'^2)/2\nV = E*(x^2/2 + a*x^4 + b*(x - y)^4)\n",
    ("T = M*((1 + a)*x'^2/2 + a*b^2*y'^2/2 + a*b*cos(x - y)*x'*y')\n"
     "V = -10*E*((1 + a)*cos(x) + a*b*cos(y))\n"),
    "T = M*(x'^2 + 1e5*y'^2)/2\nV = a*E*(x - 0.3*sin(b*y))^2\n",
};

static const char *const starts[KINDS] = {
    "x = 1, y' = 0.9 [1/s]", "x = 1.2, y = 0.5, y' = 0.5 [1/s]", "x = 1, y = -0.3, y' = 1 [1/s]",
    "x = 1.7, y = 0.4, y' = 1 [1/s]", "x = 1, y' = 1 [1/s]"};

static double energy_J(const ruined *r, double x, double y, double vx, double vy) {
    const double a = r->a;
    const double b = r->b;
    const double kinetic = (vx * vx + vy * vy) / 2.0;
    switch (r->kind) {
    case ORBIT: return kinetic - 1.0 / sqrt(x * x + y * y);
    case BOND: return kinetic + a * pow(1.0 - exp(-b * (x - 1.0)), 2.0) + pow(y - 0.3 * x, 2.0);
    case HARDENING: return kinetic + x * x / 2.0 + a * pow(x, 4.0) + b * pow(x - y, 4.0);
    case DOUBLE_PENDULUM:
        return (1.0 + a) * vx * vx / 2.0 + a * b * b * vy * vy / 2.0 +
               a * b * cos(x - y) * vx * vy - 10.0 * ((1.0 + a) * cos(x) + a * b * cos(y));
    case CLOCKED: return (vx * vx + 1e5 * vy * vy) / 2.0 + a * pow(x - 0.3 * sin(b * y), 2.0);
    case KINDS: break;
    }
    return 0.0;
}

/* Size of the energy that is exchanged: the stored energy at the start, above its minimum. */
static double moved_J(const ruined *r) {
    switch (r->kind) {
    case ORBIT: return 0.5;
    case BOND: return 0.2;
    case HARDENING: return 0.5 + r->a + r->b;
    case DOUBLE_PENDULUM: return 10.0 * (1.0 + r->a);
    case CLOCKED: return r->a;
    case KINDS: break;
    }
    return 1.0;
}

static ruined drawn(dice *d, ruined_kind kind) {
    ruined r = {.kind = kind, .steps = 20 + dice_one_of(d, 60)};
    const bool crude = dice_one_of(d, 3) == 0;
    r.a =
        kind == DOUBLE_PENDULUM ? dice_between(d, 0.3, 3.0) : pow(10.0, dice_between(d, 0.0, 1.0));
    r.b = kind == DOUBLE_PENDULUM ? dice_between(d, 0.5, 1.5) : dice_between(d, 0.5, 3.0);
    r.step_s = pow(10.0, dice_between(d, crude ? -1.7 : -1.0, -0.2));
    r.method = (wh_method)dice_one_of(d, WH_METHODS);
    if (crude || (kind == DOUBLE_PENDULUM && wh_methods[r.method].takes == WH_NO_RATES)) {
        r.method = crude ? WH_HEUN : WH_RK4;
    }
    r.number = dice_one_of(d, 3) == 0 ? "float" : "double";
    const char *unit = kind == DOUBLE_PENDULUM ? " [rad]" : "";
    snprintf(r.text, TEXT,
             "mechanism ruined\ncoordinate x%s\ncoordinate y%s\nparameter E = 1 [J]\n"
             "parameter M = 1 [J*s^2]\nparameter a = %.9g\nparameter b = %.9g\n%s"
             "scene s { start %s\nstep %.9g [s]\nuntil %.12g [s] }\n",
             unit, unit, r.a, r.b, bodies[kind], starts[kind], r.step_s, r.step_s * r.steps);
    return r;
}

static void run(const ruined *r, const named_cure *with, said *what) {
    static const named_cure as_it_is;
    const char *words[12] = {model_keep(r->text), "--quiet"};
    named_words(with != NULL ? with : &as_it_is, wh_methods[r->method].word, r->number, words, 2);
    command_say(command_run, words, what);
}

/* Energy error at the end, relative to the exchanged energy. */
static double missing(const ruined *r, const named_cure *with) {
    wh_method method = r->method;
    for (int m = 0; m < WH_METHODS; m++) {
        method = strcmp(wh_methods[m].word, with->method) == 0 ? (wh_method)m : method;
    }
    const double step_s = with->step[0] != '\0' ? said_step_s(with->step) : r->step_s;
    motion at;
    motion_open_text(
        &at, r->text,
        (stepping){.kind = r->number[0] == 'f' && !with->in_double ? &engine_float : &engine_double,
                   .method = method,
                   .compensated = with->compensated,
                   .step_s = step_s});
    double energy[2];
    bool went = true;
    for (int k = 0; k < 2; k++) {
        energy[k] = energy_J(r, motion_value(&at, "x"), motion_value(&at, "y"),
                             motion_value(&at, "x'"), motion_value(&at, "y'"));
        went = k > 0 || motion_step(&at, (uint64_t)(r->step_s * r->steps / step_s + 0.5)) == WH_OK;
        if (!went) {
            break;
        }
    }
    motion_close(&at);
    return went ? fabs(energy[1] - energy[0]) / moved_J(r) : (double)INFINITY;
}

TEST(cures, cures_were_tried) {
    dice d = dice_of("cures", 3122);
    const unsigned cases = dice_cases(few_or_all(15, 400));
    unsigned told = 0;
    unsigned done = 0;
    unsigned untried = 0;
    for (unsigned i = 0; i < cases; i++) {
        const ruined r = drawn(&d, (ruined_kind)(i % KINDS));
        said what;
        named_cure list[NAMED_CURES];
        run(&r, NULL, &what);
        const bool is_told = what.err[0] != '\0';
        const int count = named_cures(what.err, list);
        told += is_told ? 1 : 0;
        for (int k = 0; k < count; k++) {
            said again;
            char about[2 * SAID_SIZE + TEXT];
            if (!list[k].tried) {
                untried++;
                continue;
            }
            run(&r, &list[k], &again);
            const double left = missing(&r, &list[k]);
            snprintf(about, sizeof about, "%s %s, %s %s leaves %.2g\n%s%s",
                     wh_methods[r.method].word, r.number, list[k].method, list[k].step, left,
                     r.text, what.err);
            TEST_ASSERT_EQUAL_STRING_MESSAGE("", again.err, about);
            done++;
            if (r.kind == CLOCKED && r.number[0] == 'f' && !list[k].in_double) {
                /* in float, the rounding of the clock's rate changes the clock's energy, which is large */
                continue;
            }
            TEST_ASSERT_TRUE_MESSAGE(left < CURED, about);
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(told > cases / 3 && done > told / 2 && untried <= told / 5);
}

/* In fixed point Whirl tries no remedy, and does not say that none helps: a smaller step removes these warnings. */
TEST(cures, fixed_point_has_an_untried_remedy) {
    dice d = dice_of("cures_fixed", 30112026);
    for (unsigned i = 0; i < 30; i++) {
        const double per_s = dice_between(&d, 1.0, 10.0);
        const double step = dice_between(&d, 0.4, 0.6);
        char text[TEXT];
        for (int finer = 0; finer < 2; finer++) {
            said what;
            snprintf(text, TEXT,
                     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N/m]*x^2/2\n"
                     "scene s { start x = 1 [m]\nrange x = -2 .. 2 [m]\n"
                     "range x' = -%.17g .. %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
                     per_s * per_s, 2.0 * per_s, 2.0 * per_s, step / per_s / (finer ? 50.0 : 1.0),
                     50.0 * step / per_s);
            COMMAND_SAY(command_run, &what, model_keep(text), "--number", "fixed");
            TEST_ASSERT_TRUE_MESSAGE((strstr(what.err, "warning") == NULL) == finer, what.err);
            TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "none removes"), what.err);
            TEST_ASSERT_TRUE_MESSAGE(finer || strstr(what.err, "try another --step") != NULL,
                                     what.err);
        }
    }
    model_drop();
}

/* A body rolls up to the top of a hill, where errors grow as exp(t), beside a spring that needs a shorter step. In
 * float, round-off decides to which side the body rolls down: that is chaos, which is no finding. A remedy in float
 * must still give a right result until the end. */
TEST(cures, remedies_in_float_are_right) {
    dice d = dice_of("cures_float", 29112026);
    const unsigned cases = dice_cases(few_or_all(12, 60));
    unsigned in_float = 0;
    unsigned in_double = 0;
    double worst = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        char text[TEXT];
        said what;
        named_cure cure;
        const double rate = pow(10.0, dice_between(&d, -0.5, 0.5)); /* angular rate, 1/s */
        const double step_s = dice_between(&d, 0.5, 1.0) / (rate * dice_between(&d, 10.0, 30.0));
        const double steps = floor(dice_between(&d, 4.0, 18.0) / rate / step_s);
        const double spring = 0.75 / step_s;
        snprintf(text, TEXT,
                 "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
                 "V = %.17g [N/m]*y^2/2 - %.17g [N/m]*x^2/2\n"
                 "scene s { start x = 1 [m], x' = %.17g [m/s], y = 1 [m]\nstep %.17g [s]\n"
                 "until %.17g [s] }\n",
                 spring * spring, rate * rate, -rate, step_s, step_s * steps);
        const char *words[12] = {model_keep(text), "--quiet", "--number", "float"};
        command_say(command_run, words, &what);
        TEST_ASSERT_TRUE_MESSAGE(named_with_step(what.err, &cure) && cure.tried, what.err);
        in_double += cure.in_double ? 1U : 0U;
        if (!cure.in_double) {
            motion at;
            const double end_s = step_s * steps;
            const double step = said_step_s(cure.step);
            motion_open_text(&at, text,
                             (stepping){.kind = &engine_float,
                                        .method = WH_RK4,
                                        .compensated = cure.compensated,
                                        .step_s = step});
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&at, (uint64_t)(end_s / step + 0.5)));
            worst = fmax(worst, fabs(motion_value(&at, "x") - exp(-rate * end_s)));
            motion_close(&at);
            in_float++;
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(worst < 0.012 && in_float > 1 && in_double > cases / 4);
}
