/* test_chattered.c: what is kept of contacts that are too busy for their steps (host/run/busy.h), of runs that are made up: any
 * events, any states. Who changes at the pace of the steps, from when on, what steps overran by and who filled them, and how far
 * a run is off another are counted over all steps at once; and what is said of it is that (busy_text.h), to the word. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks.h"
#include "command.h"
#include "core/contact.h"
#include "derived.h"
#include "host/run/busy.h"
#include "host/run/busy_text.h"
#include "unity.h"

void suite_chattered(void);

static dice die;

enum { STEPS_MOST = 200, CONTACTS = 5, EVENTS_MOST = 6, COMPONENTS = 6 };

static const char *const four =
    "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ncoordinate q\n"
    "T = 1 [kg]*x'^2/2 + 1 [kg]*y'^2/2 + 1 [kg*m^2]*q'^2/2\n"
    "stop x >= -9 [m] restitution 0.5\nhold y while y' > 5 [m/s]\n"
    "friction x static 0.4 kinetic 0.3 normal 9.81 [N]\nwhen y crosses 7 [m] { set y' = 0 }\n"
    "stop q >= -7 restitution 0.2\n"
    "scene s { step 20 [ms]; until %.2f [s] }\n";

static const char *const statement[CONTACTS] = {
    "stop x >= -9 [m] restitution 0.5", "hold y while y' > 5 [m/s]",
    "friction x static 0.4 kinetic 0.3 normal 9.81 [N]", "when y crosses 7 [m] { set y' = 0 }",
    "stop q >= -7 restitution 0.2"};

static const wh_contact_kind kind_of[CONTACTS] = {WH_STOP, WH_HOLD, WH_FRICTION, WH_WHEN, WH_STOP};

/* Which of these is the image's contact k: it has them by kind. */
static int declared[CONTACTS];

/* The unit in which each component counts: places, then rates. */
static const int unit_of[COMPONENTS] = {0, 0, 1, 2, 2, 3};

/* --- a run that is made up ------------------------------------------------------------------------------------------*/

typedef struct story {
    int steps;
    int parts; /* of a step of the run that is judged */
    int at;    /* done */
    int events[STEPS_MOST + 1];
    engine_event event[STEPS_MOST + 1][EVENTS_MOST];
    bool overran[STEPS_MOST + 1];
    double energy_J[STEPS_MOST + 1];
    double state[STEPS_MOST + 1][COMPONENTS];
} story;

static void told_state(const void *run, double *angle_rad, double *real) {
    const story *s = run;
    (void)angle_rad; /* there is none */
    memcpy(real, s->state[s->at], sizeof s->state[s->at]);
}

static uint64_t told_steps(const void *run) { return (uint64_t)((const story *)run)->at; }

static uint64_t told_events(const void *run, uint64_t *overruns) {
    const story *s = run;
    *overruns = 0;
    for (int k = 1; k <= s->at; k++) {
        *overruns += s->overran[k] ? 1U : 0U;
    }
    return 0;
}

static int told_happened(const void *run, engine_event *list) {
    const story *s = run;
    memcpy(list, s->event[s->at], sizeof s->event[s->at]);
    return s->events[s->at];
}

static const engine_kind made_up = {.name = "made up",
                                    .state = told_state,
                                    .steps = told_steps,
                                    .events = told_events,
                                    .happened = told_happened};

/* Contacts of unlike zeal, each of them for a part of the run. */
static void draw_events(story *s) {
    double zeal[CONTACTS];
    int begins[CONTACTS];
    const bool overruns = dice_one_of(&die, 2) == 0;
    for (int k = 0; k < CONTACTS; k++) {
        zeal[k] = dice_one_of(&die, 3) == 0 ? 0.0 : dice_between(&die, 0.05, 0.9);
        begins[k] = (int)dice_one_of(&die, (unsigned)s->steps);
    }
    for (int i = 1; i <= s->steps; i++) {
        s->events[i] = 0;
        s->overran[i] = overruns && dice_one_of(&die, 7) == 0;
        for (int k = 0; k < CONTACTS; k++) {
            while (i > begins[k] && s->events[i] < EVENTS_MOST &&
                   dice_between(&die, 0.0, 1.0) < zeal[k]) {
                s->event[i][s->events[i]++] =
                    (engine_event){.contact = k, .mode = (int)dice_one_of(&die, 3) - 1};
            }
        }
    }
}

