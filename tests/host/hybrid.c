/* hybrid.c: motion between events. Closed stops and sticking frictions are constraints; sliding friction is a force:
 *
 *   M q'' = force - sum sign limit + J^T lambda, with J q'' = -J' q' for each constraint. */
#include "hybrid.h"

#include "drawn.h"
#include "test.h"

_Static_assert((int)LINKAGE_BODIES <= (int)DRAWN_MOST, "drawn.h tries the cases");

enum { STATE = 2 * LINKAGE_BODIES };

/* Modes of a contact: OPEN and CLOSED for a stop; STUCK, or the direction of sliding (UP, DOWN), for a friction. */
typedef enum mode { OPEN, CLOSED, STUCK, UP, DOWN } mode;

typedef struct runner {
    const hybrid *h;
    mode mode[HYBRID_CONTACTS];
    bool pressed[HYBRID_CONTACTS]; /* is the limit of this friction above zero? */
    long double state[STATE];
    hybrid_motion *motion;
} runner;

/* A stop has a gap and a rate, a friction only a rate. The rate is row . q', its derivative row . q'' + bend. */
typedef struct gauge {
    long double gap;
    long double rate;
    long double row[LINKAGE_BODIES];
    long double bend;
} gauge;

static gauge gauge_of(const hybrid *h, int k, const linkage_numbers *at, const long double *state) {
    const hybrid_contact *c = &h->contact[k];
    gauge g = {.bend = 0.0L};
    if (c->kind == HYBRID_FLOOR) {
        g.gap = at->end[c->body].y_m - (long double)c->limit;
        g.bend = at->end[c->body].bend_mps2;
        memcpy(g.row, at->end[c->body].row, sizeof g.row);
    } else {
        const long double sign = c->kind == HYBRID_MOST ? -1.0L : 1.0L;
        g.gap = sign * (state[c->body] - (long double)c->limit);
        g.row[c->body] = sign;
    }
    for (int i = 0; i < h->of.bodies; i++) {
        g.rate += g.row[i] * state[LINKAGE_BODIES + i];
    }
    return g;
}

/* The limit of a friction before it is cut at zero. */
static long double load_of(const hybrid_contact *c, const long double *state) {
    return (long double)c->limit + (long double)c->load * state[c->loaded_by];
}

static long double limit_of(const hybrid_contact *c, const long double *state) {
    return fmaxl(load_of(c, state), 0.0L);
}

static bool holds(mode m) { return m == CLOSED || m == STUCK; }

/* Accelerations in the present modes, and lambda of the constraints. *at: the matrices and forces of this state. */
static void accelerate(const runner *r, const long double *state, long double *accel,
                       long double *lambda, linkage_numbers *at) {
    const hybrid *h = r->h;
    const int n = h->of.bodies;
    long double force[LINKAGE_BODIES];
    long double way[HYBRID_CONTACTS][LINKAGE_BODIES];
    long double a[HYBRID_CONTACTS][HYBRID_CONTACTS + 1];
    gauge g[HYBRID_CONTACTS];
    int held[HYBRID_CONTACTS];
    int count = 0;
    linkage_evaluate(&h->of, state, state + LINKAGE_BODIES, at);
    memcpy(force, at->force, sizeof force);
    for (int k = 0; k < h->contacts; k++) {
        const hybrid_contact *c = &h->contact[k];
        lambda[k] = 0.0L;
        if (holds(r->mode[k])) {
            g[count] = gauge_of(h, k, at, state);
            linkage_solve(&h->of, at, g[count].row, way[count]);
            held[count++] = k;
        } else if (r->mode[k] != OPEN) {
            force[c->body] += (r->mode[k] == UP ? -1.0L : 1.0L) * limit_of(c, state);
        }
    }
    linkage_solve(&h->of, at, force, accel);
    /* J M^-1 J^T lambda = -J' q' - J q'', with q'' from the forces alone */
    for (int i = 0; i < count; i++) {
        a[i][count] = -g[i].bend;
        for (int x = 0; x < n; x++) {
            a[i][count] -= g[i].row[x] * accel[x];
        }
        for (int j = 0; j < count; j++) {
            a[i][j] = 0.0L;
            for (int x = 0; x < n; x++) {
                a[i][j] += g[i].row[x] * way[j][x];
            }
        }
    }
    for (int c = 0; c < count; c++) {
        for (int i = 0; i < count; i++) {
            const long double share = i == c ? 0.0L : a[i][c] / a[c][c];
            for (int j = c; j <= count && i != c; j++) {
                a[i][j] -= share * a[c][j];
            }
        }
    }
    for (int i = 0; i < count; i++) {
        lambda[held[i]] = a[i][count] / a[i][i];
        for (int x = 0; x < n; x++) {
            accel[x] += way[i][x] * lambda[held[i]];
        }
    }
}

