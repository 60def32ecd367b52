/* emitted.h: generated C of random scenes, as words. */
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

/* The current scene's code, and the generator of scenes. */
extern emitted_c emitted;
extern dice emitted_die;

void each_emitted(void (*check)(const image *im));

/* Does the code contain these words in this order? */
bool emitted_says(const char *words);
/* The code must contain this line (or lines) if `wanted`, and must not otherwise. */
void emitted_expect_line(const char *line, bool wanted);

#endif
