/* test_busy.c: contacts with more events than a step takes, or that change at the pace of the steps: `whirl run` warns
 * where the run is off for that, on both sides, and what it says would do is done: then nothing is said and the error is
 * gone. Where no step would do, the scene is changed as it says. Drawn balls between two stops, holds that end their own
 * condition, and stick-slip, against closed forms; and drawn hybrids in coarse steps, against another program. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/commands/commands.h"
#include "host/run/busy.h"
#include "hybrid.h"
#include "motion.h"
#include "unity.h"

void suite_busy(void);

/* Off by so much of its range, a busy run is told; by less than that, it is not. */
#define OFF 0.02
#define RIGHT 3e-3
#define CURED 5e-3
/* What a bounce's moment rounds in float, of the gap: some units of the last place. */
#define ROUNDED 1e-6

typedef enum rattle_kind { BALL, HOLD, BELT, KINDS } rattle_kind;

/* A mechanism with a closed form, which goes on from where it is. */
typedef struct rattle {
    rattle_kind kind;
    double number
        [6]; /* ball: gap, gravity, restitutions below and above; hold: threshold, acceleration; belt: stiffness,
                       * speed, friction static and kinetic */
    double step_s;
    int steps;
    double at_s; /* of the ball's */
    double place_m;
    double speed_mps;
} rattle;

static rattle drawn(dice *d, rattle_kind kind) {
    rattle r = {.kind = kind, .step_s = pow(10.0, dice_between(d, -4.0, -2.0))};
    double *n = r.number;
    r.steps = 40 + (int)dice_one_of(d, 160);
    if (kind == BALL) {
        n[0] = pow(10.0, dice_between(d, -3.5, -1.7));
        n[1] = dice_one_of(d, 2) == 0 ? 0.0 : 9.81;
        n[2] = dice_one_of(d, 2) == 0 ? 1.0 : dice_between(d, 0.6, 1.0);
        n[3] = dice_one_of(d, 2) == 0 ? 1.0 : dice_between(d, 0.6, 1.0);
        r.place_m = n[0] * dice_between(d, 0.2, 0.8);
        r.speed_mps = n[0] / r.step_s * pow(10.0, dice_between(d, -0.5, 2.0));
    } else if (kind == HOLD) {
        n[1] = dice_between(d, 1.0, 20.0);
        n[0] = n[1] * r.step_s * pow(10.0, dice_between(d, -2.0, 1.0));
    } else {
        n[0] = pow(10.0, dice_between(d, -1.5, 0.3)) / r.step_s;
        n[0] *= n[0];
        n[2] = 0.4;
        n[3] = dice_between(d, 0.2, 0.35);
        n[1] = (n[2] - n[3]) * 9.81 / sqrt(n[0]) * dice_between(d, 0.5, 3.0);
    }
    return r;
}

static void write(const rattle *r, char text[static LINKAGE_TEXT]) {
    const double *n = r->number;
    char more[600];
    if (r->kind == BALL) {
        snprintf(more, sizeof more,
                 "coordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N]*x\n"
                 "stop x >= 0 [m] restitution %.17g\nstop x <= %.17g [m] restitution %.17g\n"
                 "scene s { start x = %.17g [m], x' = %.17g [m/s]\n",
                 n[1], n[2], n[0], n[3], r->place_m, r->speed_mps);
    } else if (r->kind == HOLD) {
        snprintf(more, sizeof more,
                 "coordinate x [m]\nT = 1 [kg]*x'^2/2\nQ(x) = %.17g [N]\n"
                 "hold x while x' > %.17g [m/s]\nscene s { start x = 0\n",
                 n[1], n[0]);
    } else {
        snprintf(more, sizeof more,
                 "coordinate b [m]\ncoordinate y [m]\nT = 1 [kg]*b'^2/2 + 1 [kg]*y'^2/2\n"
                 "Q(y) = -%.17g [N/m]*(y + b)\n"
                 "friction y static %.17g kinetic %.17g normal 9.81 [N]\n"
                 "scene s { start b' = %.17g [m/s]\n",
                 n[0], n[2], n[3], n[1]);
    }
    snprintf(text, LINKAGE_TEXT, "mechanism rattle\n%sstep %.17g [s]\nuntil %.17g [s] }\n", more,
             r->step_s, r->step_s * r->steps);
}

