/* rig_frames.c: the rig's hal_ functions for a plant at the other end of a line. Signals have the names of
 * docs/plants/rig.whirl or carriage.whirl. Simulated time stops while the controller computes; the plant gets the
 * computing time with the outputs, and delays the outputs by that time. */
#include "rig_frames.h"

#include <stddef.h>

#include "core/text.h"
#include "hal/clock.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/reset.h"
#include "hal/slots.h"
#include "hal/stop.h"
#include "hal/watchdog.h"
#include "turns.h"

#if !WH_DOUBLE

#define RAD_PER_DEG 0.0174532925f
/* 12-bit converter for 0 to 60 V */
#define SUPPLY_FULL_mV 60000U
#define SUPPLY_COUNTS 4096
#define SUPPLY_V_PER_COUNT ((float)SUPPLY_FULL_mV / 1000.0f / (float)SUPPLY_COUNTS)
_Static_assert(HAL_MOTOR_SUPPLY_IS_SEEN(HAL_MOTOR_SUPPLY_MOST_mV, SUPPLY_FULL_mV),
               "the measurement ends too near to its limit");
#define SUPPLY_RATED_V 24.0f /* initial value of supply_V */

#define WRAP_AFTER_S 5U /* short, so that every run tests a wrap of the timer */

/* A sensor gives a pulse while the slot, 2 * HAL_SLOT_LEAD_DEG wide, is in front of it. */
#define SLOT_AT(deg) \
    { \
        .kind = WH_SIGNAL_EDGE, .name = "theta", .unit = "rad", \
        .low = ((deg)-HAL_SLOT_LEAD_DEG) * RAD_PER_DEG, \
        .high = ((deg) + HAL_SLOT_LEAD_DEG) * RAD_PER_DEG \
    }

enum { DUTY, ENABLE };                    /* outputs */
enum { CELL_FORCE, SUPPLY, STOP, DIALS }; /* samples; DIALS is the first dial */

/* The rounding error of a dial's reading, half a count, is smaller than the tests' tolerances. */
#define DIAL_PER_COUNT (1.0f / 1048576.0f)

static const wh_signal signals[] = {
    {.kind = WH_SIGNAL_OUTPUT, .name = "duty", .unit = "1", .low = 0.0f, .high = 1.0f},
    {.kind = WH_SIGNAL_OUTPUT, .name = "enable", .unit = "1", .low = 0.0f, .high = 1.0f},
    SLOT_AT(0.0f),
    SLOT_AT(90.0f),
    {.kind = WH_SIGNAL_SAMPLE,
     .name = "cell_force",
     .unit = "N",
     .low = -HAL_LOADCELL_RAW_MAX * HAL_LOADCELL_N_PER_COUNT,
     .high = HAL_LOADCELL_RAW_MAX * HAL_LOADCELL_N_PER_COUNT,
     .per_count = HAL_LOADCELL_N_PER_COUNT,
     .period_ticks = HAL_LOADCELL_PERIOD_TICKS},
    {.kind = WH_SIGNAL_SAMPLE,
     .name = "supply",
     .unit = "V",
     .low = 0.0f,
     .high = (float)(SUPPLY_COUNTS - 1) * SUPPLY_V_PER_COUNT,
     .per_count = SUPPLY_V_PER_COUNT,
     .period_ticks = HAL_LOADCELL_PERIOD_TICKS},
    {.kind = WH_SIGNAL_SAMPLE, /* a digital pin: 0 or 1 */
     .name = "stop_input",
     .unit = "1",
     .low = -1.0f,
     .high = 2.0f,
     .per_count = 1.0f,
     .period_ticks = HAL_STOP_PERIOD_TICKS},
#define ROW(channel, word, si) {.kind = WH_SIGNAL_NOTE, .name = (word), .unit = (si)},
    HAL_NOTE_ROWS(ROW)
#undef ROW
};

#define DIAL(which, word, si, most) \
    {.kind = WH_SIGNAL_SAMPLE, \
     .name = (word), \
     .unit = (si), \
     .low = -(most), \
     .high = (most), \
     .per_count = (most)*DIAL_PER_COUNT, \
     .period_ticks = HAL_DIAL_TICKS},
#define ROW(channel, word, si) {.kind = WH_SIGNAL_NOTE, .name = (word), .unit = (si)},
static const wh_signal carriage_signals[] = {HAL_DIAL_ROWS(DIAL) HAL_DIAL_NOTE_ROWS(ROW)};
static const wh_signal bench_signals[] = {HAL_BENCH_DIAL_ROWS(DIAL)};
#undef ROW
#undef DIAL

