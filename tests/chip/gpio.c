/* gpio.c: ports A to I of the chip model (RM0090, chapter 8) and the wiring of their pins. Alternate functions are
 * those of DS8626, table 9. */
#include <string.h>

#include "tests/chip/inner.h"

#define PORTS 9U
enum {
    MODER = 0x00,
    OTYPER = 0x04,
    OSPEEDR = 0x08,
    PUPDR = 0x0C,
    IDR = 0x10,
    ODR = 0x14,
    BSRR = 0x18,
    LCKR = 0x1C,
    AFRL = 0x20,
    AFRH = 0x24
};
enum { INPUT, OUTPUT, FUNCTION, ANALOGUE };

bool port_is_clocked(unsigned port);

static struct {
    uint32_t r[10];
    chip_level driven[16];
    chip_resistor resistor[16];
} ports[PORTS];

/* The alternate functions that a driver may select, with pin, number and meaning. */
typedef enum wire { TIM1_CH1N, TIM1_BKIN, TIM2_IN, USART6_TX, USART6_RX, DEBUG } wire;
static const struct {
    char port;
    uint8_t pin;
    uint8_t function;
    wire is;
    uint8_t channel;
} functions[] = {
    {'A', 7, 1, TIM1_CH1N, 0},  {'B', 13, 1, TIM1_CH1N, 0}, {'A', 6, 1, TIM1_BKIN, 0},
    {'B', 12, 1, TIM1_BKIN, 0}, {'A', 0, 1, TIM2_IN, 1},    {'A', 5, 1, TIM2_IN, 1},
    {'A', 15, 1, TIM2_IN, 1},   {'A', 1, 1, TIM2_IN, 2},    {'B', 3, 1, TIM2_IN, 2},
    {'A', 2, 1, TIM2_IN, 3},    {'B', 10, 1, TIM2_IN, 3},   {'A', 3, 1, TIM2_IN, 4},
    {'B', 11, 1, TIM2_IN, 4},   {'C', 6, 8, USART6_TX, 0},  {'C', 7, 8, USART6_RX, 0},
    {'A', 13, 0, DEBUG, 0},     {'A', 14, 0, DEBUG, 0},
};
#define FUNCTIONS (sizeof functions / sizeof *functions)

/* Scheduled edges, sorted by time. */
#define EDGES 4096U
static struct {
    uint64_t when;
    uint8_t port, pin;
    uint8_t level;
} edges[EDGES];
static unsigned edges_from, edges_to;

static uint32_t mode_of(unsigned port, unsigned pin) {
    return FIELD(ports[port].r[MODER / 4U], 2U * pin, 2);
}
static uint32_t function_of(unsigned port, unsigned pin) {
    return FIELD(ports[port].r[(pin < 8 ? AFRL : AFRH) / 4U], 4U * (pin % 8U), 4);
}
bool pin_is_function(unsigned port, unsigned pin, unsigned function) {
    return mode_of(port, pin) == FUNCTION && function_of(port, pin) == function;
}
bool pin_is_analogue(unsigned port, unsigned pin) { return mode_of(port, pin) == ANALOGUE; }

static const uint8_t *function_row(unsigned port, unsigned pin, wire is) {
    for (unsigned i = 0; i < FUNCTIONS; i++) {
        if (functions[i].is == is && functions[i].port == (char)('A' + port) &&
            functions[i].pin == pin && pin_is_function(port, pin, functions[i].function)) {
            return &functions[i].channel;
        }
    }
    return NULL;
}

static chip_level chip_drives(unsigned port, unsigned pin) {
    chip_level level = CHIP_OPEN;
    if (mode_of(port, pin) == OUTPUT) {
        level = (ports[port].r[ODR / 4U] & BIT(pin)) != 0 ? CHIP_HIGH : CHIP_LOW;
    } else if (function_row(port, pin, TIM1_CH1N) != NULL) {
        level = tim1_ch1n();
    } else if (function_row(port, pin, USART6_TX) != NULL) {
        level = CHIP_HIGH;
    }
    return level == CHIP_HIGH && (ports[port].r[OTYPER / 4U] & BIT(pin)) != 0 ? CHIP_OPEN : level;
}

static chip_level level_of(unsigned port, unsigned pin) {
    const chip_level inside = chip_drives(port, pin);
    const chip_level outside = ports[port].driven[pin];
    forbid_if(inside != CHIP_OPEN && outside != CHIP_OPEN && inside != outside,
              "P%c%u is driven against what is outside", (char)('A' + port), pin);
    if (outside != CHIP_OPEN) {
        return outside;
    }
    if (inside != CHIP_OPEN) {
        return inside;
    }
    if (ports[port].resistor[pin] !=
        CHIP_NO_RESISTOR) { /* the board's 10 kOhm are stronger than the chip's 40 kOhm */
        return ports[port].resistor[pin] == CHIP_TO_SUPPLY ? CHIP_HIGH : CHIP_LOW;
    }
    const uint32_t pull =
        mode_of(port, pin) == ANALOGUE ? 0 : FIELD(ports[port].r[PUPDR / 4U], 2U * pin, 2);
    return pull == 1 ? CHIP_HIGH : pull == 2 ? CHIP_LOW : CHIP_OPEN;
}

chip_level chip_pin(char port, unsigned pin) { return level_of((unsigned)(port - 'A'), pin); }

/* An open input may read as either level. */
bool pin_input(unsigned port, unsigned pin) {
    const chip_level level = level_of(port, pin);
    return level == CHIP_OPEN ? (drawn() & 1U) != 0 : level == CHIP_HIGH;
}

