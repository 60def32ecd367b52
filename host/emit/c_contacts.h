/* c_contacts.h: a scene's contacts as C. */
#ifndef EMIT_C_CONTACTS_H
#define EMIT_C_CONTACTS_H

#include <stdio.h>

#include "host/image/image.h"

/* The declared bounds and the core's header. */
void c_contacts_include(FILE *out, const image *im);

/* The lists, the table and advance(). */
void c_contacts_write(FILE *out, const image *im);

#endif
