/* cell.c: load cell and supply by the chip's 10-bit converter (DS 26).
 *
 * Timer 2 starts a conversion every 200 us. In a period of 8 ms, 16 conversions of the cell precede 24 conversions of
 * the supply. A sample is the mean of the 16 conversions. The time stamp of a sample is the middle of the 16
 * conversions. One count of the converter is 0.434 N.
 *
 * The reference is the chip's supply. Without force, the amplifier's output is half of the reference. If a wire is
 * broken, a resistor pulls the pin to ground. */
#include "hal/loadcell.h"
#include "hal/motor.h"

#include "atmega.h"

#define TICK_TICKS 200U
#define CELL_TICKS 16U
#define ALL_TICKS (HAL_LOADCELL_PERIOD_TICKS / TICK_TICKS)
#define SUPPLY_TICKS 8U /* the last 8 of the supply's conversions are used */
_Static_assert(ALL_TICKS *TICK_TICKS == HAL_LOADCELL_PERIOD_TICKS &&
                   ALL_TICKS >= CELL_TICKS + SUPPLY_TICKS && ALL_TICKS <= 255U,
               "a sample each period");

#define TIMER_COUNT_TICKS 2U
_Static_assert(F_CPU / 32U == 1000000U / TIMER_COUNT_TICKS, "the prescaler's 32nd");

/* Time from the start of a conversion until the input is held: one and a half clocks of 125 kHz (DS 26.4). */
#define HELD_TICKS 12U
/* Time from the middle of the sixteen conversions to the tick at the end of the sixteenth. */
#define BEHIND_TICKS (CELL_TICKS * TICK_TICKS / 2U + TICK_TICKS / 2U - HELD_TICKS)

#define FULL 1023U
#define MIDDLE 512U
#define RAIL (FULL / 64U)       /* margin in which no amplifier is linear: 73 mV */
#define OPEN_BELOW (FULL / 16U) /* an input below 0.3 V is not connected */
#define REFERENCE _BV(REFS0)
/* clock divided by 128: 125 kHz */
#define CONVERTER (_BV(ADEN) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0))

/* A sum of supply conversions gets the bit SUPPLY_BEYOND if one of them is above SUPPLY_END. */
#define SUPPLY_END (FULL - RAIL)
#define SUPPLY_BEYOND 0x8000U
#define SUPPLY_V_PER_COUNT ((float)ATMEGA_SUPPLY_FULL_mV / 1000.0f / 1024.0f)
_Static_assert(HAL_MOTOR_SUPPLY_IS_SEEN(HAL_MOTOR_SUPPLY_MOST_mV,
                                        ATMEGA_SUPPLY_FULL_mV *SUPPLY_END / 1024U),
               "the measurement ends too near to its limit");
_Static_assert(SUPPLY_TICKS *FULL < SUPPLY_BEYOND, "the sum leaves the bit alone");

#define SAMPLES_KEPT 4U /* a power of two */

typedef struct cell_sample {
    atmega_instant at; /* tick at which the last conversion ended */
    uint16_t sum;
    uint8_t status;
} cell_sample;

static volatile cell_sample kept[SAMPLES_KEPT];
static volatile uint8_t head; /* only the interrupt changes it */
static volatile uint8_t tail;
static volatile uint16_t supply_sum;
static float supply_V;
static float parts_per_V;

/* Only the interrupts use these variables. `place` counts the conversions that have ended in this period. */
static uint8_t place;
static uint16_t sum;
static uint16_t supply;
static bool saturated;

void atmega_cell_start(void) {
    DIDR0 = _BV(ATMEGA_CELL_INPUT) | _BV(ATMEGA_SUPPLY_INPUT);
    ADMUX = REFERENCE | ATMEGA_CELL_INPUT;
    ADCSRA = CONVERTER;
    TCCR2A = _BV(WGM21); /* timer 2 counts up to OCR2A */
    OCR2A = TICK_TICKS / TIMER_COUNT_TICKS - 1U;
    OCR2B = OCR2A / 2U;
    TCNT2 = 0;
    TIFR2 = _BV(OCF2A);
    TIMSK2 = _BV(OCIE2A);
    TCCR2B = _BV(CS21) | _BV(CS20);
    place = CELL_TICKS; /* the conversion that ends at the first tick is not part of a sample */
}

