/* test_chip_watchdog.c: the watchdog on the chip model, at any speed of its oscillator: it never resets before the
 * timeout, and always within three timeouts. */
#include "tests/suites.h"

#include "boards/stm32f4/stm32f4.h"
#include "hal/motor.h"
#include "hal/watchdog.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

static uint32_t timeout;
static void start(void) { hal_watchdog_start(timeout); }
static void kick(void) { hal_watchdog_kick(); }
static void drive(void) {
    (void)hal_motor_start();
    hal_motor_set_voltage(6.0F);
}

static void begin(void) {
    chip_on(scattered());
    world.watchdog_Hz = 17000U + scattered() % 30001U;
}

static void is_quiet_for(uint32_t ticks) {
    const unsigned before = chip_resets();
    chip_pass_us(ticks);
    TEST_ASSERT_EQUAL_MESSAGE(before, chip_resets(), "it bites before its time");
}

static void bites_by(uint64_t ticks) {
    const unsigned before = chip_resets();
    chip_pass_us(ticks);
    TEST_ASSERT_EQUAL_MESSAGE(before + 1U, chip_resets(), "it does not bite in time");
    TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 13));
    TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 14));
}

static uint32_t drawn_timeout(void) {
    static const uint32_t decades[8] = {8000, 20000, 8000,   20000,
                                        8000, 20000, 200000, 2000000}; /* timeouts from 2 ms on */
    const uint32_t most = decades[scattered() % 8U];
    return most / 4U + (uint32_t)(scattered() % most);
}

TEST(chip_watchdog, any_time_and_speed) {
    scattered_state = chip_seed(1);
    for (unsigned i = 0; i < 40; i++) {
        begin();
        timeout = i < 20 ? 20000U : drawn_timeout();
        if (i % 2U == 0) {
            world.watchdog_Hz = i % 8U == 0 ? 17000U : 47000U;
        }
        chip_run(start);
        chip_run(drive);
        for (unsigned times = 0; times < 6; times++) {
            is_quiet_for(times < 2 ? timeout : (uint32_t)(scattered() % (timeout / 8U)));
            chip_run(kick);
        }
        is_quiet_for(timeout);
        bites_by(timeout == 20000U ? 36000U
                                   : 2U * (uint64_t)timeout); /* 20 + 36 = 56 ms: docs/boards.md */
    }
}

/* The timeout is lengthened for an erase, then shortened again, at any instant and in quick succession. */
TEST(chip_watchdog, timeouts_are_changed) {
    scattered_state = chip_seed(2);
    for (unsigned i = 0; i < 8; i++) {
        begin();
        timeout = 20000;
        chip_run(start);
        for (unsigned rounds = 0; rounds < 2; rounds++) {
            for (unsigned times = (unsigned)(scattered() % 4U); times > 0; times--) {
                is_quiet_for((uint32_t)(scattered() % timeout));
                chip_run(kick);
            }
            timeout = 500000U + (uint32_t)(scattered() % 700000U);
            chip_run(start);
            if (scattered() % 4U == 0) {
                is_quiet_for(timeout);
                chip_run(kick);
            }
            timeout = 20000U;
            chip_run(start);
            is_quiet_for(timeout);
            chip_run(kick);
        }
        is_quiet_for(timeout);
        bites_by(2U * (uint64_t)timeout + 40U);
    }
}

/* A new timeout set at the last moment counts as a kick. */
TEST(chip_watchdog, late_timeout_counts_as_kick) {
    scattered_state = chip_seed(4);
    for (unsigned i = 0; i < 40; i++) {
        begin();
        world.watchdog_Hz = 46000U + scattered() % 1001U;
        timeout = 20000;
        chip_run(start);
        is_quiet_for(timeout);
        timeout = 30000U + (uint32_t)(scattered() % 20000U);
        chip_run(start);
        is_quiet_for(timeout);
        chip_run(kick);
    }
}

/* If a debugger has requested it (docs/boards.md), the watchdog stops while the debugger holds the core, and then
 * continues. */
static void freeze(void) { reg_store(DBGMCU_APB1_FZ, DBGMCU_APB1_FZ_IWDG); }
TEST(chip_watchdog, debugger) {
    scattered_state = chip_seed(3);
    begin();
    timeout = 20000;
    chip_run(start);
    chip_run(freeze);
    chip_halt(true);
    is_quiet_for(1000000);
    chip_halt(false);
    chip_run(kick);
    is_quiet_for(timeout);
    bites_by(60000);
}
