/* bind.c: signals to quantities. */
#include "bind.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/base/spelling.h"

enum { NAME_BYTES = 80 };

/* An angle is a number: rad equals 1, rad/s equals 1/s. */
static bool is_same_unit(const char *one, const char *other) {
    char both[2][NAME_BYTES];
    const char *const of[2] = {one, other};
    for (int i = 0; i < 2; i++) {
        const bool is_rad = strncmp(of[i], "rad", 3) == 0;
        snprintf(both[i], sizeof both[i], "%s%s", is_rad ? "1" : "", of[i] + (is_rad ? 3 : 0));
    }
    return strcmp(both[0], both[1]) == 0;
}

static bool is_output(const bound *b) { return b->signal.kind == WH_SIGNAL_OUTPUT; }

/* "theta'" is the rate of theta. */
static bool is_component(const image *im, int i, const char *name) {
    const component c = image_component(im, i);
    const image_unknown *u = &im->unknown[c.unknown];
    const size_t length = strlen(u->name);
    if (strncmp(name, u->name, length) != 0 || strlen(name) != length + (size_t)c.primes) {
        return false;
    }
    return strspn(name + length, "'") == (size_t)c.primes;
}

const char *bind_read(bound *b, const image *im, const char *name) {
    for (int i = 0; i < im->own_outputs; i++) {
        if (strcmp(im->output[i].name, name) == 0) {
            b->place = BOUND_OUTPUT;
            b->index = i;
            b->rate = -1;
            b->turns = false;
            return im->output[i].unit.si;
        }
    }
    for (int i = 0; i < im->angles + im->reals; i++) {
        if (is_component(im, i, name)) {
            const component c = image_component(im, i);
            b->place = BOUND_COMPONENT;
            b->index = i;
            b->rate = image_find_component(im, c.unknown, c.primes + 1);
            b->turns = c.primes == 0 && im->unknown[c.unknown].is_angle;
            return im->unknown[c.unknown].unit[c.primes].si;
        }
    }
    return NULL;
}

static const char *find_set(bound *b, const image *im, const char *name) {
    for (int i = 0; i < im->inputs; i++) {
        if (strcmp(im->input[i].name, name) == 0) {
            b->place = BOUND_INPUT;
            b->index = i;
            return im->input[i].unit.si;
        }
    }
    return NULL;
}

static void say_unknown(const bound *b, const image *im, const char *name) {
    nearest search = nearest_start(name, strlen(name));
    fprintf(stderr,
            "whirl pil: error: the firmware %s '%s', which '%s' does not have\nhint: it has",
            is_output(b) ? "sets" : "reads", name, im->name);
    const int count = is_output(b) ? im->inputs : im->own_outputs;
    const image_quantity *of = is_output(b) ? im->input : im->output;
    for (int i = 0; i < count; i++) {
        fprintf(stderr, " %s", of[i].name);
        nearest_offer(&search, of[i].name);
    }
    for (int i = 0; i < im->count && !is_output(b); i++) {
        fprintf(stderr, " %s", im->unknown[i].name);
        nearest_offer(&search, im->unknown[i].name);
    }
    fprintf(stderr, "; --bind %s=%s says which is meant\n", b->signal.name,
            search.best != NULL ? search.best : "NAME");
}

/* The scene's name of the firmware's `name`, into other[NAME_BYTES]. */
static void rename_signal(const char *renames, const char *name, char *other) {
    snprintf(other, NAME_BYTES, "%s", name);
    const size_t length = strlen(name);
    for (const char *at = renames; at != NULL && *at != '\0'; at += strcspn(at, ",")) {
        at += *at == ',';
        if (strncmp(at, name, length) == 0 && at[length] == '=') {
            const char *value = at + length + 1;
            snprintf(other, NAME_BYTES, "%.*s", (int)strcspn(value, ","), value);
        }
    }
}

/* The values of its end counts must be in the range of a sample. */
static bool fits_counts(const wh_signal *s) {
    return (double)s->low / (double)s->per_count >= (double)INT32_MIN &&
           (double)s->high / (double)s->per_count <= (double)INT32_MAX;
}

