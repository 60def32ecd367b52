/* tape_order.c: an order of a finished list's operations in which few values are live at a time.
 *
 * A list comes in the order in which it was entered: a whole matrix before its first row is eliminated. Of a large one
 * more values wait than a processor has registers, and a third of what is executed carries them to memory and back.
 * Here the next operation is always one that ends the most lives. Of those it is the first as entered, or the one that
 * is soonest taken for the last time, as entered: two orders. What need not be computed (the state, the pairs of sine and
 * cosine) is read where it is first wanted.
 *
 * That looks one operation ahead. So both are compared with the order as entered, by how often values would be carried,
 * and the best is taken: a list whose values fit into registers keeps its order. */
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "tape_needs.h"

typedef struct schedule {
    const tape_needs *needs;
    int *waits; /* [ops]: how many of what it needs are still to be computed */
    int *uses;  /* [ops]: how many operations are still to take it, and results to be it */
    int *ends;  /* [ops]: how many lives it ends */
    int *until; /* [ops]: the last that takes it */
    int *ready; /* those that wait for nothing, in no order */
    int count;  /* of them */
    bool *done; /* [ops] */
} schedule;

/* One operation less will take value v: the last one ends its life. */
static void use_up(schedule *s, int v) {
    const tape_needs *n = s->needs;
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

static schedule schedule_of(const tape_needs *n) {
    const tape *t = n->t;
    schedule s = {.needs = n,
                  .waits = room(t->count, sizeof *s.waits),
                  .uses = room(t->count, sizeof *s.uses),
                  .ends = room(t->count, sizeof *s.ends),
                  .until = room(t->count, sizeof *s.until),
                  .ready = room_more(NULL, t->count, sizeof *s.ready),
                  .done = room(t->count, sizeof *s.done)};
    int found[NEEDED_MOST];
    for (int i = 0; i < t->count; i++) {
        if (n->given[i]) {
            continue;
        }
        for (int k = tape_needed(n, i, found); k > 0; k--) {
            s.waits[i] += !n->given[found[k - 1]];
        }
        for (int k = tape_taken(t, i, found); k > 0; k--) {
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
        s.uses[t->result[i]] += 2; /* never ends */
        s.until[t->result[i]] = t->count;
    }
    for (int v = 0; v < t->count; v++) {
        s.uses[v]++;
        use_up(&s, v);
    }
    return s;
}

static void schedule_free(schedule *s) {
    free(s->waits);
    free(s->uses);
    free(s->ends);
    free(s->until);
    free(s->ready);
    free(s->done);
}

/* Which one of those that end as many lives comes first. */
typedef enum first_of { AS_ENTERED, SOONEST_DONE, FIRST_OF } first_of;

/* Is operation i to come before operation j? */
static bool leads(const schedule *s, first_of way, int i, int j) {
    if (s->ends[i] != s->ends[j]) {
        return s->ends[i] > s->ends[j];
    }
    const bool soonest = way == SOONEST_DONE && s->until[i] != s->until[j];
    return soonest ? s->until[i] < s->until[j] : i < j;
}

/* The next operation, no longer among those that are ready. */
static int take_best(schedule *s, first_of way) {
    int best = 0;
    for (int k = 1; k < s->count; k++) {
        best = leads(s, way, s->ready[k], s->ready[best]) ? k : best;
    }
    const int i = s->ready[best];
    s->ready[best] = s->ready[--s->count];
    return i;
}

/* A sequence of what is computed. */
static int *ending_lives(const tape_needs *n, int count, first_of way) {
    schedule s = schedule_of(n);
    int *sequence = room_more(NULL, count, sizeof *sequence);
    int found[TAKEN_MOST];
    for (int at = 0; at < count; at++) {
        const int i = take_best(&s, way);
        sequence[at] = i;
        s.done[i] = true;
        for (int k = tape_taken(n->t, i, found); k > 0; k--) {
            use_up(&s, found[k - 1]);
        }
        for (int k = n->first[i]; k < n->first[i + 1]; k++) {
            const int u = n->user[k];
            if (--s.waits[u] == 0 && !n->given[u]) {
                s.ready[s.count++] = u;
            }
        }
    }
    schedule_free(&s);
    return sequence;
}

/* --- the list in its new order -------------------------------------------------------------------*/

typedef struct placing {
    const tape_needs *needs;
    int *order;  /* [ops]: which operation stands there */
    int *number; /* [ops]: where it stands, or -1 */
    int count;
} placing;

/* Operation i, and before it what is given and has not been wanted yet. */
static void put(placing *p, int i) {
    int found[NEEDED_MOST];
    const int count = p->number[i] < 0 ? tape_needed(p->needs, i, found) : 0;
    for (int k = 0; k < count; k++) {
        put(p, found[k]);
    }
    if (p->number[i] < 0) {
        p->number[i] = p->count;
        p->order[p->count++] = i;
    }
}

static void reorder(tape *t, const tape_needs *n, const int *sequence, int count) {
    placing p = {n, room_more(NULL, t->count, sizeof *p.order),
                 room_more(NULL, t->count, sizeof *p.number), 0};
    memset(p.number, -1, (size_t)t->count * sizeof *p.number);
    for (int at = 0; at < count; at++) {
        put(&p, sequence[at]);
    }
    for (int i = 0; i < t->count; i++) { /* what only results are, or nobody wants */
        put(&p, i);
    }
    tape_renumber(t, p.order, p.number);
    free(p.order);
    free(p.number);
}

void tape_order(tape *t) {
    if (t->count <= TAPE_REGISTERS) {
        return;
    }
    tape_needs n = tape_needs_of(t);
    int count;
    int *best = tape_computed(&n, &count);
    int least = tape_carried_by(&n, best, count);
    bool moved = false;
    for (int way = 0; way < FIRST_OF; way++) {
        int *tried = ending_lives(&n, count, (first_of)way);
        const int carried = tape_carried_by(&n, tried, count);
        if (carried < least) {
            int *worse = best;
            best = tried;
            tried = worse;
            least = carried;
            moved = true;
        }
        free(tried);
    }
    if (moved) {
        reorder(t, &n, best, count);
    }
    free(best);
    tape_needs_free(&n);
}
