/* test_chip_slots.c: slot pulses on the chip model. Each edge is reported once, with its time, in order. */
#include "tests/suites.h"

#include "hal/slots.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

#define ROOM 4096U
static struct {
    uint64_t units;
    uint32_t ticks; /* the timer's value at that time */
    uint8_t sensor;
    uint8_t end;
} made[ROOM];
static unsigned made_count;
static hal_slot_edge got[ROOM];
static unsigned got_count;
static uint32_t overruns;
static unsigned most;

static void take(void) {
    for (unsigned i = 0; i < most && got_count < ROOM && hal_slots_take(&got[got_count]); i++) {
        got_count++;
    }
    overruns = hal_slots_overruns();
}
static void run_take(unsigned at_most) {
    most = at_most;
    chip_run(take);
}

static void begin(uint64_t seed) {
    scattered_state = chip_seed(seed);
    chip_on(scattered());
    made_count = got_count = 0;
    run_take(ROOM);
    got_count = 0;
}

/* Schedules an edge. Computes its timer reading from the present one, at one tick per microsecond. */
static void edge_at(uint64_t units, unsigned sensor, hal_slot_end end) {
    made[made_count].units = units;
    made[made_count].sensor = (uint8_t)sensor;
    made[made_count].end = (uint8_t)end;
    made[made_count].ticks =
        chip_tim2_count() + (uint32_t)((units - chip_now()) / CHIP_UNITS_PER_US);
    made_count++;
    chip_slot_is_at(units, sensor, end == HAL_SLOT_LEADING ? CHIP_HIGH : CHIP_LOW);
}
static void edge_now(unsigned sensor, hal_slot_end end) {
    made[made_count].sensor = (uint8_t)sensor;
    made[made_count].end = (uint8_t)end;
    made[made_count++].ticks = chip_tim2_count();
    chip_slot_is(sensor, end == HAL_SLOT_LEADING ? CHIP_HIGH : CHIP_LOW);
}
static void pulse_at(uint64_t units, unsigned sensor, uint64_t high_us) {
    edge_at(units, sensor, HAL_SLOT_LEADING);
    edge_at(units + high_us * CHIP_UNITS_PER_US, sensor, HAL_SLOT_TRAILING);
}

/* Bounds of the delay from an edge to its time stamp. The filter takes 10.7 to 12.2 us (18.4.7: eight samples of 84
 * MHz, divided by 4 and by 32). Two roundings to ticks are added. */
#define LATE_LEAST 10U
#define LATE_MOST 14U

static void all_are_there(void) {
    TEST_ASSERT_EQUAL(made_count, got_count);
    for (unsigned i = 0; i < made_count; i++) {
        TEST_ASSERT_EQUAL(made[i].sensor, got[i].sensor);
        TEST_ASSERT_EQUAL(made[i].end, got[i].end);
        TEST_ASSERT_TRUE_MESSAGE(got[i].ticks - made[i].ticks - LATE_LEAST <=
                                     LATE_MOST - LATE_LEAST,
                                 "a stamp is not its edge's");
    }
}

/* Pulses of either sensor, 50 to 200 us long, 0.5 to 25 ms apart. The program polls once per millisecond. */
static void turn(unsigned pulses, uint32_t from_ticks) {
    chip_tim2_count_is(from_ticks);
    for (unsigned i = 0; i < pulses; i++) {
        const uint64_t gap_us = (i % 5U == 0 ? 20000U : 300U) + scattered() % 3000U;
        pulse_at(chip_now() + gap_us * CHIP_UNITS_PER_US + scattered() % CHIP_UNITS_PER_US,
                 (unsigned)(scattered() % 2U), 50U + scattered() % 150U);
        for (uint64_t passed = 0; passed <= gap_us + 250U; passed += 1000U) {
            chip_pass_us(1000U);
            run_take(ROOM);
        }
    }
    chip_pass_us(2000);
    run_take(ROOM);
}

TEST(chip_slots, random_edges) {
    begin(1);
    const uint32_t before = overruns;
    turn(300, 5000);
    all_are_there();
    TEST_ASSERT_EQUAL(before, overruns);
}

TEST(chip_slots, over_the_wrap) {
    for (unsigned i = 0; i < 8; i++) {
        begin(2 + i);
        turn(20, UINT32_MAX - (uint32_t)(scattered() % 60000U));
        all_are_there();
    }
}