static void slope_of(const runner *r, const long double *state, long double *slope) {
    linkage_numbers at;
    long double lambda[HYBRID_CONTACTS];
    memset(slope, 0, STATE * sizeof *slope);
    memcpy(slope, state + LINKAGE_BODIES, LINKAGE_BODIES * sizeof *slope);
    accelerate(r, state, slope + LINKAGE_BODIES, lambda, &at);
}

/* A step of Kutta's 3/8 rule. The program's runs in these tests use other methods. */
static void step_of(const runner *r, long double h, long double *to) {
    static const long double share[3][3] = {
        {1.0L / 3.0L, 0.0L, 0.0L}, {-1.0L / 3.0L, 1.0L, 0.0L}, {1.0L, -1.0L, 1.0L}};
    static const long double weight[4] = {0.125L, 0.375L, 0.375L, 0.125L};
    long double slope[4][STATE];
    slope_of(r, r->state, slope[0]);
    for (int stage = 0; stage < 3; stage++) {
        long double at[STATE];
        for (int i = 0; i < STATE; i++) {
            at[i] = r->state[i];
            for (int k = 0; k <= stage; k++) {
                at[i] += h * share[stage][k] * slope[k][i];
            }
        }
        slope_of(r, at, slope[stage + 1]);
    }
    for (int i = 0; i < STATE; i++) {
        to[i] = r->state[i];
        for (int k = 0; k < 4; k++) {
            to[i] += h * weight[k] * slope[k][i];
        }
    }
}

/* Twice the tolerance of drawn_solved(), in N or N m: a mode that drawn_solved() has just chosen must not count as
 * ended. */
#define SLACK 2e-9L

static bool ended(const runner *r, const long double *state) {
    const hybrid *h = r->h;
    linkage_numbers at;
    long double accel[LINKAGE_BODIES];
    long double lambda[HYBRID_CONTACTS];
    accelerate(r, state, accel, lambda, &at);
    for (int k = 0; k < h->contacts; k++) {
        const gauge g = gauge_of(h, k, &at, state);
        const hybrid_contact *c = &h->contact[k];
        const bool presses = load_of(c, state) > 0.0L;
        if ((r->mode[k] == OPEN && g.gap < 0.0L) || (r->mode[k] == CLOSED && lambda[k] < -SLACK) ||
            (r->mode[k] == STUCK && fabsl(lambda[k]) > limit_of(c, state) + SLACK) ||
            (c->kind == HYBRID_FRICTION && presses != r->pressed[k]) ||
            (r->mode[k] == UP && g.rate < 0.0L) || (r->mode[k] == DOWN && g.rate > 0.0L)) {
            return true;
        }
    }
    return false;
}

/* At an event, smaller gaps (m) and rates (m/s) count as zero: bisection finds the event only to round-off. */
#define NEAR 1e-9L

