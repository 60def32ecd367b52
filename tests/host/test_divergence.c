/* test_divergence.c: a run that diverges must stop, name the component, and keep its last good state, in float and
 * double, with every method. Also the time until which a run is accurate. */
#include "test.h"

#include "core/method.h"
#include "host/check/horizon.h"
#include "host/check/run_checks.h"
#include "host/cli/commands.h"
#include "host/os/system.h"

#include "command.h"
#include "derived.h"
#include "horizons.h"
#include "linear.h"
#include "motion.h"

/* === suite divergence ========================================================================= */

/* x'' = 2 x^3/m^2 from x = 1 m at 1 m/s has the solution x = 1/(1 - t), infinite at 1 s. */
static const char blow_up[] = "mechanism blow_up\n"
                              "coordinate x [m]\n"
                              "parameter m = 1 [kg]\n"
                              "parameter c = 1 [N/m^3]\n"
                              "T = m*x'^2/2\n"
                              "V = -c*x^4/2\n"
                              "scene escape {\n"
                              "  start x = 1 [m], x' = 1 [m/s]\n"
                              "  step 1 [ms]\n"
                              "  until 2 [s]\n"
                              "}\n";

static const engine_kind *const kinds[] = {&engine_float, &engine_double};

/* Steps until a step fails, which must be within `most` steps. The state must be that before the failed step, and
 * further steps must fail in the same way. Returns the number of good steps. */
static uint64_t run_into_failure(motion *m, unsigned most) {
    const uint64_t first = m->kind->steps(m->run);
    uint64_t before = m->kind->hash(m->run);
    uint64_t done = 0;
    while (done < most && motion_step(m, 1) == WH_OK) {
        before = m->kind->hash(m->run);
        done++;
    }
    TEST_ASSERT_TRUE(done < most);
    const int fault = m->kind->fault(m->run);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(WH_E_DIVERGED, motion_step(m, 1));
        TEST_ASSERT_TRUE(m->kind->hash(m->run) == before);
        TEST_ASSERT_TRUE(m->kind->steps(m->run) == first + done);
        TEST_ASSERT_EQUAL_INT(fault, m->kind->fault(m->run));
    }
    TEST_ASSERT_TRUE(fault >= 0 && fault < m->image->angles + m->image->reals);
    return done;
}

TEST(divergence, every_method_stops) {
    for (unsigned k = 0; k < 4; k++) {
        for (unsigned i = 0; i < WH_METHODS; i++) {
            motion m;
            motion_open_text(&m, blow_up,
                             (stepping){.kind = kinds[k % 2],
                                        .method = (wh_method)i,
                                        .compensated = k / 2 != 0});
            /* methods of low order lag behind the solution and fail a little later */
            const uint64_t done = run_into_failure(&m, 1100);
            const double x = motion_value(&m, "x");
            TEST_ASSERT_TRUE(done >= 990);
            TEST_ASSERT_TRUE(x > 100.0 && x < 1e15 && isfinite(motion_value(&m, "x'")));
            motion_close(&m);
        }
    }
}

/* A torque that is not a number. The step must be refused. With the next valid torque, the motion must go on as if
 * nothing had happened. */
TEST(divergence, an_input_that_is_no_number) {
    for (unsigned k = 0; k < 2; k++) {
        motion m;
        motion undisturbed;
        motion_open(&undisturbed, "epicyclic_from_rest",
                    (stepping){.kind = kinds[k], .method = WH_RK4});
        motion_open(&m, "epicyclic_from_rest", (stepping){.kind = kinds[k], .method = WH_RK4});
        motion_to(&m, 1.0);
        m.kind->set_input(m.run, 0, (double)NAN);
        TEST_ASSERT_TRUE(run_into_failure(&m, 2) == 0);
        m.kind->set_input(m.run, 0, (double)INFINITY);
        TEST_ASSERT_TRUE(run_into_failure(&m, 2) == 0);
        m.kind->set_input(m.run, 0, 2.0);
        motion_to(&m, 2.0);
        motion_to(&undisturbed, 2.0);
        TEST_ASSERT_TRUE(m.kind->hash(m.run) == undisturbed.kind->hash(undisturbed.run));
        motion_close(&m);
        motion_close(&undisturbed);
    }
}

