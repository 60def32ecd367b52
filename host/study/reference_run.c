#include "host/study/reference_run.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/engine/loop.h"
#include "host/number/functions.h"
#include "host/os/system.h"

/* === the deviation of a run =================================================================== */

/* Updates *d with the errors at a record. Returns false if d->error exceeds what.give_up. */
static bool enter(const reference *r, const records *now, int record, deviation_of_what what,
                  deviation *d) {
    const double *row = r->row + (size_t)record * (size_t)r->columns;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (what.column >= 0 ? k != what.column : !c->counts) {
            continue;
        }
        const double unit = what.column >= 0 ? 1.0 : c->largest;
        const double off = fabs(now->row[k] - row[k]) / unit;
        if (d->column < 0 || !(off <= d->error)) { /* also true for NaN */
            d->error = off;
            d->column = k;
            d->known = c->off / unit;
        }
    }
    return d->error <= what.give_up;
}

static bool take_step(const engine_kind *kind, void *run, const image *im, deviation *d) {
    uint64_t declared;
    const uint64_t before = kind->evaluations(run, &declared);
    const bool good = loop_steps(kind, run, 1) == WH_OK;
    const uint64_t taken =
        im->list[IMAGE_MATRIX] != NULL ? 1 : kind->evaluations(run, &declared) - before;
    d->evaluations += (double)taken;
    d->evaluations_most = number_most(d->evaluations_most, (double)taken);
    return good;
}

deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what) {
    deviation d = {.column = what.column};
    records *now = records_open(NULL, im, kind);
    void *run = kind->start(im);
    records_read(now, run, 0.0);
    bool good = enter(r, now, 0, what, &d);
    const int each = (int)pace.records;
    for (int i = each; i <= r->records && good && !interrupted; i += each) {
        for (uint64_t k = 0; k < pace.steps && good; k++) {
            good = take_step(kind, run, im, &d);
        }
        if (good) {
            records_read(now, run, 0.0);
            good = enter(r, now, i, what, &d);
        }
    }
    const double time_s = ratio_times(kind->steps(run), im->step);
    d.evaluations = time_s > 0.0 ? d.evaluations / time_s : 0.0;
    d.usable = good && (kind->saturated == NULL || kind->saturated(run) == 0);
    kind->stop(run);
    records_close(now);
    return d;
}

/* === the reference ============================================================================ */

/* The method and the steps of a reference if none are requested. */
#define METHOD WH_NYSTROEM5
#define FINER 4.0    /* the first step is this many times shorter than the scene's */
#define FINEST 16.0  /* the last step is at most this many times shorter than the scene's */
#define LAST 256.0   /* replaces FINEST while each halving of the step doubles the trusted time */
#define ENOUGH 1e-11 /* halving ends if no column differs by more than this part of its `largest` */
/* A record is trusted if the two runs differ by at most this part of each column's largest value. */
#define LIMIT 1e-9
/* A column is known if the two runs agree until its magnitude has grown to this part of its largest value. */
#define KNOWN_BY 1e-6
/* An unknown column is only round-off if its largest value is this many times larger in float than in double. */
#define ROUGHER 0x1p15
#define SHARED (16.0 * DBL_EPSILON) /* round-off in both runs, as a part of a column's `largest` */
#define EVENTS 3.0 /* contacts multiply the evaluations of a step by about this factor */

/* --- two runs and their agreement ------------------------------------------------------------------*/

typedef struct computed {
    double *row; /* [wanted + 1][columns] */
    int records; /* number of records after the start */
} computed;

