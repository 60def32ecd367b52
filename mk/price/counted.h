/* counted.h: the rows that measure.sh wrote, each with what is counted in its scene's image. For mk/price only. */
#ifndef PRICE_COUNTED_H
#define PRICE_COUNTED_H

#include "host/price/cost.h"
#include "host/price/cost_row.h"

enum { ROWS_MAX = 20000, COLUMNS = 15 };

typedef struct counted {
    char line[1024];
    char *column[COLUMNS];
    int board; /* of cost_boards */
    cost_number number;
    bool fitted; /* else it is for testing */
    bool contacts;
    bool derived;
    cost predicted;
    double feature[COST_FEATURES];
    double value[COST_QUANTITIES]; /* 0: not counted */
    wh_method method;
} counted;

extern counted *rows;
extern int row_count;
extern const char *const quantity_words[COST_QUANTITIES];

/* Appends the rows of a file; ends the program with 2 where it cannot be read. */
void read_rows(const char *path);

/* For qsort(): numbers by size. */
int by_size(const void *one, const void *other);

/* fit_check.c: holds what the program predicts against the rows; a line for each that is beyond its bound, and one for each
 * quantity. Returns an exit status. */
int check_all(void);

#endif
