#include "drawn_list.h"

static void draw_op(dice *d, drawn_list *l, int i) {
    op *o = &l->ops[i];
    *o = (op){.code = i < 3 ? OP_CONSTANT : (op_code)dice_one_of(d, OPS), .a = -1, .b = -1};
    switch (op_rows[o->code].kind) {
    case OP_IS_CONSTANT: o->value = 1.0 + dice_one_of(d, 4); break;
    case OP_IS_LEAF: o->a = (int)dice_one_of(d, 3); break;
    case OP_IS_PHASE:
    case OP_IS_CELL:
        o->value = o->code == OP_PHASE ? dice_one_of(d, 2) : 0.0;
        o->b =
            o->code == OP_PHASE && dice_one_of(d, 3) == 0 ? (int)dice_one_of(d, (unsigned)i) : -1;
        for (int k = 0; k < DRAWN_LIST_ANGLES; k++) {
            l->turns[i][k] = (int)dice_one_of(d, 4) - 1;
        }
        o->turns = dice_one_of(d, 4) > 0 ? l->turns[i] : NULL;
        break;
    case OP_IS_LOOKUP:
    case OP_IS_WAVE:
    case OP_IS_UNARY: o->a = (int)dice_one_of(d, (unsigned)i); break;
    case OP_IS_BINARY:
        o->a = (int)dice_one_of(d, (unsigned)i);
        o->b = (int)dice_one_of(d, (unsigned)i);
        break;
    case OP_IS_CALL:
        o->a = (int)dice_one_of(d, (unsigned)i);
        o->function = (function_id)dice_one_of(d, FUNCTIONS);
        break;
    }
    if (op_rows[o->code].kind == OP_IS_LOOKUP) {
        o->value = 2.0 * dice_one_of(d, DRAWN_LIST_TABLES);
    }
}

void drawn_list_draw(dice *d, int most, drawn_list *l) {
    *l = (drawn_list){.list = {.count = 0}};
    l->list = (op_list){.ops = l->ops,
                        .count = 4 + (int)dice_one_of(d, (unsigned)most - 4),
                        .angles = DRAWN_LIST_ANGLES,
                        .result = l->result,
                        .results = 3};
    l->list.tables = (op_list_tables){
        .count = DRAWN_LIST_TABLES, .terms = 2, .folds = dice_one_of(d, 2) == 1, .odd = l->odd};
    for (int k = 0; k < DRAWN_LIST_TABLES; k++) {
        l->odd[k] = dice_one_of(d, 2) == 1;
    }
    for (int i = 0; i < l->list.count; i++) {
        draw_op(d, l, i);
    }
    for (int k = 0; k < 3; k++) {
        l->result[k] = l->list.count - 1 - k;
    }
}
