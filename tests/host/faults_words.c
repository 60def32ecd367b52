/* faults_words.c: the words of the controller's states and trips, from its headers. Other files of the campaign do not
 * depend on the controller. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "faults.h"

#define PHASE(phase) (WH_RIG_STAGE_OF_PHASE + (unsigned)(phase))

/* Mean duration of each state in a healthy run to 330 rpm. */
static const struct {
    unsigned stage;
    double span_s;
} stages[] = {
    {WH_RIG_IDLE, 1.4},
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

bool rig_is_tripped(const float *note) { return (int)note[HAL_NOTE_STATE] == (int)WH_RIG_TRIPPED; }

bool rig_is_idle(const float *note) { return (int)note[HAL_NOTE_STATE] == (int)WH_RIG_IDLE; }

bool rig_may_drive(const float *note) {
    const unsigned stage = (unsigned)note[HAL_NOTE_STATE];
    return stage >= PHASE(WH_PHASE_SPIN_UP) && stage <= PHASE(WH_PHASE_RAMP_DOWN);
}

const char *rig_tripped_when(void) {
    static char when[32];
    snprintf(when, sizeof when, "state=%d", (int)WH_RIG_TRIPPED);
    return when;
}

const char *rig_trip_word(int trip) { return wh_trip_text((wh_trip)trip); }

double rig_limit_rpm(void) { return (double)WH_RIG_SHAFT_LIMIT_RPM; }

double rig_nominal_rpm(void) { return (double)WH_RIG_NOMINAL_RPM; }

/* A fault is detected after two pulses that come too early. They come within a turn of the fault's begin; but a pulse
 * in the first sixth of that turn is not early enough (docs/rig.md). Until then, and for one control period more, full
 * voltage drives the rotor; gravity adds its part of a turn. */
#define CAUGHT_RPM 470.0 /* at the nominal speed or below */
#define TURNS (7.0 / 6.0)
#define LAG_S 0.23 /* time constant of the rotor under full voltage: */
#define FULL_RPM 568.0
#define STEP_S 1e-5
#define PERIOD_STEPS 200 /* the control period, 2 ms */
#define INERTIA_KGM2 5.77e-3

double rig_caught_rpm(double target_rpm) {
    const double weight_Nm = (double)(WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2);
    double rpm = target_rpm;
    double turns = 0.0;
    for (unsigned late = 0; late < PERIOD_STEPS; late += turns >= TURNS) {
        rpm += (FULL_RPM - rpm) / LAG_S * STEP_S;
        turns += rpm / 60.0 * STEP_S;
    }
    const double per_radps = (double)WH_RIG_RADPS_PER_RPM;
    const double fastest = rpm + weight_Nm / (INERTIA_KGM2 * rpm * per_radps) / per_radps;
    return fastest > CAUGHT_RPM ? fastest : CAUGHT_RPM;
}
