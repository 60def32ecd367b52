/* scatter.h: points and lines over two logarithmic axes, drawn by gnuplot. */
#ifndef PLOT_SCATTER_H
#define PLOT_SCATTER_H

#include <stdbool.h>

typedef struct scatter_series {
    const char *name;
    bool heavy; /* a heavy line, named at its points */
    int look;   /* colour and shape (palette.h) */
    int dash;   /* from 0 */
    int count;
    const double *x;    /* [count] above zero */
    const double *y;    /* [count] above zero */
    char *const *label; /* [count] of a heavy line: its name from this point on, or NULL */
} scatter_series;

/* To `file` (gnuplot.h). Title, names and axes stand as they are; `more` is a last line of the legend, or NULL. False,
 * reported, when the file cannot be written, or gnuplot is missing or failed. */
bool scatter_draw(const char *file, const char *title, const char *x_axis, const char *y_axis,
                  const scatter_series *series, int count, const char *more);

#endif