/* A start outside all bounds must be reported, without a smaller step or another number type as the remedy. */
TEST(divergence, starts_out_of_bounds_are_reported) {
    static const char *const units[] = {"m", "mm", "km"};
    static const double si[] = {1.0, 1e-3, 1e3};
    dice d = dice_of("starts beyond", 4141);
    for (unsigned i = 0; i < 40; i++) {
        const unsigned unit = dice_one_of(&d, 3);
        const bool rate = i % 2 == 0;
        const bool beyond = i % 4 < 2;
        const double size = pow(10.0, beyond ? dice_between(&d, 15.1, 30.0) : 3.0) / si[unit];
        char text[300];
        said what;
        snprintf(text, sizeof text,
                 "mechanism far\ncoordinate x [%s]\nT = 1 [kg]*x'^2/2\n"
                 "scene s { start x%s = %.17g [%s%s]; step 1 [ms]; until 1 [s] }\n",
                 units[unit], rate ? "'" : "", i % 3 == 0 ? -size : size, units[unit],
                 rate ? "/s" : "");
        COMMAND_SAY(command_run, &what, model_keep(text), "--quiet", "--number",
                    dice_one_of(&d, 2) == 0 ? "float" : "double");
        TEST_ASSERT_EQUAL_INT_MESSAGE(beyond ? 1 : 0, what.status, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(
            beyond, strstr(what.err, "a start value is above the limit") != NULL, what.err);
        TEST_ASSERT_TRUE_MESSAGE(
            strstr(what.err, "cures this") == NULL && strstr(what.err, "--step") == NULL, what.err);
    }
    model_drop();
}

/* === suite horizon ============================================================================ */
/* The time until which each column of a run is accurate. Passages of a level are compared with a search through all
 * entered differences. Verdicts on random columns are compared with their definition. Step doubling of growth and
 * decay is compared with powers of one step's factor. Words and rows of the report are read back. */

enum { ENTERED = 300 };

/* Time of the first difference above `level`; infinity if there is none. */
static double first_above_s(const double *time_s, const double *size, int count, double level) {
    for (int i = 0; i < count; i++) {
        if (!(size[i] <= level)) {
            return time_s[i];
        }
    }
    return (double)INFINITY;
}

/* Sizes that rise, fall or stay, or become NaN. The reported time of passing a level must lie between the first size
 * above the level and the first size above (1 + PASSAGE_GRAIN) times the level. */
TEST(horizon, levels_and_when_they_were_passed) {
    dice d = dice_of("horizon passages", 2312);
    for (unsigned k = 0; k < 60; k++) {
        double time_s[ENTERED];
        double size[ENTERED];
        double most = 0.0;
        passages p = {0};
        for (int i = 0; i < ENTERED; i++) {
            time_s[i] = i == 0 ? 0.0 : time_s[i - 1] + dice_between(&d, 0.0, 1.0);
            size[i] = i > 0 && dice_one_of(&d, 3) == 0
                          ? size[i - 1] * dice_between(&d, 1.0, 1.0 + 2.0 * PASSAGE_GRAIN)
                          : pow(10.0, dice_between(&d, -9.0, -9.0 + 12.0 * i / ENTERED));
            if (k % 4 == 0 && i > 250 && dice_one_of(&d, 20) == 0) {
                size[i] = (double)NAN;
            }
            passages_enter(&p, time_s[i], size[i]);
            most = isfinite(size[i]) ? fmax(most, size[i]) : (double)INFINITY;
            if (most > 1e300) {
                size[i] = (double)INFINITY;
            }
        }
        TEST_ASSERT_TRUE(p.most == most);
        for (int i = 1; i < p.count; i++) {
            TEST_ASSERT_TRUE(p.passed[i].size > p.passed[i - 1].size * (1.0 + PASSAGE_GRAIN));
            TEST_ASSERT_TRUE(p.passed[i].time_s > p.passed[i - 1].time_s);
        }
        for (int i = 0; i < 200; i++) {
            const double level = i < 100 ? pow(10.0, dice_between(&d, -10.0, 5.0)) : size[i];
            const double until_s = passages_until_s(&p, level);
            TEST_ASSERT_TRUE(until_s >= first_above_s(time_s, size, ENTERED, level));
            TEST_ASSERT_TRUE(until_s <= first_above_s(time_s, size, ENTERED,
                                                      level * (1.0 + 1.001 * PASSAGE_GRAIN)));
        }
        passages_free(&p);
        TEST_ASSERT_TRUE(p.passed == NULL && p.count == 0 && p.most == 0.0);
    }
}

enum { COLUMNS = 6, LOOKS = 40 };

typedef struct drawn_column {
    double low, high, rounding, one, alike;
    bool has_rate;
    int place;
    double time_s[LOOKS];
    double off[LOOKS];
    int looks;
} drawn_column;

/* A column that moves or not, of any size, with errors that differ by more than PASSAGE_GRAIN. */
static drawn_column draw_column(dice *d) {
    drawn_column c = {.low = dice_between(d, -5.0, 5.0)};
    const bool moves = dice_one_of(d, 3) > 0;
    c.high = c.low + (moves ? pow(10.0, dice_between(d, -7.0, 2.0)) : 0.0);
    c.rounding = dice_one_of(d, 2) == 0 ? 0.0 : pow(10.0, dice_between(d, -9.0, -2.0));
    if (dice_one_of(d, 4) == 0) { /* a column around zero */
        c.high = -c.low;
    }
    c.low = fmin(c.low, c.high);
    c.high = fmax(c.low, c.high);
    c.has_rate = dice_one_of(d, 2) == 0;
    c.alike =
        (c.high - c.low) * (dice_one_of(d, 2) == 0 ? 1.0 : pow(10.0, dice_between(d, 0.0, 5.0)));
    c.one = pow(10.0, dice_between(d, -3.0, 9.0));
    c.looks = dice_one_of(d, 4) == 0 ? 0 : (int)dice_one_of(d, LOOKS);
    double off = pow(10.0, dice_between(d, -9.0, -3.0));
    for (int i = 0; i < c.looks; i++) {
        off *= dice_between(d, 1.01, 1.8);
        c.time_s[i] = 0.25 * i;
        c.off[i] = i > 30 && dice_one_of(d, 6) == 0 ? (double)INFINITY : off;
    }
    return c;
}

static double most_off(const drawn_column *c, double left_out) {
    double most = 0.0;
    for (int i = 0; i < c->looks; i++) {
        most = fmax(most, c->off[i] * left_out);
    }
    return most;
}

/* Does the column count as one that does not move? By the definition at the head of horizon.c. */
static bool keeps_its_place(const drawn_column *c) {
    const double moved = c->high - c->low;
    const double size = fmax(fabs(c->low), fabs(c->high));
    return 1e9 * moved <= fmax(size, c->one) || 1e3 * moved <= c->alike;
}

static horizon_column judged(const drawn_column *all, int k, double tolerance,
                             const step_doubling *t) {
    const double left_out = t->left_out;
    const double end_s = t->end_s;
    const double least = t->shape->kind == &engine_double ? 1e-9 : 1e-3;
    const drawn_column *c = &all[k];
    const double moved = c->high - c->low;
    const double size = fmax(fabs(c->low), fabs(c->high));
    const bool keeps = keeps_its_place(&all[c->place]);
    horizon_column made = {.range = c->has_rate ? moved : fmax(moved, size * least),
                           .off = most_off(c, left_out),
                           .until_s = (double)INFINITY};
    for (int i = c->looks - 1; i >= 0; i--) {
        if (c->off[i] * left_out > tolerance * made.range) {
            made.until_s = c->time_s[i];
        }
    }
    if (isinf(made.until_s)) {
        const bool still = moved == 0.0 && made.off == 0.0;
        made.verdict = !keeps && c->rounding > 8.0 * tolerance * made.range ? HORIZON_UNKNOWN
                       : still                                              ? HORIZON_STILL
                                                                            : HORIZON_TO_THE_END;
    } else if (moved <= 8.0 * c->rounding && isfinite(made.off) && keeps) {
        made.verdict = HORIZON_ROUNDING;
    } else {
        made.verdict = HORIZON_UNTIL;
    }
    made.until_s = made.verdict == HORIZON_UNTIL     ? made.until_s
                   : made.verdict == HORIZON_UNKNOWN ? 0.0
                                                     : end_s;
    return made;
}

static bool ends_it(const horizon_column *c) {
    return c->verdict == HORIZON_UNTIL || c->verdict == HORIZON_UNKNOWN;
}

TEST(horizon, verdicts_on_drawn_columns) {
    dice d = dice_of("horizon verdicts", 2313);
    unsigned seen[5] = {0};
    for (unsigned n = 0; n < 800; n++) {
        drawn_column drawn[COLUMNS];
        step_doubling_column column[COLUMNS] = {{0}};
        const double tolerance = pow(10.0, dice_between(&d, -5.0, -1.0));
        records shape = {.kind = n % 2U == 0 ? &engine_double : &engine_float};
        step_doubling t = {.shape = &shape,
                           .column = column,
                           .columns = COLUMNS,
                           .end_s = 100.0,
                           .left_out = dice_between(&d, 1.0, 1.2)};
        for (int k = 1; k < COLUMNS; k++) {
            drawn[k] = draw_column(&d);
            column[k].low = drawn[k].low;
            column[k].high = drawn[k].high;
            column[k].rounding = drawn[k].rounding;
            column[k].has_rate = drawn[k].has_rate;
            column[k].one = drawn[k].one;
            column[k].alike = drawn[k].alike;
            drawn[k].place = drawn[k].has_rate ? k : 1 + (int)dice_one_of(&d, (unsigned)k);
            column[k].place = drawn[k].place;
            for (int i = 0; i < drawn[k].looks; i++) {
                passages_enter(&column[k].off, drawn[k].time_s[i], drawn[k].off[i]);
            }
        }
        horizon h = horizon_of(&t, tolerance);
        double until_s = t.end_s;
        bool to_the_end = true;
        for (int k = 1; k < COLUMNS; k++) {
            const horizon_column wanted = judged(drawn, k, tolerance, &t);
            TEST_ASSERT_EQUAL_INT(wanted.verdict, h.column[k].verdict);
            TEST_ASSERT_EQUAL_DOUBLE(wanted.range, h.column[k].range);
            TEST_ASSERT_EQUAL_DOUBLE(wanted.off, h.column[k].off);
            TEST_ASSERT_EQUAL_DOUBLE(wanted.until_s, h.column[k].until_s);
            until_s = fmin(until_s, wanted.until_s);
            to_the_end = to_the_end && !ends_it(&wanted);
            seen[wanted.verdict]++;
        }
        TEST_ASSERT_EQUAL_DOUBLE(until_s, h.until_s);
        TEST_ASSERT_EQUAL_INT(to_the_end, h.to_the_end);
        TEST_ASSERT_TRUE(to_the_end ? h.first == -1 : h.column[h.first].until_s == until_s);
        /* no column before h.first fails at this time */
        for (int k = 1; !to_the_end && k < h.first; k++) {
            TEST_ASSERT_TRUE(!ends_it(&h.column[k]) || h.column[k].until_s > until_s);
        }
        horizon_free(&h);
        for (int k = 1; k < COLUMNS; k++) {
            passages_free(&column[k].off);
        }
    }
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(seen[i] > 40);
    }
}

