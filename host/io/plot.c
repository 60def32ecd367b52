/* plot.c: gnuplot commands for the curves of runs. */
#include "plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gnuplot.h"
#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "palette.h"
#include "panels.h"

/* Left margin of all panels, in characters: room for y tics such as -2.5x10^-300 and the axis's label, so that the x
 * axes align. */
#define LEFT_MARGIN 15
#define RIGHT_MARGIN 4
#define AXIS_MOST 26
#define TEXT_MOST 60

/* Height of a panel with a one-line legend, and of each further line, in pixels; widths of a legend and its samples. */
enum { PANEL_HEIGHT = 260, KEY_LINE = 21, KEY_WIDTH = 760, KEY_SAMPLE = 60 };
#define KEY_LETTER 8.5

/* A part of gnuplot's enhanced text, with its special characters escaped. With `raised`, the exponent after ^ is
 * raised, "m^(1/2)" whole and without its parentheses. */
static void write_part(FILE *to, const char *text, bool raised) {
    for (const char *at = text; *at != '\0'; at++) {
        if (*at != '^' || !raised) {
            fputs(strchr("_{}@&~^\\", *at) != NULL ? "\\134" : "", to);
            gnuplot_character(to, text, (size_t)(at - text));
            continue;
        }
        const bool open = at[1] == '(';
        const char *from = at + (open ? 2 : 1);
        const size_t length = strspn(from, open ? "-0123456789/" : "-0123456789");
        fprintf(to, "^{%.*s}", (int)length, from);
        at = from + length - (open && from[length] == ')' ? 0 : 1);
    }
}

/* Quantity and unit. */
static void write_axis(FILE *to, const char *axis, const char *name, const char *unit) {
    fprintf(to, "set %slabel \"", axis);
    write_part(to, name, false);
    if (unit != NULL) {
        fputs(name[0] != '\0' ? " [" : "[", to);
        write_part(to, unit, true);
        fputc(']', to);
    }
    fputs("\"\n", to);
}

/* A curve counts as flat below this part of its size: the tics could not show its range. */
#define FLAT 1e-10

/* The range of an axis with one value or no value, which would cause warnings or errors in gnuplot. */
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

typedef struct extent {
    double least;
    double most;
} extent;

/* Joins the finite values of a run's column; least above most if there are no finite values. */
static extent joined(extent e, const plot_run *run, int column) {
    for (int r = 0; r < run->rows && column >= 0; r++) {
        const double value = run->data[(size_t)r * (size_t)run->columns + (size_t)column];
        e.least = isfinite(value) ? number_least(e.least, value) : e.least;
        e.most = isfinite(value) ? number_most(e.most, value) : e.most;
    }
    return e;
}

static const extent nothing = {(double)INFINITY, -(double)INFINITY};

static extent quantity_extent(const panels *p, const plot_run *runs, const int *column) {
    extent e = nothing;
    for (int k = 0; k < p->runs; k++) {
        e = joined(e, &runs[k], column[k]);
    }
    return e;
}

static int quantities_in(const panels *p, int panel) {
    int count = 0;
    for (int i = 0; i < p->quantities; i++) {
        count += p->quantity[i].panel == panel ? 1 : 0;
    }
    return count;
}

/* The names of a panel's quantities, or of all (-1), separated by commas; free it. If too long for an axis: their
 * number. */
static char *names_of(const panels *p, int panel, size_t most) {
    char *names = alloc_words("%s", "");
    int count = 0;
    for (int i = 0; i < p->quantities; i++) {
        if (panel < 0 || p->quantity[i].panel == panel) {
            char *longer =
                alloc_words("%s%s%s", names, count++ > 0 ? ", " : "", p->quantity[i].name);
            free(names);
            names = longer;
        }
    }
    if (strlen(names) > most && count > 1) {
        free(names);
        names = alloc_words("%d quantities", count);
    }
    return names;
}

/* The quantity, for one run with its description if that fits; for several runs, the run. */
static char *legend_of(const panels *p, const panels_quantity *q, int k, const plot_run *run) {
    const char *text = run->column[q->column[k]].text;
    const int together = quantities_in(p, q->panel);
    return p->runs == 1 && together <= 2 && text[0] != '\0' && strlen(text) <= TEXT_MOST
               ? alloc_words("%s: %s", q->name, text)
           : p->runs == 1  ? alloc_words("%s", q->name)
           : together == 1 ? alloc_words("%s", p->label[k])
                           : alloc_words("%s, %s", q->name, p->label[k]);
}

/* For one run: a colour for each quantity of the panel. For several: a colour for each run, and a dash for each curve,
 * so that five are distinguishable without colours. */
