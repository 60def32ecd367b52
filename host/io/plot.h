/* plot.h: curves of one or more runs, in stacked panels with one common axis, drawn by gnuplot. */
#ifndef IO_PLOT_H
#define IO_PLOT_H

#include <stdio.h>

#include "panels.h"

/* Draw to `file` (gnuplot.h). Titles and names (UTF-8) appear literally, with blanks for control characters. In a unit,
 * the exponent after ^ is raised. Neither they nor the file's name can act as gnuplot commands. False, reported, if the
 * choice does not fit, the file cannot be written, or gnuplot is missing or fails. */
bool plot_draw(const char *command, const char *file, const plot_choice *choice,
               const plot_run *runs, int count);

/* gnuplot's command for the shade in the background of a panel, from this time on. */
void plot_shade(FILE *to, double from_s);

#endif
