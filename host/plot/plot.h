/* plot.h: curves of one or more runs, panels above each other on one axis, drawn by gnuplot. */
#ifndef PLOT_PLOT_H
#define PLOT_PLOT_H

#include <stdbool.h>

#include "plot_run.h"

enum { PLOT_PANELS = 16 };

/* What is drawn. All zero: every coordinate and output, without rates, a panel for each unit. */
typedef struct plot_choice {
    const char *x;                  /* a quantity; NULL: column 0 */
    const char *y;                  /* quantities between commas, a panel for each unit; or NULL */
    const char *panel[PLOT_PANELS]; /* quantities that share a panel */
    int panels;
    const char *legend; /* labels of the runs, between commas; or NULL */
    const char *title;
} plot_choice;

/* Is there a quantity for each name, and one unit in each panel? Needs columns, no data. False is reported. */
bool plot_fits(const char *command, const plot_choice *choice, const plot_run *runs, int count);
/* True when x is another quantity than column 0. */
bool plot_is_path(const plot_choice *choice);

/* Draws to `file` (gnuplot.h). Titles and names (UTF-8) stand as they are, with a blank for a control character. In a
 * unit, the exponent after ^ is raised. Neither they nor the file's name is ever a command to gnuplot. False, reported,
 * when the choice does not fit, the file cannot be written, or gnuplot is missing or failed. */
bool plot_draw(const char *command, const char *file, const plot_choice *choice,
               const plot_run *runs, int count);

#endif
