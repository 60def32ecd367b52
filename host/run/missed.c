/* missed.c: see missed.h. */
#include "missed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/room.h"
#include "host/number/enclosure.h"

/* Halvings of a step, and parts of it that are looked at for one contact. */
#define HALVINGS 16
#define PARTS_MOST 400
/* Operations on bounds that a run's steps may take together, in parts of a step, each some ten of numbers: half a second. */
#define OPERATIONS_MOST 1e7
/* Less than this share of the gap at the ends is a touch: rounding. */
#define TOUCH 1e-9
/* An acceleration that both ends do not show is so many times theirs, and over a step would change the rate by this share. */
#define HIDDEN 2.0
#define TURNS 0.05

struct missed {
    const image *image;
    const tape *signals; /* or NULL */
    const tape *accel;   /* where an exponential function is in it, or NULL */
    double *from;        /* [angles + reals] the state before the step, */
    double *to;          /* and behind it */
    int *mode;           /* [contacts] likewise */
    int *mode_to;
    double *input;
    double *way;       /* [coordinates] */
    enclosure *place;  /* [coordinates] on a part of the way, */
    enclosure *rate;   /* [coordinates] */
    enclosure *value;  /* [most operations of the lists] */
    enclosure *result; /* [2 * contacts, or coordinates] */
    enclosure *at;     /* likewise, at one place */
    double *most;      /* [coordinates] more is hidden from both ends */
    bool *hard;        /* [contacts + coordinates] bounds say too little, once and for all */
    int parts;         /* looked at, so far */
    double spent;      /* operations of parts */
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
    const int64_t n = im->coordinates;
    const int64_t results = 2 * im->contacts + n;
    const int64_t operations =
        (signals != NULL ? signals->count : 0) + (accel != NULL ? accel->count : 0);
    m->image = im;
    m->signals = signals;
    m->accel = accel;
    m->from = room(2 * all + im->inputs + 2 * n, sizeof *m->from);
    m->to = m->from + all;
    m->input = m->to + all;
    m->way = m->input + im->inputs;
    m->most = m->way + n;
    image_inputs(im, m->input);
    m->mode = room(2 * im->contacts, sizeof *m->mode);
    m->mode_to = m->mode + im->contacts;
    m->place = room(2 * n + operations + 2 * results, sizeof *m->place);
    m->rate = m->place + n;
    m->value = m->rate + n;
    m->result = m->value + operations;
    m->at = m->result + results;
    m->hard = room(im->contacts + n, sizeof *m->hard);
    return m;
}

void missed_close(missed *m) {
    if (m != NULL) {
        free(m->from);
        free(m->mode);
        free(m->place);
        free(m->hard);
        free(m);
    }
}

/* --- bounds of a list ---------------------------------------------------------------------------------*/

static const enclosure unknown = {(double)NAN, (double)NAN};

/* Between the function's values at both ends: it rises all the way. */
static enclosure rising(function_id function, enclosure a) {
    return enclosure_hull(enclosure_about(number_call(function, a.low, 0.0), 2),
                          enclosure_about(number_call(function, a.high, 0.0), 2));
}

/* Far below zero it is next to nothing, which enclosure_exp() does not know. */
static enclosure exponential(enclosure a) {
    const bool far[2] = {a.low < -500.0, a.high < -500.0};
    return (enclosure){far[0] ? 0.0 : enclosure_exp(enclosure_of(a.low)).low,
                       far[1] ? 0x1p-720 : enclosure_exp(enclosure_of(a.high)).high};
}

static enclosure call(function_id function, enclosure a) {
    switch (function) {
    case FN_EXP: return exponential(a);
    case FN_LOG: return enclosure_log(a);
    case FN_TAN: return enclosure_div(enclosure_sine(a), enclosure_cosine(a));
    case FN_SINH:
    case FN_TANH:
    case FN_ASIN:
    case FN_ATAN: return rising(function, a);
    case FN_SIN:
    case FN_COS:
    case FN_ACOS:
    case FN_COSH:
    case FN_ATAN2:
    case FN_SQRT:
    case FN_ABS:
    case FN_SIGN:
    case FN_MIN:
    case FN_MAX: break; /* operations of their own, or not bounded */
    }
    return unknown;
}

static enclosure size_of(enclosure a) {
    const bool across = a.low < 0.0 && a.high > 0.0;
    const double low = fabs(a.low);
    const double high = fabs(a.high);
    return (enclosure){across ? 0.0 : enclosure_lesser(low, high), enclosure_larger(low, high)};
}

static enclosure sign_of(enclosure a) {
    return (enclosure){(a.low > 0.0) - (a.low < 0.0), (a.high > 0.0) - (a.high < 0.0)};
}

static enclosure phase_of(const missed *m, const tape *t, const op *o) {
    enclosure sum = enclosure_of(o->value);
    for (int i = 0; i < t->angles && o->turns != NULL; i++) {
        sum = enclosure_add(sum, enclosure_times(m->place[i], o->turns[i]));
    }
    return o->b >= 0 ? enclosure_add(sum, m->value[o->b]) : sum;
}

