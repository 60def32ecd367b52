#include "books.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/number/gauss.h"

books *books_open(const image *im) {
    if (!im->has_energies) {
        return NULL;
    }
    const int results = im->list[IMAGE_BOOKS]->results;
    books *b = alloc(1, sizeof *b);
    b->image = im;
    b->list = state_list_open(im, IMAGE_BOOKS);
    b->value = b->list.result;
    b->off = alloc(results + 5 * (int64_t)im->count, sizeof *b->off);
    b->momentum = b->off + results;
    b->drift = b->momentum + im->count;
    b->momentum_now = b->drift + im->count;
    b->rateless = b->momentum_now + im->count;
    b->terms = b->rateless + im->count;
    b->rate = alloc(2 * (int64_t)im->count, sizeof *b->rate);
    b->push = b->rate + im->count;
    b->frame = alloc(im->count, sizeof *b->frame);
    b->step_s = im->step_s;
    return b;
}

void books_close(books *b) {
    if (b != NULL) {
        state_list_close(&b->list);
        free(b->off);
        free(b->rate);
        free(b->frame);
        free(b);
    }
}

/* --- swings ------------------------------------------------------------------------------------*/

static void spread_enter(spread *s, double value, uint64_t before) {
    if (before == 0) {
        s->first = value;
    }
    const double off = value - s->first - s->mean;
    s->mean += off / (double)(before + 1);
    s->squares += off * (value - s->first - s->mean);
}

/* The range of a sine with the same standard deviation: sqrt(8) standard deviations. */
static double swing(const spread *s, uint64_t entries) {
    return entries > 0 ? number_root(8.0 * s->squares / (double)entries) : 0.0;
}

double books_momentum(const books *b, int unknown) {
    const spread *s = &b->push[unknown];
    const double mean = b->frame[unknown] ? 0.0 : s->first + s->mean;
    return b->entries > 0 ? number_root(s->squares / (double)b->entries + mean * mean) : 0.0;
}

double books_swing_J(const books *b) {
    double most = number_most(swing(&b->kinetic, b->entries), swing(&b->stored, b->entries));
    for (int i = 0; i < b->image->count && b->entries > 0; i++) {
        most = number_most(most, 0.5 * books_momentum(b, i) * swing(&b->rate[i], b->entries));
    }
    return most;
}

/* --- round-off ---------------------------------------------------------------------------------*/

#define FLOAT_LEAST 0x1p-126 /* smallest normal float */
#define SUMS_OF_A_STEP 8.0   /* assumed number of roundings of a ledger entry in one step */
#define SLOPE_SHARE 0x1p-20  /* a component is changed by this part to measure the energy's slope */

static void evaluate_now(const books *b, const double *state) {
    const image *im = b->image;
    evaluator_run(b->list.evaluator, b->time_s, state, state + im->angles, state + im->coordinates,
                  b->list.input, b->value);
    for (int i = 0; i < im->list[IMAGE_BOOKS]->results; i++) {
        b->value[i] = number_shown(b->value[i]); /* -0 becomes 0 */
    }
}

/* Returns the checked energy if `value` is b->value, or the bound on its round-off if `value` is b->off. */
static double energy_of(const image *im, const double *value) {
    const double *entry = value + im->count;
    return im->has_integral ? entry[BOOK_MOMENTA + im->count]
                            : entry[BOOK_KINETIC] + entry[BOOK_STORED];
}

static double unit_rounding(const engine_kind *kind) {
    return kind == &engine_float ? 0x1p-24 : 0x1p-53;
}

typedef struct state_rounding {
    double by;     /* round-off of a state component in one step */
    double change; /* the component is changed by this to measure the energy's slope */
} state_rounding;

