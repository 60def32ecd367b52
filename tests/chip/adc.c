/* adc.c: ADC1 of the chip model, with triggered groups, and its DMA2 stream 0. RM0090, chapters 13 and 10; DS8626,
 * table 67. */
#include <string.h>

#include "tests/chip/inner.h"

enum {
    SR = 0x00,
    CR1 = 0x04,
    CR2 = 0x08,
    SMPR1 = 0x0C,
    SMPR2 = 0x10,
    SQR1 = 0x2C,
    SQR2 = 0x30,
    SQR3 = 0x34,
    DR = 0x4C,
    CCR = 0x304
};
#define EOC BIT(1)
#define STRT BIT(4)
#define OVR BIT(5)
#define SCAN BIT(8)
#define OVRIE BIT(26)
#define ADON BIT(0)
#define DMA BIT(8)
#define DDS BIT(9)
#define SWSTART BIT(30)
#define STABLE_US 3U

static struct {
    uint32_t r[20];
    uint32_t ccr;
    uint64_t stable_at; /* the converter is stable from this time on (after ADON) */
    bool busy, sampled;
    unsigned at; /* index of the conversion within its group */
    uint64_t hold_at, end_at;
    uint16_t value;
    bool late;
    bool unread, dma_open; /* unread: DR holds an unread value; dma_open: DDS permits requests */
} adc;

static uint32_t *reg(uint32_t offset) { return &adc.r[offset / 4U]; }

static uint64_t clock_units(void) {
    const uint32_t hertz = apb2_Hz() / (2U * (FIELD(adc.ccr, 16, 2) + 1U));
    forbid_if(hertz > 36000000U || hertz < 600000U, "the ADC's clock is %u Hz", hertz);
    return units_of(hertz);
}

static unsigned members(void) {
    return (*reg(CR1) & SCAN) != 0 ? FIELD(*reg(SQR1), 20, 4) + 1U : 1U;
}
static unsigned input_at(unsigned at) {
    return at < 6    ? FIELD(*reg(SQR3), 5U * at, 5)
           : at < 12 ? FIELD(*reg(SQR2), 5U * (at - 6U), 5)
                     : FIELD(*reg(SQR1), 5U * (at - 12U), 5);
}

/* Checks that a pin is an input of ADC1 (DS8626, table 9). */
static void pin_is_wired(unsigned input) {
    const unsigned port = input < 8 ? 0 : input < 10 ? 1 : 2;
    const unsigned pin = input < 8 ? input : input < 10 ? input - 8U : input - 10U;
    if (input > 15) {
        forbidden("ADC1's input %u is none of a pin", input);
    } else if (!pin_is_analogue(port, pin)) {
        forbidden("ADC1 samples P%c%u, which is no analogue pin", (char)('A' + port), pin);
    }
}

static void begin_member(void) {
    static const uint16_t cycles[8] = {3, 15, 28, 56, 84, 112, 144, 480};
    const unsigned input = input_at(adc.at);
    const uint32_t sampling = cycles[input >= 10 ? FIELD(*reg(SMPR1), 3U * (input - 10U), 3)
                                                 : FIELD(*reg(SMPR2), 3U * input, 3)];
    static const uint8_t bits[4] = {12, 10, 8, 6};
    pin_is_wired(input);
    adc.sampled = false;
    adc.hold_at = now_units() + sampling * clock_units();
    adc.end_at = adc.hold_at + bits[FIELD(*reg(CR1), 24, 2)] * clock_units();
}

static void begin_group(void) {
    if ((*reg(CR2) & ADON) == 0) {
        forbidden("a conversion while the ADC is off");
        return;
    }
    forbid_if(now_units() < adc.stable_at, "a conversion before the ADC is stable");
    if (adc.busy) {
        forbidden("a trigger while the group before is converted");
        return;
    }
    if ((*reg(SR) & OVR) != 0) {
        return; /* until OVR is cleared, triggers are ignored */
    }
    adc.busy = true;
    adc.at = 0;
    *reg(SR) |= STRT;
    begin_member();
}

void adc_trigger(unsigned event) {
    if ((*reg(CR2) & ADON) != 0 && (FIELD(*reg(CR2), 28, 2) & 1U) != 0 &&
        FIELD(*reg(CR2), 24, 4) == event) {
        begin_group();
    }
}

void chip_adc_overruns(void) { adc.late = true; }

static uint64_t adc_next(void) {
    return !adc.busy ? CHIP_NEVER : !adc.sampled ? adc.hold_at : adc.end_at;
}

