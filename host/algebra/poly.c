/* poly.c: sums, products and powers in the normal form. */
#include "host/algebra/poly.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/algebra/algebra.h"
#include "host/base/alloc.h"
#include "host/base/hashing.h"
#include "host/number/folding.h"

/* === the order of the normal form ============================================================= */
/* The order of atoms, products and sums depends only on their contents, so the form of an expression depends neither on
 * earlier work nor on the compiler. Equal objects have the same address, so a comparison skips shared parts. */

static int of_ints(int x, int y) { return (x > y) - (x < y); }

/* If x < y, place_of(x) < place_of(y). The places of -0 and +0 differ. */
static uint64_t place_of(double x) {
    const uint64_t bits = number_bits(x);
    return bits >> 63 != 0 ? ~bits : bits | UINT64_C(1) << 63;
}

static int of_numbers(double x, double y) {
    const uint64_t left = place_of(x);
    const uint64_t right = place_of(y);
    return (left > right) - (left < right);
}

/* Symbols are sorted by their number of primes first: positions precede rates. */
static uint64_t atom_rank(const atom *x) {
    uint64_t rank = (uint64_t)x->kind << 60;
    if (x->kind == ATOM_SYMBOL) {
        rank += ((uint64_t)x->primes << 40) + ((uint64_t)x->symbol->kind << 32);
        return rank + (uint64_t)x->symbol->index;
    }
    return rank + (uint64_t)x->function;
}

static int atom_order(const atom *x, const atom *y) {
    if (x == y) {
        return 0;
    }
    if (x->rank != y->rank) {
        return x->rank < y->rank ? -1 : 1;
    }
    int order = x->kind == ATOM_SYMBOL ? strcmp(x->symbol->name, y->symbol->name) : 0;
    for (int i = 0; i < 2 && order == 0 && x->argument[i] != NULL; i++) {
        order = poly_order(x->argument[i], y->argument[i]);
    }
    return order;
}

/* The product without factors comes first: poly_power() relies on this. */
static int mono_order(const mono *x, const mono *y) {
    if (x == y) {
        return 0;
    }
    if (x->count != y->count) {
        return of_ints(x->count, y->count);
    }
    for (int i = 0; i < x->count; i++) {
        int order = atom_order(x->factors[i].atom, y->factors[i].atom);
        order = order != 0 ? order : of_numbers(x->factors[i].exponent, y->factors[i].exponent);
        if (order != 0) {
            return order;
        }
    }
    if (x->trig != y->trig || x->angle == NULL) {
        return of_ints((int)x->trig, (int)y->trig);
    }
    return poly_order(x->angle, y->angle);
}

int poly_order(const poly *x, const poly *y) {
    for (int i = 0; i < x->count && i < y->count && x != y; i++) {
        int order = mono_order(x->terms[i].mono, y->terms[i].mono);
        order = order != 0 ? order : of_numbers(x->terms[i].coefficient, y->terms[i].coefficient);
        if (order != 0) {
            return order;
        }
    }
    return of_ints(x->count, y->count);
}

/* === questions about a poly =================================================================== */

/* The sum of two coefficients counts as zero if it is at most this fraction of the larger coefficient. */
#define CANCELLED 1e-14
/* A whole power of a sum is multiplied out if this takes at most this many products of terms. */
#define POWER_TERMS_MAX 64

bool poly_is_zero(const poly *p) { return p->count == 0; }

bool poly_is_number(const poly *p, double *value) {
    if (p->count == 0) {
        *value = 0.0;
        return true;
    }
    if (p->count == 1 && p->terms[0].mono->count == 0 && p->terms[0].mono->trig == TRIG_NONE) {
        *value = p->terms[0].coefficient;
        return true;
    }
    return false;
}

double coefficient_sum(folding *f, double x, double y) {
    if (!isfinite(x + y)) { /* folding_cancels() would take any infinite sum for zero */
        return x + y;
    }
    return folding_cancels(f, x + y, number_most(fabs(x), fabs(y)), CANCELLED)
               ? 0.0
               : folding_sum(f, x, y);
}