static state_rounding rounding_of_component(const image *im, const engine_kind *kind,
                                            const void *run, int i, double value) {
    const bool turns = kind == &engine_float && i < im->angles;
    if (kind->unit != NULL) { /* fixed point: the component and its sums are rounded to this unit */
        const double unit = kind->unit(run, i);
        return (state_rounding){unit, number_most(SLOPE_SHARE * fabs(value), unit)};
    }
    return turns ? (state_rounding){0x1p-33 * 6.283185307179586, SLOPE_SHARE}
                 : (state_rounding){unit_rounding(kind) * fabs(value), SLOPE_SHARE * value};
}

/* The largest energy change if each component of the state is rounded once; 0 if it is not finite. */
static double state_rounding_J(const books *b, const engine_kind *kind, const void *run) {
    const image *im = b->image;
    double state[3 * IMAGE_COMPONENTS_MAX];
    double sum = 0.0;
    memcpy(state, b->state, sizeof state);
    for (int i = 0; i < im->angles + im->reals; i++) {
        const state_rounding rounding = rounding_of_component(im, kind, run, i, b->state[i]);
        const component c = image_component(im, i);
        /* a constant rate has no round-off */
        const spread *rate = &b->rate[c.unknown];
        const bool still = c.primes == 1 && !rate->pushed && rate->squares == 0.0;
        if (rounding.change != 0.0 && !still) {
            state[i] += rounding.change;
            evaluate_now(b, state);
            sum +=
                fabs((energy_of(im, b->value) - b->energy_J[1]) * (rounding.by / rounding.change));
            state[i] = b->state[i];
        }
    }
    return isfinite(sum) ? sum : 0.0;
}

/* Energy error of one step by the round-off of accelerations, input power and loss power. */
static double step_rounding_J(const books *b, const engine_kind *kind) {
    const image *im = b->image;
    const double *entry = b->value + im->count;
    double sum_W = 0.0;
    for (int i = 0; i < im->count; i++) {
        const double power_W = entry[BOOK_MOMENTA + i] * b->off[i];
        sum_W += isfinite(power_W) ? unit_rounding(kind) * fabs(power_W) : 0.0;
    }
    for (int k = BOOK_INPUT_POWER; k <= BOOK_LOSS_POWER; k++) {
        const double off_W = b->off[im->count + k];
        sum_W += isfinite(off_W) ? 0x1p-53 * off_W : 0.0;
    }
    return sum_W * b->step_s;
}

/* Energy that the ledger may lose to underflow in one step. Zero unless the run is in float and has contacts. */
static double step_lost_J(const books *b, const engine_kind *kind) {
    const image *im = b->image;
    if (im->contacts == 0 || kind != &engine_float) {
        return 0.0;
    }
    double without_W = 0.0;
    double with_W = 0.0;
    for (int k = BOOK_INPUT_POWER; k <= BOOK_LOSS_POWER; k++) {
        without_W += b->off[im->count + k];
    }
    evaluator_rounding(b->list.evaluator, b->state, FLOAT_LEAST, b->off);
    for (int k = BOOK_INPUT_POWER; k <= BOOK_LOSS_POWER; k++) {
        with_W += b->off[im->count + k];
    }
    const double lost_W = with_W - without_W;
    const double entries = im->ledger.smooth + im->contacts + im->inputs;
    return 0x1p-24 *
           (SUMS_OF_A_STEP * entries * FLOAT_LEAST + (isfinite(lost_W) ? b->step_s * lost_W : 0.0));
}

/* Updates terms[]. The term of a rate is the momentum minus the momentum with this rate at 0. */
static void look_at_momenta(books *b) {
    const image *im = b->image;
    double state[3 * IMAGE_COMPONENTS_MAX];
    double sum[IMAGE_COMPONENTS_MAX];
    memcpy(state, b->state, sizeof state);
    for (int i = 0; i < im->count; i++) {
        sum[i] = fabs(b->rateless[i]);
    }
    for (int k = im->angles; k < im->angles + im->reals; k++) {
        if (image_component(im, k).primes == 1 && state[k] != 0.0) {
            state[k] = 0.0;
            evaluate_now(b, state);
            state[k] = b->state[k];
            for (int i = 0; i < im->count; i++) {
                sum[i] += fabs(b->momentum_now[i] - b->value[im->count + BOOK_MOMENTA + i]);
            }
        }
    }
    for (int i = 0; i < im->count; i++) {
        b->terms[i] = number_most(b->terms[i], sum[i]);
    }
}

