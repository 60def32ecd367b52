/* cost_fixed.c: see cost_fixed.h. */
#include "cost_fixed.h"

#include <stdlib.h>
#include <string.h>

#include "cost_row.h"
#include "host/base/room.h"
#include "host/fixed/fixed_plan.h"

#include "cost_fixed_rows.h"

/* As host/fixed/c_fixed_list.c has it: longer lists are functions of their own; on AVR (core/fixed.h) all are. */
enum { INLINED_MOST = 80 };
/* A value that is wanted so many operations after it was made waits in memory: processors without an FPU have a dozen
 * registers, of which products take most. */
enum { HELD_FOR = 8 };

#define COST_FIXED_WORD(id, taken, count) #id,
const char *const cost_fixed_words[COST_FIXED_FEATURES] = {COST_FIXED_ROWS(COST_FIXED_WORD)};
#define COST_FIXED_TAKEN(id, taken, count) taken,
const unsigned cost_fixed_taken[COST_FIXED_FEATURES] = {COST_FIXED_ROWS(COST_FIXED_TAKEN)};

/* --- what is counted ------------------------------------------------------------------------------------*/

static bool is_constant(const fixed_list *l, fixed_operand from) {
    return l->op[from.op].code == FIXED_CONSTANT;
}

/* A shift of a value, to the right where it is positive. */
static void add_shift(cost_fixed_counts *c, int shift) {
    c->rounded += shift > 0;
    c->scaled += shift < 0;
    c->bits += (shift < 0 ? -shift : shift) % 8;
}

static void add_taken(const fixed_list *l, fixed_operand from, cost_fixed_counts *c) {
    if (is_constant(l, from)) {
        c->constants++;
    } else {
        add_shift(c, from.shift);
    }
}

static bool is_short(const fixed_list *l, fixed_operand from) {
    return is_constant(l, from) && ((uint32_t)from.number << (unsigned)from.shift & 0xffffU) == 0;
}

static void add_product(const fixed_list *l, const fixed_op *o, cost_fixed_counts *c) {
    const bool known = is_constant(l, o->a) || is_constant(l, o->b);
    c->products++;
    c->by_constant += known;
    c->by_short += is_short(l, o->a) || is_short(l, o->b);
    c->bits += o->by % 8;
    add_shift(c, is_constant(l, o->a) ? 0 : -o->a.shift);
    add_shift(c, is_constant(l, o->b) ? 0 : -o->b.shift);
}

static void add_wave(const fixed_list *l, const fixed_op *o, cost_fixed_counts *c) {
    int terms = o->offset != 0;
    int angles = 0;
    for (int k = 0; k < l->angles && o->turns != NULL; k++) {
        angles += o->turns[k] != 0;
        terms += o->turns[k] != 0 && o->turns[k] != 1;
    }
    c->waves++;
    c->terms += terms + (angles > 1 ? angles - 1 : 0);
}

static void add_operation(const fixed_list *l, const fixed_op *o, cost_fixed_counts *c) {
    switch (o->code) {
    case FIXED_CONSTANT: return;
    case FIXED_LINEAR:
    case FIXED_RATE:
    case FIXED_INPUT: c->leaves++; break;
    case FIXED_PHASE: add_wave(l, o, c); break;
    case FIXED_SINE:
    case FIXED_COSINE: break;
    case FIXED_SUM:
    case FIXED_DIFFERENCE:
        c->sums++;
        add_taken(l, o->a, c);
        add_taken(l, o->b, c);
        break;
    case FIXED_PRODUCT: add_product(l, o, c); break;
    case FIXED_QUOTIENT:
        c->quotients++;
        c->searched += o->spread > 1;
        break;
    case FIXED_SAME:
        c->same++;
        add_taken(l, o->a, c);
        break;
    case FIXED_ABS:
    case FIXED_SIGN:
        c->choices++;
        add_taken(l, o->a, c);
        break;
    case FIXED_LEAST:
    case FIXED_MOST:
        c->choices++;
        add_taken(l, o->a, c);
        add_taken(l, o->b, c);
        break;
    }
    c->operations++;
}

/* Values wanted again when others have taken their registers. */
static int carried(const fixed_list *l) {
    int *last = room(l->count, sizeof *last);
    int count = 0;
    int at = 0;
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        const bool two = o->code == FIXED_SUM || o->code == FIXED_DIFFERENCE ||
                         o->code == FIXED_PRODUCT || o->code == FIXED_QUOTIENT ||
                         o->code == FIXED_LEAST || o->code == FIXED_MOST;
        const bool one =
            two || o->code == FIXED_SAME || o->code == FIXED_ABS || o->code == FIXED_SIGN;
        if (!o->used || o->code == FIXED_CONSTANT) {
            continue;
        }
        last[i] = ++at;
        for (int k = 0; k < (two ? 2 : one ? 1 : 0); k++) {
            const fixed_operand from = k == 0 ? o->a : o->b;
            if (!is_constant(l, from)) {
                count += at - last[from.op] > HELD_FOR;
                last[from.op] = at;
            }
        }
    }
    free(last);
    return count;
}

