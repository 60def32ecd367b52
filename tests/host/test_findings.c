/* test_findings.c: verdict on a run's energy residual (host/check/energy_residual.h), by formulas: for synthetic
 * balances, runs with contacts and synthetic totals, and powers too small for float. */
#include "host/base/exit.h"
#include "host/check/energy_residual.h"
#include "host/check/finding.h"
#include "host/cli/commands.h"
#include "host/engine/engine.h"
#include "host/os/system.h"

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "json_check.h"
#include "made_run.h"
#include "made_sweep.h"

/* === believed ================================================================================= */

static dice die;

static void expect_near(double wanted, double is, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(wanted - is) <= 1e-12 * fabs(wanted), what);
}

static bool maybe(void) { return dice_one_of(&die, 2) == 0; }

/* --- synthetic balances -------------------------------------------------------------------------- */

static uint64_t held; /* values at an end of their range */
static uint64_t held_values(const void *run) {
    (void)run;
    return held;
}

/* The measure, its round-off allowance, which grows with the square root of the steps, and their ratio. */
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
    expect_near(fmax(entry_J, least_J), made->largest_J, "largest");
    expect_near(rounding_J, made->rounding_J, "rounding");
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
        /* any entry may be the largest; round-off a relevant part */
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
        if (c % 4U == 3) { /* no residual at all */
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

static double totals[400]; /* in the run's storage */
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
        for (int i = 0; i < l->smooth; i++) { /* statements of the energy's account */
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

/* --- losses of float ----------------------------------------------------------------------------- */

/* Bound of a list's powers with and without values below the least normal number. */
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

SUITE(believed) {
    die = dice_of("believed", 95);
    const long before = blocks_in_use();
    RUN_TEST(test_made_up_books);
    RUN_TEST(test_kept_books);
    RUN_TEST(test_what_is_too_small);
    TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
}

/* === short runs =============================================================================== */
/* Runs of one to nine steps of a body pulled back by a force or a spring, with an unreached stop or without, against
 * closed forms. An odd number of steps leaves the balance's last step without a pair, and a single step beside a
 * contact has no successor. Accurate runs cause no warning; wrong ones are not trusted. */

typedef struct short_run {
    double swing_radps;
    double start_m;
    double step_s;
    int steps;
    bool by_force; /* which does work; else a spring */
    bool stop;
    double beside_N; /* on a falling body beside it, whose energy may dominate */
} short_run;

static short_run draw(dice *d) {
    short_run r = {.start_m = pow(10.0, dice_between(d, -3.0, 1.0)),
                   .step_s = pow(10.0, dice_between(d, -4.0, -1.0)),
                   .steps = 1 + (int)(dice_one_of(d, 4) == 0 ? 0 : dice_one_of(d, 9)),
                   .by_force = dice_one_of(d, 3) > 0,
                   .stop = dice_one_of(d, 2) == 0};
    r.swing_radps = pow(10.0, dice_between(d, -2.5, 0.5)) / r.step_s;
    r.beside_N = dice_one_of(d, 2) == 0 ? 0.0 : 1e3 * r.swing_radps * r.swing_radps * r.start_m;
    return r;
}

static void write(const short_run *r, char *text, size_t size) {
    char stop[80] = "";
    char law[160];
    const double stiffness = r->swing_radps * r->swing_radps;
    snprintf(law, sizeof law,
             r->by_force ? "Q(x) = -%.17g [N/m]*x\nV = -%.17g [N]*z"
                         : "V = %.17g [N/m]*x^2/2 - %.17g [N]*z",
             stiffness, r->beside_N);
    if (r->stop) {
        snprintf(stop, sizeof stop, "stop x >= -%.17g [m] restitution 0.3\n", 1000.0 * r->start_m);
    }
    snprintf(text, size,
             "mechanism short\ncoordinate x [m]\ncoordinate z [m]\n"
             "T = 1 [kg]*x'^2/2 + 1 [kg]*z'^2/2\n%s\n%s"
             "scene s { start x = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             law, stop, r->start_m, r->step_s, r->steps * r->step_s);
}

/* Largest error relative to the ranges of place and rate. */
static double off_by(const short_run *r, const char *csv) {
    double off[2] = {0.0, 0.0};
    double low[2] = {r->start_m, 0.0};
    double high[2] = {r->start_m, 0.0};
    double value[5]; /* time, both places, both rates */
    for (const char *row = csv; (row = said_row(row, 5, value)) != NULL;) {
        const double phase = r->swing_radps * value[0];
        const double is[2] = {r->start_m * cos(phase), -r->start_m * r->swing_radps * sin(phase)};
        for (int i = 0; i < 2; i++) {
            off[i] = fmax(off[i], fabs(value[1 + 2 * i] - is[i]));
            low[i] = fmin(low[i], is[i]);
            high[i] = fmax(high[i], is[i]);
        }
    }
    return fmax(off[0] / (high[0] - low[0]), off[1] / (high[1] - low[1]));
}

static void hold(const char *number) {
    dice d = dice_of("short runs", 4463);
    const unsigned cases = dice_cases(few_or_all(usual_or(200, 50), 1000));
    unsigned wrong = 0;
    unsigned right = 0;
    for (unsigned i = 0; i < cases; i++) {
        const short_run r = draw(&d);
        char text[600];
        said what;
        write(&r, text, sizeof text);
        const char *words[] = {model_keep(text), "--number", number, "--csv", "-", NULL};
        command_say(command_run, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        const double off = off_by(&r, what.out);
        const bool warns = strstr(what.err, "warning: ") != NULL;
        if (off > 0.03) {
            wrong++;
            TEST_ASSERT_NULL_MESSAGE(strstr(what.err, "to the end: every"), text);
        } else if (off < 3e-4) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(warns, what.err);
        }
    }
    model_drop();
    printf("  %s: of %u short runs %u right, none warned of; %u off, none trusted to the end\n",
           number, cases, right, wrong);
    TEST_ASSERT_TRUE(right > cases / 3 && wrong > cases / 20);
}

TEST(short_runs, in_float) { hold("float"); }
TEST(short_runs, in_double) { hold("double"); }

/* === small told =============================================================================== */
/* Figures in reports on small numbers: an angle with steps of a few of its units (host/check/slow.h), and a motion of a
 * few of the least numbers. */

static void expect_figure(double wanted, double is, const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(is - wanted) <= 0.06 * wanted, text);
}

/* An angle moves by whole units of 2^-32 turn: each step is rounded to the nearest. */
TEST(small_told, slow_angles) {
    for (unsigned n = 0; n < dice_cases(usual_or(16, 6)); n++) {
        char text[400];
        double figure[3] = {0.0};
        said what;
        const double unit_rad = 2.0 * 3.14159265358979323846 / 4294967296.0;
        const double part = (double)(n % 4U) + dice_between(&die, n % 4U == 0 ? 0.15 : -0.45, 0.45);
        const double step_s = dice_between(&die, 0.001, 0.1);
        const unsigned steps = 200 + dice_one_of(&die, 300);
        const double off_rad = fabs(nearbyint(part) - part) * unit_rad * steps;
        const double span_rad = part * unit_rad * steps;
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate a [rad]\n"
            "T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*a'^2/2\n"
            "scene s { start a' = %.17g [rad/s], x' = 1 [m/s]; step %.17g [s]; until %.17g [s] }\n",
            part * unit_rad / step_s, step_s, step_s * steps);
        for (int compensated = 0; compensated < 2; compensated++) {
            const char *words[] = {model_keep(text),
                                   "--quiet",
                                   "--number",
                                   "float",
                                   compensated > 0 ? "--compensated" : NULL,
                                   NULL};
            command_say(command_run, words, &what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
            if (off_rad < 1.02e-3 * span_rad || off_rad < 3.1e-9 || compensated > 0) {
                continue;
            }
            const char *note = strstr(what.err, "whirl run: note:");
            TEST_ASSERT_NOT_NULL_MESSAGE(note, what.err);
            const char *at = said_exactly(
                note, "whirl run: note: 'a' turns so slowly that rounding its steps to 1.5e-9 "
                      "rad, as float does, causes an error of up to ");
            at = said_exactly(said_number(at, &figure[0]), " rad, ");
            at = said_exactly(said_number(at, &figure[1]), " % of the ");
            at = said_exactly(
                said_number(at, &figure[2]),
                " rad that it should cover\nhint: use --compensated, or a larger --step, which rounds less\n");
            TEST_ASSERT_TRUE_MESSAGE(
                *at == '\0' || strncmp(at, "whirl run: exit status 1 ", 25) == 0, at);
            expect_figure(off_rad, figure[0], what.err);
            expect_figure(100.0 * off_rad / span_rad, figure[1], what.err);
            expect_figure(span_rad, figure[2], what.err);
        }
        TEST_ASSERT_EQUAL_STRING("", what.err);
    }
    model_drop();
}

/* A body that moves by a few to some hundred of float's least numbers. Round-off must be reported above a fiftieth of
 * the way, and not below a thousandth. The same for a spring whose products of rates fall below the normal numbers. */
TEST(small_told, small_numbers) {
    unsigned told = 0;
    for (unsigned n = 0; n < dice_cases(usual_or(40, 20)); n++) {
        char text[400];
        said what;
        const double size = exp(dice_between(&die, log(2e-44), log(n % 3U == 0 ? 1e-36 : 1e-42)));
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N/m]*x^2/2\n"
                 "scene s { start x = %.17g [m]; step 10 [ms]; until 2 [s] }\n",
                 n % 2U == 0 ? 1.0 : 9.0, size);
        const char *words[] = {model_keep(text), "--quiet", "--number", "float", NULL};
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        void *run = engine_float.start(d.image);
        double off = 0.0;
        const double w = n % 2U == 0 ? 1.0 : 3.0;
        for (int i = 1; i <= 200; i++) {
            double real[2];
            TEST_ASSERT_EQUAL_INT(WH_OK, engine_float.step(run));
            engine_float.state(run, NULL, real);
            off = i <= 50 ? fmax(off, fabs(real[0] - size * cos(w * 0.01 * i)) / size) : off;
        }
        engine_float.stop(run);
        derived_free(&d);
        command_say(command_run, words, &what);
        const bool is_told = strstr(what.err, "[accuracy]") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(off < 0.05 || is_told, what.err);
        TEST_ASSERT_TRUE_MESSAGE(off > 1e-4 || what.err[0] == '\0', what.err);
        told += is_told ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(told > 3);
    model_drop();
}

SUITE(small_told) { die = dice_of("small told", 90); }

/* === sweeps told ============================================================================== */
/* Output of a whole sweep: its rows; the points that failed, overran their events, turned too slowly or cannot be
 * trusted; and the first of each. The grids have known results at every point. */

static size_t row_at(const char *rows, uint64_t row) {
    const char *at = rows;
    for (uint64_t i = 0; i <= row; i++) {
        at = strchr(at, '\n') + 1;
    }
    return (size_t)(at - rows);
}

static unsigned times_in(const char *text, const char *words) {
    unsigned times = 0;
    for (const char *at = strstr(text, words); at != NULL; at = strstr(at + 1, words)) {
        times++;
    }
    return times;
}

/* --- points that fail --------------------------------------------------------------------------------------------*/

/* The final summary: count, number of points, and the number of workers. */
static void expect_end(const char *err, uint64_t points, uint64_t found, int workers) {
    char wanted[300];
    const int length = snprintf(wanted, sizeof wanted, "%llu points", (unsigned long long)points);
    const char *at = strstr(err, wanted);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, err);
    while (at != err && at[-1] != '\n') { /* "3 of 7 points failed" */
        at = strstr(at + 1, wanted);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, err);
    }
    at += length;
    if (found > 0) {
        snprintf(wanted, sizeof wanted, ", %llu of them found in %s", (unsigned long long)found,
                 sessions_path());
        at = said_exactly(at, wanted);
    }
    if (found < points) {
        double seconds = 0.0;
        double rate = 0.0;
        at = said_number(said_exactly(at, "; "), &seconds);
        at = said_number(said_exactly(at, " s, "), &rate);
        snprintf(wanted, sizeof wanted, " points/s with --jobs %d", workers);
        at = said_exactly(at, wanted);
        TEST_ASSERT_TRUE(seconds > 0.0 && seconds < 60.0);
        TEST_ASSERT_TRUE(fabs(seconds * rate / (double)(points - found) - 1.0) < 0.012);
    }
    TEST_ASSERT_EQUAL_STRING("\n", at);
}