static bool exponent_is_whole(double x) { return x == number_floor(x) && fabs(x) < 1e6; }

bool poly_is_place(const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const mono *m = p->terms[i].mono;
        for (int k = 0; k < m->count; k++) {
            if (m->factors[k].atom->kind != ATOM_SYMBOL || m->factors[k].atom->primes > 0) {
                return false;
            }
        }
        if (m->trig != TRIG_NONE) {
            return false;
        }
    }
    return p->count > 1;
}

/* Is base^exponent expanded? A sum of positions stays a power if the exponent is at least `kept`. */
static bool power_multiplies_out(const poly *base, double exponent, double kept) {
    if (exponent <= 0.0 || !exponent_is_whole(exponent) ||
        (exponent >= kept && poly_is_place(base))) {
        return false;
    }
    int terms = 1;
    for (int i = 0; i < (int)exponent && base->count > 1 && terms <= POWER_TERMS_MAX; i++) {
        terms *= base->count;
    }
    return terms <= POWER_TERMS_MAX;
}

/* === the limit of work ======================================================================== */

/* Largest work of a derivation, counted in bytes. This much work takes about half a minute. An arm with six joints and
 * no zero lengths needs 0.42e9 bytes. */
#define WORK_MAX ((size_t)1 << 29)
/* Processing one term counts as this many bytes of work. */
#define WORK_OF_TERM 2U

static void count_bytes(algebra *a, size_t bytes) {
    a->work += bytes;
    if (a->work > WORK_MAX) {
        a->overflow = true;
    }
}

static void count_terms(algebra *a, size_t terms) { count_bytes(a, terms * WORK_OF_TERM); }

/* === sums of many polys ======================================================================= */
/* Adding polys one by one would build and store every partial sum, so the terms are collected first. */

static void push(poly_sum *s, const mono *m, double coefficient) {
    if (s->count == s->room) {
        s->room = s->room == 0 ? 64 : s->room * 2;
        s->items = alloc_more(s->items, (int64_t)s->room, sizeof *s->items);
    }
    s->items[s->count] = (sum_item){m, coefficient, s->count};
    s->count++;
}

void sum_add(algebra *a, poly_sum *s, const poly *p, double scale) {
    count_terms(a, (size_t)p->count + 1);
    for (int i = 0; i < p->count && !a->overflow; i++) {
        push(s, p->terms[i].mono, folding_product(a->folding, p->terms[i].coefficient, scale));
    }
}

static int by_mono(const void *x, const void *y) {
    const sum_item *left = x;
    const sum_item *right = y;
    if (left->mono != right->mono) {
        return mono_order(left->mono, right->mono);
    }
    return left->turn < right->turn ? -1 : 1;
}

/* Sorts the terms. Adds terms that have the same `mono`, in the order in which they entered the sum. */
static void collect(folding *f, poly_sum *s) {
    if (s->count > 1) {
        qsort(s->items, s->count, sizeof *s->items, by_mono);
    }
    size_t kept = 0;
    for (size_t i = 0; i < s->count;) {
        sum_item sum = s->items[i++];
        for (; i < s->count && s->items[i].mono == sum.mono; i++) {
            sum.coefficient = coefficient_sum(f, sum.coefficient, s->items[i].coefficient);
        }
        if (sum.coefficient != 0.0) {
            s->items[kept++] = sum;
        }
    }
    s->count = kept;
}

const poly *sum_close(algebra *a, poly_sum *s) {
    collect(a->folding, s);
    poly *p = poly_scratch((int)s->count);
    for (size_t i = 0; i < s->count; i++) {
        p->terms[p->count++] = (poly_term){s->items[i].coefficient, s->items[i].mono};
    }
    const poly *made = poly_intern(a, p);
    free(p);
    free(s->items);
    *s = (poly_sum){0};
    return made;
}

/* === interning ================================================================================ */

/* Work of making an object, in bytes: its size on a 64-bit host, so that the limit is the same on every host. */
enum { ATOM_BYTES = 72, MONO_BYTES = 48, POLY_BYTES = 32, PART_BYTES = 16, PAIR_BYTES = 24 };

