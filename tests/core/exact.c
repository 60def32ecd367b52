/* exact.c: see exact.h. */
#include "exact.h"

#define STEP_S 1e-3

/* What is below the first is zero, what is between both may be. */
#define ZERO 1e-11
#define NEAR (WH_DOUBLE ? 1e-6 : 1e-4)

static double size_of(double value) { return value < 0.0 ? -value : value; }

static int sign(exact *e, double value) {
    const double size = size_of(value);
    e->vague = e->vague || (size > ZERO && size < NEAR);
    return size <= ZERO ? 0 : value > 0.0 ? 1 : -1;
}

static bool in(unsigned bits, unsigned k) { return (bits >> k & 1U) != 0; }

static unsigned forced(void) { return hand_now.system.forced; }

static bool is(unsigned k, wh_contact_kind kind) { return hand_now.contact[k].kind == kind; }

/* Contacts of a kind in a mode (those of crossings are none), as bits. */
static unsigned those(const exact *e, wh_contact_kind kind, int mode) {
    unsigned bits = 0;
    for (unsigned k = 0; k < forced(); k++) {
        bits |= is(k, kind) && e->mode[k] == mode ? 1U << k : 0U;
    }
    return bits;
}

static void give(exact *e, unsigned bits, int mode) {
    for (unsigned k = 0; k < forced(); k++) {
        e->mode[k] = in(bits, k) ? mode : e->mode[k];
    }
}

static double along(unsigned k, const double *x) {
    return (double)hand_now.law[k].row[0] * x[0] +
           (hand_now.n == 2 ? (double)hand_now.law[k].row[1] * x[1] : 0.0);
}

static double gap(const exact *e, unsigned k) {
    return along(k, e->x) - (double)hand_now.law[k].offset;
}

/* x += M^-1 J_k^T lambda. */
static void push(unsigned k, double lambda, double *x) {
    for (unsigned i = 0; i < hand_now.n; i++) {
        for (unsigned j = 0; j < hand_now.n; j++) {
            x[i] += (double)hand_now.inverse[i][j] * (double)hand_now.law[k].row[j] * lambda;
        }
    }
}

static double coupled(unsigned k, unsigned l) {
    double way[2] = {0.0, 0.0};
    push(l, 1.0, way);
    return along(k, way);
}

/* --- all cases ---------------------------------------------------------------------------------------------- */

/* What is to be solved: x + M^-1 J^T lambda such that J x reaches target[k], by contacts that push only (a stop), that
 * push so far and no further (limit), or both ways. */
typedef struct problem {
    unsigned members; /* as bits */
    double target[HAND_CONTACTS];
    double low[HAND_CONTACTS];
    double high[HAND_CONTACTS];
} problem;

#define ENDLESS 1e9

/* lambda[] of those in `tight`, which reach their targets; the others' are given. False: their rows repeat each other. */
static bool reach(const problem *p, unsigned tight, const double *x, double *lambda) {
    double a[HAND_CONTACTS][HAND_CONTACTS + 1];
    unsigned member[HAND_CONTACTS];
    unsigned count = 0;
    double y[2] = {x[0], x[1]};
    for (unsigned k = 0; k < forced(); k++) {
        if (in(tight, k)) {
            member[count++] = k;
        } else if (in(p->members, k)) {
            push(k, lambda[k], y);
        }
    }
    for (unsigned r = 0; r < count; r++) {
        for (unsigned c = 0; c < count; c++) {
            a[r][c] = coupled(member[r], member[c]);
        }
        a[r][count] = p->target[member[r]] - along(member[r], y);
    }
    for (unsigned q = 0; q < count; q++) { /* positive definite, or singular */
        if (a[q][q] < 1e-7) {
            return false;
        }
        for (unsigned r = 0; r < count; r++) {
            const double factor = r == q ? 0.0 : a[r][q] / a[q][q];
            for (unsigned c = 0; c <= count; c++) {
                a[r][c] -= factor * a[q][c];
            }
        }
    }
    for (unsigned q = 0; q < count; q++) {
        lambda[member[q]] = a[q][count] / a[q][q];
    }
    return true;
}

static bool good(const problem *p, unsigned k, int which, double lambda, double off) {
    return which == 0  ? lambda >= p->low[k] - 1e-9 && lambda <= p->high[k] + 1e-9
           : which < 0 ? off >= -1e-9
                       : off <= 1e-9;
}

