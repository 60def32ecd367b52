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
/* Rows of own_option for these options. They set a plot_choice. */
#define RUN_CHOICE_ROWS(choice) \
    {.word = "--y", .text = &(choice).y}, \
        {.word = "--panel", \
         .text = (choice).panel, \
         .count = &(choice).panels, \
         .limit = PLOT_PANELS}, \
        {.word = "--x", .text = &(choice).x}, {.word = "--title", .text = &(choice).title}, \
        {.word = "--xlabel", .text = &(choice).xlabel}, { \
        .word = "--ylabel", .text = &(choice).ylabel \
    }

/* Like command_run() with these words and --quiet, but draws no picture. *taken gets the decimated data
 * for a picture of this choice of curves. Call plot_run_close() in any case. */
int run_to_take(int count, char **words, const plot_choice *choice, plot_run *taken);

#endif
