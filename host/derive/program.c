/* program.c: entry of the lists. */
#include "program.h"

#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/derive/equations.h"
#include "host/derive/tables.h"
#include "noise_records.h"
#include "stabilizing.h"

/* --- the lists -----------------------------------------------------------------------------------*/

/* The derivative of a component of a first-order scene. */
static int slope_of(layout *map, lowering *l, component of, const int *highest) {
    const int k = map->conserved->number[of.unknown];
    if (k >= 0) {
        return lower(l, map->conserved->rate[k]);
    }
    const int up = of.primes + 1;
    if (up == map->equations->unknowns[of.unknown].order) {
        return highest[of.unknown];
    }
    return op_list_leaf(l->tape, OP_LINEAR, map->real_number[of.unknown * map->order_room + up]);
}

static op_list *make_step(layout *map, const linear_system *s) {
    const int n = map->equations->count;
    const int components = map->angles + map->reals;
    const bool second = map->form == WH_SECOND_ORDER;
    op_list *t = op_list_new(map->angles, second ? map->coordinates : components);
    int *highest = alloc(n, sizeof *highest);
    lowering l = layout_lowering(map, t);
    linear_system sparing = *s;
    sparing.sparing = map->equations->contacts == NULL;
    solve_highest(&l, &sparing, highest);
    for (int i = 0; i < n && second; i++) {
        if (map->place[i] >= 0) {
            t->result[map->place[i]] = highest[i];
        }
    }
    for (int c = 0; c < components && !second; c++) {
        const component of = c < map->angles ? map->angle[c] : map->real[c - map->angles];
        t->result[c] = slope_of(map, &l, of, highest);
    }
    lower_done(&l);
    free(highest);
    op_list_prune(t);
    if (sparing.sparing) {
        op_list_share_sums(t);
    }
    op_list_order(t);
    return t;
}

/* A list that first solves for the highest derivatives, then computes `wanted`. With `keep`, the
 * highest derivatives are the first results. */
static op_list *make_observer(layout *map, const linear_system *s, const poly *const *wanted,
                              int count, bool keep) {
    const equations *e = map->equations;
    const int n = e->count;
    const int first = keep ? n : 0;
    op_list *t = op_list_new(map->angles, first + count);
    int *highest = alloc(n, sizeof *highest);
    const poly **folded = alloc(count + e->instance->mechanism->noise_count, sizeof(const poly *));
    lowering l = layout_lowering(map, t);
    solve_highest(&l, s, highest);
    map->highest = highest;
    for (int i = 0; i < n && keep; i++) {
        t->result[i] = highest[i];
    }
    for (int i = 0; i < n && e->contacts != NULL; i++) {
        if (map->place[i] >= 0) { /* with the contacts' forces: the core has them */
            highest[i] = op_list_leaf(t, OP_ACCEL, map->place[i]);
        }
    }
    for (int i = 0; i < count; i++) {
        folded[i] = layout_ready(map, wanted[i]);
    }
    noise_records recorded = noise_records_find(e, map->conserved, folded, count);
    int planned = count;
    for (int k = 0; k < e->instance->mechanism->noise_count; k++) {
        if (recorded.exact[k] != NULL) {
            folded[planned++] = recorded.exact[k];
        }
    }
    lower_plan(&l, folded, planned);
    noise_records_lower(e, &l, &recorded);
    map->record = recorded.node;
    for (int i = 0; i < count; i++) {
        t->result[first + i] = lower(&l, folded[i]);
    }
    if (!keep) {
        noise_on_outputs(e, &l, t->result);
    }
    lower_done(&l);
    map->highest = NULL;
    map->record = NULL;
    noise_records_free(&recorded);
    free(highest);
    free(folded);
    op_list_prune(t);
    return t;
}

/* The mechanism's outputs, then value and rate of each conserved coordinate. */
static op_list *make_observe(const program *p, layout *map, const linear_system *s) {
    const equations *e = map->equations;
    const int own = e->instance->mechanism->output_count;
    const poly **wanted = alloc(p->outputs, sizeof(const poly *));
    for (int i = 0; i < own; i++) {
        wanted[i] = e->output[i];
    }
    for (int k = 0; k < p->conserved->count; k++) {
        const symbol *q = e->unknowns[p->conserved->unknown[k]].symbol;
        wanted[own + 2 * k] = poly_symbol(e->algebra, q, 0);
        wanted[own + 2 * k + 1] = poly_symbol(e->algebra, q, 1);
    }
    op_list *t = make_observer(map, s, wanted, p->outputs, false);
    free(wanted);
    return t;
}