/* --- closed forms ------------------------------------------------------------------------------------------*/

/* From stop to stop along parabolas. */
static double ball_m(rattle *r, double t) {
    const double gap = r->number[0];
    const double g = r->number[1];
    for (;;) {
        const double z = r->place_m;
        const double v = r->speed_mps;
        const double up = v * v - 2.0 * g * (gap - z);
        const bool rises = v > 0.0 && up >= 0.0;
        double next = (double)INFINITY;
        if (rises) {
            next = g > 0.0 ? 2.0 * (gap - z) / (v + sqrt(up)) : (gap - z) / v;
        } else if (g > 0.0) {
            next = (v + sqrt(v * v + 2.0 * g * z)) / g;
        } else if (v < 0.0) {
            next = z / -v;
        }
        if (r->at_s + next > t || (z == 0.0 && next < 1e-10)) {
            const double dt = z == 0.0 && next < 1e-10 ? 0.0 : t - r->at_s;
            return z + v * dt - g * dt * dt / 2.0;
        }
        r->at_s += next;
        r->place_m = rises ? gap : 0.0;
        r->speed_mps = -(v - g * next) * r->number[rises ? 3 : 2];
    }
}

static double hold_m(const rattle *r, double t) {
    const double period = r->number[0] / r->number[1];
    const double rest = fmod(t, period);
    return (t - rest) / period * r->number[0] * period / 2.0 + r->number[1] * rest * rest / 2.0;
}

/* On the belt. Sticks until the spring pulls with the static friction, swings about where it pulls with the kinetic one, and is caught
 * again where it goes with the belt. */
static double belt_m(const rattle *r, double t) {
    const double *n = r->number;
    const double w = sqrt(n[0]);
    const double breaks = n[2] * 9.81 / n[0];
    const double middle = n[3] * 9.81 / n[0];
    const double above = breaks - middle;
    const double slip = (3.14159265358979323846 + 2.0 * atan(n[1] / (w * above))) / w;
    if (t < breaks / n[1]) {
        return 0.0;
    }
    const double cycle = slip + 2.0 * above / n[1];
    const double in = fmod(t - breaks / n[1], cycle);
    const double x = in < slip ? middle + above * cos(w * in) + n[1] / w * sin(w * in)
                               : middle - above + n[1] * (in - slip);
    return x - n[1] * t;
}

static double truth_m(rattle *r, double t) {
    return r->kind == BALL ? ball_m(r, t) : r->kind == HOLD ? hold_m(r, t) : belt_m(r, t);
}

/* --- a run beside it ------------------------------------------------------------------------------------------*/

typedef struct measured {
    bool busy;
    double off;       /* at every step, of the range */
    double looked_at; /* at 32 of them */
} measured;

static measured run_beside(const rattle *of, const char *text, double step_s, bool is_float) {
    rattle r = *of;
    motion m;
    measured made = {0};
    double low = 0.0;
    double high = 0.0;
    const uint64_t steps = (uint64_t)(r.step_s * r.steps / step_s + 0.5);
    motion_open_text(&m, text,
                     (stepping){.kind = is_float ? &engine_float : &engine_double,
                                .method = WH_RK4,
                                .step_s = step_s});
    busy *b = busy_open(m.image, 1);
    busy_enter(b, m.kind, m.run, 0.0);
    for (uint64_t k = 1; k <= steps; k++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, 1), text);
        busy_enter(b, m.kind, m.run, 0.0);
        const double truth = truth_m(&r, (double)k * step_s);
        const double off = fabs(motion_value(&m, r.kind == BELT ? "y" : "x") - truth);
        low = k == 1 ? truth : fmin(low, truth);
        high = k == 1 ? truth : fmax(high, truth);
        made.off = fmax(made.off, off);
        made.looked_at = k % (1 + steps / 30) == 0 ? fmax(made.looked_at, off) : made.looked_at;
    }
    made.busy = b->overruns > 0 || b->chatters >= 0;
    busy_close(b);
    motion_close(&m);
    made.off /= high - low;
    made.looked_at /= high - low;
    return made;
}

static void say(const char *text, const char *step, bool is_float, said *what) {
    const char *words[] = {model_keep(text),
                           "--quiet",
                           "--number",
                           is_float ? "float" : "double",
                           step != NULL ? "--step" : NULL,
                           step,
                           NULL};
    command_say(command_run, words, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, what->status, text);
}

