/* op_list_use.c: analysis of a finished list: needed operations, cost, and order. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/hashing.h"
#include "host/image/op_list.h"

/* Keeps the operations order[count]. Operation i becomes operation number[i]. */
static void renumber(op_list *t, const int *order, const int *number, int count) {
    op *ops = alloc_more(NULL, t->room, sizeof *ops);
    for (int i = 0; i < count; i++) {
        op *o = &ops[i];
        *o = t->ops[order[i]];
        const bool values = op_rows[o->code].values > 0;
        o->a = values && o->a >= 0 ? number[o->a] : o->a;
        o->b = (values || o->code == OP_PHASE) && o->b >= 0 ? number[o->b] : o->b;
    }
    free(t->ops);
    t->ops = ops;
    t->count = count;
    for (int i = 0; i < t->results; i++) {
        t->result[i] = number[t->result[i]];
    }
    op_list_reindex(t);
}

/* === dependencies between operations ========================================================== */

/* An Arm or RISC-V FPU has 32 single-precision registers. The surrounding step needs some of them. */
enum { OP_LIST_REGISTERS = 20 };

/* Dependencies between operations. A phase also depends on the previous phase, so that phases keep their order. */
typedef struct op_list_needs {
    const op_list *t;
    struct arena *memory; /* owns every array of the analysis */
    int *before;          /* [t->count] for a phase, the previous phase; else -1 */
    bool *given;          /* [t->count] true: the operation's value is loaded, not computed */
    int *first;           /* [t->count + 1] index in `user` of each operation's first user */
    int *user;            /* users of operation 0, then those of 1, ...; each group ascends */
} op_list_needs;

enum { NEEDED_MOST = 3, TAKEN_MOST = 2 };

/* Finds the operations that must precede operation i; returns their number. */
static int op_list_needed(const op_list_needs *n, int i, int found[static NEEDED_MOST]) {
    int count = op_list_operands(&n->t->ops[i], found);
    if (n->before[i] >= 0) {
        found[count++] = n->before[i];
    }
    return count;
}

/* Finds the different values that operation i reads from registers. Returns their number. */
static int op_list_taken(const op_list *t, int i, int found[static TAKEN_MOST]) {
    int operand[TAKEN_MOST];
    const int operands = op_list_operands(&t->ops[i], operand);
    int count = 0;
    for (int k = 0; k < operands; k++) {
        const op_kind kind = op_rows[t->ops[operand[k]].code].kind;
        const bool again = k > 0 && operand[k] == operand[0];
        if (kind != OP_IS_CONSTANT && kind != OP_IS_PHASE && kind != OP_IS_CELL && !again) {
            found[count++] = operand[k];
        }
    }
    return count;
}

/* Zeroed working memory: `size` bytes for each operation of the list. */
static void *room(const op_list_needs *n, size_t size) {
    return arena_alloc(n->memory, (size_t)n->t->count * size);
}

static op_list_needs op_list_needs_of(const op_list *t) {
    op_list_needs n = {.t = t, .memory = arena_new()};
    n.before = room(&n, sizeof *n.before);
    n.given = room(&n, sizeof *n.given);
    n.first = arena_alloc(n.memory, ((size_t)t->count + 1) * sizeof *n.first);
    int found[NEEDED_MOST];
    int phase = -1;
    for (int i = 0; i < t->count; i++) {
        const bool is_phase = t->ops[i].code == OP_PHASE;
        n.before[i] = is_phase ? phase : -1;
        phase = is_phase ? i : phase;
        const op_row *row = &op_rows[t->ops[i].code];
        n.given[i] = row->values == 0 || row->kind == OP_IS_WAVE;
        for (int k = op_list_needed(&n, i, found); k > 0; k--) {
            n.given[i] = n.given[i] && n.given[found[k - 1]];
            n.first[found[k - 1] + 1]++;
        }
    }
    for (int i = 0; i < t->count; i++) {
        n.first[i + 1] += n.first[i];
    }
    n.user = arena_alloc(n.memory, (size_t)n.first[t->count] * sizeof *n.user);
    int *next = room(&n, sizeof *next);
    memcpy(next, n.first, (size_t)t->count * sizeof *next);
    for (int i = 0; i < t->count; i++) {
        for (int k = op_list_needed(&n, i, found); k > 0; k--) {
            n.user[next[found[k - 1]]++] = i;
        }
    }
    return n;
}

