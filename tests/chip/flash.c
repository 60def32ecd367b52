/* flash.c: flash of the chip model: wait states, erase, program, option bytes, cache. RM0090, chapter 3; DS8626, tables 40, 41. */
#include <string.h>

#include "tests/chip/inner.h"

enum { ACR = 0x00, KEYR = 0x04, OPTKEYR = 0x08, SR = 0x0C, CR = 0x10, OPTCR = 0x14 };
#define BSY BIT(16)
#define EOP BIT(0)
#define WRPERR BIT(4)
#define PGPERR BIT(6)
#define PGSERR BIT(7)
#define PG BIT(0)
#define SER BIT(1)
#define MER BIT(2)
#define STRT BIT(16)
#define LOCK BIT(31)
#define OPTLOCK BIT(0)
#define OPTSTRT BIT(1)
#define DCEN BIT(10)
#define DCRST BIT(12)
#define DELIVERED 0x0FFFAAECU /* factory option bytes: no brown-out level, no protection */
#define OPTIONS 0x0FFFFFECU
#define LINES 8U
#define LINE_BYTES 16U

static uint8_t memory[FLASH_MEMORY_BYTES];
static unsigned erases[12];
static uint32_t option_bytes;
static unsigned option_writes;

typedef enum flash_work { NOTHING, ERASES, PROGRAMS, OPTIONS_CHANGE } flash_work;

static struct {
    uint32_t acr, sr, cr, optcr;
    /* 0, 1: number of correct keys so far; 2: unlocked; 3: locked until a reset */
    unsigned keys, option_keys;
    uint64_t busy_until;
    bool looked; /* the program has read BSY as 0 since the previous operation */
    flash_work does;
    uint32_t at, value; /* address and value of the current operation */
    struct {
        bool used;
        uint32_t address;
        uint8_t bytes[LINE_BYTES];
    } line[LINES];
    unsigned oldest;
} f;

static uint32_t sector_of(uint32_t at) {
    return at < 0x10000U ? at / 0x4000U : at < 0x20000U ? 4U : at / 0x20000U + 4U;
}
static uint32_t sector_start(uint32_t sector) {
    return sector < 4 ? sector * 0x4000U : sector == 4 ? 0x10000U : (sector - 4U) * 0x20000U;
}
static uint32_t sector_bytes(uint32_t sector) {
    return sector < 4 ? 0x4000U : sector == 4 ? 0x10000U : 0x20000U;
}

/* Table 10, 2.7 to 3.6 V: 30 MHz per wait state. */
void flash_clock_is(uint32_t hertz) {
    forbid_if(hertz > 30000000U * ((f.acr & 7U) + 1U), "core at %u Hz, flash with %u wait states",
              hertz, f.acr & 7U);
}

bool flash_busy(void) { return f.busy_until > now_units(); }
uint64_t flash_busy_until(void) { return f.busy_until; }

static void ends(void) {
    if (f.does == ERASES) {
        memset(memory + sector_start(f.at), 0xFF, sector_bytes(f.at));
        erases[f.at]++;
    } else if (f.does == PROGRAMS) {
        for (unsigned i = 0; i < 4; i++) {
            memory[f.at + i] &= (uint8_t)(f.value >> (8U * i));
        }
    } else if (f.does == OPTIONS_CHANGE) {
        option_bytes = f.value;
        option_writes++;
    }
    if (f.does != NOTHING) {
        f.sr &= ~BSY;
    }
    f.does = NOTHING;
}

static uint64_t flash_next(void) { return f.does != NOTHING ? f.busy_until : CHIP_NEVER; }

static void begins(flash_work what, uint32_t at, uint32_t value, uint64_t us) {
    forbid_if(!f.looked, "a flash operation without a look at BSY before");
    f.looked = false;
    f.does = what;
    f.at = at;
    f.value = value;
    f.busy_until = now_units() + us * CHIP_UNITS_PER_US;
    f.sr |= BSY;
}

