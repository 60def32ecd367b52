/* motor.c: the drive stage: timer 1 as a phase-correct PWM of 20 kHz on OC1A (DS 17.9.4), the enable on a pin. Both
 * pins are low when the timer does not drive them.
 *
 * The PWM has 400 steps, 60 mV of 24 V. The quantization error of the voltage is added to the next control step's
 * voltage, so that the mean is exact. */
#include "hal/motor.h"

#include "hal/stop.h"

#include "atmega.h"

#define WHOLE 400U /* F_CPU/2 / 20 kHz */
#define PARTS 64U  /* parts of a PWM step: unit of the carried error */
_Static_assert(WHOLE *PARTS == ATMEGA_WHOLE, "all of the supply");

static volatile bool driving; /* an interrupt may also clear it */
static uint16_t carried;      /* the carried error, in parts of a step */

/* Timer 1 with OC1A low, duty 0 and disconnected from its pin. OC1A keeps its level from the last disconnection, and
 * only a strobe in normal mode sets it (DS 17.7.1, 17.8). The pin is an input until then. In normal mode OCR1A also
 * takes effect at once. ICR1 is set after the mode, because it is writable only in modes that use it as TOP (DS
 * 17.6). */
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

/* The outputs are off from the first store on; the pins' port level is low. */
void atmega_motor_start(void) {
    PORTB &= (uint8_t)~_BV(ATMEGA_ENABLE_BIT);
    PORTB &= (uint8_t)~_BV(ATMEGA_PWM_BIT);
    DDRB |= _BV(ATMEGA_ENABLE_BIT);
    set_up_timer();
    DDRB &= (uint8_t)~_BV(ATMEGA_STOP_BIT);
    PORTB |= _BV(ATMEGA_STOP_BIT); /* pulled up, so that a broken wire counts as pressed (stop.c) */
    driving = false;
}

/* NaN and a missing supply give 0. */
static uint16_t parts_of(float volts) {
    const float parts = volts * atmega_parts_per_V();
    return !(parts > 0.0f) ? 0U : parts >= (float)ATMEGA_WHOLE ? WHOLE * PARTS : (uint16_t)parts;
}

unsigned hal_motor_start(void) {
    const unsigned status = hal_motor_status();
    /* a hal_motor_off() from an interrupt waits until atmega_go_on() */
    const uint8_t before = atmega_hold();
    if (!driving && (status & HAL_MOTOR_FAULT) == 0) {
        driving = true;
        carried = 0;
        /* again, because a hal_motor_off() may have interrupted a change of the settings */
        set_up_timer();
        PORTB |= _BV(ATMEGA_ENABLE_BIT);
        TCCR1A = _BV(COM1A1) | _BV(WGM11);
    }
    atmega_go_on(before);
    return status;
}

void hal_motor_set_voltage(float volts) {
    if (!driving) {
        return; /* after a start the voltage begins at 0 */
    }
    const uint16_t parts = parts_of(volts);
    const uint16_t owed = parts + carried;
    uint16_t steps = owed / PARTS;
    carried = owed % PARTS;
    steps = steps < WHOLE ? steps : WHOLE;
    OCR1A = steps;
}

/* Clears the enable first, by one instruction, which is also the first action of a fault (fault.c). */
void hal_motor_off(hal_motor_off_way way) {
    if (way != HAL_MOTOR_BRAKE) {
        PORTB &= (uint8_t)~_BV(ATMEGA_ENABLE_BIT);
    }
    TCCR1A = _BV(WGM11); /* disconnects the timer from the pin, which is low */
    OCR1A = 0;           /* takes effect in the next period, as after a start */
    if (way == HAL_MOTOR_BRAKE) {
        PORTB |= _BV(ATMEGA_ENABLE_BIT);
    }
    driving = false;
    carried = 0;
}

/* No bit for a cut: only software can switch this motor off. */
unsigned hal_motor_status(void) {
    return (hal_stop_pressed() ? HAL_MOTOR_FAULT : 0U) |
           (hal_motor_supply_V() > 0.0f ? 0U : HAL_MOTOR_NO_SUPPLY);
}
