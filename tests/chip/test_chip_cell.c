/* test_chip_cell.c: the load cell's samples on the chip model. Each must be the force at its time stamp. */
#include <math.h>
#include <stdlib.h>

#include "tests/suites.h"

#include "core/rig/guard.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/settings.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

#define PI 3.14159265358979323846
#define MIDDLE_V 1.65
#define RAW_OF_V (32768.0 / 1.65)

#define ROOM 2048U
static hal_load_sample got[ROOM];
static double got_s[ROOM]; /* time of arrival, in the chip's time */
static unsigned got_count;

/* Converts a timer tick to the chip's time. The tick is at most half of the timer's range away from now. */
static double second_of(uint32_t tick) {
    return chip_s() - (double)(int32_t)(chip_tim2_count() - tick) / 1e6;
}
static void take(void) {
    while (got_count < ROOM && hal_loadcell_take(&got[got_count])) {
        got_s[got_count] = second_of(got[got_count].ticks);
        got_count++;
    }
}
static void run_take(void) { chip_run(take); }
/* Takes this many samples of the present force. Samples that were already in progress are dropped. */
static void collect(unsigned samples) {
    for (unsigned i = 0; i < 4; i++) {
        chip_pass_us(2000);
        run_take();
    }
    got_count = 0;
    for (unsigned i = 0; i < samples + 5U && got_count < samples; i++) {
        chip_pass_us(2000);
        run_take();
    }
    TEST_ASSERT_TRUE(got_count >= samples);
}

static double offset_V, swing_V, turns_Hz, phase;
static double sine(double s) {
    return MIDDLE_V + offset_V + swing_V * sin(2.0 * PI * turns_Hz * s + phase);
}

/* Fits a sine of known frequency to the samples at their time stamps, by least squares. Results: its amplitude, the
 * error of the time stamps, and its mean. */
static void fit(double *amplitude, double *late_s, double *mean) {
    double m[3][4] = {{0}};
    const double from = got_s[0];
    for (unsigned i = 0; i < got_count; i++) {
        const double w = 2.0 * PI * turns_Hz * (got_s[i] - from);
        const double row[4] = {1.0, cos(w), sin(w), (double)got[i].raw};
        for (unsigned j = 0; j < 3; j++) {
            for (unsigned k = 0; k < 4; k++) {
                m[j][k] += row[j] * row[k];
            }
        }
    }
    for (unsigned j = 0; j < 3; j++) {
        for (unsigned i = 0; i < 3; i++) {
            const double by = i != j ? m[i][j] / m[j][j] : 0.0;
            for (unsigned k = j; k < 4; k++) {
                m[i][k] -= by * m[j][k];
            }
        }
    }
    const double c = m[1][3] / m[1][1];
    const double s = m[2][3] / m[2][2];
    *mean = m[0][3] / m[0][0];
    *amplitude = hypot(c, s);
    const double said = atan2(c, s);
    const double is = 2.0 * PI * turns_Hz * from + phase;
    *late_s = remainder(is - said, 2.0 * PI) / (2.0 * PI * turns_Hz);
}

static void begin(uint64_t seed) {
    scattered_state = chip_seed(seed * 7919U + 1U);
    chip_on(scattered());
    chip_cell_V = sine;
    got_count = 0;
    offset_V = 0;
    swing_V = 0;
    turns_Hz = 1;
    chip_tim2_count_is(seed % 3U == 0 ? UINT32_MAX - 50000U : (uint32_t)scattered());
    for (unsigned i = 0; i < 6; i++) { /* samples that were in progress when the timer was set */
        chip_pass_us(2000);
        run_take();
    }
    got_count = 0;
}

/* Sines of the rig's frequencies, and of higher frequencies at which a plain mean would be 1 % too small. The amplitude
 * must be right to 0.05 %, the time stamps to 1.5 us. */
TEST(chip_cell, sines) {
    for (unsigned i = 0; i < 14; i++) {
        begin(i + 1U);
        turns_Hz = i % 2U == 0 ? 3.0 + (double)(scattered() % 1000U) / 250.0
                               : 25.0 + (double)(scattered() % 1000U) / 66.0;
        /* The lowest voltage at the pin is 0.2 V: 1.65 - 1.39 - 0.05. */
        swing_V = 0.7 + (double)(scattered() % 690U) / 1000.0;
        phase = (double)(scattered() % 6283U) / 1000.0;
        offset_V = 0.1 * ((double)(scattered() % 1000U) / 1000.0 - 0.5);
        collect(220);
        for (unsigned at = 0; at < got_count; at++) {
            TEST_ASSERT_EQUAL(HAL_LOAD_OK, got[at].status);
            TEST_ASSERT_EQUAL(at * HAL_LOADCELL_PERIOD_TICKS, got[at].ticks - got[0].ticks);
        }
        double amplitude = 0;
        double late_s = 0;
        double mean = 0;
        fit(&amplitude, &late_s, &mean);
        TEST_ASSERT_DOUBLE_WITHIN(0.0005, 1.0, amplitude / (swing_V * RAW_OF_V));
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1.5e-6, 0.0, late_s,
                                          "stamps are not in the window's middle");
        TEST_ASSERT_DOUBLE_WITHIN(9.0, offset_V * RAW_OF_V,
                                  mean); /* truncation lowers the mean by 8 units */
    }
}