typedef struct registers {
    int value[OP_LIST_REGISTERS];
    int count;
    int *next;    /* [ops] position of the value's next use; INT_MAX: none */
    bool *stored; /* [ops] memory has a copy */
    int carried;  /* loads and stores so far */
} registers;

/* Gives value v a register. If none is free, the value whose next use is latest loses its register. The operands of the
 * current operation keep theirs, because their next use is now. */
static void hold(registers *r, int v) {
    if (r->count == OP_LIST_REGISTERS) {
        int last = 0;
        for (int k = 1; k < OP_LIST_REGISTERS; k++) {
            last = r->next[r->value[k]] > r->next[r->value[last]] ? k : last;
        }
        const int gone = r->value[last];
        if (!r->stored[gone]) {
            r->stored[gone] = true;
            r->carried++;
        }
        r->value[last] = r->value[--r->count];
    }
    r->value[r->count++] = v;
}

/* The returned array has TAKEN_MOST entries for each position of `sequence`. */
static int *uses_after(const op_list_needs *n, const int *sequence, int count, int *next) {
    const op_list *t = n->t;
    int *after = room(n, TAKEN_MOST * sizeof *after);
    int found[TAKEN_MOST];
    for (int i = 0; i < t->count; i++) {
        next[i] = INT_MAX;
    }
    for (int i = 0; i < t->results; i++) {
        next[t->result[i]] = count;
    }
    for (int at = count - 1; at >= 0; at--) {
        for (int k = op_list_taken(t, sequence[at], found) - 1; k >= 0; k--) {
            after[TAKEN_MOST * at + k] = next[found[k]];
            next[found[k]] = at;
        }
    }
    return after;
}

/* Counts loads and stores in this sequence. Replacing the value whose next use is latest is optimal (Belady, 1966). */
static int op_list_carried_by(const op_list_needs *n, const int *sequence, int count) {
    registers r = {.next = room(n, sizeof *r.next), .stored = room(n, sizeof *r.stored)};
    const int *after = uses_after(n, sequence, count, r.next);
    int found[TAKEN_MOST];
    memcpy(r.stored, n->given, (size_t)n->t->count * sizeof *r.stored);
    for (int at = 0; at < count; at++) {
        const int values = op_list_taken(n->t, sequence[at], found);
        for (int k = 0; k < values; k++) {
            int held = 0;
            while (held < r.count && r.value[held] != found[k]) {
                held++;
            }
            if (held == r.count) {
                hold(&r, found[k]);
                r.carried++;
            }
        }
        for (int k = 0; k < values; k++) {
            r.next[found[k]] = after[TAKEN_MOST * at + k];
        }
        int kept = 0;
        for (int k = 0; k < r.count; k++) {
            if (r.next[r.value[k]] < INT_MAX) {
                r.value[kept++] = r.value[k];
            }
        }
        r.count = kept;
        if (r.next[sequence[at]] < INT_MAX) {
            hold(&r, sequence[at]);
        }
    }
    return r.carried;
}

static int *op_list_computed(const op_list_needs *n, int *count) {
    int *sequence = room(n, sizeof *sequence);
    *count = 0;
    for (int i = 0; i < n->t->count; i++) {
        if (!n->given[i]) {
            sequence[(*count)++] = i;
        }
    }
    return sequence;
}

