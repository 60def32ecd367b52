/* test_price_lists.c: what lists of operations hold and are given (host/price/cost_list.h, operands.h, step_work.h), of
 * drawn lists, and of steps whose arithmetic follows from their method's row. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "compiled_flights.h"
#include "core/method.h"
#include "derived.h"
#include "drawn_list.h"
#include "host/price/cost_list.h"
#include "host/price/step_work.h"
#include "unity.h"

void suite_price_lists(void);

/* --- drawn lists -----------------------------------------------------------------------------------------*/

enum { ANGLES = DRAWN_LIST_ANGLES, OPS_MOST = 60 };

/* Angles beyond the first, an offset, and multiples of any other number than one. */
static int terms_of(const op *o) {
    int angles = 0;
    int others = 0;
    for (int k = 0; o->turns != NULL && k < ANGLES; k++) {
        angles += o->turns[k] != 0;
        others += o->turns[k] == -1 || o->turns[k] > 1;
    }
    return others + (angles == 0 ? 0 : angles - 1) + (o->value == 0.0 ? 0 : 1);
}

static void test_all_operations_are_counted_once(void) {
    dice d = dice_of("price_lists", 61);
    for (unsigned n = 0; n < dice_cases(few_or_all(300, 10000)); n++) {
        drawn_list l;
        drawn_list_draw(&d, OPS_MOST, &l);
        int of[OPS] = {0};
        int calls[FUNCTIONS] = {0};
        int pairs = 0;
        int terms = 0;
        int mirrored = 0;
        for (int i = 0; i < l.list.count; i++) {
            const op *o = &l.ops[i];
            of[o->code]++;
            calls[o->function] += o->code == OP_CALL;
            pairs += o->code == OP_PHASE && o->b == -1;
            terms += o->code == OP_PHASE ? terms_of(o) : 0;
            mirrored += op_rows[o->code].kind == OP_IS_LOOKUP && l.list.tables.folds &&
                        l.odd[(int)(o->value / 2.0)];
        }
        cost_list c = {.sums = 0};
        cost_list_add_all(&l.list, &c);
        for (int twice = 1; twice <= 2; twice++) {
            TEST_ASSERT_EQUAL_INT(twice * of[OP_CONSTANT], c.constants);
            TEST_ASSERT_EQUAL_INT(twice *
                                      (of[OP_LINEAR] + of[OP_RATE] + of[OP_INPUT] + of[OP_ACCEL] +
                                       of[OP_TIME] + of[OP_RADIANS] + of[OP_NOISE]),
                                  c.leaves);
            TEST_ASSERT_EQUAL_INT(twice * pairs, c.pairs);
            TEST_ASSERT_EQUAL_INT(twice * (of[OP_PHASE] - pairs), c.radians);
            TEST_ASSERT_EQUAL_INT(twice * terms, c.terms);
            TEST_ASSERT_EQUAL_INT(twice * (of[OP_ADD] + of[OP_SUB]), c.sums);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_MUL], c.products);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_DIV], c.quotients);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_SQRT], c.roots);
            TEST_ASSERT_EQUAL_INT(twice * (of[OP_NEG] + of[OP_ABS]), c.sizes);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_SIGN], c.signs);
            TEST_ASSERT_EQUAL_INT(twice * (of[OP_MIN] + of[OP_MAX]), c.choices);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_POW], c.powers);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_CELL], c.cells);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_LINE], c.lines);
            TEST_ASSERT_EQUAL_INT(twice * of[OP_CUBIC], c.cubics);
            TEST_ASSERT_EQUAL_INT(twice * mirrored, c.mirrored);
            for (int f = 0; f < FUNCTIONS; f++) {
                TEST_ASSERT_EQUAL_INT(twice * calls[f], c.calls[f]);
            }
            TEST_ASSERT_EQUAL_INT(twice * 3, c.results);
            TEST_ASSERT_EQUAL_INT(twice * tape_carried(&l.list), c.carried);
            TEST_ASSERT_EQUAL_INT(twice * tape_operations(&l.list), c.operations);
            cost_list_add_all(twice == 1 ? &l.list : NULL, &c); /* added up */
        }
        cost_list_add_all(NULL, &c);
    }
}

