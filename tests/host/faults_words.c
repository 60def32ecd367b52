/* faults_words.c: the controller's states and trips, as its headers have them: the only place of the campaign that knows
 * which controller it is. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "faults.h"

#define PHASE(phase) (WH_RIG_STAGE_OF_PHASE + (unsigned)(phase))

/* About as long as a healthy run to 330 rpm is there. */
static const struct {
    unsigned stage;
    double span_s;
} stages[] = {
    {WH_LIFE_IDLE, 1.4},
    {PHASE(WH_PHASE_TARE), 0.5},
    {PHASE(WH_PHASE_SPIN_UP), 0.6},
    {PHASE(WH_PHASE_RAMP), 2.8},
    {PHASE(WH_PHASE_SETTLE), 3.2},
    {PHASE(WH_PHASE_RECORD), 2.0},
    {PHASE(WH_PHASE_RAMP_DOWN), 2.2},
    {PHASE(WH_PHASE_OFF), 2.5},
};
enum { STAGES = sizeof stages / sizeof stages[0] };

unsigned rig_stages(rig_stage *stage) {
    for (unsigned i = 0; i < STAGES; i++) {
        const unsigned which = stages[i].stage;
        stage[i] = (rig_stage){.word = wh_rig_stage_text(which), .span_s = stages[i].span_s};
        snprintf(stage[i].when, sizeof stage[i].when, "state=%u", which);
    }
    return STAGES;
}

int rig_stage_of(const float *note) {
    for (int i = 0; i < STAGES; i++) {
        if (stages[i].stage == (unsigned)note[HAL_NOTE_STATE]) {
            return i;
        }
    }
    return -1;
}

bool rig_is_tripped(const float *note) { return (int)note[HAL_NOTE_STATE] == (int)WH_LIFE_TRIPPED; }

bool rig_is_idle(const float *note) { return (int)note[HAL_NOTE_STATE] == (int)WH_LIFE_IDLE; }

const char *rig_tripped_when(void) {
    static char when[32];
    snprintf(when, sizeof when, "state=%d", (int)WH_LIFE_TRIPPED);
    return when;
}

const char *rig_trip_word(int trip) { return wh_trip_text((wh_trip)trip); }

double rig_limit_rpm(void) { return (double)WH_RIG_SHAFT_LIMIT_RPM; }
