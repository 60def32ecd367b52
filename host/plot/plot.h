/* plot.h: curves over time as SVG or PNG, drawn by gnuplot. */
#ifndef PLOT_PLOT_H
#define PLOT_PLOT_H

#include <stdbool.h>

typedef struct curve {
    const char *name;
    const char *unit; /* curves of one unit share a panel */
    int column;       /* of the data, from 0; column 0 is time */
} curve;

/* True when the file's ending is one that can be drawn. */
bool plot_can_draw(const char *file);

/* Draw `rows` rows of `columns` numbers, one panel a unit, to `file` (.svg or .png); one row is drawn as
 * points. Title and names (UTF-8) stand as they are, with a blank for a control character; in a unit what
 * follows a ^ is raised. Nothing in them, nor in the file's name, is a command to gnuplot. Where `trusted_s`
 * is above zero, what lies behind it is shaded, and the time axes say why. False when the file cannot be written, or
 * gnuplot is missing or failed, reported on standard error. */
bool plot_draw(const char *file, const char *title, const curve *curves, int curve_count,
               const double *data, int rows, int columns, double trusted_s);

#endif
