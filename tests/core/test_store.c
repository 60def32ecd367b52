/* test_store.c: settings in two slots. A write is cut off at any byte: then the old or the new settings are loaded, and
 * the next save works. */
#include "core/station/store.h"

#include <string.h>

#include "draw.h"
#include "tests/suites.h"

#define SLOT_BYTES 256U
#define FOREVER UINT32_MAX

static uint8_t flash[WH_STORE_SLOTS][SLOT_BYTES];
static uint8_t photo[WH_STORE_SLOTS][SLOT_BYTES];
/* number of bytes that can still be erased or written before the supply fails */
static uint32_t left;
static bool scattered; /* a failing erase leaves random bytes in the whole slot */
static bool one_sided; /* writes can only clear bits, like flash */
static uint64_t seed;

static void start_flash(void) {
    memset(flash, 0xFF, sizeof flash);
    left = FOREVER;
    scattered = false;
    one_sided = true;
}

/* Returns a byte in the middle of its change from `was` to `becomes`: some of its bits have changed. */
static uint8_t torn(uint8_t was, uint8_t becomes) {
    const uint8_t arrived = (uint8_t)draw_bits(&seed);
    return (uint8_t)((was & ~arrived) | (becomes & arrived));
}

static void put(unsigned slot, unsigned at, uint8_t byte) {
    if (left == 0) {
        return;
    }
    left -= left != FOREVER ? 1U : 0U;
    flash[slot][at] = left == 0 ? torn(flash[slot][at], byte) : byte;
}

static bool erase(unsigned slot) {
    TEST_ASSERT_TRUE(slot < WH_STORE_SLOTS);
    if (scattered && left < SLOT_BYTES) {
        for (unsigned i = 0; i < SLOT_BYTES && left > 0; i++) {
            flash[slot][i] = torn(flash[slot][i], 0xFF);
        }
        left = 0;
    }
    for (unsigned i = 0; i < SLOT_BYTES; i++) {
        put(slot, i, 0xFF);
    }
    return left > 0;
}

static bool write(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count) {
    TEST_ASSERT_TRUE(slot < WH_STORE_SLOTS && at % 4U == 0 && at + count <= SLOT_BYTES);
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(left == 0 || !one_sided || flash[slot][at + i] == 0xFF);
        put(slot, at + i, bytes[i]);
    }
    return left > 0;
}

static bool read(unsigned slot, unsigned at, uint8_t *bytes, unsigned count) {
    TEST_ASSERT_TRUE(slot < WH_STORE_SLOTS && at + count <= SLOT_BYTES);
    memcpy(bytes, flash[slot] + at, count);
    return true;
}

static const wh_store_memory memory = {erase, write, read};

typedef struct payload {
    uint8_t bytes[WH_STORE_PAYLOAD_MOST];
    int count; /* number of bytes; -1: no record */
} payload;

static payload draw_payload(void) {
    payload p = {.count = (int)draw_one_of(&seed, draw_one_in(&seed, 3) ? 12U : 241U)};
    for (int i = 0; i < p.count; i++) {
        p.bytes[i] = (uint8_t)(draw_one_in(&seed, 4) ? 0xFFU : draw_bits(&seed));
    }
    return p;
}

static bool save(const payload *p) {
    uint8_t bytes[WH_STORE_SLOT_BYTES];
    if (p->count > 0) {
        memcpy(bytes + WH_STORE_HEAD_BYTES, p->bytes, (unsigned)p->count);
    }
    return wh_store_save(&memory, bytes, (unsigned)p->count) != 0;
}

static bool is_loaded(const payload *p) {
    uint8_t bytes[WH_STORE_SLOT_BYTES];
    uint32_t sequence;
    const int count = wh_store_load(&memory, bytes, &sequence);
    TEST_ASSERT_TRUE((count < 0) == (sequence == 0));
    return count == p->count &&
           (count <= 0 || memcmp(bytes + WH_STORE_HEAD_BYTES, p->bytes, (unsigned)count) == 0);
}

