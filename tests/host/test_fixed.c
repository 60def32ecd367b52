/* test_fixed.c: fixed-point runs must report significant round-off and nothing else. Random motions have closed
 * forms, with ranges and steps of many sizes. A correct energy balance must be accepted. */
#include "host/base/alloc.h"
#include "host/check/energy_residual.h"
#include "host/check/slow.h"
#include "host/cli/commands.h"
#include "host/engine/engine.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"

#include "command.h"
#include "derived.h"

/* === suite fixed_loss ========================================================================= */

typedef struct outcome {
    double angle[4];
    double real[4];
    int told;
    bool held;
    energy_residual belief;
} outcome;

/* Calls fixed_plan_make(). *report: its messages, which the caller frees. */
static fixed_plan *plan_of(const image *im, char **report) {
    size_t length;
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(im, false, errors);
    FILE *out = alloc_text(report, &length);
    diags_flush(errors, out);
    alloc_text_end(out);
    diags_free(errors);
    return p;
}

/* Makes the plan of the image and stores it in image->fixed. drop() removes the plan. */
static fixed_plan *planned(const derived *d) {
    char *report;
    fixed_plan *p = plan_of(d->image, &report);
    TEST_ASSERT_NOT_NULL_MESSAGE(p, report);
    free(report);
    d->image->fixed = p;
    return p;
}

static void drop(derived *d, fixed_plan *p) {
    d->image->fixed = NULL;
    fixed_plan_free(p);
    derived_free(d);
}

static outcome run_of(derived *d) {
    outcome end = {.told = 0};
    fixed_plan *p = planned(d);
    void *run = engine_fixed.start(d->image);
    books *b = books_open(d->image);
    for (uint64_t k = 0; k <= d->image->steps; k++) {
        if (b != NULL) {
            books_enter(b, &engine_fixed, run);
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, k < d->image->steps ? engine_fixed.step(run) : WH_OK);
    }
    double share;
    end.told = slow_count(&engine_fixed, d->image, run, &share);
    end.held = engine_fixed.saturated(run) > 0;
    end.belief = energy_residual_of(b, &engine_fixed, run);
    TEST_ASSERT_EQUAL_INT(end.held, end.belief.saturated);
    engine_fixed.state(run, end.angle, end.real);
    books_close(b);
    engine_fixed.stop(run);
    drop(d, p);
    return end;
}

/* Runs a mass under a constant force (kind 0), a rotor at constant speed (1) or a state with a constant rate (2) for
 * 2 s. */
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
    const outcome end = run_of(&d);
    const double span = 2.0 * value;
    const double where = kind == 1 ? end.angle[0] : end.real[0];
    /* rounding the start and the input adds an error to that of the steps */
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
    free(text);
    free(with);
}

