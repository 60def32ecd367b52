/* program.h: an instance as operation lists, with every parameter folded in. */
#ifndef DERIVE_PROGRAM_H
#define DERIVE_PROGRAM_H

#include "host/derive/image_parts.h"
#include "host/derive/layout.h"
#include "host/derive/solve.h"

/* The ledger. By Lagrange's equations, the momentum p_i = dL/dq_i' changes by dL/dq_i (gravity, springs, the other
 * coordinates' motion), each generalized force, each damper and each contact. The energy changes by the work of each
 * generalized force, each damper's loss, each contact, and each change of an input in the energies. If the energy
 * integral is not T + V, it takes the place of the energy (equations.h). */

typedef struct program {
    layout layout;
    conservation *conserved;
    const poly *integral; /* the energy integral if it is not T + V, else NULL: see equations.h */
    /* the image so far: its settings, lists, contacts and ledger. made == NULL: taken by the caller */
    image_draft draft;
} program;

/* Makes the lists of an instance. `conserve` [count] names the coordinates to recover from their momentum, or is
 * NULL. Returns NULL after an error, which is reported to `errors`, such as too many components, a momentum that is
 * not conserved, or a constant that is not finite. */
program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors);
/* Replaces the step's functions of one angle by table look-ups (tables.h), if the settings ask for it. If that is
 * impossible, returns false and reports the place. */
bool program_look_up(program *p, diags *errors);
void program_free(program *p);

/* The hash of the equations of motion. */
uint64_t program_hash(const program *p);

#endif
