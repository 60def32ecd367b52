/* test_watched.c: the books beside a run and what it is watched by (host/run/books.h, watch.h), of runs that are made up: any
 * sequence of states, no motion. Each number that is kept is what formulas make of all the states at once: energies, work by
 * Simpson's rule, momenta, spreads by two passes, ranges, records, and what the slopes lead to. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "host/base/room.h"
#include "host/run/belief.h"
#include "host/run/watch.h"
#include "made_run.h"
#include "unity.h"

void suite_watched(void);

static dice die;

static void expect_near(double wanted, double is, double size, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(wanted - is) <= 1e-11 * (fabs(wanted) + size), what);
}

/* Eight standard deviations' root, by two passes. */
static double swing_of(double (*of)(const double *), uint64_t count) {
    double mean = 0.0;
    double squares = 0.0;
    for (uint64_t k = 0; k < count; k++) {
        mean += of(made_run.state[k]) / (double)count;
    }
    for (uint64_t k = 0; k < count; k++) {
        squares += (of(made_run.state[k]) - mean) * (of(made_run.state[k]) - mean);
    }
    return sqrt(8.0 * squares / (double)count);
}

static double rate_x(const double *s) { return s[VX]; }
static double rate_y(const double *s) { return s[VY]; }

static double larger(double a, double b) { return a > b ? a : b; }

/* Simpson over each pair of steps, and a trapezoid over what is left. */
static double work_to(uint64_t end, int which) {
    double sum = 0.0;
    for (uint64_t k = 0; k + 2 <= end; k += 2) {
        sum += made_run.step_s / 3.0 *
               (made_run_power(made_run.state[k], which) +
                4.0 * made_run_power(made_run.state[k + 1], which) +
                made_run_power(made_run.state[k + 2], which));
    }
    if (end % 2 == 1) {
        sum += made_run.step_s / 2.0 *
               (made_run_power(made_run.state[end - 1], which) +
                made_run_power(made_run.state[end], which));
    }
    return sum;
}

static double left_at(uint64_t end) {
    return made_run_energy(made_run.state[end]) - made_run_energy(made_run.state[0]) -
           work_to(end, 0) + work_to(end, 1);
}

/* Simpson's rule less the trapezoids'; where that is more than a tenth of it, by how much the powers change. */
static double rule_off_to(uint64_t end) {
    double sum = 0.0;
    for (uint64_t k = 0; k + 2 <= end; k += 2) {
        for (int which = 0; which < 2; which++) {
            const double a = made_run_power(made_run.state[k], which);
            const double b = made_run_power(made_run.state[k + 1], which);
            const double c = made_run_power(made_run.state[k + 2], which);
            const double trapezoids = made_run.step_s * (a + 2.0 * b + c) / 2.0;
            const double simpson = made_run.step_s * (a + 4.0 * b + c) / 3.0;
            const double change = made_run.step_s * (fabs(b - a) + fabs(c - b)) / 2.0;
            const double off = fabs(simpson - trapezoids);
            sum += off > 0.1 * change ? change : off;
        }
    }
    return sum;
}