static void look_at_rounding(books *b, const engine_kind *kind, const void *run) {
    const double state_J = state_rounding_J(b, kind, run);
    look_at_momenta(b);
    evaluate_now(b, b->state);
    evaluator_rounding(b->list.evaluator, b->state, 0.0, b->off);
    const double off_J = energy_of(b->image, b->off);
    b->rounding_J = number_most(b->rounding_J, state_J + step_rounding_J(b, kind));
    b->computing_J = number_most(b->computing_J, isfinite(off_J) ? 0x1p-53 * off_J : 0.0);
    b->lost_J = number_most(b->lost_J, step_lost_J(b, kind));
}

double books_rounding_J(books *b, const engine_kind *kind, const void *run) {
    look_at_rounding(b, kind, run);
    return b->rounding_J + 0x1p-52 * b->size_J;
}

/* --- the balance -------------------------------------------------------------------------------*/

/* Error bound of Simpson's rule for two steps. */
static double rule_off_J(double step_s, double begin_W, double middle_W, double end_W) {
    const double rules_J = fabs(step_s / 6.0 * (2.0 * middle_W - begin_W - end_W));
    const double change_J = 0.5 * step_s * (fabs(middle_W - begin_W) + fabs(end_W - middle_W));
    return rules_J > 0.1 * change_J ? change_J : rules_J;
}

/* Simpson's rule takes two steps at once. The first of them counts as a trapezoid until the second one is entered. */
static void add_work(books *b, const double power_W[2]) {
    double *work[2] = {&b->input_J, &b->loss_J};
    double off_J = 0.0;
    for (int k = 0; k < 2; k++) {
        if (b->entries % 2 == 1) {
            *work[k] += 0.5 * b->step_s * (b->power_W[0][k] + power_W[k]);
            b->power_W[1][k] = power_W[k];
        } else {
            *work[k] -= 0.5 * b->step_s * (b->power_W[0][k] + b->power_W[1][k]);
            const double ends_W = b->power_W[0][k] + power_W[k];
            const double middle_W = b->power_W[1][k];
            *work[k] += b->step_s / 3.0 * (ends_W + 4.0 * middle_W);
            off_J += rule_off_J(b->step_s, b->power_W[0][k], middle_W, power_W[k]);
            b->power_W[0][k] = power_W[k];
        }
    }
    b->rule_J += off_J;
    b->pair_J = number_most(b->pair_J, off_J);
}

double books_rule_J(const books *b) {
    const bool is_even = b->entries % 2 == 1; /* entries = steps + 1 */
    return is_even ? b->rule_J : b->entries > 2 ? b->rule_J + b->pair_J : (double)INFINITY;
}

/* --- terms linear in the rates -------------------------------------------------------------------*/

/* Returns the kinetic energy with all rates reversed, and sets rateless[] to the momenta of that state. */
static double reversed_J(books *b, const double *from) {
    const image *im = b->image;
    double state[3 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < im->angles + im->reals; i++) {
        state[i] = image_component(im, i).primes == 1 ? -from[i] : from[i];
    }
    evaluate_now(b, state);
    memcpy(b->rateless, b->value + im->count + BOOK_MOMENTA,
           (size_t)im->count * sizeof *b->rateless);
    return b->value[im->count + BOOK_KINETIC];
}

static void take_rateless(books *b) {
    for (int i = 0; i < b->image->count; i++) {
        b->rateless[i] = 0.5 * (b->rateless[i] + b->value[b->image->count + BOOK_MOMENTA + i]);
    }
}

