/* brown_out.c: the level of the supply below which the chip is held in reset (RM0090, 3.9.10 and 5.2.2): 2.7 V, what 168 MHz
 * and the flash need. An option byte, which is written when it is another: once in a chip's life. */
#include "stm32f4.h"

static bool is_busy(void) { return (reg_load(FLASH_SR) & FLASH_SR_BSY) != 0; }

static void wait_until_done(void) {
    for (uint32_t i = 0; i < 100000000U && is_busy(); i++) {
    }
}

void stm32f4_brown_out_start(void) {
    if ((reg_load(FLASH_OPTCR) & FLASH_OPTCR_BOR_LEV) == FLASH_OPTCR_BOR_LEV_3 || is_busy()) {
        return;
    }
    reg_store(FLASH_OPTKEYR, FLASH_OPTKEY1);
    reg_store(FLASH_OPTKEYR, FLASH_OPTKEY2);
    reg_change(FLASH_OPTCR, FLASH_OPTCR_BOR_LEV,
               FLASH_OPTCR_BOR_LEV_3); /* the others as they are */
    reg_set(FLASH_OPTCR, FLASH_OPTCR_OPTSTRT);
    wait_until_done();
    reg_set(FLASH_OPTCR, FLASH_OPTCR_OPTLOCK);
}
