/* usart.c: USART6 of the chip model. RM0090, chapter 30. */
#include <string.h>

#include "tests/chip/inner.h"

enum { SR = 0x00, DR = 0x04, BRR = 0x08, CR1 = 0x0C, CR2 = 0x10, CR3 = 0x14, GTPR = 0x18 };
#define ORE BIT(3)
#define RXNE BIT(5)
#define TC BIT(6)
#define TXE BIT(7)
#define RE BIT(2)
#define TE BIT(3)
#define UE BIT(13)

#define COMING 8192U
#define SENT 16384U
static struct {
    uint64_t when;
    uint8_t byte;
    uint8_t flags; /* flags of SR that the byte sets */
} coming[COMING];
static unsigned coming_from, coming_to;
static uint8_t sent[SENT];
static unsigned sent_count;

static struct {
    uint32_t sr, brr, cr1, cr2, cr3;
    uint8_t received, next, shifts;
    bool shifting;
    uint64_t end_at;
    uint32_t seen; /* flags of SR when the program last read it */
} u;

bool serial_pin_out(void);
bool serial_pin_in(void);

uint64_t chip_serial_byte_units(void) {
    return u.brr == 0 || apb2_Hz() == 0 ? 0 : 10U * u.brr * units_of(apb2_Hz());
}
void chip_serial_comes(uint64_t when, uint8_t byte) { chip_serial_comes_as(when, byte, 0); }
void chip_serial_comes_as(uint64_t when, uint8_t byte, uint8_t flags) {
    coming[coming_to % COMING].when = when;
    coming[coming_to % COMING].flags = flags;
    coming[coming_to++ % COMING].byte = byte;
    forbid_if(coming_to - coming_from > COMING, "more bytes to come than there is room for");
}
unsigned chip_serial_sent(void) { return sent_count; }
uint8_t chip_serial_byte(unsigned at) { return sent[at % SENT]; }

static uint64_t out_at(void) { return u.shifting ? u.end_at : CHIP_NEVER; }
static uint64_t in_at(void) {
    return coming_from != coming_to ? coming[coming_from % COMING].when : CHIP_NEVER;
}
static uint64_t usart_next(void) { return out_at() < in_at() ? out_at() : in_at(); }

static void shift(uint8_t byte) {
    u.shifts = byte;
    u.shifting = true;
    u.sr &= ~TC;
    u.end_at = now_units() + chip_serial_byte_units();
}

static void usart_happens(void) {
    if (out_at() <= now_units()) {
        u.shifting = false;
        if (serial_pin_out()) {
            sent[sent_count++ % SENT] = u.shifts;
        } else {
            forbidden("a byte goes out, and no pin is USART6_TX");
        }
        if ((u.sr & TXE) == 0) {
            u.sr |= TXE;
            shift(u.next);
        } else {
            u.sr |= TC;
        }
    } else {
        const uint8_t flags = coming[coming_from % COMING].flags;
        const uint8_t byte = coming[coming_from++ % COMING].byte;
        if ((u.cr1 & (UE | RE)) == (UE | RE) && serial_pin_in()) {
            if ((u.sr & RXNE) != 0) {
                u.sr |= ORE; /* DR keeps the previous byte, and this one is lost */
            } else {
                u.received = byte; /* an invalid byte is stored, too (30.3.3) */
                u.sr |= RXNE | flags;
            }
        }
    }
}

static uint32_t usart_load(uint32_t offset) {
    switch (offset) {
    case SR: u.seen = u.sr; return u.sr;
    case DR: {
        /* A load of SR, then one of DR clears ORE. */
        u.sr &= ~(RXNE | (u.seen & (ORE | 0x17U)));
        u.seen = 0;
        return u.received;
    }
    case BRR: return u.brr;
    case CR1: return u.cr1;
    case CR2: return u.cr2;
    case CR3: return u.cr3;
    default: forbidden("load of USART6 + 0x%02x", offset); return 0;
    }
}

static void usart_store(uint32_t offset, uint32_t value) {
    switch (offset) {
    case SR:
        u.sr &= value | ~(uint32_t)(BIT(9) | BIT(8) | TC | RXNE);
        break; /* a store clears no other flags */
    case DR:
        if ((u.cr1 & (UE | TE)) != (UE | TE)) {
            forbidden("a byte to a USART that does not send");
            break;
        }
        forbid_if((u.sr & TXE) == 0, "a byte over one that waits");
        if (u.shifting) {
            u.next = (uint8_t)value;
            u.sr &= ~TXE;
        } else {
            shift((uint8_t)value);
        }
        break;
    case BRR: u.brr = value & 0xFFFFU; break;
    case CR1: {
        const uint32_t changed = value ^ u.cr1;
        u.cr1 = value;
        forbid_if((value & (BIT(15) | BIT(12) | BIT(10))) != 0,
                  "a frame of not eight bits without parity");
        if ((changed & (UE | TE)) != 0 && (value & (UE | TE)) == (UE | TE)) {
            u.sr |= TXE | TC;
        }
        if ((value & UE) == 0) {
            u.shifting = false;
        }
        break;
    }
    case CR2: u.cr2 = value; break;
    case CR3: u.cr3 = value; break;
    default: forbidden("store of USART6 + 0x%02x", offset); break;
    }
}

static bool usart_pending(unsigned interrupt) {
    return interrupt == 71 && (((u.sr & (RXNE | ORE)) != 0 && (u.cr1 & BIT(5)) != 0) ||
                               ((u.sr & TXE) != 0 && (u.cr1 & BIT(7)) != 0) ||
                               ((u.sr & TC) != 0 && (u.cr1 & BIT(6)) != 0));
}

static void usart_reset(void) {
    memset(&u, 0, sizeof u);
    u.sr = TXE | TC;
}
void usart_new(void) {
    coming_from = coming_to = sent_count = 0;
    usart_reset();
}

const part usart_part = {.name = "USART6",
                         .base = AT_USART6,
                         .bytes = 0x1C,
                         .clock_register = 0x44,
                         .clock_bit = BIT(5),
                         .load = usart_load,
                         .store = usart_store,
                         .reset = usart_reset,
                         .next = usart_next,
                         .happens = usart_happens,
                         .pending = usart_pending};