/* The case that meets the conditions: x changes, lambda[] of the members. Returns those whose J x is beyond their
 * targets, as bits. */
static unsigned solve(exact *e, const problem *p, double *x, double *lambda) {
    for (unsigned number = 0; number < 27;
         number++) { /* each at its target, its low or its high end */
        unsigned rest = number;
        unsigned tight = 0;
        int which[HAND_CONTACTS] = {0};
        bool meets = true;
        for (unsigned k = 0; k < forced(); k++, rest /= 3) {
            which[k] = (int)(rest % 3) == 2 ? -1 : (int)(rest % 3);
            lambda[k] = 0.0;
            if (!in(p->members, k)) {
                meets = meets && which[k] == 0;
            } else if (which[k] == 0) {
                tight |= 1U << k;
            } else {
                lambda[k] = which[k] < 0 ? p->low[k] : p->high[k];
                meets = meets && size_of(lambda[k]) < ENDLESS;
            }
        }
        if (!meets || !reach(p, tight, x, lambda)) {
            continue;
        }
        double y[2] = {x[0], x[1]};
        unsigned beyond = 0;
        for (unsigned k = 0; k < forced(); k++) {
            if (in(p->members, k)) {
                push(k, lambda[k], y);
            }
        }
        for (unsigned k = 0; k < forced() && meets; k++) {
            const double off = along(k, y) - p->target[k];
            meets = !in(p->members, k) || good(p, k, which[k], lambda[k], off);
        }
        if (meets) {
            for (unsigned k = 0; k < forced(); k++) {
                const bool off = in(p->members, k) && sign(e, along(k, y) - p->target[k]) != 0;
                beyond |= off ? 1U << k : 0U;
                if (in(tight, k)) { /* at an end all the same? */
                    (void)sign(e, lambda[k] - p->low[k]);
                    (void)sign(e, lambda[k] - p->high[k]);
                }
            }
            x[0] = y[0];
            x[1] = y[1];
            return beyond;
        }
    }
    e->vague = true; /* holds that repeat each other: none here */
    return 0;
}

/* Do rows of the members repeat each other? */
static bool repeat(const exact *e, unsigned members) {
    problem p = {members, {0.0}, {0.0}, {0.0}};
    const double x[2] = {0.0, 0.0};
    double lambda[HAND_CONTACTS];
    (void)e;
    return !reach(&p, members, x, lambda);
}

/* --- forces ------------------------------------------------------------------------------------------------- */

static unsigned holding(const exact *e) {
    return those(e, WH_STOP, WH_ACTIVE) | those(e, WH_HOLD, WH_ACTIVE) |
           those(e, WH_FRICTION, WH_STUCK);
}

/* Accelerations and forces as the modes are; what has to pull pulls. Of rows that repeat each other the last ones get
 * nothing. */
static void accelerate(exact *e, double *a, double *force) {
    double own[2] = {0.0, 0.0};
    unsigned members = 0;
    problem p = {0, {0.0}, {0.0}, {0.0}};
    for (unsigned i = 0; i < hand_now.n; i++) {
        own[i] = 0.0;
        for (unsigned j = 0; j < hand_now.n; j++) {
            own[i] += (double)hand_now.inverse[i][j] * (double)hand_now.load[j];
        }
    }
    for (unsigned k = 0; k < forced(); k++) {
        force[k] = 0.0;
        if (is(k, WH_FRICTION) && e->mode[k] != WH_STUCK) {
            force[k] = -(double)hand_now.law[k].second * e->mode[k];
            push(k, force[k], own);
        } else if (in(holding(e), k)) {
            members |= repeat(e, members | 1U << k) ? 0U : 1U << k;
        }
    }
    e->shared = e->shared || members != holding(e);
    p.members = members;
    (void)reach(&p, members, own, force);
    for (unsigned k = 0; k < forced(); k++) {
        if (in(members, k)) {
            push(k, force[k], own);
        }
    }
    a[0] = own[0];
    a[1] = own[1];
}

