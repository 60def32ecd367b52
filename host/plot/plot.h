/* plot.h: curves of one or more runs, panels above each other on one axis, drawn by gnuplot. */
#ifndef PLOT_PLOT_H
#define PLOT_PLOT_H

#include <stdio.h>

#include "panels.h"

/* Draws to `file` (gnuplot.h). Titles and names (UTF-8) stand as they are, with a blank for a control character. In a
 * unit, the exponent after ^ is raised. Neither they nor the file's name is ever a command to gnuplot. False, reported,
 * when the choice does not fit, the file cannot be written, or gnuplot is missing or failed. */
bool plot_draw(const char *command, const char *file, const plot_choice *choice,
               const plot_run *runs, int count);

/* gnuplot's command for the shade behind a panel, from this time on. */
void plot_shade(FILE *to, double from_s);

#endif
