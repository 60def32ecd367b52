/* time_base.c: a time of 32 bits in microseconds, from timers 4 and 5, which count at 2 MHz. The two timers start
 * together (DS 18.2), so the captures of the two timers have one time base. */
#include "boards/board.h"

#include "atmega.h"

const uint32_t board_ticks_per_s = 1000000U;
_Static_assert(F_CPU / 8U == ATMEGA_COUNTS_PER_TICK * 1000000U, "the prescaler's eighth");

#define TICKS_PER_WRAP (0x10000U / ATMEGA_COUNTS_PER_TICK)

static volatile uint32_t base_ticks; /* time at which the count last wrapped */
volatile uint8_t atmega_wraps;

ISR(TIMER4_OVF_vect) {
    base_ticks += TICKS_PER_WRAP;
    atmega_wraps++;
}

/* Both timers count at F_CPU/8 and capture rising edges. */
void atmega_time_base_start(void) {
    GTCCR = _BV(TSM) | _BV(PSRSYNC);
    TCCR4A = 0;
    TCCR5A = 0;
    TCCR4B = _BV(ICNC4) | _BV(ICES4) | _BV(CS41);
    TCCR5B = _BV(ICNC5) | _BV(ICES5) | _BV(CS51);
    TCNT4 = 0;
    TCNT5 = 0;
    TIFR4 = _BV(TOV4);
    TIMSK4 = _BV(TOIE4);
    GTCCR = 0;
}

uint32_t atmega_ticks(void) {
    const uint16_t now = TCNT4;
    uint32_t base = base_ticks;
    /* true if TIMER4_OVF has not counted the last wrap yet */
    if ((TIFR4 & _BV(TOV4)) != 0 && now < 0x8000U) {
        base += TICKS_PER_WRAP;
    }
    return base + now / ATMEGA_COUNTS_PER_TICK;
}

uint32_t board_ticks(void) {
    const uint8_t before = atmega_hold();
    const uint32_t ticks = atmega_ticks();
    atmega_go_on(before);
    return ticks;
}

/* The difference of the wrap counts, modulo 256, is the number of wraps since `at`. */
uint32_t atmega_ticks_of(atmega_instant at) {
    const uint8_t before = atmega_hold();
    const uint32_t base = base_ticks;
    const uint8_t wraps = atmega_wraps;
    atmega_go_on(before);
    const int8_t ago = (int8_t)(wraps - at.wraps); /* may be -1: at.wraps can be ahead by one */
    return base - (uint32_t)((int32_t)ago * (int32_t)TICKS_PER_WRAP) +
           at.count / ATMEGA_COUNTS_PER_TICK;
}
