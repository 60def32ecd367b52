/* test_looked.c: a close look at the last steps of a run (host/run/look_close.h), of runs that are made up: where accurate steps lead,
 * how far the run's own are from there, which steps are fine enough, and what the inertia is on the way. */
#include <math.h>
#include <string.h>

#include "host/run/look_close.h"
#include "host/run/watch.h"
#include "made_run.h"
#include "unity.h"

void suite_looked(void);

static dice die;

static void expect_near(double wanted, double is, double size, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(fabs(wanted - is) <= 1e-11 * (fabs(wanted) + size), what);
}

static double larger(double a, double b) { return a > b ? a : b; }

/* How far apart two states are: places by how far each went, rates by the kinetic energy of their difference; whose it is. */
static double apart(const watch *w, const double *run, const double *truth, int *whose) {
    double most = 0.0;
    *whose = -1;
    for (int i = 0; i < 2; i++) {
        const double off = fabs(run[i] - truth[i]) / w->range[made_run_place(i)];
        if (off > most) {
            most = off;
            *whose = made_run_place(i);
        }
    }
    const double difference[N] = {0.0, 0.0, run[VX] - truth[VX], run[VY] - truth[VY]};
    const double rates = sqrt(made_run_kinetic(difference) / made_run_kinetic(truth));
    if (rates > most) {
        *whose = -1;
    }
    return larger(most, rates);
}

/* The last eight steps again, in steps four times as many until that makes no difference: where they end, and how far the run's
 * own are from there. The inertia's pivots are the same everywhere. */
static void expect_look(const watch *w, int ahead) {
    const watch_look *l = &w->worst;
    const uint64_t begin = made_run.at > WATCH_WINDOW ? made_run.at - WATCH_WINDOW : 0;
    const int count = (int)(made_run.at - begin) + ahead;
    double coarse[N];
    double fine[N];
    int parts = 4;
    int whose;
    memcpy(coarse, made_run.state[begin], sizeof coarse);
    for (int k = 0; k < count; k++) {
        made_run_go(coarse, parts);
    }
    for (;; parts *= 4) {
        memcpy(fine, made_run.state[begin], sizeof fine);
        for (int k = 0; k < count; k++) {
            made_run_go(fine, 4 * parts);
        }
        if (apart(w, coarse, fine, &whose) < 1e-5) {
            break;
        }
        memcpy(coarse, fine, sizeof coarse);
    }
    TEST_ASSERT_TRUE(l->done && l->resolved && l->failed == (ahead > 0));
    expect_near((double)begin * made_run.step_s, l->begin_s, 0.0, "a look's begin");
    expect_near((double)(made_run.at + (uint64_t)ahead) * made_run.step_s, l->end_s, 0.0,
                "a look's end");
    expect_near(made_run.step_s / parts, l->fine_step_s, 0.0, "a look's step");
    if (ahead > 0) {
        TEST_ASSERT_TRUE(l->off == 1.0);
    } else {
        const double off = apart(w, made_run.state[made_run.at], fine, &whose);
        TEST_ASSERT_TRUE(fabs(off - l->off) <= 1e-7 * off);
        TEST_ASSERT_EQUAL_INT(whose, l->component);
    }
    const double least = 1.0 - made_run.coupled * made_run.coupled / (made_run.mx * made_run.my);
    TEST_ASSERT_TRUE(fabs(l->inertia - least) < 1e-6);
    TEST_ASSERT_EQUAL_INT(made_run_place(VY), l->singular);
    TEST_ASSERT_FALSE(w->singular.done);
}

static void test_close_looks(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 10)); c++) {
        const uint64_t end = 1 + dice_one_of(&die, 30);
        made_run_draw(&die, c % 3U > 0, c % 4U == 3);
        made_run_states(&die, end);
        derived d = made_run_derive();
        made_run.image = d.image;
        watch *w = watch_open(made_run.image, &made_run_kind);
        w->balanced = false; /* without books */
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            watch_enter(w, &made_run_kind, NULL, NULL);
        }
        made_run.at = end;
        const int ahead = c % 5U == 0 ? 2 : 0;
        const uint64_t looked = w->looked;
        w->worst = (watch_look){.done = false};
        look_close(w, ahead);
        TEST_ASSERT_EQUAL_UINT64(looked + 1, w->looked);
        expect_look(w, ahead);
        /* what is less does not take its place */
        w->worst.off = 2.0 + w->worst.off;
        const watch_look kept = w->worst;
        look_close(w, ahead);
        TEST_ASSERT_TRUE(w->worst.off == kept.off);
        watch_close(w);
        derived_free(&d);
    }
}

