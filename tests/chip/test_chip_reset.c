/* test_chip_reset.c: the reset cause and the brown-out level on the chip model. */
#include "tests/suites.h"

#include "hal/reset.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

static hal_reset cause;
static unsigned length;
static char words[128];
static void ask(void) {
    cause = hal_reset_cause();
    length = hal_reset_words(words, sizeof words);
}
static void start_and_ask(void) {
    chip_image_starts();
    chip_run(ask);
    TEST_ASSERT_TRUE(length > 0 && length < sizeof words && words[length] == 0);
}

TEST(chip_reset, causes) {
    static const hal_reset told[] = {[CHIP_BY_POWER] = HAL_RESET_POWER_ON,
                                     [CHIP_BY_DIP] = HAL_RESET_SUPPLY,
                                     [CHIP_BY_PIN] = HAL_RESET_OTHER,
                                     [CHIP_BY_WATCHDOG] = HAL_RESET_WATCHDOG,
                                     [CHIP_BY_SOFTWARE] = HAL_RESET_OTHER};
    scattered_state = chip_seed(1);
    chip_wired(1);
    for (unsigned i = 0; i < 80; i++) {
        const chip_cause by = i == 0 ? CHIP_BY_POWER : (chip_cause)(scattered() % 5U);
        chip_memory_keeps(by != CHIP_BY_POWER);
        chip_reset(by);
        start_and_ask();
        TEST_ASSERT_EQUAL(told[by], cause);
        chip_pass_us(scattered() % 3000U);
    }
}

TEST(chip_reset, words_are_cut) {
    chip_on(2);
    for (unsigned room = 1; room < 20; room++) {
        words[room] = 'x';
        length = hal_reset_words(words, room);
        TEST_ASSERT_TRUE(length < room && words[length] == 0);
        TEST_ASSERT_EQUAL('x', words[room]);
    }
}

#define LEVEL(options) ((options) >> 2 & 3U) /* BOR_LEV: 0 is level 3, 3 is off (3.9.10) */

/* The brown-out level becomes 3, whatever it was. It is written once, and the other option bytes do not change. */
TEST(chip_reset, brown_out) {
    chip_wired(3);
    chip_reset(CHIP_BY_POWER);
    TEST_ASSERT_EQUAL(3, LEVEL(chip_option_bytes()));
    start_and_ask();
    chip_pass_us(1000000);
    TEST_ASSERT_EQUAL(0, LEVEL(chip_option_bytes()));
    TEST_ASSERT_EQUAL_HEX32(0x0FFFAAE0U, chip_option_bytes());
    TEST_ASSERT_EQUAL(1, chip_option_writes());
    TEST_ASSERT_TRUE(chip_options_are_locked());
    for (unsigned i = 0; i < 5; i++) {
        chip_reset((chip_cause)i);
        start_and_ask();
        TEST_ASSERT_EQUAL(1, chip_option_writes());
        TEST_ASSERT_TRUE(chip_options_are_locked());
    }
}

/* If power fails at any instant of the write, the next start repairs the level. */
TEST(chip_reset, brown_out_torn) {
    scattered_state = chip_seed(4);
    for (unsigned i = 0; i < 15; i++) {
        chip_wired(scattered());
        chip_reset(CHIP_BY_POWER);
        chip_power_off_at(chip_now() + scattered() % (CHIP_UNITS_PER_S / 4U));
        (void)chip_start();
        chip_power_stays();
        chip_reset(CHIP_BY_POWER);
        start_and_ask();
        TEST_ASSERT_EQUAL_HEX32(0x0FFFAAE0U, chip_option_bytes());
    }
}
