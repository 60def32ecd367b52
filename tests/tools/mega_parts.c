/* mega_parts.c: parts of the ATmega2560. "DS 8.6" is a section of the data sheet (DS40002211A). */
#include "mega_parts.h"

#include <string.h>

#include <simavr/avr_timer.h>
#include <simavr/avr_watchdog.h>

#include "mega.h"

enum { REG_DDRB = 0x24, REG_TIFR4 = 0x39, REG_EECR = 0x3F, REG_EEAR = 0x41, REG_WDTCSR = 0x60 };
enum { TCCRA, TCCRB, TCCRC, ICR = 6, OCRA = 8 }; /* offsets from mega_timer_base */
#define COMA1 0x80U
#define FOCA 0x80U
#define OC1A_PIN 0x20U
#define TOV 0x01U
#define SET_EEPE 0x9AF9U /* sbi EECR, EEPE */
#define EEPE 0x02U
#define EEMPE 0x04U
#define EEPM 0x30U                  /* 0: erase and write at once */
#define EEPROM_CYCLES (18U * 1600U) /* erase or write: 1.8 ms; both: 3.4 ms (DS, table 8-1) */
#define EEPROM_BOTH_CYCLES (34U * 1600U)
#define WDR 0x95A8U
#define WDE 0x08U
#define WATCHDOG_CYCLES (UINT64_C(2048) * 125U) /* 2048 periods of 128 kHz: 16 ms (DS 12.5.2) */

static struct {
    uint64_t until; /* end of the EEPROM's write; 0: idle */
    uint64_t heard; /* cycle of the firmware's last kick of the watchdog */
    uint64_t kept;  /* cycle of the last kick of simavr's own watchdog, which must not bite */
    uint8_t settings;
    bool oc1a; /* the level of OC1A while it is disconnected */
    const char *wrong;
} parts;

const uint16_t mega_timer_base[MEGA_TIMERS] = {0x80, 0x90, 0xA0, 0x120};

void mega_parts_start(void) {
    parts.until = 0;
    parts.settings = 0;
    parts.oc1a = false;
    parts.wrong = NULL;
}

const char *mega_parts_wrong(void) { return parts.wrong; }

static uint16_t pair_at(const avr_t *avr, unsigned address) {
    return (uint16_t)(avr->data[address] | avr->data[address + 1U] << 8);
}

/* The mode: WGMn3:0. */
static unsigned mode_of(const avr_t *avr, unsigned base) {
    return (avr->data[base + TCCRA] & 3U) | (avr->data[base + TCCRB] >> 1 & 0xCU);
}

/* DS 17.9, table 17-2: ICRn is the TOP, and the CPU can write it (DS 17.6), in modes 8, 10, 12 and 14. */
static void look_at_timers(const avr_t *avr, mega_next *next) {
    for (unsigned i = 0; i < MEGA_TIMERS; i++) {
        next->captured[i] = pair_at(avr, mega_timer_base[i] + ICR);
        next->writable[i] = (mode_of(avr, mega_timer_base[i]) & 9U) == 8U;
    }
    next->timed = (avr->data[mega_timer_base[0] + TCCRA] & COMA1) != 0 &&
                  (avr->data[REG_DDRB] & OC1A_PIN) != 0;
}

/* Undoes the CPU's writes to ICRn in modes that forbid them. (No capture comes during an instruction.) */
static void keep_captured(avr_t *avr, const mega_next *before) {
    for (unsigned i = 0; i < MEGA_TIMERS; i++) {
        if (!before->writable[i]) {
            avr->data[mega_timer_base[i] + ICR] = (uint8_t)before->captured[i];
            avr->data[mega_timer_base[i] + ICR + 1U] = (uint8_t)(before->captured[i] >> 8);
        }
    }
}

/* A disconnected OC1A keeps its level, even if the mode changes (DS 17.8), and must be low when it is connected
 * again. The strobe FOC1A sets the level in modes without PWM only. */
static void keep_output(avr_t *avr, const mega_next *before) {
    const unsigned base = mega_timer_base[0];
    const unsigned mode = mode_of(avr, base);
    mega_next now;
    look_at_timers(avr, &now);
    if (before->timed && !now.timed) {
        const unsigned top = before->captured[0];
        const unsigned part = top > 0 ? (unsigned)(avr->cycle % (2U * top)) : 0U;
        parts.oc1a = (part < top ? part : 2U * top - part) < pair_at(avr, base + OCRA);
    }
    if ((avr->data[base + TCCRC] & FOCA) != 0) {
        avr->data[base + TCCRC] = 0;
        if (mode == 0 || mode == 4 || mode == 12) {
            parts.oc1a = (avr->data[base + TCCRA] & 0xC0U) == 0xC0U;
        }
    }
    if (!before->timed && now.timed && parts.oc1a) {
        parts.wrong = "OC1A is connected to its pin while it is high";
    }
}

/* Pending overflows (bits 0 and 1: timers 4 and 5), except those that `out TIFR4, Rr` or `out TIFR5, Rr` clears. */
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

/* If a flag of a timer is written, simavr clears all flags, the chip only the written flag (DS 17.11.37). Restores
 * overflows that simavr has lost. On the chip, too, an overflow's interrupt clears it. */
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
    mega_next next = {.hears = word == WDR,
                      .writes = word == SET_EEPE && (avr->data[REG_EECR] & EEMPE) != 0,
                      .overflows = overflows_now(avr, word),
                      .address = pair_at(avr, REG_EEAR)};
    look_at_timers(avr, &next);
    return next;
}

/* In simavr a byte is written at once. A chip takes some time, and EEPE is set meanwhile. */
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

/* Returns true if the watchdog bites. simavr's own watchdog would keep the old time after a change of settings. */
bool mega_parts_bite(avr_t *avr, const mega_next *done) {
    keep_captured(avr, done);
    keep_output(avr, done);
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
