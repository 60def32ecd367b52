/* chip.c: time, bus, interrupts and resets of the chip model. */
#include "tests/chip/chip.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "board_data.h"
#include "boards/cortexm/cortexm.h"
#include "boards/stm32f4/registers.h"
#include "tests/chip/inner.h"

chip_world world;
chip_cause reset_by;
void (*chip_stored)(void);

static const part *const parts[] = {
    &rcc_part,  &pwr_part,  &flash_part,  &flash_memory_part, &gpio_part,      &tim1_part,
    &tim2_part, &tim3_part, &adc_part,    &dma_part,          &usart_part,     &iwdg_part,
    &nvic_part, &scb_part,  &dbgmcu_part, &dwt_part,          &core_debug_part};
#define PARTS (sizeof parts / sizeof *parts)

#define INTERRUPTS 82U /* RM0090, table 62 */
#define NMI 1000U
/* A handler that runs this often, while the program makes no progress, counts as endless. */
#define HANDLED_MOST 20000U
static struct {
    uint64_t now;
    uint64_t random;
    uint64_t begun, may_take, power_at;
    uint64_t quiet_until; /* no event and no interrupt comes before this time; 0: unknown */
    jmp_buf back;
    bool trying, masked, handling, in_nmi, halted, nmi_taken, passing;
    bool power_ends;
    unsigned stores, power_after, violations, handled, resets;
    chip_end end;
    char violation[200];
    uint32_t enabled[3];
    uint32_t set_pending[3];
    unsigned long taken[INTERRUPTS];
} chip;

void forbid_if(bool broken, const char *words, ...) {
    if (broken && chip.violations++ == 0) {
        va_list list;
        va_start(list, words);
        (void)vsnprintf(chip.violation, sizeof chip.violation, words, list);
        va_end(list);
    }
}
unsigned chip_violations(void) { return chip.violations; }
const char *chip_violation(void) { return chip.violations > 0 ? chip.violation : "none"; }
void chip_forgive(void) { chip.violations = 0; }

uint64_t drawn(void) {
    chip.random ^= chip.random << 13;
    chip.random ^= chip.random >> 7;
    chip.random ^= chip.random << 17;
    return chip.random;
}

__attribute__((noreturn)) static void leave(chip_end end) {
    chip.end = end;
    chip.handling = false;
    chip.in_nmi = false;
    longjmp(chip.back, 1);
}

void core_resets(chip_cause cause) {
    chip_reset(cause);
    if (chip.trying) {
        leave(CHIP_RESET);
    }
}

chip_end chip_try_with(void (*what)(void *), void *with) {
    chip.trying = true;
    chip.quiet_until = 0;
    chip.handled = 0;
    chip.begun = chip.now;
    chip.end = CHIP_RETURNED;
    if (setjmp(chip.back) == 0) {
        what(with);
    }
    chip.trying = false;
    return chip.end;
}

static void call(void *what) { (*(void (**)(void))what)(); }
chip_end chip_try(void (*what)(void)) { return chip_try_with(call, &what); }

void chip_may_take(uint64_t units) { chip.may_take = units; }
void chip_power_off_after(unsigned stores) {
    chip.power_ends = true;
    chip.power_after = chip.stores + stores;
}
void chip_power_off_at(uint64_t when) { chip.power_at = when; }
void chip_power_stays(void) {
    chip.power_ends = false;
    chip.power_at = CHIP_NEVER;
}
unsigned chip_stores(void) { return chip.stores; }

uint64_t now_units(void) { return chip.now; }
uint64_t chip_now(void) { return chip.now; }
double chip_s(void) { return (double)chip.now / (double)CHIP_UNITS_PER_S; }
bool core_halted(void) { return chip.halted; }
void chip_halt(bool halted) {
    timers_hold_counts();
    tim1_hold_count();
    if (halted) {
        iwdg_holds();
    } else {
        iwdg_goes_on();
    }
    chip.halted = halted;
    timers_go_on();
    tim1_go_on();
    pins_changed();
}
bool chip_nmi_taken(void) { return chip.nmi_taken; }

static bool asks(unsigned interrupt) {
    if ((chip.set_pending[interrupt / 32U] & BIT(interrupt % 32U)) != 0) {
        return true;
    }
    for (unsigned i = 0; i < PARTS; i++) {
        if (parts[i]->pending != NULL && parts[i]->pending(interrupt)) {
            return true;
        }
    }
    return false;
}