static void test_what_operations_are_given_is_added_up(void) {
    dice d = dice_of("price_lists given", 62);
    for (unsigned n = 0; n < dice_cases(few_or_all(300, 10000)); n++) {
        drawn_list l;
        drawn_list_draw(&d, OPS_MOST, &l);
        cost_list c = {.sums = 0};
        operands given = {.is_float = true};
        double products = 0.0;
        double sums = 0.0;
        double opposed = 0.0;
        double bits = 0.0;
        double still = 0.0;
        double zero = 0.0;
        for (int k = 0; k < ANGLES; k++) {
            given.still[k] = dice_between(&d, 0.0, 1.0);
            given.at_zero[k] = dice_between(&d, 0.0, 1.0);
        }
        for (int i = 0; i < l.list.count; i++) {
            const op *o = &l.ops[i];
            const operand_share s = {dice_between(&d, 0, 1), dice_between(&d, 0, 1),
                                     dice_between(&d, 0, 9)};
            cost_list_add_operands(o, &s, &c);
            products += o->code == OP_MUL ? s.zero : 0.0;
            sums += o->code != OP_MUL ? s.zero : 0.0;
            opposed += o->code != OP_MUL ? s.opposed : 0.0;
            bits += o->code != OP_MUL ? s.bits : 0.0;
            if (o->code != OP_PHASE) {
                continue;
            }
            cost_list_add_pair(&l.list, o, &given, &c);
            double least_still = 1.0;
            double least_zero = o->value != 0.0 ? 0.0 : 1.0;
            for (int k = 0; k < ANGLES && o->turns != NULL; k++) {
                least_still = o->turns[k] ? fmin(least_still, given.still[k]) : least_still;
                least_zero = o->turns[k] ? fmin(least_zero, given.at_zero[k]) : least_zero;
            }
            still += least_still;
            zero += least_zero;
        }
        TEST_ASSERT_TRUE(fabs(c.zero_products - products) < 1e-9);
        TEST_ASSERT_TRUE(fabs(c.zero_sums - sums) < 1e-9 && fabs(c.opposed - opposed) < 1e-9);
        TEST_ASSERT_TRUE(fabs(c.bits - bits) < 1e-9 && fabs(c.still_pairs - still) < 1e-9);
        TEST_ASSERT_TRUE(fabs(c.zero_pairs - zero) < 1e-9);
    }
}

/* What each operation is, in words, with what it takes: "x" in front where that is in no word of the other list. */
static void spell(const drawn_list *l, char word[][300], char other[][300], int count, bool turned,
                  int in_other[]) {
    for (int i = 0; i < l->list.count; i++) {
        const op *o = &l->ops[i];
        int operand[2];
        const int values = tape_operands(o, operand);
        int to = snprintf(word[i], 300, "%d,%d,%g(", (int)o->code, (int)o->function, o->value);
        for (int k = 0; k < values; k++) {
            const int from = in_other != NULL ? in_other[operand[k]] : operand[k];
            to += snprintf(word[i] + to, 300 - (size_t)to, "%d ", from);
        }
        for (int k = 0; k < ANGLES && values == 0; k++) {
            to += snprintf(word[i] + to, 300 - (size_t)to, "%d:", o->turns ? o->turns[k] : 0);
        }
        if (values == 0) {
            snprintf(word[i] + to, 300 - (size_t)to, "%d %d", o->a, o->b);
        }
        for (int k = 0; in_other != NULL && k < (in_other[i] = -1, count); k++) {
            const bool pair = o->code == OP_PHASE && o->b < 0;
            if (strcmp(word[i], other[k]) == 0 && !(turned && pair)) {
                in_other[i] = k;
                break;
            }
        }
    }
}

