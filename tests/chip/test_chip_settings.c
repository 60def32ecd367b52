/* test_chip_settings.c: erase, write and read of the settings' flash on the chip model. A power failure before any
 * store, or at any instant, leaves the old content or the new. */
#include <string.h>

#include "tests/suites.h"

#include "core/station/store.h"
#include "hal/clock.h"
#include "hal/settings.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

#define SLOT_AT(slot) (0x08004000U + 0x4000U * (slot)) /* sectors 1 and 2 (RM0090, table 5) */

static unsigned slot, at, count;
static uint8_t bytes[HAL_SETTINGS_BYTES];
static bool good;
static void erase(void) { good = hal_settings_erase(slot); }
static void write(void) { good = hal_settings_write(slot, at, bytes, count); }
static void read(void) { good = hal_settings_read(slot, at, bytes, count); }
static void run(void (*what)(void)) {
    const uint64_t then = chip_now();
    chip_run(what);
    TEST_ASSERT_TRUE_MESSAGE(chip_now() - then <= HAL_SETTINGS_TICKS * CHIP_UNITS_PER_US,
                             "longer than a call may take");
}

/* After erases and writes of any length, both slots equal a copy in the test. No other memory changes. */
TEST(chip_settings, slots) {
    static uint8_t mine[2][HAL_SETTINGS_BYTES];
    scattered_state = chip_seed(1);
    chip_clocks_on(1);
    memset(mine, 0xFF, sizeof mine);
    for (uint32_t i = 0; i < 0x100000U; i++) {
        if (i < 0x4000U || i >= 0xC000U) {
            chip_flash_byte_is(0x08000000U + i, (uint8_t)(i * 7U));
        }
    }
    for (unsigned i = 0; i < 60; i++) {
        slot = (unsigned)(scattered() % 2U);
        run(erase);
        TEST_ASSERT_TRUE(good);
        memset(mine[slot], 0xFF, sizeof mine[slot]);
        for (at = 4U * (unsigned)(scattered() % 10U); at < HAL_SETTINGS_BYTES;
             at += (count + 3U) / 4U * 4U) {
            const unsigned room = HAL_SETTINGS_BYTES - at;
            count = 1U + (unsigned)(scattered() % (room < 90U ? room : 90U));
            for (unsigned b = 0; b < count; b++) {
                mine[slot][at + b] = bytes[b] = (uint8_t)scattered();
            }
            run(write);
            TEST_ASSERT_TRUE(good);
        }
        for (unsigned look = 0; look < 4; look++) {
            slot = (unsigned)(scattered() % 2U);
            at = (unsigned)(scattered() % HAL_SETTINGS_BYTES);
            count = (unsigned)(scattered() % (HAL_SETTINGS_BYTES - at + 1U));
            memset(bytes, 0x55, sizeof bytes);
            run(read);
            TEST_ASSERT_TRUE(good);
            for (unsigned b = 0; b < count; b++) {
                TEST_ASSERT_EQUAL(mine[slot][at + b], bytes[b]);
            }
        }
        for (unsigned both = 0; both < 2; both++) {
            for (unsigned b = 0; b < HAL_SETTINGS_BYTES; b++) {
                TEST_ASSERT_EQUAL(mine[both][b], chip_flash_byte(SLOT_AT(both) + b));
            }
        }
    }
    for (uint32_t i = 0; i < 0x100000U; i++) {
        if (i < 0x4000U || i >= 0xC000U) {
            TEST_ASSERT_EQUAL((uint8_t)(i * 7U), chip_flash_byte(0x08000000U + i));
        }
    }
}

TEST(chip_settings, refused) {
    chip_clocks_on(2);
    for (slot = 0; slot < 2; slot++) {
        chip_protect_sector(1U + slot);
        run(erase);
        TEST_ASSERT_FALSE(good);
        bytes[0] = 0;
        at = 0;
        count = 1;
        run(write);
        TEST_ASSERT_FALSE(good);
        TEST_ASSERT_EQUAL(0, chip_flash_erases(1U + slot));
        TEST_ASSERT_EQUAL(0xFF, chip_flash_byte(SLOT_AT(slot)));
    }
}

