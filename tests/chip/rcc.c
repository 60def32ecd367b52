/* rcc.c: clocks and resets of the chip model, and its supply's scale. RM0090, chapters 5 and 7; DS8626, table 14. */
#include <string.h>

#include "tests/chip/inner.h"

#define REGISTERS 34U
enum {
    CR = 0x00,
    PLLCFGR = 0x04,
    CFGR = 0x08,
    CIR = 0x0C,
    AHB1ENR = 0x30,
    APB1ENR = 0x40,
    APB2ENR = 0x44,
    CSR = 0x74
};

#define HSION BIT(0)
#define HSIRDY BIT(1)
#define HSEON BIT(16)
#define HSERDY BIT(17)
#define HSEBYP BIT(18)
#define CSSON BIT(19)
#define PLLON BIT(24)
#define PLLRDY BIT(25)
#define CSSF BIT(7)
#define CSSC BIT(23)
#define RMVF BIT(24)
#define HSI_HZ 16000000U

static struct {
    uint32_t r[REGISTERS];
    /* Times at which the clocks become ready. CHIP_NEVER: never, or already ready. */
    uint64_t hsi_at, hse_at, pll_at, lsi_at;
    uint64_t hse_gone_at; /* HSERDY falls six HSE cycles after HSEON is cleared (7.3.1) */
    bool crystal_runs, lsi_forced, vos_1;
    uint32_t core, hclk;
    /* Clock register that has just enabled a part: the next access must not go to a part of it. 0: none. */
    uint32_t enabled_late;
} rcc;

static uint32_t *reg(uint32_t offset) { return &rcc.r[offset / 4U]; }

uint64_t units_of(uint32_t hertz) {
    if (hertz == 0) {
        return CHIP_NEVER;
    }
    forbid_if(CHIP_UNITS_PER_S % hertz != 0, "a clock of %u Hz, which the played chip has not",
              hertz);
    return CHIP_UNITS_PER_S / hertz;
}

static uint32_t crystal_Hz(void) { return rcc.crystal_runs ? world.crystal_Hz : 0; }

static uint32_t pll_input(void) {
    const uint32_t m = FIELD(*reg(PLLCFGR), 0, 6);
    const uint32_t from = (*reg(PLLCFGR) & BIT(22)) != 0 ? crystal_Hz() : HSI_HZ;
    return m > 0 ? from / m : 0;
}
static uint32_t pll_Hz(void) {
    const uint32_t vco = pll_input() * FIELD(*reg(PLLCFGR), 6, 9);
    return vco / (2U * (FIELD(*reg(PLLCFGR), 16, 2) + 1U));
}

static uint32_t system_Hz(void) {
    switch (FIELD(*reg(CFGR), 2, 2)) {
    case 0: return HSI_HZ;
    case 1: return crystal_Hz();
    case 2: return pll_Hz();
    default: forbidden("SW: there is no fourth source"); return 0;
    }
}

static uint32_t divided_by(uint32_t field, bool of_core) {
    static const uint32_t core[8] = {2, 4, 8, 16, 64, 128, 256, 512};
    static const uint32_t bus[4] = {2, 4, 8, 16};
    return of_core ? (field >= 8 ? core[field - 8U] : 1U) : (field >= 4 ? bus[field - 4U] : 1U);
}
static uint32_t apb1_divider(void) { return divided_by(FIELD(*reg(CFGR), 10, 3), false); }
static uint32_t apb2_divider(void) { return divided_by(FIELD(*reg(CFGR), 13, 3), false); }

uint32_t core_Hz(void) { return rcc.hclk; }
uint32_t apb2_Hz(void) { return rcc.hclk / apb2_divider(); }
uint32_t apb1_timer_Hz(void) { return rcc.hclk / apb1_divider() * (apb1_divider() == 1 ? 1U : 2U); }
uint32_t apb2_timer_Hz(void) { return rcc.hclk / apb2_divider() * (apb2_divider() == 1 ? 1U : 2U); }
chip_clocks chip_clocks_now(void) {
    return (chip_clocks){.core_Hz = rcc.hclk,
                         .apb1_Hz = rcc.hclk / apb1_divider(),
                         .apb2_Hz = apb2_Hz(),
                         .timers1_Hz = apb2_timer_Hz(),
                         .timers2_Hz = apb1_timer_Hz()};
}
bool pll_is_on(void) { return (*reg(CR) & PLLON) != 0; }

