/* rig_frames.h: what the rig's controller tells of itself at the other end of a line: whoever judges a run sees what the
 * controller took it for. The plant has none of it. */
#ifndef HAL_FRAMES_RIG_FRAMES_H
#define HAL_FRAMES_RIG_FRAMES_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Notes, in the order of their channels: X(name, word, unit). The state is wh_rig_stage(); its, the trip's and the
 * quality's numbers are those of core/rig, `reset` is hal_reset_cause(); the others are the result's, which is none while it
 * has no turns. */
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

/* From now on; it goes with the outputs when the controller waits next. */
void hal_frames_note(unsigned channel, float value);

/* Round each control step, without what it takes to read sensors, to set outputs and to print: see
 * hal_turns_step_begins(). They are calls, so that whoever counts from outside finds them, too. */
void hal_frames_step_begins(void);
void hal_frames_step_ends(void);

/* The program ends: see hal_turns_end(). */
void hal_frames_end(int status);

/* What an operator dials in before a run, and the notes that go with it: of programs that ask for dials before
 * hal_clock_start(). X(name, word, unit, largest either way), the notes above but for the largest. */
#define HAL_DIAL_ROWS(X) \
    X(HAL_DIAL_SPEED, "dial_speed", "rad/s", 64.0f) \
    X(HAL_DIAL_RADIUS, "dial_radius", "m", 1.0f) \
    X(HAL_DIAL_RATIO, "dial_ratio", "1", 16.0f)
#define HAL_DIAL_NOTE_ROWS(X) X(HAL_NOTE_DISPLACEMENT, "displacement", "m")

/* Those of the rig on its bench: set-point; gravity's torque that is fed forward in every run, as a part of what it should be,
 * 0: all of it, where the set-point asks for it; 1: the motor brakes at a run's end and after stop. */
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

#define HAL_DIAL_TICKS 100000U /* from one reading of a dial to the next */

/* Before hal_clock_start(): the carriage has dials, or the bench. */
void hal_frames_with_dials(void);
void hal_frames_with_bench_dials(void);

/* As last read; 0 before that. */
float hal_frames_dial(unsigned which);

/* Was each of them read? */
bool hal_frames_dials_heard(void);

#ifdef __cplusplus
}
#endif

#endif
