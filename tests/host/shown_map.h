/* shown_map.h: random stability maps with any verdicts over ranges of every kind, without runs. Input of map_text.h and
 * map_plot.h. */
#ifndef TESTS_SHOWN_MAP_H
#define TESTS_SHOWN_MAP_H

#include "command.h"
#include "host/study/stability_map.h"

enum { SHOWN_MOST = 7 };

/* A map and its pairs in the order of the values: [row][along], both rising. */
typedef struct shown_map {
    axis axes[2];
    grid grid;
    stability_map map;
    map_cell cell[SHOWN_MOST * SHOWN_MOST];
    double value[2][SHOWN_MOST];   /* of the axis along and of the rows; rising */
    uint64_t place[2][SHOWN_MOST]; /* index of each axis in the map */
    const map_cell *at[SHOWN_MOST][SHOWN_MOST];
} shown_map;

/* Its pointers refer to itself: it must not be moved. */
void shown_map_draw(dice *d, shown_map *s);
/* Value i of an axis on the grid. */
double shown_map_value(const axis *a, uint64_t i);
uint64_t shown_map_across(const shown_map *s);
uint64_t shown_map_rows(const shown_map *s);

#endif