int op_list_carried(const op_list *t) {
    op_list_needs n = op_list_needs_of(t);
    int count;
    const int *sequence = op_list_computed(&n, &count);
    const int times = op_list_carried_by(&n, sequence, count);
    arena_free(n.memory);
    return times;
}

/* === order of a list ========================================================================== */
/* Reorders a finished list, because a large list has more live values than a processor has registers. A new order
 * always continues with the operation that is the last use of the most values. The two rules for ties (first_of) give
 * two new orders. The order with the fewest loads and stores is taken: one of these, or the order of entry. */

typedef struct schedule {
    const op_list_needs *needs;
    int *waits; /* [ops] dependencies not yet computed */
    int *uses;  /* [ops] remaining users, plus 2 for a result, so that it stays live */
    int *ends;  /* [ops] number of values that have this operation as their only remaining user */
    int *until; /* [ops] last user of the operation's value */
    int *ready; /* operations without pending dependencies, unordered */
    int count;  /* number of ready operations */
    bool *done; /* [ops] */
} schedule;

static void use_up(schedule *s, int v) {
    const op_list_needs *n = s->needs;
    if (--s->uses[v] != 1) {
        return;
    }
    for (int k = n->first[v]; k < n->first[v + 1]; k++) {
        const int u = n->user[k];
        if (!s->done[u] && !n->given[u]) {
            s->ends[u]++;
            return;
        }
    }
}

static schedule schedule_of(const op_list_needs *n) {
    const op_list *t = n->t;
    schedule s = {.needs = n,
                  .waits = room(n, sizeof *s.waits),
                  .uses = room(n, sizeof *s.uses),
                  .ends = room(n, sizeof *s.ends),
                  .until = room(n, sizeof *s.until),
                  .ready = room(n, sizeof *s.ready),
                  .done = room(n, sizeof *s.done)};
    int found[NEEDED_MOST];
    for (int i = 0; i < t->count; i++) {
        if (n->given[i]) {
            continue;
        }
        for (int k = op_list_needed(n, i, found); k > 0; k--) {
            s.waits[i] += !n->given[found[k - 1]];
        }
        for (int k = op_list_taken(t, i, found); k > 0; k--) {
            s.uses[found[k - 1]]++;
        }
        if (s.waits[i] == 0) {
            s.ready[s.count++] = i;
        }
    }
    for (int v = 0; v < t->count; v++) {
        s.until[v] = n->first[v] < n->first[v + 1] ? n->user[n->first[v + 1] - 1] : v;
    }
    for (int i = 0; i < t->results; i++) {
        s.uses[t->result[i]] += 2;
        s.until[t->result[i]] = t->count;
    }
    for (int v = 0; v < t->count; v++) {
        s.uses[v]++;
        use_up(&s, v);
    }
    return s;
}

/* A tie goes to the first operation in the list (AS_ENTERED), or to that with the least until[] (SOONEST_DONE). */
typedef enum first_of { AS_ENTERED, SOONEST_DONE, FIRST_OF } first_of;

static bool leads(const schedule *s, first_of way, int i, int j) {
    if (s->ends[i] != s->ends[j]) {
        return s->ends[i] > s->ends[j];
    }
    const bool soonest = way == SOONEST_DONE && s->until[i] != s->until[j];
    return soonest ? s->until[i] < s->until[j] : i < j;
}

static int take_best(schedule *s, first_of way) {
    int best = 0;
    for (int k = 1; k < s->count; k++) {
        best = leads(s, way, s->ready[k], s->ready[best]) ? k : best;
    }
    const int i = s->ready[best];
    s->ready[best] = s->ready[--s->count];
    return i;
}

