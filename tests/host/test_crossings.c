/* test_crossings.c: several crossings, each with assignments of its own: each does its own ones, and in its own time. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "motion.h"

#include "unity.h"

void suite_crossings(void);

/* x moves on at 1 m/s and crosses a level a second; each crossing gives some of y, z, u other rates. */
static void test_each_crossing_sets_its_own(void) {
    static const char *const others[] = {"y", "z", "u"};
    uint64_t seed = 47;
    for (int round = 0; round < 40; round++) {
        const int levels = 2 + round % 4;
        char text[2048];
        size_t length = (size_t)snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate z [m]\ncoordinate u [m]\n"
            "T = 1 [kg]*(x'^2 + y'^2 + z'^2 + u'^2)/2\n"
            "scene s {\nstep 10 [ms]\nuntil 10 [s]\nstart x' = 1 [m/s]\n");
        double rate[3] = {0.0};
        double rates[6][3]; /* after so many levels */
        memcpy(rates[0], rate, sizeof rate);
        for (int level = 0; level < levels; level++) {
            length += (size_t)snprintf(text + length, sizeof text - length,
                                       "when x crosses %d.505 [m] rising { set", level);
            const unsigned which = 1 + (unsigned)(random_bits(&seed) % 7);
            bool first = true;
            for (unsigned k = 0; k < 3; k++) {
                if ((which >> k & 1U) != 0) {
                    rate[k] = (double)(random_bits(&seed) % 17) / 4.0 - 2.0;
                    length +=
                        (size_t)snprintf(text + length, sizeof text - length, "%s %s' = %g [m/s]",
                                         first ? "" : ",", others[k], rate[k]);
                    first = false;
                }
            }
            length += (size_t)snprintf(text + length, sizeof text - length, " }\n");
            memcpy(rates[level + 1], rate, sizeof rate);
        }
        snprintf(text + length, sizeof text - length, "}\n");
        motion m;
        motion_open_text(&m, text, IN_DOUBLE);
        double moved[3] = {0.0};
        for (int level = 0; level <= levels; level++) {
            motion_to(&m, level);
            for (int k = 0; k < 3; k++) {
                char name[8];
                snprintf(name, sizeof name, "%s'", others[k]);
                TEST_ASSERT_DOUBLE_WITHIN(1e-12, rates[level][k], motion_value(&m, name));
                moved[k] +=
                    level == 0 ? 0.0 : 0.505 * rates[level - 1][k] + 0.495 * rates[level][k];
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, moved[k], motion_value(&m, others[k]));
            }
        }
        motion_close(&m);
    }
}

/* --- what turns back ---------------------------------------------------------------------------------------------*/

/* A body falls to or past a level, by a pull of any sign, and crossing that sets its rate to k x' + c: mostly back, slower or
 * faster, or on. What it turns back from it has crossed once; going back over what the location left is no other crossing.
 * Between crossings it goes by a parabola, of which the next moment at the level is known. */
typedef struct bounce {
    int direction; /* of the crossing: +1 rising, -1 falling, 0 both */
    double pull;   /* m/s^2, downwards */
    double k;
    double c_mps;
    double x_m; /* above the level */
    double v_mps;
} bounce;

enum { HITS_MOST = 12, HITS_IN_STEP = 5 };

/* When it is at the level next; infinity: never. What is there leaves it first. */
static double next_hit_s(const bounce *b) {
    if (b->x_m == 0.0) {
        const double back_s = b->pull == 0.0 ? -1.0 : 2.0 * b->v_mps / b->pull;
        return back_s > 0.0 ? back_s : (double)INFINITY;
    }
    if (b->pull == 0.0) {
        return b->x_m * b->v_mps < 0.0 ? -b->x_m / b->v_mps : (double)INFINITY;
    }
    const double root = b->v_mps * b->v_mps + 2.0 * b->pull * b->x_m;
    if (root < 0.0) {
        return (double)INFINITY;
    }
    const double first = (b->v_mps - sqrt(root)) / b->pull;
    const double second = (b->v_mps + sqrt(root)) / b->pull;
    const double low = fmin(first, second);
    const double high = fmax(first, second);
    return low > 0.0 ? low : high > 0.0 ? high : (double)INFINITY;
}

