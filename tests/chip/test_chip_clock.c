/* test_chip_clock.c: start and time of the STM32F405 on the chip model. No limit of the clock tree or the flash is
 * exceeded at any instant. A dead clock delays the start only briefly. */
#include "tests/suites.h"

#include "boards/stm32f4/registers.h"
#include "hal/motor.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

static uint32_t ticks;
static void read_ticks(void) { ticks = hal_clock_ticks(); }

/* Returns the error of the timer's ticks over `s` seconds, in ppm. A tick is a microsecond. */
static double ppm_over(double s) {
    chip_run(read_ticks);
    const uint32_t before = ticks;
    const uint64_t then = chip_now();
    chip_pass((uint64_t)(s * (double)CHIP_UNITS_PER_S));
    chip_run(read_ticks);
    const double us = (double)(chip_now() - then) / (double)CHIP_UNITS_PER_US;
    return ((double)(ticks - before) / us - 1.0) * 1e6;
}

TEST(chip_clock, crystals_that_start) {
    scattered_state = chip_seed(1);
    for (unsigned i = 0; i < 20; i++) {
        chip_wired(scattered());
        world.crystal_units =
            /* typically 2 ms (DS8626, table 36) */
            (200U + scattered() % 5000U) * CHIP_UNITS_PER_US;
        chip_restart(CHIP_BY_POWER);
        TEST_ASSERT_EQUAL(HAL_CLOCK_CRYSTAL, hal_clock_source_now());
        const chip_clocks now = chip_clocks_now();
        TEST_ASSERT_EQUAL(168000000, now.core_Hz);
        TEST_ASSERT_EQUAL(42000000, now.apb1_Hz);
        TEST_ASSERT_EQUAL(84000000, now.apb2_Hz);
        TEST_ASSERT_TRUE(ppm_over(0.05) < 25.0 &&
                         ppm_over(0.05) > -25.0); /* one tick in 50 ms is 20 ppm */
    }
}

static void fallback_is_taken(uint64_t most_ms) {
    const uint64_t then = chip_now();
    chip_restart(CHIP_BY_POWER);
    TEST_ASSERT_TRUE_MESSAGE(chip_now() - then < most_ms * 1000U * CHIP_UNITS_PER_US,
                             "the start waits too long");
    TEST_ASSERT_EQUAL(HAL_CLOCK_FALLBACK, hal_clock_source_now());
    TEST_ASSERT_EQUAL(16000000, chip_clocks_now().core_Hz);
    TEST_ASSERT_TRUE(ppm_over(0.05) < 25.0 && ppm_over(0.05) > -25.0);
}

TEST(chip_clock, no_crystal) {
    chip_wired(2);
    world.crystal = false;
    fallback_is_taken(1000);
}

TEST(chip_clock, no_lock) {
    chip_wired(3);
    world.pll = false;
    fallback_is_taken(1000);
}

/* A crystal starts at about the end of the driver's timeout. The core runs on either source, and no limit is
 * exceeded. */
TEST(chip_clock, crystals_that_are_late) {
    scattered_state = chip_seed(7);
    unsigned taken = 0;
    for (unsigned i = 0; i < 30; i++) {
        chip_wired(scattered());
        world.crystal_units =
            (scattered() % 15000U + (i % 2U == 0 ? 0U : 30000U)) * CHIP_UNITS_PER_US;
        chip_restart(CHIP_BY_POWER);
        chip_pass_us(60000);
        TEST_ASSERT_EQUAL_STRING("none", chip_violation());
        const bool crystal = hal_clock_source_now() == HAL_CLOCK_CRYSTAL;
        TEST_ASSERT_EQUAL(crystal ? 168000000U : 16000000U, chip_clocks_now().core_Hz);
        TEST_ASSERT_TRUE(ppm_over(0.05) < 25.0 && ppm_over(0.05) > -25.0);
        taken += crystal ? 1U : 0U;
    }
    TEST_ASSERT_EQUAL(15, taken);
}

