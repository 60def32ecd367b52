/* test_price_rows.c: prices of images by the rows that are kept (host/price/cost.h, cost_fixed.h), against sums of the rows'
 * figures and the images' features by hand. Drawn rows are test_price_sums.c's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/fixed/fixed_plan.h"
#include "host/image/core_rows.h"
#include "host/price/cost.h"
#include "host/price/cost_fixed.h"
#include "host/price/cost_row.h"
#include "host/run/start.h"
#include "unity.h"

#include "host/price/cost_fixed_rows.h"
#include "host/price/cost_rows.h"

void suite_price_rows(void);

static bool near(double a, double b) { return fabs(a - b) <= 1e-12 * (fabs(a) + fabs(b)); }

/* --- prices as they are kept -----------------------------------------------------------------------------*/

/* One quantity, from the row: its sum, and between what; not known where anything is not. */
static cost_figure by_hand(const cost_fit *fit, const double *feature, cost_basis of) {
    double sum = 0.0;
    bool seen = fit->cases > 0;
    for (int f = 0; f < COST_FEATURES; f++) {
        seen = seen && (fit->figure[f] >= 0.0 || feature[f] == 0.0);
        sum += fit->figure[f] * feature[f];
    }
    const double bound = seen && sum > 0.0 ? cost_bound_at(fit, feature, sum) : 9.0;
    if (!seen || sum <= 0.0 || bound > 4.0) {
        return (cost_figure){0};
    }
    const double most = sum * bound + fit->slack;
    return (cost_figure){COST_PREDICTED, of,        sum, fmax(0.0, (sum - fit->slack) / bound),
                         most,           most / sum};
}

static void expect_figure(const cost_figure *want, const cost_figure *have, const char *what) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(want->basis, have->basis, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(want->of, have->of, what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->value, have->value), what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->least, have->least), what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->most, have->most), what);
    TEST_ASSERT_TRUE_MESSAGE(near(want->bound, have->bound), what);
}

static void expect_cost(const cost *want, const cost *have, const char *what) {
    TEST_ASSERT_TRUE(have->predictable);
    expect_figure(&want->instructions, &have->instructions, what);
    expect_figure(&want->instructions_worst, &have->instructions_worst, what);
    expect_figure(&want->cycles, &have->cycles, what);
    expect_figure(&want->cycles_worst, &have->cycles_worst, what);
    expect_figure(&want->flash_bytes, &have->flash_bytes, what);
    expect_figure(&want->ram_bytes, &have->ram_bytes, what);
    expect_figure(&want->stack_bytes, &have->stack_bytes, what);
}

static cost_figure longest_of(cost_figure f, double spread) {
    f.value *= spread;
    f.most *= spread;
    return f;
}

static cost_figure range_of(const cost_board *b, cost_figure f) {
    return f.basis == COST_NOT_KNOWN ? f : (cost_figure){COST_RANGE,
                                                         COST_PREDICTED,
                                                         0.0,
                                                         f.least * b->cycles_least,
                                                         f.most * b->cycles_most,
                                                         1.0};
}

/* As the instructions of the step are to those of a smooth one. */
static cost_figure events_of(cost_figure cycles, cost_figure step, double smooth) {
    if (step.basis != COST_PREDICTED || !(smooth > 0.0) || cycles.basis == COST_NOT_KNOWN) {
        return (cost_figure){0};
    }
    const double share = step.value / smooth;
    cycles.value *= share;
    cycles.least *= share / step.bound;
    cycles.most *= share * step.bound;
    cycles.bound *= cycles.basis == COST_PREDICTED ? step.bound : 1.0;
    return cycles;
}

static const char *const scenes[] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\ninput u = 1 [N]\n"
    "T = 2 [kg]*x'^2/2 + 1 [kg]*((x' + 1 [m]*a'*cos(a))^2 + (1 [m]*a'*sin(a))^2)/2\n"
    "V = -8 [J]*cos(a) + 3 [N/m]*x^2/2\nQ(x) = u\n"
    "scene s { start a = 1 [rad]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s], a' = -20 .. 20 [rad/s], u = -2 .. 2 [N] }\n",
    "mechanism m\nstate y\nequation y' + 4 [1/s]*y + 1 [1/s]*y^3 = 1 [1/s]\n"
    "scene s { start y = 3; step 1 [ms]; until 1 [s]\nrange y = -4 .. 4 }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [kg]*9.81 [m/s^2]*x\n"
    "stop x >= 0 [m] restitution 0.5\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

