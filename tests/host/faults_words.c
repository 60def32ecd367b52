/* faults_words.c: the controller's states and trips, as its headers have them: the only place of the campaign that knows
 * which controller it is. */
#include "core/rig/datasheet.h"
#include "core/rig/life.h"
#include "core/rig/rig.h"
#include "core/rig/run.h"
#include "faults.h"
#include "hal/frames/rig_frames.h"

enum {
    RUNNING_AT = 100
}; /* phases of a run are numbered from here, states of the life cycle from 0 */

/* About as long as a healthy run to 330 rpm is there. */
static const struct {
    int state;
    double span_s;
} stages[] = {
    {WH_LIFE_IDLE, 1.5},
    {RUNNING_AT + WH_PHASE_TARE, 0.5},
    {RUNNING_AT + WH_PHASE_SPIN_UP, 1.0},
    {RUNNING_AT + WH_PHASE_RAMP, 2.5},
    {RUNNING_AT + WH_PHASE_SETTLE, 3.2},
    {RUNNING_AT + WH_PHASE_RECORD, 2.0},
    {RUNNING_AT + WH_PHASE_RAMP_DOWN, 2.2},
    {RUNNING_AT + WH_PHASE_OFF, 2.5},
};

static const char *word_of(int state) {
    return state >= RUNNING_AT ? wh_phase_text((wh_rig_phase)(state - RUNNING_AT))
                               : wh_life_text((wh_life)state);
}

static void when_of(int state, rig_stage *stage) {
    const bool runs = state >= RUNNING_AT;
    snprintf(stage->when, sizeof stage->when, "%s=%d", runs ? "phase_of_run" : "state",
             runs ? state - RUNNING_AT : state);
}

static int state_of(const float *note) {
    const int phase = (int)note[HAL_NOTE_PHASE_OF_RUN];
    return phase != (int)WH_PHASE_NONE ? RUNNING_AT + phase : (int)note[HAL_NOTE_STATE];
}

bool rig_is_tripped(const float *note) { return (int)note[HAL_NOTE_STATE] == (int)WH_LIFE_TRIPPED; }

enum { STAGES = sizeof stages / sizeof stages[0] };

unsigned rig_stages(rig_stage *stage) {
    for (unsigned i = 0; i < STAGES; i++) {
        stage[i] = (rig_stage){.word = word_of(stages[i].state), .span_s = stages[i].span_s};
        when_of(stages[i].state, &stage[i]);
    }
    return STAGES;
}

int rig_stage_of(const float *note) {
    for (int i = 0; i < STAGES; i++) {
        if (stages[i].state == state_of(note)) {
            return i;
        }
    }
    return -1;
}

const char *rig_trip_word(int trip) { return wh_trip_text((wh_trip)trip); }

double rig_limit_rpm(void) { return (double)WH_RIG_SHAFT_LIMIT_RPM; }
