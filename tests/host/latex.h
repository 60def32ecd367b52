/* latex.h: for the tests of host/emit: does a formula compile? A reader of the little of TeX's math mode
 * that the program writes; anything else is wrong. */
#ifndef TESTS_HOST_LATEX_H
#define TESTS_HOST_LATEX_H

/* NULL when the formula is good: braces and \left \right in pairs, one superscript and one subscript to a
 * base at most, commands that are known (with amsmath) and have their arguments. Else what is wrong, with
 * *at where. `&` and `\\` may stand outside all braces. */
const char *latex_problem(const char *text, const char **at);

/* The width in points of its widest row, in Computer Modern of 10 pt: an independent count of host/show/show_break.c. */
int latex_width(const char *text);

/* The text with the rows of each `aligned` in one line, so that each equation is a line; to be freed. */
char *latex_joined(const char *text);

#endif
