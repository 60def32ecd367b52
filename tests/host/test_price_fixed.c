/* test_price_fixed.c: what is counted in a step in fixed point, and its price (host/price/cost_fixed.h): of drawn lists and of
 * scenes, against another walk over the list, and sums of the rows' figures by hand. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "core/fixed.h"
#include "derived.h"
#include "figures_by_hand.h"
#include "host/fixed/fixed_plan.h"
#include "host/price/cost_fixed.h"
#include "priced.h"
#include "unity.h"

#include "host/price/cost_fixed_rows.h"

void suite_price_fixed(void);

/* --- features ------------------------------------------------------------------------------------------*/

/* Earlier values that an operation of this code takes as numbers: a phase's sine takes none. */
static int taken_by(fixed_code code) {
    static const int values[] = {
        [FIXED_CONSTANT] = 0,   [FIXED_LINEAR] = 0,  [FIXED_RATE] = 0,     [FIXED_INPUT] = 0,
        [FIXED_PHASE] = 0,      [FIXED_SINE] = 0,    [FIXED_COSINE] = 0,   [FIXED_SUM] = 2,
        [FIXED_DIFFERENCE] = 2, [FIXED_PRODUCT] = 2, [FIXED_QUOTIENT] = 2, [FIXED_SAME] = 1,
        [FIXED_ABS] = 1,        [FIXED_SIGN] = 1,    [FIXED_LEAST] = 2,    [FIXED_MOST] = 2};
    return values[code];
}

static bool is_constant(const fixed_list *l, int i) { return l->op[i].code == FIXED_CONSTANT; }

/* How many operations compute, up to number i and with it. */
static int computed(const fixed_list *l, int i) {
    int count = 0;
    for (int k = 0; k <= i; k++) {
        count += l->op[k].used && !is_constant(l, k);
    }
    return count;
}

/* How often a value waits for more than eight others: from where it is made to where it is wanted, and from there to where
 * it is wanted again. */
static int waits_of(const fixed_list *l) {
    int waits = 0;
    for (int v = 0; v < l->count; v++) {
        int last = computed(l, v);
        for (int i = v + 1; i < l->count && l->op[v].used && !is_constant(l, v); i++) {
            const fixed_op *o = &l->op[i];
            const int values = o->used ? taken_by(o->code) : 0;
            if ((values > 0 && o->a.op == v) || (values > 1 && o->b.op == v)) {
                waits += computed(l, i) > last + 8;
                last = computed(l, i);
            }
        }
    }
    return waits;
}

/* Further angles and multiples of a wave, and an offset. */
static int terms_of(const fixed_list *l, const fixed_op *o) {
    int angles = 0;
    int multiples = 0;
    for (int k = 0; o->turns != NULL && k < l->angles; k++) {
        angles += o->turns[k] == 0 ? 0 : 1;
        multiples += o->turns[k] < 0 || o->turns[k] > 1;
    }
    return multiples + (angles > 1 ? angles - 1 : 0) + (o->offset == 0 ? 0 : 1);
}

/* Shifts as they are taken: to the right, to the left, and their bits beyond whole bytes. */
typedef struct shifts {
    int right, left, bits, constants;
} shifts;

static void add_shift(const fixed_list *l, fixed_operand from, int sign, shifts *s) {
    if (is_constant(l, from.op)) {
        s->constants += sign > 0;
        return;
    }
    s->right += sign * from.shift > 0;
    s->left += sign * from.shift < 0;
    s->bits += abs(from.shift) % 8;
}

/* What the list holds, by codes. */
typedef struct held {
    int of[FIXED_MOST + 1];
    shifts shift;
    int by_constant, by_short, searched, terms, all;
} held;

static void hold_product(const fixed_list *l, const fixed_op *o, held *h) {
    const fixed_operand *const factors[] = {&o->a, &o->b};
    bool is = false;
    bool half = false;
    for (int k = 0; k < 2; k++) {
        const fixed_operand *f = factors[k];
        if (is_constant(l, f->op)) {
            is = true;
            half = half || ((uint64_t)(uint32_t)f->number << f->shift) % 65536 == 0;
        }
        add_shift(l, *f, -1, &h->shift);
    }
    h->shift.bits += o->by % 8;
    h->by_constant += is;
    h->by_short += half;
}