/* Is any rateless[i] nonzero at a test state? Returns false if a coordinate is recovered from its momentum. */
static bool find_rateless(books *b) {
    const image *im = b->image;
    double state[3 * IMAGE_COMPONENTS_MAX];
    double *real = state + im->angles;
    bool found = false;
    for (int k = 1; k <= 3 && im->recovered == 0; k++) {
        memcpy(state, b->state, sizeof state);
        for (int i = 0; i < im->angles; i++) {
            state[i] += 0.37 * k * (i + 1);
        }
        for (int i = 0; i < im->reals; i++) {
            real[i] += (0.61 * k * (i + 1)) * (1.0 + fabs(real[i]));
        }
        (void)reversed_J(b, state);
        evaluate_now(b, state);
        take_rateless(b);
        double most = 0.0;
        for (int i = 0; i < im->count; i++) {
            most = number_most(most, fabs(b->value[im->count + BOOK_MOMENTA + i]));
        }
        for (int i = 0; i < im->count; i++) {
            found = found || (isfinite(most) && fabs(b->rateless[i]) > 1e-9 * most);
        }
    }
    return found;
}

/* --- momenta that every motion conserves ---------------------------------------------------------------*/

enum { FRAME_MOST = 24 };  /* largest number of momenta for find_frame() */
#define FRAME_ASIDE_S 1e-5 /* half the duration of the motion in momenta_change(), s */
#define FRAME_LEAST 1e-6   /* momentum changes below this part of the largest one are round-off */

/* change[i]: the decrease of momentum i during a short motion through random state `draw`. */
static bool momenta_change(books *b, int draw, double *change) {
    const image *im = b->image;
    double to[2][3 * IMAGE_COMPONENTS_MAX];
    double from[3 * IMAGE_COMPONENTS_MAX];
    bool finite = true;
    for (int i = 0; i < im->angles + im->reals; i++) {
        const uint32_t drawn = (uint32_t)(draw * (im->angles + im->reals) + i + 1) * 2654435769U;
        const double at = b->state[i];
        from[i] = at + (0x1p-31 * (double)drawn - 1.0) * (1.0 + fabs(at));
    }
    evaluate_now(b, from);
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        const int rate = c.primes == 0 ? image_find_component(im, c.unknown, 1) : -1;
        const double slope = rate >= 0 ? from[rate] : b->value[c.unknown];
        to[0][i] = from[i] - FRAME_ASIDE_S * slope;
        to[1][i] = from[i] + FRAME_ASIDE_S * slope;
    }
    for (int k = 0; k < 2; k++) {
        evaluate_now(b, to[k]);
        for (int i = 0; i < im->count; i++) {
            const double p = b->value[im->count + BOOK_MOMENTA + i];
            change[i] = k == 0 ? p : change[i] - p;
            finite = finite && isfinite(change[i]);
        }
    }
    return finite;
}

/* Sets frame[i] if momentum i is a term of a conserved sum of momenta. */
static void find_frame(books *b) {
    const int n = b->image->count;
    const int rows = 2 * n;
    if (n > FRAME_MOST || b->image->recovered > 0) {
        return;
    }
    double *a = alloc((int64_t)rows * n, sizeof *a);
    int lead[FRAME_MOST];
    bool leads[FRAME_MOST] = {false};
    double most = 0.0;
    bool known = true;
    for (int r = 0; r < rows && known; r++) {
        known = momenta_change(b, r, a + r * n);
        for (int i = 0; i < n && known; i++) {
            most = number_most(most, fabs(a[r * n + i]));
        }
    }
    const int rank = known ? gauss_reduce(a, rows, n, n, false, FRAME_LEAST * most, lead) : 0;
    for (int r = 0; r < rank; r++) {
        leads[lead[r]] = true;
    }
    for (int c = 0; c < n && known; c++) {
        for (int r = -1; r < rank && !leads[c]; r++) {
            const int i = r < 0 ? c : lead[r];
            const double share = r < 0 ? 1.0 : fabs(a[r * n + c] / a[r * n + i]);
            b->frame[i] = b->frame[i] || share > FRAME_LEAST;
        }
    }
    free(a);
}

#define NEGATIVE 1e-6 /* a kinetic energy below -NEGATIVE * size_J is not round-off */