/* exp(z) without the terms after z^order: the factor by which a step of these methods changes x in x' = a x. */
static double factor(int order, double z) {
    double sum = 1.0;
    double next = 1.0;
    for (int k = 1; k <= order; k++) {
        next *= z / k;
        sum += next;
    }
    return sum;
}

/* Growth or decay x' = a x. The finer run uses `method` if its order is 4, else RK4. If both runs have order 4, the
 * estimated error is 16/15 of their difference. */
static void hold_growth(dice *d, wh_method method, int order) {
    const double size = dice_between(d, 0.05, 0.3);
    const int steps = (int)(dice_between(d, 3.0, 12.0) / size);
    const double z = dice_one_of(d, 2) == 0 ? size : -size;
    const double step_s = pow(10.0, dice_between(d, -4.0, 1.0));
    const double tolerance = pow(10.0, dice_between(d, -5.0, -2.0));
    char text[400];
    snprintf(text, sizeof text,
             "mechanism growth\nstate x [m]\nequation x' = %.17g [1/s]*x\n"
             "scene s { start x = 2 [m]; step %.17g [s]; until %.17g [s] }\n",
             z / step_s, step_s, (steps + 0.25) * step_s);
    derived made = derived_scene(text, "s");
    derived_expect(&made, text);
    made.image->settings.method = method;
    run_checks *v = run_checks_whole(made.image, &engine_double, NULL, NULL);
    const step_doubling *t = v->doubling;
    horizon h = horizon_of(t, tolerance);
    const double rough = factor(order, z);
    const double fine = factor(4, 0.5 * z);
    const double share = order == 4 ? 1.0 / (1.0 - 1.0 / 16.0) : 1.0;
    const double end = 2.0 * pow(fine, 2.0 * (double)made.image->steps);
    const double range = fabs(end - 2.0);
    double until_s = (double)INFINITY;
    double most = 0.0;
    for (int i = 0; i <= (int)made.image->steps; i++) {
        const double off = share * 2.0 * fabs(pow(rough, i) - pow(fine, 2.0 * i));
        most = fmax(most, off);
        if (off > tolerance * range && isinf(until_s)) {
            until_s = (i - 1) * ratio_times(1, made.image->step);
        }
    }
    TEST_ASSERT_EQUAL_INT(2, t->columns);
    TEST_ASSERT_EQUAL_UINT64(2, t->each);
    TEST_ASSERT_EQUAL_INT(order == 4 ? (int)method : (int)WH_RK4, t->finer.settings.method);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12 * step_s, 0.5 * step_s, t->finer.step_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * range, fmin(2.0, end), t->column[1].low);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * range, fmax(2.0, end), t->column[1].high);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4 * most + 1e-13 * range, most, h.column[1].off);
    if (isinf(until_s)) {
        TEST_ASSERT_TRUE(h.to_the_end && h.until_s == t->end_s);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * t->end_s, (double)made.image->steps * step_s, t->end_s);
    } else {
        TEST_ASSERT_EQUAL_INT(HORIZON_UNTIL, h.column[1].verdict);
        TEST_ASSERT_DOUBLE_WITHIN(1.01 * step_s, until_s, h.until_s);
    }
    horizon_free(&h);
    run_checks_close(v);
    derived_free(&made);
}

