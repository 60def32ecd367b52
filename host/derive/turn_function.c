/* turn_function.c: see turn_function.h. In double, by the program's own functions: the same on every host. */
#include "turn_function.h"

#include <math.h>

#define TURN_RAD 6.283185307179586477

/* Sine and cosine of parts of a turn: exact at quarter turns, and as symmetric as they are. */
static void wave_of(double turns, double *sine, double *cosine) {
    const double quarters = number_even(4.0 * turns);
    const double rest_rad = (turns - 0.25 * quarters) * TURN_RAD;
    const double s = number_sine(rest_rad);
    const double c = number_cosine(rest_rad);
    const int quarter = (int)(quarters - 4.0 * number_floor(0.25 * quarters));
    *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
    *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
}

static turn_value product_of(turn_value x, turn_value y) {
    return (turn_value){x.value * y.value, x.slope * y.value + x.value * y.slope, x.size * y.size};
}

static turn_value quotient_of(turn_value x, turn_value y) {
    const double value = x.value / y.value;
    return (turn_value){value, (x.slope - value * y.slope) / y.value,
                        (x.size + fabs(value) * y.size) / fabs(y.value)};
}

static turn_value function_of(function_id function, turn_value x, turn_value y) {
    const bool two = function_arguments(function) > 1;
    const double value = number_call(function, x.value, y.value);
    const double slope = number_slope(function, 0, x.value, y.value) * x.slope +
                         (two ? number_slope(function, 1, x.value, y.value) * y.slope : 0.0);
    return (turn_value){value, slope, fabs(value)};
}

static turn_value power_of(turn_value x, turn_value y) {
    const double value = number_power(x.value, y.value);
    const double by_exponent =
        y.slope == 0.0 ? 0.0 : value * number_call(FN_LOG, x.value, 0.0) * y.slope;
    return (turn_value){value, y.value * value / x.value * x.slope + by_exponent, fabs(value)};
}

static turn_value of_wave(op_code code, double turns, int multiple) {
    double sine;
    double cosine;
    wave_of(turns, &sine, &cosine);
    return code == OP_SIN
               ? (turn_value){sine, TURN_RAD * multiple * cosine, multiple != 0 ? 1.0 : fabs(sine)}
               : (turn_value){cosine, -TURN_RAD * multiple * sine,
                              multiple != 0 ? 1.0 : fabs(cosine)};
}

void turn_evaluate(const tape *t, const int *multiple, double turns, turn_value *value) {
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const int values = op_rows[o->code].values;
        const turn_value none = {0.0, 0.0, 0.0};
        const turn_value x = values > 0 ? value[o->a] : none;
        const turn_value y = values > 1 && o->b >= 0 ? value[o->b] : none;
        switch (o->code) {
        case OP_CONSTANT: value[i] = (turn_value){o->value, 0.0, fabs(o->value)}; break;
        case OP_SIN:
        case OP_COS: {
            const double way = multiple[o->a] * turns;
            const double within = way - number_floor(way);
            value[i] = of_wave(o->code, within + t->ops[o->a].value / TURN_RAD, multiple[o->a]);
            break;
        }
        case OP_ADD:
            value[i] = (turn_value){x.value + y.value, x.slope + y.slope, x.size + y.size};
            break;
        case OP_SUB:
            value[i] = (turn_value){x.value - y.value, x.slope - y.slope, x.size + y.size};
            break;
        case OP_NEG: value[i] = (turn_value){-x.value, -x.slope, x.size}; break;
        case OP_MUL: value[i] = product_of(x, y); break;
        case OP_DIV: value[i] = quotient_of(x, y); break;
        case OP_SQRT: value[i] = function_of(FN_SQRT, x, y); break;
        case OP_CALL: value[i] = function_of(o->function, x, y); break;
        case OP_POW: value[i] = power_of(x, y); break;
        case OP_PHASE:  /* no value of its own */
        case OP_LINEAR: /* and these are in no such list */
        case OP_RATE:
        case OP_INPUT:
        case OP_ACCEL:
        case OP_TIME:
        case OP_RADIANS:
        case OP_NOISE:
        case OP_ABS:
        case OP_SIGN:
        case OP_MIN:
        case OP_MAX:
        case OP_CELL:
        case OP_LINE:
        case OP_CUBIC: value[i] = none; break;
        }
    }
}