/* A list's results where places and rates are. */
static void bound(missed *m, const tape *t, enclosure *result) {
    const image *im = m->image;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const enclosure a = op_rows[o->code].values > 0 && o->a >= 0 ? m->value[o->a] : unknown;
        const enclosure b = op_rows[o->code].values > 1 && o->b >= 0 ? m->value[o->b] : unknown;
        enclosure v = unknown;
        switch (o->code) {
        case OP_CONSTANT: v = enclosure_of(o->value); break;
        case OP_LINEAR: v = m->place[im->angles + o->a]; break;
        case OP_RATE: v = m->rate[o->a]; break;
        case OP_INPUT: v = enclosure_of(m->input[o->a]); break;
        case OP_PHASE: v = phase_of(m, t, o); break;
        case OP_SIN: v = enclosure_sine(m->value[o->a]); break;
        case OP_COS: v = enclosure_cosine(m->value[o->a]); break;
        case OP_ADD: v = enclosure_add(a, b); break;
        case OP_SUB: v = enclosure_sub(a, b); break;
        case OP_MUL: v = o->a == o->b ? enclosure_square(a) : enclosure_mul(a, b); break;
        case OP_DIV: v = enclosure_div(a, b); break;
        case OP_NEG: v = enclosure_neg(a); break;
        case OP_SQRT: v = enclosure_root(a); break;
        case OP_ABS: v = size_of(a); break;
        case OP_SIGN: v = sign_of(a); break;
        case OP_MIN:
            v = (enclosure){enclosure_lesser(a.low, b.low), enclosure_lesser(a.high, b.high)};
            break;
        case OP_MAX:
            v = (enclosure){enclosure_larger(a.low, b.low), enclosure_larger(a.high, b.high)};
            break;
        case OP_CALL: v = call(o->function, a); break;
        case OP_POW: v = enclosure_power(a, b); break;
        case OP_ACCEL:
        case OP_TIME:
        case OP_RADIANS:
        case OP_NOISE:
        case OP_CELL:
        case OP_LINE:
        case OP_CUBIC: break; /* not in such a list */
        }
        m->value[i] = v;
    }
    for (int i = 0; i < t->results; i++) {
        result[i] = m->value[t->result[i]];
    }
}

/* --- the way of a step --------------------------------------------------------------------------------*/

/* A number that is low at one end and high at the other, or the other way round, and bends no more than that between. */
static enclosure between(double a, double b, double bend) {
    return (enclosure){enclosure_below(number_least(a, b) - bend),
                       enclosure_above(number_most(a, b) + bend)};
}

/* Places and rates on the part from `low` to `high` of the way. */
static void go(missed *m, double low, double high) {
    const image *im = m->image;
    const double h = im->step_s;
    const double width = high - low;
    const double *v0 = m->from + im->angles + (im->coordinates - im->angles);
    const double *v1 = m->to + im->angles + (im->coordinates - im->angles);
    for (int i = 0; i < im->coordinates; i++) {
        const double way = m->way[i];
        const double lead[2] = {h * v0[i], h * v1[i]};
        const double c2 = 3.0 * way - 2.0 * lead[0] - lead[1];
        const double c3 = lead[0] + lead[1] - 2.0 * way;
        const double bend =
            number_most(fabs(2.0 * c2 + 6.0 * c3 * low), fabs(2.0 * c2 + 6.0 * c3 * high));
        double at[2];
        double rate[2];
        for (int k = 0; k < 2; k++) {
            const double s = k == 0 ? low : high;
            at[k] = m->from[i] + s * (lead[0] + s * (c2 + s * c3));
            rate[k] = lead[0] + s * (2.0 * c2 + s * 3.0 * c3);
        }
        m->place[i] = between(at[0], at[1], width * width / 8.0 * bend);
        m->rate[i] = between(rate[0] / h, rate[1] / h, width * width / 8.0 * fabs(6.0 * c3) / h);
    }
}

/* Above zero: the contact stays as it is. */
static enclosure margin(const missed *m, int k, const enclosure *result) {
    const bool is = m->image->contact[k].kind == WH_STOP || m->mode[k] == WH_ACTIVE;
    return is ? result[2 * k] : enclosure_neg(result[2 * k]);
}

/* A margin on a part of the way, given it there and at its middle; of a stop by its rate, too. */
static double least(const missed *m, int k, double width) {
    const double natural = margin(m, k, m->result).low;
    if (m->image->contact[k].kind != WH_STOP) {
        return natural;
    }
    const double most = enclosure_size(m->result[2 * k + 1]) * 0.5 * width * m->image->step_s;
    const double mean = margin(m, k, m->at).low - most;
    return mean > natural || !(natural - natural == 0.0) ? mean : natural;
}

/* Is what is looked at found inside on a part of the way (1), nowhere there (0), or is that open (-1)? */
typedef int looking(missed *m, int k, double low, double high, double least);

static int look_contact(missed *m, int k, double low, double high, double touch) {
    const double middle = 0.5 * (low + high);
    go(m, middle, middle);
    bound(m, m->signals, m->at);
    if (margin(m, k, m->at).high < -touch) {
        return 1;
    }
    go(m, low, high);
    bound(m, m->signals, m->result);
    return least(m, k, high - low) >= 0.0 ? 0 : -1;
}

