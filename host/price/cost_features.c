/* cost_features.c: see cost_features.h. */
#include "cost_features.h"

#include <stdlib.h>

#include "host/base/room.h"
#include "host/image/core_rows.h"
#include "host/image/turned.h"
#include "operands.h"

/* As host/emit/c_list.c has it: longer lists are functions of their own. */
enum { INLINED_MOST = 150, LONG_LEAST = 100 };
/* With books compilers decide: gcc 12 makes functions of lists of more operations than this, and of the ledger's where both
 * have more. A sine of radians stands in the list, too, and is as long as so many. */
enum { BOOKING_MOST = 50, BOTH_MOST = 85, RADIANS_LENGTH = 25 };

#define COST_WORD(id, taken, count) #id,
const char *const cost_feature_words[COST_FEATURES] = {COST_FEATURE_ROWS(COST_WORD)};
#define COST_TAKEN(id, taken, count) taken,
const unsigned cost_feature_taken[COST_FEATURES] = {COST_FEATURE_ROWS(COST_TAKEN)};

int cost_calls(const cost_list *l) {
    int calls = l->powers;
    for (int i = 0; i < FUNCTIONS; i++) {
        calls += l->calls[i];
    }
    return calls;
}

/* Does stage s stand where an earlier one does? */
static bool stands_again(const wh_tableau *by, unsigned s) {
    const wh_places *at = by->places;
    for (unsigned e = 0; e < s; e++) {
        bool same = at->node[e] == at->node[s] && at->reach[e].parts == at->reach[s].parts;
        for (unsigned j = 0; j < by->stages; j++) {
            same = same && at->reach[e].share[j] == at->reach[s].share[j];
        }
        if (same) {
            return true;
        }
    }
    return false;
}

/* Where the stages of a row stand that says so. */
static void add_reach(const wh_tableau *by, cost_counts *c) {
    c->places = 0;
    for (unsigned s = 0; s < by->stages; s++) {
        if (stands_again(by, s)) {
            continue;
        }
        c->places++;
        c->reaches += by->places->node[s] != 0;
        for (unsigned j = 0; j < s; j++) {
            c->reach_shares += by->places->reach[s].share[j] != 0;
        }
    }
}

/* What the method's row makes of a step. */
static void add_method(const image *im, cost_counts *c) {
    const wh_tableau *by = wh_tableau_of(im->settings.method);
    bool moves = false;
    bool rests = false;
    c->stages = c->places = (int)by->stages;
    if (c->second && by->places != NULL) {
        add_reach(by, c);
    }
    for (unsigned s = 0; s < by->stages; s++) {
        bool leans = false;
        for (unsigned j = 0; j < s; j++) {
            const wh_real share = by->stage[s].share[j];
            c->shares += share != 0;
            c->scaled += share != 0 && share != 1 && share != -1;
            leans = leans || (j > 0 && share != 0);
        }
        c->leans += leans;
        c->ends += by->rates[s] != 0;
        c->ends += by->positions[s] != 0 && by->positions[s] != by->rates[s];
        moves = moves || by->positions[s] != 0;
        rests = rests || by->positions[s] != by->rates[s];
        c->turns = by->turns[s] > c->turns ? by->turns[s] : c->turns;
    }
    c->ends_twice = c->second && c->turned && moves && !rests;
}

/* --- what of a list a stage must do anew ----------------------------------------------------------*/

/* Does operation i change from stage to stage? Told in varies[], of the earlier ones. */
static bool changes(const tape *t, int i, const bool *varies) {
    int operand[2];
    bool does = false;
    switch (op_rows[t->ops[i].code].kind) {
    case OP_IS_CONSTANT: return false;
    case OP_IS_LEAF: return t->ops[i].code != OP_INPUT;
    case OP_IS_PHASE:
    case OP_IS_CELL: return true;
    case OP_IS_LOOKUP:
    case OP_IS_WAVE:
    case OP_IS_UNARY:
    case OP_IS_BINARY:
    case OP_IS_CALL: break;
    }
    for (int k = tape_operands(&t->ops[i], operand); k > 0; k--) {
        does = does || varies[operand[k - 1]];
    }
    return does;
}

/* Components of the state that the list reads: of its coordinate or real i, a position, a rate, an angle. */
typedef struct cost_reads {
    bool position[IMAGE_COMPONENTS_MAX];
    bool rate[IMAGE_COMPONENTS_MAX];
    bool angle[IMAGE_COMPONENTS_MAX];
} cost_reads;

