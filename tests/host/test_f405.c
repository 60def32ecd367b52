/* test_f405.c: clock setup of the STM32F405, on registers that follow RM0090, 7.2, 7.3 and 3.5.1, or fail. With any
 * fault the start ends, and the core never runs faster than flash and buses allow. */
#include "boards/stm32f4/rm0090.h"
#include "hal/motor.h"
#include "hal/settings.h"
#include "hal/slots.h"
#include "hal/watchdog.h"
#include "test.h"
#include "tests/host/fake_registers.h"
#include "tests/scattered.h"

/* === f405 clock =============================================================================== */

/* boards/cortexm/cortexm.h; comes with a board's data. */
enum { CRYSTAL, FALLBACK, GIVEN };
void board_clock_start(void);
extern unsigned board_clock_is;

#define CRYSTAL_MHz 25U /* the driver's compile-time data: boards/netduinoplus2 */
#define LOADS_MOST 60000UL

static struct {
    bool there; /* absent in an emulator */
    bool crystal;
    bool pll;
    bool turns;   /* the switch works */
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

/* Current clock of the core, MHz. */
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
            now |= RCC_CR_PLLON; /* the core's clock source cannot be switched off */
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

/* State after a reset, or after a loader that used the PLL with the same crystal. */
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

TEST(f405_clock, whatever_answers) {
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

TEST(f405_clock, without_the_unit) {
    unit.there = false;
    leave(false);
    board_clock_start();
    TEST_ASSERT_EQUAL_UINT(GIVEN, board_clock_is);
    TEST_ASSERT_TRUE(fake.loads < LOADS_MOST);
}

/* === f405 motor =============================================================================== */
/* The motor driver on a timer with outputs as in RM0090 (17.4.18 and table 94): random orders and breaks, with the pins
 * checked after each. */

void stm32f4_motor_start(void);

#define BDTR TIM_BDTR(TIM1)
#define LOCKED \
    (3U << 8 | TIM_BDTR_OSSI | TIM_BDTR_OSSR | TIM_BDTR_BKE | 1U << 13 | 1U << 14 | 0xFFU)
#define BREAK_PIN PIN('A', 6)
#define ENABLE_PIN PIN('B', 14)

static bool pressed;
static float supply_V;
static uint32_t odr[3];

float hal_motor_supply_V(void) { return supply_V; }

/* The break is level-sensitive: it clears MOE at once, and MOE cannot be set meanwhile (17.3.12). */
static void see_break(void) {
    if (pressed && (fake_get(BDTR) & TIM_BDTR_BKE) != 0) {
        fake_put(BDTR, fake_get(BDTR) & ~TIM_BDTR_MOE);
        fake_put(TIM_SR(TIM1), fake_get(TIM_SR(TIM1)) | TIM_SR_BIF);
    }
}

static void store_f405_motor(uint32_t address, uint32_t value) {
    if (address == BDTR) {
        const uint32_t held = (fake_get(BDTR) & 3U << 8) != 0 ? LOCKED : 0U;
        fake_put(BDTR, (fake_get(BDTR) & held) | (value & ~held));
    } else if (address == TIM_SR(TIM1)) {
        fake_put(address, fake_get(address) & value); /* a zero clears */
    } else if (address == GPIO_BSRR(0) || address == GPIO_BSRR(1)) {
        const unsigned port = address == GPIO_BSRR(1) ? 1U : 0U;
        odr[port] = (odr[port] & ~(value >> 16)) | (value & 0xFFFFU);
    } else {
        fake_put(address, value);
    }
    see_break();
}

static uint32_t load_f405_motor(uint32_t address) {
    return address == GPIO_IDR(0) && !pressed ? 1U << BREAK_PIN % 16U
           : address == GPIO_IDR(0)           ? 0U
                                              : fake_get(address);
}

static unsigned mode_of(unsigned pin) {
    return fake_get(GPIO_MODER(pin / 16U)) >> 2U * (pin % 16U) & 3U;
}

static bool enabled(void) {
    return mode_of(ENABLE_PIN) == 1U && (odr[ENABLE_PIN / 16U] >> ENABLE_PIN % 16U & 1U) != 0;
}

/* Duty of PB13; -1: floating. */
static double output(void) {
    const uint32_t bdtr = fake_get(BDTR);
    const uint32_t ccer = fake_get(TIM_CCER(TIM1));
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, ccer & ~TIM_CCER_CC1NE,
                                    "the complementary output alone, not inverted");
    TEST_ASSERT_EQUAL_UINT(2U, mode_of(PIN('B', 13)));
    TEST_ASSERT_EQUAL_UINT(1U, fake_get(GPIO_AFR(1, 1)) >> 20 & 15U);
    if ((bdtr & TIM_BDTR_MOE) == 0) {
        const bool idle_high = (fake_get(TIM_CR2(TIM1)) & TIM_CR2_OIS1N) != 0;
        return (bdtr & TIM_BDTR_OSSI) == 0 ? -1.0 : idle_high ? 1.0 : 0.0;
    }
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(TIM_CCMR_OC1M_PWM_1, fake_get(TIM_CCMR(TIM1, 0)),
                                    "PWM mode 1, no preload");
    const double period = fake_get(TIM_ARR(TIM1)) + 1.0;
    const double high = fake_get(TIM_CCR(TIM1, 1U));
    return high > period ? 1.0 : high / period;
}

static double uniform(void) { return (double)(scattered() >> 11) * 0x1p-53; }

static void start(void) {
    fake_start(load_f405_motor, store_f405_motor);
    pressed = false;
    odr[0] = odr[1] = 0;
    supply_V = 24.0f;
    stm32f4_motor_start();
}

TEST(f405_motor, starts_off) {
    scattered_state = 3;
    start();
    TEST_ASSERT_TRUE(!enabled() && output() >= 0.0 && output() <= 0.0);
    TEST_ASSERT_TRUE_MESSAGE((fake_get(DBGMCU_APB2_FZ) & DBGMCU_APB2_FZ_TIM1) != 0,
                             "off while a debugger halts");
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, fake_get(BDTR) & (1U << 13 | 1U << 14),
                                    "active low, and never on by itself");
    TEST_ASSERT_TRUE((fake_get(BDTR) & TIM_BDTR_BKE) != 0 && (fake_get(BDTR) & 3U << 8) != 0);
    for (unsigned i = 0; i < fake.stores; i++) {
        TEST_ASSERT_TRUE_MESSAGE(fake.stored[i].address != BDTR ||
                                     (fake.stored[i].value & TIM_BDTR_MOE) == 0,
                                 "never driven");
    }
    const double frequency =
        168e6 / (fake_get(TIM_ARR(TIM1)) + 1.0) / (fake_get(TIM_PSC(TIM1)) + 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 20e3, frequency);
}

