/* start.h: starts an image on the chip model. */
#ifndef TESTS_CHIP_START_H
#define TESTS_CHIP_START_H

#include "boards/board.h"
#include "hal/clock.h"
#include "tests/chip/chip.h"

/* Runs a function of the drivers. The test fails unless the function returns and violates no rule. */
void chip_run(void (*what)(void));

/* Starts clocks, variables, console, time base and the rig's hardware. The test fails if the clock does not start. */
chip_end chip_start(void);
/* Does the same as chip_start(). The test fails unless the start returns and violates no rule. */
void chip_image_starts(void);
/* Does the same as chip_start() after a reset. */
void chip_restart(chip_cause cause);

/* Sets whether the memory that survives a reset has data from before (boards/cortexm/kept.c). */
void chip_memory_keeps(bool anything);

/* Returns a suite's seed, which is not 0: `usual`, or WHIRL_SEED if that is set. */
uint64_t chip_seed(uint64_t usual);

typedef struct chip_wiring {
    const char *board;
    uint32_t crystal_Hz;
    char slot_port[2];
    uint8_t slot_pin[2];
    uint8_t cell_input, supply_input; /* channels of ADC1 */
} chip_wiring;
const chip_wiring *chip_wires(void);
void chip_slot_is(unsigned sensor, chip_level level);
void chip_slot_is_at(uint64_t when, unsigned sensor, chip_level level);

/* Makes a chip on its board, wired as in docs/boards.md, with resistors, a closed stop chain and quiet sensors; no
 * power yet. */
void chip_wired(uint64_t seed);
extern double (*chip_cell_V)(double s); /* voltage at the load cell's pin as a function of time */
extern double chip_supply_V;            /* supply voltage; its pin has a tenth of it */

/* Does the same as chip_wired(), switches the power on and starts the image. The test fails if the start fails or
 * violates a rule. */
void chip_on(uint64_t seed);

/* Starts only the chip's clocks; the next function does so on the same chip after a power-off. */
void chip_clocks_on(uint64_t seed);
void chip_clocks_again(void);

#endif
