/* test_price_features.c: what is counted in an image to price its steps (host/price/cost_features.h): of drawn lists
 * and of scenes as boards see them, against counts by hand (counted_by_hand.h); and of methods that everybody knows. What an
 * operation counts as is tests/host/test_price_lists.c's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "counted_by_hand.h"
#include "derived.h"
#include "drawn_list.h"
#include "host/price/cost_row.h"
#include "host/run/start.h"
#include "priced.h"
#include "unity.h"

#include "host/price/cost_rows.h"

void suite_price_features(void);

/* --- drawn lists ---------------------------------------------------------------------------------------*/

/* No more than so many operations that compute. */
static void shorten(drawn_list *l, int operations) {
    while (l->list.count > 4 && tape_operations(&l->list) > operations) {
        l->list.count--;
    }
    for (int k = 0; k < 3; k++) {
        l->result[k] = l->list.count - 1 - k;
    }
}

typedef struct drawn_step {
    drawn_list step, books, observe;
    image im;
} drawn_step;

static void draw_step(dice *d, drawn_step *s) {
    static const int lengths[] = {24, 25, 49, 50, 51, 60, 99, 100, 150, 151, 170};
    drawn_list_draw(d, DRAWN_LIST_MOST, &s->step);
    shorten(&s->step, lengths[dice_one_of(d, sizeof lengths / sizeof lengths[0])]);
    s->step.list.tables.bits = 5;
    drawn_list_draw(d, 60, &s->observe);
    drawn_list_draw(d, DRAWN_LIST_MOST, &s->books);
    const bool kept = dice_one_of(d, 3) == 0;
    const int over = (int)dice_one_of(d, 4) - 1; /* about as long together as compilers take */
    const int rest = 85 + over - length_by_hand(&s->step.list);
    shorten(&s->books, rest > 0 ? rest : 20);
    for (int i = 0; i < s->step.list.count;
         i++) { /* most steps have no sine of radians, and can be turned */
        op *o = &s->step.ops[i];
        o->b = o->code == OP_PHASE && dice_one_of(d, 8) > 0 ? -1 : o->b;
    }
    const bool few = dice_one_of(d, 2) == 0;
    for (int i = 0; i < s->step.list.count && few; i++) { /* much that places alone move */
        op *o = &s->step.ops[i];
        o->b = o->code == OP_PHASE && i > 0 ? (int)dice_one_of(d, (unsigned)i) : o->b;
        if (dice_one_of(d, 8) > 0) {
            o->code = o->code == OP_RATE                        ? OP_LINEAR
                      : o->code == OP_CALL || o->code == OP_POW ? OP_SQRT
                                                                : o->code;
        }
    }
    if (dice_one_of(d, 4) == 0) {
        s->step.list.tables.count = 0;
    }
    const bool second = dice_one_of(d, 3) > 0;
    s->im = (image){.form = second ? WH_SECOND_ORDER : WH_FIRST_ORDER,
                    .angles = DRAWN_LIST_ANGLES - (second ? (int)dice_one_of(d, 2) : 3),
                    .inputs = (int)dice_one_of(d, 4),
                    .ledger = {.kept = kept,
                               .asked = kept && dice_one_of(d, 2) == 1,
                               .entries = (int)dice_one_of(d, 9),
                               .accounts = (int)dice_one_of(d, 5),
                               .inputs = (int)dice_one_of(d, 3)}};
    s->im.coordinates = second ? 3 : 0;
    s->im.reals = second ? 2 * 3 - s->im.angles : 3;
    s->im.list[IMAGE_STEP] = &s->step.list;
    s->im.list[IMAGE_OBSERVE] = dice_one_of(d, 4) > 0 ? &s->observe.list : NULL;
    s->im.list[IMAGE_POWERS] = kept ? &s->books.list : NULL;
    do {
        s->im.settings.method = (wh_method)dice_one_of(d, WH_METHODS);
    } while (!second && wh_methods[s->im.settings.method].takes != WH_ANY_SYSTEM);
    s->im.settings.compensated = dice_one_of(d, 2) == 1;
    s->im.settings.angles = dice_one_of(d, 2) == 1 ? ANGLES_TURNED : ANGLES_LOOKUP;
}

