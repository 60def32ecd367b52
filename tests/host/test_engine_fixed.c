/* test_engine_fixed.c: steps in fixed point (host/fixed/engine_fixed.h) of random mechanisms against the same steps in
 * double. The steps are so long and few that the difference is round-off, while a stage other than Runge-Kutta's would
 * be visible. Also other queries of a run. test_fixed.c has whole runs. */
#include "command.h"
#include "derived.h"
#include "host/engine/engine.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"

void suite_engine_fixed(void);

enum { TEXT_SIZE = 1500, KINDS = 5, MOST = 16 };

static dice die;

static double some(double low, double high) { return dice_between(&die, low, high); }

/* A mechanism m with a scene s. Every operation of the lists occurs in one of them. */
static void write_mechanism(char *text, int which) {
    char rest[200];
    snprintf(rest, sizeof rest, "step %.3f [s]; until %.1f [s] }\n",
             which == 1 ? some(0.004, 0.01) : some(0.012, 0.025), which == 1 ? 0.3 : 1.0);
    switch (which) {
    case 0:
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput f = %.6f [N]\n"
            "T = %.6f [kg]*x'^2/2 + 1.5 [kg]*y'^2/2\nV = %.6f [N/m]*(y - x)^2/2 + 20 [N/m]*x^2/2\n"
            "Q(x) = f - 0.8 [N*s^2/m^2]*x'*abs(x')\n"
            "Q(y) = -2 [N*s/m]*min(y', 0.1 [m/s]) - 3 [N/m]*max(y, 0.05 [m])\n"
            "output o = x - 2*y\noutput p = f\nscene s { range f = -2 .. 2 [N], x = -1 .. 1 [m], y = -1 .. 1 [m], x' = -3 .. 3 [m/s], y' = -3 .. 3 [m/s]; start x = 0.1 [m]; %s",
            some(-1, 1), some(1, 2), some(10, 60), rest);
        break;
    case 1:
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\ninput M = %.6f [N*m]\n"
            "T = %.6f [kg*m^2]*(1.5 + cos(2*a + 0.3))*a'^2/2 + 1 [kg]*x'^2/2\n"
            "V = %.6f [J]*sin(3*a) + 9 [N/m]*x^2/2\nF = 0.4 [N*m*s]*a'^2/2\nQ(a) = M\n"
            "Q(x) = -0.5 [N]*sign(x - 0.02 [m])\noutput o = x*sin(a)\noutput p = M\noutput r = x' \n"
            "scene s { range M = -1 .. 1 [N*m], a' = -6 .. 6 [rad/s]; start a' = %.6f [rad/s], x = 0.2 [m]; %s",
            some(0.1, 0.4), some(0.3, 0.6), some(0.1, 0.5), some(-3, 3), rest);
        break;
    case 2:
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ninput M = %.6f [N*m]\n"
            "T = %.6f [kg*m^2]*(2*a'^2 + b'^2 + a'*b'*cos(a - b))/2\n"
            "V = -%.6f [J]*(2*cos(a) + cos(b))\nF = 0.1 [N*m*s]*(a'^2 + (a' - b')^2)/2\nQ(a) = M\n"
            "output o = a - b\noutput p = M\nscene s { range M = -1 .. 1 [N*m], a' = -12 .. 12 [rad/s], b' = -12 .. 12 [rad/s]; start a = %.6f [rad], b = -0.4 [rad]; %s",
            some(-0.4, 0.4), some(0.4, 0.7), some(1, 4), some(-0.7, 0.7), rest);
        break;
    case 3:
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\nstate p [rad]\nstate v [V]\nstate q\ninput d = %.6f [V]\n"
            "equation p' = %.6f [1/s]*(1 + 0.3*sin(p)) + 0.1 [1/s]*q\n"
            "equation v' = %.6f [1/s]*(d - v + 0.5 [V]*cos(2*p - 1))\n"
            "equation q''/(30 [1/s^2]) + %.6f*q'/(5 [1/s]) + q = v/(1 [V])\n"
            "output o = v*q\noutput e = d\nscene s { range d = -2 .. 2 [V], v = -4 .. 4 [V], q = -4 .. 4, q' = -30 .. 30 [1/s]; %s",
            some(0.2, 1), some(1, 4), some(0.5, 3), some(0.1, 0.4), rest);
        break;
    default: /* a negative denominator, and one of a wide range */
        snprintf(
            text, TEXT_SIZE,
            "mechanism m\nstate x\nstate y\ninput d = %.6f\n"
            "equation x' = %.6f [1/s]*(d - x)/(-1.1 - y^2) + 0.2 [1/s]\n"
            "equation y' = %.6f [1/s]*(x - y)/(0.05 + y^2)/20\noutput o = x + y\noutput e = d\n"
            "scene s { range d = -1 .. 1, x = -2 .. 2, y = -2 .. 2; start x = 0.3, y = %.6f; %s",
            some(0.1, 0.3), some(-1.5, -0.5), some(0.5, 1), some(-0.6, 0.6), rest);
    }
}

