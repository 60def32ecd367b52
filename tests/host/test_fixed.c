/* test_fixed.c: fixed-point runs report significant round-off and nothing else: random motions with closed forms in
 * ranges and steps of many sizes. Correct energy balances are accepted. */
#include "host/base/alloc.h"
#include "host/check/energy_residual.h"
#include "host/check/slow.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"

#include "derived.h"

/* === fixed loss =============================================================================== */

typedef struct outcome {
    double angle[4];
    double real[4];
    int told;
    bool held;
    energy_residual belief;
} outcome;

static outcome run_of(derived *d, const char *text) {
    outcome end = {.told = 0};
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(d->image, false, errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(p, text);
    d->image->fixed = p;
    void *run = engine_fixed.start(d->image);
    books *b = books_open(d->image);
    for (uint64_t k = 0; k <= d->image->steps; k++) {
        if (b != NULL) {
            books_enter(b, &engine_fixed, run);
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, k < d->image->steps ? engine_fixed.step(run) : WH_OK);
    }
    end.told = slow_count(&engine_fixed, d->image, run);
    end.held = engine_fixed.saturated(run) > 0;
    end.belief = energy_residual_of(b, &engine_fixed, run);
    TEST_ASSERT_EQUAL_INT(end.held, end.belief.saturated);
    engine_fixed.state(run, end.angle, end.real);
    books_close(b);
    engine_fixed.stop(run);
    d->image->fixed = NULL;
    fixed_plan_free(p);
    diags_free(errors);
    return end;
}

/* Pushed, turning and filling evenly, for 2 s. */
static void try_even_motion(int kind, double value, double times, int step_us, int *told,
                            int *quiet) {
    static const char *const texts[] = {
        ("coordinate x [m]\ninput u = %.9g [N]\nT = 1 [kg]*x'^2/2\nQ(x) = u\n"
         "scene s { until 2 [s]; step %d [us]\n"
         "range x = -%.9g .. %.9g [m], x' = -%.9g .. %.9g [m/s], u = -%.9g .. %.9g [N] }\n"),
        ("coordinate b [rad]\ninput M = 0 [N*m]\nT = 1 [kg*m^2]*b'^2/2\nQ(b) = M\n"
         "scene s { start b' = %.9g [rad/s]; until 2 [s]; step %d [us]\n"
         "range b' = -%.9g .. %.9g [rad/s], M = -%.9g .. %.9g [N*m] }\n"),
        ("state c [m]\ninput v = %.9g [m/s]\nequation c' = v\nscene s { until 2 [s]; step %d [us]\n"
         "range c = -%.9g .. %.9g [m], v = -%.9g .. %.9g [m/s] }\n")};
    const double size = 3.0 * value * times;
    char *with = alloc_words(texts[kind], value, step_us, size, size, size, size, size, size);
    char *text = alloc_words("mechanism m\n%s", with);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    const outcome end = run_of(&d, text);
    const double span = 2.0 * value;
    const double where = kind == 1 ? end.angle[0] : end.real[0];
    /* a start and an input are each rounded once, too */
    double worst = fabs(where - span) / span;
    worst = kind == 0 ? fmax(worst, fabs(end.real[1] - span) / span) : worst;
    TEST_ASSERT_FALSE_MESSAGE(end.held, text);
    if (worst > 4e-3) {
        TEST_ASSERT_GREATER_THAN_INT_MESSAGE(0, end.told, text);
        ++*told;
    } else if (worst < 2e-4) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, end.told, text);
        ++*quiet;
    }
    derived_free(&d);
    free(text);
    free(with);
}