static const cost_row *row_named(const char *board, cost_number number) {
    const cost_row *found = NULL;
    for (size_t i = 0; i < sizeof cost_rows / sizeof cost_rows[0]; i++) {
        if (cost_rows[i].number == number && strcmp(cost_rows[i].board, board) == 0) {
            found = &cost_rows[i];
        }
    }
    return found;
}

static int check_price(const image *im, const cost_board *b, cost_number number) {
    const cost c = cost_of(im, b, number);
    const cost_row *row = row_named(b->name, number);
    const bool contacts = im->contacts > 0;
    const double real = number == COST_DOUBLE ? 8.0 : 4.0;
    TEST_ASSERT_EQUAL_INT(contacts ? COST_NOT_KNOWN : COST_EXACT, c.state_bytes.basis);
    TEST_ASSERT_TRUE(contacts ||
                     c.state_bytes.value == 8.0 * im->angles + real * core_memory_reals(im));
    char word[40];
    snprintf(word, sizeof word, " %s ", wh_methods[im->settings.method].word);
    if (row == NULL || strstr(row->methods, word) == NULL) {
        TEST_ASSERT_TRUE(!c.predictable && c.why[0] != '\0');
        TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, c.instructions.basis);
        return 0;
    }
    double feature[COST_FEATURES];
    cost_counts counts = cost_counts_of(im, b, number);
    counts.smooth = 1.0;
    cost_features(&counts, feature);
    cost want = {.predictable = true};
    want.instructions = by_hand(&row->fit[COST_OF_INSTRUCTIONS], feature, COST_MEASURED);
    want.instructions_worst = longest_of(want.instructions, row->spread);
    want.cycles = b->cycles == COST_RANGE ? range_of(b, want.instructions)
                                          : by_hand(&row->fit[COST_OF_CYCLES], feature, b->cycles);
    want.cycles_worst = b->cycles == COST_RANGE ? range_of(b, want.instructions_worst)
                                                : longest_of(want.cycles, row->spread_cycles);
    want.flash_bytes = by_hand(&row->fit[COST_OF_FLASH], feature, COST_MEASURED);
    want.ram_bytes = by_hand(&row->fit[COST_OF_RAM], feature, COST_MEASURED);
    want.stack_bytes = by_hand(&row->fit[COST_OF_STACK], feature, COST_MEASURED);
    if (contacts) {
        const double smooth = want.instructions.value;
        counts.smooth = smooth;
        cost_features(&counts, feature);
        want.instructions = by_hand(&row->fit[COST_OF_CONTACT_MEAN], feature, COST_MEASURED);
        want.instructions_worst = by_hand(&row->fit[COST_OF_CONTACT_WORST], feature, COST_MEASURED);
        want.cycles_worst = events_of(want.cycles, want.instructions_worst, smooth);
        want.cycles = events_of(want.cycles, want.instructions, smooth);
        want.flash_bytes = want.ram_bytes = want.stack_bytes = (cost_figure){0};
        TEST_ASSERT_NOT_NULL(strstr(c.why, "with contacts must be measured"));
    }
    expect_cost(&want, &c, b->name);
    return c.instructions.basis == COST_PREDICTED;
}

static void test_prices_are_those_sums(void) {
    int known = 0;
    int refused = 0;
    for (int n = 0; n < SCENES; n++) {
        derived d = derived_scene(scenes[n], "s");
        derived_expect(&d, scenes[n]);
        diags *unsaid = diags_new();
        for (int b = 0; b < cost_board_count; b++) {
            for (int m = 0; m < WH_METHODS; m++) {
                d.image->settings.method = (wh_method)m;
                if (start_has_method(d.image, (wh_method)m, unsaid)) {
                    known += check_price(d.image, &cost_boards[b], COST_FLOAT);
                    known += check_price(d.image, &cost_boards[b], COST_DOUBLE);
                } else { /* whatever is asked of it */
                    const cost c = cost_of(d.image, &cost_boards[b], (cost_number)(m % 2));
                    TEST_ASSERT_EQUAL_STRING("the scene does not take this method", c.why);
                    TEST_ASSERT_FALSE(c.predictable);
                    TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, c.instructions.basis);
                    refused++;
                }
            }
        }
        diags_free(unsaid);
        const cost none = cost_of(d.image, &cost_boards[0], COST_FIXED);
        TEST_ASSERT_TRUE(!none.predictable && none.why[0] != '\0');
        derived_free(&d);
    }
    printf("  %d prices\n", known);
    TEST_ASSERT_TRUE(known > 200 && refused > 20);
}

