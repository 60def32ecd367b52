/* test_contact_exact.c: random mechanisms of one or two coordinates with up to three contacts under constant loads.
 * Each step's state, modes, events and energies equal the reference of exact.h, until a decision depends on round-off,
 * which is rare. */
#include <string.h>

#include "draw.h"
#include "exact.h"

#include "tests/suites.h"

enum { MECHANISMS = __STDC_HOSTED__ ? 2000 : 50, STEPS = 60 };

#define CLOSE (WH_DOUBLE ? 1e-5 : 5e-3)

/* Draws one to three contacts under loads of size `heavy`: stops, a hold, frictions, a crossing. One in `touched`
 * stops is touched, or passed, at the start. */
static void draw(uint64_t *seed, unsigned touched, bool crosses, int heavy) {
    const unsigned n = draw_one_in(seed, 4) ? 1 : 2;
    unsigned room = (unsigned)HAND_CONTACTS - crosses;
    const bool beside =
        /* the crossing belongs to the other coordinate */
        crosses && n == 2 && draw_one_in(seed, 2);
    wh_real row[2];
    hand_build(n, draw_broken(seed, 1, 4), n == 1 ? WH_R(0.0) : draw_broken(seed, -1, 1),
               draw_broken(seed, 2, 4));
    hand_pushed = draw_one_in(seed, 2) ? WH_R(1.0) : WH_R(-1.0);
    for (unsigned i = 0; i < n; i++) {
        hand_now.start[i] = draw_whole(seed, -2, 2) / 8;
        hand_now.start[n + i] = draw_one_in(seed, 3) ? WH_R(0.0) : draw_broken(seed, -1, 1);
        hand_now.load[i] =
            draw_one_in(seed, 8) ? WH_R(0.0) : draw_broken(seed, -8, 8) * (wh_real)heavy;
    }
    if (beside) {
        hand_now.start[3] = WH_R(0.0);
    }
    hand_now.weighs = draw_one_in(seed, 2);
    hand_now.system.compensated = draw_one_in(seed, 4);
    for (; room > 0 && !draw_one_in(seed, 3); room--) {
        int pin = hand_draw_row(seed, n, row);
        if (beside) {
            row[0] = WH_R(0.0);
            row[1] = draw_one_in(seed, 2) ? WH_R(1.0) : WH_R(-2.0);
            pin = 1;
        }
        const wh_real gap = !draw_one_in(seed, touched) ? draw_broken(seed, 0, 20) / 1024
                            : draw_one_in(seed, 4)      ? draw_broken(seed, -4, 0) / 1024
                                                        : WH_R(0.0);
        const wh_real at = row[0] * hand_now.start[0] + row[1] * hand_now.start[1];
        (void)hand_add(WH_STOP, pin, row[0], row[1], at - gap, draw_whole(seed, 0, 4) / 4,
                       WH_R(0.0));
    }
    if (room > 0 && draw_one_in(seed, 2)) {
        const int pin = hand_draw_row(seed, n, row);
        const unsigned k = hand_add(WH_HOLD, pin, row[0], row[1], WH_R(0.0), WH_R(0.0), WH_R(0.0));
        hand_now.contact[k].direction = draw_one_in(seed, 2) ? 1 : 0;
        hand_now.system.held = pin < 0;
        room--;
    }
    for (unsigned i = 0; i < n && room > 0; i++) {
        if (draw_one_in(seed, 2) || hand_now.system.contacts == 0) {
            const wh_real most = draw_broken(seed, 0, 3) * (wh_real)(heavy > 0 ? heavy : 1);
            (void)hand_add(WH_FRICTION, (int)i, i == 0 ? WH_R(1.0) : WH_R(0.0),
                           i == 1 ? WH_R(1.0) : WH_R(0.0), WH_R(0.0), most,
                           draw_one_in(seed, 2) ? most : most * WH_R(0.75));
            room--;
        }
    }
    if (crosses) {
        const unsigned k =
            hand_add(WH_WHEN, -1, WH_R(1.0), WH_R(0.0),
                     hand_now.start[0] + draw_broken(seed, -4, 4) / 256, WH_R(0.0), WH_R(0.0));
        hand_now.contact[k].direction = (int8_t)draw_whole(seed, -1, 1);
        hand_now.places = draw_one_in(seed, 2);
        hand_now.place = hand_now.start[0] + draw_broken(seed, -16, 16) / 256;
    }
}

