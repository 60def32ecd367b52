/* image_make.c: the image, and its variants with other roundings of folded numbers. */
#include "host/image/image_make.h"

#include <stdio.h>
#include <string.h>

#include "core/contact.h"
#include "host/derive/lagrange.h"
#include "host/image/diagnostic_expressions.h"
#include "host/image/image_parts.h"
#include "host/image/matrix_make.h"
#include "host/image/op_list_scaling.h"
#include "host/image/program.h"
#include "host/lang/lexer.h"
#include "host/lang/value.h"
#include "host/lang/words.h"
#include "host/number/folding.h"
#include "host/number/phase.h"

static void name_it(image_draft *d, const instance *inst) {
    image *im = d->made;
    const mechanism *m = inst->mechanism;
    im->name = image_text(d, inst->name);
    im->title = image_text(d, inst->scene != NULL ? inst->scene->title : m->title);
    im->mechanism = image_text(d, m->name);
    im->mechanism_at = image_place(d, m->at);
    im->at = image_place(d, inst->scene != NULL ? inst->scene->at : m->at);
    im->effects = m->effect_count;
    im->effect = image_room(d, im->effects, sizeof *im->effect);
    for (int i = 0; i < im->effects; i++) {
        im->effect[i] = (image_effect){image_text(d, m->effects[i].name),
                                       image_text(d, m->effects[i].text), inst->with[i]};
    }
}

static void time_it(image *im, const instance *inst) {
    im->step_s = inst->step_s;
    im->step = inst->step;
    im->steps = inst->steps;
    im->until_s = inst->until_s;
}

/* is_written() examines at most this many subexpressions. Each let may double them, as in p*p with p = q*q. */
enum { MOST_PARTS = 1000 };

/* Is the expression a constant without sums and calls? These may give round-off instead of zero. */
static bool is_written(const instance *inst, const expr *e, int *parts) {
    if (++*parts > MOST_PARTS) {
        return false;
    }
    switch (e->op) {
    case EXPR_NUMBER: return true;
    case EXPR_SYMBOL:
        return e->symbol->kind == SYM_LET ? is_written(inst, e->symbol->value, parts)
               : e->symbol->kind == SYM_PARAMETER
                   ? is_written(inst, inst->parameter_given[e->symbol->index], parts)
                   : false;
    case EXPR_NEG: return is_written(inst, e->left, parts);
    case EXPR_MUL:
    case EXPR_DIV:
    case EXPR_POW: return is_written(inst, e->left, parts) && is_written(inst, e->right, parts);
    case EXPR_ADD:
    case EXPR_SUB:
    case EXPR_CALL: return false;
    }
    return false;
}

static void start_unknown(image_draft *d, const instance *inst, int i) {
    image_unknown *u = &d->made->unknown[i];
    u->starts = inst->start_count[i];
    u->start = image_room(d, u->starts, sizeof *u->start);
    u->start_at = image_room(d, u->starts, sizeof *u->start_at);
    for (int k = 0; k < u->starts; k++) {
        u->start[k] = inst->start[i][k];
        u->start_at[k] = image_place(d, inst->start_given[i][k].at);
    }
    int parts = 0;
    u->start_written = inst->start_given[i][0].value != NULL &&
                       is_written(inst, inst->start_given[i][0].value, &parts);
}

static void start_components(image_draft *d) {
    image *im = d->made;
    im->start_rad = image_room(d, im->angles, sizeof *im->start_rad);
    im->start_turns = image_room(d, im->angles, sizeof *im->start_turns);
    im->start_real = image_room(d, im->reals, sizeof *im->start_real);
    for (int i = 0; i < im->angles; i++) {
        im->start_rad[i] = im->unknown[im->angle[i].unknown].start[0];
        im->start_turns[i] = phase_of_start(im->start_rad[i]);
    }
    for (int i = 0; i < im->reals; i++) {
        const component c = im->real[i];
        const image_unknown *u = &im->unknown[c.unknown];
        im->start_real[i] = c.primes < u->starts ? u->start[c.primes] : 0.0;
    }
}

