/* tables.h: a step's list with tables of one angle's functions in place of its sines and divisions. */
#ifndef DERIVE_TABLES_H
#define DERIVE_TABLES_H

#include "host/image/image.h"
#include "products.h"

/* Cells of a table, a turn, where nothing else is asked for. */
enum { TABLES_CELLS_LINEAR = 256, TABLES_CELLS_CUBIC = 64 };

/* The accelerations (or slopes) as sum_k c_k(phase) m_k, m_k products of rates, inputs and reals: `list` with the c_k
 * that are no constants as tables, whose phase is the one turn angle, or the one whole multiple or sum of such, that
 * all are functions of. c_k that differ by a factor share one. *exact is a list of what the tables hold. NULL, with
 * *why filled in: it has not that form. */
tape *tables_make(const tape *list, image_tables form, int cells, tape **exact, refusal *why);

/* As many cells as that form takes by itself. */
int tables_cells(image_tables form);

#endif