static held held_by(const fixed_list *l) {
    held h = {.all = 0};
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        if (!o->used) {
            continue;
        }
        h.of[o->code]++;
        h.all += o->code != FIXED_CONSTANT;
        h.searched += o->code == FIXED_QUOTIENT && o->spread >= 2;
        h.terms += o->code == FIXED_PHASE ? terms_of(l, o) : 0;
        if (o->code == FIXED_PRODUCT) {
            hold_product(l, o, &h);
        } else if (o->code != FIXED_QUOTIENT) {
            for (int k = 0; k < taken_by(o->code); k++) {
                add_shift(l, k == 0 ? o->a : o->b, 1, &h.shift);
            }
        }
    }
    return h;
}

/* Is a component of this kind wanted by what is used? */
static bool wants(const fixed_list *l, fixed_code code, int which) {
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        if (o->used && o->code == code &&
            (code == FIXED_PHASE ? o->turns != NULL && o->turns[which] != 0 : o->index == which)) {
            return true;
        }
    }
    return false;
}

static void expect_motion(const image *im, const double *feature, const char *what) {
    const fixed_plan *p = im->fixed;
    const fixed_list *l = p->list;
    const bool called = computed(l, l->count - 1) > 80;
    int of[2][2] = {{0, 0}, {0, 0}}; /* [angle][still] */
    int staged[3] = {0, 0, 0};
    for (int i = 0; i < p->coordinates; i++) {
        const bool turns = i < im->angles;
        of[turns][is_constant(l, l->result[i])]++;
        staged[0] += turns && (called || wants(l, FIXED_PHASE, i));
        staged[1] += !turns && (called || wants(l, FIXED_LINEAR, i - im->angles));
        staged[2] += p->second && (called || wants(l, FIXED_RATE, i));
    }
    const double second = p->second ? 1.0 : 0.0;
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_ANGLES] == second * of[1][0], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_PLACES] == second * of[0][0], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_STILL_ANGLES] == second * of[1][1], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_STILL_PLACES] == second * of[0][1], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_FIRSTS] == (1.0 - second) * (of[0][0] + of[0][1]),
                             what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_FIRST_ANGLES] == (1.0 - second) * (of[1][0] + of[1][1]),
                             what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_STAGED_ANGLES] == staged[0], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_STAGED_PLACES] == staged[1], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_STAGED_RATES] == staged[2], what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_LIES_COMPONENTS] == p->coordinates, what);
    TEST_ASSERT_TRUE_MESSAGE(feature[COST_X_LIES_RATES] == second * p->coordinates, what);
}