static void copy_unknowns(image_draft *d, const equations *e) {
    image *im = d->made;
    im->unknown = image_room(d, im->count, sizeof *im->unknown);
    for (int i = 0; i < im->count; i++) {
        const symbol *s = e->unknowns[i].symbol;
        image_unknown *u = &im->unknown[i];
        char momentum[DIM_TEXT_SIZE];
        dimension dim = dim_none();
        (void)dim_divide(dim_of(2, 1, -1, 0, 0), s->dim, &dim);
        *u = (image_unknown){
            .name = image_text(d, s->name),
            .text = image_text(d, s->text),
            .at = image_place(d, s->at),
            .is_angle = s->is_angle,
            .is_length = s->dim.twelfths[DIM_LENGTH] == DIM_DENOMINATOR,
            .conserved = e->conserved[i],
            .driven = s->driven != NULL,
            .order = e->unknowns[i].order,
            .momentum_si = image_text(d, dimension_unit(dim, false, momentum, sizeof momentum))};
        u->unit = image_room(d, u->order + 1, sizeof *u->unit);
        for (int primes = 0; primes <= u->order; primes++) {
            u->unit[primes] = image_unit_of(d, s, primes);
        }
        start_unknown(d, e->instance, i);
    }
}

static void copy_quantities(image_draft *d, const program *p, const instance *inst) {
    image *im = d->made;
    const mechanism *m = inst->mechanism;
    im->input = image_room(d, im->inputs, sizeof *im->input);
    for (int i = 0; i < im->inputs; i++) {
        const int k = p->layout.input[i];
        im->input[i] = image_quantity_of(d, m->inputs[k], inst->input[k]);
    }
    im->output = image_room(d, im->own_outputs, sizeof *im->output);
    for (int i = 0; i < im->own_outputs; i++) {
        im->output[i] = image_quantity_of(d, m->outputs[i], 0.0);
    }
    im->parameter = image_room(d, m->parameter_count, sizeof *im->parameter);
    for (int i = 0; i < m->parameter_count; i++) {
        if (instance_lacks(inst, m->parameters[i]) == NULL) {
            im->parameter[im->parameters++] =
                image_quantity_of(d, m->parameters[i], inst->parameter[i]);
        }
    }
}

/* Returns the range of a symbol's derivative with `primes` primes. The range may be undeclared. */
static image_range range_of(image_draft *d, const instance *inst, const char *name, place at,
                            const symbol *s, int primes) {
    image_range made = {.name = name, .at = at};
    for (int k = 0; k < inst->range_count; k++) {
        const range_value *r = &inst->range[k];
        if (r->symbol == s && r->primes == primes) {
            made = (image_range){name, image_place(d, r->at), true, r->low, r->high};
        }
    }
    return made;
}

/* Copies the declared ranges of components and inputs, for fixed point. */
static void copy_ranges(image_draft *d, const equations *e, const layout *map) {
    image *im = d->made;
    const instance *inst = e->instance;
    im->range = image_room(d, im->reals + im->inputs, sizeof *im->range);
    im->angle_range = image_room(d, im->angles, sizeof *im->angle_range);
    for (int i = 0; i < im->reals + im->angles; i++) {
        const bool real = i < im->reals;
        const component c = real ? im->real[i] : im->angle[i - im->reals];
        const image_unknown *u = &im->unknown[c.unknown];
        char name[NAME_LENGTH_MAX + 16];
        snprintf(name, sizeof name, "%s%.*s", u->name, c.primes, "''''''''''");
        *(real ? &im->range[i] : &im->angle_range[i - im->reals]) =
            range_of(d, inst, image_text(d, name), u->at, e->unknowns[c.unknown].symbol, c.primes);
    }
    for (int i = 0; i < im->inputs; i++) {
        im->range[im->reals + i] = range_of(d, inst, im->input[i].name, im->input[i].at,
                                            inst->mechanism->inputs[map->input[i]], 0);
    }
}

