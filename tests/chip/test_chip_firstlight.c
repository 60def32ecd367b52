/* test_chip_firstlight.c: the image boards/programs/firstlight.c on the chip model. The record agrees with the random
 * state of the modelled board: clock, cycles, cell, supply, stop and slots. After the Enter key the image prints the
 * record again. Neither the enable nor the PWM is ever high. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/suites.h"

#include "boards/cortexm/cortexm.h"
#include "hal/loadcell.h"
#include "hal/reset.h"
#include "host/monitor/light.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

int firstlight_main(void);

#define RUN_UNITS (CHIP_UNITS_PER_S * 3U) /* two seconds, and the output of the record */
/* Core cycles per access. The number is large, so that the run has few accesses and takes only a second or two. */
#define ACCESS_CYCLES(crystal) ((crystal) ? 400U : 40U)

unsigned board_stack_used_bytes(void) { return 1000; }
unsigned board_stack_size_bytes(void) { return 4096; }
void hal_reset_mark(uint32_t state) { (void)state; }
void hal_remember(const void *bytes, unsigned count) {
    (void)bytes;
    (void)count;
}

static light l;
static unsigned driven;
static void look_at_pins(void) {
    driven += chip_pin('B', 14) == CHIP_HIGH || chip_pin('B', 13) == CHIP_HIGH ? 1U : 0U;
}
static void image(void) {
    board_clock_start();
    drivers_as_flashed();
    (void)firstlight_main();
}