/* A start below the floor fails at any point: the first twenty are reported in order, then that there are more, and the
 * total at the end. A resumed file counts those that it already has. */
static void test_failures(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(8, 4)); c++) {
        made_sweep m;
        char over[2][80];
        const char *const axes[] = {over[0], over[1]};
        const char *const asked[] = {"x"};
        const unsigned below = 1 + dice_one_of(&die, 9);
        const unsigned above = 1 + dice_one_of(&die, 5);
        const unsigned lines = c == 0 ? 1 : 1 + dice_one_of(&die, 5);
        const unsigned columns = below + above;
        const uint64_t points = (uint64_t)lines * columns;
        const uint64_t first = c % 3U == 2 ? dice_one_of(&die, (unsigned)points) : 0;
        const int most = 1 + (int)dice_one_of(&die, 6);
        const uint64_t rows = points - first;
        snprintf(over[0], sizeof over[0], "y=%s:%u", lines == 1 ? "7..7" : "1..9", lines);
        snprintf(over[1], sizeof over[1], "x=%d..%u:%u", -(int)below, above - 1, columns);
        made_sweep_open(&m, made_sweep_floor, axes, 2, asked, 1, &engine_double);
        session_settings settings = {.first = first, .end = points, .header = true, .jobs = most};
        sessions_open();
        session_said s = sessions_sit(&m, settings);
        unsigned failed = 0;
        for (uint64_t i = first; i < points; i++) {
            const unsigned column = (unsigned)(i % columns);
            const uint64_t row = i / columns;
            if (column < below && ++failed <= 20) {
                char wanted[200];
                char y[NUMBER_SIZE];
                const double line = lines == 1 ? 7.0 : 1.0 + 8.0 * (double)row / (lines - 1.0);
                snprintf(wanted, sizeof wanted,
                         "whirl sweep: error: point %u (y=%s, x=%d): the run starts beyond this "
                         "stop, by %u m",
                         (unsigned)i + 1, number_shortest(line, y), (int)column - (int)below,
                         below - column);
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(s.err, wanted), s.err);
            }
        }
        TEST_ASSERT_EQUAL_UINT(failed < 20 ? failed : 20, times_in(s.err, "error: point "));
        TEST_ASSERT_EQUAL_UINT(
            failed > 20 ? 1 : 0,
            times_in(s.err, "\nfurther failures are not listed: their measures are empty\n"));
        char wanted[200];
        snprintf(wanted, sizeof wanted,
                 "whirl sweep: error: %u of %u points failed: their measures are empty\n", failed,
                 (unsigned)rows);
        TEST_ASSERT_EQUAL_UINT(failed > 0 ? 1 : 0, times_in(s.err, wanted));
        TEST_ASSERT_EQUAL_INT(failed > 0 ? EXIT_RUN_FAILED : EXIT_DONE, s.code);
        expect_end(s.err, rows, 0, (uint64_t)most < rows ? most : (int)rows);
        TEST_ASSERT_EQUAL_STRING_LEN("start(y),start(x),x,energy_residual\r\n", s.rows, 37);

        const uint64_t kept = c % 2U == 0 ? rows : dice_one_of(&die, (unsigned)rows + 1U);
        sessions_cut(kept < rows ? row_at(s.rows, kept) : strlen(s.rows));
        settings.quiet = c % 4U == 3;
        const session_said again = sessions_sit(&m, settings);
        TEST_ASSERT_EQUAL_STRING(s.rows, again.rows);
        TEST_ASSERT_EQUAL_INT(s.code, again.code);
        TEST_ASSERT_EQUAL_UINT(failed > 0 ? 1 : 0, times_in(again.err, wanted));
        if (!settings.quiet) {
            const uint64_t rest = rows - kept;
            expect_end(again.err, rows, kept, (uint64_t)most < rest ? most : (int)rest);
        } else {
            TEST_ASSERT_NULL_MESSAGE(strstr(again.err, "points/s"), again.err);
        }
        made_sweep_close(&m);
    }
    sessions_close();
}

