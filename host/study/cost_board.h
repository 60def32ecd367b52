/* cost_board.h: the boards with prices, their number types, and the sources of a figure. */
#ifndef STUDY_COST_BOARD_H
#define STUDY_COST_BOARD_H

#include <stdbool.h>

/* X(id, word, description of the figure's source) */
#define COST_BASIS_ROWS(X) \
    X(COST_NOT_KNOWN, "not known", "nobody can tell: it must be measured") \
    X(COST_EXACT, "exact", "follows from the layout") \
    X(COST_PREDICTED, "predicted", "from the image, as a sum over its operations") \
    X(COST_MEASURED, "measured", "counted in an emulator, or read off a linked image") \
    X(COST_ESTIMATED, "estimated", \
      "cycles of counted instructions by Arm's timing, no wait states") \
    X(COST_SIMULATED, "simulated", "cycles as simavr plays the chip") \
    X(COST_RANGE, "range", "instructions times the least and most cycles of one")
#define COST_BASIS_ID(id, word, says) id,
typedef enum cost_basis { COST_BASIS_ROWS(COST_BASIS_ID) } cost_basis;
#undef COST_BASIS_ID
#define COST_BASIS_ONE(id, word, says) +1
enum { COST_BASES = COST_BASIS_ROWS(COST_BASIS_ONE) };
#undef COST_BASIS_ONE
extern const char *const cost_basis_words[COST_BASES];

/* The number that a scene computes in. */
typedef enum cost_number { COST_FLOAT, COST_DOUBLE, COST_FIXED, COST_NUMBERS } cost_number;
extern const char *const cost_number_words[COST_NUMBERS]; /* "float", "double", "fixed" */

typedef struct cost_board {
    const char *name;  /* its folder of boards/, or "host" for this kind of machine (x86-64) */
    const char *core;  /* "Cortex-M4F" */
    const char *chips; /* known chips with that core, for people; "" */
    bool fpu;          /* float in hardware */
    /* How its cycles are known: COST_ESTIMATED, COST_SIMULATED, or COST_RANGE: cycles an instruction, least and most. */
    cost_basis cycles;
    double cycles_least; /* COST_RANGE only, else 0 */
    double cycles_most;
    double clock_Hz;  /* of a chip with a clock set by the board, or 0 */
    long flash_bytes; /* of the chip, or 0 if the board is no single chip */
    long ram_bytes;   /* the same */
} cost_board;

#define COST_BOARD_DEFAULT "mps2-an386"
/* All boards, in display order. */
extern const cost_board cost_boards[];
extern const int cost_board_count;
const cost_board *cost_board_named(const char *name); /* NULL: unknown */

#endif
