/* noise_records.c: noise added after the exact outputs. */
#include "noise_records.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/hashing.h"

/* The noises of outputs with the same seed differ: the hash of the name (FNV-1a) enters the seed. */
static uint32_t seed_of(const noise *of) {
    return hash_text(of->output->name, strlen(of->output->name)) ^ of->seed;
}

/* The operation that adds noise k to `node`. */
static int with_noise(const equations *e, lowering *l, const noise *each, int node) {
    op_list *t = l->tape;
    const poly *deviation = poly_from_expr(e->algebra, each->deviation);
    const int size = lower(l, equations_fold(e, deviation));
    return op_list_add(t, node, op_list_mul(t, size, op_list_noise(t, seed_of(each))));
}

void noise_on_outputs(const equations *e, lowering *l, int *result) {
    const mechanism *m = e->instance->mechanism;
    for (int k = 0; k < m->noise_count; k++) {
        const noise *each = &m->noises[k];
        const int at = each->output->index;
        if (instance_has_noise(e->instance, each) && at < m->output_count &&
            m->outputs[at] == each->output) {
            result[at] = with_noise(e, l, each, result[at]);
        }
    }
}

/* Has this record's output any active noise? */
static bool is_noisy(const equations *e, const symbol *record) {
    const mechanism *m = e->instance->mechanism;
    for (int k = 0; k < m->noise_count; k++) {
        if (m->noises[k].record == record && instance_has_noise(e->instance, &m->noises[k])) {
            return true;
        }
    }
    return false;
}

typedef struct recording {
    const equations *equations;
    const conservation *conserved;
} recording;

/* The output of a record, ready for a list. */
static const poly *exact_output(const recording *r, const symbol *record) {
    const equations *e = r->equations;
    const poly *output = poly_from_expr(e->algebra, record->value);
    return conservation_settle(e, r->conserved, equations_fold(e, output));
}

static const poly *quiet_record(void *context, algebra *a, const symbol *s, int primes) {
    const recording *r = context;
    (void)a;
    (void)primes;
    return s->kind == SYM_RECORD && !is_noisy(r->equations, s) ? exact_output(r, s) : NULL;
}

noise_records noise_records_find(const equations *e, const conservation *conserved,
                                 const poly **wanted, int count) {
    const mechanism *m = e->instance->mechanism;
    recording of = {e, conserved};
    noise_records r = {alloc(m->noise_count, sizeof(const poly *)),
                       alloc(m->noise_count, sizeof(int)), 0};
    for (int k = 0; k < m->noise_count; k++) {
        const symbol *record = m->noises[k].record;
        bool named = false;
        for (int i = 0; i < count; i++) {
            named = named || poly_contains(wanted[i], record, 0);
        }
        if (named && is_noisy(e, record)) {
            r.exact[k] = exact_output(&of, record);
            r.count++;
        } else if (named) {
            for (int i = 0; i < count; i++) {
                wanted[i] = poly_substitute(e->algebra, wanted[i], quiet_record, &of);
            }
        }
    }
    return r;
}

void noise_records_lower(const equations *e, lowering *l, noise_records *r) {
    const mechanism *m = e->instance->mechanism;
    for (int k = 0; k < m->noise_count; k++) {
        if (r->exact[k] == NULL) {
            continue;
        }
        r->node[k] = lower(l, r->exact[k]);
        for (int i = 0; i < m->noise_count; i++) {
            if (m->noises[i].record == m->noises[k].record &&
                instance_has_noise(e->instance, &m->noises[i])) {
                r->node[k] = with_noise(e, l, &m->noises[i], r->node[k]);
            }
        }
    }
}

int noise_record_node(const equations *e, const int *node, const symbol *record) {
    const mechanism *m = e->instance->mechanism;
    int k = 0;
    while (m->noises[k].record != record) {
        k++; /* every record belongs to a noise */
    }
    return node[k];
}

void noise_records_free(noise_records *r) {
    free(r->exact);
    free(r->node);
}