/* The contacts with numbers member[count], as a problem for drawn_solved(). */
static drawn cases_of(const runner *r, const linkage_numbers *at, const gauge *g, const int *member,
                      int count) {
    drawn b = {.n = r->h->of.bodies, .contacts = count};
    for (int i = 0; i < b.n; i++) {
        for (int j = 0; j < b.n; j++) {
            b.mass[i][j] = (double)at->mass[i][j];
        }
    }
    for (int c = 0; c < count; c++) {
        const bool friction = r->h->contact[member[c]].kind == HYBRID_FRICTION;
        b.contact[c].kind = friction ? 'f' : 's';
        b.contact[c].limit = friction ? (double)limit_of(&r->h->contact[member[c]], r->state) : 0.0;
        for (int i = 0; i < b.n; i++) {
            b.contact[c].row[i] = (double)g[member[c]].row[i];
        }
    }
    return b;
}

/* Computes the impact if a stop is hit. Closed stops take part in the impact. Returns false if no case fits, or if a
 * stop would soon be hit again. */
static bool impact(runner *r, const linkage_numbers *at, gauge *g, long double least_flight_s) {
    const hybrid *h = r->h;
    int member[HYBRID_CONTACTS];
    int count = 0;
    bool hit = false;
    for (int k = 0; k < h->contacts && h->contact[k].kind != HYBRID_FRICTION; k++) {
        if (fabsl(g[k].gap) < NEAR && g[k].rate < NEAR) {
            hit = hit || (r->mode[k] == OPEN && g[k].rate < 0.0L);
            member[count++] = k;
        }
    }
    if (!hit) {
        return true;
    }
    drawn b = cases_of(r, at, g, member, count);
    double from[DRAWN_MOST] = {0.0};
    double lambda[DRAWN_CONTACTS];
    double to[DRAWN_MOST];
    for (int i = 0; i < b.n; i++) {
        from[i] = (double)r->state[LINKAGE_BODIES + i];
    }
    for (int c = 0; c < count; c++) {
        const int k = member[c];
        b.contact[c].target =
            r->mode[k] == OPEN ? -h->contact[k].restitution * (double)g[k].rate : 0.0;
    }
    if (!drawn_solved(&b, from, lambda, to)) {
        return false;
    }
    r->motion->impacts++;
    for (int i = 0; i < b.n; i++) {
        /* adds only the change, which is computed in double, so that the state keeps the digits of long double */
        r->state[LINKAGE_BODIES + i] += (long double)to[i] - (long double)from[i];
    }
    for (int k = 0; k < h->contacts; k++) {
        g[k] = gauge_of(h, k, at, r->state);
    }
    for (int c = 0; c < count; c++) { /* would this stop be hit again soon? */
        const int k = member[c];
        long double accel[LINKAGE_BODIES];
        long double towards = -g[k].bend;
        linkage_solve(&h->of, at, at->force, accel);
        for (int i = 0; i < b.n; i++) {
            towards -= g[k].row[i] * accel[i];
        }
        if (h->contact[k].restitution > 0.0 && g[k].rate > NEAR &&
            2.0L * g[k].rate < towards * least_flight_s) {
            return false;
        }
    }
    return true;
}

