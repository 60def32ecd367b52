/* scatter.h: points and lines over two logarithmic axes, drawn by gnuplot. */
#ifndef PLOT_SCATTER_H
#define PLOT_SCATTER_H

#include <stdbool.h>

typedef struct scatter_series {
    const char *name;
    bool heavy; /* a heavy line without points, above the others */
    int count;
    const double *x; /* [count] above zero */
    const double *y; /* [count] above zero */
} scatter_series;

/* To `file` (.svg or .png). Title, names and axes stand as they are. False when the file cannot be written, or gnuplot is
 * missing or failed, reported on standard error. */
bool scatter_draw(const char *file, const char *title, const char *x_axis, const char *y_axis,
                  const scatter_series *series, int count);

#endif
