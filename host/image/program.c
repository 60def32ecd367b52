/* program.c: the lists of an instance: step, contacts, ledger, outputs. */
#include "host/image/program.h"

#include "core/contact.h"
#include "core/hash.h"
#include "core/step/ledger_step.h"
#include "host/derive/equations.h"
#include "host/image/tables.h"
#include "host/lang/value.h"
#include "host/lang/words.h"

#define SAME_KIND(id, ...) \
    _Static_assert((int)CONTACT_##id == (int)WH_##id, "the core handles contacts in this order");
CONTACT_KIND_ROWS(SAME_KIND)
#undef SAME_KIND

_Static_assert((int)CONTACTS_MAX == WH_CONTACTS_LIMIT && (int)SETS_MAX == WH_SETS_MAX,
               "the core has room for what a run may have");

/* Returns a list that computes wanted[count], which layout_ready() has made ready. */
static op_list *enter_ready(layout *map, const poly *const *wanted, int count) {
    op_list *t = op_list_new(map->angles, count);
    t->folding = algebra_folding(map->equations->algebra);
    lowering l = layout_lowering(map, t);
    lower_plan(&l, wanted, count);
    for (int i = 0; i < count; i++) {
        t->result[i] = lower(&l, wanted[i]);
    }
    lower_done(&l);
    op_list_prune(t);
    return t;
}

/* As enter_ready(), but makes wanted[] ready first. */
static op_list *enter(layout *map, const poly **wanted, int count) {
    for (int i = 0; i < count; i++) {
        wanted[i] = layout_ready(map, wanted[i]);
    }
    return enter_ready(map, wanted, count);
}

static const poly **polys(const layout *map, int count) {
    return algebra_room(map->equations->algebra, count, sizeof(const poly *));
}

static op_list *make_signals(layout *map) {
    const contact_laws *laws = map->equations->contacts;
    const poly **wanted = polys(map, 2 * laws->count);
    for (int k = 0; k < laws->count; k++) {
        wanted[2 * k] = laws->law[k].value;
        wanted[2 * k + 1] = laws->law[k].speed;
    }
    return enter(map, wanted, 2 * laws->count);
}

static op_list *make_sets(layout *map) {
    const contact_laws *laws = map->equations->contacts;
    const poly **wanted = polys(map, laws->set_count);
    int count = 0;
    for (int k = laws->forced; k < laws->count; k++) {
        for (int i = 0; i < laws->law[k].from->set_count; i++) {
            wanted[count++] = laws->law[k].set[i];
        }
    }
    return count > 0 ? enter(map, wanted, count) : NULL;
}

/* For each contact with a force, enters the law's numbers, then row J, then M^-1 J^T. */
static op_list *make_forces(layout *map, const linear_system *s) {
    const contact_laws *laws = map->equations->contacts;
    const int n = map->equations->count;
    const int stride = WH_LAW_ROWS + 2 * map->coordinates;
    op_list *t = op_list_new(map->angles, laws->forced * stride);
    t->folding = algebra_folding(map->equations->algebra);
    int *pushed = algebra_room(map->equations->algebra, n, sizeof *pushed);
    const poly **row = polys(map, n + 3);
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
        for (int i = 0; i < n; i++) { /* row J includes the driven coordinates' entries */
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
    op_list_prune(t);
    return t;
}

/* If the only nonzero entry of row J is a constant, returns its coordinate (map->place); otherwise -1. */
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

/* Returns the `direction` of a stop (core/contact.h). */
static int stop_moves(const equations *e, const contact_law *law) {
    const mechanism *m = e->instance->mechanism;
    int moves = law->driven ? 2 : 0;
    for (int i = 0; i < m->input_count && moves == 0; i++) {
        moves = !poly_is_zero(poly_derivative(e->algebra, law->value, m->inputs[i], 0));
    }
    return moves;
}

static void make_row(program *p, const contact_law *law, image_contact *row) {
    image *im = p->draft.made;
    const layout *map = &p->layout;
    const contact_statement *from = law->from;
    const bool loosens = contact_loosens(from);
    char si[DIM_TEXT_SIZE];
    const char *gap =
        from->kind == CONTACT_STOP ? dimension_unit(from->value->dim, false, si, sizeof si) : "1";
    *row = (image_contact){
        .kind = (int)from->kind,
        .word = image_text(&p->draft, loosens ? "normal" : contact_word(from->kind)),
        .undefined = image_text(&p->draft, loosens ? "the normal force of this friction"
                                                   : contact_undefined(from->kind)),
        .pin = from->kind != CONTACT_WHEN ? pin_of(map, law) : -1,
        .unit = image_text(&p->draft, gap),
        .at = image_place(&p->draft, from->at)};
    switch (from->kind) {
    case CONTACT_STOP: row->direction = stop_moves(map->equations, law); break;
    case CONTACT_HOLD:
        row->direction = law->straight ? 1 : -law->driven;
        row->first_set = row->pin < 0 ? im->held++ : 0;
        break;
    case CONTACT_FRICTION: break;
    case CONTACT_WHEN:
        row->direction = from->direction;
        row->first_set = im->set_count;
        row->sets = from->set_count;
        for (int i = 0; i < from->set_count; i++) {
            const assignment *set = &from->sets[i];
            im->target[im->set_count++] = layout_component(map, set->symbol->index, set->primes);
        }
        break;
    }
}

/* Tests unsimplified expressions: simplification may remove an infinite argument of `max`. */
static bool are_finite(const equations *e, const expr *const *each, int count) {
    for (int i = 0; i < count; i++) {
        if (each[i] != NULL &&
            !poly_is_finite(equations_fold(e, poly_from_expr(e->algebra, each[i])))) {
            return false;
        }
    }
    return true;
}

static bool have_finite_laws(const equations *e, diags *errors) {
    static const char hint[] =
        "look for a division by zero, a root or logarithm of a negative number, or too large values";
    bool finite = true;
    for (int k = 0; k < e->contacts->count; k++) {
        const contact_statement *h = e->contacts->law[k].from;
        const expr *const each[] = {h->value,           h->restitution,      h->condition,
                                    h->static_friction, h->kinetic_friction, h->normal};
        if (!are_finite(e, each, (int)(sizeof each / sizeof each[0]))) {
            diag_error(errors, h->at, hint, "a number here is not finite");
            finite = false;
        }
        for (int i = 0; i < h->set_count; i++) {
            if (!are_finite(e, &h->sets[i].value, 1)) {
                diag_error(errors, h->sets[i].at, hint, "a number here is not finite");
                finite = false;
            }
        }
    }
    return finite;
}

/* An impact changes the rates, but must not change the mass matrix. */
static bool have_impulses(const equations *e, diags *errors) {
    for (int k = 0; k < e->contacts->count; k++) {
        const contact_statement *h = e->contacts->law[k].from;
        if ((h->kind == CONTACT_STOP || h->kind == CONTACT_HOLD) && energy_mass_has_rates(e)) {
            diag_error(errors, h->at, "leave it out, or make T quadratic in the rates",
                       "impacts cannot be computed: the inertia of '%s' depends on rates",
                       e->instance->mechanism->name);
            return false;
        }
    }
    return true;
}

/* Returns false after an error (reported). */
static bool make_contacts(program *p, const linear_system *s, diags *errors) {
    image *im = p->draft.made;
    layout *map = &p->layout;
    const equations *e = map->equations;
    const contact_laws *laws = e->contacts;
    if (map->form != WH_SECOND_ORDER) {
        diag_error(
            errors, laws->law[0].from->at, "integrate the coordinate: --without conserve",
            "in a scene with stops, friction, holds or crossings, Whirl cannot compute a coordinate's rate from its conserved momentum");
        return false;
    }
    if (!have_impulses(e, errors) || !have_finite_laws(e, errors)) {
        return false;
    }
    im->contact = image_room(&p->draft, laws->count, sizeof *im->contact);
    im->target = image_room(&p->draft, laws->set_count, sizeof *im->target);
    im->contacts = laws->count;
    im->forced = laws->forced;
    for (int k = 0; k < laws->count; k++) {
        make_row(p, &laws->law[k], &im->contact[k]);
    }
    im->list[IMAGE_SIGNALS] = make_signals(map);
    im->list[IMAGE_FORCES] = make_forces(map, s);
    im->list[IMAGE_SETS] = make_sets(map);
    return true;
}

/* === the ledger =============================================================================== */

typedef struct entries {
    image_draft *draft;
    image_ledger *ledger;
    const layout *map;
    const poly **power; /* [ledger->smooth] */
} entries;

/* Adds an entry, unless its rate is zero. `at` may be NULL. */
static void add_entry(entries *to, ledger_kind kind, const place *at, int account,
                      const poly *what) {
    const poly *ready = layout_ready(to->map, what);
    image_entry entry = {.kind = kind, .account = account};
    if (!poly_is_zero(ready)) {
        if (at != NULL) {
            entry.at = image_place(to->draft, *at);
        }
        to->ledger->entry[to->ledger->smooth] = entry;
        to->power[to->ledger->smooth++] = ready;
    }
}

static void add_statement(entries *to, const statement_force *of) {
    const bool drives = of->from->kind == TERM_Q;
    const equations *e = to->map->equations;
    for (int account = 1; account < to->ledger->accounts; account++) {
        const int i = to->ledger->unknown[account];
        if (e->unknowns[i].symbol->driven == NULL) { /* a driven coordinate has no momentum */
            add_entry(to, drives ? LEDGER_DRIVE : LEDGER_DAMPING, &of->from->at, account,
                      of->force[i]);
        }
    }
    add_entry(to, drives ? LEDGER_WORK : LEDGER_LOSS, &of->from->at, 0, of->power);
}

/* Adds the entries that change continuously between events. */
static void smooth_entries(entries *to) {
    const equations *e = to->map->equations;
    algebra *a = e->algebra;
    const poly *lagrangian = poly_sub(a, e->kinetic, e->stored);
    for (int account = 1; account < to->ledger->accounts; account++) {
        const int i = to->ledger->unknown[account];
        const symbol *q = e->unknowns[i].symbol;
        if (q->driven != NULL) {
            add_entry(to, LEDGER_WORK, &q->at, 0, energy_drive(e, i));
            continue;
        }
        add_entry(to, LEDGER_ENERGIES, NULL, account, poly_derivative(a, lagrangian, q, 0));
    }
    for (int k = 0; k < e->forces; k++) {
        add_statement(to, &e->force[k]);
    }
}

/* Finds the inputs in T or V. Each has a ledger entry, because its change between steps changes the energy. */
static void find_inputs(image_ledger *l, const layout *map) {
    const equations *e = map->equations;
    const poly *kinetic = layout_ready(map, e->kinetic);
    const poly *stored = layout_ready(map, e->stored);
    for (int i = 0; i < map->inputs; i++) {
        const symbol *s = e->instance->mechanism->inputs[map->input[i]];
        if (poly_contains(kinetic, s, 0) || poly_contains(stored, s, 0)) {
            l->input[l->inputs++] = i;
        }
    }
}

static op_list *make_levels(const image_ledger *l, const poly *integral, layout *map) {
    const equations *e = map->equations;
    const poly **wanted = polys(map, l->accounts);
    wanted[0] = integral != NULL ? integral : poly_add(e->algebra, e->kinetic, e->stored);
    for (int account = 1; account < l->accounts; account++) {
        wanted[account] = e->momentum[l->unknown[account]];
    }
    return enter(map, wanted, l->accounts);
}

/* Returns false after an error (reported). */
static bool make_ledger(program *p, diags *errors) {
    image *im = p->draft.made;
    layout *map = &p->layout;
    const equations *e = map->equations;
    const mechanism *m = e->instance->mechanism;
    image_ledger *l = &im->ledger;
    if (m->is_system) {
        diag_error(errors, m->at, "leave the ledger out: --without ledger",
                   "'%s' is given by equations: without energies it has no ledger", m->name);
        return false;
    }
    if (map->form != WH_SECOND_ORDER) {
        diag_error(
            errors, m->at, "integrate the coordinate: --without conserve",
            "in a scene with a ledger, Whirl cannot compute a coordinate's rate from its conserved momentum");
        return false;
    }
    const int most = e->count + e->forces * (1 + e->count);
    entries to = {&p->draft, l, map, polys(map, most)};
    l->accounts = 1 + e->count;
    l->unknown = image_room(&p->draft, l->accounts, sizeof *l->unknown);
    l->input = image_room(&p->draft, map->inputs, sizeof *l->input);
    l->entry = image_room(&p->draft, most, sizeof *l->entry);
    l->unknown[0] = -1;
    for (int i = 0, conserved = 1 + map->coordinates; i < e->count; i++) {
        l->unknown[map->place[i] >= 0 ? 1 + map->place[i] : conserved++] = i;
    }
    smooth_entries(&to);
    find_inputs(l, map);
    l->entries = l->smooth + im->contacts * (1 + map->coordinates) + l->inputs;
    l->kept = l->entries <= WH_LEDGER_MAX;
    l->entries += im->settings.stabilized;
    if (l->kept) {
        im->list[IMAGE_POWERS] = enter_ready(map, to.power, l->smooth);
        im->list[IMAGE_LEVELS] = make_levels(l, p->integral, map);
        l->turned = op_list_reads_turns(im->list[IMAGE_POWERS]);
    } else {
        diag_error(errors, m->at, "leave the ledger out: --without ledger",
                   "the ledger of '%s' has too many entries", m->name);
        *l = (image_ledger){.asked = l->asked};
    }
    return l->kept;
}

/* === conditions of --stabilized =============================================================== */

static const char no_stabilized[] = "leave out --stabilized";

/* Returns false (reported) if --stabilized is impossible. stabilizing_conserves() checks the ledger. */
static bool stabilizing_possible(const program *p, diags *errors) {
    const equations *e = p->layout.equations;
    const image_settings *settings = &p->draft.made->settings;
    const mechanism *m = e->instance->mechanism;
    if (m->is_system) {
        diag_error(
            errors, m->at, no_stabilized,
            "--stabilized corrects the energy drift: '%s' is given by equations and has no energy",
            m->name);
    } else if (e->contacts != NULL) {
        diag_error(errors, e->contacts->law[0].from->at,
                   "leave the effect out with --without EFFECT, or leave out --stabilized",
                   "--stabilized would undo the energy changes at the events of '%s'", m->name);
    } else if (settings->matrix != MATRIX_NONE) {
        diag_error(
            errors, m->at, "leave out --matrix, or --stabilized",
            "--stabilized needs the stages of a step, which steps with --matrix do not have");
    } else if (wh_methods[settings->method].takes == WH_NO_RATES) {
        diag_error(errors, m->at, "choose another --method, or leave out --stabilized",
                   "--stabilized needs a ledger, which is not possible with %s",
                   wh_methods[settings->method].title);
    } else if (settings->method == WH_SEMI_IMPLICIT_EULER) {
        diag_error(
            errors, m->at, "choose another --method, or leave out --stabilized",
            "--stabilized corrects an energy drift, but with %s the energy does not drift: it oscillates around the right value",
            wh_methods[settings->method].title);
    } else if (p->layout.form != WH_SECOND_ORDER) {
        diag_error(
            errors, m->at, "add --without conserve, or leave out --stabilized",
            "--stabilized needs a ledger, and a scene that computes a coordinate from its conserved momentum has none");
    } else if (p->integral != NULL) {
        diag_error(
            errors, m->at, no_stabilized,
            "--stabilized needs a kinetic energy that is quadratic in the rates: that of '%s' is not",
            m->name);
    } else {
        return true;
    }
    return false;
}

/* A stabilized step requires that nothing adds or removes energy. */
static bool stabilizing_conserves(const image_ledger *l, const equations *e, diags *errors) {
    for (int i = 0; i < l->smooth; i++) {
        if (l->entry[i].account == 0) {
            diag_error(
                errors, l->entry[i].at,
                "leave the effect out with --without EFFECT, or leave out --stabilized",
                "--stabilized is for motion without drive or damping, but this statement drives or damps");
            return false;
        }
    }
    if (l->inputs > 0) {
        diag_error(
            errors, e->instance->mechanism->at, no_stabilized,
            "--stabilized is for motion without drive or damping: the energies of '%s' name an input",
            e->instance->mechanism->name);
        return false;
    }
    return true;
}

/* === the lists of an instance ================================================================= */

static int slope_of(layout *map, lowering *l, component of, const int *highest) {
    const int k = map->conserved->number[of.unknown];
    if (k >= 0) {
        return lower(l, map->conserved->rate[k]);
    }
    const int up = of.primes + 1;
    if (up == map->equations->unknowns[of.unknown].order) {
        return highest[of.unknown];
    }
    return op_list_leaf(l->list, OP_LINEAR, map->real_number[of.unknown * map->order_room + up]);
}

static op_list *make_step(layout *map, const linear_system *s) {
    const int n = map->equations->count;
    const int components = map->angles + map->reals;
    const bool second = map->form == WH_SECOND_ORDER;
    op_list *t = op_list_new(map->angles, second ? map->coordinates : components);
    t->folding = algebra_folding(map->equations->algebra);
    int *highest = algebra_room(map->equations->algebra, n, sizeof *highest);
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
    op_list_prune(t);
    if (sparing.sparing) {
        op_list_share_sums(t);
    }
    op_list_order(t);
    return t;
}

/* Makes a list that computes `wanted`. If `keep`, its first results are the unknowns' highest derivatives. */
static op_list *make_observer(layout *map, const linear_system *s, const poly *const *wanted,
                              int count, bool keep) {
    const equations *e = map->equations;
    const int n = e->count;
    const int first = keep ? n : 0;
    op_list *t = op_list_new(map->angles, first + count);
    t->folding = algebra_folding(e->algebra);
    int *highest = algebra_room(map->equations->algebra, n, sizeof *highest);
    const poly **folded = polys(map, count + e->instance->mechanism->noise_count);
    lowering l = layout_lowering(map, t);
    solve_highest(&l, s, highest);
    map->highest = highest;
    for (int i = 0; i < n && keep; i++) {
        t->result[i] = highest[i];
    }
    for (int i = 0; i < n && e->contacts != NULL; i++) {
        if (map->place[i] >= 0) { /* the contacts' forces are in OP_ACCEL, not in highest[] */
            highest[i] = op_list_leaf(t, OP_ACCEL, map->place[i]);
        }
    }
    for (int i = 0; i < count; i++) {
        folded[i] = layout_ready(map, wanted[i]);
    }
    int planned = count;
    for (int k = 0; k < e->instance->mechanism->noise_count; k++) {
        const symbol *record = e->instance->mechanism->noises[k].record;
        bool named = false;
        for (int i = 0; i < count; i++) {
            named = named || poly_contains(folded[i], record, 0);
        }
        if (named) {
            folded[planned++] = layout_recorded(map, record);
        }
    }
    lower_plan(&l, folded, planned);
    map->recording = &l;
    for (int i = 0; i < count; i++) {
        t->result[first + i] = lower(&l, folded[i]);
    }
    if (!keep) {
        noise_on_outputs(e, &l, t->result);
    }
    lower_done(&l);
    map->highest = NULL;
    map->recording = NULL;
    op_list_prune(t);
    return t;
}

/* The list of the mechanism's outputs, then value and rate of each conserved coordinate. */
static op_list *make_observe(layout *map, const linear_system *s) {
    const equations *e = map->equations;
    const int own = e->instance->mechanism->output_count;
    const int count = own + 2 * map->conserved->count;
    const poly **wanted = polys(map, count);
    for (int i = 0; i < own; i++) {
        wanted[i] = e->output[i];
    }
    for (int k = 0; k < map->conserved->count; k++) {
        const symbol *q = e->unknowns[map->conserved->unknown[k]].symbol;
        wanted[own + 2 * k] = poly_symbol(e->algebra, q, 0);
        wanted[own + 2 * k + 1] = poly_symbol(e->algebra, q, 1);
    }
    return make_observer(map, s, wanted, count, false);
}

static op_list *make_books(const poly *integral, layout *map, const linear_system *s) {
    const equations *e = map->equations;
    algebra *a = e->algebra;
    const int n = e->count;
    const poly **wanted = polys(map, BOOK_MOMENTA + n + 1);
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
        if (integral != NULL) {
            wanted[count++] = integral;
        }
    }
    return make_observer(map, s, wanted, count, true);
}

/* Parameter values may give 1/0 or too large numbers. A program with such a constant cannot run. */
static bool lists_finite(const image *im, const equations *e, diags *errors) {
    static const char hint[] =
        "look for a division by zero, or values that are too large or too small";
    const mechanism *m = e->instance->mechanism;
    const int output = op_list_not_finite(im->list[IMAGE_OBSERVE]);
    bool finite = true;
    for (int role = 0; role < IMAGE_ROLES; role++) {
        const op_list *t = role != IMAGE_OBSERVE ? im->list[role] : NULL;
        finite = finite && (t == NULL || op_list_not_finite(t) < 0);
    }
    if (finite && output >= 0 && output < m->output_count) {
        diag_error(errors, m->outputs[output]->at, hint,
                   "output '%s' contains a number that is not finite", m->outputs[output]->name);
    } else if (!finite || output >= 0) {
        diag_error(errors, m->at, hint, "the equations of '%s' contain a number that is not finite",
                   m->name);
    }
    return finite && output < 0;
}

/* A step has angles only modulo a turn. */
static bool steps_need_no_turns(const image *im, const equations *e, diags *errors) {
    const op_list *const lists[] = {im->list[IMAGE_STEP], im->list[IMAGE_SIGNALS],
                                    im->list[IMAGE_FORCES], im->list[IMAGE_SETS]};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        if (lists[i] != NULL && op_list_reads_turns(lists[i])) {
            diag_error(errors, e->instance->mechanism->at, "use smaller multiples of the angles",
                       "the equations of '%s' contain too large a multiple of an angle",
                       e->instance->mechanism->name);
            return false;
        }
    }
    return true;
}

