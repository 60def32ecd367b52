/* test_f405_clock.c: how the STM32F405's clocks are set up, on registers that answer as RM0090, 7.2, 7.3 and 3.5.1 say, or do
 * not: whatever is broken, the start ends, and the core never runs faster than flash and buses can. */
#include "boards/stm32f4/rm0090.h"
#include "tests/host/fake_registers.h"
#include "tests/scattered.h"
#include "unity.h"

void suite_f405_clock(void);

/* boards/cortexm/cortexm.h, which a board's data comes with. */
enum { CRYSTAL, FALLBACK, GIVEN };
void board_clock_start(void);
extern unsigned board_clock_is;

#define CRYSTAL_MHz 25U /* the data that the driver is compiled with: boards/netduinoplus2 */
#define LOADS_MOST 60000UL

static struct {
    bool there; /* an emulator has none */
    bool crystal;
    bool pll;
    bool turns;   /* the switch does what it is told */
    bool latency; /* the flash's register takes a value */
} unit;

static uint32_t ready(uint32_t value, uint32_t on, uint32_t flag, bool works) {
    return (value & on) != 0 && works ? value | flag : value & ~flag;
}

static uint32_t load(uint32_t address) {
    if (!unit.there && address >= RCC && address < RCC + 0x80U) {
        return 0;
    }
    return fake_get(address);
}

static unsigned divider(unsigned bits) { return (bits & 4U) != 0 ? 2U << (bits & 3U) : 1U; }

/* What runs the core by now, MHz. */
static unsigned core_MHz(void) {
    const uint32_t pll = fake_get(RCC_PLLCFGR);
    if ((fake_get(RCC_CFGR) & RCC_CFGR_SWS) != RCC_CFGR_SWS_PLL) {
        return 16;
    }
    const unsigned m = pll & 63U;
    const unsigned n = pll >> 6 & 511U;
    const unsigned p = 2U * ((pll >> 16 & 3U) + 1U);
    TEST_ASSERT_TRUE_MESSAGE((pll & RCC_PLLCFGR_HSE) != 0, "the crystal drives the loop");
    TEST_ASSERT_TRUE_MESSAGE(m >= 2 && CRYSTAL_MHz >= m && CRYSTAL_MHz <= 2U * m,
                             "1 to 2 MHz are compared");
    TEST_ASSERT_TRUE_MESSAGE(CRYSTAL_MHz * n >= 100U * m && CRYSTAL_MHz * n <= 432U * m,
                             "the loop's range");
    return CRYSTAL_MHz * n / m / p;
}

static void look_at_speeds(void) {
    const unsigned core = core_MHz();
    const uint32_t cfgr = fake_get(RCC_CFGR);
    TEST_ASSERT_TRUE_MESSAGE(core <= 168U, "the core");
    TEST_ASSERT_TRUE_MESSAGE(core / divider(cfgr >> 10 & 7U) <= 42U, "APB1");
    TEST_ASSERT_TRUE_MESSAGE(core / divider(cfgr >> 13 & 7U) <= 84U, "APB2");
    TEST_ASSERT_TRUE_MESSAGE(core <= 30U * ((fake_get(FLASH_ACR) & 7U) + 1U), "wait states");
    TEST_ASSERT_TRUE_MESSAGE(core <= 144U || (fake_get(PWR_CR) & PWR_CR_VOS) != 0,
                             "the regulator's scale");
}

static void store(uint32_t address, uint32_t value) {
    if (address == RCC_CR) {
        uint32_t now = value;
        if ((fake_get(RCC_CFGR) & RCC_CFGR_SWS) == RCC_CFGR_SWS_PLL) {
            now |= RCC_CR_PLLON; /* what the core runs on cannot be switched off */
        }
        now = ready(now, RCC_CR_HSION, RCC_CR_HSIRDY, true);
        now = ready(now, RCC_CR_HSEON, RCC_CR_HSERDY, unit.crystal);
        now = ready(now, RCC_CR_PLLON, RCC_CR_PLLRDY, unit.pll);
        fake_put(address, now);
    } else if (address == RCC_CFGR) {
        const uint32_t before = fake_get(RCC_CFGR) & RCC_CFGR_SWS;
        const bool to_pll = (value & RCC_CFGR_SW) == RCC_CFGR_SW_PLL;
        TEST_ASSERT_TRUE_MESSAGE(!to_pll || (fake_get(RCC_CR) & RCC_CR_PLLRDY) != 0,
                                 "the loop is ready");
        const uint32_t after = !to_pll ? RCC_CFGR_SWS_HSI : unit.turns ? RCC_CFGR_SWS_PLL : before;
        fake_put(address, (value & ~RCC_CFGR_SWS) | after);
    } else if (address == RCC_PLLCFGR) {
        TEST_ASSERT_TRUE_MESSAGE((fake_get(RCC_CR) & RCC_CR_PLLON) == 0,
                                 "set up while the loop is off");
        fake_put(address, value);
    } else if (address != FLASH_ACR || unit.latency) {
        fake_put(address, value);
    }
    if (unit.there) {
        look_at_speeds();
    }
}

static bool draw(void) { return scattered() >> 62 != 0; }

/* What a reset leaves, or a loader that ran on the loop from the same crystal. */
static void leave(bool loader) {
    fake_start(load, store);
    fake_put(RCC_CR, RCC_CR_HSION | RCC_CR_HSIRDY);
    if (loader) {
        fake_put(RCC_CR,
                 fake_get(RCC_CR) | RCC_CR_HSEON | RCC_CR_HSERDY | RCC_CR_PLLON | RCC_CR_PLLRDY);
        fake_put(RCC_PLLCFGR, 25U | RCC_PLLCFGR_N(240U) | 1U << 16 | RCC_PLLCFGR_HSE |
                                  RCC_PLLCFGR_Q(5U)); /* 60 MHz */
        fake_put(RCC_CFGR, RCC_CFGR_SW_PLL | RCC_CFGR_SWS_PLL | 4U << 10);
        fake_put(FLASH_ACR, 1U);
    }
}

static void test_whatever_answers(void) {
    scattered_state = 20251125U;
    for (unsigned i = 0; i < 200; i++) {
        unit.there = true;
        unit.crystal = draw();
        unit.pll = draw();
        unit.turns = draw();
        unit.latency = draw();
        leave(scattered() >> 63 != 0);
        board_clock_start();
        const bool all = unit.crystal && unit.pll && unit.turns && unit.latency;
        TEST_ASSERT_EQUAL_UINT(all ? CRYSTAL : FALLBACK, board_clock_is);
        TEST_ASSERT_EQUAL_UINT(all ? 168U : 16U, core_MHz());
        TEST_ASSERT_TRUE(fake.loads < LOADS_MOST);
        TEST_ASSERT_TRUE_MESSAGE(!all || (fake_get(RCC_CR) & RCC_CR_CSSON) != 0,
                                 "the crystal is watched");
        TEST_ASSERT_TRUE_MESSAGE(all || (fake_get(RCC_CR) & (RCC_CR_HSEON | RCC_CR_PLLON)) == 0,
                                 "what failed is off");
    }
}

static void test_without_the_unit(void) {
    unit.there = false;
    leave(false);
    board_clock_start();
    TEST_ASSERT_EQUAL_UINT(GIVEN, board_clock_is);
    TEST_ASSERT_TRUE(fake.loads < LOADS_MOST);
}

void suite_f405_clock(void) {
    RUN_TEST(test_whatever_answers);
    RUN_TEST(test_without_the_unit);
}