static computed compute(const reference_request *w, uint64_t steps, const engine_kind *kind) {
    image copy = *w->image;
    copy.settings = (image_settings)IMAGE_SETTINGS_DEFAULT;
    copy.settings.compensated = true;
    copy.list[IMAGE_MATRIX] = NULL;
    copy.settings.method = w->by.steps > 0 ? w->by.method : METHOD;
    copy.step = (whole_ratio){w->spacing.numerator, w->spacing.denominator * steps};
    copy.step_s = ratio_times(1, copy.step);
    copy.steps = steps * (uint64_t)w->records;
    records *r = records_open(NULL, &copy, kind);
    void *run = kind->start(&copy);
    computed c = {alloc((int64_t)(w->records + 1) * r->columns, sizeof(double)), 0};
    for (;; c.records++) {
        records_read(r, run, ratio_times((uint64_t)c.records, w->spacing));
        memcpy(c.row + (size_t)c.records * (size_t)r->columns, r->row,
               (size_t)r->columns * sizeof *r->row);
        if (c.records == w->records || interrupted || loop_steps(kind, run, steps) != WH_OK) {
            break;
        }
    }
    kind->stop(run);
    records_close(r);
    return c;
}

static double value_at(const reference *r, const double *rows, int record, int column) {
    return rows[(size_t)record * (size_t)r->columns + (size_t)column];
}

/* A column's largest magnitude in rows 0 to `until`. */
static double largest_of(const reference *r, const double *rows, int until, int column) {
    double largest = 0.0;
    for (int i = 0; i <= until; i++) {
        largest = number_most(largest, fabs(value_at(r, rows, i, column)));
    }
    return largest;
}

static double row_off(const reference *r, const computed *other, int record, int column) {
    const double off =
        fabs(value_at(r, r->row, record, column) - value_at(r, other->row, record, column));
    return isfinite(off) ? off : (double)INFINITY;
}

static bool measure(reference *r, const computed *other, int until, int column) {
    const double enough = KNOWN_BY * largest_of(r, r->row, until, column);
    reference_column *c = &r->column[column];
    bool known = false;
    *c = (reference_column){.largest = 0.0};
    for (int i = 0; i <= until; i++) {
        c->largest = number_most(c->largest, fabs(value_at(r, r->row, i, column)));
        c->off = number_most(c->off, row_off(r, other, i, column));
        known = known || (i > 0 && c->largest > 0.0 && c->largest >= enough &&
                          c->off <= r->limit * c->largest);
    }
    c->off = number_most(c->off, SHARED * c->largest);
    return known;
}

static void weigh(reference *r, const reference_request *w, uint64_t steps, const computed *other,
                  computed *rough) {
    const int until = r->records < 0 ? 0 : r->records;
    for (int k = 1; k < r->columns; k++) {
        reference_column *c = &r->column[k];
        const bool known = measure(r, other, until, k);
        c->counts = r->shape->column[k].unknown >= 0 && c->largest > 0.0;
        if (c->counts && !known) {
            *rough = rough->row == NULL ? compute(w, steps, &engine_float) : *rough;
            const int both = until < rough->records ? until : rough->records;
            c->counts =
                ROUGHER * largest_of(r, other->row, both, k) >= largest_of(r, rough->row, both, k);
        }
    }
}

/* Decides which columns count, and up to which record the two runs agree. */
static void judge(reference *r, const reference_request *w, uint64_t steps, const computed *other,
                  int reached) {
    computed rough = {NULL, 0};
    r->records = reached;
    weigh(r, w, steps, other, &rough);
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        for (int i = 0; i <= r->records && c->counts; i++) {
            if (row_off(r, other, i, k) > r->limit * c->largest) {
                r->records = i - 1;
            }
        }
    }
    weigh(r, w, steps, other, &rough);
    free(rough.row);
}

/* Does a coordinate or a rate move? Outputs do not matter. */
static bool moves(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        for (int i = 0; r->shape->column[k].unknown >= 0 && i <= (r->records < 0 ? 0 : r->records);
             i++) {
            if (value_at(r, r->row, i, k) != r->row[k]) {
                return true;
            }
        }
    }
    return false;
}

/* --- the steps ---------------------------------------------------------------------------------------*/

/* Returns an even number of steps between two records: at least 2, and limited by w->operations. */
static uint64_t steps_of(const reference_request *w, double finer) {
    const image *im = w->image;
    const double each =
        wh_methods[METHOD].stages * (im->contacts > 0 ? EVENTS : 1.0) * im->list[IMAGE_STEP]->count;
    const double wanted = number_ceiling(finer * ratio_times(1, w->spacing) / im->step_s / 2.0);
    const double affordable = number_floor(w->operations / each / w->records / 2.0);
    return 2U * (uint64_t)number_most(1.0, number_least(wanted, affordable));
}