/* --- points with further reports -------------------------------------------------------------------------------- */

/* A ball between stops a millimetre apart bounces v times per millisecond: from 8 m/s on more often than a step takes.
 * It then rests: one step of each. An angle beside it turns, sometimes too slowly for float. */
static const char between_text[] =
    "mechanism m\ncoordinate z [m]\ncoordinate a [rad]\nT = 1 [kg]*z'^2/2 + 1 [kg*m^2]*a'^2/2\n"
    "stop z >= 0 [mm] restitution 1\nstop z <= 1 [mm] restitution 1\n"
    "scene s { start z = 0.5 [mm]; step 1 [ms]; until 0.05 [s] }\n";

static void expect_note(const char *err, const char *begin, unsigned count, unsigned ran,
                        const char *middle, unsigned first, const char *at) {
    char wanted[300];
    snprintf(wanted, sizeof wanted, "%s%u of %u points ", begin, count, ran);
    const char *note = strstr(err, wanted);
    TEST_ASSERT_EQUAL_MESSAGE(count > 0, note != NULL, err);
    if (note != NULL) {
        snprintf(wanted, sizeof wanted, "%sfirst: point %u (%s)\nhint: ", middle, first + 1, at);
        note = strstr(note, wanted);
        TEST_ASSERT_NOT_NULL_MESSAGE(note, err);
    }
}

