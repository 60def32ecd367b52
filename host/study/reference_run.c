#include "host/study/reference_run.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/interrupts.h"
#include "host/engine/loop.h"
#include "host/number/functions.h"
#include "host/study/extrapolation.h"
#include "host/study/long_list.h"

/* Enter a record: false when the run is of no use any more. */
static bool enter(const reference *r, const records *now, int record, deviation_of_what what,
                  deviation *d) {
    const long double *row = r->row + (size_t)record * (size_t)r->columns;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (what.column >= 0 ? k != what.column : !c->counts) {
            continue;
        }
        const long double unit = what.column >= 0 ? 1.0L : c->largest;
        const double off = (double)(long_size((long double)now->row[k] - row[k]) / unit);
        if (d->column < 0 || !(off <= d->error)) { /* or NaN */
            d->error = off;
            d->column = k;
            d->known = (double)(c->off / unit);
        }
    }
    return d->error <= what.give_up;
}

/* Evaluations so far. With contacts, reading a record is also an evaluation, but not one of a step. */
typedef struct counted {
    double in_steps;
    double most; /* in one of these */
} counted;

/* One step. With contacts their cost varies; a step as one matrix evaluates one list. */
static bool take_step(const engine_kind *kind, void *run, const image *im, counted *c) {
    uint64_t declared;
    const bool matrix = im->list[IMAGE_MATRIX] != NULL;
    const uint64_t before = kind->evaluations(run, &declared);
    const bool good = loop_steps(kind, run, 1) == WH_OK;
    const double taken = matrix ? 1.0 : (double)(kind->evaluations(run, &declared) - before);
    c->in_steps += taken;
    c->most = taken > c->most ? taken : c->most;
    return good;
}

deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what) {
    deviation d = {.column = what.column};
    counted c = {0.0, 0.0};
    records *now = records_open(NULL, im, kind);
    void *run = kind->start(im);
    records_read(now, run, 0.0);
    bool good = enter(r, now, 0, what, &d);
    const int each = (int)pace.records;
    for (int i = each; i <= r->records && good && !interrupted; i += each) {
        for (uint64_t k = 0; k < pace.steps && good; k++) {
            good = take_step(kind, run, im, &c);
        }
        if (good) {
            records_read(now, run, 0.0);
            good = enter(r, now, i, what, &d);
        }
    }
    uint64_t most;
    const bool matrix = im->list[IMAGE_MATRIX] != NULL; /* a step evaluates only one of its lists */
    const uint64_t evaluations = matrix ? kind->steps(run) : kind->evaluations(run, &most);
    d.operations =
        (double)evaluations * (double)im->list[matrix ? IMAGE_MATRIX : IMAGE_STEP]->count;
    const double time_s = ratio_times(kind->steps(run), im->step);
    d.evaluations = time_s > 0.0 ? c.in_steps / time_s : 0.0;
    d.evaluations_most = im->contacts > 0 ? c.most
                         : matrix         ? 1.0
                                          : (double)wh_methods[im->settings.method].stages;
    d.usable = good && (kind->saturated == NULL || kind->saturated(run) == 0);
    kind->stop(run);
    records_close(now);
    return d;
}

/* === the reference ============================================================================ */

/* --- a state as a row of records -------------------------------------------------------------------*/

struct long_rows {
    const records *shape;
    long_list *observe;
    double *input;
    long double *output; /* [image->outputs] */
};

long_rows *long_rows_new(const records *shape) {
    const image *im = shape->image;
    long_rows *l = alloc(1, sizeof *l);
    *l = (long_rows){shape, long_list_new(im->list[IMAGE_OBSERVE]),
                     alloc(im->inputs, sizeof *l->input), alloc(im->outputs, sizeof *l->output)};
    image_inputs(im, l->input);
    return l;
}

void long_rows_free(long_rows *l) {
    if (l != NULL) {
        long_list_free(l->observe);
        free(l->input);
        free(l->output);
        free(l);
    }
}

static int column_of(const records *r, component c) {
    int column = 1;
    while (r->column[column].unknown != c.unknown || r->column[column].primes != c.primes) {
        column++;
    }
    return column;
}