static void expect_books(const books *b) {
    const uint64_t end = made_run.at;
    const double *now = made_run.state[end];
    const double *first = made_run.state[0];
    double size = 0.0;
    for (uint64_t k = 0; k <= end; k++) {
        const double *s = made_run.state[k];
        size = larger(size, fabs(made_run_kinetic(s) + made_run_odd(s)) + made_run_stored(s));
    }
    TEST_ASSERT_EQUAL_UINT64(end + 1, b->entries);
    expect_near((double)end * made_run.step_s, b->time_s, 0.0, "time");
    expect_near(made_run_kinetic(first) + made_run_odd(first), b->kinetic_J[0], size,
                "kinetic, start");
    expect_near(made_run_kinetic(now) + made_run_odd(now), b->kinetic_J[1], size, "kinetic, now");
    expect_near(made_run_kinetic(first), b->moving_J[0], size, "moving, start");
    expect_near(made_run_kinetic(now), b->moving_J[1], size, "moving, now");
    expect_near(made_run_stored(first), b->stored_J[0], size, "stored, start");
    expect_near(made_run_stored(now), b->stored_J[1], size, "stored, now");
    expect_near(made_run_energy(first), b->energy_J[0], size, "energy, start");
    expect_near(made_run_energy(now), b->energy_J[1], size, "energy, now");
    expect_near(work_to(end, 0), b->input_J, size, "input");
    expect_near(work_to(end, 1), b->loss_J, size, "loss");
    expect_near(size, b->size_J, 0.0, "size");
    expect_near(rule_off_to(end), b->rule_J, size, "rule");
    TEST_ASSERT_EQUAL(made_run.magnetic > 0.0, b->leans);

    double most = larger(swing_of(made_run_kinetic, end + 1), swing_of(made_run_stored, end + 1));
    for (int i = 0; i < 2; i++) {
        double drift = 0.0;
        double squares = 0.0;
        for (uint64_t k = 0; k <= end; k++) {
            const double own = made_run_momentum(made_run.state[k], i, false);
            drift = larger(drift, fabs(made_run_momentum(made_run.state[k], i, true) -
                                       made_run_momentum(first, i, true)));
            squares += own * own;
        }
        expect_near(made_run_momentum(first, i, true), b->momentum[i], 1.0, "momentum, start");
        expect_near(made_run_momentum(now, i, true), b->momentum_now[i], 1.0, "momentum, now");
        expect_near(drift, b->drift[i], 1.0, "drift");
        expect_near(squares, b->momentum_2[i], 1.0, "squares of momenta");
        TEST_ASSERT_TRUE(b->rate[i].pushed);
        most = larger(most, 0.5 * sqrt(squares / ((double)end + 1.0)) *
                                swing_of(i == 0 ? rate_x : rate_y, end + 1));
    }
    expect_near(most, books_swing_J(b), size, "swing");

    const book_account a = books_account(b);
    expect_near(left_at(end), a.left, size, "left over");
    expect_near(larger(fabs(work_to(end, 0)), fabs(work_to(end, 1))), a.largest, size, "largest");
    double jump = 0.0;
    double jump_s = 0.0;
    for (uint64_t k = 2; k <= end; k += 2) {
        const double change = left_at(k) - left_at(k - 2);
        if (fabs(change) > fabs(jump)) {
            jump = change;
            jump_s = (double)k * made_run.step_s;
        }
    }
    expect_near(jump, b->jump_J, size, "jump");
    expect_near(jump_s, b->jump_s, 0.0, "when it jumped");
    expect_near(left_at(end - end % 2), b->kept_J, size, "kept");
    TEST_ASSERT_FALSE(b->undefined);
}

/* --- watched -----------------------------------------------------------------------------------------------------*/

/* Of component i, as the image counts: y is in millimetres, but its SI unit is x's. */
static void expect_ranges(const watch *w) {
    double furthest[2] = {0}; /* places, rates */
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < N; i++) {
            double low = made_run.state[0][i];
            double high = low;
            for (uint64_t k = 1; k <= made_run.at; k++) {
                low = made_run.state[k][i] < low ? made_run.state[k][i] : low;
                high = larger(high, made_run.state[k][i]);
            }
            furthest[i / 2] = larger(furthest[i / 2], high - low);
            if (round == 1) {
                const int at = made_run_place(i);
                TEST_ASSERT_TRUE(w->low[at] == low && w->high[at] == high);
                TEST_ASSERT_TRUE(w->range[at] == larger(high - low, 1e-3 * furthest[i / 2]));
            }
        }
    }
}

/* Evenly over the run so far, as many as there is room for when every other one goes where there is none. */
static void expect_records(const watch *w) {
    uint64_t stride = 1;
    while (made_run.at / stride >= WATCH_RECORDS) {
        stride *= 2;
    }
    TEST_ASSERT_EQUAL_INT(1 + (int)(made_run.at / stride), w->records);
    for (int k = 0; k < w->records; k++) {
        const uint64_t step = stride * (uint64_t)k;
        expect_near((double)step * made_run.step_s, w->record_s[k], 0.0, "a record's time");
        for (int i = 0; i < N; i++) {
            TEST_ASSERT_TRUE(w->record[(ptrdiff_t)k * N + made_run_place(i)] ==
                             made_run.state[step][i]);
        }
    }
}

