/* faults_words.c: the controller's states and trips, as its headers have them: the only place of the campaign that knows
 * which controller it is. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "faults.h"

/* About as long as a healthy run to 330 rpm is there. */
static const struct {
    wh_rig_state state;
    double span_s;
} stages[] = {
    {WH_RIG_TARE, 0.5},   {WH_RIG_SPIN_UP, 0.86},  {WH_RIG_RAMP, 2.1},  {WH_RIG_SETTLE, 3.2},
    {WH_RIG_RECORD, 2.0}, {WH_RIG_RAMP_DOWN, 2.2}, {WH_RIG_COAST, 2.5},
};

unsigned rig_stages(rig_stage *stage) {
    const unsigned count = sizeof stages / sizeof stages[0];
    for (unsigned i = 0; i < count; i++) {
        stage[i] =
            (rig_stage){(int)stages[i].state, wh_rig_state_text(stages[i].state), stages[i].span_s};
    }
    return count;
}

bool rig_is_tripped(int state) { return state == (int)WH_RIG_TRIPPED; }

const char *rig_trip_word(int trip) { return wh_trip_text((wh_trip)trip); }

double rig_limit_rpm(void) { return (double)WH_RIG_SHAFT_LIMIT_RPM; }
