/* test_chip_console.c: the console on the chip model, in both directions, at 115,200 baud and random times. */
#include <string.h>

#include "tests/suites.h"

#include "hal/console.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

static char bytes[4096];
static unsigned room, count;
static void take(void) { count = hal_console_read(bytes, room); }
static void offer(void) { count = hal_console_offer(bytes, room); }
static void write(void) { hal_console_write(bytes, room); }

TEST(chip_console, rate) {
    chip_on(1);
    TEST_ASSERT_DOUBLE_WITHIN(
        0.005, 1.0, (double)CHIP_UNITS_PER_S * 10.0 / 115200.0 / (double)chip_serial_byte_units());
    chip_wired(2);
    world.crystal = false;
    chip_restart(CHIP_BY_POWER);
    TEST_ASSERT_DOUBLE_WITHIN(
        0.01, 1.0, (double)CHIP_UNITS_PER_S * 10.0 / 115200.0 / (double)chip_serial_byte_units());
}

/* A write waits until all bytes are sent; an offer does not wait. Each byte comes out once and in order, in bursts,
 * with or without pauses. */
TEST(chip_console, out) {
    static uint8_t mine[16384];
    scattered_state = chip_seed(2);
    chip_on(3);
    unsigned from = chip_serial_sent();
    unsigned said = 0;
    for (unsigned i = 0; i < 150; i++) {
        room = 1U + (unsigned)(scattered() % 100U);
        for (unsigned b = 0; b < room; b++) {
            bytes[b] = (char)scattered();
        }
        const uint64_t then = chip_now();
        if (i % 5U == 4) {
            chip_run(write);
            count = room;
        } else {
            chip_run(offer);
            TEST_ASSERT_TRUE_MESSAGE(chip_now() - then < 500U * CHIP_UNITS_PER_US,
                                     "an offer waits");
            TEST_ASSERT_TRUE(count <= room);
        }
        memcpy(mine + said, bytes, count);
        said += count;
        chip_pass_us(scattered() % 2U == 0 ? 0 : scattered() % 9000U);
    }
    chip_pass_us(30000);
    TEST_ASSERT_EQUAL(said, chip_serial_sent() - from);
    TEST_ASSERT_TRUE(said > 3000);
    for (unsigned i = 0; i < said; i++) {
        TEST_ASSERT_EQUAL(mine[i], chip_serial_byte(from + i));
    }
}

/* The same test with long delays between accesses and with incoming bytes, so that interrupts come between accesses. */
TEST(chip_console, out_between_accesses) {
    scattered_state = chip_seed(10);
    chip_on(10);
    const unsigned from = chip_serial_sent();
    unsigned said = 0;
    for (unsigned i = 0; i < 400; i++) {
        world.access_cycles = 500U + (unsigned)(scattered() % 4000U);
        const uint64_t byte_units = chip_serial_byte_units();
        for (unsigned b = 0; b < 3; b++) {
            chip_serial_comes(chip_now() + b * byte_units + scattered() % byte_units, 'x');
        }
        room = 1U + (unsigned)(scattered() % 30U);
        for (unsigned b = 0; b < room; b++) {
            bytes[b] = (char)((said + b) % 253U);
        }
        chip_run(offer);
        said += count;
        chip_pass_us(3U * 87U + scattered() % 5000U);
        room = sizeof bytes;
        chip_run(take);
    }
    chip_pass_us(30000);
    TEST_ASSERT_EQUAL(said, chip_serial_sent() - from);
    for (unsigned i = 0; i < said; i++) {
        TEST_ASSERT_EQUAL(i % 253U, chip_serial_byte(from + i));
    }
}

/* If bytes are always offered, the line is never idle: at least 11,000 bytes per second. */
TEST(chip_console, out_is_full) {
    chip_on(4);
    const unsigned from = chip_serial_sent();
    for (unsigned i = 0; i < 100; i++) {
        room = 64;
        chip_run(offer);
        chip_pass_us(1000);
    }
    TEST_ASSERT_TRUE(chip_serial_sent() - from > 1100U);
}

/* If the program reads in each control step, bytes arrive in order and none is lost. A byte with noise or a framing
 * error is read as zero. An Escape is read as Escape even then. */
TEST(chip_console, in) {
    static uint8_t mine[4096];
    scattered_state = chip_seed(5);
    chip_on(5);
    unsigned made = 0;
    unsigned got = 0;
    uint64_t at = chip_now();
    const uint64_t byte_units = chip_serial_byte_units();
    for (unsigned i = 0; i < 3000; i++) {
        at += byte_units + (scattered() % 4U == 0 ? scattered() % (5U * byte_units) : 0);
        mine[made] = scattered() % 8U == 0 ? 0x1B : (uint8_t)(1U + scattered() % 255U);
        const uint8_t invalid =
            scattered() % 50U == 0 ? (uint8_t)(2U + 2U * (scattered() % 3U)) : 0;
        chip_serial_comes_as(at, mine[made], invalid);
        mine[made] = invalid != 0 && mine[made] != 0x1B ? 0 : mine[made];
        made++;
    }
    while (chip_now() < at + CHIP_UNITS_PER_S / 100U) {
        chip_pass_us(1000U + scattered() % 1000U);
        room = 1U + (unsigned)(scattered() % 60U);
        do {
            chip_run(take);
            TEST_ASSERT_TRUE(count <= room);
            TEST_ASSERT_TRUE(got + count <= made);
            TEST_ASSERT_TRUE(memcmp(mine + got, bytes, count) == 0);
            got += count;
        } while (count == room);
    }
    TEST_ASSERT_EQUAL(made, got);
}

