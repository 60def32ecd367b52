/* exact_law.c: see exact_law.h. */
#include "exact_law.h"

/* A number below NEAR that is not zero makes a decision vague (exact.h). */
#define NEAR (WH_DOUBLE ? 1e-6 : 1e-4)

double exact_size_of(double value) { return value < 0.0 ? -value : value; }

int exact_sign(exact *e, double value) {
    const double size = exact_size_of(value);
    e->vague = e->vague || (size > EXACT_ZERO && size < NEAR);
    return size <= EXACT_ZERO ? 0 : value > 0.0 ? 1 : -1;
}

bool exact_in(unsigned bits, unsigned k) { return (bits >> k & 1U) != 0; }

unsigned exact_forced(void) { return hand_now.system.forced; }

bool exact_is(unsigned k, wh_contact_kind kind) { return hand_now.contact[k].kind == kind; }

unsigned exact_those(const exact *e, wh_contact_kind kind, int mode) {
    unsigned bits = 0;
    for (unsigned k = 0; k < exact_forced(); k++) {
        bits |= exact_is(k, kind) && e->mode[k] == mode ? 1U << k : 0U;
    }
    return bits;
}

void exact_give(exact *e, unsigned bits, int mode) {
    for (unsigned k = 0; k < exact_forced(); k++) {
        e->mode[k] = exact_in(bits, k) ? mode : e->mode[k];
    }
}

double exact_along(unsigned k, const double *x) {
    return (double)hand_now.law[k].row[0] * x[0] +
           (hand_now.n == 2 ? (double)hand_now.law[k].row[1] * x[1] : 0.0);
}

double exact_gap(const exact *e, unsigned k) {
    return exact_along(k, e->x) - (double)hand_now.law[k].offset;
}

void exact_push(unsigned k, double lambda, double *x) {
    for (unsigned i = 0; i < hand_now.n; i++) {
        for (unsigned j = 0; j < hand_now.n; j++) {
            x[i] += (double)hand_now.inverse[i][j] * (double)hand_now.law[k].row[j] * lambda;
        }
    }
}

double exact_coupled(unsigned k, unsigned l) {
    double way[2] = {0.0, 0.0};
    exact_push(l, 1.0, way);
    return exact_along(k, way);
}