void long_rows_read(long_rows *l, const long double *state, long double time_s, long double *row) {
    const records *r = l->shape;
    const image *im = r->image;
    const long double *real = state + im->angles;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
    const long_leaves in = {state, real, real + linear, l->input, time_s};
    long_list_run(l->observe, &in, l->output);
    memset(row, 0, (size_t)r->columns * sizeof *row);
    for (int i = 0; i < im->angles + im->reals; i++) {
        row[column_of(r, image_component(im, i))] = state[i];
    }
    for (int i = 0; i < im->own_outputs; i++) {
        row[r->columns - im->own_outputs + i] = l->output[i];
    }
    for (int k = 0; k < im->recovered; k++) {
        for (int primes = 0; primes < 2; primes++) {
            const component c = {im->from_momentum[k], primes};
            row[column_of(r, c)] = l->output[im->own_outputs + 2 * k + primes];
        }
    }
    for (int i = 1; i < r->columns; i++) {
        const image_unit *u = r->column[i].unit;
        row[i] = row[i] * (long double)u->divisor / (long double)u->scale;
    }
    row[0] = time_s;
}

/* --- by fine steps ---------------------------------------------------------------------------------*/

/* As many times finer than the scene's step, if they may take the operations. */
#define FINER 16.0
/* Evaluations of a step: RK4's, and those of the search for events. */
#define EVALUATIONS 4.0
#define EVALUATIONS_CONTACTS 12.0

uint64_t fine_steps_of(const reference_wish *w) {
    const image *im = w->image;
    if (w->by.steps > 0) {
        return w->by.steps;
    }
    const double spacing_s = ratio_times(1, w->spacing);
    const double each =
        (im->contacts > 0 ? EVALUATIONS_CONTACTS : EVALUATIONS) * im->list[IMAGE_STEP]->count;
    const double wanted = number_ceiling(FINER * spacing_s / im->step_s / 2.0);
    const double affordable = number_floor(w->operations / each / w->records / 2.0);
    return 2U * (uint64_t)number_most(1.0, number_least(wanted, affordable));
}

int fine_steps_run(const reference_wish *w, const records *shape, uint64_t steps,
                   long double *row) {
    image copy = *w->image;
    copy.settings = (image_settings)IMAGE_SETTINGS_DEFAULT;
    copy.settings.compensated = true;
    copy.list[IMAGE_MATRIX] = NULL;
    if (w->by.steps > 0) {
        copy.settings.method = w->by.method;
    }
    copy.step = (whole_ratio){w->spacing.numerator, w->spacing.denominator * steps};
    copy.step_s = ratio_times(1, copy.step);
    copy.steps = steps * (uint64_t)w->records;
    records *r = records_open(NULL, &copy, &engine_double);
    void *run = engine_double.start(&copy);
    int done = 0;
    for (;; done++) {
        records_read(r, run, ratio_times((uint64_t)done, w->spacing));
        for (int i = 0; i < shape->columns; i++) {
            row[(size_t)done * (size_t)shape->columns + (size_t)i] = (long double)r->row[i];
        }
        if (done == w->records || interrupted || loop_steps(&engine_double, run, steps) != WH_OK) {
            break;
        }
    }
    engine_double.stop(run);
    records_close(r);
    return done;
}

/* --- the two computations and their agreement ------------------------------------------------------*/

/* The finer of two extrapolations, and its comparison, which has another order and so other steps. */
static const extrapolation_setting fine = {6, 16.0 * (double)LDBL_EPSILON};
static const extrapolation_setting coarse = {5, 64.0 * (double)LDBL_EPSILON};

/* A record is trusted while the two differ by less than this part of a column's largest value. They begin with less than
 * 1e-16 in long double. A difference of this size is not their own error: the motion has amplified each round-off. */
#define LIMIT_EXTRAPOLATED (LONG_IS_LONGER ? 1e-12 : 1e-9)
#define LIMIT_FINE_STEPS 1e-6
/* A component is round-off if the two never agree to this part of it before the first record at which it reaches this part
 * of its largest value. The round-off is the motion's, or that of the list's constants. */
#define KNOWN_BY 1e-6L

typedef struct computed {
    long double *row; /* [wanted + 1][columns] */
    int records;      /* after the start */
    extrapolation_status status;
} computed;

static long double *rows_of(const reference *r) {
    return alloc((int64_t)(r->wanted + 1) * r->columns, sizeof(long double));
}

static computed extrapolate(const reference_wish *w, const reference *r,
                            extrapolation_setting how) {
    computed c = {rows_of(r), 0, EXTRAPOLATION_OK};
    long_rows *rows = long_rows_new(r->shape);
    extrapolation *e = extrapolation_new(w->image, how, w->operations);
    const long double spacing_s =
        (long double)w->spacing.numerator / (long double)w->spacing.denominator;
    for (int i = 0;; i++) {
        long double *row = c.row + (size_t)i * (size_t)r->columns;
        long_rows_read(rows, extrapolation_state(e), (long double)i * spacing_s, row);
        c.records = i;
        if (i < r->wanted) {
            c.status = extrapolation_go(e, spacing_s);
        }
        if (i == r->wanted || c.status != EXTRAPOLATION_OK || interrupted) {
            break;
        }
    }
    extrapolation_free(e);
    long_rows_free(rows);
    return c;
}