TEST(chip_console, both) {
    scattered_state = chip_seed(6);
    chip_on(6);
    const unsigned from = chip_serial_sent();
    const uint64_t byte_units = chip_serial_byte_units();
    for (unsigned i = 0; i < 1000; i++) {
        chip_serial_comes(chip_now() + (i + 1U) * byte_units, (uint8_t)(1U + i % 250U));
    }
    unsigned got = 0;
    unsigned said = 0;
    while (got < 1000U) {
        room = 40;
        for (unsigned b = 0; b < room; b++) {
            bytes[b] = (char)((said + b) % 251U);
        }
        chip_run(offer);
        said += count;
        chip_pass_us(2000);
        room = sizeof bytes;
        chip_run(take);
        for (unsigned b = 0; b < count; b++) {
            TEST_ASSERT_EQUAL(1U + (got + b) % 250U, (uint8_t)bytes[b]);
        }
        got += count;
        TEST_ASSERT_TRUE_MESSAGE(count > 0, "some are lost");
    }
    chip_pass_us(30000);
    TEST_ASSERT_EQUAL(said, chip_serial_sent() - from);
    for (unsigned i = 0; i < said; i++) {
        TEST_ASSERT_EQUAL(i % 251U, chip_serial_byte(from + i));
    }
}

/* Unread bytes are lost, for example while the core stands (`held`). The program gets the other bytes in order, with a
 * zero for each gap. */
static void lost(bool held) {
    static uint8_t seen[4096];
    chip_on(7U + (held ? 1U : 0U));
    const uint64_t byte_units = chip_serial_byte_units();
    for (unsigned rounds = 0; rounds < 20; rounds++) {
        const unsigned many =
            held ? 8U + (unsigned)(scattered() % 40U) : 200U + (unsigned)(scattered() % 100U);
        for (unsigned i = 0; i < many; i++) {
            chip_serial_comes(chip_now() + (i + 1U) * byte_units, (uint8_t)(1U + i % 250U));
        }
        if (held) {
            chip_pass((1U + scattered() % 4U) * byte_units + 10U);
            chip_halt(true);
        }
        chip_pass((many + 2U) * byte_units);
        if (held) {
            chip_halt(false);
        }
        for (unsigned i = 0; i < 3; i++) { /* the next line is complete */
            chip_serial_comes(chip_now() + (i + 1U) * byte_units, 251U);
        }
        unsigned got = 0;
        for (unsigned i = 0; i < 30; i++) {
            room = 50;
            chip_run(take);
            memcpy(seen + got, bytes, count);
            got += count;
            chip_pass_us(200);
        }
        unsigned next = 1;
        bool gap = false;
        unsigned zeros = 0;
        for (unsigned i = 0; i < got; i++) {
            if (seen[i] == 0) {
                gap = true;
                zeros++;
            } else if (seen[i] != 251U) {
                TEST_ASSERT_TRUE_MESSAGE(seen[i] == next || gap,
                                         "some are missing, and no zero says so");
                gap = false;
                next = seen[i] % 250U + 1U;
            } else {
                TEST_ASSERT_TRUE_MESSAGE(gap || next == many % 250U + 1U || seen[i - 1U] == 251U,
                                         "the end is missing, and no zero says so");
                gap = false;
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(zeros > 0, "nothing says that some are lost");
        TEST_ASSERT_EQUAL_MESSAGE(251U, seen[got - 1U], "what comes behind is lost, too");
    }
}
TEST(chip_console, output_without_a_reader) {
    scattered_state = chip_seed(7);
    lost(false);
}
TEST(chip_console, core_that_stood) {
    scattered_state = chip_seed(8);
    lost(true);
}

/* With interrupts off, as in a fault's handler, polling sends all bytes. */
uint32_t reg_hold(void);
void reg_go_on(uint32_t before);
static void write_held(void) {
    const uint32_t before = reg_hold();
    hal_console_write(bytes, room);
    reg_go_on(before);
}
TEST(chip_console, from_a_fault) {
    scattered_state = chip_seed(9);
    for (unsigned i = 0; i < 20; i++) {
        chip_on(scattered());
        room = (unsigned)(scattered() % 60U);
        memset(bytes, 'o', sizeof bytes);
        chip_run(offer);
        const unsigned before = count;
        chip_pass_us(scattered() % 3000U);
        room = 100;
        memset(bytes, 'f', room);
        const unsigned from = chip_serial_sent();
        chip_run(write_held);
        chip_pass_us(20000);
        unsigned faults = 0;
        for (unsigned b = from; b < chip_serial_sent(); b++) {
            faults += chip_serial_byte(b) == 'f' ? 1U : 0U;
        }
        TEST_ASSERT_EQUAL(100, faults);
        TEST_ASSERT_TRUE(chip_serial_sent() <= from + 100U + before);
    }
}
