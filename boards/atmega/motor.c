/* motor.c: the drive stage. Timer 1 is a phase-correct PWM of 20 kHz on OC1A (DS 17.9.4); another pin is the enable.
 * The PWM has 400 steps, of 60 mV each if the supply has 24 V. The rounding error of the voltage is added to the next
 * control step's voltage, so the mean is exact. */
#include "hal/motor.h"

#include "hal/stop.h"

#include "atmega.h"

#define WHOLE 400U /* F_CPU/2 / 20 kHz */
#define PARTS 64U  /* number of parts in a PWM step; rounding errors are counted in parts */
_Static_assert(WHOLE *PARTS == ATMEGA_WHOLE, "all of the supply");

static volatile bool driving; /* an interrupt may clear it, too */
static uint16_t carried;      /* rounding error, in units of 1/PARTS of a PWM step */

/* Sets timer 1 to duty 0. The order of the stores keeps the pin's output low (DS 17.6, 17.7.1, 17.8). */
static void set_up_timer(void) {
    DDRB &= (uint8_t)~_BV(ATMEGA_PWM_BIT);
    TCCR1B = 0;
    TCCR1A = _BV(COM1A1);
    TCCR1C = _BV(FOC1A);
    OCR1A = 0;
    TCCR1A = _BV(WGM11);
    TCCR1B = _BV(WGM13);
    ICR1 = WHOLE;
    TCCR1B = _BV(WGM13) | _BV(CS10);
    DDRB |= _BV(ATMEGA_PWM_BIT);
}

/* Both pins are set low before they become outputs. */
void atmega_motor_start(void) {
    PORTB &= (uint8_t)~_BV(ATMEGA_ENABLE_BIT);
    PORTB &= (uint8_t)~_BV(ATMEGA_PWM_BIT);
    DDRB |= _BV(ATMEGA_ENABLE_BIT);
    set_up_timer();
    DDRB &= (uint8_t)~_BV(ATMEGA_STOP_BIT);
    PORTB |= _BV(ATMEGA_STOP_BIT); /* pulled up, so that a broken wire counts as pressed (stop.c) */
    driving = false;
}

/* Returns a voltage as a number of parts of a PWM step. NaN and a missing supply give 0. */
static uint16_t parts_of(float volts) {
    const float parts = volts * atmega_parts_per_V();
    return !(parts > 0.0f) ? 0U : parts >= (float)ATMEGA_WHOLE ? WHOLE * PARTS : (uint16_t)parts;
}

unsigned hal_motor_start(void) {
    const unsigned status = hal_motor_status();
    /* no interrupt may call hal_motor_off() in the middle of the start */
    const uint8_t before = atmega_hold();
    if (!driving && (status & HAL_MOTOR_FAULT) == 0) {
        driving = true;
        carried = 0;
        /* if hal_motor_off() interrupted hal_motor_set_voltage(), OCR1A still has an old duty */
        set_up_timer();
        PORTB |= _BV(ATMEGA_ENABLE_BIT);
        TCCR1A = _BV(COM1A1) | _BV(WGM11);
    }
    atmega_go_on(before);
    return status;
}

void hal_motor_set_voltage(float volts) {
    if (!driving) {
        return;
    }
    const uint16_t parts = parts_of(volts);
    const uint16_t owed = parts + carried;
    uint16_t steps = owed / PARTS;
    carried = owed % PARTS;
    steps = steps < WHOLE ? steps : WHOLE;
    OCR1A = steps;
}

void hal_motor_off(hal_motor_off_way way) {
    if (way != HAL_MOTOR_BRAKE) {
        PORTB &= (uint8_t)~_BV(ATMEGA_ENABLE_BIT);
    }
    TCCR1A = _BV(WGM11); /* disconnects the timer from the pin, which is low */
    OCR1A = 0;           /* takes effect in the next period */
    if (way == HAL_MOTOR_BRAKE) {
        PORTB |= _BV(ATMEGA_ENABLE_BIT);
    }
    driving = false;
    carried = 0;
}

/* Never HAL_MOTOR_CUT, because only software can switch this motor off. */
unsigned hal_motor_status(void) {
    return (hal_stop_pressed() ? HAL_MOTOR_FAULT : 0U) |
           (hal_motor_supply_V() > 0.0f ? 0U : HAL_MOTOR_NO_SUPPLY);
}
