/* motor.c: the drive stage. The complementary output of TIM1's channel 1 is a PWM of 20 kHz (RM0090, 17.3, table 94).
 * Another pin enables the stage. The break input receives the stop signal and the stage's fault signal.
 *
 * The break input is active low, with a pull-down: a broken wire is a break. A break or a stopped crystal clears MOE
 * without software, so the output goes low. MOE cannot be set while the break is active. A lock-up of the core does not
 * clear MOE; the watchdog then resets the chip.
 *
 * If a debugger halts the core, TIM1's counter stops (DBG_TIM1_STOP), and an output could stay high. So the watchdog
 * keeps running in a halt. */
#include "hal/motor.h"

#include "hal/stop.h"

#include "stm32f4.h"

#define PWM_Hz 20000U
#define TIM1_FUNCTION 1U

static uint32_t whole;        /* compare value at which the output is always on */
static volatile bool driving; /* from hal_motor_start() to hal_motor_off(), even if MOE is clear */

void stm32f4_motor_start(void) {
    stm32f4_pin_is(BOARD_PIN_ENABLE, PIN_OUTPUT);
    stm32f4_clock_on(RCC_PART(RCC_APB2ENR, RCC_APB2ENR_TIM1));
    reg_set(DBGMCU_APB2_FZ, DBGMCU_APB2_FZ_TIM1);
    /* A debugger may have set this bit. It stops the watchdog in a halt, and resets do not clear it. */
    reg_clear(DBGMCU_APB1_FZ, DBGMCU_APB1_FZ_IWDG);
    whole = stm32f4_clocks_now()->timer1_Hz / PWM_Hz;
    stm32f4_pin_is(BOARD_PIN_BREAK, PIN_ALTERNATE(TIM1_FUNCTION) | PULL_DOWN);
    reg_store(TIM_CR1(TIM1), 0);
    reg_store(TIM_CR2(TIM1), 0); /* idle level OIS1N: low */
    reg_store(TIM_PSC(TIM1), 0);
    reg_store(TIM_ARR(TIM1), whole - 1U);
    reg_store(TIM_CCR(TIM1, 1U), 0);
    reg_store(TIM_CCMR(TIM1, 0U), TIM_CCMR_OC1M_PWM_1); /* no preload: stores act at once */
    reg_store(TIM_CCER(TIM1), TIM_CCER_CC1NE);
    reg_store(TIM_EGR(TIM1), TIM_EGR_UG);
    reg_store(TIM_BDTR(TIM1), BOARD_MOTOR_BDTR);
    reg_store(TIM_CR1(TIM1), TIM_CR1_CEN);
    stm32f4_pin_is(BOARD_PIN_PWM, PIN_ALTERNATE(TIM1_FUNCTION) | PULL_DOWN);
    driving = false;
}

/* True if MOE is clear although the motor was started. MOE stays clear, because no hardware sets it (AOE is 0). */
static bool is_cut(void) { return driving && (reg_load(TIM_BDTR(TIM1)) & TIM_BDTR_MOE) == 0; }

/* NaN and a missing supply give 0. */
static uint32_t compare_of(float volts) {
    const float supply_V = hal_motor_supply_V();
    if (!(volts > 0.0f) || !(supply_V > 0.0f)) {
        return 0;
    }
    return volts >= supply_V ? whole : (uint32_t)(volts / supply_V * (float)whole);
}

unsigned hal_motor_start(void) {
    /* a hal_motor_off() in an interrupt waits until stm32f4_go_on() */
    const uint32_t before = stm32f4_hold();
    if (!driving) {
        driving = true;
        reg_store(TIM_CCR(TIM1, 1U), 0);
        if (!hal_stop_pressed() && (reg_load(TIM_SR(TIM1)) & TIM_SR_BIF) == 0) {
            stm32f4_pin_set(BOARD_PIN_ENABLE, true);
            reg_store(TIM_BDTR(TIM1), BOARD_MOTOR_BDTR | TIM_BDTR_MOE);
        }
    }
    stm32f4_go_on(before);
    return hal_motor_status();
}

void hal_motor_set_voltage(float volts) { reg_store(TIM_CCR(TIM1, 1U), compare_of(volts)); }

/* Clears MOE first, as the fault handler does (BOARD_SAFE_ROWS). BIF is cleared, because it prevents the next start. */
void hal_motor_off(hal_motor_off_way way) {
    reg_store(TIM_BDTR(TIM1), BOARD_MOTOR_BDTR);
    stm32f4_pin_set(BOARD_PIN_ENABLE, way == HAL_MOTOR_BRAKE);
    if ((reg_load(TIM_SR(TIM1)) & TIM_SR_BIF) != 0) {
        reg_store(TIM_SR(TIM1), ~TIM_SR_BIF);
    }
    driving = false;
}

unsigned hal_motor_status(void) {
    return (is_cut() ? HAL_MOTOR_CUT : 0U) | (hal_stop_pressed() ? HAL_MOTOR_FAULT : 0U) |
           (hal_motor_supply_V() > 0.0f ? 0U : HAL_MOTOR_NO_SUPPLY);
}