/* --- when to look ---------------------------------------------------------------------------------------------------*/

static double range_until(int i, uint64_t end) {
    double low = made_run.state[0][i];
    double high = low;
    for (uint64_t k = 1; k <= end; k++) {
        low = fmin(low, made_run.state[k][i]);
        high = fmax(high, made_run.state[k][i]);
    }
    return high - low;
}

/* By which part of its range the accelerations change a rate in the last step more or less than those before it say. */
static double change_at(uint64_t k) {
    double most = 0.0;
    double before[N];
    double now[N];
    made_run_slope(made_run.state[k - 1], before);
    made_run_slope(made_run.state[k], now);
    for (int i = VX; i <= VY; i++) {
        const double other = range_until(i == VX ? VY : VX, k);
        const double range = fmax(range_until(i, k), 1e-3 * other);
        most = fmax(most, fabs(now[i] - before[i]) * made_run.step_s / range);
    }
    return most;
}

/* From the third step on: half a window behind a change of a fiftieth that is larger by a third than any that was looked at, or when
 * two thirds as many steps and a window have gone by since; and in the end what is still due, or has failed. */
static void test_when_it_looks(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(16, 6)); c++) {
        const uint64_t end = 3 + dice_one_of(&die, 66);
        uint64_t looks = 0;
        uint64_t due = 0;
        uint64_t next = 0;
        double largest = 0.0;
        made_run_draw(&die, false, false);
        made_run.step_s *= 0.1;
        made_run_states(&die, end);
        for (uint64_t k = 1; k <= end; k++) { /* steps of all sizes */
            const double part = exp(dice_between(&die, -6.0, 0.0));
            for (int i = 0; i < N; i++) {
                const double moved = part * dice_between(&die, -1.0, 1.0);
                made_run.state[k][i] = made_run.state[k - 1][i] + moved;
            }
        }
        derived d = made_run_derive();
        made_run.image = d.image;
        watch *w = watch_open(made_run.image, &made_run_kind);
        w->balanced = false;
        for (made_run.at = 0; made_run.at <= end; made_run.at++) {
            const uint64_t k = made_run.at;
            const double change = k > 2 ? change_at(k) : 0.0;
            watch_enter(w, &made_run_kind, NULL, NULL);
            if (change > 0.02 && (change > 1.3 * largest || k >= next)) {
                largest = fmax(largest, change);
                next = k + 8 + 2 * k / 3;
                due = k + 4;
            }
            if (due > 0 && k >= due) {
                looks++;
                due = 0;
            }
            TEST_ASSERT_EQUAL_UINT64(looks, w->looked);
        }
        made_run.at = end;
        const bool failed = c % 3U == 0;
        watch_end(w, failed);
        TEST_ASSERT_EQUAL_UINT64(looks + (failed || due > 0 ? 1U : 0U), w->looked);
        watch_close(w);
        derived_free(&d);
    }
}

/* --- past a pole ------------------------------------------------------------------------------------------------------*/

/* A body on a straight line: where it is and how fast, at the begin of the look. */
typedef struct line {
    double x_m, y_m, vx_mps, vy_mps;
} line;

static double radius_m(const line *l, double t) {
    const double x = l->x_m + l->vx_mps * t;
    const double y = l->y_m + l->vy_mps * t;
    return sqrt(x * x + y * y);
}

/* Free bodies in polar coordinates whose radius is `turned`: r or 3 m - r. The inertia of phi is r^2, and its least is found at
 * one of 512 places of the way, as a part of the most that it has been, at records and before on the way. */
