/* test_f405_parts.c: watchdog, flash and captures of the STM32F405, on registers that do what RM0090 says (21.4, 3.6, 18.4). */
#include <string.h>

#include "boards/stm32f4/rm0090.h"
#include "hal/settings.h"
#include "hal/slots.h"
#include "hal/watchdog.h"
#include "tests/host/fake_registers.h"
#include "tests/scattered.h"
#include "unity.h"

void suite_f405_parts(void);
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

static void test_bites_in_time(void) {
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

static void test_settings_are_kept(void) {
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
    busy = UINT32_MAX; /* it does not come to rest */
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

/* CCxS (18.4.7): 1 of its own input, 2 of the other's of its pair; CCxP: falling. */
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

/* Edges at random, up to four before the interrupt comes: each once, in order of time, wraps included. */
static void test_captures_in_order(void) {
    hal_slot_edge got;
    uint32_t ticks = 0xFFF00000U;
    scattered_state = 17;
    fake_start(capture_load, capture_store);
    stm32f4_slots_start();
    const uint32_t overruns = hal_slots_overruns();
    for (unsigned i = 0; i < 20000; i++) {
        unsigned left = 0xFU; /* of the two sensors' two ends each */
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
    edge(0, HAL_SLOT_LEADING, ++ticks); /* one before the one ahead of it was read */
    edge(0, HAL_SLOT_LEADING, ++ticks);
    interrupt();
    TEST_ASSERT_TRUE(hal_slots_take(&got) && got.ticks == ticks && !hal_slots_take(&got));
    TEST_ASSERT_EQUAL_UINT32(overruns + 1U, hal_slots_overruns());
}

/* A storm takes no more interrupts than there is room, the oldest are kept, and afterwards it goes on. */
static void test_storm_ends_by_itself(void) {
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

void suite_f405_parts(void) {
    RUN_TEST(test_bites_in_time);
    RUN_TEST(test_settings_are_kept);
    RUN_TEST(test_captures_in_order);
    RUN_TEST(test_storm_ends_by_itself);
}
