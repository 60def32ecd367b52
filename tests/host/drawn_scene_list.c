/* drawn_scene_list.c: the operations of a drawn scene (drawn_scene.h). */
#include "core/step/table.h"
#include "drawn_scene.h"

static bool is_value(const op *o) {
    const op_kind kind = op_rows[o->code].kind;
    return kind != OP_IS_PHASE && kind != OP_IS_CELL;
}

/* The index of a random operation before operation i that has the kind `kind` (OP_IS_CONSTANT: any operation with a
 * value). Returns -1 if 40 tries find no such operation. */
static int before(dice *die, const scene_list *l, int i, op_kind kind) {
    for (int tries = 0; tries < 40; tries++) {
        const int a = (int)dice_one_of(die, (unsigned)i);
        if (op_rows[l->ops[a].code].kind == kind ||
            (kind == OP_IS_CONSTANT && is_value(&l->ops[a]))) {
            return a;
        }
    }
    return kind == OP_IS_CONSTANT ? 0 : -1;
}

static bool draw_leaf(dice *die, const image *im, unsigned takes, op *o) {
    const int linears = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const bool of_state = o->code == OP_TIME || o->code == OP_NOISE;
    const int of = o->code == OP_LINEAR                                    ? linears
                   : o->code == OP_RATE && (takes & TAKES_RATES) != 0      ? im->coordinates
                   : o->code == OP_INPUT                                   ? im->inputs
                   : o->code == OP_ACCEL && (takes & TAKES_ACCEL) != 0     ? im->coordinates
                   : o->code == OP_RADIANS && (takes & TAKES_RECORDS) != 0 ? im->angles
                                                                           : 0;
    if (o->code == OP_NOISE) {
        o->value = dice_one_of(die, 2) == 0 ? 4294967295.0 : dice_one_of(die, 1000);
    }
    o->a = of > 0 ? (int)dice_one_of(die, (unsigned)of) : 0;
    return of > 0 || (of_state && (takes & TAKES_STATE) != 0);
}

static bool draw_turns(dice *die, scene_list *l, int i) {
    bool any = false;
    for (int k = 0; k < l->list.angles; k++) {
        l->turns[i][k] = dice_one_of(die, 2) == 0 ? 0 : (int)dice_one_of(die, 6) - 2;
        any = any || l->turns[i][k] != 0;
    }
    l->ops[i].turns = any ? l->turns[i] : NULL;
    return any;
}

static bool draw_phase(dice *die, scene_list *l, int i, unsigned takes) {
    op *o = &l->ops[i];
    const bool turned = draw_turns(die, l, i);
    o->value = dice_one_of(die, 2) == 0 ? 0.0 : dice_between(die, -7.0, 7.0);
    if ((!turned || dice_one_of(die, 5) == 0) && dice_one_of(die, 3) > 0) {
        o->b = before(die, l, i, OP_IS_CONSTANT);
    }
    if ((takes & TAKES_RECORDS) != 0 && l->list.angles > 0 && dice_one_of(die, 3) == 0) {
        for (int k = 0; k < l->list.angles; k++) {
            l->parts[i][k] = k > 0 && dice_one_of(die, 2) == 0 ? 0.0 : dice_between(die, -3.0, 3.0);
        }
        o->parts = l->parts[i];
    }
    return true;
}

static bool draw_look_up(dice *die, scene_list *l, int i) {
    op *o = &l->ops[i];
    o->a = before(die, l, i, OP_IS_CELL);
    if (l->list.tables.count == 0 || o->a < 0) {
        return false;
    }
    const int terms = l->list.tables.terms;
    o->value = terms * (double)dice_one_of(die, (unsigned)l->list.tables.count);
    return terms == (o->code == OP_LINE ? (int)WH_TABLE_LINEAR : (int)WH_TABLE_CUBIC);
}

static bool is_sum(op_code code) {
    return code == OP_CONSTANT || code == OP_LINEAR || code == OP_RATE || code == OP_INPUT ||
           code == OP_ADD || code == OP_SUB || code == OP_MUL || code == OP_NEG;
}