/* A code's features: once where the list is a function of its own, else at each of four stages. */
static void expect_features(const image *im, const char *what) {
    const fixed_list *l = ((const fixed_plan *)im->fixed)->list;
    double feature[COST_FIXED_FEATURES];
    const long before = blocks_in_use();
    cost_fixed_features(im, feature);
    TEST_ASSERT_EQUAL_INT_MESSAGE(before, blocks_in_use(), what);
    const held h = held_by(l);
    const int *of = h.of;
    const bool called = h.all > 80;
    const int copies = called ? 1 : 4;
    const int sums = of[FIXED_SUM] + of[FIXED_DIFFERENCE];
    const int leaves = of[FIXED_LINEAR] + of[FIXED_RATE] + of[FIXED_INPUT];
    const int choices = of[FIXED_ABS] + of[FIXED_SIGN] + of[FIXED_LEAST] + of[FIXED_MOST];
    const int waves = of[FIXED_PHASE];
    const int waits = waits_of(l);
    const int bytes = (int)WH_FIXED_BYTES(im->angles, im->reals + im->inputs);
    const double want[COST_FIXED_FEATURES] = {
        [COST_X_SUMS] = sums,
        [COST_X_PRODUCTS] = of[FIXED_PRODUCT] - h.by_constant,
        [COST_X_BY_CONSTANT] = h.by_constant - h.by_short,
        [COST_X_BY_SHORT] = h.by_short,
        [COST_X_QUOTIENTS] = of[FIXED_QUOTIENT],
        [COST_X_SEARCHED] = h.searched,
        [COST_X_ROUNDED] = h.shift.right,
        [COST_X_SCALED] = h.shift.left,
        [COST_X_BITS] = h.shift.bits,
        [COST_X_CONSTANTS] = h.shift.constants,
        [COST_X_SAME] = of[FIXED_SAME],
        [COST_X_CHOICES] = choices,
        [COST_X_LEAVES] = leaves,
        [COST_X_WAVE_ALONE] = waves == 1,
        [COST_X_WAVES] = waves == 1 ? 0 : waves,
        [COST_X_TERMS] = h.terms,
        [COST_X_CARRIED] = waits,
        [COST_X_CALLED] = called,
        [COST_X_CALLED_DATA] = called ? leaves + l->results : 0,
        [COST_X_CODE_SUMS] = copies * sums,
        [COST_X_CODE_PRODUCTS] = copies * (of[FIXED_PRODUCT] - h.by_constant),
        [COST_X_CODE_BY_CONSTANT] = copies * (h.by_constant - h.by_short),
        [COST_X_CODE_BY_SHORT] = copies * h.by_short,
        [COST_X_CODE_SHIFTS] = copies * (h.shift.right + h.shift.left),
        [COST_X_CODE_QUOTIENTS] = copies * of[FIXED_QUOTIENT],
        [COST_X_CODE_WAVE_ALONE] = waves == 1 ? copies : 0,
        [COST_X_CODE_WAVES] = waves == 1 ? 0 : copies * waves,
        [COST_X_CODE_OTHERS] = copies * (of[FIXED_SAME] + choices + h.terms),
        [COST_X_CODE_LEAVES] = copies * leaves,
        [COST_X_CODE_CARRIED] = copies * waits,
        [COST_X_ANY_WAVE] = waves >= 1,
        [COST_X_ANY_SHARED_WAVE] = waves >= 2,
        [COST_X_ANY_QUOTIENT] = of[FIXED_QUOTIENT] >= 1,
        [COST_X_NUMBERS] = im->reals + im->inputs,
        [COST_X_STATE_BYTES] = bytes % 8 == 0 ? bytes : bytes + 8 - bytes % 8,
        [COST_X_LIES_WAVES] = waves,
        [COST_X_LIES_OPERATIONS] = h.all,
        [COST_X_ONE] = 1};
    for (int f = 0; f < COST_FIXED_FEATURES; f++) {
        const bool moves = f >= COST_X_ANGLES && f <= COST_X_LIES_RATES; /* by themselves */
        char line[120];
        snprintf(line, sizeof line, "%.60s: %s", what, cost_fixed_words[f]);
        TEST_ASSERT_TRUE_MESSAGE(moves || feature[f] == want[f], line);
    }
    expect_motion(im, feature, what);
}

/* --- prices --------------------------------------------------------------------------------------------*/

/* A sum of what the quantity takes; where a feature is in no fitted scene, nothing, and *missing. */
static cost_figure fixed_by_hand(const cost_fixed_row *row, cost_quantity q, const double *feature,
                                 cost_basis of, bool *missing) {
    const cost_fixed_fit *fit = &row->fit[q];
    double sum = 0.0;
    bool seen = fit->cases > 0;
    for (int f = 0; f < COST_FIXED_FEATURES; f++) {
        if ((cost_fixed_taken[f] & 1U << q) != 0) {
            seen = seen && (fit->figure[f] >= 0.0 || feature[f] == 0.0);
            sum += fit->figure[f] * feature[f];
        }
    }
    TEST_ASSERT_TRUE(cost_fixed_sum(fit, q, feature) == (seen ? sum : -1.0) || fit->cases == 0);
    if (!seen || sum <= 0.0) {
        *missing = true;
        return (cost_figure){0};
    }
    const double bound = sum > fit->largest ? fit->bound + fit->bound - 1.0 : fit->bound;
    return (cost_figure){COST_PREDICTED, of, sum, sum / bound, sum * bound, bound};
}

