/* gnuplot.h: a gnuplot that draws one picture: its process, and text that is no command to it. */
#ifndef PLOT_GNUPLOT_H
#define PLOT_GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>

typedef struct gnuplot {
    FILE *to;      /* its commands */
    FILE *said;    /* its messages, shown when it fails */
    FILE *drawn;   /* the picture as gnuplot draws it, */
    FILE *picture; /* and as it is kept: an SVG has a title and alternative text */
    const char *file;
    const char *title;
    const char *text;
    void (*before)(int); /* of SIGPIPE */
} gnuplot;

/* True when the file ends in .svg, .png or .pdf. */
bool gnuplot_can_draw(const char *file);
/* The same; false is reported, with the option that named the file. */
bool gnuplot_can_draw_for(const char *command, const char *option, const char *file);

/* False, told on standard error, when gnuplot is missing. */
bool gnuplot_is_there(void);

/* Begins a picture of 900 by `height` pixels in `file`, in the look that all pictures share (palette.h). An SVG gets
 * `title` and the alternative `text`; both must live until gnuplot_close(). False, reported, when the file cannot be
 * written or gnuplot is missing. */
bool gnuplot_open(gnuplot *g, const char *file, int height, const char *title, const char *text);
/* Ends it. False, told, when it could not be drawn. */
bool gnuplot_close(gnuplot *g);

/* Text as it is written, where gnuplot is told "noenhanced". */
void gnuplot_quote(FILE *to, const char *text);
/* A character of it, text[at], between gnuplot's double quotes. */
void gnuplot_character(FILE *to, const char *text, size_t at);

#endif
