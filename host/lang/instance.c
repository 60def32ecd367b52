/* instance.c: a scene, or a bare mechanism, with the command line's changes, in numbers. */
#include <stdio.h>
#include <string.h>

#include "host/base/arena.h"
#include "instance_limits.h"
#include "model.h"
#include "override.h"
#include "value.h"
#include "words.h"

#define STEP_DEFAULT_S 1e-3
#define UNTIL_DEFAULT_S 10.0
#define ROUNDING 1e-9 /* of a step: what the conversion of units may leave */

enum { WORDS_SIZE = 120 };

/* An expression and where it was given. */
typedef struct given {
    const expr *value; /* NULL: nothing given */
    place at;
} given;

/* What the scene and the command line give, the later over the earlier. */
typedef struct plan {
    valuation values;
    given *input;  /* [input_count] */
    given **start; /* [coordinate_count][order] */
    given step;
    given until;
} plan;

static void apply(plan *into, const assignment *change) {
    const int index = change->symbol->index;
    const given value = {change->value, change->at};
    switch (change->symbol->kind) {
    case SYM_PARAMETER:
        into->values.parameter_expr[index] = value.value;
        into->values.parameter_at[index] = value.at;
        break;
    case SYM_INPUT: into->input[index] = value; break;
    case SYM_COORDINATE:
    case SYM_STATE: into->start[index][change->primes] = value; break;
    case SYM_LET:
    case SYM_OUTPUT:
    case SYM_RECORD: break; /* refused when it was read */
    }
}

static plan plan_new(const instance *made, diags *all) {
    const mechanism *of = made->mechanism;
    plan fresh = {.values = valuation_new(of, made->arena, all)};
    fresh.input = arena_alloc(made->arena, (size_t)of->input_count * sizeof *fresh.input);
    for (int i = 0; i < of->input_count; i++) {
        fresh.input[i] = (given){of->inputs[i]->value, of->inputs[i]->at};
    }
    fresh.start = arena_alloc(made->arena, (size_t)of->coordinate_count * sizeof *fresh.start);
    for (int i = 0; i < of->coordinate_count; i++) {
        const size_t order = (size_t)of->coordinates[i]->order;
        fresh.start[i] = arena_alloc(made->arena, order * sizeof **fresh.start);
    }
    return fresh;
}

static void apply_scene(plan *into, const scene *from, instance *made) {
    for (int i = 0; i < from->mechanism->effect_count; i++) {
        made->with[i] = from->with[i];
    }
    made->ledger = from->ledger;
    made->conserve = from->conserve;
    for (int i = 0; i < from->set_count; i++) {
        apply(into, &from->sets[i]);
    }
    for (int i = 0; i < from->start_count; i++) {
        apply(into, &from->starts[i]);
    }
    if (from->step != NULL) {
        into->step = (given){from->step, from->step->at};
    }
    if (from->until != NULL) {
        into->until = (given){from->until, from->until->at};
    }
}

/* A change that could change nothing is a mistake. */
static bool takes_part(const instance *made, override_kind kind, const assignment *change,
                       diags *all) {
    const effect *missing = instance_lacks(made, change->symbol);
    char hint[WORDS_SIZE];
    if (missing == NULL) {
        return true;
    }
    if (kind == OVERRIDE_SET) {
        snprintf(hint, sizeof hint, "add --with %.80s", missing->name);
    } else {
        snprintf(hint, sizeof hint, "name a scene that calls for %.60s", missing->name);
    }
    diag_error(all, change->at, hint, "'%s' belongs to the effect '%s', which takes no part here",
               change->symbol->name, missing->name);
    return false;
}