/* Is something of it not known? */
static bool check_fixed(const image *im, const cost_board *b) {
    const cost c = cost_fixed_of(im, b);
    const cost_fixed_row *row = NULL;
    for (size_t i = 0; i < sizeof cost_fixed_rows / sizeof cost_fixed_rows[0]; i++) {
        row = strcmp(cost_fixed_rows[i].board, b->name) == 0 ? &cost_fixed_rows[i] : row;
    }
    TEST_ASSERT_EQUAL_INT(COST_EXACT, c.state_bytes.basis);
    TEST_ASSERT_TRUE(c.state_bytes.value ==
                     (double)WH_FIXED_BYTES(im->angles, im->reals + im->inputs));
    if (row == NULL) {
        TEST_ASSERT_TRUE(!c.predictable && c.why[0] != '\0');
        return false;
    }
    double feature[COST_FIXED_FEATURES];
    cost_fixed_features(im, feature);
    bool missing = false;
    cost want = {.predictable = true};
    want.instructions = fixed_by_hand(row, COST_OF_INSTRUCTIONS, feature, COST_MEASURED, &missing);
    want.instructions_worst = longest_of(want.instructions, row->spread);
    const bool range = b->cycles == COST_RANGE;
    want.cycles = range ? range_of(b, want.instructions)
                        : fixed_by_hand(row, COST_OF_CYCLES, feature, b->cycles, &missing);
    want.cycles_worst =
        range ? range_of(b, want.instructions_worst) : longest_of(want.cycles, row->spread_cycles);
    want.flash_bytes = fixed_by_hand(row, COST_OF_FLASH, feature, COST_MEASURED, &missing);
    want.ram_bytes = fixed_by_hand(row, COST_OF_RAM, feature, COST_MEASURED, &missing);
    want.stack_bytes = fixed_by_hand(row, COST_OF_STACK, feature, COST_MEASURED, &missing);
    expect_cost(&want, &c, b->name);
    TEST_ASSERT_EQUAL_STRING(missing ? "the scene does something that no measured scene in fixed "
                                       "point did: measure it"
                                     : "",
                             c.why);
    return missing;
}

/* --- scenes --------------------------------------------------------------------------------------------*/

