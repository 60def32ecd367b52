#include "missed.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "taylor_bounds.h"

/* Halvings of a step, and its most parts for one contact. */
#define HALVINGS 24
#define PARTS_MOST 400
/* A touch is below this share of the gap at the ends, or of its change at the slope there. It may also be below this many
 * times the bounds' width, which is round-off. */
#define TOUCH 1e-9
#define WIDTHS 64.0
/* A hidden acceleration is this many times those at both ends, and over a step would change the rate by this share. */
#define HIDDEN 2.0
#define TURNS 0.05
/* A gap's slope that changes by this share of its size in 2^-EDGE_HALVINGS of a step has an edge there. */
#define EDGE 0.05
#define EDGE_HALVINGS 8

struct missed {
    const image *image;
    taylor_bounds_bounds *signals; /* or NULL */
    taylor_bounds_bounds *accel;   /* if there is one to test, or NULL */
    bool hills;                    /* an exponential function is in them */
    bool edges;                    /* a gap may have an edge */
    taylor_bounds_bounds *laws;    /* of the contacts if a friction's limits move, or NULL */
    double *from;                  /* [angles + reals] the state before the step, */
    double *to;                    /* and after it */
    int *mode;                     /* [contacts] the same */
    int *mode_to;
    double *most;              /* [coordinates] more is hidden from both ends */
    const engine_piece *piece; /* the present piece */
    double size;               /* the larger margin at its ends */
    int parts;                 /* tested so far */
};

static bool has_exponential(const op_list *t) {
    bool some = false;
    for (int i = 0; i < t->count; i++) {
        some = some || (t->ops[i].code == OP_CALL && t->ops[i].function == FN_EXP);
    }
    return some;
}

static bool has_edges(const image *im) {
    const op_list *t = im->contacts > 0 ? im->list[IMAGE_SIGNALS] : NULL;
    bool some = false;
    for (int i = 0; t != NULL && i < t->count; i++) {
        const op_code code = t->ops[i].code;
        some = some || code == OP_ABS || code == OP_SIGN || code == OP_MIN || code == OP_MAX;
    }
    return some && im->contact[0].kind == WH_STOP;
}

/* The result of the contacts' laws that is this row of contact k. */
static int law_of(const image *im, int k, int row) {
    return k * (WH_LAW_ROWS + 2 * im->coordinates) + row;
}

/* A friction with undefined limits. */
static bool has_moving_limits(const image *im, int k) {
    const op_list *t = im->list[IMAGE_FORCES];
    return im->contact[k].kind == WH_FRICTION &&
           (t->ops[t->result[law_of(im, k, WH_LAW_FIRST)]].code != OP_CONSTANT ||
            t->ops[t->result[law_of(im, k, WH_LAW_SECOND)]].code != OP_CONSTANT);
}

missed *missed_open(const image *im) {
    const op_list *signals = im->contacts > 0 ? im->list[IMAGE_SIGNALS] : NULL;
    const bool hills = im->form == WH_SECOND_ORDER && has_exponential(im->list[IMAGE_STEP]);
    const op_list *laws = has_edges(im) ? im->list[IMAGE_FORCES] : NULL;
    for (int k = 0; k < im->forced; k++) {
        laws = has_moving_limits(im, k) ? im->list[IMAGE_FORCES] : laws;
    }
    if (signals == NULL && !hills) {
        return NULL;
    }
    missed *m = alloc(1, sizeof *m);
    const int64_t all = im->angles + im->reals;
    m->image = im;
    m->signals = signals != NULL ? taylor_bounds_open(im, signals) : NULL;
    m->hills = hills;
    m->edges = has_edges(im);
    m->accel = hills || laws != NULL ? taylor_bounds_open(im, im->list[IMAGE_STEP]) : NULL;
    m->laws = laws != NULL ? taylor_bounds_open(im, laws) : NULL;
    m->from = alloc(2 * all + im->coordinates, sizeof *m->from);
    m->to = m->from + all;
    m->most = m->to + all;
    m->mode = alloc(2 * im->contacts, sizeof *m->mode);
    m->mode_to = m->mode + im->contacts;
    return m;
}