enum {
    SIGNALS = sizeof signals / sizeof signals[0],
    CARRIAGE_SIGNALS = sizeof carriage_signals / sizeof carriage_signals[0],
    BENCH_SIGNALS = sizeof bench_signals / sizeof bench_signals[0]
};
_Static_assert(SIGNALS + CARRIAGE_SIGNALS <= WH_SIGNALS_MAX, "room for all");
_Static_assert(SIGNALS + BENCH_SIGNALS <= WH_SIGNALS_MAX, "room for all");

static hal_turns plant;
static float supply_V = SUPPLY_RATED_V;
static bool stop_pressed;
static bool stop_heard;     /* false before the first reading and after a long silence */
static uint32_t stop_ticks; /* time of the last reading of stop */
static uint32_t load_ticks;
static bool load_seen;         /* load_ticks is valid */
static const wh_signal *dials; /* dials first, then their notes; NULL: no dials */
static unsigned dial_signals;
static float dial[HAL_DIALS];
static bool dial_heard[HAL_DIALS];
_Static_assert((int)HAL_BENCH_DIALS <= (int)HAL_DIALS, "room for either's");

static void see_dial(const wh_sample *sample) {
    const unsigned which = (unsigned)sample->channel - DIALS;
    if (which < HAL_DIALS && which < dial_signals) {
        dial[which] = (float)sample->raw * dials[which].per_count;
        dial_heard[which] = true;
    }
}

/* If no reading of the stop input comes for this time, the input counts as pressed. */
#define STOP_SILENCE_TICKS (25U * HAL_STOP_PERIOD_TICKS)

/* Takes the newest readings of supply, stop and dials. */
static void see_levels(void) {
    if (plant.ticks - stop_ticks > STOP_SILENCE_TICKS) {
        stop_heard = false;
    }
    for (unsigned i = plant.sample; i < plant.readings.samples; i++) {
        const wh_sample *sample = &plant.readings.sample[i];
        if (sample->channel == SUPPLY) {
            supply_V = sample->raw < SUPPLY_COUNTS - 1 ? (float)sample->raw * SUPPLY_V_PER_COUNT
                                                       : HAL_MOTOR_SUPPLY_BEYOND;
        } else if (sample->channel == STOP) {
            stop_pressed = sample->raw != 0 || sample->status != WH_SAMPLE_GOOD;
            stop_heard = true;
            stop_ticks = plant.ticks;
        } else if (sample->channel >= DIALS) {
            see_dial(sample);
        }
    }
}

bool hal_clock_start(void) {
    static wh_signal all[WH_SIGNALS_MAX];
    unsigned count = 0;
    for (unsigned i = 0; i < SIGNALS; i++) {
        all[count++] = signals[i];
    }
    for (unsigned i = 0; i < dial_signals; i++) {
        all[count++] = dials[i];
    }
    const wh_hello hello = {.program = dials == NULL               ? "rig"
                                       : dials == carriage_signals ? "rig_dials"
                                                                   : "rig_dialled",
                            .ticks_per_s = HAL_TICKS_PER_S,
                            .start_ticks = 0U - WRAP_AFTER_S * HAL_TICKS_PER_S,
                            .signal = all,
                            .signals = count};
    return hal_turns_start(&plant, &hello);
}

void hal_frames_end(int status) { hal_turns_end(&plant, status); }

hal_clock_source hal_clock_source_now(void) { return HAL_CLOCK_PLAYED; }

uint32_t hal_clock_ticks(void) { return plant.ticks; }

void hal_clock_wait_until(uint32_t ticks) {
    if ((int32_t)(ticks - plant.ticks) > 0) {
        hal_turns_wait(&plant, ticks);
        see_levels();
    }
}

/* Sets the chopper's duty, clamped to 0 ... 1 (NaN: 0). */
static void drive(float duty) {
    hal_turns_set(&plant, DUTY, duty > 1.0f ? 1.0f : duty > 0.0f ? duty : 0.0f);
    hal_turns_set(&plant, ENABLE, 1.0f);
}

static bool motor_started;

unsigned hal_motor_status(void) { return hal_turns_is_cut(&plant) ? HAL_MOTOR_CUT : 0U; }

unsigned hal_motor_start(void) {
    if (!motor_started && !hal_turns_is_cut(&plant)) {
        motor_started = true;
        drive(0.0f);
    }
    return hal_motor_status();
}

