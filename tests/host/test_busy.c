/* test_busy.c: contacts with more events than a step can take, or with changes in each step. `whirl run` must warn
 * if a run is wrong for this reason, and must not warn if the run is right. With the proposed remedy, the warning
 * and the error must vanish. If no step helps, the scene is changed as proposed. Balls between two stops, holds that
 * end their own condition and stick-slip have closed forms. Random hybrids in coarse steps have hybrid.h as their
 * reference. */
#include "command.h"
#include "host/cli/commands.h"
#include "hybrid.h"
#include "motion.h"
#include "rattle.h"

/* A run is wrong if its error exceeds OFF, right if its error is below RIGHT; with the remedy, the error must be
 * below CURED. Errors are relative to the range of the motion. */
#define OFF 0.02
#define RIGHT 3e-3
#define CURED 5e-3
/* Round-off of the time of one bounce in float, relative to the gap: a few units in the last place. */
#define ROUNDED 1e-6

typedef struct measured {
    bool busy;
    double off;       /* largest error at any step, relative to the range */
    double looked_at; /* largest error at about thirty of the steps, relative to the range */
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
    for (uint64_t k = 1; k <= steps; k++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, 1), text);
        const double truth = rattle_truth_m(&r, (double)k * step_s);
        const double off = fabs(motion_value(&m, r.kind == BELT ? "y" : "x") - truth);
        low = k == 1 ? truth : fmin(low, truth);
        high = k == 1 ? truth : fmax(high, truth);
        made.off = fmax(made.off, off);
        made.looked_at = k % (1 + steps / 30) == 0 ? fmax(made.looked_at, off) : made.looked_at;
    }
    uint64_t overruns;
    (void)m.kind->events(m.run, &overruns);
    made.busy = overruns > 0;
    motion_close(&m);
    made.off /= high - low;
    made.looked_at /= high - low;
    return made;
}

static void say(const char *text, const char *step, bool is_float, said *what) {
    COMMAND_SAY(command_run, what, model_keep(text), "--quiet", "--number",
                is_float ? "float" : "double", step != NULL ? "--step" : NULL, step);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, text);
}

static bool is_told(const said *what) { return strstr(what->err, "warning: ") != NULL; }

/* Reads the proposed step. *is_float becomes false if the hint also names double. Returns false if no step is
 * proposed. */
static bool step_said(const said *what, char word[40], bool *is_float) {
    const char *hint = strstr(what->err, "\nhint: --step ");
    *is_float = *is_float && (hint == NULL || strstr(hint, "--number double") == NULL);
    return hint != NULL && sscanf(hint, "\nhint: --step %39s", word) == 1;
}

static double bounces_of(const rattle *r) {
    return r->kind == BALL ? fabs(r->speed_mps) * r->step_s * r->steps / r->number[0] : 0.0;
}