static bool near(double value, double wanted) {
    const double off = value - wanted;
    return off <= CLOSE && -off <= CLOSE;
}

static double rate_of(unsigned k) {
    double sum = 0.0;
    for (unsigned i = 0; i < hand_now.n; i++) {
        sum += (double)(hand_now.law[k].row[i] * hand_state.real[hand_now.n + i]);
    }
    return sum;
}

/* Returns the impulse of contact k along its row, from the ledger. */
static double impulse_of(unsigned k) {
    const wh_real *entry = hand_state.ledger + wh_ledger_of_contact(&hand_books, k) + 1;
    const unsigned i = hand_now.law[k].row[0] != WH_R(0.0) ? 0 : 1;
    return (double)(entry[i] / hand_now.law[k].row[i]);
}

/* False if a stop opens without an impulse, because such an event may be only round-off. If contacts are redundant,
 * the impulse is not known: then no stop that opens counts. */
static bool counts(const exact *e, const wh_event *event) {
    return hand_now.contact[event->contact].kind != WH_STOP || event->mode != WH_FREE ||
           !(e->shared || near((double)event->impulse, 0.0));
}

static bool same_event(const exact *e, const wh_event *got, const wh_event *wanted) {
    return got->contact == wanted->contact && got->mode == wanted->mode &&
           near((double)got->at_s, (double)wanted->at_s) &&
           (e->shared || near((double)got->impulse, (double)wanted->impulse));
}

static bool same_log(const exact *e) {
    const wh_contacts *c = hand_state.contacts;
    unsigned i = 0;
    unsigned j = 0;
    for (;;) {
        for (; i < c->logged && !counts(e, &c->log[i]); i++) {
        }
        for (; j < e->logged && !counts(e, &e->log[j]); j++) {
        }
        if (i == c->logged || j == e->logged) {
            return i == WH_EVENT_LOG || (i == c->logged && j == e->logged);
        }
        if (!same_event(e, &c->log[i++], &e->log[j++])) {
            return false;
        }
    }
}

static bool same(const exact *e) {
    bool good = same_log(e);
    for (unsigned i = 0; i < hand_now.n; i++) {
        good = good && near((double)hand_state.real[i], e->x[i]) &&
               near((double)hand_state.real[hand_now.n + i], e->v[i]);
    }
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        const bool forced = k < hand_now.system.forced;
        const bool rests = forced && hand_now.contact[k].kind != WH_FRICTION &&
                           hand_state.contacts->mode[k] == WH_ACTIVE;
        good = good && hand_state.contacts->mode[k] == e->mode[k];
        good = good && (!rests || near(rate_of(k), 0.0));
        good = good &&
               (e->shared || near((double)hand_state.ledger[wh_ledger_of_contact(&hand_books, k)],
                                  e->energy[k]));
        good = good && (e->shared || !forced || near(impulse_of(k), e->impulse[k]));
    }
    return good && hand_state.contacts->overruns == 0;
}

typedef struct tally {
    unsigned wrong;
    unsigned steps; /* number of compared steps */
    uint64_t events;
} tally;

/* Compares a run until a decision depends on round-off. */
static void compare(tally *t) {
    exact e;
    bool good = true;
    hand_start(true);
    exact_start(&e);
    for (unsigned step = 0; step < STEPS && good; step++) {
        hand_steps(1);
        exact_step(&e);
        if (e.vague) {
            return;
        }
        good = same(&e);
        t->steps++;
        t->events += e.logged;
        t->wrong += !good;
        if (step % 8U == 7U) { /* changes the condition of the hold */
            hand_state.input[0] = -hand_state.input[0];
            e.pushed = -e.pushed;
        }
    }
}