void missed_close(missed *m) {
    if (m != NULL) {
        taylor_bounds_close(m->signals);
        taylor_bounds_close(m->accel);
        taylor_bounds_close(m->laws);
        free(m->from);
        free(m->mode);
        free(m);
    }
}

/* --- parts of a piece -----------------------------------------------------------------------------------*/

/* Positive: the contact keeps its mode. */
static enclosure margin(const missed *m, int k, enclosure signal) {
    const bool is = m->image->contact[k].kind == WH_STOP || m->piece->mode[k] > 0;
    return is ? signal : enclosure_neg(signal);
}

/* Is the condition met on a part of the way (1), excluded there (0), or undecided (-1)? */
typedef int looking(missed *m, int k, double low, double high, double bar);

/* The finest part: a thinner contact does not count. */
static bool is_finest(double low, double high) { return high - low <= 1.0 / (1 << HALVINGS); }

/* `beyond`: the largest negative margin of an end, because of the error of a located event. */
static int look_contact(missed *m, int k, double low, double high, double beyond) {
    taylor_bounds_look(m->signals, 2 * k, low, high);
    const enclosure middle = margin(m, k, taylor_bounds_middle(m->signals, 2 * k));
    const enclosure value = margin(m, k, taylor_bounds_value(m->signals, 2 * k));
    const double change = number_least(m->size, taylor_bounds_change(m->signals, 2 * k));
    const double rounding = WIDTHS * (middle.high - middle.low);
    const double touch = number_most(beyond, number_most(TOUCH * change, rounding));
    if (middle.high < -touch) {
        return 1;
    }
    const bool outside = value.low >= -beyond || enclosure_size(value) <= touch;
    return outside || (is_finest(low, high) && enclosure_is_finite(value)) ? 0 : -1;
}

static int look_size(taylor_bounds_bounds *a, int i, double low, double high, double most) {
    taylor_bounds_look(a, i, low, high);
    const enclosure middle = taylor_bounds_middle(a, i);
    if (middle.low > most || middle.high < -most) {
        return 1;
    }
    return enclosure_size(taylor_bounds_value(a, i)) <= most ? 0 : -1;
}

static int look_force(missed *m, int i, double low, double high, double most) {
    return look_size(m->accel, i, low, high, most);
}

static int look_drag(missed *m, int i, double low, double high, double most) {
    return look_size(m->laws, i, low, high, most);
}

static int look_grip(missed *m, int i, double low, double high, double least) {
    taylor_bounds_look(m->laws, i, low, high);
    return taylor_bounds_middle(m->laws, i).high < least  ? 1
           : taylor_bounds_value(m->laws, i).low >= least ? 0
                                                          : -1;
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

/* The earlier result, or this one: the first certain one counts. */
static missed_found or_this(missed_found found, int passed, int what) {
    return passed > 0 || (passed < 0 && found.what < 0)
               ? (missed_found){.what = what, .sure = passed > 0}
               : found;
}

/* A hold that would close has no effect if its expression rests all the way. */
static bool is_idle(missed *m, int k) {
    if (m->image->contact[k].kind != WH_HOLD || m->piece->mode[k] != WH_FREE) {
        return false;
    }
    taylor_bounds_look(m->signals, 2 * k + 1, 0.0, 1.0);
    const enclosure middle = taylor_bounds_middle(m->signals, 2 * k + 1);
    return enclosure_size(taylor_bounds_value(m->signals, 2 * k + 1)) <=
           WIDTHS * (middle.high - middle.low) + DBL_MIN;
}

/* Does contact k, which is in the same mode at both ends, leave it on the way? */
static int contact_passes(missed *m, int k) {
    double beyond = 0.0;
    m->size = 0.0;
    if (is_idle(m, k) || margin(m, k, taylor_bounds_glance(m->signals, 2 * k)).low >= 0.0 ||
        look_contact(m, k, 0.0, 1.0, 0.0) == 0) {
        return 0;
    }
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->signals, 2 * k, end, end);
        const enclosure value = margin(m, k, taylor_bounds_value(m->signals, 2 * k));
        m->size = number_most(m->size, value.high);
        beyond = number_most(beyond, -2.0 * value.low);
    }
    m->parts = 0;
    return passes(m, look_contact, k, 0.0, 1.0, beyond, HALVINGS);
}

