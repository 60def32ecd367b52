/* show_equations.h: the equations of motion for readers, printed from the equations themselves: what runs is printed
 * from the image by host/emit, and tests hold both against each other at random states. */
#ifndef SHOW_SHOW_EQUATIONS_H
#define SHOW_SHOW_EQUATIONS_H

#include <stdio.h>

#include "host/derive/equations.h"

/* The equations of motion, one a coordinate, terms collected by second derivative and factored; then
 * the first-order form. */
void show_text(FILE *out, const equations *e);
void show_latex(FILE *out, const equations *e);

#endif