static void *copy(image_draft *d, const void *from, int count, size_t size) {
    void *made = image_room(d, count, size);
    if (count > 0) {
        memcpy(made, from, (size_t)count * size);
    }
    return made;
}

static int input_number(const layout *map, const symbol *input) {
    int number = 0;
    while (map->input[number] != input->index) {
        number++;
    }
    return number;
}

static void take_drives(image_draft *d, const layout *map) {
    image *im = d->made;
    const equations *e = map->equations;
    im->drive = image_room(d, e->count, sizeof *im->drive);
    for (int i = 0; i < e->count; i++) {
        const symbol *input = e->unknowns[i].symbol->driven;
        if (input != NULL) {
            const int *at = &map->real_number[i * map->order_room];
            im->drive[im->drives++] =
                (image_drive){input_number(map, input), input_number(map, input->rate), at[0],
                              at[1], input->rate->rate != NULL};
        }
    }
}

static void copy_layout(image_draft *d, const program *p) {
    image *im = d->made;
    const layout *map = &p->layout;
    im->form = map->form;
    im->coordinates = map->coordinates;
    im->angles = map->angles;
    im->reals = map->reals;
    im->inputs = map->inputs;
    im->recovered = map->conserved->count;
    im->angle = copy(d, map->angle, map->angles, sizeof *map->angle);
    im->real = copy(d, map->real, map->reals, sizeof *map->real);
    im->place = copy(d, map->place, im->count, sizeof *map->place);
    im->from_momentum =
        copy(d, map->conserved->unknown, im->recovered, sizeof *map->conserved->unknown);
    take_drives(d, map);
}

/* Makes the requested matrix, if any. Returns the image, or NULL (reported). */
static image *with_matrix(image_draft *d, const equations *e, diags *errors) {
    if (d->made->settings.matrix == MATRIX_NONE || matrix_make(d, e, errors)) {
        return d->made;
    }
    image_free(d->made);
    return NULL;
}

/* As image_once(), with the current folding of the algebra. */
static image *image_folded(const equations *e, const bool *conserve, const image_settings *settings,
                           image_use use, diags *errors) {
    program *p = program_make(e, conserve, settings, errors);
    if (p == NULL) {
        return NULL;
    }
    image_draft *d = &p->draft;
    image *im = d->made;
    /* contacts forbid scaling, because their lists use the step's mass matrix */
    if (settings->compensated && im->contacts == 0 && settings->tables == TABLES_NONE &&
        folding_way(algebra_folding(e->algebra)) == FOLDING_NEAREST) {
        op_list_scale(&im->list[IMAGE_STEP], op_list_scaling_price(im->list[IMAGE_STEP]));
    }
    im->hash = program_hash(p);
    im->count = e->count;
    im->own_outputs = e->instance->mechanism->output_count;
    im->outputs = im->own_outputs + 2 * p->layout.conserved->count;
    im->has_energies = e->kinetic != NULL;
    im->has_integral = p->integral != NULL;
    im->mass_blur = e->mass_blur;
    name_it(d, e->instance);
    time_it(im, e->instance);
    copy_layout(d, p);
    copy_unknowns(d, e);
    copy_quantities(d, p, e->instance);
    start_components(d);
    copy_ranges(d, e, &p->layout);
    if (use != IMAGE_TO_WRITE) {
        diagnostics_make(d, e);
    }
    return with_matrix(d, e, errors);
}

/* As image_make(), without variants. All constants are folded with `f`. */
static image *image_once(const equations *e, const bool *conserve, const image_settings *settings,
                         image_use use, folding *f, diags *errors) {
    folding *const before = algebra_fold(e->algebra, f);
    image *im = image_folded(e, conserve, settings, use, errors);
    for (int role = 0; im != NULL && role < IMAGE_ROLES; role++) {
        if (im->list[role] != NULL) {
            im->list[role]->folding = NULL; /* the list outlives `f` */
        }
    }
    (void)algebra_fold(e->algebra, before);
    return im;
}