/* Random orders and breaks: the output is the last order of a started motor, otherwise low. After a break it is low
 * until off is ordered. */
TEST(f405_motor, orders_and_breaks) {
    scattered_state = 7;
    start();
    bool driving = false;
    bool cut = false;
    bool seen = false; /* pressed since the last off */
    for (unsigned i = 0; i < 20000; i++) {
        const unsigned what = (unsigned)(scattered() >> 61);
        const unsigned before = fake.stores = 0;
        double wanted = -1.0;
        if (what < 2) {
            const unsigned says = hal_motor_start();
            cut = cut || (!driving && seen);
            wanted = driving ? output() : 0.0;
            driving = true;
            TEST_ASSERT_EQUAL((pressed ? HAL_MOTOR_FAULT : 0) | (cut ? HAL_MOTOR_CUT : 0) |
                                  (supply_V > 0.0f ? 0 : HAL_MOTOR_NO_SUPPLY),
                              says);
        } else if (what < 4) {
            const double part = uniform() * 1.4 - 0.2;
            const float volts = what == 3 && part < 0.0 ? NAN : (float)(part * 24.0);
            supply_V = part > 1.1 ? 0.0f : 24.0f;
            hal_motor_set_voltage(volts);
            wanted = !driving || cut || !(volts > 0.0f) || !(supply_V > 0.0f) ? 0.0
                     : volts / supply_V > 1.0f                                ? 1.0
                                               : (double)(volts / supply_V);
        } else if (what < 6) {
            const hal_motor_off_way way = what == 4 ? HAL_MOTOR_COAST : HAL_MOTOR_BRAKE;
            hal_motor_off(way);
            TEST_ASSERT_TRUE_MESSAGE(fake.stored[before].address == BDTR &&
                                         (fake.stored[before].value & TIM_BDTR_MOE) == 0,
                                     "the output is the first to be off");
            driving = false;
            cut = false;
            seen = pressed;
            wanted = 0.0;
            TEST_ASSERT_TRUE(enabled() == (way == HAL_MOTOR_BRAKE));
        } else {
            pressed = !pressed && what == 6;
            see_break();
            seen = seen || pressed;
            cut = cut || (driving && pressed);
            wanted = cut || !driving ? 0.0 : output();
        }
        TEST_ASSERT_DOUBLE_WITHIN(1.0 / 8400.0, wanted, output());
        TEST_ASSERT_TRUE(!driving || cut || enabled());
        TEST_ASSERT_TRUE(((hal_motor_status() & HAL_MOTOR_CUT) != 0) == (driving && cut));
        TEST_ASSERT_TRUE(((hal_motor_status() & HAL_MOTOR_FAULT) != 0) == pressed);
    }
}