/* Vectors by name. If this program lacks a driver, the driver's vector is NULL, and its interrupt is a fault. */
#define WEAK_ROW(number, name) __attribute__((weak)) void on_##name(void);
BOARD_VECTOR_ROWS(WEAK_ROW)
__attribute__((weak)) void on_nmi(void);
static const struct {
    unsigned number;
    void (*handler)(void);
} vectors[] = {
#define VECTOR_ROW(number, name) {(number), on_##name},
    BOARD_VECTOR_ROWS(VECTOR_ROW)};

static void handle(void (*handler)(void), unsigned number) {
    if (handler == NULL) {
        forbidden("interrupt %u, and nobody takes it", number);
        return;
    }
    if (++chip.handled > HANDLED_MOST && chip.trying) {
        leave(CHIP_HANGS);
    }
    handler();
}

static void take_interrupts(void) {
    if (chip.halted || chip.in_nmi) {
        return;
    }
    if (nmi_pending() && !chip.nmi_taken) {
        chip.nmi_taken = true; /* on_nmi() reports a fault and does not return */
        chip.in_nmi = true;
        if (on_nmi != NULL) {
            on_nmi();
        }
        chip.in_nmi = false;
    }
    if (chip.masked || chip.handling || flash_busy()) {
        return;
    }
    for (unsigned i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        const unsigned n = vectors[i].number;
        if (n < INTERRUPTS && (chip.enabled[n / 32U] & BIT(n % 32U)) != 0 && asks(n)) {
            chip.set_pending[n / 32U] &= ~BIT(n % 32U);
            chip.taken[n]++;
            chip.handling = true;
            handle(vectors[i].handler, n);
            chip.handling = false;
            i = UINT32_MAX; /* the search restarts at the lowest number */
        }
    }
}

/* Returns the part with the next event; *when gets the event's time. */
static const part *next_part(uint64_t *when) {
    const part *first = NULL;
    *when = CHIP_NEVER;
    for (unsigned i = 0; i < PARTS; i++) {
        const uint64_t next = parts[i]->next != NULL ? parts[i]->next() : CHIP_NEVER;
        if (next < *when) {
            first = parts[i];
            *when = next;
        }
    }
    return first;
}

static void run_until(uint64_t until) {
    for (;;) {
        uint64_t next = 0;
        const part *first = next_part(&next);
        const uint64_t soonest = next < until ? next : until;
        if (chip.trying && soonest >= chip.power_at) {
            chip.now = chip.power_at > chip.now ? chip.power_at : chip.now;
            chip.power_at = CHIP_NEVER;
            leave(CHIP_POWER_OFF);
        }
        if (next > until || first == NULL) {
            chip.quiet_until = next < chip.power_at ? next : chip.power_at;
            break;
        }
        chip.now = soonest > chip.now ? soonest : chip.now;
        first->happens();
        take_interrupts();
    }
    chip.now = until > chip.now ? until : chip.now;
}

void chip_pass(uint64_t units) {
    const uint64_t until = chip.now + units;
    chip.quiet_until = 0;
    take_interrupts();
    run_until(until);
    take_interrupts();
}
void chip_pass_us(uint64_t us) { chip_pass(us * CHIP_UNITS_PER_US); }

/* Lets the time of a register access, and of the code around it, pass. While the flash is busy, the core waits for
 * instructions and takes no interrupt. */
static void time_passes(void) {
    if (flash_busy()) {
        run_until(flash_busy_until());
    }
    const uint32_t hertz = core_Hz();
    const uint64_t until =
        chip.now + world.access_cycles * (CHIP_UNITS_PER_S / (hertz > 0 ? hertz : 1000000U));
    if (!chip.handling) {
        chip.handled = 0;
    }
    if (until < chip.quiet_until) {
        chip.now = until;
    } else {
        run_until(until);
        take_interrupts();
    }
    if (chip.trying && chip.now - chip.begun > chip.may_take) {
        leave(CHIP_HANGS);
    }
}

static const part *part_at(uint32_t address) {
    for (unsigned i = 0; i < PARTS; i++) {
        if (address - parts[i]->base < parts[i]->bytes) {
            return parts[i];
        }
    }
    return NULL;
}