static void test_what_the_step_has_is_not_counted_again(void) {
    static char word[OPS_MOST][300];
    static char other[OPS_MOST][300];
    static drawn_list books;
    static drawn_list step;
    dice d = dice_of("price_lists shared", 63);
    int shared = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(300, 10000)); n++) {
        int same[OPS_MOST];
        const bool turned = dice_one_of(&d, 2) == 1;
        drawn_list_draw(&d, OPS_MOST, &step);
        drawn_list_draw(&d, OPS_MOST, &books);
        /* they begin alike, but for some */
        for (int i = 0; i < books.list.count && i < step.list.count; i++) {
            if (dice_one_of(&d, 10) > 0) {
                books.ops[i] = step.ops[i];
            }
        }
        spell(&step, other, NULL, 0, false, NULL);
        spell(&books, word, other, step.list.count, turned, same);
        cost_list want = {.sums = 0};
        for (int i = 0; i < books.list.count; i++) {
            if (same[i] < 0) {
                cost_list_add(&books.list, &books.ops[i], &want);
            }
            shared += same[i] >= 0;
        }
        cost_list c = {.sums = 0};
        cost_list_add_unshared(&books.list, &step.list, turned, &c);
        want.results = 3;
        want.carried = tape_carried(&books.list);
        want.operations = tape_operations(&books.list);
        TEST_ASSERT_EQUAL_MEMORY(want.calls, c.calls, sizeof c.calls);
        TEST_ASSERT_TRUE(want.sums == c.sums && want.products == c.products);
        TEST_ASSERT_TRUE(want.constants == c.constants && want.leaves == c.leaves);
        TEST_ASSERT_TRUE(want.pairs == c.pairs && want.radians == c.radians);
        TEST_ASSERT_TRUE(want.cells == c.cells && want.choices == c.choices);
        TEST_ASSERT_TRUE(want.results == c.results && want.carried == c.carried);
        TEST_ASSERT_TRUE(want.operations == c.operations && want.terms == c.terms);
    }
    TEST_ASSERT_TRUE(shared > 1000);
}

/* --- a step's own arithmetic -----------------------------------------------------------------------------*/

static const char *const flight =
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\n"
    "T = 1 [kg]*(x'^2 + y'^2 + z'^2)/2\nV = 1 [kg]*9.81 [m/s^2]*z\n"
    "scene s { start x' = 1 [m/s], y' = 2 [m/s], z' = 3 [m/s]; step 1 [ms]; until 1 [s] }\n";
static const char *const pendulum =
    "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\nT = 1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2\n"
    "V = -8 [J]*cos(a) + 3 [N/m]*x^2/2\nF = 1 [N*s/m]*x'^2/2\n"
    "scene s { start a = 1 [rad], x = 1 [m]; step 1 [ms]; until 1 [s] }\n";
static const char *const decay =
    "mechanism m\nstate y\nstate z\nequation y' + 4 [1/s]*y*z = 1 [1/s]\n"
    "equation z' + 3 [1/s]*y = 1 [1/s]\n"
    "scene s { start y = 3, z = 1; step 1 [ms]; until 1 [s] }\n";

/* All accelerations are constants. */
static void test_steps_take_what_a_compiler_makes_of_them(void) {
    derived d = derived_scene(flight, "s");
    derived_expect(&d, flight);
    for (int i = 0; i < COMPILED_FLIGHTS; i++) {
        operands given = {.is_float = true};
        d.image->settings.method = compiled_flights[i].method;
        d.image->settings.compensated = compiled_flights[i].compensated;
        const step_work w = step_work_of(d.image, false, false, false, &given);
        TEST_ASSERT_TRUE(w.products == compiled_flights[i].products);
        TEST_ASSERT_TRUE(w.sums + w.zero_sums == compiled_flights[i].sums);
        TEST_ASSERT_TRUE(w.zero_products == 0.0 && w.conversions == 0.0);
    }
    derived_free(&d);
}

/* Of first order, from the method's row: each share but one and minus one takes a product, or for two a sum, each further
 * one a sum, then a product with h and the sum with where it begins. */