static void test_notes(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        made_sweep m;
        char over[60];
        const char *const axes[] = {over, "a'=1e-7..1:2"};
        const char *const reversed[] = {over, "a'=1..1e-7:2"};
        const char *const asked[] = {"z", "a"};
        const bool is_float = c % 2U == 0;
        const bool slow_first = c % 3U != 0;
        const unsigned count = 1 + dice_one_of(&die, 5);
        const double from = c % 2U == 0 ? 3.0 : dice_between(&die, 11.0, 20.0);
        /* 3, 13, ...: all but one bounce too often; or all, or no point */
        const double to = count == 1    ? from
                          : c % 3U == 0 ? from + 1.0
                                        : from + 10.0 * (count - 1.0);
        snprintf(over, sizeof over, "z'=%.17g..%.17g:%u", from, to, count);
        made_sweep_open(&m, between_text, slow_first ? axes : reversed, 2, asked, 2,
                        is_float ? &engine_float : &engine_double);
        unsigned overran = 0;
        unsigned first_overrun = 0;
        char first_at[2][100];
        const unsigned points = 2 * count;
        unsigned slow = 0;
        unsigned first_slow = 0;
        for (unsigned i = 0; i < points; i++) {
            double value[2];
            char text[NUMBER_SIZE];
            char at[100];
            grid_values(&m.grid, i, value);
            snprintf(at, sizeof at, "z'=%s, a'=%s", number_shortest(value[0], text),
                     value[1] == 1.0 ? "1" : "1e-07");
            TEST_ASSERT_TRUE(value[0] < 7.0 || value[0] > 9.0);
            if (value[0] > 8.0 && overran++ == 0) {
                first_overrun = i;
                snprintf(first_at[0], sizeof first_at[0], "%s", at);
            }
            if (is_float && value[1] != 1.0 && slow++ == 0) {
                first_slow = i;
                snprintf(first_at[1], sizeof first_at[1], "%s", at);
            }
        }
        const session_settings settings = {.end = points, .header = true, .jobs = 2, .quiet = true};
        sessions_open();
        const session_said s = sessions_sit(&m, settings);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(s.err), s.code, s.err);
        expect_note(s.err, "whirl sweep: warning: ", overran, points,
                    "had steps with more events than a step takes [events]; ", first_overrun,
                    first_at[0]);
        expect_note(s.err, "whirl sweep: note: ", slow, points,
                    "have a component whose steps are below its resolution [digits]; ", first_slow,
                    first_at[1]);
        made_sweep_close(&m);
    }
    sessions_close();
}