/* Which have more than they take? The stops go first, then the friction that is furthest above its limit. */
static void give_way(exact *e) {
    for (;;) {
        double a[2];
        double force[HAND_CONTACTS];
        double lambda[HAND_CONTACTS];
        double way[2];
        problem p = {holding(e), {0.0}, {0.0}, {0.0}};
        unsigned first = 0;
        double most = 0.0;
        accelerate(e, way, force); /* as if all held */
        a[0] = 0.0;
        a[1] = 0.0;
        for (unsigned i = 0; i < hand_now.n; i++) {
            for (unsigned j = 0; j < hand_now.n; j++) {
                a[i] += (double)hand_now.inverse[i][j] * (double)hand_now.load[j];
            }
        }
        for (unsigned k = 0; k < forced(); k++) {
            const double limit = is(k, WH_FRICTION) ? (double)hand_now.law[k].first : ENDLESS;
            p.low[k] = is(k, WH_STOP) ? 0.0 : -limit;
            p.high[k] = limit;
            if (is(k, WH_FRICTION) && e->mode[k] != WH_STUCK) {
                push(k, force[k], a);
            }
        }
        const unsigned giving = solve(e, &p, a, lambda);
        if (giving == 0) {
            return;
        }
        const unsigned stops = giving & those(e, WH_STOP, WH_ACTIVE);
        for (unsigned k = 0; k < forced() && stops == 0; k++) {
            const double load =
                in(giving, k) ? size_of(force[k]) / (double)hand_now.law[k].first : 0.0;
            const int more = in(giving, k) ? sign(e, load - most) : -1;
            first = more > 0 ? 1U << k : first | (more == 0 ? 1U << k : 0U);
            most = more > 0 ? load : most;
        }
        e->vague =
            e->vague || (stops == 0 && (giving & (giving - 1U)) != 0 && repeat(e, holding(e)));
        give(e, stops, WH_FREE);
        for (unsigned k = 0; k < forced(); k++) {
            if (in(first, k)) {
                e->mode[k] = sign(e, along(k, a));
            }
        }
    }
}

static double stored(const exact *e) {
    double sum = 0.0;
    for (unsigned i = 0; i < hand_now.n; i++) {
        const double load = hand_now.weighs ? (double)hand_now.load[i] : 0.0;
        sum += (0.5 * (double)hand_now.spring[i] * e->x[i] - load) * e->x[i];
    }
    return sum;
}

static double kinetic(const exact *e) {
    double sum = 0.0;
    for (unsigned i = 0; i < hand_now.n; i++) {
        for (unsigned j = 0; j < hand_now.n; j++) {
            sum += 0.5 * e->v[i] * (double)hand_now.mass[i][j] * e->v[j];
        }
    }
    return sum;
}

/* What rests goes back onto its place, and what else holds, but for those in `but`, stays with it. The energy is
 * contact `mover`'s, or, if there is none, the first one's that is off. */
static void put_back(exact *e, unsigned but, unsigned mover) {
    const double before = stored(e);
    double way[2] = {0.0, 0.0};
    double lambda[HAND_CONTACTS] = {0.0};
    problem p = {holding(e) & ~but, {0.0}, {0.0}, {0.0}};
    for (unsigned k = forced(); k-- > 0;) {
        const int pin = hand_now.contact[k].pin;
        if (in(p.members, k) && is(k, WH_STOP) && sign(e, gap(e, k)) != 0) {
            p.target[k] = -gap(e, k);
            mover = mover < forced() || mover == HAND_CONTACTS ? k : mover;
            if (pin >= 0) { /* its coordinate alone; the furthest, of several */
                const double by = p.target[k] / (double)hand_now.law[k].row[pin];
                way[pin] = size_of(by) > size_of(way[pin]) ? by : way[pin];
            }
        }
    }
    e->x[0] += way[0];
    e->x[1] += way[1];
    for (unsigned k = 0; k < forced(); k++) { /* and what else is to be, around it */
        p.target[k] = hand_now.contact[k].pin >= 0 ? 0.0 : p.target[k] - along(k, way);
    }
    way[0] = 0.0;
    way[1] = 0.0;
    e->vague = e->vague || !reach(&p, p.members, way, lambda);
    for (unsigned k = 0; k < forced(); k++) {
        if (in(p.members, k)) {
            push(k, lambda[k], e->x);
        }
    }
    if (mover < HAND_CONTACTS) {
        e->energy[mover] += stored(e) - before;
    }
}

/* --- velocities --------------------------------------------------------------------------------------------- */

