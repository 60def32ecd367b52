/* description.h: the contents of an image, for programs (docs/describe.md) and for readers. */
#ifndef EMIT_DESCRIPTION_H
#define EMIT_DESCRIPTION_H

#include <stdio.h>

#include "host/image/image.h"

/* Increased when a field changes its meaning or is removed; new fields may appear at any time. */
#define DESCRIBE_VERSION 1

/* Writes one JSON object. `file` is the name of the .whirl file. */
void describe_json(FILE *out, const image *im, const char *file);

/* Writes the description as text for readers. */
void describe_text(FILE *out, const image *im, const char *file);

/* Words of both descriptions. */
extern const char *const describe_roles[IMAGE_ROLES];
const char *describe_ledger_kind(ledger_kind kind);

#endif