/* A spring by Runge-Kutta 4 keeps |1 - (hw)^6/72 + (hw)^8/576| of its energy per step. A soft one keeps nearly all of
 * it in a hundred steps, a hard one nothing. */
static void test_not_believed(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(6, 3)); c++) {
        made_sweep m;
        static const char text[] =
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
            "V = 1 [N/m]*x^2/2\nscene s { start x = 1 [m]; step 1 [ms]; until 40 [s] }\n";
        char over[60];
        const char *const axes[] = {over};
        const char *const asked[] = {"x"};
        const double fine_s = dice_between(&die, 0.01, 0.05);
        const double coarse_s = dice_between(&die, 1.0, 1.8);
        const bool fine_first = c % 2U == 0;
        snprintf(over, sizeof over, "step=%.3g..%.3g:2", fine_first ? fine_s : coarse_s,
                 fine_first ? coarse_s : fine_s);
        made_sweep_open(&m, text, axes, 1, asked, 1, &engine_double);
        const session_settings settings = {.end = 2, .jobs = 2, .quiet = true};
        sessions_open();
        const session_said s = sessions_sit(&m, settings);
        char at[60];
        double value[1];
        char number[NUMBER_SIZE];
        grid_values(&m.grid, fine_first ? 1 : 0, value);
        snprintf(at, sizeof at, "step=%s", number_shortest(value[0], number));
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(s.err), s.code, s.err);
        expect_note(
            s.err, "whirl sweep: warning: ", 1, 2,
            "fail the energy balance: the residual is too large compared with the balance's largest entry (energy_residual), at the end or at a time before [energy]; ",
            fine_first ? 1 : 0, at);
        TEST_ASSERT_TRUE(
            times_in(s.err, "hint: run the point with `whirl run`: it prints a remedy\n") >= 1);
        made_sweep_close(&m);
    }
    sessions_close();
}