/* Impulses: those in `set` come to target[], what holds and what is in `beside` to zero, stops at least. Returns the
 * stops that open. */
static unsigned strike(exact *e, unsigned set, unsigned beside, const double *target,
                       double *impulse) {
    problem p = {set | beside | those(e, WH_STOP, WH_ACTIVE) | those(e, WH_HOLD, WH_ACTIVE),
                 {0.0},
                 {0.0},
                 {0.0}};
    double before[HAND_CONTACTS];
    double lambda[HAND_CONTACTS];
    for (unsigned k = 0; k < forced(); k++) {
        p.target[k] = in(set, k) ? target[k] : 0.0;
        p.low[k] = is(k, WH_STOP) ? 0.0 : -ENDLESS;
        p.high[k] = ENDLESS;
        before[k] = along(k, e->v);
    }
    e->shared = e->shared || repeat(e, p.members);
    const unsigned opens = solve(e, &p, e->v, lambda);
    for (unsigned k = 0; k < forced(); k++) {
        if (in(p.members, k)) {
            impulse[k] += lambda[k];
            e->impulse[k] += lambda[k];
            e->energy[k] += lambda[k] * 0.5 * (before[k] + along(k, e->v));
        }
    }
    return opens;
}

/* Is a flight that begins so too short? */
static bool rests(exact *e, unsigned k, double speed, const double *a) {
    const int pressed = sign(e, -along(k, a));
    return pressed == 0 ? sign(e, speed) <= 0
                        : pressed > 0 && sign(e, 2.0 * speed + along(k, a) * STEP_S / 8.0) <= 0;
}

static bool touched(exact *e, unsigned k) { return sign(e, gap(e, k)) <= 0; }

/* Free stops that are touched and close, as bits. */
static unsigned closing(exact *e) {
    unsigned bits = 0;
    for (unsigned k = 0; k < forced(); k++) {
        const bool free = is(k, WH_STOP) && e->mode[k] == WH_FREE;
        bits |= free && touched(e, k) && sign(e, along(k, e->v)) < 0 ? 1U << k : 0U;
    }
    return bits;
}

/* Free stops in `found` are hit, and all that close with them. Returns them. */
static unsigned hit(exact *e, unsigned found, double *impulse) {
    double a[2];
    double force[HAND_CONTACTS];
    double speed[HAND_CONTACTS] = {0.0};
    const unsigned resting = those(e, WH_STOP, WH_ACTIVE);
    unsigned closes = 0;
    unsigned beside = 0;
    unsigned rest = 0;
    unsigned leaving = 0;
    unsigned gone = 0;
    accelerate(e, a, force);
    for (unsigned k = 0; k < forced(); k++) { /* that merely touch */
        if (in(resting, k) && hand_now.law[k].first > 0 && sign(e, force[k]) <= 0) {
            e->mode[k] = WH_FREE;
        }
    }
    const unsigned hits = found | closing(e);
    for (unsigned k = 0; k < forced(); k++) {
        const bool free = is(k, WH_STOP) && e->mode[k] == WH_FREE;
        if (in(hits, k)) {
            speed[k] = -(double)hand_now.law[k].first * along(k, e->v);
            speed[k] = rests(e, k, speed[k], a) ? 0.0 : speed[k];
        } else if (free && touched(e, k) && sign(e, along(k, e->v)) == 0) {
            for (unsigned l = 0; l < forced(); l++) {
                const bool moves = in(hits, l) && sign(e, coupled(k, l)) != 0;
                beside |= moves && !(hand_now.law[k].first > 0) ? 1U << k : 0U;
            }
        }
    }
    for (unsigned k = 0; k < forced(); k++) {
        closes |= in(hits, k) && sign(e, along(k, e->v)) < 0 ? 1U << k : 0U;
    }
    if (closes != 0) {
        give(e, strike(e, closes, beside, speed, impulse), WH_FREE);
    }
    accelerate(e, a, force);
    e->next |= closing(e) & ~hits;
    for (unsigned k = 0; k < forced(); k++) {
        const int leaves = sign(e, along(k, e->v));
        if (in(hits, k) && leaves >= 0 && rests(e, k, along(k, e->v), a)) {
            rest |= 1U << k;
            leaving |= leaves > 0 ? 1U << k : 0U;
        }
    }
    give(e, rest, WH_ACTIVE);
    for (unsigned k = 0; k < forced(); k++) {
        const bool open = in(resting, k) && e->mode[k] == WH_FREE && !in(e->next, k);
        gone |= open && rests(e, k, along(k, e->v), a) ? 1U << k : 0U;
    }
    give(e, gone, WH_ACTIVE);
    if ((gone | leaving) != 0) { /* all that holds, together, whatever it takes */
        problem p = {
            those(e, WH_STOP, WH_ACTIVE) | those(e, WH_HOLD, WH_ACTIVE), {0.0}, {0.0}, {0.0}};
        double lambda[HAND_CONTACTS] = {0.0};
        double before[HAND_CONTACTS];
        for (unsigned k = 0; k < forced(); k++) {
            before[k] = along(k, e->v);
        }
        e->vague = e->vague || !reach(&p, p.members, e->v, lambda);
        for (unsigned k = 0; k < forced(); k++) {
            if (in(p.members, k)) {
                push(k, lambda[k], e->v);
                e->impulse[k] += lambda[k];
                e->energy[k] += lambda[k] * 0.5 * before[k];
            }
        }
    }
    if ((rest | gone) != 0) {
        put_back(e, 0, HAND_CONTACTS);
    }
    return hits;
}

