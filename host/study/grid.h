/* grid.h: the points of a sweep: varied values, their ranges and order. */
#ifndef STUDY_GRID_H
#define STUDY_GRID_H

#include <stdint.h>

#include "host/lang/model.h"
#include "host/number/decimal.h"

/* One --over: `count` values from `from` to `to` (SI), equally spaced, or equally spaced in the logarithm. */
typedef struct axis {
    char *name;           /* the name as typed: "r", "theta'", "step" */
    char *column;         /* CSV column: the name; "start(theta')" for a start value */
    const symbol *symbol; /* parameter, input, coordinate or state; NULL: the step */
    int primes;
    double from;
    double to;
    uint64_t count; /* 1 only when from = to */
    bool is_log;
    bool is_start; /* a start value: the symbol is a coordinate or a state */
} axis;

/* All combinations of the axes' values; the last axis changes fastest. Starts as {0}; free with grid_free(). */
typedef struct grid {
    const char *command; /* command in messages; NULL: "sweep" */
    const char *option;  /* NULL: "--over" */
    axis *axes;
    int count;
    uint64_t points;
} grid;

#define GRID_POINTS_MAX UINT64_C(1000000000000)

/* Adds the axis "NAME=FROM..TO:COUNT[,log]". Without a unit, FROM has that of TO. False, with a message: not added. */
bool grid_add(grid *g, const mechanism *of, const char *text, diags *errors);
void grid_free(grid *g);

/* Sets value[g->count], SI, to the axes' values at `point` < g->points. An axis's first and last values are exact. */
void grid_values(const grid *g, uint64_t point, double *value);

int grid_step_axis(const grid *g);

/* Does an axis vary a parameter? Then each point has equations of its own. */
bool grid_varies_parameters(const grid *g);

/* The points of shard k of n (1 <= k <= n): first <= point < end. Shards 1 to n have every point once, in order. */
void grid_shard(const grid *g, uint64_t k, uint64_t n, uint64_t *first, uint64_t *end);

/* === the values of a point, as overrides ============================================================= */

/* The changes of `base`, then the point's exact values, which take precedence. Free with changes_forget(). */
overrides changes_at(const grid *g, const overrides *base, uint64_t point);
void changes_forget(const overrides *base, overrides *changes);

/* Returns false (reported) if an axis varies a value of an effect that `base` does not select. */
bool changes_take_part(const grid *g, const instance *base);
/* Returns false (reported) if `base` sets a value that an axis varies. */
bool changes_are_apart(const grid *g, const overrides *base);

#endif
