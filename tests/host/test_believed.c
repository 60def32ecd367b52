/* test_believed.c: whether what is left of a run's energy can be believed (host/check/energy_residual.h), by formulas: of books that are made up,
 * of runs with contacts whose totals are, and of what float loses of powers that are too small for it. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "host/check/energy_residual.h"
#include "made_run.h"
#include "unity.h"

void suite_believed(void);

static dice die;

static void expect_near(double wanted, double is, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(wanted - is) <= 1e-12 * fabs(wanted), what);
}

static bool maybe(void) { return dice_one_of(&die, 2) == 0; }

/* --- books that are made up ---------------------------------------------------------------------------------------------*/

static uint64_t held; /* values at an end of their range */
static uint64_t held_values(const void *run) {
    (void)run;
    return held;
}

/* What explains it, by the root of the steps; the measure, and its part. */
static void expect_measure(const energy_residual *made, books *b, const engine_kind *kind,
                           double entry_J, double left_J) {
    double computing_J = 0.0;
    const double step_J = books_rounding_J(b, kind, NULL, &computing_J);
    double rounding_J = 32.0 * sqrt((double)b->entries) * step_J + 2.0 * computing_J;
    const bool exact = b->image->settings.matrix == MATRIX_EXACT;
    rounding_J += left_J != 0.0 ? books_lost_J(b) : 0.0;
    rounding_J += left_J != 0.0 && exact ? b->rule_J : 0.0;
    const double least_J = 1e3 * rounding_J;
    TEST_ASSERT_EQUAL(isfinite(left_J), made->known);
    TEST_ASSERT_EQUAL(exact, made->exact);
    TEST_ASSERT_EQUAL(least_J > entry_J, made->rounded);
    expect_near(entry_J, made->entry_J, "entry");
    expect_near(fmax(entry_J, least_J), made->largest_J, "largest");
    expect_near(rounding_J, made->rounding_J, "rounding");
    expect_near(2.0 * computing_J, made->computing_J, "computing");
    expect_near(b->size_J, made->size_J, "size");
    expect_near(left_J == 0.0 ? 0.0 : fabs(left_J) / fmax(entry_J, least_J), made->ratio, "ratio");
}

static double swung(const books *b) { return books_swing_J(b); }

static void test_made_up_books(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        const uint64_t end = 2 + dice_one_of(&die, 20);
        made_run_draw(&die, c % 2U == 0, c % 3U == 0);
        made_run_states(&die, end);
        derived d = made_run_derive();
        made_run.image = d.image;
        engine_kind kind = made_run_kind;
        kind.saturated = maybe() ? held_values : NULL;
        held = dice_one_of(&die, 2);
        books *b = books_open(made_run.image);
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            books_enter(b, &kind, NULL);
        }
        made_run.at = end;
        /* any of the entries may be the largest, rounding a part that counts */
        const double size = exp(dice_between(&die, -30.0, 1.0));
        for (int k = 0; k < 2; k++) {
            b->energy_J[k] = size * dice_between(&die, -1.0, 1.0);
            b->moving_J[k] = size * dice_between(&die, -9.0, 9.0);
            b->stored_J[k] = size * dice_between(&die, -9.0, 9.0);
        }
        b->input_J = size * dice_between(&die, -9.0, 9.0);
        b->loss_J = size * dice_between(&die, 0.0, 9.0);
        b->rule_J = size * dice_between(&die, 0.0, 1e-3);
        b->jump_J = size * dice_between(&die, -9.0, 9.0);
        b->jump_s = 7.0;
        if (c % 4U == 3) { /* nothing left over at all */
            b->energy_J[1] = b->energy_J[0];
            b->input_J = 0.0;
            b->loss_J = 0.0;
        }
        if (maybe()) {
            b->kinetic.squares *= size * size;
            b->stored.squares *= size * size;
            memset(b->rate, 0, (size_t)d.image->count * sizeof *b->rate);
        }
        d.image->settings.matrix = c % 5U == 0 ? MATRIX_EXACT : MATRIX_NONE;
        const double left_J = b->energy_J[1] - b->energy_J[0] - b->input_J + b->loss_J;
        const double entries[] = {fabs(b->input_J), fabs(b->loss_J),
                                  fabs(b->moving_J[1] - b->moving_J[0]),
                                  fabs(b->stored_J[1] - b->stored_J[0]), swung(b)};
        double entry_J = 0.0;
        for (int i = 0; i < 5; i++) {
            entry_J = fmax(entry_J, entries[i]);
        }
        const energy_residual made = energy_residual_of(b, &kind, NULL);
        TEST_ASSERT_TRUE(fabs(left_J - made.left_J) <= 1e-14 * entry_J);
        expect_measure(&made, b, &kind, entry_J, made.left_J);
        expect_near(b->input_J, made.inputs_J, "inputs");
        expect_near(-b->loss_J, made.losses_J, "losses");
        TEST_ASSERT_TRUE(made.contacts_J == 0.0);
        TEST_ASSERT_TRUE((fabs(b->jump_J) > 0.5 * fabs(left_J)) == (made.jump_s == 7.0));
        TEST_ASSERT_TRUE(made.jump_s == 7.0 || made.jump_s < 0.0);
        TEST_ASSERT_EQUAL(kind.saturated != NULL && held > 0, made.saturated);
        books_close(b);
        derived_free(&d);
    }
    TEST_ASSERT_FALSE(energy_residual_of(NULL, &made_run_kind, NULL).known);
}

