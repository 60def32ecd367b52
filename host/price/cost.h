/* cost.h: what a step of a scene costs on a board, predicted from its image: neither source tree nor compiler is asked.
 *
 *     const cost_board *board = cost_board_named("mps2-an386");
 *     cost c = cost_of(image, board, COST_FLOAT);
 *
 * An image has its settings in it (method, compensated sums, angles): the price is that of these. A prediction is a sum
 * of counts, taken from the image, times figures of the board and number, fitted to counted steps (cost_rows.h, which
 * `make price-fit` writes). docs/price.md says how well it does.
 *
 * Where a source tree and a board's compiler are there, the same can be measured instead:
 *
 *     sh mk/price/measure_one.sh BOARD NUMBER FILE[:SCENE] [OPTIONS OF whirl derive...]
 *
 * from the tree's root (it uses and renews build/), prints COST_HEADER and one row on
 * standard output and ends with 0; with 2 where words are wrong or tools are missing, with 1 where the scene cannot be
 * derived, does not fit or does not run, each with a message on standard error. cost_measured() reads the row.
 *
 * What neither knows: wait states of flash, caches, interrupts, other compilers and flags than those of cost_rows.h. */
#ifndef PRICE_COST_H
#define PRICE_COST_H

#include "cost_figure.h"
#include "host/image/image.h"

typedef struct cost {
    bool
        predictable; /* false: no figures of this board and number; `why` says so, all is COST_NOT_KNOWN */
    const char *why; /* what is not known and why, a sentence for people; "" where all is known */
    cost_figure instructions;       /* a step, mean of a run */
    cost_figure instructions_worst; /* the longest step: with contacts far above the mean */
    cost_figure cycles;             /* of the mean step */
    cost_figure cycles_worst;
    /* The smallest firmware around the scene, which steps and computes the outputs (boards/programs/size.c): */
    cost_figure flash_bytes;
    cost_figure ram_bytes;   /* without the stack */
    cost_figure stack_bytes; /* deepest, in steps */
    cost_figure state_bytes; /* of these RAM bytes, the scene's own: WH_MEMORY_BYTES */
} cost;

/* Of a step in fixed point: cost_fixed.h. */
cost cost_of(const image *im, const cost_board *board, cost_number number);

/* Columns of a measured row, and the row of measure_one.sh read: what it does not have (state_bytes) stays as it is. False where it is none, or of another board. */
#define COST_HEADER \
    "commit,compiler,flags,board,scene,number,setting,instructions,instructions_most,cycles,cycles_most," \
    "cycles_obtained,flash_bytes,ram_bytes,stack_bytes"
bool cost_measured(const char *row, const cost_board *board, cost *c);

#endif