/* Decides from the accelerations which contacts act from now on. Returns false if no case fits. */
static bool settle(runner *r, const linkage_numbers *at, const gauge *g) {
    const hybrid *h = r->h;
    int member[HYBRID_CONTACTS];
    int count = 0;
    long double force[LINKAGE_BODIES];
    long double accel[LINKAGE_BODIES];
    memcpy(force, at->force, sizeof force);
    for (int k = 0; k < h->contacts; k++) {
        const hybrid_contact *c = &h->contact[k];
        if (fabsl(g[k].rate) < NEAR && (c->kind == HYBRID_FRICTION || fabsl(g[k].gap) < NEAR)) {
            member[count++] = k;
        } else if (c->kind == HYBRID_FRICTION) {
            r->mode[k] = g[k].rate > 0.0L ? UP : DOWN;
            force[c->body] += (r->mode[k] == UP ? -1.0L : 1.0L) * limit_of(c, r->state);
        } else {
            r->mode[k] = OPEN;
        }
    }
    drawn b = cases_of(r, at, g, member, count);
    double from[DRAWN_MOST] = {0.0};
    double lambda[DRAWN_CONTACTS];
    double to[DRAWN_MOST];
    linkage_solve(&h->of, at, force, accel);
    for (int i = 0; i < b.n; i++) {
        from[i] = (double)accel[i];
    }
    for (int c = 0; c < count; c++) {
        b.contact[c].target = -(double)g[member[c]].bend;
    }
    if (!drawn_solved(&b, from, lambda, to)) {
        return false;
    }
    for (int c = 0; c < count; c++) {
        const int k = member[c];
        const double off = drawn_along(&b, c, to) - b.contact[c].target;
        /* drawn_solved() gives a sliding friction exactly its limit, and an open stop exactly zero */
        const bool slides = fabs(lambda[c]) >= b.contact[c].limit;
        const bool up = lambda[c] < 0.0 || (lambda[c] == 0.0 && off > 0.0);
        if (b.contact[c].kind == 's') {
            r->mode[k] = lambda[c] == 0.0 ? OPEN : CLOSED;
        } else {
            r->mode[k] = !slides ? STUCK : up ? UP : DOWN;
        }
        r->motion->rests += holds(r->mode[k]) ? 1 : 0;
    }
    return true;
}

/* Computes the impact, if any, and the modes after it. Returns false if this motion has no reference
 * (hybrid_motion.aside). */
static bool event(runner *r, long double least_flight_s) {
    linkage_numbers at;
    gauge g[HYBRID_CONTACTS];
    linkage_evaluate(&r->h->of, r->state, r->state + LINKAGE_BODIES, &at);
    for (int k = 0; k < r->h->contacts; k++) {
        g[k] = gauge_of(r->h, k, &at, r->state);
        r->pressed[k] = load_of(&r->h->contact[k], r->state) > 0.0L;
    }
    if (!impact(r, &at, g, least_flight_s)) {
        return false;
    }
    /* the impact has changed the rates, on which forces depend */
    linkage_evaluate(&r->h->of, r->state, r->state + LINKAGE_BODIES, &at);
    for (int k = 0; k < r->h->contacts; k++) {
        g[k] = gauge_of(r->h, k, &at, r->state);
    }
    return settle(r, &at, g);
}

hybrid_motion hybrid_move(const hybrid *h, double step_s, double until_s, double least_flight_s) {
    enum { HALVINGS = 62, EVENTS_MOST = 100 };
    hybrid_motion end = {.impacts = 0};
    runner r = {.h = h, .motion = &end};
    long double time = 0.0L;
    int events = 0;
    for (int k = 0; k < h->of.bodies; k++) {
        r.state[k] = (long double)h->of.start[k];
        r.state[LINKAGE_BODIES + k] = (long double)h->of.start_rate[k];
    }
    end.aside = !event(&r, (long double)least_flight_s);
    while (time < (long double)until_s && !end.aside) {
        long double step = fminl((long double)step_s, (long double)until_s - time);
        long double to[STATE];
        step_of(&r, step, to);
        const bool happens = ended(&r, to);
        if (happens) {
            /* bisects to the end of the first mode that ends; the state passes this point only by round-off */
            long double before = 0.0L;
            for (int i = 0; i < HALVINGS && step - before > 1e-17L; i++) {
                const long double middle = before + (step - before) / 2.0L;
                step_of(&r, middle, to);
                if (ended(&r, to)) {
                    step = middle;
                } else {
                    before = middle;
                }
            }
            step_of(&r, step, to);
        }
        memcpy(r.state, to, sizeof to);
        time += step;
        if (happens) {
            end.aside = ++events > EVENTS_MOST || !event(&r, (long double)least_flight_s);
        }
    }
    memcpy(end.state, r.state, sizeof end.state);
    return end;
}
