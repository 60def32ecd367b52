/* caught.h: the output to a stream, as text. */
#ifndef TESTS_HOST_CAUGHT_H
#define TESTS_HOST_CAUGHT_H

#include "host/base/alloc.h"

/* `text` is complete after alloc_text_end(to). The caller frees it. */
typedef struct caught {
    char *text;
    size_t length;
    FILE *to;
} caught;

static inline FILE *catch_text(caught *c) {
    c->to = alloc_text(&c->text, &c->length);
    return c->to;
}

#endif
