/* test_station_host.c: the rig's console, and a host that stops sending. */
#include "console.h"
#include "draw.h"
#include "tests/suites.h"

static wh_step_inputs seen;
static uint64_t seed;

static void period(void) {
    even_step(&even);
    seen.inputs = even.inputs;
    wh_station_see(&station, &even.config, &even.rig, &seen);
    wh_station_step(&station, &even.rig);
}

static void obey(const char *line) { check_begins("OK", ask(line)); }

/* A host types now and then, then stops. The run ends in the step after the silence that the host or the configuration
 * allows. Without a limit, or while bytes arrive, the run continues. */
TEST(station_host, a_host_that_is_gone) {
    seed = 31;
    unsigned ends = 0;
    for (unsigned i = 0; i < 60U; i++) {
        const uint32_t limit_s = i % 3U == 2U ? 0 : (uint32_t)(1U + draw_one_of(&seed, 4));
        char line[] = "host 0";
        line[5] = (char)('0' + limit_s);
        console_begin();
        even.config.host_loss_stops = i % 3U == 0;
        if (i / 3U % 2U == 0) {
            obey(line);
        } else { /* otherwise the setting gives the limit */
            even.config.host_max_s = limit_s;
        }
        obey("arm");
        obey("start 330");
        even_go_on_until(&even, (wh_rig_phase)(WH_PHASE_TARE + draw_one_of(&seed, 5)));
        for (unsigned k = draw_one_of(&seed, 5); k > 0; k--) {
            /* Any byte except zero ends the silence. */
            type(draw_one_in(&seed, 2) ? "\n" : "\b");
            for (uint32_t step = 0; limit_s > 0 && step < limit_s * STEPS_PER_S; step++) {
                period();
            }
            TEST_ASSERT_TRUE(station.host_losses == 0);
        }
        type("\n");
        uint32_t silent = 0;
        while (even.rig.state == WH_RIG_RUNNING) {
            if (draw_one_in(&seed, 20)) {
                wh_station_take(&station, "", 1); /* noise: a damaged byte */
            }
            period();
            silent++;
            TEST_ASSERT_TRUE(silent < 60U * STEPS_PER_S);
        }
        /* A byte is received in one step and read in the next. */
        const uint32_t most = limit_s * STEPS_PER_S + 2U;
        const bool stops = limit_s > 0 && even.config.host_loss_stops;
        TEST_ASSERT_TRUE(!stops || silent <= most);
        const bool stopped = stops && silent == most;
        for (unsigned step = 0; step < 10U * STEPS_PER_S; step++) {
            period();
        }
        TEST_ASSERT_TRUE(stopped || even_is_done(&even));
        ends += stopped ? 1U : 0U;
        TEST_ASSERT_EQUAL_UINT32(limit_s > 0 ? 1 : 0, station.host_losses);
        type("\n"); /* ends the line with the noise */
        period();
        wh_station_drop(&station, WH_STATION_OUT_BYTES);
        obey("arm");
    }
    TEST_ASSERT_TRUE(ends >= 10U);
}
