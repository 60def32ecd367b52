/* made_up_tree.h: a fake source tree whose make and measure_one.sh record their arguments and print given texts, for
 * tests of host/study/price_table.h. */
#ifndef TESTS_HOST_MADE_UP_TREE_H
#define TESTS_HOST_MADE_UP_TREE_H

/* tree_enter() changes into the tree, tree_leave() back. measure_one.sh prints row0, or row1 and row2 for places 1 and
 * 2, and records its arguments in `asked`. make prints `says` and records its own in `made`. Both exit with the number
 * in `status`. */
void tree_enter(void);
void tree_leave(void);
void tree_keep(const char *file, const char *text);
/* Returns the contents of `file` in static memory, "" if there is no such file, and deletes it. */
const char *tree_taken(const char *file);

#endif