/* Of the contacts, not of the energy. */
static bool is_told(const said *what) {
    return strstr(what->err, "moments with events") != NULL ||
           strstr(what->err, "at the pace of the steps") != NULL;
}

/* The step behind the warning of contacts; false when it names none. */
static bool step_said(const said *what, char word[40]) {
    const char *about = strstr(what->err, "moments with events, most of");
    about = about != NULL ? about : strstr(what->err, "at the pace of the steps");
    const char *hint = about != NULL ? strstr(about, "\nhint: --step ") : NULL;
    return hint != NULL && sscanf(hint, "\nhint: --step %39s", word) == 1;
}

/* How often a ball passes its gap, at most: it may do so thousands of times. */
static double bounces_of(const rattle *r) {
    return r->kind == BALL ? fabs(r->speed_mps) * r->step_s * r->steps / r->number[0] : 0.0;
}

static void test_busy_contacts_are_told_and_cured(void) {
    dice d = dice_of("busy", 15005);
    const unsigned cases = dice_cases(few_or_all(30, 120));
    unsigned off = 0;
    unsigned right = 0;
    unsigned cured = 0;
    unsigned without = 0;
    double worst = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const rattle r = drawn(&d, (rattle_kind)(i % KINDS));
        const bool is_float = dice_one_of(&d, 4) == 0;
        char text[LINKAGE_TEXT];
        char about[LINKAGE_TEXT + SAID_SIZE + 100];
        char step[40];
        said what;
        write(&r, text);
        const measured seen = run_beside(&r, text, r.step_s, is_float);
        say(text, NULL, is_float, &what);
        snprintf(about, sizeof about, "%s%s, off by %.3g, %.3g at looks: %s\n%s", text,
                 is_float ? "float" : "double", seen.off, seen.looked_at,
                 seen.busy ? "busy" : "calm", what.err);
        if (seen.busy && seen.looked_at > OFF) {
            off++;
            TEST_ASSERT_TRUE_MESSAGE(is_told(&what), about);
            if (!step_said(&what, step)) {
                without++;
                continue;
            }
            const measured then = run_beside(&r, text, said_step_s(step), is_float);
            cured++;
            worst = fmax(worst, then.off);
            say(text, step, is_float, &what);
            const double allowed = CURED + (is_float ? ROUNDED * bounces_of(&r) : 0.0);
            if (then.off >= allowed || what.err[0] != '\0') {
                printf("%s# with it off by %.3g: %s\n", about, then.off, what.err);
            }
            TEST_ASSERT_TRUE(then.off < allowed);
            TEST_ASSERT_EQUAL_STRING("", what.err);
        } else if (seen.off < RIGHT || !seen.busy) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(is_told(&what), about);
        }
    }
    model_drop();
    printf("  %u runs: %u off for their contacts, all told; %u cured by the step that was named, "
           "to %.1e of their range, %u without one; %u calm or right, not told\n",
           cases, off, cured, worst, without, right);
    TEST_ASSERT_TRUE(off > cases / 6 && right > cases / 6);
    TEST_ASSERT_TRUE(without <= off / 10);
}

/* --- where no step would do ---------------------------------------------------------------------------------*/

/* A million events a step and more; what the warning says of the scene is done. */
static void test_where_no_step_helps_the_scene_is_changed(void) {
    dice d = dice_of("busy_scenes", 15002);
    const unsigned cases = dice_cases(few_or_all(usual_or(4, 3), 60));
    for (unsigned i = 0; i < cases; i++) {
        static const char *const words[] = {"ends its bounces", "take longer to come true again"};
        rattle r = drawn(&d, i % 2 == 0 ? BALL : HOLD);
        const double faster = pow(10.0, dice_between(&d, 5.0, 7.0));
        char text[LINKAGE_TEXT];
        said what;
        if (r.kind == BALL) {
            r.speed_mps = r.number[0] / r.step_s * faster;
            r.number[1] = 0.0;
            r.number[2] = 1.0;
            r.number[3] = 1.0;
        } else {
            r.number[0] = r.number[1] * r.step_s / faster;
        }
        write(&r, text);
        say(text, NULL, false, &what);
        TEST_ASSERT_TRUE_MESSAGE(is_told(&what), text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, words[r.kind]), what.err);
        if (r.kind == BALL) {
            const char *upper = strstr(what.err, "restitution 0 of 'stop x <= ");
            const char *lower = strstr(what.err, "restitution 0 of 'stop x >= ");
            TEST_ASSERT_TRUE_MESSAGE((upper == NULL) != (lower == NULL), what.err);
            r.number[upper != NULL ? 3 : 2] = 0.0;
        } else {
            r.number[0] *= 10.0 * faster;
        }
        write(&r, text);
        say(text, NULL, false, &what);
        TEST_ASSERT_FALSE_MESSAGE(is_told(&what), what.err);
    }
    model_drop();
}