static void test_prices_in_fixed_point_are_those_sums(void) {
    for (int n = 0; n < PRICED_SCENES; n++) {
        derived d = derived_scene(priced_scenes[n], "s");
        derived_expect(&d, priced_scenes[n]);
        const cost none = cost_fixed_of(d.image, &cost_boards[0]);
        TEST_ASSERT_TRUE(!none.predictable && none.why[0] != '\0');
        TEST_ASSERT_EQUAL_INT(COST_NOT_KNOWN, none.state_bytes.basis);
        diags *errors = diags_new();
        fixed_plan *plan = fixed_plan_make(d.image, errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(plan, priced_scenes[n]);
        d.image->fixed = plan;
        expect_features(d.image, priced_scenes[n]);
        for (int b = 0; b < cost_board_count; b++) {
            (void)check_fixed(d.image, &cost_boards[b]);
        }
        d.image->fixed = NULL;
        fixed_plan_free(plan);
        diags_free(errors);
        derived_free(&d);
    }
}

/* --- drawn lists ---------------------------------------------------------------------------------------*/

enum { OPS_MOST = 160, ANGLES = 3, COMPONENTS = 5 };

typedef struct drawn_fixed {
    fixed_op op[OPS_MOST];
    int turns[OPS_MOST][ANGLES];
    int result[COMPONENTS];
    fixed_list list;
    fixed_plan plan;
    image im;
} drawn_fixed;

static fixed_operand draw_operand(dice *d, const drawn_fixed *f, int below) {
    fixed_operand o = {.op = (int)dice_one_of(d, (unsigned)below)};
    o.shift = (int)dice_one_of(d, 24) - 8;
    if (f->op[o.op].code == FIXED_CONSTANT) { /* put in front of what it is multiplied by */
        o.shift = (int)dice_one_of(d, 12);
        o.number = (int32_t)dice_one_of(d, 1U << 18) * (dice_one_of(d, 2) == 1 ? 4096 : 1);
    }
    return o;
}

static void draw_fixed_op(dice *d, drawn_fixed *f, int i, bool waves) {
    fixed_op *o = &f->op[i];
    o->code = i > 0                    ? (fixed_code)dice_one_of(d, FIXED_MOST + 1)
              : dice_one_of(d, 2) == 1 ? FIXED_CONSTANT
                                       : FIXED_INPUT;
    if (o->code == FIXED_PHASE && !waves) {
        o->code = FIXED_SUM;
    }
    o->index = (int)dice_one_of(d, COMPONENTS);
    o->index = o->code == FIXED_LINEAR ? o->index % (COMPONENTS - ANGLES) : o->index;
    o->by = (int)dice_one_of(d, 20);
    o->spread = (int)dice_one_of(d, 4);
    o->offset = dice_one_of(d, 2) == 1 ? 0x40000000U : 0U;
    for (int k = 0; k < ANGLES; k++) {
        f->turns[i][k] = (int)dice_one_of(d, 5) - 1;
    }
    o->turns = dice_one_of(d, 4) > 0 ? f->turns[i] : NULL;
    if (i > 0) {
        o->a = draw_operand(d, f, i);
        o->b = draw_operand(d, f, i);
    }
}

/* What the results take is used. */
static void draw_fixed(dice *d, drawn_fixed *f) {
    *f = (drawn_fixed){.list = {.count = 0}};
    f->list = (fixed_list){.op = f->op,
                           .count = 8 + (int)dice_one_of(d, OPS_MOST - 7),
                           .result = f->result,
                           .results = COMPONENTS,
                           .angles = ANGLES};
    const bool waves = dice_one_of(d, 4) > 0;
    for (int i = 0; i < f->list.count; i++) {
        draw_fixed_op(d, f, i, waves);
    }
    for (int k = 0; k < COMPONENTS; k++) {
        f->result[k] = dice_one_of(d, 4) == 0 ? 0 : f->list.count - 1 - k;
        f->op[f->result[k]].used = true;
    }
    for (int i = f->list.count - 1; i > 0; i--) {
        const fixed_op *o = &f->op[i];
        const bool sine = o->code == FIXED_SINE || o->code == FIXED_COSINE;
        f->op[i].used = f->op[i].used || dice_one_of(d, 6) == 0;
        for (int k = 0; o->used && k < (sine ? 1 : taken_by(o->code)); k++) {
            f->op[k == 0 ? o->a.op : o->b.op].used = true;
        }
    }
    f->plan =
        (fixed_plan){.second = dice_one_of(d, 3) > 0, .coordinates = COMPONENTS, .list = &f->list};
    f->im = (image){.form = f->plan.second ? WH_SECOND_ORDER : WH_FIRST_ORDER,
                    .angles = ANGLES,
                    .coordinates = f->plan.second ? COMPONENTS : 0,
                    .reals = f->plan.second ? 2 * COMPONENTS - ANGLES : COMPONENTS - ANGLES,
                    .inputs = (int)dice_one_of(d, 4),
                    .fixed = &f->plan};
}

static void test_drawn_lists_are_counted_by_another_walk(void) {
    static drawn_fixed f;
    dice d = dice_of("price_fixed", 421);
    int missing = 0;
    int known = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(300, 20000)); n++) {
        char what[40];
        snprintf(what, sizeof what, "case %u", n);
        draw_fixed(&d, &f);
        expect_features(&f.im, what);
        const bool is = check_fixed(&f.im, &cost_boards[n % (unsigned)cost_board_count]);
        missing += is;
        known += !is;
    }
    TEST_ASSERT_TRUE(missing > 5 && known > 5);
}

/* A figure is of what the quantity takes, and of nothing else. */
static void test_fixed_figures_are_of_what_a_quantity_takes(void) {
    int figures = 0;
    for (size_t r = 0; r < sizeof cost_fixed_rows / sizeof cost_fixed_rows[0]; r++) {
        for (int f = 0; f < COST_FIXED_FEATURES; f++) {
            for (unsigned q = 0; q < COST_QUANTITIES; q++) {
                const double figure = cost_fixed_rows[r].fit[q].figure[f];
                TEST_ASSERT_TRUE_MESSAGE((cost_fixed_taken[f] >> q & 1U) != 0 || figure <= 0.0,
                                         cost_fixed_words[f]);
                figures += figure > 0.0;
            }
        }
    }
    TEST_ASSERT_TRUE(figures > 100);
    for (int f = 0; f < COST_FIXED_FEATURES; f++) {
        for (int e = 0; e < f; e++) {
            TEST_ASSERT_TRUE(strcmp(cost_fixed_words[e], cost_fixed_words[f]) != 0);
        }
    }
}

void suite_price_fixed(void) {
    RUN_TEST(test_drawn_lists_are_counted_by_another_walk);
    RUN_TEST(test_prices_in_fixed_point_are_those_sums);
    RUN_TEST(test_fixed_figures_are_of_what_a_quantity_takes);
}