static void add_reads(const tape *t, const op *o, cost_reads *r) {
    if (o->code == OP_LINEAR && o->a < IMAGE_COMPONENTS_MAX) {
        r->position[o->a] = true;
    }
    if (o->code == OP_RATE && o->a < IMAGE_COMPONENTS_MAX) {
        r->rate[o->a] = true;
    }
    const bool looks = o->code == OP_PHASE || o->code == OP_CELL;
    for (int k = 0; looks && k < t->angles && o->turns != NULL; k++) {
        r->angle[k] = r->angle[k] || o->turns[k] != 0;
    }
}

/* Where the compiler sees the list at each stage, it leaves out what nobody reads and does once what stays the same; in a
 * function of its own all is done each time. */
static void count_staged(const cost_reads *r, cost_counts *c) {
    for (int i = 0; i < c->components; i++) {
        const bool is_angle = i < c->angles;
        const bool placed = is_angle ? r->angle[i] : r->position[i - c->angles];
        c->staged_angles += is_angle && (c->called || placed);
        c->staged_linears += !is_angle && (c->called || placed);
        c->staged_rates += c->second && (c->called || r->rate[i] || (placed && c->reaches == 0));
    }
}

/* Of turn angles: counted by themselves. What is in radians is none. */
static bool is_pair(const op *o) { return o->code == OP_PHASE && o->b < 0; }

/* Does operation i take rates, or call what a compiler does not look into? Told in takes[], of the earlier ones. */
static bool takes_more_than_places(const tape *t, int i, const bool *takes) {
    const op *o = &t->ops[i];
    int operand[2];
    bool does = o->code == OP_RATE || o->code == OP_CALL || o->code == OP_POW || is_pair(o);
    for (int k = tape_operands(o, operand); k > 0; k--) {
        does = does || (takes[operand[k - 1]] && !is_pair(&t->ops[operand[k - 1]]));
    }
    return does;
}

static void add_step(const image *im, const operands *given, cost_counts *c) {
    const tape *t = im->list[IMAGE_STEP];
    bool *varies = room(t->count, sizeof *varies);
    bool *takes = room(t->count, sizeof *takes);
    cost_reads reads = {{false}, {false}, {false}};
    for (int i = 0; i < t->count; i++) {
        varies[i] = changes(t, i, varies);
        takes[i] = takes_more_than_places(t, i, takes);
        const bool stays = c->places < c->stages && !takes[i] && !im->ledger.asked;
        cost_list *to = c->called    ? &c->step
                        : !varies[i] ? &c->fixed
                        : stays      ? &c->placed
                                     : &c->step;
        cost_list_add(t, &t->ops[i], to);
        if (given->of != NULL) {
            cost_list_add_operands(&t->ops[i], &given->of[i], to);
        }
        if (given->of != NULL && is_pair(&t->ops[i])) {
            cost_list_add_pair(t, &t->ops[i], given, &c->step);
        }
        add_reads(t, &t->ops[i], &reads);
    }
    free(takes);
    c->step.results = t->results;
    c->step.carried = tape_carried(t);
    c->step.operations = tape_operations(t);
    for (int i = 0; i < t->results; i++) {
        c->moving += c->called || t->ops[t->result[i]].code != OP_CONSTANT;
    }
    free(varies);
    count_staged(&reads, c);
}

static int state_words(const image *im) {
    return im->angles + 2 * im->reals + im->angles + im->inputs + core_ledger_words(im);
}

/* A step as one matrix: its list, and no stages. What matrices have in common with other steps is little, so their figures
 * are their own. */
static void add_matrix(const image *im, const operands *given, cost_counts *c) {
    const tape *t = im->list[IMAGE_MATRIX];
    c->is_matrix = true;
    cost_list_add_all(t, &c->matrix);
    for (int i = 0; i < t->count && given->of != NULL; i++) {
        cost_list_add_operands(&t->ops[i], &given->of[i], &c->matrix);
    }
    if (c->soft) { /* what it does costs as much as elsewhere */
        c->moves = step_work_of_matrix(im, given);
        c->moves.sums += c->matrix.sums - c->matrix.zero_sums;
        c->moves.products += c->matrix.products - c->matrix.zero_products;
        c->moves.zero_sums += c->matrix.zero_sums;
        c->moves.zero_products += c->matrix.zero_products;
    }
    c->stages = c->places = c->copies = 1;
}