static uint8_t status_now(void) {
    return (uint8_t)(sum < CELL_TICKS * OPEN_BELOW ? HAL_LOAD_DISCONNECTED
                     : saturated                   ? HAL_LOAD_SATURATED
                                                   : HAL_LOAD_OK);
}

/* Stores a sample. A separate interrupt for samples keeps TIMER2_COMPA short. */
ISR(TIMER2_COMPB_vect) {
    const uint16_t late = (uint16_t)(TCNT2 * (TIMER_COUNT_TICKS * ATMEGA_COUNTS_PER_TICK));
    const uint16_t count = (uint16_t)(TCNT4 - late);
    TIMSK2 = _BV(OCIE2A);
    if ((uint8_t)(head - tail) < SAMPLES_KEPT) {
        volatile cell_sample *to = &kept[head % SAMPLES_KEPT];
        const atmega_instant at = atmega_instant_of(count);
        to->at.count = at.count;
        to->at.wraps = at.wraps;
        to->sum = sum;
        to->status = status_now();
        head++;
    }
    sum = 0;
    saturated = false;
}

/* A tick: the conversion that started at the last tick has ended. */
ISR(TIMER2_COMPA_vect) {
    const uint16_t count = ADC;
    uint8_t next = (uint8_t)(place + 1U);
    if (next == ALL_TICKS) {
        next = 0;
    }
    place = next;
    ADMUX = next < CELL_TICKS ? REFERENCE | ATMEGA_CELL_INPUT : REFERENCE | ATMEGA_SUPPLY_INPUT;
    ADCSRA = CONVERTER | _BV(ADSC);
    if (next != 0 && next <= CELL_TICKS) {
        sum += count;
        if (count < RAIL || count > FULL - RAIL) {
            saturated = true;
        }
        if (next == CELL_TICKS) {
            TIFR2 = _BV(OCF2B);
            TIMSK2 = _BV(OCIE2A) | _BV(OCIE2B);
        }
    } else if (next == 0 || next > ALL_TICKS - SUPPLY_TICKS) {
        supply += count;
        if (count > SUPPLY_END) {
            supply |= SUPPLY_BEYOND;
        }
        if (next == 0) {
            supply_sum = supply;
            supply = 0;
        }
    }
}

static void renew_supply(void) {
    const uint8_t before = atmega_hold();
    const uint16_t counts = supply_sum;
    atmega_go_on(before);
    supply_V = (counts & SUPPLY_BEYOND) != 0
                   ? HAL_MOTOR_SUPPLY_BEYOND
                   : (float)counts * (SUPPLY_V_PER_COUNT / (float)SUPPLY_TICKS);
    parts_per_V = counts > 0 ? (float)ATMEGA_WHOLE / supply_V : 0.0f;
}

/* The sum is multiplied by 4, because it has 14 bits, and sample->raw has 16. */
bool hal_loadcell_take(hal_load_sample *sample) {
    if (tail == head) {
        return false;
    }
    const volatile cell_sample *from = &kept[tail % SAMPLES_KEPT];
    const atmega_instant at = {from->at.count, from->at.wraps};
    sample->ticks = atmega_ticks_of(at) - BEHIND_TICKS;
    sample->raw = ((int32_t)from->sum - (int32_t)(CELL_TICKS * MIDDLE)) * 4;
    sample->status = from->status;
    tail++;
    renew_supply();
    return true;
}

float hal_motor_supply_V(void) { return supply_V; }

float hal_motor_supply_most_V(void) { return (float)HAL_MOTOR_SUPPLY_MOST_mV / 1000.0f; }

float atmega_parts_per_V(void) { return parts_per_V; }