/* --- fixed point -----------------------------------------------------------------------------------------*/

static cost_figure fixed_by_hand(const cost_fixed_fit *fit, cost_quantity q, const double *feature,
                                 cost_basis of) {
    double sum = 0.0;
    bool seen = fit->cases > 0;
    for (int f = 0; f < COST_FIXED_FEATURES; f++) {
        if ((cost_fixed_taken[f] & 1U << q) != 0) {
            seen = seen && (fit->figure[f] >= 0.0 || feature[f] == 0.0);
            sum += fit->figure[f] * feature[f];
        }
    }
    if (!seen || sum <= 0.0) {
        return (cost_figure){0};
    }
    const double bound = sum > fit->largest ? fit->bound + fit->bound - 1.0 : fit->bound;
    return (cost_figure){COST_PREDICTED, of, sum, sum / bound, sum * bound, bound};
}

static void check_fixed(const image *im, const cost_board *b) {
    const cost c = cost_fixed_of(im, b);
    const cost_fixed_row *row = NULL;
    for (size_t i = 0; i < sizeof cost_fixed_rows / sizeof cost_fixed_rows[0]; i++) {
        row = strcmp(cost_fixed_rows[i].board, b->name) == 0 ? &cost_fixed_rows[i] : row;
    }
    TEST_ASSERT_EQUAL_INT(COST_EXACT, c.state_bytes.basis);
    if (row == NULL) {
        TEST_ASSERT_TRUE(!c.predictable && c.why[0] != '\0');
        return;
    }
    double feature[COST_FIXED_FEATURES];
    cost_fixed_features(im, feature);
    cost want = {.predictable = true};
    want.instructions = fixed_by_hand(&row->fit[COST_OF_INSTRUCTIONS], COST_OF_INSTRUCTIONS,
                                      feature, COST_MEASURED);
    want.instructions_worst = longest_of(want.instructions, row->spread);
    const bool range = b->cycles == COST_RANGE;
    want.cycles =
        range ? range_of(b, want.instructions)
              : fixed_by_hand(&row->fit[COST_OF_CYCLES], COST_OF_CYCLES, feature, b->cycles);
    want.cycles_worst =
        range ? range_of(b, want.instructions_worst) : longest_of(want.cycles, row->spread_cycles);
    want.flash_bytes =
        fixed_by_hand(&row->fit[COST_OF_FLASH], COST_OF_FLASH, feature, COST_MEASURED);
    want.ram_bytes = fixed_by_hand(&row->fit[COST_OF_RAM], COST_OF_RAM, feature, COST_MEASURED);
    want.stack_bytes =
        fixed_by_hand(&row->fit[COST_OF_STACK], COST_OF_STACK, feature, COST_MEASURED);
    expect_cost(&want, &c, b->name);
}

/* Shifts as they are taken: to the right, to the left, and their bits beyond whole bytes. */
typedef struct shifts {
    int right, left, bits, constants;
} shifts;

static void add_shift(const fixed_list *l, fixed_operand from, int sign, shifts *s) {
    if (l->op[from.op].code == FIXED_CONSTANT) {
        s->constants += sign > 0;
        return;
    }
    s->right += sign * from.shift > 0;
    s->left += sign * from.shift < 0;
    s->bits += abs(from.shift) % 8;
}