image *image_again(const image *base, const instance *inst, diags *errors) {
    image_draft d = image_draft_new();
    image *im = d.made;
    struct arena *memory = im->memory;
    *im = *base;
    im->memory = memory;
    im->base = base->base != NULL ? base->base : base;
    im->finer = NULL; /* base->finer has the starts of `base`, not those of `inst` */
    time_it(im, inst);
    im->unknown = copy(&d, base->unknown, im->count, sizeof *im->unknown);
    for (int i = 0; i < im->count; i++) {
        start_unknown(&d, inst, i);
    }
    im->input = copy(&d, base->input, im->inputs, sizeof *im->input);
    for (int k = 0, i = 0; k < inst->mechanism->input_count; k++) {
        if (instance_lacks(inst, inst->mechanism->inputs[k]) == NULL) {
            im->input[i++].value = inst->input[k];
        }
    }
    start_components(&d);
    if (im->settings.matrix == MATRIX_NONE || im->step_s == im->base->step_s) {
        im->list[IMAGE_MATRIX] = im->base->list[IMAGE_MATRIX];
        im->matrix = im->base->matrix;
        return d.made;
    }
    return with_matrix(&d, NULL, errors);
}

/* === the image, and ways of folding its numbers =============================================== */

/* image_make() makes variants only if folding.lost exceeds this limit. */
#define FOLDED_MUCH 1e-9

_Static_assert((int)FOLDING_WAYS - (int)FOLDING_OPPOSITE == (int)IMAGE_WAYS,
               "a place for each way");

static bool is_alike(const image *im, const image *other) {
    bool alike = im->form == other->form && im->coordinates == other->coordinates &&
                 im->angles == other->angles && im->reals == other->reals &&
                 im->recovered == other->recovered && im->contacts == other->contacts;
    for (int i = 0; i < im->angles + im->reals && alike; i++) {
        const component a = image_component(im, i);
        const component b = image_component(other, i);
        alike = a.unknown == b.unknown && a.primes == b.primes;
    }
    for (int role = 0; role < IMAGE_ROLES && alike; role++) {
        const op_list *a = im->list[role];
        const op_list *b = other->list[role];
        alike = (a == NULL) == (b == NULL) && (a == NULL || a->results == b->results);
    }
    return alike;
}

/* Makes a variant of `im` with folding `way`. Returns NULL if that fails, or if the two are not is_alike(). */
static image *make_refolded(image *im, const equations *e, const bool *conserve,
                            const image_settings *settings, int way) {
    diags *unsaid = diags_new();
    folding varied = {.way = way};
    instance *again = instance_again(e->instance, way);
    im->unbounded = im->unbounded || again == NULL;
    equations *other = again != NULL ? equations_derive(again, unsaid) : NULL;
    image *made = other != NULL
                      ? image_once(other, conserve, settings, IMAGE_TO_WRITE, &varied, unsaid)
                      : NULL;
    equations_free(other);
    instance_free(again);
    diags_free(unsaid);
    if (made != NULL && !is_alike(im, made)) {
        image_free(made);
        made = NULL;
    }
    return made;
}

image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors) {
    folding nearest = e->folding;
    nearest.way = FOLDING_NEAREST;
    image *im = image_once(e, conserve, settings, use, &nearest, errors);
    if (im == NULL) {
        return NULL;
    }
    const bool asks = use != IMAGE_TO_WRITE && nearest.lost > FOLDED_MUCH;
    for (int way = FOLDING_OPPOSITE; way < FOLDING_WAYS && asks; way++) {
        image *other = make_refolded(im, e, conserve, settings, way);
        if (other != NULL) {
            im->refolded[im->ways++] = other;
        }
    }
    image_settings finer;
    if (use == IMAGE_TO_CHECK && image_settings_finer(settings, &finer)) {
        diags *unsaid = diags_new(); /* discarded: the run's image had the same messages */
        im->finer = image_make(e, conserve, &finer, IMAGE_TO_RUN, unsaid);
        diags_free(unsaid);
    }
    return im;
}
