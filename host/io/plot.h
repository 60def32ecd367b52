/* plot.h: curves of one or more runs, in stacked panels with one common axis, drawn by gnuplot. */
#ifndef IO_PLOT_H
#define IO_PLOT_H

#include <stdbool.h>
#include <stdio.h>

/* === the quantities of one run or sweep, with their units, from memory or from a CSV file ===== */

typedef struct plot_column {
    char *name;  /* x, der(x), der(der(x)), ... */
    char *shown; /* x, x', x'', ... */
    char *unit;  /* declared unit; NULL: unknown */
    char *text;  /* the quantity in words, or "" */
} plot_column;

/* Owns its data. Column 0 is the time, or the first swept value. */
typedef struct plot_run {
    char *title; /* title if the run is alone in the picture */
    char *label; /* label in the legend of several runs */
    plot_column *column;
    int columns;
    double *data; /* [rows * columns] by row; a single row is drawn as points */
    int rows;
    double trusted_s; /* shade the picture from this time on; <= 0: no shade */
    double *mark_s;   /* [marks] times of events */
    int marks;
} plot_run;

/* Opens a run. It has no data yet, and its columns have no names. Texts are copied; `unit` may be NULL. */
void plot_run_open(plot_run *run, const char *title, const char *label, int columns);
void plot_run_name(plot_run *run, int column, const char *name, const char *unit, const char *text);
/* Names a column by its heading, NAME or NAME [UNIT]. The time is in seconds. */
void plot_run_head(plot_run *run, int column, const char *heading);
void plot_run_close(plot_run *run);

/* Reads the CSV file, and CSV.toml if it exists. Empty fields become NaN; a text that is neither a number nor NaN is an
 * error. Returns false after an error (reported). Call plot_run_close() in any case. */
bool plot_run_read(const char *command, const char *csv, plot_run *run);

/* Writes CSV.toml: first the text `facts`, then the run's data, then the text `tables`. Returns false after an error
 * (reported). */
bool plot_run_about(const char *csv, const plot_run *run, const char *facts, const char *tables);

/* Calls atomic_file_close(). If that kept a regular file, also writes CSV.toml: Whirl's version, `command` and `scene`
 * ("": none). Returns false after an error (reported). */
bool plot_run_csv_end(FILE *csv, const char *name, bool keep, const char *command,
                      const char *scene);

/* A TOML string in quotes. The caller frees it. */
char *plot_run_quoted(const char *text);

/* === a choice of quantities, resolved to panels and curves ==================================== */

enum { PLOT_PANELS = 16 };

/* If all members are zero, the plot shows every coordinate and output, but no rates. Each unit has its own panel. */
typedef struct plot_choice {
    const char *x;                  /* a quantity; NULL: column 0 */
    const char *y;                  /* quantities; each unit has its own panel */
    const char *panel[PLOT_PANELS]; /* quantities that share a panel */
    int panels;
    const char *legend; /* labels of the runs; NULL: their own */
    const char *title;
    const char *xlabel; /* NULL: quantity and unit */
    const char *ylabel; /* labels of the panels; NULL: quantities and unit */
} plot_choice;

/* Returns false (reported) if a quantity of the choice is unknown, or a panel has two units. The runs need no data. */
bool plot_fits(const char *command, const plot_choice *choice, const plot_run *runs, int count);
/* Is x a quantity other than column 0? */
bool plot_is_path(const plot_choice *choice);

enum { PANELS_QUANTITIES = 256 };

typedef struct panels_quantity {
    char *name;  /* as displayed: theta' */
    int *column; /* [runs] its column in each run; -1: the run has none */
    int panel;
} panels_quantity;

typedef struct panels {
    panels_quantity quantity[PANELS_QUANTITIES];
    int quantities;
    const char *unit[PANELS_QUANTITIES]; /* NULL: unknown */
    int count;
    int *x; /* [runs] column of the x axis */
    const char *x_unit;
    char *x_name;
    char *label[PANELS_QUANTITIES]; /* labels of the runs */
    int runs;
} panels;

/* Draws to `file`. Titles and names (UTF-8) appear literally. Exponents after ^ in a unit are raised. No text or
 * file name can act as a gnuplot command. Returns false after an error (reported). */
bool plot_draw(const char *command, const char *file, const plot_choice *choice,
               const plot_run *runs, int count);

/* Writes gnuplot's command that shades a panel's background from this time on. */
void plot_shade(FILE *to, double from_s);

/* === a figure from its description ============================================================= */
/* mk/figures/figures.sh documents the format of a .fig text. */

/* Records of a run, sweep or table of the figure. */
typedef struct figure_data {
    char *name;
    char *csv;        /* text with a header line */
    double trusted_s; /* end of the trusted time; 0: not limited, or unknown */
} figure_data;

/* Finds the next line from *at on that begins with `word` and a blank. Returns its rest, to be freed, or NULL. */
char *figure_line(const char **at, const char *word);

/* Draws the figure described by `text`, which messages call `where`. `varied`: options that changed its runs, or "".
 * They are added to the title, and replace the caption, which describes the original runs. Returns false (reported) if
 * the description is wrong, or drawing fails. */
bool figure_draw(const char *file, const char *where, const char *text, const figure_data *data,
                 int count, const char *varied);

#endif