TEST(horizon, twins_of_growths_and_decays) {
    dice d = dice_of("horizon growths", 2314);
    for (unsigned k = 0; k < few_or_all(40, 400); k++) {
        static const wh_method methods[] = {WH_RK4, WH_EULER, WH_HEUN, WH_RK38};
        static const int orders[] = {4, 1, 2, 4};
        hold_growth(&d, methods[k % 4], orders[k % 4]);
    }
}

/* Two springs, of which one is soon wrong and the other accurate to the end, and a third one at rest. */
static const char springs[] =
    "mechanism springs\n"
    "coordinate a [m]\ncoordinate b [mm]\ncoordinate c [m]\n"
    "T = 1 [kg]*(a'^2 + b'^2 + c'^2)/2\n"
    "V = 2500 [N/m]*a^2/2 + 1 [N/m]*b^2/2 + 1 [N/m]*c^2/2\n"
    "scene s { start a = 1 [m], b = 1 [mm]; step 10 [ms]; until 4 [s] }\n";

static void expect_csv_row(const horizon *h, int k, char *line) {
    static const char *const words[] = {"end", "until", "still", "rounding"};
    const record_column *c = &h->of->shape->column[k];
    char head[80];
    snprintf(head, sizeof head, "%s%s,%s,%s,", c->name, c->primes > 0 ? "'" : "", c->unit->shown,
             words[h->column[k].verdict]);
    TEST_ASSERT_EQUAL_STRING_LEN(head, line, strlen(head));
    char *at = line + strlen(head);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14 * h->column[k].until_s, h->column[k].until_s, strtod(at, &at));
    TEST_ASSERT_EQUAL_DOUBLE(h->column[k].range, strtod(at + 1, &at));
    TEST_ASSERT_EQUAL_DOUBLE(h->column[k].off, strtod(at + 1, &at));
    TEST_ASSERT_EQUAL_STRING("\r\n", at);
}

static void expect_csv(const horizon *h) {
    char line[300];
    FILE *both = tmpfile();
    TEST_ASSERT_NOT_NULL(both);
    horizon_write(both, h);
    rewind(both);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    TEST_ASSERT_EQUAL_STRING("column,unit,verdict,until,range,off\r\n", line);
    for (int k = 1; k < h->of->columns; k++) {
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
        expect_csv_row(h, k, line);
    }
    TEST_ASSERT_NULL(fgets(line, sizeof line, both));
    fclose(both);
}

/* The rest of the table's row for a column. */
static const char *behind(const char *told, const char *name) {
    char start[40];
    snprintf(start, sizeof start, "\n  %-16s ", name);
    const char *at = strstr(told, start);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, start);
    return at + strlen(start);
}

