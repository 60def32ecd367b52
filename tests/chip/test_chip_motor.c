/* test_chip_motor.c: the motor's PWM, enable and break at the pins of the chip model. */
#include <math.h>

#include "tests/suites.h"

#include "boards/stm32f4/stm32f4.h"
#include "hal/motor.h"
#include "hal/stop.h"
#include "hal/watchdog.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

static float volts;
static hal_motor_off_way way;
static unsigned status;
static float supply_V;
static bool pressed;
static void set(void) {
    (void)hal_motor_start();
    hal_motor_set_voltage(volts);
}
static void set_alone(void) { hal_motor_set_voltage(volts); }
static void off(void) { hal_motor_off(way); }
static void start(void) { status = hal_motor_start(); }
static void draw_way(void) { way = (scattered() & 1U) != 0 ? HAL_MOTOR_COAST : HAL_MOTOR_BRAKE; }
static void look(void) {
    status = hal_motor_status();
    supply_V = hal_motor_supply_V();
    pressed = hal_stop_pressed();
}
static void set_to(float V) {
    volts = V;
    chip_run(set);
}

#define PERIOD_UNITS (CHIP_UNITS_PER_S / 20000U)
#define TICKS 8400U

/* Returns the number of ticks in one period during which the pin is high. Interrupts are off, because they would take
 * time between two reads. */
static unsigned high_ticks(void) {
    unsigned high = 0;
    const uint32_t before = reg_hold();
    for (unsigned i = 0; i < TICKS; i++) {
        high += chip_pin('B', 13) == CHIP_HIGH ? 1U : 0U;
        chip_pass(PERIOD_UNITS / TICKS);
    }
    reg_go_on(before);
    return high;
}
static void is_low_for(uint64_t units) {
    for (unsigned i = 0; i < 20; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(CHIP_LOW, chip_pin('B', 13), "PWM is to be low");
        chip_pass(units / 20U);
    }
    TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 13));
}
static bool enabled(void) { return chip_pin('B', 14) == CHIP_HIGH; }

/* In reset and before any start the pin is low, even if hal_motor_off() is called. */
TEST(chip_motor, before_the_start) {
    chip_wired(1);
    chip_reset(CHIP_BY_POWER);
    is_low_for(PERIOD_UNITS);
    TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 14));
    way = HAL_MOTOR_COAST;
    TEST_ASSERT_EQUAL(CHIP_RETURNED, chip_try(off));
    is_low_for(PERIOD_UNITS);
    TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 14));
    chip_forgive(); /* The motor's peripherals have no clock yet, so the stores have no effect. */
    chip_on(1);
    is_low_for(PERIOD_UNITS);
    TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 14));
}

static void never_driven(void) {
    TEST_ASSERT_FALSE(chip_pin('B', 13) == CHIP_HIGH);
    TEST_ASSERT_FALSE(chip_pin('B', 14) == CHIP_HIGH);
}
/* A loader in ROM may have set any levels in the output registers of its inputs. */
static uint32_t left_levels;
static void leave_levels(void) {
    reg_store(0x40023830U, reg_load(0x40023830U) | 2U); /* clock of port B (RCC_AHB1ENR) */
    (void)reg_load(0x40023830U);
    reg_store(0x40020414U, left_levels); /* GPIOB_ODR */
}
TEST(chip_motor, through_the_start) {
    scattered_state = chip_seed(2);
    for (unsigned i = 0; i < 12; i++) {
        chip_wired(scattered());
        chip_reset(CHIP_BY_POWER);
        left_levels = i == 0 ? 0U : (uint32_t)scattered() & 0xFFFFU;
        chip_run(leave_levels);
        chip_stored = never_driven;
        chip_image_starts();
        chip_stored = NULL;
    }
}

