/* tables.c: see tables.h. */
#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/table.h"
#include "host/base/room.h"
#include "table_numbers.h"
#include "turn_function.h"

/* Where it is tried of what kind a coefficient is; sums and multiples of an angle are told apart by less. */
enum { TRIES = 4096 };

/* Of the size that it would have if nothing cancelled: what is less is nothing, or the same. */
#define ALIKE 1e-13

/* A divisor that comes as near to zero as this, of its largest, is taken to reach it. */
#define POLE 1e-6

typedef enum coefficient_kind { IS_NOTHING, IS_CONSTANT, IS_TABLE } coefficient_kind;

/* What stands before a product. */
typedef struct coefficient {
    int of; /* operation of the coefficients' list */
    coefficient_kind kind;
    int table;
    double factor; /* of the table, or the constant */
    double *value; /* [TRIES] */
    double size;   /* the largest of its sizes there */
} coefficient;

typedef struct tabling {
    products *from;
    refusal *why;
    int *turns;               /* [angles] of the phase that is looked up */
    int *multiple;            /* [coefficients->count] of that, by phase */
    coefficient *coefficient; /* [count]: the products', one result's behind the other's */
    int count;
    int *table; /* [tables] operations of the coefficients' list */
    int tables;
} tabling;

int tables_cells(image_tables form) {
    return form == TABLES_CUBIC ? TABLES_CELLS_CUBIC : TABLES_CELLS_LINEAR;
}

static void refuse(tabling *t, const char *reason, const char *hint, int angle) {
    if (t->why->reason == NULL) {
        *t->why = (refusal){reason, hint, angle};
    }
}

/* --- which phase is looked up ------------------------------------------------------------------------*/

