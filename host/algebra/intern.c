/* intern.c: one object for equal things: atoms, products and sums are looked up before they are made. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "algebra.h"
#include "host/base/hashing.h"
#include "host/base/room.h"
#include "poly.h"

/* A derivation that needs more work than this is given up on: some 500 MB, or half a minute. An arm of six joints, of which
 * no length is 0, needs 0.42e9. */
#define WORK_MAX ((size_t)1 << 29)
/* What a term handled counts for, in bytes. */
#define WORK_OF_TERM 2U
/* What objects count for, in bytes: their sizes on a host of 64 bits. What is given up on must not depend on the host. */
enum { ATOM_BYTES = 72, MONO_BYTES = 48, POLY_BYTES = 32, PART_BYTES = 16, PAIR_BYTES = 24 };

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* --- hash tables ---------------------------------------------------------------------------------*/

static void table_grow(intern_table *table) {
    const size_t size = table->size == 0 ? 1024 : table->size * 2;
    intern_slot *slots = room((int64_t)size, sizeof *slots);
    for (size_t i = 0; i < table->size; i++) {
        if (table->slots[i].object != NULL) {
            size_t at = (size_t)table->slots[i].hash & (size - 1);
            while (slots[at].object != NULL) {
                at = (at + 1) & (size - 1);
            }
            slots[at] = table->slots[i];
        }
    }
    free(table->slots);
    table->slots = slots;
    table->size = size;
}

/* The slot where an equal object lies, or the empty slot where it belongs. */
static intern_slot *table_find(intern_table *table, uint64_t hash, const void *candidate,
                               bool (*equal)(const void *, const void *)) {
    if (table->count * 2 >= table->size) {
        table_grow(table);
    }
    size_t at = (size_t)hash & (table->size - 1);
    while (table->slots[at].object != NULL &&
           !(table->slots[at].hash == hash && equal(table->slots[at].object, candidate))) {
        at = (at + 1) & (table->size - 1);
    }
    return &table->slots[at];
}

static void count_bytes(algebra *a, size_t bytes) {
    a->work += bytes;
    if (a->work > WORK_MAX) {
        a->overflow = true;
    }
}

char *algebra_limit(const algebra *a) {
    return a->work > WORK_MAX ? room_words("more than %.0f MB of terms were made", 1e-6 * WORK_MAX)
                              : room_words("more than %.0f operands", POLY_SIZE_MAX);
}

void algebra_work(algebra *a, size_t amount) { count_bytes(a, amount * WORK_OF_TERM); }

/* A new object's number. With its slots in the hash table it takes some 48 bytes more than itself. */
static unsigned next_id(algebra *a, intern_table *table, size_t bytes) {
    count_bytes(a, bytes + 48);
    return (unsigned)table->count++;
}

/* --- life ----------------------------------------------------------------------------------------*/

algebra *algebra_new(void) {
    algebra *a = room(1, sizeof *a);
    a->arena = arena_new();
    a->zero = poly_number(a, 0.0);
    a->one = poly_number(a, 1.0);
    return a;
}

void algebra_free(algebra *a) {
    if (a == NULL) {
        return;
    }
    free(a->atoms.slots);
    free(a->monos.slots);
    free(a->polys.slots);
    free(a->products.slots);
    free(a->derivatives.slots);
    free(a->lets.slots);
    arena_free(a->arena);
    free(a);
}

bool algebra_overflow(const algebra *a) { return a->overflow; }

/* --- atoms ---------------------------------------------------------------------------------------*/

uint64_t symbol_bit(const symbol *sym, int primes) {
    const uint64_t which = (uint64_t)sym->kind * 1024U + (uint64_t)sym->index;
    return UINT64_C(1) << (hash_mix(which, (uint64_t)primes + 1) >> 58);
}

static bool atom_equal(const void *x, const void *y) {
    const atom *left = x;
    const atom *right = y;
    return left->kind == right->kind && left->symbol == right->symbol &&
           left->primes == right->primes && left->function == right->function &&
           left->argument[0] == right->argument[0] && left->argument[1] == right->argument[1];
}

