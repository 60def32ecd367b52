/* evaluated.h: what a list's operations come to, by another evaluation than the program's, where leaves have made-up values. */
#ifndef TESTS_HOST_EVALUATED_H
#define TESTS_HOST_EVALUATED_H

#include "host/image/op_list.h"

enum { EVALUATED_MOST = 2000 };

/* That of a leaf; of an angle, for OP_PHASE. Above zero. */
double evaluated_leaf(op_code code, int which);

/* v[t->count], which is at most EVALUATED_MOST. Fails the test where an operation stands before what it takes. */
void evaluated(const op_list *t, double *v);

#endif
