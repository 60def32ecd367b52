/* test_contact_random.c: invariants after every step, for random mechanisms of one or two coordinates with up to three
 * contacts under constant loads. No body is beyond a stop, a stop only pushes, and a resting stop has zero rate.
 * Sticking friction has zero rate, sliding friction opposes its rate, and both forces stay within their limits. Held
 * values stay. Only assignments add energy, and the ledger balances. A mirrored mechanism has the mirrored motion. */
#include "draw.h"
#include "hand.h"

#include "core/hash.h"

#include "tests/suites.h"

enum { MECHANISMS = __STDC_HOSTED__ ? 2000 : 50, STEPS = 60 };

#define STEP_S WH_R(0.001)

/* Round-off of numbers of size one. */
#define SLACK (WH_DOUBLE ? WH_R(2e-12) : WH_R(2e-3))

static void add_stop(uint64_t *seed, unsigned n) {
    wh_real row[2];
    const int pin = hand_draw_row(seed, n, row);
    const wh_real gap = draw_one_in(seed, 2) ? WH_R(0.0) : draw_whole(seed, 1, 20) * STEP_S;
    const wh_real at = row[0] * hand_now.start[0] + row[1] * hand_now.start[1];
    (void)hand_add(WH_STOP, pin, row[0], row[1], at - gap, draw_whole(seed, 0, 4) / 4, WH_R(0.0));
}

static void add_hold(uint64_t *seed, unsigned n) {
    wh_real row[2];
    const int pin = hand_draw_row(seed, n, row);
    const unsigned k = hand_add(WH_HOLD, pin, row[0], row[1], WH_R(0.0), WH_R(0.0), WH_R(0.0));
    hand_now.contact[k].direction = 1;
    hand_now.system.held = pin < 0;
}

static void add_friction(uint64_t *seed, unsigned i) {
    const wh_real most = draw_whole(seed, 1, 4) / 2;
    const wh_real less = draw_one_in(seed, 2) ? most : most * WH_R(0.75);
    (void)hand_add(WH_FRICTION, (int)i, i == 0 ? WH_R(1.0) : WH_R(0.0),
                   i == 1 ? WH_R(1.0) : WH_R(0.0), WH_R(0.0), most, less);
}

/* Draws up to three contacts: stops, a hold, frictions, a crossing, in this order. */
static void draw(uint64_t *seed) {
    const unsigned n = draw_one_in(seed, 4) ? 1 : 2;
    unsigned room = HAND_CONTACTS;
    hand_build(n, draw_whole(seed, 2, 4), n == 1 ? WH_R(0.0) : draw_whole(seed, -1, 1),
               draw_whole(seed, 2, 4));
    hand_pushed = draw_one_in(seed, 2) ? WH_R(1.0) : WH_R(-1.0);
    for (unsigned i = 0; i < n; i++) {
        hand_now.start[i] = draw_whole(seed, -2, 2) / 8;
        hand_now.start[n + i] = draw_one_in(seed, 3) ? WH_R(0.0) : draw_whole(seed, -8, 8) / 8;
        hand_now.load[i] = draw_whole(seed, -8, 8);
    }
    for (; room > 0 && !draw_one_in(seed, 3); room--) {
        add_stop(seed, n);
    }
    if (room > 0 && draw_one_in(seed, 2)) {
        add_hold(seed, n);
        room--;
    }
    for (unsigned i = 0; i < n && room > 0; i++) {
        if (draw_one_in(seed, 2)) {
            add_friction(seed, i);
            room--;
        }
    }
    if (room > 0 && (draw_one_in(seed, 2) || room == HAND_CONTACTS)) {
        const unsigned k =
            hand_add(WH_WHEN, -1, WH_R(1.0), WH_R(0.0),
                     hand_now.start[0] + draw_whole(seed, -4, 4) / 256, WH_R(0.0), WH_R(0.0));
        hand_now.contact[k].direction = (int8_t)draw_whole(seed, -1, 1);
        hand_now.places = draw_one_in(seed, 2);
        hand_now.place = hand_now.start[0] + draw_whole(seed, -16, 16) / 256;
    }
}