/* If only the balance needs the ledger, a failure to make it is no error. */
static bool make_ledger_asked(program *p, diags *errors) {
    image *im = p->draft.made;
    const equations *e = p->layout.equations;
    const bool stabilized = im->settings.stabilized;
    if (stabilized && !stabilizing_possible(p, errors)) {
        return false;
    }
    im->ledger.asked = e->instance->ledger || stabilized;
    if (!im->ledger.asked) {
        diags *unsaid = diags_new();
        (void)(e->contacts != NULL && e->instance->balance && make_ledger(p, unsaid));
        diags_free(unsaid);
        return true;
    }
    return make_ledger(p, errors) && (!stabilized || stabilizing_conserves(&im->ledger, e, errors));
}

/* Returns false after an error (reported). */
static bool make_lists(program *p, const linear_system *s, diags *errors) {
    image *im = p->draft.made;
    layout *map = &p->layout;
    const equations *e = map->equations;
    im->list[IMAGE_STEP] = make_step(map, s);
    im->list[IMAGE_OBSERVE] = make_observe(map, s);
    p->integral = energy_integral(e);
    im->list[IMAGE_BOOKS] = make_books(p->integral, map, s);
    return (e->contacts == NULL || make_contacts(p, s, errors)) && make_ledger_asked(p, errors) &&
           lists_finite(im, e, errors) && steps_need_no_turns(im, e, errors);
}