TEST(fixed_loss, lost_steps_are_warned_of) {
    static const int step_us[] = {20, 100, 1000, 10000};
    uint64_t seed = 77;
    int told = 0;
    int quiet = 0;
    for (int kind = 0; kind < 3; kind++) {
        for (int power = 0; power <= 6; power++) {
            for (int n = 0; n < 4; n++) {
                /* an angle has a fixed unit, so a slow rotor takes the place of a wide range */
                const double value = kind == 1 ? pow(10.0, -power) : 1.0;
                try_even_motion(kind, value * random_between(&seed, 0.5, 2.0),
                                kind == 1 ? 1.0 : pow(10.0, power), step_us[n], &told, &quiet);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(15, told);
    TEST_ASSERT_GREATER_THAN_INT(25, quiet);
}

/* Oscillators of all masses and springs, some almost at rest. The balance of an accurate run must be accepted. */
TEST(fixed_loss, accurate_balances_are_accepted) {
    int right = 0;
    for (int mass = -6; mass <= 6; mass += 2) {
        for (int spring = -6; spring <= 6; spring += 2) {
            const double w = pow(10.0, 0.5 * (spring - mass));
            if (w > 100.0) { /* the step is too coarse for this spring */
                continue;
            }
            char *text = alloc_words(
                "mechanism m\ncoordinate x [m]\nT = 1e%d [kg]*x'^2/2\nV = 1e%d [N/m]*x^2/2\n"
                "scene s { start x = 1 [m]; step 1 [ms]; until 5 [s] }\n",
                mass, spring);
            derived d = derived_scene(text, "s");
            derived_expect(&d, text);
            const outcome end = run_of(&d);
            if (fabs(end.real[0] - cos(5.0 * w)) < 1e-5) {
                TEST_ASSERT_FALSE_MESSAGE(energy_residual_lost(&end.belief, ENERGY_RESIDUAL_LIMIT),
                                          text);
                right++;
            }
            free(text);
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(30, right);
}

/* === suite fixed_runs ========================================================================= */
/* Fixed-point runs of random smooth mechanisms, compared with the run in double: the difference must be below the
 * round-off of the number formats. Also ranges that are too small, and refusals. */

enum { KINDS = 5, CASES = 40, TEXT_SIZE = 3000, MOST = 8 };

/* Writes a mechanism m of kind `which` and its scene s with these ranges. Kinds: masses between springs, one of
 * which is one-sided; a damped pendulum on a carriage; a driven rotor with an uneven load; two coupled pendulums; a
 * system of first order. */
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

/* Runs the scene to its end. Results: end[] has the reals, then the angles; far[] has the largest absolute value of
 * each real. */
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

/* Writes the range of each real and input, such as "range x = -0.3 .. 0.3 [m]". The limit is `times` times the
 * largest value of the run. */
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

/* Bound on the round-off of real i at the end. Each step adds one unit of the stored number, at random, and two units
 * of each list result, which constants can give the same sign in every step. Positions integrate the errors of rates.
 * The mechanisms are damped, so an error does not grow; the factor PASSED_ON allows for swings between bodies. */
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
        const double of_one = at >= 0 ? 1.0 : 6.283185307179586 / 4294967296.0; /* as a phase */
        const double most = of_one * fmax(fabs(result->range.low), fabs(result->range.high));
        rate = fmax(rate, some * unit + steps * 2.0 * ldexp(most, -FIXED_RESULT_DIGITS));
    }
    return PASSED_ON * (some * ldexp(1.0, -p->format[i].bits) + rate * (1.0 + im->until_s));
}

static void check_beside_double(const derived *d, bool declared, const char *text) {
    double fixed[2 * MOST];
    double exact[2 * MOST];
    fixed_plan *p = planned(d);
    for (int i = 0; i < d->image->reals + d->image->inputs; i++) {
        TEST_ASSERT_EQUAL_INT(declared, p->image->range[i].declared);
    }
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, run(&engine_fixed, d->image, fixed, NULL), text);
    (void)run(&engine_double, d->image, exact, NULL);
    for (int i = 0; i < d->image->reals; i++) {
        const double bound = bound_of(p, i);
        const double size = fmax(fabs(p->range[i].low), fabs(p->range[i].high));
        TEST_ASSERT_TRUE_MESSAGE(bound < 3e-3 * size, text); /* a wide bound would show nothing */
        TEST_ASSERT_TRUE_MESSAGE(fabs(fixed[i] - exact[i]) <= bound, text);
    }
    d->image->fixed = NULL;
    fixed_plan_free(p);
}

static void check_saturation(const derived *d, const char *text) {
    double end[2 * MOST];
    char *report;
    fixed_plan *p = plan_of(d->image, &report);
    TEST_ASSERT_TRUE_MESSAGE((p == NULL) == (report[0] != '\0'), report);
    free(report);
    if (p == NULL) { /* the scene may start outside its ranges */
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
        beyond.image->range[i].low *= 2.0; /* the inputs shall not leave their ranges */
        beyond.image->range[i].high *= 2.0;
    }
    check_saturation(&beyond, text);
    derived_free(&beyond);
    derived_free(&plain);
}

TEST(fixed_runs, random_mechanisms) {
    for (int which = 0; which < KINDS; which++) {
        for (unsigned i = 0; i < CASES / KINDS; i++) {
            try_one(which, 1000U * (unsigned)which + i + 7U);
        }
    }
}

static void check_refused(const char *text, const char *why) {
    char *report;
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    TEST_ASSERT_NULL_MESSAGE(plan_of(d.image, &report), text);
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
        {"V = 1 [J]*exp(x/1 [m])", "", "contain exp, which"},
        {"V = 1 [J]*cos(x/1 [m])", "", "the sine of a quantity other than a turn angle"},
        {"Q(x) = -1 [N]*(2 + x/1 [m])^2.5", "", "contain"},
        {"output o = x\nnoise o deviation 1 [mm] seed 7", "", "outputs of 's' have noise"},
        {"stop x >= -1 [m] restitution 0.5", "", "fixed point does not support events"},
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

TEST(fixed_runs, ranges_keep_denominators_from_zero) {
    derived d = derived_scene(
        "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [J*m]/(x + 3 [m]) + 2 [N/m]*x^2\n"
        "scene s { start x' = 0.1 [m/s]; range x = -2 .. 4 [m], x' = -9 .. 9 [m/s]; until 1 [s] }\n",
        "s");
    derived_expect(&d, "denominator");
    check_beside_double(&d, true, "a denominator from 1 to 7");
    derived_free(&d);
}

/* Bounds with any unit, and bounds that use parameters. Wrong bounds are in tests/bad/scene.texts. */
TEST(fixed_runs, ranges_in_the_language) {
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

/* === suite fixed_ranges ====================================================================== */
/* Fixed point with ranges and steps of all sizes. The choice of formats must end with a plan, or with a refusal whose
 * hint helps. A coordinate whose acceleration is zero must still move. */

static bool is_made(const image *im) {
    char *report;
    fixed_plan *p = plan_of(im, &report);
    const bool made = p != NULL;
    free(report);
    fixed_plan_free(p);
    return made;
}

static void set_ranges(image *im, double size) {
    for (int i = 0; i < im->reals + im->inputs; i++) {
        im->range[i].declared = true;
        im->range[i].low = -size;
        im->range[i].high = size;
    }
}

static const char *const wide[] = {
    "coordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 100 [N/m^3]*x^4/4\n",
    "coordinate x [m]\ninput u = 0 [N]\nT = 1 [kg]*x'^2/2\nV = 1 [N/m^7]*x^8\nF = 3 [N*s/m]*x'^2\nQ(x) = u\n",
    "coordinate x [m]\nT = 1 [kg]*x'^2/2 + 2 [kg/m^2]*x^2*x'^2\nV = 40 [N/m]*x^2/2\n",
    "coordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nV = -2 [J]*cos(a)\nF = 1e-3 [N*m*s]*a'^2\n",
    ("coordinate a [rad]\ncoordinate b [rad]\n"
     "T = 1 [kg*m^2]*(2*a'^2 + b'^2 + a'*b'*cos(a - b))/2\nV = -2 [J]*cos(a)\n"),
    "state x\nequation x'*1 [s] = -x^3\n",
    "state x\nequation x'*1 [s] = x - x^5\n",
    "state x\nstate p [rad]\nequation x'*1 [s] = -x^3*sin(p)\nequation p'*1 [s] = x^2\n",
    "state x\nstate y\nequation x'*1 [s] = 1/(1 + x^2) - y\nequation y'*1 [s] = x*y\n",
};

/* With shorter steps or narrower ranges, as the hints ask, planning must succeed. */
static void check_hint(image *im, double size, const char *report) {
    const double step_s = im->step_s;
    bool helped = false;
    for (int down = 0; size * pow(0.1, down) > 1e-11 && !helped; down++) {
        set_ranges(im, size * pow(0.1, down));
        for (int k = 0; k <= 4 && !helped; k++) {
            im->step_s = step_s * pow(0.1, k);
            helped = is_made(im);
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(helped, report);
}

TEST(fixed_ranges, ranges_and_steps_of_any_size) {
    static const double step_s[] = {1e-6, 1e-4, 1e-3, 1e-2, 1.0};
    int made = 0;
    int refused = 0;
    for (size_t k = 0; k < sizeof wide / sizeof wide[0]; k++) {
        char *text = alloc_words("mechanism m\n%sscene s { until 1 [s] }\n", wide[k]);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        for (int power = -9; power <= 300;
             power += power < 12 ? (int)few_or_all(4, 1) : (int)few_or_all(96, 32)) {
            for (size_t n = 0; n < sizeof step_s / sizeof step_s[0]; n += few_or_all(2, 1)) {
                const double size = pow(10.0, power);
                char *report;
                set_ranges(d.image, size);
                d.image->step_s = step_s[n];
                fixed_plan *p = plan_of(d.image, &report);
                made += p != NULL;
                if (p == NULL) {
                    refused++;
                    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(report, "hint: "), report);
                    check_hint(d.image, size, report);
                }
                free(report);
                fixed_plan_free(p);
            }
        }
        derived_free(&d);
        free(text);
    }
    TEST_ASSERT_GREATER_THAN_INT((int)few_or_all(25, 200), made);
    TEST_ASSERT_GREATER_THAN_INT((int)few_or_all(25, 200), refused);
}

static void run_to_end(const image *im, double *angle, double *real) {
    void *run = engine_fixed.start(im);
    for (uint64_t k = 0; k < im->steps; k++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, engine_fixed.step(run));
    }
    TEST_ASSERT_EQUAL_UINT64(0, engine_fixed.saturated(run));
    engine_fixed.state(run, angle, real);
    engine_fixed.stop(run);
}

/* Bound on the round-off of a position: half a unit for each step, and one unit of the rate over the whole time. */
static double range_bound_of(const fixed_plan *p, int at, int rate, double until_s) {
    const double unit = at >= 0 ? ldexp(1.0, -p->format[at].bits) : 1.4629180793e-9;
    const double of_rate = rate >= 0 ? ldexp(1.0, -p->format[rate].bits) : 0.0;
    return 0.51 * (double)p->image->steps * unit + until_s * of_rate;
}

TEST(fixed_ranges, motion_without_acceleration) {
    static const struct {
        const char *text;
        int at, rate; /* numbers of position and rate in the reals; -1: the angle, or none */
        bool moves;
    } kinds[] = {
        {"coordinate a [rad]\nT = 1 [kg*m^2]*a'^2/2\nscene s { start a' = %.9f [rad/s]", -1, 0,
         true},
        {"coordinate y [m]\nT = 3 [kg]*y'^2/2\nscene s { start y' = %.9f [m/s]", 0, 1, true},
        {"coordinate t [s]\nT = 1e-9 [J]*t'^2/2\nscene s { start t' = %.9f", 0, 1, true},
        {"coordinate x [m]\ncoordinate t [s]\nT = 2 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
         "V = 50 [N/m]*x^2/2\nQ(x) = 4 [N/s]*t\nscene s { start t' = %.9f",
         1, 3, true},
        {"state c\nstate d\nequation c'*1 [s] = 0\nequation d'*1 [s] = c - d\n"
         "scene s { start c = %.9f",
         0, -1, false},
        {"state c\nequation c'*1 [s] = %.9f\nscene s {", 0, -1, true},
    };
    uint64_t seed = 91;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        for (int i = 0; i < 12; i++) {
            double angle[4] = {0};
            double real[4] = {0};
            const double value = pow(10.0, random_between(&seed, -2.0, 2.0));
            const double until_s = 2.0;
            char *with = alloc_words(kinds[k].text, value);
            char *text = alloc_words("mechanism m\n%s; step %d [us]; until 2 [s] }\n", with,
                                     (int[]){50, 100, 500, 1000, 5000, 20000}[i % 6]);
            derived d = derived_scene(text, "s");
            derived_expect(&d, text);
            fixed_plan *p = planned(&d);
            run_to_end(d.image, angle, real);
            const double end = kinds[k].at < 0 ? angle[0] : real[kinds[k].at];
            const double expected = kinds[k].moves ? value * until_s : value;
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(
                range_bound_of(p, kinds[k].at, kinds[k].rate, until_s) + 1e-9 * value, expected,
                end, text);
            drop(&d, p);
            free(text);
            free(with);
        }
    }
}

/* A swing that is so small that one step changes the rate by more than its whole range. No range is declared. */
TEST(fixed_ranges, small_swings) {
    for (int power = -7; power <= 0; power++) {
        char *text = alloc_words("mechanism m\ncoordinate th [rad]\nT = 0.144 [kg*m^2]*th'^2/2\n"
                                 "V = -2.3544 [J]*cos(th)\nF = 0.02 [N*m*s]*th'^2\n"
                                 "scene s { start th = %.9g [rad]; step 1 [ms]; until 2 [s] }\n",
                                 pow(10.0, power));
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        drop(&d, planned(&d));
        free(text);
    }
}

enum { INPUTS_MOST = 3, RANGES_TEXT = 400 };

/* Derives the fixed-point code of a scene with inputs that push to either side, and with these ranges. *said: the
 * messages. */
static void derive_pushed(int inputs, const double *start, const char *ranges, said *what) {
    char text[1500];
    int length = snprintf(text, sizeof text, "mechanism pushed\ncoordinate x [m]\n");
    for (int i = 0; i < inputs; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "input u%d = %.17g [N]\n",
                           i, start[i]);
    }
    length += snprintf(text + length, sizeof text - (size_t)length,
                       "T = 2 [kg]*x'^2/2\nV = 50 [N/m]*x^2/2\nF = 3 [N*s/m]*x'^2/2\nQ(x) = u0");
    for (int i = 1; i < inputs; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length, " + u%d", i);
    }
    snprintf(text + length, sizeof text - (size_t)length,
             "\nscene s { start x = 0.3 [m]; until 1 [s]%s }\n", ranges);
    COMMAND_SAY(command_derive, what, model_keep(text), "--as", "c", "--number", "fixed");
    model_drop();
}

/* Each input without a range must be refused with a hint. If all hints are pasted, the scene must be accepted. */
TEST(fixed_ranges, inputs_must_declare_ranges) {
    dice d = dice_of("fixed_ranges", 46);
    const unsigned cases = dice_cases(usual_or(24, 8));
    for (unsigned k = 0; k < cases; k++) {
        const int inputs = 1 + (int)(k % INPUTS_MOST);
        const unsigned declared = dice_one_of(&d, 1U << inputs);
        double start[INPUTS_MOST];
        char ranges[RANGES_TEXT] = "";
        size_t length = 0;
        said what;
        for (int i = 0; i < inputs; i++) {
            start[i] = dice_one_of(&d, 4) == 0 ? 0.0 : dice_between(&d, -2.0, 2.0);
            if ((declared >> i & 1U) != 0) { /* a range around the start value, which may be zero */
                length += (size_t)snprintf(
                    ranges + length, sizeof ranges - length, "; range u%d = %.17g .. %.17g [N]", i,
                    start[i] - dice_between(&d, 0.1, 3.0), start[i] + dice_between(&d, 0.1, 3.0));
            }
        }
        derive_pushed(inputs, start, ranges, &what);
        const bool all = declared == (1U << inputs) - 1U;
        TEST_ASSERT_EQUAL_INT_MESSAGE(all ? 0 : 2, what.status, what.err);
        const char *at = what.err;
        for (int i = 0; i < inputs; i++) {
            char wanted[40];
            snprintf(wanted, sizeof wanted, "range of the input 'u%d'", i);
            TEST_ASSERT_TRUE_MESSAGE(
                (strstr(what.err, wanted) != NULL) == ((declared >> i & 1U) == 0), what.err);
        }
        while ((at = strstr(at, "in the scene: ")) != NULL) {
            at += strlen("in the scene: ");
            length += (size_t)snprintf(ranges + length, sizeof ranges - length, "; %.*s",
                                       (int)strcspn(at, "\n"), at);
        }
        derive_pushed(inputs, start, ranges, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    }
}

/* === suite engine_fixed ====================================================================== */
/* Steps in fixed point (host/fixed/engine_fixed.h), compared with the same steps in double, for random mechanisms.
 * The steps are so long and so few that a wrong Runge-Kutta stage would exceed the round-off. Also other queries of
 * a run. The suites above test whole runs. */

enum { ENGINE_TEXT_SIZE = 1500, ENGINE_KINDS = 5, ENGINE_MOST = 16 };

static dice die;

static double some(double low, double high) { return dice_between(&die, low, high); }

/* Writes mechanism number `which`, m, and its scene s. Together, the mechanisms use every operation of the lists. */
static void engine_write_mechanism(char *text, int which) {
    char rest[200];
    snprintf(rest, sizeof rest, "step %.3f [s]; until %.1f [s] }\n",
             which == 1 ? some(0.004, 0.01) : some(0.012, 0.025), which == 1 ? 0.3 : 1.0);
    switch (which) {
    case 0:
        snprintf(
            text, ENGINE_TEXT_SIZE,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput f = %.6f [N]\n"
            "T = %.6f [kg]*x'^2/2 + 1.5 [kg]*y'^2/2\nV = %.6f [N/m]*(y - x)^2/2 + 20 [N/m]*x^2/2\n"
            "Q(x) = f - 0.8 [N*s^2/m^2]*x'*abs(x')\n"
            "Q(y) = -2 [N*s/m]*min(y', 0.1 [m/s]) - 3 [N/m]*max(y, 0.05 [m])\n"
            "output o = x - 2*y\noutput p = f\nscene s { range f = -2 .. 2 [N], x = -1 .. 1 [m], y = -1 .. 1 [m], x' = -3 .. 3 [m/s], y' = -3 .. 3 [m/s]; start x = 0.1 [m]; %s",
            some(-1, 1), some(1, 2), some(10, 60), rest);
        break;
    case 1:
        snprintf(
            text, ENGINE_TEXT_SIZE,
            "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\ninput M = %.6f [N*m]\n"
            "T = %.6f [kg*m^2]*(1.5 + cos(2*a + 0.3))*a'^2/2 + 1 [kg]*x'^2/2\n"
            "V = %.6f [J]*sin(3*a) + 9 [N/m]*x^2/2\nF = 0.4 [N*m*s]*a'^2/2\nQ(a) = M\n"
            "Q(x) = -0.5 [N]*sign(x - 0.02 [m])\noutput o = x*sin(a)\noutput p = M\noutput r = x' \n"
            "scene s { range M = -1 .. 1 [N*m], a' = -6 .. 6 [rad/s]; start a' = %.6f [rad/s], x = 0.2 [m]; %s",
            some(0.1, 0.4), some(0.3, 0.6), some(0.1, 0.5), some(-3, 3), rest);
        break;
    case 2:
        snprintf(
            text, ENGINE_TEXT_SIZE,
            "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ninput M = %.6f [N*m]\n"
            "T = %.6f [kg*m^2]*(2*a'^2 + b'^2 + a'*b'*cos(a - b))/2\n"
            "V = -%.6f [J]*(2*cos(a) + cos(b))\nF = 0.1 [N*m*s]*(a'^2 + (a' - b')^2)/2\nQ(a) = M\n"
            "output o = a - b\noutput p = M\nscene s { range M = -1 .. 1 [N*m], a' = -12 .. 12 [rad/s], b' = -12 .. 12 [rad/s]; start a = %.6f [rad], b = -0.4 [rad]; %s",
            some(-0.4, 0.4), some(0.4, 0.7), some(1, 4), some(-0.7, 0.7), rest);
        break;
    case 3:
        snprintf(
            text, ENGINE_TEXT_SIZE,
            "mechanism m\nstate p [rad]\nstate v [V]\nstate q\ninput d = %.6f [V]\n"
            "equation p' = %.6f [1/s]*(1 + 0.3*sin(p)) + 0.1 [1/s]*q\n"
            "equation v' = %.6f [1/s]*(d - v + 0.5 [V]*cos(2*p - 1))\n"
            "equation q''/(30 [1/s^2]) + %.6f*q'/(5 [1/s]) + q = v/(1 [V])\n"
            "output o = v*q\noutput e = d\nscene s { range d = -2 .. 2 [V], v = -4 .. 4 [V], q = -4 .. 4, q' = -30 .. 30 [1/s]; %s",
            some(0.2, 1), some(1, 4), some(0.5, 3), some(0.1, 0.4), rest);
        break;
    case 4: /* divides by a negative number, and by a number with a wide range */
        snprintf(
            text, ENGINE_TEXT_SIZE,
            "mechanism m\nstate x\nstate y\ninput d = %.6f\n"
            "equation x' = %.6f [1/s]*(d - x)/(-1.1 - y^2) + 0.2 [1/s]\n"
            "equation y' = %.6f [1/s]*(x - y)/(0.05 + y^2)/20\noutput o = x + y\noutput e = d\n"
            "scene s { range d = -1 .. 1, x = -2 .. 2, y = -2 .. 2; start x = 0.3, y = %.6f; %s",
            some(0.1, 0.3), some(-1.5, -0.5), some(0.5, 1), some(-0.6, 0.6), rest);
    }
}

static fixed_plan *begin(derived *d, int which, char *text) {
    engine_write_mechanism(text, which);
    *d = derived_scene(text, "s");
    derived_expect(d, text);
    return planned(d);
}

/* state[]: angles, then reals. */
static void state_of(const engine_kind *kind, const image *im, const void *run, double *state) {
    kind->state(run, state, state + im->angles);
}

/* The largest difference of any component, in units of its fixed-point format. */
static double units_off(const image *im, const void *fixed, const void *exact) {
    double is[ENGINE_MOST];
    double wanted[ENGINE_MOST];
    double most = 0.0;
    state_of(&engine_fixed, im, fixed, is);
    state_of(&engine_double, im, exact, wanted);
    for (int i = 0; i < im->angles + im->reals; i++) {
        const double unit = engine_fixed.unit(fixed, i);
        const double units = is[i] / unit;
        TEST_ASSERT_TRUE(i < im->angles || units == rint(units)); /* stored values are integers */
        most = fmax(most, fabs(is[i] - wanted[i]) / unit);
    }
    return most;
}

/* Bounds on the round-off, in units. List results have errors of some units, a step has four of them, and positions
 * integrate the errors of rates. A force with a squared rate has fewer digits. The maxima of 25 seeds were 482, 36,
 * 631, 10 and 7. */
static const double units_most[ENGINE_KINDS] = {1200.0, 90.0, 1600.0, 25.0, 25.0};

TEST(engine_fixed, steps) {
    double worst[ENGINE_KINDS] = {0.0};
    for (int which = 0; which < ENGINE_KINDS; which++) {
        for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
            static char text[ENGINE_TEXT_SIZE];
            derived d;
            fixed_plan *p = begin(&d, which, text);
            const image *im = d.image;
            void *fixed = engine_fixed.start(im);
            void *exact = engine_double.start(im);
            for (uint64_t k = 0; k < im->steps; k++) {
                uint64_t most = 1;
                TEST_ASSERT_EQUAL_UINT64(k, engine_fixed.steps(fixed));
                TEST_ASSERT_EQUAL_UINT64(4 * k, engine_fixed.evaluations(fixed, &most));
                TEST_ASSERT_EQUAL_UINT64(0, most);
                worst[which] = fmax(worst[which], units_off(im, fixed, exact));
                TEST_ASSERT_EQUAL_INT(WH_OK, engine_fixed.step(fixed));
                TEST_ASSERT_EQUAL_INT(WH_OK, engine_double.step(exact));
                if (k == im->steps / 2) { /* from here on, another input acts */
                    const double input = im->input[0].value * some(0.2, 0.9);
                    engine_fixed.set_input(fixed, 0, input);
                    engine_double.set_input(exact, 0, input);
                }
            }
            worst[which] = fmax(worst[which], units_off(im, fixed, exact));
            TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, engine_fixed.saturated(fixed), text);
            engine_fixed.stop(fixed);
            engine_double.stop(exact);
            drop(&d, p);
        }
        printf("  kind %d: %.1f units off\n", which, worst[which]);
        TEST_ASSERT_TRUE(worst[which] < units_most[which] && worst[which] > 0.1);
    }
}

