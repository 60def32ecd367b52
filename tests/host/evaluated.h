/* evaluated.h: evaluates an operation list independently of the program, with made-up positive values of the leaves. */
#ifndef TESTS_HOST_EVALUATED_H
#define TESTS_HOST_EVALUATED_H

#include "host/image/op_list.h"

enum { EVALUATED_MOST = 2000 };

/* The positive value of leaf `which`. For OP_PHASE: the value of angle `which`. */
double evaluated_leaf(op_code code, int which);

/* Computes the value v[i] of each operation i. The list may have up to EVALUATED_MOST operations. Fails the test if
 * an operation uses a later one. */
void evaluated(const op_list *t, double *v);

#endif
