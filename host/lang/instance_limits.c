#include "instance_limits.h"

#include <math.h>
#include <stdio.h>

/* What decimals leave: 0.1 + 0.2 is not above 0.3, and 0.3 - 0.2 - 0.1 not below zero. */
#define LAST_DIGITS 1e-15

/* The value at the start, or NAN when it changes with the motion, or is not finite (reported). */
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
                   "0: it stays where it hits; 1: it leaves as fast as it came",
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
        diag_error(known->diags, slides->at, "sliding takes no more force than breaking loose",
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

/* What two effects give separately, they must not give together. */
static void check_pairs(const instance *made, diags *all) {
    const mechanism *of = made->mechanism;
    for (int i = 0; i < of->contact_count; i++) {
        const contact_statement *a = &of->contacts[i];
        for (int k = 0; k < i && a->kind == CONTACT_FRICTION && instance_has_contact(made, a);
             k++) {
            const contact_statement *b = &of->contacts[k];
            if (b->kind == CONTACT_FRICTION && b->coordinate == a->coordinate &&
                instance_has_contact(made, b)) {
                diag_error(all, a->at, "call for one of these effects",
                           "friction on '%s' was already given in line %d", a->coordinate->name,
                           b->at.line);
                break;
            }
        }
    }
    for (int i = 0; i < of->noise_count; i++) {
        const noise *a = &of->noises[i];
        for (int k = 0; k < i && instance_has_noise(made, a); k++) {
            const noise *b = &of->noises[k];
            if (b->output == a->output && instance_has_noise(made, b)) {
                diag_error(all, a->at, "call for one of these effects",
                           "noise on '%s' was already given in line %d", a->output->name,
                           b->at.line);
                break;
            }
        }
    }
}

/* A scene may name what belongs to any effect; an input is there only with its effect. */
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
        char hint[120];
        snprintf(hint, sizeof hint, "call for it: with %s", owner);
        diag_error(all, tree->at, hint, "'%s' belongs to the effect '%s', which takes no part here",
                   named->name, owner);
    }
    check_inputs(made, tree->left, all);
    check_inputs(made, tree->right, all);
}

/* The numbers of events and of what they set are bounded. */
static void count_event(const contact_statement *each, int *events, int *sets, diags *all) {
    *events += 1;
    *sets += each->set_count;
    if (*events == CONTACTS_MAX + 1) {
        diag_error(all, each->at, NULL, "more than %d stops, frictions, holds and whens in one run",
                   CONTACTS_MAX);
    }
    if (*sets > SETS_MAX && *sets - each->set_count <= SETS_MAX) {
        diag_error(all, each->at, NULL, "the whens of one run set more than %d values", SETS_MAX);
    }
}

void limits_check(const instance *made, valuation *known) {
    const mechanism *of = made->mechanism;
    known->input = made->input;
    int events = 0;
    int sets = 0;
    for (int i = 0; i < of->contact_count; i++) {
        const contact_statement *each = &of->contacts[i];
        if (!instance_has_contact(made, each)) {
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
        if (instance_has_noise(made, &of->noises[i])) {
            check_noise(&of->noises[i], known);
        }
    }
    check_pairs(made, known->diags);
}
