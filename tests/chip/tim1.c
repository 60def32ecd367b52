/* tim1.c: channel 1 of TIM1 in the chip model, with break, idle state and lock. RM0090, chapter 17, table 94. */
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
    RCR = 0x30,
    CCR1 = 0x34,
    BDTR = 0x44,
    DMAR = 0x4C
};
#define CC1E BIT(0)
#define CC1P BIT(1)
#define CC1NE BIT(2)
#define CC1NP BIT(3)
#define POLARITIES 0x2AAAU /* the bits CCxP and CCxNP of CCER */
#define OIS1N BIT(9)
#define IDLE_STATES 0x7F00U /* bits of CR2 */
#define OSSI BIT(10)
#define OSSR BIT(11)
#define BKE BIT(12)
#define BKP BIT(13)
#define AOE BIT(14)
#define MOE BIT(15)
#define BIF BIT(7)

bool break_pin_is_high(void);

static struct {
    uint32_t r[20];
    uint32_t psc, arr, ccr1; /* values in use, after the preload */
    uint32_t count;
    uint64_t base; /* time to which `count` belongs */
    bool locked_once, failed;
} t;

static uint32_t *reg(uint32_t offset) { return &t.r[offset / 4U]; }

uint64_t chip_tim1_tick_units(void) {
    const uint32_t hertz = apb2_timer_Hz();
    return hertz == 0 ? CHIP_NEVER : units_of(hertz) * (t.psc + 1U);
}
uint32_t chip_tim1_period_ticks(void) { return t.arr + 1U; }

static bool counts(void) {
    return (*reg(CR1) & 1U) != 0 && t.arr > 0 && apb2_timer_Hz() > 0 && !debug_stops(0x0C, 0);
}
static uint32_t count_now(void) {
    return counts() ? t.count + (uint32_t)((now_units() - t.base) / chip_tim1_tick_units())
                    : t.count;
}
void tim1_hold_count(void) {
    t.count = count_now();
    t.base = now_units();
}
void tim1_go_on(void) {}

static bool preloads(uint32_t offset) {
    return offset == ARR ? (*reg(CR1) & BIT(7)) != 0 : (*reg(CCMR1) & BIT(3)) != 0;
}

static void update(void) {
    t.psc = *reg(PSC);
    t.arr = *reg(ARR);
    t.ccr1 = *reg(CCR1);
}

static uint64_t tim1_next(void) {
    return counts() ? t.base + (t.arr + 1U - (t.count <= t.arr ? t.count : t.arr)) *
                                   chip_tim1_tick_units()
                    : CHIP_NEVER;
}

static bool break_is_active(void) {
    if ((*reg(BDTR) & BKE) == 0) {
        return false;
    }
    return t.failed || break_pin_is_high() == ((*reg(BDTR) & BKP) != 0);
}

static void tim1_happens(void) {
    t.count = 0;
    t.base = now_units();
    if ((*reg(CR1) & BIT(1)) == 0) {
        update();
        *reg(SR) |= 1U;
        if ((*reg(BDTR) & AOE) != 0 && !break_is_active()) {
            *reg(BDTR) |= MOE;
        }
    }
}

/* The break acts asynchronously, in hardware. */
void tim1_break_input(void) {
    if (break_is_active()) {
        *reg(BDTR) &= ~MOE;
        *reg(SR) |= BIF;
    }
}
void tim1_clock_failed(void) {
    t.failed = true;
    tim1_break_input();
    t.failed = false;
}

/* Returns OC1REF (17.4.7, OC1M): PWM modes 1 and 2 when counting up, and the forced levels. */
static bool reference(void) {
    const uint32_t count = count_now() % (t.arr + 1U);
    switch (FIELD(*reg(CCMR1), 4, 3)) {
    case 5: return true;
    case 6: return count < t.ccr1;
    case 7: return count >= t.ccr1;
    case 0: /* frozen: the mode after a reset */
    case 4: return false;
    default:
        forbidden("OC1M: a match toggles or sets, which the played chip does not");
        return false;
    }
}

/* Returns the output's level by table 94. The dead time must be 0, because a single output needs none. */
chip_level tim1_ch1n(void) {
    const uint32_t ccer = *reg(CCER);
    const uint32_t bdtr = *reg(BDTR);
    const bool inverted = (ccer & CC1NP) != 0;
    const bool main_on = (bdtr & MOE) != 0 && !(world.halt_disables && debug_stops(0x0C, 0));
    if (main_on) {
        if ((ccer & CC1NE) != 0) {
            const bool active = (ccer & CC1E) != 0 ? !reference() : reference();
            return active != inverted ? CHIP_HIGH : CHIP_LOW;
        }
        return (bdtr & OSSR) != 0 && (ccer & CC1E) != 0 ? (inverted ? CHIP_HIGH : CHIP_LOW)
                                                        : CHIP_OPEN;
    }
    if ((bdtr & OSSI) == 0 || (ccer & (CC1E | CC1NE)) == 0) {
        return CHIP_OPEN;
    }
    const bool idle = (*reg(CR2) & OIS1N) != 0;
    return idle ? CHIP_HIGH : CHIP_LOW;
}

