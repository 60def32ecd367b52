/* map_text.c: see map_text.h. */
#include "map_text.h"

#include <math.h>
#include <string.h>

#include "host/number/functions.h"
#include "host/plot/gnuplot.h"

/* Along which axis columns run, and rows: the step from left to right, else the second one. */
static int column_axis(const stability_map *m) { return m->step_axis >= 0 ? m->step_axis : 1; }

static const map_cell *cell_at(const stability_map *m, uint64_t row, uint64_t column) {
    const bool swapped = column_axis(m) == 0;
    return &m->cell[map_point(m->grid, swapped ? column : row, swapped ? row : column)];
}

static double value_at(const stability_map *m, int axis_number, uint64_t at) {
    double value[2];
    grid_values(m->grid, axis_number == 0 ? map_point(m->grid, at, 0) : map_point(m->grid, 0, at),
                value);
    return value[axis_number];
}

/* --- for people -----------------------------------------------------------------------------------------*/

static void print_row(FILE *out, const stability_map *m, uint64_t row) {
    const int across = column_axis(m);
    const uint64_t columns = m->grid->axes[across].count;
    const double limit_s = m->limit_s == NULL ? (double)NAN : m->limit_s[row];
    fprintf(out, "  %-12.6g ", value_at(m, 1 - across, row));
    for (uint64_t i = 0; i < columns; i++) {
        const double step_s = value_at(m, across, i);
        const bool first = limit_s < step_s && (i == 0 || limit_s >= value_at(m, across, i - 1));
        fprintf(out, "%s%c", first ? "|" : "", map_verdicts[cell_at(m, row, i)->verdict].mark);
    }
    fputs(limit_s >= value_at(m, across, columns - 1) ? "|" : "", out);
    if (isfinite(limit_s)) {
        fprintf(out, "  %.4g s", limit_s);
    }
    fputc('\n', out);
}

void map_print(FILE *out, const stability_map *m, const map_words *words) {
    const int across = column_axis(m);
    const axis *columns = &m->grid->axes[across];
    const axis *rows = &m->grid->axes[1 - across];
    fprintf(out, "%s, %s: %llu runs\n\n", words->target, words->how, (unsigned long long)m->done);
    fprintf(out, "  %-12.40s %.40s from %.6g to %.6g%s%s\n", rows->column, columns->column,
            columns->from, columns->to, columns->is_log ? ", logarithmic" : "",
            m->limit_s != NULL ? "; |: longest stable step, by the linear theory" : "");
    for (uint64_t i = rows->count; i-- > 0;) {
        print_row(out, m, i);
    }
    fputc('\n', out);
    for (int i = 0; i < MAP_VERDICTS; i++) {
        const uint64_t count = map_count(m, (map_verdict)i);
        if (count > 0) {
            fprintf(out, "  %c  %-8s %6llu  %s\n", map_verdicts[i].mark, map_verdicts[i].word,
                    (unsigned long long)count, map_verdicts[i].words);
        }
    }
}

/* --- for programs ---------------------------------------------------------------------------------------*/

static void field(FILE *out, double value) {
    char text[NUMBER_SIZE];
    fprintf(out, ",%s", isfinite(value) ? number_shortest(value, text) : "");
}

bool map_csv(FILE *out, const stability_map *m) {
    const grid *g = m->grid;
    fprintf(out, "%s,%s,verdict,until,end,left_over,limit\r\n", g->axes[0].column,
            g->axes[1].column);
    for (uint64_t i = 0; i < m->done; i++) {
        const map_cell *c = &m->cell[i];
        char text[NUMBER_SIZE];
        double value[2];
        grid_values(g, i, value);
        fprintf(out, "%s", number_shortest(value[0], text));
        field(out, value[1]);
        fprintf(out, ",%s", map_verdicts[c->verdict].word);
        field(out, c->verdict == MAP_NONE ? (double)NAN : c->until_s);
        field(out, c->verdict == MAP_NONE ? (double)NAN : c->end_s);
        field(out, c->left_over);
        field(out,
              m->limit_s == NULL
                  ? (double)NAN
                  : m->limit_s[m->step_axis == 0 ? i % g->axes[1].count : i / g->axes[1].count]);
        fputs("\r\n", out);
    }
    return fflush(out) == 0 && ferror(out) == 0;
}