/* Returns the part at this address. An access that is not allowed is a violation. */
static const part *reached(uint32_t address, const char *how) {
    const part *which = part_at(address);
    if (which == NULL) {
        forbidden("%s of 0x%08x, where nothing is", how, address);
    } else if (address % 4U != 0) {
        forbidden("%s of 0x%08x, no word", how, address);
        which = NULL;
    } else if (!part_is_clocked(which)) {
        forbidden("%s of %s + 0x%02x, which has no clock", how, which->name, address - which->base);
        which = NULL;
    }
    return which;
}

uint32_t reg_load(uint32_t address) {
    time_passes();
    const part *which = reached(address, "load");
    return which != NULL ? which->load(address - which->base) : 0;
}

void reg_store(uint32_t address, uint32_t value) {
    time_passes();
    if (chip.power_ends && chip.stores == chip.power_after) {
        chip.power_ends = false;
        leave(CHIP_POWER_OFF);
    }
    chip.stores++;
    const part *which = reached(address, "store");
    if (which != NULL) {
        which->store(address - which->base, value);
    }
    if (chip_stored != NULL) {
        chip_stored();
    }
    chip.quiet_until = 0;
    take_interrupts();
}

uint32_t reg_hold(void) {
    const uint32_t before = chip.masked ? 1U : 0U;
    chip.masked = true;
    return before;
}

bool chip_is_masked(void) { return chip.masked; }

void reg_go_on(uint32_t before) {
    chip.masked = (before & 1U) != 0;
    chip.quiet_until = 0;
    take_interrupts();
}

/* Memories that DMA uses. Each gets a 32-bit address of the chip, because this machine's addresses may be longer. */
#define MEMORIES 8U
#define MEMORY_BYTES 0x4000U
static volatile void *memories[MEMORIES];
uint32_t reg_address(volatile void *memory) {
    for (unsigned i = 0; i < MEMORIES; i++) {
        if (memories[i] == NULL || memories[i] == memory) {
            memories[i] = memory;
            return AT_RAM + i * MEMORY_BYTES;
        }
    }
    forbidden("more memories than the played chip has");
    return 0;
}

volatile void *memory_at(uint32_t address) {
    const uint32_t at = (address - AT_RAM) / MEMORY_BYTES;
    return at < MEMORIES && (address - AT_RAM) % MEMORY_BYTES == 0 ? memories[at] : NULL;
}

/* --- NVIC, SCB (Armv7-M Architecture Reference Manual, B3.4, B3.2) ------------------------------------ */
static uint32_t nvic_load(uint32_t offset) {
    const uint32_t i = (offset % 0x80U) / 4U;
    return offset < 0x100U && i < 3   ? chip.enabled[i]
           : offset < 0x200U && i < 3 ? chip.set_pending[i]
                                      : 0;
}
static void nvic_store(uint32_t offset, uint32_t value) {
    const uint32_t i = (offset % 0x80U) / 4U;
    if (offset >= 0x300U) {
        return; /* priorities are ignored, because all drivers have the same */
    }
    if (i >= 3 || (i == 2 && (value >> (INTERRUPTS - 64U)) != 0)) {
        forbidden("an interrupt that there is none of");
        return;
    }
    switch (offset / 0x80U) {
    case 0: chip.enabled[i] |= value; break;
    case 1: chip.enabled[i] &= ~value; break;
    case 2: chip.set_pending[i] |= value; break;
    case 3: chip.set_pending[i] &= ~value; break;
    default: forbidden("store of NVIC + 0x%03x", offset); break;
    }
}
static void nvic_reset(void) {
    memset(chip.enabled, 0, sizeof chip.enabled);
    memset(chip.set_pending, 0, sizeof chip.set_pending);
    chip.masked = false;
    chip.handling = false;
    chip.nmi_taken = false;
}
unsigned long chip_interrupts(unsigned number) {
    return number < INTERRUPTS ? chip.taken[number] : 0;
}

#define AIRCR 0x0CU
static uint32_t scb_load(uint32_t offset) { return offset == AIRCR ? 0xFA050000U : 0; }
static void scb_store(uint32_t offset, uint32_t value) {
    if (offset == AIRCR) {
        if (value >> 16 != 0x05FAU) {
            forbidden("AIRCR without its key");
        } else if ((value & BIT(2)) != 0) {
            core_resets(CHIP_BY_SOFTWARE);
        }
    }
}