/* What the list holds, by walking it. */
static void check_fixed_counts(const image *im) {
    const fixed_list *l = ((const fixed_plan *)im->fixed)->list;
    double feature[COST_FIXED_FEATURES];
    cost_fixed_features(im, feature);
    int of[FIXED_MOST + 1] = {0};
    shifts s = {0, 0, 0, 0};
    int by_constant = 0;
    int by_short = 0;
    int leaves = 0;
    int all = 0;
    int searched = 0;
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        if (!o->used) {
            continue;
        }
        of[o->code]++;
        all += o->code != FIXED_CONSTANT;
        leaves += o->code == FIXED_LINEAR || o->code == FIXED_RATE || o->code == FIXED_INPUT;
        searched += o->code == FIXED_QUOTIENT && o->spread > 1;
        if (o->code == FIXED_SUM || o->code == FIXED_DIFFERENCE || o->code >= FIXED_SAME) {
            add_shift(l, o->a, 1, &s);
        }
        if (o->code == FIXED_SUM || o->code == FIXED_DIFFERENCE || o->code >= FIXED_LEAST) {
            add_shift(l, o->b, 1, &s);
        }
        if (o->code == FIXED_PRODUCT) {
            s.bits += o->by % 8;
            bool is = false;
            bool half = false;
            const fixed_operand *const factors[] = {&o->a, &o->b};
            for (int k = 0; k < 2; k++) {
                const fixed_operand *f = factors[k];
                if (l->op[f->op].code == FIXED_CONSTANT) {
                    is = true;
                    half = half || ((uint64_t)(uint32_t)f->number << f->shift) % 65536 == 0;
                }
                add_shift(l, *f, -1, &s);
            }
            by_constant += is;
            by_short += half;
        }
    }
    const int sums = of[FIXED_SUM] + of[FIXED_DIFFERENCE];
    TEST_ASSERT_TRUE(feature[COST_X_ONE] == 1.0 && feature[COST_X_SUMS] == sums);
    TEST_ASSERT_TRUE(feature[COST_X_PRODUCTS] == of[FIXED_PRODUCT] - by_constant);
    TEST_ASSERT_TRUE(feature[COST_X_BY_CONSTANT] == by_constant - by_short);
    TEST_ASSERT_TRUE(feature[COST_X_BY_SHORT] == by_short);
    TEST_ASSERT_TRUE(feature[COST_X_QUOTIENTS] == of[FIXED_QUOTIENT]);
    TEST_ASSERT_TRUE(feature[COST_X_SEARCHED] == searched);
    TEST_ASSERT_TRUE(feature[COST_X_ROUNDED] == s.right && feature[COST_X_SCALED] == s.left);
    TEST_ASSERT_TRUE(feature[COST_X_BITS] == s.bits);
    TEST_ASSERT_TRUE(feature[COST_X_CONSTANTS] == s.constants);
    TEST_ASSERT_TRUE(feature[COST_X_SAME] == of[FIXED_SAME]);
    TEST_ASSERT_TRUE(feature[COST_X_CHOICES] ==
                     of[FIXED_ABS] + of[FIXED_SIGN] + of[FIXED_LEAST] + of[FIXED_MOST]);
    TEST_ASSERT_TRUE(feature[COST_X_LEAVES] == leaves);
    TEST_ASSERT_TRUE(feature[COST_X_WAVE_ALONE] == (of[FIXED_PHASE] == 1));
    TEST_ASSERT_TRUE(feature[COST_X_WAVES] == (of[FIXED_PHASE] > 1 ? of[FIXED_PHASE] : 0));
    const int operations = all - of[FIXED_SINE] - of[FIXED_COSINE];
    TEST_ASSERT_TRUE(feature[COST_X_LIES_OPERATIONS] == all ||
                     feature[COST_X_LIES_OPERATIONS] == operations);
    TEST_ASSERT_TRUE(feature[COST_X_CALLED] == (feature[COST_X_LIES_OPERATIONS] > 80));
    TEST_ASSERT_TRUE(feature[COST_X_NUMBERS] == im->reals + im->inputs);
    const bool second = im->form == WH_SECOND_ORDER;
    const int components = second ? im->coordinates : im->angles + im->reals;
    TEST_ASSERT_TRUE(feature[COST_X_LIES_COMPONENTS] == components);
    TEST_ASSERT_TRUE(feature[COST_X_ANGLES] + feature[COST_X_STILL_ANGLES] ==
                     (second ? im->angles : 0));
    TEST_ASSERT_TRUE(feature[COST_X_PLACES] + feature[COST_X_STILL_PLACES] ==
                     (second ? im->coordinates - im->angles : 0));
    TEST_ASSERT_TRUE(feature[COST_X_FIRSTS] == (second ? 0 : im->reals));
}

static void test_prices_in_fixed_point_are_those_sums(void) {
    for (int n = 0; n < SCENES - 1; n++) {
        derived d = derived_scene(scenes[n], "s");
        derived_expect(&d, scenes[n]);
        const cost none = cost_fixed_of(d.image, &cost_boards[0]);
        TEST_ASSERT_TRUE(!none.predictable && none.why[0] != '\0');
        TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, none.state_bytes.basis);
        diags *errors = diags_new();
        fixed_plan *plan = fixed_plan_make(d.image, errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(plan, scenes[n]);
        d.image->fixed = plan;
        check_fixed_counts(d.image);
        for (int b = 0; b < cost_board_count; b++) {
            check_fixed(d.image, &cost_boards[b]);
        }
        d.image->fixed = NULL;
        fixed_plan_free(plan);
        diags_free(errors);
        derived_free(&d);
    }
}

void suite_price_rows(void) {
    RUN_TEST(test_prices_are_those_sums);
    RUN_TEST(test_prices_in_fixed_point_are_those_sums);
}
