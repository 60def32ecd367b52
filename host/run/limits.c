/* limits.c: see limits.h. The shares are those of the double build. */
#define WH_DOUBLE 1
#include "limits.h"

#include <math.h>
#include <string.h>

#include "core/method.h"
#include "host/number/functions.h"

/* Beyond any method's interval, and how finely it is looked at; a growth a step that is rounding. */
#define INTERVAL_MOST 8.0
#define INTERVAL_STEPS 4000
#define GROWTH_LEAST 1e-13
/* Of what turns, so that nothing is symmetric, methods with positions of their own let something grow at any step, by a
 * power of it: less than this a step is none. Where that begins below SLOWEST there is no step that is stable. */
#define GROWTH_TURNING 1e-6
#define SLOWEST 0.1
/* A vector of theirs is followed in so many shorter steps a radian. */
#define FOLLOWED 10.0
/* Rates that are off the oscillator's by less of the eigenvalue are its: differences that linearise are off by as much. */
#define TURNS_LEAST 1e-6
/* Growth beyond exp() of this is beyond all. */
#define LOG_MOST 500.0

static complex_number times_real(complex_number a, double by) {
    return (complex_number){a.re * by, a.im * by};
}

static complex_number plus_real_times(complex_number a, double by, complex_number b) {
    return (complex_number){a.re + by * b.re, a.im + by * b.im};
}

/* |R(z)|, the stability polynomial of the row. */
static double growth_of_first(const wh_tableau *by, complex_number z) {
    complex_number k[WH_STAGES_MAX];
    complex_number end = {1.0, 0.0};
    for (unsigned i = 0; i < by->stages; i++) {
        k[i] = (complex_number){1.0, 0.0};
        for (unsigned j = 0; j < i; j++) {
            k[i] = complex_plus_times(
                k[i], times_real(z, by->stage[i].share[j] / by->stage[i].parts), k[j]);
        }
        end = complex_plus_times(end, times_real(z, by->rates[i] / by->parts), k[i]);
    }
    return complex_size(end);
}

/* A step of q'' = rates q' - stiffness q, h = 1, from (q, v). */
static void step_second(const wh_tableau *by, complex_number stiffness, complex_number rates,
                        complex_number *q, complex_number *v) {
    const complex_number pull = {-stiffness.re, -stiffness.im};
    complex_number rate[WH_STAGES_MAX];
    complex_number accel[WH_STAGES_MAX];
    complex_number ends[2] = {{q->re + v->re, q->im + v->im}, *v};
    for (unsigned i = 0; i < by->stages; i++) {
        const wh_shares *share = &by->stage[i];
        complex_number place = *q;
        rate[i] = *v;
        if (by->places != NULL) {
            place = plus_real_times(place, by->places->node[i], *v);
        }
        for (unsigned j = 0; j < i; j++) {
            rate[i] = plus_real_times(rate[i], share->share[j] / share->parts, accel[j]);
            place = by->places != NULL
                        ? plus_real_times(
                              place, by->places->reach[i].share[j] / by->places->reach[i].parts,
                              accel[j])
                        : plus_real_times(place, share->share[j] / share->parts, rate[j]);
        }
        accel[i] = complex_plus_times(complex_plus_times((complex_number){0.0, 0.0}, pull, place),
                                      rates, rate[i]);
        ends[0] = plus_real_times(ends[0], by->positions[i] / by->parts, accel[i]);
        ends[1] = plus_real_times(ends[1], by->rates[i] / by->parts, accel[i]);
    }
    *q = ends[0];
    *v = ends[1];
}

limits_motion limits_plain(complex_number value) {
    return (limits_motion){value, {value.im != 0.0 ? 2.0 * value.re : value.re, 0.0}};
}

limits_motion limits_scaled(limits_motion m, double by) {
    return (limits_motion){times_real(m.value, by), times_real(m.rates, by)};
}

/* Does it turn, so that its stiffness is no real number or not all of it? */
static bool turns(limits_motion m) {
    const complex_number plain = limits_plain(m.value).rates;
    const complex_number off = {m.rates.re - plain.re, m.rates.im - plain.im};
    return m.value.im != 0.0 && complex_size(off) > TURNS_LEAST * complex_size(m.value);
}

