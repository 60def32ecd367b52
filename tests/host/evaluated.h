/* evaluated.h: independent evaluation of an operation list, with arbitrary values of its leaves. */
#ifndef TESTS_HOST_EVALUATED_H
#define TESTS_HOST_EVALUATED_H

#include "host/image/op_list.h"

enum { EVALUATED_MOST = 2000 };

/* The positive value of a leaf. With OP_PHASE: the value of angle `which`. */
double evaluated_leaf(op_code code, int which);

/* Computes v[t->count], with t->count <= EVALUATED_MOST. Fails the test if an operation comes before its operand. */
void evaluated(const op_list *t, double *v);

#endif
