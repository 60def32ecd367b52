/* mega.h: an ATmega2560 in simavr with its image, its console and the rig at its pins. The rig is the core's own model, run in
 * real time by the chip's cycles (hal/virtual). Slot sensors are edges at the capture pins; load cell and supply are voltages
 * at the converter. PWM and enable pins set the motor's voltage.
 *
 * A fault of the emulator itself ends the program with a message. */
#ifndef TESTS_TOOLS_MEGA_H
#define TESTS_TOOLS_MEGA_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/virtual/virtual_rig.h"

#define MEGA_HZ 16000000U
#define MEGA_CYCLES_PER_US (MEGA_HZ / 1000000U)
#define MEGA_EEPROM_BYTES 4096U

/* In cycles. A step runs from the end of a wait to the console's turn, a loop to the begin of the next wait. */
typedef struct mega_times {
    uint64_t steps;
    uint64_t worst_step;
    uint64_t worst_loop;
    uint64_t sum_step;
    uint64_t late; /* number of loops longer than a control period */
    /* control steps by their cycles, 1000 per bin; the last bin has all longer ones */
    unsigned histogram[64];
} mega_times;

typedef struct mega_motor {
    bool enabled;
    float duty;
} mega_motor;

/* Restarts with power-on. The EEPROM stays (mega_eeprom()); at first it is erased. */
void mega_start(const char *image);

/* One instruction and the events of its cycles. False: the program ended or crashed. */
bool mega_step(void);

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

/* Calls code of the chip with the arguments in r22 to r25, then continues as if nothing had happened. */
void mega_call(uint32_t at, const uint8_t arguments[4]);

/* Overwrites two bytes of the flash that is executed. Returns the old bytes. */
uint16_t mega_set_flash(uint32_t at, uint16_t word);

/* An address of flash, or of memory as for mega_data(); 0: no such symbol. */
uint32_t mega_symbol(const char *name);

/* The supply's voltage, and whether stop's contacts are open, from now on. */
extern float mega_supply_V;
extern bool mega_stop;
extern float mega_noise_mV; /* noise of the load cell's amplifier, uniform, plus or minus this */

/* The plant gives no more slot pulses: the caller sets the levels at the capture pins. */
extern bool mega_no_pulses;
void mega_level(unsigned sensor, bool high);

/* Called with the address before an EEPROM byte changes; NULL: no call. */
extern void (*mega_on_eeprom)(unsigned address);

/* A reset other than power-on: `flag` of MCUSR. Memory stays. */
void mega_reset(uint8_t flag);

/* mega_say() sends a line at the console's speed; mega_hear() reads the console's next line within `ms`. */
void mega_say(const char *line);
bool mega_hear(char *line, unsigned room, unsigned ms);

/* Sends a line; its answer must begin with these words. Otherwise prints a message and returns false. */
bool mega_answers(const char *order, const char *begin, char *line, unsigned room);

#endif
