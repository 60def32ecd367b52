/* figure_draw.h: a figure's description as a picture. mk/figures/figures.sh tells the form of a .fig text. */
#ifndef PLOT_FIGURE_DRAW_H
#define PLOT_FIGURE_DRAW_H

#include <stdbool.h>

/* The records of a run, sweep or table of the figure. */
typedef struct figure_data {
    char *name;
    char *csv;        /* text with a header line */
    double trusted_s; /* until when; 0: to the end, or not known */
} figure_data;

/* The rest of the next line of `text` from *at on that begins with `word` and a blank; NULL at the end. Free it. */
char *figure_line(const char **at, const char *word);

/* Draws it. `varied` holds the options that change its runs, "" without any: the title names them, and the caption, which
 * describes the original, is left out. False, reported, when the description is wrong (`where` names it) or the picture
 * cannot be drawn. */
bool figure_draw(const char *file, const char *where, const char *text, const figure_data *data,
                 int count, const char *varied);

#endif
