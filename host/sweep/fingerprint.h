/* fingerprint.h: everything that decides the bytes of a sweep's CSV, as lines of text. */
#ifndef SWEEP_FINGERPRINT_H
#define SWEEP_FINGERPRINT_H

#include "point.h"

typedef struct shard {
    uint64_t number; /* from 1 */
    uint64_t of;
} shard;

/* `model_text`: the whole .whirl text; `base` and `p`: the instance without what is swept. The
 * result is the caller's to free. */
char *fingerprint_make(const sweep *s, const char *model_text, const instance *base,
                       const image *im, shard part);

#endif
