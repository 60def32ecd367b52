/* turn.c: who turned too far. */
#include "stage_turn.h"

wh_status wh_turn_refuse(uint64_t angles, const wh_real *rate, wh_real h, wh_state *state) {
    wh_real most = WH_R(-1.0); /* rad a step */
    for (unsigned i = 0; i < 64U && angles >> i != 0 && most == most; i++) {
        const wh_real turn = WH_ABS(rate[i] * h);
        if ((angles >> i & 1U) != 0 && !(turn <= most)) {
            most = turn; /* what is no number is the fastest */
            state->fault = (int)i;
        }
    }
    return most * WH_PHASE_PER_RAD < WH_PHASE_STEP_MAX ? WH_E_TURN : WH_E_DIVERGED;
}