TEST(fixed_loss, lost_steps_are_told) {
    static const int step_us[] = {20, 100, 1000, 10000};
    uint64_t seed = 77;
    int told = 0;
    int quiet = 0;
    for (int kind = 0; kind < 3; kind++) {
        for (int power = 0; power <= 6; power++) {
            for (int n = 0; n < 4; n++) {
                /* a rotor's angle has its own units: slow ones */
                const double value = kind == 1 ? pow(10.0, -power) : 1.0;
                try_even_motion(kind, value * random_between(&seed, 0.5, 2.0),
                                kind == 1 ? 1.0 : pow(10.0, power), step_us[n], &told, &quiet);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(15, told);
    TEST_ASSERT_GREATER_THAN_INT(25, quiet);
}

/* Oscillators of all masses and springs, some so slow that they hardly move: accepted whenever they are accurate. */
TEST(fixed_loss, books_believe_what_is_right) {
    int right = 0;
    for (int mass = -6; mass <= 6; mass += 2) {
        for (int spring = -6; spring <= 6; spring += 2) {
            const double w = pow(10.0, 0.5 * (spring - mass));
            if (w > 100.0) { /* too coarse a step */
                continue;
            }
            char *text = alloc_words(
                "mechanism m\ncoordinate x [m]\nT = 1e%d [kg]*x'^2/2\nV = 1e%d [N/m]*x^2/2\n"
                "scene s { start x = 1 [m]; step 1 [ms]; until 5 [s] }\n",
                mass, spring);
            derived d = derived_scene(text, "s");
            derived_expect(&d, text);
            const outcome end = run_of(&d, text);
            if (fabs(end.real[0] - cos(5.0 * w)) < 1e-5) {
                TEST_ASSERT_FALSE_MESSAGE(energy_residual_lost(&end.belief, ENERGY_RESIDUAL_LIMIT),
                                          text);
                right++;
            }
            derived_free(&d);
            free(text);
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(30, right);
}

/* === fixed runs =============================================================================== */
/* Fixed-point runs of random smooth mechanisms, against the run in double within the formats' round-off; ranges that
 * are too small; refusals. */

enum { KINDS = 5, CASES = 40, TEXT_SIZE = 3000, MOST = 8 };

/* A mechanism m with a scene s of kind `which` with these ranges. Kinds are masses between springs, one of them
 * one-sided, a damped pendulum on a carriage, and a driven rotor with an uneven load. Two coupled pendulums and a system
 * of first order are the others. */
static void write_mechanism(char text[static TEXT_SIZE], int which, uint64_t seed,
                            const char *ranges) {
    double r[10];
    for (int i = 0; i < 10; i++) {
        r[i] = random_between(&seed, 0.5, 2.0);
    }
    switch (which) {
    case 0:
        snprintf(text, TEXT_SIZE,
                 "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput u = %.6f [N]\n"
                 "T = %.6f [kg]*x'^2/2 + %.6f [kg]*(x' + y')^2/2\n"
                 "V = %.6f [N/m]*x^2/2 + %.6f [N/m]*y^2/2 + %.6f [N/m]*max(x, y)^2/2\n"
                 "F = %.6f [N*s/m]*x'^2/2 + 0.5 [N*s/m]*y'^2/2\nQ(y) = u\n"
                 "scene s { start x = %.6f [m], y' = -%.6f [m/s]; until 2 [s]\n%s }\n",
                 r[0], r[1], r[2], 90 * r[3], 40 * r[4], 20 * r[5], r[6], 0.1 * r[7], 0.3 * r[8],
                 ranges);
        break;
    case 1:
        snprintf(text, TEXT_SIZE,
                 "mechanism m\ncoordinate x [m]\ncoordinate th [rad]\ninput u = %.6f [N]\n"
                 "let L = %.6f [m]\nlet p = %.6f [kg]\n"
                 "T = %.6f [kg]*x'^2/2 + p*((x' + L*th'*cos(th))^2 + (L*th'*sin(th))^2)/2\n"
                 "V = -p*9.81 [m/s^2]*L*cos(th) + %.6f [N/m]*x^2/2\n"
                 "F = %.6f [N*s/m]*x'^2/2 + %.6f [N*m*s]*th'^2/2\nQ(x) = u\n"
                 "scene s { start th = %.6f [rad]; until 2 [s]\n%s }\n",
                 r[0], 0.5 * r[1], 0.4 * r[2], 1.5 * r[3], 20 * r[4], 0.3 * r[5], 0.02 * r[6],
                 0.8 * r[7], ranges);
        break;
    case 2:
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\ncoordinate a [rad]\ninput M = %.6f [N*m]\n"
            "T = %.6f [kg*m^2]*(1.5 + cos(2*a + 0.3))*a'^2/2\nV = %.6f [J]*sin(3*a)\n"
            "F = %.6f [N*m*s]*a'^2/2\nQ(a) = M\nscene s { start a' = %.6f [rad/s]; until 2 [s]\n%s }\n",
            r[0], 0.3 * r[1], 0.4 * r[2], 0.4 * r[3], 3 * r[4], ranges);
        break;
    case 3:
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ninput M = %.6f [N*m]\n"
            "T = %.6f [kg*m^2]*(2*a'^2 + b'^2 + a'*b'*cos(a - b))/2\n"
            "V = -%.6f [J]*(2*cos(a) + cos(b))\nF = %.6f [N*m*s]*(a'^2 + (a' - b')^2)/2\nQ(a) = M\n"
            "scene s { start a = %.6f [rad]; until 2 [s]\n%s }\n",
            r[0], 0.5 * r[1], 4 * r[2], 0.2 * r[3], 0.7 * r[4], ranges);
        break;
    default:
        snprintf(text, TEXT_SIZE,
                 "mechanism m\nstate p [rad]\nstate v [V]\nstate q\ninput d = %.6f [V]\n"
                 "equation p' = %.6f [1/s]*(1 + 0.3*sin(p)) + 0.1 [1/s]*q\n"
                 "equation v' = %.6f [1/s]*(d - v + 0.5 [V]*cos(2*p - 1))\n"
                 "equation q''/(30 [1/s^2]) + %.6f*q'/(5 [1/s]) + q = v/(1 [V])\n"
                 "scene s { until 2 [s]\n%s }\n",
                 r[0], 4 * r[1], 3 * r[2], 0.4 * r[3], ranges);
    }
}

/* Its run to the end: real[reals], then angles; the largest value of each real. */
static uint64_t run(const engine_kind *kind, const image *im, double *end, double *far) {
    void *of = kind->start(im);
    for (uint64_t k = 0; k <= im->steps; k++) {
        kind->state(of, end + im->reals, end);
        for (int i = 0; i < im->reals && far != NULL; i++) {
            far[i] = fmax(far[i], fabs(end[i]));
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, k < im->steps ? kind->step(of) : WH_OK);
    }
    const uint64_t held = kind->saturated != NULL ? kind->saturated(of) : 0;
    kind->stop(of);
    return held;
}

/* "range x = -0.3 .. 0.3 [m]": this factor times the run's largest value, for each real and input. */
static void write_ranges(char *text, const image *im, const double *far, double times) {
    size_t length = 0;
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const bool real = i < im->reals;
        const char *unit = real ? im->unknown[im->real[i].unknown].unit[im->real[i].primes].si
                                : im->input[i - im->reals].unit.si;
        const double size = times * (real ? far[i] : im->input[i - im->reals].value) + 1e-3;
        length +=
            (size_t)snprintf(text + length, 1000 - length, "range %s = -%.6f .. %.6f%s%s%s\n",
                             im->range[i].name, size, size, strcmp(unit, "1") == 0 ? "" : " [",
                             strcmp(unit, "1") == 0 ? "" : unit, strcmp(unit, "1") == 0 ? "" : "]");
    }
}

/* Bound on the round-off of component i of the reals at the end. Each step adds a unit of the stored number, and two
 * units of the list's results, which constants may add each time. Positions integrate the rates' errors. The mechanisms
 * are damped, so errors do not grow, but a swing may be passed on for a while. */
static double bound_of(const fixed_plan *p, int i) {
    enum { PASSED_ON = 12 };
    const image *im = p->image;
    const int linears = p->second ? im->coordinates - im->angles : 0;
    const double steps = (double)im->steps;
    const double some = sqrt(steps);
    double rate = 0.0;
    for (int k = 0; k < p->coordinates; k++) {
        const fixed_op *result = &p->list->op[p->list->result[k]];
        const int at = p->second ? linears + k : k - im->angles;
        const double unit = at >= 0 ? ldexp(1.0, -p->format[at].bits) : 0.0;
        const double of_one = at >= 0 ? 1.0 : 6.283185307179586 / 4294967296.0; /* phases */
        const double most = of_one * fmax(fabs(result->range.low), fabs(result->range.high));
        rate = fmax(rate, some * unit + steps * 2.0 * ldexp(most, -FIXED_RESULT_DIGITS));
    }
    return PASSED_ON * (some * ldexp(1.0, -p->format[i].bits) + rate * (1.0 + im->until_s));
}

static void check_beside_double(const derived *d, bool declared, const char *text) {
    double fixed[2 * MOST];
    double exact[2 * MOST];
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(d->image, false, errors);
    diags_flush(errors, stderr);
    diags_free(errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(p, text);
    d->image->fixed = p;
    for (int i = 0; i < d->image->reals + d->image->inputs; i++) {
        TEST_ASSERT_EQUAL_INT(declared, p->declared[i]);
    }
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, run(&engine_fixed, d->image, fixed, NULL), text);
    (void)run(&engine_double, d->image, exact, NULL);
    for (int i = 0; i < d->image->reals; i++) {
        const double bound = bound_of(p, i);
        const double size = fmax(fabs(p->range[i].low), fabs(p->range[i].high));
        TEST_ASSERT_TRUE_MESSAGE(bound < 3e-3 * size, text); /* the bound must be significant */
        TEST_ASSERT_TRUE_MESSAGE(fabs(fixed[i] - exact[i]) <= bound, text);
    }
    d->image->fixed = NULL;
    fixed_plan_free(p);
}

static void check_saturation(const derived *d, const char *text) {
    double end[2 * MOST];
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(d->image, false, errors);
    const int refused = diags_count(errors);
    diags_free(errors);
    if (p == NULL) { /* it may start outside */
        TEST_ASSERT_TRUE_MESSAGE(refused > 0, text);
        return;
    }
    d->image->fixed = p;
    TEST_ASSERT_TRUE_MESSAGE(run(&engine_fixed, d->image, end, NULL) > 0, text);
    for (int i = 0; i < d->image->reals; i++) {
        TEST_ASSERT_TRUE_MESSAGE(end[i] >= p->range[i].low && end[i] <= p->range[i].high, text);
    }
    d->image->fixed = NULL;
    fixed_plan_free(p);
}

static void try_one(int which, uint64_t seed) {
    static char text[TEXT_SIZE];
    char ranges[1000];
    double end[2 * MOST];
    double far[MOST] = {0};
    write_mechanism(text, which, seed, "");
    derived plain = derived_scene(text, "s");
    derived_expect(&plain, text);
    check_beside_double(&plain, false, text);
    (void)run(&engine_double, plain.image, end, far);
    write_ranges(ranges, plain.image, far, 1.5);
    write_mechanism(text, which, seed, ranges);
    derived within = derived_scene(text, "s");
    derived_expect(&within, text);
    check_beside_double(&within, true, text);
    derived_free(&within);
    write_ranges(ranges, plain.image, far, 0.6);
    write_mechanism(text, which, seed, ranges);
    derived beyond = derived_scene(text, "s");
    derived_expect(&beyond, text);
    for (int i = beyond.image->reals; i < beyond.image->reals + beyond.image->inputs; i++) {
        beyond.image->range[i].low *= 2.0; /* inputs stay inside */
        beyond.image->range[i].high *= 2.0;
    }
    check_saturation(&beyond, text);
    derived_free(&beyond);
    derived_free(&plain);
}

TEST(fixed_runs, made_up_mechanisms) {
    for (int which = 0; which < KINDS; which++) {
        for (unsigned i = 0; i < CASES / KINDS; i++) {
            try_one(which, 1000U * (unsigned)which + i + 7U);
        }
    }
}

/* Message of fixed_plan_make() for the scene. */
static void check_refused(const char *text, const char *why) {
    char *report;
    size_t length;
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(d.image, false, errors);
    FILE *out = alloc_text(&report, &length);
    diags_flush(errors, out);
    alloc_text_end(out);
    diags_free(errors);
    TEST_ASSERT_NULL_MESSAGE(p, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, why), report);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, "hint: "), report);
    free(report);
    derived_free(&d);
}

