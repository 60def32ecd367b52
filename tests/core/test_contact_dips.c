/* test_contact_dips.c: stops that a body passes and leaves within one step (contact_dip.h), for random bodies under
 * constant loads, whose motion is known. wh_contact_attempt_dipped() must report a hit if the stop was open or
 * closing at the begin. If both ends of the step are open, wh_contact_dip() must find a time at which the body is
 * beyond the stop. */
#include "draw.h"
#include "hand.h"

#include "tests/suites.h"

#define H WH_R(0.0009765625)

static wh_contact_work w;
static wh_contact_attempt a;

typedef struct drawn_stop {
    wh_real gap[2];  /* at the begin and at the end */
    wh_real rate[2]; /* rates at the begin and at the end */
} drawn_stop;

/* Returns stop k: stop 0 bounds x0 from below, stop 1 bounds x1, stop 2 bounds x0 from above. */
static drawn_stop stop_of(unsigned k, const wh_real *at, const wh_real *accel, wh_real offset) {
    const unsigned i = k == 1 ? 1 : 0;
    const wh_real sign = k == 2 ? WH_R(-1.0) : WH_R(1.0);
    drawn_stop s;
    s.gap[0] = sign * at[i] - offset;
    s.rate[0] = sign * at[2 + i];
    s.gap[1] = s.gap[0] + H * (s.rate[0] + WH_R(0.5) * H * sign * accel[i]);
    s.rate[1] = s.rate[0] + H * sign * accel[i];
    return s;
}

/* Returns false if a number is so near zero that round-off decides. */
static bool is_plain(const drawn_stop *s) {
    return WH_ABS(s->gap[1]) > WH_R(1e-6) && WH_ABS(s->rate[1]) > WH_R(1e-4) &&
           WH_ABS(s->gap[0]) > WH_R(1e-6) && WH_ABS(s->rate[0]) > WH_R(1e-4);
}

TEST(contact_dips, dips_are_found) {
    uint64_t seed = 2322;
    unsigned dips = 0;
    unsigned leaves = 0;
    unsigned passed = 0; /* stops that are passed and left again within the trial step */
    unsigned missed = 0; /* stops not passed, although the tangents at both ends allow it */
    for (unsigned round = 0; round < 3000; round++) {
        wh_real input[1] = {WH_R(0.0)};
        wh_real offset[3];
        drawn_stop stop[3];
        bool plain = true;
        hand_build(2, WH_R(1.0), WH_R(0.0), WH_R(1.0));
        for (unsigned i = 0; i < 2; i++) {
            hand_now.load[i] = draw_broken(&seed, -6000, 6000);
            hand_now.start[i] = draw_broken(&seed, -1, 1) * WH_R(0.0009765625);
            hand_now.start[2 + i] = draw_broken(&seed, -2, 2);
        }
        for (unsigned k = 0; k < 3; k++) {
            offset[k] = draw_broken(&seed, -1, 1) * WH_R(0.0009765625);
            hand_add(WH_STOP, k == 1 ? 1 : 0,
                     k == 0   ? WH_R(1.0)
                     : k == 2 ? WH_R(-1.0)
                              : WH_R(0.0),
                     k == 1 ? WH_R(1.0) : WH_R(0.0), offset[k], WH_R(0.5), WH_R(0.0));
            stop[k] = stop_of(k, hand_now.start, hand_now.load, offset[k]);
            plain = plain && is_plain(&stop[k]);
        }
        if (!plain) {
            continue;
        }
        hand_start(false);
        wh_contact_work_begin(&hand_now.system, &hand_state, &w);
        for (unsigned k = 0; k < 3; k++) {
            w.mode[k] = WH_FREE;
        }
        w.hit_next = w.turned = w.inside = w.moved = 0;
        for (unsigned i = 0; i < 4; i++) {
            a.now.real[i] = hand_now.start[i];
            a.now.carry[i] = WH_R(0.0);
        }
        a.next = a.now;
        wh_contact_attempt_make(&hand_now.system, &w, H, input, &a);
        TEST_ASSERT_TRUE(a.sound);
        unsigned leaving = 0;
        for (unsigned k = 0; k < 3; k++) {
            const bool near = stop[k].gap[1] < H * stop[k].rate[1];
            leaving |= near && stop[k].rate[1] > WH_R(0.0) ? 1U << k : 0U;
        }
        TEST_ASSERT_EQUAL_UINT(leaving, a.leaving);
        const unsigned inside = w.inside;
        const wh_margins before = a.margins;
        wh_contact_attempt_dipped(&hand_now.system, &w, H, input, &a);
        for (unsigned k = 0; k < 3; k++) {
            const bool open = stop[k].gap[0] > WH_R(0.0) || stop[k].rate[0] < WH_R(0.0);
            const bool closed = stop[k].gap[1] < WH_R(0.0);
            const bool hit = open && closed && (leaving >> k & 1U) != 0;
            TEST_ASSERT_EQUAL_UINT(hit ? 0U : inside >> k & 1U, w.inside >> k & 1U);
            TEST_ASSERT_TRUE(a.margins.value[k] == (hit ? before.signal[2 * k] : before.value[k]));
            TEST_ASSERT_TRUE(!hit || a.margins.value[k] < WH_R(0.0));
            dips += hit;
            leaves += (leaving >> k & 1U) != 0 && closed && !hit;
        }
        /* The path is a parabola that is open at both ends: its lowest point decides whether the stop is passed. */
        for (unsigned k = 0; k < 3; k++) {
            const drawn_stop *s = &stop[k];
            const wh_real least =
                s->gap[0] - WH_R(0.5) * H * s->rate[0] * s->rate[0] / (s->rate[1] - s->rate[0]);
            const bool turns = s->gap[0] > WH_R(0.0) && s->gap[1] > WH_R(0.0) &&
                               s->rate[0] < WH_R(0.0) && s->rate[1] > WH_R(0.0);
            if (turns && WH_ABS(least) > WH_R(1e-6)) {
                a.dips &= 1U << k;
                const wh_real share = wh_contact_dip(&hand_now.system, &a, input);
                const wh_real t = share * H;
                const wh_real gap =
                    s->gap[0] + t * s->rate[0] + WH_R(0.5) * t * share * (s->rate[1] - s->rate[0]);
                TEST_ASSERT_TRUE(least < WH_R(0.0) ? share < WH_R(1.0) && gap < WH_R(0.0)
                                                   : share == WH_R(1.0));
                passed += least < WH_R(0.0);
                missed += least > WH_R(0.0) && (a.dips >> k & 1U) != 0;
                wh_contact_attempt_dipped(&hand_now.system, &w, H, input, &a);
            }
        }
    }
    TEST_ASSERT_TRUE(dips > 60 && leaves > 60);
    TEST_ASSERT_TRUE(passed > 60 && missed > 20);
}