TEST(busy, busy_contacts_have_a_working_remedy) {
    dice d = dice_of("busy", 15005);
    const unsigned cases = dice_cases(few_or_all(usual_or(30, 10), 120));
    unsigned off = 0;
    unsigned right = 0;
    unsigned without = 0;
    for (unsigned i = 0; i < cases; i++) {
        const rattle r = rattle_drawn(&d, (rattle_kind)(i % KINDS));
        bool is_float = dice_one_of(&d, 4) == 0;
        char text[LINKAGE_TEXT];
        char about[LINKAGE_TEXT + SAID_SIZE + 100];
        char step[40];
        said what;
        rattle_write(&r, text);
        const measured seen = run_beside(&r, text, r.step_s, is_float);
        say(text, NULL, is_float, &what);
        snprintf(about, sizeof about, "%s%s, off by %.3g, %.3g at looks: %s\n%s", text,
                 is_float ? "float" : "double", seen.off, seen.looked_at,
                 seen.busy ? "busy" : "calm", what.err);
        if (seen.looked_at > OFF) {
            off++;
            TEST_ASSERT_TRUE_MESSAGE(is_told(&what), about);
            if (!step_said(&what, step, &is_float)) {
                without++;
                continue;
            }
            const measured then = run_beside(&r, text, said_step_s(step), is_float);
            say(text, step, is_float, &what);
            const double allowed = CURED + (is_float ? ROUNDED * bounces_of(&r) : 0.0);
            if (then.off >= allowed || what.err[0] != '\0') {
                printf("%s# with it off by %.3g: %s\n", about, then.off, what.err);
            }
            TEST_ASSERT_TRUE(then.off < allowed);
            TEST_ASSERT_EQUAL_STRING("", what.err);
        } else if (seen.off < RIGHT) {
            right++;
            TEST_ASSERT_FALSE_MESSAGE(is_told(&what), about);
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(off > cases / 6 && right > cases / 6);
    TEST_ASSERT_TRUE(without <= off / 10);
}

/* The ball would need a million events per step, or more. The scene is changed as the hint proposes. */
TEST(busy, hinted_scene_changes_end_the_warning) {
    dice d = dice_of("busy_scenes", 15002);
    const unsigned cases = dice_cases(few_or_all(usual_or(4, 3), 60));
    for (unsigned i = 0; i < cases; i++) {
        rattle r = rattle_drawn(&d, i % 2 == 0 ? BALL : HOLD);
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
        rattle_write(&r, text);
        say(text, NULL, false, &what);
        TEST_ASSERT_TRUE_MESSAGE(is_told(&what), text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "hint: use restitution 0, or add hysteresis"),
                                     what.err);
        if (r.kind == BALL) {
            r.number[2] = 0.0;
            r.number[3] = 0.0;
        } else {
            r.number[0] *= 10.0 * faster;
        }
        rattle_write(&r, text);
        say(text, NULL, false, &what);
        TEST_ASSERT_FALSE_MESSAGE(is_told(&what), what.err);
    }
    model_drop();
}

/* Largest error of the coordinates at the end, relative to the largest range of all bodies. *busy_one: did a step
 * have too many events? */
static double hybrid_off(const hybrid *h, const hybrid_motion *wanted, double step_s,
                         const char *text, bool *busy_one) {
    motion m;
    double most = 0.0;
    motion_open_text(&m, text,
                     (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s});
    double low[LINKAGE_BODIES] = {0.0};
    double high[LINKAGE_BODIES] = {0.0};
    char name[8];
    for (uint64_t k = 0; k <= m.image->steps; k++) {
        TEST_ASSERT_TRUE(k == 0 || motion_step(&m, 1) == WH_OK);
        for (int i = 0; i < h->of.bodies; i++) {
            snprintf(name, sizeof name, "q%d", i);
            const double q = motion_value(&m, name);
            low[i] = k == 0 ? q : fmin(low[i], q);
            high[i] = k == 0 ? q : fmax(high[i], q);
        }
    }
    double range = 1e-300;
    for (int i = 0; i < h->of.bodies; i++) {
        range = fmax(range, high[i] - low[i]);
    }
    for (int k = 0; k < h->of.bodies; k++) {
        snprintf(name, sizeof name, "q%d", k);
        most = fmax(most, fabs(motion_value(&m, name) - (double)wanted->state[k]) / range);
    }
    uint64_t overruns;
    (void)m.kind->events(m.run, &overruns);
    *busy_one = overruns > 0;
    motion_close(&m);
    return most;
}

TEST(busy, hybrids_in_coarse_steps) {
    dice d = dice_of("busy_hybrids", 15003);
    const unsigned cases = dice_cases(few_or_all(usual_or(6, 4), 60));
    uint64_t seed = d.state;
    unsigned tried = 0;
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
        say(text, i % 2 == 0 ? "25ms" : "5ms", false, &what);
        if (is_busy && off > OFF) {
            TEST_ASSERT_TRUE_MESSAGE(is_told(&what), text);
        } else if (off < RIGHT) {
            TEST_ASSERT_FALSE_MESSAGE(is_told(&what), what.err);
        }
        bool is_float = false;
        if (is_told(&what) && step_said(&what, step, &is_float)) {
            const double cured = hybrid_off(&h, &wanted, said_step_s(step), text, &is_busy);
            say(text, step, false, &what);
            TEST_ASSERT_FALSE_MESSAGE(is_told(&what), what.err);
            TEST_ASSERT_TRUE_MESSAGE(cured < CURED, text);
        }
    }
    model_drop();
    TEST_ASSERT_TRUE(tried > cases / 2);
}
