/* start.c: whether a run can start where its scene says, and by the method that is asked for. */
#include "start.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine.h"
#include "host/base/room.h"
#include "host/derive/contact_lists.h"
#include "host/lang/shown.h"
#include "host/number/phase.h"
#include "methods.h"

/* m or rad: what the conversion of a start's units may leave. */
#define ROUNDING 1e-9

static bool is_apart(const contact_row *row, double gap, diags *errors) {
    static const char hint[] = "start on it or apart from it, or leave the stop out";
    const contact_statement *stop = row->from;
    if (stop->kind != CONTACT_STOP || (gap >= -ROUNDING && isfinite(gap))) {
        return true;
    }
    char si[64];
    const char *by = dimension_unit(stop->value->dim, false, si, sizeof si);
    if (!isfinite(gap)) {
        diag_error(errors, stop->at, hint,
                   "the distance to this stop is not a finite number where the run starts");
    } else {
        diag_error(errors, stop->at, hint, "the run starts beyond this stop, by %.6g%s%s", -gap,
                   strcmp(by, "1") == 0 ? "" : " ", strcmp(by, "1") == 0 ? "" : by);
    }
    return false;
}

bool start_angles_are_held(const program *p, const instance *inst, diags *errors) {
    bool held = true;
    for (int i = 0; i < p->angles; i++) {
        const int k = p->angle[i].unknown;
        const symbol *s = inst->mechanism->coordinates[k];
        const place given = inst->start_at[k][0];
        if (!phase_holds_start(inst->start[k][0])) {
            diag_error(errors, given.source != NULL ? given : s->at,
                       "start it within a turn: whole turns change nothing in a sine",
                       "'%s' starts at %.9g rad: float counts turns up to %g rad only", s->name,
                       inst->start[k][0], PHASE_START_MOST_RAD);
            held = false;
        }
    }
    return held;
}

bool start_is_possible(const program *p, const instance *inst, const engine_kind *kind,
                       diags *errors) {
    const contact_lists *c = p->contacts;
    bool good = kind != &engine_float || start_angles_are_held(p, inst, errors);
    if (c == NULL || !good) {
        return good;
    }
    double *angle_rad = room(p->angles, sizeof(double));
    double *real = room(p->reals, sizeof(double));
    double *signal = room(2 * c->count, sizeof(double));
    evaluator *ev = evaluator_new(c->signals);
    double *input = room(p->inputs, sizeof(double));
    program_start(p, inst, angle_rad, real);
    program_inputs(p, inst, input);
    evaluator_run(ev, 0.0, angle_rad, real, real + (p->coordinates - p->angles), input, signal);
    for (int k = 0; k < c->count; k++) {
        good = is_apart(&c->row[k], signal[2 * k], errors) && good;
    }
    evaluator_free(ev);
    free(input);
    free(signal);
    free(real);
    free(angle_rad);
    return good;
}

bool start_has_method(const program *p, const instance *inst, wh_method method, diags *errors) {
    const mechanism *m = inst->mechanism;
    if (wh_method_takes(method, p->form)) {
        return true;
    }
    const char *title = wh_methods[method].title;
    char others[METHODS_TEXT_SIZE];
    char hint[METHODS_TEXT_SIZE + 160];
    methods_of_form(p->form, others);
    for (int i = 0; i < m->coordinate_count; i++) {
        const symbol *s = m->coordinates[i];
        if (s->order != 2) {
            snprintf(
                hint, sizeof hint,
                "it moves positions in another way than rates: every unknown must be of order 2; "
                "choose --method %s",
                others);
            diag_error(errors, s->at, hint, "%s is not defined here: '%s' is of order %d", title,
                       s->name, s->order);
            return false;
        }
    }
    snprintf(hint, sizeof hint,
             "integrate the coordinate, --without conserve; or choose --method %s", others);
    diag_error(errors, inst->scene != NULL ? inst->scene->at : m->at, hint,
               "%s is not defined here: '%s', which is conserved, is integrated from its momentum",
               title, m->coordinates[p->conserved->unknown[0]]->name);
    return false;
}