static void test_drawn_steps_are_counted_by_what_they_depend_on(void) {
    static drawn_step s;
    static const char *const boards[] = {"mps2-an386", "host", "rv32imafc"};
    dice d = dice_of("price_features", 411);
    int turned = 0;
    int placed = 0;
    int fixed = 0;
    int shared = 0;
    for (unsigned n = 0; n < dice_cases(few_or_all(250, 20000)); n++) {
        char what[80];
        draw_step(&d, &s);
        const cost_board *b = cost_board_named(boards[dice_one_of(&d, 3)]);
        snprintf(what, sizeof what, "case %u: %s, %d operations", n,
                 wh_methods[s.im.settings.method].word, tape_operations(&s.step.list));
        const long before = blocks_in_use();
        const cost_counts c = cost_counts_of(&s.im, b, COST_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(before, blocks_in_use(), what);
        expect_counts(&s.im, b, COST_FLOAT, &c, NULL, what);
        turned += c.turned;
        placed += c.placed.products;
        fixed += c.fixed.products;
        shared += c.im->ledger.kept && !c.called && !c.books_called;
        int calls = c.step.powers;
        for (int f = 0; f < FUNCTIONS; f++) {
            calls += c.step.calls[f];
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(calls, cost_calls(&c.step), what);
    }
    TEST_ASSERT_TRUE(turned > 20 && placed > 50 && fixed > 50 && shared > 10);
}

/* --- methods that everybody knows ----------------------------------------------------------------------*/

/* As textbooks print them: shares of stages in stages, and of these in how many none, one or minus one of a common part is
 * wanted; how many stages look at others than the first; what stands in the last row, and in that of positions. */
static const struct {
    wh_method method;
    int stages, shares, scaled, leans, ends, turns;
} known[] = {{WH_EULER, 1, 0, 0, 0, 1, 0},
             {WH_SEMI_IMPLICIT_EULER, 1, 0, 0, 0, 1, 0},
             {WH_HEUN, 2, 1, 0, 0, 2, 1},
             {WH_RK4, 4, 3, 0, 2, 6, 2},
             {WH_RK38, 4, 6, 1, 2, 6, 3}};

static void test_known_methods_take_what_is_known(void) {
    static drawn_step s;
    dice d = dice_of("price_features methods", 412);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        do {
            draw_step(&d, &s);
        } while (s.im.form != WH_SECOND_ORDER || s.im.ledger.kept);
        s.im.settings.method = known[i].method;
        const cost_counts c = cost_counts_of(&s.im, cost_board_named("host"), COST_FLOAT);
        const char *word = wh_methods[known[i].method].word;
        TEST_ASSERT_EQUAL_INT_MESSAGE(known[i].stages, c.stages, word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(known[i].shares, c.shares, word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(known[i].scaled, c.scaled, word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(known[i].leans, c.leans, word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(known[i].ends, c.ends, word);
        TEST_ASSERT_EQUAL_INT_MESSAGE(known[i].turns, c.turns, word);
    }
}

/* --- scenes --------------------------------------------------------------------------------------------*/

static const char *const scenes[] = {
    /* from rest, so that much is zero; an input; an output of its own */
    "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\ninput u = 1 [N]\n"
    "output height [m] = 1 [m]*cos(a + b) + x\n"
    "T = 2 [kg]*x'^2/2 + 1 [kg]*((x' + 1 [m]*a'*cos(a))^2 + (1 [m]*a'*sin(a))^2)/2 + 1 "
    "[kg*m^2]*b'^2/2\n"
    "V = -8 [J]*cos(a) + 3 [N/m]*x^2/2\nQ(x) = u\n"
    "scene s { start a = 0 [rad]; step 1 [ms]; until 1 [s] }\n",
    /* an angle that the fixed motion of another does not move, and books */
    "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
    "T = 1 [kg*m^2]*a'^2/2 + 1 [kg]*x'^2/2\nV = -8 [J]*cos(a) + 3 [N/m]*x^2/2\n"
    "F = 0.5 [N*s/m]*x'^2/2\n"
    "scene s { with ledger; start a = 1 [rad], x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\nstate y\nstate z\nequation y' + 4 [1/s]*exp(-y)*z = 1 [1/s]\n"
    "equation z' + 3 [1/s]*y = 1 [1/s]\n"
    "scene s { start y = 3, z = 1; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput u = 2 [N]\n"
    "T = 1 [kg]*(x'^2 + y'^2)/2\nV = 9 [N/m]*(x - y)^2/2\nF = 0.5 [N*s/m]*x'^2/2\nQ(y) = u\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n",
    /* one turn angle, for tables */
    "mechanism m\ncoordinate a [rad]\nT = (1 + 0.3*cos(a))*1 [kg*m^2]*a'^2/2\nV = -8 [J]*cos(a)\n"
    "scene s { start a' = 1 [rad/s]; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
    "V = 1 [kg]*9.81 [m/s^2]*x + 2 [N/m]*(x - y)^2/2\n"
    "stop x >= 0 [m] restitution 0.5\nstop y <= 2 [m] restitution 0.25\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

/* Where numbers are software, what a step does beside its lists, and a pair that is looked up at an angle of zero. */
static void expect_moves(const image *im, const cost_board *b, const cost_counts *c,
                         const operands *given, const char *what) {
    const bool avr = strcmp(b->core, "AVR") == 0;
    const step_work w = step_work_of(im, c->turned, avr, c->tabled, given);
    double zero_pairs = 0.0;
    const tape *t = im->list[IMAGE_STEP];
    for (int i = 0; i < t->count && !c->turned; i++) {
        if (t->ops[i].code == OP_PHASE && t->ops[i].b == -1) {
            cost_list one = {.sums = 0};
            cost_list_add_pair(t, &t->ops[i], given, &one);
            zero_pairs += one.zero_pairs * c->stages;
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(c->moves.sums == w.sums && c->moves.products == w.products, what);
    TEST_ASSERT_TRUE_MESSAGE(c->moves.conversions == w.conversions, what);
    TEST_ASSERT_TRUE_MESSAGE(
        fabs(c->moves.zero_conversions - w.zero_conversions - zero_pairs) < 1e-9, what);
    TEST_ASSERT_TRUE_MESSAGE(
        fabs(c->moves.zero_products - w.zero_products - 8.0 * zero_pairs) < 1e-9, what);
    TEST_ASSERT_TRUE_MESSAGE(fabs(c->moves.zero_sums - w.zero_sums - 5.0 * zero_pairs) < 1e-9,
                             what);
}

/* A whole step as one matrix: its list, and where numbers are software, all that it does as of any other list. */
static void expect_matrix(const image *im, cost_number number, const cost_counts *c,
                          const operands *given, const char *what) {
    const tape *t = im->list[IMAGE_MATRIX];
    cost_list want = {.sums = 0};
    cost_list_add_all(t, &want);
    step_work w = {.sums = 0.0};
    if (given != NULL) {
        w = step_work_of_matrix(im, given);
        for (int i = 0; i < t->count; i++) {
            cost_list_add_operands(&t->ops[i], &given->of[i], &want);
            const double zero = given->of[i].zero;
            const bool sum = t->ops[i].code == OP_ADD || t->ops[i].code == OP_SUB;
            const bool product = t->ops[i].code == OP_MUL;
            w.sums += sum ? 1.0 - zero : 0.0;
            w.zero_sums += sum ? zero : 0.0;
            w.products += product ? 1.0 - zero : 0.0;
            w.zero_products += product ? zero : 0.0;
        }
    }
    expect_common_counts(im, number, c, what);
    expect_list_counts(&want, &c->matrix, what);
    TEST_ASSERT_TRUE_MESSAGE(c->is_matrix && c->soft == (given != NULL), what);
    TEST_ASSERT_TRUE_MESSAGE(fabs(c->moves.sums - w.sums) < 1e-9, what);
    TEST_ASSERT_TRUE_MESSAGE(fabs(c->moves.products - w.products) < 1e-9, what);
    TEST_ASSERT_TRUE_MESSAGE(fabs(c->moves.zero_sums - w.zero_sums) < 1e-9, what);
    TEST_ASSERT_TRUE_MESSAGE(fabs(c->moves.zero_products - w.zero_products) < 1e-9, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, c->stages, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, c->places, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, c->copies, what);
}

static void check_scene(const image *im, const cost_board *b, cost_number number,
                        const char *what) {
    const bool soft = cost_is_soft(b, number);
    operands given = {.of = NULL};
    if (soft) {
        given = operands_of(im, number);
    }
    const cost_counts c = cost_counts_of(im, b, number);
    const operands *known_of = soft ? &given : NULL;
    if (im->settings.matrix != MATRIX_NONE) {
        expect_matrix(im, number, &c, known_of, what);
    } else {
        expect_counts(im, b, number, &c, known_of, what);
        if (soft) {
            expect_moves(im, b, &c, &given, what);
        }
    }
    operands_free(&given);
}

static void test_scenes_are_counted_as_boards_see_them(void) {
    int seen = 0;
    dice d = dice_of("price_features scenes", 413);
    for (int n = 0; n < SCENES; n++) {
        priced p;
        diags *unsaid = diags_new();
        priced_open(&p, &scenes[n], 1);
        for (int i = 0; i < setting_count(); i++) {
            setting s = setting_at(i);
            s.image.compensated = s.image.matrix == MATRIX_NONE ? s.image.compensated : i % 2 == 1;
            if (setting_is_fixed(&s) || (i + n) % 3 > 0) {
                continue;
            }
            image *im = priced_image(&p, 0, &s, NULL);
            if (im != NULL && !start_has_method(im, s.image.method, unsaid)) {
                image_free(im);
                im = NULL;
            }
            char what[SETTING_TEXT + 40];
            char options[SETTING_TEXT];
            setting_options(&s, true, options);
            for (int k = 0; im != NULL && k < 2; k++) {
                const cost_board *b = &cost_boards[dice_one_of(&d, (unsigned)cost_board_count)];
                snprintf(what, sizeof what, "%d %s %s", n, b->name, options);
                check_scene(im, b, s.number == &engine_float ? COST_FLOAT : COST_DOUBLE, what);
                seen++;
            }
            image_free(im);
        }
        diags_free(unsaid);
        priced_close(&p);
    }
    printf("  %d scenes\n", seen);
    TEST_ASSERT_TRUE(seen > 200);
}

/* --- who takes a feature -------------------------------------------------------------------------------*/

/* Figures are fitted of what a quantity takes, and of nothing else; each has a word of its own. */
static void test_figures_are_of_what_a_quantity_takes(void) {
    int figures = 0;
    for (size_t r = 0; r < sizeof cost_rows / sizeof cost_rows[0]; r++) {
        for (int q = 0; q < COST_QUANTITIES; q++) {
            for (int f = 0; f < COST_FEATURES; f++) {
                const bool taken = (cost_feature_taken[f] >> (unsigned)q & 1U) != 0;
                const double figure = cost_rows[r].fit[q].figure[f];
                TEST_ASSERT_TRUE_MESSAGE(taken || figure == 0.0, cost_feature_words[f]);
                figures += figure > 0.0;
            }
        }
    }
    TEST_ASSERT_TRUE(figures > 1000);
    for (int f = 0; f < COST_FEATURES; f++) {
        TEST_ASSERT_TRUE(cost_feature_taken[f] != 0 && cost_feature_words[f][0] != '\0');
        for (int e = 0; e < f; e++) {
            TEST_ASSERT_TRUE(strcmp(cost_feature_words[e], cost_feature_words[f]) != 0);
        }
    }
}

void suite_price_features(void) {
    RUN_TEST(test_drawn_steps_are_counted_by_what_they_depend_on);
    RUN_TEST(test_known_methods_take_what_is_known);
    RUN_TEST(test_scenes_are_counted_as_boards_see_them);
    RUN_TEST(test_figures_are_of_what_a_quantity_takes);
}
