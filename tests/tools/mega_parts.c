/* mega_parts.c: places in the data sheet (DS40002211A) as "DS 8.6". */
#include "mega_parts.h"

#include <string.h>

#include <simavr/avr_timer.h>
#include <simavr/avr_watchdog.h>

#include "mega.h"

enum { REG_TIFR4 = 0x39, REG_EECR = 0x3F, REG_EEAR = 0x41, REG_WDTCSR = 0x60 };
#define TOV 0x01U
#define SET_EEPE 0x9AF9U /* sbi EECR, EEPE */
#define EEPE 0x02U
#define EEMPE 0x04U
#define EEPM 0x30U                  /* 0: erase and write in one go */
#define EEPROM_CYCLES (18U * 1600U) /* 1.8 ms; 3.4 in one go (DS 8.6.3, table 8-1) */
#define EEPROM_BOTH_CYCLES (34U * 1600U)
#define WDR 0x95A8U
#define WDE 0x08U
#define WATCHDOG_CYCLES (UINT64_C(2048) * 125U) /* 2048 of 128 kHz (DS 12.5.2) */

static struct {
    uint64_t until; /* the EEPROM writes; 0: it rests */
    uint64_t heard; /* the watchdog, */
    uint64_t kept;  /* and simavr's own, from biting */
    uint8_t settings;
} parts;

void mega_parts_start(void) {
    parts.until = 0;
    parts.settings = 0;
}

/* Of timers 4 and 5 whose overflow waits, but for one that `out TIFR4, Rr` or `out TIFR5, Rr` is to clear. */
static uint8_t overflows_now(const avr_t *avr, unsigned word) {
    const unsigned to = 0x20U + ((word >> 5 & 0x30U) | (word & 0xFU));
    const bool out = (word & 0xF800U) == 0xB800U && (avr->data[word >> 4 & 0x1FU] & TOV) != 0;
    uint8_t waits = 0;
    for (unsigned i = 0; i < 2; i++) {
        const bool cleared = out && to == REG_TIFR4 + i;
        waits |= (avr->data[REG_TIFR4 + i] & TOV) != 0 && !cleared ? (uint8_t)(1U << i) : 0U;
    }
    return waits;
}

/* simavr clears all flags of a timer where one is written (DS 17.11.37: that one); an overflow goes by its own interrupt. */
static void keep_overflows(avr_t *avr, uint8_t overflows) {
    for (avr_io_t *io = avr->io_port; io != NULL && overflows != 0; io = io->next) {
        avr_timer_t *timer = (avr_timer_t *)io;
        const bool is =
            strcmp(io->kind, "timer") == 0 && (timer->name == '4' || timer->name == '5');
        if (is && (overflows & 1U << (timer->name - '4')) != 0 &&
            (avr->data[REG_TIFR4 + timer->name - '4'] & TOV) == 0 &&
            avr->pc != timer->overflow.vector * avr->vector_size) {
            avr_raise_interrupt(avr, &timer->overflow);
        }
    }
}

mega_next mega_parts_next(const avr_t *avr) {
    const unsigned word = avr->flash[avr->pc] | (unsigned)avr->flash[avr->pc + 1U] << 8;
    return (mega_next){.hears = word == WDR,
                       .writes = word == SET_EEPE && (avr->data[REG_EECR] & EEMPE) != 0,
                       .overflows = overflows_now(avr, word),
                       .address = avr->data[REG_EEAR] | (unsigned)avr->data[REG_EEAR + 1] << 8};
}

/* simavr writes a byte at once. On the chip it takes its time, and EEPE says so. */
static void keep_eeprom_busy(avr_t *avr, bool writes) {
    if (writes) {
        const bool both = (avr->data[REG_EECR] & EEPM) == 0;
        parts.until = avr->cycle + (both ? EEPROM_BOTH_CYCLES : EEPROM_CYCLES);
    }
    if (parts.until > avr->cycle) {
        avr->data[REG_EECR] |= EEPE;
    } else if (parts.until != 0) {
        parts.until = 0;
        avr->data[REG_EECR] &= (uint8_t)~EEPE;
    }
}

/* Behind the last `wdr` or change of its settings; simavr's own goes on with the time that it had before a change. */
bool mega_parts_bite(avr_t *avr, const mega_next *done) {
    keep_eeprom_busy(avr, done->writes);
    keep_overflows(avr, done->overflows);
    const uint8_t settings = avr->data[REG_WDTCSR];
    if (done->hears || settings != parts.settings) {
        parts.settings = settings;
        parts.heard = avr->cycle;
    }
    if (avr->cycle - parts.kept > MEGA_HZ / 1000U) {
        parts.kept = avr->cycle;
        avr_ioctl(avr, AVR_IOCTL_WATCHDOG_RESET, NULL);
    }
    const unsigned twice = (settings & 7U) | (settings >> 2 & 8U);
    return (settings & WDE) != 0 && avr->cycle - parts.heard > WATCHDOG_CYCLES << twice;
}
