/* map_text.h: a stability map for people, for programs and as a picture. */
#ifndef MAP_MAP_TEXT_H
#define MAP_MAP_TEXT_H

#include <stdio.h>

#include "stability_map.h"

typedef struct map_words {
    const char *target; /* as the user named it */
    const char *how;    /* method and number */
    double tolerance;
} map_words;

/* A row for each value of the axis that is not the step, a mark for each step, `|` behind the last one that theory lets be. */
void map_print(FILE *out, const stability_map *m, const map_words *words);
/* A row for each pair: both values, verdict, times, what is missing of the energy, the theory's limit. False: errno tells. */
bool map_csv(FILE *out, const stability_map *m);
/* A square for each pair and the limit as a line, to .svg or .png. False: told on standard error. */
bool map_plot(const char *file, const stability_map *m, const map_words *words);

#endif
