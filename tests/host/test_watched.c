/* test_watched.c: the books beside a run and what it is watched by (host/run/books.h, watch.h), of runs that are made up: any
 * sequence of states, no motion. Each number that is kept is what formulas of this file make of all the states at once: energies,
 * work by Simpson's rule, momenta, spreads by two passes, ranges, records, and what the slopes lead to. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "derived.h"
#include "host/base/room.h"
#include "host/run/belief.h"
#include "host/run/watch.h"
#include "unity.h"

void suite_watched(void);

enum { STEPS_MOST = 70, X = 0, Y = 1, VX = 2, VY = 3, N = 4 };

static dice die;

/* Two bodies on springs, coupled by their inertia too, one pushed and one damped, and perhaps in a magnetic field. */
static struct {
    double mx, my, coupled; /* kg */
    double k, h;            /* N/m */
    double damping;
    double push;
    double magnetic; /* kg/s */
    double step_s;
    double state[STEPS_MOST + 1][N]; /* as this file counts them */
    uint64_t at;
} world;

static void draw_world(bool powers, bool magnetic) {
    world.mx = dice_between(&die, 1.0, 3.0);
    world.my = dice_between(&die, 1.0, 3.0);
    world.coupled = dice_between(&die, -0.6, 0.6);
    world.k = dice_between(&die, 0.5, 4.0);
    world.h = dice_between(&die, 0.5, 4.0);
    world.damping = powers ? dice_between(&die, 0.2, 1.0) : 0.0;
    world.push = powers ? dice_between(&die, 1.0, 3.0) : 0.0;
    world.magnetic = magnetic ? dice_between(&die, 0.5, 1.5) : 0.0;
    world.step_s = dice_between(&die, 0.01, 0.1);
}

static derived derive_world(void) {
    char text[900];
    char field_text[120] = "";
    if (world.magnetic > 0.0) {
        snprintf(field_text, sizeof field_text, " + %.17g [kg/s]*(x*y' - y*x')", world.magnetic);
    }
    char powers[120] = "";
    if (world.damping > 0.0) {
        snprintf(powers, sizeof powers, "F = %.17g [N*s/m]*x'^2/2\nQ(y) = u\n", world.damping);
    }
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [mm]\ninput u = %.17g [N]\n"
             "T = %.17g [kg]*x'^2/2 + %.17g [kg]*y'^2/2 + %.17g [kg]*x'*y'%s\n"
             "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*(x - y)^2/2\n%s"
             "scene s { step %.17g [s]; until 9 [s] }\n",
             world.push, world.mx, world.my, world.coupled, field_text, world.k, world.h, powers,
             world.step_s);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    return d;
}

/* Places and rates that walk about. */
static void draw_states(uint64_t steps) {
    for (uint64_t k = 0; k <= steps; k++) {
        for (int i = 0; i < N; i++) {
            const double before = k == 0 ? dice_between(&die, -2.0, 2.0) : world.state[k - 1][i];
            world.state[k][i] = before + dice_between(&die, -1.0, 1.0);
        }
    }
}

/* --- formulas -------------------------------------------------------------------------------------------------*/

static double kinetic_of(const double *s) {
    return world.mx * s[VX] * s[VX] / 2.0 + world.my * s[VY] * s[VY] / 2.0 +
           world.coupled * s[VX] * s[VY];
}

static double odd_of(const double *s) { return world.magnetic * (s[X] * s[VY] - s[Y] * s[VX]); }

static double stored_of(const double *s) {
    return world.k * s[X] * s[X] / 2.0 + world.h * (s[X] - s[Y]) * (s[X] - s[Y]) / 2.0;
}

static double energy_of(const double *s) { return kinetic_of(s) + stored_of(s); }

/* Input, loss. */
static double power_of(const double *s, int which) {
    return which == 0 ? world.push * s[VY] : world.damping * s[VX] * s[VX];
}

static double momentum_of(const double *s, int i, bool whole) {
    const double magnetic = whole ? world.magnetic : 0.0;
    return i == 0 ? world.mx * s[VX] + world.coupled * s[VY] - magnetic * s[Y]
                  : world.my * s[VY] + world.coupled * s[VX] + magnetic * s[X];
}