static void expect_words(const run_checks *v, const horizon *h) {
    static char told[4000];
    FILE *out = fmemopen(told, sizeof told, "w");
    TEST_ASSERT_NOT_NULL(out);
    horizon_print(out, h, v->books, &v->balance);
    fclose(out);
    TEST_ASSERT_NOT_NULL(strstr(told, "step 0.01 s, 400 steps to t = 4 s\n"));
    TEST_ASSERT_NOT_NULL(strstr(told, "compensated, double, step 0.005 s\n"));
    double number[2];
    const char *at = said_number(behind(told, "a"), &number[0]);
    at = said_words(said_number(said_words(at, "error at most"), &number[1]), "m; range");
    TEST_ASSERT_DOUBLE_WITHIN(0.05 * number[1], 0.01 * h->column[1].range, number[1]);
    said_words(said_number(at, &number[1]), "m\n");
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, h->column[1].until_s, number[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * h->column[1].range, h->column[1].range, number[1]);
    at = said_words(said_words(behind(told, "b"), "to the end"), "error");
    at = said_words(said_number(at, &number[0]), "of its range of");
    said_words(said_number(at, &number[1]), "mm\n");
    TEST_ASSERT_DOUBLE_WITHIN(1e-2 * number[0], h->column[2].off / h->column[2].range, number[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * h->column[2].range, h->column[2].range, number[1]);
    TEST_ASSERT_EQUAL_INT(0,
                          strncmp(behind(told, "c"), "to the end      constant in this run\n", 33));
    TEST_ASSERT_EQUAL_INT(
        0, strncmp(behind(told, "c'"), "to the end      constant in this run\n", 33));
    at = strstr(told, "trusted until t = ");
    TEST_ASSERT_NOT_NULL(at);
    char name[20];
    at = said_words(said_number(said_words(at, "trusted until t = "), &number[0]), "s of");
    at = said_words(said_number(at, &number[1]), "s:");
    said_words(said_word(said_words(at, "after that the error of"), name, sizeof name),
               "exceeds 0.01 of its range\n");
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, h->until_s, number[0]);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, number[1]);
    TEST_ASSERT_EQUAL_STRING(h->of->shape->column[h->first].primes == 0 ? "a" : "a'", name);
    TEST_ASSERT_NOT_NULL(strstr(
        told,
        "after that no single coordinate is accurate; only the balances are meaningful, to t = 4 s:\n  energy: "));
}

/* The fast spring has w h = 1/2 and an amplitude of 1 m. Its phase lags by w (w h)^4/120 = 0.026 rad per second, so
 * after 0.77 s the error can be 0.02 m, a hundredth of the range. The error reaches this value half a swing later
 * at the latest. */
TEST(horizon, words_and_rows) {
    derived made = derived_scene(springs, "s");
    derived_expect(&made, springs);
    run_checks *v = run_checks_whole(made.image, &engine_double, NULL, NULL);
    const step_doubling *t = v->doubling;
    horizon h = horizon_of(t, 0.01);
    TEST_ASSERT_TRUE(h.first > 0 && t->shape->column[h.first].unknown == 0);
    TEST_ASSERT_TRUE(h.until_s > 0.68 && h.until_s < 0.85);
    expect_csv(&h);
    expect_words(v, &h);
    horizon_free(&h);
    run_checks_close(v);
    derived_free(&made);
}

/* === suite trust_kinks ======================================================================== */
/* The time until which a run with a kinked force is accurate. A body is on a spring, and a second spring acts beyond
 * a gap. The motions between the kinks are sines, so the reference is a closed form. A kink destroys the order of
 * the method, and two runs may have the same error. */

#define TURN 6.28318530717958648

typedef struct two_springs {
    double soft; /* stiffness of the spring, N/m */
    double hard; /* further stiffness beyond the gap, N/m */
    double gap_m;
    double x_m;
    double v_mps;
} two_springs;

static void go_on(two_springs *s, double span_s) {
    while (span_s > 0.0) {
        const bool beyond = s->x_m > s->gap_m || (s->x_m == s->gap_m && s->v_mps > 0.0);
        const double w = sqrt(beyond ? s->soft + s->hard : s->soft);
        const double middle = beyond ? s->hard * s->gap_m / (w * w) : 0.0;
        const double size = hypot(s->x_m - middle, s->v_mps / w);
        const double phase = atan2(-s->v_mps / w, s->x_m - middle);
        const double share = (s->gap_m - middle) / size;
        double wait_s = (double)INFINITY;
        if (fabs(share) < 1.0) {
            const double at = beyond ? acos(share) : -acos(share);
            const double turns = ceil((phase + 1e-9 - at) / TURN);
            wait_s = (at + turns * TURN - phase) / w;
        }
        const double part_s = fmin(wait_s, span_s);
        s->v_mps = -w * size * sin(phase + w * part_s);
        s->x_m = wait_s <= span_s ? s->gap_m : middle + size * cos(phase + w * part_s);
        span_s -= part_s;
    }
}

/* The time at which the error of x or x' first exceeds a thousandth of its range; infinity if never. */
static double right_until_s(const two_springs *start, const char *csv, double *most) {
    enum { ROWS_MOST = 400 };
    static double was[ROWS_MOST][3]; /* time, x and x' */
    static double is[2][ROWS_MOST];
    two_springs s = *start;
    int n = 0;
    for (const char *row = csv; n < ROWS_MOST && (row = said_row(row, 3, was[n])) != NULL; n++) {
        go_on(&s, n == 0 ? 0.0 : was[n][0] - was[n - 1][0]);
        is[0][n] = s.x_m;
        is[1][n] = s.v_mps;
    }
    double first_s = (double)INFINITY;
    *most = 0.0;
    for (int c = 0; c < 2; c++) {
        double low = is[c][0];
        double high = is[c][0];
        for (int k = 0; k < n; k++) {
            low = fmin(low, is[c][k]);
            high = fmax(high, is[c][k]);
        }
        for (int k = 0; k < n; k++) {
            const double off = fabs(was[k][1 + c] - is[c][k]) / (high - low);
            *most = fmax(*most, off);
            first_s = off > 1e-3 ? fmin(first_s, was[k][0]) : first_s;
        }
    }
    return first_s;
}