/* If no supply voltage is measured, the duty is 0, because the division would fail. */
void hal_motor_set_voltage(float volts) {
    if (motor_started) {
        drive(supply_V > SUPPLY_V_PER_COUNT ? volts / supply_V : 0.0f);
    }
}

void hal_motor_off(hal_motor_off_way way) {
    motor_started = false;
    hal_turns_set(&plant, DUTY, 0.0f);
    hal_turns_set(&plant, ENABLE, way == HAL_MOTOR_BRAKE ? 1.0f : 0.0f);
}

float hal_motor_supply_V(void) { return supply_V; }

float hal_motor_supply_most_V(void) { return (float)HAL_MOTOR_SUPPLY_MOST_mV / 1000.0f; }

void hal_frames_note(unsigned channel, float value) { hal_turns_note(&plant, channel, value); }

void hal_frames_step_begins(void) { hal_turns_step_begins(&plant); }

void hal_frames_step_ends(void) { hal_turns_step_ends(&plant); }

void hal_frames_with_dials(void) {
    dials = carriage_signals;
    dial_signals = CARRIAGE_SIGNALS;
}

void hal_frames_with_bench_dials(void) {
    dials = bench_signals;
    dial_signals = BENCH_SIGNALS;
}

float hal_frames_dial(unsigned which) { return which < HAL_DIALS ? dial[which] : 0.0f; }

bool hal_frames_dials_heard(void) {
    for (unsigned i = 0; i < dial_signals && i < HAL_DIALS; i++) {
        if (dials[i].kind == WH_SIGNAL_SAMPLE && !dial_heard[i]) {
            return false;
        }
    }
    return true;
}

bool hal_slots_take(hal_slot_edge *edge) {
    wh_edge played;
    if (!hal_turns_take_edge(&plant, &played)) {
        return false;
    }
    *edge = (hal_slot_edge){.ticks = played.ticks, .sensor = played.channel};
    return true;
}

/* Returns the number of lost edges and lost samples. */
uint32_t hal_slots_overruns(void) { return plant.lost; }

bool hal_loadcell_take(hal_load_sample *sample) {
    wh_sample one;
    do {
        if (!hal_turns_take_sample(&plant, &one)) {
            return false;
        }
    } while (one.channel != CELL_FORCE);
    const bool again = load_seen && one.ticks == load_ticks;
    load_seen = true;
    load_ticks = one.ticks;
    sample->ticks = one.ticks;
    sample->raw = one.raw;
    sample->status = again                               ? HAL_LOAD_REPEATED
                     : one.status == WH_SAMPLE_GOOD      ? HAL_LOAD_OK
                     : one.status == WH_SAMPLE_SATURATED ? HAL_LOAD_SATURATED
                                                         : HAL_LOAD_DISCONNECTED;
    return true;
}

void hal_watchdog_start(uint32_t timeout_ticks) { hal_turns_watch(&plant, timeout_ticks); }

void hal_watchdog_kick(void) { hal_turns_alive(&plant); }

bool hal_watchdog_has_cut(void) { return hal_turns_is_cut(&plant); }

bool hal_stop_pressed(void) { return stop_pressed || !stop_heard; }

hal_stop_source hal_stop_source_now(void) { return HAL_STOP_INPUT; }

bool hal_stop_heard(void) { return stop_heard; }

_Static_assert(sizeof plant.reset.remembered >= HAL_REMEMBER_BYTES, "the line takes them");

hal_reset hal_reset_cause(void) {
    return plant.reset.cause == 0                   ? HAL_RESET_POWER_ON
           : plant.reset.cause == WH_RESET_WATCHDOG ? HAL_RESET_WATCHDOG
                                                    : HAL_RESET_OTHER;
}

unsigned hal_reset_words(char *words, unsigned room) {
    wh_text text;
    wh_text_start(&text, words, room);
    wh_text_add(&text, plant.reset.cause == 0                   ? "power on"
                       : plant.reset.cause == WH_RESET_WATCHDOG ? "watchdog"
                                                                : "other");
    return text.length;
}

void hal_reset_mark(uint32_t state) { (void)state; }

void hal_remember(const void *bytes, unsigned count) { hal_turns_remember(&plant, bytes, count); }

unsigned hal_recall(void *bytes) {
    uint8_t *to = bytes;
    for (unsigned i = 0; i < plant.reset.count; i++) {
        to[i] = plant.reset.remembered[i];
    }
    return plant.reset.count;
}

#endif