static double time_of(const reference_request *w, int record) {
    return ratio_times((uint64_t)(record < 0 ? 0 : record), w->spacing);
}

static void say(const reference_request *w, reference *r, uint64_t steps, int reached) {
    r->how = alloc_words(
        "%s in double with compensated sums and steps of %.6g s; a second reference with twice that step checks it; both compute sines and events like the run, but without --tables",
        wh_methods[w->by.steps > 0 ? w->by.method : METHOD].word, time_of(w, 1) / (double)steps);
    if (r->records < reached) {
        r->why = alloc_words(
            "after %.9g s the two references differ by more than %.0e of the largest value of a coordinate or rate: the motion diverges or jumps, or the references have their events in different orders",
            time_of(w, r->records), r->limit);
    } else if (reached < r->wanted) {
        r->why = alloc_words("the run fails after %.9g s", time_of(w, r->records));
    }
    r->reliable = r->records >= 1 && reference_agreement(r, -1) > 0.0;
    r->still = !r->reliable && r->why == NULL && !moves(r);
    if (!r->reliable && r->why == NULL) {
        r->why = alloc_words(
            "%s",
            r->still
                ? "nothing moves"
                : "the two references never agree: the motion is only round-off, or the horizon is too long");
    }
}

reference *reference_new(const reference_request *w) {
    const bool fixed = w->by.steps > 0;
    uint64_t steps = fixed ? w->by.steps : steps_of(w, FINER);
    reference *r = alloc(1, sizeof *r);
    r->shape = records_open(NULL, w->image, &engine_double);
    r->columns = r->shape->columns;
    r->wanted = w->records;
    r->column = alloc(r->columns, sizeof *r->column);
    r->limit = fixed ? w->by.limit : LIMIT;
    computed other = compute(w, steps / 2U, &engine_double);
    for (int before = 0;; before = r->records, steps *= 2U) {
        const computed best = compute(w, steps, &engine_double);
        const int reached = best.records < other.records ? best.records : other.records;
        r->row = best.row;
        judge(r, w, steps / 2U, &other, reached);
        const double agreement = reference_agreement(r, -1);
        const bool grows = r->records < r->wanted && r->records >= 2 * before;
        free(other.row);
        if (interrupted || fixed || 2U * steps > steps_of(w, grows ? LAST : FINEST) ||
            (r->records == r->wanted && agreement > 0.0 && agreement <= ENOUGH)) {
            say(w, r, steps, reached);
            break;
        }
        other = best;
    }
    /* the finer run's error is 1/(2^order - 1) of the difference of the two runs */
    for (int k = 1; k < r->columns && fixed; k++) {
        r->column[k].off /= number_scaled(1.0, w->by.order) - 1.0;
    }
    r->stopped = interrupted != 0;
    return r;
}

/* --- its columns -------------------------------------------------------------------------------------*/

void reference_cut(reference *r, int until) {
    r->records = until < r->records ? until : r->records;
    for (int k = 1; k < r->columns; k++) {
        reference_column *c = &r->column[k];
        c->largest = largest_of(r, r->row, r->records, k);
        c->counts = c->counts && c->largest > 0.0;
    }
}

double reference_agreement(const reference *r, int column) {
    double worst = 0.0;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (column >= 0 ? k == column : c->counts) {
            worst = number_most(worst, c->off / c->largest);
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

static bool is_noisy(const op_list *t, int result) {
    bool *needed = alloc(t->count, sizeof *needed);
    bool found = false;
    op_list_mark_needed(t, t->result[result], needed);
    for (int i = t->result[result]; i >= 0; i--) {
        found = found || (needed[i] && t->ops[i].code == OP_NOISE);
    }
    free(needed);
    return found;
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
            *noisy = c->unknown < 0 &&
                     is_noisy(im->list[IMAGE_OBSERVE], k - (r->columns - im->own_outputs));
            return k;
        }
    }
    return -1;
}
