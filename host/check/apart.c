/* apart.c: start values that satisfy the holds: positions by Newton's method, rates by one linear step. */
#include "apart.h"

#include <math.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/diag.h"
#include "host/engine/engine.h"
#include "host/number/functions.h"
#include "host/number/gauss.h"

enum { N = IMAGE_COMPONENTS_MAX, HOLDS = WH_CONTACTS_LIMIT, NEWTON_MOST = 50 };

#define OFF_MOST 0.5
/* A hold's condition may become false just after the start, so it is evaluated SOON steps later. */
#define SOON 1e-6

typedef struct apart {
    const image *im;
    state_list forces; /* its result: [im->forced * (WH_LAW_ROWS + 2 n)] */
    int n;
    int hold[HOLDS]; /* indices in im->contact[] of the holds that are active at the start */
    int holds;
    bool vanishes[HOLDS]; /* result of has_zero() */
    bool closes;          /* at least one hold has an error */
    double x[2 * N];      /* [2 n] positions, then rates */
} apart;

static const double *rates(const apart *a) { return a->x + a->n; }

static const double *law_of(const apart *a, int h) {
    return a->forces.result + (ptrdiff_t)a->hold[h] * (WH_LAW_ROWS + 2 * a->n);
}
static const double *row_of(const apart *a, int h) { return law_of(a, h) + WH_LAW_ROWS; }

static void look(apart *a) { (void)state_list_at(&a->forces, a->x, a->x + a->im->angles); }

static double along(const apart *a, int h, const double *x) {
    double sum = 0.0;
    for (int i = 0; i < a->n; i++) {
        sum += row_of(a, h)[i] * x[i];
    }
    return sum;
}

/* Sum of |row[i] x[i]|. If x has positions (`places`), each angle counts as 1 rad. */
static double terms(const apart *a, int h, const double *x, bool places) {
    double sum = 0.0;
    for (int i = 0; i < a->n; i++) {
        sum += fabs(row_of(a, h)[i]) * (places && i < a->im->angles ? 1.0 : fabs(x[i]));
    }
    return sum;
}

static double off_zero(const apart *a, int h) {
    const image_contact *c = &a->im->contact[a->hold[h]];
    const double value = law_of(a, h)[WH_LAW_FIRST];
    const double size = terms(a, h, a->x, true);
    const bool is = c->pin < 0 && c->direction <= 0 && a->vanishes[h] &&
                    fabs(value) > APART_LEAST * size &&
                    (a->closes || fabs(value) < OFF_MOST * size);
    return is ? value : 0.0;
}

/* Sets a->x to from + share * row, and returns the hold's expression at this point. */
static double value_at(apart *a, int h, const double *from, const double *row, double share) {
    for (int i = 0; i < a->n; i++) {
        a->x[i] = from[i] + share * row[i];
    }
    look(a);
    return law_of(a, h)[WH_LAW_FIRST];
}

/* Does the hold's expression change its sign at the zero that Newton's method finds from the start? */
static bool has_zero(apart *a, int h) {
    double start[2 * N];
    double row[N] = {0.0};
    double value = law_of(a, h)[WH_LAW_FIRST];
    const double least = 1e-9 * fabs(value);
    memcpy(start, a->x, sizeof start);
    for (int k = 0; k < NEWTON_MOST && fabs(value) > least; k++) {
        double square = 0.0;
        for (int i = 0; i < a->n; i++) {
            row[i] = row_of(a, h)[i];
            square += row[i] * row[i];
        }
        value = square > 0.0 ? value_at(a, h, a->x, row, -value / square) : (double)NAN;
    }
    double zero[2 * N];
    memcpy(zero, a->x, sizeof zero);
    const bool changes = fabs(value) <= least &&
                         value_at(a, h, zero, row, -1e-4) * value_at(a, h, zero, row, 1e-4) < 0.0;
    memcpy(a->x, start, sizeof start);
    look(a);
    return changes;
}

/* Solves matrix[n][n + 1]; its last column is the right-hand side, and becomes the solution. False: singular. */
static bool solve(int n, double *matrix) {
    int lead[HOLDS];
    if (gauss_reduce(matrix, n, n + 1, n, false, 1e-12, lead) < n) {
        return false;
    }
    for (int p = 0; p < n; p++) {
        matrix[p * (n + 1) + n] /= matrix[p * (n + 1) + p];
    }
    return true;
}

