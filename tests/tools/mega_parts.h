/* mega_parts.h: parts of the ATmega2560 that differ from simavr's: an EEPROM that takes its time, a watchdog that takes a new time
 * at once, flags of timers 4 and 5 that clear one by one, an input capture register that the CPU can write in some modes only, and
 * an output OC1A that keeps its level while it is disconnected. */
#ifndef TESTS_TOOLS_MEGA_PARTS_H
#define TESTS_TOOLS_MEGA_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include <simavr/sim_avr.h>

#define MEGA_TIMERS 4U                              /* of 16 bits: 1, 3, 4, 5 */
extern const uint16_t mega_timer_base[MEGA_TIMERS]; /* the address of TCCRnA */

/* What the next instruction does. */
typedef struct mega_next {
    uint16_t captured[MEGA_TIMERS]; /* ICRn, */
    bool writable[MEGA_TIMERS];     /* and whether the CPU can write it */
    bool timed;                     /* OC1A is connected to its pin, an output */
    bool hears;                     /* it is `wdr` */
    bool writes;                    /* it begins to write a byte of the EEPROM, or to erase one: */
    unsigned address;               /* of it */
    uint8_t
        overflows; /* a bit for timer 4, one for 5: its overflow waits, and the instruction has nothing to do with it */
} mega_next;

/* Out of a reset. */
void mega_parts_start(void);

/* What the firmware did against the data sheet; NULL: nothing. */
const char *mega_parts_wrong(void);

/* Before an instruction, and behind it. True: the watchdog bites. */
mega_next mega_parts_next(const avr_t *avr);
bool mega_parts_bite(avr_t *avr, const mega_next *done);

#endif
