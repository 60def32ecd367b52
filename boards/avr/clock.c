/* clock.c: the board's clock on the AVR's 16-bit timer, with an interrupt that counts overflows. Programs that do not
 * call board_ticks() have no interrupts, so their steps always take the same number of cycles. */
#include "boards/board.h"

#include <avr/interrupt.h>
#include <avr/io.h>

const uint32_t board_ticks_per_s = F_CPU / 64U;

static volatile uint16_t overflows;

ISR(TIMER1_OVF_vect) { overflows++; }

/* The first call starts the timer. */
uint32_t board_ticks(void) {
    if (TCCR1B == 0) {
        TCCR1B = _BV(CS11) | _BV(CS10); /* one count every 64 clocks */
        TIMSK1 = _BV(TOIE1);
    }
    const uint8_t before = SREG;
    cli();
    uint16_t low = TCNT1;
    uint16_t high = overflows;
    if ((TIFR1 & _BV(TOV1)) != 0) { /* the wrap is not counted yet */
        low = TCNT1;
        high++;
    }
    SREG = before;
    sei();
    return (uint32_t)high << 16 | low;
}
