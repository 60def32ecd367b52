/* mega.c: an ATmega2560 in simavr, with the rig round its pins. */
#include "mega.h"
#include "mega_parts.h"

#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_timer.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Data addresses of the chip's registers, and bits in them. */
enum {
    REG_DDRB = 0x24,
    REG_PORTB = 0x25,
    REG_MCUSR = 0x54,
    REG_SPL = 0x5D,
    REG_TCCR1A = 0x80,
    REG_ICR1 = 0x86,
    REG_OCR1A = 0x88,
};
#define ENABLE 0x40U
#define PWM 0x20U
#define COM1A1 0x80U
#define WDRF 8U /* bit of MCUSR */
#define STOP_PIN 4U
#define BYTE_CYCLES (MEGA_HZ / 11520U)
#define MEMORY_BASE 0x800000U

float mega_supply_V = 24.0f;
bool mega_stop;
float mega_noise_mV;
bool mega_no_pulses;
void (*mega_on_eeprom)(unsigned address);

static avr_t *avr;
static elf_firmware_t firmware;
static hal_virtual_rig plant;
static uint64_t plant_cycle; /* time of the model's state */
static float force_N[2];     /* force at both ends of the last step */
static hal_slot_edge edges[HAL_VIRTUAL_PULSES];
static unsigned edge_count;
static uint64_t high_until[2]; /* end of a sensor's pulse; 0: low */
static char heard[65536];
static unsigned heard_bytes;
static char said[4096];
static unsigned said_bytes;
static uint64_t said_cycle; /* from this cycle on, the next byte may be sent */
static uint8_t eeprom[MEGA_EEPROM_BYTES];
static bool eeprom_known;
static mega_times times;

static _Noreturn void fail(const char *what) {
    fprintf(stderr, "mega: %s\n", what);
    exit(2);
}

static void on_log(avr_t *chip, const int level, const char *format, va_list arguments) {
    (void)chip;
    if (level <= LOG_ERROR) {
        vfprintf(stderr, format, arguments);
    }
}

static void on_byte(struct avr_irq_t *irq, uint32_t value, void *data) {
    (void)irq;
    (void)data;
    if (heard_bytes + 1U < sizeof heard) {
        heard[heard_bytes++] = (char)value;
    }
}

uint32_t mega_symbol(const char *name) {
    for (uint32_t i = 0; i < firmware.symbolcount; i++) {
        if (strcmp(firmware.symbol[i]->symbol, name) == 0) {
            const uint32_t at = firmware.symbol[i]->addr;
            return at >= MEMORY_BASE ? at - MEMORY_BASE : at;
        }
    }
    return 0;
}

/* --- the rig round it ----------------------------------------------------------------------------- */

static uint16_t word_at(unsigned address) {
    return (uint16_t)(avr->data[address] | avr->data[address + 1U] << 8);
}

mega_motor mega_motor_now(void) {
    const uint8_t out = avr->data[REG_DDRB] & avr->data[REG_PORTB];
    const bool timed = (avr->data[REG_TCCR1A] & COM1A1) != 0 && (avr->data[REG_DDRB] & PWM) != 0;
    const uint16_t whole = word_at(REG_ICR1);
    mega_motor motor = {.enabled = (out & ENABLE) != 0};
    if (timed && whole > 0) {
        motor.duty = (float)word_at(REG_OCR1A) / (float)whole;
    } else {
        motor.duty = (out & PWM) != 0 ? 1.0f : 0.0f;
    }
    return motor;
}

static float cell_N(void) {
    wh_real output[8];
    plant.scene->observe(plant.scene, &plant.state, output);
    return output[0];
}

/* The chip gets the state of the rig one model step late: the events in that step are then known. */
static void advance_plant(void) {
    const mega_motor motor = mega_motor_now();
    plant.supply_V = mega_supply_V;
    if (motor.enabled) {
        hal_virtual_rig_drive(&plant, motor.duty * mega_supply_V);
    } else {
        hal_virtual_rig_motor_off(&plant, HAL_MOTOR_COAST);
    }
    force_N[0] = force_N[1];
    hal_virtual_rig_advance(&plant, plant.ticks + plant.step_ticks);
    force_N[1] = cell_N();
    plant_cycle += (uint64_t)plant.step_ticks * MEGA_CYCLES_PER_US;
    plant.samples = 0;
    while (hal_virtual_rig_take_pulse(&plant, &edges[edge_count])) {
        edge_count += edge_count + 1U < HAL_VIRTUAL_PULSES ? 1U : 0U;
    }
}