static const atom *atom_intern(algebra *a, const atom *candidate) {
    uint64_t hash = hash_mix((uint64_t)candidate->kind, (uint64_t)candidate->function);
    hash = hash_mix(hash_mix(hash, (uint64_t)(uintptr_t)candidate->symbol),
                    (uint64_t)candidate->primes);
    for (int i = 0; i < 2; i++) {
        hash = hash_mix(hash, candidate->argument[i] == NULL ? 0 : candidate->argument[i]->id + 1U);
    }
    intern_slot *slot = table_find(&a->atoms, hash, candidate, atom_equal);
    if (slot->object == NULL) {
        atom *made = arena_alloc(a->arena, sizeof *made);
        *made = *candidate;
        made->id = next_id(a, &a->atoms, ATOM_BYTES);
        made->rank = atom_rank(made);
        *slot = (intern_slot){hash, made};
    }
    return slot->object;
}

const atom *atom_symbol(algebra *a, const symbol *sym, int primes) {
    const atom candidate = {.kind = ATOM_SYMBOL,
                            .symbol = sym,
                            .primes = primes,
                            .symbols = symbol_bit(sym, primes),
                            .size = 1.0};
    return atom_intern(a, &candidate);
}

const atom *atom_of_polys(algebra *a, atom_kind kind, function_id function, const poly *x,
                          const poly *y) {
    const atom candidate = {.kind = kind,
                            .function = function,
                            .argument = {x, y},
                            .symbols = x->symbols | (y == NULL ? 0 : y->symbols),
                            .keeps_powers = x->keeps_powers || (y != NULL && y->keeps_powers),
                            .size = 1.0 + x->size + (y == NULL ? 0.0 : y->size)};
    return atom_intern(a, &candidate);
}

/* --- products of atoms ---------------------------------------------------------------------------*/

static bool mono_equal(const void *x, const void *y) {
    const mono *left = x;
    const mono *right = y;
    if (left->count != right->count || left->trig != right->trig || left->angle != right->angle) {
        return false;
    }
    for (int i = 0; i < left->count; i++) {
        if (left->factors[i].atom != right->factors[i].atom ||
            bits_of(left->factors[i].exponent) != bits_of(right->factors[i].exponent)) {
            return false;
        }
    }
    return true;
}

/* `candidate` may lie in scratch memory: it is copied when it is new. */
const mono *mono_intern(algebra *a, mono *candidate) {
    uint64_t hash = hash_mix((uint64_t)candidate->trig,
                             candidate->angle == NULL ? 0 : candidate->angle->id + 1U);
    candidate->symbols = candidate->angle == NULL ? 0 : candidate->angle->symbols;
    candidate->keeps_powers = candidate->angle != NULL && candidate->angle->keeps_powers;
    candidate->size = candidate->angle == NULL ? 1.0 : 1.0 + candidate->angle->size;
    for (int i = 0; i < candidate->count; i++) {
        const mono_factor *f = &candidate->factors[i];
        const bool kept = f->atom->kind == ATOM_GROUP && f->exponent > 1.0 &&
                          power_multiplies_out(f->atom->argument[0], f->exponent, (double)INFINITY);
        candidate->keeps_powers = candidate->keeps_powers || f->atom->keeps_powers || kept;
        hash = hash_mix(hash_mix(hash, candidate->factors[i].atom->id),
                        bits_of(candidate->factors[i].exponent));
        candidate->symbols |= candidate->factors[i].atom->symbols;
        candidate->size += candidate->factors[i].atom->size;
    }
    intern_slot *slot = table_find(&a->monos, hash, candidate, mono_equal);
    if (slot->object != NULL) {
        return slot->object;
    }
    const size_t bytes = sizeof *candidate + (size_t)candidate->count * sizeof(mono_factor);
    mono *made = arena_alloc(a->arena, bytes);
    memcpy(made, candidate, bytes);
    made->id = next_id(a, &a->monos, MONO_BYTES + (size_t)candidate->count * PART_BYTES);
    *slot = (intern_slot){hash, made};
    return made;
}

mono *mono_scratch(int factors) {
    mono *m = room_tail(sizeof *m, factors, sizeof(mono_factor));
    return m;
}