/* Mirrors the mechanism: every quantity with a sign gets the opposite sign. */
static void mirror(void) {
    for (unsigned i = 0; i < 2; i++) {
        hand_now.load[i] = -hand_now.load[i];
        hand_now.start[i] = -hand_now.start[i];
        hand_now.start[2 + i] = -hand_now.start[2 + i];
    }
    hand_now.place = -hand_now.place;
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        const wh_contact_kind kind = (wh_contact_kind)hand_now.contact[k].kind;
        for (unsigned i = 0; i < 2 && kind != WH_FRICTION && kind != WH_WHEN; i++) {
            hand_now.law[k].row[i] = -hand_now.law[k].row[i];
        }
        if (kind == WH_WHEN) { /* the same value at the mirrored position */
            hand_now.law[k].offset = -hand_now.law[k].offset;
            hand_now.contact[k].direction = (int8_t)-hand_now.contact[k].direction;
        }
    }
}

static wh_real along(unsigned k, const wh_real *x) {
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < hand_now.n; i++) {
        sum += hand_now.law[k].row[i] * x[i];
    }
    return sum;
}

/* Returns the energy that contact k has given so far; the next function returns the impulse along its row. */
static wh_real energy_of(unsigned k) {
    return hand_state.ledger[wh_ledger_of_contact(&hand_books, k)];
}
static wh_real impulse_of(unsigned k) {
    const wh_real *entry = hand_state.ledger + wh_ledger_of_contact(&hand_books, k) + 1;
    const unsigned i = hand_now.law[k].row[0] != WH_R(0.0) ? 0 : 1;
    return entry[i] / hand_now.law[k].row[i];
}

static bool stop_holds(unsigned k) {
    const wh_real gap = along(k, hand_state.real) - hand_now.law[k].offset;
    const wh_real rate = along(k, hand_state.real + hand_now.n);
    const bool rests = hand_state.contacts->mode[k] == WH_ACTIVE;
    return gap >= -SLACK && impulse_of(k) >= -SLACK && energy_of(k) <= SLACK &&
           (!rests || (WH_ABS(gap) <= SLACK && WH_ABS(rate) <= SLACK)) &&
           (!rests || hand_now.contact[k].pin < 0 || rate == WH_R(0.0));
}

static bool friction_holds(unsigned k) {
    const wh_real rate = hand_state.real[hand_now.n + (unsigned)hand_now.contact[k].pin];
    const signed char mode = hand_state.contacts->mode[k];
    const wh_real most = hand_now.law[k].first * STEP_S * (wh_real)hand_state.steps;
    const bool way = mode == WH_STUCK ? rate == WH_R(0.0)
                     : mode > 0       ? rate >= -SLACK
                                      : rate <= SLACK;
    return way && energy_of(k) <= SLACK && WH_ABS(impulse_of(k)) <= most + SLACK;
}

/* True if the hold keeps `was`, its value at the capture. A crossing in this step may have changed the value. */
static bool hold_holds(unsigned k, wh_real was) {
    for (unsigned i = 0; i < hand_state.contacts->logged; i++) {
        if (hand_now.contact[hand_state.contacts->log[i].contact].kind == WH_WHEN) {
            was = along(k, hand_state.real);
        }
    }
    const bool rests = hand_state.contacts->mode[k] == WH_ACTIVE;
    return rests == (hand_pushed > WH_R(0.0)) && energy_of(k) <= SLACK &&
           (!rests || (WH_ABS(along(k, hand_state.real) - was) <= SLACK &&
                       WH_ABS(along(k, hand_state.real + hand_now.n)) <= SLACK));
}

static bool all_hold(const wh_real *was) {
    wh_real level[WH_ACCOUNTS_MAX];
    bool good = hand_state.input[0] == hand_pushed; /* the step must not change its input */
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        switch ((wh_contact_kind)hand_now.contact[k].kind) {
        case WH_STOP: good = good && stop_holds(k); break;
        case WH_HOLD: good = good && hold_holds(k, was[k]); break;
        case WH_FRICTION: good = good && friction_holds(k); break;
        case WH_WHEN:
        case WH_CONTACT_KIND_COUNT: break;
        }
    }
    for (unsigned account = 0; account <= hand_now.n; account++) {
        good = good && WH_ABS(wh_ledger_error(&hand_books, &hand_state, account, level)) <= SLACK;
    }
    return good;
}