void mega_level(unsigned sensor, bool high) {
    avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('L'), (int)sensor), high ? 1 : 0);
}

static uint64_t cycle_of(uint32_t ticks) {
    return plant_cycle - (uint64_t)(uint32_t)(plant.ticks - ticks) * MEGA_CYCLES_PER_US;
}

static void give_edges(void) {
    while (edge_count > 0 && cycle_of(edges[0].ticks) <= avr->cycle) {
        const unsigned sensor = edges[0].sensor;
        edge_count--;
        memmove(edges, edges + 1, edge_count * sizeof edges[0]);
        if (!mega_no_pulses) {
            mega_level(sensor, true);
            high_until[sensor] =
                avr->cycle + (uint64_t)HAL_VIRTUAL_PULSE_TICKS * MEGA_CYCLES_PER_US;
        }
    }
}

static float noise_mV(void) {
    static uint32_t drawn = 1;
    drawn = drawn * 1664525U + 1013904223U;
    return mega_noise_mV * ((float)(int32_t)drawn / 2147483648.0f);
}

static void on_convert(struct avr_irq_t *irq, uint32_t value, void *data) {
    union {
        avr_adc_mux_t mux;
        uint32_t value;
    } asked = {.value = value};
    (void)irq;
    (void)data;
    const uint32_t step_cycles = plant.step_ticks * MEGA_CYCLES_PER_US;
    const float part = 1.0f - (float)(int64_t)(plant_cycle - avr->cycle) / (float)step_cycles;
    const float load_N = force_N[0] + part * (force_N[1] - force_N[0]);
    const float mV = asked.mux.src == 0
                         ? 2500.0f + load_N / HAL_LOADCELL_FULL_SCALE_N * 2500.0f + noise_mV()
                         : 100.0f * mega_supply_V;
    /* Simavr divides by 1023, the data sheet (DS 26.7) by 1024 per reference: the scaled voltage gives the data sheet's code. */
    const float counts = mV * (1024.0f / 5000.0f);
    const uint32_t count = counts < 0.0f ? 0 : counts > 1023.0f ? 1023U : (uint32_t)counts;
    avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, (int)asked.mux.src),
                  (count * 5000U + 1022U) / 1023U);
}

/* --- time ------------------------------------------------------------------------------------------- */

static struct {
    uint32_t wait;
    uint32_t console;
    uint32_t back; /* address to which the wait returns */
    bool waits;
    bool steps;
    uint64_t began;
} seen;

static void forget_times(void) {
    seen.waits = false;
    seen.steps = false;
    seen.began = 0;
}

static uint32_t return_address(void) {
    const unsigned sp = mega_sp();
    const uint8_t *at = avr->data + sp;
    return 2U * ((uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3]);
}

static void see_times(void) {
    const uint32_t pc = avr->pc;
    if (seen.waits) {
        if (pc == seen.back) {
            seen.waits = false;
            seen.steps = true;
            seen.began = avr->cycle;
        }
    } else if (pc == seen.wait) {
        if (seen.began > 0) {
            const uint64_t took = avr->cycle - seen.began;
            times.worst_loop = took > times.worst_loop ? took : times.worst_loop;
            times.late += took > (uint64_t)MEGA_HZ / 500U ? 1U : 0U;
        }
        seen.back = return_address();
        seen.waits = true;
    } else if (pc == seen.console && seen.steps) {
        const uint64_t took = avr->cycle - seen.began;
        seen.steps = false;
        times.steps++;
        times.sum_step += took;
        times.worst_step = took > times.worst_step ? took : times.worst_step;
        times.histogram[took / 1000U < 63U ? took / 1000U : 63U]++;
    }
}