static void clocks_are_allowed(void) {
    const chip_clocks now = chip_clocks_now();
    forbid_if(now.core_Hz > (rcc.vos_1 ? 168000000U : 144000000U), "core at %u Hz", now.core_Hz);
    forbid_if(now.apb1_Hz > 42000000U, "APB1 at %u Hz", now.apb1_Hz);
    forbid_if(now.apb2_Hz > 84000000U, "APB2 at %u Hz", now.apb2_Hz);
    flash_clock_is(now.core_Hz);
}

static void clocks_change(void) {
    timers_hold_counts();
    tim1_hold_count();
    rcc.core = system_Hz();
    rcc.hclk = rcc.core / divided_by(FIELD(*reg(CFGR), 4, 4), true);
    timers_go_on();
    tim1_go_on();
    clocks_are_allowed();
}

/* Switches the core's clock when the source that SW requests is ready. SWS reports the present source. */
static void switch_source(void) {
    static const uint32_t ready[3] = {HSIRDY, HSERDY, PLLRDY};
    const uint32_t asked = FIELD(*reg(CFGR), 0, 2);
    if (asked < 3 && (*reg(CR) & ready[asked]) != 0) {
        *reg(CFGR) = (*reg(CFGR) & ~(3U << 2)) | asked << 2;
    }
    clocks_change();
}

static bool uses(uint32_t source) {
    const uint32_t now = FIELD(*reg(CFGR), 2, 2);
    return now == source || FIELD(*reg(CFGR), 0, 2) == source ||
           (source == 1 && now == 2 && (*reg(PLLCFGR) & BIT(22)) != 0);
}

static void pll_is_allowed(void) {
    const uint32_t m = FIELD(*reg(PLLCFGR), 0, 6);
    const uint32_t n = FIELD(*reg(PLLCFGR), 6, 9);
    const uint32_t q = FIELD(*reg(PLLCFGR), 24, 4);
    const uint32_t in = pll_input();
    const uint32_t vco = in * n;
    forbid_if(m < 2, "PLLM %u", m);
    forbid_if(in < 950000U || in > 2100000U, "PLL input %u Hz", in); /* DS8626, table 38 */
    forbid_if(n < 50 || n > 432 || vco < 192000000U || vco > 432000000U,
              "PLL's oscillator at %u Hz, N %u", vco, n);
    forbid_if(pll_Hz() > 168000000U, "PLL gives %u Hz", pll_Hz());
    forbid_if(q < 2 || vco / q > 48000000U, "PLLQ %u: %u Hz", q, q > 0 ? vco / q : 0);
}

static void control(uint32_t value) {
    const uint32_t before = *reg(CR);
    uint32_t after = (before & ~(uint32_t)(HSION | 0xF8U | HSEON | HSEBYP | CSSON | PLLON)) |
                     (value & (HSION | 0xF8U | HSEON | HSEBYP | CSSON | PLLON));
    if ((before & HSEON) != 0 && (after & HSEON) == 0 && uses(1)) {
        forbidden("HSE off while it is used");
        after |= HSEON;
    }
    if ((before & PLLON) != 0 && (after & PLLON) == 0 && uses(2)) {
        forbidden("PLL off while it is used");
        after |= PLLON;
    }
    if ((before & HSION) != 0 && (after & HSION) == 0 && uses(0)) {
        forbidden("HSI off while it is used");
        after |= HSION;
    }
    *reg(CR) = after;
    const uint32_t on = after & ~before;
    const uint32_t off = before & ~after;
    if ((on & HSION) != 0) {
        rcc.hsi_at = now_units() + 4U * CHIP_UNITS_PER_US;
    }
    if ((on & HSEON) != 0) {
        rcc.hse_at = world.crystal ? now_units() + world.crystal_units : CHIP_NEVER;
    }
    if ((on & PLLON) != 0) {
        forbid_if((*reg(PLLCFGR) & BIT(22)) != 0 && (*reg(CR) & HSERDY) == 0,
                  "PLL on before its crystal is ready");
        pll_is_allowed();
        rcc.pll_at =
            world.pll ? now_units() + (75U + drawn() % 225U) * CHIP_UNITS_PER_US : CHIP_NEVER;
    }
    if ((off & HSION) != 0) {
        *reg(CR) &= ~HSIRDY;
        rcc.hsi_at = CHIP_NEVER;
    }
    forbid_if((on & HSEON) != 0 && rcc.hse_gone_at != CHIP_NEVER, "HSE on again before it is off");
    forbid_if(((on | off) & HSEBYP) != 0 && ((after & HSEON) != 0 || rcc.hse_gone_at != CHIP_NEVER),
              "HSEBYP while HSE is on");
    if ((off & HSEON) != 0) {
        rcc.hse_at = CHIP_NEVER;
        rcc.hse_gone_at =
            rcc.crystal_runs ? now_units() + 6U * units_of(world.crystal_Hz) : CHIP_NEVER;
    }
    if ((off & PLLON) != 0) {
        *reg(CR) &= ~PLLRDY;
        rcc.pll_at = CHIP_NEVER;
    }
}

