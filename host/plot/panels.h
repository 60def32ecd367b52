/* panels.h: a choice of quantities (plot.h), resolved to panels and curves. */
#ifndef PLOT_PANELS_H
#define PLOT_PANELS_H

#include "plot.h"

enum { PANELS_MOST = 64, PANELS_QUANTITIES = 256 };

/* A quantity that is drawn: of each run its column, or -1. */
typedef struct panels_quantity {
    char *name;  /* as people write it: theta' */
    int *column; /* [runs] */
    int panel;
} panels_quantity;

typedef struct panels {
    panels_quantity quantity[PANELS_QUANTITIES];
    int quantities;
    const char *unit[PANELS_MOST]; /* NULL: not known */
    int count;
    int *x; /* [runs] column */
    const char *x_unit;
    char *x_name;
    char *label[PANELS_QUANTITIES]; /* of the runs */
    int runs;
} panels;

/* False is reported. panels_free() in any case. */
bool panels_make(panels *p, const char *command, const plot_choice *choice, const plot_run *runs,
                 int count);
void panels_free(panels *p);

#endif