/* --- hybrids ----------------------------------------------------------------------------------------------------*/

/* The most that a coordinate ends off the other program's, of how far it went; *busy_one: its contacts were. */
static double hybrid_off(const hybrid *h, const hybrid_motion *wanted, double step_s,
                         const char *text, bool *busy_one) {
    motion m;
    double most = 0.0;
    motion_open_text(&m, text,
                     (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s});
    busy *b = busy_open(m.image, 1);
    for (uint64_t k = 0; k <= m.image->steps; k++) {
        TEST_ASSERT_TRUE(k == 0 || motion_step(&m, 1) == WH_OK);
        busy_enter(b, m.kind, m.run, 0.0);
    }
    for (int k = 0; k < h->of.bodies; k++) {
        char name[8];
        snprintf(name, sizeof name, "q%d", k);
        const double off = fabs(motion_value(&m, name) - (double)wanted->state[k]);
        double range = 1e-300;
        for (int i = 0; i < b->n; i++) { /* of others, too: what hardly moves is no measure */
            range = fmax(range, b->high[i] - b->low[i]);
        }
        most = fmax(most, off / range);
    }
    *busy_one = b->overruns > 0 || b->chatters >= 0;
    busy_close(b);
    motion_close(&m);
    return most;
}

static void test_hybrids_in_coarse_steps(void) {
    dice d = dice_of("busy_hybrids", 15003);
    const unsigned cases = dice_cases(few_or_all(usual_or(6, 4), 60));
    uint64_t seed = d.state;
    unsigned tried = 0;
    unsigned busy_ones = 0;
    unsigned told = 0;
    double worst = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        char statements[HYBRID_TEXT];
        char text[LINKAGE_TEXT];
        char step[40];
        said what;
        bool is_busy;
        const double step_s = i % 2 == 0 ? 25e-3 : 5e-3;
        const hybrid h = hybrid_draw(&seed);
        const hybrid_motion wanted = hybrid_move(&h, HYBRID_STEP_S, 0.5, 1e-5);
        if (wanted.aside || h.contacts == 0) {
            continue;
        }
        tried++;
        hybrid_statements(&h, statements);
        linkage_write(&h.of, "hybrid", (linkage_writing){LINKAGE_INSIDE, .more = statements}, text);
        const double off = hybrid_off(&h, &wanted, step_s, text, &is_busy);
        busy_ones += is_busy ? 1U : 0U;
        say(text, i % 2 == 0 ? "25ms" : "5ms", false, &what);
        if (is_busy && off > OFF) {
            TEST_ASSERT_TRUE_MESSAGE(is_told(&what), text);
        } else if (!is_busy) {
            TEST_ASSERT_FALSE_MESSAGE(is_told(&what), what.err);
        }
        told += is_told(&what) ? 1U : 0U;
        if (is_told(&what) && step_said(&what, step)) {
            const double cured = hybrid_off(&h, &wanted, said_step_s(step), text, &is_busy);
            say(text, step, false, &what);
            TEST_ASSERT_FALSE_MESSAGE(is_told(&what), what.err);
            worst = fmax(worst, cured);
            TEST_ASSERT_TRUE_MESSAGE(cured < CURED, text);
        }
    }
    model_drop();
    printf("  %u hybrids in coarse steps: %u busy, %u told, cured to %.1e\n", tried, busy_ones,
           told, worst);
    TEST_ASSERT_TRUE(tried > cases / 2);
}

void suite_busy(void) {
    RUN_TEST(test_busy_contacts_are_told_and_cured);
    RUN_TEST(test_where_no_step_helps_the_scene_is_changed);
    RUN_TEST(test_hybrids_in_coarse_steps);
}