static op_list *make_books(const program *p, layout *map, const linear_system *s) {
    const equations *e = map->equations;
    algebra *a = e->algebra;
    const int n = e->count;
    const poly **wanted = alloc(BOOK_MOMENTA + n + 1, sizeof *wanted);
    int count = 0;
    if (!e->instance->mechanism->is_system) {
        wanted[BOOK_KINETIC] = e->kinetic;
        wanted[BOOK_STORED] = e->stored;
        wanted[BOOK_INPUT_POWER] = forces_power(a, e->force, e->forces, TERM_Q);
        for (int i = 0; i < n; i++) {
            wanted[BOOK_INPUT_POWER] =
                e->unknowns[i].symbol->driven == NULL
                    ? wanted[BOOK_INPUT_POWER]
                    : poly_add(a, wanted[BOOK_INPUT_POWER], energy_drive(e, i));
        }
        wanted[BOOK_LOSS_POWER] = poly_scale(a, forces_power(a, e->force, e->forces, TERM_F), -1.0);
        for (int i = 0; i < n; i++) {
            wanted[BOOK_MOMENTA + i] = e->momentum[i];
        }
        count = BOOK_MOMENTA + n;
        if (p->integral != NULL) {
            wanted[count++] = p->integral;
        }
    }
    op_list *t = make_observer(map, s, wanted, count, true);
    free(wanted);
    return t;
}

/* Parameter values may produce 1/0, or a number that is too large: such a program cannot run. */
static bool lists_finite(const program *p, const equations *e, diags *errors) {
    static const char hint[] =
        "look for a division by zero, or values that are too large or too small";
    const mechanism *m = e->instance->mechanism;
    const contact_lists *c = p->contacts;
    const ledger_lists *l = p->ledger;
    const op_list *const lists[] = {p->step,
                                    p->books,
                                    c != NULL ? c->signals : NULL,
                                    c != NULL ? c->forces : NULL,
                                    c != NULL ? c->sets : NULL,
                                    l != NULL ? l->powers : NULL,
                                    l != NULL ? l->levels : NULL};
    bool finite = true;
    for (size_t i = 0; i < sizeof lists / sizeof lists[0] && finite; i++) {
        finite = lists[i] == NULL || op_list_not_finite(lists[i]) < 0;
    }
    const int output = finite ? op_list_not_finite(p->observe) : -1;
    if (output >= 0 && output < m->output_count) {
        diag_error(errors, m->outputs[output]->at, hint,
                   "output '%s' contains a number that is not finite", m->outputs[output]->name);
    } else if (!finite || output >= 0) {
        diag_error(errors, m->at, hint, "the equations of '%s' contain a number that is not finite",
                   m->name);
    }
    return finite && output < 0;
}

/* A step knows phases only. Coordinates whose turns the lists need are reals, so normally no list needs them. The
 * exception is a factor that grew too large while solving the equations. */
static bool steps_need_no_turns(const program *p, const equations *e, diags *errors) {
    const contact_lists *c = p->contacts;
    const op_list *const lists[] = {p->step, c != NULL ? c->signals : NULL,
                                    c != NULL ? c->forces : NULL, c != NULL ? c->sets : NULL};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        if (lists[i] != NULL && op_list_reads_turns(lists[i])) {
            diag_error(errors, e->instance->mechanism->at, "take smaller multiples of the angles",
                       "the equations of '%s' contain too large a multiple of an angle",
                       e->instance->mechanism->name);
            return false;
        }
    }
    return true;
}

