/* missed.c: see missed.h. */
#include "missed.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "along.h"
#include "core/contact.h"
#include "host/base/room.h"

/* Halvings of a step, and parts of it that are looked at for one contact. */
#define HALVINGS 24
#define PARTS_MOST 400
/* Less than this share of the gap at the ends, or of its change at its slope there, is a touch. So is less than so many times
 * the bounds' width, which is rounding. */
#define TOUCH 1e-9
#define WIDTHS 64.0
/* An acceleration that both ends do not show is so many times theirs, and over a step would change the rate by this share. */
#define HIDDEN 2.0
#define TURNS 0.05

struct missed {
    const image *image;
    along_bounds *signals; /* or NULL */
    along_bounds *accel;   /* where an exponential function is in it, or NULL */
    double *from;          /* [angles + reals] the state before the step, */
    double *to;            /* and after it */
    int *mode;             /* [contacts] likewise */
    int *mode_to;
    double *most;              /* [coordinates] more is hidden from both ends */
    const engine_piece *piece; /* the one that is looked at */
    double size;               /* the larger margin at its ends */
    int parts;                 /* looked at, so far */
};

static bool has_exponential(const tape *t) {
    bool some = false;
    for (int i = 0; i < t->count; i++) {
        some = some || (t->ops[i].code == OP_CALL && t->ops[i].function == FN_EXP);
    }
    return some;
}

missed *missed_open(const image *im) {
    const tape *signals = im->forced > 0 ? im->list[IMAGE_SIGNALS] : NULL;
    const tape *accel = im->form == WH_SECOND_ORDER && has_exponential(im->list[IMAGE_STEP])
                            ? im->list[IMAGE_STEP]
                            : NULL;
    if (signals == NULL && accel == NULL) {
        return NULL;
    }
    missed *m = room(1, sizeof *m);
    const int64_t all = im->angles + im->reals;
    m->image = im;
    m->signals = signals != NULL ? along_open(im, signals) : NULL;
    m->accel = accel != NULL ? along_open(im, accel) : NULL;
    m->from = room(2 * all + im->coordinates, sizeof *m->from);
    m->to = m->from + all;
    m->most = m->to + all;
    m->mode = room(2 * im->contacts, sizeof *m->mode);
    m->mode_to = m->mode + im->contacts;
    return m;
}

void missed_close(missed *m) {
    if (m != NULL) {
        along_close(m->signals);
        along_close(m->accel);
        free(m->from);
        free(m->mode);
        free(m);
    }
}

/* --- parts of a piece -----------------------------------------------------------------------------------*/

/* Above zero: the contact stays as it is. */
static enclosure margin(const missed *m, int k, enclosure signal) {
    const bool is = m->image->contact[k].kind == WH_STOP || m->piece->mode[k] == WH_ACTIVE;
    return is ? signal : enclosure_neg(signal);
}

/* Is what is looked at found inside on a part of the way (1), nowhere there (0), or is that open (-1)? */
typedef int looking(missed *m, int k, double low, double high, double bar);

/* The finest part: a contact as thin as that is none. */
static bool is_finest(double low, double high) { return high - low <= 1.0 / (1 << HALVINGS); }

/* `beyond`: so far a margin may be below zero, as at an end where an event was located. */
static int look_contact(missed *m, int k, double low, double high, double beyond) {
    along_look(m->signals, 2 * k, low, high);
    const enclosure middle = margin(m, k, along_middle(m->signals, 2 * k));
    const enclosure value = margin(m, k, along_value(m->signals, 2 * k));
    const double change = number_least(m->size, along_change(m->signals, 2 * k));
    const double rounding = WIDTHS * (middle.high - middle.low);
    const double touch = number_most(beyond, number_most(TOUCH * change, rounding));
    if (middle.high < -touch) {
        return 1;
    }
    const bool outside = value.low >= -beyond || enclosure_size(value) <= touch;
    return outside || (is_finest(low, high) && enclosure_is_finite(value)) ? 0 : -1;
}

static int look_force(missed *m, int i, double low, double high, double most) {
    along_look(m->accel, i, low, high);
    const enclosure middle = along_middle(m->accel, i);
    if (middle.low > most || middle.high < -most) {
        return 1;
    }
    return enclosure_size(along_value(m->accel, i)) <= most ? 0 : -1;
}

static int passes(missed *m, looking *look, int k, double low, double high, double bar,
                  int halvings) {
    if (m->parts >= PARTS_MOST) {
        return -1;
    }
    m->parts++;
    const int found = look(m, k, low, high, bar);
    if (found >= 0 || halvings == 0) {
        return found;
    }
    const double middle = 0.5 * (low + high);
    const int first = passes(m, look, k, low, middle, bar, halvings - 1);
    const int second = first > 0 ? 0 : passes(m, look, k, middle, high, bar, halvings - 1);
    return first > 0 || second > 0 ? 1 : first < 0 || second < 0 ? -1 : 0;
}

