/* map_plot.h: a stability map as a picture, drawn by gnuplot. */
#ifndef MAP_MAP_PLOT_H
#define MAP_MAP_PLOT_H

#include "stability_map.h"

/* A rectangle for each pair, to .svg or .png; `words` stand above. False: told on
 * standard error. */
bool map_plot(const char *file, const stability_map *m, const char *words);

#endif
