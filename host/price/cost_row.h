/* cost_row.h: a row of the table of figures (cost_rows.h). */
#ifndef PRICE_COST_ROW_H
#define PRICE_COST_ROW_H

#include "cost_count.h"

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
    double within;  /* the factor of error that nine of ten counted steps kept */
    double longest; /* the longest step over the mean; 1 of bytes */
    double figure
        [COST_CLASSES]; /* cost of one operation; COST_UNSEEN: no counted step has the class */
} cost_row;

#define COST_UNSEEN (-1.0)

/* Times that an operation of each class counts: of time as it is executed, of bytes as the firmware contains it. */
const double *cost_counted(const cost_counts *c, cost_quantity quantity);

#endif
