/* map_plot.c: a stability map as a picture. */
#include "stability_map.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/io/gnuplot.h"
#include "host/io/palette.h"
#include "host/lang/shown.h"
#include "host/number/functions.h"

enum { HEIGHT = 620 };

/* A gnuplot axis is logarithmic where its values are above zero: those below are drawn evenly. */
static bool is_log(const axis *a) { return a->is_log && a->from > 0.0; }

/* The value half a cell further along the axis, down or up. */
static double edge(const axis *a, double value, bool up) {
    const double cells = a->count > 1 ? (double)(a->count - 1) : 1.0;
    if (a->is_log) {
        const double ratio = a->count > 1 ? number_most(a->to / a->from, a->from / a->to) : 1.1;
        const double half = number_power(ratio, 0.5 / cells);
        return up == (value > 0.0) ? value * half : value / half;
    }
    const double width = a->count > 1 ? fabs(a->to - a->from) : number_most(fabs(a->from), 1.0);
    return up ? value + 0.5 * width / cells : value - 0.5 * width / cells;
}

static void set_axis(FILE *to, const axis *a, char letter) {
    char *unit = a->symbol == NULL                 ? alloc_words("s")
                 : unit_is_si(a->symbol->declared) ? shown_unit_name(a->symbol, a->primes)
                                                   : shown_si_name(a->symbol, a->primes);
    const double least = number_least(a->from, a->to);
    const double most = number_most(a->from, a->to);
    fprintf(to, "set %clabel ", letter);
    gnuplot_quote(to, a->column);
    fprintf(to, ".' [%s]' noenhanced\n", unit);
    free(unit);
    if (is_log(a)) {
        fprintf(to, "set logscale %c\n", letter);
    }
    fprintf(to, "set %crange [%.17g:%.17g]\n", letter, edge(a, least, false), edge(a, most, true));
}

/* x, y and the edges of each stretch of cells of a row that have this verdict. */
static void write_cells(FILE *to, const stability_map *m, map_verdict verdict) {
    const axis *along = &m->grid->axes[m->along];
    const axis *rows = &m->grid->axes[1 - m->along];
    fprintf(to, "$%s << EOD\n", map_verdicts[verdict].word);
    for (uint64_t row = 0; row < rows->count; row++) {
        const double y = map_row(m, row);
        for (uint64_t at = 0; at < along->count; at++) {
            const uint64_t from = at;
            while (at < along->count && m->cell[map_point(m, row, at)].verdict == verdict) {
                at++;
            }
            if (at > from) {
                fprintf(to, "%.9g %.9g %.9g %.9g %.9g %.9g\n", map_along(m, from), y,
                        edge(along, map_along(m, from), false),
                        edge(along, map_along(m, at - 1), true), edge(rows, y, false),
                        edge(rows, y, true));
            }
        }
    }
    fputs("EOD\n", to);
}

static bool is_drawn(const stability_map *m, int verdict) {
    return verdict < PALETTE_AREAS && map_count(m, (map_verdict)verdict) > 0;
}

static bool draw(const char *file, const stability_map *m, const char *words, const char *text) {
    gnuplot g;
    if (!gnuplot_open(&g, file, HEIGHT, words, text)) {
        return false;
    }
    fputs("set title ", g.to);
    gnuplot_quote(g.to, words);
    fputs(" noenhanced\n", g.to);
    set_axis(g.to, &m->grid->axes[m->along], 'x');
    set_axis(g.to, &m->grid->axes[1 - m->along], 'y');
    fputs(
        "set key below left Left reverse maxcols 1 samplen 2\nset tics out\nset style fill solid noborder\n",
        g.to);
    for (int i = 0; i < MAP_VERDICTS; i++) {
        if (is_drawn(m, i)) {
            write_cells(g.to, m, (map_verdict)i);
        }
    }
    const char *comma = "plot ";
    for (int i = 0; i < MAP_VERDICTS; i++) {
        if (is_drawn(m, i)) {
            fprintf(g.to, "%s$%s with boxxyerror lc rgb '%s' title '%s: %s'", comma,
                    map_verdicts[i].word, palette_area(i), map_verdicts[i].word,
                    map_verdicts[i].words);
            comma = ", ";
        }
    }
    if (*comma == 'p') {
        fputs("plot NaN notitle", g.to);
    }
    fputc('\n', g.to);
    return gnuplot_close(&g);
}

/* For readers who do not see the picture; free it. */
static char *alternative_text(const stability_map *m) {
    char *text = alloc_words("A map of %s and %s.", m->grid->axes[m->along].column,
                             m->grid->axes[1 - m->along].column);
    for (int i = 0; i < PALETTE_AREAS; i++) {
        char *longer =
            alloc_words("%s %llu %s: %s.", text, (unsigned long long)map_count(m, (map_verdict)i),
                        map_verdicts[i].word, map_verdicts[i].words);
        free(text);
        text = longer;
    }
    return text;
}

bool map_plot(const char *file, const stability_map *m, const char *words) {
    char *text = alternative_text(m);
    const bool drawn = draw(file, m, words, text);
    free(text);
    return drawn;
}
