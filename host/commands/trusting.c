/* trusting.c: see trusting.h. */
#include "trusting.h"

#include "host/number/functions.h"
#include "host/trust/horizon_text.h"

load_keep trusting_keep(const image_settings *settings) {
    image_settings plain;
    return twins_plain(settings, &plain) ? KEEP_EQUATIONS : KEEP_IMAGE;
}

image *trusting_plain(const loaded *made) {
    const image *im = made->image;
    image_settings plain;
    if (im == NULL || made->equations == NULL || !twins_plain(&im->settings, &plain)) {
        return NULL;
    }
    diags *unsaid = diags_new(); /* it has been said of the run's image */
    image *without = image_make(made->equations, made->equations->instance->conserve, &plain,
                                IMAGE_TO_RUN, unsaid);
    diags_free(unsaid);
    return without;
}

trusting trusting_look(const image *im, const image *plain, simulation_settings *s) {
    trusting t = {0};
    const image *without = plain != NULL ? plain : im;
    s->trusted_s = 0.0;
    t.dear = twins_operations(im, without) > TRUSTING_OPERATIONS_1S;
    if ((s->quiet && s->plot == NULL && s->taken == NULL) || im->steps == 0 || t.dear) {
        return t;
    }
    const twins_wish wish = {.image = im, .kind = s->kind, .plain = without, .stop = s->stop};
    t.twins = twins_run(&wish);
    t.horizon = horizon_of(t.twins, HORIZON_TOLERANCE);
    if (t.twins->status == WH_OK && !t.twins->stopped && !t.horizon.to_the_end) {
        s->trusted_s = number_most(t.horizon.until_s, im->step_s);
    }
    return t;
}

void trusting_say(const trusting *t, const simulation_settings *s, bool doubted) {
    FILE *out = simulation_summary(s);
    if (s->quiet) {
        return;
    }
    if (t->dear) {
        fputs("trusted            whirl trust tells until when: it takes more than a second\n",
              out);
    } else if (t->twins != NULL && t->twins->status == WH_OK && !t->twins->stopped) {
        horizon_print_line(out, &t->horizon, doubted);
    }
}

double trusting_until_s(const trusting *t, bool doubted) {
    const horizon *h = &t->horizon;
    if (t->twins == NULL || t->twins->status != WH_OK || t->twins->stopped ||
        (h->to_the_end && doubted)) {
        return -1.0;
    }
    const bool told =
        h->to_the_end || (h->column[h->first].verdict != HORIZON_NOT_TOLD && !t->twins->between);
    return told ? h->until_s : -1.0;
}

void trusting_end(trusting *t) {
    if (t->twins != NULL) {
        horizon_free(&t->horizon);
        twins_free(t->twins);
    }
}
