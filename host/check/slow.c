#include "slow.h"

#include <string.h>

#include "host/number/functions.h"

bool slow_component(const engine_kind *kind, const void *run, int i) {
    double span;
    const double off = kind->component_off(run, i, &span);
    const double least =
        kind->unit != NULL ? SLOW_LEAST_UNITS * kind->unit(run, i) : SLOW_LEAST_RAD;
    return off > SLOW_SHARE * span && off > least;
}

/* kind->unit is NULL in float and double. */
static int components(const engine_kind *kind, const image *im, const void *run) {
    const bool held = kind->saturated != NULL && kind->saturated(run) > 0;
    return held ? 0 : im->angles + (kind->unit != NULL ? im->reals : 0);
}

int slow_count(const engine_kind *kind, const image *im, const void *run, double *share) {
    int count = 0;
    *share = 0.0;
    for (int i = 0; i < components(kind, im, run); i++) {
        if (slow_component(kind, run, i)) {
            double span;
            const double off = kind->component_off(run, i, &span);
            *share = number_most(*share, off / span);
            count++;
        }
    }
    return count;
}

static void say(FILE *out, const image *im, const engine_kind *kind, const void *run, int i) {
    const component c = image_component(im, i);
    const image_unknown *u = &im->unknown[c.unknown];
    const char *si = kind->unit == NULL ? "rad" : u->unit[c.primes].si;
    const char *unit = strcmp(si, "1") == 0 ? "" : si;
    const char *space = unit[0] != '\0' ? " " : "";
    double span;
    const double off = kind->component_off(run, i, &span);
    fprintf(out, "'%s%.*s' ", u->name, c.primes, "''''''''''");
    if (kind->unit == NULL) {
        fputs("turns so slowly that rounding its change in each step to 1.5e-9 rad, as float does,",
              out);
    } else {
        fprintf(
            out,
            "moves so slowly that rounding in each step, of its value to %.2g%s%s and of its change,",
            kind->unit(run, i), space, unit);
    }
    fprintf(out, " causes an error of up to %.2g%s%s", off, space, unit);
    if (span > 0.0) {
        fprintf(out, " (%.3g %% of its true change, %.2g%s%s)", 100.0 * off / span, span, space,
                unit);
    }
}

void slow_message(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    int i = 0;
    while (!slow_component(kind, run, i)) {
        i++;
    }
    say(out, im, kind, run, i);
}

void slow_say(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    bool some = false;
    for (int i = 0; i < components(kind, im, run); i++) {
        if (slow_component(kind, run, i)) {
            fputs("whirl run: note: ", out);
            say(out, im, kind, run, i);
            fputc('\n', out);
            some = true;
        }
    }
    if (some) {
        fputs(
            kind->unit != NULL
                ? "hint: use a larger --step, or --number float --compensated; narrower ranges help too, except for turn angles\n"
                : "hint: use --compensated or a larger --step: both reduce round-off\n",
            out);
    }
}