/* Its way, to `end_s`; at[] gets the moments. Their count, or -1: too many, one that hardly leaves, or one that goes through
 * and would come back within the step, which its end does not see. */
static int go(bounce *b, double end_s, double step_s, double *at) {
    double time_s = 0.0;
    int hits = 0;
    for (;;) {
        const double next_s = next_hit_s(b);
        const double span_s = fmin(next_s, end_s - time_s);
        b->x_m = next_s <= end_s - time_s
                     ? 0.0
                     : b->x_m + b->v_mps * span_s - 0.5 * b->pull * span_s * span_s;
        b->v_mps -= b->pull * span_s;
        time_s += span_s;
        if (b->x_m != 0.0) {
            return hits;
        }
        const double rest_s = (floor(time_s / step_s) + 1.0) * step_s - time_s;
        const double beyond_m = b->v_mps * rest_s - 0.5 * b->pull * rest_s * rest_s;
        if (beyond_m * b->v_mps < 1e-4 * fabs(b->v_mps)) {
            return -1;
        }
        const bool taken = b->direction == 0 || (b->direction > 0) == (b->v_mps > 0.0);
        if (taken) {
            b->v_mps = b->k * b->v_mps + b->c_mps;
            at[hits++] = time_s;
        }
        if (hits == HITS_MOST || fabs(b->v_mps) < 0.02) {
            return -1;
        }
    }
}

