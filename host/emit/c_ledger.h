/* c_ledger.h: a scene's books as C. */
#ifndef EMIT_C_LEDGER_H
#define EMIT_C_LEDGER_H

#include <stdio.h>

#include "host/derive/ledger.h"

/* The declared bounds: before the core's headers. */
void c_ledger_bounds(FILE *out, const ledger_lists *l);

/* The lists and the constant `ledger`. */
void c_ledger_write(FILE *out, const program *p);

#endif
