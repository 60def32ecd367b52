/* plot.c: handing curves to gnuplot. */
#include "plot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gnuplot.h"
#include "host/number/functions.h"

/* A unit in gnuplot's enhanced text: what follows a ^ is raised, "m^(1/2)" whole and without its
 * parentheses. Its other marks are escaped. */
static void write_unit(FILE *to, const char *unit) {
    fputc('"', to);
    for (const char *at = unit; *at != '\0'; at++) {
        if (*at != '^') {
            fputs(strchr("_{}@&~\\", *at) != NULL ? "\\134" : "", to);
            gnuplot_character(to, unit, (size_t)(at - unit));
            continue;
        }
        const bool open = at[1] == '(';
        const char *from = at + (open ? 2 : 1);
        const size_t length = strspn(from, open ? "-0123456789/" : "-0123456789");
        fprintf(to, "^{%.*s}", (int)length, from);
        at = from + length - (open && from[length] == ')' ? 0 : 1);
    }
    fputc('"', to);
}

static bool same_panel(const curve *x, const curve *y) { return strcmp(x->unit, y->unit) == 0; }

static int count_panels(const curve *curves, int count) {
    int panels = 0;
    for (int i = 0; i < count; i++) {
        bool first = true;
        for (int k = 0; k < i; k++) {
            first = first && !same_panel(&curves[k], &curves[i]);
        }
        panels += first;
    }
    return panels;
}

/* Characters: y tics as wide as -2.5x10^-300 and the axis's label stand left of all panels, the longest
 * name and its line right of them, so that their time axes stand below each other. */
#define LEFT_MARGIN 15
#define KEY_LINE 9
#define NAME_MOST 40

static int right_margin(const curve *curves, int count) {
    size_t longest = 0;
    for (int i = 0; i < count; i++) {
        const size_t length = strlen(curves[i].name);
        longest = length > longest ? length : longest;
    }
    return (int)(longest < NAME_MOST ? longest : NAME_MOST) + KEY_LINE;
}

/* A part of its size below which a curve counts as flat: the tics could not tell it. */
#define FLAT 1e-10

/* The range of an axis that gnuplot would warn of, or fail at: of one value, or of none. */
static void write_range(FILE *to, const char *axis, double least, double most) {
    if (!(least <= most)) {
        fprintf(to, "set %srange [-1:1]\n", axis);
        return;
    }
    const double size = number_most(fabs(least), fabs(most));
    if (most - least > FLAT * size) {
        fprintf(to, "set %srange [*:*]\n", axis);
        return;
    }
    const double room = size > 0.0 ? 0.1 * size : 1.0;
    fprintf(to, "set %srange [%.17g:%.17g]\n", axis, least - room, most + room);
}

typedef struct plot_table {
    const double *data;
    int rows;
    int columns;
} plot_table;

/* Least and most of the finite values of one panel's curves; least above most where there are none. */
static void range_of(const plot_table *t, const curve *curves, int count, const curve *panel,
                     double *least, double *most) {
    *least = (double)INFINITY;
    *most = -(double)INFINITY;
    for (int k = 0; k < count; k++) {
        for (int r = 0; r < t->rows && same_panel(&curves[k], panel); r++) {
            const double value = t->data[(size_t)r * (size_t)t->columns + (size_t)curves[k].column];
            *least = isfinite(value) ? number_least(*least, value) : *least;
            *most = isfinite(value) ? number_most(*most, value) : *most;
        }
    }
}

static void write_panels(FILE *to, const plot_table *t, const curve *curves, int count) {
    const curve time = {"", "", 0};
    double least;
    double most;
    range_of(t, &time, 1, &time, &least, &most);
    write_range(to, "x", least, most);
    for (int i = 0; i < count; i++) {
        bool first = true;
        for (int k = 0; k < i; k++) {
            first = first && !same_panel(&curves[k], &curves[i]);
        }
        if (!first) {
            continue;
        }
        range_of(t, curves, count, &curves[i], &least, &most);
        write_range(to, "y", least, most);
        fputs("set ylabel ", to);
        write_unit(to, curves[i].unit);
        fputs("\nplot ", to);
        for (int k = i; k < count; k++) {
            if (same_panel(&curves[k], &curves[i])) {
                fprintf(to, "%s$data using 1:%d with %s title ", k > i ? ", " : "",
                        curves[k].column + 1, t->rows == 1 ? "points pt 7 ps 0.6" : "lines lw 1.5");
                gnuplot_quote(to, curves[k].name);
            }
        }
        fputs("\n", to);
    }
}

bool plot_can_draw(const char *file) { return gnuplot_can_draw(file); }

/* Behind the curves of every panel, to the end of its axis. */
static void write_shade(FILE *to, double trusted_s) {
    if (trusted_s > 0.0) {
        fprintf(to,
                "set object 1 rectangle from first %.17g, graph 0 to graph 1, graph 1 behind "
                "fillcolor rgb '#e4e4e4' fillstyle solid noborder\n"
                "set xlabel 'time [s]; shaded, behind %.6g s: no single value is to be trusted, "
                "energy and momenta are'\n",
                trusted_s, trusted_s);
    }
}

bool plot_draw(const char *file, const char *title, const curve *curves, int count,
               const double *data, int rows, int columns, double trusted_s) {
    const int panels = count_panels(curves, count);
    gnuplot g;
    if (!gnuplot_open(&g, file, 120 + 260 * panels)) {
        return false;
    }
    FILE *to = g.to;
    fputs("$data << EOD\n", to);
    for (int r = 0; r < rows; r++) {
        for (int c = 0; c < columns; c++) {
            fprintf(to, "%.17g ", data[(size_t)r * (size_t)columns + (size_t)c]);
        }
        fputc('\n', to);
    }
    fprintf(to, "EOD\nset multiplot layout %d,1 title ", panels);
    gnuplot_quote(to, title);
    fputs(" noenhanced\nset grid\nset key outside right top noenhanced\nset xlabel 'time [s]'\n",
          to);
    fprintf(to, "set lmargin %d\nset rmargin %d\n", LEFT_MARGIN, right_margin(curves, count));
    write_shade(to, trusted_s);
    write_panels(to, &(plot_table){data, rows, columns}, curves, count);
    fputs("unset multiplot\n", to);
    return gnuplot_close(&g);
}
