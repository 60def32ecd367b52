/* table_numbers.h: the numbers of tables: what stands in each cell for functions of one angle. */
#ifndef DERIVE_TABLE_NUMBERS_H
#define DERIVE_TABLE_NUMBERS_H

#include "host/image/tape.h"

/* What is tabled: operations of a list of functions of one angle, of which its phase i takes multiple[i]. */
typedef struct table_functions {
    const tape *list;
    const int *multiple; /* [list->count] */
    const int *function; /* [tables] operations */
} table_functions;

/* Fills in all of the tables but for their count, bits and terms. */
void table_numbers(const table_functions *f, tape_tables *into);

#endif