static bool has_good_range(const bound *b) {
    const wh_signal *s = &b->signal;
    const bool ordered = isfinite(s->low) && isfinite(s->high) && s->low <= s->high;
    const bool sampled = s->kind != WH_SIGNAL_SAMPLE ||
                         (s->period_ticks > 0 && s->per_count > 0.0F && isfinite(s->per_count));
    if (!ordered || !sampled) {
        fprintf(stderr,
                "whirl pil: error: the firmware declares '%s' from %g to %g, %g a count, every %u "
                "ticks\nhint: low <= high; a sample needs a period and a value a count\n",
                s->name, (double)s->low, (double)s->high, (double)s->per_count,
                (unsigned)s->period_ticks);
        return false;
    }
    if (s->kind == WH_SIGNAL_SAMPLE && !fits_counts(s)) {
        fprintf(stderr,
                "whirl pil: error: the firmware declares '%s' from %g to %g, %g a count: more "
                "counts than 32 bits have\nhint: a coarser count, or a narrower range\n",
                s->name, (double)s->low, (double)s->high, (double)s->per_count);
        return false;
    }
    return true;
}

static bool bind_one(bound *b, const image *im, const char *renames) {
    if (b->signal.kind == WH_SIGNAL_NOTE) {
        b->place = BOUND_NOWHERE;
        return true;
    }
    char name[NAME_BYTES];
    rename_signal(renames, b->signal.name, name);
    const char *unit = is_output(b) ? find_set(b, im, name) : bind_read(b, im, name);
    if (unit == NULL) {
        say_unknown(b, im, name);
        return false;
    }
    if (!is_same_unit(unit, b->signal.unit)) {
        fprintf(stderr,
                "whirl pil: error: the firmware's '%s' is in %s, and '%s' of '%s' in %s\n"
                "hint: what goes over the line is SI on both sides\n",
                b->signal.name, b->signal.unit, name, im->name, unit);
        return false;
    }
    return has_good_range(b);
}

/* The reason why a renaming is invalid, or NULL. A name that the firmware does not have would silently rename nothing,
 * and so would a second renaming of the same name. */
static const char *against(const binding *b, const char *renames, const char *at, size_t length) {
    const size_t name = strcspn(at, "=");
    if (name == 0 || name >= length || name + 1U == length) {
        return "it is no NAME=OTHER";
    }
    for (const char *before = renames; before < at; before += strcspn(before, ",") + 1U) {
        if (strncmp(before, at, name + 1U) == 0) {
            return "the firmware's signal is renamed already";
        }
    }
    for (unsigned i = 0; i < b->count; i++) {
        const char *known = b->bound[i].signal.name;
        if (strlen(known) == name && strncmp(at, known, name) == 0) {
            return NULL;
        }
    }
    return "the firmware has no signal of that name";
}

static bool all_are_used(const binding *b, const char *renames) {
    for (const char *at = renames; at != NULL;) {
        const size_t length = strcspn(at, ",");
        const char *why = against(b, renames, at, length);
        if (why != NULL) {
            fprintf(stderr,
                    "whirl pil: error: --bind '%.*s': %s\n"
                    "hint: --bind NAME=OTHER, the firmware's name first\n",
                    (int)length, at, why);
            return false;
        }
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return true;
}

bool bind_signals(binding *b, const wh_hello *hello, const image *im, const char *renames) {
    *b = (binding){.count = hello->signals};
    for (unsigned i = 0; i < hello->signals; i++) {
        b->bound[i].signal = hello->signal[i];
        switch (hello->signal[i].kind) {
        case WH_SIGNAL_OUTPUT: b->bound[i].channel = b->outputs++; break;
        case WH_SIGNAL_SAMPLE: b->bound[i].channel = b->samples++; break;
        case WH_SIGNAL_EDGE: b->bound[i].channel = b->edges++; break;
        case WH_SIGNAL_NOTE: b->bound[i].channel = b->notes++; break;
        }
        if (!bind_one(&b->bound[i], im, renames)) {
            return false;
        }
    }
    return all_are_used(b, renames);
}