/* Makes a run. Returns false if an invariant fails. In a step with too many events invariants need not hold. */
static bool run(wh_real *end, uint64_t *overruns) {
    wh_real was[HAND_CONTACTS] = {WH_R(0.0)};
    bool good = true;
    bool assigned = false;
    hand_start(true);
    for (unsigned step = 0; step < STEPS && good; step++) {
        for (unsigned k = 0; k < hand_now.system.contacts; k++) {
            if (hand_state.contacts->mode[k] != WH_ACTIVE || assigned) {
                was[k] = along(k, hand_state.real);
            }
        }
        hand_steps(1);
        good = hand_state.contacts->overruns > 0 || all_hold(was);
        assigned = false;
        for (unsigned i = 0; i < hand_state.contacts->logged; i++) {
            assigned =
                assigned || hand_now.contact[hand_state.contacts->log[i].contact].kind == WH_WHEN;
        }
        if (step % 8U == 7U) { /* changes the condition of the hold */
            hand_state.input[0] = -hand_state.input[0];
            hand_pushed = -hand_pushed;
        }
    }
    for (unsigned i = 0; i < 2 * hand_now.n; i++) {
        end[i] = hand_state.real[i];
    }
    *overruns = hand_state.contacts->overruns;
    return good;
}

TEST(contact_random, random_runs_satisfy_the_contact_laws) {
    uint64_t seed = 2;
    unsigned wrong = 0;
    uint64_t events = 0;
    for (unsigned i = 0; i < MECHANISMS; i++) {
        wh_real end[4];
        uint64_t overruns;
        draw(&seed);
        const bool good = run(end, &overruns);
        wrong += !good;
        events += hand_state.contacts->events;
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_TRUE_MESSAGE(events >= MECHANISMS / 2, "too little happens");
}

TEST(contact_random, mirrored_runs_are_equal) {
    uint64_t seed = 3;
    unsigned wrong = 0;
    for (unsigned i = 0; i < MECHANISMS; i++) {
        wh_real end[2][4];
        uint64_t overruns[2];
        draw(&seed);
        const wh_real pushed = hand_pushed;
        (void)run(end[0], &overruns[0]);
        mirror();
        hand_pushed = pushed;
        (void)run(end[1], &overruns[1]);
        bool same = overruns[0] == overruns[1];
        for (unsigned c = 0; c < 2 * hand_now.n; c++) {
            same = same && end[0][c] == -end[1][c];
        }
        wrong += !same;
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
}

/* After each step, mixes the state, the ledger and the reported events into a hash. */
static uint64_t trace(uint64_t *hashes) {
    hand_start(true);
    for (unsigned step = 0; step < STEPS; step++) {
        hand_steps(1);
        uint64_t hash = wh_scene_hash(&hand_now.scene, &hand_state);
        for (unsigned entry = 0; entry < hand_books.entries; entry++) {
            hash = wh_hash_real(hash, hand_state.ledger[entry]);
        }
        hash = wh_hash_u64(hash, hand_state.contacts->events);
        hash = wh_hash_u64(hash, hand_state.contacts->overruns);
        hashes[step] = wh_hash_u64(hash, hand_state.contacts->logged);
        if (step % 8U == 7U) {
            hand_state.input[0] = -hand_state.input[0];
        }
    }
    return hand_state.contacts->events;
}

TEST(contact_random, eventless_shortcut_changes_no_bit) {
    uint64_t seed = 5;
    unsigned wrong = 0;
    uint64_t events = 0;
    for (unsigned i = 0; i < MECHANISMS; i++) {
        uint64_t hashes[2][STEPS];
        draw(&seed);
        (void)trace(hashes[0]);
        hand_now.eventful = true;
        events += trace(hashes[1]);
        bool same = true;
        for (unsigned step = 0; step < STEPS; step++) {
            same = same && hashes[0][step] == hashes[1][step];
        }
        wrong += !same;
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_TRUE(events > 0 && events < (uint64_t)MECHANISMS * STEPS / 4U);
}