static void say_byte(void) {
    if (said_bytes > 0 && avr->cycle >= said_cycle) {
        avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT),
                      (uint8_t)said[0]);
        said_bytes--;
        memmove(said, said + 1, said_bytes);
        said_cycle = avr->cycle + BYTE_CYCLES;
    }
}

bool mega_step(void) {
    const uint64_t before = avr->cycle;
    const mega_next next = mega_parts_next(avr);
    if (next.writes && mega_on_eeprom != NULL) {
        mega_on_eeprom(next.address);
    }
    const int state = avr_run(avr);
    if (mega_parts_bite(avr, &next)) {
        mega_reset(WDRF);
    }
    if (mega_parts_wrong() != NULL) {
        fail(mega_parts_wrong());
    }
    if (avr->cycle < before) { /* a reset restarts the count */
        fail("the cycles' count went back");
    }
    while (plant_cycle < avr->cycle) {
        advance_plant();
    }
    if (edge_count > 0) {
        give_edges();
    }
    for (unsigned i = 0; i < 2; i++) {
        if (high_until[i] != 0 && high_until[i] <= avr->cycle) {
            high_until[i] = 0;
            mega_level(i, false);
        }
    }
    if (avr->pc == 0) {
        mega_parts_start();
        forget_times(); /* pc is 0 after a reset, or after a stray jump */
    }
    see_times();
    if (said_bytes > 0) {
        say_byte();
    }
    return state != cpu_Done && state != cpu_Crashed;
}

bool mega_run(unsigned ms) {
    const uint64_t end = avr->cycle + (uint64_t)ms * (MEGA_HZ / 1000U);
    while (avr->cycle < end) {
        if (!mega_step()) {
            return false;
        }
    }
    return true;
}

/* --- start and reset ---------------------------------------------------------------------------------- */

static void wire(void) {
    uint32_t flags = 0;
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
                            on_byte, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER),
                            on_convert, NULL);
}

static void set_stop(void) {
    avr_ioport_external_t contacts = {.name = 'B', .mask = 1U << STOP_PIN};
    contacts.value = mega_stop ? 1U << STOP_PIN : 0U;
    avr_ioctl(avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('B'), &contacts);
    avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), STOP_PIN), mega_stop ? 1 : 0);
}

void mega_start(const char *image) {
    avr_global_logger_set(on_log);
    if (avr != NULL) {
        avr_terminate(avr);
        free(avr);
    }
    memset(&firmware, 0, sizeof firmware);
    if (elf_read_firmware(image, &firmware) != 0) {
        fail("cannot read the image");
    }
    avr = avr_make_mcu_by_name("atmega2560");
    if (avr == NULL || avr_init(avr) != 0) {
        fail("simavr does not know the chip");
    }
    firmware.frequency = MEGA_HZ;
    avr_load_firmware(avr, &firmware);
    avr->vcc = avr->avcc = avr->aref = 5000;
    avr->run_cycle_limit = 1;
    wire();
    avr_eeprom_desc_t all = {.ee = eeprom, .offset = 0, .size = sizeof eeprom};
    if (!eeprom_known) {
        memset(eeprom, 0xFF, sizeof eeprom);
        eeprom_known = true;
    }
    avr_ioctl(avr, AVR_IOCTL_EEPROM_SET, &all);
    avr->data[REG_MCUSR] = 1; /* cause of the reset: power-on */
    if (!hal_virtual_rig_start(&plant, &rig_fixed)) {
        fail("the model does not start");
    }
    plant_cycle = 0;
    force_N[0] = force_N[1] = cell_N();
    edge_count = heard_bytes = said_bytes = 0;
    said_cycle = high_until[0] = high_until[1] = 0;
    mega_parts_start();
    memset(&times, 0, sizeof times);
    memset(&seen, 0, sizeof seen);
    seen.wait = mega_symbol("hal_clock_wait_until");
    seen.console = mega_symbol("hal_console_read");
    set_stop();
}

void mega_reset(uint8_t flag) {
    avr_reset(avr);
    avr->data[REG_MCUSR] = flag;
    mega_parts_start();
    heard_bytes = said_bytes = 0;
    forget_times();
    set_stop();
}

/* --- the console ---------------------------------------------------------------------------------------- */