TEST(chip_motor, duty) {
    scattered_state = chip_seed(3);
    for (unsigned chips = 0; chips < 6; chips++) {
        chip_on(scattered());
        chip_supply_V = 6.0 + (double)(scattered() % 2400U) / 100.0;
        chip_pass_us(20000);
        chip_run(look);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, chip_supply_V, (double)supply_V);
        for (unsigned i = 0; i < 5; i++) {
            const float V = (float)(scattered() % 10001U) / 10000.0F * supply_V;
            set_to(V);
            chip_pass(scattered() % PERIOD_UNITS);
            TEST_ASSERT_TRUE(enabled());
            chip_run(look);
            TEST_ASSERT_DOUBLE_WITHIN(1.01, (double)V / (double)supply_V * TICKS, high_ticks());
            TEST_ASSERT_EQUAL(0, status);
        }
    }
}

TEST(chip_motor, voltages_out_of_range) {
    static const struct {
        float volts;
        unsigned high;
    } rows[] = {{NAN, 0},        {-1.0F, 0},        {-INFINITY, 0}, {0.0F, 0},
                {100.0F, TICKS}, {INFINITY, TICKS}, {3e38F, TICKS}};
    chip_on(4);
    chip_pass_us(10000);
    for (unsigned i = 0; i < 2U * sizeof rows / sizeof *rows; i++) {
        if (i == sizeof rows / sizeof *rows) {
            set_to(5.0F); /* before the second pass through the rows */
        }
        set_to(rows[i % (sizeof rows / sizeof *rows)].volts);
        TEST_ASSERT_EQUAL(rows[i % (sizeof rows / sizeof *rows)].high, high_ticks());
        TEST_ASSERT_TRUE(enabled());
    }
    way = HAL_MOTOR_COAST;
    chip_run(off);
    set_to(NAN);
    TEST_ASSERT_EQUAL(0, high_ticks());
}

/* The first store of hal_motor_off() switches the output off, at any instant of the period and at any duty. */
static unsigned stores;
static void first_store(void) {
    if (stores++ == 0) {
        is_low_for(PERIOD_UNITS);
    }
}
TEST(chip_motor, off_lowers_the_pin_immediately) {
    scattered_state = chip_seed(5);
    chip_on(5);
    chip_pass_us(10000);
    for (unsigned i = 0; i < 60; i++) {
        set_to((float)(scattered() % 13U));
        if (i % 4 == 3) {
            draw_way();
            chip_run(off); /* the motor is already off */
        }
        chip_pass(scattered() % (3U * PERIOD_UNITS));
        draw_way();
        stores = 0;
        chip_stored = first_store;
        chip_run(off);
        chip_stored = NULL;
        is_low_for(PERIOD_UNITS);
        TEST_ASSERT_EQUAL(way == HAL_MOTOR_BRAKE, enabled());
        chip_run(look);
        TEST_ASSERT_EQUAL(0, status);
    }
}

/* The first stores of a fault (boards/cortexm/fault.c), made before any use of the stack. The first turns the PWM off,
 * the second the enable. */
static void fault_stores(void) {
#define SAFE_STORE(address, value) reg_store((address), (value));
    BOARD_SAFE_ROWS(SAFE_STORE)
}
TEST(chip_motor, fault_from_anywhere) {
    scattered_state = chip_seed(11);
    for (unsigned i = 0; i < 12; i++) {
        chip_on(scattered());
        chip_pass_us(6000);
        set_to(1.0F + (float)(scattered() % 12U));
        chip_pass(scattered() % (3U * PERIOD_UNITS));
        stores = 0;
        chip_stored = first_store;
        chip_run(fault_stores);
        chip_stored = NULL;
        is_low_for(PERIOD_UNITS);
        TEST_ASSERT_FALSE(enabled());
    }
}

/* The stop input, or a fault of the drive stage, pulls the output low without software. The output stays low until the
 * motor has been switched off. Pulses have any length, in any order. */