static fixed_plan *planned(derived *d, const char *text) {
    *d = derived_scene(text, "s");
    derived_expect(d, text);
    diags *errors = diags_new();
    fixed_plan *p = fixed_plan_make(d->image, false, errors);
    if (p == NULL) {
        diags_flush(errors, stdout);
    }
    diags_free(errors);
    TEST_ASSERT_NOT_NULL_MESSAGE(p, text);
    d->image->fixed = p;
    return p;
}

static void drop(derived *d, fixed_plan *p) {
    d->image->fixed = NULL;
    fixed_plan_free(p);
    derived_free(d);
}

/* Angles, then reals. */
static void state_of(const engine_kind *kind, const image *im, const void *run, double *state) {
    kind->state(run, state, state + im->angles);
}

/* The largest difference, each in its own fixed-point unit. */
static double units_off(const image *im, const void *fixed, const void *exact) {
    double is[MOST];
    double wanted[MOST];
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

/* Bound on round-off: list results have errors of some units, a step has four of them, and positions integrate the
 * rates' errors. A force with a squared rate has fewer digits than the rate. Maxima of 25 seeds: 482, 36, 631, 10 and
 * 7. */
static const double units_most[KINDS] = {1200.0, 90.0, 1600.0, 25.0, 25.0};

TEST(engine_fixed, steps) {
    double worst[KINDS] = {0.0};
    for (int which = 0; which < KINDS; which++) {
        for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
            static char text[TEXT_SIZE];
            derived d;
            write_mechanism(text, which);
            fixed_plan *p = planned(&d, text);
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
                if (k == im->steps / 2) { /* another input from here on */
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

/* Outputs belong to the reported state. An input is stored to half a unit and clamped to its range, with a count. */
TEST(engine_fixed, outputs_and_inputs) {
    for (unsigned c = 0; c < dice_cases(usual_or(10, 5)); c++) {
        static char text[TEXT_SIZE];
        derived d;
        double output[4];
        double is[MOST];
        const int which = (int)(c % KINDS);
        write_mechanism(text, which);
        fixed_plan *p = planned(&d, text);
        const image *im = d.image;
        void *run = engine_fixed.start(im);
        for (int k = 0; k < 5; k++) {
            (void)engine_fixed.step(run);
        }
        state_of(&engine_fixed, im, run, is);
        engine_fixed.outputs(run, output);
        const double wanted[KINDS] = {is[0] - 2.0 * is[1], is[1] * sin(is[0]), is[0] - is[1],
                                      is[1] * is[2], is[0] + is[1]};
        TEST_ASSERT_TRUE_MESSAGE(fabs(output[0] - wanted[which]) < 1e-13, text);
        TEST_ASSERT_TRUE(which != 1 || output[2] == is[3]); /* a, x, a', x' */
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

/* The same run has the same hash after each step, and the next step another; no failures, no events. */
TEST(engine_fixed, asked) {
    for (unsigned c = 0; c < dice_cases(usual_or(5, 5)); c++) {
        static char text[TEXT_SIZE];
        derived d;
        write_mechanism(text, (int)(c % KINDS));
        fixed_plan *p = planned(&d, text);
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

void suite_engine_fixed(void) { die = dice_of("engine_fixed", 52); }
