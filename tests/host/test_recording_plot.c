/* test_recording_plot.c: what a recording keeps of samples for a plot (host/monitor/recording.h): thinned out where it is too
 * much, evenly, and none of it another sample than it was; and that nothing is drawn of nothing. */
#include <math.h>

#include "command.h"
#include "host/monitor/recording.h"
#include "unity.h"

void suite_recording_plot(void);

static dice die;

/* A channel of one field, a whole number. */
static const schema numbers = {
    .channel[RECORDING_RUN] = {.known = true,
                               .period_ticks = 1000,
                               .eaches = 1,
                               .each[0] = {.name = "n [N]", .size = 4, .scale = 1.0}}};

static void test_thinned_out(void) {
    recording r;
    recording_begin(&r, NULL, NULL, NULL, true);
    const unsigned samples = 230000U + dice_one_of(&die, 20000);
    for (unsigned i = 0; i < samples; i++) {
        const uint8_t payload[4] = {(uint8_t)i, (uint8_t)(i >> 8), (uint8_t)(i >> 16), 0};
        recording_frame(&r, &numbers,
                        &(wire_frame){.channel = RECORDING_RUN,
                                      .sequence = (uint16_t)i,
                                      .ticks = i * 1000U,
                                      .payload = payload,
                                      .length = 4});
        TEST_ASSERT_EQUAL_INT64(i < 100000 ? 1 : i < 200000 ? 2 : 4, r.every);
        TEST_ASSERT_EQUAL_INT64(i / r.every + 1, r.rows);
    }
    TEST_ASSERT_EQUAL_INT(2, r.columns);
    for (int64_t i = 0; i < r.rows; i++) {
        TEST_ASSERT_TRUE(fabs(r.row[2 * i] - (double)(4 * i) * 1e-3) < 1e-9 &&
                         r.row[2 * i + 1] == (double)(4 * i));
    }
    TEST_ASSERT_EQUAL_UINT64(samples, r.counts.samples);
    recording_end(&r);
    TEST_ASSERT_NULL(r.row);
}

static void test_nothing_to_plot(void) {
    recording r;
    recording_begin(&r, NULL, NULL, NULL, true);
    errors_catch();
    const bool drawn = recording_plot(&r, &numbers, "/nowhere/at all.svg");
    TEST_ASSERT_EQUAL_STRING("whirl monitor: error: nothing to plot: no samples came\n",
                             errors_caught());
    TEST_ASSERT_FALSE(drawn);
    recording_end(&r);
}

void suite_recording_plot(void) {
    die = dice_of("recording_plot", 54);
    RUN_TEST(test_thinned_out);
    RUN_TEST(test_nothing_to_plot);
}
