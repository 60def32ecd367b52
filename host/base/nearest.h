/* nearest.h: the known name closest to a misspelt one. */
#ifndef BASE_NEAREST_H
#define BASE_NEAREST_H

#include <stddef.h>

typedef struct nearest {
    const char *wanted;
    size_t length;
    const char *best; /* NULL: no similar name */
    int cost;
    int offers;
} nearest;

nearest nearest_start(const char *wanted, size_t length);
void nearest_offer(nearest *search, const char *candidate);

#endif
