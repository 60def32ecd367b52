/* ledger.h: the books of a run: what changed the energy and each momentum, and by how much.
 *
 * Accounts: account 0 is the energy integral sum q_i' dL/dq_i' - L (Goldstein, Classical Mechanics, section
 * 2.7), which is T + V where T is a quadratic form of the rates and V free of them; account 1 + i is the
 * generalized momentum dL/dq_i' of coordinate i (in the scene's order, conserved coordinates last). Entries
 * say what went into an account since the start: the work of each input, the loss of each damper
 * (negative), the impulse of each generalized force, for each contact its energy and its impulse along
 * each coordinate, and, where the energies name an input, what its changes between steps gave: -dL/dt of
 * an input that stands still within each step.
 *
 * The powers and forces of the smooth entries, and the contacts' forces, are integrated with the weights
 * of the method's own stages, so the books are of the method's order and a step costs one more list of
 * operations a stage; impacts, captures and assignments are entered as they happen. Sums carry their
 * rounding errors along. Whatever the entries leave of an account's change is the run's numerical drift:
 * wh_ledger_error(). The books never touch the state: a run with them has the same bits as without.
 */
#ifndef WH_LEDGER_H
#define WH_LEDGER_H

#include "step.h"

/* Most entries. A generated scene defines its own. */
#ifndef WH_LEDGER_MAX
#define WH_LEDGER_MAX 2048
#endif

/* Most accounts. A generated scene defines its own. */
#ifndef WH_ACCOUNTS_MAX
#define WH_ACCOUNTS_MAX 65
#endif

/* The accounts at a state, SI units. level[1 + all coordinates]. */
typedef void wh_levels_fn(const void *model, const wh_angle *angle, const wh_real *linear,
                          const wh_real *rate, const wh_real *input, wh_real *level);

/* A scene's ledger, constant. The functions are lists of operations like the accelerations. */
struct wh_ledger_form {
    const void *model;    /* first argument of the functions */
    wh_accel_fn *powers;  /* result[smooth]: what goes into the account, a second */
    wh_levels_fn *levels; /* result[1 + all coordinates] */
    /* in place of powers where one needs a turn angle itself, in radians, which no acceleration does: a
     * total derivative in the energies, as th^2 th', drops out of the equations and not of dL/dth; or NULL */
    wh_levels_fn *turned;
    const uint8_t *account; /* [smooth] */
    const uint8_t *input;   /* [inputs] those that the energies name; the last entries are theirs */
    uint16_t smooth;        /* entries of powers and forces */
    uint16_t entries;       /* smooth + contacts * (1 + coordinates) + inputs, <= WH_LEDGER_MAX */
    uint8_t accounts;       /* 1 + all coordinates + inputs: one is kept for each of those */
    uint8_t coordinates;    /* integrated coordinates, of which */
    uint8_t angles;         /* are kept as turn angles */
    uint8_t inputs;
};

/* Entry of contact k in the account of its energy; those of its impulses follow, by coordinate. */
WH_INLINE unsigned wh_ledger_of_contact(const wh_ledger_form *form, unsigned k) {
    return form->smooth + k * (1U + form->coordinates);
}

/* Entry of the first of form->input, in the energy's account; the others' follow. */
WH_INLINE unsigned wh_ledger_of_input(const wh_ledger_form *form) {
    return (unsigned)form->entries - form->inputs;
}

WH_INLINE unsigned wh_ledger_account(const wh_ledger_form *form, unsigned entry) {
    if (entry >= wh_ledger_of_input(form)) {
        return 0;
    }
    return entry < form->smooth ? form->account[entry]
                                : (entry - form->smooth) % (1U + form->coordinates);
}

/* The inputs of the last step, [inputs], behind the levels at the start. */
WH_INLINE wh_real *wh_ledger_kept(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - form->inputs;
}

/* Exchange input k of form->input and what was kept of it. */
WH_INLINE void wh_ledger_exchange(const wh_ledger_form *form, const wh_state *state, unsigned k) {
    wh_real *kept = wh_ledger_kept(form, state);
    const wh_real input = state->input[form->input[k]];
    state->input[form->input[k]] = kept[k];
    kept[k] = input;
}

/* The accounts at the present state. */
WH_INLINE void wh_ledger_levels(const wh_ledger_form *form, const wh_state *state, wh_real *level) {
    const unsigned linears = (unsigned)form->coordinates - form->angles;
    form->levels(form->model, state->angle, state->real, state->real + linears, state->input,
                 level);
}

