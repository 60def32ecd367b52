/* made_up_tree.h: a made-up source tree whose make and measure_one.sh are scripts that keep what they are told, and say what they
 * are given: for what counts prices (host/study/measured.h). */
#ifndef TESTS_HOST_MADE_UP_TREE_H
#define TESTS_HOST_MADE_UP_TREE_H

/* From the first on the working directory is that of the tree, up to the second. measure_one.sh says what is in row0, or
 * row1 and row2 of places 1 and 2, and keeps its words in `asked`; make says `says`, and keeps them in `made`; both end with
 * what is in `status`. */
void tree_enter(void);
void tree_leave(void);
/* A file of the tree. */
void tree_keep(const char *file, const char *text);
/* What is in it, which is then gone; static. */
const char *tree_taken(const char *file);

#endif