TEST(trust_kinks, trust_near_a_kink) {
    static const char *const methods[] = {"rk4", "rk4", "rk38", "nystroem4", "nystroem5"};
    dice d = dice_of("trust beside a kink", 7103);
    const unsigned cases = dice_cases(few_or_all(usual_or(60, 15), 400));
    unsigned ended = 0;
    unsigned late = 0;
    for (unsigned i = 0; i < cases; i++) {
        static said what;
        char text[700];
        char every[40];
        const two_springs s = {.soft = pow(10.0, dice_between(&d, -0.5, 1.0)),
                               .hard = pow(10.0, dice_between(&d, 0.0, 2.0)),
                               .gap_m = dice_between(&d, -0.5, 0.8),
                               .x_m = dice_between(&d, -2.0, 2.0),
                               .v_mps = dice_between(&d, -1.0, 1.0)};
        const double step_s = pow(10.0, dice_between(&d, -1.4, -0.3)) / sqrt(s.soft + s.hard);
        const int between = 1 + (int)dice_one_of(&d, 4);
        const double end_s = step_s * between * 100;
        snprintf(
            text, sizeof text,
            "mechanism kink\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
            "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*max(x - %.17g [m], 0 [m])^2/2\n"
            "scene s { start x = %.17g [m]; start x' = %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
            s.soft, s.hard, s.gap_m, s.x_m, s.v_mps, step_s, end_s);
        snprintf(every, sizeof every, "%.17gs", step_s * between);
        COMMAND_SAY(command_run, &what, model_keep(text), "--csv", "-", "--every", every,
                    "--method", methods[i % 5], "--number", i / 5 % 2 == 0 ? "double" : "float");
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        double most;
        const double truth_s = right_until_s(&s, what.out, &most);
        const char *line = strstr(what.err, "\ntrusted");
        TEST_ASSERT_NOT_NULL_MESSAGE(line, what.err);
        const char *at = strstr(line, "until t = ");
        const double told_s = at != NULL                           ? strtod(at + 10, NULL)
                              : strstr(line, "to the end") != NULL ? end_s
                                                                   : 0.0;
        TEST_ASSERT_FALSE_MESSAGE(told_s >= end_s && most > 3e-3, text);
        ended += truth_s < end_s ? 1U : 0U;
        late += told_s > 1.3 * fmin(truth_s, end_s) + step_s * between ? 1U : 0U;
    }
    model_drop();
    TEST_ASSERT_TRUE(ended > cases / 10);
    TEST_ASSERT_TRUE(late <= cases / 100);
}

/* The time until which matrix steps are accurate, for random linear mechanisms. Exact matrices must be accurate to
 * the end with any step; Runge-Kutta matrices until the reference shows a difference. */
typedef struct way {
    const char *words;
    horizons_setting how;
} way;

static const way exact[] = {
    {"double", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_EXACT}},
    {"double compensated", {&engine_double, true, WH_RK4, TABLES_NONE, MATRIX_EXACT}},
    {"float", {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_EXACT}},
    {"float compensated", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_EXACT}}};
static const way by_rk4[] = {
    {"rk4, double", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_RK4}},
    {"rk4, float compensated", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_RK4}}};
enum {
    EXACT = sizeof exact / sizeof exact[0],
    BY_RK4 = sizeof by_rk4 / sizeof by_rk4[0],
    STEPS = 3
};
static const int step_ms[STEPS] = {2, 20, 100};

/* Draws linear mechanism n with one to four coordinates, with coupled masses if n is odd, and runs it for 2 s. */
static horizons one_of(uint64_t *seed, unsigned n, int ms, horizons_setting how) {
    char text[4000];
    linear of;
    linear_draw(seed, 1 + (int)(n % 4), (linear_kind){n % 3 == 0 ? 3 : 0, n % 2 != 0}, text,
                sizeof text - 40, &of);
    char *step = strstr(text, "step ");
    TEST_ASSERT_NOT_NULL(step);
    snprintf(step, 40, "step %d [ms]; until 2 [s] }\n", ms);
    return horizons_of(text, "s", how, HORIZON_TOLERANCE);
}

TEST(trust_kinks, exact_steps_are_trusted) {
    uint64_t seed = 1408;
    double worst = 0.0;
    for (unsigned n = 0; n < few_or_all(12, 48); n++) {
        const way *w = &exact[n % EXACT];
        horizons h = one_of(&seed, n, step_ms[n / EXACT % STEPS], w->how);
        TEST_ASSERT_TRUE_MESSAGE(h.true_until_s >= h.doubling->end_s, w->words);
        TEST_ASSERT_TRUE_MESSAGE(h.estimate.to_the_end, w->words);
        for (int k = 1; k < h.doubling->columns && w->how.kind == &engine_double; k++) {
            worst = fmax(worst, h.estimate.column[k].off / h.estimate.column[k].range);
        }
        horizons_free(&h);
    }
    printf("  in double off by at most %.1e of the range\n", worst);
    TEST_ASSERT_TRUE(worst > 0.0 && worst < 1e-11);
}

/* Two undamped masses on springs. The phases of a run deviate more and more from the exact ones. The estimated time
 * must agree with the time at which the true error becomes too large. */
TEST(trust_kinks, trusted_time_of_coarse_steps) {
    dice d = dice_of("trust matrix", 1409);
    int ended = 0;
    const unsigned cases = dice_cases(few_or_all(8, 24));
    for (unsigned n = 0; n < cases; n++) {
        const way *w = &by_rk4[n % BY_RK4];
        char text[400];
        snprintf(text, sizeof text,
                 "mechanism pair\ncoordinate x [m]\ncoordinate y [m]\n"
                 "T = %.3g [kg]*x'^2/2 + %.3g [kg]*y'^2/2\n"
                 "V = %.3g [N/m]*x^2/2 + %.3g [N/m]*(x - y)^2/2\n"
                 "scene s { start x = 1 [m]; step %u [ms]; until 100 [s] }\n",
                 dice_between(&d, 1.0, 4.0), dice_between(&d, 1.0, 4.0), dice_between(&d, 1.0, 9.0),
                 dice_between(&d, 1.0, 9.0), 50 + dice_one_of(&d, 60));
        horizons h = horizons_of(text, "s", w->how, HORIZON_TOLERANCE);
        TEST_ASSERT_TRUE_MESSAGE(fabs(h.estimate.until_s - h.true_until_s) <=
                                     0.1 * h.true_until_s + 1.5 * h.look_s,
                                 text);
        ended += h.true_until_s < h.doubling->end_s ? 1 : 0;
        horizons_free(&h);
    }
    TEST_ASSERT_TRUE(ended > 0 && ended < (int)cases);
}

