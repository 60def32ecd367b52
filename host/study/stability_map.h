/* stability_map.h: a map over two swept values. A cell shows whether a run is bounded, accurate, and conserves energy.
 *
 * A finer run (host/check/step_doubling.h) shows until when a run is accurate. The energy residual
 * (host/check/energy_residual.h) shows whether the run conserves energy. */
#ifndef STUDY_STABILITY_MAP_H
#define STUDY_STABILITY_MAP_H

#include "host/study/point.h"

/* A run diverges if the error of an unknown's highest derivative exceeds MAP_BOUND times the range of that derivative.
 * A growing error exceeds this bound long before overflow. */
#define MAP_BOUND 100.0

/* The verdicts, from good to bad. X(id, mark, word, words) */
#define MAP_VERDICT_ROWS(X) \
    X(MAP_KEEPS, '.', "keeps", "accurate to the tolerance until its end") \
    X(MAP_OFF, 'o', "off", "bounded, but its error exceeds the tolerance before its end") \
    X(MAP_LOSES, 'x', "loses", \
      "bounded, but its energy residual exceeds a thousandth of the largest entry") \
    X(MAP_DIVERGES, '#', "diverges", \
      "grew without bound, or the error of a rate exceeds a hundred times its range") \
    X(MAP_NONE, '-', "none", "not run: Whirl refuses these values") \
    X(MAP_UNTRIED, '?', "untried", "interrupted before it was run")
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
    map_verdict verdict; /* with MAP_NONE and MAP_UNTRIED the other fields are not set */
    double end_s;        /* the run's last time */
    double until_s;      /* the run is accurate to the tolerance until this time */
    double left_over;    /* |residual| / largest entry of the energy balance; NAN: unknown */
} map_cell;

typedef struct map_request {
    sweep of; /* a sweep with two axes */
    double tolerance;
    void (*progress)(double runs, void *context); /* may be NULL; `runs`: completed runs */
    void *context;
} map_request;

typedef struct stability_map {
    const grid *grid;
    map_cell *cell; /* [grid->points] */
    uint64_t done;  /* number of completed cells; fewer than points after an interrupt */
    int along;      /* index of the axis along a row: 0 if axes[0] is the step, else 1 */
    bool by_step;   /* one axis is the step */
} stability_map;

/* Runs the map row by row. If the step is swept, each row begins with the shortest step. */
stability_map map_make(const map_request *w);
void map_free(stability_map *m);

uint64_t map_count(const stability_map *m, map_verdict verdict);
/* The grid's index of point `at` in row `row`. The values along a row rise. */
uint64_t map_point(const stability_map *m, uint64_t row, uint64_t at);
/* map_along() returns the value at index `at` along a row, and map_row() the value of a row, in SI units. */
double map_along(const stability_map *m, uint64_t at);
double map_row(const stability_map *m, uint64_t row);

/* Prints a line for each row, with one mark for each point of the row. `words` describe the run. */
void map_print(FILE *out, const stability_map *m, const char *words);
/* Writes a CSV row for each completed cell: two swept values, verdict, times, energy residual. */
void map_csv(FILE *out, const stability_map *m);
/* Writes the map as one JSON object (docs/warnings.md has the schema). `status`: exit status. */
void map_json(FILE *out, const stability_map *m, const image *of, const map_request *w, int status);
/* Draws the map with gnuplot to .svg or .png, with `words` as the title. False: reported on standard error. */
bool map_plot(const char *file, const stability_map *m, const char *words);

#endif