/* A sample is a mean over a window, corrected for the attenuation. For a parabola the correction is exact. So only the
 * converter's truncation remains: one count is 16 units. */
static double bend_from;
static double parabola(double s) {
    const double t = s - bend_from;
    return 0.3 + 15000.0 * t * t;
}
TEST(chip_cell, parabolas) {
    for (unsigned i = 0; i < 10; i++) {
        begin(40U + i);
        chip_pass(scattered() % (2000U * CHIP_UNITS_PER_US));
        bend_from = chip_s() + 0.013;
        chip_cell_V = parabola;
        got_count = 0;
        for (unsigned step = 0; step < 14; step++) {
            chip_pass_us(2000);
            run_take();
        }
        unsigned seen = 0;
        for (unsigned at = 0; at < got_count; at++) {
            const double V = parabola(got_s[at]);
            if (fabs(got_s[at] - bend_from) < 0.008) {
                TEST_ASSERT_DOUBLE_WITHIN(12.0, (V - MIDDLE_V) * RAW_OF_V - 8.0,
                                          /* without the correction the error would be 99 units */
                                          got[at].raw);
                seen++;
            }
        }
        TEST_ASSERT_TRUE(seen >= 6);
    }
}

static double level_V;
static double level(double s) {
    (void)s;
    return level_V;
}
TEST(chip_cell, ends) {
    begin(60);
    chip_cell_V = level;
    /* After a broken wire, the pin has the voltage of its leakage. An amplifier stops short of its rails. */
    static const struct {
        double least_V, most_V;
        uint8_t status;
    } rows[] = {{3.26, 5.0, HAL_LOAD_SATURATED},
                {0.22, 3.24, HAL_LOAD_OK},
                {0.0, 0.2, HAL_LOAD_DISCONNECTED},
                {1.65, 1.65, HAL_LOAD_OK}};
    for (unsigned i = 0; i < 60; i++) {
        const unsigned row = i % (sizeof rows / sizeof *rows);
        const double part = i < 4 ? 0.0 : i < 8 ? 1.0 : (double)(scattered() % 10001U) / 10000.0;
        level_V = rows[row].least_V + part * (rows[row].most_V - rows[row].least_V);
        chip_pass_us(10000); /* waits until no sample contains an earlier voltage */
        run_take();
        collect(5);
        for (unsigned at = 0; at < got_count; at++) {
            TEST_ASSERT_EQUAL(rows[row].status, got[at].status);
            if (level_V > 3.3) {
                TEST_ASSERT_INT_WITHIN(16, HAL_LOADCELL_RAW_MAX,
                                       got[at].raw); /* a count of 12 bits is 16 units */
            } else {
                TEST_ASSERT_DOUBLE_WITHIN(17.0, (level_V - MIDDLE_V) * RAW_OF_V, got[at].raw);
            }
        }
    }
}

/* If the force clips in a part of a sample's window, the sample is not valid. */
static double clip_V;
static double clipped(double s) {
    const double in_turn = fmod(s, 0.05);
    return in_turn < 0.0004 ? clip_V : MIDDLE_V;
}
static void clipped_at(double V) {
    begin(61);
    clip_V = V;
    chip_cell_V = clipped;
    collect(200);
    unsigned marked = 0;
    for (unsigned at = 0; at < got_count; at++) {
        const double next =
            /* time from the begin of the last clip to the window's end */
            fmod(got_s[at] + 0.001, 0.05);
        const bool has = next < 0.00238 && next > 0.00005;
        marked += got[at].status == HAL_LOAD_SATURATED ? 1U : 0U;
        if (has && next > 0.0003 && next < 0.0021) {
            TEST_ASSERT_EQUAL_MESSAGE(HAL_LOAD_SATURATED, got[at].status,
                                      "a clipped sample is called good");
        }
        if (got[at].status == HAL_LOAD_OK) {
            TEST_ASSERT_TRUE_MESSAGE(abs(got[at].raw) < 40, "a good sample that is none");
        }
    }
    TEST_ASSERT_TRUE(marked >= 7);
}

TEST(chip_cell, clipped_for_a_moment) {
    clipped_at(4.0);
    clipped_at(0.0);
}

/* At least four samples are stored; if more come, the newest are lost. */
TEST(chip_cell, four_samples_are_stored) {
    begin(62);
    run_take();
    got_count = 0;
    const uint32_t then = chip_tim2_count();
    chip_pass_us(40000);
    run_take();
    TEST_ASSERT_TRUE(got_count >= 4);
    for (unsigned at = 0; at < 4; at++) {
        TEST_ASSERT_TRUE_MESSAGE(got[at].ticks - then < 12000U || then - got[at].ticks < 4100U,
                                 "the oldest are not kept");
    }
}