/* === suite twins ============================================================================== */
/* Step doubling (host/check/step_doubling.h): the settings of the finer run, the ends of both runs, and the report,
 * for oscillators with a known motion. */

enum { TEXT = 600 };

/* A mass on a spring, from rest at x = a: x = a cos(w t). The unit of x may differ from SI. */
static void write_spring(char *text, const char *unit, double a, double w, double step_s,
                         double until_s) {
    snprintf(text, TEXT,
             "mechanism m\ncoordinate x [%s]\nparameter k = %.17g [N/m]\nT = 1 [kg]*x'^2/2\n"
             "V = k*x^2/2\nscene s { start x = %.17g [m]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             unit, w * w, a, step_s, until_s);
}

static run_checks *twins_of(const motion *m, const image *im) {
    return run_checks_whole(im, m->kind, NULL, NULL);
}

/* The finer run must have exactly half the step, whatever fraction the step is. The step of an exact matrix must not
 * be halved. */
TEST(doubling, the_finer_run) {
    dice d = dice_of("twins", 31);
    for (unsigned method = 0; method < WH_METHODS; method++) {
        for (unsigned of = 0; of < 3U; of++) {
            char text[TEXT];
            motion m;
            const image_matrix_of matrix = of == 0   ? MATRIX_NONE
                                           : of == 1 ? MATRIX_RK4
                                                     : MATRIX_EXACT;
            if (of > 0 && method != (unsigned)WH_METHOD_DEFAULT) {
                continue;
            }
            write_spring(text, "m", 1.0, 2.0, 1e-3, 3e-3);
            motion_open_text(&m, text,
                             (stepping){.kind = &engine_double,
                                        .method = (wh_method)method,
                                        .compensated = of == 2,
                                        .matrix = matrix});
            image im = *m.image;
            im.finer = m.image;
            const whole_ratio steps[] = {im.step,
                                         {1U + dice_one_of(&d, 1000), 1U + dice_one_of(&d, 1000)},
                                         {2U * (1U + dice_one_of(&d, 1000)), UINT64_C(1) << 61},
                                         {3, UINT64_C(1) << 58}};
            for (unsigned k = 0; k < sizeof steps / sizeof steps[0]; k++) {
                im.step = steps[k];
                run_checks *checks = twins_of(&m, &im);
                const step_doubling *t = checks->doubling;
                const bool halves = matrix != MATRIX_EXACT;
                const int order = wh_methods[method].order;
                const bool own = matrix == MATRIX_NONE && order >= 4;
                TEST_ASSERT_EQUAL(halves ? 2 : 1, t->each);
                TEST_ASSERT_TRUE(t->finer.settings.compensated);
                if (halves) {
                    TEST_ASSERT_EQUAL(MATRIX_NONE, t->finer.settings.matrix);
                    TEST_ASSERT_NULL(t->finer.list[IMAGE_MATRIX]);
                    TEST_ASSERT_EQUAL(own ? method : (unsigned)WH_RK4, t->finer.settings.method);
                    const long double twice = 2.0L * (long double)t->finer.step.numerator *
                                              (long double)steps[k].denominator;
                    TEST_ASSERT_TRUE(twice == (long double)t->finer.step.denominator *
                                                  (long double)steps[k].numerator);
                    TEST_ASSERT_EQUAL_DOUBLE(0.5 * (double)steps[k].numerator /
                                                 (double)steps[k].denominator,
                                             t->finer.step_s);
                    TEST_ASSERT_EQUAL_UINT64(2U * im.steps, t->finer.steps);
                }
                TEST_ASSERT_EQUAL_DOUBLE(halves && own ? 1.0 / (1.0 - pow(2.0, -order)) : 1.0,
                                         t->left_out);
                run_checks_close(checks);
            }
            motion_close(&m);
        }
    }
}

TEST(doubling, plain_settings) {
    for (unsigned i = 0; i < 24U; i++) {
        const image_settings of = {.tables = i % 2U == 0 ? TABLES_NONE : TABLES_CUBIC,
                                   .cells = i % 2U == 0 ? 0 : 64,
                                   .compensated = i / 2U % 2U == 1,
                                   .matrix = i / 4U % 3U == 0   ? MATRIX_NONE
                                             : i / 4U % 3U == 1 ? MATRIX_RK4
                                                                : MATRIX_EXACT,
                                   .method = i < 12U ? WH_RK4 : WH_LEAPFROG};
        image_settings plain;
        const bool sums = of.compensated || of.matrix == MATRIX_EXACT;
        const bool other = image_settings_finer(&of, &plain);
        TEST_ASSERT_EQUAL(i % 2U == 1 || sums != of.compensated, other);
        TEST_ASSERT_EQUAL(TABLES_NONE, plain.tables);
        TEST_ASSERT_EQUAL(0, plain.cells);
        TEST_ASSERT_EQUAL(sums, plain.compensated);
        TEST_ASSERT_TRUE(plain.matrix == of.matrix && plain.method == of.method);
    }
}

/* The reported lowest and highest values must be those of the motion. The reported difference at the end must be that
 * of two separate runs. The round-off of a rate must count in its coordinate for the whole time. */
TEST(doubling, reported_ranges_and_differences) {
    static const struct {
        const char *name;
        double per_m;
    } units[] = {{"m", 1.0}, {"mm", 1e3}, {"km", 1e-3}};
    dice d = dice_of("twins", 32);
    for (unsigned i = 0; i < 12U; i++) {
        char text[TEXT];
        motion m;
        const double a = dice_between(&d, 0.5, 2.0);
        const double w = dice_between(&d, 5.0, 20.0);
        const double per_m = units[i % 3U].per_m;
        write_spring(text, units[i % 3U].name, a, w, 1e-3, 1.5);
        motion_open_text(
            &m, text,
            (stepping){.kind = i % 2U == 0 ? &engine_double : &engine_float, .method = WH_RK4});
        run_checks *checks = twins_of(&m, m.image);
        const step_doubling *t = checks->doubling;
        TEST_ASSERT_EQUAL(WH_OK, t->status);
        TEST_ASSERT_EQUAL_DOUBLE(1.5, t->end_s);
        TEST_ASSERT_TRUE(t->finer_failed_s < 0.0 && t->overrun_s < 0.0 && !checks->interrupted);
        TEST_ASSERT_EQUAL_INT(3, t->columns);
        const step_doubling_column *x = &t->column[1];
        const step_doubling_column *v = &t->column[2];
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * a * per_m, -a * per_m, x->low);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * a * per_m, a * per_m, x->high);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * a * w, -a * w, v->low / per_m);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * a * w, a * w, v->high / per_m);
        motion_step(&m, 1500);
        const double off = fabs(motion_value(&m, "x") - a * cos(1.5 * w)) * per_m;
        TEST_ASSERT_DOUBLE_WITHIN(0.1 * off + 1e-12 * a * per_m, off, x->last * t->left_out);
        const double unit = 0.5 * 0x1p-52;
        const double x_size = fmax(fabs(x->low), fabs(x->high));
        const double v_size = fmax(fabs(v->low), fabs(v->high));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * x->rounding, v->rounding * t->end_s + unit * x_size,
                                  x->rounding);
        /* the rest is the acceleration's round-off: some units in the last place of its largest value */
        const double pull = v->rounding - unit * v_size;
        TEST_ASSERT_TRUE(pull > 0.5 * unit * a * w * w * per_m * t->end_s);
        TEST_ASSERT_TRUE(pull < 20.0 * unit * a * w * w * per_m * t->end_s);
        run_checks_close(checks);
        motion_close(&m);
    }
}