static void table_grow(intern_table *table) {
    const size_t size = table->size == 0 ? 1024 : table->size * 2;
    intern_slot *slots = alloc((int64_t)size, sizeof *slots);
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

/* Returns the slot of an equal object, or the empty slot for a new one. */
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

char *algebra_limit(const algebra *a) {
    return a->work > WORK_MAX ? alloc_words("more than %.0f MB of terms were made", 1e-6 * WORK_MAX)
                              : alloc_words("more than %.0f operands", POLY_SIZE_MAX);
}

/* Returns the number of a new object of `bytes` bytes. Its slots in the hash table count as 48 further bytes. */
static unsigned next_id(algebra *a, intern_table *table, size_t bytes) {
    count_bytes(a, bytes + 48);
    return (unsigned)table->count++;
}

algebra *algebra_new(void) {
    algebra *a = alloc(1, sizeof *a);
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

void *algebra_room(algebra *a, int count, size_t size) {
    return arena_alloc(a->arena, (size_t)count * size);
}

folding *algebra_folding(const algebra *a) { return a->folding; }

folding *algebra_fold(algebra *a, folding *f) {
    folding *const before = a->folding;
    a->folding = f;
    return before;
}

bool algebra_overflow(const algebra *a) { return a->overflow; }

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

static const atom *atom_of_polys(algebra *a, atom_kind kind, function_id function, const poly *x,
                                 const poly *y) {
    const atom candidate = {.kind = kind,
                            .function = function,
                            .argument = {x, y},
                            .symbols = x->symbols | (y == NULL ? 0 : y->symbols),
                            .keeps_powers = x->keeps_powers || (y != NULL && y->keeps_powers),
                            .size = 1.0 + x->size + (y == NULL ? 0.0 : y->size)};
    return atom_intern(a, &candidate);
}

static bool mono_equal(const void *x, const void *y) {
    const mono *left = x;
    const mono *right = y;
    if (left->count != right->count || left->trig != right->trig || left->angle != right->angle) {
        return false;
    }
    for (int i = 0; i < left->count; i++) {
        if (left->factors[i].atom != right->factors[i].atom ||
            number_bits(left->factors[i].exponent) != number_bits(right->factors[i].exponent)) {
            return false;
        }
    }
    return true;
}

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
                        number_bits(candidate->factors[i].exponent));
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

mono *mono_scratch(int factors) { return alloc_tail(sizeof(mono), factors, sizeof(mono_factor)); }

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

static bool poly_equal(const void *x, const void *y) {
    const poly *left = x;
    const poly *right = y;
    if (left->count != right->count) {
        return false;
    }
    for (int i = 0; i < left->count; i++) {
        if (left->terms[i].mono != right->terms[i].mono ||
            number_bits(left->terms[i].coefficient) != number_bits(right->terms[i].coefficient)) {
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
                        number_bits(candidate->terms[i].coefficient));
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

poly *poly_scratch(int terms) { return alloc_tail(sizeof(poly), terms, sizeof(poly_term)); }

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

/* === sums, products and powers ================================================================ */

/* The product of two sums is multiplied out if it has at most this many products of terms. */
#define PRODUCT_TERMS_MAX 400000
/* A power of a sum of positions is not expanded if its exponent is whole and at least this: the expanded (x - b)^3
 * would lose its digits near x = b. Squares are expanded, so that equal sums of squares have the same form. */
#define POWER_KEPT 3.0

const poly *poly_of_atom(algebra *a, const atom *x, double exponent) {
    const mono_factor one = {x, exponent};
    return poly_of_term(a, 1.0, mono_make(a, &one, 1, TRIG_NONE, NULL));
}

const poly *poly_symbol(algebra *a, const symbol *sym, int primes) {
    return poly_of_atom(a, atom_symbol(a, sym, primes), 1.0);
}

bool poly_may_contain(const poly *p, const symbol *sym, int primes) {
    return (p->symbols & symbol_bit(sym, primes)) != 0;
}

static const poly *sum_of_two(algebra *a, const poly *left, const poly *right, double scale) {
    poly_sum sum = {0};
    sum_add(a, &sum, left, 1.0);
    sum_add(a, &sum, right, scale);
    return sum_close(a, &sum);
}

const poly *poly_add(algebra *a, const poly *left, const poly *right) {
    return sum_of_two(a, left, right, 1.0);
}

const poly *poly_sub(algebra *a, const poly *left, const poly *right) {
    return sum_of_two(a, left, right, -1.0);
}

const poly *poly_scale(algebra *a, const poly *p, double scale) {
    return scale == 0.0 ? a->zero : poly_each_number(a, p, folding_product, scale);
}

const poly *poly_each_number(algebra *a, const poly *p,
                             double (*change)(folding *f, double number, double by), double by) {
    count_terms(a, (size_t)p->count);
    poly *changed = poly_scratch(p->count);
    /* the terms stay sorted, because only their coefficients change */
    for (int i = 0; i < p->count; i++) {
        const double number = change(a->folding, p->terms[i].coefficient, by);
        if (number != 0.0) {
            changed->terms[changed->count++] = (poly_term){number, p->terms[i].mono};
        }
    }
    const poly *made = poly_intern(a, changed);
    free(changed);
    return made;
}

static const poly *trig_of(algebra *a, trig kind, const poly *angle) {
    double value;
    if (poly_is_number(angle, &value)) {
        return poly_number(
            a, folding_call(a->folding, kind == TRIG_SIN ? FN_SIN : FN_COS, value, 0.0));
    }
    double sign = 1.0;
    if (angle->terms[0].coefficient < 0.0) {
        angle = poly_scale(a, angle, -1.0);
        sign = kind == TRIG_SIN ? -1.0 : 1.0;
    }
    return poly_of_term(a, sign, mono_make(a, NULL, 0, kind, angle));
}

const poly *poly_sin(algebra *a, const poly *angle) { return trig_of(a, TRIG_SIN, angle); }
const poly *poly_cos(algebra *a, const poly *angle) { return trig_of(a, TRIG_COS, angle); }

/* trig(x) * trig(y) as a sum of sines or cosines of x + y and x - y. */
static const poly *trig_product(algebra *a, trig left, const poly *x, trig right, const poly *y) {
    const poly *plus = poly_add(a, x, y);
    const poly *minus = poly_sub(a, x, y);
    const poly *p;
    if (left == TRIG_COS && right == TRIG_COS) {
        p = poly_add(a, poly_cos(a, minus), poly_cos(a, plus));
    } else if (left == TRIG_SIN && right == TRIG_SIN) {
        p = poly_sub(a, poly_cos(a, minus), poly_cos(a, plus));
    } else if (left == TRIG_SIN) {
        p = poly_add(a, poly_sin(a, plus), poly_sin(a, minus));
    } else {
        p = poly_sub(a, poly_sin(a, plus), poly_sin(a, minus));
    }
    return poly_scale(a, p, 0.5);
}

/* Expands a power of an absolute value or of a group. Returns NULL if the power stays as it is. */
static const poly *power_expands(algebra *a, const mono_factor *f) {
    if (f->atom->kind == ATOM_CALL && f->atom->function == FN_ABS && f->exponent >= 2.0) {
        const poly *inside = f->atom->argument[0];
        const double even = 2.0 * number_floor(f->exponent / 2.0);
        const poly *opened = even == 2.0 ? poly_mul(a, inside, inside) : poly_pow(a, inside, even);
        return f->exponent == even
                   ? opened
                   : poly_mul(a, opened, poly_of_atom(a, f->atom, f->exponent - even));
    }
    if (f->atom->kind == ATOM_GROUP && exponent_is_whole(f->exponent) && f->exponent > 0.0) {
        const poly *inside = f->atom->argument[0];
        if (f->exponent == 1.0 || power_multiplies_out(inside, f->exponent, POWER_KEPT)) {
            return poly_pow(a, inside, f->exponent);
        }
    }
    return NULL;
}

/* The product of two products. It has several terms if sines are multiplied or a group is expanded. */
static const poly *mono_product(algebra *a, const mono *left, const mono *right) {
    mono *product = mono_scratch(left->count + right->count);
    const poly *extra = NULL;
    int i = 0;
    int j = 0;
    while (i < left->count || j < right->count) {
        const int order = i >= left->count ? 1
                          : j >= right->count
                              ? -1
                              : atom_order(left->factors[i].atom, right->factors[j].atom);
        mono_factor f;
        if (order < 0) {
            f = left->factors[i++];
        } else if (order > 0) {
            f = right->factors[j++];
        } else {
            f = left->factors[i++];
            f.exponent += right->factors[j++].exponent;
            if (fabs(f.exponent) < 1e-12) {
                continue;
            }
            const poly *opened = power_expands(a, &f);
            if (opened != NULL) {
                extra = extra == NULL ? opened : poly_mul(a, extra, opened);
                continue;
            }
        }
        product->factors[product->count++] = f;
    }
    const bool both = left->trig != TRIG_NONE && right->trig != TRIG_NONE;
    if (!both) {
        const mono *with = left->trig != TRIG_NONE ? left : right;
        product->trig = with->trig;
        product->angle = with->angle;
    }
    const poly *result = poly_of_term(a, 1.0, mono_intern(a, product));
    free(product);
    if (both) {
        const poly *sum = trig_product(a, left->trig, left->angle, right->trig, right->angle);
        result = poly_mul(a, result, sum);
    }
    return extra == NULL ? result : poly_mul(a, result, extra);
}

static const atom *group_of(algebra *a, const poly *p) {
    return atom_of_polys(a, ATOM_GROUP, FUNCTION_NONE, p, NULL);
}

static const poly *product_of(algebra *a, const poly *left, const poly *right) {
    if (left->count > 1 && right->count > 1 &&
        (double)left->count * right->count > PRODUCT_TERMS_MAX) {
        return poly_mul(a, left, poly_of_atom(a, group_of(a, right), 1.0));
    }
    poly_sum sum = {0};
    poly_sum row = {0};
    for (int i = 0; i < left->count && !a->overflow; i++) {
        for (int j = 0; j < right->count && !a->overflow; j++) {
            const poly *p = mono_product(a, left->terms[i].mono, right->terms[j].mono);
            sum_add(a, &row, p,
                    folding_product(a->folding, left->terms[i].coefficient,
                                    right->terms[j].coefficient));
        }
        collect(a->folding, &row);
        for (size_t k = 0; k < row.count; k++) {
            push(&sum, row.items[k].mono, row.items[k].coefficient);
        }
        row.count = 0;
    }
    free(row.items);
    return sum_close(a, &sum);
}

const poly *poly_mul(algebra *a, const poly *left, const poly *right) {
    double value;
    if (poly_is_number(left, &value)) {
        return poly_scale(a, right, value);
    }
    if (poly_is_number(right, &value)) {
        return poly_scale(a, left, value);
    }
    if (a->overflow) {
        return a->zero;
    }
    /* Sorts the operands, so that a * b and b * a are rounded equally. */
    if (poly_order(right, left) < 0) {
        const poly *swap = left;
        left = right;
        right = swap;
    }
    const poly *known = memo_get(&a->products, left, right);
    if (known == NULL) {
        known = product_of(a, left, right);
        memo_put(a, &a->products, left, right, known);
    }
    return known;
}

/* Uses only rules that hold for every real x: (x^2)^(1/2) does not become x, because it is |x|. */
static const poly *term_pow(algebra *a, const poly_term *t, double exponent) {
    const mono *m = t->mono;
    const bool whole = exponent_is_whole(exponent);
    if (whole && m->trig == TRIG_NONE) {
        mono_factor *f = alloc(m->count, sizeof *f);
        const poly *extra = a->one;
        int count = 0;
        for (int i = 0; i < m->count; i++) {
            f[count] = (mono_factor){m->factors[i].atom, m->factors[i].exponent * exponent};
            const poly *opened = power_expands(a, &f[count]);
            if (opened != NULL) {
                extra = poly_mul(a, extra, opened);
            } else {
                count++;
            }
        }
        const mono *powered = mono_make(a, f, count, TRIG_NONE, NULL);
        free(f);
        return poly_mul(
            a, poly_of_term(a, folding_power(a->folding, t->coefficient, exponent), powered),
            extra);
    }
    if (whole && exponent > 0.0 && exponent <= 16.0) {
        const poly *base = poly_of_term(a, t->coefficient, m);
        const poly *half = poly_pow(a, base, number_floor(exponent / 2.0));
        const poly *even = poly_mul(a, half, half);
        return number_remainder(exponent, 2.0) == 0.0 ? even : poly_mul(a, even, base);
    }
    if (whole && m->count > 0) { /* 1/(r cos a) = 1/r * 1/(cos a) */
        const mono *plain = mono_make(a, m->factors, m->count, TRIG_NONE, NULL);
        const mono *wave = mono_make(a, NULL, 0, m->trig, m->angle);
        return poly_mul(a, poly_pow(a, poly_of_term(a, t->coefficient, plain), exponent),
                        poly_pow(a, poly_of_term(a, 1.0, wave), exponent));
    }
    /* A fractional power of a negative coefficient is not real, so the sign stays inside. */
    const double sign = t->coefficient < 0.0 ? -1.0 : 1.0;
    const double outside = whole ? folding_power(a->folding, t->coefficient, exponent)
                                 : folding_power(a->folding, fabs(t->coefficient), exponent);
    const poly *inside = poly_of_term(a, whole ? 1.0 : sign, m);
    if (m->count == 1 && m->trig == TRIG_NONE && m->factors[0].exponent == 1.0 && sign > 0.0) {
        return poly_scale(a, poly_of_atom(a, m->factors[0].atom, exponent), outside);
    }
    return poly_scale(a, poly_of_atom(a, group_of(a, inside), exponent), outside);
}

const poly *poly_power(algebra *a, const poly *base, double exponent, double kept) {
    double value;
    if (exponent == 0.0) {
        return a->one;
    }
    if (exponent == 1.0) {
        return base;
    }
    if (poly_is_number(base, &value)) {
        return poly_number(a, folding_power(a->folding, value, exponent));
    }
    if (base->count == 1) {
        return term_pow(a, &base->terms[0], exponent);
    }
    if (power_multiplies_out(base, exponent, kept)) {
        const poly *p = base;
        for (int i = 1; i < (int)exponent; i++) {
            p = poly_mul(a, p, base);
        }
        return p;
    }
    /* The base is divided by one coefficient, so that sums that differ only by a factor become equal. */
    const bool whole = exponent_is_whole(exponent);
    const bool constant = base->terms[0].mono->count == 0 && base->terms[0].mono->trig == TRIG_NONE;
    const double size = base->terms[constant && whole && exponent > 0.0 ? 1 : 0].coefficient;
    const double outside = whole ? size : fabs(size);
    const poly *inside = poly_scale(a, base, 1.0 / outside);
    return poly_scale(a, poly_of_atom(a, group_of(a, inside), exponent),
                      number_power(outside, exponent));
}

const poly *poly_pow(algebra *a, const poly *base, double exponent) {
    return poly_power(a, base, exponent, POWER_KEPT);
}

const poly *poly_pow_poly(algebra *a, const poly *base, const poly *exponent) {
    double value;
    if (poly_is_number(exponent, &value)) {
        return poly_pow(a, base, value);
    }
    return poly_of_atom(a, atom_of_polys(a, ATOM_POWER, FUNCTION_NONE, base, exponent), 1.0);
}

const poly *poly_call(algebra *a, function_id function, const poly *x, const poly *y) {
    double vx;
    double vy = 0.0;
    if (poly_is_number(x, &vx) && (y == NULL || poly_is_number(y, &vy))) {
        return poly_number(a, folding_call(a->folding, function, vx, vy));
    }
    /* Sine, cosine and square root have normal forms of their own; other functions are atoms. */
    if (function == FN_SIN) {
        return poly_sin(a, x);
    }
    if (function == FN_COS) {
        return poly_cos(a, x);
    }
    if (function == FN_SQRT) {
        return poly_pow(a, x, 0.5);
    }
    return poly_of_atom(a, atom_of_polys(a, ATOM_CALL, function, x, y), 1.0);
}
