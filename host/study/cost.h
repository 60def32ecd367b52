/* cost.h: the price of a step on a board: predicted from its image, or read from a counted row.
 *
 *     cost c = cost_of(image, cost_board_named("mps2-an386"), COST_FLOAT);
 *
 * An image contains its settings (method, compensated sums, angles). A prediction is a sum over the classes of operations
 * (cost_count.h) times the figures of the board and number (cost_rows.h, written by `make price-table`). It needs neither
 * a source tree nor a compiler. docs/price.md gives its error.
 *
 * With the source tree and the board's compiler and emulator the same is counted by
 *
 *     sh mk/price/measure_one.sh BOARD NUMBER FILE[:SCENE] [OPTIONS OF whirl derive...]
 *
 * It prints COST_HEADER and one row, which cost_measured() reads. Exit status 2: wrong words, or a tool is missing. 1:
 * the scene cannot be derived, does not fit or does not run.
 *
 * Neither includes wait states of flash, caches, interrupts, and other compilers and flags. */
#ifndef STUDY_COST_H
#define STUDY_COST_H

#include "cost_board.h"
#include "host/image/image.h"

/* A figure: the value is between `least` and `most`, of a prediction in nine of ten cases. COST_RANGE has no value.
 * COST_NOT_KNOWN: all are 0. */
typedef struct cost_figure {
    cost_basis basis;
    double value;
    double least;
    double most;
} cost_figure;

typedef struct cost {
    const char *why;          /* why figures are not known, a sentence for people; "" if all are */
    cost_figure instructions; /* a step, mean of a run */
    cost_figure instructions_worst; /* the longest step: with contacts far above the mean */
    cost_figure cycles;             /* of the mean step */
    cost_figure cycles_worst;
    /* The smallest firmware around the scene, which steps and computes the outputs (boards/programs/size.c): */
    cost_figure flash_bytes;
    cost_figure ram_bytes;   /* without the stack */
    cost_figure stack_bytes; /* deepest, in steps */
    cost_figure state_bytes; /* of these RAM bytes, the scene's own: WH_MEMORY_BYTES */
} cost;

/* In fixed point the image has its step in fixed point. A scene with contacts has no prediction: its price depends on the
 * motion. */
cost cost_of(const image *im, const cost_board *board, cost_number number);

cost_figure cost_known(double value, cost_basis basis);
/* Cycles of a board on which they are not counted: a range. */
cost_figure cost_ranged(const cost_board *board, const cost_figure *instructions);

/* Reads a row of measure_one.sh. Values that the row lacks (state_bytes) stay. False: not a row, or another board's. */
#define COST_HEADER \
    "commit,compiler,flags,board,scene,number,setting,instructions,instructions_most,cycles,cycles_most," \
    "cycles_obtained,flash_bytes,ram_bytes,stack_bytes"
enum { COST_COLUMNS = 15 };
/* Cuts a row at its commas outside quotes; false unless it has this many columns. */
bool cost_cut(char *row, char **column, int columns);
bool cost_measured(const char *row, const cost_board *board, cost *c);

#endif
