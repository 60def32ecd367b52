#include "horizons.h"
#include "test.h"

#include "host/lang/builtin.h"

enum { LOOKS = 10000 };

typedef struct reference_of {
    image fine;
    void *run;
    uint64_t each; /* number of the reference's steps in one step of the run */
    records *records;
    bool failed;
} reference_of;

static void reference_open(reference_of *r, const image *im, bool finer) {
    *r = (reference_of){.fine = *im, .each = finer ? 32 : 16};
    r->fine.settings.compensated = true;
    r->fine.list[IMAGE_MATRIX] = NULL; /* a matrix is valid for one step length only */
    r->fine.settings.method = im->contacts > 0 ? WH_RK4 : WH_NYSTROEM5;
    r->fine.step.denominator *= r->each;
    r->fine.step_s = ratio_times(1, r->fine.step);
    r->run = engine_double.start(&r->fine);
    r->records = records_open(NULL, &r->fine, &engine_double);
}

static void reference_close(reference_of *r) {
    engine_double.stop(r->run);
    records_close(r->records);
}

/* Advances the reference by `steps` steps of the run, to time_s. */
static void reference_go(reference_of *r, uint64_t steps, double time_s) {
    for (uint64_t i = 0; i < steps * r->each && !r->failed; i++) {
        r->failed = engine_double.step(r->run) != WH_OK;
    }
    records_read(r->records, r->run, time_s);
}

typedef struct beside {
    horizons *h;
    reference_of fine, other;
    records *now;
    double *last; /* [columns] difference between run and reference at the previous sample */
    double before_s, look_s;
    int open; /* number of columns that are still accurate */
} beside;

static void enter(beside *b) {
    horizons *h = b->h;
    for (int k = 1; k < h->doubling->columns; k++) {
        const double level = h->estimate.tolerance * h->estimate.column[k].range;
        const double off = fabs(b->now->row[k] - b->fine.records->row[k]);
        const bool events = h->image->contacts > 0;
        const double now = isfinite(off) && !b->fine.failed ? off : (double)INFINITY;
        const double counts = events ? fmin(now, b->last[k]) : now;
        b->last[k] = now;
        if (h->estimate.column[k].verdict == HORIZON_ROUNDING ||
            h->estimate.column[k].verdict == HORIZON_STILL || isfinite(h->true_s[k]) ||
            counts <= level) {
            continue;
        }
        h->true_s[k] = events ? b->before_s : b->look_s;
        b->open--;
        const double differ = fabs(b->other.records->row[k] - b->fine.records->row[k]) / level;
        if (!events) { /* near events the two references may differ for one step */
            h->known = fmax(h->known, isfinite(differ) ? differ : (double)INFINITY);
        }
    }
}

static void run_beside(horizons *h, uint64_t stride) {
    const image *im = h->image;
    const engine_kind *kind = h->doubling->shape->kind;
    beside b = {.h = h,
                .now = records_open(NULL, im, kind),
                .last = calloc((size_t)h->doubling->columns, sizeof(double)),
                .open = h->doubling->columns - 1};
    void *run = kind->start(im);
    const image *finer = h->image->finer != NULL ? h->image->finer : h->image;
    reference_open(&b.fine, finer, true);
    reference_open(&b.other, finer, false);
    uint64_t step = 0;
    while (step < im->steps && b.open > 0) {
        const uint64_t more = step + stride < im->steps ? stride : im->steps - step;
        wh_status status = WH_OK;
        for (uint64_t i = 0; i < more && status == WH_OK; i++) {
            status = kind->step(run);
        }
        step += more;
        const double time_s = ratio_times(step, im->step);
        reference_go(&b.fine, more, time_s);
        reference_go(&b.other, more, time_s);
        records_read(b.now, run, time_s);
        enter(&b);
        b.before_s = b.look_s;
        b.look_s = time_s;
        if (status != WH_OK) {
            break;
        }
    }
    kind->stop(run);
    reference_close(&b.fine);
    reference_close(&b.other);
    records_close(b.now);
    free(b.last);
}

static image *image_with(const derived *d, const image_settings *settings) {
    diags *errors = diags_new();
    image *im = image_make(d->equations, d->equations->instance->conserve, settings, IMAGE_TO_CHECK,
                           errors);
    diags_flush(errors, stdout);
    diags_free(errors);
    TEST_ASSERT_NOT_NULL(im);
    return im;
}

horizons horizons_of(const char *text, const char *name, horizons_setting how, double tolerance) {
    horizons h = {.made = derived_scene(text, name)};
    derived_expect(&h.made, text);
    const image_settings settings = {.method = how.method,
                                     .compensated = how.compensated,
                                     .tables = how.tables,
                                     .matrix = how.matrix};
    h.image = image_with(&h.made, &settings);
    h.checks = run_checks_whole(h.image, how.kind, NULL, NULL);
    h.doubling = h.checks->doubling;
    h.estimate = horizon_of(h.doubling, tolerance);
    h.true_s = calloc((size_t)h.doubling->columns, sizeof *h.true_s);
    TEST_ASSERT_NOT_NULL(h.true_s);
    for (int k = 1; k < h.doubling->columns; k++) {
        h.true_s[k] = (double)INFINITY;
    }
    const uint64_t stride = 1 + h.image->steps / LOOKS;
    h.look_s = ratio_times(stride, h.image->step);
    run_beside(&h, stride);
    h.true_until_s = h.doubling->end_s;
    for (int k = 1; k < h.doubling->columns; k++) {
        h.true_until_s = fmin(h.true_until_s, h.true_s[k]);
    }
    return h;
}

void horizons_free(horizons *h) {
    horizon_free(&h->estimate);
    run_checks_close(h->checks);
    image_free(h->image);
    free(h->true_s);
    derived_free(&h->made);
}

double horizons_ratio(const horizons *h) {
    return h->true_until_s > 0.0 ? h->estimate.until_s / h->true_until_s
                                 : (h->estimate.until_s > 0.0 ? (double)INFINITY : 1.0);
}

double horizons_column_ratio(const horizons *h, int column) {
    const double real = fmin(h->true_s[column], h->doubling->end_s);
    const double guess = h->estimate.column[column].until_s;
    return real > 0.0 ? guess / real : (guess > 0.0 ? (double)INFINITY : 1.0);
}

static char *joined(const char *text, size_t length, const char *more) {
    char *all = malloc(length + strlen(more) + 1);
    TEST_ASSERT_NOT_NULL(all);
    memcpy(all, text, length);
    memcpy(all + length, more, strlen(more) + 1);
    return all;
}

char *horizons_builtin(const char *file, const char *more) {
    for (size_t i = 0; i < builtin_model_count; i++) {
        const struct builtin_model *b = &builtin_models[i];
        const char *slash = strrchr(b->file, '/');
        if (strcmp(slash != NULL ? slash + 1 : b->file, file) == 0) {
            return joined(b->text, b->length, more);
        }
    }
    TEST_FAIL_MESSAGE(file);
    return NULL;
}

char *horizons_file(const char *path, const char *more) {
    char text[16384];
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    const size_t length = fread(text, 1, sizeof text, in);
    fclose(in);
    TEST_ASSERT_TRUE_MESSAGE(length < sizeof text, path);
    return joined(text, length, more);
}