static uint16_t converted(void) {
    const double s = chip_s();
    const double volts = world.volts != NULL ? world.volts(input_at(adc.at), s) : 0.0;
    const double counts = volts / world.vdda_V * 4096.0;
    return counts < 0.0 ? 0 : counts >= 4095.0 ? 4095 : (uint16_t)counts;
}

static void adc_happens(void) {
    if (!adc.sampled) {
        adc.value = converted(); /* the voltage is sampled at this time */
        adc.sampled = true;
        return;
    }
    const bool dma = (*reg(CR2) & DMA) != 0;
    if (adc.unread && dma) {
        *reg(SR) |= OVR; /* DR keeps the unread value, and requests end */
        adc.busy = false;
        adc.dma_open = false;
        return;
    }
    forbid_if((*reg(CR1) & BIT(24)) != 0 || (*reg(CR1) & BIT(25)) != 0 ||
                  (*reg(CR2) & BIT(11)) != 0,
              "a resolution or alignment that the played chip has not");
    *reg(DR) = adc.value;
    adc.unread = true;
    if ((*reg(CR2) & BIT(10)) != 0 || adc.at + 1U == members()) {
        *reg(SR) |= EOC;
    }
    if (dma && adc.dma_open && !adc.late) {
        dma_request_adc();
    }
    adc.late = false;
    adc.at++;
    if (adc.at < members()) {
        begin_member();
    } else {
        adc.busy = false;
        if ((*reg(CR2) & BIT(1)) != 0) {
            begin_group();
        }
    }
}

/* DMA reads DR. If DDS is 0, no request follows the last transfer. */
static uint16_t adc_taken(bool last) {
    adc.unread = false;
    *reg(SR) &= ~EOC;
    if (last && (*reg(CR2) & DDS) == 0) {
        adc.dma_open = false;
    }
    return (uint16_t)*reg(DR);
}

static uint32_t adc_load(uint32_t offset) {
    if (offset == CCR) {
        return adc.ccr;
    }
    if (offset >= sizeof adc.r) {
        return 0;
    }
    if (offset == DR) {
        adc.unread = false;
        *reg(SR) &= ~EOC;
    }
    return *reg(offset);
}

static void adc_store(uint32_t offset, uint32_t value) {
    if (offset == CCR) {
        adc.ccr = value;
        return;
    }
    if (offset >= sizeof adc.r) {
        forbidden("store of ADC + 0x%03x", offset);
        return;
    }
    switch (offset) {
    case SR: *reg(SR) &= value; break; /* type rc_w0 */
    case CR2: {
        const uint32_t before = *reg(CR2);
        *reg(CR2) = value & ~SWSTART;
        if ((value & ADON & ~before) != 0) {
            adc.stable_at = now_units() + STABLE_US * CHIP_UNITS_PER_US;
        }
        if ((value & ADON) == 0) {
            adc.busy = false;
        }
        if ((value & DMA & ~before) != 0) {
            adc.dma_open = true;
        }
        if ((value & SWSTART) != 0) {
            begin_group();
        }
        break;
    }
    case SQR1:
    case SQR2:
    case SQR3:
    case SMPR1:
    case SMPR2:
        forbid_if(adc.busy, "the group is changed while it is converted");
        *reg(offset) = value;
        break;
    case CR1: *reg(CR1) = value; break;
    case DR: break;
    default: forbidden("store of ADC + 0x%03x", offset); break;
    }
}

static void adc_reset(void) { memset(&adc, 0, sizeof adc); }
static bool adc_pending(unsigned interrupt) {
    return interrupt == 18 && (((*reg(SR) & OVR) != 0 && (*reg(CR1) & OVRIE) != 0) ||
                               ((*reg(SR) & EOC) != 0 && (*reg(CR1) & BIT(5)) != 0));
}

const part adc_part = {.name = "ADC1",
                       .base = AT_ADC1,
                       .bytes = 0x308,
                       .clock_register = 0x44,
                       .clock_bit = BIT(8),
                       .load = adc_load,
                       .store = adc_store,
                       .reset = adc_reset,
                       .next = adc_next,
                       .happens = adc_happens,
                       .pending = adc_pending};

enum {
    LISR = 0x00,
    LIFCR = 0x08,
    S0CR = 0x10,
    S0NDTR = 0x14,
    S0PAR = 0x18,
    S0M0AR = 0x1C,
    S0M1AR = 0x20,
    S0FCR = 0x24
};
#define EN BIT(0)
#define CIRC BIT(8)
#define TEIF BIT(3)
#define HTIF BIT(4)
#define TCIF BIT(5)
#define STREAM0_FLAGS 0x3DU

