/* cost_count.h: the operations of a step, counted by class. A prediction is the sum of these counts times the figures of
 * cost_rows.h. Sums over stages come from the method's tableau (core/method.h), so every method has counts. */
#ifndef STUDY_COST_COUNT_H
#define STUDY_COST_COUNT_H

#include "cost_board.h"
#include "host/image/image.h"

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
    X(MOVE, "a size, a sign, a choice, or a value that is loaded or kept") \
    X(LOOKED_UP, "a sine and cosine, looked up") \
    X(TURNED, "a sine and cosine, rotated on") \
    X(CELL, "an angle's cell of a table") \
    X(LINE, "a value of a linear table") \
    X(CUBIC, "a value of a cubic table") \
    X(FUNCTION, "another function") \
    X(POWER, "a power") \
    X(CARRY, "a compensated value") \
    X(BOOK, "an entry of the energy's account") \
    X(MATRIX, "a number of the state, in a step as one matrix") \
    X(SHIFT, "a shift, in fixed point") \
    X(WORD, "a word of the state or of its start") \
    X(TABLE, "a number of a table") \
    X(LIBRARY, "a function's code, however often it is called")
#define COST_CLASS_ID(id, meaning) COST_CLASS_##id,
typedef enum cost_class { COST_CLASS_ROWS(COST_CLASS_ID) COST_CLASSES } cost_class;
#undef COST_CLASS_ID

typedef struct cost_counts {
    double run[COST_CLASSES];  /* times that a step executes it */
    double code[COST_CLASSES]; /* times that the firmware contains it */
} cost_counts;

/* In fixed point the image has its step in fixed point. */
cost_counts cost_count(const image *im, const cost_board *board, cost_number number);

/* A row of the table of figures (cost_rows.h). */
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
    double within;  /* the factor of error of nine of ten counted steps */
    double longest; /* the longest step over the mean; 1 of bytes */
    double figure
        [COST_CLASSES]; /* cost of one operation; COST_UNSEEN: no counted step has the class */
} cost_row;

#define COST_UNSEEN (-1.0)

/* The weight of an operation of each class: executions for time, copies in the firmware for bytes. */
const double *cost_counted(const cost_counts *c, cost_quantity quantity);

#endif