static void slope_of(const double *s, double *slope) {
    const double fx = -world.k * s[X] - world.h * (s[X] - s[Y]) - world.damping * s[VX] +
                      2.0 * world.magnetic * s[VY];
    const double fy = world.h * (s[X] - s[Y]) + world.push - 2.0 * world.magnetic * s[VX];
    const double det = world.mx * world.my - world.coupled * world.coupled;
    slope[X] = s[VX];
    slope[Y] = s[VY];
    slope[VX] = (world.my * fx - world.coupled * fy) / det;
    slope[VY] = (world.mx * fy - world.coupled * fx) / det;
}

/* Runge-Kutta 4, `parts` of a step. */
static void go(double *s, int parts) {
    const double h = world.step_s / parts;
    for (int part = 0; part < parts; part++) {
        static const double ahead[] = {0.0, 0.5, 0.5, 1.0};
        static const double weight[] = {1.0, 2.0, 2.0, 1.0};
        double slope[N] = {0};
        double sum[N] = {0};
        for (int stage = 0; stage < 4; stage++) {
            double there[N];
            for (int i = 0; i < N; i++) {
                there[i] = s[i] + h * ahead[stage] * slope[i];
            }
            slope_of(there, slope);
            for (int i = 0; i < N; i++) {
                sum[i] += weight[stage] * slope[i];
            }
        }
        for (int i = 0; i < N; i++) {
            s[i] += h / 6.0 * sum[i];
        }
    }
}

/* --- the run that is made up ------------------------------------------------------------------------------------*/

static const image *made_for;

/* Where the image keeps what this file counts so. */
static int place_of(int i) {
    for (int k = 0; k < N; k++) {
        const component c = image_component(made_for, k);
        if (c.unknown + 2 * c.primes == i) {
            return k;
        }
    }
    return -1;
}

static void state(const void *run, double *angle_rad, double *real) {
    (void)run;
    (void)angle_rad;
    for (int i = 0; i < N; i++) {
        real[place_of(i)] = world.state[world.at][i];
    }
}

static uint64_t steps(const void *run) {
    (void)run;
    return world.at;
}

static const engine_kind kind = {.name = "made up", .state = state, .steps = steps};

static void expect_near(double wanted, double is, double size, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(wanted - is) <= 1e-11 * (fabs(wanted) + size), what);
}

/* Eight standard deviations' root, by two passes. */
static double swing_of(double (*of)(const double *), uint64_t count) {
    double mean = 0.0;
    double squares = 0.0;
    for (uint64_t k = 0; k < count; k++) {
        mean += of(world.state[k]) / (double)count;
    }
    for (uint64_t k = 0; k < count; k++) {
        squares += (of(world.state[k]) - mean) * (of(world.state[k]) - mean);
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
        sum += world.step_s / 3.0 *
               (power_of(world.state[k], which) + 4.0 * power_of(world.state[k + 1], which) +
                power_of(world.state[k + 2], which));
    }
    if (end % 2 == 1) {
        sum += world.step_s / 2.0 *
               (power_of(world.state[end - 1], which) + power_of(world.state[end], which));
    }
    return sum;
}

static double left_at(uint64_t end) {
    return energy_of(world.state[end]) - energy_of(world.state[0]) - work_to(end, 0) +
           work_to(end, 1);
}

/* Simpson's rule less the trapezoids'; where that is more than a tenth of it, by how much the powers change. */
static double rule_off_to(uint64_t end) {
    double sum = 0.0;
    for (uint64_t k = 0; k + 2 <= end; k += 2) {
        for (int which = 0; which < 2; which++) {
            const double a = power_of(world.state[k], which);
            const double b = power_of(world.state[k + 1], which);
            const double c = power_of(world.state[k + 2], which);
            const double trapezoids = world.step_s * (a + 2.0 * b + c) / 2.0;
            const double simpson = world.step_s * (a + 4.0 * b + c) / 3.0;
            const double change = world.step_s * (fabs(b - a) + fabs(c - b)) / 2.0;
            const double off = fabs(simpson - trapezoids);
            sum += off > 0.1 * change ? change : off;
        }
    }
    return sum;
}