/* --- with contacts ------------------------------------------------------------------------------------------------------*/

static double totals[400]; /* as the run keeps them */
static void told_totals(const void *run, double *total, double *error) {
    (void)run;
    memcpy(total, totals, sizeof totals[0] * (size_t)(error - total));
    error[0] = 3.0;
}

static uint64_t one_step(const void *run) {
    (void)run;
    return 1;
}

static void rests(const void *run, double *angle_rad, double *real) {
    (void)run;
    (void)angle_rad;
    memset(real, 0, 4 * sizeof *real);
}

static void test_kept_books(void) {
    static const char text[] =
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput p = 1 [N]\n"
        "input k = 2 [N/m]\nT = 1 [kg]*(x'^2 + y'^2)/2\nV = k*x^2/2\nF = 3 [N*s/m]*x'^2/2 + 1 [N*s/m]*y'^2/2\n"
        "Q(x) = p\nQ(y) = 2*p\nstop x >= -1 [m] restitution 0.5\n"
        "stop y >= -1 [m] restitution 0.5\nscene s { with ledger; step 1 [ms]; until 1 [s] }\n";
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    const image_ledger *l = &d.image->ledger;
    engine_kind kind = engine_double;
    kind.ledger = told_totals;
    kind.steps = one_step;
    kind.state = rests;
    TEST_ASSERT_TRUE(l->kept && l->entries < 400);
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        books *b = books_open(d.image);
        books_enter(b, &kind, NULL);
        for (int i = 0; i < l->entries; i++) {
            totals[i] = dice_between(&die, -5.0, 5.0);
        }
        b->energy_J[0] = dice_between(&die, -5.0, 5.0);
        b->energy_J[1] = dice_between(&die, -5.0, 5.0);
        double left_J = b->energy_J[1] - b->energy_J[0];
        double most = 0.0;
        double inputs_J = 0.0;
        double losses_J = 0.0;
        double contacts_J = 0.0;
        for (int i = 0; i < l->smooth; i++) { /* statements; of the energy's account */
            const ledger_kind by = l->entry[i].kind;
            if (l->entry[i].account == 0) {
                const bool damper = by == LEDGER_LOSS || by == LEDGER_DAMPING;
                losses_J += damper ? totals[i] : 0.0;
                inputs_J += damper ? 0.0 : totals[i];
                left_J -= totals[i];
                most = fmax(most, fabs(totals[i]));
            }
        }
        for (int i = 0; i < d.image->contacts; i++) { /* each with the energy first */
            const double own = totals[l->smooth + i * (1 + d.image->coordinates)];
            contacts_J += own;
            left_J -= own;
            most = fmax(most, fabs(own));
        }
        for (int i = 0; i < l->inputs; i++) { /* the last */
            const double own = totals[l->entries - l->inputs + i];
            inputs_J += own;
            left_J -= own;
            most = fmax(most, fabs(own));
        }
        const energy_residual made = energy_residual_of(b, &kind, NULL);
        expect_near(left_J, made.left_J, "left over");
        expect_near(inputs_J, made.inputs_J, "inputs");
        expect_near(losses_J, made.losses_J, "losses");
        expect_near(contacts_J, made.contacts_J, "contacts");
        expect_near(most, made.energy.largest, "largest");
        expect_measure(&made, b, &kind, most, left_J);
        TEST_ASSERT_TRUE(made.jump_s < 0.0);
        books_close(b);
    }
    d.image->ledger.kept = false;
    books *b = books_open(d.image);
    TEST_ASSERT_FALSE(energy_residual_of(b, &kind, NULL).known);
    books_close(b);
    derived_free(&d);
}