/* Returns a sequence of the operations to compute. */
static int *ending_lives(const op_list_needs *n, int count, first_of way) {
    schedule s = schedule_of(n);
    int *sequence = room(n, sizeof *sequence);
    int found[TAKEN_MOST];
    for (int at = 0; at < count; at++) {
        const int i = take_best(&s, way);
        sequence[at] = i;
        s.done[i] = true;
        for (int k = op_list_taken(n->t, i, found); k > 0; k--) {
            use_up(&s, found[k - 1]);
        }
        for (int k = n->first[i]; k < n->first[i + 1]; k++) {
            const int u = n->user[k];
            if (--s.waits[u] == 0 && !n->given[u]) {
                s.ready[s.count++] = u;
            }
        }
    }
    return sequence;
}

typedef struct placing {
    const op_list *t;
    const op_list_needs *needs; /* NULL: an operation follows only its operands */
    int *order;                 /* [ops]: operation at each position */
    int *number;                /* [ops]: position of each operation, or -1 */
    int count;
} placing;

/* Appends operation i to the sequence, after the missing operations on which it depends. */
static void put_next(placing *p, int i) {
    int found[NEEDED_MOST];
    const int count = p->number[i] >= 0  ? 0
                      : p->needs != NULL ? op_list_needed(p->needs, i, found)
                                         : op_list_operands(&p->t->ops[i], found);
    for (int k = 0; k < count; k++) {
        put_next(p, found[k]);
    }
    if (p->number[i] < 0) {
        p->number[i] = p->count;
        p->order[p->count++] = i;
    }
}

/* Puts the operations of the sequence first, each after its operands. The others follow in the order of entry. */
static void reorder(op_list *t, const op_list_needs *n, const int *sequence, int count) {
    placing p = {t, n, alloc_more(NULL, t->count, sizeof *p.order),
                 alloc_more(NULL, t->count, sizeof *p.number), 0};
    memset(p.number, -1, (size_t)t->count * sizeof *p.number);
    for (int at = 0; at < count; at++) {
        put_next(&p, sequence[at]);
    }
    for (int i = 0; i < t->count; i++) {
        put_next(&p, i);
    }
    renumber(t, p.order, p.number, p.count);
    free(p.order);
    free(p.number);
}

void op_list_order(op_list *t) {
    if (t->count <= OP_LIST_REGISTERS) {
        return;
    }
    op_list_needs n = op_list_needs_of(t);
    int count;
    const int *best = op_list_computed(&n, &count);
    int least = op_list_carried_by(&n, best, count);
    bool moved = false;
    for (int way = 0; way < FIRST_OF; way++) {
        const int *tried = ending_lives(&n, count, (first_of)way);
        const int carried = op_list_carried_by(&n, tried, count);
        if (carried < least) {
            best = tried;
            least = carried;
            moved = true;
        }
    }
    if (moved) {
        reorder(t, &n, best, count);
    }
    arena_free(n.memory);
}

/* === sums with a common part ================================================================== */
/* Replaces a + 2 b by (a + b) + b if the list has a + b, which saves a product. Kinetic energies produce such pairs: a
 * chain of two arms moves with sin x + sin y, and its forces have sin x + 2 sin y. */

/* Returns b if operation i is 2 b and is used only once; else -1. */
static int doubled(const op_list *t, const int *uses, int i) {
    const op *o = &t->ops[i];
    double two;
    if (o->code != OP_MUL || uses[i] != 1) {
        return -1;
    }
    if (op_list_is_constant(t, o->a, &two) && two == 2.0) {
        return o->b;
    }
    return op_list_is_constant(t, o->b, &two) && two == 2.0 ? o->a : -1;
}

/* If operation i is a + 2 b and the list has a + b, sets *half to a + b and *part to b. Differences work alike. */
static bool half_of(const op_list *t, const int *uses, int i, int *half, int *part) {
    const op *o = &t->ops[i];
    const int twice_a = doubled(t, uses, o->a);
    const int twice_b = doubled(t, uses, o->b);
    *half = -1;
    if (twice_b >= 0) {
        *part = twice_b;
        *half = op_list_find_binary(t, o->code, o->a, twice_b);
    }
    if (*half < 0 && twice_a >= 0) {
        *part = twice_a;
        *half = op_list_find_binary(t, o->code, twice_a, o->b);
    }
    return *half >= 0;
}

