/* test_contact_undefined.c: sets each expression of each contact to NaN or infinity. If a step depends on the
 * expression, it is refused with the contact's number and the last good state. Otherwise this is no error. */
#include "hand.h"

#include "tests/suites.h"

typedef enum lost_place { FIRST_SIGNAL, SECOND_SIGNAL, FIRST_LAW, SECOND_LAW } lost_place;
enum { PLACES = SECOND_LAW + 1 };

#define COUNT 3U

static wh_real none(unsigned way) {
    const volatile wh_real zero = WH_R(0.0);
    return way == 0 ? zero / zero : (way == 1 ? WH_R(1.0) : WH_R(-1.0)) / zero;
}

/* Draws three contacts whose kinds follow from the number. Returns false if no such combination exists. No contact is
 * near an event. */
static bool build(unsigned number, bool held, bool pinned, bool straight) {
    wh_contact_kind kind[COUNT];
    for (unsigned k = 0; k < COUNT; k++, number /= 4) {
        kind[k] = (wh_contact_kind)(number % 4);
        if (k > 0 && (kind[k] < kind[k - 1] || (kind[k] == WH_HOLD && kind[k - 1] == WH_HOLD))) {
            return false;
        }
    }
    hand_build(2, WH_R(2.0), WH_R(0.5), WH_R(3.0));
    hand_now.load[0] = WH_R(1.0);
    hand_now.start[2] = WH_R(0.5);
    hand_now.start[3] = WH_R(0.25);
    hand_pushed = held ? WH_R(1.0) : WH_R(-1.0);
    unsigned frictions = 0;
    for (unsigned k = 0; k < COUNT; k++) {
        if (kind[k] == WH_FRICTION) {
            const bool first = frictions++ % 2U == 0;
            hand_add(WH_FRICTION, first ? 0 : 1, first ? WH_R(1.0) : WH_R(0.0),
                     first ? WH_R(0.0) : WH_R(1.0), WH_R(0.0), WH_R(0.75), WH_R(0.5));
            continue;
        }
        hand_add(kind[k], pinned && kind[k] != WH_WHEN ? 1 : -1, pinned ? WH_R(0.0) : WH_R(1.0),
                 WH_R(1.0), WH_R(-2.0) - (wh_real)k, WH_R(0.5), WH_R(0.0));
        if (kind[k] == WH_HOLD) {
            hand_now.contact[k].direction = straight;
            hand_now.law[k].first = WH_R(0.0);
            hand_now.system.held = !pinned;
        }
    }
    return true;
}

/* True if a step depends on this expression of contact k. */
static bool needed(unsigned k, lost_place place) {
    const wh_contact_kind kind = (wh_contact_kind)hand_now.contact[k].kind;
    const bool stuck = kind == WH_FRICTION && hand_state.contacts->mode[k] == WH_STUCK;
    const bool curved = hand_now.contact[k].direction == 0 && hand_now.contact[k].pin < 0;
    switch (place) {
    case FIRST_SIGNAL:
    case SECOND_SIGNAL: return true;
    case FIRST_LAW: return stuck || (kind == WH_HOLD && curved && hand_pushed > WH_R(0.0));
    case SECOND_LAW: break;
    }
    return kind == WH_FRICTION && !stuck;
}

static void lose(unsigned k, lost_place place, wh_real nothing) {
    hand_now.nothing = nothing;
    switch (place) {
    case FIRST_SIGNAL:
    case SECOND_SIGNAL: hand_now.lost[place] |= 1U << k; break;
    case FIRST_LAW: hand_now.law[k].first = nothing; break;
    case SECOND_LAW: hand_now.law[k].second = nothing; break;
    }
}

/* Steps, then makes contact k's expression undefined. Returns true if the next step is refused or accepted as
 * expected. */
static bool answers(unsigned k, lost_place place, unsigned steps, wh_real nothing) {
    hand_start(true);
    hand_steps(steps);
    if (steps == 0) { /* the run has begun: the modes are those of its start */
        hand_steps(1);
        const bool build_on = needed(k, place);
        hand_start(true);
        lose(k, place, nothing);
        const wh_status status = wh_scene_step(&hand_now.scene, &hand_state);
        return build_on ? status == WH_E_UNDEFINED && hand_state.fault == (int)k : status == WH_OK;
    }
    const uint64_t hash = wh_scene_hash(&hand_now.scene, &hand_state);
    const bool build_on = needed(k, place);
    lose(k, place, nothing);
    const wh_status status = wh_scene_step(&hand_now.scene, &hand_state);
    return build_on ? status == WH_E_UNDEFINED && hand_state.fault == (int)k &&
                          wh_scene_hash(&hand_now.scene, &hand_state) == hash
                    : status == WH_OK;
}

TEST(contact_undefined, undefined_contacts_refuse_the_step) {
    unsigned wrong = 0;
    unsigned asked = 0;
    for (unsigned number = 0; number < 64 * 16; number++) {
        for (unsigned one = 0; one < COUNT * PLACES * 2; one++) {
            const unsigned k = one / (PLACES * 2);
            const lost_place place = (lost_place)(one / 2 % PLACES);
            if (!build(number / 16, (number & 1U) != 0, (number & 2U) != 0, (number & 8U) != 0)) {
                continue;
            }
            if (place == SECOND_SIGNAL && hand_now.contact[k].kind != WH_STOP &&
                hand_now.contact[k].kind != WH_HOLD) {
                continue; /* this signal is always zero */
            }
            hand_now.eventful = (number & 4U) != 0;
            wrong += !answers(k, place, one % 2U * 3U, none(0));
            asked++;
        }
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_TRUE(asked > 100);
}

TEST(contact_undefined, the_first_of_several_is_named) {
    for (unsigned steps = 0; steps < 4; steps += 3) {
        for (unsigned k = 0; k + 1 < COUNT; k++) {
            TEST_ASSERT_TRUE(build(0, false, false, true)); /* three stops */
            hand_start(true);
            hand_steps(steps);
            lose(k, FIRST_SIGNAL, none(0));
            lose(COUNT - 1, FIRST_SIGNAL, none(0));
            TEST_ASSERT_TRUE(wh_scene_step(&hand_now.scene, &hand_state) == WH_E_UNDEFINED);
            TEST_ASSERT_EQUAL_INT((int)k, hand_state.fault);
        }
    }
}

/* A restitution is evaluated only when its stop is hit, at the start of a run or later. */
TEST(contact_undefined, a_restitution_counts_at_an_impact) {
    for (unsigned k = 0; k < COUNT; k++) {
        for (unsigned later = 0; later < 2; later++) {
            hand_build(1, WH_R(2.0), WH_R(0.0), WH_R(1.0));
            hand_now.start[1] = WH_R(-1.0);
            hand_now.start[0] = later != 0 ? WH_R(0.0025) : WH_R(0.0);
            for (unsigned l = 0; l < COUNT; l++) {
                hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), l == k ? WH_R(0.0) : WH_R(-1.0), none(0),
                         WH_R(0.0));
            }
            hand_start(true);
            hand_steps(2 * later);
            TEST_ASSERT_TRUE(wh_scene_step(&hand_now.scene, &hand_state) == WH_E_UNDEFINED);
            TEST_ASSERT_EQUAL_INT((int)k, hand_state.fault);
        }
    }
}
