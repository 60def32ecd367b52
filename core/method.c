/* method.c: the table of each method's names, order, systems and number of stages. */
#include "method.h"

#define ROW(id, word, title, order, takes, stages, ...) \
    [id] = {word, #id, title, order, takes, stages},
const wh_method_row wh_methods[WH_METHODS] = {WH_METHOD_ROWS(ROW)};