static void read_record(unsigned from) {
    static char bytes[8192];
    unsigned count = 0;
    const char *hint = NULL;
    for (unsigned i = from; i < chip_serial_sent() && count < sizeof bytes; i++) {
        bytes[count++] = (char)chip_serial_byte(i);
    }
    const char *why = light_read(&l, bytes, count, &hint);
    TEST_ASSERT_NULL_MESSAGE(why, why);
}
static const char *value(const char *name) {
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        if (strcmp(name, light_names[i]) == 0) {
            return l.value[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return "";
}

/* Reads the whole numbers at the start of a field. */
static void numbers(const char *name, int count, int *const *number) {
    const char *at = value(name);
    for (int i = 0; i < count; i++) {
        char *end = NULL;
        *number[i] = (int)strtol(at, &end, 10);
        TEST_ASSERT_TRUE_MESSAGE(end != at, name);
        at = end;
    }
}

static double cell_V;
static double level_of_cell(double s) { return cell_V + 0.002 * sin(s * 3000.0); }

TEST(chip_firstlight, drawn_worlds) {
    char first[LIGHT_ROOM] = "";
    scattered_state = chip_seed(20);
    for (unsigned i = 0; i < 5; i++) {
        const bool crystal = i == 0 || scattered() % 3U != 0;
        const bool pressed = i > 0 && scattered() % 3U == 0;
        const unsigned pulses[2] = {i == 0 ? 0U : (unsigned)(scattered() % 4U), i == 0 ? 0U : 1U};
        chip_wired(100U + i);
        world.crystal = crystal;
        world.counter = i == 0 ? CHIP_COUNTS : (chip_counter)(scattered() % 3U);
        world.access_cycles = ACCESS_CYCLES(crystal);
        cell_V = i == 0 ? 1.65 : 1.2 + (double)(scattered() % 900U) / 1000.0;
        chip_cell_V = level_of_cell;
        chip_supply_V = i == 0 ? 24.0 : 3.0 + (double)(scattered() % 2500U) / 100.0;
        chip_pin_drive('A', 6, pressed ? CHIP_LOW : CHIP_HIGH);
        driven = 0;
        chip_reset(CHIP_BY_POWER);
        chip_stored = look_at_pins;
        const uint64_t now = chip_now();
        /* slot pulses of 150 us, in the second half of the run */
        for (unsigned p = 0; p < 4; p++) {
            for (unsigned s = 0; s < 2; s++) {
                if (p < pulses[s]) {
                    const uint64_t at =
                        now + CHIP_UNITS_PER_S + (100000U * p + 30000U * s) * CHIP_UNITS_PER_US;
                    chip_slot_is_at(at, s, CHIP_HIGH);
                    chip_slot_is_at(at + 150U * CHIP_UNITS_PER_US, s, CHIP_LOW);
                }
            }
        }
        const unsigned from = chip_serial_sent();
        chip_may_take(RUN_UNITS);
        TEST_ASSERT_EQUAL(CHIP_HANGS, chip_try(image)); /* the image never ends */
        TEST_ASSERT_EQUAL_STRING("none", chip_violation());
        TEST_ASSERT_EQUAL_MESSAGE(0, driven, "enable or PWM was high");
        read_record(from);

        char words[100];
        int least = 0;
        int mean = 0;
        int most = 0;
        TEST_ASSERT_EQUAL_STRING(board_name, value("board"));
        TEST_ASSERT_EQUAL_STRING("0x10076413", value("chip"));
        TEST_ASSERT_EQUAL_STRING(crystal ? "crystal" : "fallback", value("clock"));
        TEST_ASSERT_EQUAL_STRING(pressed ? "pressed" : "released", value("stop"));
        (void)snprintf(words, sizeof words, "%u %u edges, 0 lost", 2U * pulses[0], 2U * pulses[1]);
        TEST_ASSERT_EQUAL_STRING(words, value("slots"));
        numbers("period_us", 2, (int *const[]){&least, &most});
        TEST_ASSERT_TRUE(least >= 1900 && least <= 2000 && most >= 2000 && most <= 2100);
        const bool counts = world.counter == CHIP_COUNTS;
        TEST_ASSERT_EQUAL(!counts, light_is_none(value("cycles.rig_fixed")));
        TEST_ASSERT_EQUAL(!counts, light_is_none(value("period_cycles")));
        if (counts) {
            const double cycles = (double)chip_clocks_now().core_Hz * 0.002;
            numbers("period_cycles", 2, (int *const[]){&least, &most});
            TEST_ASSERT_TRUE(least >= 0.95 * cycles && least <= cycles * 1.001);
            TEST_ASSERT_TRUE(most <= 1.05 * cycles && most >= cycles * 0.999);
        }
        numbers("load", 3, (int *const[]){&least, &mean, &most});
        TEST_ASSERT_INT_WITHIN(100, (int)((cell_V - 1.65) / 1.65 * HAL_LOADCELL_RAW_MAX), mean);
        TEST_ASSERT_TRUE(least <= mean && mean <= most && most - least < 200);
        const double volts = strtod(value("supply"), NULL);
        TEST_ASSERT_DOUBLE_WITHIN(0.02 * chip_supply_V + 0.02, chip_supply_V, volts);
        TEST_ASSERT_NOT_NULL(strstr(value("selftest"), crystal ? "clock=good" : "clock=bad"));
        TEST_ASSERT_NOT_NULL(strstr(value("selftest"), pressed ? "stop=bad" : "stop=good"));
        if (i == 0) {
            TEST_ASSERT_EQUAL_STRING_LEN("good ", value("selftest"), 5);
            (void)snprintf(first, sizeof first, "%s", value("hash.shuttle_buffers"));
        }
        TEST_ASSERT_EQUAL_STRING(first, value("hash.shuttle_buffers"));
    }
}

TEST(chip_firstlight, again) {
    static char said[LIGHT_ROOM];
    chip_wired(120);
    world.access_cycles = ACCESS_CYCLES(true);
    chip_reset(CHIP_BY_POWER);
    const uint64_t now = chip_now();
    chip_serial_comes(now + RUN_UNITS, 'x');
    chip_serial_comes(now + RUN_UNITS + CHIP_UNITS_PER_S / 4U, '\r');
    const unsigned from = chip_serial_sent();
    chip_may_take(RUN_UNITS + CHIP_UNITS_PER_S / 5U);
    TEST_ASSERT_EQUAL(CHIP_HANGS, chip_try(image));
    read_record(from);
    (void)snprintf(said, sizeof said, "%s", l.text);
    chip_wired(120);
    world.access_cycles = ACCESS_CYCLES(true);
    chip_reset(CHIP_BY_POWER);
    const uint64_t then = chip_now();
    chip_serial_comes(then + RUN_UNITS, '\r');
    chip_serial_comes(then + RUN_UNITS + CHIP_UNITS_PER_S / 1000U, '\n');
    const unsigned once = chip_serial_sent();
    chip_may_take(RUN_UNITS + CHIP_UNITS_PER_S / 2U);
    TEST_ASSERT_EQUAL(CHIP_HANGS, chip_try(image));
    const unsigned sent = chip_serial_sent() - once;
    TEST_ASSERT_EQUAL_MESSAGE(0, sent % 2U, "two records");
    read_record(once + sent / 2U);
    TEST_ASSERT_EQUAL_STRING(said, l.text);
}
