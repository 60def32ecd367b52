/* figure_draw.h: drawing a figure from its description. mk/figures/figures.sh documents the format of a .fig text. */
#ifndef IO_FIGURE_DRAW_H
#define IO_FIGURE_DRAW_H

#include <stdbool.h>

/* The records of a run, sweep or table of the figure. */
typedef struct figure_data {
    char *name;
    char *csv;        /* text with a header line */
    double trusted_s; /* end of the trusted time; 0: the whole time, or unknown */
} figure_data;

/* The remaining text of the next line of `text` from *at on that begins with `word` and a blank; NULL at the end. The
 * caller frees the result. */
char *figure_line(const char **at, const char *word);

/* Draw it. `varied` has the options that change its runs, or "". With options the title names them, and the caption,
 * which describes the original, is omitted. Returns false, and reports the reason, if the description is wrong (`where`
 * names it) or the picture cannot be drawn. */
bool figure_draw(const char *file, const char *where, const char *text, const figure_data *data,
                 int count, const char *varied);

#endif
