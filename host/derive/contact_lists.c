/* contact_lists.c: folding contacts, and entering their lists. */
#include "contact_lists.h"

#include <stdlib.h>

#include "contacts.h"
#include "core/contact.h"
#include "core/hash.h"
#include "host/base/alloc.h"
#include "host/derive/equations.h"

#define SAME_KIND(id, ...) \
    _Static_assert((int)CONTACT_##id == (int)WH_##id, "the core handles contacts in this order");
CONTACT_KIND_ROWS(SAME_KIND)
#undef SAME_KIND

_Static_assert((int)CONTACTS_MAX == WH_CONTACTS_LIMIT && (int)SETS_MAX == WH_SETS_MAX,
               "the core has room for what a run may have");

/* Folded, and without conserved coordinates. */
static const poly *ready(const equations *e, const conservation *c, const poly *p) {
    return conservation_settle(e, c, equations_fold(e, p));
}

int contact_lists_polys(const equations *e, const conservation *c, const poly **p) {
    const contact_laws *laws = e->contacts;
    int count = 0;
    for (int k = 0; k < (laws != NULL ? laws->count : 0); k++) {
        const contact_law *law = &laws->law[k];
        const poly *const fixed[] = {law->value, law->speed, law->first, law->second, law->bias};
        const int sets = law->row == NULL ? law->from->set_count : 0;
        for (int i = 0; i < 5 + sets + (law->row != NULL ? e->count : 0); i++) {
            const poly *each = i < 5          ? fixed[i]
                               : i < 5 + sets ? laws->sets[k].value[i - 5]
                                              : law->row[i - 5 - sets];
            if (p != NULL) {
                p[count] = ready(e, c, each);
            }
            count++;
        }
    }
    return count;
}

/* A list that computes `wanted` [count]. */
static op_list *enter(layout *map, const poly *const *wanted, int count) {
    op_list *t = op_list_new(map->angles, count);
    lowering l = layout_lowering(map, t);
    const poly **p = alloc(count, sizeof(const poly *));
    for (int i = 0; i < count; i++) {
        p[i] = layout_ready(map, wanted[i]);
    }
    lower_plan(&l, p, count);
    for (int i = 0; i < count; i++) {
        t->result[i] = lower(&l, p[i]);
    }
    lower_done(&l);
    free(p);
    op_list_prune(t);
    return t;
}

static op_list *make_signals(layout *map) {
    const contact_laws *laws = map->equations->contacts;
    const poly **wanted = alloc(2 * laws->count, sizeof(const poly *));
    for (int k = 0; k < laws->count; k++) {
        wanted[2 * k] = laws->law[k].value;
        wanted[2 * k + 1] = laws->law[k].speed;
    }
    op_list *t = enter(map, wanted, 2 * laws->count);
    free(wanted);
    return t;
}

static op_list *make_sets(layout *map) {
    const contact_laws *laws = map->equations->contacts;
    if (laws->set_count == 0) {
        return NULL;
    }
    const poly **wanted = alloc(laws->set_count, sizeof(const poly *));
    int count = 0;
    for (int k = laws->forced; k < laws->count; k++) {
        for (int i = 0; i < laws->law[k].from->set_count; i++) {
            wanted[count++] = laws->sets[k].value[i];
        }
    }
    op_list *t = enter(map, wanted, count);
    free(wanted);
    return t;
}

/* The rows and their responses M^-1 J^T, by the same elimination as the accelerations. */
static op_list *make_forces(layout *map, const linear_system *s) {
    const contact_laws *laws = map->equations->contacts;
    const int n = map->equations->count;
    const int stride = WH_LAW_ROWS + 2 * map->coordinates;
    op_list *t = op_list_new(map->angles, laws->forced * stride);
    int *pushed = alloc(n, sizeof *pushed);
    const poly **row = alloc(n + 3, sizeof(const poly *));
    linear_system load = *s;
    load.force = row;
    for (int k = 0; k < laws->forced; k++) {
        const contact_law *law = &laws->law[k];
        int *result = t->result + k * stride;
        lowering l = layout_lowering(map, t);
        for (int i = 0; i < n; i++) {
            const bool driven = map->equations->unknowns[i].symbol->driven != NULL;
            row[i] = driven ? poly_number(l.algebra, 0.0) : layout_ready(map, law->row[i]);
        }
        solve_highest(&l, &load, pushed);
        for (int i = 0; i < n; i++) { /* a driven coordinate moves the contact but is not pushed */
            row[i] = layout_ready(map, law->row[i]);
        }
        row[n + WH_LAW_FIRST] = layout_ready(map, law->first);
        row[n + WH_LAW_SECOND] = layout_ready(map, law->second);
        row[n + WH_LAW_BIAS] = layout_ready(map, law->bias);
        lower_plan(&l, row, n + 3);
        for (int i = 0; i < WH_LAW_ROWS; i++) {
            result[i] = lower(&l, row[n + i]);
        }
        for (int i = 0; i < n; i++) {
            if (map->place[i] >= 0) {
                result[WH_LAW_ROWS + map->place[i]] = lower(&l, row[i]);
                result[WH_LAW_ROWS + map->coordinates + map->place[i]] = pushed[i];
            }
        }
        lower_done(&l);
    }
    free(pushed);
    free(row);
    op_list_prune(t);
    return t;
}

/* The only scene coordinate with an entry in the row, if the entry is a number; else -1. */
static int pin_of(const layout *map, const contact_law *law) {
    int pin = -1;
    for (int i = 0; i < map->equations->count; i++) {
        const poly *entry = layout_ready(map, law->row[i]);
        double number;
        if (poly_is_zero(entry)) {
            continue;
        }
        if (pin >= 0 || !poly_is_number(entry, &number)) {
            return -1;
        }
        pin = map->place[i];
    }
    return pin;
}

/* The state component of an assignment, or -1: a conserved coordinate has none. */
static int component_of(const layout *map, const assignment *set) {
    const component *const lists[] = {map->angle, map->real};
    const int counts[] = {map->angles, map->reals};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < counts[k]; i++) {
            if (lists[k][i].unknown == set->symbol->index && lists[k][i].primes == set->primes) {
                return i + (k == 0 ? 0 : map->angles);
            }
        }
    }
    return -1;
}

