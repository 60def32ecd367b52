/* start.c: starts an image on the chip model, as boards/cortexm/startup.c does, and has the memory that a reset
 * preserves. */
#include "tests/chip/start.h"

#include <stdlib.h>
#include <string.h>

#include "boards/cortexm/kept.h"
#include "hal/clock.h"

#include "unity.h"

/* The linker's symbols at the ends of the drivers' variables (mk/tests.mk). */
extern uint8_t __start_drivers_bss[], __stop_drivers_bss[];
/* These two symbols exist only if some variable has an initial value. */
__attribute__((weak)) extern uint8_t __start_drivers_data[], __stop_drivers_data[];

static uint8_t image[16384];
static size_t image_bytes;

/* Copies byte by byte, because a sanitizer puts guards between variables. */
__attribute__((no_sanitize("address", "undefined"), noinline)) static void
put(volatile uint8_t *to, const uint8_t *from, size_t count) {
    for (size_t i = 0; i < count; i++) {
        to[i] = from != NULL ? from[i] : 0;
    }
}

__attribute__((constructor, no_sanitize("address", "undefined"))) static void keep_image(void) {
    image_bytes = (size_t)(__stop_drivers_data - __start_drivers_data);
    if (image_bytes <= sizeof image) {
        for (size_t i = 0; i < image_bytes; i++) {
            image[i] = ((volatile uint8_t *)__start_drivers_data)[i];
        }
    }
}

void drivers_as_flashed(void) {
    put(__start_drivers_data, image, image_bytes);
    put(__start_drivers_bss, NULL, (size_t)(__stop_drivers_bss - __start_drivers_bss));
}

/* Returns the wiring of docs/boards.md; the inputs of ADC1 are those of DS8626, table 9. */
const chip_wiring *chip_wires(void) {
    static const chip_wiring boards[] = {
        {"netduinoplus2", 25000000U, {'A', 'A'}, {0, 2}, 10, 11},
        {"stm32-h405", 8000000U, {'A', 'A'}, {1, 2}, 10, 11},
        {"feather-f405", 12000000U, {'A', 'B'}, {5, 11}, 14, 15},
    };
    for (unsigned i = 0; i < sizeof boards / sizeof *boards; i++) {
        if (strcmp(boards[i].board, board_name) == 0) {
            return &boards[i];
        }
    }
    TEST_FAIL_MESSAGE(board_name);
    return NULL;
}
void chip_slot_is(unsigned sensor, chip_level level) {
    chip_pin_drive(chip_wires()->slot_port[sensor], chip_wires()->slot_pin[sensor], level);
}
void chip_slot_is_at(uint64_t when, unsigned sensor, chip_level level) {
    chip_pin_drive_at(when, chip_wires()->slot_port[sensor], chip_wires()->slot_pin[sensor], level);
}

double (*chip_cell_V)(double s);
double chip_supply_V;
static double quiet_cell(double s) {
    (void)s;
    return 1.65;
}
static double chip_volts(unsigned input, double s) {
    const chip_wiring *wires = chip_wires();
    return input == wires->cell_input     ? chip_cell_V(s)
           : input == wires->supply_input ? chip_supply_V / 10.0
                                          : 0.0;
}

static bool anything_kept;
void chip_memory_keeps(bool anything) { anything_kept = anything; }
bool board_kept_anything(void) { return anything_kept; }
void board_kept_forget(void) { anything_kept = false; }
bool board_kept_take_fault(board_fault_record *record) {
    (void)record;
    return false;
}

static void start_all(void) {
    board_clock_start();
    drivers_as_flashed();
    board_start();
    TEST_ASSERT_TRUE(hal_clock_start());
}

void chip_run(void (*what)(void)) {
    TEST_ASSERT_EQUAL(CHIP_RETURNED, chip_try(what));
    TEST_ASSERT_EQUAL_STRING("none", chip_violation());
}
chip_end chip_start(void) { return chip_try(start_all); }
void chip_image_starts(void) { chip_run(start_all); }
void chip_restart(chip_cause cause) {
    chip_reset(cause);
    chip_image_starts();
}

static void start_clocks(void) {
    board_clock_start();
    drivers_as_flashed();
}
void chip_clocks_on(uint64_t seed) {
    chip_wired(seed);
    chip_clocks_again();
}
void chip_clocks_again(void) {
    chip_reset(CHIP_BY_POWER);
    chip_run(start_clocks);
}

uint64_t chip_seed(uint64_t usual) {
    const char *given = getenv("WHIRL_SEED");
    const uint64_t by = given != NULL ? strtoull(given, NULL, 10) : 0;
    return (usual + by * 1000003U) | UINT64_C(1) << 40;
}

void chip_wired(uint64_t seed) {
    chip_new(chip_seed(seed));
    chip_pin_resistor('B', 13, CHIP_TO_GROUND);
    chip_pin_resistor('B', 14, CHIP_TO_GROUND);
    chip_pin_resistor('A', 6, CHIP_TO_GROUND);
    chip_pin_drive('A', 6, CHIP_HIGH);
    chip_slot_is(0, CHIP_LOW);
    chip_slot_is(1, CHIP_LOW);
    world.crystal_Hz = chip_wires()->crystal_Hz;
    chip_pin_drive('C', 7, CHIP_HIGH);
    world.volts = chip_volts;
    chip_cell_V = quiet_cell;
    chip_supply_V = 12.0;
    anything_kept = false;
}

void chip_on(uint64_t seed) {
    chip_wired(seed);
    chip_restart(CHIP_BY_POWER);
}
