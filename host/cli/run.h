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
    "  --ylabel TEXTS       the labels of the panels, separated by commas\n"
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

/* Runs a scene like `whirl run --quiet` with these words. *taken gets the data of a picture of the chosen curves.
 * Free it with plot_run_close(), also after an error. Returns an exit status. */
int run_to_take(int count, char **words, const plot_choice *choice, plot_run *taken);

#endif
