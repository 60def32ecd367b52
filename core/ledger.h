/* ledger.h: accounts of the energy and of each momentum of a run, and the entries that changed them.
 *
 * Account 0 is the energy integral sum q_i' dL/dq_i' - L (Goldstein, Classical Mechanics, section 2.7). It equals T + V if
 * T is a quadratic form of the rates and V does not depend on them. Account 1 + i is the generalized momentum dL/dq_i' of
 * coordinate i, in the scene's order, conserved coordinates last.
 *
 * Each entry sums the changes of an account since the start.
 * - the work of each input, the loss of each damper (negative), the impulse of each generalized force.
 * - for each contact its energy and its impulse along each coordinate.
 * - if the energies name an input: the work -dL/dt of its changes between steps (it is constant within a step).
 * - last, if the scene asks for it: the energy drift that its steps have given back (stabilize.h).
 *
 * The smooth entries' powers and forces, and the contacts' forces, are integrated with the weights of the method's own
 * stages. So the entries have the method's order, and a step costs one more list of operations a stage. Impacts, captures
 * and assignments are entered as they happen. Sums are compensated. The part of an account's change that no entry explains
 * is the run's numerical drift: wh_ledger_error(). The ledger never touches the state: a run with it has the same bits as
 * without. ledger_step.h fills it. */
#ifndef WH_LEDGER_H
#define WH_LEDGER_H

#include "number/sum.h"
#include "state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The accounts at a state, SI units. level[1 + all coordinates]. */
typedef void wh_levels_fn(const void *model, const wh_angle *angle, const wh_real *linear,
                          const wh_real *rate, const wh_real *input, wh_real *level);

/* A scene's ledger, constant. The functions are lists of operations, as the accelerations are. */
struct wh_ledger_form {
    const void *model;    /* first argument of the functions */
    wh_accel_fn *powers;  /* result[smooth]: change of the account per second */
    wh_levels_fn *levels; /* result[1 + all coordinates] */
    /* replaces powers if one of them needs a turn angle in radians; or NULL. Accelerations never need one: a total
     * derivative in the energies, such as th^2 th', drops out of the equations but not out of dL/dth */
    wh_levels_fn *turned;
    const uint8_t *account; /* [smooth] */
    const uint8_t *input; /* [inputs] inputs that the energies name; the last entries are theirs */
    uint16_t smooth;      /* entries of powers and forces */
    uint16_t
        entries; /* smooth + contacts * (1 + coordinates) + inputs + stabilized, <= WH_LEDGER_MAX */
    uint8_t
        accounts; /* words stored: two levels for each account (the energy, and a momentum for each
                   * of all coordinates), the inputs' and one if stabilized */
    uint8_t coordinates; /* integrated coordinates, of which */
    uint8_t angles;      /* are stored as turn angles */
    uint8_t inputs;
    bool stabilized; /* each step gives back part of the drift (stabilize.h) */
};

/* Entry of contact k's energy. Its impulses follow, by coordinate. */
WH_INLINE unsigned wh_ledger_of_contact(const wh_ledger_form *form, unsigned k) {
    return form->smooth + k * (1U + form->coordinates);
}

/* Entry of the first of form->input, in the energy's account; the others follow. */
WH_INLINE unsigned wh_ledger_of_input(const wh_ledger_form *form) {
    return (unsigned)form->entries - form->inputs - form->stabilized;
}

/* Entry of the energy given back, if form->stabilized. */
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

/* Accounts with a level: the energy, and a momentum for each of all coordinates. */
WH_INLINE unsigned wh_ledger_level_count(const wh_ledger_form *form) {
    return ((unsigned)form->accounts - form->inputs - form->stabilized) / 2U;
}

/* Change of each account by corrections (wh_scene_set_real() and similar), stored after the start's levels. Those
 * levels moved by the same amount, so the entries still add up to the change since then. */
WH_INLINE wh_real *wh_ledger_corrected(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + wh_ledger_level_count(form);
}

/* The inputs of the last step, [inputs], stored after the corrections. */
WH_INLINE wh_real *wh_ledger_kept(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - form->inputs -
           form->stabilized;
}

/* max P of stabilize.h so far, J, if form->stabilized; the last word. */
WH_INLINE wh_real *wh_ledger_most(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - 1U;
}

/* Exchange input k of form->input with its stored value. */
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

/* The accounts with the inputs of the last step. The next step enters the effect of changed inputs. */
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

/* Sum of an account's entries since the start, in the account's unit. */
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

/* Numerical drift of an account since the start: its change less its entries, J or the momentum's unit. `level`
 * [form->accounts] is working space. Zero before the first step. Inputs that were changed since the last step do not
 * count yet: the next step enters them. */
static inline wh_real wh_ledger_error(const wh_ledger_form *form, const wh_state *state,
                                      unsigned account, wh_real *level) {
    if (state->steps == 0) {
        return WH_R(0.0);
    }
    wh_ledger_last_levels(form, state, level);
    return (level[account] - state->ledger[2U * form->entries + account]) -
           wh_ledger_sum(form, state, account);
}

#ifdef __cplusplus
}
#endif

#endif
