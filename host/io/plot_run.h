/* plot_run.h: the quantities of one run or sweep, with their units, from memory or from a CSV file. */
#ifndef IO_PLOT_RUN_H
#define IO_PLOT_RUN_H

#include <stdbool.h>

typedef struct plot_column {
    char *name; /* x, der(x), der(der(x)), ... */
    char *unit; /* as declared; NULL: unknown */
    char *text; /* the quantity in words, or "" */
} plot_column;

/* Owner of all its data. Column 0 is the time, or the first swept value. */
typedef struct plot_run {
    char *title; /* for a picture of this run alone */
    char *label; /* in the legend of a picture of several runs */
    plot_column *column;
    int columns;
    double *data; /* [rows * columns] row by row; a single row is drawn as points */
    int rows;
    double trusted_s; /* the picture is shaded after it; no shade if not above 0 */
    double *mark_s;   /* [marks] times of events */
    int marks;
} plot_run;

/* Columns without names, no data. Texts are copied; `unit` may be NULL. */
void plot_run_open(plot_run *run, const char *title, const char *label, int columns);
void plot_run_name(plot_run *run, int column, const char *name, const char *unit, const char *text);
void plot_run_close(plot_run *run);

/* Read the CSV file, and its description CSV.toml if that exists. A quantity's field that is not a number is NaN. False
 * is reported; call plot_run_close() in any case. */
bool plot_run_read(const char *command, const char *csv, plot_run *run);

/* Write CSV.toml, which describes the run: `facts` are lines of TOML for its head, `tables` for its end. False is
 * reported. */
bool plot_run_about(const char *csv, const plot_run *run, const char *facts, const char *tables);

/* A TOML string, in quotes. Free it. */
char *plot_run_quoted(const char *text);

#endif