static long double row_off(const reference *r, const computed *other, int record, int column) {
    const size_t at = (size_t)record * (size_t)r->columns + (size_t)column;
    const long double off = long_size(r->row[at] - other->row[at]);
    return isfinite(off) ? off : (long double)INFINITY;
}

/* Largest and most different values of a column over the records up to `until`. */
static void measure(reference *r, const computed *other, int until, int column) {
    reference_column *c = &r->column[column];
    c->largest = 0.0L;
    c->off = 0.0L;
    for (int i = 0; i <= until; i++) {
        const long double size = long_size(r->row[(size_t)i * (size_t)r->columns + (size_t)column]);
        const long double off = row_off(r, other, i, column);
        c->largest = size > c->largest ? size : c->largest;
        c->off = off > c->off ? off : c->off;
    }
}

/* Did they agree about a column, with a known largest value, before the motion may have carried them apart? */
static bool is_known(const reference *r, const computed *other, int until, int column) {
    const long double enough = KNOWN_BY * r->column[column].largest;
    long double largest = 0.0L;
    long double off = 0.0L;
    for (int i = 0; i <= until; i++) {
        const long double size = long_size(r->row[(size_t)i * (size_t)r->columns + (size_t)column]);
        const long double now = row_off(r, other, i, column);
        largest = size > largest ? size : largest;
        off = now > off ? now : off;
        if (i > 0 && largest > 0.0L && largest >= enough &&
            off <= (long double)r->limit * largest) {
            return true;
        }
    }
    return false;
}

/* Which columns count, and until when they agree. */
static void judge(reference *r, const computed *other) {
    const int both = other->records < r->records ? other->records : r->records;
    for (int k = 1; k < r->columns; k++) {
        measure(r, other, both, k);
        r->column[k].counts = r->shape->column[k].unknown >= 0 && is_known(r, other, both, k);
    }
    r->records = both;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        for (int i = 0; i <= r->records && c->counts; i++) {
            if (row_off(r, other, i, k) > (long double)r->limit * c->largest) {
                r->records = i - 1;
            }
        }
    }
    for (int k = 1; k < r->columns; k++) {
        measure(r, other, r->records < 0 ? 0 : r->records, k);
    }
}

static double time_of(const reference_wish *w, int record) {
    return ratio_times((uint64_t)(record < 0 ? 0 : record), w->spacing);
}

static void say_extrapolated(const reference_wish *w, reference *r, extrapolation_status status,
                             int reached) {
    r->how = alloc_words(
        "extrapolation of order %d in long double (%d binary digits), tolerance %.2g; "
        "held against order %d, %.2g",
        2 * fine.columns, LDBL_MANT_DIG, fine.tolerance, 2 * coarse.columns, coarse.tolerance);
    if (r->records < reached) {
        r->why = alloc_words(
            "the motion carries the two references apart: by %.0e of a component's largest value "
            "behind %.9g s, from less than 1e-15 at the start",
            r->limit, time_of(w, r->records));
    } else if (status == EXTRAPOLATION_SMALL) {
        r->why = alloc_words("behind %.9g s no step is small enough for the reference: a jump, a "
                             "pole, or what has no value",
                             time_of(w, r->records));
    } else if (status == EXTRAPOLATION_LONG) {
        r->why = alloc_words("the reference took too long behind %.9g s", time_of(w, r->records));
    }
}

static reference *begin(const reference_wish *w) {
    reference *r = alloc(1, sizeof *r);
    r->shape = records_open(NULL, w->image, &engine_double);
    r->columns = r->shape->columns;
    r->wanted = w->records;
    r->column = alloc(r->columns, sizeof *r->column);
    return r;
}

static reference *by_extrapolation(const reference_wish *w) {
    reference *r = begin(w);
    const computed best = extrapolate(w, r, fine);
    const computed other = extrapolate(w, r, coarse);
    r->kind = REFERENCE_EXTRAPOLATED;
    r->limit = LIMIT_EXTRAPOLATED;
    r->row = best.row;
    r->records = best.records;
    const int reached = best.records < other.records ? best.records : other.records;
    judge(r, &other);
    r->broken = r->records >= reached && reached < r->wanted;
    say_extrapolated(w, r, best.status != EXTRAPOLATION_OK ? best.status : other.status, reached);
    free(other.row);
    r->stopped = interrupted != 0;
    return r;
}

