/* instance.c: the numerical values of a scene or mechanism, including the changes from the command line. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/model.h"
#include "host/lang/override.h"
#include "host/lang/value.h"
#include "host/lang/words.h"

bool instance_has(const instance *of, int within) { return within < 0 || of->with[within]; }

double instance_value(const instance *of, const symbol *s, int primes) {
    switch (s->kind) {
    case SYM_PARAMETER: return of->parameter[s->index];
    case SYM_INPUT: return of->input[s->index];
    case SYM_COORDINATE:
    case SYM_STATE: return primes < of->start_count[s->index] ? of->start[s->index][primes] : 0.0;
    case SYM_LET:
    case SYM_OUTPUT:
    case SYM_RECORD: break;
    }
    return (double)NAN;
}

const effect *instance_lacks(const instance *of, const symbol *what) {
    return instance_has(of, what->effect) ? NULL : &of->mechanism->effects[what->effect];
}

/* === ranges of contacts and of noise ========================================================== */

/* Allowance for round-off: 0.3 - 0.2 - 0.1 is -3e-17, and must pass as zero. */
#define LAST_DIGITS 1e-15

/* Returns the value at the start. Returns NAN if the expression depends on the motion, or after an error. */
static double value_at_start(const expr *tree, valuation *known, const char *what) {
    if ((tree->uses & USES_UNKNOWNS) != 0) {
        return (double)NAN;
    }
    const size_t before = diags_calls(known->diags);
    const double value = finite_value(tree, known, tree->at, what);
    return diags_calls(known->diags) == before ? value : (double)NAN;
}

static void check_stop(const contact_statement *stop, valuation *known) {
    const double e = value_at_start(stop->restitution, known, "the restitution");
    if (e < -LAST_DIGITS || e > 1.0 + LAST_DIGITS) {
        diag_error(known->diags, stop->restitution->at,
                   "write 0 for a body that stays at the stop, 1 for a body that keeps its speed",
                   "a restitution is from 0 to 1, and this is %g", e);
    }
}

static void check_friction(const contact_statement *friction, valuation *known) {
    const expr *sticks = friction->static_friction;
    const expr *slides = friction->kinetic_friction;
    const double most = value_at_start(sticks, known, "the coefficient of static friction");
    const double kinetic = value_at_start(slides, known, "the coefficient of kinetic friction");
    const bool first = most < -LAST_DIGITS;
    if (first || kinetic < -LAST_DIGITS) {
        diag_error(known->diags, first ? sticks->at : slides->at, NULL,
                   "a coefficient of friction must not be negative, and this is %g",
                   first ? most : kinetic);
    } else if (kinetic > most * (1.0 + LAST_DIGITS) + LAST_DIGITS) {
        diag_error(known->diags, slides->at,
                   "lower the kinetic coefficient, or raise the static one",
                   "kinetic friction %g is above static friction %g", kinetic, most);
    }
}

static void check_noise(const noise *each, valuation *known) {
    const double deviation = value_at_start(each->deviation, known, "the deviation");
    if (deviation < 0.0) {
        diag_error(known->diags, each->deviation->at, NULL,
                   "a standard deviation must not be negative, and this is %g", deviation);
    }
}

/* Reports two active frictions on one coordinate, or two active noises on one output. */
static void check_pairs(const instance *made, diags *all) {
    const mechanism *of = made->mechanism;
    for (int i = 0; i < of->contact_count; i++) {
        const contact_statement *a = &of->contacts[i];
        for (int k = 0; k < i && a->kind == CONTACT_FRICTION && instance_has(made, a->effect);
             k++) {
            const contact_statement *b = &of->contacts[k];
            if (b->kind == CONTACT_FRICTION && b->coordinate == a->coordinate &&
                instance_has(made, b->effect)) {
                diag_error(all, a->at, "select only one of these effects",
                           "friction on '%s' was already given in line %d", a->coordinate->name,
                           b->at.line);
                break;
            }
        }
    }
    for (int i = 0; i < of->noise_count; i++) {
        const noise *a = &of->noises[i];
        for (int k = 0; k < i && instance_has(made, a->effect); k++) {
            const noise *b = &of->noises[k];
            if (b->output == a->output && instance_has(made, b->effect)) {
                diag_error(all, a->at, "select only one of these effects",
                           "noise on '%s' was already given in line %d", a->output->name,
                           b->at.line);
                break;
            }
        }
    }
}

