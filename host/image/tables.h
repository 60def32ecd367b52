/* tables.h: look-up tables for functions of one angle. They replace the sines and divisions of a step's list. */
#ifndef IMAGE_TABLES_H
#define IMAGE_TABLES_H

#include "host/image/image.h"
#include "host/image/op_list.h"

/* Why a list cannot have tables. The message has the words "the accelerations " before `reason`. */
typedef struct refusal {
    const char *reason;
    const char *hint;
    int angle; /* the turn angle that the message names, or -1 */
} refusal;

/* Default number of cells of a table for one turn. */
enum { TABLES_CELLS_LINEAR = 256, TABLES_CELLS_CUBIC = 64 };

/* Returns `list` with table look-ups. Each acceleration (or derivative) becomes a sum of products c(phase) * m. Every m
 * is a product of rates, inputs and reals. Every c is a constant, or a table's value times a factor. All tables have
 * the same phase, a sum of turn angles times whole numbers. *exact receives the list that computes the tables'
 * functions. If `list` cannot be written as such sums, returns NULL and sets *why to the reason. */
op_list *tables_make(const op_list *list, image_tables form, int cells, op_list **exact,
                     refusal *why);

int tables_cells(image_tables form);

#endif