TEST(fixed_runs, refusals) {
    static const struct {
        const char *energy;
        const char *more;
        const char *why;
    } tried[] = {
        {"V = 1 [J]*sqrt(1 + (x/1 [m])^2)", "", "a square root"},
        {"V = 1 [J]*exp(x/1 [m])", "", "hold exp, which"},
        {"V = 1 [J]*cos(x/1 [m])", "", "the sine of what is no turn angle"},
        {"Q(x) = -1 [N]*(2 + x/1 [m])^2.5", "", "hold"},
        {"output o = x\nnoise o deviation 1 [mm] seed 7", "", "outputs of 's' have noise"},
        {"stop x >= -1 [m] restitution 0.5", "", "there are no events in fixed point"},
        {"friction x static 0.3 kinetic 0.2 normal 1 [N]", "", "has this friction"},
        {"V = 1 [J]*x^2/1 [m^2]", "with ledger", "keeps a ledger"},
        {"V = 1 [J*m]/(x + 3 [m])",
         "range x = -4 .. 4 [m], x' = -9 .. 9 [m/s], a' = -1 .. 1 [rad/s]",
         "a denominator of the equations of 's' may be zero"},
        {"V = 1 [J]*x^2/1 [m^2]", "range x = 1 .. 2 [m]", "starts at 0, outside its range"},
        {"V = 1 [J]*x^2/1 [m^2]",
         "step 1 [s]; range x = -1 .. 1 [m], x' = -1e9 .. 1e9 [m/s], a' = -1e9 .. 1e9 [rad/s]",
         "too far for fixed point"},
    };
    char text[TEXT_SIZE];
    for (size_t i = 0; i < sizeof tried / sizeof tried[0]; i++) {
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
            "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n%s\nscene s { start x' = 0.1 [m/s]; until 1 [s]\n%s }\n",
            tried[i].energy, tried[i].more);
        check_refused(text, tried[i].why);
    }
}

