/* caught.h: what is printed to a stream, as a text. */
#ifndef TESTS_HOST_CAUGHT_H
#define TESTS_HOST_CAUGHT_H

#include "host/base/alloc.h"

/* `text`, to be freed, is whole behind alloc_text_end(to). */
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