/* Reports an input whose effect is not active: the run has no such input. */
static void check_inputs(const instance *made, const expr *tree, diags *all) {
    if (tree == NULL) {
        return;
    }
    const symbol *named = tree->op == EXPR_SYMBOL ? tree->symbol : NULL;
    const bool changes =
        named != NULL &&
        (named->kind == SYM_INPUT ||
         (named->kind == SYM_LET && named->value != NULL && (named->value->uses & USES_INPUT)));
    if (changes && named->effect >= 0 && !made->with[named->effect]) {
        const char *owner = made->mechanism->effects[named->effect].name;
        diag_error(all, tree->at, arena_words(made->arena, "add it to the scene: with %s", owner),
                   "'%s' belongs to the effect '%s', which is not selected here", named->name,
                   owner);
    }
    check_inputs(made, tree->left, all);
    check_inputs(made, tree->right, all);
}

/* Counts a contact and the values that it sets. Reports the first contact that exceeds CONTACTS_MAX or SETS_MAX. */
static void count_event(const contact_statement *each, int *events, int *sets, diags *all) {
    *events += 1;
    *sets += each->set_count;
    if (*events == CONTACTS_MAX + 1) {
        diag_error(all, each->at, NULL,
                   "more than %d stops, frictions, holds and 'when' statements in one run",
                   CONTACTS_MAX);
    }
    if (*sets > SETS_MAX && *sets - each->set_count <= SETS_MAX) {
        diag_error(all, each->at, NULL, "the 'when' statements of one run set more than %d values",
                   SETS_MAX);
    }
}

/* Checks contacts and noises, but only at the initial values of the inputs. */
static void limits_check(const instance *made, valuation *known) {
    const mechanism *of = made->mechanism;
    known->input = made->input;
    int events = 0;
    int sets = 0;
    for (int i = 0; i < of->contact_count; i++) {
        const contact_statement *each = &of->contacts[i];
        if (!instance_has(made, each->effect)) {
            continue;
        }
        count_event(each, &events, &sets, known->diags);
        if (each->kind == CONTACT_STOP) {
            check_stop(each, known);
        } else if (each->kind == CONTACT_FRICTION) {
            check_friction(each, known);
        }
    }
    for (int i = 0; made->scene != NULL && i < made->scene->when_count; i++) {
        const contact_statement *each = &made->scene->whens[i];
        count_event(each, &events, &sets, known->diags);
        check_inputs(made, each->value, known->diags);
        for (int k = 0; k < each->set_count; k++) {
            check_inputs(made, each->sets[k].value, known->diags);
        }
    }
    for (int i = 0; i < of->noise_count; i++) {
        if (instance_has(made, of->noises[i].effect)) {
            check_noise(&of->noises[i], known);
        }
    }
    check_pairs(made, known->diags);
}

/* === a scene in numbers ======================================================================= */

#define STEP_DEFAULT_S 1e-3
#define UNTIL_DEFAULT_S 10.0
#define ROUNDING 1e-9 /* allowance for round-off of unit conversions, as a fraction of the step */

enum { WORDS_SIZE = 120 };

/* The values from the scene and from the command line, which overrides the scene. */
typedef struct plan {
    valuation values;
    given_value *input; /* [input_count] */
    const expr *step;   /* NULL: not given */
    const expr *until;
} plan;

static void apply(plan *into, instance *made, const assignment *change) {
    const int index = change->symbol->index;
    const given_value value = {change->value, change->at};
    switch (change->symbol->kind) {
    case SYM_PARAMETER:
        into->values.parameter_expr[index] = value.value;
        into->values.parameter_at[index] = value.at;
        break;
    case SYM_INPUT: into->input[index] = value; break;
    case SYM_COORDINATE:
    case SYM_STATE: made->start_given[index][change->primes] = value; break;
    case SYM_LET:
    case SYM_OUTPUT:
    case SYM_RECORD: break; /* refused by the parser */
    }
}

static plan plan_new(const instance *made, diags *all) {
    const mechanism *of = made->mechanism;
    plan fresh = {.values = valuation_new(of, made->arena, all)};
    fresh.input = arena_alloc(made->arena, (size_t)of->input_count * sizeof *fresh.input);
    for (int i = 0; i < of->input_count; i++) {
        fresh.input[i] = (given_value){of->inputs[i]->value, of->inputs[i]->at};
    }
    return fresh;
}

