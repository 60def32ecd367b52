/* mega_parts.h: parts of the ATmega2560 that simavr has otherwise: an EEPROM that takes its time, a watchdog that takes another time
 * at once, flags of timers 4 and 5 that go one by one. */
#ifndef TESTS_TOOLS_MEGA_PARTS_H
#define TESTS_TOOLS_MEGA_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include <simavr/sim_avr.h>

/* What the next instruction does. */
typedef struct mega_next {
    bool hears;       /* it is `wdr` */
    bool writes;      /* it begins to write a byte of the EEPROM, or to erase one: */
    unsigned address; /* of it */
    uint8_t
        overflows; /* a bit for timer 4, one for 5: its overflow waits, and the instruction has nothing to do with it */
} mega_next;

/* Out of a reset. */
void mega_parts_start(void);

/* Before an instruction, and behind it. True: the watchdog bites. */
mega_next mega_parts_next(const avr_t *avr);
bool mega_parts_bite(avr_t *avr, const mega_next *done);

#endif
