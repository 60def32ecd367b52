/* made_up_tree.h: a fake source tree for tests of host/study/price_table.h. Its `make` and measure_one.sh record
 * their arguments and print prepared texts. */
#ifndef TESTS_HOST_MADE_UP_TREE_H
#define TESTS_HOST_MADE_UP_TREE_H

/* tree_enter() changes the working directory to the tree; tree_leave() changes back.
 * measure_one.sh prints the file row1 for place 1, row2 for place 2, else row0, and appends its arguments to `asked`.
 * make prints the file `says` and appends its arguments to `made`.
 * Both exit with the status in the file `status`. */
void tree_enter(void);
void tree_leave(void);
void tree_keep(const char *file, const char *text);
/* Returns the contents of `file` ("" if there is none) in static memory, and deletes the file. */
const char *tree_taken(const char *file);

#endif