void exact_squeeze(exact *e) {
    const double zero[HAND_CONTACTS] = {0.0};
    const double before = stored(e);
    double impulse[HAND_CONTACTS] = {0.0};
    double way[2] = {0.0, 0.0};
    double lambda[HAND_CONTACTS];
    const unsigned stops = those(e, WH_STOP, WH_FREE) | those(e, WH_STOP, WH_ACTIVE);
    problem p = {stops | those(e, WH_HOLD, WH_ACTIVE), {0.0}, {0.0}, {0.0}};
    unsigned touched = 0;
    unsigned first = 0;
    for (unsigned k = forced(); k-- > 0;) {
        p.target[k] = in(stops, k) ? -gap(e, k) : 0.0;
        p.low[k] = in(stops, k) ? 0.0 : -ENDLESS;
        p.high[k] = ENDLESS;
        if (in(stops, k) && e->mode[k] == WH_FREE && sign(e, gap(e, k)) < 0) {
            touched |= 1U << k;
            first = k;
        }
    }
    if (touched == 0) {
        return;
    }
    (void)solve(e, &p, way, lambda);
    for (unsigned i = 0; i < hand_now.n; i++) {
        e->x[i] += way[i];
    }
    for (unsigned k = 0; k < forced(); k++) {
        touched |= in(stops, k) && sign(e, lambda[k]) > 0 ? 1U << k : 0U;
    }
    e->energy[first] += stored(e) - before;
    give(e, strike(e, touched, 0, zero, impulse), WH_FREE);
}

/* --- crossings ---------------------------------------------------------------------------------------------- */

/* The new value; what rests on what it disturbs flies, or is put back; what is held is captured again. */
static void assign(exact *e, unsigned k, double *impulse) {
    const exact was = *e;
    const double zero[HAND_CONTACTS] = {0.0};
    unsigned stops = 0;
    unsigned passed = 0;
    unsigned kept = 0;
    e->mode[k] = -e->mode[k];
    if (hand_now.places) {
        e->x[0] = (double)hand_now.place;
    } else {
        e->v[0] = -0.5 * e->v[0];
    }
    e->energy[k] += kinetic(e) - kinetic(&was) + stored(e) - stored(&was);
    const int side = sign(e, gap(e, k));
    if (hand_now.places && side != 0) { /* a rate does not move it */
        e->mode[k] = side;
    }
    for (unsigned l = 0; l < forced(); l++) {
        const bool same = sign(e, gap(e, l) - gap(&was, l)) == 0 &&
                          sign(e, along(l, e->v) - along(l, was.v)) == 0;
        stops |= is(l, WH_STOP) && !same ? 1U << l : 0U;
        kept |= is(l, WH_HOLD) && e->mode[l] == WH_ACTIVE && !same ? 1U << l : 0U;
    }
    for (unsigned l = 0; l < forced(); l++) {
        passed |= in(stops, l) && sign(e, gap(e, l)) < 0 ? 1U << l : 0U;
    }
    give(e, stops, WH_FREE);
    if (passed != 0) {
        give(e, passed, WH_ACTIVE);
        put_back(e, 0, k);
        give(e, passed, WH_FREE);
    }
    if (kept != 0) {
        give(e, strike(e, kept, 0, zero, impulse), WH_FREE);
    }
}