static void test_steps_of_first_order_follow_from_the_row(void) {
    derived d = derived_scene(decay, "s");
    derived_expect(&d, decay);
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_tableau *by = wh_tableau_of((wh_method)m);
        if (wh_methods[m].takes != WH_ANY_SYSTEM) {
            continue;
        }
        for (int tabled = 0; tabled < 2; tabled++) {
            double products = 0.0;
            double sums = 0.0;
            for (unsigned s = 1; s <= by->stages; s++) {
                const wh_real *share = s < by->stages ? by->stage[s].share : by->rates;
                int shares = 0;
                for (unsigned j = 0; j < s; j++) {
                    /* weights that are alike, one behind the other, are put together first */
                    const bool joins = s == by->stages && j + 1 < s && share[j] == share[j + 1];
                    sums += joins ? 1 : 0;
                    if (share[j] != 0 && !joins) {
                        shares++;
                        products += tabled || (fabs((double)share[j]) != 1 && share[j] != 2);
                        sums += !tabled && share[j] == 2;
                    }
                }
                sums += shares > 0 ? shares - 1 : 0;
                products += shares > 0;
                sums += shares > 0;
            }
            operands given = {.is_float = true};
            d.image->settings.method = (wh_method)m;
            const step_work w = step_work_of(d.image, false, true, tabled, &given);
            TEST_ASSERT_TRUE_MESSAGE(w.products == 2.0 * products, wh_methods[m].word);
            TEST_ASSERT_TRUE_MESSAGE(w.sums == 2.0 * sums + 2.0 - 1.0, wh_methods[m].word);
        }
    }
    derived_free(&d);
}

static step_work work_of(const image *im, unsigned how, const operands *given) {
    return step_work_of(im, how & 1U, how & 2U, how & 4U, given);
}

/* Whatever is zero, as much is done; what is always zero is done with zeros alone, but for what is added to a state; and
 * what is zero sometimes, so often. */
static void test_zeros_change_what_arithmetic_is_given_and_not_how_much(void) {
    static const char *const texts[] = {flight, pendulum, decay};
    dice d = dice_of("price_lists zeros", 64);
    for (int n = 0; n < 3; n++) {
        derived e = derived_scene(texts[n], "s");
        derived_expect(&e, texts[n]);
        image *im = e.image;
        const int components = n == 0 ? 3 : 2;
        for (int m = 0; m < WH_METHODS; m++) {
            for (unsigned how = 0; how < 32; how++) {
                if (im->form != WH_SECOND_ORDER && wh_methods[m].takes != WH_ANY_SYSTEM) {
                    continue;
                }
                im->settings.method = (wh_method)m;
                im->settings.compensated = (how & 8U) != 0;
                operands none = {.is_float = (how & 16U) != 0};
                operands all = none;
                operands some = none;
                operands same = none;
                for (int i = 0; i < components; i++) {
                    all.rate[i] = all.accel[i] = 1.0;
                    some.rate[i] = dice_between(&d, 0.0, 1.0);
                    some.accel[i] = dice_between(&d, 0.0, 1.0);
                    same.rate[i] = same.accel[i] = 0.375;
                }
                const step_work w = work_of(im, how, &none);
                const step_work z = work_of(im, how, &all);
                const step_work u = work_of(im, how, &some);
                const step_work v = work_of(im, how, &same);
                const double sums = w.sums + w.zero_sums;
                /* leapfrog's stage stands where no acceleration has moved it yet: that sum has a zero */
                const bool leaps = m == WH_LEAPFROG;
                TEST_ASSERT_TRUE(w.zero_products == 0 && w.zero_conversions == 0);
                TEST_ASSERT_TRUE(w.zero_sums <= (leaps ? components : 0));
                TEST_ASSERT_TRUE(z.products == 0 && z.conversions == 0);
                TEST_ASSERT_TRUE(z.zero_products == w.products);
                TEST_ASSERT_TRUE(z.zero_conversions == w.conversions);
                /* checks that no component is absurd: angles are not, and the first is free */
                const double checks = n == 0 ? 5.0 : n == 1 ? 2.0 : 1.0;
                TEST_ASSERT_TRUE(z.sums == checks && z.zero_sums == sums - checks);
                TEST_ASSERT_TRUE(fabs(u.sums + u.zero_sums - sums) < 1e-9);
                TEST_ASSERT_TRUE(fabs(u.products + u.zero_products - w.products) < 1e-9);
                TEST_ASSERT_TRUE(fabs(u.conversions + u.zero_conversions - w.conversions) < 1e-9);
                TEST_ASSERT_TRUE(leaps || fabs(v.zero_sums - 0.375 * z.zero_sums) < 1e-9);
                TEST_ASSERT_TRUE(fabs(v.zero_products - 0.375 * z.zero_products) < 1e-9);
                TEST_ASSERT_TRUE(fabs(v.zero_conversions - 0.375 * z.zero_conversions) < 1e-9);
                TEST_ASSERT_EQUAL_INT(n == 1, w.conversions > 0);
            }
        }
        derived_free(&e);
    }
}

