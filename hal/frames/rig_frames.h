/* rig_frames.h: what the rig's controller tells of itself at the other end of a line: whoever judges a run sees what the
 * controller took it for. The plant has none of it. */
#ifndef HAL_FRAMES_RIG_FRAMES_H
#define HAL_FRAMES_RIG_FRAMES_H

#ifdef __cplusplus
extern "C" {
#endif

/* Notes, in the order of their channels: X(name, word, unit). The state is wh_rig_stage(); its, the trip's and the quality's numbers are those of
 * core/rig, `reset` is hal_reset_cause(); the others are the result's, which is none while it has no turns. */
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

#ifdef __cplusplus
}
#endif

#endif