/* Writes a record in the format that store.h describes, with another implementation of the CRC. */
static void put_by_hand(unsigned slot, const payload *p, uint32_t sequence) {
    uint8_t *to = flash[slot];
    uint32_t crc = 0xFFFFFFFFU;
    const unsigned length = 8U + (unsigned)p->count;
    to[0] = 0x01;
    to[1] = 0x57;
    to[2] = (uint8_t)p->count;
    to[3] = (uint8_t)((unsigned)p->count >> 8);
    for (unsigned i = 0; i < 4U; i++) {
        to[4U + i] = (uint8_t)(sequence >> 8U * i);
    }
    memcpy(to + 8, p->bytes, (unsigned)p->count);
    for (unsigned bit = 0; bit < 8U * length; bit++) {
        const uint32_t in = (uint32_t)(to[bit / 8U] >> bit % 8U) & 1U;
        crc = (crc >> 1) ^ (((crc ^ in) & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    for (unsigned i = 0; i < 4U; i++) {
        to[length + i] = (uint8_t)(~crc >> 8U * i);
    }
}

TEST(store, saved_settings_are_loaded) {
    seed = 3;
    start_flash();
    const payload none = {.count = -1};
    TEST_ASSERT_TRUE(is_loaded(&none));
    for (unsigned i = 0; i < 300U; i++) {
        const payload p = draw_payload();
        TEST_ASSERT_TRUE(save(&p) && is_loaded(&p));
    }
    uint8_t bytes[WH_STORE_SLOT_BYTES] = {0};
    uint32_t sequence;
    TEST_ASSERT_EQUAL_UINT32(0, wh_store_save(&memory, bytes, WH_STORE_PAYLOAD_MOST + 1U));
    TEST_ASSERT_EQUAL_UINT32(301, wh_store_save(&memory, bytes, 2));
    TEST_ASSERT_EQUAL_INT(2, wh_store_load(&memory, bytes, &sequence));
    TEST_ASSERT_EQUAL_UINT32(301, sequence);
}

/* The supply fails at every erased or written byte. The old or the new record is loaded, and the next save works. */
TEST(store, torn_at_every_byte) {
    seed = 4;
    unsigned old = 0;
    unsigned new = 0;
    for (unsigned round = 0; round < 8U; round++) {
        start_flash();
        payload before = {.count = -1};
        for (unsigned i = 0; i < round; i++) { /* no slot, one slot, or both have a record */
            before = draw_payload();
            TEST_ASSERT_TRUE(save(&before));
        }
        const payload after = draw_payload();
        const uint32_t all = SLOT_BYTES + WH_STORE_FIXED_BYTES + (uint32_t)after.count;
        memcpy(photo, flash, sizeof flash);
        for (uint32_t at = 0; at <= all + 1U; at++) {
            for (unsigned way = 0; way < 2U; way++) {
                memcpy(flash, photo, sizeof flash);
                scattered = way == 1U;
                left = at;
                const bool said = save(&after);
                left = FOREVER;
                const bool is_new = is_loaded(&after);
                TEST_ASSERT_TRUE(is_new || is_loaded(&before));
                /* If the save reported success, the new record must be loaded. */
                TEST_ASSERT_TRUE(is_new || !said);
                TEST_ASSERT_TRUE(at <= all || said);
                old += is_new ? 0U : 1U;
                new += is_new ? 1U : 0U;
                const payload next = draw_payload();
                TEST_ASSERT_TRUE(save(&next) && is_loaded(&next));
            }
        }
    }
    TEST_ASSERT_TRUE(old > 5000U && new >= 8U);
}

/* If a bit of the newest record is flipped, the previous record is loaded. */
TEST(store, every_bit) {
    seed = 5;
    for (unsigned round = 0; round < 4U; round++) {
        start_flash();
        payload before = draw_payload();
        for (unsigned i = 0; i < round; i++) {
            TEST_ASSERT_TRUE(save(&before));
        }
        before = draw_payload();
        TEST_ASSERT_TRUE(save(&before));
        const payload after = draw_payload();
        TEST_ASSERT_TRUE(save(&after));
        const unsigned slot = (round + 1U) % 2U;
        for (unsigned bit = 0; bit < 8U * (WH_STORE_FIXED_BYTES + (unsigned)after.count); bit++) {
            flash[slot][bit / 8U] = (uint8_t)(flash[slot][bit / 8U] ^ 1U << bit % 8U);
            TEST_ASSERT_TRUE(is_loaded(&before));
            flash[slot][bit / 8U] = (uint8_t)(flash[slot][bit / 8U] ^ 1U << bit % 8U);
        }
        TEST_ASSERT_TRUE(is_loaded(&after));
    }
}

static uint32_t after_it(uint32_t sequence) { return sequence == UINT32_MAX ? 1U : sequence + 1U; }

/* Sequence numbers wrap, and the format is the documented one. */
TEST(store, sequences_wrap) {
    static const uint32_t first[] = {1U, 0x7FFFFFFFU, 0xFFFFFFFEU, 0xFFFFFFFFU};
    seed = 6;
    for (unsigned i = 0; i < 8U; i++) {
        start_flash();
        const payload one = draw_payload();
        const payload two = draw_payload();
        const uint32_t second = after_it(first[i / 2U]);
        put_by_hand(i % 2U, &one, first[i / 2U]);
        TEST_ASSERT_TRUE(is_loaded(&one));
        put_by_hand(1U - i % 2U, &two, second);
        TEST_ASSERT_TRUE(is_loaded(&two));
        memcpy(photo, flash, sizeof flash);
        const payload three = draw_payload();
        TEST_ASSERT_TRUE(save(&three) && is_loaded(&three));
        TEST_ASSERT_TRUE(memcmp(photo[1U - i % 2U], flash[1U - i % 2U], SLOT_BYTES) == 0);
        memcpy(photo, flash, sizeof flash);
        put_by_hand(i % 2U, &three, after_it(second));
        TEST_ASSERT_TRUE(memcmp(photo, flash, sizeof flash) == 0); /* the documented bytes */
    }
}

/* Failing memory is reported, and another format is refused. */
TEST(store, failing_memory) {
    seed = 7;
    start_flash();
    payload p = draw_payload();
    TEST_ASSERT_TRUE(save(&p));
    left = 0;
    payload q = draw_payload();
    TEST_ASSERT_FALSE(save(&q));
    left = FOREVER;
    TEST_ASSERT_TRUE(is_loaded(&p));
    const payload none = {.count = -1};
    put_by_hand(0, &p, 9);
    flash[0][0] = 0x02;
    memset(flash[1], 0, SLOT_BYTES);
    TEST_ASSERT_TRUE(is_loaded(&none));
}