static double middle_of(taylor_bounds_bounds *a, int result) {
    const enclosure e = taylor_bounds_middle(a, result);
    return 0.5 * e.low + 0.5 * e.high;
}

/* The speed and load of friction k at the ends. Each is the sum of its row's parts:
 * the acceleration of its rate by a unit force, and the force that keeps it stuck without other contacts. */
typedef struct met {
    double turns;
    double load;
    double rate;
} met;

static met met_by(missed *m, int k) {
    const int n = m->image->coordinates;
    const int rows = law_of(m->image, k, WH_LAW_ROWS);
    met of = {0.0, 0.0, 0.0};
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->laws, -1, end, end);
        taylor_bounds_look(m->accel, -1, end, end);
        double pull = middle_of(m->laws, law_of(m->image, k, WH_LAW_BIAS));
        double rate = 0.0;
        double turns = 0.0;
        for (int i = 0; i < n; i++) {
            const double row = middle_of(m->laws, rows + i);
            pull += row * middle_of(m->accel, i);
            rate += row * (end == 0 ? m->piece->from : m->piece->to)[n + i];
            turns += row * middle_of(m->laws, rows + n + i);
        }
        of.load = number_most(of.load, fabs(pull) / turns);
        of.rate = number_most(of.rate, fabs(rate));
        of.turns = number_most(of.turns, turns);
    }
    for (int l = 0; l < m->image->forced; l++) {
        const bool bears = m->image->contact[l].kind == WH_FRICTION || m->piece->mode[l] != WH_FREE;
        of.load = l != k && bears ? (double)INFINITY : of.load;
    }
    return of;
}

/* Does friction k, which slides at both ends, have a far larger limit between, or a far smaller one that could not
 * keep it stuck? */
static int limit_passes(missed *m, int k) {
    const bool sticks = m->piece->mode[k] == WH_STUCK;
    const int i = law_of(m->image, k, sticks ? WH_LAW_FIRST : WH_LAW_SECOND);
    double drag = 0.0;
    double grip = (double)INFINITY;
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->laws, i, end, end);
        const enclosure value = taylor_bounds_value(m->laws, i);
        drag += enclosure_is_finite(value) ? HIDDEN * enclosure_size(value) : 0.0;
        grip = value.low / HIDDEN < grip ? value.low / HIDDEN : grip;
    }
    const enclosure glance = taylor_bounds_glance(m->laws, i);
    if (sticks ? glance.low >= grip : glance.high <= drag) {
        return 0;
    }
    const met of = met_by(m, k);
    m->parts = 0;
    return sticks ? passes(m, look_grip, i, 0.0, 1.0, number_least(grip, of.load), HALVINGS)
                  : passes(m, look_drag, i, 0.0, 1.0,
                           number_most(drag, TURNS * of.rate / (m->piece->span_s * of.turns)),
                           HALVINGS);
}

/* --- edges ---------------------------------------------------------------------------------------------*/

static double look_width(missed *m, int i, double low, double high) {
    taylor_bounds_look(m->laws, i, low, high);
    const enclosure e = taylor_bounds_value(m->laws, i);
    return enclosure_is_finite(e) ? e.high - e.low : 0.0;
}

static int look_edge(missed *m, int i, double low, double high, double most) {
    return look_width(m, i, low, high) <= most                ? 0
           : high - low <= 1.0 / (double)(1 << EDGE_HALVINGS) ? 1
                                                              : -1;
}

/* Does the slope of stop k's gap jump on the way? A contact that lies on an edge all the way slides
 * over no edge. */
static bool slope_jumps(missed *m, int k) {
    bool some = false;
    for (int c = 0; c < m->image->coordinates && !some; c++) {
        const int i = law_of(m->image, k, WH_LAW_ROWS + c);
        const double width[2] = {look_width(m, i, 0.0, 0.0), look_width(m, i, 1.0, 1.0)};
        const double size = enclosure_size(taylor_bounds_value(m->laws, i));
        taylor_bounds_look(m->laws, i, 0.0, 0.0);
        const double most = EDGE * (size + enclosure_size(taylor_bounds_value(m->laws, i)));
        m->parts = 0;
        some = (width[0] <= most || width[1] <= most) &&
               passes(m, look_edge, i, 0.0, 1.0, most, EDGE_HALVINGS) > 0;
    }
    return some;
}