/* --- a picture ------------------------------------------------------------------------------------------*/

/* From good to bad; a colour-blind reader tells them apart by lightness, too. */
static const char *const colours[MAP_VERDICTS] = {"#2b83ba", "#abdda4", "#fdae61", "#b2182b",
                                                  "#ffffff"};

static void plot_squares(FILE *to, const stability_map *m, map_verdict verdict) {
    const int across = column_axis(m);
    for (uint64_t row = 0; row < m->grid->axes[1 - across].count; row++) {
        for (uint64_t i = 0; i < m->grid->axes[across].count; i++) {
            if (cell_at(m, row, i)->verdict == verdict) {
                fprintf(to, "%.17g %.17g\n", value_at(m, across, i), value_at(m, 1 - across, row));
            }
        }
    }
    fputs("e\n", to);
}

static void plot_limit(FILE *to, const stability_map *m) {
    const int across = column_axis(m);
    const axis *steps = &m->grid->axes[across];
    for (uint64_t row = 0; row < m->grid->axes[1 - across].count; row++) {
        const double limit_s = m->limit_s[row];
        if (limit_s >= number_least(steps->from, steps->to) && limit_s <= number_most(steps->from, steps->to)) {
            fprintf(to, "%.17g %.17g\n", limit_s, value_at(m, 1 - across, row));
        }
    }
    fputs("e\n", to);
}

/* Half a cell beyond the ends. */
static void plot_range(FILE *to, const axis *a, char letter) {
    const double cells = a->count > 1 ? (double)(a->count - 1) : 1.0;
    if (a->is_log) {
        const double half = number_power(a->to / a->from, 0.5 / cells);
        fprintf(to, "set logscale %c\nset %crange [%.17g:%.17g]\n", letter, letter, a->from / half,
                a->to * half);
    } else {
        const double half = (a->to - a->from) / cells / 2.0;
        fprintf(to, "set %crange [%.17g:%.17g]\n", letter, a->from - half, a->to + half);
    }
}

bool map_plot(const char *file, const stability_map *m, const map_words *words) {
    enum { HEIGHT = 600 };
    const int across = column_axis(m);
    const axis *columns = &m->grid->axes[across];
    const axis *rows = &m->grid->axes[1 - across];
    const double most = number_most((double)columns->count, 1.4 * (double)rows->count);
    gnuplot g;
    if (!gnuplot_open(&g, file, HEIGHT)) {
        return false;
    }
    fputs("set title ", g.to);
    gnuplot_quote(g.to, words->target);
    fputs(" noenhanced\nset xlabel ", g.to);
    gnuplot_quote(g.to, columns->column);
    fputs(" noenhanced\nset ylabel ", g.to);
    gnuplot_quote(g.to, rows->column);
    fputs(" noenhanced\nset key outside bottom center horizontal\n", g.to);
    plot_range(g.to, columns, 'x');
    plot_range(g.to, rows, 'y');
    fputs("plot", g.to);
    const char *comma = "";
    for (int i = 0; i < MAP_VERDICTS; i++) {
        if (map_count(m, (map_verdict)i) > 0 && i != MAP_NONE) {
            fprintf(g.to, "%s '-' with points pt 5 ps %.3g lc rgb '%s' title '%s'", comma,
                    number_least(6.0, 90.0 / most), colours[i], map_verdicts[i].word);
            comma = ",";
        }
    }
    if (m->limit_s != NULL) {
        fprintf(g.to,
                "%s '-' with lines lw 2 lc rgb 'black' title 'longest stable step, linear theory'",
                comma);
    }
    fputc('\n', g.to);
    for (int i = 0; i < MAP_VERDICTS; i++) {
        if (map_count(m, (map_verdict)i) > 0 && i != MAP_NONE) {
            plot_squares(g.to, m, (map_verdict)i);
        }
    }
    if (m->limit_s != NULL) {
        plot_limit(g.to, m);
    }
    return gnuplot_close(&g);
}
