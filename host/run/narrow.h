/* narrow.h: does a float run lose what is too small for a float? */
#ifndef RUN_NARROW_H
#define RUN_NARROW_H

#include "watch.h"

/* The slope that loses most: a part of its largest, at `time_s`. */
typedef struct narrow {
    double part; /* 0: none loses any */
    int component;
    double time_s;
} narrow;

/* About the records of a run in float, with the scene's operations in double: what falls below the smallest normal float
 * is rounded as much as that, or gone. Rates squared of a slow motion do, and products of small lengths. */
narrow narrow_of(const watch *w);
/* A sentence with a hint, where it is more than a thousandth. */
void narrow_say(FILE *out, const image *im, const narrow *n);

#endif