/* === f405 parts =============================================================================== */
/* Watchdog, flash and captures of the STM32F405, on registers that follow RM0090 (21.4, 3.6, 18.4). */

void stm32f4_slots_start(void);
void on_tim2(void);

static unsigned below(unsigned limit) { return (unsigned)(scattered() >> 33) % limit; }

/* --- watchdog: an oscillator of 17 to 47 kHz ------------------------------------------------------- */

static bool unlocked;

static void watch(uint32_t address, uint32_t value) {
    if (address == IWDG_KR) {
        unlocked = value == IWDG_KR_UNLOCK;
    } else if (address == IWDG_PR || address == IWDG_RLR) {
        TEST_ASSERT_TRUE_MESSAGE(unlocked, "the key before");
    }
    fake_put(address, value);
}

TEST(f405_parts, bites_in_time) {
    scattered_state = 11;
    for (unsigned i = 0; i < 2000; i++) {
        const uint32_t ticks = i == 0 ? 20000U : 1000U + below(8000000U);
        fake_start(NULL, watch);
        hal_watchdog_start(ticks);
        const double clocks = (fake_get(IWDG_RLR) + 1.0) * (4U << fake_get(IWDG_PR));
        TEST_ASSERT_TRUE(fake_get(IWDG_RLR) <= 4095U && fake_get(IWDG_PR) <= 6U);
        TEST_ASSERT_TRUE_MESSAGE(clocks / 47e3 >= ticks * 1e-6, "never before its time");
        TEST_ASSERT_TRUE_MESSAGE((clocks - 1.0 - 2.0 * (4U << fake_get(IWDG_PR))) / 47e3 <=
                                     ticks * 1e-6,
                                 "no later than that");
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(IWDG_KR_RELOAD, fake_get(IWDG_KR), "begins with the whole");
        TEST_ASSERT_EQUAL_UINT32(0, fake_get(DBGMCU_APB1_FZ) & DBGMCU_APB1_FZ_IWDG);
    }
}

/* --- flash: sectors 1 and 2 ------------------------------------------------------------------------- */

#define SETTINGS 0x08004000U
#define SECTOR 0x4000U
#define WORDS (HAL_SETTINGS_BYTES / 4U)

static uint32_t flash[2][WORDS];
static unsigned keys;
static unsigned busy;
static bool fails;

static void act(void) {
    const uint32_t cr = fake_get(FLASH_CR);
    if ((cr & FLASH_CR_STRT) != 0) {
        const unsigned sector = cr >> 3 & 15U;
        TEST_ASSERT_TRUE_MESSAGE((cr & FLASH_CR_SER) != 0 && (sector == 1 || sector == 2),
                                 "a settings' sector");
        memset(flash[sector - 1U], 0xFF, sizeof flash[0]);
        busy = 1 + below(50);
        fake_put(FLASH_SR, fake_get(FLASH_SR) | (fails ? 1U << 4 : 0U));
    }
}

static void flash_store(uint32_t address, uint32_t value) {
    if (address >= SETTINGS && address < SETTINGS + 2U * SECTOR) {
        const uint32_t offset = (address - SETTINGS) % SECTOR;
        TEST_ASSERT_TRUE_MESSAGE(keys == 2 && busy == 0 && (fake_get(FLASH_CR) & FLASH_CR_PG) != 0,
                                 "programming is on");
        TEST_ASSERT_TRUE_MESSAGE(
            (fake_get(FLASH_CR) & 3U << 8) == FLASH_CR_PSIZE_32 && offset % 4U == 0, "a word");
        TEST_ASSERT_TRUE(offset / 4U < WORDS);
        flash[(address - SETTINGS) / SECTOR][offset / 4U] &= value;
        busy = 1 + below(5);
        fake_put(FLASH_SR, fake_get(FLASH_SR) | (fails ? 1U << 4 : 0U));
        return;
    }
    TEST_ASSERT_TRUE_MESSAGE(address < 0x08000000U || address >= 0x08100000U,
                             "no other part of the flash");
    if (address == FLASH_KEYR) {
        keys = keys == 0 && value == FLASH_KEY1 ? 1U : keys == 1 && value == FLASH_KEY2 ? 2U : 3U;
    } else if (address == FLASH_SR) {
        fake_put(address, fake_get(address) & ~value);
    } else if (address == FLASH_CR) {
        TEST_ASSERT_TRUE_MESSAGE(busy == 0 && keys == 2, "unlocked, and at rest");
        fake_put(address, value & ~FLASH_CR_STRT);
        if ((value & FLASH_CR_LOCK) != 0) {
            keys = 0;
        } else {
            fake_put(address, value);
            act();
        }
    } else {
        fake_put(address, value);
    }
}

