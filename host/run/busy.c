/* busy.c: see busy.h. */
#include "busy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/room.h"
#include "host/number/functions.h"

/* What has not gone further than this part of what the furthest of its unit has is measured by that. */
#define ALIKE_SHARE 1e-3

busy *busy_open(const image *im, uint64_t parts) {
    if (im->contacts == 0) {
        return NULL;
    }
    busy *b = room(1, sizeof *b);
    b->image = im;
    b->parts = parts;
    b->chatters = -1;
    b->n = im->angles + im->reals;
    b->look = room((BUSY_LOOKS + 4) * (int64_t)b->n, sizeof *b->look);
    b->low = b->look + (ptrdiff_t)(BUSY_LOOKS + 2) * b->n;
    b->high = b->low + b->n;
    for (int k = 0; k < im->contacts; k++) {
        b->mode[k] = WH_UNSET;
    }
    return b;
}

void busy_close(busy *b) {
    if (b != NULL) {
        free(b->look);
        free(b);
    }
}

/* --- events ------------------------------------------------------------------------------------------------*/

/* Which contacts changed their mode in the last step, as bits. Crossings have sides, no modes that could chatter. */
static unsigned changes_of(busy *b, const engine_event *event, int count) {
    unsigned bits = 0;
    for (int i = 0; i < count; i++) {
        const int k = event[i].contact;
        const int kind = b->image->contact[k].kind;
        const bool other = event[i].mode != b->mode[k] && b->mode[k] != WH_UNSET;
        bits |= kind != WH_WHEN && (other || kind == WH_HOLD) ? 1U << k : 0U;
        b->mode[k] = event[i].mode;
    }
    return bits;
}

static int bits_of(uint32_t set) {
    int count = 0;
    for (; set != 0; set &= set - 1U) {
        count++;
    }
    return count;
}

static void watch_modes(busy *b, const engine_event *event, int count) {
    const unsigned changed = changes_of(b, event, count);
    for (int k = 0; k < b->image->contacts; k++) {
        b->changed[k] = (b->changed[k] << 1U | (changed >> k & 1U)) & ((1U << BUSY_WINDOW) - 1U);
        if ((changed >> k & 1U) == 0 || bits_of(b->changed[k]) < BUSY_CHANGES) {
            continue;
        }
        b->changes[k]++;
        if (b->chatters < 0) {
            b->chatters = k;
            b->chatters_at = b->steps;
        } else if (b->changes[k] > b->changes[b->chatters]) {
            b->chatters = k;
        }
    }
}

static void watch_events(busy *b, const engine_kind *kind, const void *run, double energy_J) {
    engine_event event[WH_EVENT_LOG];
    uint64_t overruns;
    kind->events(run, &overruns);
    const int count = kind->happened(run, event);
    if (overruns > b->overruns) {
        b->overran_at = b->overruns == 0 ? b->steps - 1 : b->overran_at;
        b->overruns = overruns;
        b->taken_J += fabs(energy_J - b->energy_J);
        for (int i = 0; i < count; i++) {
            b->in_overruns[event[i].contact]++;
        }
    }
    watch_modes(b, event, count);
}

/* --- the way --------------------------------------------------------------------------------------------------*/

/* Counted in steps of the run that is judged. */
static bool is_look(const busy *b) {
    const uint64_t all = b->image->steps / b->parts;
    const uint64_t stride = 1 + (all > 0 ? (all - 1) / BUSY_LOOKS : 0);
    return b->steps % (stride * b->parts) == 0 || b->steps == all * b->parts;
}

void busy_enter(busy *b, const engine_kind *kind, const void *run, double energy_J) {
    double x[3 * IMAGE_COMPONENTS_MAX];
    if (b == NULL) {
        return;
    }
    b->steps = kind->steps(run);
    kind->state(run, x, x + b->image->angles);
    for (int i = 0; i < b->n; i++) {
        b->low[i] = b->steps == 0 || x[i] < b->low[i] ? x[i] : b->low[i];
        b->high[i] = b->steps == 0 || x[i] > b->high[i] ? x[i] : b->high[i];
    }
    if (b->steps > 0) {
        watch_events(b, kind, run, energy_J);
    }
    b->energy_J = energy_J;
    if (is_look(b) && b->looks < BUSY_LOOKS + 2) {
        memcpy(b->look + b->looks * (ptrdiff_t)b->n, x, (size_t)b->n * sizeof *x);
        b->looks++;
    }
}

static const char *unit_of(const image *im, int i) {
    const component c = image_component(im, i);
    return im->unknown[c.unknown].unit[c.primes].si;
}

/* How far component i went, at least a part of what others like it did. */
static double range_of(const busy *b, int i) {
    double range = b->high[i] - b->low[i];
    for (int k = 0; k < b->n; k++) {
        if (strcmp(unit_of(b->image, i), unit_of(b->image, k)) == 0) {
            range = number_most(range, ALIKE_SHARE * (b->high[k] - b->low[k]));
        }
    }
    return range;
}

double busy_off(const busy *b, const busy *truth) {
    double most = 0.0;
    for (int i = 0; i < b->n; i++) {
        const double range = range_of(truth, i);
        for (int k = 0;
             k < b->looks && k < truth->looks && image_component(b->image, i).primes == 0; k++) {
            const double off =
                fabs(b->look[k * (ptrdiff_t)b->n + i] - truth->look[k * (ptrdiff_t)b->n + i]);
            most = off > 0.0 ? number_most(most, off / range) : most;
        }
    }
    return most;
}