/* Adds the smallest change to x that changes the expression of each hold h by by[h]. */
static bool move(const apart *a, const bool *may, const double *by, double *x) {
    double matrix[HOLDS * (HOLDS + 1)] = {0.0};
    const int n = a->holds;
    for (int r = 0; r < n; r++) {
        double *row = matrix + (ptrdiff_t)r * (n + 1);
        row[n] = by[r];
        for (int c = 0; c < n; c++) {
            for (int i = 0; i < a->n; i++) {
                row[c] += may[i] ? row_of(a, r)[i] * row_of(a, c)[i] : 0.0;
            }
        }
    }
    if (!solve(n, matrix)) {
        return false;
    }
    for (int i = 0; i < a->n; i++) {
        for (int r = 0; r < n && may[i]; r++) {
            x[i] += row_of(a, r)[i] * matrix[r * (n + 1) + n];
        }
    }
    return true;
}

static bool fit_places(apart *a, const bool *may) {
    double worst = 1.0;
    double wanted[HOLDS]; /* 0 for a hold with an error, else its value at the start */
    for (int h = 0; h < a->holds; h++) {
        const double value = law_of(a, h)[WH_LAW_FIRST];
        wanted[h] = off_zero(a, h) != 0.0 ? 0.0 : value;
    }
    for (int k = 0; k < NEWTON_MOST && worst > 1e-14; k++) {
        double by[HOLDS];
        worst = 0.0;
        for (int h = 0; h < a->holds; h++) {
            const image_contact *c = &a->im->contact[a->hold[h]];
            const bool curved = c->pin < 0 && c->direction <= 0;
            by[h] = curved ? wanted[h] - law_of(a, h)[WH_LAW_FIRST] : 0.0;
            worst = number_most(worst, fabs(by[h]));
        }
        if (worst > 1e-14 && !move(a, may, by, a->x)) {
            return false;
        }
        look(a);
    }
    return worst < 1e-9;
}

static bool fit_rates(apart *a, const bool *may) {
    double by[HOLDS];
    for (int h = 0; h < a->holds; h++) {
        by[h] = -along(a, h, rates(a));
    }
    return move(a, may, by, a->x + a->n);
}

/* Tries first to change only start values that the scene does not set. */
static bool fit(apart *a, int primes, bool (*with)(apart *a, const bool *may)) {
    const apart before = *a;
    for (int all = 0; all < 2; all++) {
        bool may[N];
        for (int i = 0; i < a->n; i++) {
            const image_unknown *u = &a->im->unknown[image_component(a->im, i).unknown];
            may[i] = !u->driven && (all == 1 || u->start_at[primes].source == NULL);
        }
        if (with(a, may)) {
            return true;
        }
        memcpy(a->x, before.x, sizeof a->x);
        look(a);
    }
    return false;
}

/* Energy removed by the impulse that stops the holds' rates w: 1/2 w (J M^-1 J^T)^-1 w. NaN if holds are redundant. */
static double lost_J(const apart *a) {
    double matrix[HOLDS * (HOLDS + 1)];
    const int n = a->holds;
    double sum = 0.0;
    for (int r = 0; r < n; r++) {
        for (int c = 0; c <= n; c++) {
            matrix[r * (n + 1) + c] = along(a, r, c < n ? row_of(a, c) + a->n : rates(a));
        }
    }
    if (!solve(n, matrix)) {
        return (double)NAN;
    }
    for (int r = 0; r < n; r++) {
        sum += 0.5 * matrix[r * (n + 1) + n] * along(a, r, rates(a));
    }
    return sum;
}

