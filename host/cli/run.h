/* run.h: the common part of `whirl run` and `whirl plot`. */
#ifndef CLI_RUN_H
#define CLI_RUN_H

#include "host/io/plot.h"

/* The options of the choice of curves, for help texts. */
#define RUN_CHOICE_HELP \
    "  --y NAMES            quantities between commas, a panel for each unit: --y \"X', theta\" (default:\n" \
    "                       coordinates and outputs)\n" \
    "  --panel NAMES        quantities that share a panel (repeatable)\n" \
    "  --x NAME             the horizontal axis (default: the time)\n" \
    "  --title TEXT         the title\n" \
    "  --xlabel TEXT        the label of the horizontal axis\n" \
    "  --ylabel TEXTS       the labels of the panels, between commas\n"
#define RUN_CHOICE_WORDS "--y", "--panel", "--x", "--title", "--xlabel", "--ylabel"

/* If words[*at] is one of these, take it and advance *at past it. An error is reported and sets *bad. */
bool run_take_choice(const char *command, int count, char **words, int *at, plot_choice *to,
                     bool *bad);

/* As command_run() with these words and --quiet. *taken gets the data of a picture, decimated for this choice, and no
 * picture is drawn. Call plot_run_close() in any case. */
int run_to_take(int count, char **words, const plot_choice *choice, plot_run *taken);

#endif