/* Pulses of both sensors come at the same time, or nearly so, also while the timer wraps. They are reported in order of
 * time, even if one interrupt handles both. */
TEST(chip_slots, together) {
    begin(11);
    for (unsigned i = 0; i < 200; i++) {
        if (i % 4U == 0) {
            chip_tim2_count_is(UINT32_MAX - (uint32_t)(scattered() % 1020U));
        }
        const uint64_t at = chip_now() + CHIP_UNITS_PER_US * (1000U + scattered() % 10U);
        const unsigned first = (unsigned)(scattered() % 2U);
        const uint64_t apart_us =
            4U + scattered() % 8U; /* at least two samples of the filter, so the ticks differ */
        made_count = got_count = 0;
        edge_at(at, first, HAL_SLOT_LEADING);
        chip_pass(at - chip_now());
        chip_pass(apart_us * CHIP_UNITS_PER_US);
        edge_now(1U - first, HAL_SLOT_LEADING);
        chip_pass_us(20U + scattered() % 300U);
        edge_now(first, HAL_SLOT_TRAILING);
        chip_pass(apart_us * CHIP_UNITS_PER_US);
        edge_now(1U - first, HAL_SLOT_TRAILING);
        chip_pass_us(300);
        run_take(ROOM);
        all_are_there();
    }
}

/* A pulse shorter than the filter does not count, at either level. */
TEST(chip_slots, spikes) {
    begin(12);
    for (unsigned i = 0; i < 200; i++) {
        const unsigned pin = (unsigned)(scattered() % 2U);
        chip_slot_is(pin, CHIP_HIGH);
        chip_pass(scattered() %
                  (21U * CHIP_UNITS_PER_US / 2U)); /* eight samples take at least 10.7 us */
        chip_slot_is(pin, CHIP_LOW);
        chip_pass_us(20U + scattered() % 100U);
    }
    run_take(ROOM);
    TEST_ASSERT_EQUAL(0, got_count);
    TEST_ASSERT_EQUAL(0, overruns);
}

static unsigned leading(void) {
    unsigned count = 0;
    for (unsigned i = 0; i < got_count; i++) {
        count += got[i].end == HAL_SLOT_LEADING ? 1U : 0U;
    }
    return count;
}

/* A level that is high when the timer starts is no pulse. When it falls, only the end of a pulse is reported. */
TEST(chip_slots, high_at_the_start) {
    chip_wired(13);
    chip_slot_is(0, CHIP_HIGH);
    chip_slot_is(1, CHIP_HIGH);
    chip_restart(CHIP_BY_POWER);
    got_count = 0;
    chip_pass_us(1000);
    run_take(ROOM);
    const unsigned at_start = leading();
    TEST_ASSERT_EQUAL(at_start, got_count);
    chip_slot_is(0, CHIP_LOW);
    chip_slot_is(1, CHIP_LOW);
    chip_pass_us(1000);
    run_take(ROOM);
    TEST_ASSERT_EQUAL_MESSAGE(at_start, leading(), "a fall was taken for a pulse");
    TEST_ASSERT_EQUAL(at_start + 2U, got_count);
    /* Before its pin is connected, an input reads low. So at the start each sensor may show one rise, and no more. */
    TEST_ASSERT_TRUE(at_start <= 2U);
}

/* If the program does not read the pulses, at least the 8 oldest are stored, and the others are counted as overruns.
 * Later pulses are stored again. */
TEST(chip_slots, full) {
    scattered_state = chip_seed(14);
    for (unsigned round = 0; round < 10; round++) {
        begin(scattered() | 1U);
        const uint32_t before = overruns;
        for (unsigned i = 0; i < 40; i++) {
            const uint64_t at = chip_now() + (100U + scattered() % 400U) * CHIP_UNITS_PER_US;
            pulse_at(at, (unsigned)(scattered() % 2U), 40);
            chip_pass(at + 60U * CHIP_UNITS_PER_US - chip_now());
        }
        run_take(ROOM);
        TEST_ASSERT_TRUE_MESSAGE(got_count >= 16U, "at least eight are kept");
        for (unsigned i = 0; i < 16; i++) {
            TEST_ASSERT_EQUAL(made[i].sensor, got[i].sensor);
            TEST_ASSERT_EQUAL(made[i].end, got[i].end);
            TEST_ASSERT_TRUE(got[i].ticks - made[i].ticks - LATE_LEAST <= LATE_MOST - LATE_LEAST);
        }
        TEST_ASSERT_TRUE_MESSAGE(overruns - before >= 1U, "nobody was told that some are lost");
        for (unsigned i = 1; i < got_count; i++) {
            TEST_ASSERT_TRUE((int32_t)(got[i].ticks - got[i - 1U].ticks) >= 0);
        }
        chip_pass_us(1000);
        run_take(ROOM);
        made_count = got_count = 0;
        turn(5, chip_tim2_count());
        all_are_there();
    }
}

