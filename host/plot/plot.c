/* plot.c: handing curves to gnuplot. */
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/number/functions.h"

static const char *ending_of(const char *file) {
    const char *dot = strrchr(file, '.');
    return dot == NULL ? "" : dot + 1;
}

bool plot_can_draw(const char *file) {
    return strcmp(ending_of(file), "svg") == 0 || strcmp(ending_of(file), "png") == 0;
}

/* A character, text[at], between gnuplot's double quotes. Letters and the bytes of UTF-8 stand for themselves, all
 * else is its octal code, so that nothing of it is a `command`, a @macro, an escape or a quote; digits too, lest
 * they lengthen the code before them. The picture's XML has no control characters: each becomes a blank. Nor has
 * it "]]>", whose > gnuplot leaves alone: a character without width (U+2060) parts it. */
static void write_character(FILE *to, const char *text, size_t at) {
    const unsigned char code = (unsigned char)text[at];
    const unsigned char lower = code | 0x20;
    if (code == '>' && at >= 2 && text[at - 1] == ']' && text[at - 2] == ']') {
        fputs("\xe2\x81\xa0", to);
    }
    if (code >= 0x80 || (lower >= 'a' && lower <= 'z')) {
        fputc(code, to);
    } else {
        fprintf(to, "\\%03o", code < 0x20 || code == 0x7f ? (unsigned)' ' : (unsigned)code);
    }
}

/* Text as it is written, where gnuplot is told "noenhanced". */
static void write_quoted(FILE *to, const char *text) {
    fputc('"', to);
    for (size_t at = 0; text[at] != '\0'; at++) {
        write_character(to, text, at);
    }
    fputc('"', to);
}

/* A unit in gnuplot's enhanced text: what follows a ^ is raised, "m^(1/2)" whole and without its
 * parentheses. Its other marks are escaped. */
static void write_unit(FILE *to, const char *unit) {
    fputc('"', to);
    for (const char *at = unit; *at != '\0'; at++) {
        if (*at != '^') {
            fputs(strchr("_{}@&~\\", *at) != NULL ? "\\134" : "", to);
            write_character(to, unit, (size_t)(at - unit));
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
                write_quoted(to, curves[k].name);
            }
        }
        fputs("\n", to);
    }
}

/* Puts the file in the place of a stream, until put_back() of what this returns; -1 when there was none. */
static int put_in_place(FILE *file, int stream) {
    const int before = dup(stream);
    if (before >= 0) {
        dup2(fileno(file), stream);
    }
    return before;
}

static void put_back(int before, int stream) {
    if (before >= 0) {
        dup2(before, stream);
        close(before);
    }
}

/* gnuplot, which draws to its standard output, the picture: the file's name, which could begin with a | or ~,
 * never reaches it. What it says is kept in `said`: it is shown only when it fails. */
static FILE *start_gnuplot(FILE *picture, FILE *said) {
    fflush(stdout);
    fflush(stderr);
    const int output = put_in_place(picture, STDOUT_FILENO);
    const int errors = said == NULL ? -1 : put_in_place(said, STDERR_FILENO);
    FILE *to = output < 0 ? NULL : popen("LC_ALL=C.UTF-8 gnuplot", "w");
    put_back(errors, STDERR_FILENO);
    put_back(output, STDOUT_FILENO);
    return to;
}

static void show_said(FILE *said) {
    rewind(said);
    for (int c = fgetc(said); c != EOF; c = fgetc(said)) {
        fputc(c, stderr);
    }
}

bool plot_draw(const char *file, const char *title, const curve *curves, int count,
               const double *data, int rows, int columns) {
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        fprintf(stderr, "whirl: error: plots need gnuplot, which is not installed\n"
                        "hint: make deps installs it (Debian package gnuplot-nox)\n");
        return false;
    }
    FILE *picture = fopen(file, "wb");
    if (picture == NULL) {
        fprintf(stderr, "%s: error: cannot be written: %s\n", file, strerror(errno));
        return false;
    }
    void (*before)(int) = signal(SIGPIPE, SIG_IGN);
    FILE *said = tmpfile(); /* without one, gnuplot says it itself */
    FILE *to = start_gnuplot(picture, said);
    fclose(picture);
    if (to == NULL) {
        perror("whirl: error: gnuplot");
        if (said != NULL) {
            fclose(said);
        }
        signal(SIGPIPE, before);
        return false;
    }
    const int panels = count_panels(curves, count);
    fprintf(to,
            strcmp(ending_of(file), "svg") == 0
                ? "set terminal svg size 900,%d dynamic background rgb 'white'\n"
                : "set terminal pngcairo size 900,%d\n",
            120 + 260 * panels);
    fputs("set encoding utf8\n$data << EOD\n", to);
    for (int r = 0; r < rows; r++) {
        for (int c = 0; c < columns; c++) {
            fprintf(to, "%.17g ", data[(size_t)r * (size_t)columns + (size_t)c]);
        }
        fputc('\n', to);
    }
    fprintf(to, "EOD\nset multiplot layout %d,1 title ", panels);
    write_quoted(to, title);
    fputs(" noenhanced\nset grid\nset key outside right top noenhanced\nset xlabel 'time [s]'\n",
          to);
    fprintf(to, "set lmargin %d\nset rmargin %d\n", LEFT_MARGIN, right_margin(curves, count));
    write_panels(to, &(plot_table){data, rows, columns}, curves, count);
    fputs("unset multiplot\n", to);
    const bool written = ferror(to) == 0;
    const int code = pclose(to);
    signal(SIGPIPE, before);
    const bool drawn = written && code == 0;
    if (said != NULL) {
        if (!drawn) {
            show_said(said);
        }
        fclose(said);
    }
    if (!drawn) {
        fprintf(stderr, "whirl: error: gnuplot could not draw %s\n", file);
    }
    return drawn;
}