/* Replaces the step's functions of one angle by tables (tables.h), if the settings ask for it. Returns false (reported)
 * if that is impossible. */
static bool look_up(program *p, diags *errors) {
    static const char no_contacts[] =
        "leave out --tables, or the effects with contacts and crossings: --without EFFECT";
    image *im = p->draft.made;
    image_settings *settings = &im->settings;
    const equations *e = p->layout.equations;
    refusal why = {NULL, NULL, -1};
    if (settings->tables == TABLES_NONE) {
        return true;
    }
    settings->cells = settings->cells > 0 ? settings->cells : tables_cells(settings->tables);
    if (e->contacts != NULL) {
        diag_error(errors, e->contacts->law[0].from->at, no_contacts,
                   "--tables: a scene with events cannot use tables");
        return false;
    }
    op_list *made = tables_make(im->list[IMAGE_STEP], settings->tables, settings->cells,
                                &im->list[IMAGE_TABLES], &why);
    if (made == NULL) {
        const symbol *angle =
            why.angle >= 0 ? e->unknowns[p->layout.angle[why.angle].unknown].symbol : NULL;
        diag_error(errors, angle != NULL ? angle->at : e->instance->mechanism->at, why.hint,
                   angle != NULL ? "--tables: the %s of '%s' %s, such as '%s'"
                                 : "--tables: the %s of '%s' %s",
                   p->layout.form == WH_SECOND_ORDER ? "accelerations" : "slopes",
                   e->instance->mechanism->name, why.reason, angle != NULL ? angle->name : "");
        return false;
    }
    op_list_free(im->list[IMAGE_STEP]);
    im->list[IMAGE_STEP] = made;
    return true;
}

