/* mega_parts.h: parts of the ATmega2560 that simavr models differently. A write to the EEPROM takes time. A change of
 * the watchdog's time acts at once. A write to the flags of timer 4 or 5 clears only the written flags. The CPU can
 * write an input capture register in some modes only. OC1A keeps its level while disconnected. */
#ifndef TESTS_TOOLS_MEGA_PARTS_H
#define TESTS_TOOLS_MEGA_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include <simavr/sim_avr.h>

#define MEGA_TIMERS 4U                              /* timers 1, 3, 4, 5: 16 bits */
extern const uint16_t mega_timer_base[MEGA_TIMERS]; /* the address of TCCRnA */

typedef struct mega_next {
    uint16_t captured[MEGA_TIMERS]; /* ICRn */
    bool writable[MEGA_TIMERS];     /* the CPU can write ICRn */
    bool timed;                     /* OC1A is connected to its pin, an output */
    bool hears;                     /* the instruction is `wdr` */
    bool writes;                    /* the instruction begins to write or erase an EEPROM byte */
    unsigned address;               /* that byte's address */
    uint8_t overflows;              /* overflows that stay pending; bits 0 and 1: timers 4 and 5 */
} mega_next;

/* To be called after a reset. */
void mega_parts_start(void);

/* The firmware's violation of the data sheet; NULL: none. */
const char *mega_parts_wrong(void);

/* To be called before and after each instruction. mega_parts_bite() returns true if the watchdog bites. */
mega_next mega_parts_next(const avr_t *avr);
bool mega_parts_bite(avr_t *avr, const mega_next *done);

#endif