static void expect_pole(const watch *w, const line *l, bool turned) {
    const image *im = w->field->image;
    const watch_look *found = &w->singular;
    const int r = derived_component(im, "r", 0);
    const double span_s = found->end_s - found->begin_s;
    double most_2 = 0.0;
    double least = 1.0;
    double when_s = 0.0;
    double least_m = 0.0;
    for (int k = 0; k < w->records; k++) {
        const double kept = w->record[k * w->field->n + r];
        const double own = turned ? 3.0 - kept : kept;
        most_2 = larger(most_2, own * own);
    }
    for (int k = 0; k <= 512; k++) {
        const double own = radius_m(l, span_s * k / 512.0);
        most_2 = larger(most_2, own * own);
        if (own * own / most_2 < least) {
            least = own * own / most_2;
            least_m = own;
            when_s = found->begin_s + span_s * k / 512.0;
        }
    }
    TEST_ASSERT_TRUE(found->done && found->resolved && !found->failed);
    TEST_ASSERT_TRUE(fabs(found->inertia - least) <= 1e-4 * least);
    TEST_ASSERT_TRUE(fabs(found->singular_s - when_s) <= 1.01 * span_s / 512.0);
    TEST_ASSERT_EQUAL_INT(derived_component(im, "phi", 1), found->singular);
    TEST_ASSERT_EQUAL_INT(r, found->near);
    TEST_ASSERT_TRUE(fabs((turned ? 3.0 - found->near_at : found->near_at) - least_m) <=
                     1e-4 * least_m);
}

static void test_poles(void) {
    static const char *const declared[] = {
        "coordinate b [m]\ncoordinate r [m]\ncoordinate phi [rad]\ncoordinate c [m]\n",
        "coordinate phi [rad]\ncoordinate c [m]\ncoordinate r [m]\ncoordinate b [m]\n",
        "coordinate r [m]\ncoordinate phi [rad]\ncoordinate b [m]\ncoordinate c [m]\n"};
    for (unsigned c = 0; c < dice_cases(usual_or(12, 6)); c++) {
        char text[900];
        const bool turned = c % 2U == 1;
        const double passes_m = dice_between(&die, 0.01, 0.03);
        const double step_s = passes_m * dice_between(&die, 0.7, 1.4);
        const double begin_m = 14.3 * step_s; /* 1 m/s */
        snprintf(
            text, sizeof text,
            "mechanism m\n%sT = 1 [kg]*(r'^2 + %s^2*phi'^2)/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\n"
            "V = 5 [N/m]*b^2/2\n"
            "scene s { start r = %.17g [m], r' = %s1 [m/s], phi' = %.17g [rad/s], b = 0.4 [m], c' "
            "= 2 [m/s]; step %.17g [s]; until %.17g [s] }\n",
            declared[c % 3U], turned ? "(3 [m] - r)" : "r", turned ? 3.0 - begin_m : begin_m,
            turned ? "" : "-", passes_m / (begin_m * begin_m), step_s, 18.0 * step_s);
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        const image *im = d.image;
        const int angle = derived_component(im, "phi", 0);
        const int r = derived_component(im, "r", 0);
        const int turns = derived_component(im, "phi", 1);
        const int goes = derived_component(im, "r", 1);
        void *run = engine_double.start(im);
        watch *w = watch_open(im, &engine_double);
        w->balanced = false;
        watch_enter(w, &engine_double, NULL, run);
        for (int k = 0; k < 18; k++) {
            TEST_ASSERT_EQUAL_INT(WH_OK, engine_double.step(run));
            watch_enter(w, &engine_double, NULL, run);
        }
        w->worst = (watch_look){.done = false};
        w->singular = (watch_look){.done = false};
        memset(w->most, 0, (size_t)w->field->rows * sizeof *w->most);
        look_close(w, 0);
        const double *x = watch_past(w, 10);
        const double at_m = turned ? 3.0 - x[r] : x[r];
        const double out_mps = turned ? -x[goes] : x[goes];
        const line l = {.x_m = at_m * cos(x[angle]),
                        .y_m = at_m * sin(x[angle]),
                        .vx_mps = out_mps * cos(x[angle]) - at_m * x[turns] * sin(x[angle]),
                        .vy_mps = out_mps * sin(x[angle]) + at_m * x[turns] * cos(x[angle])};
        TEST_ASSERT_TRUE(fabs(w->singular.begin_s - 10.0 * step_s) < 1e-12);
        expect_pole(w, &l, turned);
        /* what is less does not take its place */
        w->singular.off += 2.0;
        const double kept = w->singular.off;
        look_close(w, 0);
        TEST_ASSERT_TRUE(w->singular.off == kept);
        watch_close(w);
        engine_double.stop(run);
        derived_free(&d);
    }
}

void suite_looked(void) {
    die = dice_of("looked", 72);
    RUN_TEST(test_close_looks);
    RUN_TEST(test_when_it_looks);
    RUN_TEST(test_poles);
}