static void draw_motion(story *s) {
    double size[COMPONENTS];
    for (int c = 0; c < COMPONENTS; c++) {
        size[c] = exp(dice_between(&die, -9.0, 3.0));
    }
    for (int i = 0; i <= s->steps; i++) {
        s->energy_J[i] = dice_between(&die, -1.0, 1.0);
        for (int c = 0; c < COMPONENTS; c++) {
            s->state[i][c] = size[c] * dice_between(&die, -1.0, 1.0);
        }
    }
}

static busy *entered(const image *im, story *s) {
    busy *b = busy_open(im, (uint64_t)s->parts);
    for (s->at = 0; s->at <= s->steps; s->at++) {
        busy_enter(b, &made_up, s, s->energy_J[s->at]);
    }
    return b;
}

/* --- what is known of it --------------------------------------------------------------------------------------------*/

/* Did contact k change its mode in step i? From the first on that is known; a hold with each; a crossing never. */
static bool changed(const story *s, int k, int i) {
    int known = WH_UNSET;
    bool other = false;
    for (int j = 1; j <= i; j++) {
        other = false;
        for (int e = 0; e < s->events[j]; e++) {
            if (s->event[j][e].contact == k) {
                other = other || kind_of[declared[k]] == WH_HOLD ||
                        (known != WH_UNSET && known != s->event[j][e].mode);
                known = s->event[j][e].mode;
            }
        }
    }
    return other && kind_of[declared[k]] != WH_WHEN;
}

/* In at least four of the sixteen steps that end with step i, which is one of them. */
static bool at_pace(const bool *changes, int i) {
    int count = 0;
    for (int j = i; j > i - BUSY_WINDOW && j > 0; j--) {
        count += changes[j] ? 1 : 0;
    }
    return changes[i] && count >= BUSY_CHANGES;
}

static void expect_chatter(const story *s, const busy *b) {
    uint64_t most = 0;
    int first = -1;
    for (int k = 0; k < CONTACTS; k++) {
        bool changes[STEPS_MOST + 1];
        uint64_t count = 0;
        for (int i = 1; i <= s->steps; i++) {
            changes[i] = changed(s, k, i);
        }
        for (int i = 1; i <= s->steps; i++) {
            if (at_pace(changes, i)) {
                count++;
                first = first < 0 || i < first ? i : first;
            }
        }
        TEST_ASSERT_EQUAL_UINT64(count, b->changes[k]);
        most = count > most ? count : most;
    }
    TEST_ASSERT_EQUAL(first >= 0, b->chatters >= 0);
    if (first >= 0) {
        TEST_ASSERT_EQUAL_UINT64((uint64_t)first, b->chatters_at);
        TEST_ASSERT_EQUAL_UINT64(most, b->changes[b->chatters]);
    }
}

static void expect_overruns(const story *s, const busy *b) {
    uint64_t count = 0;
    uint64_t of[CONTACTS] = {0};
    double taken_J = 0.0;
    for (int i = s->steps; i > 0; i--) {
        if (s->overran[i]) {
            count++;
            taken_J += fabs(s->energy_J[i] - s->energy_J[i - 1]);
            for (int e = 0; e < s->events[i]; e++) {
                of[s->event[i][e].contact]++;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT64(count, b->overruns);
    TEST_ASSERT_EQUAL_UINT64((uint64_t)s->steps, b->steps);
    TEST_ASSERT_TRUE(fabs(taken_J - b->taken_J) <= 1e-12 * taken_J);
    for (int k = 0; k < CONTACTS; k++) {
        TEST_ASSERT_EQUAL_UINT64(of[k], b->in_overruns[k]);
    }
    if (count > 0) { /* steps before the first */
        int before = 0;
        while (!s->overran[before + 1]) {
            before++;
        }
        TEST_ASSERT_EQUAL_UINT64((uint64_t)before, b->overran_at);
    }
}

static double range_of(const story *s, int c) {
    double low = s->state[0][c];
    double high = low;
    for (int i = 1; i <= s->steps; i++) {
        low = fmin(low, s->state[i][c]);
        high = fmax(high, s->state[i][c]);
    }
    return high - low;
}

/* Places at up to 32 times alike, the start and the end among them, by how far the right run went; what hardly moves by a
 * thousandth of how far others of its unit went. */
static double off_by(const story *run, const story *right) {
    double most = 0.0;
    const int parts = right->steps / run->steps;
    int stride = 1;
    while (run->steps > stride * BUSY_LOOKS) {
        stride++;
    }
    for (int c = 0; c < COMPONENTS / 2; c++) {
        double range = range_of(right, c);
        for (int other = 0; other < COMPONENTS; other++) {
            if (unit_of[other] == unit_of[c]) {
                range = fmax(range, 1e-3 * range_of(right, other));
            }
        }
        for (int i = 0; i <= run->steps;
             i += i + stride > run->steps && i < run->steps ? run->steps - i : stride) {
            most = fmax(most, fabs(run->state[i][c] - right->state[i * parts][c]) / range);
        }
    }
    return most;
}

static story *drawn_story(int steps, int parts) {
    story *s = calloc(1, sizeof *s);
    TEST_ASSERT_NOT_NULL(s);
    s->steps = steps;
    s->parts = parts;
    draw_events(s);
    draw_motion(s);
    return s;
}

static derived scene_of(int steps) {
    char text[900];
    snprintf(text, sizeof text, four, 0.02 * steps);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    TEST_ASSERT_EQUAL_INT(CONTACTS, d.image->contacts);
    for (int k = 0; k < CONTACTS; k++) {
        declared[k] = (int)d.image->contact[k].at.line - 6;
        TEST_ASSERT_EQUAL_INT(kind_of[declared[k]], d.image->contact[k].kind);
    }
    return d;
}

static void test_what_is_kept(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 10)); c++) {
        const int steps = 20 + (int)dice_one_of(&die, STEPS_MOST - 20);
        derived d = scene_of(steps);
        const long before = blocks_in_use();
        story *s = drawn_story(steps, 1);
        busy *b = entered(d.image, s);
        expect_chatter(s, b);
        expect_overruns(s, b);
        for (int i = 0; i < COMPONENTS; i++) {
            TEST_ASSERT_TRUE(b->high[i] - b->low[i] == range_of(s, i));
        }
        busy_close(b);
        free(s);
        TEST_ASSERT_EQUAL_INT(before, blocks_in_use());
        derived_free(&d);
    }
}