/* If power or the chip's state is lost in the middle of an operation, the bits that change become random. */
void flash_power_goes(void) {
    if (f.does == ERASES) {
        for (uint32_t i = 0; i < sector_bytes(f.at); i++) {
            memory[sector_start(f.at) + i] |= (uint8_t)drawn();
        }
    } else if (f.does == PROGRAMS) {
        for (unsigned i = 0; i < 4; i++) {
            memory[f.at + i] &= (uint8_t)(f.value >> (8U * i) | drawn());
        }
    } else if (f.does == OPTIONS_CHANGE) {
        option_bytes =
            /* the new or the old bytes: the manual specifies no worse outcome */
            (drawn() & 1U) != 0 ? f.value : option_bytes;
    }
    f.does = NOTHING;
}

static void flash_reset(void) {
    memset(&f, 0, sizeof f);
    f.cr = LOCK;
    f.optcr = option_bytes | OPTLOCK;
}

void flash_new(void) {
    memset(memory, 0xFF, sizeof memory);
    memset(erases, 0, sizeof erases);
    option_bytes = DELIVERED;
    option_writes = 0;
    flash_reset();
}

static unsigned key(unsigned had, uint32_t value, uint32_t first, uint32_t second,
                    const char *which) {
    if (had == 0 && value == first) {
        return 1;
    }
    if (had == 1 && value == second) {
        return 2;
    }
    forbidden("a wrong key to %s: it is shut until a reset", which);
    return 3;
}

static uint32_t flash_load(uint32_t offset) {
    switch (offset) {
    case ACR: return f.acr;
    case SR: f.looked = (f.sr & BSY) == 0; return f.sr;
    case CR: return f.cr;
    case OPTCR: return f.optcr;
    case KEYR:
    case OPTKEYR: return 0;
    default: forbidden("load of FLASH + 0x%02x", offset); return 0;
    }
}

static void control(uint32_t value) {
    if ((f.cr & LOCK) != 0) {
        forbid_if((value & ~LOCK) != (f.cr & ~LOCK), "FLASH_CR while it is locked");
        return;
    }
    f.cr = value & ~STRT;
    if ((value & LOCK) != 0) {
        f.keys = 0;
    }
    if ((value & STRT) == 0) {
        return;
    }
    const uint32_t sector = FIELD(value, 3, 4);
    if ((value & MER) != 0) {
        forbidden("all of the flash is erased");
    } else if ((value & SER) == 0 || sector > 11) {
        forbidden("STRT without a sector");
    } else if (sector == 0 || sector > 2) {
        forbidden("sector %u, the program's, is erased", sector);
    } else if ((f.sr & 0xF2U) != 0) {
        forbidden("an erase with error flags of before");
    } else if ((option_bytes & BIT(16U + sector)) == 0) {
        f.sr |= WRPERR;
    } else {
        static const uint16_t least_ms[4] = {
            400, 300, 250, 250}; /* typical times (table 40); an erase takes up to twice as long */
        const uint32_t ms = least_ms[FIELD(value, 8, 2)];
        begins(ERASES, sector, 0, 1000U * (ms + drawn() % ms));
    }
}

static void options(uint32_t value) {
    if ((f.optcr & OPTLOCK) != 0) {
        forbidden("FLASH_OPTCR while it is locked");
        return;
    }
    const bool begin = (value & OPTSTRT) != 0;
    forbid_if(begin && ((value ^ f.optcr) & OPTIONS) != 0,
              "OPTSTRT in one store with other option bytes");
    f.optcr = value & ~OPTSTRT;
    if ((value & OPTLOCK) != 0) {
        f.option_keys = 0;
    }
    if (begin) {
        forbid_if(((value ^ option_bytes) & 0x0FFFFFE0U & OPTIONS) != 0,
                  "option bytes beside the brown-out level: 0x%08x for 0x%08x", value,
                  option_bytes);
        begins(OPTIONS_CHANGE, 0, value & OPTIONS, 1000U * (250U + drawn() % 250U));
    }
}

