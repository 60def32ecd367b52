/* timers.c: TIM2 and TIM3 of the chip model: counting, filtered captures, updates as triggers. RM0090, chapter 18. */
#include <string.h>

#include "tests/chip/inner.h"

enum {
    CR1 = 0x00,
    CR2 = 0x04,
    SMCR = 0x08,
    DIER = 0x0C,
    SR = 0x10,
    EGR = 0x14,
    CCMR1 = 0x18,
    CCMR2 = 0x1C,
    CCER = 0x20,
    CNT = 0x24,
    PSC = 0x28,
    ARR = 0x2C,
    CCR1 = 0x34,
    OR = 0x50
};
#define CEN BIT(0)
#define UDIS BIT(1)
#define URS BIT(2)
#define UIF BIT(0)
#define FLAGS 0x1E5FU
#define TIM3_TRGO 8U /* the ADC's number of this trigger (EXTSEL, table 69) */

typedef struct timer {
    uint32_t r[21];
    uint32_t psc, arr; /* values in use */
    uint64_t count, base;
    uint64_t most; /* largest count */
    unsigned interrupt;
    unsigned debug_bit; /* bit of DBGMCU_APB1_FZ that stops this timer */
    unsigned trigger;   /* the ADC's number of this timer's update */
    struct {
        bool level, filtered;
        uint64_t accepted_at; /* time at which the filter passes the new level */
    } input[4];
} timer;

static timer tim2 = {.most = UINT32_MAX, .interrupt = 28, .debug_bit = 0, .trigger = 6};
static timer tim3 = {.most = 0xFFFF, .interrupt = 29, .debug_bit = 1, .trigger = TIM3_TRGO};

static uint32_t *reg(timer *t, uint32_t offset) { return &t->r[offset / 4U]; }

static uint64_t tick_units(const timer *t) {
    return units_of(apb1_timer_Hz()) * ((uint64_t)t->psc + 1U);
}
static bool counts(timer *t) {
    return (*reg(t, CR1) & CEN) != 0 && t->arr > 0 && apb1_timer_Hz() > 0 &&
           !debug_stops(0x08, t->debug_bit);
}
static uint64_t count_now(timer *t) {
    return counts(t) ? t->count + (now_units() - t->base) / tick_units(t) : t->count;
}
/* Stores the count. If the clock does not change, the elapsed fraction of a tick is kept. */
static void hold(timer *t, bool clock_changes) {
    const uint64_t count = count_now(t);
    t->base =
        counts(t) && !clock_changes ? t->base + (count - t->count) * tick_units(t) : now_units();
    t->count = count;
}
void timers_hold_counts(void) {
    hold(&tim2, true);
    hold(&tim3, true);
}
void timers_go_on(void) {}

static void update_event(timer *t) {
    t->psc = *reg(t, PSC);
    t->arr = *reg(t, ARR);
    if (FIELD(*reg(t, CR2), 4, 3) == 2) {
        adc_trigger(t->trigger);
    }
}

static uint64_t overflow_at(timer *t) {
    return counts(t)
               ? t->base + ((uint64_t)t->arr + 1U - (t->count <= t->arr ? t->count : t->arr)) *
                               tick_units(t)
               : CHIP_NEVER;
}

static uint64_t next_of(timer *t) {
    uint64_t next = overflow_at(t);
    for (unsigned i = 0; i < 4; i++) {
        next = t->input[i].accepted_at < next ? t->input[i].accepted_at : next;
    }
    return next;
}

static uint32_t mode_of(timer *t, unsigned i) {
    return *reg(t, i < 2 ? CCMR1 : CCMR2) >> (8U * (i % 2U)) & 0xFFU;
}

/* Captures in channel i, if CCxS selects this input: the channel's own (1) or that of its pair (2). Sets CCRx and
 * CCxIF, or also CCxOF if CCxIF is still set (18.3.5). The filter belongs to the input, the edge to the channel
 * (figures of 18.3.4). */
static void capture(timer *t, unsigned input, unsigned i) {
    const uint32_t cc = *reg(t, CCER) >> (4U * i) & 0xFU;
    const uint32_t mode = mode_of(t, i);
    const bool rising = t->input[input].filtered;
    const bool wanted = (cc & 0xAU) == 0xAU || ((cc & 2U) != 0) != rising;
    if ((cc & 1U) == 0 || (mode & 3U) != (i == input ? 1U : 2U) || !wanted) {
        return;
    }
    forbid_if((mode & 0xCU) != 0, "a capture of some edges only");
    *reg(t, CCR1 + 4U * i) = (uint32_t)(count_now(t) % ((uint64_t)t->arr + 1U));
    if ((*reg(t, SR) & BIT(1U + i)) != 0) {
        *reg(t, SR) |= BIT(9U + i);
    }
    *reg(t, SR) |= BIT(1U + i);
}

/* Computes from IC1F the number of samples that must agree, and their distance in units of time (18.4.7). */
static void filter(timer *t, unsigned i, unsigned *samples, uint64_t *apart) {
    static const uint8_t many[16] = {0, 2, 4, 8, 6, 8, 6, 8, 6, 8, 5, 6, 8, 5, 6, 8};
    static const uint8_t divided[16] = {1, 1, 1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 16, 32, 32, 32};
    const uint32_t f = mode_of(t, i) >> 4;
    const uint32_t dts = f < 4 ? 0 : FIELD(*reg(t, CR1), 8, 2);
    *samples = many[f];
    *apart = units_of(apb1_timer_Hz()) * divided[f] << dts;
}