/* A step of the books in progress. */
typedef struct wh_ledger_work {
    wh_real attempt[WH_LEDGER_MAX]; /* of the present try */
    wh_real step[WH_LEDGER_MAX];    /* of the whole step so far */
    wh_real span;                   /* length of the present try, s; zero: there is none */
    const wh_angle *angle;          /* where it begins */
    unsigned stage;
} wh_ledger_work;

/* Share of the step that stage `stage` of the method counts for in its quadrature. */
WH_INLINE wh_real wh_ledger_weight(wh_method method, unsigned stage) {
    if (method == WH_RK4) {
        return stage == 1 || stage == 2 ? WH_R(1.0) / WH_R(3.0) : WH_R(1.0) / WH_R(6.0);
    }
    return method == WH_HEUN ? WH_R(0.5) : WH_R(1.0);
}

/* A try from `angle` on, [form->angles], which stays as it is until the last stage has been. */
WH_INLINE void wh_ledger_begin(const wh_ledger_form *form, const wh_angle *angle, wh_ledger_work *w,
                               wh_real span) {
    for (unsigned i = 0; i < form->entries; i++) {
        w->attempt[i] = WH_R(0.0);
    }
    w->span = span;
    w->angle = angle;
    w->stage = 0;
}

/* The try is part of the run: its entries count. */
WH_INLINE void wh_ledger_accept(const wh_ledger_form *form, wh_ledger_work *w) {
    for (unsigned i = 0; i < form->entries; i++) {
        w->step[i] += w->attempt[i];
    }
}

/* Enter the smooth entries at one stage. Returns the time that the stage counts for, s. */
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

/* Before a step: what inputs that were changed since the last one give, one after another. */
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

/* Before a step: the accounts' levels at the start of the run. */
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

/* After a step: its entries join the totals. */
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
}

typedef struct wh_ledger_model {
    const wh_ledger_form *form;
    const void *model;
    wh_accel_fn *accel;
    wh_method method;
    wh_ledger_work *work;
} wh_ledger_model;

/* The accelerations, with a stage of the books. A wh_accel_fn. */
WH_INLINE void wh_ledger_accel(const void *of, const wh_phase *phase, const wh_real *linear,
                               const wh_real *rate, const wh_real *input, wh_real *accel) {
    const wh_ledger_model *m = of;
    m->accel(m->model, phase, linear, rate, input, accel);
    (void)wh_ledger_stage(m->form, m->method, phase, linear, rate, input, m->work);
}

/* wh_step_second() with books. */
WH_INLINE wh_status wh_step_ledger(const wh_ledger_form *form, const void *model,
                                   wh_accel_fn *accel, wh_method method, bool compensated,
                                   wh_real h, wh_state *state) {
    wh_ledger_work work;
    const wh_ledger_model with = {form, model, accel, method, &work};
    wh_ledger_open(form, state, &work);
    wh_ledger_begin(form, state->angle, &work, h);
    const wh_status status = wh_step_second(&with, wh_ledger_accel, method, compensated,
                                            form->angles, form->coordinates, h, state);
    if (status == WH_OK) {
        wh_ledger_accept(form, &work);
        wh_ledger_commit(form, &work, state);
    }
    return status;
}

/* What went into an account since the start, entries of its own unit summed. */
static inline wh_real wh_ledger_sum(const wh_ledger_form *form, const wh_state *state,
                                    unsigned account) {
    wh_real sum = WH_R(0.0);
    wh_real carry = WH_R(0.0);
    for (unsigned i = 0; i < form->entries && state->steps > 0; i++) {
        if (wh_ledger_account(form, i) == account) {
            sum = wh_sum(sum, state->ledger[i] + state->ledger[form->entries + i], true, &carry);
        }
    }
    return sum;
}

/* How much more an account changed since the start than its entries say: the run's numerical drift, J
 * or the momentum's unit. `level` [form->accounts] is room to work in. Zero before the first step. Inputs that
 * were changed since the last step do not count yet: the next step enters them. */
static inline wh_real wh_ledger_error(const wh_ledger_form *form, const wh_state *state,
                                      unsigned account, wh_real *level) {
    if (state->steps == 0) {
        return WH_R(0.0);
    }
    for (unsigned k = 0; k < form->inputs; k++) {
        wh_ledger_exchange(form, state, k);
    }
    wh_ledger_levels(form, state, level);
    for (unsigned k = 0; k < form->inputs; k++) {
        wh_ledger_exchange(form, state, k);
    }
    return (level[account] - state->ledger[2U * form->entries + account]) -
           wh_ledger_sum(form, state, account);
}

#endif