static bool draw_op(dice *die, const image *im, scene_list *l, int i, unsigned takes) {
    op *o = &l->ops[i];
    *o = (op){.code = (op_code)dice_one_of(die, OPS), .a = -1, .b = -1};
    if ((takes & TAKES_SUMS) != 0 && !is_sum(o->code)) {
        return false;
    }
    switch (op_rows[o->code].kind) {
    case OP_IS_CONSTANT: o->value = dice_between(die, -2.0, 2.0); return true;
    case OP_IS_LEAF: return draw_leaf(die, im, takes, o);
    case OP_IS_PHASE: return draw_phase(die, l, i, takes);
    case OP_IS_CELL: return l->list.tables.count > 0 && draw_turns(die, l, i);
    case OP_IS_LOOKUP: return draw_look_up(die, l, i);
    case OP_IS_WAVE: o->a = before(die, l, i, OP_IS_PHASE); return o->a >= 0;
    case OP_IS_UNARY: o->a = before(die, l, i, OP_IS_CONSTANT); return true;
    case OP_IS_BINARY:
        o->a = before(die, l, i, OP_IS_CONSTANT);
        o->b = before(die, l, i, OP_IS_CONSTANT);
        return true;
    case OP_IS_CALL:
        o->function = (function_id)dice_one_of(die, FUNCTIONS);
        o->a = before(die, l, i, OP_IS_CONSTANT);
        o->b = function_arguments(o->function) == 2 ? before(die, l, i, OP_IS_CONSTANT) : -1;
        return true;
    }
    return false;
}

static void draw_tables(dice *die, drawn_scene *d, op_list_tables *t) {
    const bool cubic = d->im.settings.tables == TABLES_CUBIC;
    *t = (op_list_tables){.count = 1 + (int)dice_one_of(die, SCENE_FEW),
                          .bits = 3 + (int)dice_one_of(die, SCENE_BITS - 2),
                          .terms = cubic ? (int)WH_TABLE_CUBIC : (int)WH_TABLE_LINEAR,
                          .number = d->number,
                          .size = d->size,
                          .off = d->off,
                          .folds = dice_one_of(die, 2) == 0,
                          .odd = d->odd};
    for (int i = 0; i < t->count * t->terms << t->bits; i++) {
        d->number[i] = dice_between(die, -9.0, 9.0);
    }
    for (int k = 0; k < t->count; k++) {
        d->size[k] = dice_between(die, 0.1, 50.0);
        d->off[k] = dice_between(die, 1e-9, 1e-3);
        d->odd[k] = dice_one_of(die, 2) == 0;
    }
}

void drawn_scene_list(drawn_scene *d, dice *die, image_role role, int results, unsigned takes) {
    static const int lengths[] = {99, 100, 101, 149, 150, 151, 152};
    scene_list *l = &d->list[role];
    l->list = (op_list){.ops = l->ops, .angles = d->im.angles, .result = l->result};
    if ((takes & TAKES_TABLES) != 0) {
        draw_tables(die, d, &l->list.tables);
    }
    const int wanted =
        dice_one_of(die, 6) == 0 ? lengths[dice_one_of(die, 7)] : (int)dice_one_of(die, 40);
    l->ops[0] = (op){.code = OP_CONSTANT, .a = -1, .b = -1, .value = dice_between(die, -2.0, 2.0)};
    l->list.count = 1;
    if ((takes & TAKES_TABLES) != 0) { /* at least one table is looked up */
        l->ops[1] = (op){.code = OP_CELL, .a = -1, .b = -1};
        while (!draw_turns(die, l, 1)) {
        }
        l->list.count = 2;
    }
    for (int tries = 0; tries < 20 * SCENE_OPS && l->list.count < SCENE_OPS - 1; tries++) {
        if (op_list_operations(&l->list) >= wanted) {
            break;
        }
        const bool drawn = draw_op(die, &d->im, l, l->list.count, takes);
        l->list.count += drawn;
        if (drawn && op_rows[l->ops[l->list.count - 1].code].kind == OP_IS_PHASE) {
            l->ops[l->list.count] = (op){.code = dice_one_of(die, 2) == 0 ? OP_SIN : OP_COS,
                                         .a = l->list.count - 1,
                                         /* the next operation always uses the phase */
                                         .b = -1};
            l->list.count++;
        }
    }
    l->list.results = results;
    for (int i = 0; i < results; i++) {
        l->result[i] = before(die, l, l->list.count, OP_IS_CONSTANT);
    }
    d->im.list[role] = &l->list;
}