static void erase(void) { (void)hal_settings_erase(0); }

/* The core stops at any instant for any time, as during an erase or under a debugger. If a sample is reported as good,
 * its force still belongs to its time stamp. */
static double ramp(double s) { return 0.4 + 2.4 * fabs(remainder(s, 1.0)); }
TEST(chip_cell, core_that_stood) {
    for (unsigned i = 0; i < 30; i++) {
        begin(70U + i);
        chip_cell_V = ramp;
        chip_pass_us(20000);
        run_take();
        chip_pass(scattered() % (4000U * CHIP_UNITS_PER_US));
        got_count = 0;
        if (i % 5U == 0) {
            chip_run(erase);
        } else {
            chip_halt(true);
            chip_pass((scattered() % 30000U) * CHIP_UNITS_PER_US);
            chip_halt(false);
        }
        for (unsigned step = 0; step < 20; step++) {
            run_take();
            chip_pass_us(1000);
        }
        run_take();
        unsigned good = 0;
        for (unsigned at = 0; at < got_count; at++) {
            if (got[at].status == HAL_LOAD_OK && fabs(remainder(got_s[at], 0.5)) > 0.005) {
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(40.0, (ramp(got_s[at]) - MIDDLE_V) * RAW_OF_V,
                                                  got[at].raw, "a sample is not of its stamp");
                good++;
            }
        }
        TEST_ASSERT_TRUE(good >= 5);
    }
}

/* After an overrun the converter makes no more requests (13.8.1). The driver does not restart it: no further sample
 * comes, and the controller detects a silent cell. A reset restores the samples. */
TEST(chip_cell, overrun) {
    begin(110);
    chip_cell_V = ramp;
    chip_pass_us(10000);
    run_take();
    chip_adc_overruns();
    chip_pass_us(20000);
    run_take();
    got_count = 0;
    for (unsigned step = 0; step < 40; step++) {
        chip_pass_us(1000);
        run_take();
    }
    TEST_ASSERT_EQUAL(0, got_count);
    chip_restart(CHIP_BY_SOFTWARE);
    collect(5);
}

/* On the chip's own oscillator, too, a pair is converted before the next request, and the force is right. */
TEST(chip_cell, fallback) {
    chip_wired(111);
    world.crystal = false;
    chip_restart(CHIP_BY_POWER);
    chip_cell_V = ramp;
    collect(20);
    for (unsigned at = 0; at < got_count; at++) {
        TEST_ASSERT_EQUAL(at * HAL_LOADCELL_PERIOD_TICKS, got[at].ticks - got[0].ticks);
        if (fabs(remainder(got_s[at], 0.5)) > 0.005) {
            TEST_ASSERT_DOUBLE_WITHIN(40.0, (ramp(got_s[at]) - MIDDLE_V) * RAW_OF_V, got[at].raw);
        }
    }
}

/* The supply's reading is not older than 2 ms. */
static float supply;
static void read_supply(void) { supply = hal_motor_supply_V(); }
TEST(chip_cell, supply) {
    begin(120);
    for (unsigned i = 0; i < 30; i++) {
        chip_supply_V = (double)(scattered() % 3200U) / 100.0;
        chip_pass_us(6000);
        chip_run(read_supply);
        TEST_ASSERT_DOUBLE_WITHIN(0.012, chip_supply_V, (double)supply);
    }
}

/* The supply has any voltage up to 60 V. The divider's 1 % resistors change its ratio by up to 1.8 %. The guard
 * accepts 12 to 30 V. It refuses more than 31.5 V, apart from the divider's error, even if a setting allows more. */
TEST(chip_cell, supplies) {
    wh_guard_config guard = {.supply_min_V = 10.8F, .supply_max_V = hal_motor_supply_most_V()};
    begin(121);
    for (unsigned i = 0; i < 200; i++) {
        const double divider = 1.0 + 0.018 * ((double)(scattered() % 2001U) / 1000.0 - 1.0);
        const double supply_V = (double)(scattered() % 60001U) / 1000.0;
        chip_supply_V = supply_V * divider;
        chip_pass_us(6000);
        chip_run(read_supply);
        if (supply_V > 31.5 * 1.02) {
            TEST_ASSERT_FALSE(wh_guard_supply(&guard, supply));
        } else if (supply_V >= 12.0 && supply_V <= 30.0) {
            TEST_ASSERT_TRUE(wh_guard_supply(&guard, supply));
        }
        const wh_guard_config set = {.supply_min_V = 1.0F,
                                     .supply_max_V = 31.5F + (float)(scattered() % 28501U) / 1e3F};
        TEST_ASSERT_TRUE(chip_supply_V < 32.9 || !wh_guard_supply(&set, supply));
    }
}
