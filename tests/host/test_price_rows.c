/* test_price_rows.c: prices of images by the rows that are kept (host/price/cost.h), against sums of the rows' figures and the
 * images' features by hand. Drawn rows are test_price_sums.c's, those of fixed point test_price_fixed.c's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "figures_by_hand.h"
#include "host/image/core_rows.h"
#include "host/price/cost.h"
#include "host/price/cost_row.h"
#include "host/run/start.h"
#include "priced.h"
#include "unity.h"

#include "host/price/cost_rows.h"

void suite_price_rows(void);

/* --- prices as they are kept -----------------------------------------------------------------------------*/

/* Why a figure is not known. */
static const char *const nothing_alike = "nothing like this scene has been measured on this board";
static const char *const something_else =
    "the scene does something that no measured scene did: measure it";
static const char *const depends = "it depends on more than the image tells: measure it";

/* One quantity, from the row: its sum, and between what; not known where anything is not, and then *why. */
static cost_figure by_hand(const cost_row *row, cost_quantity q, const double *feature,
                           cost_basis of, const char **why) {
    const cost_fit *fit = &row->fit[q];
    double sum = 0.0;
    bool seen = fit->cases > 0;
    for (int f = 0; f < COST_FEATURES; f++) {
        seen = seen && (fit->figure[f] >= 0.0 || feature[f] == 0.0);
        sum += fit->figure[f] * feature[f];
    }
    const double bound = seen && sum > 0.0 ? cost_bound_at(fit, feature, sum) : 9.0;
    if (!seen || sum <= 0.0 || bound > 4.0) {
        *why = fit->cases == 0 ? nothing_alike : !seen || sum <= 0.0 ? something_else : depends;
        return (cost_figure){0};
    }
    const double most = sum * bound + fit->slack;
    return (cost_figure){COST_PREDICTED, of,        sum, fmax(0.0, (sum - fit->slack) / bound),
                         most,           most / sum};
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
    /* more of some functions than any that was measured has */
    "mechanism m\nstate y\nstate z\n"
    "equation y' + 4 [1/s]*exp(-y)*atan(y + 2*z)*exp(-2*z)*atan(y - z)*exp(y*z) = 1 [1/s]\n"
    "equation z' + 3 [1/s]*exp(-y*y)*atan(y)*exp(-3*z)*atan(2*y - z)*exp(z*z*y) = 1 [1/s]\n"
    "scene s { start y = 3; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\nstate y\nequation y' + 4 [1/s]*log(1 + y*y)*log(2 + y) = 1 [1/s]\n"
    "scene s { start y = 3; step 1 [ms]; until 1 [s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [kg]*9.81 [m/s^2]*x\n"
    "stop x >= 0 [m] restitution 0.5\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s] }\n"};
enum { SCENES = PRICED_SCENES + sizeof scenes / sizeof scenes[0] };
static const char *scene_text(int n) {
    return n < PRICED_SCENES ? priced_scenes[n] : scenes[n - PRICED_SCENES];
}

static const cost_row *row_named(const char *board, cost_number number) {
    const cost_row *found = NULL;
    for (size_t i = 0; i < sizeof cost_rows / sizeof cost_rows[0]; i++) {
        if (cost_rows[i].number == number && strcmp(cost_rows[i].board, board) == 0) {
            found = &cost_rows[i];
        }
    }
    return found;
}

static int reasons[3]; /* how often each of these */

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
    const char *why = "";
    cost want = {.predictable = true};
    want.instructions = by_hand(row, COST_OF_INSTRUCTIONS, feature, COST_MEASURED, &why);
    want.instructions_worst = longest_of(want.instructions, row->spread);
    want.cycles = b->cycles == COST_RANGE ? range_of(b, want.instructions)
                                          : by_hand(row, COST_OF_CYCLES, feature, b->cycles, &why);
    want.cycles_worst = b->cycles == COST_RANGE ? range_of(b, want.instructions_worst)
                                                : longest_of(want.cycles, row->spread_cycles);
    want.flash_bytes = by_hand(row, COST_OF_FLASH, feature, COST_MEASURED, &why);
    want.ram_bytes = by_hand(row, COST_OF_RAM, feature, COST_MEASURED, &why);
    want.stack_bytes = by_hand(row, COST_OF_STACK, feature, COST_MEASURED, &why);
    if (contacts) {
        const double smooth = want.instructions.value;
        counts.smooth = smooth;
        cost_features(&counts, feature);
        want.instructions = by_hand(row, COST_OF_CONTACT_MEAN, feature, COST_MEASURED, &why);
        want.instructions_worst = by_hand(row, COST_OF_CONTACT_WORST, feature, COST_MEASURED, &why);
        want.cycles_worst = events_of(want.cycles, want.instructions_worst, smooth);
        want.cycles = events_of(want.cycles, want.instructions, smooth);
        want.flash_bytes = want.ram_bytes = want.stack_bytes = (cost_figure){0};
        why = "what events take depends on the motion: a scene with contacts must be measured";
    }
    expect_cost(&want, &c, b->name);
    TEST_ASSERT_EQUAL_STRING(why, c.why);
    reasons[0] += why == nothing_alike;
    reasons[1] += why == something_else;
    reasons[2] += why == depends;
    return c.instructions.basis == COST_PREDICTED;
}

static void test_prices_are_those_sums(void) {
    int known = 0;
    int refused = 0;
    for (int n = 0; n < SCENES; n++) {
        derived d = derived_scene(scene_text(n), "s");
        derived_expect(&d, scene_text(n));
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
    printf("  %d prices; unknown: %d, %d, %d\n", known, reasons[0], reasons[1], reasons[2]);
    TEST_ASSERT_TRUE(known > 200 && refused > 20);
    TEST_ASSERT_TRUE(reasons[0] > 0 && reasons[1] > 0 && reasons[2] > 0);
}

void suite_price_rows(void) { RUN_TEST(test_prices_are_those_sums); }
