/* ledger_lists.c: entry of the ledger's lists. */
#include "ledger_lists.h"

#include <stdlib.h>

#include "core/step/ledger_step.h"
#include "host/base/alloc.h"
#include "host/derive/equations.h"

static void add_entry(ledger_lists *l, const poly **power, ledger_kind kind, const place *at,
                      int account, const poly *what) {
    if (!poly_is_zero(what)) {
        l->entry[l->smooth] = (ledger_entry){kind, at, account};
        power[l->smooth++] = what;
    }
}

/* An input with a rate has no momentum, so its account has no entries. */
static bool is_driven(const layout *map, int i) {
    return map->equations->unknowns[i].symbol->driven != NULL;
}

/* The entries of one statement. */
static void add_statement(ledger_lists *l, const layout *map, const statement_force *of,
                          const poly **power) {
    const bool drives = of->from->kind == TERM_Q;
    for (int account = 1; account < l->accounts; account++) {
        if (!is_driven(map, l->unknown[account])) {
            add_entry(l, power, drives ? LEDGER_DRIVE : LEDGER_DAMPING, &of->from->at, account,
                      layout_ready(map, of->force[l->unknown[account]]));
        }
    }
    add_entry(l, power, drives ? LEDGER_WORK : LEDGER_LOSS, &of->from->at, 0,
              layout_ready(map, of->power));
}

static void order_accounts(ledger_lists *l, const layout *map) {
    int conserved = 1 + map->coordinates;
    l->unknown[0] = -1;
    for (int i = 0; i < map->equations->count; i++) {
        l->unknown[map->place[i] >= 0 ? 1 + map->place[i] : conserved++] = i;
    }
}

/* The continuous entries, between events. */
static const poly **smooth_entries(ledger_lists *l, const layout *map) {
    const equations *e = map->equations;
    algebra *a = e->algebra;
    const int most = e->count + e->forces * (1 + e->count);
    const poly **power = alloc(most, sizeof(const poly *));
    const poly *lagrangian = poly_sub(a, e->kinetic, e->stored);
    l->entry = alloc(most, sizeof *l->entry);
    for (int account = 1; account < l->accounts; account++) {
        const symbol *q = e->unknowns[l->unknown[account]].symbol;
        if (q->driven != NULL) {
            add_entry(l, power, LEDGER_WORK, &q->at, 0,
                      layout_ready(map, energy_drive(e, l->unknown[account])));
            continue;
        }
        const poly *force = poly_derivative(a, lagrangian, q, 0);
        add_entry(l, power, LEDGER_ENERGIES, NULL, account, layout_ready(map, force));
    }
    for (int k = 0; k < e->forces; k++) {
        add_statement(l, map, &e->force[k], power);
    }
    return power;
}

/* Inputs in the energies: their changes between steps are entries. */
static void find_inputs(ledger_lists *l, const layout *map) {
    const equations *e = map->equations;
    const poly *kinetic = layout_ready(map, e->kinetic);
    const poly *stored = layout_ready(map, e->stored);
    l->input = alloc(map->inputs, sizeof *l->input);
    for (int i = 0; i < map->inputs; i++) {
        const symbol *s = e->instance->mechanism->inputs[map->input[i]];
        if (poly_contains(kinetic, s, 0) || poly_contains(stored, s, 0)) {
            l->input[l->inputs++] = i;
        }
    }
}

static op_list *enter(layout *map, const poly *const *wanted, int count) {
    op_list *t = op_list_new(map->angles, count);
    lowering l = layout_lowering(map, t);
    lower_plan(&l, wanted, count);
    for (int i = 0; i < count; i++) {
        t->result[i] = lower(&l, wanted[i]);
    }
    lower_done(&l);
    op_list_prune(t);
    return t;
}

static op_list *make_levels(const ledger_lists *l, const poly *integral, layout *map) {
    const equations *e = map->equations;
    const poly **wanted = alloc(l->accounts, sizeof(const poly *));
    wanted[0] = layout_ready(map, integral != NULL ? integral
                                                   : poly_add(e->algebra, e->kinetic, e->stored));
    for (int account = 1; account < l->accounts; account++) {
        wanted[account] = layout_ready(map, e->momentum[l->unknown[account]]);
    }
    op_list *t = enter(map, wanted, l->accounts);
    free(wanted);
    return t;
}

/* Can this scene have a ledger? */
static bool can_keep(const layout *map, diags *errors) {
    const mechanism *m = map->equations->instance->mechanism;
    if (m->is_system) {
        diag_error(errors, m->at, "leave out the ledger",
                   "'%s' is given by equations: there are no energies to keep books of", m->name);
        return false;
    }
    if (map->form != WH_SECOND_ORDER) {
        diag_error(errors, m->at, "integrate the coordinate: --without conserve",
                   "a coordinate that must be integrated from its momentum cannot be conserved "
                   "beside a ledger");
        return false;
    }
    return true;
}

ledger_lists *ledger_lists_make(layout *map, const poly *integral, int contacts, diags *errors) {
    const equations *e = map->equations;
    if (!can_keep(map, errors)) {
        return NULL;
    }
    ledger_lists *l = alloc(1, sizeof *l);
    l->accounts = 1 + e->count;
    l->unknown = alloc(l->accounts, sizeof *l->unknown);
    order_accounts(l, map);
    const poly **power = smooth_entries(l, map);
    l->entries = l->smooth + contacts * (1 + map->coordinates);
    find_inputs(l, map);
    l->entries += l->inputs;
    const bool good = l->entries <= WH_LEDGER_MAX;
    if (good) {
        l->powers = enter(map, power, l->smooth);
        l->levels = make_levels(l, integral, map);
        /* an angle that the equations have only inside sines with whole factors, but a power has elsewhere */
        l->turned = op_list_reads_turns(l->powers);
    }
    if (!good) {
        diag_error(errors, e->instance->mechanism->at, "leave out the ledger",
                   "the books of '%s' cannot be kept: there are too many entries",
                   e->instance->mechanism->name);
        ledger_lists_free(l);
        l = NULL;
    }
    free(power);
    return l;
}

void ledger_lists_free(ledger_lists *l) {
    if (l == NULL) {
        return;
    }
    op_list_free(l->powers);
    op_list_free(l->levels);
    free(l->entry);
    free(l->unknown);
    free(l->input);
    free(l);
}