/* --- interrupted sweeps ----------------------------------------------------------------------------------------- */

/* Stopped before the first new point: existing rows stay, and the message says how to resume. */
static void test_stopped(void) {
    made_sweep m;
    const char *const axes[] = {"x=1..9:9"};
    const char *const asked[] = {"x"};
    made_sweep_open(&m, made_sweep_floor, axes, 1, asked, 1, &engine_double);
    session_settings settings = {.end = 9, .header = true, .jobs = 1, .quiet = true};
    sessions_open();
    const session_said whole = sessions_sit(&m, settings);
    for (unsigned kept = 0; kept < 9U; kept++) {
        unsigned rows = 0;
        sessions_cut(row_at(whole.rows, kept));
        interrupted = 1;
        const session_said s = sessions_sit(&m, settings);
        interrupted = 0;
        for (const char *at = strchr(s.rows, '\n'); at != NULL; at = strchr(at + 1, '\n')) {
            rows += at[1] != '\0' ? 1 : 0;
        }
        if (rows == 9) { /* it was complete already */
            TEST_ASSERT_EQUAL_INT(EXIT_DONE, s.code);
            continue;
        }
        char wanted[200];
        snprintf(wanted, sizeof wanted,
                 "whirl sweep: interrupted after %u of 9 points; their rows are kept\n"
                 "hint: repeat the command to continue from there\n",
                 rows);
        TEST_ASSERT_EQUAL_STRING(wanted, s.err);
        TEST_ASSERT_EQUAL_INT(EXIT_INTERRUPTED, s.code);
        TEST_ASSERT_TRUE(rows >= kept);
        const session_said on = sessions_sit(&m, settings);
        TEST_ASSERT_EQUAL_STRING(whole.rows, on.rows);
    }
    made_sweep_close(&m);
    sessions_close();
}

static void test_given_back(void) {
    static void (*const rounds[])(void) = {test_failures, test_notes, test_stopped};
    for (size_t i = 0; i < sizeof rounds / sizeof rounds[0]; i++) {
        const long before = blocks_in_use();
        rounds[i]();
        TEST_ASSERT_TRUE(blocks_in_use() == before);
    }
}

SUITE(sweeps_told) {
    die = dice_of("sweeps_told", 62);
    RUN_TEST(test_failures);
    RUN_TEST(test_notes);
    RUN_TEST(test_not_believed);
    RUN_TEST(test_stopped);
    RUN_TEST(test_given_back);
}

/* === thresholds =============================================================================== */
/* Each finding on both sides of its limit (host/check/finding.h). A scene with one parameter causes no report at one
 * end and one at the other. Bisection finds the place of the limit: just beyond it the finding is reported, with a
 * value just beyond the limit; just within it is not. That place is known, mostly in closed form, so that a limit wrong
 * by a twentieth fails. Findings that count steps have their own suites (pole, missed, busy). */

enum { TEXT = 1200, HALVINGS = 24 };

