/* figure_text.h: figures of costs in words, each with how it is known. */
#ifndef PRICE_FIGURE_TEXT_H
#define PRICE_FIGURE_TEXT_H

#include <stdio.h>

#include "cost.h"
#include "trial.h"

enum { FIGURE_TEXT = 64 };

/* "1234 p": a letter for the basis, "-" for what is not known. Returns text. */
const char *figure_text(const cost_figure *f, char text[FIGURE_TEXT]);
/* The letter of a basis. */
char figure_letter(cost_basis basis);
/* What the letters mean, a line each of those that are in `cost`: "p  predicted: from the image, within a bound". */
void figure_legend(FILE *out, const cost *c);
/* "predicted, of simulated figures, within 8 %". Returns text. */
enum { FIGURE_WORDS = 120 };
const char *figure_words(const cost_figure *f, char text[FIGURE_WORDS]);

/* What was held against what, in lines that begin with two blanks. */
void figure_reference(FILE *out, const trials *t);

/* A field of CSV, quoted where RFC 4180 wants it. */
void figure_field(FILE *out, const char *text);

#endif