void tim2_input(unsigned channel, bool high) {
    timer *t = &tim2;
    const unsigned i = channel - 1U;
    if (t->input[i].level == high) {
        return;
    }
    t->input[i].level = high;
    if (high == t->input[i].filtered) {
        t->input[i].accepted_at = CHIP_NEVER; /* the level has changed back */
        return;
    }
    unsigned samples = 0;
    uint64_t apart = 0;
    filter(t, i, &samples, &apart);
    if (samples == 0) {
        t->input[i].accepted_at = now_units() + 3U * apart; /* no filter, only the synchronizer */
    } else {
        const uint64_t first = (now_units() / apart + 1U) * apart;
        t->input[i].accepted_at = first + (samples - 1U) * apart;
    }
}

static void happens_to(timer *t) {
    for (unsigned i = 0; i < 4; i++) {
        if (t->input[i].accepted_at <= now_units()) {
            t->input[i].accepted_at = CHIP_NEVER;
            t->input[i].filtered = t->input[i].level;
            capture(t, i, i);
            capture(t, i, i ^ 1U);
        }
    }
    if (overflow_at(t) <= now_units()) {
        t->count = 0;
        t->base = now_units();
        if ((*reg(t, CR1) & UDIS) == 0) {
            *reg(t, SR) |= UIF;
            update_event(t);
        }
    }
}

static uint32_t load_of(timer *t, uint32_t offset) {
    if (offset == CNT) {
        return (uint32_t)(count_now(t) % ((uint64_t)t->arr + 1U));
    }
    if (offset >= CCR1 && offset <= CCR1 + 12U) {
        const unsigned i = (offset - CCR1) / 4U;
        if ((mode_of(t, i) & 3U) != 0) {
            *reg(t, SR) &= ~BIT(1U + i); /* reading clears CCxIF, but not CCxOF */
        }
    }
    return offset == EGR ? 0 : *reg(t, offset);
}

static void store_of(timer *t, uint32_t offset, uint32_t value) {
    hold(t, false);
    switch (offset) {
    case CR1:
        forbid_if((value & 0x78U) != 0, "a timer that does not count up for ever");
        *reg(t, CR1) = value;
        break;
    case SR: *reg(t, SR) &= value; break; /* type rc_w0 */
    case EGR:
        if ((value & 1U) != 0) {
            t->count = 0;
            t->base = now_units();
            if ((*reg(t, CR1) & UDIS) == 0) {
                *reg(t, SR) |= (*reg(t, CR1) & URS) != 0 ? 0 : UIF;
                update_event(t);
            }
        }
        break;
    case CNT:
        t->count = value & t->most;
        t->base = now_units();
        break;
    case ARR:
        *reg(t, ARR) = value & (uint32_t)t->most;
        if ((*reg(t, CR1) & BIT(7)) == 0) {
            t->arr = *reg(t, ARR);
        }
        break;
    case PSC: *reg(t, PSC) = value & 0xFFFFU; break;
    case CCMR1:
    case CCMR2:
        for (unsigned i = 0; i < 2; i++) {
            const unsigned channel = i + (offset == CCMR2 ? 2U : 0U);
            const uint32_t other = (value ^ *reg(t, offset)) >> (8U * i) & 3U;
            forbid_if(other != 0 && (*reg(t, CCER) >> (4U * channel) & 1U) != 0,
                      "CC%uS while the channel is on", channel + 1U);
        }
        *reg(t, offset) = value;
        break;
    case CR2:
    case DIER:
    case CCER: *reg(t, offset) = value; break;
    default: forbidden("store of a timer + 0x%02x", offset); break;
    }
}

static void reset_of(timer *t) {
    memset(t->r, 0, sizeof t->r);
    t->psc = 0;
    t->arr = (uint32_t)t->most;
    *reg(t, ARR) = t->arr;
    t->count = 0;
    t->base = now_units();
    for (unsigned i = 0; i < 4; i++) {
        t->input[i].filtered = t->input[i].level = false;
        t->input[i].accepted_at = CHIP_NEVER;
    }
}

static bool pending_of(timer *t, unsigned interrupt) {
    return interrupt == t->interrupt && (*reg(t, SR) & *reg(t, DIER) & 0x5FU) != 0;
}

void chip_tim2_count_is(uint32_t count) {
    tim2.count = count;
    tim2.base = now_units();
}
uint32_t chip_tim2_count(void) { return (uint32_t)(count_now(&tim2) % ((uint64_t)tim2.arr + 1U)); }

/* Defines the struct part of a timer, with the functions above. */
#define TIMER_PART(tim, called, at, bit) \
    static uint32_t tim##_load(uint32_t offset) { return load_of(&tim, offset); } \
    static void tim##_store(uint32_t offset, uint32_t value) { store_of(&tim, offset, value); } \
    static void tim##_reset(void) { reset_of(&tim); } \
    static uint64_t tim##_next(void) { return next_of(&tim); } \
    static void tim##_happens(void) { happens_to(&tim); } \
    static bool tim##_pending(unsigned interrupt) { return pending_of(&tim, interrupt); } \
    const part tim##_part = {.name = (called), \
                             .base = (at), \
                             .bytes = 0x54, \
                             .clock_register = 0x40, \
                             .clock_bit = BIT(bit), \
                             .load = tim##_load, \
                             .store = tim##_store, \
                             .reset = tim##_reset, \
                             .next = tim##_next, \
                             .happens = tim##_happens, \
                             .pending = tim##_pending};
TIMER_PART(tim2, "TIM2", AT_TIM2, 0)
TIMER_PART(tim3, "TIM3", AT_TIM3, 1)
