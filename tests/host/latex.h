/* latex.h: does a formula compile? Reads the subset of TeX's math mode that the program writes and rejects all else.
 * For tests of host/emit. */
#ifndef TESTS_HOST_LATEX_H
#define TESTS_HOST_LATEX_H

/* Returns NULL for a valid formula, otherwise the error, with *at at its place. A formula has paired braces and \left
 * \right, at most one superscript and subscript per base, and known commands (amsmath) with their arguments. `&` and
 * `\\` may be outside all braces. */
const char *latex_problem(const char *text, const char **at);

/* Width in points of the widest row, in Computer Modern of 10 pt; independent of host/show/show_equations.c. */
int latex_width(const char *text);

/* The text with each `aligned` joined, so that each equation is a line; to be freed. */
char *latex_joined(const char *text);

#endif
