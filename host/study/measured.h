/* measured.h: counted prices, in Whirl's source tree, with the board's compiler and emulator. They use the same command
 * line that is shown to users (table_measure_line()). */
#ifndef STUDY_MEASURED_H
#define STUDY_MEASURED_H

#include "host/study/table_text.h"

typedef enum measured_end {
    MEASURED_COUNTED,
    MEASURED_MISSING /* a tool is */
} measured_end;

/* The reason why counting is impossible on a board. NULL: it is possible, and the files that are compiled once exist.
 * `text` has room for the answer. */
enum { MEASURED_TEXT = 160 };
const char *measured_missing(const trials *t, const cost_board *board, char text[MEASURED_TEXT]);
/* Counts the steps of a row (seconds), for all rows of its setting; with contacts its whole run. The table is sorted again.
 * Rows that cannot be built, linked or run lose their price and leave the table. */
measured_end measured_count(const trials *t, table *made, int row, const table_words *words);
/* Counts the rows of the front until all of them are counted. */
measured_end measured_front(const trials *t, table *made, const table_words *words,
                            const table_wish *w);

#endif