static int *uses_of(const op_list *t) {
    int *uses = alloc(t->count, sizeof *uses);
    int operand[2];
    for (int i = 0; i < t->count; i++) {
        for (int k = op_list_operands(&t->ops[i], operand); k > 0; k--) {
            uses[operand[k - 1]]++;
        }
    }
    for (int i = 0; i < t->results; i++) {
        uses[t->result[i]]++;
    }
    return uses;
}

void op_list_share_sums(op_list *t) {
    int *uses = uses_of(t);
    bool shared = false;
    for (int i = 0; i < t->count; i++) {
        op *o = &t->ops[i];
        int half;
        int part;
        if ((o->code == OP_ADD || o->code == OP_SUB) && half_of(t, uses, i, &half, &part)) {
            /* 2 b - a = (b - a) + b */
            const op_code code = o->code == OP_SUB && t->ops[half].b == part ? OP_SUB : OP_ADD;
            *o = (op){.code = code, .function = FUNCTION_NONE, .a = half, .b = part};
            uses[part] += 1;
            uses[half] += 1;
            shared = true;
        }
    }
    free(uses);
    if (shared) {
        reorder(t, NULL, NULL, 0); /* a changed operation may use a later one */
        op_list_prune(t);
    }
}

/* === needed operations and cost =============================================================== */

int op_list_operands(const op *o, int operand[static 2]) {
    const bool values = op_rows[o->code].values > 0;
    int count = 0;
    if (values && o->a >= 0) {
        operand[count++] = o->a;
    }
    if ((values || o->code == OP_PHASE) && o->b >= 0) {
        operand[count++] = o->b;
    }
    return count;
}

static void mark_operands(const op_list *t, int last, bool *needed) {
    int operand[2];
    for (int i = last; i >= 0; i--) {
        for (int k = needed[i] ? op_list_operands(&t->ops[i], operand) : 0; k > 0; k--) {
            needed[operand[k - 1]] = true;
        }
    }
}

void op_list_mark_needed(const op_list *t, int number, bool *needed) {
    needed[number] = true;
    mark_operands(t, number, needed);
}

bool op_list_has(const op_list *t, op_code code) {
    bool has = false;
    for (int i = 0; t != NULL && i < t->count && !has; i++) {
        has = t->ops[i].code == code;
    }
    return has;
}

bool op_list_has_kinks(const op_list *t) {
    return op_list_has(t, OP_ABS) || op_list_has(t, OP_SIGN) || op_list_has(t, OP_MIN) ||
           op_list_has(t, OP_MAX);
}

/* x * (1/y) becomes x/y if 1/y has no other use, which saves a rounding and an operation. */
static void fuse_reciprocals(op_list *t) {
    int *uses = uses_of(t);
    double one;
    for (int i = 0; i < t->count; i++) {
        op *o = &t->ops[i];
        for (int k = 0; k < 2 && o->code == OP_MUL; k++) {
            const int inverse = k == 0 ? o->a : o->b;
            const int other = k == 0 ? o->b : o->a;
            if (t->ops[inverse].code == OP_DIV && op_list_is_constant(t, t->ops[inverse].a, &one) &&
                one == 1.0 && uses[inverse] == 1) {
                *o = (op){
                    .code = OP_DIV, .function = FUNCTION_NONE, .a = other, .b = t->ops[inverse].b};
            }
        }
    }
    free(uses);
}

static void drop_unused(op_list *t) {
    bool *needed = alloc(t->count, sizeof *needed);
    int *order = alloc(t->count, sizeof *order);
    int *number = alloc(t->count, sizeof *number);
    for (int i = 0; i < t->results; i++) {
        needed[t->result[i]] = true;
    }
    mark_operands(t, t->count - 1, needed);
    int kept = 0;
    for (int i = 0; i < t->count; i++) {
        if (needed[i]) {
            order[kept] = i;
            number[i] = kept++;
        }
    }
    renumber(t, order, number, kept);
    free(order);
    free(number);
    free(needed);
}