static uint32_t rcc_load(uint32_t offset) {
    rcc.enabled_late = 0;
    return *reg(offset);
}

static void rcc_store(uint32_t offset, uint32_t value) {
    switch (offset) {
    case CR: control(value); break;
    case PLLCFGR:
        if (pll_is_on()) {
            forbidden("PLLCFGR while the PLL is on");
        } else {
            *reg(PLLCFGR) = value & 0x0F437FFFU;
        }
        break;
    case CFGR:
        *reg(CFGR) = (*reg(CFGR) & (3U << 2)) | (value & ~(uint32_t)(3U << 2));
        switch_source();
        break;
    case CIR: *reg(CIR) = (value & 0x7F00U) | (*reg(CIR) & 0xFFU & ~(value >> 16)); break;
    case CSR:
        if ((value & RMVF) != 0) {
            *reg(CSR) &= 0x00FFFFFFU;
        }
        *reg(CSR) = (*reg(CSR) & ~1U) | (value & 1U);
        if ((value & 1U) != 0 && (*reg(CSR) & 2U) == 0 && rcc.lsi_at == CHIP_NEVER) {
            rcc.lsi_at = now_units() + 40U * CHIP_UNITS_PER_US;
        }
        break;
    case AHB1ENR:
    case APB1ENR:
    case APB2ENR:
        rcc.enabled_late = (value & ~*reg(offset)) != 0 ? offset : 0;
        *reg(offset) = value;
        break;
    default: forbidden("store of RCC + 0x%02x", offset); break;
    }
}

static void rcc_reset(void) {
    /* Every reset of the system pulls the pin NRST low, and therefore sets PINRSTF (RM0090, figure 20). */
    static const uint32_t flags[] = {[CHIP_BY_POWER] = BIT(27) | BIT(26) | BIT(25),
                                     [CHIP_BY_DIP] = BIT(26) | BIT(25),
                                     [CHIP_BY_PIN] = BIT(26),
                                     [CHIP_BY_WATCHDOG] = BIT(29) | BIT(26),
                                     [CHIP_BY_SOFTWARE] = BIT(28) | BIT(26)};
    const uint32_t before = reset_by == CHIP_BY_POWER ? 0 : *reg(CSR) & 0xFF000000U;
    memset(&rcc, 0, sizeof rcc);
    rcc.hsi_at = rcc.hse_at = rcc.pll_at = rcc.lsi_at = rcc.hse_gone_at = CHIP_NEVER;
    *reg(CR) = 0x8083U;
    *reg(PLLCFGR) = 0x24003010U;
    *reg(AHB1ENR) = 0x00100000U;
    *reg(CSR) = before | flags[reset_by];
    rcc.vos_1 = true;
    rcc.core = rcc.hclk = HSI_HZ;
}

static uint64_t soonest(uint64_t a, uint64_t b) { return a < b ? a : b; }
static uint64_t rcc_next(void) {
    return soonest(soonest(soonest(rcc.hsi_at, rcc.hse_at), soonest(rcc.pll_at, rcc.lsi_at)),
                   rcc.hse_gone_at);
}
static void rcc_happens(void) {
    if (rcc.hsi_at <= now_units()) {
        rcc.hsi_at = CHIP_NEVER;
        *reg(CR) |= HSIRDY;
    }
    if (rcc.hse_gone_at <= now_units()) {
        rcc.hse_gone_at = CHIP_NEVER;
        rcc.crystal_runs = false;
        *reg(CR) &= ~HSERDY;
    }
    if (rcc.hse_at <= now_units()) {
        rcc.hse_at = CHIP_NEVER;
        rcc.crystal_runs = true;
        *reg(CR) |= HSERDY;
    }
    if (rcc.pll_at <= now_units()) {
        rcc.pll_at = CHIP_NEVER;
        *reg(CR) |= PLLRDY;
    }
    if (rcc.lsi_at <= now_units()) {
        rcc.lsi_at = CHIP_NEVER;
        *reg(CSR) |= 2U;
    }
    switch_source();
}