typedef struct oscillator {
    complex_number a, b, c, d; /* the step's matrix of (q, v), h = 1 */
    bool swings;
    bool rates;
    double stiffness; /* of one that does not turn */
} oscillator;

/* `z`: in a step of one. */
static oscillator oscillator_of(wh_method method, limits_motion z) {
    const wh_tableau *by = wh_tableau_of(method);
    const complex_number value = z.value;
    oscillator o = {.swings = value.im != 0.0, .rates = wh_methods[method].takes != WH_NO_RATES};
    complex_number rates = {o.rates ? limits_plain(value).rates.re : 0.0, 0.0};
    o.stiffness = o.swings  ? value.re * value.re + value.im * value.im
                  : o.rates ? 0.0
                            : -value.re * value.re;
    complex_number stiffness = {o.stiffness, 0.0};
    if (o.rates && turns(z)) {
        const complex_number left = {z.rates.re - value.re, z.rates.im - value.im};
        rates = z.rates;
        stiffness = complex_plus_times((complex_number){0.0, 0.0}, left, value);
    }
    complex_number begin[2][2] = {{{1.0, 0.0}, {0.0, 0.0}}, {{0.0, 0.0}, {1.0, 0.0}}};
    step_second(by, stiffness, rates, &begin[0][0], &begin[0][1]);
    step_second(by, stiffness, rates, &begin[1][0], &begin[1][1]);
    o.a = begin[0][0];
    o.c = begin[0][1];
    o.b = begin[1][0];
    o.d = begin[1][1];
    return o;
}

static double growth_of_second(const oscillator *o) {
    const double half_trace = 0.5 * (o->a.re + o->d.re);
    const double determinant = o->a.re * o->d.re - o->b.re * o->c.re;
    if (!o->swings && o->rates) {
        return fabs(determinant); /* the other one is that of standing still: 1 */
    }
    const double disc = half_trace * half_trace - determinant;
    return disc < 0.0 ? number_root(determinant) : fabs(half_trace) + number_root(disc);
}

/* The vector (size q, v) that the step's matrix stretches by `mu`: of two ways to have it the longer. */
static void vector_of(const oscillator *o, complex_number mu, double size, complex_number x[2]) {
    const complex_number by_b[2] = {times_real(o->b, size), plus_real_times(mu, -1.0, o->a)};
    const complex_number by_c[2] = {times_real(plus_real_times(mu, -1.0, o->d), size), o->c};
    const double long_b = number_most(complex_size(by_b[0]), complex_size(by_b[1]));
    const double long_c = number_most(complex_size(by_c[0]), complex_size(by_c[1]));
    const double most = number_most(long_b, long_c);
    for (int i = 0; i < 2; i++) {
        x[i] = times_real(long_b >= long_c ? by_b[i] : by_c[i], most > 0.0 ? 1.0 / most : 0.0);
    }
}

/* How much two vectors of size about one have in common: their product, by their lengths. */
static double alike(const complex_number x[2], const complex_number y[2]) {
    complex_number both = {0.0, 0.0};
    double lengths[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++) {
        both = complex_plus_times(both, (complex_number){x[i].re, -x[i].im}, y[i]);
        lengths[0] += x[i].re * x[i].re + x[i].im * x[i].im;
        lengths[1] += y[i].re * y[i].re + y[i].im * y[i].im;
    }
    const double length = number_root(lengths[0] * lengths[1]);
    return length > 0.0 ? complex_size(both) / length : 0.0;
}

/* The step's matrix has two factors, and the other belongs to another motion. Which one is this one's is told by its
 * vector, which is (1, value) in short steps, and is followed from there. */