/* The same denominator, kept from zero by its range. */
TEST(fixed_runs, ranges_keep_denominators_from_zero) {
    derived d = derived_scene(
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [J*m]/(x + 3 [m]) + 2 [N/m]*x^2\n"
        "scene s { start x' = 0.1 [m/s]; range x = -2 .. 4 [m], x' = -9 .. 9 [m/s]; until 1 [s] }\n",
        "s");
    derived_expect(&d, "denominator");
    check_beside_double(&d, true, "a denominator from 1 to 7");
    derived_free(&d);
}

/* An invalid range is reported with its place. */
TEST(fixed_runs, ranges_in_the_language) {
    static const char *const tried[][2] = {
        {"range x = 1 .. -1 [m]", "holds nothing"},
        {"range x = 1 [m]", "'..' is missing"},
        {"range x = -1 .. 1 [s]", "is length"},
        {"range k = -1 .. 1", "coordinates, their rates and inputs"},
        {"range x'' = -1 .. 1 [m/s^2]", "fewer primes"},
        {"range u' = -1 .. 1 [N/s]", "no prime"},
        {"range x = -1 .. 1 [m], x = -2 .. 2 [m]", "already given"},
        {"range nobody = 0 .. 1", "is unknown"},
    };
    char text[TEXT_SIZE];
    for (size_t i = 0; i < sizeof tried / sizeof tried[0]; i++) {
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\nparameter k = 3\ninput u = 1 [N]\nT = 1 [kg]*x'^2/2\nQ(x) = u\n"
            "scene s { %s }\n",
            tried[i][0]);
        derived d = derived_scene(text, "s");
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, tried[i][1]), d.errors);
        derived_free(&d);
    }
    derived d =
        derived_scene("mechanism m\ncoordinate x [m]\nparameter vm = 3 [m/s]\nT = 1 [kg]*x'^2/2\n"
                      "scene s { range x = -500..250 [mm],\n x' = -vm .. 2*vm }\n",
                      "s");
    derived_expect(&d, "ranges");
    TEST_ASSERT_EQUAL_DOUBLE(-0.5, d.image->range[0].low);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, d.image->range[0].high);
    TEST_ASSERT_EQUAL_DOUBLE(6.0, d.image->range[1].high);
    derived_free(&d);
}
