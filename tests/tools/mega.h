/* mega.h: an ATmega2560 in simavr with its image, its console, and round its pins the rig: the core's own model, played in real
 * time by the chip's cycles (hal/virtual). Slot sensors are edges on the capture pins, load cell and supply voltages at the
 * converter, the motor is what PWM and enable pins make of the supply.
 *
 * What is wrong with the emulator itself ends the program with a message. */
#ifndef TESTS_TOOLS_MEGA_H
#define TESTS_TOOLS_MEGA_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/virtual/virtual_rig.h"

#define MEGA_HZ 16000000U
#define MEGA_CYCLES_PER_US (MEGA_HZ / 1000000U)
#define MEGA_EEPROM_BYTES 4096U

/* What the chip's time went into, in cycles: a control step, from the end of the wait for it to the console's turn; and all until the
 * next wait, the console's turn in it. */
typedef struct mega_times {
    uint64_t steps;
    uint64_t worst_step;
    uint64_t worst_loop;
    uint64_t sum_step;
    uint64_t late;          /* waits that began after their time */
    unsigned histogram[64]; /* of steps, 1000 cycles each; the last has what is above */
} mega_times;

/* The motor as its pins have it. */
typedef struct mega_motor {
    bool enabled;
    float duty;
} mega_motor;

/* Begins anew with the power, the EEPROM as it was (mega_eeprom()): erased at first. */
void mega_start(const char *image);

/* One instruction, and what its cycles bring. False: the program has ended, or crashed. */
bool mega_step(void);

/* So many milliseconds of the chip's time. */
bool mega_run(unsigned ms);

uint64_t mega_cycle(void);
mega_times *mega_times_now(void);
mega_motor mega_motor_now(void);
hal_virtual_rig *mega_plant(void);
uint8_t *mega_data(void); /* registers and memory */
uint8_t *mega_eeprom(void);
uint32_t mega_pc(void);
void mega_set_pc(uint32_t at);
void mega_push_pc(void);
uint16_t mega_sp(void);

/* Calls code of the chip, the arguments in r22 to r25, and goes on behind as if it had not been. */
void mega_call(uint32_t at, const uint8_t arguments[4]);

/* Flash as it is executed, two bytes; returns what was there. */
uint16_t mega_set_flash(uint32_t at, uint16_t word);

/* An address of flash, or of memory as mega_data() has it; 0: there is no such symbol. */
uint32_t mega_symbol(const char *name);

/* The supply's voltage, and whether stop's contacts are open: from now on. */
extern float mega_supply_V;
extern bool mega_stop;
extern float mega_noise_mV; /* of the load cell's amplifier, evenly, either way */

/* The plant gives no more slot pulses: levels at the capture pins are whoever sets them. */
extern bool mega_no_pulses;
void mega_level(unsigned sensor, bool high);

/* A byte of the EEPROM is about to be written: its address, before it changes. NULL: nobody is told. */
extern void (*mega_on_eeprom)(unsigned address);

/* A reset that is not the power's: `flag` of MCUSR. Memory stays. */
void mega_reset(uint8_t flag);

/* To the console, at its speed; its next line, within so many milliseconds. */
void mega_say(const char *line);
bool mega_hear(char *line, unsigned room, unsigned ms);

/* A line, and its answer, which begins so; else a word of it on standard output, and false. */
bool mega_answers(const char *order, const char *begin, char *line, unsigned room);

#endif