static int divisor_of(int a, int b) {
    a = abs(a);
    b = abs(b);
    while (b != 0) {
        const int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* The first angle with a part in it. */
static int leading(const int *turns, int angles) {
    int k = 0;
    while (k < angles - 1 && turns[k] == 0) {
        k++;
    }
    return k;
}

/* Are both multiples of one phase? Then *turns becomes the largest such phase. */
static bool shares(int *turns, const int *other, int angles) {
    const int k = leading(turns, angles);
    const int common = divisor_of(turns[k], other[k]);
    for (int i = 0; i < angles; i++) {
        if ((int64_t)turns[i] * other[k] != (int64_t)other[i] * turns[k]) {
            return false;
        }
    }
    const int before = turns[k];
    for (int i = 0; i < angles; i++) {
        turns[i] = (int)((int64_t)turns[i] * common / abs(before));
    }
    return true;
}

/* An angle that is in the other phase and not in this one, or its first. */
static int angle_of_other(const int *turns, const int *other, int angles) {
    for (int k = 0; k < angles; k++) {
        if (other[k] != 0 && turns[k] == 0) {
            return k;
        }
    }
    return leading(other, angles);
}

static void find_phase(tabling *t) {
    const tape *c = t->from->coefficients;
    bool found = false;
    for (int i = 0; i < c->count && t->why->reason == NULL; i++) {
        const int *turns = c->ops[i].turns;
        if (!tape_is_wave(&c->ops[i])) {
            continue;
        }
        if (!found) {
            memcpy(t->turns, turns, (size_t)c->angles * sizeof *turns);
            found = true;
        } else if (!shares(t->turns, turns, c->angles)) {
            refuse(t, "depend on the sines of more than one turn angle",
                   "a table is looked up by one angle, or by one sum of them: leave --tables out",
                   angle_of_other(t->turns, turns, c->angles));
        }
    }
    const int k = leading(t->turns, c->angles);
    if (!found) {
        refuse(t, "depend on no turn angle: there is nothing to look up", "leave --tables out", -1);
        return;
    }
    for (int i = 0; i < c->count; i++) {
        t->multiple[i] = tape_is_wave(&c->ops[i]) ? c->ops[i].turns[k] / t->turns[k] : 0;
    }
}

/* --- constants, poles, and what differs by a factor ----------------------------------------------------*/

typedef struct span_of {
    double least;
    double most;
} span_of;

/* All of their values, and the poles. */
static void try_angles(tabling *t) {
    const tape *c = t->from->coefficients;
    turn_value *value = room(c->count, sizeof *value);
    span_of *span = room(c->count, sizeof *span);
    bool finite = true;
    for (int s = 0; s < TRIES; s++) {
        turn_evaluate(c, t->multiple, (double)s / TRIES, value);
        for (int i = 0; i < c->count; i++) {
            span[i].least = s > 0 ? number_least(span[i].least, value[i].value) : value[i].value;
            span[i].most = s > 0 ? number_most(span[i].most, value[i].value) : value[i].value;
        }
        for (int k = 0; k < t->count; k++) {
            coefficient *of = &t->coefficient[k];
            of->value[s] = value[of->of].value;
            of->size = number_most(of->size, value[of->of].size);
            finite = finite && isfinite(of->value[s]) && isfinite(value[of->of].slope);
        }
    }
    for (int i = 0; i < c->count; i++) {
        const span_of by = c->ops[i].code == OP_DIV ? span[c->ops[i].b] : (span_of){1.0, 1.0};
        const double nearest = number_least(fabs(by.least), fabs(by.most));
        const double farthest = number_most(fabs(by.least), fabs(by.most));
        if (!(by.least * by.most > 0.0 && nearest > POLE * farthest)) {
            finite = false;
        }
    }
    if (!finite) {
        refuse(t, "have no value or no slope at some angle (a division by zero, a root of nothing)",
               "a table holds finite numbers: leave --tables out", -1);
    }
    free(value);
    free(span);
}

/* Where it is largest. */
static int peak_of(const coefficient *c) {
    int at = 0;
    for (int s = 1; s < TRIES; s++) {
        at = fabs(c->value[s]) > fabs(c->value[at]) ? s : at;
    }
    return at;
}

static bool is_constant(const coefficient *c) {
    for (int s = 0; s < TRIES; s++) {
        if (!(fabs(c->value[s] - c->value[0]) <= ALIKE * c->size)) {
            return false;
        }
    }
    return true;
}

/* Is c, which is largest at `peak`, a multiple of `of`? */
static bool is_multiple(const coefficient *c, int peak, const coefficient *of, double *factor) {
    *factor = of->value[peak] != 0.0 ? c->value[peak] / of->value[peak] : 0.0;
    const double size = c->size + fabs(*factor) * of->size;
    for (int s = 0; s < TRIES; s++) {
        if (!(fabs(c->value[s] - *factor * of->value[s]) <= ALIKE * size)) {
            return false;
        }
    }
    if (fabs(fabs(*factor) - 1.0) <= ALIKE) {
        *factor = *factor < 0.0 ? -1.0 : 1.0;
    }
    return *factor != 0.0;
}

static void sort_out(tabling *t) {
    int *first = room(t->count, sizeof *first); /* by table */
    for (int k = 0; k < t->count; k++) {
        coefficient *c = &t->coefficient[k];
        const int peak = peak_of(c);
        c->kind = IS_TABLE;
        c->table = -1;
        if (fabs(c->value[peak]) <= ALIKE * c->size) {
            c->kind = IS_NOTHING;
        } else if (is_constant(c)) {
            c->kind = IS_CONSTANT;
            c->factor = c->value[0];
        }
        for (int i = 0; i < t->tables && c->kind == IS_TABLE && c->table < 0; i++) {
            if (is_multiple(c, peak, &t->coefficient[first[i]], &c->factor)) {
                c->table = i;
            }
        }
        if (c->kind == IS_TABLE && c->table < 0) {
            c->factor = 1.0;
            c->table = t->tables;
            first[t->tables] = k;
            t->table[t->tables++] = c->of;
        }
    }
    free(first);
}

/* --- the list --------------------------------------------------------------------------------------*/

/* A product that is left to be summed up. */
typedef struct part {
    int coefficient; /* operation of the new list */
    unsigned char *power;
} part;

typedef struct writing {
    const products *from;
    const tape *list;
    tape *made;
    bool nested;
} writing;

static int symbol_of(const writing *w, int symbol) {
    const op *o = &w->list->ops[w->from->symbol[symbol]];
    return tape_leaf(w->made, o->code, o->a);
}

static int product_of(const writing *w, const part *p) {
    int made = tape_constant(w->made, 1.0);
    for (int s = 0; s < w->from->symbols; s++) {
        if (p->power[s] > 0) {
            made = tape_mul(w->made, made, tape_power(w->made, symbol_of(w, s), p->power[s]));
        }
    }
    return tape_mul(w->made, p->coefficient, made);
}

/* The symbol that most of the parts have, if that is more than one of them; or -1. */
static int commonest(const writing *w, const part *parts, int count) {
    int best = -1;
    int most = 1;
    for (int s = 0; s < w->from->symbols; s++) {
        int have = 0;
        for (int i = 0; i < count; i++) {
            have += parts[i].power[s] > 0;
        }
        if (have > most) {
            most = have;
            best = s;
        }
    }
    return best;
}

/* The sum of parts[count], which are used up. Nested: what several have is taken out of them. */
static int sum_up(const writing *w, part *parts, int count) {
    const int common = w->nested ? commonest(w, parts, count) : -1;
    int with = 0;
    int sum = tape_constant(w->made, 0.0);
    for (int i = 0; i < count && common >= 0; i++) {
        if (parts[i].power[common] > 0) {
            const part first = parts[with];
            parts[with] = parts[i];
            parts[i] = first;
            parts[with++].power[common]--;
        }
    }
    if (with > 0) {
        const int inner = sum_up(w, parts, with); /* one power less each time */
        sum = tape_mul(w->made, symbol_of(w, common), inner);
        return tape_add(w->made, sum, sum_up(w, parts + with, count - with));
    }
    for (int i = 0; i < count; i++) {
        sum = tape_add(w->made, sum, product_of(w, &parts[i]));
    }
    return sum;
}

static int write_result(const tabling *t, const writing *w, int cell, int result, int at) {
    const product_sum *sum = &t->from->result[result];
    const size_t powers = (size_t)t->from->symbols + 1U;
    part *parts = room(sum->count, sizeof *parts);
    unsigned char *power = room((int64_t)sum->count, powers);
    int count = 0;
    for (int i = 0; i < sum->count; i++) {
        const coefficient *c = &t->coefficient[at + i];
        if (c->kind != IS_NOTHING) {
            const int factor = tape_constant(w->made, c->factor);
            part *p = &parts[count];
            p->power = power + (size_t)count++ * powers;
            memcpy(p->power, sum->product[i].power, (size_t)t->from->symbols);
            p->coefficient = c->kind == IS_CONSTANT
                                 ? factor
                                 : tape_mul(w->made, factor, tape_look_up(w->made, cell, c->table));
        }
    }
    const int made = sum_up(w, parts, count);
    free(parts);
    free(power);
    return made;
}

static tape *write_list(const tabling *t, const tape *list, image_tables form, int bits,
                        bool nested) {
    tape *made = tape_new(list->angles, list->results);
    const writing w = {t->from, list, made, nested};
    tape_tables_new(made, t->tables, bits,
                    (int)(form == TABLES_CUBIC ? WH_TABLE_CUBIC : WH_TABLE_LINEAR));
    const int cell = tape_cell(made, t->turns);
    int at = 0;
    for (int i = 0; i < list->results; i++) {
        made->result[i] = write_result(t, &w, cell, i, at);
        at += t->from->result[i].count;
    }
    tape_prune(made);
    return made;
}

/* The cheaper one of both ways to write it. */
static tape *cheaper(const tabling *t, const tape *list, image_tables form, int bits) {
    tape *made[2];
    for (int k = 0; k < 2; k++) {
        made[k] = write_list(t, list, form, bits, k > 0);
    }
    const int taken = tape_weight(made[1]) < tape_weight(made[0]);
    tape_free(made[1 - taken]);
    const table_functions functions = {t->from->coefficients, t->multiple, t->table};
    table_numbers(&functions, &made[taken]->tables);
    tape_order(made[taken]);
    return made[taken];
}

/* The coefficients' list becomes that of what the tables hold. */
static tape *take_exact(tabling *t) {
    tape *exact = t->from->coefficients;
    t->from->coefficients = NULL;
    free(exact->result);
    exact->result = t->table;
    exact->results = t->tables;
    t->table = NULL;
    tape_prune(exact);
    return exact;
}

static void take_coefficients(tabling *t) {
    for (int i = 0; i < t->from->results; i++) {
        t->count += t->from->result[i].count;
    }
    t->coefficient = room(t->count, sizeof *t->coefficient);
    t->table = room(t->count, sizeof *t->table);
    for (int i = 0, at = 0; i < t->from->results; i++) {
        for (int k = 0; k < t->from->result[i].count; k++, at++) {
            t->coefficient[at].of = t->from->result[i].product[k].coefficient;
            t->coefficient[at].value = room(TRIES, sizeof *t->coefficient[at].value);
        }
    }
}

/* NULL where it was refused. */
static tape *make(tabling *t, const tape *list, image_tables form, int bits, tape **exact) {
    find_phase(t);
    if (t->why->reason != NULL) {
        return NULL;
    }
    take_coefficients(t);
    try_angles(t);
    if (t->why->reason != NULL) {
        return NULL;
    }
    sort_out(t);
    if (t->tables == 0) {
        refuse(t, "depend on no turn angle: there is nothing to look up", "leave --tables out", -1);
        return NULL;
    }
    tape *made = cheaper(t, list, form, bits);
    *exact = take_exact(t);
    return made;
}

tape *tables_make(const tape *list, image_tables form, int cells, tape **exact, refusal *why) {
    products p = products_of(list, why);
    tabling t = {.from = &p,
                 .why = why,
                 .turns = room(list->angles, sizeof *t.turns),
                 .multiple = room(p.coefficients->count, sizeof *t.multiple)};
    int bits = 0;
    while ((1 << bits) < cells) {
        bits++;
    }
    tape *made = why->reason == NULL ? make(&t, list, form, bits, exact) : NULL;
    for (int k = 0; k < t.count; k++) {
        free(t.coefficient[k].value);
    }
    free(t.coefficient);
    free(t.table);
    free(t.turns);
    free(t.multiple);
    products_free(&p);
    return made;
}
