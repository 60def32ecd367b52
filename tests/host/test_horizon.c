/* test_horizon.c: until when a run is right, part by part: when a difference passed a level, held to all that was entered;
 * the verdict on drawn columns, held to its definition; twins of growths and decays whose steps multiply by a known
 * number, held to powers of it; and words and rows, read again. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "host/check/horizon.h"

#include "unity.h"

void suite_horizon(void);

/* --- passages --------------------------------------------------------------------------------------------*/

enum { ENTERED = 300 };

/* The time of the first that is more than `level`. */
static double first_above_s(const double *time_s, const double *size, int count, double level) {
    for (int i = 0; i < count; i++) {
        if (!(size[i] <= level)) {
            return time_s[i];
        }
    }
    return (double)INFINITY;
}

/* Sizes that rise, fall, stay and end: a level is passed between the first size above it and the first that is so by
 * more than the grain. */
static void test_levels_and_when_they_were_passed(void) {
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

/* --- verdicts --------------------------------------------------------------------------------------------*/

enum { COLUMNS = 6, LOOKS = 40 };

typedef struct drawn_column {
    double low, high, rounding, one, alike;
    bool has_rate;
    int place;
    double time_s[LOOKS];
    double off[LOOKS];
    int looks;
} drawn_column;

/* Moves or not, of any size, more or less off; differences told apart by more than the grain. */
static drawn_column draw_column(dice *d) {
    drawn_column c = {.low = dice_between(d, -5.0, 5.0)};
    const bool moves = dice_one_of(d, 3) > 0;
    c.high = c.low + (moves ? pow(10.0, dice_between(d, -7.0, 2.0)) : 0.0);
    c.rounding = dice_one_of(d, 2) == 0 ? 0.0 : pow(10.0, dice_between(d, -9.0, -2.0));
    if (dice_one_of(d, 4) == 0) { /* about zero */
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

/* Stays where it is, as horizon.c's head has it. */
static bool keeps_its_place(const drawn_column *c) {
    const double moved = c->high - c->low;
    const double size = fmax(fabs(c->low), fabs(c->high));
    return 1e9 * moved <= fmax(size, c->one) || 1e3 * moved <= c->alike;
}

/* As horizon.h has it. */
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
        made.verdict = !keeps && c->rounding > 8.0 * tolerance * made.range ? HORIZON_NOT_TOLD
                       : still                                              ? HORIZON_STILL
                                                                            : HORIZON_TO_THE_END;
    } else if (moved <= 8.0 * c->rounding && isfinite(made.off) && keeps) {
        made.verdict = HORIZON_ROUNDING;
    } else {
        made.verdict = HORIZON_UNTIL;
    }
    made.until_s = made.verdict == HORIZON_UNTIL      ? made.until_s
                   : made.verdict == HORIZON_NOT_TOLD ? 0.0
                                                      : end_s;
    return made;
}

static bool ends_it(const horizon_column *c) {
    return c->verdict == HORIZON_UNTIL || c->verdict == HORIZON_NOT_TOLD;
}

static void test_verdicts_on_drawn_columns(void) {
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
        for (int k = 1; !to_the_end && k < h.first; k++) { /* of several the first */
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

/* --- twins -----------------------------------------------------------------------------------------------*/

/* exp() cut off behind z^order: what a step of these methods multiplies x' = a x by. */
static double factor(int order, double z) {
    double sum = 1.0;
    double next = 1.0;
    for (int k = 1; k <= order; k++) {
        next *= z / k;
        sum += next;
    }
    return sum;
}

/* The finer run takes the method where its order is 4, else RK4; its own error is left out of what the two differ by
 * where they share it. */
static void hold_growth(dice *d, wh_method method, int order, bool events) {
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
    const step_doubling_wish wish = {
        .image = made.image, .kind = &engine_double, .plain = made.image, .books = events};
    step_doubling *t = step_doubling_run(&wish);
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
    step_doubling_free(t);
    derived_free(&made);
}

static void test_twins_of_growths_and_decays(void) {
    dice d = dice_of("horizon growths", 2314);
    for (unsigned k = 0; k < few_or_all(40, 400); k++) {
        static const wh_method methods[] = {WH_RK4, WH_EULER, WH_HEUN, WH_RK38};
        static const int orders[] = {4, 1, 2, 4};
        hold_growth(&d, methods[k % 4], orders[k % 4], k % 8 < 4);
    }
}

/* --- words and rows ----------------------------------------------------------------------------------------*/

/* Two springs of which one is soon off, one is right to the end, and a third that stands still. */
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

/* What stands behind a column's name in the table. */
static const char *behind(const char *told, const char *name) {
    char start[40];
    snprintf(start, sizeof start, "\n  %-16s ", name);
    const char *at = strstr(told, start);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, start);
    return at + strlen(start);
}

static void expect_words(const horizon *h) {
    static char told[4000];
    FILE *out = fmemopen(told, sizeof told, "w");
    TEST_ASSERT_NOT_NULL(out);
    horizon_print(out, h);
    fclose(out);
    TEST_ASSERT_NOT_NULL(strstr(told, "step 0.01 s, 400 steps to t = 4 s\n"));
    TEST_ASSERT_NOT_NULL(strstr(told, "compensated, double, step 0.005 s\n"));
    double number[2];
    const char *at = said_number(behind(told, "a"), &number[0]);
    said_words(said_number(said_words(at, "of its range,"), &number[1]), "m,");
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, h->column[1].until_s, number[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * h->column[1].range, h->column[1].range, number[1]);
    at = said_words(said_words(behind(told, "b"), "to the end"), "off by");
    at = said_words(said_number(at, &number[0]), "of its range,");
    said_words(said_number(at, &number[1]), "mm\n");
    TEST_ASSERT_DOUBLE_WITHIN(1e-2 * number[0], h->column[2].off / h->column[2].range, number[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * h->column[2].range, h->column[2].range, number[1]);
    TEST_ASSERT_EQUAL_INT(0, strncmp(behind(told, "c"), "to the end      it does not move\n", 33));
    TEST_ASSERT_EQUAL_INT(0, strncmp(behind(told, "c'"), "to the end      it does not move\n", 33));
    at = strstr(told, "trusted until t = ");
    TEST_ASSERT_NOT_NULL(at);
    char name[20];
    at = said_words(said_number(said_words(at, "trusted until t = "), &number[0]), "s of");
    at = said_words(said_number(at, &number[1]), "s:");
    said_words(said_word(at, name, sizeof name), "is off first\n");
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, h->until_s, number[0]);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, number[1]);
    TEST_ASSERT_EQUAL_STRING(h->of->shape->column[h->first].primes == 0 ? "a" : "a'", name);
    TEST_ASSERT_NOT_NULL(
        strstr(told, "behind its end no single value of a coordinate is to be relied on, "
                     "but what the books keep, to t = 4 s:\n  energy: "));
}

/* The fast spring, at w h = 1/2, lags by w (w h)^4/120 = 0.026 rad a second: off by a hundredth of its range, 2 m, when
 * that has made 0.02 rad, 0.77 s, or up to half a swing later. */
static void test_words_and_rows(void) {
    derived made = derived_scene(springs, "s");
    derived_expect(&made, springs);
    const step_doubling_wish wish = {
        .image = made.image, .kind = &engine_double, .plain = made.image, .books = true};
    step_doubling *t = step_doubling_run(&wish);
    horizon h = horizon_of(t, 0.01);
    TEST_ASSERT_TRUE(h.first > 0 && t->shape->column[h.first].unknown == 0);
    TEST_ASSERT_TRUE(h.until_s > 0.68 && h.until_s < 0.85);
    expect_csv(&h);
    expect_words(&h);
    horizon_free(&h);
    step_doubling_free(t);
    step_doubling_free(NULL);
    derived_free(&made);
}

void suite_horizon(void) {
    RUN_TEST(test_levels_and_when_they_were_passed);
    RUN_TEST(test_verdicts_on_drawn_columns);
    RUN_TEST(test_twins_of_growths_and_decays);
    RUN_TEST(test_words_and_rows);
}
