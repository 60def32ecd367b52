/* narrow.c: see narrow.h. */
#include "narrow.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* The smallest normal float, and what one is rounded by, of itself. */
#define FLOAT_LEAST 0x1p-126
#define FLOAT_ROUNDING 0x1p-24
/* Less than this part of a slope is not told. */
#define PART_TOLD 1e-3

/* A step's list, in double, with what its results lose. */
typedef struct asked {
    const image *image;
    evaluator *evaluator;
    int results;
    double *input;
    double *value;   /* [results] */
    double *without; /* [results] off by rounding, in units of it */
    double *with;    /* and by what is too small */
} asked;

static void ask(asked *a, double time_s, const double *x) {
    const image *im = a->image;
    const double *real = x + im->angles;
    evaluator_run(a->evaluator, time_s, x, real, real + (im->coordinates - im->angles), a->input,
                  a->value);
    evaluator_rounding(a->evaluator, x, 0.0, a->without);
    evaluator_rounding(a->evaluator, x, FLOAT_LEAST, a->with);
}

/* Would a slope that large have moved it by a part that counts? What stands still has no range to tell: then what the slope
 * alone would make of its place in that time is asked. A slope of nothing but rounding moves nothing. */
static bool moves(const asked *a, const watch *w, int i, double slope) {
    const int c = image_slope_component(a->image, i);
    const double time_s = watch_time_s(w, w->steps);
    if (w->range[c] > 0.0) {
        return slope * time_s > PART_TOLD * w->range[c];
    }
    const bool first = a->image->form == WH_FIRST_ORDER;
    const double size = number_most(number_most(fabs(w->low[i]), fabs(w->high[i])), w->range[i]);
    return slope * time_s * (first ? 1.0 : time_s) > PART_TOLD * size;
}

/* What is lost at a record, of the largest slopes. */
static void judge(const asked *a, const watch *w, int record, const double *most, narrow *n) {
    for (int i = 0; i < a->results; i++) {
        const int c = image_slope_component(a->image, i);
        const double lost = FLOAT_ROUNDING * (a->with[i] - a->without[i]);
        const double part = most[i] > 0.0 ? lost / most[i] : 0.0;
        if (isfinite(part) && part > n->part && moves(a, w, i, most[i])) {
            *n = (narrow){part, c, w->record_s[record]};
        }
    }
}

narrow narrow_of(const watch *w) {
    const image *im = w->field->image;
    const tape *t = im->list[IMAGE_STEP];
    narrow n = {.component = -1};
    asked a = {.image = im, .results = t->results};
    double *most = room(t->results, sizeof *most);
    a.evaluator = evaluator_new(t);
    evaluator_wrap(a.evaluator);
    a.input = room(im->inputs, sizeof *a.input);
    a.value = room(3 * (int64_t)t->results, sizeof *a.value);
    a.without = a.value + t->results;
    a.with = a.without + t->results;
    image_inputs(im, a.input);
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < w->records; k++) {
            ask(&a, w->record_s[k], w->record + k * (ptrdiff_t)w->field->n);
            for (int i = 0; i < a.results && pass == 0; i++) {
                most[i] = number_most(most[i], fabs(a.value[i]));
            }
            if (pass == 1) {
                judge(&a, w, k, most, &n);
            }
        }
    }
    evaluator_free(a.evaluator);
    free(a.input);
    free(a.value);
    free(most);
    return n;
}

void narrow_say(FILE *out, const image *im, const narrow *n) {
    if (n->part < PART_TOLD) {
        return;
    }
    const component c = image_component(im, n->component);
    fprintf(
        out,
        "whirl run: warning: float has no room for what '%s' is made of: products below 1.2e-38 or beyond 3.4e+38 are "
        "cut or lost, up to %.2g %% of its slope about t = %.6g s\n"
        "hint: --number double; float holds sizes from 1.2e-38 to 3.4e+38 in SI units\n",
        im->unknown[c.unknown].name, 100.0 * number_least(n->part, 1.0), n->time_s);
}
