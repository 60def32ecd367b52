/* engine_double.c: the interpreter in the reference arithmetic. */
#define WH_DOUBLE 1
#include "engine.inc"

struct evaluator {
    const tape *tape;
    registers registers;
    bool wraps;
};

evaluator *evaluator_new(const tape *t) {
    evaluator *ev = room(1, sizeof *ev);
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

void evaluator_run(evaluator *ev, double time_s, const double *angle_rad, const double *linear,
                   const double *rate, const double *input, double *result) {
    double phase[PROGRAM_COMPONENTS_MAX];
    for (int i = 0; i < ev->tape->angles && ev->wraps; i++) {
        phase[i] = remainder(angle_rad[i], 6.283185307179586477);
    }
    evaluate(ev->tape, ev->registers,
             (leaves){ev->wraps ? phase : angle_rad, angle_rad, time_s, linear, rate, input, NULL},
             result);
}