program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors) {
    const int n = e->count;
    const mechanism *m = e->instance->mechanism;
    program *p = alloc(1, sizeof *p);
    p->conserved = conservation_make(e, conserve, errors);
    if (p->conserved == NULL) {
        program_free(p);
        return NULL;
    }
    const int polys = n * n + n;
    const int more = contact_lists_polys(e, p->conserved, NULL);
    const poly **dynamics = alloc(polys + more, sizeof(const poly *));
    bool *turning = alloc(n, sizeof *turning);
    bool *wanted = alloc(n, sizeof *wanted);
    const symbol **symbols = alloc(n, sizeof *symbols);
    p->count = n;
    p->outputs = m->output_count + 2 * p->conserved->count;
    const linear_system s = {n,       !m->is_system, dynamics, dynamics + n * n,     symbols,
                             turning, wanted,        false,    settings->compensated};
    for (int i = 0; i < n * n; i++) {
        dynamics[i] = equations_fold(e, e->mass[i]);
    }
    for (int i = 0; i < n; i++) {
        const poly *force = equations_fold(e, equations_force(e, i));
        dynamics[n * n + i] = conservation_settle(e, p->conserved, force);
        symbols[i] = e->unknowns[i].symbol;
        turning[i] = symbols[i]->is_angle;
        wanted[i] = p->conserved->number[i] < 0;
    }
    contact_lists_polys(e, p->conserved, dynamics + polys);
    layout *map = &p->layout;
    const bool fits = layout_arrange(map, e, p->conserved, dynamics, polys + more);
    bool good = fits;
    if (fits) {
        p->step = make_step(map, &s);
        p->observe = make_observe(p, map, &s);
        p->integral = energy_integral(e);
        p->books = make_books(p, map, &s);
        p->contacts = more > 0 ? contact_lists_make(map, &s, errors) : NULL;
        good = more == 0 || p->contacts != NULL;
        const int contacts = p->contacts != NULL ? p->contacts->count : 0;
        good = good && (!settings->stabilized ||
                        stabilizing_possible(map, p->contacts, p->integral, settings, errors));
        p->ledger_asked = e->instance->ledger || settings->stabilized;
        if (good && p->ledger_asked) {
            p->ledger = ledger_lists_make(map, p->integral, contacts, errors);
            good = p->ledger != NULL &&
                   (!settings->stabilized || stabilizing_conserves(p->ledger, e, errors));
        } else if (good && p->contacts != NULL && e->instance->balance) {
            diags *unsaid = diags_new();
            p->ledger = ledger_lists_make(map, p->integral, contacts, unsaid);
            diags_free(unsaid);
        }
        good = good && lists_finite(p, e, errors) && steps_need_no_turns(p, e, errors);
    } else {
        diag_error(errors, m->at, NULL, "'%s' has more than %d components of state", m->name,
                   IMAGE_COMPONENTS_MAX);
    }
    const bool grown = fits && algebra_overflow(e->algebra);
    if (grown) {
        equations_report_growth(e, errors);
    }
    free(dynamics);
    free(turning);
    free(wanted);
    free(symbols);
    if (!good || grown) {
        program_free(p);
        return NULL;
    }
    return p;
}

bool program_look_up(program *p, const equations *e, image_settings *settings, diags *errors) {
    static const char no_contacts[] =
        "leave --tables out, or the effects that have contacts and crossings";
    refusal why = {NULL, NULL, -1};
    if (settings->tables == TABLES_NONE) {
        return true;
    }
    settings->cells = settings->cells > 0 ? settings->cells : tables_cells(settings->tables);
    if (p->contacts != NULL) {
        diag_error(errors, p->contacts->row[0].from->at, no_contacts,
                   "--tables: a step with events looks at more than tables hold");
        return false;
    }
    op_list *made = tables_make(p->step, settings->tables, settings->cells, &p->tables, &why);
    if (made == NULL) {
        const symbol *angle =
            why.angle >= 0 ? e->unknowns[p->layout.angle[why.angle].unknown].symbol : NULL;
        diag_error(errors, angle != NULL ? angle->at : e->instance->mechanism->at, why.hint,
                   angle != NULL ? "--tables: the %s of '%s' %s: '%s' is one of them"
                                 : "--tables: the %s of '%s' %s",
                   p->layout.form == WH_SECOND_ORDER ? "accelerations" : "slopes",
                   e->instance->mechanism->name, why.reason, angle != NULL ? angle->name : "");
        return false;
    }
    op_list_free(p->step);
    p->step = made;
    return true;
}

void program_free(program *p) {
    if (p == NULL) {
        return;
    }
    op_list_free(p->step);
    op_list_free(p->tables);
    op_list_free(p->observe);
    op_list_free(p->books);
    contact_lists_free(p->contacts);
    ledger_lists_free(p->ledger);
    layout_free(&p->layout);
    conservation_free(p->conserved);
    free(p);
}

uint64_t program_hash(const program *p) {
    uint64_t hash = op_list_hash(p->step);
    if (p->contacts != NULL) {
        hash = contact_lists_hash(p->contacts, hash);
    }
    return hash;
}
