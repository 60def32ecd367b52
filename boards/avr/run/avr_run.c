/* avr_run.c: runs an AVR program on simavr, which counts the processor's cycles.
 *
 *     avr_run mcu=atmega328p hz=16000000 [counts=FILE [every=N]] PROGRAM.elf
 *
 * Prints the output of the program's first USART. The program ends by sleeping with interrupts off. The exit status is
 * the program's GPIOR0 (boards/avr/board.c), 125 if simavr cannot run the program, or 123 if the program crashed or the
 * stack ran into the variables.
 *
 * FILE gets the log that mk/count/count_plugin.c describes, with the cycles of each interval and a last line "intervals
 * TOTAL". The program must have wh_count_begin() and wh_count_end() (boards/programs/counted.h). */
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_core.h>
#include <simavr/sim_elf.h>

#include <inttypes.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CANNOT_RUN 125
#define WENT_WRONG 123
#define GPIOR0 0x3EU          /* address in data memory, on both chips */
#define MEMORY_BASE 0x800000U /* ELF files add this to addresses in data memory */

static _Noreturn void fail(const char *what) {
    fprintf(stderr, "avr_run: %s\n", what);
    exit(CANNOT_RUN);
}

static void on_byte(struct avr_irq_t *irq, uint32_t value, void *data) {
    (void)irq;
    (void)data;
    putchar((int)(value & 0xFFU));
}

/* Shows only errors: simavr also logs every section that it loads. */
static void on_log(avr_t *avr, const int level, const char *format, va_list arguments) {
    (void)avr;
    if (level <= LOG_ERROR) {
        vfprintf(stderr, format, arguments);
    }
}

static const char *value_of(const char *argument, const char *name) {
    const size_t length = strlen(name);
    return strncmp(argument, name, length) == 0 && argument[length] == '=' ? argument + length + 1
                                                                           : NULL;
}

static uint32_t number_of(const char *text) {
    char *end = NULL;
    const unsigned long number = strtoul(text, &end, 0);
    if (end == text || *end != '\0') {
        fail("a number is expected after '='");
    }
    return (uint32_t)number;
}

typedef struct settings {
    const char *mcu;
    uint32_t hz;
    const char *counts;
    uint32_t every;
    const char *program;
} settings;

static settings read_arguments(int argc, char **argv) {
    settings all = {.every = 1};
    for (int i = 1; i < argc; i++) {
        const char *value = NULL;
        if ((value = value_of(argv[i], "mcu")) != NULL) {
            all.mcu = value;
        } else if ((value = value_of(argv[i], "hz")) != NULL) {
            all.hz = number_of(value);
        } else if ((value = value_of(argv[i], "counts")) != NULL) {
            all.counts = value;
        } else if ((value = value_of(argv[i], "every")) != NULL) {
            all.every = number_of(value);
        } else {
            all.program = argv[i];
        }
    }
    if (all.mcu == NULL || all.hz == 0 || all.every == 0 || all.program == NULL) {
        fail("usage: avr_run mcu=NAME hz=NUMBER [counts=FILE [every=N]] PROGRAM.elf");
    }
    return all;
}

static uint32_t address_of(const elf_firmware_t *firmware, const char *name) {
    for (uint32_t i = 0; i < firmware->symbolcount; i++) {
        if (strcmp(firmware->symbol[i]->symbol, name) == 0) {
            return firmware->symbol[i]->addr;
        }
    }
    return 0;
}

static avr_t *load(const settings *all, elf_firmware_t *firmware) {
    memset(firmware, 0, sizeof *firmware);
    if (elf_read_firmware(all->program, firmware) != 0) {
        fail("cannot read the program");
    }
    avr_t *avr = avr_make_mcu_by_name(all->mcu);
    if (avr == NULL || avr_init(avr) != 0) {
        fail("simavr does not know the chip");
    }
    firmware->frequency = all->hz;
    avr_load_firmware(avr, firmware);
    uint32_t flags = 0; /* simavr must not print, and must not sleep while the program polls */
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
                            on_byte, NULL);
    return avr;
}

/* address in data memory; 0: unknown */
static uint32_t end_of_variables;