static double growth_of_turning(wh_method method, limits_motion z) {
    const complex_number none = {0.0, 0.0};
    const double size = complex_size(z.value);
    const int parts = 1 + (int)(FOLLOWED * number_least(size, INTERVAL_MOST));
    complex_number x[2] = {{1.0, 0.0}, times_real(z.value, 1.0 / size)};
    double growth = 1.0;
    for (int k = 1; k <= parts; k++) {
        const oscillator o = oscillator_of(method, limits_scaled(z, (double)k / parts));
        const complex_number half = {0.5 * (o.a.re + o.d.re), 0.5 * (o.a.im + o.d.im)};
        const complex_number apart = {0.5 * (o.a.re - o.d.re), 0.5 * (o.a.im - o.d.im)};
        const complex_number root =
            complex_root(complex_plus_times(complex_plus_times(none, apart, apart), o.b, o.c));
        complex_number y[2][2];
        const complex_number mu[2] = {plus_real_times(half, 1.0, root),
                                      plus_real_times(half, -1.0, root)};
        for (int i = 0; i < 2; i++) {
            vector_of(&o, mu[i], size * k / parts, y[i]);
        }
        const int own = alike(x, y[0]) >= alike(x, y[1]) ? 0 : 1;
        growth = complex_size(mu[own]);
        memcpy(x, y[own], sizeof x);
    }
    return growth;
}

/* A step goes round on an ellipse where the motion goes round on a circle, in (w q, v): by how much the energy goes up and
 * down on it. It is the form that the step's matrix keeps but for a factor: b v^2 + (a - d) q v - c q^2. */
static double ripple(const oscillator *o) {
    const double w = number_root(o->stiffness);
    const double mean = 0.5 * (o->b.re * w - o->c.re / w);
    const double half = 0.5 * (o->b.re * w + o->c.re / w);
    const double off = 0.5 * (o->a.re - o->d.re);
    return mean != 0.0 ? number_least(number_root(half * half + off * off) / fabs(mean), 1.0) : 1.0;
}

double limits_growth(wh_method method, wh_form form, limits_motion m, double step_s) {
    const limits_motion z = limits_scaled(m, step_s);
    if (form == WH_FIRST_ORDER) {
        return growth_of_first(wh_tableau_of(method), z.value);
    }
    if (wh_methods[method].takes != WH_NO_RATES && turns(z)) {
        return growth_of_turning(method, z);
    }
    const oscillator o = oscillator_of(method, z);
    return growth_of_second(&o);
}

/* As if it were not damped: a damped oscillator has such an ellipse by itself. Not of one that soon decays. Where rates
 * make it turn, of that part which places do. */
double limits_ripple(wh_method method, wh_form form, limits_motion m, double step_s) {
    const double size = complex_size(m.value);
    if (form == WH_FIRST_ORDER || fabs(m.value.re) > 0.1 * fabs(m.value.im)) {
        return 0.0;
    }
    const oscillator o = oscillator_of(method, limits_plain((complex_number){0.0, size * step_s}));
    const complex_number by_places = {m.rates.re - m.value.re, m.rates.im - m.value.im};
    return ripple(&o) * (turns(m) ? number_least(complex_size(by_places) / size, 1.0) : 1.0);
}

double limits_exact(complex_number value, double step_s) {
    return number_call(FN_EXP, value.re * step_s, 0.0);
}

double limits_off(wh_method method, wh_form form, limits_motion m, double step_s, double span_s) {
    const complex_number value = m.value;
    const double exact = limits_exact(value, step_s);
    const double growth = limits_growth(method, form, m, step_s);
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

double limits_interval(wh_method method, wh_form form, limits_motion m) {
    const limits_motion one = limits_scaled(m, 1.0 / complex_size(m.value));
    const bool turning = form == WH_SECOND_ORDER && turns(one);
    const double most = 1.0 + (turning ? GROWTH_TURNING : GROWTH_LEAST);
    double low = 0.0;
    double high = INTERVAL_MOST;
    const int steps = turning ? INTERVAL_STEPS / 10 : INTERVAL_STEPS;
    for (int k = 1; k <= steps; k++) {
        const double h = INTERVAL_MOST * k / steps;
        if (limits_growth(method, form, one, h) > most) {
            high = h;
            break;
        }
        low = h;
    }
    for (int k = 0; k < 60 && low > 0.0; k++) {
        const double middle = 0.5 * (low + high);
        if (limits_growth(method, form, one, middle) > most) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return turning && one.value.re == 0.0 && low < SLOWEST ? 0.0 : low;
}
