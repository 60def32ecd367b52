/* gnuplot.h: a gnuplot process that draws one picture, and quoting of text for it. */
#ifndef IO_GNUPLOT_H
#define IO_GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>

typedef struct gnuplot {
    FILE *to;      /* its commands */
    FILE *said;    /* its messages, shown after a failure */
    FILE *drawn;   /* the picture from gnuplot, */
    FILE *picture; /* and the final one: an SVG has a title and alternative text */
    const char *file;
    const char *title;
    const char *text;
    void (*before)(int); /* of SIGPIPE */
} gnuplot;

/* True when the file ends in .svg, .png or .pdf. */
bool gnuplot_can_draw(const char *file);
/* The same; false is reported, with the option that named the file. */
bool gnuplot_can_draw_for(const char *command, const char *option, const char *file);

/* False, reported on standard error, if gnuplot is missing. */
bool gnuplot_is_there(void);

/* Begin a picture of 900 by `height` pixels in `file`, in the common look (palette.h). An SVG gets `title` and the
 * alternative `text`; both must live until gnuplot_close(). False, reported, if the file cannot be written or gnuplot
 * is missing. */
bool gnuplot_open(gnuplot *g, const char *file, int height, const char *title, const char *text);
/* Finish the picture. False, reported, after a failure. */
bool gnuplot_close(gnuplot *g);

/* Literal text, for places with gnuplot's "noenhanced". */
void gnuplot_quote(FILE *to, const char *text);
/* One character of it, text[at], between gnuplot's double quotes. */
void gnuplot_character(FILE *to, const char *text, size_t at);

#endif