static void run(uint64_t seed, unsigned touched, bool crosses, int heavy) {
    EXACT_NEEDS_DOUBLE();
    tally t = {0, 0, 0};
    for (unsigned i = 0; i < MECHANISMS; i++) {
        draw(&seed, touched, crosses, heavy);
        compare(&t);
    }
    TEST_ASSERT_EQUAL_UINT(0, t.wrong);
    TEST_ASSERT_TRUE_MESSAGE(t.steps >= MECHANISMS * STEPS / (WH_DOUBLE ? 2U : 4U),
                             "too many hang on rounding");
    TEST_ASSERT_TRUE_MESSAGE(t.events >= MECHANISMS / 2U, "too little happens");
}

TEST(contact_exact, start_without_contact) { run(11, 64, false, 1); }
TEST(contact_exact, start_in_contact) { run(12, 2, false, 1); }
TEST(contact_exact, stops_with_crossings) { run(13, 3, true, 1); }
TEST(contact_exact, large_loads) { run(14, 2, false, 128); }
TEST(contact_exact, no_loads) { run(15, 2, false, 0); }
TEST(contact_exact, start_in_contact_with_crossings) { run(16, 1, true, 1); }

enum { CORRECTED = __STDC_HOSTED__ ? 500 : 25, AFTER = 40 };

typedef struct reached {
    wh_real real[4];
    wh_real held;
    int8_t mode[HAND_CONTACTS];
    uint64_t events;
} reached;

static reached reached_now(void) {
    const unsigned held = hand_now.system.held;
    reached r;
    memset(&r, 0, sizeof r); /* memcmp() compares padding, too */
    r.held = held > 0 ? hand_state.held[0] : WH_R(0.0);
    r.events = hand_state.contacts->events;
    for (unsigned i = 0; i < 2 * hand_now.n; i++) {
        r.real[i] = hand_state.real[i];
    }
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        r.mode[k] = hand_state.contacts->mode[k];
    }
    return r;
}

static void levels_now(wh_real *level) {
    hand_books.levels(hand_books.model, NULL, hand_state.real, hand_state.real + hand_now.n,
                      hand_state.input, level);
}

/* Corrects some positions and rates. With compensated sums it corrects all, because otherwise the low parts of the
 * two runs would differ. The ledger records the change. */
static void correct(uint64_t *seed) {
    wh_real before[3];
    wh_real after[3];
    wh_real level[3];
    wh_real had[3];
    const bool all = hand_now.system.compensated;
    double size = 1.0; /* size of the accounts, for their round-off */
    for (unsigned a = 0; a <= hand_now.n; a++) {
        had[a] = wh_ledger_error(&hand_books, &hand_state, a, level);
        size += (double)WH_ABS(level[a]);
    }
    levels_now(before);
    const unsigned first = draw_one_of(seed, 2 * hand_now.n);
    for (unsigned i = 0; i < 2 * hand_now.n; i++) {
        if (all || i == first || draw_one_in(seed, 3)) {
            const wh_real value = draw_one_in(seed, 4) && i >= hand_now.n
                                      ? WH_R(0.0)
                                      : hand_state.real[i] + draw_broken(seed, -4, 4) / 16;
            TEST_ASSERT_TRUE(wh_scene_set_real(&hand_now.scene, &hand_state, i, value) == WH_OK);
            TEST_ASSERT_TRUE(hand_state.real[i] == value);
        }
    }
    levels_now(after);
    for (unsigned a = 0; a <= hand_now.n; a++) {
        const wh_real booked = wh_ledger_corrected(&hand_books, &hand_state)[a];
        const wh_real left = wh_ledger_error(&hand_books, &hand_state, a, level);
        size += (double)WH_ABS(after[a]);
        TEST_ASSERT_TRUE(hand_near(booked, after[a] - before[a], 1e-14 * size, 1e-6 * size));
        TEST_ASSERT_TRUE(hand_near(left, had[a], 1e-14 * size, 1e-6 * size));
    }
}

