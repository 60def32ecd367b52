/* ledger.h: the books of a run: what changed the energy and each momentum, and by how much.
 *
 * Accounts: account 0 is the energy integral sum q_i' dL/dq_i' - L (Goldstein, Classical Mechanics, section
 * 2.7), which is T + V where T is a quadratic form of the rates and V free of them; account 1 + i is the
 * generalized momentum dL/dq_i' of coordinate i (in the scene's order, conserved coordinates last). Entries
 * say what went into an account since the start: the work of each input, the loss of each damper
 * (negative), the impulse of each generalized force, for each contact its energy and its impulse along
 * each coordinate, and, where the energies name an input, what its changes between steps gave: -dL/dt of
 * an input that stands still within each step; and last, where the scene asks for that, what its steps have given back of what
 * the energy drifted by (stabilize.h).
 *
 * The powers and forces of the smooth entries, and the contacts' forces, are integrated with the weights
 * of the method's own stages, so the books are of the method's order and a step costs one more list of
 * operations a stage; impacts, captures and assignments are entered as they happen. Sums carry their
 * rounding errors along. Whatever the entries leave of an account's change is the run's numerical drift:
 * wh_ledger_error(). The books never touch the state: a run with them has the same bits as without.
 * ledger_step.h keeps them.
 */
#ifndef WH_LEDGER_H
#define WH_LEDGER_H

#include "state.h"
#include "sum.h"

#ifdef __cplusplus
extern "C" {
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
    uint16_t
        entries; /* smooth + contacts * (1 + coordinates) + inputs + stabilized, <= WH_LEDGER_MAX */
    uint8_t
        accounts; /* words that are kept: two levels for each account (the energy's, and a momentum for each
                       * of all coordinates), the inputs' and one if stabilized */
    uint8_t coordinates; /* integrated coordinates, of which */
    uint8_t angles;      /* are kept as turn angles */
    uint8_t inputs;
    bool stabilized; /* each step gives back some of the drift (stabilize.h) */
};

/* Entry of contact k in the account of its energy; those of its impulses follow, by coordinate. */
WH_INLINE unsigned wh_ledger_of_contact(const wh_ledger_form *form, unsigned k) {
    return form->smooth + k * (1U + form->coordinates);
}

/* Entry of the first of form->input, in the energy's account; the others' follow. */
WH_INLINE unsigned wh_ledger_of_input(const wh_ledger_form *form) {
    return (unsigned)form->entries - form->inputs - form->stabilized;
}

/* Entry of what was given back, where form->stabilized. */
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

/* What corrections changed each account by (wh_scene_set_real() and its like), behind the levels at the start. Those
 * levels have moved by as much, so the entries still add up to the change from there. */
WH_INLINE wh_real *wh_ledger_corrected(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + wh_ledger_level_count(form);
}

/* The inputs of the last step, [inputs], behind those. */
WH_INLINE wh_real *wh_ledger_kept(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - form->inputs -
           form->stabilized;
}

/* The most energy so far that the rates would get if they grew by all of themselves, where form->stabilized; the last word. */
WH_INLINE wh_real *wh_ledger_most(const wh_ledger_form *form, const wh_state *state) {
    return state->ledger + 2U * form->entries + (unsigned)form->accounts - 1U;
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

/* The same with the inputs of the last step: the next one enters what other inputs were changed by. */
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
    wh_ledger_last_levels(form, state, level);
    return (level[account] - state->ledger[2U * form->entries + account]) -
           wh_ledger_sum(form, state, account);
}

#ifdef __cplusplus
}
#endif

#endif
