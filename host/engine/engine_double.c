/* engine_double.c: the interpreter in the reference arithmetic. */
#define WH_DOUBLE 1
#include "engine.inc"
#include "host/base/alloc.h"
#include "rounding.h"

uint64_t engine_operations;

uint64_t engine_evaluation(const image *im) {
    const uint64_t of_method = 4U + 2U * (uint64_t)im->count;
    const uint64_t of_contacts = im->contacts > 0 ? 40U + 20U * (uint64_t)im->contacts : 0U;
    return (uint64_t)im->list[IMAGE_STEP]->count + EVALUATION + of_method + of_contacts;
}

struct evaluator {
    const op_list *list;
    registers registers;
    bool wraps;
};

evaluator *evaluator_new(const op_list *t) {
    evaluator *ev = alloc(1, sizeof *ev);
    *ev = (evaluator){t, registers_new(t), false};
    return ev;
}

void evaluator_free(evaluator *ev) {
    if (ev != NULL) {
        registers_free(ev->registers);
        free(ev);
    }
}

void evaluator_wrap(evaluator *ev) { ev->wraps = true; }

/* The angles for the list's phases, wrapped if evaluator_wrap() was called. */
static const double *phases_of(const evaluator *ev, const double *angle_rad, double *wrapped) {
    for (int i = 0; i < ev->list->angles && ev->wraps; i++) {
        wrapped[i] = number_centred(angle_rad[i], 6.283185307179586477);
    }
    return ev->wraps ? wrapped : angle_rad;
}

void evaluator_run(evaluator *ev, double time_s, const double *angle_rad, const double *linear,
                   const double *rate, const double *input, double *result) {
    double wrapped[IMAGE_COMPONENTS_MAX];
    const double *phase = phases_of(ev, angle_rad, wrapped);
    evaluate(ev->list, ev->registers,
             (leaves){NULL, phase, angle_rad, time_s, linear, rate, input, NULL}, result);
}

double evaluator_value(const evaluator *ev, int operation) {
    return ev->registers.value[operation];
}

void evaluator_rounding(const evaluator *ev, const double *angle_rad, double least, double *error) {
    double wrapped[IMAGE_COMPONENTS_MAX];
    const registers *r = &ev->registers;
    const double *phase = phases_of(ev, angle_rad, wrapped);
    engine_operations += 2U * (uint64_t)ev->list->count;
    rounding_of(ev->list, &(rounding_values){r->value, r->sine, r->cosine, phase, angle_rad, least},
                error);
}

state_list state_list_open(const image *im, image_role role) {
    const op_list *t = im->list[role];
    state_list l = {im, evaluator_new(t), alloc(im->inputs, sizeof *l.input),
                    alloc(t->results, sizeof *l.result)};
    image_inputs(im, l.input);
    return l;
}

void state_list_close(const state_list *l) {
    evaluator_free(l->evaluator);
    free(l->input);
    free(l->result);
}

const double *state_list_at(const state_list *l, const double *angle_rad, const double *real) {
    evaluator_run(l->evaluator, 0.0, angle_rad, real,
                  real + (l->image->coordinates - l->image->angles), l->input, l->result);
    return l->result;
}