static wh_real gap_of(unsigned k) {
    return hand_now.law[k].row[0] * hand_state.real[0] +
           hand_now.law[k].row[1] * hand_state.real[hand_now.n - 1] - hand_now.law[k].offset;
}

/* Counts the resting stops if `rest`, otherwise the stops passed by more than `by`. */
static unsigned stops_that(bool rest, wh_real by) {
    unsigned count = 0;
    for (unsigned k = 0; k < hand_now.system.forced; k++) {
        const bool is = rest ? hand_state.contacts->mode[k] == WH_ACTIVE : gap_of(k) < -by;
        count += hand_now.contact[k].kind == WH_STOP && is;
    }
    return count;
}

/* A corrected run has the same bits as a run that starts from the corrected state. No body stays beyond a stop. */
TEST(contact_exact, corrected_run_equals_a_new_start) {
    uint64_t seed = 4600;
    unsigned beyond = 0;
    unsigned resting = 0;
    for (unsigned i = 0; i < CORRECTED;) {
        draw(&seed, 2, draw_one_in(&seed, 4), draw_one_in(&seed, 2) ? 128 : 1);
        hand_start(true);
        if (stops_that(false, WH_R(0.0)) > 0) {
            continue; /* the stops contradict each other */
        }
        i++;
        hand_steps(1 + draw_one_of(&seed, STEPS));
        resting += stops_that(true, WH_R(0.0));
        correct(&seed);
        for (unsigned c = 0; c < 2 * hand_now.n; c++) {
            hand_now.start[c] = hand_state.real[c];
        }
        hand_pushed = hand_state.input[0];
        beyond += stops_that(false, WH_R(1e-3));
        const uint64_t events = hand_state.contacts->events;
        reached run[2];
        for (unsigned which = 0; which < 2; which++) {
            if (which == 1) {
                hand_start(true);
            }
            hand_steps(1);
            TEST_ASSERT_EQUAL_UINT(0, stops_that(false, WH_R(1e-4)));
            hand_steps(AFTER);
            run[which] = reached_now();
        }
        run[0].events -= events;
        TEST_ASSERT_EQUAL_MEMORY(&run[1], &run[0], sizeof run[0]);
    }
    TEST_ASSERT_TRUE_MESSAGE(beyond >= CORRECTED / 10, "too few are put beyond a stop");
    TEST_ASSERT_TRUE_MESSAGE(resting >= CORRECTED / 10, "too few rest when they are corrected");
}

/* A refused correction changes nothing. */
TEST(contact_exact, corrections_to_nan_are_refused) {
    static const wh_real bad[] = {WH_R(1e16), WH_R(-1e16), WH_R(0.0), WH_R(0.0)};
    volatile wh_real zero = WH_R(0.0);
    hand_build_ball(WH_R(0.5));
    hand_start(true);
    hand_steps(600);
    const reached before = reached_now();
    for (unsigned i = 0; i < 4; i++) {
        const wh_real value = i < 2 ? bad[i] : (i == 2 ? zero : WH_R(1.0)) / zero;
        TEST_ASSERT_TRUE(wh_scene_set_real(&hand_now.scene, &hand_state, 0, value) ==
                         WH_E_ARGUMENT);
    }
    TEST_ASSERT_TRUE(wh_scene_set_real(&hand_now.scene, &hand_state, 2, WH_R(1.0)) ==
                     WH_E_ARGUMENT);
    TEST_ASSERT_TRUE(wh_scene_set_angle(&hand_now.scene, &hand_state, 0, WH_R(1.0)) ==
                     WH_E_ARGUMENT);
    const reached after = reached_now();
    TEST_ASSERT_EQUAL_MEMORY(&before, &after, sizeof before);
}
