/* c_ledger.h: a scene's books as C. */
#ifndef EMIT_C_LEDGER_H
#define EMIT_C_LEDGER_H

#include <stdio.h>

#include "host/image/image.h"

/* The declared bounds: before the core's headers. */
void c_ledger_bounds(FILE *out, const image *im);

/* The lists and the constant `ledger`. */
void c_ledger_write(FILE *out, const image *im);

#endif
