/* ledger_step.h: fills the ledger (ledger.h) while a scene steps. C only. */
#ifndef WH_LEDGER_STEP_H
#define WH_LEDGER_STEP_H

#include "../step.h"
#include "driven.h"
#include "stabilize.h"

/* Maximum number of entries. A generated scene defines its own. */
#ifndef WH_LEDGER_MAX
#define WH_LEDGER_MAX 2048
#endif

typedef struct wh_ledger_work {
    wh_real attempt[WH_LEDGER_MAX]; /* entries of the present trial step */
    wh_real step[WH_LEDGER_MAX];    /* entries of the whole step so far */
    wh_real span;                   /* length of the present trial step, s; zero: no trial step */
    const wh_angle *angle;          /* angles at the begin of the trial step */
    unsigned stage;
} wh_ledger_work;

/* Returns the stage's weight in the method's quadrature, without a table in memory. */
WH_INLINE wh_real wh_ledger_weight(wh_method method, unsigned stage) {
    const wh_tableau *by = wh_tableau_of(method);
    wh_real rates = by->rates[0];
    WH_UNROLL
    for (unsigned s = 1; s < WH_STAGES; s++) {
        if (s < by->stages && by->rates[s] != by->rates[0] && stage == s) {
            rates = by->rates[s];
        }
    }
    return rates / by->parts;
}

/* Begin a trial step at `angle` [form->angles]. The angles must not change before the last stage. */
WH_INLINE void wh_ledger_begin(const wh_ledger_form *form, const wh_angle *angle, wh_ledger_work *w,
                               wh_real span) {
    for (unsigned i = 0; i < form->entries; i++) {
        w->attempt[i] = WH_R(0.0);
    }
    w->span = span;
    w->angle = angle;
    w->stage = 0;
}

WH_INLINE void wh_ledger_accept(const wh_ledger_form *form, wh_ledger_work *w) {
    for (unsigned i = 0; i < form->entries; i++) {
        w->step[i] += w->attempt[i];
    }
}

/* Adds a stage to the smooth entries (ledger.h). Returns the stage's weight times the length of the trial step, s. */
WH_INLINE wh_real wh_ledger_stage(const wh_ledger_form *form, wh_method method,
                                  const wh_phase *phase, const wh_real *linear, const wh_real *rate,
                                  const wh_real *input, wh_ledger_work *w) {
    wh_real power[WH_LEDGER_MAX];
    for (unsigned i = 0; i < form->smooth; i++) {
        power[i] = WH_R(0.0);
    }
    const wh_real share = w->span * wh_ledger_weight(method, w->stage++);
    if (form->turned != NULL) {
        wh_angle angle[WH_COORDS];
        for (unsigned i = 0; i < form->angles; i++) {
            angle[i] = wh_angle_near(w->angle[i], phase[i]);
        }
        form->turned(form->model, angle, linear, rate, input, power);
    } else {
        form->powers(form->model, phase, linear, rate, input, power);
    }
    for (unsigned i = 0; i < form->smooth; i++) {
        w->attempt[i] += share * power[i];
    }
    return share;
}

/* Call this before a step. If inputs have changed, w->step[] gets one energy change for each input. */
static inline void wh_ledger_move(const wh_ledger_form *form, const wh_state *state,
                                  wh_ledger_work *w) {
    const wh_real *kept = wh_ledger_kept(form, state);
    wh_real level[WH_ACCOUNTS_MAX];
    bool changed = false;
    for (unsigned k = 0; k < form->inputs; k++) {
        changed = changed || kept[k] != state->input[form->input[k]];
    }
    if (!changed) {
        return;
    }
    for (unsigned k = 0; k < form->inputs; k++) {
        wh_ledger_exchange(form, state, k);
    }
    wh_ledger_levels(form, state, level);
    for (unsigned k = 0; k < form->inputs; k++) {
        const wh_real before = level[0];
        wh_ledger_exchange(form, state, k);
        wh_ledger_levels(form, state, level);
        w->step[wh_ledger_of_input(form) + k] = level[0] - before;
    }
}

/* Call this before a step. Before the first step it stores the accounts' levels at the start of the run. */
WH_INLINE void wh_ledger_open(const wh_ledger_form *form, wh_state *state, wh_ledger_work *w) {
    for (unsigned i = 0; i < form->entries; i++) {
        w->step[i] = WH_R(0.0);
    }
    w->span = WH_R(0.0);
    if (state->steps == 0) {
        wh_ledger_levels(form, state, state->ledger + 2U * form->entries);
    } else {
        wh_ledger_move(form, state, w);
    }
}

/* Call this after a step. It adds the step's entries to the totals, and stabilizes the energy if form->stabilized. */
WH_INLINE void wh_ledger_commit(const wh_ledger_form *form, const wh_ledger_work *w,
                                wh_state *state) {
    wh_real *total = state->ledger;
    wh_real *carry = state->ledger + form->entries;
    for (unsigned i = 0; i < form->entries; i++) {
        total[i] = wh_sum(total[i], w->step[i], true, &carry[i]);
    }
    for (unsigned k = 0; k < form->inputs; k++) {
        wh_ledger_kept(form, state)[k] = state->input[form->input[k]];
    }
    if (form->stabilized) {
        wh_real level[WH_ACCOUNTS_MAX];
        wh_stabilize(form, state, level);
    }
}

typedef struct wh_ledger_model {
    const wh_ledger_form *form;
    const void *model;
    wh_accel_fn *accel;
    wh_method method;
    wh_ledger_work *work;
} wh_ledger_model;

/* A wh_accel_fn that also enters the stage in the ledger. */
WH_INLINE void wh_ledger_accel(const void *of, const wh_phase *phase, const wh_real *linear,
                               const wh_real *rate, const wh_real *input, wh_real *accel) {
    const wh_ledger_model *m = of;
    m->accel(m->model, phase, linear, rate, input, accel);
    (void)wh_ledger_stage(m->form, m->method, phase, linear, rate, input, m->work);
}

/* wh_step_second() with a ledger. */
WH_INLINE wh_status wh_step_ledger(const wh_ledger_form *form, const void *model,
                                   wh_accel_fn *accel, wh_method method, bool compensated,
                                   wh_two_part h, wh_state *state) {
    wh_ledger_work work;
    const wh_ledger_model with = {form, model, accel, method, &work};
    wh_ledger_open(form, state, &work);
    wh_ledger_begin(form, state->angle, &work, h.high);
    const wh_status status = wh_step_second(&with, wh_ledger_accel, method, compensated,
                                            form->angles, form->coordinates, h, state);
    if (status == WH_OK) {
        wh_ledger_accept(form, &work);
        wh_ledger_commit(form, &work, state);
    }
    return status;
}

#endif