static reference *by_fine_steps(const reference_wish *w) {
    reference *r = begin(w);
    const uint64_t steps = fine_steps_of(w);
    r->row = rows_of(r);
    computed other = {rows_of(r), 0, EXTRAPOLATION_OK};
    r->records = fine_steps_run(w, r->shape, steps, r->row);
    other.records = fine_steps_run(w, r->shape, steps / 2U, other.row);
    const int reached = r->records < other.records ? r->records : other.records;
    r->kind = REFERENCE_FINE_STEPS;
    r->limit = w->by.steps > 0 ? w->by.limit : LIMIT_FINE_STEPS;
    judge(r, &other);
    for (int k = 1; k < r->columns && w->by.steps > 0;
         k++) { /* the finer one's own, by its order */
        r->column[k].off /= (long double)number_scaled(1.0, w->by.order) - 1.0L;
    }
    free(other.row);
    r->how =
        alloc_words("rk4 in double with compensated sums by steps of %.6g s; held against twice "
                    "that step: a reference that shares the core's step and events",
                    time_of(w, 1) / (double)steps);
    if (r->records < reached) {
        r->why = alloc_words(
            "the two references differ by more than %.0e of a component's largest value behind "
            "%.9g s: the motion carries them apart, or events come in another order",
            r->limit, time_of(w, r->records));
    } else if (reached < r->wanted) {
        r->why = alloc_words("the run fails behind %.9g s", time_of(w, r->records));
    }
    r->stopped = interrupted != 0;
    return r;
}

/* Does anything but outputs? */
static bool moves(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        for (int i = 0; r->shape->column[k].unknown >= 0 && i <= (r->records < 0 ? 0 : r->records);
             i++) {
            if (r->row[(size_t)i * (size_t)r->columns + (size_t)k] != r->row[k]) {
                return true;
            }
        }
    }
    return false;
}

/* If no column is known, the trust has no end either, because records prove nothing. */
static bool knows(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        if (r->column[k].counts) {
            return true;
        }
    }
    return false;
}

reference *reference_new(const reference_wish *w) {
    const bool steps = w->image->contacts > 0 || w->by.steps > 0;
    reference *r = steps ? by_fine_steps(w) : by_extrapolation(w);
    if (!r->stopped && r->broken) {          /* of extrapolations alone */
        reference *other = by_fine_steps(w); /* kinks and jumps are passed by steps */
        if (knows(other) && (other->records > r->records || !knows(r))) {
            reference *swap = r;
            r = other;
            other = swap;
        }
        reference_free(other);
    }
    if (r->records < 1 || !knows(r)) {
        r->kind = REFERENCE_NONE;
        if (r->why == NULL) {
            r->still = !moves(r);
            r->why = alloc_words(!r->still
                                     ? "the two never agree: what moves is rounding alone, or this "
                                       "horizon is too long to be looked at"
                                     : "nothing moves");
        }
    }
    return r;
}

void reference_cut(reference *r, int until) {
    r->records = until < r->records ? until : r->records;
    for (int k = 1; k < r->columns; k++) {
        r->column[k].largest = 0.0L;
        for (int i = 0; i <= r->records; i++) {
            const long double size = long_size(r->row[(size_t)i * (size_t)r->columns + (size_t)k]);
            r->column[k].largest = size > r->column[k].largest ? size : r->column[k].largest;
        }
        r->column[k].counts = r->column[k].counts && r->column[k].largest > 0.0L;
    }
}

double reference_agreement(const reference *r) {
    double worst = 0.0;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (c->counts) {
            worst = number_most(worst, (double)(c->off / c->largest));
        }
    }
    return worst;
}

void reference_free(reference *r) {
    if (r != NULL) {
        records_close(r->shape);
        free(r->row);
        free(r->column);
        free(r->how);
        free(r->why);
        free(r);
    }
}

int reference_find(const reference *r, const char *name, bool *noisy) {
    const image *im = r->shape->image;
    const size_t length = strcspn(name, "'");
    const int primes = (int)strlen(name + length);
    *noisy = false;
    for (int k = 1; k < r->columns; k++) {
        const record_column *c = &r->shape->column[k];
        if (strlen(c->name) == length && strncmp(c->name, name, length) == 0 &&
            c->primes == primes && strspn(name + length, "'") == (size_t)primes) {
            *noisy = c->unknown < 0 && long_list_asks(im->list[IMAGE_OBSERVE],
                                                      k - (r->columns - im->own_outputs), OP_NOISE);
            return k;
        }
    }
    return -1;
}
