/* table_counted.h: a table whose front is counted, not predicted. */
#ifndef PRICE_TABLE_COUNTED_H
#define PRICE_TABLE_COUNTED_H

#include "measured.h"

/* Counts what is on the front, and sorts anew, until all of it is. A table by evaluations stays as it is. Look at t->stopped.
 * MEASURED_MISSING: a tool is missing. */
measured_end table_counted(trials *t, table *made, measured_prices *m, const table_wish *w);

#endif
