/* operands.c: see operands.h. */
#include "operands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "host/run/engine.h"
#include "long_list.h"

/* Steps of measure.sh: what it counts lies behind the first, and ends at the last. */
enum { FIRST = 20, LAST = 70, APART = 10 };

/* A look at the run: state and leaves. */
typedef struct looking {
    const image *im;
    const tape *list;
    bool is_float;
    long_list *values;
    double *angle_rad;
    double *real;
    long double *state; /* the same, angles first */
    double *input;
    long double *result;
    int looks;
} looking;

static int linears_of(const image *im) {
    return im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
}

static looking begin(const image *im, const tape *list, cost_number number) {
    looking l = {.im = im,
                 .list = list,
                 .is_float = number == COST_FLOAT,
                 .values = long_list_new(list),
                 .angle_rad = room(im->angles, sizeof *l.angle_rad),
                 .real = room(im->reals, sizeof *l.real),
                 .state = room(im->angles + im->reals, sizeof *l.state),
                 .input = room(im->inputs, sizeof *l.input),
                 .result = room(list->results, sizeof *l.result)};
    image_inputs(im, l.input);
    return l;
}

static void end(looking *l) {
    long_list_free(l->values);
    free(l->angle_rad);
    free(l->real);
    free(l->state);
    free(l->input);
    free(l->result);
}

/* As the number keeps it. */
static double kept(const looking *l, long double value) {
    return l->is_float ? (double)(float)value : (double)value;
}

/* Of two to which `value` is a factor of 1/2 to 1, by its bits; 0 for zero. */
static int exponent(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return value == 0.0 ? 0 : (int)(bits >> 52 & 0x7ffU) - 1022;
}

/* Bits that a sum's smaller operand is shifted by, and its result when leading digits cancel. */
static double shifted(const looking *l, double a, double b, double sum) {
    const int digits = l->is_float ? 24 : 53;
    const int apart = abs(exponent(a) - exponent(b));
    const int high = exponent(fabs(a) > fabs(b) ? a : b);
    const int cancelled = sum != 0.0 && exponent(sum) < high ? high - exponent(sum) : 0;
    return (apart < digits ? apart : digits) + (cancelled < digits ? cancelled : digits);
}

static void look_at_operation(const looking *l, int i, operand_share *to) {
    const op *o = &l->list->ops[i];
    const bool is_sum = o->code == OP_ADD || o->code == OP_SUB;
    if (!is_sum && o->code != OP_MUL) {
        return;
    }
    const double a = kept(l, long_list_value(l->values, o->a));
    const double b = kept(l, long_list_value(l->values, o->b)) * (o->code == OP_SUB ? -1.0 : 1.0);
    if (a == 0.0 || b == 0.0) {
        to->zero += 1.0;
    } else if (is_sum) {
        to->opposed += (a < 0.0) != (b < 0.0);
        to->bits += shifted(l, a, b, kept(l, long_list_value(l->values, i)));
    }
}

/* The components: reals of second order are positions, then the rates of all coordinates. */
static void look_at_components(const looking *l, operands *to) {
    const image *im = l->im;
    const bool second = im->form == WH_SECOND_ORDER;
    const int components = second ? im->coordinates : im->angles + im->reals;
    const long double *rate = l->state + im->angles + linears_of(im);
    for (int i = 0; i < components && l->list == im->list[IMAGE_STEP]; i++) {
        const bool is_led = second && kept(l, rate[i]) != 0.0;
        const bool is_driven = kept(l, l->result[i]) != 0.0;
        to->accel[i] += !is_driven;
        to->rate[i] += second && !is_led;
        if (i < im->angles) {
            to->still[i] += !is_led && !is_driven;
            to->at_zero[i] += l->state[i] == 0.0L;
        }
    }
    for (int i = 0; i < im->reals; i++) {
        to->real[i] += kept(l, l->state[im->angles + i]) == 0.0;
    }
}

/* Does everything in the state and in what follows from it have a value? */
static bool look(looking *l, const engine_kind *kind, void *run, operands *to) {
    const image *im = l->im;
    kind->state(run, l->angle_rad, l->real);
    for (int i = 0; i < im->angles + im->reals; i++) {
        const double value = i < im->angles ? l->angle_rad[i] : l->real[i - im->angles];
        if (!isfinite(value)) {
            return false;
        }
        l->state[i] = (long double)value;
    }
    const long double *real = l->state + im->angles;
    const long double time_s = (long double)(im->step_s * (double)kind->steps(run));
    const long_leaves in = {l->state, real, real + linears_of(im), l->input, time_s};
    long_list_run(l->values, &in, l->result);
    for (int i = 0; i < l->list->count; i++) {
        look_at_operation(l, i, &to->of[i]);
    }
    look_at_components(l, to);
    l->looks++;
    return true;
}

static void take_means(operands *to, int operations, int looks) {
    const double part = looks > 0 ? 1.0 / looks : 0.0;
    for (int i = 0; i < operations; i++) {
        to->of[i].zero *= part;
        to->of[i].opposed *= part;
        to->of[i].bits *= part;
    }
    for (int i = 0; i < IMAGE_COMPONENTS_MAX; i++) {
        to->rate[i] *= part;
        to->accel[i] *= part;
        to->still[i] *= part;
        to->at_zero[i] *= part;
        to->real[i] *= part;
    }
}

operands operands_of(const image *im, cost_number number) {
    const tape *list = im->list[im->settings.matrix != MATRIX_NONE ? IMAGE_MATRIX : IMAGE_STEP];
    const engine_kind *kind = number == COST_FLOAT ? &engine_float : &engine_double;
    operands to = {.of = room(list->count, sizeof *to.of), .is_float = number == COST_FLOAT};
    if (im->contacts > 0) {
        return to;
    }
    looking l = begin(im, list, number);
    void *run = kind->start(im);
    bool goes = true;
    for (int step = 1; step <= LAST && goes; step++) {
        goes = kind->step(run) == WH_OK;
        goes = goes && (step < FIRST || step % APART != 0 || look(&l, kind, run, &to));
    }
    kind->stop(run);
    take_means(&to, list->count, l.looks);
    end(&l);
    return to;
}

void operands_free(operands *o) { free(o->of); }