static void test_how_far_apart(void) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 10)); c++) {
        const int parts = 1 + (int)dice_one_of(&die, 4);
        const int steps = 1 + (int)dice_one_of(&die, (unsigned)(STEPS_MOST / parts));
        derived d = scene_of(steps);
        derived finer = scene_of(steps * parts);
        story *s = drawn_story(steps, 1);
        story *right = drawn_story(steps * parts, parts);
        busy *b = entered(d.image, s);
        busy *truth = entered(finer.image, right);
        const double off = off_by(s, right);
        TEST_ASSERT_TRUE(fabs(off - busy_off(b, truth)) <= 1e-12 * off);
        TEST_ASSERT_TRUE(busy_off(b, b) == 0.0);
        busy_close(b);
        busy_close(truth);
        free(s);
        free(right);
        derived_free(&d);
        derived_free(&finer);
    }
}

/* --- what is said of it ---------------------------------------------------------------------------------------------*/

static int most_of(const busy *b, int besides) {
    int found = -1;
    for (int k = CONTACTS - 1; k >= 0; k--) {
        const bool more = found < 0 || b->in_overruns[k] >= b->in_overruns[found];
        found = k != besides && b->in_overruns[k] > 0 && more ? k : found;
    }
    return found;
}

static int said_many(char *text, const busy *b) {
    const int first = most_of(b, -1);
    const int second = first < 0 ? -1 : most_of(b, first);
    char most[200] = "what shares a load";
    if (second >= 0) {
        snprintf(most, sizeof most, "'%s' and '%s'", statement[declared[first]],
                 statement[declared[second]]);
    } else if (first >= 0) {
        snprintf(most, sizeof most, "'%s'", statement[declared[first]]);
    }
    return snprintf(text, 700,
                    "whoever: %d step%s of %d, the first at t = %.6g s, had more than %d moments "
                    "with events, most of %s: what was left of %s counts as rest or sticking",
                    (int)b->overruns, b->overruns > 1 ? "s" : "", (int)b->steps,
                    0.02 * (double)b->overran_at, WH_EVENTS_MAX, most,
                    b->overruns > 1 ? "them" : "it");
}

/* What was tried beside it names steps of its own where they do all, and nothing where that is not known. */
static const char other_step[] = "--step 7us --number double";
static const char *const all_of_it[] = {
    [CURE_DOES] = "would do",
    [CURE_DOES_NOT] = "resolves that, but is not all that it takes",
    [CURE_ROUNDS] = "resolves that, but is not all that it takes",
    [CURE_NOT_TRIED] = "resolves that; whether that is all was not tried: it takes long"};

