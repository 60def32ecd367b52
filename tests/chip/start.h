/* start.h: an image's start on the chip model. */
#ifndef TESTS_CHIP_START_H
#define TESTS_CHIP_START_H

#include "boards/board.h"
#include "hal/clock.h"
#include "tests/chip/chip.h"

/* Runs a function of the drivers. The test fails unless it returns and no rule was broken. */
void chip_run(void (*what)(void));

/* Sets up clocks, variables, console, time base and the rig's hardware. The test fails if the clock does not start. */
chip_end chip_start(void);
/* As above. The test fails unless it returns and no rule was broken. */
void chip_image_starts(void);
/* The same after a reset. */
void chip_restart(chip_cause cause);

/* Sets whether memory that survives a reset has earlier data (boards/cortexm/kept.c). */
void chip_memory_keeps(bool anything);

/* A suite's seed, not 0: the given one, or WHIRL_SEED. */
uint64_t chip_seed(uint64_t usual);

typedef struct chip_wiring {
    const char *board; /* the program with the linked drivers' data */
    uint32_t crystal_Hz;
    char slot_port[2];
    uint8_t slot_pin[2];
    uint8_t cell_input, supply_input; /* channels of ADC1 */
} chip_wiring;
const chip_wiring *chip_wires(void);
void chip_slot_is(unsigned sensor, chip_level level);
void chip_slot_is_at(uint64_t when, unsigned sensor, chip_level level);

/* A chip on its board, wired as in docs/boards.md: resistors, closed stop chain, quiet sensors; no power yet. */
void chip_wired(uint64_t seed);
extern double (*chip_cell_V)(double s); /* voltage at the load cell's pin as a function of time */
extern double chip_supply_V;            /* the pin has a tenth of it */

/* As above, with power on and the image started. The test fails if the start fails or violates a rule. */
void chip_on(uint64_t seed);

/* Starts only the chip's clocks; the same chip after a power-off. */
void chip_clocks_on(uint64_t seed);
void chip_clocks_again(void);

#endif
