/* growth.h: how a value goes on towards a place, from so far away to so near: does it grow there as one over the distance does,
 * or faster? */
#ifndef RUN_GROWTH_H
#define RUN_GROWTH_H

/* It is asked at so many distances, each GROWTH_CLOSER times nearer than the one before. */
enum { GROWTH_POINTS = 10 };
#define GROWTH_CLOSER 1.7099759466766968 /* the third root of 5 */
/* The farthest of them, of the nearest. */
#define GROWTH_REACH 125.0
/* What grows beyond all numbers was so large before. */
#define GROWTH_BEYOND 1e60

typedef enum growth {
    GROWTH_ROUGH, /* it does not go on evenly: rounding, or a zero; from farther off it may */
    GROWTH_NONE,  /* evenly, and no pole: it has a limit, or one over a root has */
    GROWTH_POLE   /* evenly */
} growth;

/* value[k * stride] at the k-th distance, the farthest first. */
growth growth_of(const double *value, int stride);

#endif
