/* rig_frames.h: notes from the rig's controller to the other end of the line: a judge of the run sees the controller's
 * own findings. The plant does not use them. */
#ifndef HAL_FRAMES_RIG_FRAMES_H
#define HAL_FRAMES_RIG_FRAMES_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Notes, in the order of their channels: X(name, word, unit). The state is wh_rig_stage(); its, the trip's and the
 * quality's numbers are those of core/rig; `reset` is hal_reset_cause(). The others are the result's; without turns
 * there is no result. */
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

/* Set a note; it goes with the outputs at the controller's next wait. */
void hal_frames_note(unsigned channel, float value);

/* At the beginning and end of each control step, excluding the time to read sensors, set outputs and print: see
 * hal_turns_step_begins(). They are functions, so that a debugger can count from them, too. */
void hal_frames_step_begins(void);
void hal_frames_step_ends(void);

/* The program ends: see hal_turns_end(). */
void hal_frames_end(int status);

/* An operator's dials, set before a run, and the notes with their values: for programs that ask for dials before
 * hal_clock_start(). X(name, word, unit, largest either way); the notes above are without the largest. */
#define HAL_DIAL_ROWS(X) \
    X(HAL_DIAL_SPEED, "dial_speed", "rad/s", 64.0f) \
    X(HAL_DIAL_RADIUS, "dial_radius", "m", 1.0f) \
    X(HAL_DIAL_RATIO, "dial_ratio", "1", 16.0f)
#define HAL_DIAL_NOTE_ROWS(X) X(HAL_NOTE_DISPLACEMENT, "displacement", "m")

/* Dials of the rig on its bench. The set-point. The torque fed forward in every run, in parts of gravity's; 0: all of
 * it, if the set-point needs it. 1: the motor brakes at a run's end and after stop. */
#define HAL_BENCH_DIAL_ROWS(X) \
    X(HAL_DIAL_TARGET, "dial_speed", "rad/s", 64.0f) \
    X(HAL_DIAL_FEED, "dial_feed", "1", 4.0f) \
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

#define HAL_DIAL_TICKS 100000U /* between two readings of a dial */

/* Call it before hal_clock_start(): the carriage, or the bench, has dials. */
void hal_frames_with_dials(void);
void hal_frames_with_bench_dials(void);

/* The last reading; 0 before the first. */
float hal_frames_dial(unsigned which);

/* Was each of them read? */
bool hal_frames_dials_heard(void);

#ifdef __cplusplus
}
#endif

#endif
