/* test_chip_unplayed.c: a register missing from the chip model is not silent memory, so a driver that uses it is noticed. */
#include "tests/suites.h"

#include "boards/stm32f4/registers.h"
#include "tests/chip/start.h"
#include "tests/scattered.h"

/* Each part's base, and the registers of the manual that the model lacks. */
static const struct {
    uint32_t base;
    uint16_t offset[8];
} unplayed[] = {
    {0x40010000U, {0x08, 0x1C, 0x30, 0x38, 0x3C, 0x40, 0x48, 0x4C}}, /* TIM1 */
    {0x40000000U, {0x08, 0x3C, 0x40, 0x44, 0x48, 0x4C, 0x50, 0x48}}, /* TIM2 */
    {0x40012000U, {0x14, 0x18, 0x1C, 0x20, 0x24, 0x28, 0x38, 0x3C}}, /* ADC1 */
    {0x40023800U, {0x10, 0x14, 0x18, 0x20, 0x24, 0x34, 0x38, 0x50}}, /* RCC */
    {0x40026400U, {0x28, 0x2C, 0x30, 0x34, 0x38, 0x40, 0x44, 0x58}}, /* DMA2's other streams */
    {0x40011400U, {0x18, 0x18, 0x18, 0x18, 0x18, 0x18, 0x18, 0x18}}, /* USART6 */
};
#define PARTS (sizeof unplayed / sizeof unplayed[0])

static uint32_t address;
static uint32_t value;
static void store(void) { reg_store(address, value); }

TEST(chip_unplayed, a_store_to_what_is_not_played_is_told) {
    scattered_state = chip_seed(9);
    chip_on(9);
    for (unsigned i = 0; i < PARTS * 8U; i++) {
        address = unplayed[i / 8U].base + unplayed[i / 8U].offset[i % 8U];
        value = (uint32_t)scattered() | 1U;
        chip_forgive();
        TEST_ASSERT_EQUAL(CHIP_RETURNED, chip_try(store));
        TEST_ASSERT_TRUE_MESSAGE(chip_violations() > 0, "nobody noticed");
    }
    chip_forgive();
}
