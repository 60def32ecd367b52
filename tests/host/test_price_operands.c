/* test_price_operands.c: what operations are given as a scene begins to move (host/price/operands.h): against the same
 * steps of the interpreter, the list evaluated at the same six of them, and exponents of libm's; and against what follows
 * from the motion. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "host/price/long_list.h"
#include "host/price/operands.h"
#include "priced.h"
#include "unity.h"

void suite_price_operands(void);

/* Behind step 20 and every tenth up to 70. */
enum { LOOKS = 6, FIRST_LOOK = 20, APART = 10, MOST = IMAGE_COMPONENTS_MAX };

static double rounded(long double value, bool is_float) {
    return is_float ? (double)(float)value : (double)value;
}

static int exponent(double value) {
    int e;
    (void)frexp(value, &e);
    return e;
}

/* Bits that a sum of two, neither of them zero, is shifted by. */
static double bits_of(double a, double b, double sum, int digits) {
    const double larger = fmax(fabs(a), fabs(b));
    const double lesser = fmin(fabs(a), fabs(b));
    const int apart = exponent(larger) - exponent(lesser);
    const int gone = sum == 0.0 ? 0 : exponent(larger) - exponent(sum);
    return fmin(apart, digits) + fmin(fmax(gone, 0), digits);
}

/* What is seen at one step is added. */
static void see(const tape *t, long_list *l, bool is_float, operands *seen) {
    const int digits = is_float ? 24 : 53;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        if (o->code != OP_ADD && o->code != OP_SUB && o->code != OP_MUL) {
            continue;
        }
        const double a = rounded(long_list_value(l, o->a), is_float);
        const double b = rounded(long_list_value(l, o->b), is_float);
        const double is = rounded(long_list_value(l, i), is_float);
        if (fabs(a) == 0.0 || fabs(b) == 0.0) {
            seen->of[i].zero += 1.0 / LOOKS;
        } else if (o->code != OP_MUL) {
            const bool alike = signbit(a) == signbit(b);
            seen->of[i].opposed += alike == (o->code == OP_SUB) ? 1.0 / LOOKS : 0.0;
            seen->of[i].bits += bits_of(a, b, is, digits) / LOOKS;
        }
    }
}

static void see_state(const image *im, const double *angle, const double *real,
                      const long double *slope, bool is_float, operands *seen) {
    const double once = 1.0 / LOOKS;
    const bool second = im->form == WH_SECOND_ORDER;
    const int n = second ? im->coordinates : im->angles + im->reals;
    for (int i = 0; i < im->reals; i++) {
        seen->real[i] += fabs(real[i]) > 0.0 ? 0.0 : once;
    }
    for (int i = 0; i < n && slope != NULL; i++) {
        const double rate = second ? real[im->coordinates - im->angles + i] : 0.0;
        const bool driven = fabs(rounded(slope[i], is_float)) > 0.0;
        seen->accel[i] += driven ? 0.0 : once;
        seen->rate[i] += second && rate == 0.0 ? once : 0.0;
        if (i < im->angles) {
            seen->still[i] += rate == 0.0 && !driven ? once : 0.0;
            seen->at_zero[i] += angle[i] == 0.0 ? once : 0.0;
        }
    }
}

static bool is_near(double a, double b) { return fabs(a - b) < 1e-12 * (1.0 + fabs(b)); }

static operands looked_at(const image *im, const tape *t, const engine_kind *kind) {
    const bool is_float = kind == &engine_float;
    operands seen = {.of = calloc((size_t)t->count + 1, sizeof *seen.of), .is_float = is_float};
    const int linears = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
    long_list *l = long_list_new(t);
    void *run = kind->start(im);
    double input[MOST];
    double angle[MOST];
    double real[2 * MOST];
    long double all[3 * MOST];
    long double result[4 * MOST];
    for (int i = 0; i < im->inputs; i++) {
        input[i] = im->input[i].value;
    }
    for (int step = 1; step <= FIRST_LOOK + (LOOKS - 1) * APART; step++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, kind->step(run));
        if (step < FIRST_LOOK || step % APART != 0) {
            continue;
        }
        kind->state(run, angle, real);
        for (int i = 0; i < im->angles + im->reals; i++) {
            all[i] = (long double)(i < im->angles ? angle[i] : real[i - im->angles]);
        }
        const long_leaves in = {.angle_rad = all,
                                .linear = all + im->angles,
                                .rate = all + im->angles + linears,
                                .input = input,
                                .time_s = (long double)(step * im->step_s)};
        long_list_run(l, &in, result);
        see(t, l, is_float, &seen);
        see_state(im, angle, real, t == im->list[IMAGE_STEP] ? result : NULL, is_float, &seen);
    }
    kind->stop(run);
    long_list_free(l);
    return seen;
}