bool lsi_is_on(void) { return rcc.lsi_forced || (*reg(CSR) & 2U) != 0; }
void lsi_forced(void) { rcc.lsi_forced = true; }
bool nmi_pending(void) { return (*reg(CIR) & CSSF) != 0; }

/* Without the clock security system the chip stops, and only the watchdog resets it (RM0090, 7.2.7). */
void chip_crystal_stops(void) {
    world.crystal = false;
    if ((*reg(CR) & HSERDY) == 0) {
        return;
    }
    const bool guarded = (*reg(CR) & CSSON) != 0;
    const bool direct = FIELD(*reg(CFGR), 2, 2) == 1;
    const bool by_pll = FIELD(*reg(CFGR), 2, 2) == 2 && (*reg(PLLCFGR) & BIT(22)) != 0;
    rcc.crystal_runs = false;
    if (guarded) {
        *reg(CR) &= ~(uint32_t)(HSEON | HSERDY | CSSON);
        if (direct || by_pll) {
            *reg(CR) |= HSION | HSIRDY;
            *reg(CFGR) &= ~UINT32_C(0xF);
        }
        if ((*reg(PLLCFGR) & BIT(22)) != 0) {
            *reg(CR) &= ~(uint32_t)(PLLON | PLLRDY);
        }
        *reg(CIR) |= CSSF;
        tim1_clock_failed();
    }
    clocks_change();
}

bool part_is_clocked(const part *which) {
    if (which == &gpio_part || which->clock_register == 0) {
        return true; /* gpio.c reads the clock of each port */
    }
    if (rcc.enabled_late == which->clock_register) {
        rcc.enabled_late = 0;
        forbidden("%s is touched at once behind its clock's enable (ES0182, 2.1.13)", which->name);
    }
    return (*reg(which->clock_register) & which->clock_bit) != 0;
}

bool port_is_clocked(unsigned port);
bool port_is_clocked(unsigned port) {
    if (rcc.enabled_late == AHB1ENR) {
        rcc.enabled_late = 0;
        forbidden("port %c is touched at once behind its clock's enable (ES0182, 2.1.13)",
                  (char)('A' + port));
    }
    return (*reg(AHB1ENR) & BIT(port)) != 0;
}

const part rcc_part = {.name = "RCC",
                       .base = AT_RCC,
                       .bytes = REGISTERS * 4U,
                       .load = rcc_load,
                       .store = rcc_store,
                       .reset = rcc_reset,
                       .next = rcc_next,
                       .happens = rcc_happens};

/* --- PWR: this chip's CR has only VOS, bit 14 --- */
static uint32_t pwr[2];
static uint32_t pwr_load(uint32_t offset) { return pwr[offset / 4U] | (offset == 4 ? BIT(14) : 0); }
static void pwr_store(uint32_t offset, uint32_t value) {
    if (offset == 0 && ((value ^ pwr[0]) & BIT(14)) != 0 && pll_is_on()) {
        forbidden("VOS while the PLL is on");
        return;
    }
    pwr[offset / 4U] = value;
    rcc.vos_1 = (pwr[0] & BIT(14)) != 0;
}
static void pwr_reset(void) {
    pwr[0] = BIT(14);
    pwr[1] = 0;
}
const part pwr_part = {.name = "PWR",
                       .base = AT_PWR,
                       .bytes = 8,
                       .clock_register = APB1ENR,
                       .clock_bit = BIT(28),
                       .load = pwr_load,
                       .store = pwr_store,
                       .reset = pwr_reset};

/* --- DBGMCU: the clocks that stop while a debugger holds the core. A system reset does not reset it. --- */
static uint32_t dbgmcu[4];
static uint32_t dbgmcu_load(uint32_t offset) {
    return offset == 0 ? 0x10076413U : dbgmcu[offset / 4U];
}
static void dbgmcu_store(uint32_t offset, uint32_t value) { dbgmcu[offset / 4U] = value; }
static void dbgmcu_reset(void) {
    if (reset_by == CHIP_BY_POWER) {
        memset(dbgmcu, 0, sizeof dbgmcu);
    }
}
bool debug_stops(uint32_t offset, unsigned bit) {
    return core_halted() && (dbgmcu[offset / 4U] & BIT(bit)) != 0;
}
const part dbgmcu_part = {.name = "DBGMCU",
                          .base = AT_DBGMCU,
                          .bytes = 16,
                          .load = dbgmcu_load,
                          .store = dbgmcu_store,
                          .reset = dbgmcu_reset};