static void write_style(FILE *to, const panels *p, int of_panel, int k, bool points) {
    const int line = p->runs == 1 ? of_panel : k;
    const int dash = p->runs == 1 ? palette_dash(line) : 1 + (of_panel * p->runs + k) % 5;
    if (points) {
        fprintf(to, "points pt %d ps 0.6 lc rgb '%s'", palette_point(line), palette_line(line));
    } else {
        fprintf(to, "lines lw 1.8 dt %d lc rgb '%s'", dash, palette_line(line));
    }
}

static double first_trusted_s(const plot_run *runs, int count) {
    double least = 0.0;
    for (int k = 0; k < count; k++) {
        const double own = runs[k].trusted_s;
        least = own > 0.0 && !(least > 0.0 && least < own) ? own : least;
    }
    return least;
}

/* "" if all is trusted; short for several runs, since a legend's columns are as wide as its longest entry. */
static char *trust_sign(const plot_run *runs, int count) {
    const double until_s = first_trusted_s(runs, count);
    return !(until_s > 0.0) ? alloc_words("%s", "")
           : count > 1
               ? alloc_words("trusted until %.6g s", until_s)
               : alloc_words(
                     "after %.6g s no single value is to be trusted, energy and momenta are",
                     until_s);
}

static int marks_in(const plot_run *runs, int count) {
    int marks = 0;
    for (int k = 0; k < count; k++) {
        marks += runs[k].marks;
    }
    return marks;
}

/* Lines of a panel's legend, in columns as wide as its longest entry. */
static int key_lines(const panels *p, const plot_run *runs, int panel, bool time) {
    const bool signs = time && panel == 0;
    char *trusted = trust_sign(runs, p->runs);
    size_t longest = signs ? strlen(trusted) : 0;
    free(trusted);
    int entries = (longest > 0 ? 1 : 0) + (signs && marks_in(runs, p->runs) > 0 ? 1 : 0);
    for (int i = 0; i < p->quantities; i++) {
        for (int k = 0; k < p->runs && p->quantity[i].panel == panel; k++) {
            char *words = legend_of(p, &p->quantity[i], k, &runs[k]);
            longest = strlen(words) > longest ? strlen(words) : longest;
            free(words);
            entries++;
        }
    }
    const int columns =
        (int)number_most(1.0, KEY_WIDTH / (KEY_SAMPLE + KEY_LETTER * (double)longest));
    return (entries + columns - 1) / columns;
}

/* Entries of the first panel's legend other than curves. */
static void write_signs(FILE *to, const plot_run *runs, int count) {
    char *trusted = trust_sign(runs, count);
    if (trusted[0] != '\0') {
        fprintf(to,
                ", keyentry with boxes fillstyle solid noborder lc rgb '" PALETTE_SHADE
                "' title '%s'",
                trusted);
    }
    free(trusted);
    if (marks_in(runs, count) > 0) {
        fputs(", keyentry with points pt 2 ps 0.7 lc rgb '" PALETTE_FRAME "' title 'event'", to);
    }
}

/* Label the y axis with this text, which is freed, or with the quantities' names and unit. */
static void write_panel(FILE *to, const panels *p, const plot_run *runs, int panel, bool time,
                        char *ylabel) {
    extent e = nothing;
    int drawn = 0;
    int of_panel = 0;
    for (int i = 0; i < p->quantities; i++) {
        if (p->quantity[i].panel == panel) {
            const extent own = quantity_extent(p, runs, p->quantity[i].column);
            e = (extent){number_least(e.least, own.least), number_most(e.most, own.most)};
        }
    }
    write_range(to, "y", e.least, e.most);
    fprintf(to, "set key vertical maxrows %d\n", key_lines(p, runs, panel, time));
    char *names = ylabel != NULL ? ylabel : names_of(p, panel, AXIS_MOST);
    write_axis(to, "y", names, ylabel != NULL ? NULL : p->unit[panel]);
    free(names);
    for (int i = 0; i < p->quantities; i++) {
        const panels_quantity *q = &p->quantity[i];
        for (int k = 0; k < p->runs && q->panel == panel; k++) {
            if (q->column[k] >= 0 && p->x[k] >= 0) {
                fprintf(to, "%s$data%d using %d:%d with ", drawn++ > 0 ? ", " : "plot ", k,
                        p->x[k] + 1, q->column[k] + 1);
                write_style(to, p, of_panel, k, runs[k].rows == 1);
                char *words = legend_of(p, q, k, &runs[k]);
                fputs(" title ", to);
                gnuplot_quote(to, words);
                free(words);
            }
        }
        of_panel += q->panel == panel ? 1 : 0;
    }
    if (drawn == 0) {
        fputs("plot NaN notitle", to);
    }
    if (time && panel == 0) {
        write_signs(to, runs, p->runs);
    }
    fputc('\n', to);
}

void plot_shade(FILE *to, double from_s) {
    fprintf(to,
            "set object 1 rectangle from first %.17g, graph 0 to graph 1, graph 1 behind "
            "fillcolor rgb '" PALETTE_SHADE "' fillstyle solid noborder\n",
            from_s);
}