/* A resting stop is put back onto its face at the end of each step, even after it slid over an edge. So the path along its
 * rates at the begin is tested, too. */
static missed_found edge_passed(missed *m) {
    const engine_piece *p = m->piece;
    const int n = m->image->coordinates;
    double ahead[2 * IMAGE_COMPONENTS_MAX];
    memcpy(ahead, p->from, 2 * (size_t)n * sizeof *ahead);
    for (int i = 0; i < n; i++) {
        ahead[i] += p->span_s * p->from[n + i];
    }
    for (int way = 0; way < 2; way++) {
        taylor_bounds_way(m->laws, p->from, way == 0 ? p->to : ahead, p->span_s);
        for (int k = 0; k < m->image->forced; k++) {
            if (m->image->contact[k].kind == WH_STOP && p->mode[k] != WH_FREE &&
                slope_jumps(m, k)) {
                return (missed_found){.what = k, .sure = true, .edge = true};
            }
        }
    }
    return MISSED_NOTHING;
}

static missed_found contact_passed(missed *m) {
    missed_found found = MISSED_NOTHING;
    for (int k = 0; k < m->image->contacts && !found.sure; k++) {
        const image_contact *c = &m->image->contact[k];
        const int mode = m->piece->mode[k];
        if (c->kind == WH_HOLD || (c->kind == WH_STOP && mode == WH_FREE) ||
            (c->kind == WH_WHEN && c->sets > 0 && mode != 0)) {
            found = or_this(found, contact_passes(m, k), k);
        } else if (c->kind == WH_FRICTION && has_moving_limits(m->image, k)) {
            found = or_this(found, limit_passes(m, k), k);
        }
    }
    return found;
}

/* The coordinate with an acceleration on the way that neither end shows. At rest in balance the bounds are underflow alone. */
static missed_found force_passed(missed *m) {
    missed_found found = MISSED_NOTHING;
    const int n = m->image->coordinates;
    bool open[IMAGE_COMPONENTS_MAX];
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->accel, -1, end, end);
        for (int i = 0; i < n; i++) {
            const enclosure value =
                taylor_bounds_value(m->accel, i); /* an end without bounds proves nothing */
            const double size = enclosure_is_finite(value) ? HIDDEN * enclosure_size(value) : 0.0;
            m->most[i] = (end == 0 ? 0.0 : m->most[i]) + size;
        }
    }
    for (int i = 0; i < n; i++) {
        const double rate = number_most(fabs(m->piece->from[n + i]), fabs(m->piece->to[n + i]));
        m->most[i] = number_most(number_most(m->most[i], TURNS * rate / m->piece->span_s), DBL_MIN);
        open[i] = !(enclosure_size(taylor_bounds_glance(m->accel, i)) <= m->most[i]);
    }
    for (int i = 0; i < n && !found.sure; i++) {
        m->parts = 0;
        const int passed = open[i] ? passes(m, look_force, i, 0.0, 1.0, m->most[i], HALVINGS) : 0;
        found = or_this(found, passed, m->image->contacts + i);
    }
    return found;
}

static missed_found piece_passed(missed *m, const engine_piece *piece) {
    missed_found found = MISSED_NOTHING;
    if (piece->span_s <= m->image->step_s / (1 << HALVINGS)) {
        return found; /* as thin as is_finest() has it */
    }
    m->piece = piece;
    taylor_bounds_bounds *const bounds[] = {m->signals, m->accel, m->laws};
    for (int i = 0; i < 3; i++) {
        if (bounds[i] != NULL) {
            taylor_bounds_way(bounds[i], piece->from, piece->to, piece->span_s);
        }
    }
    found = m->signals != NULL ? contact_passed(m) : found;
    found = found.what < 0 && m->edges ? edge_passed(m) : found;
    return found.what < 0 && m->hills ? force_passed(m) : found;
}

missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, bool eventful,
                          bool blind) {
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
    if (kind->steps(run) == 0 || blind) {
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