/* --- moments ------------------------------------------------------------------------------------------------ */

static void note(exact *e, unsigned events, double at_s, const double *impulse) {
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        if (in(events, k) && e->logged < EXACT_LOG) {
            e->log[e->logged++] =
                (wh_event){(uint8_t)k, (int8_t)e->mode[k], (wh_real)at_s, (wh_real)impulse[k]};
        }
    }
}

/* All that happens at a moment. Returns what did. */
static unsigned happen(exact *e, unsigned events, double *impulse) {
    const double zero[HAND_CONTACTS] = {0.0};
    const unsigned let_go = events & those(e, WH_HOLD, WH_ACTIVE);
    const unsigned captured = events & those(e, WH_HOLD, WH_FREE);
    const double came[2] = {e->v[0], e->v[1]};
    for (unsigned k = 0; k < HAND_CONTACTS; k++) {
        impulse[k] = 0.0;
    }
    const unsigned found = events & those(e, WH_STOP, WH_FREE);
    if (found != 0) {
        events |= hit(e, found, impulse);
    }
    give(e, let_go, WH_FREE);
    if (captured != 0) {
        const unsigned closed = closing(e);
        give(e, captured, WH_ACTIVE);
        give(e, strike(e, captured, 0, zero, impulse), WH_FREE);
        e->next |= closing(e) & ~closed;
    }
    for (unsigned k = forced(); k < hand_now.system.contacts; k++) {
        if (in(events, k)) {
            assign(e, k, impulse);
        }
    }
    for (unsigned k = 0; k < forced(); k++) {
        if (is(k, WH_FRICTION)) {
            const double v = along(k, e->v);
            const bool zeroed = in(events, k) && v == along(k, came);
            const int way = sign(e, v);
            e->vague = e->vague || (way == 0 && !zeroed && sign(e, along(k, came)) != 0) ||
                       (in(events, k) && (events & (events - 1U)) != 0);
            e->mode[k] = zeroed ? WH_STUCK : way != 0 ? way : e->mode[k];
        }
    }
    give_way(e);
    for (unsigned k = 0; k < forced(); k++) { /* exactly */
        const int pin = hand_now.contact[k].pin;
        if (pin >= 0 && in(holding(e), k) && size_of(e->v[pin]) <= ZERO) {
            e->v[pin] = 0.0;
        }
    }
    return events;
}

void exact_start(exact *e) {
    double impulse[HAND_CONTACTS];
    unsigned still = 0;
    unsigned moving = 0;
    *e = (exact){.pushed = (double)hand_pushed};
    for (unsigned i = 0; i < hand_now.n; i++) {
        e->x[i] = (double)hand_now.start[i];
        e->v[i] = (double)hand_now.start[hand_now.n + i];
    }
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        const int speed = sign(e, along(k, e->v));
        const bool on = is(k, WH_STOP) ? touched(e, k) : is(k, WH_HOLD) && e->pushed > 0.0;
        e->mode[k] = is(k, WH_FRICTION) ? speed : is(k, WH_WHEN) ? sign(e, gap(e, k)) : WH_FREE;
        still |= on && speed == 0 ? 1U << k : 0U;
        moving |= on && (is(k, WH_HOLD) ? speed != 0 : speed < 0) ? 1U << k : 0U;
    }
    const unsigned holds = still & those(e, WH_HOLD, WH_FREE);
    give(e, still & ~holds, WH_ACTIVE);
    if (still != 0) { /* settled before anything is hit */
        (void)happen(e, holds, impulse);
        put_back(e, those(e, WH_FRICTION, WH_STUCK), HAND_CONTACTS); /* nothing holds it there */
    }
    const unsigned events = happen(e, moving, impulse);
    note(e, events, 0.0, impulse);
}

/* --- motion ------------------------------------------------------------------------------------------------- */

