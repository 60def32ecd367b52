/* slots.c: the slot sensors on the input captures of timers 4 and 5. Each timer stores the time of an edge in hardware
 * (DS 17.6): a rising edge, then a falling edge, and so on. The noise canceller requires four equal samples, 0.25 us.
 *
 * If a pulse ends before the interrupt has read the pulse's first edge, the second edge is lost. Overruns count the
 * edges that found kept[] full, and the pulses whose first edge was lost. */
#include "hal/slots.h"

#include "atmega.h"

#define EDGES_KEPT 16U /* a power of two */

typedef struct kept_edge {
    atmega_instant at;
    uint8_t of; /* bit 0: the sensor; from bit 1 on: a hal_slot_end */
} kept_edge;

static volatile kept_edge kept[EDGES_KEPT];
static volatile uint8_t head; /* only interrupts change it */
static volatile uint8_t tail;
static volatile uint32_t overruns;
static volatile bool stopped;

static void listen(void) {
    TCCR4B |= _BV(ICES4);
    TCCR5B |= _BV(ICES5);
    TIFR4 = _BV(ICF4); /* edges that remain from a storm may be of any age: drop them */
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

/* Stores an edge. If the memory is full, interrupts stay off until the program takes an edge. */
static void keep(uint8_t of, uint16_t count) {
    if ((uint8_t)(head - tail) == EDGES_KEPT) {
        overruns++;
        stopped = true;
        TIMSK4 &= (uint8_t)~_BV(ICIE4);
        TIMSK5 &= (uint8_t)~_BV(ICIE5);
        return;
    }
    volatile kept_edge *to = &kept[head % EDGES_KEPT];
    const atmega_instant at = atmega_instant_of(count);
    to->at.count = at.count;
    to->at.wraps = at.wraps;
    to->of = of;
    head++;
}

/* True if the edge that the timer waits for has passed without a capture. */
static inline bool waits_in_vain(uint8_t sensor, const volatile uint8_t *control,
                                 const volatile uint8_t *flags) {
    const bool high = (PINL & _BV(sensor)) != 0;
    return high == ((*control & _BV(ICES4)) != 0) && (*flags & _BV(ICF4)) == 0;
}

/* Makes the timer capture the opposite edge. This may set the capture flag (DS 17.6.3), so the flag is cleared. */
static inline void wait_for_other(volatile uint8_t *control, volatile uint8_t *flags) {
    *control ^= _BV(ICES4);
    *flags = _BV(ICF4);
}

/* Returns the captured edge, coded like kept_edge.of. Makes the timer wait for the first edge that has not passed. */
static inline uint8_t turn(uint8_t sensor, volatile uint8_t *control, volatile uint8_t *flags) {
    const bool rose = (*control & _BV(ICES4)) != 0;
    wait_for_other(control, flags);
    for (uint8_t looks = 0; looks < 3U && waits_in_vain(sensor, control, flags); looks++) {
        overruns += (*control & _BV(ICES4)) != 0 ? 1U : 0U; /* the begin of a pulse was lost */
        wait_for_other(control, flags);
    }
    return (uint8_t)(sensor | (rose ? HAL_SLOT_LEADING : HAL_SLOT_TRAILING) << 1);
}
_Static_assert(ICES4 == ICES5 && ICF4 == ICF5 && PL0 == 0 && PL1 == 1, "one turn() for both");

/* Stores the captured edges in the order of their times. */
static void fetch(bool first, bool second) {
    const uint16_t first_count = ICR4;
    const uint16_t second_count = ICR5;
    const uint8_t first_of = first ? turn(0, &TCCR4B, &TIFR4) : 0U;
    const uint8_t second_of = second ? turn(1, &TCCR5B, &TIFR5) : 0U;
    const bool turned = first && second && (int16_t)(second_count - first_count) < 0;
    if (turned) {
        keep(second_of, second_count);
    }
    if (first) {
        keep(first_of, first_count);
    }
    if (second && !turned) {
        keep(second_of, second_count);
    }
}

ISR(TIMER4_CAPT_vect) { fetch(true, (TIFR5 & _BV(ICF5)) != 0); }

ISR(TIMER5_CAPT_vect) { fetch((TIFR4 & _BV(ICF4)) != 0, true); }

/* If a pin is low, makes its timer capture the next rising edge. */
static void go_on_waiting(void) {
    if ((TCCR4B & TCCR5B & _BV(ICES4)) != 0) {
        return;
    }
    const uint8_t before = atmega_hold();
    if ((TCCR4B & _BV(ICES4)) == 0 && waits_in_vain(0, &TCCR4B, &TIFR4)) {
        wait_for_other(&TCCR4B, &TIFR4);
    }
    if ((TCCR5B & _BV(ICES5)) == 0 && waits_in_vain(1, &TCCR5B, &TIFR5)) {
        wait_for_other(&TCCR5B, &TIFR5);
    }
    atmega_go_on(before);
}

bool hal_slots_take(hal_slot_edge *edge) {
    if (head == tail) {
        go_on_waiting();
        return false;
    }
    const volatile kept_edge *from = &kept[tail % EDGES_KEPT];
    const atmega_instant at = {from->at.count, from->at.wraps};
    edge->ticks = atmega_ticks_of(at);
    edge->sensor = from->of & 1U;
    edge->end = from->of >> 1;
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
