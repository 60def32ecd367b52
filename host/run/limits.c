/* limits.c: see limits.h. The shares are those of the double build. */
#define WH_DOUBLE 1
#include "limits.h"

#include <math.h>

#include "core/method.h"
#include "host/number/functions.h"

/* Beyond any method's interval, and how finely it is looked at; a growth a step that is rounding. */
#define INTERVAL_MOST 8.0
#define INTERVAL_STEPS 4000
#define GROWTH_LEAST 1e-13
/* Growth beyond exp() of this is beyond all. */
#define LOG_MOST 500.0

static complex_number plus_times(complex_number a, complex_number b, complex_number c) {
    return (complex_number){a.re + b.re * c.re - b.im * c.im, a.im + b.re * c.im + b.im * c.re};
}

static complex_number times_real(complex_number a, double by) {
    return (complex_number){a.re * by, a.im * by};
}

/* |R(z)|, the stability polynomial of the row. */
static double growth_of_first(const wh_tableau *by, complex_number z) {
    complex_number k[WH_STAGES_MAX];
    complex_number end = {1.0, 0.0};
    for (unsigned i = 0; i < by->stages; i++) {
        k[i] = (complex_number){1.0, 0.0};
        for (unsigned j = 0; j < i; j++) {
            k[i] =
                plus_times(k[i], times_real(z, by->stage[i].share[j] / by->stage[i].parts), k[j]);
        }
        end = plus_times(end, times_real(z, by->rates[i] / by->parts), k[i]);
    }
    return complex_size(end);
}

/* A step of q'' = -stiffness q + damping q', h = 1, from (q, v). */
static void step_second(const wh_tableau *by, double stiffness, double damping, double *q,
                        double *v) {
    double rate[WH_STAGES_MAX];
    double accel[WH_STAGES_MAX];
    double ends[2] = {*q + *v, *v};
    for (unsigned i = 0; i < by->stages; i++) {
        const wh_shares *share = &by->stage[i];
        double place = *q + (by->places != NULL ? by->places->node[i] * *v : 0.0);
        rate[i] = *v;
        for (unsigned j = 0; j < i; j++) {
            rate[i] += share->share[j] / share->parts * accel[j];
            place += by->places != NULL
                         ? by->places->reach[i].share[j] / by->places->reach[i].parts * accel[j]
                         : share->share[j] / share->parts * rate[j];
        }
        accel[i] = -stiffness * place + damping * rate[i];
        ends[0] += by->positions[i] / by->parts * accel[i];
        ends[1] += by->rates[i] / by->parts * accel[i];
    }
    *q = ends[0];
    *v = ends[1];
}

typedef struct oscillator {
    double a, b, c, d; /* the step's matrix of (q, v), h = 1 */
    bool swings;
    bool rates;
    double stiffness;
} oscillator;

static oscillator oscillator_of(wh_method method, complex_number z) {
    const wh_tableau *by = wh_tableau_of(method);
    oscillator o = {.swings = z.im != 0.0, .rates = wh_methods[method].takes != WH_NO_RATES};
    const double damping = o.rates ? (o.swings ? 2.0 : 1.0) * z.re : 0.0;
    o.stiffness = o.swings ? z.re * z.re + z.im * z.im : o.rates ? 0.0 : -z.re * z.re;
    double begin[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    step_second(by, o.stiffness, damping, &begin[0][0], &begin[0][1]);
    step_second(by, o.stiffness, damping, &begin[1][0], &begin[1][1]);
    o.a = begin[0][0];
    o.c = begin[0][1];
    o.b = begin[1][0];
    o.d = begin[1][1];
    return o;
}

static double growth_of_second(const oscillator *o) {
    const double half_trace = 0.5 * (o->a + o->d);
    const double determinant = o->a * o->d - o->b * o->c;
    if (!o->swings && o->rates) {
        return fabs(determinant); /* the other one is that of standing still: 1 */
    }
    const double disc = half_trace * half_trace - determinant;
    return disc < 0.0 ? number_root(determinant) : fabs(half_trace) + number_root(disc);
}

/* A step goes round on an ellipse where the motion goes round on a circle, in (w q, v): by how much the energy goes up and
 * down on it. It is the form that the step's matrix keeps but for a factor: b v^2 + (a - d) q v - c q^2. */
static double ripple(const oscillator *o) {
    const double w = number_root(o->stiffness);
    const double mean = 0.5 * (o->b * w - o->c / w);
    const double half = 0.5 * (o->b * w + o->c / w);
    const double off = 0.5 * (o->a - o->d);
    return mean != 0.0 ? number_least(number_root(half * half + off * off) / fabs(mean), 1.0) : 1.0;
}

double limits_growth(wh_method method, wh_form form, complex_number value, double step_s) {
    const complex_number z = times_real(value, step_s);
    if (form == WH_FIRST_ORDER) {
        return growth_of_first(wh_tableau_of(method), z);
    }
    const oscillator o = oscillator_of(method, z);
    return growth_of_second(&o);
}

/* As if it were not damped: a damped oscillator has such an ellipse by itself. Not of one that soon decays. */
double limits_ripple(wh_method method, wh_form form, complex_number value, double step_s) {
    if (form == WH_FIRST_ORDER || fabs(value.re) > 0.1 * fabs(value.im)) {
        return 0.0;
    }
    const oscillator o = oscillator_of(method, (complex_number){0.0, complex_size(value) * step_s});
    return ripple(&o);
}

double limits_exact(complex_number value, double step_s) {
    return number_call(FN_EXP, value.re * step_s, 0.0);
}

double limits_off(wh_method method, wh_form form, complex_number value, double step_s,
                  double span_s) {
    const double exact = limits_exact(value, step_s);
    const double growth = limits_growth(method, form, value, step_s);
    const double steps = number_most(span_s / step_s, 1.0);
    if (growth > 1.0 && growth > exact) {
        const double more = steps * number_call(FN_LOG, growth / number_most(exact, 1.0), 0.0);
        return more < LOG_MOST ? number_call(FN_EXP, more, 0.0) - 1.0 : (double)INFINITY;
    }
    if (exact >= 1.0) {
        const double left = steps * number_call(FN_LOG, growth / exact, 0.0);
        return 1.0 - number_call(FN_EXP, number_least(left, 0.0), 0.0);
    }
    /* what steps have taken is largest when the motion has gone down to a third */
    const double lasts = number_most(number_least(steps, -1.0 / (value.re * step_s)), 1.0);
    const double left = number_call(FN_EXP, value.re * step_s * (lasts - 1.0), 0.0);
    return number_least(1.0, lasts * left * fabs(growth - exact));
}

double limits_interval(wh_method method, wh_form form, complex_number direction) {
    const double size = complex_size(direction);
    const complex_number one = times_real(direction, 1.0 / size);
    double low = 0.0;
    double high = INTERVAL_MOST;
    for (int k = 1; k <= INTERVAL_STEPS; k++) {
        const double h = INTERVAL_MOST * k / INTERVAL_STEPS;
        if (limits_growth(method, form, one, h) > 1.0 + GROWTH_LEAST) {
            high = h;
            break;
        }
        low = h;
    }
    for (int k = 0; k < 60 && low > 0.0; k++) {
        const double middle = 0.5 * (low + high);
        if (limits_growth(method, form, one, middle) > 1.0 + GROWTH_LEAST) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return low;
}