program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors) {
    algebra *a = e->algebra;
    const int n = e->count;
    const mechanism *m = e->instance->mechanism;
    const contact_laws *laws = e->contacts;
    program *p = algebra_room(a, 1, sizeof *p);
    layout *map = &p->layout;
    *map = (layout){.equations = e, .conserved = conservation_make(e, conserve, errors)};
    if (map->conserved == NULL) {
        return NULL;
    }
    p->draft = image_draft_new();
    p->draft.made->settings = *settings;
    const int of_contacts = laws != NULL ? laws->count * (LAW_POLYS + n) + laws->set_count : 0;
    const poly **dynamics = algebra_room(a, n * n + n + of_contacts, sizeof *dynamics);
    bool *turning = algebra_room(a, n, sizeof *turning);
    bool *wanted = algebra_room(a, n, sizeof *wanted);
    const symbol **symbols = algebra_room(a, n, sizeof *symbols);
    const linear_system s = {n,       !m->is_system, dynamics, dynamics + n * n,     symbols,
                             turning, wanted,        false,    settings->compensated};
    int count = 0;
    for (; count < n * n; count++) {
        dynamics[count] = equations_fold(e, e->mass[count]);
    }
    for (int i = 0; i < n; i++) {
        dynamics[count++] = layout_ready(map, equations_force(e, i));
        symbols[i] = e->unknowns[i].symbol;
        turning[i] = symbols[i]->is_angle;
        wanted[i] = map->conserved->number[i] < 0;
    }
    for (int k = 0; laws != NULL && k < laws->count; k++) {
        const poly *each;
        for (int i = 0; (each = contact_law_poly(e, k, i)) != NULL; i++) {
            dynamics[count++] = layout_ready(map, each);
        }
    }
    const bool fits = layout_arrange(map, dynamics, count);
    bool good = fits && make_lists(p, &s, errors);
    if (!fits) {
        diag_error(errors, m->at, NULL, "'%s' has more than %d coordinates, rates and states",
                   m->name, IMAGE_COMPONENTS_MAX);
    } else if (algebra_overflow(a)) {
        equations_report_growth(e, errors);
        good = false;
    }
    if (!good || !look_up(p, errors)) {
        image_free(p->draft.made);
        return NULL;
    }
    return p;
}

uint64_t program_hash(const program *p) {
    const image *im = p->draft.made;
    uint64_t hash = op_list_hash(im->list[IMAGE_STEP]);
    for (int role = IMAGE_SIGNALS; role <= IMAGE_SETS; role++) {
        hash = im->list[role] != NULL ? wh_hash_u64(hash, op_list_hash(im->list[role])) : hash;
    }
    for (int k = 0; k < im->contacts; k++) {
        hash = wh_hash_u64(hash, (uint64_t)im->contact[k].kind);
        hash = wh_hash_u64(hash, (uint64_t)(im->contact[k].direction + 1));
    }
    for (int i = 0; i < im->set_count; i++) {
        hash = wh_hash_u64(hash, (uint64_t)im->target[i]);
    }
    return hash;
}