/* 2: an input with a rate moves the stop; 1: another input moves it between steps; 0: it is fixed. */
static int stop_moves(const equations *e, const contact_law *law) {
    const mechanism *m = e->instance->mechanism;
    int moves = law->driven ? 2 : 0;
    for (int i = 0; i < m->input_count && moves == 0; i++) {
        moves = !poly_is_zero(poly_derivative(e->algebra, law->value, m->inputs[i], 0));
    }
    return moves;
}

static contact_row make_row(contact_lists *c, const layout *map, const contact_law *law) {
    const contact_statement *from = law->from;
    contact_row row = {.from = from, .kind = (int)from->kind, .pin = -1};
    row.direction = from->kind == CONTACT_WHEN ? from->direction : 0;
    row.first_set = c->set_count;
    if (from->kind != CONTACT_WHEN) {
        row.pin = pin_of(map, law);
        row.direction = from->kind == CONTACT_STOP   ? stop_moves(map->equations, law)
                        : from->kind != CONTACT_HOLD ? 0
                        : law->straight              ? 1
                                                     : -law->driven;
        row.first_set = from->kind == CONTACT_HOLD && row.pin < 0 ? c->held++ : 0;
        return row;
    }
    row.sets = from->set_count;
    for (int i = 0; i < from->set_count; i++) {
        c->target[c->set_count++] = component_of(map, &from->sets[i]);
    }
    return row;
}

/* Are all numbers in these expressions finite, with the parameters' values? `max` may hide an infinite one, so each
 * expression is checked in its original form. */