/* A loader in ROM has left the core on a PLL, at any speed, with any crystal, bus dividers and wait states. */
#define RCC_AT(offset) (0x40023800U + (offset))
static void wait_for(uint32_t offset, uint32_t bit) {
    while ((reg_load(RCC_AT(offset)) & bit) == 0) {
    }
}
static bool bypassed; /* the oscillator's amplifier is bypassed */
static void loader(void) {
    reg_store(RCC_AT(0x00U), reg_load(RCC_AT(0x00U)) | (bypassed ? 0x40000U : 0U));
    reg_store(RCC_AT(0x00U), reg_load(RCC_AT(0x00U)) | 0x10000U);
    wait_for(0x00U, 0x20000U);
    reg_store(RCC_AT(0x04U), 16U | 240U << 6 | 1U << 16 | 5U << 24); /* 60 MHz from HSI */
    reg_store(RCC_AT(0x00U), reg_load(RCC_AT(0x00U)) | 0x1000000U);
    wait_for(0x00U, 0x2000000U);
    reg_store(0x40023C00U, 1U);
    reg_store(RCC_AT(0x08U), 4U << 10);
    reg_store(RCC_AT(0x08U), 4U << 10 | 2U);
    wait_for(0x08U, 8U);
    reg_store(RCC_AT(0x30U), 0x00100007U);
    (void)reg_load(RCC_AT(0x30U));
}
TEST(chip_clock, clock_after_a_boot_loader) {
    scattered_state = chip_seed(8);
    for (unsigned i = 0; i < 14; i++) {
        chip_wired(30 + i);
        world.access_cycles = 3U + (unsigned)(scattered() % 6U);
        bypassed = (scattered() & 1U) != 0;
        chip_reset(CHIP_BY_POWER);
        chip_run(loader);
        TEST_ASSERT_EQUAL(60000000, chip_clocks_now().core_Hz);
        chip_image_starts();
        TEST_ASSERT_EQUAL(HAL_CLOCK_CRYSTAL, hal_clock_source_now());
        TEST_ASSERT_EQUAL_MESSAGE(0, reg_load(RCC_AT(0x00U)) & 0x40000U,
                                  "a crystal needs its amplifier");
        TEST_ASSERT_EQUAL(168000000, chip_clocks_now().core_Hz);
        TEST_ASSERT_TRUE(ppm_over(0.05) < 25.0 && ppm_over(0.05) > -25.0);
    }
}

TEST(chip_clock, from_every_reset) {
    static const chip_cause causes[] = {CHIP_BY_DIP, CHIP_BY_PIN, CHIP_BY_WATCHDOG,
                                        CHIP_BY_SOFTWARE};
    for (unsigned i = 0; i < sizeof causes / sizeof *causes; i++) {
        chip_on(4 + i);
        chip_pass_us(10000);
        chip_restart(causes[i]);
        TEST_ASSERT_EQUAL(168000000, chip_clocks_now().core_Hz);
    }
}

static uint32_t target;
static void wait_there(void) { hal_clock_wait_until(target); }

/* A wait is never too short and at most 0.1 ms too long, even if the timer wraps or interrupts come. */
TEST(chip_clock, waits) {
    scattered_state = chip_seed(5);
    chip_on(5);
    for (unsigned i = 0; i < 60; i++) {
        if (i % 3 == 0) {
            chip_tim2_count_is(UINT32_MAX - (uint32_t)(scattered() % 2000U));
        }
        const uint32_t ahead = (uint32_t)(scattered() % 3000U);
        target = chip_tim2_count() + ahead;
        chip_run(wait_there);
        const uint32_t late = chip_tim2_count() - target;
        TEST_ASSERT_TRUE_MESSAGE(late < 100U, "not within 0.1 ms behind what was asked");
    }
    target = chip_tim2_count() - 1000U;
    const uint64_t then = chip_now();
    chip_run(wait_there);
    TEST_ASSERT_TRUE_MESSAGE(chip_now() - then < 20U * CHIP_UNITS_PER_US,
                             "it waits for what is past");
    TEST_ASSERT_EQUAL_STRING("none", chip_violation());
}

static void drive(void) {
    (void)hal_motor_start();
    hal_motor_set_voltage(6.0F);
}

/* The crystal stops while the motor turns. The hardware pulls the output low before the NMI. */
TEST(chip_clock, crystal_dies) {
    scattered_state = chip_seed(6);
    for (unsigned i = 0; i < 10; i++) {
        chip_on(scattered());
        chip_pass_us(5000);
        chip_run(drive);
        unsigned high = 0;
        for (unsigned at = 0; at < 100; at++) {
            chip_pass(CHIP_UNITS_PER_US + scattered() % CHIP_UNITS_PER_US);
            high += chip_pin('B', 13) == CHIP_HIGH ? 1U : 0U;
        }
        TEST_ASSERT_TRUE(high > 20 && high < 80);
        chip_pass(scattered() % (100U * CHIP_UNITS_PER_US));
        chip_crystal_stops();
        TEST_ASSERT_EQUAL_MESSAGE(CHIP_LOW, chip_pin('B', 13), "the output at once");
        chip_pass_us(1);
        TEST_ASSERT_TRUE_MESSAGE(chip_nmi_taken(), "the crystal's guard raises no NMI");
        chip_pass_us(1000);
        TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 13));
        TEST_ASSERT_EQUAL_STRING("none", chip_violation());
    }
}
