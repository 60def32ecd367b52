/* start.h: an image's start on the played chip. */
#ifndef TESTS_CHIP_START_H
#define TESTS_CHIP_START_H

#include "boards/board.h"
#include "hal/clock.h"
#include "tests/chip/chip.h"

/* Clocks, variables, console and time base, the rig's hardware. *how: what hal_clock_start() said, when it came so far. */
chip_end chip_start(hal_start *how);

/* Memory that outlives a reset holds something of before (boards/cortexm/kept.c), or nothing. */
void chip_memory_keeps(bool anything);

/* A suite's seed, not 0: as it is usually, or by WHIRL_SEED another. */
uint64_t chip_seed(uint64_t usual);

/* What differs between the boards. */
typedef struct chip_wiring {
    const char *board; /* whose data the drivers of this program have */
    uint32_t crystal_Hz;
    char slot_port[2];
    uint8_t slot_pin[2];
    uint8_t cell_input, supply_input; /* of ADC1 */
} chip_wiring;
const chip_wiring *chip_wires(void);
/* The level of a slot sensor, now or at a time. */
void chip_slot_is(unsigned sensor, chip_level level);
void chip_slot_is_at(uint64_t when, unsigned sensor, chip_level level);

/* A chip on its board, wired as docs/boards.md has it: resistors, closed stop chain, quiet sensors; no power yet. */
void chip_wired(uint64_t seed);
extern double (*chip_cell_V)(double s); /* at the load cell's pin, at a time */
extern double chip_supply_V;            /* of which its pin has a tenth */

/* The same with its power on and the image started; a test fails if it does not, or violates anything. */
void chip_on(uint64_t seed);

/* Its clocks alone, for what needs no more; the same chip again, behind a power-off. */
void chip_clocks_on(uint64_t seed);
void chip_clocks_again(void);

#endif