static void expect_slopes_followed(const watch *w) {
    for (int i = 0; i < N; i++) {
        double asked = 0.0;
        double low = 0.0;
        double high = 0.0;
        double strayed = 0.0;
        for (uint64_t k = 1; k <= made_run.at; k++) {
            double before[N];
            double now[N];
            made_run_slope(made_run.state[k - 1], before);
            made_run_slope(made_run.state[k], now);
            asked += made_run.step_s * (before[i] + now[i]) / 2.0;
            low = asked < low ? asked : low;
            high = larger(high, asked);
            strayed = larger(strayed, fabs(asked - (made_run.state[k][i] - made_run.state[0][i])));
        }
        const int at = made_run_place(i);
        expect_near(asked, w->asked[at], 10.0, "asked");
        expect_near(low, w->asked_low[at], 10.0, "asked, least");
        expect_near(high, w->asked_high[at], 10.0, "asked, most");
        expect_near(strayed, w->strayed[at], 10.0, "strayed");
        TEST_ASSERT_TRUE(w->start[at] == made_run.state[0][i]);
    }
}

/* Of each pair of steps: what is left by Simpson's rule; where the powers change too much for that, and 64 steps on, what each
 * step did beside an accurate way from its begin. */
static void expect_lost(const watch *w) {
    double lost = 0.0;
    double most = 0.0;
    double size = 0.0;
    uint64_t doubts = 0;
    uint64_t until = 0;
    for (uint64_t k = 0; k <= made_run.at; k++) {
        const double *s = made_run.state[k];
        size = larger(size, fabs(made_run_kinetic(s) + made_run_odd(s)) + made_run_stored(s));
        if (k == 0 || k % 2 == 1) {
            continue;
        }
        double power[3];
        for (int i = 0; i < 3; i++) {
            const double *at = made_run.state[k - 2 + (uint64_t)i];
            power[i] = made_run_power(at, 0) - made_run_power(at, 1);
        }
        const double third = made_run.step_s / 3.0;
        const double doubt = fabs(third * (power[0] - 2.0 * power[1] + power[2]));
        const double sizes = third * (fabs(power[0]) + 4.0 * fabs(power[1]) + fabs(power[2]));
        if (doubt > 0.01 * sizes && doubt > 1e-7 * size) {
            until = k + 64;
        }
        if (k <= until) {
            for (uint64_t i = k - 2; i < k; i++) {
                double there[N];
                memcpy(there, made_run.state[i], sizeof there);
                made_run_go(there, 6);
                lost += made_run_energy(made_run.state[i + 1]) - made_run_energy(there);
                if (i == k - 2) {
                    most = larger(most, fabs(lost));
                }
            }
            doubts++;
        } else {
            lost += left_at(k) - left_at(k - 2);
        }
        most = larger(most, fabs(lost));
    }
    TEST_ASSERT_TRUE(w->balanced);
    TEST_ASSERT_EQUAL_UINT64(doubts, w->doubts);
    expect_near(lost, w->lost_J, size, "lost");
    expect_near(most, w->most_J, size, "lost at most");
}

static void test_made_up_runs(void) {
    const long before = blocks_in_use();
    for (unsigned c = 0; c < dice_cases(usual_or(60, 12)); c++) {
        made_run_draw(&die, c % 3U > 0, c % 4U == 3);
        const uint64_t end = c % 5U == 0 ? c % 7U : dice_one_of(&die, STEPS_MOST + 1U);
        made_run_states(&die, end);
        derived d = made_run_derive();
        made_run.image = d.image;
        TEST_ASSERT_TRUE(made_run.image->angles == 0 && made_run.image->reals == N);
        books *b = books_open(made_run.image);
        watch *w = watch_open(made_run.image, &made_run_kind);
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            books_enter(b, &made_run_kind, NULL);
            watch_enter(w, &made_run_kind, b, NULL);
            if (made_run.at == end || dice_one_of(&die, 10) == 0) {
                expect_books(b);
                expect_ranges(w);
                expect_records(w);
                expect_slopes_followed(w);
                expect_lost(w);
            }
        }
        watch_close(w);
        books_close(b);
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(blocks_in_use() == before);
}

