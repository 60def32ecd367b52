/* latex.h: does a formula compile? Reads the subset of TeX's math mode that the program writes, and rejects
 * everything else. For tests of host/emit. */
#ifndef TESTS_HOST_LATEX_H
#define TESTS_HOST_LATEX_H

/* Returns NULL for a valid formula, otherwise a description of the error; *at: the place of the error. Valid
 * formulas have paired braces and \left \right, not more than one superscript and one subscript per base, and known
 * commands (amsmath) with their arguments. `&` and `\\` are valid outside all braces only. */
const char *latex_problem(const char *text, const char **at);

/* Width of the widest row in points, in Computer Modern at 10 pt. The computation is independent of
 * host/show/show_equations.c. */
int latex_width(const char *text);

/* Returns the text with the rows of each `aligned` environment joined, so that each equation is one line. The caller
 * frees the text. */
char *latex_joined(const char *text);

#endif
