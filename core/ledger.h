/* ledger.h: accounts of the energy and of each momentum of a run, with entries for the causes of their changes.
 *
 * Account 0 is the energy integral sum q_i' dL/dq_i' - L (Goldstein, Classical Mechanics, section 2.7). It equals T + V
 * if T is a quadratic form of the rates and V does not depend on the rates. Account 1 + i is the generalized momentum
 * dL/dq_i' of coordinate i, in the scene's order; coordinates that follow from a conserved momentum come last.
 *
 * Each entry is the sum of the changes that one cause has made to one account since the start. In order, they are:
 * - smooth entries: the work of each input, the loss of each damper (negative), the impulse of each generalized force.
 * - for each contact, its energy and its impulse along each coordinate.
 * - for each input in the energies, the work -dL/dt of its changes between steps.
 * - if the scene asks for it, the energy that stabilization has added (stabilize.h).
 *
 * Powers and forces, including contact forces, are integrated by the method's own weighted sum over its stages, so the
 * entries have the method's order. An impact, capture or assignment adds the change that it makes. Sums are
 * compensated. The part of an account's change that no entry explains is the run's numerical drift: wh_ledger_error().
 * Without stabilization, a run with a ledger has the same bits as a run without. ledger_step.h fills the ledger. */
#ifndef WH_LEDGER_H
#define WH_LEDGER_H

#include "number/sum.h"
#include "state.h"

WH_C_BEGIN

/* Computes the accounts of a state in SI units. level[0] is the energy, level[1 + i] the momentum of coordinate i. */
typedef void wh_levels_fn(const void *model, const wh_angle *angle, const wh_real *linear,
                          const wh_real *rate, const wh_real *input, wh_real *level);

/* A scene's constant data for the ledger. */
struct wh_ledger_form {
    const void *model;    /* first argument of the functions */
    wh_accel_fn *powers;  /* result[smooth]: time derivative of each smooth entry */
    wh_levels_fn *levels; /* values of the accounts: level[wh_ledger_level_count(form)] */
    /* Replaces `powers` if an entry depends on a turn angle itself, not only on its sine and cosine. Else NULL. */
    wh_levels_fn *turned;
    const uint8_t *account; /* [smooth] index of each smooth entry's account */
    const uint8_t *input;   /* [inputs] index in state->input of each input that enters L */
    uint16_t smooth;        /* number of smooth entries */
    uint16_t entries;       /* smooth + contacts * (1 + coordinates) + inputs + stabilized */
    uint8_t accounts;       /* stored reals: 2 per account, 1 per input, 1 if stabilized */
    uint8_t coordinates;    /* number of integrated coordinates */
    uint8_t angles;         /* number of coordinates stored as turn angles; they come first */
    uint8_t inputs;
    bool stabilized; /* each step corrects part of the energy's drift (stabilize.h) */
};

/* Index of the entry of contact k's energy. The next entries are the contact's impulses, one for each coordinate. */
WH_INLINE unsigned wh_ledger_of_contact(const wh_ledger_form *form, unsigned k) {
    return form->smooth + k * (1U + form->coordinates);
}

/* Index of the entry of form->input[0]. The entries of the other inputs follow. All belong to the energy's account. */
WH_INLINE unsigned wh_ledger_of_input(const wh_ledger_form *form) {
    return (unsigned)form->entries - form->inputs - form->stabilized;
}

/* Index of stabilization's entry. Valid only if form->stabilized. */
WH_INLINE unsigned wh_ledger_of_stabilized(const wh_ledger_form *form) {
    return form->entries - 1U;
}

WH_INLINE unsigned wh_ledger_account(const wh_ledger_form *form, unsigned entry) {
    if (entry >= wh_ledger_of_input(form)) {
        return 0;
    }
    return entry < form->smooth ? form->account[entry]
                                : (entry - form->smooth) % (1U + form->coordinates);
}

/* Number of accounts: the energy, and a momentum for each coordinate. */
WH_INLINE unsigned wh_ledger_level_count(const wh_ledger_form *form) {
    return ((unsigned)form->accounts - form->inputs - form->stabilized) / 2U;
}

/* Returns an array with one real for each account: the total change by corrections such as wh_scene_set_real(). Each
 * correction is also added to the account's stored initial value, so that it does not count as drift. */
WH_INLINE wh_real *wh_ledger_corrected(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + wh_ledger_level_count(form);
}

/* Returns an array [form->inputs]: the value of each input form->input[k] in the last step. */
WH_INLINE wh_real *wh_ledger_kept(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - form->inputs -
           form->stabilized;
}

/* If form->stabilized: the largest P = sum q_i' dL/dq_i' (stabilize.h) so far, in J. */
WH_INLINE wh_real *wh_ledger_most(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - 1U;
}

WH_INLINE void wh_ledger_exchange(const wh_ledger_form *form, const wh_state *state, unsigned k) {
    wh_real *kept = wh_ledger_kept(form, state);
    const wh_real input = state->input[form->input[k]];
    state->input[form->input[k]] = kept[k];
    kept[k] = input;
}

WH_INLINE void wh_ledger_levels(const wh_ledger_form *form, const wh_state *state, wh_real *level) {
    const unsigned linears = (unsigned)form->coordinates - form->angles;
    form->levels(form->model, state->angle, state->real, state->real + linears, state->input,
                 level);
}

/* Computes the accounts at the present state, but with the inputs of the last step, because the entries do not yet
 * contain the effect of newer inputs. */
static inline void wh_ledger_last_levels(const wh_ledger_form *form, const wh_state *state,
                                         wh_real *level) {
    for (unsigned k = 0; k < form->inputs; k++) {
        wh_ledger_exchange(form, state, k);
    }
    wh_ledger_levels(form, state, level);
    for (unsigned k = 0; k < form->inputs; k++) {
        wh_ledger_exchange(form, state, k);
    }
}

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

/* Numerical drift of an account since the start: its change minus the sum of its entries, in J or the momentum's unit.
 * `level` [form->accounts] is working space. Inputs that changed since the last step do not count yet. */
static inline wh_real wh_ledger_error(const wh_ledger_form *form, const wh_state *state,
                                      unsigned account, wh_real *level) {
    if (state->steps == 0) {
        return WH_R(0.0);
    }
    wh_ledger_last_levels(form, state, level);
    return (level[account] - state->ledger[2U * form->entries + account]) -
           wh_ledger_sum(form, state, account);
}

WH_C_END

#endif
