/* step_tape.h: what control steps of the rig saw, and what they answered, to the bit: as bytes that say only what is not as it was
 * the step before (telemetry's channel `tape`, core/station/tape_out.h), and as the exchanges of a tape that `whirl pil --replay`
 * gives to the rig's controller (exchange.h; boards/programs/pil_taped.c). All who write or read either are this file.
 *
 * A tape begins with the settings, then the controller starts anew; what it saw before is of no account then. Ticks of
 * the exchanges count from there, ticks of steps are the rig's own. Floats are kept as their bits.
 *
 * The first byte of a frame of the channel says what it holds:
 *
 *   WH_TAPED_SETTINGS  some of the settings: a number of conf_rows.h and the value's bits each
 *   WH_TAPED_BEGIN     the controller has started, at the frame's ticks: what it says then, as of a step
 *   WH_TAPED_STEPS     control steps, the first at the frame's ticks
 *   WH_TAPED_END       no more will come: why, a wh_taped_end
 */
#ifndef WH_STEP_TAPE_H
#define WH_STEP_TAPE_H

#include "exchange.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Raised whenever the meaning of what is recorded changes. */
#define WH_TAPED_VERSION 1U

#define WH_TAPED_SAMPLES 2U
#define WH_TAPED_ORDERS 4U
#define WH_TAPED_PERIOD 2000U /* ticks: what is usual from one step to the next */
#define WH_TAPED_SETTING_BYTES 5U
#define WH_TAPED_SETTINGS_MOST 11U /* in one exchange */
#define WH_TAPED_STEP_BYTES 61U    /* the longest */

enum { WH_TAPED_SETTINGS, WH_TAPED_BEGIN, WH_TAPED_STEPS, WH_TAPED_END };

/* X(end, words) */
#define WH_TAPED_END_ROWS(X) \
    X(WH_TAPED_OFF, "it was switched off") \
    X(WH_TAPED_LOST, "the line was too slow for it")

#define WH_TAPED_NAME(end, words) end,
typedef enum wh_taped_end { WH_TAPED_END_ROWS(WH_TAPED_NAME) WH_TAPED_ENDS } wh_taped_end;
#undef WH_TAPED_NAME

enum { WH_TAPED_STOP = 1, WH_TAPED_FALLBACK = 2, WH_TAPED_CUT = 4 }; /* wh_taped_step.pins */

typedef struct wh_taped_sample {
    uint32_t ticks;
    int32_t raw;
    uint8_t status; /* wh_load_status: 0 to 7 */
} wh_taped_sample;

typedef struct wh_taped_order {
    uint8_t event;
    uint32_t value; /* a float's bits */
} wh_taped_order;

/* What the controller says. */
typedef struct wh_taped_answer {
    uint8_t way;
    uint32_t volts; /* a float's bits */
    uint8_t stage;
    uint8_t trip;
} wh_taped_answer;

typedef struct wh_taped_step {
    uint32_t ticks;
    uint32_t supply; /* a float's bits */
    uint8_t pins;
    bool pulsed;
    uint8_t sensor;
    uint32_t pulse_ticks;
    unsigned samples; /* so many of: */
    wh_taped_sample sample[WH_TAPED_SAMPLES];
    unsigned orders; /* given since the step before */
    wh_taped_order order[WH_TAPED_ORDERS];
    wh_taped_answer answer;
} wh_taped_step;

/* What the next step is told as a difference to. All zeros, with its ticks and answer, at the begin. */
typedef struct wh_taped_before {
    uint32_t ticks;
    uint32_t supply;
    uint8_t pins;
    uint32_t late; /* by which the last sample came behind its ticks */
    wh_taped_answer answer;
} wh_taped_before;

static inline uint32_t wh_taped_bits(float number) {
    uint32_t bits;
    __builtin_memcpy(&bits, &number, sizeof bits);
    return bits;
}

static inline float wh_taped_float(uint32_t bits) {
    float number;
    __builtin_memcpy(&number, &bits, sizeof number);
    return number;
}

#define wh_taped_put WH_NAME(wh_taped_put)
#define wh_taped_get WH_NAME(wh_taped_get)
#define wh_taped_put_answer WH_NAME(wh_taped_put_answer)
#define wh_taped_get_answer WH_NAME(wh_taped_get_answer)
#define wh_taped_hello WH_NAME(wh_taped_hello)
#define wh_taped_readings WH_NAME(wh_taped_readings)
#define wh_taped_step_of WH_NAME(wh_taped_step_of)
#define wh_taped_orders WH_NAME(wh_taped_orders)

/* A step, WH_TAPED_STEP_BYTES at most; *before becomes what the next one's is. */
void wh_taped_put(wh_taped_before *before, const wh_taped_step *step, wh_bytes *out);
/* False where there is none: too short, or of more samples or orders than there may be. */
bool wh_taped_get(wh_taped_before *before, wh_taped_step *step, wh_bytes *in);

/* All of it. */
void wh_taped_put_answer(const wh_taped_answer *answer, wh_bytes *out);
void wh_taped_get_answer(wh_taped_answer *answer, wh_bytes *in);

/* --- as exchanges ---------------------------------------------------------------------------------------------*/

/* What samples of such a tape are. */
enum {
    WH_TAPED_LOAD,
    WH_TAPED_STATUS, /* of the load behind it, where it is not good */
    WH_TAPED_SUPPLY, /* a float's bits, and so are all values */
    WH_TAPED_PINS,
    WH_TAPED_ORDER,
    WH_TAPED_ORDER_VALUE, /* behind it */
    WH_TAPED_SETTING,
    WH_TAPED_SETTING_VALUE, /* behind it */
    WH_TAPED_STARTS         /* the controller, with these settings: a WH_TAPED_VERSION */
};

/* Who plays such tapes. `board` is the caller's. */
void wh_taped_hello(wh_hello *hello, const char *board);

/* The step's inputs, its ticks less `begin_ticks`; and back. */
void wh_taped_readings(const wh_taped_step *step, uint32_t begin_ticks, wh_readings *readings);
void wh_taped_step_of(const wh_readings *readings, uint32_t now_ticks, wh_taped_step *step);

/* The answer of an exchange at `now_ticks`. */
void wh_taped_orders(const wh_taped_answer *answer, uint32_t now_ticks, wh_orders *orders);

#ifdef __cplusplus
}
#endif

#endif
