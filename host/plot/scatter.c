/* scatter.c: see scatter.h. */
#include "scatter.h"

#include <stdlib.h>

#include "gnuplot.h"
#include "host/base/room.h"
#include "palette.h"

enum { HEIGHT = 620, DASHES = 5 };

static void write_data(FILE *to, const scatter_series *series, int count) {
    for (int i = 0; i < count; i++) {
        fprintf(to, "$data%d << EOD\n", i);
        for (int k = 0; k < series[i].count; k++) {
            fprintf(to, "%.17g %.17g\n", series[i].x[k], series[i].y[k]);
        }
        fputs("EOD\n", to);
    }
}

static void write_labels(FILE *to, const scatter_series *s) {
    for (int k = 0; s->label != NULL && k < s->count; k++) {
        if (s->label[k] != NULL) {
            fputs("set label ", to);
            gnuplot_quote(to, s->label[k]);
            fprintf(to, " at %.17g, %.17g left offset 0.6,0.6 noenhanced front\n", s->x[k],
                    s->y[k]);
        }
    }
}

bool scatter_draw(const char *file, const char *title, const char *x_axis, const char *y_axis,
                  const scatter_series *series, int count, const char *more) {
    gnuplot g;
    char *text = room_words("%s over %s, both logarithmic, %d lines.", y_axis, x_axis, count);
    bool drawn = gnuplot_open(&g, file, HEIGHT, title, text);
    if (drawn) {
        write_data(g.to, series, count);
        fputs("set title ", g.to);
        gnuplot_quote(g.to, title);
        fputs(" noenhanced\nset xlabel ", g.to);
        gnuplot_quote(g.to, x_axis);
        fputs(" noenhanced\nset ylabel ", g.to);
        gnuplot_quote(g.to, y_axis);
        fputs(" noenhanced\nset logscale xy\nset format '10^{%L}'\n"
              "set key below left Left reverse maxcols 3 samplen 3 noenhanced\n",
              g.to);
        for (int i = 0; i < count; i++) {
            write_labels(g.to, &series[i]);
        }
        fputs("plot ", g.to);
        for (int i = 0; i < count; i++) {
            const scatter_series *s = &series[i];
            fprintf(g.to, "%s$data%d using 1:2 with ", i > 0 ? ", " : "", i);
            if (s->heavy) {
                fputs("lines lw 4 lc rgb '" PALETTE_FRAME "'", g.to);
            } else {
                fprintf(g.to, "linespoints pt %d ps 0.7 lw 1.2 dt %d lc rgb '%s'",
                        palette_point(s->look), 1 + s->dash % DASHES, palette_line(s->look));
            }
            fputs(" title ", g.to);
            gnuplot_quote(g.to, s->name);
        }
        if (more != NULL) {
            fputs(", keyentry with points pt -2 title ", g.to);
            gnuplot_quote(g.to, more);
        }
        fputs("\n", g.to);
        drawn = gnuplot_close(&g);
    }
    free(text);
    return drawn;
}