/* When g + r t + a t^2 / 2 first falls below zero within `left`, having not been there; `left` if it does not. */
static double falls(exact *e, double g, double r, double a, double left) {
    const double end = g + r * left + 0.5 * a * left * left;
    const int below = sign(e, end);
    const int begins = sign(e, g);
    e->vague = e->vague || (begins == 0 && size_of(r) < ZERO && size_of(a) < ZERO);
    e->vague = e->vague || (below == 0 && begins > 0); /* just at the step's end */
    if (below >= 0) {
        if (a > 0.0 && r < 0.0 && -r / a < left) { /* a dip that the step's end does not see */
            e->vague = e->vague || sign(e, g - 0.5 * r * r / a) < 0;
        }
        return left;
    }
    if (begins == 0 && (r < 0.0 || (sign(e, r) == 0 && a < 0.0))) {
        return 0.0;
    }
    if (begins < 0) {
        e->vague = true;
        return left;
    }
    if (size_of(a) < 1e-9) {
        return -g / r;
    }
    if (begins == 0) { /* up and down again */
        return -2.0 * r / a;
    }
    const double root = (double)WH_SQRT((wh_real)(r * r - 2.0 * a * g));
    return r < 0.0 ? 2.0 * g / (root - r) : (-r - root) / a;
}

/* Of contact k: how long until its event. */
static double waits(exact *e, unsigned k, const double *a, double left) {
    const double r = along(k, e->v);
    switch ((wh_contact_kind)hand_now.contact[k].kind) {
    case WH_STOP: return e->mode[k] == WH_ACTIVE ? left : falls(e, gap(e, k), r, along(k, a), left);
    case WH_HOLD: return (e->mode[k] == WH_ACTIVE) == (e->pushed > 0.0) ? left : 0.0;
    case WH_FRICTION: {
        const double rate = r * e->mode[k];
        return e->mode[k] == WH_STUCK ? left : falls(e, rate, along(k, a) * e->mode[k], 0.0, left);
    }
    case WH_WHEN: {
        const double side = e->mode[k];
        return e->mode[k] == 0 || hand_now.contact[k].direction == e->mode[k]
                   ? left
                   : falls(e, gap(e, k) * side, r * side, along(k, a) * side, left);
    }
    case WH_CONTACT_KIND_COUNT: break;
    }
    return left;
}

static void move(exact *e, const double *a, const double *force, double span) {
    double way[2] = {0.0, 0.0};
    for (unsigned i = 0; i < hand_now.n; i++) {
        way[i] = span * (e->v[i] + 0.5 * span * a[i]);
        e->x[i] += way[i];
        e->v[i] += span * a[i];
    }
    for (unsigned k = 0; k < forced(); k++) {
        e->energy[k] += force[k] * along(k, way);
        e->impulse[k] += force[k] * span;
    }
}

void exact_step(exact *e) {
    double left = STEP_S;
    unsigned rounds = 0;
    if (hand_state.steps > 1) { /* a run's start is noted with its first step */
        e->logged = 0;
    }
    while ((left > 0.0 || e->next != 0) && !e->vague) {
        unsigned events = e->next;
        e->next = 0;
        if (events == 0) {
            double a[2];
            double force[HAND_CONTACTS];
            double wait[HAND_CONTACTS];
            double span = left;
            accelerate(e, a, force);
            for (unsigned k = 0; k < hand_now.system.contacts; k++) {
                wait[k] = waits(e, k, a, left);
                span = wait[k] < span ? wait[k] : span;
            }
            for (unsigned k = 0; k < hand_now.system.contacts && span < left; k++) {
                events |= sign(e, (wait[k] - span) / STEP_S) == 0 ? 1U << k : 0U;
            }
            move(e, a, force, span);
            left = span < left ? left - span : 0.0;
        }
        if (events != 0) {
            double impulse[HAND_CONTACTS];
            const double at_s = STEP_S - left;
            for (unsigned k = 0; k < forced(); k++) { /* it has just come to zero */
                const int pin = hand_now.contact[k].pin;
                if (in(events, k) && is(k, WH_FRICTION)) {
                    e->v[pin] = 0.0;
                }
            }
            events = happen(e, events, impulse);
            note(e, events, at_s, impulse);
            e->vague = e->vague || ++rounds >= WH_EVENTS_MAX - 1;
        }
    }
    for (unsigned k = forced(); k < hand_now.system.contacts; k++) { /* passed the other way */
        const int side = sign(e, gap(e, k));
        e->mode[k] = side != 0 ? side : e->mode[k];
    }
}
