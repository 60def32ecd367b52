/* panels.h: a choice of quantities, resolved to panels and curves. */
#ifndef IO_PANELS_H
#define IO_PANELS_H

#include "plot_run.h"

enum { PLOT_PANELS = 16 };

/* The choice of curves. All zero: every coordinate and output, without rates, a panel for each unit. */
typedef struct plot_choice {
    const char *x;                  /* a quantity; NULL: column 0 */
    const char *y;                  /* quantities separated by commas, a panel for each unit; or
                                     * NULL */
    const char *panel[PLOT_PANELS]; /* quantities that share a panel */
    int panels;
    const char *legend; /* labels of the runs, separated by commas; or NULL */
    const char *title;
    const char *xlabel; /* NULL: quantity and unit */
    const char *ylabel; /* of the panels, separated by commas; default: quantities and unit */
} plot_choice;

/* Does each name have a quantity, and each panel one unit? Needs columns, no data. False is reported. */
bool plot_fits(const char *command, const plot_choice *choice, const plot_run *runs, int count);
/* True if x is a quantity other than column 0. */
bool plot_is_path(const plot_choice *choice);

enum { PANELS_MOST = 64, PANELS_QUANTITIES = 256 };

/* A drawn quantity: its column in each run, or -1. */
typedef struct panels_quantity {
    char *name;  /* as displayed: theta' */
    int *column; /* [runs] */
    int panel;
} panels_quantity;

typedef struct panels {
    panels_quantity quantity[PANELS_QUANTITIES];
    int quantities;
    const char *unit[PANELS_MOST]; /* NULL: unknown */
    int count;
    int *x; /* [runs] column */
    const char *x_unit;
    char *x_name;
    char *label[PANELS_QUANTITIES]; /* of the runs */
    int runs;
} panels;

/* The next entry of a list separated by commas, without blanks at its ends; NULL at the end of the list. Free it. */
char *panels_next(const char **list);
/* False is reported. Call panels_free() in any case. */
bool panels_make(panels *p, const char *command, const plot_choice *choice, const plot_run *runs,
                 int count);
void panels_free(panels *p);

#endif