void mega_say(const char *line) {
    const size_t length = strlen(line);
    if (said_bytes + length + 1U > sizeof said) {
        fail("too much is said at once");
    }
    for (size_t i = 0; i < length; i++) {
        said[said_bytes++] = line[i];
    }
    said[said_bytes++] = '\r';
}

static bool take_line(char *line, unsigned room) {
    const char *end = memchr(heard, '\n', heard_bytes);
    if (end == NULL) {
        return false;
    }
    const unsigned taken = (unsigned)(end - heard) + 1U;
    unsigned length = taken - 1U;
    while (length > 0 && heard[length - 1U] == '\r') {
        length--;
    }
    length = length < room - 1U ? length : room - 1U;
    memcpy(line, heard, length);
    line[length] = '\0';
    heard_bytes -= taken;
    memmove(heard, heard + taken, heard_bytes);
    return true;
}

bool mega_hear(char *line, unsigned room, unsigned ms) {
    for (unsigned i = 0; i <= ms; i++) {
        while (take_line(line, room)) {
            if (line[0] != '\0') {
                return true;
            }
        }
        if (!mega_run(1)) {
            return false;
        }
    }
    return false;
}

bool mega_answers(const char *order, const char *begin, char *line, unsigned room) {
    mega_say(order);
    if (!mega_hear(line, room, 3000)) {
        printf("# '%s' is not answered\n", order);
        return false;
    }
    if (strncmp(line, begin, strlen(begin)) != 0) {
        printf("# '%s' is answered '%s', not '%s'\n", order, line, begin);
        return false;
    }
    return true;
}

/* --- inspecting the chip --------------------------------------------------------------------------------- */

uint64_t mega_cycle(void) { return avr->cycle; }
mega_times *mega_times_now(void) { return &times; }
hal_virtual_rig *mega_plant(void) { return &plant; }
uint8_t *mega_data(void) { return avr->data; }
uint32_t mega_pc(void) { return avr->pc; }
void mega_set_pc(uint32_t at) { avr->pc = at; }
uint16_t mega_sp(void) { return word_at(REG_SPL); }

/* Pushes a return address as a call does: three bytes, a count of words, the highest byte at the lowest address. */
void mega_push_pc(void) {
    const uint16_t sp = mega_sp();
    const uint32_t words = avr->pc / 2U;
    avr->data[sp] = (uint8_t)words;
    avr->data[sp - 1U] = (uint8_t)(words >> 8);
    avr->data[sp - 2U] = (uint8_t)(words >> 16);
    avr->data[REG_SPL] = (uint8_t)(sp - 3U);
    avr->data[REG_SPL + 1U] = (uint8_t)((sp - 3U) >> 8);
}

void mega_call(uint32_t at, const uint8_t arguments[4]) {
    uint8_t registers[32];
    uint8_t flags[sizeof avr->sreg];
    const uint32_t back = avr->pc;
    const uint16_t sp = mega_sp();
    const uint64_t end = avr->cycle + MEGA_HZ;
    memcpy(registers, avr->data, sizeof registers);
    memcpy(flags, avr->sreg, sizeof flags);
    memcpy(avr->data + 22, arguments, 4);
    mega_push_pc();
    avr->pc = at;
    while (avr->pc != back || mega_sp() != sp) {
        if (!mega_step() || avr->cycle > end) {
            fail("what was called does not return");
        }
    }
    memcpy(avr->data, registers, sizeof registers);
    memcpy(avr->sreg, flags, sizeof flags);
}

uint16_t mega_set_flash(uint32_t at, uint16_t word) {
    const uint16_t before = (uint16_t)(avr->flash[at] | avr->flash[at + 1U] << 8);
    avr->flash[at] = (uint8_t)word;
    avr->flash[at + 1U] = (uint8_t)(word >> 8);
    return before;
}

uint8_t *mega_eeprom(void) {
    avr_eeprom_desc_t all = {.ee = eeprom, .offset = 0, .size = sizeof eeprom};
    if (avr != NULL) {
        avr_ioctl(avr, AVR_IOCTL_EEPROM_GET, &all);
    }
    eeprom_known = true;
    return eeprom;
}