static void expect_books(const books *b) {
    const uint64_t end = world.at;
    const double *now = world.state[end];
    const double *first = world.state[0];
    double size = 0.0;
    for (uint64_t k = 0; k <= end; k++) {
        const double *s = world.state[k];
        size = larger(size, fabs(kinetic_of(s) + odd_of(s)) + stored_of(s));
    }
    TEST_ASSERT_EQUAL_UINT64(end + 1, b->entries);
    expect_near((double)end * world.step_s, b->time_s, 0.0, "time");
    expect_near(kinetic_of(first) + odd_of(first), b->kinetic_J[0], size, "kinetic, start");
    expect_near(kinetic_of(now) + odd_of(now), b->kinetic_J[1], size, "kinetic, now");
    expect_near(kinetic_of(first), b->moving_J[0], size, "moving, start");
    expect_near(kinetic_of(now), b->moving_J[1], size, "moving, now");
    expect_near(stored_of(first), b->stored_J[0], size, "stored, start");
    expect_near(stored_of(now), b->stored_J[1], size, "stored, now");
    expect_near(energy_of(first), b->energy_J[0], size, "energy, start");
    expect_near(energy_of(now), b->energy_J[1], size, "energy, now");
    expect_near(work_to(end, 0), b->input_J, size, "input");
    expect_near(work_to(end, 1), b->loss_J, size, "loss");
    expect_near(size, b->size_J, 0.0, "size");
    expect_near(rule_off_to(end), b->rule_J, 0.0, "rule");
    TEST_ASSERT_EQUAL(world.magnetic > 0.0, b->leans);

    double most = larger(swing_of(kinetic_of, end + 1), swing_of(stored_of, end + 1));
    for (int i = 0; i < 2; i++) {
        double drift = 0.0;
        double squares = 0.0;
        for (uint64_t k = 0; k <= end; k++) {
            const double own = momentum_of(world.state[k], i, false);
            drift = larger(
                drift, fabs(momentum_of(world.state[k], i, true) - momentum_of(first, i, true)));
            squares += own * own;
        }
        expect_near(momentum_of(first, i, true), b->momentum[i], 1.0, "momentum, start");
        expect_near(momentum_of(now, i, true), b->momentum_now[i], 1.0, "momentum, now");
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
            jump_s = (double)k * world.step_s;
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
            double low = world.state[0][i];
            double high = low;
            for (uint64_t k = 1; k <= world.at; k++) {
                low = world.state[k][i] < low ? world.state[k][i] : low;
                high = larger(high, world.state[k][i]);
            }
            furthest[i / 2] = larger(furthest[i / 2], high - low);
            if (round == 1) {
                const int at = place_of(i);
                TEST_ASSERT_TRUE(w->low[at] == low && w->high[at] == high);
                TEST_ASSERT_TRUE(w->range[at] == larger(high - low, 1e-3 * furthest[i / 2]));
            }
        }
    }
}

/* Evenly over the run so far, as many as there is room for when every other one goes where there is none. */
static void expect_records(const watch *w) {
    uint64_t stride = 1;
    while (world.at / stride >= WATCH_RECORDS) {
        stride *= 2;
    }
    TEST_ASSERT_EQUAL_INT(1 + (int)(world.at / stride), w->records);
    for (int k = 0; k < w->records; k++) {
        const uint64_t step = stride * (uint64_t)k;
        expect_near((double)step * world.step_s, w->record_s[k], 0.0, "a record's time");
        for (int i = 0; i < N; i++) {
            TEST_ASSERT_TRUE(w->record[(ptrdiff_t)k * N + place_of(i)] == world.state[step][i]);
        }
    }
}

static void expect_slopes_followed(const watch *w) {
    for (int i = 0; i < N; i++) {
        double asked = 0.0;
        double low = 0.0;
        double high = 0.0;
        double strayed = 0.0;
        for (uint64_t k = 1; k <= world.at; k++) {
            double before[N];
            double now[N];
            slope_of(world.state[k - 1], before);
            slope_of(world.state[k], now);
            asked += world.step_s * (before[i] + now[i]) / 2.0;
            low = asked < low ? asked : low;
            high = larger(high, asked);
            strayed = larger(strayed, fabs(asked - (world.state[k][i] - world.state[0][i])));
        }
        const int at = place_of(i);
        expect_near(asked, w->asked[at], 10.0, "asked");
        expect_near(low, w->asked_low[at], 10.0, "asked, least");
        expect_near(high, w->asked_high[at], 10.0, "asked, most");
        expect_near(strayed, w->strayed[at], 10.0, "strayed");
        TEST_ASSERT_TRUE(w->start[at] == world.state[0][i]);
    }
}

