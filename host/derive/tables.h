/* tables.h: look-up tables for functions of one angle. They replace the sines and divisions of a step's list. */
#ifndef DERIVE_TABLES_H
#define DERIVE_TABLES_H

#include "host/image/image.h"
#include "host/image/op_list.h"

/* The reason why a list cannot have tables, in words that follow "the accelerations ", and a hint. */
typedef struct refusal {
    const char *reason;
    const char *hint;
    int angle; /* the turn angle that the message names, or -1 */
} refusal;

/* Default number of cells of a table for one turn. */
enum { TABLES_CELLS_LINEAR = 256, TABLES_CELLS_CUBIC = 64 };

/* Returns `list` with table look-ups, and in *exact a list of the tables' functions. Accelerations (or derivatives)
 * become sum_k c_k(phase) m_k. Each m_k is a product of rates, inputs and reals. Each c_k that is not constant becomes
 * a table; c_k that differ by a factor share one. All c_k must depend on one phase, a sum of turn angles times whole
 * numbers. If the list has no such form, returns NULL, and the reason in *why. */
op_list *tables_make(const op_list *list, image_tables form, int cells, op_list **exact,
                     refusal *why);

int tables_cells(image_tables form);

#endif