static void flash_store(uint32_t offset, uint32_t value) {
    switch (offset) {
    case ACR:
        if ((value & DCRST) != 0 && (f.acr & value & DCEN) != 0) {
            forbidden("DCRST while the cache is on");
        } else if ((value & DCRST) != 0) {
            memset(f.line, 0, sizeof f.line);
        }
        forbid_if((value & BIT(11)) != 0 && (f.acr & value & BIT(9)) != 0,
                  "ICRST while the cache is on");
        f.acr = value;
        flash_clock_is(core_Hz());
        break;
    case KEYR:
        f.keys = key(f.keys, value, 0x45670123U, 0xCDEF89ABU, "FLASH_CR");
        f.cr = f.keys == 2 ? f.cr & ~LOCK : f.cr;
        break;
    case OPTKEYR:
        f.option_keys = key(f.option_keys, value, 0x08192A3BU, 0x4C5D6E7FU, "FLASH_OPTCR");
        f.optcr = f.option_keys == 2 ? f.optcr & ~OPTLOCK : f.optcr;
        break;
    case SR: f.sr &= ~(value & 0xF3U); break; /* type rc_w1 */
    case CR: control(value); break;
    case OPTCR: options(value); break;
    default: forbidden("store of FLASH + 0x%02x", offset); break;
    }
}

const part flash_part = {.name = "FLASH",
                         .base = AT_FLASH,
                         .bytes = 0x18,
                         .load = flash_load,
                         .store = flash_store,
                         .reset = flash_reset,
                         .next = flash_next,
                         .happens = ends};

static uint32_t word_of(const uint8_t *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* The cache has eight lines of 16 bytes; a new line replaces the oldest. Programming updates them, an erase does not
 * (3.5.2). */
static uint32_t memory_load(uint32_t at) {
    if ((f.acr & DCEN) == 0) {
        return word_of(memory + at);
    }
    const uint32_t address = at / LINE_BYTES * LINE_BYTES;
    for (unsigned i = 0; i < LINES; i++) {
        if (f.line[i].used && f.line[i].address == address) {
            forbid_if(memcmp(f.line[i].bytes, memory + address, LINE_BYTES) != 0,
                      "the cache of data gives what was at 0x%08x before the erase",
                      AT_FLASH_MEMORY + at);
            return word_of(f.line[i].bytes + at % LINE_BYTES);
        }
    }
    const unsigned to = f.oldest++ % LINES;
    f.line[to].used = true;
    f.line[to].address = address;
    memcpy(f.line[to].bytes, memory + address, LINE_BYTES);
    return word_of(f.line[to].bytes + at % LINE_BYTES);
}

static void memory_store(uint32_t at, uint32_t value) {
    if ((f.cr & LOCK) != 0 || (f.cr & PG) == 0) {
        f.sr |= PGSERR;
        forbidden("a store into flash without PG");
    } else if (FIELD(f.cr, 8, 2) != 2) {
        f.sr |= PGPERR;
        forbidden("a word into flash with PSIZE %u", FIELD(f.cr, 8, 2));
    } else if ((f.sr & 0xF2U) != 0) {
        forbidden("programmed with error flags of before");
    } else if (sector_of(at) == 0 || sector_of(at) > 2) {
        forbidden("the program's flash is programmed");
    } else if ((option_bytes & BIT(16U + sector_of(at))) == 0) {
        f.sr |= WRPERR;
    } else {
        forbid_if((value & ~word_of(memory + at)) != 0, "flash at 0x%08x is not erased",
                  AT_FLASH_MEMORY + at);
        for (unsigned i = 0; i < LINES; i++) {
            if (f.line[i].used && f.line[i].address == at / LINE_BYTES * LINE_BYTES) {
                for (unsigned b = 0; b < 4; b++) {
                    f.line[i].bytes[at % LINE_BYTES + b] &= (uint8_t)(value >> (8U * b));
                }
            }
        }
        begins(PROGRAMS, at, value, 16U + drawn() % 84U);
    }
}

const part flash_memory_part = {.name = "flash memory",
                                .base = AT_FLASH_MEMORY,
                                .bytes = FLASH_MEMORY_BYTES,
                                .load = memory_load,
                                .store = memory_store};

uint8_t chip_flash_byte(uint32_t address) { return memory[address - AT_FLASH_MEMORY]; }
void chip_flash_byte_is(uint32_t address, uint8_t byte) {
    memory[address - AT_FLASH_MEMORY] = byte;
}
unsigned chip_flash_erases(unsigned sector) { return erases[sector]; }
uint32_t chip_option_bytes(void) { return option_bytes; }
unsigned chip_option_writes(void) { return option_writes; }
bool chip_options_are_locked(void) { return (f.optcr & OPTLOCK) != 0; }
void chip_protect_sector(unsigned sector) {
    option_bytes &= ~BIT(16U + sector);
    f.optcr &= ~BIT(16U + sector);
}