/* How much of what was seen is neither never nor always. */
static int expect(const operands *want, const operands *have, const tape *t, const char *what) {
    int sometimes = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(want->is_float, have->is_float, what);
    for (int i = 0; i < t->count; i++) {
        const operand_share *w = &want->of[i];
        const operand_share *h = &have->of[i];
        TEST_ASSERT_TRUE_MESSAGE(is_near(h->zero, w->zero), what);
        TEST_ASSERT_TRUE_MESSAGE(is_near(h->opposed, w->opposed), what);
        TEST_ASSERT_TRUE_MESSAGE(is_near(h->bits, w->bits), what);
        sometimes += w->zero > 0.01 && w->zero < 0.99;
        sometimes += w->opposed > 0.01 && w->opposed < 0.99;
    }
    for (int i = 0; i < MOST; i++) {
        TEST_ASSERT_TRUE_MESSAGE(is_near(have->rate[i], want->rate[i]), what);
        TEST_ASSERT_TRUE_MESSAGE(is_near(have->accel[i], want->accel[i]), what);
        TEST_ASSERT_TRUE_MESSAGE(is_near(have->still[i], want->still[i]), what);
        TEST_ASSERT_TRUE_MESSAGE(is_near(have->at_zero[i], want->at_zero[i]), what);
        TEST_ASSERT_TRUE_MESSAGE(is_near(have->real[i], want->real[i]), what);
        sometimes += want->accel[i] > 0.01 && want->accel[i] < 0.99;
    }
    return sometimes;
}

/* The last is linear. Forces that begin while it is looked at, at places that are drawn; sums of all signs and sizes; what always rests, at zero
 * and elsewhere; an angle that is never moved and one that is; a loss that is nothing at first. */
static const char *const forms[] = {
    "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\ncoordinate y [m]\n"
    "input u = %.3f [N]\n"
    "T = 1 [kg*m^2]*(a'^2 + b'^2)/2 + 1 [kg]*(x'^2 + y'^2)/2\n"
    "V = 3 [J]*cos(a) + 1 [N/m]*max(x - %.4f [m], 0 [m])^2 + 2 [N/m]*(x - 0.3 [m])^2\nQ(y) = u\n"
    "F = 0.7 [N*s/m]*(x' - y')^2/2\n"
    "scene s { start a = %.3f [rad], x' = 1 [m/s]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\nstate w\nstate y\nstate z\n"
    "equation y' + %.3f [1/s]*max(z - %.4f, 0) = 0 [1/s]\nequation z' = 1 [1/s]\n"
    "equation w' - 3 [1/s]*w*y + 2 [1/s]*z*w - %.3f [1/s]*w = 0 [1/s]\n"
    "scene s { start y = 0.5; step 1 [ms]; until 1 [s] }\n",
    /* a product that float has no number for but zero */
    "mechanism m\nstate w\nstate y\nstate z\n"
    "equation w' = 1 [1/s]*y*z + %.3f [1/s]*w\nequation y' + %.4f [1/s]*y = 0 [1/s]\n"
    "equation z' + %.3f [1/s]*z = 0 [1/s]\n"
    "scene s { start w = 1, y = 1e-25, z = 1e-26; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\n"
    "T = 1 [kg]*(x'^2 + y'^2 + z'^2)/2\n"
    "V = %.3f [N/m]*(x - y)^2/2 + %.4f [N/m]*x^2\nF = %.3f [N*s/m]*y'^2/2\n"
    "scene s { start x = 0.02 [m], y = 0.01 [m]; step 1 [ms]; until 1 [s] }\n"};
enum { FORMS = sizeof forms / sizeof forms[0] };

static void test_what_is_seen_is_what_is_there(void) {
    static const engine_kind *const kinds[] = {&engine_float, &engine_double};
    static const wh_method methods[] = {WH_EULER, WH_RK4, WH_HEUN};
    dice d = dice_of("price_operands", 401);
    int sometimes = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(30, 1000)); n++) {
        char text[900];
        snprintf(text, sizeof text, forms[n % FORMS], dice_between(&d, 1.0, 9.0),
                 dice_between(&d, 0.02, 0.065), dice_between(&d, 0.1, 2.0));
        const char *texts[] = {text};
        priced p;
        priced_open(&p, texts, 1);
        for (int k = 0; k < 2; k++) {
            const bool whole =
                n % FORMS == FORMS - 1 && dice_one_of(&d, 2) == 1; /* step as one matrix */
            setting s = priced_setting(whole ? WH_RK4 : methods[dice_one_of(&d, 3)], kinds[k]);
            s.image.matrix = whole ? MATRIX_EXACT : MATRIX_NONE;
            image *im = priced_image(&p, 0, &s, NULL);
            TEST_ASSERT_NOT_NULL_MESSAGE(im, text);
            const tape *t = im->list[whole ? IMAGE_MATRIX : IMAGE_STEP];
            operands want = looked_at(im, t, kinds[k]);
            operands have = operands_of(im, k == 0 ? COST_FLOAT : COST_DOUBLE);
            sometimes += expect(&want, &have, t, text);
            operands_free(&have);
            free(want.of);
            image_free(im);
        }
        priced_close(&p);
    }
    TEST_ASSERT_TRUE(sometimes > 50);
}