/* --- what float loses ---------------------------------------------------------------------------------------------------*/

/* Of a list's powers, in its bounds with and without what is below the least normal number. */
static double lost_W(const image *im, const double *real, const double *input) {
    const op_list *t = im->list[IMAGE_BOOKS];
    double value[60];
    double off[2][60];
    double lost = 0.0;
    TEST_ASSERT_TRUE(t->results < 60);
    evaluator *e = evaluator_new(t);
    evaluator_wrap(e);
    evaluator_run(e, 0.0, NULL, real, real + im->coordinates, input, value);
    evaluator_rounding(e, NULL, 0.0, off[0]);
    evaluator_rounding(e, NULL, 0x1p-126, off[1]);
    evaluator_free(e);
    lost += off[1][im->count + BOOK_INPUT_POWER] - off[0][im->count + BOOK_INPUT_POWER];
    lost += off[1][im->count + BOOK_LOSS_POWER] - off[0][im->count + BOOK_LOSS_POWER];
    return lost;
}

static void test_what_is_too_small(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(16, 6)); c++) {
        char text[700];
        const double tiny = exp(dice_between(&die, -55.0, -40.0));
        const int end = 1 + (int)dice_one_of(&die, 90);
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput p = %.17g [N]\n"
            "input k = %.17g\nT = 1 [kg]*(x'^2 + 3*y'^2)/2\nQ(x) = p*k + 1e-20 [N*s/m]*x'\n"
            "F = %.17g [N*s/m]*y'^2*k/2\nstop x >= -100 [m] restitution 0.5\n"
            "scene s { with ledger; start x' = %.17g [m/s], y' = %.17g [m/s], y = 1 [m]; step 10 [ms]; "
            "until %.2f [s] }\n",
            tiny, tiny, tiny, tiny * dice_between(&die, 1.0, 1e9),
            tiny * dice_between(&die, 1.0, 1e9), 0.01 * end);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        const engine_kind *kind = c % 4U == 3 ? &engine_double : &engine_float;
        double input[4];
        double wanted_J = 0.0;
        void *run = kind->start(d.image);
        books *b = books_open(d.image);
        image_inputs(d.image, input);
        for (int i = 0; i <= end; i++) {
            double real[4];
            TEST_ASSERT_TRUE(i == 0 || kind->step(run) == WH_OK);
            books_enter(b, kind, run);
            kind->state(run, NULL, real);
            if (i == 0 || i == 1 || i == 4 || i == 16 || i == 64 || i == end) {
                const double entries = d.image->ledger.smooth + 1 + 2;
                const double own_J =
                    0x1p-24 * (8.0 * entries * 0x1p-126 + 0.01 * lost_W(d.image, real, input));
                wanted_J = fmax(wanted_J, own_J);
            }
        }
        double computing_J;
        const double step_J = books_rounding_J(b, kind, run, &computing_J);
        wanted_J *= kind == &engine_float ? end + 1 : 0;
        expect_near(wanted_J, books_lost_J(b), "lost");
        const energy_residual made = energy_residual_of(b, kind, run);
        expect_near(32.0 * sqrt(end + 1.0) * step_J + 2.0 * computing_J +
                        (made.left_J != 0.0 ? wanted_J : 0.0),
                    made.rounding_J, "rounding, with what is lost");
        books_close(b);
        kind->stop(run);
        derived_free(&d);
    }
}

void suite_believed(void) {
    die = dice_of("believed", 95);
    const long before = blocks_in_use();
    RUN_TEST(test_made_up_books);
    RUN_TEST(test_kept_books);
    RUN_TEST(test_what_is_too_small);
    TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
}
