/* scatter.c: see scatter.h. */
#include "scatter.h"

#include "gnuplot.h"

enum { HEIGHT = 560, SHAPES = 7 };

static void write_data(FILE *to, const scatter_series *series, int count) {
    for (int i = 0; i < count; i++) {
        fprintf(to, "$data%d << EOD\n", i);
        for (int k = 0; k < series[i].count; k++) {
            fprintf(to, "%.17g %.17g\n", series[i].x[k], series[i].y[k]);
        }
        fputs("EOD\n", to);
    }
}

bool scatter_draw(const char *file, const char *title, const char *x_axis, const char *y_axis,
                  const scatter_series *series, int count) {
    gnuplot g;
    if (!gnuplot_open(&g, file, HEIGHT)) {
        return false;
    }
    write_data(g.to, series, count);
    fputs("set title ", g.to);
    gnuplot_quote(g.to, title);
    fputs(" noenhanced\nset xlabel ", g.to);
    gnuplot_quote(g.to, x_axis);
    fputs(" noenhanced\nset ylabel ", g.to);
    gnuplot_quote(g.to, y_axis);
    fputs(" noenhanced\nset logscale xy\nset format '10^{%L}'\nset grid\n"
          "set key outside right top samplen 2 font ',9' noenhanced\nplot ",
          g.to);
    for (int i = 0; i < count; i++) {
        fprintf(g.to, "%s$data%d using 1:2 with ", i > 0 ? ", " : "", i);
        if (series[i].heavy) {
            fputs("lines lw 4 lc rgb '#80808080'", g.to);
        } else {
            fprintf(g.to, "linespoints pt %d ps 0.6 lw 1", 1 + i % SHAPES);
        }
        fputs(" title ", g.to);
        gnuplot_quote(g.to, series[i].name);
    }
    fputs("\n", g.to);
    return gnuplot_close(&g);
}
