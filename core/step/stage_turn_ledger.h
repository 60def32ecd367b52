/* stage_turn_ledger.h: fills the ledger (ledger.h) for stages with rotated sines (stage_turn.h). C only. */
#ifndef WH_STAGE_TURN_LEDGER_H
#define WH_STAGE_TURN_LEDGER_H

#include "ledger_step.h"
#include "stage_turn.h"

typedef struct wh_turn_ledger_model {
    const wh_ledger_form *form;
    const void *model;
    wh_turned_accel_fn *accel;
    wh_method method;
    wh_ledger_work *work;
    const wh_phase *phase; /* phases of the angles [form->angles] at the present stage */
} wh_turn_ledger_model;

/* A wh_turned_accel_fn that also enters the stage in the ledger. The ledger takes m->phase, not pair[]. */
WH_INLINE void wh_turn_ledger_accel(const void *of, const wh_wave *pair, const wh_real *linear,
                                    const wh_real *rate, const wh_real *input, wh_real *accel) {
    const wh_turn_ledger_model *m = of;
    m->accel(m->model, pair, linear, rate, input, accel);
    (void)wh_ledger_stage(m->form, m->method, m->phase, linear, rate, input, m->work);
}

/* wh_turn_second() with a ledger; the state has the same bits as without. */
WH_INLINE wh_status wh_turn_ledger(const wh_ledger_form *form, const void *model,
                                   wh_turned_accel_fn *accel, const wh_waves *waves,
                                   wh_method method, bool compensated, wh_two_part h,
                                   wh_state *state) {
    wh_ledger_work work;
    wh_phase phase[WH_COORDS] = {0};
    const wh_turn_ledger_model with = {form, model, accel, method, &work, phase};
    wh_ledger_open(form, state, &work);
    wh_ledger_begin(form, state->angle, &work, h.high);
    const wh_stepping to = {wh_tableau_of(method), state,      h.high, form->angles,
                            form->coordinates,     compensated};
    const wh_status status =
        wh_turn_second_phases(&with, wh_turn_ledger_accel, waves, &to, h, phase, state);
    if (status == WH_OK) {
        wh_ledger_accept(form, &work);
        wh_ledger_commit(form, &work, state);
    }
    return status;
}

#endif
