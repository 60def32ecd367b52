#include "minmax_decimation.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"

/* The extremes of one column in a bucket. */
typedef struct extent {
    double least;
    double most;
    bool falls; /* the greatest value precedes the least */
} extent;

struct decimation {
    int columns;
    bool samples;    /* a bucket keeps its first row instead of its extremes */
    uint64_t size;   /* steps per bucket */
    uint64_t filled; /* steps in the last bucket */
    unsigned count;  /* buckets, including the last one */
    extent *extents; /* [DECIMATION_ROOM * columns] by bucket */
};

decimation *decimation_new(int columns, bool samples) {
    decimation *v = alloc(1, sizeof *v);
    v->columns = columns;
    v->samples = samples;
    v->size = 1;
    v->extents = alloc((int64_t)DECIMATION_ROOM * columns, sizeof *v->extents);
    return v;
}

void decimation_free(decimation *v) {
    if (v != NULL) {
        free(v->extents);
        free(v);
    }
}

static extent joined(extent earlier, extent later) {
    if (!isfinite(later.least) || !isfinite(later.most)) {
        return earlier;
    }
    if (!isfinite(earlier.least) || !isfinite(earlier.most)) {
        return later;
    }
    const bool least_later = later.least < earlier.least;
    const bool most_later = later.most > earlier.most;
    extent made = {.least = least_later ? later.least : earlier.least,
                   .most = most_later ? later.most : earlier.most};
    made.falls = least_later && most_later     ? later.falls
                 : !least_later && !most_later ? earlier.falls
                                               : least_later;
    return made;
}

static extent *bucket(const decimation *v, unsigned number) {
    return v->extents + (size_t)number * (size_t)v->columns;
}

static void merge_pairs(decimation *v) {
    for (unsigned k = 0; k < DECIMATION_ROOM / 2; k++) {
        for (int i = 0; i < v->columns; i++) {
            const extent first = bucket(v, 2 * k)[i];
            bucket(v, k)[i] = v->samples ? first : joined(first, bucket(v, 2 * k + 1)[i]);
        }
    }
    v->count = DECIMATION_ROOM / 2;
    v->size *= 2;
    v->filled = v->size;
}

void decimation_enter(decimation *v, const double *row) {
    if (v->count == DECIMATION_ROOM && v->filled == v->size) {
        merge_pairs(v);
    }
    const bool fresh = v->count == 0 || v->filled == v->size;
    if (fresh) {
        v->count++;
        v->filled = 0;
    }
    extent *last = bucket(v, v->count - 1);
    for (int i = 0; i < v->columns; i++) {
        const extent one = {row[i], row[i], false};
        last[i] = fresh ? one : v->samples ? last[i] : joined(last[i], one);
    }
    v->filled++;
}

double *decimation_rows(const decimation *v, int *rows) {
    const unsigned each = v->size == 1 || v->samples ? 1 : 2;
    double *made = alloc((int64_t)each * v->count * v->columns, sizeof *made);
    double *to = made;
    for (unsigned k = 0; k < v->count; k++) {
        for (unsigned half = 0; half < each; half++) {
            for (int i = 0; i < v->columns; i++) {
                const extent *e = &bucket(v, k)[i];
                *to++ = e->falls == (half == 0) ? e->most : e->least;
            }
        }
    }
    *rows = (int)(each * v->count);
    return made;
}