/* What moves how: where the list is called at each stage, all that it might read is made. */
static void add_motion(const image *im, cost_fixed_counts *c) {
    const fixed_plan *p = im->fixed;
    bool angle[IMAGE_COMPONENTS_MAX] = {false};
    bool linear[2 * IMAGE_COMPONENTS_MAX] = {false};
    bool rate[IMAGE_COMPONENTS_MAX] = {false};
    for (int i = 0; i < p->list->count; i++) {
        const fixed_op *o = &p->list->op[i];
        for (int k = 0; k < im->angles && o->used && o->code == FIXED_PHASE; k++) {
            angle[k] = angle[k] || (o->turns != NULL && o->turns[k] != 0);
        }
        if (o->used && o->code == FIXED_LINEAR) {
            linear[o->index] = true;
        }
        if (o->used && o->code == FIXED_RATE) {
            rate[o->index] = true;
        }
    }
    c->components = p->coordinates;
    for (int i = 0; i < p->coordinates; i++) {
        const bool still = p->list->op[p->list->result[i]].code == FIXED_CONSTANT;
        const bool is_angle = i < im->angles;
        c->first_angles += !p->second && is_angle;
        c->firsts += !p->second && !is_angle;
        c->angles += p->second && is_angle && !still;
        c->places += p->second && !is_angle && !still;
        c->still_angles += p->second && is_angle && still;
        c->still_places += p->second && !is_angle && still;
        c->staged_angles += is_angle && (c->called || angle[i]);
        c->staged_places += !is_angle && (c->called || linear[i - im->angles]);
        c->staged_rates += p->second && (c->called || rate[i]);
    }
}

static cost_fixed_counts counts_of(const image *im) {
    const fixed_plan *p = im->fixed;
    cost_fixed_counts c = {.numbers = im->reals + im->inputs,
                           .state_bytes =
                               ((int)WH_FIXED_BYTES(im->angles, im->reals + im->inputs) + 7) / 8 *
                               8, /* the header's words */
                           .results = p->list->results};
    for (int i = 0; i < p->list->count; i++) {
        if (p->list->op[i].used) {
            add_operation(p->list, &p->list->op[i], &c);
        }
    }
    c.carried = carried(p->list);
    c.called = c.operations > INLINED_MOST;
    c.one = c.waves == 1;
    add_motion(im, &c);
    return c;
}

void cost_fixed_features(const image *im, double feature[static COST_FIXED_FEATURES]) {
    const cost_fixed_counts counts = counts_of(im);
    const cost_fixed_counts *c = &counts;
#define COST_FIXED_VALUE(id, taken, count) feature[COST_X_##id] = (double)(count);
    COST_FIXED_ROWS(COST_FIXED_VALUE)
#undef COST_FIXED_VALUE
}

/* --- predicting -----------------------------------------------------------------------------------------*/

double cost_fixed_sum(const cost_fixed_fit *fit, cost_quantity q,
                      const double feature[static COST_FIXED_FEATURES]) {
    double sum = 0.0;
    for (int i = 0; i < COST_FIXED_FEATURES; i++) {
        if ((cost_fixed_taken[i] >> q & 1U) == 0 || feature[i] == 0.0) {
            continue;
        }
        if (fit->figure[i] < 0.0) {
            return -1.0;
        }
        sum += feature[i] * fit->figure[i];
    }
    return sum;
}

static const cost_fixed_row *row_of(const cost_board *board) {
    for (size_t i = 0; i < sizeof cost_fixed_rows / sizeof cost_fixed_rows[0]; i++) {
        if (strcmp(cost_fixed_rows[i].board, board->name) == 0) {
            return &cost_fixed_rows[i];
        }
    }
    return NULL;
}

/* Or nothing of it, and why in *why. */
static cost_figure predicted(const cost_fixed_row *row, cost_quantity q, cost_basis of,
                             const double *feature, const char **why) {
    const cost_fixed_fit *fit = &row->fit[q];
    const double value = fit->cases > 0 ? cost_fixed_sum(fit, q, feature) : -1.0;
    if (value <= 0.0) {
        *why = "the scene does something that no measured scene in fixed point did: measure it";
        return (cost_figure){0};
    }
    const double bound = cost_bound_of(value, fit->largest, fit->bound);
    return (cost_figure){.basis = COST_PREDICTED,
                         .of = of,
                         .value = value,
                         .least = value / bound,
                         .most = value * bound,
                         .bound = bound};
}

cost cost_fixed_of(const image *im, const cost_board *board) {
    const cost_fixed_row *row = row_of(board);
    cost c = {.why = ""};
    if (im->fixed == NULL) {
        c.why = "it has no step in fixed point";
        return c;
    }
    const double bytes = (double)WH_FIXED_BYTES(im->angles, im->reals + im->inputs);
    c.state_bytes = cost_known(bytes, COST_EXACT);
    if (row == NULL) {
        c.why = "no scene has been measured on this board in fixed point: it must be measured";
        return c;
    }
    double feature[COST_FIXED_FEATURES];
    cost_fixed_features(im, feature);
    c.predictable = true;
    c.instructions = predicted(row, COST_OF_INSTRUCTIONS, COST_MEASURED, feature, &c.why);
    c.instructions_worst = cost_longest(c.instructions, row->spread);
    if (board->cycles == COST_RANGE) {
        c.cycles = cost_ranged(board, &c.instructions);
        c.cycles_worst = cost_ranged(board, &c.instructions_worst);
    } else {
        c.cycles = predicted(row, COST_OF_CYCLES, board->cycles, feature, &c.why);
        c.cycles_worst = cost_longest(c.cycles, row->spread_cycles);
    }
    c.flash_bytes = predicted(row, COST_OF_FLASH, COST_MEASURED, feature, &c.why);
    c.ram_bytes = predicted(row, COST_OF_RAM, COST_MEASURED, feature, &c.why);
    c.stack_bytes = predicted(row, COST_OF_STACK, COST_MEASURED, feature, &c.why);
    return c;
}
