/* drawn_list.h: a random list of operations of all kinds, for tests that count them. It is never run. */
#ifndef TESTS_HOST_DRAWN_LIST_H
#define TESTS_HOST_DRAWN_LIST_H

#include "command.h"
#include "host/image/op_list.h"

enum { DRAWN_LIST_MOST = 200, DRAWN_LIST_ANGLES = 3, DRAWN_LIST_TABLES = 4 };

typedef struct drawn_list {
    op ops[DRAWN_LIST_MOST];
    int turns[DRAWN_LIST_MOST][DRAWN_LIST_ANGLES];
    int result[3];
    bool odd[DRAWN_LIST_TABLES];
    op_list list; /* of the arrays above */
} drawn_list;

/* A list of 4 to `most` - 1 operations. */
void drawn_list_draw(dice *d, int most, drawn_list *l);

#endif
