/* slots.c: the slot sensors on the input captures of timers 4 and 5, which take the time of an edge by themselves (DS 17.6),
 * after four samples alike of their noise canceller, 0.25 us. The interrupt only carries the stamps away.
 *
 * The chip does not tell that a capture was overwritten before it was read: edges of one sensor within an interrupt's latency
 * are one, the later. Overruns count what found no room. */
#include "hal/slots.h"

#include "atmega.h"

#define PULSES_KEPT 8U /* a power of two */

typedef struct kept_pulse {
    atmega_instant at;
    uint8_t sensor;
} kept_pulse;

static volatile kept_pulse kept[PULSES_KEPT];
static volatile uint8_t head; /* the interrupts' */
static volatile uint8_t tail;
static volatile uint32_t overruns;
static volatile bool stopped;

static void listen(void) {
    TIFR4 = _BV(ICF4); /* what a storm has left may be of any age: forgotten */
    TIFR5 = _BV(ICF5);
    TIMSK4 |= _BV(ICIE4);
    TIMSK5 |= _BV(ICIE5);
    stopped = false;
}

void atmega_slots_start(void) {
    DDRL &= (uint8_t) ~(_BV(PL0) | _BV(PL1));
    PORTL &= (uint8_t) ~(_BV(PL0) | _BV(PL1));
    const uint8_t before = atmega_hold();
    head = tail = 0;
    listen();
    atmega_go_on(before);
}

/* Full: no more interrupts until one is taken. */
static void keep(uint8_t sensor, uint16_t count) {
    if ((uint8_t)(head - tail) == PULSES_KEPT) {
        overruns++;
        stopped = true;
        TIMSK4 &= (uint8_t)~_BV(ICIE4);
        TIMSK5 &= (uint8_t)~_BV(ICIE5);
        return;
    }
    volatile kept_pulse *to = &kept[head % PULSES_KEPT];
    const atmega_instant at = atmega_instant_of(count);
    to->at.count = at.count;
    to->at.wraps = at.wraps;
    to->sensor = sensor;
    head++;
}

/* Of two that came in one go the earlier first. */
static void fetch(bool first, bool second) {
    const uint16_t first_count = ICR4;
    const uint16_t second_count = ICR5;
    const bool turned = first && second && (int16_t)(second_count - first_count) < 0;
    if (turned) {
        keep(1, second_count);
    }
    if (first) {
        keep(0, first_count);
    }
    if (second && !turned) {
        keep(1, second_count);
    }
}

ISR(TIMER4_CAPT_vect) {
    const bool other = (TIFR5 & _BV(ICF5)) != 0;
    if (other) {
        TIFR5 = _BV(ICF5);
    }
    fetch(true, other);
}

ISR(TIMER5_CAPT_vect) {
    const bool other = (TIFR4 & _BV(ICF4)) != 0;
    if (other) {
        TIFR4 = _BV(ICF4);
    }
    fetch(other, true);
}

bool hal_slots_take(hal_slot_pulse *pulse) {
    if (head == tail) {
        return false;
    }
    const volatile kept_pulse *from = &kept[tail % PULSES_KEPT];
    const atmega_instant at = {from->at.count, from->at.wraps};
    pulse->ticks = atmega_ticks_of(at);
    pulse->sensor = from->sensor;
    const uint8_t before = atmega_hold();
    tail++;
    if (stopped) {
        listen();
    }
    atmega_go_on(before);
    return true;
}

uint32_t hal_slots_overruns(void) {
    const uint8_t before = atmega_hold();
    const uint32_t count = overruns;
    atmega_go_on(before);
    return count;
}
