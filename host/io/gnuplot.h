/* gnuplot.h: a gnuplot process that draws one picture, and quoting of text for it. */
#ifndef IO_GNUPLOT_H
#define IO_GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>

/* === colours and shapes ================================================================================== */
/* Every line colour has a contrast of 3:1 (WCAG 2.1, 1.4.11) with a white and a dark page. Two line colours differ by
 * at least 13 (CIELAB), in normal vision and with each colour blindness (Machado, Oliveira and Fernandes, 2009).
 * tests/host/test_plot.c computes both. mk/curves/chart.sh also reads PALETTE_LINE_ROWS. */

#define PALETTE_LINE_ROWS(X) \
    X("#0072b2") \
    X("#d55e00") \
    X("#709764") \
    X("#7e79ff") \
    X("#8d5066") \
    X("#309eb9") \
    X("#c2058b") \
    X("#b87289")

/* Colours of areas, from good to bad; their lightness differs, so that they are distinguishable without colour. */
#define PALETTE_AREA_ROWS(X) \
    X("#d0e6f0") \
    X("#8fbf7f") \
    X("#e08b3c") \
    X("#8e1420")

#define PALETTE_WHITE "#ffffff"
#define PALETTE_DARK "#0d1117"
/* Colour of frames, tics and a figure's "law" curves, with a contrast of 3:1 with a white and a dark page. */
#define PALETTE_FRAME "#767676"
#define PALETTE_GRID "#d8d8d8"
#define PALETTE_SHADE "#e4e4e4"

#define PALETTE_ONE(colour) +1
#define PALETTE_WORD(colour) colour,
enum {
    PALETTE_LINES = PALETTE_LINE_ROWS(PALETTE_ONE),
    PALETTE_AREAS = PALETTE_AREA_ROWS(PALETTE_ONE)
};

/* Colour of line i, from 0. Colours repeat after the last one, with another palette_dash(). */
static inline const char *palette_line(int i) {
    static const char *const lines[] = {PALETTE_LINE_ROWS(PALETTE_WORD)};
    return lines[i % PALETTE_LINES];
}

static inline int palette_dash(int i) { return 1 + i / PALETTE_LINES % 5; }

static inline const char *palette_area(int i) {
    static const char *const areas[] = {PALETTE_AREA_ROWS(PALETTE_WORD)};
    return areas[i];
}

/* gnuplot's number for the shape of point i. */
static inline int palette_point(int i) {
    static const int points[] = {7, 5, 9, 11, 13, 15, 1, 2, 3};
    return points[i % 9];
}

typedef struct gnuplot {
    FILE *to;      /* gnuplot's commands */
    FILE *said;    /* gnuplot's messages, shown after a failure */
    FILE *drawn;   /* the picture by gnuplot */
    FILE *picture; /* the final file */
    const char *file;
    const char *title;
    const char *text;
} gnuplot;

/* Returns false (reported) if `file` does not end in .svg, .png or .pdf. The report names `option`. */
bool gnuplot_can_draw_for(const char *command, const char *option, const char *file);

/* Returns false (reported) if gnuplot is missing. */
bool gnuplot_is_there(void);

/* Begins a picture of 900 by `height` pixels. An SVG gets `title` and the alternative `text`. `file`, `title` and
 * `text` must live until gnuplot_close(), which fails if gnuplot is missing. Returns false (reported) if the file
 * cannot be written. */
bool gnuplot_open(gnuplot *g, const char *file, int height, const char *title, const char *text);
/* Finishes the picture. Returns false after a failure (reported). */
bool gnuplot_close(gnuplot *g);

/* Writes text in quotes. gnuplot shows it literally if "noenhanced" is set. */
void gnuplot_quote(FILE *to, const char *text);
/* Writes text[at], escaped for a string in gnuplot's double quotes. The caller writes the quotes. */
void gnuplot_character(FILE *to, const char *text, size_t at);

#endif
