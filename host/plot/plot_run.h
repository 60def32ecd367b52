/* plot_run.h: the quantities of one run or sweep, with their units, from memory or from a CSV file. */
#ifndef PLOT_PLOT_RUN_H
#define PLOT_PLOT_RUN_H

#include <stdbool.h>

typedef struct plot_column {
    char *name; /* x, der(x), der(der(x)), ... */
    char *unit; /* as declared; NULL: not known */
    char *text; /* the quantity in words, or "" */
} plot_column;

/* Owns all of it. Column 0 is the time, or the first swept value. */
typedef struct plot_run {
    char *title; /* of a picture of this run alone */
    char *label; /* in the legend of a picture of several runs */
    plot_column *column;
    int columns;
    double *data; /* [rows * columns] row by row; one row is drawn as points */
    int rows;
    double trusted_s; /* the picture is shaded after it; not above 0: nowhere */
    double *mark_s;   /* [marks] times of events */
    int marks;
} plot_run;

/* Columns without names, no data. Texts are copied; `unit` may be NULL. */
void plot_run_open(plot_run *run, const char *title, const char *label, int columns);
void plot_run_name(plot_run *run, int column, const char *name, const char *unit, const char *text);
void plot_run_close(plot_run *run);

/* The CSV file, and the file about it beside it, if there is one. A quantity's field that is no number is NaN. False is
 * reported; plot_run_close() in any case. */
bool plot_run_read(const char *command, const char *csv, plot_run *run);

/* Writes CSV.toml, which describes the run: `facts` are lines of TOML for its head, `tables` for its end. False
 * is reported. */
bool plot_run_about(const char *csv, const plot_run *run, const char *facts, const char *tables);

/* A TOML string, in quotes. Free it. */
char *plot_run_quoted(const char *text);

#endif