static uint32_t stack_pointer(const avr_t *avr) {
    return (uint32_t)avr->data[R_SPL] | (uint32_t)avr->data[R_SPH] << 8;
}

static _Noreturn void went_wrong(const avr_t *avr, const char *what) {
    fflush(stdout);
    fprintf(stderr, "avr_run: %s at 0x%" PRIx32 "\n", what, (uint32_t)avr->pc);
    exit(WENT_WRONG);
}

#define TORN_INSTRUCTIONS 2U /* instructions for which the stack pointer may be half written */

/* Executes one instruction. Returns false if the program has ended. */
static bool step(avr_t *avr) {
    static unsigned low = 0; /* successive instructions with the stack pointer among variables */
    const int state = avr_run(avr);
    if (state == cpu_Crashed) {
        went_wrong(avr, "crashed");
    }
    const uint32_t pointer = stack_pointer(avr);
    low = pointer < end_of_variables && pointer != 0
              ? low + 1U
              : 0U; /* pointer is 0 until the start-up code sets it */
    if (low > TORN_INSTRUCTIONS) {
        went_wrong(avr, "the stack ran into the variables");
    }
    return state != cpu_Done;
}

/* Intervals reported together: `instructions` and `cycles` are maxima, `all` and `all_cycles` are sums. */
typedef struct group {
    uint64_t members;
    uint64_t instructions, cycles;
    uint64_t all, all_cycles;
} group;

static void join(group *g, uint64_t instructions, uint64_t cycles) {
    g->members++;
    g->instructions = instructions > g->instructions ? instructions : g->instructions;
    g->cycles = cycles > g->cycles ? cycles : g->cycles;
    g->all += instructions;
    g->all_cycles += cycles;
}

static void write_group(FILE *file, group *g, unsigned number, uint32_t every) {
    fprintf(file, "interval %u %" PRIu64 "\ncycles %u %" PRIu64 "\n", number, g->instructions,
            number, g->cycles);
    if (every > 1) {
        fprintf(file, "sums %u %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", number, g->members, g->all,
                g->all_cycles);
    }
    *g = (group){0};
}

static void run_counting(avr_t *avr, const settings *all, const elf_firmware_t *firmware) {
    const uint32_t begin = address_of(firmware, "wh_count_begin");
    const uint32_t end = address_of(firmware, "wh_count_end");
    if (begin == 0 || end == 0) {
        fail("the program has no wh_count_begin() and wh_count_end()");
    }
    FILE *file = fopen(all->counts, "w");
    if (file == NULL) {
        fail("cannot write the counts");
    }
    unsigned intervals = 0;
    bool counting = false;
    uint64_t instructions = 0;
    avr_cycle_count_t began = 0;
    group g = {0};
    bool running = true;
    while (running) {
        const uint32_t at = (uint32_t)avr->pc;
        const avr_cycle_count_t before = avr->cycle;
        running = step(avr);
        if (at == begin) {
            counting = true;
            instructions = 0;
            began = avr->cycle;
        } else if (at == end && counting) {
            counting = false;
            join(&g, instructions, (uint64_t)(before - began));
            if (g.members == all->every) {
                write_group(file, &g, intervals++, all->every);
            }
        } else {
            instructions++;
        }
    }
    if (g.members > 0) {
        write_group(file, &g, intervals++, all->every);
    }
    if (counting) {
        fprintf(file, "unfinished %" PRIu64 "\n", instructions);
    }
    fprintf(file, "intervals %u\n", intervals);
    if (fclose(file) != 0) {
        fail("cannot write the counts");
    }
}

int main(int argc, char **argv) {
    const settings all = read_arguments(argc, argv);
    avr_global_logger_set(on_log);
    /* line buffered, so that the output of a program that hangs is visible */
    (void)setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    elf_firmware_t firmware;
    avr_t *avr = load(&all, &firmware);
    avr->run_cycle_limit = 1; /* one instruction per call */
    const uint32_t end = address_of(&firmware, "_end");
    end_of_variables = end > MEMORY_BASE ? end - MEMORY_BASE : 0;
    if (all.counts != NULL) {
        run_counting(avr, &all, &firmware);
    } else {
        while (step(avr)) {
        }
    }
    return avr->data[GPIOR0];
}
