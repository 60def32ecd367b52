/* test_f405_motor.c: the drive stage's driver, on a timer whose output is as RM0090 has it (17.4.18 and table 94): orders and
 * breaks at random, and after each what the pins do. */
#include <math.h>

#include "boards/stm32f4/rm0090.h"
#include "hal/motor.h"
#include "tests/host/fake_registers.h"
#include "tests/scattered.h"
#include "unity.h"

void suite_f405_motor(void);
void stm32f4_motor_start(void);

#define BDTR TIM_BDTR(TIM1)
#define LOCKED \
    (3U << 8 | TIM_BDTR_OSSI | TIM_BDTR_OSSR | TIM_BDTR_BKE | 1U << 13 | 1U << 14 | 0xFFU)
#define BREAK_PIN PIN('A', 6)
#define ENABLE_PIN PIN('B', 14)

static bool pressed;
static float supply_V;
static uint32_t odr[3];

float hal_motor_supply_V(void) { return supply_V; }

/* The break acts by level: it clears MOE at once, and MOE cannot be set meanwhile (17.3.12). */
static void see_break(void) {
    if (pressed && (fake_get(BDTR) & TIM_BDTR_BKE) != 0) {
        fake_put(BDTR, fake_get(BDTR) & ~TIM_BDTR_MOE);
        fake_put(TIM_SR(TIM1), fake_get(TIM_SR(TIM1)) | TIM_SR_BIF);
    }
}

static void store(uint32_t address, uint32_t value) {
    if (address == BDTR) {
        const uint32_t held = (fake_get(BDTR) & 3U << 8) != 0 ? LOCKED : 0U;
        fake_put(BDTR, (fake_get(BDTR) & held) | (value & ~held));
    } else if (address == TIM_SR(TIM1)) {
        fake_put(address, fake_get(address) & value); /* a zero clears */
    } else if (address == GPIO_BSRR(0) || address == GPIO_BSRR(1)) {
        const unsigned port = address == GPIO_BSRR(1) ? 1U : 0U;
        odr[port] = (odr[port] & ~(value >> 16)) | (value & 0xFFFFU);
    } else {
        fake_put(address, value);
    }
    see_break();
}

static uint32_t load(uint32_t address) {
    return address == GPIO_IDR(0) && !pressed ? 1U << BREAK_PIN % 16U
           : address == GPIO_IDR(0)           ? 0U
                                              : fake_get(address);
}

static unsigned mode_of(unsigned pin) {
    return fake_get(GPIO_MODER(pin / 16U)) >> 2U * (pin % 16U) & 3U;
}

static bool enabled(void) {
    return mode_of(ENABLE_PIN) == 1U && (odr[ENABLE_PIN / 16U] >> ENABLE_PIN % 16U & 1U) != 0;
}

/* The part of the time that PB13 is high; -1: nobody drives it. */
static double output(void) {
    const uint32_t bdtr = fake_get(BDTR);
    const uint32_t ccer = fake_get(TIM_CCER(TIM1));
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, ccer & ~TIM_CCER_CC1NE,
                                    "the complementary output alone, not inverted");
    TEST_ASSERT_EQUAL_UINT(2U, mode_of(PIN('B', 13)));
    TEST_ASSERT_EQUAL_UINT(1U, fake_get(GPIO_AFR(1, 1)) >> 20 & 15U);
    if ((bdtr & TIM_BDTR_MOE) == 0) {
        const bool idle_high = (fake_get(TIM_CR2(TIM1)) & TIM_CR2_OIS1N) != 0;
        return (bdtr & TIM_BDTR_OSSI) == 0 ? -1.0 : idle_high ? 1.0 : 0.0;
    }
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(TIM_CCMR_OC1M_PWM_1, fake_get(TIM_CCMR(TIM1, 0)),
                                    "PWM mode 1, no preload");
    const double period = fake_get(TIM_ARR(TIM1)) + 1.0;
    const double high = fake_get(TIM_CCR(TIM1, 1U));
    return high > period ? 1.0 : high / period;
}

static double uniform(void) { return (double)(scattered() >> 11) * 0x1p-53; }