/* Does contact k, which is in the same mode at both ends, leave it on the way? */
static int contact_passes(missed *m, int k) {
    double beyond = 0.0;
    m->size = 0.0;
    if (margin(m, k, along_glance(m->signals, 2 * k)).low >= 0.0 ||
        look_contact(m, k, 0.0, 1.0, 0.0) == 0) {
        return 0;
    }
    for (int end = 0; end < 2; end++) {
        along_look(m->signals, 2 * k, end, end);
        const enclosure value = margin(m, k, along_value(m->signals, 2 * k));
        m->size = number_most(m->size, value.high);
        beyond = number_most(beyond, -2.0 * value.low);
    }
    m->parts = 0;
    return passes(m, look_contact, k, 0.0, 1.0, beyond, HALVINGS);
}

static missed_found contact_passed(missed *m) {
    missed_found found = MISSED_NOTHING;
    for (int k = 0; k < m->image->forced && !found.sure; k++) {
        const int what = m->image->contact[k].kind;
        if (what == WH_HOLD || (what == WH_STOP && m->piece->mode[k] == WH_FREE)) {
            const int passed = contact_passes(m, k);
            found = passed > 0 || (passed < 0 && found.what < 0)
                        ? (missed_found){.what = k, .sure = passed > 0}
                        : found;
        }
    }
    return found;
}

/* The coordinate whose acceleration on the way is hidden from both ends. One at rest in balance has bounds of underflow alone. */
static missed_found force_passed(missed *m) {
    missed_found found = MISSED_NOTHING;
    const int n = m->image->coordinates;
    bool open[IMAGE_COMPONENTS_MAX];
    for (int end = 0; end < 2; end++) {
        along_look(m->accel, -1, end, end);
        for (int i = 0; i < n; i++) {
            const double size = HIDDEN * enclosure_size(along_value(m->accel, i));
            m->most[i] = (end == 0 ? 0.0 : m->most[i]) + size;
        }
    }
    for (int i = 0; i < n; i++) {
        const double rate = number_most(fabs(m->piece->from[n + i]), fabs(m->piece->to[n + i]));
        m->most[i] = number_most(number_most(m->most[i], TURNS * rate / m->piece->span_s), DBL_MIN);
        open[i] = m->most[i] - m->most[i] == 0.0 &&
                  !(enclosure_size(along_glance(m->accel, i)) <= m->most[i]);
    }
    for (int i = 0; i < n && !found.sure; i++) {
        m->parts = 0;
        const int passed = open[i] ? passes(m, look_force, i, 0.0, 1.0, m->most[i], HALVINGS) : 0;
        found = passed > 0 || (passed < 0 && found.what < 0)
                    ? (missed_found){.what = m->image->contacts + i, .sure = passed > 0}
                    : found;
    }
    return found;
}

static missed_found piece_passed(missed *m, const engine_piece *piece) {
    missed_found found = MISSED_NOTHING;
    if (piece->span_s <= m->image->step_s / (1 << HALVINGS)) {
        return found; /* as thin as is_finest() has it */
    }
    m->piece = piece;
    if (m->signals != NULL) {
        along_way(m->signals, piece->from, piece->to, piece->span_s);
        found = contact_passed(m);
    }
    if (m->accel != NULL && found.what < 0) {
        along_way(m->accel, piece->from, piece->to, piece->span_s);
        found = force_passed(m);
    }
    return found;
}

missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, bool eventful) {
    missed_found found = MISSED_NOTHING;
    if (m == NULL) {
        return found;
    }
    const image *im = m->image;
    int count = 0;
    memcpy(m->from, m->to, (size_t)(im->angles + im->reals) * sizeof *m->to);
    memcpy(m->mode, m->mode_to, (size_t)im->contacts * sizeof *m->mode);
    kind->state(run, m->to, m->to + im->angles);
    if (im->contacts > 0) {
        kind->modes(run, m->mode_to);
    }
    if (kind->steps(run) == 0) {
        return found;
    }
    const engine_piece *pieces =
        im->contacts > 0 && kind->pieces != NULL ? kind->pieces(run, &count) : NULL;
    for (int i = 0; i < count && !found.sure; i++) {
        const missed_found in = piece_passed(m, &pieces[i]);
        found = in.sure || found.what < 0 ? in : found;
    }
    if (count == 0 && !eventful) {
        const engine_piece all = {im->step_s, m->from, m->to, m->mode};
        found = piece_passed(m, &all);
    }
    return found;
}
