/* driven.h: inputs with a rate (`input L rate Lv`), for generated scenes that have such inputs. Inside a step such an
 * input moves like a coordinate without forces, at its constant rate. Between steps the caller sets the value and the
 * rate, or the rate alone. A step starts from both and updates both; a refused step leaves the state as it was. */
#ifndef WH_DRIVEN_H
#define WH_DRIVEN_H

#include "../ledger.h"
#include "../scene.h"
#include "refuse.h"
#include "unroll.h"

/* Maximum number of accounts: the energy, and a momentum for each coordinate. A generated scene defines its own. */
#ifndef WH_ACCOUNTS_MAX
#define WH_ACCOUNTS_MAX (WH_COORDS + 1)
#endif

/* `input` and `rate` are indices in state->input[]. value_at and rate_at are indices in state->real[]. */
typedef struct wh_driven {
    uint8_t input;
    uint8_t rate;
    uint8_t value_at;
    uint8_t rate_at;
} wh_driven;

/* Numbers that wh_driven_end() restores if the step is refused. */
typedef struct wh_driven_kept {
    wh_real real[2 * WH_COORDS];
    wh_real books[2 * WH_ACCOUNTS_MAX];
    bool booked;
} wh_driven_kept;

/* Enters each account's level minus before[] as a correction in the ledger. */
static inline void wh_ledger_correct(const wh_ledger_form *form, const wh_state *state,
                                     const wh_real *before) {
    wh_real *start = state->ledger + 2U * form->entries;
    wh_real *corrected = wh_ledger_corrected(form, state);
    wh_real level[WH_ACCOUNTS_MAX];
    wh_ledger_last_levels(form, state, level);
    for (unsigned i = 0; i < wh_ledger_level_count(form); i++) {
        const wh_real change = level[i] - before[i];
        if (wh_believable(change, WH_ABSURD)) {
            start[i] += change;
            corrected[i] += change;
        }
    }
}

/* Call this before a step. It copies the inputs to the components. If `form` is not NULL, it
 * enters the resulting changes of the accounts' levels in the ledger as corrections. */
WH_INLINE void wh_driven_begin(const wh_driven *drive, unsigned count, const wh_ledger_form *form,
                               wh_driven_kept *kept, wh_state *state) {
    wh_real before[WH_ACCOUNTS_MAX];
    bool set = false;
    for (unsigned i = 0; i < count; i++) {
        set = set || state->real[drive[i].value_at] != state->input[drive[i].input] ||
              state->real[drive[i].rate_at] != state->input[drive[i].rate];
    }
    kept->booked = set && form != NULL && state->steps > 0;
    if (kept->booked) {
        wh_ledger_last_levels(form, state, before);
        for (unsigned i = 0; i < 2U * wh_ledger_level_count(form); i++) {
            kept->books[i] = state->ledger[2U * form->entries + i];
        }
    }
    for (unsigned i = 0; i < count; i++) {
        kept->real[2 * i] = state->real[drive[i].value_at];
        kept->real[2 * i + 1] = state->real[drive[i].rate_at];
        state->real[drive[i].value_at] = state->input[drive[i].input];
        state->real[drive[i].rate_at] = state->input[drive[i].rate];
    }
    if (kept->booked) {
        wh_ledger_correct(form, state, before);
    }
}

/* Call this after a step. If `status` is WH_OK, it copies the components to the inputs. Otherwise it restores the
 * components and the ledger. Returns `status`. */
WH_INLINE wh_status wh_driven_end(const wh_driven *drive, unsigned count,
                                  const wh_ledger_form *form, const wh_driven_kept *kept,
                                  wh_status status, wh_state *state) {
    for (unsigned i = 0; i < count && status == WH_OK; i++) {
        state->input[drive[i].input] = state->real[drive[i].value_at];
        state->input[drive[i].rate] = state->real[drive[i].rate_at];
    }
    for (unsigned i = 0; i < count && status != WH_OK; i++) {
        state->real[drive[i].value_at] = kept->real[2 * i];
        state->real[drive[i].rate_at] = kept->real[2 * i + 1];
    }
    for (unsigned i = 0; kept->booked && status != WH_OK && i < 2U * wh_ledger_level_count(form);
         i++) {
        state->ledger[2U * form->entries + i] = kept->books[i];
    }
    return status;
}

#endif
