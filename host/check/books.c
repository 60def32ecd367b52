#include "books.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

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
    b->step_s = im->step_s;
    return b;
}

void books_close(books *b) {
    if (b != NULL) {
        state_list_close(&b->list);
        free(b->off);
        free(b->rate);
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

double books_mass(const books *b, int unknown) {
    return swing(&b->push[unknown], b->entries) / swing(&b->rate[unknown], b->entries);
}

/* Swings are differences from means, so that a common speed of all bodies changes nothing. */
double books_swing_J(const books *b) {
    double most = number_most(swing(&b->kinetic, b->entries), swing(&b->stored, b->entries));
    for (int i = 0; i < b->image->count; i++) {
        const double of_momentum = swing(&b->push[i], b->entries);
        const double of_rate = swing(&b->rate[i], b->entries);
        most = number_most(most, of_momentum * of_rate / number_root(32.0));
    }
    return most;
}

/* --- round-off ---------------------------------------------------------------------------------*/

/* FLOAT_LEAST: the smallest normal float. SUMS_OF_A_STEP: how often a step, with its stages and events, rounds each entry. */
#define FLOAT_LEAST 0x1p-126
#define SUMS_OF_A_STEP 8.0

/* To measure how the energy changes with a component of the state, the component is changed by this part of its value. */
#define SLOPE_SHARE 0x1p-20

static void evaluate_now(const books *b, const double *angle_rad, const double *real,
                         double time_s) {
    (void)state_list_at(&b->list, time_s, angle_rad, real);
    for (int i = 0; i < b->image->list[IMAGE_BOOKS]->results; i++) {
        b->value[i] = number_shown(b->value[i]); /* -0 becomes 0 */
    }
}

/* The balanced energy. `value`: the results of the books list, or their error bounds. */
static double energy_of(const image *im, const double *value) {
    const double *entry = value + im->count;
    return im->has_integral ? entry[BOOK_MOMENTA + im->count]
                            : entry[BOOK_KINETIC] + entry[BOOK_STORED];
}

static double unit_rounding(const engine_kind *kind) {
    return kind == &engine_float ? 0x1p-24 : 0x1p-53;
}

/* by: the round-off of a component of the state in one step. change: the change by which the energy's slope is measured. */
typedef struct state_rounding {
    double by;
    double change;
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

/* The energy change when each component of the state is rounded once. */
static double state_rounding_J(const books *b, const engine_kind *kind, const void *run) {
    const image *im = b->image;
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    double sum = 0.0;
    memcpy(angle_rad, b->angle_rad, sizeof angle_rad);
    memcpy(real, b->real, sizeof real);
    for (int i = 0; i < im->angles + im->reals; i++) {
        double *at = i < im->angles ? &angle_rad[i] : &real[i - im->angles];
        const double kept = *at;
        const state_rounding rounding = rounding_of_component(im, kind, run, i, kept);
        const component c = image_component(im, i);
        /* a rate that never changed, such as a clock's, was never rounded */
        const spread *rate = &b->rate[c.unknown];
        const bool still = c.primes == 1 && !rate->pushed && rate->squares == 0.0;
        if (rounding.change != 0.0 && !still) {
            *at = kept + rounding.change;
            evaluate_now(b, angle_rad, real, b->time_s);
            sum +=
                fabs((energy_of(im, b->value) - b->energy_J[1]) * (rounding.by / rounding.change));
            *at = kept;
        }
    }
    return isfinite(sum) ? sum : 0.0;
}

/* Energy change of a step by the round-off of its accelerations and of its powers. A small difference of large
 * terms, such as balanced forces, has a round-off in proportion to the terms. */
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

/* Energy that the entries of a step may lose to underflow. A run with contacts keeps its ledger in its own number type. In
 * float, values below the smallest normal number have an error of that size, or become zero, and all errors may have one
 * sign. In double this loss is negligible. */
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
    evaluator_rounding(b->list.evaluator, b->angle_rad, FLOAT_LEAST, b->off);
    for (int k = BOOK_INPUT_POWER; k <= BOOK_LOSS_POWER; k++) {
        with_W += b->off[im->count + k];
    }
    const double lost_W = with_W - without_W;
    const double entries = im->ledger.smooth + im->contacts + im->inputs;
    return 0x1p-24 *
           (SUMS_OF_A_STEP * entries * FLOAT_LEAST + (isfinite(lost_W) ? b->step_s * lost_W : 0.0));
}

static void look_at_rounding(books *b, const engine_kind *kind, const void *run) {
    const double state_J = state_rounding_J(b, kind, run);
    evaluate_now(b, b->angle_rad, b->real, b->time_s);
    evaluator_rounding(b->list.evaluator, b->angle_rad, 0.0, b->off);
    for (int i = 0; i < b->image->count; i++) {
        const double sizes = b->off[b->image->count + BOOK_MOMENTA + i];
        b->terms[i] = isfinite(sizes) ? number_most(b->terms[i], sizes) : b->terms[i];
    }
    const double off_J = energy_of(b->image, b->off);
    b->rounding_J = number_most(b->rounding_J, state_J + step_rounding_J(b, kind));
    b->computing_J = number_most(b->computing_J, isfinite(off_J) ? 0x1p-53 * off_J : 0.0);
    b->lost_J = number_most(b->lost_J, step_lost_J(b, kind));
}

double books_rounding_J(books *b, const engine_kind *kind, const void *run, double *computing_J) {
    look_at_rounding(b, kind, run);
    *computing_J = b->computing_J;
    return b->rounding_J + 0x1p-52 * b->size_J;
}

double books_lost_J(const books *b) { return (double)b->entries * b->lost_J; }

/* --- the balance -------------------------------------------------------------------------------*/

/* Error bound of the work of two steps. If the powers are smooth, it is the difference between Simpson's and the
 * trapezoidal rule. Otherwise it is half a step times the changes of the power in both steps. */
static double rule_off_J(double step_s, double begin_W, double middle_W, double end_W) {
    const double rules_J = fabs(step_s / 6.0 * (2.0 * middle_W - begin_W - end_W));
    const double change_J = 0.5 * step_s * (fabs(middle_W - begin_W) + fabs(end_W - middle_W));
    return rules_J > 0.1 * change_J ? change_J : rules_J;
}

/* Simpson's rule needs pairs of steps. A single last step counts as a trapezoid until the next entry completes the pair. */
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
    const bool is_even = b->entries % 2 == 1; /* the first entry is the start */
    return is_even ? b->rule_J : b->entries > 2 ? b->rule_J + b->pair_J : (double)INFINITY;
}

/* --- terms linear in the rates -------------------------------------------------------------------*/

/* The kinetic energy at this state with every rate reversed. rateless[] gets the momenta of the reversed state. */
static double reversed_J(books *b, const double *angle_rad, const double *from) {
    const image *im = b->image;
    double real[2 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < im->reals; i++) {
        real[i] = im->real[i].primes == 1 ? -from[i] : from[i];
    }
    evaluate_now(b, angle_rad, real, b->time_s);
    memcpy(b->rateless, b->value + im->count + BOOK_MOMENTA,
           (size_t)im->count * sizeof *b->rateless);
    return b->value[im->count + BOOK_KINETIC];
}

/* rateless[] becomes the mean of the momenta with reversed rates and of those just evaluated with the actual rates. */
static void take_rateless(books *b) {
    for (int i = 0; i < b->image->count; i++) {
        b->rateless[i] = 0.5 * (b->rateless[i] + b->value[b->image->count + BOOK_MOMENTA + i]);
    }
}

/* Does a momentum have a part that stays the same if all rates are reversed? Tests three states other than the start. A
 * coordinate that is recovered from its momentum has no rate to reverse. */
static bool find_rateless(books *b) {
    const image *im = b->image;
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX] = {0};
    bool found = false;
    for (int k = 1; k <= 3 && im->recovered == 0; k++) {
        for (int i = 0; i < im->angles; i++) {
            angle_rad[i] = b->angle_rad[i] + 0.37 * k * (i + 1);
        }
        for (int i = 0; i < im->reals; i++) {
            real[i] = b->real[i] + (0.61 * k * (i + 1)) * (1.0 + fabs(b->real[i]));
        }
        (void)reversed_J(b, angle_rad, real);
        evaluate_now(b, angle_rad, real, b->time_s);
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

/* A kinetic energy that is negative by more than this part of all energies is not round-off. */
#define NEGATIVE 1e-6

/* --- all of a step ---------------------------------------------------------------------------------*/

void books_enter(books *b, const engine_kind *kind, const void *run) {
    const image *im = b->image;
    kind->state(run, b->angle_rad, b->real);
    if (b->entries == 0 && kind == &engine_float) {
        evaluator_wrap(b->list.evaluator);
    }
    b->time_s = (double)kind->steps(run) * b->step_s;
    if (b->entries == 0) {
        b->has_rateless = find_rateless(b);
        memset(b->rateless, 0, (size_t)im->count * sizeof *b->rateless);
    }
    const double back_J = b->has_rateless ? reversed_J(b, b->angle_rad, b->real) : 0.0;
    evaluate_now(b, b->angle_rad, b->real, b->time_s);
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
        for (int k = 0; k < 2; k++) {
            b->power_W[0][k] = power_W[k];
        }
        for (int i = 0; i < im->count; i++) {
            b->momentum[i] = entry[BOOK_MOMENTA + i];
        }
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
            spread_enter(&b->rate[im->real[i].unknown], b->real[i], b->entries);
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
        /* not at each step, because it takes long: at the start, and after 1, 4, 16, ... steps */
        look_at_rounding(b, kind, run);
    }
    b->entries++;
    if (b->entries % 2 == 1) { /* the number of steps is even, so Simpson's rule covers them all */
        const double error = books_account(b).left;
        b->most_J = number_most(b->most_J, fabs(error));
        if (fabs(error - b->kept_J) > fabs(b->jump_J)) {
            b->jump_J = error - b->kept_J;
            b->jump_s = b->time_s;
        }
        b->kept_J = error;
    }
}

book_account account_of(const double level[2]) {
    return (book_account){.level = {level[0], level[1]}, .left = level[1] - level[0]};
}

void account_enter(book_account *a, double given) {
    a->left -= given;
    a->largest = fabs(given) > a->largest ? fabs(given) : a->largest;
}

book_account books_account(const books *b) {
    book_account a = account_of(b->energy_J);
    account_enter(&a, b->input_J);
    account_enter(&a, -b->loss_J);
    return a;
}