static void add_tables(const image *im, const cost_board *board, cost_counts *c) {
    const tape_tables *of = &im->list[IMAGE_STEP]->tables;
    const double cells = of->count > 0 ? (double)(1U << (unsigned)of->bits) : 0.0;
    c->folded = of->folds && !board->fpu && c->number == COST_FLOAT;
    c->table_numbers = (c->folded ? cells / 2.0 + 1.0 : cells) * of->count * of->terms;
}

/* What is wanted again after a list's evaluation: the state, what stages gave so far and its sums, pairs that are turned
 * on. What registers do not hold is carried to memory and back. */
static void add_pressure(int registers, cost_counts *c) {
    const int each = c->stages == 1 ? 2 : c->second ? 4 : 3;
    const int kept = each * c->components + (c->turned && c->stages > 1 ? 3 * c->step.pairs : 0);
    if (registers > 0) {
        c->pressed = kept > registers / 2 ? kept - registers / 2 : 0;
        c->spilled = kept > registers ? kept - registers : 0;
    }
}

static int length_of(const tape *t) {
    int length = tape_operations(t);
    for (int i = 0; i < t->count; i++) {
        length += t->ops[i].code == OP_PHASE && t->ops[i].b >= 0 ? RADIANS_LENGTH : 0;
    }
    return length;
}

/* Where both lists stand in the step, compilers compute once what both want. */
static void add_books(const image *im, cost_counts *c) {
    const tape *step = im->list[IMAGE_STEP];
    const tape *books = im->list[IMAGE_POWERS];
    const int length = length_of(step);
    c->books_called = c->called || length + length_of(books) > BOTH_MOST;
    c->called = c->called || length > BOOKING_MOST;
    if (c->called || c->books_called) {
        cost_list_add_all(books, &c->books);
    } else {
        cost_list_add_unshared(books, step, c->turned, &c->books);
    }
}

static cost_counts count(const image *im, const cost_board *board, cost_number number,
                         const operands *given) {
    cost_counts c = {.im = im,
                     .soft = given->of != NULL,
                     .number = number,
                     .second = im->form == WH_SECOND_ORDER,
                     .turned = image_turns(im),
                     .reals = im->reals,
                     .state_words = state_words(im)};
    cost_list_add_all(im->list[IMAGE_OBSERVE], &c.observe);
    if (im->settings.matrix != MATRIX_NONE) {
        add_matrix(im, given, &c);
        return c;
    }
    c.compensated = im->settings.compensated;
    c.angles = im->angles;
    add_method(im, &c);
    add_tables(im, board, &c);
    if (im->contacts > 0) {
        cost_list_add_all(im->list[IMAGE_SIGNALS], &c.events);
        cost_list_add_all(im->list[IMAGE_FORCES], &c.events);
    }
    c.components = c.second ? im->coordinates : im->angles + im->reals;
    c.linears = c.second ? im->coordinates - im->angles : im->reals;
    c.called =
        tape_operations(im->list[IMAGE_STEP]) > INLINED_MOST || im->contacts > 0 || !board->fpu;
    if (im->ledger.kept) {
        add_books(im, &c);
    }
    const bool is_avr = board->cycles == COST_SIMULATED;
    add_step(im, given, &c);
    const bool unrolls_less = im->settings.compensated || c.step.operations >= LONG_LEAST;
    c.looped = is_avr && (unrolls_less || im->ledger.kept || im->contacts > 0);
    c.tabled = is_avr && unrolls_less && c.stages > 2;
    if (c.soft) {
        c.moves = step_work_of(im, c.turned, is_avr, c.tabled, given);
        const double at_zero = c.turned ? 0.0 : c.stages * c.step.zero_pairs;
        c.moves.zero_products += COST_ZERO_PRODUCTS * at_zero;
        c.moves.zero_sums += COST_ZERO_SUMS * at_zero;
        c.moves.zero_conversions += at_zero;
    }
    c.copies = c.called ? 1 : c.stages;
    c.lookups = c.turned ? c.step.pairs : (c.called ? c.stages : c.places) * c.step.pairs;
    add_pressure(cost_registers(board, number), &c);
    c.evaluations = core_evaluations(im);
    return c;
}

cost_counts cost_counts_of(const image *im, const cost_board *board, cost_number number) {
    const bool soft = cost_is_soft(board, number);
    operands given = soft ? operands_of(im, number) : (operands){.of = NULL};
    const cost_counts c = count(im, board, number, &given);
    operands_free(&given);
    return c;
}

void cost_features(const cost_counts *c, double feature[static COST_FEATURES]) {
#define COST_VALUE(id, taken, count) feature[COST_F_##id] = (double)(count);
    COST_FEATURE_ROWS(COST_VALUE)
#undef COST_VALUE
}