static void apply_scene(plan *into, const scene *from, instance *made) {
    memcpy(made->with, from->with, (size_t)from->mechanism->effect_count * sizeof *made->with);
    made->ledger = from->ledger;
    made->conserve = from->conserve;
    for (int i = 0; i < from->set_count; i++) {
        apply(into, made, &from->sets[i]);
    }
    for (int i = 0; i < from->start_count; i++) {
        apply(into, made, &from->starts[i]);
    }
    into->step = from->step;
    into->until = from->until;
}

static bool takes_part(const instance *made, override_kind kind, const assignment *change,
                       diags *all) {
    const effect *missing = instance_lacks(made, change->symbol);
    if (missing == NULL) {
        return true;
    }
    const char *hint = arena_words(
        made->arena, kind == OVERRIDE_SET ? "add --with %s" : "name a scene that selects %s",
        missing->name);
    diag_error(all, change->at, hint, "'%s' belongs to the effect '%s', which is not selected here",
               change->symbol->name, missing->name);
    return false;
}

/* Reports a second value for the same symbol, and returns false: one of the two values would be lost. */
static bool is_first(const assignment *before, int count, const assignment *change, diags *all) {
    for (int i = 0; i < count; i++) {
        if (before[i].symbol == change->symbol && before[i].primes == change->primes) {
            diag_error(all, change->at, "leave one of them out",
                       "'%s%.*s' is given twice on the command line", change->symbol->name,
                       change->primes, "'''''''''");
            return false;
        }
    }
    return true;
}

static void apply_texts(plan *into, instance *made, override_kind kind, const char *const *texts,
                        int count) {
    assignment *taken = arena_alloc(made->arena, ((size_t)count + 1) * sizeof *taken);
    int taken_count = 0;
    for (int i = 0; i < count; i++) {
        assignment change;
        diags *all = into->values.diags;
        if (override_parse(made->mechanism, kind, texts[i], NULL, made->arena, all, &change) &&
            takes_part(made, kind, &change, all) && is_first(taken, taken_count, &change, all)) {
            taken[taken_count++] = change;
            apply(into, made, &change);
        }
    }
}

static bool is_word(const char *text, word_id word) { return word_is(word, text, strlen(text)); }

/* Applies the word `all` of --with or --without. apply_effects() then applies the names of single effects. */
static void apply_all(instance *made, const char *const *texts, int count, bool wanted) {
    for (int i = 0; i < count; i++) {
        for (int k = 0; is_word(texts[i], WORD_ALL) && k < made->mechanism->effect_count; k++) {
            made->with[k] = wanted;
        }
    }
}

static void apply_effects(plan *into, instance *made, const char *const *texts, int count,
                          bool wanted) {
    for (int i = 0; i < count; i++) {
        if (is_word(texts[i], WORD_LEDGER)) {
            made->ledger = wanted;
        } else if (is_word(texts[i], WORD_CONSERVE) && !wanted) {
            made->conserve = NULL;
        } else if (!is_word(texts[i], WORD_ALL)) {
            const int index =
                override_effect(made->mechanism, texts[i], made->arena, into->values.diags);
            if (index >= 0) {
                made->with[index] = wanted;
            }
        }
    }
}

static void apply_overrides(plan *into, instance *made, const overrides *changes) {
    const mechanism *of = made->mechanism;
    diags *all = into->values.diags;
    made->balance = changes->balance;
    apply_all(made, changes->with, changes->with_count, true);
    apply_all(made, changes->without, changes->without_count, false);
    apply_effects(into, made, changes->with, changes->with_count, true);
    apply_effects(into, made, changes->without, changes->without_count, false);
    apply_texts(into, made, OVERRIDE_SET, changes->sets, changes->set_count);
    apply_texts(into, made, OVERRIDE_START, changes->starts, changes->start_count);
    apply_texts(into, made, OVERRIDE_EITHER, changes->values, changes->value_count);
    if (changes->step != NULL) {
        const expr *value = override_duration(of, "step", changes->step, made->arena, all);
        into->step = value == NULL ? into->step : value;
    }
    if (changes->until != NULL) {
        const expr *value = override_duration(of, "until", changes->until, made->arena, all);
        into->until = value == NULL ? into->until : value;
    }
}

