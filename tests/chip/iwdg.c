/* iwdg.c: the independent watchdog of the chip model. RM0090, chapter 21; DS8626, table 35 (oscillator: 17 to 47 kHz). */
#include <string.h>

#include "tests/chip/inner.h"

enum { KR = 0x00, PR = 0x04, RLR = 0x08, SR = 0x0C };
#define PVU BIT(0)
#define RVU BIT(1)

static struct {
    uint32_t pr, rlr;           /* registers as the program wrote them */
    uint32_t pr_used, rlr_used; /* values in use, after the update */
    uint64_t pr_at, rlr_at;
    uint64_t bites_at;
    uint64_t held_at; /* time at which a debugger stopped the watchdog */
    bool open, runs;
} w;

static uint64_t period_units(void) { return CHIP_UNITS_PER_S / world.watchdog_Hz; }
static uint64_t count_units(void) {
    return period_units() * (UINT64_C(4) << (w.pr_used < 6 ? w.pr_used : 6U));
}

/* The prescaler runs freely, so the first count may take almost no time. */
static void reload(void) {
    w.bites_at = now_units() + w.rlr_used * count_units() + drawn() % (count_units() + 1U);
}

void iwdg_holds(void) { w.held_at = now_units(); }
void iwdg_goes_on(void) {
    if (debug_stops(0x08, 12) && w.bites_at != CHIP_NEVER) {
        w.bites_at += now_units() - w.held_at;
    }
}

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }
static uint64_t iwdg_next(void) {
    const bool stopped = debug_stops(0x08, 12);
    return least(least(w.pr_at, w.rlr_at), w.runs && !stopped ? w.bites_at : CHIP_NEVER);
}

static void iwdg_happens(void) {
    if (w.pr_at <= now_units()) {
        const uint64_t before = count_units();
        const uint64_t left = w.bites_at > now_units() ? (w.bites_at - now_units()) / before : 0;
        w.pr_used = w.pr;
        w.pr_at = CHIP_NEVER;
        if (w.runs) {
            w.bites_at = now_units() + left * count_units();
        }
    } else if (w.rlr_at <= now_units()) {
        w.rlr_used = w.rlr;
        w.rlr_at = CHIP_NEVER;
    } else {
        core_resets(CHIP_BY_WATCHDOG);
    }
}

static uint32_t iwdg_load(uint32_t offset) {
    switch (offset) {
    case PR: forbid_if(w.pr_at != CHIP_NEVER, "IWDG_PR is read while it is updated"); return w.pr;
    case RLR:
        forbid_if(w.rlr_at != CHIP_NEVER, "IWDG_RLR is read while it is updated");
        return w.rlr;
    case SR: return (w.pr_at != CHIP_NEVER ? PVU : 0) | (w.rlr_at != CHIP_NEVER ? RVU : 0);
    default: forbidden("load of IWDG + 0x%02x", offset); return 0;
    }
}

/* Returns the time at which an update ends: after "up to five periods" of the oscillator, which must run. */
static uint64_t update_ends(void) {
    return w.runs || lsi_is_on() ? now_units() + period_units() * (1U + drawn() % 5U)
                                 : CHIP_NEVER - 1U;
}

static void iwdg_store(uint32_t offset, uint32_t value) {
    switch (offset) {
    case KR:
        w.open = value == 0x5555U;
        if (value == 0xAAAAU) {
            reload();
        } else if (value == 0xCCCCU) {
            if (!w.runs) {
                w.runs = true;
                lsi_forced();
                reload();
                if (w.pr_at == CHIP_NEVER - 1U) {
                    w.pr_at = update_ends();
                }
                if (w.rlr_at == CHIP_NEVER - 1U) {
                    w.rlr_at = update_ends();
                }
            }
        } else if (value != 0x5555U) {
            forbidden("0x%04x is no key of the watchdog", value);
        }
        break;
    case PR:
    case RLR: {
        uint64_t *at = offset == PR ? &w.pr_at : &w.rlr_at;
        if (!w.open) {
            forbidden("a watchdog's register without its key");
        } else if (*at != CHIP_NEVER) {
            forbidden("a watchdog's register while it is updated");
        } else {
            *(offset == PR ? &w.pr : &w.rlr) = value & (offset == PR ? 7U : 0xFFFU);
            *at = update_ends();
        }
        break;
    }
    default: forbidden("store of IWDG + 0x%02x", offset); break;
    }
}

void iwdg_new(void) {
    memset(&w, 0, sizeof w);
    w.rlr = w.rlr_used = 0xFFFU;
    w.pr_at = w.rlr_at = w.bites_at = CHIP_NEVER;
}

const part iwdg_part = {.name = "IWDG",
                        .base = AT_IWDG,
                        .bytes = 0x10,
                        .load = iwdg_load,
                        .store = iwdg_store,
                        .reset = iwdg_new,
                        .next = iwdg_next,
                        .happens = iwdg_happens};