/* An angle is moved by a whole number of units: converted once a place and once at the end, with sums that carry what is
 * rounded three times more. Only where the list reads it and it is not turned on is it placed. */
static void test_angles_are_converted_once_a_place(void) {
    derived d = derived_scene(pendulum, "s");
    derived_expect(&d, pendulum);
    for (int m = 0; m < WH_METHODS; m++) {
        const wh_tableau *by = wh_tableau_of((wh_method)m);
        for (int how = 0; how < 8; how++) {
            const bool turned = (how & 1) != 0;
            const bool carries = (how & 2) != 0 && (how & 4) != 0;
            int places = 0;
            for (unsigned s = 0; s < by->stages && !turned; s++) {
                bool again = false; /* does it stand where an earlier one does? */
                for (unsigned e = 0; e < s && by->places != NULL; e++) {
                    again = again || (by->places->node[e] == by->places->node[s] &&
                                      memcmp(&by->places->reach[e], &by->places->reach[s],
                                             sizeof by->places->reach[s]) == 0);
                }
                const bool away = s > 0 || (by->places != NULL && by->places->node[0] != 0);
                places += away && !again;
            }
            d.image->settings.method = (wh_method)m;
            d.image->settings.compensated = (how & 2) != 0;
            operands given = {.is_float = (how & 4) != 0};
            const step_work w = step_work_of(d.image, turned, true, false, &given);
            TEST_ASSERT_TRUE_MESSAGE(w.conversions == places + 1 + (carries ? 3 : 0),
                                     wh_methods[m].word);
        }
    }
    derived_free(&d);
}

/* Of a step as one matrix: a product for each angle that is moved, and what carries its rounding; eight sums or
 * nine for each real that is carried; and the sizes of all reals added up to be checked. */
static void test_matrices_take_what_moves_and_is_carried(void) {
    derived d = derived_scene(pendulum, "s");
    derived_expect(&d, pendulum);
    image *im = d.image;
    const int angles = im->angles;
    TEST_ASSERT_TRUE(angles == 1 && im->reals == 3);
    for (int how = 0; how < 8; how++) {
        im->angles = (how & 1) != 0 ? 1 : 0;
        im->settings.compensated = (how & 2) != 0;
        operands given = {.is_float = (how & 4) != 0, .real = {0.0, 1.0, 0.25}};
        const bool carries = im->settings.compensated;
        const double each = given.is_float ? 9.0 : 8.0;
        const bool carries_angle = carries && given.is_float && im->angles > 0;
        const step_work w = step_work_of_matrix(im, &given);
        const double checks = im->angles == 0 && !carries && given.is_float ? 0.0 : 3.0;
        TEST_ASSERT_TRUE(w.products == im->angles + (carries_angle ? 1 : 0));
        TEST_ASSERT_TRUE(w.conversions == im->angles + (carries_angle ? 3 : 0));
        TEST_ASSERT_TRUE(w.zero_products == 0.0 && w.zero_conversions == 0.0);
        TEST_ASSERT_TRUE(w.sums ==
                         checks + (carries ? 1.75 * each : 0.0) + (carries_angle ? 4.0 : 0.0));
        TEST_ASSERT_TRUE(w.zero_sums == (carries ? 1.25 * each : 0.0));
    }
    im->angles = angles;
    derived_free(&d);
}

void suite_price_lists(void) {
    RUN_TEST(test_angles_are_converted_once_a_place);
    RUN_TEST(test_matrices_take_what_moves_and_is_carried);
    RUN_TEST(test_all_operations_are_counted_once);
    RUN_TEST(test_what_operations_are_given_is_added_up);
    RUN_TEST(test_what_the_step_has_is_not_counted_again);
    RUN_TEST(test_steps_take_what_a_compiler_makes_of_them);
    RUN_TEST(test_steps_of_first_order_follow_from_the_row);
    RUN_TEST(test_zeros_change_what_arithmetic_is_given_and_not_how_much);
}
