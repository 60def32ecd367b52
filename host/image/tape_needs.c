/* tape_needs.c: see tape_needs.h. */
#include "tape_needs.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

int tape_needed(const tape_needs *n, int i, int found[static NEEDED_MOST]) {
    int count = tape_operands(&n->t->ops[i], found);
    if (n->before[i] >= 0) {
        found[count++] = n->before[i];
    }
    return count;
}

int tape_taken(const tape *t, int i, int found[static TAKEN_MOST]) {
    int operand[TAKEN_MOST];
    const int operands = tape_operands(&t->ops[i], operand);
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

static bool may_be_given(const op *o) {
    switch (op_rows[o->code].kind) {
    case OP_IS_CONSTANT:
    case OP_IS_LEAF:
    case OP_IS_PHASE:
    case OP_IS_CELL:
    case OP_IS_WAVE: return true;
    case OP_IS_LOOKUP:
    case OP_IS_UNARY:
    case OP_IS_BINARY:
    case OP_IS_CALL: break;
    }
    return false;
}

tape_needs tape_needs_of(const tape *t) {
    tape_needs n = {.t = t,
                    .before = room(t->count, sizeof *n.before),
                    .given = room(t->count, sizeof *n.given),
                    .first = room((int64_t)t->count + 1, sizeof *n.first)};
    int found[NEEDED_MOST];
    int phase = -1;
    for (int i = 0; i < t->count; i++) {
        const bool is_phase = t->ops[i].code == OP_PHASE;
        n.before[i] = is_phase ? phase : -1;
        phase = is_phase ? i : phase;
        n.given[i] = may_be_given(&t->ops[i]);
        for (int k = tape_needed(&n, i, found); k > 0; k--) {
            n.given[i] = n.given[i] && n.given[found[k - 1]];
            n.first[found[k - 1] + 1]++;
        }
    }
    for (int i = 0; i < t->count; i++) {
        n.first[i + 1] += n.first[i];
    }
    n.user = room(n.first[t->count], sizeof *n.user);
    int *next = room_more(NULL, t->count, sizeof *next);
    memcpy(next, n.first, (size_t)t->count * sizeof *next);
    for (int i = 0; i < t->count; i++) {
        for (int k = tape_needed(&n, i, found); k > 0; k--) {
            n.user[next[found[k - 1]]++] = i;
        }
    }
    free(next);
    return n;
}

void tape_needs_free(tape_needs *n) {
    free(n->before);
    free(n->given);
    free(n->first);
    free(n->user);
}

/* --- how often values are carried ----------------------------------------------------------------*/

/* When each value of a list that is done in some sequence is wanted. */
typedef struct wanted {
    int *first; /* [ops + 1]: where a value's times begin in time[] */
    int *time;  /* places in the sequence; behind its end for results */
    int *next;  /* [ops]: which of its times comes next */
} wanted;

/* Value v is wanted at a time: counted first, entered in the second pass. */
static void want(wanted *w, int pass, int v, int time) {
    if (pass == 0) {
        w->first[v + 1]++;
    } else {
        w->time[w->next[v]++] = time;
    }
}

static wanted wanted_of(const tape *t, const int *sequence, int count) {
    wanted w = {room((int64_t)t->count + 1, sizeof *w.first), NULL,
                room_more(NULL, t->count, sizeof *w.next)};
    int found[TAKEN_MOST];
    for (int pass = 0; pass < 2; pass++) {
        for (int at = 0; at < count; at++) {
            for (int k = tape_taken(t, sequence[at], found); k > 0; k--) {
                want(&w, pass, found[k - 1], at);
            }
        }
        for (int i = 0; i < t->results; i++) {
            want(&w, pass, t->result[i], count);
        }
        for (int i = 0; i < t->count && pass == 0; i++) {
            w.first[i + 1] += w.first[i];
        }
        w.time = pass == 0 ? room(w.first[t->count], sizeof *w.time) : w.time;
        memcpy(w.next, w.first, (size_t)t->count * sizeof *w.next);
    }
    return w;
}

static void wanted_free(wanted *w) {
    free(w->first);
    free(w->time);
    free(w->next);
}

/* When value v is wanted next, or INT_MAX. */
static int next_time(const wanted *w, int v) {
    return w->next[v] < w->first[v + 1] ? w->time[w->next[v]] : INT_MAX;
}

/* Values in registers, and what carrying them has cost. */
typedef struct registers {
    int value[TAPE_REGISTERS];
    int count;
    bool *stored; /* [ops]: memory has it, too */
    int carried;
} registers;

/* Value v gets a register: if need be, that of the one that is wanted last. (What an operation takes is wanted now.) */
static void hold(const wanted *w, registers *r, int v) {
    if (r->count == TAPE_REGISTERS) {
        int last = 0;
        for (int k = 1; k < TAPE_REGISTERS; k++) {
            last = next_time(w, r->value[k]) > next_time(w, r->value[last]) ? k : last;
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

static bool is_held(const registers *r, int v) {
    int k = 0;
    while (k < r->count && r->value[k] != v) {
        k++;
    }
    return k < r->count;
}

int tape_carried_by(const tape_needs *n, const int *sequence, int count) {
    wanted w = wanted_of(n->t, sequence, count);
    registers r = {.stored = room(n->t->count, sizeof *r.stored)};
    int found[TAKEN_MOST];
    for (int i = 0; i < n->t->count; i++) {
        r.stored[i] = n->given[i];
    }
    for (int at = 0; at < count; at++) {
        const int values = tape_taken(n->t, sequence[at], found);
        for (int k = 0; k < values; k++) {
            if (!is_held(&r, found[k])) {
                hold(&w, &r, found[k]);
                r.carried++;
            }
        }
        for (int k = 0; k < values; k++) {
            w.next[found[k]]++;
        }
        int kept = 0;
        for (int k = 0; k < r.count; k++) {
            if (next_time(&w, r.value[k]) < INT_MAX) {
                r.value[kept++] = r.value[k];
            }
        }
        r.count = kept;
        if (next_time(&w, sequence[at]) < INT_MAX) {
            hold(&w, &r, sequence[at]);
        }
    }
    const int carried = r.carried;
    free(r.stored);
    wanted_free(&w);
    return carried;
}

int *tape_computed(const tape_needs *n, int *count) {
    int *sequence = room_more(NULL, n->t->count, sizeof *sequence);
    *count = 0;
    for (int i = 0; i < n->t->count; i++) {
        if (!n->given[i]) {
            sequence[(*count)++] = i;
        }
    }
    return sequence;
}

int tape_carried(const tape *t) {
    tape_needs n = tape_needs_of(t);
    int count;
    int *sequence = tape_computed(&n, &count);
    const int times = tape_carried_by(&n, sequence, count);
    free(sequence);
    tape_needs_free(&n);
    return times;
}
