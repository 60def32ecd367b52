/* test_selftest.c: the console's self-test reports each bad part, and no other. */
#include "console.h"
#include "tests/suites.h"

static wh_step_inputs seen;

static void begin(void) {
    console_begin();
    seen = (wh_step_inputs){.inputs = even.inputs, .samples = 1};
    seen.sample[0] = (wh_step_sample){even.inputs.now_ticks, EVEN_TARE_RAW, WH_LOAD_OK};
}

static void period(void) {
    wh_station_see(&station, &even.config, &even.rig, &seen);
    wh_station_step(&station, &even.rig);
}

static const char *test_parts(void) { return ask("selftest"); }

TEST(selftest, good) {
    begin();
    TEST_ASSERT_EQUAL_STRING(
        "OK selftest=good arithmetic=good clock=good watchdog=good supply=good "
        "cell=good stop=good rotor=good swing=none",
        test_parts());
}

TEST(selftest, each_part) {
    static const char *const parts[] = {"clock", "watchdog", "supply", "cell",
                                        "cell",  "cell",     "stop",   "rotor"};
    for (unsigned mask = 0; mask < 256U; mask++) {
        char bad[64];
        begin();
        seen.inputs.clock_is_fallback = (mask & 1U) != 0;
        seen.inputs.watchdog_has_cut = (mask & 2U) != 0;
        seen.inputs.supply_V = (mask & 4U) != 0 ? WH_R(3.0) : WH_RIG_RATED_V;
        seen.sample[0].raw = (mask & 8U) != 0 ? -30000 : EVEN_TARE_RAW;
        even.rig.guard.load_good = (mask & 16U) == 0;
        even.rig.guard.load_ticks -= (mask & 32U) != 0 ? 30000U : 0U;
        seen.inputs.stop_pressed = (mask & 64U) != 0;
        even.rig.guard.quiet = (mask & 128U) == 0;
        const char *answer = test_parts();
        TEST_ASSERT_NOT_NULL(strstr(answer, mask == 0 ? "OK selftest=good " : "OK selftest=bad "));
        for (unsigned i = 0; i < 8U; i++) {
            const unsigned same = parts[i][0] == 'c' && parts[i][1] == 'e' ? 56U : 1U << i;
            strcpy(bad, " ");
            strcat(bad, parts[i]);
            strcat(bad, (mask & same) != 0 ? "=bad " : "=good ");
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(answer, bad), bad);
        }
    }
}

TEST(selftest, the_swing) {
    begin();
    even.rig.swing.result = (wh_swung){.why = WH_SWING_FOUND};
    even.rig.swing.result.place_rad[0] = WH_R(-0.02);
    even.rig.swing.result.half_rad[0] = WH_R(0.002);
    TEST_ASSERT_NOT_NULL(strstr(test_parts(), "selftest=bad "));
    TEST_ASSERT_NOT_NULL(strstr(heard, " swing=bad place_deg=-1.15 place_half_deg=0.11"));
    even.rig.swing.result.place_rad[0] = WH_R(0.004);
    TEST_ASSERT_NOT_NULL(strstr(test_parts(), "selftest=good "));
    TEST_ASSERT_NOT_NULL(strstr(heard, " swing=good place_deg=0.23 "));
    even.rig.swing.result.why = WH_SWING_FEW;
    TEST_ASSERT_NOT_NULL(strstr(test_parts(), " swing=none"));
}

TEST(selftest, only_in_idle) {
    begin();
    TEST_ASSERT_EQUAL_INT(WH_ALLOWED, even_order(&even, WH_EVENT_ARM, WH_R(0.0)));
    TEST_ASSERT_NOT_NULL(strstr(test_parts(), "ERR 107 "));
}