const mono *mono_make(algebra *a, const mono_factor *factors, int count, trig kind,
                      const poly *angle) {
    mono *m = mono_scratch(count);
    m->count = count;
    m->trig = kind;
    m->angle = angle;
    if (count > 0) {
        memcpy(m->factors, factors, (size_t)count * sizeof *factors);
    }
    const mono *made = mono_intern(a, m);
    free(m);
    return made;
}

/* --- sums ----------------------------------------------------------------------------------------*/

static bool poly_equal(const void *x, const void *y) {
    const poly *left = x;
    const poly *right = y;
    if (left->count != right->count) {
        return false;
    }
    for (int i = 0; i < left->count; i++) {
        if (left->terms[i].mono != right->terms[i].mono ||
            bits_of(left->terms[i].coefficient) != bits_of(right->terms[i].coefficient)) {
            return false;
        }
    }
    return true;
}

const poly *poly_intern(algebra *a, poly *candidate) {
    uint64_t hash = (uint64_t)candidate->count;
    candidate->symbols = 0;
    candidate->keeps_powers = false;
    candidate->size = 0.0;
    for (int i = 0; i < candidate->count; i++) {
        candidate->keeps_powers = candidate->keeps_powers || candidate->terms[i].mono->keeps_powers;
        hash = hash_mix(hash_mix(hash, candidate->terms[i].mono->id),
                        bits_of(candidate->terms[i].coefficient));
        candidate->symbols |= candidate->terms[i].mono->symbols;
        candidate->size += candidate->terms[i].mono->size;
    }
    intern_slot *slot = table_find(&a->polys, hash, candidate, poly_equal);
    if (slot->object == NULL) {
        const size_t bytes = sizeof *candidate + (size_t)candidate->count * sizeof(poly_term);
        poly *made = arena_alloc(a->arena, bytes);
        memcpy(made, candidate, bytes);
        made->id = next_id(a, &a->polys, POLY_BYTES + (size_t)candidate->count * PART_BYTES);
        if (made->size > POLY_SIZE_MAX) {
            a->overflow = true;
        }
        *slot = (intern_slot){hash, made};
    }
    return slot->object;
}

poly *poly_scratch(int terms) {
    poly *p = room_tail(sizeof *p, terms, sizeof(poly_term));
    return p;
}

const poly *poly_of_term(algebra *a, double coefficient, const mono *m) {
    if (coefficient == 0.0) {
        return a->zero;
    }
    poly *p = poly_scratch(1);
    p->count = 1;
    p->terms[0] = (poly_term){coefficient, m};
    const poly *made = poly_intern(a, p);
    free(p);
    return made;
}

const poly *poly_number(algebra *a, double value) {
    if (value == 0.0) {
        poly none = {.count = 0};
        return poly_intern(a, &none);
    }
    return poly_of_term(a, value, mono_make(a, NULL, 0, TRIG_NONE, NULL));
}

/* --- results remembered --------------------------------------------------------------------------*/

static bool pair_equal(const void *x, const void *y) {
    const memo_pair *left = x;
    const memo_pair *right = y;
    return left->left == right->left && left->right == right->right;
}

static uint64_t pair_hash(const void *left, const void *right) {
    return hash_mix((uint64_t)(uintptr_t)left, (uint64_t)(uintptr_t)right);
}

const poly *memo_get(intern_table *table, const void *left, const void *right) {
    const memo_pair key = {left, right, NULL};
    const intern_slot *slot = table_find(table, pair_hash(left, right), &key, pair_equal);
    return slot->object == NULL ? NULL : ((const memo_pair *)slot->object)->result;
}

void memo_put(algebra *a, intern_table *table, const void *left, const void *right,
              const poly *result) {
    const memo_pair key = {left, right, result};
    const uint64_t hash = pair_hash(left, right);
    intern_slot *slot = table_find(table, hash, &key, pair_equal);
    if (slot->object == NULL) {
        memo_pair *made = arena_alloc(a->arena, sizeof *made);
        *made = key;
        *slot = (intern_slot){hash, made};
        next_id(a, table, PAIR_BYTES);
    }
}