bool exact_reach(const exact_problem *p, unsigned tight, const double *x, double *lambda) {
    double a[HAND_CONTACTS][HAND_CONTACTS + 1];
    unsigned member[HAND_CONTACTS];
    unsigned count = 0;
    double y[2] = {x[0], x[1]};
    for (unsigned k = 0; k < exact_forced(); k++) {
        if (exact_in(tight, k)) {
            member[count++] = k;
        } else if (exact_in(p->members, k)) {
            exact_push(k, lambda[k], y);
        }
    }
    for (unsigned r = 0; r < count; r++) {
        for (unsigned c = 0; c < count; c++) {
            a[r][c] = exact_coupled(member[r], member[c]);
        }
        a[r][count] = p->target[member[r]] - exact_along(member[r], y);
    }
    for (unsigned q = 0; q < count; q++) {
        /* Unless each pivot is positive, the rows are dependent. */
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

static bool good(const exact_problem *p, unsigned k, int which, double lambda, double off) {
    return which == 0  ? lambda >= p->low[k] - 1e-9 && lambda <= p->high[k] + 1e-9
           : which < 0 ? off >= -1e-9
                       : off <= 1e-9;
}

unsigned exact_solve(exact *e, const exact_problem *p, double *x, double *lambda) {
    for (unsigned number = 0; number < 27;
         /* the combinations: each contact is at its target, its low limit or its high limit */
         number++) {
        unsigned rest = number;
        unsigned tight = 0;
        int which[HAND_CONTACTS] = {0};
        bool meets = true;
        for (unsigned k = 0; k < exact_forced(); k++, rest /= 3) {
            which[k] = (int)(rest % 3) == 2 ? -1 : (int)(rest % 3);
            lambda[k] = 0.0;
            if (!exact_in(p->members, k)) {
                meets = meets && which[k] == 0;
            } else if (which[k] == 0) {
                tight |= 1U << k;
            } else {
                lambda[k] = which[k] < 0 ? p->low[k] : p->high[k];
                meets = meets && exact_size_of(lambda[k]) < EXACT_ENDLESS;
            }
        }
        if (!meets || !exact_reach(p, tight, x, lambda)) {
            continue;
        }
        double y[2] = {x[0], x[1]};
        unsigned beyond = 0;
        for (unsigned k = 0; k < exact_forced(); k++) {
            if (exact_in(p->members, k)) {
                exact_push(k, lambda[k], y);
            }
        }
        for (unsigned k = 0; k < exact_forced() && meets; k++) {
            const double off = exact_along(k, y) - p->target[k];
            meets = !exact_in(p->members, k) || good(p, k, which[k], lambda[k], off);
        }
        if (meets) {
            for (unsigned k = 0; k < exact_forced(); k++) {
                const bool off =
                    exact_in(p->members, k) && exact_sign(e, exact_along(k, y) - p->target[k]) != 0;
                beyond |= off ? 1U << k : 0U;
                if (exact_in(tight, k)) { /* the decision is vague if the force is near a limit */
                    (void)exact_sign(e, lambda[k] - p->low[k]);
                    (void)exact_sign(e, lambda[k] - p->high[k]);
                }
            }
            x[0] = y[0];
            x[1] = y[1];
            return beyond;
        }
    }
    e->vague = true; /* dependent holds have no unique forces, so there is no reference */
    return 0;
}

bool exact_repeat(const exact *e, unsigned members) {
    exact_problem p = {members, {0.0}, {0.0}, {0.0}};
    const double x[2] = {0.0, 0.0};
    double lambda[HAND_CONTACTS];
    (void)e;
    return !exact_reach(&p, members, x, lambda);
}

unsigned exact_holding(const exact *e) {
    return exact_those(e, WH_STOP, WH_ACTIVE) | exact_those(e, WH_HOLD, WH_ACTIVE) |
           exact_those(e, WH_FRICTION, WH_STUCK);
}

void exact_accelerate(exact *e, double *a, double *force) {
    double own[2] = {0.0, 0.0};
    unsigned members = 0;
    exact_problem p = {0, {0.0}, {0.0}, {0.0}};
    for (unsigned i = 0; i < hand_now.n; i++) {
        own[i] = 0.0;
        for (unsigned j = 0; j < hand_now.n; j++) {
            own[i] += (double)hand_now.inverse[i][j] * (double)hand_now.load[j];
        }
    }
    for (unsigned k = 0; k < exact_forced(); k++) {
        force[k] = 0.0;
        if (exact_is(k, WH_FRICTION) && e->mode[k] != WH_STUCK) {
            force[k] = -(double)hand_now.law[k].second * e->mode[k];
            exact_push(k, force[k], own);
        } else if (exact_in(exact_holding(e), k)) {
            members |= exact_repeat(e, members | 1U << k) ? 0U : 1U << k;
        }
    }
    e->shared = e->shared || members != exact_holding(e);
    p.members = members;
    (void)exact_reach(&p, members, own, force);
    for (unsigned k = 0; k < exact_forced(); k++) {
        if (exact_in(members, k)) {
            exact_push(k, force[k], own);
        }
    }
    a[0] = own[0];
    a[1] = own[1];
}

void exact_give_way(exact *e) {
    for (;;) {
        double a[2];
        double force[HAND_CONTACTS];
        double lambda[HAND_CONTACTS];
        double way[2];
        exact_problem p = {exact_holding(e), {0.0}, {0.0}, {0.0}};
        unsigned first = 0;
        double most = 0.0;
        exact_accelerate(e, way, force); /* for this computation all contacts are still active */
        a[0] = 0.0;
        a[1] = 0.0;
        for (unsigned i = 0; i < hand_now.n; i++) {
            for (unsigned j = 0; j < hand_now.n; j++) {
                a[i] += (double)hand_now.inverse[i][j] * (double)hand_now.load[j];
            }
        }
        for (unsigned k = 0; k < exact_forced(); k++) {
            const double limit =
                exact_is(k, WH_FRICTION) ? (double)hand_now.law[k].first : EXACT_ENDLESS;
            p.low[k] = exact_is(k, WH_STOP) ? 0.0 : -limit;
            p.high[k] = limit;
            if (exact_is(k, WH_FRICTION) && e->mode[k] != WH_STUCK) {
                exact_push(k, force[k], a);
            }
        }
        const unsigned giving = exact_solve(e, &p, a, lambda);
        if (giving == 0) {
            return;
        }
        const unsigned stops = giving & exact_those(e, WH_STOP, WH_ACTIVE);
        for (unsigned k = 0; k < exact_forced() && stops == 0; k++) {
            const double load =
                exact_in(giving, k) ? exact_size_of(force[k]) / (double)hand_now.law[k].first : 0.0;
            const int more = exact_in(giving, k) ? exact_sign(e, load - most) : -1;
            first = more > 0 ? 1U << k : first | (more == 0 ? 1U << k : 0U);
            most = more > 0 ? load : most;
        }
        e->vague = e->vague || (stops == 0 && (giving & (giving - 1U)) != 0 &&
                                exact_repeat(e, exact_holding(e)));
        exact_give(e, stops, WH_FREE);
        for (unsigned k = 0; k < exact_forced(); k++) {
            if (exact_in(first, k)) {
                e->mode[k] = exact_sign(e, exact_along(k, a));
            }
        }
    }
}

double exact_stored(const exact *e) {
    double sum = 0.0;
    for (unsigned i = 0; i < hand_now.n; i++) {
        const double load = hand_now.weighs ? (double)hand_now.load[i] : 0.0;
        sum += (0.5 * (double)hand_now.spring[i] * e->x[i] - load) * e->x[i];
    }
    return sum;
}

double exact_kinetic(const exact *e) {
    double sum = 0.0;
    for (unsigned i = 0; i < hand_now.n; i++) {
        for (unsigned j = 0; j < hand_now.n; j++) {
            sum += 0.5 * e->v[i] * (double)hand_now.mass[i][j] * e->v[j];
        }
    }
    return sum;
}

void exact_put_back(exact *e, unsigned but, unsigned mover) {
    const double before = exact_stored(e);
    double way[2] = {0.0, 0.0};
    double lambda[HAND_CONTACTS] = {0.0};
    exact_problem p = {exact_holding(e) & ~but, {0.0}, {0.0}, {0.0}};
    for (unsigned k = exact_forced(); k-- > 0;) {
        const int pin = hand_now.contact[k].pin;
        if (exact_in(p.members, k) && exact_is(k, WH_STOP) && exact_sign(e, exact_gap(e, k)) != 0) {
            p.target[k] = -exact_gap(e, k);
            mover = mover < exact_forced() || mover == HAND_CONTACTS ? k : mover;
            if (pin >= 0) {
                /* The contact moves its only coordinate. Of several contacts, the one with the largest move
                 * counts. */
                const double by = p.target[k] / (double)hand_now.law[k].row[pin];
                way[pin] = exact_size_of(by) > exact_size_of(way[pin]) ? by : way[pin];
            }
        }
    }
    e->x[0] += way[0];
    e->x[1] += way[1];
    for (unsigned k = 0; k < exact_forced(); k++) {
        /* the remaining errors of contacts that depend on several coordinates */
        p.target[k] = hand_now.contact[k].pin >= 0 ? 0.0 : p.target[k] - exact_along(k, way);
    }
    way[0] = 0.0;
    way[1] = 0.0;
    e->vague = e->vague || !exact_reach(&p, p.members, way, lambda);
    for (unsigned k = 0; k < exact_forced(); k++) {
        if (exact_in(p.members, k)) {
            exact_push(k, lambda[k], e->x);
        }
    }
    if (mover < HAND_CONTACTS) {
        e->energy[mover] += exact_stored(e) - before;
    }
}