/* Of each pair of steps: what is left by Simpson's rule; where the powers change too much for that, what each step did beside an
 * accurate way from its begin. */
static void expect_lost(const watch *w) {
    double lost = 0.0;
    double most = 0.0;
    double size = 0.0;
    uint64_t doubts = 0;
    for (uint64_t k = 0; k <= world.at; k++) {
        const double *s = world.state[k];
        size = larger(size, fabs(kinetic_of(s) + odd_of(s)) + stored_of(s));
        if (k == 0 || k % 2 == 1) {
            continue;
        }
        double power[3];
        for (int i = 0; i < 3; i++) {
            const double *at = world.state[k - 2 + (uint64_t)i];
            power[i] = power_of(at, 0) - power_of(at, 1);
        }
        const double third = world.step_s / 3.0;
        const double doubt = fabs(third * (power[0] - 2.0 * power[1] + power[2]));
        const double sizes = third * (fabs(power[0]) + 4.0 * fabs(power[1]) + fabs(power[2]));
        if (doubt > 0.01 * sizes && doubt > 1e-7 * size) {
            for (uint64_t i = k - 2; i < k; i++) {
                double there[N];
                memcpy(there, world.state[i], sizeof there);
                go(there, 6);
                lost += energy_of(world.state[i + 1]) - energy_of(there);
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
        draw_world(c % 3U > 0, c % 4U == 3);
        const uint64_t end = c % 5U == 0 ? c % 7U : dice_one_of(&die, STEPS_MOST + 1U);
        draw_states(end);
        derived d = derive_world();
        made_for = d.image;
        TEST_ASSERT_TRUE(made_for->angles == 0 && made_for->reals == N);
        books *b = books_open(made_for);
        watch *w = watch_open(made_for, &kind);
        for (world.at = 0; world.at <= end; world.at++) {
            books_enter(b, &kind, NULL);
            watch_enter(w, &kind, b, NULL);
            if (world.at == end || dice_one_of(&die, 10) == 0) {
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
        draw_world(c % 2U == 0, c % 3U == 0);
        const uint64_t end = 4 + dice_one_of(&die, 20);
        const uint64_t wrong = dice_one_of(&die, (unsigned)end + 1U);
        draw_states(end);
        world.state[wrong][c % N] = c % 5U == 0 ? (double)INFINITY : (double)NAN;
        derived d = derive_world();
        made_for = d.image;
        books *b = books_open(made_for);
        for (world.at = 0; world.at <= end; world.at++) {
            books_enter(b, &kind, NULL);
            TEST_ASSERT_EQUAL(world.at >= wrong, b->undefined);
        }
        expect_near((double)wrong * world.step_s, b->undefined_s, 0.0, "undefined");
        books_close(b);
        derived_free(&d);
    }
}

/* --- rounding ----------------------------------------------------------------------------------------------------*/

/* What rounding each component of the state once makes of the energy, to first order; beside it what the accelerations' own
 * rounding makes of a step, which is less where steps are short. */
static void test_rounding(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 10)); c++) {
        draw_world(c % 2U == 0, false);
        world.step_s = 1e-9;
        const uint64_t end = dice_one_of(&die, 30);
        draw_states(end);
        derived d = derive_world();
        made_for = d.image;
        books *b = books_open(made_for);
        double most = 0.0;
        double size = 0.0;
        double computing = 0.0;
        for (world.at = 0; world.at <= end; world.at++) {
            const double *s = world.state[world.at];
            const bool looked = world.at == 0 || world.at == 1 || world.at == 4 || world.at == 16 ||
                                world.at == end;
            const double slope[N] = {world.k * s[X] + world.h * (s[X] - s[Y]),
                                     -world.h * (s[X] - s[Y]), momentum_of(s, 0, false),
                                     momentum_of(s, 1, false)};
            double sum = 0.0;
            for (int i = 0; i < N; i++) {
                sum += fabs(slope[i] * s[i]) * 0x1p-53;
            }
            most = looked ? larger(most, sum) : most;
            size = larger(size, energy_of(s));
            books_enter(b, &kind, NULL);
        }
        world.at = end;
        const double found = books_rounding_J(b, &kind, NULL, &computing);
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