/* Outputs must belong to the reported state. An input must be stored to half a unit and limited to its range; the
 * limiting must be counted. */
TEST(engine_fixed, outputs_and_inputs) {
    for (unsigned c = 0; c < dice_cases(usual_or(10, 5)); c++) {
        static char text[ENGINE_TEXT_SIZE];
        derived d;
        double output[4];
        double is[ENGINE_MOST];
        const int which = (int)(c % ENGINE_KINDS);
        fixed_plan *p = begin(&d, which, text);
        const image *im = d.image;
        void *run = engine_fixed.start(im);
        for (int k = 0; k < 5; k++) {
            (void)engine_fixed.step(run);
        }
        state_of(&engine_fixed, im, run, is);
        engine_fixed.outputs(run, output);
        const double wanted[ENGINE_KINDS] = {is[0] - 2.0 * is[1], is[1] * sin(is[0]), is[0] - is[1],
                                             is[1] * is[2], is[0] + is[1]};
        TEST_ASSERT_TRUE_MESSAGE(fabs(output[0] - wanted[which]) < 1e-13, text);
        TEST_ASSERT_TRUE(which != 1 || output[2] == is[3]); /* components a, x, a', x' */
        const enclosure range = p->range[im->reals];
        const double unit = ldexp(1.0, -p->format[im->reals].bits);
        for (int k = 0; k < 20; k++) {
            const double wished = range.low + some(-0.3, 1.3) * (range.high - range.low);
            const double held = fmin(fmax(wished, range.low), range.high);
            const uint64_t before = engine_fixed.saturated(run);
            engine_fixed.set_input(run, 0, wished);
            engine_fixed.outputs(run, output);
            TEST_ASSERT_TRUE(fabs(output[1] - held) <= 1.01 * unit);
            const bool is_out = fabs(wished - held) > 2.0 * unit;
            TEST_ASSERT_TRUE(engine_fixed.saturated(run) - before == (is_out ? 1U : 0U) ||
                             (!is_out && wished != held));
            TEST_ASSERT_TRUE(is_out || wished != held || fabs(output[1] - wished) <= 0.501 * unit);
        }
        engine_fixed.stop(run);
        drop(&d, p);
    }
}