static void evaluate_durations(plan *from, instance *made) {
    valuation *values = &from->values;
    const expr *step = from->step;
    const expr *until = from->until;
    const size_t before = diags_calls(values->diags);
    made->step_s = STEP_DEFAULT_S;
    made->until_s = UNTIL_DEFAULT_S;
    if (step != NULL) {
        made->step_s = finite_value(step, values, step->at, "step");
        if (!(made->step_s > 0.0)) {
            diag_error(values->diags, step->at, NULL, "step must be above zero");
        } else if (made->step_s < RATIO_LEAST || made->step_s > RATIO_MOST) {
            diag_error(values->diags, step->at, NULL,
                       "a step must be from %g s to %g s, and this is %.9g s", RATIO_LEAST,
                       RATIO_MOST, made->step_s);
        }
    }
    if (until != NULL) {
        made->until_s = finite_value(until, values, until->at, "until");
        if (!(made->until_s >= 0.0)) {
            diag_error(values->diags, until->at, NULL, "until must not be negative");
        } else if (made->until_s > RATIO_MOST) {
            diag_error(values->diags, until->at, NULL,
                       "until must be at most %g s, and this is %.9g s", RATIO_MOST, made->until_s);
        }
    }
    if (diags_calls(values->diags) != before) {
        return;
    }
    const place at = until != NULL ? until->at : step != NULL ? step->at : made->mechanism->at;
    made->step = ratio_of(made->step_s);
    if (!ratio_count(ratio_of(made->until_s), made->step, &made->steps)) {
        diag_error(values->diags, at, "use a larger 'step' or an earlier 'until'",
                   "more than 2^63 steps of %.9g s", made->step_s);
    }
    if (made->until_s > 0.0 && made->until_s < made->step_s * (1.0 - ROUNDING)) {
        diag_error(values->diags, at,
                   "use a later 'until' or a shorter 'step'; a run with 'until' 0 has no steps",
                   "'until' is %.9g s, less than one step of %.9g s", made->until_s, made->step_s);
    }
}

static void evaluate_ranges(plan *from, instance *made) {
    const int count = made->scene != NULL ? made->scene->range_count : 0;
    made->range = arena_alloc(made->arena, (size_t)count * sizeof *made->range);
    for (int i = 0; i < count; i++) {
        const range_statement *each = &made->scene->ranges[i];
        const char *what = arena_words(made->arena, "the range of '%s%.*s'", each->symbol->name,
                                       each->primes, "'''''''''");
        const double low = finite_value(each->low, &from->values, each->at, what);
        const double high = finite_value(each->high, &from->values, each->at, what);
        if (!(low < high)) {
            diag_error(from->values.diags, each->at, "write the smaller value first",
                       "%s is empty: from %.9g to %.9g", what, low, high);
        }
        made->range[made->range_count++] =
            (range_value){each->symbol, each->primes, low, high, each->at};
    }
}

static void evaluate(plan *from, instance *made) {
    const mechanism *of = made->mechanism;
    char what[WORDS_SIZE];
    for (int i = 0; i < of->parameter_count; i++) {
        made->parameter[i] = parameter_value(&from->values, i);
        made->parameter_given[i] = from->values.parameter_expr[i];
    }
    for (int i = 0; i < of->input_count; i++) {
        snprintf(what, sizeof what, "input '%s'", of->inputs[i]->name);
        made->input_given[i] = from->input[i].value;
        made->input[i] = finite_value(from->input[i].value, &from->values, from->input[i].at, what);
    }
    for (int i = 0; i < of->coordinate_count; i++) {
        for (int k = 0; k < made->start_count[i]; k++) {
            const symbol *input = of->coordinates[i]->driven;
            given_value *each = &made->start_given[i][k];
            if (input != NULL) {
                *each = from->input[(k == 0 ? input : input->rate)->index];
            }
            snprintf(what, sizeof what, "the initial value of '%s'", of->coordinates[i]->name);
            made->start[i][k] = each->value == NULL
                                    ? 0.0
                                    : finite_value(each->value, &from->values, each->at, what);
        }
    }
}