/* While the core is halted, one pulse of each sensor comes. Both times are captured, and both pulses are delivered in
 * order. */
TEST(chip_slots, core_that_stood) {
    begin(19);
    for (unsigned i = 0; i < 100; i++) {
        if (i % 4U == 0) {
            chip_tim2_count_is(UINT32_MAX - (uint32_t)(scattered() % 3000U));
        }
        made_count = got_count = 0;
        const uint8_t first = (uint8_t)(scattered() % 2U);
        chip_pass_us(100);
        chip_halt(true);
        for (unsigned n = 0; n < 2; n++) {
            chip_pass_us(120U + scattered() % 1200U);
            edge_now(first ^ n, HAL_SLOT_LEADING);
            chip_pass_us(50);
            edge_now(first ^ n, HAL_SLOT_TRAILING);
        }
        chip_pass_us(scattered() % 2000U);
        chip_halt(false);
        chip_pass_us(10);
        run_take(ROOM);
        all_are_there();
    }
    TEST_ASSERT_EQUAL(0, overruns);
}

/* A second pulse comes before the first was read. One is lost and counted, the other is complete. */
TEST(chip_slots, overrun) {
    begin(20);
    for (unsigned i = 0; i < 40; i++) {
        const uint32_t before = overruns;
        made_count = got_count = 0;
        chip_halt(true);
        for (unsigned n = 0; n < 2; n++) {
            made_count = 0;
            edge_now(i % 2U, HAL_SLOT_LEADING);
            chip_pass_us(50U + scattered() % 200U);
            edge_now(i % 2U, HAL_SLOT_TRAILING);
            chip_pass_us(50U + scattered() % 200U);
        }
        chip_halt(false);
        chip_pass_us(10);
        run_take(ROOM);
        all_are_there();
        TEST_ASSERT_EQUAL(before + 1U, overruns);
    }
}

/* Both inputs have 5 kHz or 30 kHz, and the program polls once per millisecond. Interrupts take a bounded share of the
 * time. */
static void storm(uint64_t period_us, uint64_t ms) {
    begin(15 + period_us);
    const uint64_t end = chip_now() + ms * 1000U * CHIP_UNITS_PER_US;
    const unsigned long before = chip_interrupts(28);
    const uint32_t overruns_before = overruns;
    unsigned taken = 0;
    while (chip_now() < end) {
        const uint64_t until = chip_now() + 1000U * CHIP_UNITS_PER_US;
        while (chip_now() < until) {
            for (unsigned pin = 0; pin < 2; pin++) {
                chip_slot_is(pin, CHIP_HIGH);
            }
            chip_pass(period_us * CHIP_UNITS_PER_US / 2U);
            for (unsigned pin = 0; pin < 2; pin++) {
                chip_slot_is(pin, CHIP_LOW);
            }
            chip_pass(period_us * CHIP_UNITS_PER_US / 2U);
        }
        got_count = 0;
        run_take(ROOM);
        taken += got_count;
        for (unsigned i = 1; i < got_count; i++) {
            TEST_ASSERT_TRUE_MESSAGE((int32_t)(got[i].ticks - got[i - 1U].ticks) >= 0,
                                     "not in order of time");
        }
    }
    TEST_ASSERT_TRUE(taken > 0);
    TEST_ASSERT_TRUE_MESSAGE(chip_interrupts(28) - before <= 20U * ms, "a storm takes the time");
    if (period_us < 100U) {
        TEST_ASSERT_TRUE(overruns > overruns_before);
    }
    chip_pass_us(3000);
    run_take(ROOM);
    made_count = got_count = 0;
    turn(5, chip_tim2_count());
    all_are_there();
}
TEST(chip_slots, storms) {
    storm(200, 40);
    storm(33, 40);
}
