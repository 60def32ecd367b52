/* exchange.h: the payloads of the frames between a controller and the plant that it runs against.
 *
 * The controller speaks first: a `hello` names its inputs and outputs, with units and ranges. Then frames alternate.
 * The plant sends the time and the sensors' readings since the last exchange (`wh_readings`). The controller sends its
 * new outputs and the time at which it wants the next readings (`wh_orders`).
 *
 * After a reset the controller sends its hello again. The plant answers with the cause of the reset and the bytes that
 * the controller had asked it to remember.
 *
 * Times are ticks of the controller's timer, 32 bits, wrapping. Values are floats in SI units; samples are counts. */
#ifndef WH_EXCHANGE_H
#define WH_EXCHANGE_H

#include "frame.h"

WH_C_BEGIN

enum {
    WH_FRAME_HELLO = 1,
    WH_FRAME_ORDERS = 2,
    WH_FRAME_READINGS = 3,
    WH_FRAME_RESET = 4,    /* the plant sends wh_reset after a reset, before the first readings */
    WH_FRAME_REMEMBER = 5, /* before its orders, the controller sends bytes for the next wh_reset */
    /* These two are for a line on which the plant cannot see that a controller starts or ends. */
    WH_FRAME_ASK = 6, /* before the first readings, the plant requests the hello again */
    WH_FRAME_END = 7  /* a controller that ends sends its exit status (4 bytes) instead of orders */
};

#define WH_SIGNALS_MAX 20U /* all kinds together */
#define WH_EDGES_MAX 16U   /* per exchange; later edges are lost */
#define WH_SAMPLES_MAX 24U

typedef enum wh_signal_kind {
    WH_SIGNAL_OUTPUT, /* a value that the controller sets, in `low`..`high` */
    WH_SIGNAL_SAMPLE, /* a converter's counts every period_ticks: value / per_count, rounded */
    WH_SIGNAL_EDGE,   /* a pulse when the value (angle: modulo a turn) enters `low`..`high` */
    WH_SIGNAL_NOTE    /* a value that the controller reports; not a signal of the plant */
} wh_signal_kind;

/* The channels of each kind are numbered from 0 in the order of the signals. */
typedef struct wh_signal {
    wh_signal_kind kind;
    const char *name; /* name of the plant's input, output, coordinate or rate, or of the note */
    const char *unit; /* an SI unit */
    float low;
    float high;
    float per_count;       /* WH_SIGNAL_SAMPLE only: units per count */
    uint32_t period_ticks; /* WH_SIGNAL_SAMPLE only: ticks between two samples */
} wh_signal;

typedef struct wh_hello {
    const char *program;
    const char *board;
    uint32_t ticks_per_s; /* rate of all time stamps */
    uint32_t timer_per_s; /* rate of the timer that measures computing time; 0: no such timer */
    uint32_t start_ticks; /* time stamp at the plant's time 0 */
    const wh_signal *signal;
    unsigned signals;
} wh_hello;

enum { WH_ORDER_ALIVE = 1 }; /* wh_orders.flags: the watchdog is kicked */

typedef struct wh_orders {
    uint32_t until_ticks;    /* time of the next readings */
    uint32_t acted_timer;    /* timer counts from the readings' arrival to the outputs */
    uint32_t busy_timer;     /* timer counts from the readings' arrival to these orders */
    uint32_t step_timer;     /* longest control step since the last orders; 0: unknown */
    uint32_t watchdog_ticks; /* outputs become 0 after this time without WH_ORDER_ALIVE; 0: never */
    uint8_t flags;
    unsigned outputs;             /* number of outputs and notes together */
    float output[WH_SIGNALS_MAX]; /* by channel: the outputs, then the notes */
} wh_orders;

typedef struct wh_edge {
    uint32_t ticks;
    uint8_t channel;
} wh_edge;

typedef enum wh_sample_status {
    WH_SAMPLE_GOOD,
    WH_SAMPLE_SATURATED, /* the converter is at an end of its range */
    WH_SAMPLE_DISCONNECTED
} wh_sample_status;

typedef struct wh_sample {
    uint32_t ticks;
    int32_t raw;
    uint8_t channel;
    uint8_t status; /* wh_sample_status */
} wh_sample;

enum { WH_READING_CUT = 1 }; /* wh_readings.flags: the watchdog has set the outputs to 0 */

/* Edges and samples are sorted by ticks. The time of the readings themselves is the frame's `ticks`. */
typedef struct wh_readings {
    uint8_t flags;
    unsigned edges;
    unsigned samples;
    wh_edge edge[WH_EDGES_MAX];
    wh_sample sample[WH_SAMPLES_MAX];
} wh_readings;

#define WH_REMEMBER_MAX 32U

/* After a power-on the plant sends no reset frame. */
enum { WH_RESET_WATCHDOG = 1, WH_RESET_OTHER = 2 };
typedef struct wh_reset {
    uint8_t cause;
    unsigned count; /* number of bytes in remembered[] */
    uint8_t remembered[WH_REMEMBER_MAX];
} wh_reset;

#define WH_ORDERS_BYTES (22U + 4U * WH_SIGNALS_MAX)
#define WH_RESET_BYTES (1U + WH_REMEMBER_MAX)
#define WH_READINGS_BYTES (3U + 5U * WH_EDGES_MAX + 10U * WH_SAMPLES_MAX)

#define wh_hello_put WH_NAME(wh_hello_put)
#define wh_hello_get WH_NAME(wh_hello_get)
#define wh_orders_put WH_NAME(wh_orders_put)
#define wh_orders_get WH_NAME(wh_orders_get)
#define wh_readings_put WH_NAME(wh_readings_put)
#define wh_readings_get WH_NAME(wh_readings_get)
#define wh_reset_put WH_NAME(wh_reset_put)
#define wh_reset_get WH_NAME(wh_reset_get)

/* Write a payload into bytes[room]. Returns its length; 0 if it does not fit. */
unsigned wh_hello_put(const wh_hello *hello, uint8_t *bytes, unsigned room);
unsigned wh_orders_put(const wh_orders *orders, uint8_t *bytes, unsigned room);
unsigned wh_readings_put(const wh_readings *readings, uint8_t *bytes, unsigned room);
unsigned wh_reset_put(const wh_reset *reset, uint8_t *bytes, unsigned room);

/* Read a payload. Returns false if its length is wrong, a count is above its limit, or a kind or cause is unknown.
 * The strings of a hello point into `bytes`. The signals of a hello go to signal[WH_SIGNALS_MAX]. */
bool wh_hello_get(wh_hello *hello, wh_signal *signal, const uint8_t *bytes, unsigned length);
bool wh_orders_get(wh_orders *orders, const uint8_t *bytes, unsigned length);
bool wh_readings_get(wh_readings *readings, const uint8_t *bytes, unsigned length);
bool wh_reset_get(wh_reset *reset, const uint8_t *bytes, unsigned length);

WH_C_END

#endif
