/* plot.c: handing curves to gnuplot. */
#include "plot.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *ending_of(const char *file) {
    const char *dot = strrchr(file, '.');
    return dot == NULL ? "" : dot + 1;
}

bool plot_can_draw(const char *file) {
    return strcmp(ending_of(file), "svg") == 0 || strcmp(ending_of(file), "png") == 0;
}

/* Text between gnuplot's double quotes. */
static void write_quoted(FILE *to, const char *text) {
    fputc('"', to);
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\') {
            fputc('\\', to);
        }
        if (*text != '\n' && *text != '\r') {
            fputc(*text, to);
        }
    }
    fputc('"', to);
}

/* A unit in gnuplot's enhanced text: what follows a ^ is raised, "m^(1/2)" whole and without its
 * parentheses. */
static void write_unit(FILE *to, const char *unit) {
    fputc('"', to);
    for (const char *at = unit; *at != '\0'; at++) {
        fputc(*at, to);
        if (*at != '^') {
            continue;
        }
        const bool open = at[1] == '(';
        const char *from = at + (open ? 2 : 1);
        const size_t length = strspn(from, open ? "-0123456789/" : "-0123456789");
        fprintf(to, "{%.*s}", (int)length, from);
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

static void write_panels(FILE *to, const curve *curves, int count) {
    for (int i = 0; i < count; i++) {
        bool first = true;
        for (int k = 0; k < i; k++) {
            first = first && !same_panel(&curves[k], &curves[i]);
        }
        if (!first) {
            continue;
        }
        fputs("set ylabel ", to);
        write_unit(to, curves[i].unit);
        fputs("\nplot ", to);
        for (int k = i; k < count; k++) {
            if (same_panel(&curves[k], &curves[i])) {
                fprintf(to, "%s$data using 1:%d with lines lw 1.5 title ", k > i ? ", " : "",
                        curves[k].column + 1);
                write_quoted(to, curves[k].name);
            }
        }
        fputs("\n", to);
    }
}

bool plot_draw(const char *file, const char *title, const curve *curves, int count,
               const double *data, int rows, int columns) {
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        fprintf(stderr, "whirl: error: plots need gnuplot, which is not installed\n"
                        "hint: make deps installs it (Debian package gnuplot-nox)\n");
        return false;
    }
    void (*before)(int) = signal(SIGPIPE, SIG_IGN);
    FILE *to = popen("LC_ALL=C.UTF-8 gnuplot", "w");
    if (to == NULL) {
        perror("whirl: error: gnuplot");
        signal(SIGPIPE, before);
        return false;
    }
    const int panels = count_panels(curves, count);
    fprintf(to,
            strcmp(ending_of(file), "svg") == 0
                ? "set terminal svg size 900,%d dynamic background rgb 'white'\n"
                : "set terminal pngcairo size 900,%d\n",
            120 + 260 * panels);
    fputs("set encoding utf8\nset output ", to);
    write_quoted(to, file);
    fputs("\n$data << EOD\n", to);
    for (int r = 0; r < rows; r++) {
        for (int c = 0; c < columns; c++) {
            fprintf(to, "%.9g ", data[(size_t)r * (size_t)columns + (size_t)c]);
        }
        fputc('\n', to);
    }
    fprintf(to, "EOD\nset multiplot layout %d,1 title ", panels);
    write_quoted(to, title);
    fputs(" noenhanced\nset grid\nset key outside right top noenhanced\nset xlabel 'time [s]'\n",
          to);
    write_panels(to, curves, count);
    fputs("unset multiplot\nset output\n", to);
    const bool written = ferror(to) == 0;
    const int code = pclose(to);
    signal(SIGPIPE, before);
    if (!written || code != 0) {
        fprintf(stderr, "whirl: error: gnuplot could not draw %s\n", file);
        return false;
    }
    return true;
}
