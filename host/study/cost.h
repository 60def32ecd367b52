/* cost.h: the price of a step on a board: predicted from its image, or read from a counted row.
 *
 *     cost c = cost_of(image, cost_board_named("mps2-an386"), COST_FLOAT);
 *
 * A prediction is a sum over the classes of operations (below): their counts times the figures of the board and number
 * type (cost_rows.inc, written by `make price-table`). It needs neither a source tree nor a compiler. docs/price.md
 * gives its error.
 *
 * With the source tree and the board's compiler and emulator, this command counts the price instead:
 *
 *     sh mk/price/measure_one.sh BOARD NUMBER FILE[:SCENE] [OPTIONS OF whirl derive...]
 *
 * It prints COST_HEADER and one row, which cost_enter() reads. Exit status 2: wrong arguments, or a tool is missing;
 * 1: the scene cannot be derived, does not fit or does not run.
 *
 * Neither price includes wait states of flash, caches or interrupts. Other compilers and flags have other prices. */
#ifndef STUDY_COST_H
#define STUDY_COST_H

#include <stdbool.h>

#include "host/image/image.h"

/* === boards and number types ================================================================== */

/* X(id, word, description of the figure's source) */
#define COST_BASIS_ROWS(X) \
    X(COST_NOT_KNOWN, "not known", "unknown; only a measurement gives it") \
    X(COST_EXACT, "exact", "follows from the memory layout") \
    X(COST_PREDICTED, "predicted", "a sum over the operations of the scene") \
    X(COST_MEASURED, "measured", "counted in an emulator, or read from the linked program") \
    X(COST_ESTIMATED, "estimated", \
      "cycles from counted instructions and Arm's timing tables, no wait states") \
    X(COST_SIMULATED, "simulated", "cycles of a simulation of the chip by simavr") \
    X(COST_RANGE, "range", \
      "instructions times the smallest and largest number of cycles per instruction")
#define COST_BASIS_ID(id, word, says) id,
typedef enum cost_basis { COST_BASIS_ROWS(COST_BASIS_ID) } cost_basis;
#undef COST_BASIS_ID
#define COST_BASIS_ONE(id, word, says) +1
enum { COST_BASES = COST_BASIS_ROWS(COST_BASIS_ONE) };
#undef COST_BASIS_ONE
extern const char *const cost_basis_words[COST_BASES];

/* The number type of a scene. */
typedef enum cost_number { COST_FLOAT, COST_DOUBLE, COST_FIXED, COST_NUMBERS } cost_number;
extern const char *const cost_number_words[COST_NUMBERS]; /* "float", "double", "fixed" */

typedef struct cost_board {
    const char *name;    /* folder in boards/, or "host" (x86-64) */
    const char *core;    /* "Cortex-M4F" */
    bool fpu;            /* the core computes float in hardware */
    cost_basis cycles;   /* how the board's cycles are found, such as COST_SIMULATED */
    double cycles_least; /* per instruction, with COST_RANGE; else 0 */
    double cycles_most;
    double clock_Hz;  /* the chip's clock as the board sets it, or 0 */
    long flash_bytes; /* flash of the chip, or 0 if the board is no single chip */
    long ram_bytes;   /* RAM of the chip, or 0 */
} cost_board;

#define COST_BOARD_DEFAULT "mps2-an386"
/* All boards, in display order. */
extern const cost_board cost_boards[];
extern const int cost_board_count;
const cost_board *cost_board_named(const char *name); /* NULL: unknown */

/* === the operations of a step, by class ======================================================= */
/* Counts of a step's operations. The method's tableau (core/method.h) gives the operations of its stages. */

/* X(id, meaning): a class of operations. */
#define COST_CLASS_ROWS(X) \
    X(STEP, "the step itself") \
    X(STAGE, "a position or rate of a stage") \
    X(ANGLE, "an angle that is moved") \
    X(SHARE, "a share of one stage in another, or in the step's end") \
    X(SPILL, "a value of the state that registers do not hold, in a stage") \
    X(CALL, "a call of the list, in a stage") \
    X(SUM, "a sum or difference") \
    X(PRODUCT, "a product") \
    X(QUOTIENT, "a quotient") \
    X(ROOT, "a square root") \
    X(MOVE, "a size, a sign, a choice, or a value that is loaded or stored") \
    X(LOOKED_UP, "a sine and cosine, looked up") \
    X(TURNED, "a sine and cosine, rotated") \
    X(CELL, "the search for an angle's table cell") \
    X(LINE, "a value of a linear table") \
    X(CUBIC, "a value of a cubic table") \
    X(FUNCTION, "another function") \
    X(POWER, "a power") \
    X(CARRY, "a compensated value") \
    X(BOOK, "an entry of the energy's account") \
    X(MATRIX, "one component of the state, if the step is one matrix") \
    X(SHIFT, "a shift, in fixed point") \
    X(WORD, "a word of the state or of its start") \
    X(TABLE, "a number of a table") \
    X(LIBRARY, "a function's code, however often it is called")