static operands of_text(const char *text, derived *d) {
    *d = derived_scene(text, "s");
    derived_expect(d, text);
    return operands_of(d->image, COST_DOUBLE);
}

/* What rests keeps resting: all that an operation may be given of it is zero, or nothing of the state is. */
static void test_rest_and_motion_have_closed_forms(void) {
    derived d;
    operands o = of_text("mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\n"
                         "T = 1 [kg*m^2]*(a'^2 + b'^2)/2 + 1 [kg]*x'^2/2\nV = 2 [J]*cos(a)\n"
                         "scene s { start b = 1 [rad], b' = 2 [rad/s], x = 3 [m]; step 1 [ms];"
                         " until 1 [s] }\n",
                         &d);
    TEST_ASSERT_TRUE(o.rate[0] == 1.0 && o.rate[1] == 0.0 && o.rate[2] == 1.0);
    TEST_ASSERT_TRUE(o.accel[0] == 1.0 && o.accel[1] == 1.0 && o.accel[2] == 1.0);
    TEST_ASSERT_TRUE(o.still[0] == 1.0 && o.still[1] == 0.0 && o.still[2] == 0.0);
    TEST_ASSERT_TRUE(o.at_zero[0] == 1.0 && o.at_zero[1] == 0.0 && o.at_zero[2] == 0.0);
    TEST_ASSERT_TRUE(o.real[0] == 0.0 && o.real[1] == 1.0 && o.real[2] == 0.0 && o.real[3] == 1.0);
    operands_free(&o);
    derived_free(&d);
}

/* As many angles as there may be, all at rest at zero: so of each of them. */
static void test_all_components_are_looked_at(void) {
    char text[8000] = "mechanism m\n";
    for (int i = 0; i < MOST; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), "coordinate a%d [rad]\n", i);
    }
    strcat(text, "T = 1 [kg*m^2]*(0 [1/s^2]");
    for (int i = 0; i < MOST; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), " + a%d'^2", i);
    }
    strcat(text, ")/2\nscene s { step 1 [ms]; until 1 [s] }\n");
    derived d;
    operands o = of_text(text, &d);
    for (int i = 0; i < MOST; i++) {
        TEST_ASSERT_TRUE(o.rate[i] == 1.0 && is_near(o.accel[i], 1.0) && is_near(o.still[i], 1.0));
        TEST_ASSERT_TRUE(is_near(o.at_zero[i], 1.0) && is_near(o.real[i], 1.0));
    }
    operands_free(&o);
    derived_free(&d);
}

/* With contacts nothing is looked at; and behind a pole nothing more: of the looks before it all are full parts. */
static void test_what_is_not_known_is_not_zero(void) {
    derived d = derived_scene(priced_ball[0], "s");
    derived_expect(&d, priced_ball[0]);
    operands o = operands_of(d.image, COST_FLOAT);
    TEST_ASSERT_TRUE(o.is_float);
    for (int i = 0; i < d.image->list[IMAGE_STEP]->count; i++) {
        TEST_ASSERT_TRUE(o.of[i].zero == 0.0 && o.of[i].bits == 0.0);
    }
    TEST_ASSERT_TRUE(o.rate[0] == 0.0 && o.accel[0] == 0.0 && o.real[0] == 0.0);
    operands_free(&o);
    derived_free(&d);
    static const double ends_s[] = {0.005, 0.015, 0.035, 0.055, 0.2};
    for (size_t i = 0; i < sizeof ends_s / sizeof ends_s[0]; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism m\nstate y\nstate z\nequation y' = 1 [1/s]*y^2\n"
                 "equation z' = 0 [1/s]*y + 1 [1/s]*z\n"
                 "scene s { start y = %.17g, z = 0; step 1 [ms]; until 1 [s] }\n",
                 1.0 / ends_s[i]);
        o = of_text(text, &d);
        const double seen = ends_s[i] > 0.02 ? 1.0 : 0.0;
        TEST_ASSERT_TRUE_MESSAGE(is_near(o.real[1], seen), text);
        TEST_ASSERT_TRUE_MESSAGE(o.real[0] == 0.0 && is_near(o.accel[1], seen), text);
        operands_free(&o);
        derived_free(&d);
    }
}

static void test_all_is_given_back(void) {
    derived d = derived_scene(priced_ball[0], "s");
    derived e = derived_builtin("two_mass_relative");
    derived_expect(&e, "two_mass_relative");
    for (int n = 0; n < 4; n++) {
        const long before = blocks_in_use();
        operands o = operands_of(n % 2 ? d.image : e.image, n < 2 ? COST_FLOAT : COST_DOUBLE);
        operands_free(&o);
        TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
    }
    derived_free(&d);
    derived_free(&e);
}

void suite_price_operands(void) {
    RUN_TEST(test_what_is_seen_is_what_is_there);
    RUN_TEST(test_rest_and_motion_have_closed_forms);
    RUN_TEST(test_all_components_are_looked_at);
    RUN_TEST(test_what_is_not_known_is_not_zero);
    RUN_TEST(test_all_is_given_back);
}