/* Tells other parts of the model that one of their input pins has changed. */
static void tell(unsigned port, unsigned pin) {
    const uint8_t *channel = function_row(port, pin, TIM2_IN);
    if (channel != NULL) {
        tim2_input(*channel, pin_input(port, pin));
    }
    tim1_break_input();
}
void pins_changed(void) { tim1_break_input(); }

/* True if the break's input is high. Without a selected pin it is low. */
bool break_pin_is_high(void);
bool break_pin_is_high(void) {
    for (unsigned i = 0; i < FUNCTIONS; i++) {
        if (functions[i].is == TIM1_BKIN && function_row((unsigned)(functions[i].port - 'A'),
                                                         functions[i].pin, TIM1_BKIN) != NULL) {
            return pin_input((unsigned)(functions[i].port - 'A'), functions[i].pin);
        }
    }
    return false;
}

bool serial_pin_out(void);
bool serial_pin_in(void);
bool serial_pin_out(void) { return pin_is_function(2, 6, 8); }
bool serial_pin_in(void) { return pin_is_function(2, 7, 8); }

void chip_pin_drive(char port, unsigned pin, chip_level level) {
    ports[port - 'A'].driven[pin] = level;
    tell((unsigned)(port - 'A'), pin);
}
void chip_pin_drive_at(uint64_t when, char port, unsigned pin, chip_level level) {
    edges[edges_to % EDGES].when = when;
    edges[edges_to % EDGES].port = (uint8_t)(port - 'A');
    edges[edges_to % EDGES].pin = (uint8_t)pin;
    edges[edges_to % EDGES].level = (uint8_t)level;
    edges_to++;
    forbid_if(edges_to - edges_from > EDGES, "more edges to come than there is room for");
}
void chip_pin_resistor(char port, unsigned pin, chip_resistor resistor) {
    ports[port - 'A'].resistor[pin] = resistor;
}

static uint64_t gpio_next(void) {
    return edges_from != edges_to ? edges[edges_from % EDGES].when : CHIP_NEVER;
}
static void gpio_happens(void) {
    const unsigned at = edges_from++ % EDGES;
    ports[edges[at].port].driven[edges[at].pin] = (chip_level)edges[at].level;
    tell(edges[at].port, edges[at].pin);
}

static bool here(uint32_t offset, const char *how) {
    const bool clocked = port_is_clocked(offset / 0x400U);
    forbid_if(!clocked, "%s of port %c, which has no clock", how, (char)('A' + offset / 0x400U));
    if (offset % 0x400U > AFRH) {
        forbidden("%s of port %c + 0x%03x", how, (char)('A' + offset / 0x400U), offset % 0x400U);
        return false;
    }
    return clocked;
}

static uint32_t gpio_load(uint32_t offset) {
    const unsigned port = offset / 0x400U;
    if (!here(offset, "load")) {
        return 0;
    }
    switch (offset % 0x400U) {
    case IDR: {
        uint32_t levels = 0;
        for (unsigned pin = 0; pin < 16; pin++) {
            if (mode_of(port, pin) != ANALOGUE && pin_input(port, pin)) {
                levels |= BIT(pin);
            }
        }
        return levels;
    }
    case BSRR: return 0;
    default: return ports[port].r[offset % 0x400U / 4U];
    }
}

/* PA13 and PA14 belong to the debugger. If a driver reassigns them, it locks the debugger out: a violation. */
static void debug_stays(unsigned port) {
    forbid_if(port == 0 && (!pin_is_function(0, 13, 0) || !pin_is_function(0, 14, 0)),
              "the debugger's pins are taken away");
}

static void gpio_store(uint32_t offset, uint32_t value) {
    const unsigned port = offset / 0x400U;
    uint32_t *r = ports[port].r;
    if (!here(offset, "store")) {
        return;
    }
    switch (offset % 0x400U) {
    case IDR: forbidden("store of IDR"); break;
    case ODR: r[ODR / 4U] = value & 0xFFFFU; break;
    case BSRR:
        r[ODR / 4U] = (r[ODR / 4U] & ~(value >> 16)) | (value & 0xFFFFU);
        break; /* if a bit is both set and reset, it is set */
    case MODER:
    case OTYPER:
    case OSPEEDR:
    case PUPDR:
    case AFRL:
    case AFRH: r[offset % 0x400U / 4U] = value; break;
    default: forbidden("store of GPIO + 0x%02x", offset % 0x400U); break;
    }
    debug_stays(port);
    for (unsigned pin = 0; pin < 16; pin++) {
        (void)level_of(port, pin); /* reports a short circuit, which this store may have caused */
        const uint8_t *channel = function_row(port, pin, TIM2_IN);
        if (channel != NULL) {
            tim2_input(*channel, pin_input(port, pin));
        }
    }
    tim1_break_input();
}

static void gpio_reset(void) {
    for (unsigned i = 0; i < PORTS; i++) {
        memset(ports[i].r, 0, sizeof ports[i].r);
    }
    ports[0].r[MODER / 4U] = 0xA8000000U;
    ports[0].r[PUPDR / 4U] = 0x64000000U;
    ports[1].r[MODER / 4U] = 0x00000280U;
    ports[1].r[OSPEEDR / 4U] = 0x000000C0U;
    ports[1].r[PUPDR / 4U] = 0x00000100U;
}

void pins_new(void) {
    memset(ports, 0, sizeof ports);
    for (unsigned i = 0; i < PORTS; i++) {
        for (unsigned pin = 0; pin < 16; pin++) {
            ports[i].driven[pin] = CHIP_OPEN;
        }
    }
    edges_from = edges_to = 0;
}

const part gpio_part = {.name = "GPIO",
                        .base = AT_GPIOA,
                        .bytes = PORTS * 0x400U,
                        .load = gpio_load,
                        .store = gpio_store,
                        .reset = gpio_reset,
                        .next = gpio_next,
                        .happens = gpio_happens};