/* --- all of a step ---------------------------------------------------------------------------------*/

void books_enter(books *b, const engine_kind *kind, const void *run) {
    const image *im = b->image;
    kind->state(run, b->state, b->state + im->angles);
    b->time_s = (double)kind->steps(run) * b->step_s;
    if (b->entries == 0) {
        if (kind == &engine_float) {
            evaluator_wrap(b->list.evaluator);
        }
        b->has_rateless = find_rateless(b);
        find_frame(b);
        memset(b->rateless, 0, (size_t)im->count * sizeof *b->rateless);
    }
    const double back_J = b->has_rateless ? reversed_J(b, b->state) : 0.0;
    evaluate_now(b, b->state);
    const double *entry = b->value + im->count;
    b->moving_J[1] = entry[BOOK_KINETIC];
    if (b->has_rateless) {
        b->moving_J[1] = 0.5 * (b->moving_J[1] + back_J);
        take_rateless(b);
    }
    const double power_W[2] = {entry[BOOK_INPUT_POWER], entry[BOOK_LOSS_POWER]};
    b->kinetic_J[1] = entry[BOOK_KINETIC];
    b->stored_J[1] = entry[BOOK_STORED];
    b->energy_J[1] = energy_of(im, b->value);
    if (b->entries == 0) {
        b->kinetic_J[0] = b->kinetic_J[1];
        b->moving_J[0] = b->moving_J[1];
        b->stored_J[0] = b->stored_J[1];
        b->energy_J[0] = b->energy_J[1];
        memcpy(b->power_W[0], power_W, sizeof power_W);
        memcpy(b->momentum, entry + BOOK_MOMENTA, (size_t)im->count * sizeof *b->momentum);
    } else {
        add_work(b, power_W);
    }
    spread_enter(&b->kinetic, b->moving_J[1], b->entries);
    spread_enter(&b->stored, b->stored_J[1], b->entries);
    if (!b->negative && b->moving_J[1] < -NEGATIVE * b->size_J) {
        b->negative = true;
        b->negative_s = b->time_s;
    }
    b->size_J = number_most(b->size_J, fabs(b->kinetic_J[1]) + fabs(b->stored_J[1]));
    double all = b->energy_J[1] + power_W[0] + power_W[1];
    for (int i = 0; i < im->reals; i++) {
        if (im->real[i].primes == 1) {
            spread_enter(&b->rate[im->real[i].unknown], b->state[im->angles + i], b->entries);
        }
    }
    for (int i = 0; i < im->count; i++) {
        b->rate[i].pushed = b->rate[i].pushed || b->value[i] != 0.0;
        all += entry[BOOK_MOMENTA + i];
        const double own = entry[BOOK_MOMENTA + i] - b->rateless[i];
        spread_enter(&b->push[i], own, b->entries);
        b->momentum_now[i] = entry[BOOK_MOMENTA + i];
        b->drift[i] = number_most(b->drift[i], fabs(entry[BOOK_MOMENTA + i] - b->momentum[i]));
    }
    if (!isfinite(all) && !b->undefined) {
        b->undefined = true;
        b->undefined_s = b->time_s;
    }
    if (b->entries == 0 || ((b->entries & (b->entries - 1)) == 0 && b->entries % 3 == 1)) {
        /* costly, so only at the start and after 1, 4, 16, ... steps */
        look_at_rounding(b, kind, run);
    }
    b->entries++;
    if (b->entries % 2 == 1) { /* the number of steps is even, so Simpson's rule covers them all */
        const double error = books_left_J(b);
        b->most_J = number_most(b->most_J, fabs(error));
        if (fabs(error - b->kept_J) > fabs(b->jump_J)) {
            b->jump_J = error - b->kept_J;
            b->jump_s = b->time_s;
        }
        b->kept_J = error;
    }
}

double books_left_J(const books *b) {
    return b->energy_J[1] - b->energy_J[0] - b->input_J + b->loss_J;
}