static bool are_finite(const equations *e, const expr *const *each, int count) {
    for (int i = 0; i < count; i++) {
        if (each[i] != NULL &&
            !poly_is_finite(equations_fold(e, poly_from_expr(e->algebra, each[i])))) {
            return false;
        }
    }
    return true;
}

/* Parameter values may produce 1/0: a contact would then have no defined side. */
static bool have_finite_laws(const equations *e, diags *errors) {
    static const char hint[] =
        "look for a division by zero, a root or logarithm of what is below it, "
        "or values that are too large";
    bool finite = true;
    for (int k = 0; k < e->contacts->count; k++) {
        const contact_statement *h = e->contacts->law[k].from;
        const expr *const each[] = {h->value,           h->restitution,      h->condition,
                                    h->static_friction, h->kinetic_friction, h->normal};
        if (!are_finite(e, each, (int)(sizeof each / sizeof each[0]))) {
            diag_error(errors, h->at, hint, "there is a number here that is not finite");
            finite = false;
        }
        for (int i = 0; i < h->set_count; i++) {
            if (!are_finite(e, &h->sets[i].value, 1)) {
                diag_error(errors, h->sets[i].at, hint,
                           "there is a number here that is not finite");
                finite = false;
            }
        }
    }
    return finite;
}

/* An impulse uses the mass matrix before it, so the matrix must not change during it. */
static bool have_impulses(const equations *e, diags *errors) {
    for (int k = 0; k < e->contacts->count; k++) {
        const contact_statement *h = e->contacts->law[k].from;
        if ((h->kind == CONTACT_STOP || h->kind == CONTACT_HOLD) && energy_mass_has_rates(e)) {
            diag_error(errors, h->at, "leave it out, or make T quadratic in the rates",
                       "what an impact does cannot be told: the inertia of '%s' depends on rates",
                       e->instance->mechanism->name);
            return false;
        }
    }
    return true;
}

contact_lists *contact_lists_make(layout *map, const linear_system *s, diags *errors) {
    const equations *e = map->equations;
    const contact_laws *laws = e->contacts;
    if (map->form != WH_SECOND_ORDER) {
        diag_error(errors, laws->law[0].from->at, "integrate the coordinate: --without conserve",
                   "a coordinate that must be integrated from its momentum cannot be conserved "
                   "beside stops, friction, holds or crossings");
        return NULL;
    }
    if (!have_impulses(e, errors) || !have_finite_laws(e, errors)) {
        return NULL;
    }
    contact_lists *c = alloc(1, sizeof *c);
    c->row = alloc(laws->count, sizeof *c->row);
    c->target = alloc(laws->set_count, sizeof *c->target);
    c->count = laws->count;
    c->forced = laws->forced;
    for (int k = 0; k < laws->count; k++) {
        c->row[k] = make_row(c, map, &laws->law[k]);
    }
    c->signals = make_signals(map);
    c->forces = make_forces(map, s);
    c->sets = make_sets(map);
    return c;
}

uint64_t contact_lists_hash(const contact_lists *c, uint64_t hash) {
    hash = wh_hash_u64(hash, op_list_hash(c->signals));
    hash = wh_hash_u64(hash, op_list_hash(c->forces));
    hash = c->sets != NULL ? wh_hash_u64(hash, op_list_hash(c->sets)) : hash;
    for (int k = 0; k < c->count; k++) {
        hash = wh_hash_u64(hash, (uint64_t)c->row[k].kind);
        hash = wh_hash_u64(hash, (uint64_t)(c->row[k].direction + 1));
    }
    for (int i = 0; i < c->set_count; i++) {
        hash = wh_hash_u64(hash, (uint64_t)c->target[i]);
    }
    return hash;
}

void contact_lists_free(contact_lists *c) {
    if (c == NULL) {
        return;
    }
    op_list_free(c->signals);
    op_list_free(c->forces);
    op_list_free(c->sets);
    free(c->row);
    free(c->target);
    free(c);
}