/* Given twice, one of the two would change nothing. */
static bool is_first(const assignment *before, int count, const assignment *change, diags *all) {
    for (int i = 0; i < count; i++) {
        if (before[i].symbol == change->symbol && before[i].primes == change->primes) {
            diag_error(all, change->at, "once is enough: leave one of them out",
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
        if (override_parse(made->mechanism, kind, texts[i], made->arena, all, &change) &&
            takes_part(made, kind, &change, all) && is_first(taken, taken_count, &change, all)) {
            taken[taken_count++] = change;
            apply(into, &change);
        }
    }
}

/* "all" comes before the names beside it, which take away or add. */
static void apply_all(instance *made, const char *const *texts, int count, bool wanted) {
    bool found = false;
    for (int i = 0; i < count && !found; i++) {
        found = strcmp(texts[i], word_row(WORD_ALL)->text) == 0;
    }
    for (int i = 0; i < made->mechanism->effect_count && found; i++) {
        made->with[i] = wanted;
    }
}

static void apply_effects(plan *into, instance *made, const char *const *texts, int count,
                          bool wanted) {
    for (int i = 0; i < count; i++) {
        if (strcmp(texts[i], word_row(WORD_ALL)->text) == 0) {
            continue;
        }
        if (strcmp(texts[i], word_row(WORD_LEDGER)->text) == 0) {
            made->ledger = wanted;
            continue;
        }
        if (strcmp(texts[i], word_row(WORD_CONSERVE)->text) == 0 && !wanted) {
            made->conserve = NULL;
            continue;
        }
        const int index =
            override_effect(made->mechanism, texts[i], made->arena, into->values.diags);
        if (index >= 0) {
            made->with[index] = wanted;
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
        into->step = value == NULL ? into->step : (given){value, value->at};
    }
    if (changes->until != NULL) {
        const expr *value = override_duration(of, "until", changes->until, made->arena, all);
        into->until = value == NULL ? into->until : (given){value, value->at};
    }
}

static void evaluate_durations(plan *from, instance *made) {
    valuation *values = &from->values;
    const size_t before = diags_calls(values->diags);
    made->step_s = STEP_DEFAULT_S;
    made->until_s = UNTIL_DEFAULT_S;
    if (from->step.value != NULL) {
        made->step_s = finite_value(from->step.value, values, from->step.at, "step");
        if (!(made->step_s > 0.0)) {
            diag_error(values->diags, from->step.at, NULL, "step must be above zero");
        } else if (made->step_s < RATIO_LEAST || made->step_s > RATIO_MOST) {
            diag_error(values->diags, from->step.at, NULL,
                       "a step must be from %g s to %g s, and this is %.9g s", RATIO_LEAST,
                       RATIO_MOST, made->step_s);
        }
    }
    if (from->until.value != NULL) {
        made->until_s = finite_value(from->until.value, values, from->until.at, "until");
        if (!(made->until_s >= 0.0)) {
            diag_error(values->diags, from->until.at, NULL, "until must not be negative");
        } else if (made->until_s > RATIO_MOST) {
            diag_error(values->diags, from->until.at, NULL,
                       "until must be at most %g s, and this is %.9g s", RATIO_MOST, made->until_s);
        }
    }
    if (diags_calls(values->diags) != before) {
        return;
    }
    const place at = from->until.value != NULL ? from->until.at : from->step.at;
    made->step = ratio_of(made->step_s);
    if (!ratio_count(ratio_of(made->until_s), made->step, &made->steps)) {
        diag_error(values->diags, at, "a larger step or an earlier until",
                   "more than 2^63 steps of %.9g s", made->step_s);
    }
    if (made->until_s > 0.0 && made->until_s < made->step_s * (1.0 - ROUNDING)) {
        diag_error(values->diags, at, "a later until or a shorter step; until 0 takes no step",
                   "until %.9g s is less than one step of %.9g s", made->until_s, made->step_s);
    }
}

static void evaluate_ranges(plan *from, instance *made) {
    const int count = made->scene != NULL ? made->scene->range_count : 0;
    char what[WORDS_SIZE];
    made->range = arena_alloc(made->arena, (size_t)count * sizeof *made->range);
    for (int i = 0; i < count; i++) {
        const range_statement *each = &made->scene->ranges[i];
        snprintf(what, sizeof what, "the range of '%s%.*s'", each->symbol->name, each->primes,
                 "'''''''''");
        const double low = finite_value(each->low, &from->values, each->at, what);
        const double high = finite_value(each->high, &from->values, each->at, what);
        if (!(low < high)) {
            diag_error(from->values.diags, each->at, "write the lesser end first",
                       "%s holds nothing: from %.9g to %.9g", what, low, high);
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
            const given *each = input == NULL ? &from->start[i][k]
                                              : &from->input[(k == 0 ? input : input->rate)->index];
            snprintf(what, sizeof what, "the initial value of '%s'", of->coordinates[i]->name);
            made->start_at[i][k] = each->at;
            made->start_given[i][k] = each->value;
            made->start[i][k] = each->value == NULL
                                    ? 0.0
                                    : finite_value(each->value, &from->values, each->at, what);
        }
    }
    evaluate_ranges(from, made);
    evaluate_durations(from, made);
}

static void allocate(instance *made) {
    const mechanism *of = made->mechanism;
    struct arena *memory = made->arena;
    made->with = arena_alloc(memory, (size_t)of->effect_count * sizeof *made->with);
    made->parameter = arena_alloc(memory, (size_t)of->parameter_count * sizeof *made->parameter);
    made->input = arena_alloc(memory, (size_t)of->input_count * sizeof *made->input);
    made->start = arena_alloc(memory, (size_t)of->coordinate_count * sizeof *made->start);
    made->start_at = arena_alloc(memory, (size_t)of->coordinate_count * sizeof *made->start_at);
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
        made->start[i] =
            arena_alloc(memory, (size_t)(order < 2 ? 2 : order) * sizeof **made->start);
        made->start_at[i] = arena_alloc(memory, (size_t)order * sizeof **made->start_at);
        made->start_given[i] = arena_alloc(memory, (size_t)order * sizeof **made->start_given);
    }
}

/* An instance without numbers yet, and the plan they follow from. */
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
    const size_t before = diags_calls(all);
    const folding before_it = folding_begin(folding_way(), NULL);
    plan what;
    instance *made = begin(of, from, changes, all, &what);
    evaluate(&what, made);
    made->folding = folding_end(before_it);
    if (diags_calls(all) == before) {
        limits_check(made, &what.values);
    }
    if (diags_calls(all) != before) {
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