/* An interrupt must end both runs before the next step. */
TEST(doubling, an_end_from_outside) {
    char text[TEXT];
    motion m;
    write_spring(text, "m", 1.0, 3.0, 1e-3, 1.2);
    motion_open_text(&m, text, IN_DOUBLE);
    for (int i = 0; i < 2; i++) {
        interrupted = i;
        run_checks *checks = twins_of(&m, m.image);
        const step_doubling *t = checks->doubling;
        TEST_ASSERT_EQUAL(i == 1, checks->interrupted);
        TEST_ASSERT_EQUAL_DOUBLE(i == 1 ? 0.0 : 1.2, t->end_s);
        run_checks_close(checks);
    }
    interrupted = 0;
    motion_close(&m);
}

/* x'' = x^3 from x = s, x' = s^2/sqrt(2) has the solution x = s/(1 - s t/sqrt(2)), infinite at a known time. The
 * report must end there. */
TEST(doubling, runs_that_fail) {
    dice d = dice_of("twins", 33);
    for (unsigned i = 0; i < 6U; i++) {
        char text[TEXT];
        motion m;
        const double s = dice_between(&d, 1.0, 3.0);
        const double end_s = sqrt(2.0) / s;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nparameter k = 1 [N/m^3]\nT = 1 [kg]*x'^2/2\n"
                 "V = -k*x^4/4\nscene s { start x = %.17g [m], x' = %.17g [m/s]\nstep 1 [ms]\n"
                 "until 9 [s] }\n",
                 s, s * s / sqrt(2.0));
        motion_open_text(&m, text, i % 2U == 0 ? IN_DOUBLE : IN_FLOAT);
        run_checks *checks = twins_of(&m, m.image);
        const step_doubling *t = checks->doubling;
        TEST_ASSERT_NOT_EQUAL(WH_OK, t->status);
        TEST_ASSERT_TRUE(t->end_s > 0.99 * end_s && t->end_s < 1.05 * end_s + 0.02);
        run_checks_close(checks);
        motion_close(&m);
    }
}

/* The predicted work of step doubling must be the counted work, except for the first steps and the samples of the
 * state. */
TEST(doubling, predicted_work) {
    dice d = dice_of("twins", 34);
    for (unsigned i = 0; i < 2U * WH_METHODS; i++) {
        char text[TEXT];
        motion m;
        const wh_method method = (wh_method)(i / 2U);
        const uint64_t steps = 200U + dice_one_of(&d, 800);
        write_spring(text, "m", 1.0, dice_between(&d, 1.0, 10.0), 1e-3, 1e-3 * (double)steps);
        motion_open_text(
            &m, text,
            (stepping){.kind = i % 2U == 0 ? &engine_double : &engine_float, .method = method});
        const double told = step_doubling_operations(m.image);
        const int own = wh_methods[method].order >= 4 ? (int)method : (int)WH_METHOD_DEFAULT;
        const int methods[] = {(int)method, own, own}; /* the finer run has two steps */
        double counted = 0.0;
        for (int k = 0; k < 3; k++) {
            motion run;
            motion_open_text(&run, text,
                             (stepping){.kind = &engine_double, .method = (wh_method)methods[k]});
            const uint64_t before = engine_operations;
            motion_step(&run, steps);
            counted += (double)(engine_operations - before);
            motion_close(&run);
        }
        TEST_ASSERT_TRUE(told >= 0.99 * counted && told <= 1.02 * counted);
        motion_close(&m);
    }
}