/* "%1$.17g" is the parameter, in the decade `silent` to `told`, randomly extended at both ends. */
static const struct {
    finding_id id;
    const char *number;
    double silent;
    double told;
    double at; /* where the report starts; 0: somewhere between */
    double limit;
    const char *text;
} rows[] = {
    {FINDING_ENERGY, "double", 0.1, 10.0, 0.4335,
     1e-3, /* N (h w)^6/72 of energy; largest entry: root 2 */
     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %1$.17g [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]\nstep 0.5 [s]\nuntil 40 [s] }\n"},
    {FINDING_ACCURACY, "double", 0.1, 4.0, 2.728, 0.5, /* w t (h w)^4/120: 1 % of the range */
     "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %1$.17g [N/m]*x^2/2\n"
     "scene s { start x = 1 [m]\nstep 0.25 [s]\nuntil 100 [s] }\n"},
    {FINDING_MASS, "double", 1e-10, 1e-13, 4e-12, 1e-4,
     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"
     "T = %1$.17g [kg]*x'^2/2 + 1 [kg]*(x' + y')^2/2\n"
     "V = 1 [N/m]*(x + y)^2/2 + %1$.17g [N/m]*x^2/2\n"
     "scene s { start y = 1 [m]\nstep 1 [ms]\nuntil 0.1 [s] }\n"},
    {FINDING_ALIASED, "double", 1e-5, 1.0, 1e-3, 1e-3,
     "mechanism m\ncoordinate x [m]\ncoordinate t [s]\nT = 1 [kg]*x'^2/2 + 1e-9 [J]*t'^2/2\n"
     "Q(x) = 1 [N] + %1$.17g [N]*cos(2*pi*400 [Hz]*t)\n"
     "scene s { start x' = 1 [m/s], t' = 1\nstep 10 [ms]\nuntil 2 [s] }\n"},
    {FINDING_APART, "double", 1e-8, 1e-4, 1.25e-6, 1e-6, /* 0.8 of it is along the rod */
     "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nT = 1 [kg]*(x'^2 + y'^2)/2\n"
     "V = 9.81 [N]*y\nhold sqrt(x^2 + y^2) - 1 [m] while 1 > 0\n"
     "scene s { start x = 0.6 [m], y = 0.8 [m] + %1$.17g [m]\nstep 1 [ms]\nuntil 20 [ms] }\n"},
    {FINDING_DIGITS, "float", 1e-2, 1e-6, 0.0, 1e-3,
     "mechanism m\ncoordinate q [rad]\nT = 1 [kg*m^2]*q'^2/2\nV = 1e-9 [J]*cos(q)\n"
     "scene s { start q' = %1$.17g [rad/s]\nstep 1 [ms]\nuntil 2 [s] }\n"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* The reported value of this finding; NAN without a report. */
static double told_by(unsigned row, double parameter) {
    static said what;
    char text[TEXT];
    char value[100];
    snprintf(text, sizeof text, rows[row].text, parameter);
    const char *words[] = {model_keep(text), "--json", "--number", rows[row].number, NULL};
    command_say(command_run, words, &what);
    const int count = json_length(what.out, "findings");
    TEST_ASSERT_TRUE_MESSAGE(count >= 0, what.err);
    for (int i = 0; i < count; i++) {
        char path[60];
        snprintf(path, sizeof path, "findings/%d/id", i);
        if (strcmp(json_value(what.out, path, value), finding_rows[rows[row].id].word) == 0) {
            snprintf(path, sizeof path, "findings/%d/value", i);
            return strtod(json_value(what.out, path, value), NULL);
        }
    }
    return (double)NAN;
}

TEST(thresholds, both_sides_of_each_limit) {
    dice d = dice_of("thresholds", 4703);
    for (unsigned i = 0; i < ROWS; i++) {
        const double limit = rows[i].limit;
        const char *word = finding_rows[rows[i].id].word;
        const double off = rows[i].told > rows[i].silent ? 1.0 : -1.0;
        double silent = rows[i].silent * pow(2.0, -off * dice_between(&d, 0.0, 1.0));
        double told = rows[i].told * pow(2.0, off * dice_between(&d, 0.0, 1.0));
        TEST_ASSERT_TRUE_MESSAGE(isnan(told_by(i, silent)), word);
        TEST_ASSERT_FALSE_MESSAGE(isnan(told_by(i, told)), word);
        for (int k = 0; k < HALVINGS; k++) {
            const double middle = sqrt(silent * told);
            *(isnan(told_by(i, middle)) ? &silent : &told) = middle;
        }
        const double value = told_by(i, told);
        TEST_ASSERT_TRUE_MESSAGE(finding_rows[rows[i].id].limit == limit, word);
        const bool below = rows[i].id == FINDING_ACCURACY;
        printf("  %-9s limit %g %s, told from %.6g on\n", word, limit,
               finding_rows[rows[i].id].unit, value);
        TEST_ASSERT_TRUE_MESSAGE(below ? value <= limit : value >= limit, word);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.02 * limit, limit, value, word);
        TEST_ASSERT_TRUE_MESSAGE(rows[i].at == 0.0 || fabs(told / rows[i].at - 1.0) < 0.02, word);
    }
    model_drop();
}