static void say_values(FILE *out, const apart *a, const double *was) {
    const char *before = "hint: write: start ";
    for (int i = 0; i < 2 * a->n; i++) {
        const image_unknown *u = &a->im->unknown[image_component(a->im, i % a->n).unknown];
        const int primes = i / a->n;
        const double value = a->x[i];
        const char *si = u->unit[primes].si;
        const bool has_unit = strcmp(si, "1") != 0;
        /* the user replaces all start values of the scene by this text, so it includes unchanged values */
        if (value != was[i] || (u->start_at[primes].source != NULL && !u->driven)) {
            fprintf(out, "%s%s%s = %.17g%s%s%s", before, u->name, primes == 0 ? "" : "'", value,
                    has_unit ? " [" : "", has_unit ? si : "", has_unit ? "]" : "");
            before = ", ";
        }
    }
    fputs("\n", out);
}

/* The rate of a hold, if it exceeds round-off; else 0. */
static double moving(const apart *a, int h) {
    const double speed = along(a, h, rates(a));
    const double least = APART_LEAST * terms(a, h, rates(a), false);
    return fabs(speed) > least ? speed : 0.0;
}

static void say(FILE *out, const char *who, apart *a) {
    char statement[STATEMENT_SIZE];
    bool off = false;
    bool moves = false;
    for (int h = 0; h < a->holds; h++) {
        const double value = off_zero(a, h);
        const double speed = moving(a, h);
        statement_text(a->im->contact[a->hold[h]].at, statement, sizeof statement);
        for (int k = 0; k < 2; k++) {
            if (k == 0 ? value == 0.0 : speed == 0.0) {
                continue;
            }
            fprintf(out,
                    k == 0 ? "%s%sa hold starts with an error of %.6g (SI), and keeps it: %s"
                           : "%s%sa hold starts with a rate of %.6g (SI), which should be zero: %s",
                    who != NULL ? who : "", who != NULL ? ": warning: " : "",
                    k == 0 ? value : speed, statement);
            if (who == NULL) {
                return;
            }
            fputs(" [apart]\n", out);
        }
        off = off || value != 0.0;
        moves = moves || speed != 0.0;
    }
    if (moves && isfinite(lost_J(a))) {
        fprintf(out,
                "%s: warning: an impulse at t = 0 sets this rate to zero and removes %.6g J "
                "of energy\n",
                who, lost_J(a));
    }
    double was[2 * N];
    memcpy(was, a->x, sizeof was);
    if ((!off || fit(a, 0, fit_places)) && fit(a, 1, fit_rates)) {
        say_values(out, a, was);
    } else {
        fputs(
            "hint: choose other start values: Whirl found none near these that satisfy the holds\n",
            out);
    }
}

double apart_say(FILE *out, const char *who, const image *im) {
    double part = 0.0;
    if (im->list[IMAGE_FORCES] == NULL || im->list[IMAGE_SIGNALS] == NULL) {
        return part;
    }
    apart a = {.im = im, .forces = state_list_open(im, IMAGE_FORCES), .n = im->coordinates};
    const state_list signals = state_list_open(im, IMAGE_SIGNALS);
    double soon[2 * N];
    for (int i = 0; i < 2 * a.n; i++) {
        a.x[i] = image_start(im, i);
    }
    for (int i = 0; i < a.n; i++) {
        soon[i] = a.x[i] + SOON * im->step_s * a.x[a.n + i];
        soon[a.n + i] = a.x[a.n + i];
    }
    const double *signal = state_list_at(&signals, soon, soon + im->angles);
    for (int k = 0; k < im->forced; k++) {
        if (im->contact[k].kind == WH_HOLD && signal[2 * k] > 0.0) {
            a.hold[a.holds++] = k;
        }
    }
    if (a.holds > 0) {
        look(&a);
        for (int h = 0; h < a.holds; h++) {
            a.vanishes[h] = has_zero(&a, h);
        }
        for (int h = 0; h < a.holds; h++) {
            a.closes = a.closes || off_zero(&a, h) != 0.0;
        }
        for (int h = 0; h < a.holds; h++) {
            const double off = fabs(off_zero(&a, h));
            const double speed = fabs(moving(&a, h));
            part = number_most(part, off > 0.0 ? off / terms(&a, h, a.x, true) : 0.0);
            part = number_most(part, speed > 0.0 ? speed / terms(&a, h, rates(&a), false) : 0.0);
        }
        if (part > 0.0 && out != NULL) {
            say(out, who, &a);
        }
    }
    state_list_close(&signals);
    state_list_close(&a.forces);
    return part;
}
