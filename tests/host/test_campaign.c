/* test_campaign.c: what a campaign of faults draws, and how fast what it draws may get. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "faults.h"
#include "unity.h"

void suite_campaign(void);

static void test_draws(void) {
    unsigned drawn[CAMPAIGN_ROWS_MAX] = {0};
    unsigned stages[RIG_STAGES_MAX] = {0};
    const campaign all = {.firmware = "pil_dialled.elf", .seed = 3};
    bool second[CAMPAIGN_ROWS_MAX] = {false};
    double slowest_rpm = 1000.0;
    double fastest_rpm = 0.0;
    TEST_ASSERT_TRUE(campaign_rows() <= CAMPAIGN_ROWS_MAX);
    for (unsigned i = 0; i < 4000; i++) {
        campaign_case one;
        campaign_case again;
        fault_plan plan = {.count = 0};
        campaign_draw(&one, &all, i);
        campaign_draw(&again, &all, i);
        TEST_ASSERT_EQUAL_STRING(one.words, again.words);
        TEST_ASSERT_EQUAL_UINT32(one.seed, again.seed);
        TEST_ASSERT_TRUE_MESSAGE(fault_read(&plan, one.words), one.words);
        const char *word = campaign_row_word(one.row);
        const bool twice = strcmp(word, "reset-tripped") == 0 || strcmp(word, "hang-resets") == 0;
        const bool two = !campaign_is_alone(&one);
        /* noise, set-point, sometimes the feed; then what breaks */
        const unsigned dials = 1U + (strstr(one.words, "reads:5=1") != NULL ? 1U : 0U) +
                               (strstr(one.words, "reads:6=1") != NULL ? 1U : 0U);
        const bool share =
            strstr(word, "-share") != NULL; /* with a supply, perhaps stop and a dead sensor */
        const unsigned faults = strcmp(word, "none") == 0 ? 0U : twice || share ? 2U : 1U;
        TEST_ASSERT_TRUE(plan.count >= 1U + faults &&
                         plan.count <= 1U + dials + faults + 2U * (two || share));
        TEST_ASSERT_TRUE(one.breaks == (faults > 0));
        TEST_ASSERT_TRUE(!two || !one.runs_away || one.drives);
        slowest_rpm = one.target_rpm < slowest_rpm ? one.target_rpm : slowest_rpm;
        fastest_rpm = one.target_rpm > fastest_rpm ? one.target_rpm : fastest_rpm;
        second[one.row] = two;
        TEST_ASSERT_TRUE(strlen(one.words) + 1 < sizeof one.words);
        drawn[one.row]++;
        stages[one.stage]++;
    }
    TEST_ASSERT_TRUE(slowest_rpm >= 100.0 && slowest_rpm < 105.0 && fastest_rpm <= 360.0 &&
                     fastest_rpm > 355.0);
    TEST_ASSERT_TRUE(second[campaign_rows() - 1U]);
    rig_stage stage[RIG_STAGES_MAX];
    for (unsigned s = 0; s < rig_stages(stage); s++) {
        TEST_ASSERT_TRUE(stages[s] > 300);
        TEST_ASSERT_TRUE(stage[s].span_s > 0.0 && strchr(stage[s].when, '=') != NULL);
    }
    for (unsigned row = 0; row < campaign_rows(); row++) {
        campaign_case one;
        TEST_ASSERT_TRUE(drawn[row] > 30);
        const campaign only = {.firmware = "pil_dialled.elf",
                               .seed = 1,
                               .only = campaign_row_word(row),
                               .also = "jam"};
        campaign_draw(&one, &only, 2);
        TEST_ASSERT_TRUE(strstr(one.words, ",jam") != NULL && one.drives);
        TEST_ASSERT_EQUAL_STRING(campaign_row_word(row), campaign_row_word(one.row));
    }
}

/* Runs whose set-points are close have nothing else in common: of pairs within 0.02 rad/s a twentieth has times of the same
 * fault within a twentieth of each other, not most. */
static void test_draws_are_independent(void) {
    enum { RUNS = 4000 };
    static double target[RUNS];
    static double after[RUNS];
    const campaign c = {.firmware = "pil_dialled", .seed = 4, .only = "late"};
    unsigned pairs = 0;
    unsigned close = 0;
    for (unsigned i = 0; i < RUNS; i++) {
        campaign_case one;
        campaign_draw(&one, &c, i);
        rig_stage stage[RIG_STAGES_MAX];
        rig_stages(stage);
        const char *when = strchr(one.words, '~');
        target[i] = one.target_rpm;
        after[i] = when != NULL ? strtod(when + 1, NULL) / stage[one.stage].span_s : 0.0;
        for (unsigned other = 0; other < i; other++) {
            const bool near =
                fabs(target[i] - target[other]) < 0.2 && fabs(target[i] - 330.0) > 1.0;
            pairs += near;
            close += near && fabs(after[i] - after[other]) < 0.025;
        }
    }
    TEST_ASSERT_TRUE(pairs > 2000);
    TEST_ASSERT_TRUE(close > pairs / 40 && close < pairs / 10);
}

/* What cannot be drawn is refused: rows of an emulator's counts, or of an operator's dials. */
static void test_what_there_is_to_draw(void) {
    const char *const words[] = {NULL, "jam", "slow", "feed-part", "two faults", "nothing"};
    static const bool has[3][6] = {{true, true, false, false, true, false},
                                   {true, true, true, false, true, false},
                                   {true, true, true, true, true, false}};
    const char *const images[] = {"pil_rig", "pil_rig.elf", "pil_dialled.elf"};
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned w = 0; w < 6; w++) {
            const campaign c = {.firmware = images[i], .only = words[w]};
            TEST_ASSERT_TRUE(campaign_has_any(&c) == has[i][w]);
        }
    }
    campaign_case one;
    const campaign without = {.firmware = "pil_rig", .seed = 1};
    campaign_draw(&one, &without, 7);
    TEST_ASSERT_TRUE(strstr(one.words, "reads:4") == NULL);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 330.0, one.target_rpm);
}

/* Until 7/6 of a turn and a control period have passed: from closed forms of the speed and the angle over time. */
static void test_how_fast_a_runaway_may_get(void) {
    TEST_ASSERT_TRUE(rig_caught_rpm(100.0) == 470.0 && rig_caught_rpm(330.0) == 470.0);
    for (int five = 67; five <= 72; five++) {
        const double rpm = 5.0 * five;
        double time_s = 0.0;
        for (int i = 0; i < 50; i++) {
            const double left = (568.0 - rpm) * exp(-time_s / 0.23);
            const double turns = (568.0 * time_s - 0.23 * (568.0 - rpm - left)) / 60.0;
            time_s -= (turns - 7.0 / 6.0) * 60.0 / (568.0 - left);
        }
        const double mean = 568.0 - (568.0 - rpm) * exp(-(time_s + 2e-3) / 0.23);
        const double swing = 0.345 / 5.77e-3 / (mean / 9.5493) * 9.5493;
        const double most = rig_caught_rpm(rpm);
        TEST_ASSERT_DOUBLE_WITHIN(0.1, mean + swing > 470.0 ? mean + swing : 470.0, most);
    }
}

void suite_campaign(void) {
    RUN_TEST(test_draws);
    RUN_TEST(test_draws_are_independent);
    RUN_TEST(test_what_there_is_to_draw);
    RUN_TEST(test_how_fast_a_runaway_may_get);
}
