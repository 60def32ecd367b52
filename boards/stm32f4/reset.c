/* reset.c: the cause of the chip's start (RM0090, 7.3.21), and the data that survived it (boards/cortexm/kept.h). */
#include "hal/reset.h"
#include "boards/cortexm/kept.h"
#include "boards/shared/reset_words.h"
#include "core/text.h"

#include "stm32f4.h"

static hal_reset cause;
static board_fault_record fault;

/* Every start sets the reset pin's flag, so this flag shows no cause. In an emulator, no flag is set. */
static hal_reset cause_of(uint32_t flags, bool knows_of_before, bool faulted) {
    if ((flags & (RCC_CSR_IWDGRSTF | RCC_CSR_WWDGRSTF)) != 0) {
        return HAL_RESET_WATCHDOG;
    }
    if ((flags & RCC_CSR_PORRSTF) != 0) {
        return HAL_RESET_POWER_ON;
    }
    if ((flags & RCC_CSR_BORRSTF) != 0) {
        return HAL_RESET_SUPPLY;
    }
    if (faulted) {
        return HAL_RESET_FAULT;
    }
    return flags == 0 && !knows_of_before ? HAL_RESET_POWER_ON : HAL_RESET_OTHER;
}

void stm32f4_reset_start(void) {
    const uint32_t all = RCC_CSR_LPWRRSTF | RCC_CSR_WWDGRSTF | RCC_CSR_IWDGRSTF | RCC_CSR_SFTRSTF |
                         RCC_CSR_PORRSTF | RCC_CSR_PINRSTF | RCC_CSR_BORRSTF;
    const bool knows_of_before = board_kept_anything();
    const bool faulted = board_kept_take_fault(&fault);
    cause = cause_of(reg_load(RCC_CSR) & all, knows_of_before, faulted);
    if (cause == HAL_RESET_POWER_ON) {
        board_kept_forget();
    }
    reg_set(RCC_CSR, RCC_CSR_RMVF);
}

hal_reset hal_reset_cause(void) { return cause; }

board_fault_when board_fault_answer(wh_text *text) {
    board_fault_words(text, &fault.facts);
    return (board_fault_when){.ticks = fault.ticks, .state = fault.state, .faults = fault.faults};
}