TEST(chip_motor, break) {
    scattered_state = chip_seed(6);
    chip_on(6);
    chip_pass_us(10000);
    for (unsigned i = 0; i < 60; i++) {
        set_to(1.0F + (float)(scattered() % 12U));
        chip_pass(scattered() % (2U * PERIOD_UNITS));
        chip_pin_drive('A', 6, (scattered() & 1U) != 0 ? CHIP_LOW : CHIP_OPEN);
        TEST_ASSERT_EQUAL_MESSAGE(CHIP_LOW, chip_pin('B', 13), "with no software in the way");
        const bool stays = (scattered() & 1U) != 0;
        if (stays) {
            is_low_for(PERIOD_UNITS);
            chip_run(look);
            TEST_ASSERT_TRUE(pressed);
            TEST_ASSERT_EQUAL(HAL_MOTOR_CUT | HAL_MOTOR_FAULT, status);
            set_to(12.0F);
            is_low_for(PERIOD_UNITS);
        }
        chip_pass(scattered() % CHIP_UNITS_PER_US);
        chip_pin_drive('A', 6, CHIP_HIGH);
        is_low_for(PERIOD_UNITS);
        for (unsigned again = 0; again < 3; again++) {
            set_to(12.0F);
            is_low_for(PERIOD_UNITS);
            chip_run(look);
            TEST_ASSERT_FALSE(pressed);
            TEST_ASSERT_EQUAL(HAL_MOTOR_CUT, status);
        }
        way = HAL_MOTOR_COAST;
        chip_run(off);
        is_low_for(PERIOD_UNITS);
        chip_run(look);
        TEST_ASSERT_EQUAL(0, status);
        set_to(12.0F);
        TEST_ASSERT_EQUAL(TICKS, high_ticks());
    }
}

/* A voltage that is set while stop is pressed has no effect, even after stop is released. The motor must be switched
 * off and started again. */
TEST(chip_motor, voltage_while_stop_is_pressed) {
    chip_on(7);
    chip_pass_us(10000);
    chip_pin_drive('A', 6, CHIP_LOW);
    set_to(6.0F);
    is_low_for(PERIOD_UNITS);
    chip_run(look);
    TEST_ASSERT_EQUAL(HAL_MOTOR_CUT | HAL_MOTOR_FAULT, status);
    TEST_ASSERT_FALSE(enabled());
    chip_pin_drive('A', 6, CHIP_HIGH);
    is_low_for(PERIOD_UNITS);
    set_to(6.0F);
    is_low_for(PERIOD_UNITS);
    chip_run(look);
    TEST_ASSERT_EQUAL(HAL_MOTOR_CUT, status);
    way = HAL_MOTOR_COAST;
    chip_run(off);
    set_to(supply_V);
    TEST_ASSERT_EQUAL(TICKS, high_ticks());
}

/* While the motor is off, the program switches it off again in each step. If stop was pressed since the last of these
 * calls, a start has no effect. */
TEST(chip_motor, pressed_before_a_start) {
    scattered_state = chip_seed(14);
    chip_on(14);
    chip_pass_us(10000);
    chip_run(look);
    for (unsigned i = 0; i < 40; i++) {
        const bool presses = i % 2U == 0;
        way = HAL_MOTOR_COAST;
        chip_run(off);
        chip_pass(scattered() % CHIP_UNITS_PER_US);
        if (presses) {
            chip_pin_drive('A', 6, CHIP_LOW);
            chip_pass(scattered() % (1000U * CHIP_UNITS_PER_US) + CHIP_UNITS_PER_US);
            chip_pin_drive('A', 6, CHIP_HIGH);
            chip_pass(scattered() % CHIP_UNITS_PER_US);
        }
        set_to(supply_V);
        chip_run(look);
        TEST_ASSERT_EQUAL(presses ? HAL_MOTOR_CUT : 0, status);
        TEST_ASSERT_EQUAL(presses ? 0 : TICKS, high_ticks());
    }
}

/* A voltage has no effect before a start or after the motor was switched off. */
TEST(chip_motor, voltage_without_start_has_no_effect) {
    scattered_state = chip_seed(12);
    chip_on(12);
    chip_pass_us(10000);
    for (unsigned i = 0; i < 40; i++) {
        volts = (float)(scattered() % 13U);
        chip_run(set_alone);
        is_low_for(PERIOD_UNITS);
        chip_run(look);
        TEST_ASSERT_EQUAL(0, status);
        set_to(1.0F + (float)(scattered() % 12U));
        TEST_ASSERT_TRUE(high_ticks() > 0);
        draw_way();
        chip_run(off);
    }
}