/* From the first entry on that is no number the books are none. */
static void test_no_number(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 10)); c++) {
        made_run_draw(&die, c % 2U == 0, c % 3U == 0);
        const uint64_t end = 4 + dice_one_of(&die, 20);
        const uint64_t wrong = dice_one_of(&die, (unsigned)end + 1U);
        made_run_states(&die, end);
        made_run.state[wrong][c % N] = c % 5U == 0 ? (double)INFINITY : (double)NAN;
        derived d = made_run_derive();
        made_run.image = d.image;
        books *b = books_open(made_run.image);
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            books_enter(b, &made_run_kind, NULL);
            TEST_ASSERT_EQUAL(made_run.at >= wrong, b->undefined);
        }
        expect_near((double)wrong * made_run.step_s, b->undefined_s, 0.0, "undefined");
        books_close(b);
        derived_free(&d);
    }
}

/* --- rounding ----------------------------------------------------------------------------------------------------*/

/* What the accelerations' and the powers' own rounding makes of a step, in so many units of a double's as an evaluator's bound
 * says of this state: of each, by its name. */
static double rounding_of_a_step(const double *s) {
    const image *im = made_run.image;
    const tape *list = im->list[IMAGE_BOOKS];
    double *value = room(list->results, sizeof *value);
    double *off = room(list->results, sizeof *off);
    double real[N];
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        real[made_run_place(i)] = s[i];
    }
    evaluator *ev = evaluator_new(list);
    evaluator_run(ev, 0.0, real, real, real + 2, &made_run.push, value);
    evaluator_rounding(ev, real, 0.0, off);
    for (int i = 0; i < 2; i++) {
        sum += 0x1p-53 * off[i] * fabs(made_run_momentum(s, i, true));
    }
    sum += 0x1p-53 * (off[2 + BOOK_INPUT_POWER] + off[2 + BOOK_LOSS_POWER]);
    evaluator_free(ev);
    free(value);
    free(off);
    return sum * made_run.step_s;
}

/* What rounding each component of the state once makes of the energy, to first order, and beside it what a step adds: next to
 * nothing where steps are short, and all where they are long. */
static void test_rounding(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(60, 18)); c++) {
        static const double lengths_s[] = {1e-9, 1.0, 9.0};
        made_run_draw(&die, c % 2U == 0, c % 5U == 4);
        made_run.step_s = lengths_s[c % 3U];
        const uint64_t end = dice_one_of(&die, 30);
        made_run_states(&die, end);
        derived d = made_run_derive();
        made_run.image = d.image;
        books *b = books_open(made_run.image);
        double most = 0.0;
        double size = 0.0;
        double computing = 0.0;
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            const double *s = made_run.state[made_run.at];
            const bool looked = made_run.at == 0 || made_run.at == 1 || made_run.at == 4 ||
                                made_run.at == 16 || made_run.at == end;
            const double slope[N] = {made_run.k * s[X] + made_run.h * (s[X] - s[Y]),
                                     -made_run.h * (s[X] - s[Y]), made_run_momentum(s, 0, false),
                                     made_run_momentum(s, 1, false)};
            double sum = looked ? rounding_of_a_step(s) : 0.0;
            for (int i = 0; i < N; i++) {
                sum += fabs(slope[i] * s[i]) * 0x1p-53;
            }
            most = looked ? larger(most, sum) : most;
            size = larger(size, fabs(made_run_kinetic(s) + made_run_odd(s)) + made_run_stored(s));
            books_enter(b, &made_run_kind, NULL);
        }
        made_run.at = end;
        const double found = books_rounding_J(b, &made_run_kind, NULL, &computing);
        TEST_ASSERT_TRUE(fabs(found - 0x1p-52 * size - most) <= 2e-5 * most);
        /* a handful of operations, of terms no larger than a few energies */
        TEST_ASSERT_TRUE(computing > 0x1p-54 * size && computing < 60.0 * 0x1p-53 * size);
        TEST_ASSERT_TRUE(books_lost_J(b) == 0.0); /* it has no contacts */
        books_close(b);
        derived_free(&d);
    }
}

void suite_watched(void) {
    die = dice_of("watched", 66);
    RUN_TEST(test_made_up_runs);
    RUN_TEST(test_no_number);
    RUN_TEST(test_rounding);
}
