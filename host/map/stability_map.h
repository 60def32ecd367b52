/* stability_map.h: what becomes of a scene's run for each pair of two swept values: does it stay bounded, keep its energy,
 * keep a tolerance? And where a method's stability ends by the linear theory.
 *
 * Each run has a finer one beside it (host/trust/twins.h), which says until when it is right, and books, which say what of
 * its energy is missing (host/run/belief.h). The theory's limit of a place is that of the fastest motion which takes part in
 * the run by the finest step there, linearised along its way (host/run/linearised.h): the longest step that lets it not
 * grow. It knows no contacts, and nothing of motions that get faster when the step is long. */
#ifndef MAP_STABILITY_MAP_H
#define MAP_STABILITY_MAP_H

#include <signal.h>

#include "host/run/engine.h"
#include "host/sweep/grid.h"

/* What becomes of a run, from good to bad. X(id, mark, word, words) */
#define MAP_VERDICT_ROWS(X) \
    X(MAP_KEEPS, '.', "keeps", "right to the tolerance, to its end") \
    X(MAP_OFF, 'o', "off", \
      "bounded, its energy kept, and off by more than the tolerance before its end") \
    X(MAP_LOSES, 'x', "loses", \
      "bounded, and more than a thousandth of its energy is not accounted for") \
    X(MAP_DIVERGES, '#', "diverges", "it leaves all bounds") \
    X(MAP_NONE, ' ', "none", "there is no such run: its values are refused")
#define MAP_VERDICT_ID(id, mark, word, words) id,
typedef enum map_verdict { MAP_VERDICT_ROWS(MAP_VERDICT_ID) MAP_VERDICTS } map_verdict;
#undef MAP_VERDICT_ID

typedef struct map_verdict_row {
    char mark;
    const char *word;
    const char *words;
} map_verdict_row;
extern const map_verdict_row map_verdicts[MAP_VERDICTS];

typedef struct map_cell {
    map_verdict verdict;
    double step_s;
    double end_s;     /* until then it went */
    double until_s;   /* until then it is right to the tolerance */
    double left_over; /* part of the energy's largest entry that is missing; NAN: not known */
} map_cell;

typedef struct map_wish {
    const grid *grid; /* two axes */
    const mechanism *mechanism;
    const scene *scene; /* NULL for a bare mechanism */
    const overrides *changes;
    const engine_kind *kind; /* float or double */
    image_settings settings;
    double tolerance;
    const volatile sig_atomic_t *stop;                        /* may be NULL */
    void (*progress)(void *told, uint64_t done, uint64_t of); /* may be NULL */
    void *told;
} map_wish;

/* One theory's limit for each place: each value of the axis that is no step. */
typedef struct stability_map {
    const grid *grid;
    map_cell *cell; /* [grid->points] */
    uint64_t done;  /* cells: fewer than points where it was stopped */
    int step_axis;  /* 0 or 1; -1: neither is the step, and there is no theory */
    double *
        limit_s; /* [count of the other axis] longest stable step, NAN: not known; NULL without a step's axis */
} stability_map;

stability_map map_make(const map_wish *w);
void map_free(stability_map *m);

/* How many cells have this verdict. */
uint64_t map_count(const stability_map *m, map_verdict verdict);
/* The point of these values' numbers along the axes. */
uint64_t map_point(const grid *g, uint64_t first, uint64_t second);

#endif