static int look_force(missed *m, int i, double low, double high, double most) {
    const double middle = 0.5 * (low + high);
    go(m, middle, middle);
    bound(m, m->accel, m->at);
    if (m->at[i].low > most || m->at[i].high < -most) {
        return 1;
    }
    go(m, low, high);
    bound(m, m->accel, m->result);
    return m->result[i].low >= -most && m->result[i].high <= most ? 0 : -1;
}

static bool passes(missed *m, looking *look, int k, double low, double high, double bar,
                   int halvings) {
    m->spent += 2.0 * (m->signals != NULL ? m->signals->count : m->accel->count);
    if (m->parts++ > PARTS_MOST || m->spent > OPERATIONS_MOST) {
        return false;
    }
    const int found = look(m, k, low, high, bar);
    const double middle = 0.5 * (low + high);
    return found > 0 || (found < 0 && halvings > 0 &&
                         (passes(m, look, k, low, middle, bar, halvings - 1) ||
                          passes(m, look, k, middle, high, bar, halvings - 1)));
}

/* Does contact k, which is in the same mode at both ends, leave it on the way? */
static bool is_passed(missed *m, int k) {
    double size = 0.0;
    for (int end = 0; end < 2; end++) {
        go(m, (double)end, (double)end);
        bound(m, m->signals, m->at);
        const enclosure value = margin(m, k, m->at);
        if (!(value.low >= 0.0)) { /* none of ours: it is there already, to rounding */
            return false;
        }
        size = number_most(size, value.high);
    }
    m->parts = 0;
    const bool found = passes(m, look_contact, k, 0.0, 1.0, TOUCH * size, HALVINGS);
    m->hard[k] = m->parts > PARTS_MOST;
    return found;
}

/* The contact that is passed, or -1. */
static int contact_passed(missed *m) {
    const image *im = m->image;
    bool open[WH_CONTACTS_LIMIT];
    go(m, 0.0, 1.0);
    bound(m, m->signals, m->result);
    for (int k = 0; k < im->forced; k++) {
        const int what = im->contact[k].kind;
        const bool can = what == WH_HOLD || (what == WH_STOP && m->mode[k] == WH_FREE);
        open[k] = can && !m->hard[k] && m->mode[k] == m->mode_to[k] &&
                  !(margin(m, k, m->result).low >= 0.0);
    }
    for (int k = 0; k < im->forced; k++) {
        if (open[k] && is_passed(m, k)) {
            return k;
        }
    }
    return -1;
}

/* The coordinate whose acceleration on the way is hidden from both ends, or -1. */
static int force_passed(missed *m) {
    const image *im = m->image;
    const double *v0 = m->from + im->coordinates;
    const double *v1 = m->to + im->coordinates;
    for (int end = 0; end < 2; end++) {
        go(m, (double)end, (double)end);
        bound(m, m->accel, m->at);
        for (int i = 0; i < im->coordinates; i++) {
            m->most[i] = (end == 0 ? 0.0 : m->most[i]) + HIDDEN * enclosure_size(m->at[i]);
        }
    }
    go(m, 0.0, 1.0);
    bound(m, m->accel, m->result);
    bool open[IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < im->coordinates; i++) {
        const double turns = TURNS * number_most(fabs(v0[i]), fabs(v1[i])) / im->step_s;
        m->most[i] = number_most(m->most[i], turns);
        open[i] = m->most[i] - m->most[i] == 0.0 && !m->hard[im->contacts + i] &&
                  !(enclosure_size(m->result[i]) <= m->most[i]);
    }
    for (int i = 0; i < im->coordinates; i++) {
        m->parts = 0;
        if (open[i] && passes(m, look_force, i, 0.0, 1.0, m->most[i], HALVINGS)) {
            return i;
        }
        m->hard[im->contacts + i] = m->hard[im->contacts + i] || m->parts > PARTS_MOST;
    }
    return -1;
}

int missed_enter(missed *m, const engine_kind *kind, const void *run, bool eventful) {
    if (m == NULL) {
        return -1;
    }
    const image *im = m->image;
    memcpy(m->from, m->to, (size_t)(im->angles + im->reals) * sizeof *m->to);
    memcpy(m->mode, m->mode_to, (size_t)im->contacts * sizeof *m->mode);
    kind->state(run, m->to, m->to + im->angles);
    if (im->contacts > 0) {
        kind->modes(run, m->mode_to);
    }
    if (eventful || kind->steps(run) == 0) {
        return -1;
    }
    for (int i = 0; i < im->coordinates; i++) {
        const double way = m->to[i] - m->from[i];
        m->way[i] = i < im->angles ? number_centred(way, 6.283185307179586) : way;
    }
    const int contact = m->signals != NULL ? contact_passed(m) : -1;
    const int force = contact < 0 && m->accel != NULL ? force_passed(m) : -1;
    return force >= 0 ? im->contacts + force : contact;
}