#define COST_CLASS_ID(id, meaning) COST_CLASS_##id,
typedef enum cost_class { COST_CLASS_ROWS(COST_CLASS_ID) COST_CLASSES } cost_class;
#undef COST_CLASS_ID

typedef struct cost_counts {
    double run[COST_CLASSES];  /* number of executions in a step */
    double code[COST_CLASSES]; /* number of copies in the firmware */
} cost_counts;

/* For COST_FIXED the image must contain its step in fixed point (image.h, `fixed`). */
cost_counts cost_count(const image *im, const cost_board *board, cost_number number);

/* The quantity that a row of cost_rows.inc predicts. */
typedef enum cost_quantity {
    COST_OF_INSTRUCTIONS,
    COST_OF_CYCLES,
    COST_OF_FLASH,
    COST_OF_RAM,
    COST_OF_STACK,
    COST_QUANTITIES
} cost_quantity;

typedef struct cost_row {
    const char *board;
    cost_number number;
    cost_quantity quantity;
    double within;  /* prediction / within <= count <= prediction * within in nine of ten cases */
    double longest; /* cost of the most expensive step / mean cost of a step; 1 for bytes */
    double figure[COST_CLASSES]; /* of one operation, or COST_UNSEEN */
} cost_row;

#define COST_UNSEEN (-1.0) /* no counted step has an operation of this class */

/* Returns c->run if the quantity is instructions or cycles; returns c->code if it is bytes. */
const double *cost_counted(const cost_counts *c, cost_quantity quantity);

/* === the price of a step ====================================================================== */
/* Nine of ten predictions have the true value in least..most. COST_RANGE: `value` is 0. COST_NOT_KNOWN: all are 0. */
typedef struct cost_figure {
    cost_basis basis;
    double value;
    double least;
    double most;
} cost_figure;

typedef struct cost {
    const char *why;                /* reason for unknown figures, in words, or "" */
    cost_figure instructions;       /* mean over the steps of a run */
    cost_figure instructions_worst; /* of the longest step of a run */
    cost_figure cycles;             /* mean over the steps of a run */
    cost_figure cycles_worst;
    /* Figures of a minimal firmware that steps the scene and computes its outputs (boards/programs/size.c): */
    cost_figure flash_bytes;
    cost_figure ram_bytes;   /* without the stack */
    cost_figure stack_bytes; /* deepest stack during a step */
    cost_figure state_bytes; /* the scene's memory, WH_MEMORY_BYTES: a part of the RAM */
} cost;

/* For COST_FIXED the image must contain its step in fixed point. With contacts, the cost is unknown without a run. */
cost cost_of(const image *im, const cost_board *board, cost_number number);

/* Does a cost have cycles, and not only a range of them? */
bool cost_has_cycles(const cost *c);
/* Does the image's method support the scene? */
bool cost_takes_method(const image *im);
cost_figure cost_known(double value, cost_basis basis);

/* The header of measure_one.sh's rows. */
#define COST_HEADER \
    "commit,compiler,flags,board,scene,number,setting,instructions,instructions_most,cycles,cycles_most," \
    "cycles_obtained,flash_bytes,ram_bytes,stack_bytes"
enum { COST_COLUMNS = 15 };
/* Cuts a row at its commas outside quotes. Returns false if its number of columns is not `columns`. */
bool cost_cut(char *row, char **column, int columns);

/* The number of a row's columns, and five column indices. The last three columns are flash, RAM and stack, in bytes. */
typedef struct cost_layout {
    int columns, board, instructions, instructions_most, cycles, cycles_most;
} cost_layout;
extern const cost_layout cost_step_layout; /* of COST_HEADER */
/* Cuts a row into column[at->columns]. If a count of the row exceeds the figure in `c`, the count replaces the figure.
 * Returns false if the row has another layout or board, or does not count instructions. */
bool cost_enter(char *row, const cost_layout *at, char **column, const cost_board *board, cost *c);

#endif
