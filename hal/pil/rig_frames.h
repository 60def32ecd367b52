/* rig_frames.h: notes from the rig's controller, by which the program at the other end of the line judges the run. */
#ifndef HAL_PIL_RIG_FRAMES_H
#define HAL_PIL_RIG_FRAMES_H

#include <stdbool.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Notes in the order of their channels, X(name, word, unit). `state` is wh_rig_stage(), `trip` a wh_trip, `reset`
 * hal_reset_cause(). The others come from the last result (wh_measured). */
#define HAL_NOTE_ROWS(X) \
    X(HAL_NOTE_STATE, "state", "1") \
    X(HAL_NOTE_TRIP, "trip", "1") \
    X(HAL_NOTE_QUALITY, "quality", "1") \
    X(HAL_NOTE_AMPLITUDE, "amplitude", "N") \
    X(HAL_NOTE_AMPLITUDE_HALF, "amplitude_half", "N") \
    X(HAL_NOTE_PHASE, "phase", "rad") \
    X(HAL_NOTE_PHASE_HALF, "phase_half", "rad") \
    X(HAL_NOTE_TURNS, "turns", "1") \
    X(HAL_NOTE_RESET, "reset", "1")

enum {
#define ROW(name, word, unit) name,
    HAL_NOTE_ROWS(ROW)
#undef ROW
};

/* Sets a note, which the next wait sends with the outputs. */
void hal_frames_note(unsigned channel, float value);

/* Call these at the begin and at the end of each control step (turns.h). A debugger can count the
 * instructions between the two calls. */
void hal_frames_step_begins(void);
void hal_frames_step_ends(void);

/* Reports the end of the program to the plant (hal_turns_end()). */
void hal_frames_end(int status);

/* The carriage operator's dials, X(name, word, unit, largest magnitude). A program with these dials also reports
 * HAL_DIAL_NOTE_ROWS, X(name, word, unit). */
#define HAL_DIAL_ROWS(X) \
    X(HAL_DIAL_SPEED, "dial_speed", "rad/s", 64.0f) \
    X(HAL_DIAL_RADIUS, "dial_radius", "m", 1.0f) \
    X(HAL_DIAL_RATIO, "dial_ratio", "1", 16.0f)
#define HAL_DIAL_NOTE_ROWS(X) X(HAL_NOTE_DISPLACEMENT, "displacement", "m")

/* The bench operator's dials. If dial_feed is 0, the configuration decides when to compensate gravity. Otherwise
 * gravity is always compensated, and dial_feed multiplies the compensation. If dial_brakes is 1, the motor brakes at a
 * run's end and after stop. */
#define HAL_BENCH_DIAL_ROWS(X) \
    X(HAL_DIAL_TARGET, "dial_speed", "rad/s", 64.0f) \
    X(HAL_DIAL_COMPENSATION, "dial_feed", "1", 4.0f) \
    X(HAL_DIAL_BRAKES, "dial_brakes", "1", 4.0f)

#define ROW(name, word, unit, largest) name,
enum { HAL_DIAL_ROWS(ROW) HAL_DIALS };
enum { HAL_BENCH_DIAL_ROWS(ROW) HAL_BENCH_DIALS };
#undef ROW
enum {
    HAL_NOTES_BEFORE_DIALS = HAL_NOTE_RESET,
#define ROW(name, word, unit) name,
    HAL_DIAL_NOTE_ROWS(ROW)
#undef ROW
};

#define HAL_DIAL_TICKS 100000U /* time between two readings of a dial */

/* For a program with dials: call one of these before hal_clock_start(). */
void hal_frames_with_dials(void);
void hal_frames_with_bench_dials(void);

/* Returns the dial's last reading; 0 before the first reading. */
float hal_frames_dial(unsigned which);

/* True if every dial has been read at least once. */
bool hal_frames_dials_heard(void);

WH_C_END

#endif
