/* step_text.h: a step as --step takes it. */
#ifndef RUN_STEP_TEXT_H
#define RUN_STEP_TEXT_H

enum { STEP_WORD = 40 };

/* The largest of 1, 2 and 5 times powers of ten, s, from 1000 s down, that is not beyond it; 0: none. */
double step_nice_s(double most_s);
/* "200us", in as many digits as it takes to be read back as it is; returns `text`. */
const char *step_text(double step_s, char text[STEP_WORD]);

#endif