static void said_cure(char *text, const busy *b, const retrial *r, const busy_cure *tried) {
    static const char *const ends[CONTACTS] = {
        "restitution 0 of '%s' ends its bounces",
        "let the condition of '%s' take longer to come true again once it has held",
        "a static friction that it does not break, or a softer drive, ends what '%s' does",
        "let '%s' set what takes longer to cross again", "restitution 0 of '%s' ends its bounces"};
    if (r->parts > 0) { /* 20 ms in so many parts: whole microseconds */
        const int us = 20000 / (int)r->parts;
        const char *does = all_of_it[tried == NULL ? CURE_DOES : tried->outcome];
        if (tried != NULL && tried->outcome == CURE_DOES) {
            snprintf(text, 500, "hint: %s would do", other_step);
        } else if (us < 1000) {
            snprintf(text, 500, "hint: --step %dus %s", us, does);
        } else {
            snprintf(text, 500, "hint: --step %gms %s", us / 1000.0, does);
        }
        strcat(text, r->agreed ? "" : ", as far as the steps go: still finer ones end elsewhere");
    } else if (r->finest > 1) {
        const int busiest = most_of(b, -1);
        const int k = b->overruns == 0 ? b->chatters : busiest < 0 ? 0 : busiest;
        const int at = snprintf(text, 500, "hint: steps down to %gus do not resolve it; ",
                                20000.0 / (double)r->finest);
        snprintf(text + at, (size_t)(500 - at), ends[declared[k]], statement[declared[k]]);
    } else {
        strcpy(text,
               "hint: a smaller --step; which was not tried, as it takes longer than a second");
    }
}

static void expect_said(const busy *b, const retrial *r, const busy_cure *tried) {
    char wanted[1500] = "";
    char cure[500];
    char *is = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&is, &size);
    busy_say(out, "whoever", b, r, tried);
    fclose(out);
    if (r->told) {
        int at;
        if (b->overruns > 0) {
            at = said_many(wanted, b);
        } else {
            at = snprintf(wanted, sizeof wanted,
                          "whoever: '%s' changes at the pace of the steps, in %d of %d steps from "
                          "t = %.6g s on",
                          statement[declared[b->chatters]], (int)b->changes[b->chatters],
                          (int)(b->steps - b->chatters_at), 0.02 * (double)b->chatters_at);
        }
        if (r->known) {
            at += snprintf(wanted + at, sizeof wanted - (size_t)at,
                           "; finer steps end elsewhere, by %.2g of a coordinate's range", r->off);
        }
        said_cure(cure, b, r, tried);
        snprintf(wanted + at, sizeof wanted - (size_t)at, "\n%s\n", cure);
    }
    TEST_ASSERT_EQUAL_STRING(wanted, is);
    free(is);
}

static void test_what_is_said(void) {
    static const uint64_t parts[] = {0, 0, 0, 2, 5, 20, 50};
    unsigned said_of[2] = {0};
    for (unsigned c = 0; c < dice_cases(usual_or(80, 40)); c++) {
        const int steps = 20 + (int)dice_one_of(&die, STEPS_MOST - 20);
        derived d = scene_of(steps);
        story *s = drawn_story(steps, 1);
        if (dice_one_of(&die, 4) == 0) { /* one that nothing is known to be behind */
            s->overran[steps] = true;
            s->events[steps] = 0;
        }
        busy *b = entered(d.image, s);
        if (b->overruns > 0 || b->chatters >= 0) {
            const retrial r = {.told = dice_one_of(&die, 9) > 0,
                               .known = dice_one_of(&die, 2) == 0,
                               .off = dice_between(&die, 0.01, 3.0),
                               .parts = parts[dice_one_of(&die, 7)],
                               .finest = dice_one_of(&die, 4) == 0 ? 1U : 100U,
                               .agreed = dice_one_of(&die, 2) == 0};
            const unsigned outcome = dice_one_of(&die, CURE_NOT_TRIED + 2);
            const busy_cure tried = {other_step, (cure_outcome)(outcome % (CURE_NOT_TRIED + 1))};
            expect_said(b, &r, outcome > CURE_NOT_TRIED ? NULL : &tried);
            said_of[b->overruns > 0 ? 1 : 0]++;
        }
        busy_close(b);
        free(s);
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(said_of[0] > 0 && said_of[1] > 0);
}

static void test_none_without_contacts(void) {
    derived d = derived_scene("mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\n"
                              "scene s { step 20 [ms]; until 1 [s] }\n",
                              "s");
    TEST_ASSERT_NULL(busy_open(d.image, 1));
    busy_enter(NULL, &made_up, NULL, 0.0);
    busy_close(NULL);
    derived_free(&d);
}

void suite_chattered(void) {
    die = dice_of("chattered", 92);
    RUN_TEST(test_what_is_kept);
    RUN_TEST(test_how_far_apart);
    RUN_TEST(test_what_is_said);
    RUN_TEST(test_none_without_contacts);
}
