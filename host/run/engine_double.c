/* engine_double.c: the interpreter in the reference arithmetic. */
#define WH_DOUBLE 1
#include "engine.inc"

struct evaluator {
    const tape *tape;
    registers registers;
};

evaluator *evaluator_new(const tape *t) {
    evaluator *ev = room(1, sizeof *ev);
    *ev = (evaluator){t, registers_new(t)};
    return ev;
}

void evaluator_free(evaluator *ev) {
    if (ev != NULL) {
        registers_free(ev->registers);
        free(ev);
    }
}

void evaluator_run(evaluator *ev, double time_s, const double *angle_rad, const double *linear,
                   const double *rate, const double *input, double *result) {
    evaluate(ev->tape, ev->registers,
             (leaves){angle_rad, angle_rad, time_s, linear, rate, input, NULL}, result);
}