const part nvic_part = {.name = "NVIC",
                        .base = AT_NVIC,
                        .bytes = 0x400,
                        .load = nvic_load,
                        .store = nvic_store,
                        .reset = nvic_reset};
const part scb_part = {
    .name = "SCB", .base = AT_SCB, .bytes = 0x90, .load = scb_load, .store = scb_store};

/* --- DEMCR, DWT's cycle counter (Armv7-M Architecture Reference Manual, C1.6.5, C1.8) -------------------- */
#define DEMCR 0x0CU
#define DWT_CTRL 0x00U
#define DWT_CYCCNT 0x04U
#define DWT_LAR 0xFB0U /* lock access register: no effect on a Cortex-M4 */
static struct {
    uint32_t demcr, ctrl, count; /* count is the counter's value at the time `since` */
    uint64_t since;
} trace;

static uint32_t core_debug_load(uint32_t offset) { return offset == DEMCR ? trace.demcr : 0; }
static void core_debug_store(uint32_t offset, uint32_t value) {
    if (offset == DEMCR) {
        trace.demcr = value;
    } else {
        forbidden("store of the core's debug registers + 0x%02x", offset);
    }
}
static uint32_t cycles_now(void) {
    const bool counts = (trace.ctrl & BIT(0)) != 0 && world.counter == CHIP_COUNTS;
    return trace.count + (counts ? (uint32_t)((chip.now - trace.since) / units_of(core_Hz())) : 0);
}
static bool is_traced(void) {
    forbid_if((trace.demcr & BIT(24)) == 0, "DWT without TRCENA");
    return (trace.demcr & BIT(24)) != 0;
}
static uint32_t dwt_load(uint32_t offset) {
    if (!is_traced()) {
        return 0;
    }
    return offset == DWT_CTRL
               ? 0x40000000U | (world.counter == CHIP_NO_COUNTER ? BIT(25) : 0) | trace.ctrl
           : offset == DWT_CYCCNT ? cycles_now()
                                  : 0;
}
static void dwt_store(uint32_t offset, uint32_t value) {
    if (!is_traced() || offset == DWT_LAR) {
        return;
    }
    const uint32_t count = offset == DWT_CYCCNT ? value : cycles_now();
    if (offset == DWT_CTRL) {
        trace.ctrl = value & BIT(0);
    } else if (offset != DWT_CYCCNT) {
        forbidden("store of DWT + 0x%03x", offset);
    }
    trace.count = count;
    trace.since = chip.now;
}
static void trace_reset(void) {
    if (reset_by == CHIP_BY_POWER) {
        memset(&trace, 0, sizeof trace);
    }
}
const part core_debug_part = {.name = "core debug",
                              .base = AT_CORE_DEBUG,
                              .bytes = 0x10,
                              .load = core_debug_load,
                              .store = core_debug_store};
const part dwt_part = {.name = "DWT",
                       .base = AT_DWT,
                       .bytes = 0x1000,
                       .load = dwt_load,
                       .store = dwt_store,
                       .reset = trace_reset};

unsigned chip_resets(void) { return chip.resets; }

void chip_new(uint64_t seed) {
    memset(&chip, 0, sizeof chip);
    chip.random = seed * 2654435761U + 88172645463325252U;
    chip.now = drawn() % CHIP_UNITS_PER_S;
    chip.power_at = CHIP_NEVER;
    chip.may_take = 5U * CHIP_UNITS_PER_S;
    chip_stored = NULL;
    memset(memories, 0, sizeof memories);
    world = (chip_world){.crystal_Hz = 25000000U,
                         .crystal = true,
                         .crystal_units = 2000U * CHIP_UNITS_PER_US,
                         .pll = true,
                         .watchdog_Hz = 32000,
                         .halt_disables = true,
                         .volts = NULL,
                         .vdda_V = 3.3,
                         .access_cycles = 8};
    flash_new();
    pins_new();
    usart_new();
    iwdg_new();
    tim1_new();
}

void chip_reset(chip_cause cause) {
    chip.resets++;
    reset_by = cause;
    chip.quiet_until = 0;
    flash_power_goes();
    for (unsigned i = 0; i < PARTS; i++) {
        if (parts[i]->reset != NULL) {
            parts[i]->reset();
        }
    }
    pins_changed();
}