static uint32_t tim1_load(uint32_t offset) {
    switch (offset) {
    case CNT: return count_now() % (t.arr + 1U);
    case EGR: return 0;
    case CR1:
    case CR2:
    case DIER:
    case SR:
    case CCMR1:
    case CCER:
    case PSC:
    case ARR:
    case CCR1:
    case BDTR: return *reg(offset);
    default: forbidden("load of TIM1 + 0x%02x", offset); return 0;
    }
}

/* Returns the bits of a register that the lock protects. A store that leaves them unchanged is allowed. */
static uint32_t kept_by_lock(uint32_t offset) {
    const uint32_t level = FIELD(*reg(BDTR), 8, 2);
    uint32_t kept = 0;
    if (offset == BDTR) {
        kept |= t.locked_once ? 3U << 8 : 0;
        kept |= level >= 1 ? 0xFFU | BKE | BKP | AOE : 0;
        kept |= level >= 2 ? OSSI | OSSR : 0;
    } else if (offset == CR2) {
        kept |= level >= 1 ? IDLE_STATES : 0;
    } else if (offset == CCER) {
        kept |= level >= 2 ? POLARITIES : 0;
    } else if (offset == CCMR1) {
        kept |= level >= 3 ? 0x7878U : 0;
    }
    return kept;
}

static void tim1_store(uint32_t offset, uint32_t value) {
    const uint32_t kept = kept_by_lock(offset);
    forbid_if(((value ^ *reg(offset)) & kept) != 0, "TIM1 + 0x%02x: what is locked", offset);
    const uint32_t next = (value & ~kept) | (*reg(offset) & kept);
    tim1_hold_count();
    switch (offset) {
    case SR: *reg(SR) &= value | ~UINT32_C(0x1EFF); break; /* type rc_w0 */
    case EGR:
        if ((value & 1U) != 0) {
            update();
            t.count = 0;
            *reg(SR) |= (*reg(CR1) & BIT(2)) != 0 ? 0 : 1U;
        }
        if ((value & BIT(7)) != 0) {
            *reg(BDTR) &= ~MOE;
            *reg(SR) |= BIF;
        }
        break;
    case CNT: t.count = value & 0xFFFFU; break;
    case PSC: *reg(PSC) = value & 0xFFFFU; break;
    case ARR:
        *reg(ARR) = value & 0xFFFFU;
        t.arr = preloads(ARR) ? t.arr : *reg(ARR);
        break;
    case CCR1:
        *reg(CCR1) = value & 0xFFFFU;
        t.ccr1 = preloads(CCR1) ? t.ccr1 : *reg(CCR1);
        break;
    case BDTR:
        *reg(BDTR) = next;
        t.locked_once = true;
        forbid_if((next & 0xFFU) != 0, "a dead time, which the played chip has not");
        tim1_break_input(); /* while a break is active, MOE stays off */
        break;
    case CR1:
    case CR2:
    case DIER:
    case CCMR1:
    case CCER: *reg(offset) = next; break;
    default: forbidden("store of TIM1 + 0x%02x", offset); break;
    }
    tim1_break_input();
}

void tim1_new(void) {
    memset(&t, 0, sizeof t);
    *reg(ARR) = 0xFFFFU;
    t.arr = 0xFFFFU;
    t.base = now_units();
}

/* True if TIM1 requests an interrupt: the break (24) if BIF and BIE are set, the update (25) if UIF and UIE are. */
static bool tim1_pending(unsigned interrupt) {
    const uint32_t asked = *reg(SR) & *reg(DIER);
    return (interrupt == 24 && (asked & BIF) != 0) || (interrupt == 25 && (asked & 1U) != 0) ||
           (interrupt == 27 && (asked & 0x1EU) != 0);
}

const part tim1_part = {.name = "TIM1",
                        .base = AT_TIM1,
                        .bytes = 0x50,
                        .clock_register = 0x44,
                        .clock_bit = BIT(0),
                        .load = tim1_load,
                        .store = tim1_store,
                        .reset = tim1_new,
                        .next = tim1_next,
                        .happens = tim1_happens,
                        .pending = tim1_pending};