/* After a write to a word that is not erased, the flash reports no error. The reader of store.h detects it. */

static const wh_store_memory memory = {hal_settings_erase, hal_settings_write, hal_settings_read};
static uint8_t payload[WH_STORE_PAYLOAD_MOST];
static unsigned payload_bytes;
static int loaded;
static void save(void) {
    uint8_t record[WH_STORE_SLOT_BYTES];
    memcpy(record + WH_STORE_HEAD_BYTES, payload, payload_bytes);
    good = wh_store_save(&memory, record, payload_bytes) != 0;
}
static void load(void) {
    uint8_t record[WH_STORE_SLOT_BYTES];
    uint32_t sequence = 0;
    loaded = wh_store_load(&memory, record, &sequence);
    memcpy(payload, record + WH_STORE_HEAD_BYTES, loaded > 0 ? (unsigned)loaded : 0U);
}
static void drawn_payload(void) {
    payload_bytes = 100U + (unsigned)(scattered() % (WH_STORE_PAYLOAD_MOST - 99U));
    for (unsigned i = 0; i < payload_bytes; i++) {
        payload[i] = (uint8_t)scattered();
    }
}

static uint8_t old[WH_STORE_PAYLOAD_MOST], new[WH_STORE_PAYLOAD_MOST];
static unsigned old_bytes, new_bytes;

/* Reads the settings after a power-off in the middle of a save. Returns true if they are the new ones, false if the old
 * ones. The test fails if they are neither. */
static bool new_is_there(void) {
    chip_power_stays();
    chip_clocks_again();
    run(load);
    TEST_ASSERT_TRUE_MESSAGE(loaded >= 0, "nothing is there any more");
    if ((unsigned)loaded == new_bytes && memcmp(payload, new, new_bytes) == 0) {
        return true;
    }
    TEST_ASSERT_EQUAL(old_bytes, loaded);
    TEST_ASSERT_EQUAL_MEMORY(old, payload, old_bytes);
    return false;
}
static void becomes(uint8_t *to, unsigned *to_bytes) {
    memcpy(to, payload, payload_bytes);
    *to_bytes = payload_bytes;
}
static void one_more(void) {
    drawn_payload();
    becomes(new, &new_bytes);
}
static void old_is_new(void) {
    memcpy(old, new, new_bytes);
    old_bytes = new_bytes;
}

TEST(chip_settings, torn_before_any_store) {
    scattered_state = chip_seed(3);
    chip_clocks_on(3);
    drawn_payload();
    becomes(old, &old_bytes);
    run(save);
    TEST_ASSERT_TRUE(good);
    unsigned torn = 0;
    unsigned whole = 0;
    for (unsigned stores = 0;; stores++) {
        one_more();
        chip_power_off_after(stores);
        const chip_end end = chip_try(save);
        TEST_ASSERT_EQUAL_STRING("none", chip_violation());
        if (new_is_there()) {
            whole++;
            old_is_new();
        }
        if (end == CHIP_RETURNED) {
            TEST_ASSERT_TRUE(good);
            break;
        }
        torn++;
    }
    TEST_ASSERT_TRUE(torn > 20 && whole >= 1);
}

TEST(chip_settings, torn_at_any_instant) {
    scattered_state = chip_seed(4);
    chip_clocks_on(4);
    drawn_payload();
    becomes(old, &old_bytes);
    run(save);
    unsigned torn = 0;
    unsigned kept = 0;
    for (unsigned i = 0; i < 300; i++) {
        one_more();
        /* Half of the failures come during the erase, half during the write that follows. */
        chip_power_off_at(chip_now() + (i % 2U == 0 ? scattered() % (CHIP_UNITS_PER_S / 3U)
                                                    : CHIP_UNITS_PER_S / 4U +
                                                          scattered() % (CHIP_UNITS_PER_S / 4U)));
        if (chip_try(save) == CHIP_POWER_OFF) {
            torn++;
        }
        TEST_ASSERT_EQUAL_STRING("none", chip_violation());
        if (new_is_there()) {
            old_is_new();
        } else {
            kept++;
        }
    }
    TEST_ASSERT_TRUE(torn > 150 && kept > 100);
}