/* After the store that sets a voltage, an interrupt switches the motor off. The output stays off, whatever voltages
 * follow. */
static void off_behind(void) {
    chip_stored = NULL;
    hal_motor_off(way);
}
TEST(chip_motor, off_in_an_interrupt) {
    scattered_state = chip_seed(13);
    chip_on(13);
    chip_pass_us(10000);
    for (unsigned i = 0; i < 60; i++) {
        set_to(1.0F + (float)(scattered() % 12U));
        chip_pass(scattered() % PERIOD_UNITS);
        draw_way();
        volts = 1.0F + (float)(scattered() % 12U);
        chip_stored = off_behind;
        chip_run(set_alone);
        TEST_ASSERT_NULL(chip_stored);
        for (unsigned again = 0; again < 3; again++) {
            is_low_for(PERIOD_UNITS);
            TEST_ASSERT_EQUAL(way == HAL_MOTOR_BRAKE, enabled());
            chip_run(set_alone);
        }
    }
}

/* A start is atomic. An interrupt that switches the motor off comes before the first store of the start or after the
 * last one. */
static void is_held(void) { TEST_ASSERT_TRUE_MESSAGE(chip_is_masked(), "an off may come between"); }
TEST(chip_motor, start_is_whole) {
    chip_on(15);
    chip_pass_us(10000);
    for (unsigned i = 0; i < 10; i++) {
        chip_stored = is_held;
        chip_run(start);
        chip_stored = NULL;
        TEST_ASSERT_FALSE(chip_is_masked());
        TEST_ASSERT_EQUAL(0, status);
        chip_run(off);
    }
}

TEST(chip_motor, no_supply) {
    chip_on(8);
    chip_supply_V = 0.0;
    chip_pass_us(10000);
    set_to(6.0F);
    chip_run(look);
    TEST_ASSERT_TRUE(supply_V <= 0.0F);
    TEST_ASSERT_EQUAL(HAL_MOTOR_NO_SUPPLY, status);
    TEST_ASSERT_EQUAL(0, high_ticks());
}

/* A debugger halts the core at any instant, and the motor goes off. Either the halt disables the outputs at once, or
 * the watchdog resets the chip. Settings that a debugger made before the start change nothing. */
static void freeze_watchdog(void) { reg_store(DBGMCU_APB1_FZ, DBGMCU_APB1_FZ_IWDG); }
static void watch(void) { hal_watchdog_start(20000); }
TEST(chip_motor, debugger) {
    scattered_state = chip_seed(9);
    for (unsigned i = 0; i < 20; i++) {
        chip_on(scattered());
        world.halt_disables = i % 2U == 0;
        world.watchdog_Hz = 17000U + scattered() % 30001U;
        chip_run(freeze_watchdog);
        chip_restart(CHIP_BY_SOFTWARE);
        chip_pass_us(10000);
        chip_run(watch);
        set_to(6.0F);
        chip_pass(scattered() % (3U * PERIOD_UNITS));
        const unsigned resets = chip_resets();
        chip_halt(true);
        if (world.halt_disables) {
            is_low_for(3U * PERIOD_UNITS);
        }
        chip_pass_us(57000);
        TEST_ASSERT_TRUE_MESSAGE(chip_resets() > resets, "the watchdog stands still");
        is_low_for(PERIOD_UNITS);
        TEST_ASSERT_FALSE(enabled());
        chip_halt(false);
    }
}

/* After a reset at any instant, both pins float, and resistors pull them low. */
TEST(chip_motor, reset_at_any_instant) {
    scattered_state = chip_seed(10);
    for (unsigned i = 0; i < 12; i++) {
        chip_on(scattered());
        chip_pass_us(6000);
        set_to(12.0F);
        chip_pass(scattered() % (3U * PERIOD_UNITS));
        chip_reset((chip_cause)(scattered() % 5U));
        is_low_for(PERIOD_UNITS);
        TEST_ASSERT_EQUAL(CHIP_LOW, chip_pin('B', 14));
    }
}
