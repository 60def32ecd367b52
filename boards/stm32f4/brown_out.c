/* brown_out.c: the supply voltage below which the chip stays in reset (RM0090, 3.9.10 and 5.2.2). It is 2.7 V, which
 * 168 MHz and the flash require. An option byte keeps it, so the program writes it only once in a chip's life. */
#include "stm32f4.h"

void stm32f4_brown_out_start(void) {
    if ((reg_load(FLASH_OPTCR) & FLASH_OPTCR_BOR_LEV) == FLASH_OPTCR_BOR_LEV_3 ||
        !stm32f4_flash_rests()) {
        return;
    }
    reg_store(FLASH_OPTKEYR, FLASH_OPTKEY1);
    reg_store(FLASH_OPTKEYR, FLASH_OPTKEY2);
    reg_change(FLASH_OPTCR, FLASH_OPTCR_BOR_LEV, FLASH_OPTCR_BOR_LEV_3); /* keeps the other bits */
    reg_set(FLASH_OPTCR, FLASH_OPTCR_OPTSTRT);
    (void)stm32f4_flash_rests();
    reg_set(FLASH_OPTCR, FLASH_OPTCR_OPTLOCK);
}
