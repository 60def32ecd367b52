/* emitted.h: generated C of scenes that are drawn, and its words. */
#ifndef TESTS_HOST_EMITTED_H
#define TESTS_HOST_EMITTED_H

#include "c_read.h"
#include "drawn_scene.h"

typedef struct emitted_c {
    drawn_scene drawn;
    char *text;
    c_file file; /* of the text */
    char about[40];
} emitted_c;

/* The present one, and what scenes are drawn by. */
extern emitted_c emitted;
extern dice emitted_die;

/* Each of the scenes that are drawn, in turn. */
void each_emitted(void (*check)(const image *im));

/* Are these words in it, in this order? */
bool emitted_says(const char *words);
/* Is there such a line, or are there such lines, if it is wanted, and else none? */
void emitted_expect_line(const char *line, bool wanted);

#endif