static void test_what_turns_back_crosses_once(void) {
    static const char *const words[] = {" falling", "", " rising"};
    static const char *const values[] = {"x crosses 2 [m]", "3*x - 4 [m] crosses 2 [m]",
                                         "x*abs(x)/(2 [m]) crosses 2 [m]"};
    dice d = dice_of("what turns back", 5519);
    unsigned taken = 0;
    unsigned crowded = 0;
    for (unsigned i = 0; i < dice_cases(usual_or(1200, 600)); i++) {
        bounce b = {.direction = (int)dice_one_of(&d, 3) - 1,
                    .pull = dice_one_of(&d, 4) == 0 ? 0.0 : dice_between(&d, -10.0, 10.0),
                    .k = dice_one_of(&d, 4) == 0 ? dice_between(&d, 0.2, 1.5)
                                                 : dice_between(&d, -1.5, -0.2),
                    .c_mps = dice_one_of(&d, 3) == 0 ? dice_between(&d, -1.0, 1.0) : 0.0,
                    .x_m = dice_between(&d, -1.0, 1.0) * dice_between(&d, 0.0, 1.5),
                    .v_mps = dice_between(&d, -2.0, 2.0)};
        const double step_s = pow(10.0, dice_between(&d, -2.5, 0.3));
        const int steps = 2 + (int)(dice_between(&d, 1.0, 4.0) / step_s);
        double at_s[HITS_MOST];
        char text[900];
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N]*x\n"
            "when %s%s { set x' = %.17g*x' + %.17g [m/s] }\n"
            "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [m]\nstart x' = %.17g [m/s]\n}\n",
            b.pull, values[i % 3], words[b.direction + 1], b.k, b.c_mps, step_s, step_s * steps,
            2.0 + b.x_m, b.v_mps);
        const int hits = go(&b, step_s * steps, step_s, at_s);
        bool shared = false;
        bool twice = false;
        for (int k = 1; k < hits; k++) {
            twice = twice || at_s[k] - at_s[k - 1] < 0.5 * step_s;
        }
        for (int k = HITS_IN_STEP; k < hits; k++) {
            shared = shared || at_s[k] - at_s[k - HITS_IN_STEP] < step_s;
        }
        if (hits < 1 || shared) {
            continue;
        }
        taken++;
        crowded += twice ? 1U : 0U;
        motion m;
        motion_open_text(&m, text, i / 3 % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        uint64_t overruns;
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        const double allowed = i / 3 % 2 == 0 ? 1e-8 : 2e-2 * (1.0 + fabs(b.x_m));
        TEST_ASSERT_EQUAL_INT_MESSAGE(hits, (int)m.kind->events(m.run, &overruns), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(allowed, 2.0 + b.x_m, motion_value(&m, "x"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(allowed, b.v_mps, motion_value(&m, "x'"), text);
        motion_close(&m);
    }
    printf("  %u bodies that cross a level and may turn back, %u of them twice within a step\n",
           taken, crowded);
    TEST_ASSERT_TRUE(taken > 10 && crowded > 1);
}

/* A body that its crossing stops, and that stands there, by itself or by friction, until another crossing moves it on or back: it
 * has crossed once. A second level, half a metre on, is crossed where it goes on, and counts. */
static void test_what_stands_at_its_crossing(void) {
    dice d = dice_of("what stands", 5521);
    for (unsigned i = 0; i < dice_cases(usual_or(300, 60)); i++) {
        char text[900];
        const double level_m = dice_one_of(&d, 4) == 0 ? 0.0 : dice_between(&d, -1.0, 1.0);
        const double speed_mps = dice_between(&d, 0.8, 3.0);
        const double away_m = dice_between(&d, 0.05, 0.35);
        const double side = dice_one_of(&d, 2) == 0 ? 1.0 : -1.0;
        const double then_mps = dice_between(&d, 1.5, 3.0) * (dice_one_of(&d, 2) == 0 ? 1.0 : -1.0);
        const double moved_s = dice_between(&d, 0.5, 0.6);
        const bool rubs = dice_one_of(&d, 2) == 0;
        const char *direction = dice_one_of(&d, 2) == 0 ? "" : side > 0.0 ? "rising" : "falling";
        const double step_s = 0.001 * (1.0 + dice_one_of(&d, 20));
        const int steps = (int)(1.0 / step_s);
        snprintf(
            text, sizeof text,
            "mechanism m\ncoordinate x [m]\ncoordinate y [m]\n"
            "T = 1 [kg]*(x'^2 + y'^2)/2\n%s"
            "when x crosses %.17g [m] %s { set x' = 0 [m/s] }\n"
            "when y crosses 0 [m] rising { set x' = %.17g [m/s] }\n"
            "when x crosses %.17g [m] { set x' = x' }\n"
            "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [m], x' = %.17g [m/s]\n"
            "start y = %.17g [m], y' = 1 [m/s]\n}\n",
            rubs ? "friction x static 1 kinetic 1 normal 1e-5 [N]\n" : "", level_m, direction,
            then_mps, level_m + 0.5 * side, step_s, step_s * steps, level_m - away_m * side,
            speed_mps * side, -moved_s);
        motion m;
        motion_open_text(&m, text, i % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        const double way_m = then_mps * (step_s * steps - moved_s);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4, level_m + way_m, motion_value(&m, "x"), text);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-4, then_mps, motion_value(&m, "x'"), text);
        uint64_t overruns;
        const int on = way_m * side > 0.5;
        TEST_ASSERT_EQUAL_INT_MESSAGE(2 + on + (rubs ? 1 : 0),
                                      (int)m.kind->events(m.run, &overruns), text);
        motion_close(&m);
    }
}

/* A body that one crossing sets onto the level of another, and that goes on from there or back: only what it passed on its way
 * has crossed, not what it was set onto, nor is it crossed when left. */
static void test_what_is_set_onto_another(void) {
    dice d = dice_of("set onto", 5522);
    unsigned passed = 0;
    for (unsigned i = 0; i < dice_cases(usual_or(300, 60)); i++) {
        char text[900];
        const bool turns = dice_one_of(&d, 2) == 0;
        const double side = dice_one_of(&d, 2) == 0 ? 1.0 : -1.0;
        const double from = dice_between(&d, -1.0, 1.0);
        const double level = from + 0.3 * side;
        const double far = dice_between(&d, 0.05, 0.25);
        const double onto = level + (dice_one_of(&d, 2) == 0 ? far : -far);
        const double speed = side * dice_between(&d, 1.0, 3.0);
        const double then = dice_one_of(&d, 2) == 0 ? speed : -0.7 * speed;
        const unsigned way = (unsigned)dice_one_of(&d, 3); /* either, rising, falling */
        const int steps = 10 + (int)dice_one_of(&d, 200);
        const double end_s = 0.3 / fabs(speed) + 0.5 * far / fabs(then); /* half of the way back */
        const double step_s = end_s / steps;
        const char *unit = turns ? "rad" : "m";
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [%s]\nT = 1 [%s]*x'^2/2\n%s"
                 "when x crosses %.17g [%s] %s { set x = %.17g [%s], x' = %.17g [%s/s] }\n"
                 "when x crosses %.17g [%s] %s { set x' = x' }\n"
                 "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [%s], "
                 "x' = %.17g [%s/s]\n}\n",
                 unit, turns ? "kg*m^2" : "kg", turns ? "V = 1e-9 [J]*cos(x)\n" : "", level, unit,
                 side > 0.0 ? "rising" : "falling", onto, unit, then, unit, onto, unit,
                 way == 0   ? ""
                 : way == 1 ? "rising"
                            : "falling",
                 step_s, step_s * steps, from, unit, speed, unit);
        motion m;
        motion_open_text(&m, text, i % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        uint64_t overruns;
        const bool passes = (onto - level) * side < 0.0 && (way == 0 || (way == 1) == (side > 0.0));
        passed += passes;
        TEST_ASSERT_EQUAL_INT_MESSAGE(1 + passes, (int)m.kind->events(m.run, &overruns), text);
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(passed > 5);
}

/* Each bounce without loss throws a rate across a crossing of that rate, and between bounces it falls through it: two crossings
 * a bounce. */
static void test_what_impacts_throw_across(void) {
    dice d = dice_of("thrown across", 5523);
    unsigned bounced = 0;
    for (unsigned i = 0; i < dice_cases(usual_or(300, 60)); i++) {
        char text[900];
        const double height_m = dice_between(&d, 0.05, 0.5);
        const double g_mps2 = dice_between(&d, 1.0, 10.0);
        const double hit_mps = sqrt(2.0 * g_mps2 * height_m);
        const double level_mps = -hit_mps * dice_between(&d, 0.1, 0.9);
        const double step_s = 0.001 * (1.0 + dice_one_of(&d, 10));
        const int steps = (int)(3.0 / step_s);
        const double fall_s = hit_mps / g_mps2;
        const double passes_s = -level_mps / g_mps2;
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nQ(x) = %.17g [N]\n"
                 "stop x >= 0 [m] restitution 1\nwhen x' crosses %.17g [m/s] { set x' = x' }\n"
                 "scene s {\nstep %.17g [s]\nuntil %.17g [s]\nstart x = %.17g [m]\n}\n",
                 -g_mps2, level_mps, step_s, step_s * steps, height_m);
        /* falls for fall_s, then up and down again and again */
        const double end_s = step_s * steps;
        const int hits = end_s < fall_s ? 0 : 1 + (int)((end_s - fall_s) / (2.0 * fall_s));
        const double since_s = end_s - (hits == 0 ? 0.0 : fall_s + 2.0 * fall_s * (hits - 1));
        const double due_s = hits == 0 ? passes_s : fall_s + passes_s;
        const double next_s = hits == 0 ? fall_s : 2.0 * fall_s;
        if (fabs(since_s - due_s) < 1e-2 || since_s < 1e-2 || next_s - since_s < 1e-2) {
            continue; /* too near to tell, in float */
        }
        motion m;
        motion_open_text(&m, text, i % 2 == 0 ? IN_DOUBLE : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, (int)motion_step(&m, (uint64_t)steps), text);
        uint64_t overruns;
        bounced += hits > 1;
        TEST_ASSERT_EQUAL_INT_MESSAGE(3 * hits + (since_s > due_s),
                                      (int)m.kind->events(m.run, &overruns), text);
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(bounced > 10);
}

void suite_crossings(void) {
    RUN_TEST(test_what_is_set_onto_another);
    RUN_TEST(test_what_impacts_throw_across);
    RUN_TEST(test_what_stands_at_its_crossing);
    RUN_TEST(test_each_crossing_sets_its_own);
    RUN_TEST(test_what_turns_back_crosses_once);
}