/* Two equal runs must have the same hash after each step, and the hash must change with a step. There must be no
 * failures and no events. */
TEST(engine_fixed, hashes_failures_and_events) {
    for (unsigned c = 0; c < dice_cases(usual_or(5, 5)); c++) {
        static char text[ENGINE_TEXT_SIZE];
        derived d;
        fixed_plan *p = begin(&d, (int)(c % ENGINE_KINDS), text);
        void *one = engine_fixed.start(d.image);
        void *other = engine_fixed.start(d.image);
        for (int k = 0; k < 10; k++) {
            uint64_t overruns = 1;
            const uint64_t before = engine_fixed.hash(one);
            engine_event happened[WH_EVENT_LOG];
            TEST_ASSERT_EQUAL_HEX64(before, engine_fixed.hash(other));
            (void)engine_fixed.step(one);
            TEST_ASSERT_TRUE(before != engine_fixed.hash(one));
            (void)engine_fixed.step(other);
            TEST_ASSERT_EQUAL_INT(-1, engine_fixed.fault(one));
            TEST_ASSERT_EQUAL_UINT64(0, engine_fixed.events(one, &overruns));
            TEST_ASSERT_EQUAL_UINT64(0, overruns);
            TEST_ASSERT_EQUAL_INT(0, engine_fixed.happened(one, happened));
        }
        TEST_ASSERT_TRUE(strcmp(engine_fixed.name, "fixed") == 0 && engine_fixed.digits == 9);
        engine_fixed.stop(one);
        engine_fixed.stop(other);
        drop(&d, p);
    }
}

SUITE(engine_fixed) { die = dice_of("engine_fixed", 52); }
