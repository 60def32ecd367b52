/* gnuplot.h: a gnuplot that draws one picture: its process, and text that is no command to it. */
#ifndef PLOT_GNUPLOT_H
#define PLOT_GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>

typedef struct gnuplot {
    FILE *to;   /* its commands */
    FILE *said; /* what it says, shown when it fails; or NULL */
    const char *file;
    void (*before)(int); /* of SIGPIPE */
} gnuplot;

/* True when the file's ending is one that can be drawn. */
bool gnuplot_can_draw(const char *file);

/* False, told on standard error, when gnuplot is missing. */
bool gnuplot_is_there(void);

/* Begins a picture of 900 by `height` pixels in `file` (.svg or .png). False, told on standard error, when the file
 * cannot be written or gnuplot is missing. */
bool gnuplot_open(gnuplot *g, const char *file, int height);
/* Ends it. False, told, when it could not be drawn. */
bool gnuplot_close(gnuplot *g);

/* Text as it is written, where gnuplot is told "noenhanced". */
void gnuplot_quote(FILE *to, const char *text);
/* A character of it, text[at], between gnuplot's double quotes. */
void gnuplot_character(FILE *to, const char *text, size_t at);

#endif