static void allocate_numbers(instance *made) {
    const mechanism *of = made->mechanism;
    struct arena *memory = made->arena;
    made->parameter = arena_alloc(memory, (size_t)of->parameter_count * sizeof *made->parameter);
    made->input = arena_alloc(memory, (size_t)of->input_count * sizeof *made->input);
    made->start = arena_alloc(memory, (size_t)of->coordinate_count * sizeof *made->start);
    for (int i = 0; i < of->coordinate_count; i++) {
        const int order = of->coordinates[i]->order;
        made->start[i] =
            arena_alloc(memory, (size_t)(order < 2 ? 2 : order) * sizeof **made->start);
    }
}

static void allocate(instance *made) {
    const mechanism *of = made->mechanism;
    struct arena *memory = made->arena;
    allocate_numbers(made);
    made->with = arena_alloc(memory, (size_t)of->effect_count * sizeof *made->with);
    made->start_given =
        arena_alloc(memory, (size_t)of->coordinate_count * sizeof *made->start_given);
    made->parameter_given =
        arena_alloc(memory, (size_t)of->parameter_count * sizeof *made->parameter_given);
    made->input_given = arena_alloc(memory, (size_t)of->input_count * sizeof *made->input_given);
    made->start_count =
        arena_alloc(memory, (size_t)of->coordinate_count * sizeof *made->start_count);
    for (int i = 0; i < of->coordinate_count; i++) {
        const int order = of->coordinates[i]->order;
        made->start_count[i] = order;
        made->start_given[i] = arena_alloc(memory, (size_t)order * sizeof **made->start_given);
    }
}

/* Returns an instance whose numbers are not computed yet. *what: the plan for computing them. */
static instance *begin(const mechanism *of, const scene *from, const overrides *changes, diags *all,
                       plan *what) {
    struct arena *memory = arena_new();
    instance *made = arena_alloc(memory, sizeof *made);
    made->arena = memory;
    made->mechanism = of;
    made->scene = from;
    made->name = from != NULL ? from->name : of->name;
    allocate(made);
    *what = plan_new(made, all);
    what->values.folding = &made->folding;
    if (from != NULL) {
        apply_scene(what, from, made);
    }
    if (changes != NULL) {
        apply_overrides(what, made, changes);
        made->name = changes->name != NULL ? changes->name : made->name;
    }
    return made;
}

bool instance_duration(const mechanism *of, const scene *from, const overrides *changes,
                       const char *what, const char *text, diags *all, double *seconds) {
    const size_t before = diags_calls(all);
    plan known;
    instance *made = begin(of, from, changes, all, &known);
    const expr *value = override_duration(of, what, text, made->arena, all);
    *seconds = value == NULL ? 0.0 : finite_value(value, &known.values, value->at, what);
    if (value != NULL && *seconds < 0.0) {
        diag_error(all, value->at, NULL, "%s must not be negative", what);
    }
    instance_free(made);
    return diags_calls(all) == before;
}

instance *instance_make(const mechanism *of, const scene *from, const overrides *changes,
                        diags *all) {
    const size_t calls = diags_calls(all);
    plan what;
    instance *made = begin(of, from, changes, all, &what);
    evaluate(&what, made);
    evaluate_ranges(&what, made);
    evaluate_durations(&what, made);
    what.values.folding = NULL;
    if (diags_calls(all) == calls) {
        limits_check(made, &what.values);
    }
    if (diags_calls(all) != calls) {
        instance_free(made);
        return NULL;
    }
    return made;
}

instance *instance_again(const instance *first, int way) {
    struct arena *memory = arena_new();
    instance *made = arena_alloc(memory, sizeof *made);
    *made = *first;
    made->arena = memory;
    allocate_numbers(made);
    diags *unsaid = diags_new();
    plan what = plan_new(made, unsaid);
    made->folding.way = way;
    what.values.folding = &made->folding;
    for (int i = 0; i < made->mechanism->parameter_count; i++) {
        what.values.parameter_expr[i] = first->parameter_given[i];
    }
    for (int i = 0; i < made->mechanism->input_count; i++) {
        what.input[i].value = first->input_given[i];
    }
    evaluate(&what, made);
    const bool good = diags_calls(unsaid) == 0;
    diags_free(unsaid);
    if (!good) {
        instance_free(made);
        return NULL;
    }
    return made;
}

void instance_free(instance *done) {
    if (done != NULL) {
        arena_free(done->arena);
    }
}