static void start(void) {
    fake_start(load, store);
    pressed = false;
    odr[0] = odr[1] = 0;
    supply_V = 24.0f;
    stm32f4_motor_start();
}

static void test_starts_off(void) {
    scattered_state = 3;
    start();
    TEST_ASSERT_TRUE(!enabled() && output() >= 0.0 && output() <= 0.0);
    TEST_ASSERT_TRUE_MESSAGE((fake_get(DBGMCU_APB2_FZ) & DBGMCU_APB2_FZ_TIM1) != 0,
                             "off while a debugger halts");
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, fake_get(BDTR) & (1U << 13 | 1U << 14),
                                    "active low, and never on by itself");
    TEST_ASSERT_TRUE((fake_get(BDTR) & TIM_BDTR_BKE) != 0 && (fake_get(BDTR) & 3U << 8) != 0);
    for (unsigned i = 0; i < fake.stores; i++) {
        TEST_ASSERT_TRUE_MESSAGE(fake.stored[i].address != BDTR ||
                                     (fake.stored[i].value & TIM_BDTR_MOE) == 0,
                                 "never driven");
    }
    const double frequency =
        168e6 / (fake_get(TIM_ARR(TIM1)) + 1.0) / (fake_get(TIM_PSC(TIM1)) + 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 20e3, frequency);
}

/* Orders and breaks at random: the output is what was ordered last of a motor that is started, else low, and after a break low
 * until off was ordered. */
static void test_orders_and_breaks(void) {
    scattered_state = 7;
    start();
    bool driving = false;
    bool cut = false;
    bool seen = false; /* it was pressed since the last off */
    for (unsigned i = 0; i < 20000; i++) {
        const unsigned what = (unsigned)(scattered() >> 61);
        const unsigned before = fake.stores = 0;
        double wanted = -1.0;
        if (what < 2) {
            const unsigned says = hal_motor_start();
            cut = cut || (!driving && seen);
            wanted = driving ? output() : 0.0;
            driving = true;
            TEST_ASSERT_EQUAL((pressed ? HAL_MOTOR_FAULT : 0) | (cut ? HAL_MOTOR_CUT : 0) |
                                  (supply_V > 0.0f ? 0 : HAL_MOTOR_NO_SUPPLY),
                              says);
        } else if (what < 4) {
            const double part = uniform() * 1.4 - 0.2;
            const float volts = what == 3 && part < 0.0 ? NAN : (float)(part * 24.0);
            supply_V = part > 1.1 ? 0.0f : 24.0f;
            hal_motor_set_voltage(volts);
            wanted = !driving || cut || !(volts > 0.0f) || !(supply_V > 0.0f) ? 0.0
                     : volts / supply_V > 1.0f                                ? 1.0
                                               : (double)(volts / supply_V);
        } else if (what < 6) {
            const hal_motor_off_way way = what == 4 ? HAL_MOTOR_COAST : HAL_MOTOR_BRAKE;
            hal_motor_off(way);
            TEST_ASSERT_TRUE_MESSAGE(fake.stored[before].address == BDTR &&
                                         (fake.stored[before].value & TIM_BDTR_MOE) == 0,
                                     "the output is the first to be off");
            driving = false;
            cut = false;
            seen = pressed;
            wanted = 0.0;
            TEST_ASSERT_TRUE(enabled() == (way == HAL_MOTOR_BRAKE));
        } else {
            pressed = !pressed && what == 6;
            see_break();
            seen = seen || pressed;
            cut = cut || (driving && pressed);
            wanted = cut || !driving ? 0.0 : output();
        }
        TEST_ASSERT_DOUBLE_WITHIN(1.0 / 8400.0, wanted, output());
        TEST_ASSERT_TRUE(!driving || cut || enabled());
        TEST_ASSERT_TRUE(((hal_motor_status() & HAL_MOTOR_CUT) != 0) == (driving && cut));
        TEST_ASSERT_TRUE(((hal_motor_status() & HAL_MOTOR_FAULT) != 0) == pressed);
    }
}

void suite_f405_motor(void) {
    RUN_TEST(test_starts_off);
    RUN_TEST(test_orders_and_breaks);
}