static struct {
    uint32_t cr, left, par, m0ar, m1ar, fcr, flags;
    uint32_t whole; /* NDTR when the stream began */
} dma;

void dma_request_adc(void) {
    if ((dma.cr & EN) == 0 || FIELD(dma.cr, 25, 3) != 0) {
        return; /* the value was not read, so the next one overruns it */
    }
    volatile uint16_t *memory = (volatile uint16_t *)memory_at(dma.m0ar);
    if (dma.par != AT_ADC1 + DR || memory == NULL || FIELD(dma.cr, 6, 2) != 0 ||
        FIELD(dma.cr, 11, 2) != 1 || FIELD(dma.cr, 13, 2) != 1 || (dma.cr & BIT(9)) != 0 ||
        (dma.cr & BIT(10)) == 0) {
        forbidden("the stream takes no half words of the ADC into memory: CR 0x%08x", dma.cr);
        dma.flags |= TEIF;
        dma.cr &= ~EN;
        return;
    }
    memory[dma.whole - dma.left] =
        adc_taken(dma.left == 1); /* true at the last value of each round */
    dma.left--;
    if (dma.left == dma.whole / 2U) {
        dma.flags |= HTIF;
    }
    if (dma.left == 0) {
        dma.flags |= TCIF;
        if ((dma.cr & CIRC) != 0) {
            dma.left = dma.whole;
        } else {
            dma.cr &= ~EN;
        }
    }
}

static uint32_t dma_load(uint32_t offset) {
    switch (offset) {
    case LISR: return dma.flags;
    case S0CR: return dma.cr;
    case S0NDTR: return dma.left;
    case S0PAR: return dma.par;
    case S0M0AR: return dma.m0ar;
    case S0M1AR: return dma.m1ar;
    case S0FCR: return dma.fcr;
    default: forbidden("load of DMA2 + 0x%02x", offset); return 0;
    }
}

static void stays_while_on(uint32_t offset, uint32_t *to, uint32_t value) {
    if ((dma.cr & EN) != 0 && *to != value) {
        forbidden("stream 0 + 0x%02x while it is on", offset);
        return;
    }
    *to = value;
}

static void dma_store(uint32_t offset, uint32_t value) {
    switch (offset) {
    case LIFCR: dma.flags &= ~value; break;
    case S0CR:
        if ((dma.cr & EN) != 0 && (value & EN) != 0) {
            const uint32_t interrupts = 0x1EU;
            if (((value ^ dma.cr) & ~interrupts) != 0) {
                forbidden("stream 0's CR while it is on");
                break;
            }
        }
        if ((value & EN) != 0 && (dma.cr & EN) == 0) {
            forbid_if((dma.flags & STREAM0_FLAGS) != 0, "stream 0 on with flags of before: 0x%02x",
                      dma.flags);
            forbid_if(dma.left == 0, "stream 0 on with nothing to take");
            dma.whole = dma.left;
        }
        if ((value & EN) == 0 && (dma.cr & EN) != 0) {
            dma.flags |= TCIF; /* 10.3.17: the stream was disabled before its end */
        }
        dma.cr = value;
        break;
    case S0NDTR: stays_while_on(offset, &dma.left, value & 0xFFFFU); break;
    case S0PAR: stays_while_on(offset, &dma.par, value); break;
    case S0M0AR: stays_while_on(offset, &dma.m0ar, value); break;
    case S0M1AR: dma.m1ar = value; break;
    case S0FCR: stays_while_on(offset, &dma.fcr, value); break;
    default: forbidden("store of DMA2 + 0x%02x", offset); break;
    }
}

static void dma_reset(void) {
    memset(&dma, 0, sizeof dma);
    dma.fcr = 0x21U;
}
static bool dma_pending(unsigned interrupt) {
    return interrupt == 56 && (((dma.flags & HTIF) != 0 && (dma.cr & BIT(3)) != 0) ||
                               ((dma.flags & TCIF) != 0 && (dma.cr & BIT(4)) != 0) ||
                               ((dma.flags & TEIF) != 0 && (dma.cr & BIT(2)) != 0));
}

const part dma_part = {.name = "DMA2",
                       .base = AT_DMA2,
                       .bytes = 0xD0,
                       .clock_register = 0x30,
                       .clock_bit = BIT(22),
                       .load = dma_load,
                       .store = dma_store,
                       .reset = dma_reset,
                       .pending = dma_pending};