static uint32_t flash_load(uint32_t address) {
    if (address >= SETTINGS && address < SETTINGS + 2U * SECTOR) {
        TEST_ASSERT_EQUAL_UINT_MESSAGE(0, busy, "read at rest");
        return flash[(address - SETTINGS) / SECTOR][(address - SETTINGS) % SECTOR / 4U];
    }
    if (address == FLASH_SR && busy > 0) {
        busy--;
        return fake_get(address) | FLASH_SR_BSY;
    }
    return fake_get(address);
}

TEST(f405_parts, settings_are_kept) {
    uint8_t kept[2][HAL_SETTINGS_BYTES];
    uint8_t bytes[HAL_SETTINGS_BYTES];
    scattered_state = 13;
    fake_start(flash_load, flash_store);
    memset(flash, 0, sizeof flash);
    memset(kept, 0, sizeof kept);
    keys = busy = 0;
    for (unsigned i = 0; i < 2000; i++) {
        const unsigned slot = below(2);
        const unsigned at = 4U * below(WORDS);
        const unsigned count = below(HAL_SETTINGS_BYTES - at + 1U);
        fails = false;
        TEST_ASSERT_EQUAL(HAL_SETTINGS_DONE, hal_settings_erase(slot));
        memset(kept[slot], 0xFF, sizeof kept[0]);
        for (unsigned k = 0; k < count; k++) {
            bytes[k] = kept[slot][at + k] = (uint8_t)scattered();
        }
        TEST_ASSERT_EQUAL(HAL_SETTINGS_DONE, hal_settings_write(slot, at, bytes, count));
        for (unsigned s = 0; s < 2; s++) {
            const unsigned from = below(HAL_SETTINGS_BYTES);
            TEST_ASSERT_EQUAL(HAL_SETTINGS_DONE,
                              hal_settings_read(s, from, bytes, HAL_SETTINGS_BYTES - from));
            TEST_ASSERT_EQUAL_INT(0, memcmp(bytes, kept[s] + from, HAL_SETTINGS_BYTES - from));
        }
        TEST_ASSERT_EQUAL_UINT_MESSAGE(0, keys, "locked again");
    }
    fails = true;
    TEST_ASSERT_EQUAL(HAL_SETTINGS_FAILED, hal_settings_erase(0));
    TEST_ASSERT_EQUAL(HAL_SETTINGS_FAILED, hal_settings_write(1, 0, bytes, 8));
    fails = false;
    TEST_ASSERT_EQUAL_MESSAGE(HAL_SETTINGS_DONE, hal_settings_erase(0),
                              "an old error is none of this");
    const hal_settings_result outside[] = {
        hal_settings_erase(2), hal_settings_write(0, 2, bytes, 4),
        hal_settings_write(0, 252, bytes, 8), hal_settings_read(2, 0, bytes, 1),
        hal_settings_write(0, 256, bytes, 4)};
    for (unsigned i = 0; i < sizeof outside / sizeof *outside; i++) {
        TEST_ASSERT_EQUAL(HAL_SETTINGS_OUTSIDE, outside[i]);
    }
    busy = UINT32_MAX; /* stays busy */
    TEST_ASSERT_EQUAL(HAL_SETTINGS_BUSY, hal_settings_erase(0));
    TEST_ASSERT_EQUAL(HAL_SETTINGS_BUSY, hal_settings_write(0, 0, bytes, 4));
    busy = 0;
}

/* --- captures: timer 2, both pairs of channels ------------------------------------------------------------ */

static uint32_t capture_load(uint32_t address) {
    for (unsigned channel = 1; channel <= 4; channel++) {
        if (address == TIM_CCR(TIM2, channel)) {
            fake_put(TIM_SR(TIM2), fake_get(TIM_SR(TIM2)) & ~TIM_SR_CCIF(channel));
        }
    }
    return fake_get(address);
}

static void capture_store(uint32_t address, uint32_t value) {
    fake_put(address, address == TIM_SR(TIM2) ? fake_get(address) & value : value);
}

static const uint8_t inputs[2] = {1, 3}; /* of the Netduino Plus 2 */