/* The shade after the least trusted time in every panel, and a cross on each axis for an event. */
static void write_times(FILE *to, const plot_run *runs, int count) {
    const double trusted_s = first_trusted_s(runs, count);
    if (trusted_s > 0.0) {
        plot_shade(to, trusted_s);
    }
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < runs[k].marks; i++) {
            fprintf(to,
                    "set label at first %.17g, graph 0 '' point pt 2 ps 0.7 lc rgb '%s' front\n",
                    runs[k].mark_s[i], count > 1 ? palette_line(k) : PALETTE_FRAME);
        }
    }
}

static void write_data(FILE *to, const plot_run *run, int number) {
    fprintf(to, "$data%d << EOD\n", number);
    for (int r = 0; r < run->rows; r++) {
        for (int c = 0; c < run->columns; c++) {
            fprintf(to, "%.17g ", run->data[(size_t)r * (size_t)run->columns + (size_t)c]);
        }
        fputc('\n', to);
    }
    fputs("EOD\n", to);
}

/* The picture's title: the requested one, the run's, or its axes in words. Free it. */
static char *title_of(const panels *p, const plot_choice *choice, const plot_run *runs) {
    bool alike = true;
    for (int k = 1; k < p->runs; k++) {
        alike = alike && strcmp(runs[k].title, runs[0].title) == 0;
    }
    if (choice->title != NULL || alike) {
        return alloc_words("%s", choice->title != NULL ? choice->title : runs[0].title);
    }
    char *names = names_of(p, -1, TEXT_MOST);
    char *title = alloc_words("%s over %s, %d runs", names, p->x_name, p->runs);
    free(names);
    return title;
}

/* For readers who do not see the picture; free it. */
static char *alternative_text(const panels *p, const plot_run *runs) {
    char *text = alloc_words("Curves over %s.", p->x_name);
    for (int i = 0; i < p->quantities; i++) {
        const panels_quantity *q = &p->quantity[i];
        const char *unit = p->unit[q->panel];
        for (int k = 0; k < p->runs; k++) {
            const extent e = joined(nothing, &runs[k], q->column[k]);
            if (!(e.least <= e.most)) {
                continue;
            }
            char *longer =
                alloc_words("%s %s%s%s lies between %.4g and %.4g%s%s.", text, q->name,
                            p->runs > 1 ? " of " : "", p->runs > 1 ? p->label[k] : "", e.least,
                            e.most, unit != NULL ? " " : "", unit != NULL ? unit : "");
            free(text);
            text = longer;
        }
    }
    return text;
}

static bool draw_panels(const panels *p, const char *file, const plot_choice *choice,
                        const plot_run *runs) {
    const bool time = !plot_is_path(choice) && strcmp(runs[0].column[0].name, "time") == 0;
    char *title = title_of(p, choice, runs);
    char *text = alternative_text(p, runs);
    gnuplot g;
    int lines = 1;
    for (int i = 0; i < p->count; i++) {
        lines = (int)number_most(lines, key_lines(p, runs, i, time));
    }
    const int each = PANEL_HEIGHT + KEY_LINE * (lines - 1);
    bool drawn = gnuplot_open(&g, file, 120 + each * p->count, title, text);
    if (drawn) {
        for (int k = 0; k < p->runs; k++) {
            write_data(g.to, &runs[k], k);
        }
        fprintf(g.to, "set multiplot layout %d,1 title ", p->count);
        gnuplot_quote(g.to, title);
        fprintf(g.to,
                ".\"\\n\" noenhanced\nset key above left Left reverse noenhanced samplen %d\n"
                "set lmargin %d\nset rmargin %d\n",
                p->runs > 1 ? 4 : 2, LEFT_MARGIN, RIGHT_MARGIN);
        const extent x = quantity_extent(p, runs, p->x);
        write_range(g.to, "x", x.least, x.most);
        if (time) {
            write_times(g.to, runs, p->runs);
        }
        const char *ylabels = choice->ylabel;
        for (int i = 0; i < p->count; i++) {
            const bool last = i == p->count - 1;
            const char *own = choice->xlabel;
            write_axis(g.to, "x",
                       !last         ? ""
                       : own != NULL ? own
                                     : p->x_name,
                       last && own == NULL ? p->x_unit : NULL);
            write_panel(g.to, p, runs, i, time, panels_next(&ylabels));
        }
        fputs("unset multiplot\n", g.to);
        drawn = gnuplot_close(&g);
    }
    free(title);
    free(text);
    return drawn;
}

bool plot_draw(const char *command, const char *file, const plot_choice *choice,
               const plot_run *runs, int count) {
    panels p;
    bool drawn = panels_make(&p, command, choice, runs, count);
    if (drawn && p.count == 0) {
        fprintf(stderr, "whirl %s: error: there is no quantity to draw\n", command);
        drawn = false;
    }
    drawn = drawn && draw_panels(&p, file, choice, runs);
    panels_free(&p);
    return drawn;
}