void op_list_prune(op_list *t) {
    drop_unused(t);
    fuse_reciprocals(t);
    drop_unused(t);
}

bool op_list_reads_turns(const op_list *t) {
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == OP_RADIANS || t->ops[i].parts != NULL) {
            return true;
        }
    }
    return false;
}

int op_list_waves(const op_list *t) {
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        count += op_list_is_wave(&t->ops[i]);
    }
    return count;
}

bool op_list_takes_waves(const op_list *t) {
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        if (o->code == OP_PHASE && (o->parts != NULL || (o->turns != NULL && o->b >= 0))) {
            return false;
        }
    }
    return true;
}

int op_list_not_finite(const op_list *t) {
    bool *tainted = alloc(t->count, sizeof *tainted);
    int operand[2];
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        tainted[i] = !isfinite(o->value);
        for (int k = 0; k < t->angles && o->parts != NULL; k++) {
            tainted[i] = tainted[i] || !isfinite(o->parts[k]);
        }
        for (int k = op_list_operands(o, operand); k > 0; k--) {
            tainted[i] = tainted[i] || tainted[operand[k - 1]];
        }
    }
    int found = -1;
    for (int i = t->results - 1; i >= 0; i--) {
        found = tainted[t->result[i]] ? i : found;
    }
    free(tainted);
    return found;
}

bool fits_float(double value) {
    const double size = fabs(value);
    return size == 0.0 || (size >= 0x1p-126 && size < 0x1.ffffffp127);
}

double op_list_out_of_float(const op_list *t) {
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == OP_CONSTANT && !fits_float(t->ops[i].value)) {
            return t->ops[i].value;
        }
    }
    return 0.0;
}

op_list_cost op_list_count(const op_list *t) {
    op_list_cost cost = {0};
    for (int i = 0; i < t->count; i++) {
        switch (op_rows[t->ops[i].code].cost) {
        case OP_COSTS_NOTHING: break;
        case OP_COSTS_ARITHMETIC: cost.arithmetic++; break;
        case OP_COSTS_DIVISION: cost.divisions++; break;
        case OP_COSTS_ROOT: cost.roots++; break;
        case OP_COSTS_WAVE: cost.waves++; break;
        case OP_COSTS_CALL: cost.calls++; break;
        case OP_COSTS_LINE:
            cost.look_ups++;
            cost.arithmetic += 2;
            break;
        case OP_COSTS_CUBIC:
            cost.look_ups++;
            cost.arithmetic += 6;
            break;
        }
    }
    return cost;
}

int op_list_weight(const op_list *t) {
    const op_list_cost c = op_list_count(t);
    return c.arithmetic + 14 * (c.divisions + c.roots) + 36 * c.waves + 100 * c.calls;
}

int op_list_operations(const op_list *t) {
    int operations = 0;
    for (int i = 0; i < t->count; i++) {
        operations += op_rows[t->ops[i].code].values > 0;
    }
    return operations;
}

uint64_t op_list_hash(const op_list *t) {
    uint64_t hash = WH_HASH_START;
    for (int i = 0; i < t->count; i++) {
        hash = hash_of_hashes(hash, op_list_op_hash(t, &t->ops[i]));
    }
    for (int i = 0; i < t->results; i++) {
        hash = hash_of_hashes(hash, (uint64_t)t->result[i]);
    }
    const size_t numbers = (size_t)t->tables.count * (size_t)t->tables.terms;
    for (size_t i = 0; i < numbers << (unsigned)t->tables.bits; i++) {
        hash = hash_of_hashes(hash, number_bits(t->tables.number[i]));
    }
    return hash;
}