/* CCxS (18.4.7): 1 for its own input, 2 for the other input of its pair; CCxP: falling. */
static void edge(unsigned sensor, hal_slot_end end, uint32_t ticks) {
    const unsigned channel = ((inputs[sensor] - 1U) ^ end) + 1U;
    const uint32_t status = fake_get(TIM_SR(TIM2));
    const uint32_t on = fake_get(TIM_CCER(TIM2)) >> 4U * (channel - 1U) & 0xFU;
    const uint32_t of = fake_get(TIM_CCMR(TIM2, (channel - 1U) / 2U)) >> 8U * ((channel - 1U) % 2U);
    TEST_ASSERT_EQUAL_MESSAGE(end == HAL_SLOT_LEADING ? 1U : 3U, on, "the edge");
    TEST_ASSERT_EQUAL_MESSAGE(end == HAL_SLOT_LEADING ? 1U : 2U, of & 3U, "the input");
    fake_put(TIM_SR(TIM2), status | TIM_SR_CCIF(channel) |
                               ((status & TIM_SR_CCIF(channel)) != 0 ? TIM_SR_CCOF(channel) : 0U));
    fake_put(TIM_CCR(TIM2, channel), ticks);
}

static void interrupt(void) {
    if ((fake_get(TIM_SR(TIM2)) & fake_get(TIM_DIER(TIM2))) != 0) {
        on_tim2();
    }
}

/* Random edges, up to four before the interrupt: each is reported once, in order of time, across wraps. */
TEST(f405_parts, captures_in_order) {
    hal_slot_edge got;
    uint32_t ticks = 0xFFF00000U;
    scattered_state = 17;
    fake_start(capture_load, capture_store);
    stm32f4_slots_start();
    const uint32_t overruns = hal_slots_overruns();
    for (unsigned i = 0; i < 20000; i++) {
        unsigned left = 0xFU; /* two sensors with two ends each */
        hal_slot_edge made[4];
        const unsigned count = 1U + below(4);
        for (unsigned k = 0; k < count; k++) {
            unsigned one = below(4);
            while ((left >> one & 1U) == 0) {
                one = (one + 1U) % 4U;
            }
            left &= ~(1U << one);
            ticks += 1U + below(k == 0 ? 3000 : 9);
            made[k] = (hal_slot_edge){ticks, (uint8_t)(one / 2U), (uint8_t)(one % 2U)};
            edge(made[k].sensor, (hal_slot_end)made[k].end, ticks);
        }
        interrupt();
        for (unsigned k = 0; k < count; k++) {
            TEST_ASSERT_TRUE(hal_slots_take(&got));
            TEST_ASSERT_TRUE(got.ticks == made[k].ticks && got.sensor == made[k].sensor &&
                             got.end == made[k].end);
        }
        TEST_ASSERT_FALSE(hal_slots_take(&got));
    }
    TEST_ASSERT_EQUAL_UINT32(overruns, hal_slots_overruns());
    edge(0, HAL_SLOT_LEADING, ++ticks); /* a second edge before the first was read */
    edge(0, HAL_SLOT_LEADING, ++ticks);
    interrupt();
    TEST_ASSERT_TRUE(hal_slots_take(&got) && got.ticks == ticks && !hal_slots_take(&got));
    TEST_ASSERT_EQUAL_UINT32(overruns + 1U, hal_slots_overruns());
}

/* A storm causes no more interrupts than there is room; the oldest edges are kept, and capture continues afterwards. */
TEST(f405_parts, storm_ends_by_itself) {
    hal_slot_edge pulse;
    uint32_t ticks = 5;
    fake_start(capture_load, capture_store);
    stm32f4_slots_start();
    const uint32_t overruns = hal_slots_overruns();
    unsigned interrupts = 0;
    for (unsigned i = 0; i < 5000; i++) {
        edge(0, (hal_slot_end)(i % 2U), ticks + i);
        interrupts += (fake_get(TIM_SR(TIM2)) & fake_get(TIM_DIER(TIM2))) != 0 ? 1U : 0U;
        interrupt();
    }
    TEST_ASSERT_TRUE(interrupts >= 16U && interrupts <= 20U);
    TEST_ASSERT_TRUE(hal_slots_overruns() > overruns);
    for (unsigned i = 0; i < interrupts; i++) {
        TEST_ASSERT_TRUE(hal_slots_take(&pulse) && pulse.ticks == ticks + i);
    }
    TEST_ASSERT_FALSE(hal_slots_take(&pulse));
    edge(1, HAL_SLOT_LEADING, 99999);
    interrupt();
    TEST_ASSERT_TRUE(hal_slots_take(&pulse) && pulse.ticks == 99999 && pulse.sensor == 1);
}
