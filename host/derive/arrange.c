/* arrange.c: scales, and what is eliminated while the equations are still symbols. */
#include "arrange.h"

#include <math.h>
#include <stdlib.h>

#include "hinge.h"
#include "host/base/room.h"
#include "host/number/folding.h"

/* Symbolic elimination stops when an entry would get more terms than this. */
#define SYMBOLIC_TERMS_MAX 60

/* --- scaling -------------------------------------------------------------------------------------*/

/* Different numbers that are counted; later ones are not, in what is large beyond any choice. */
#define TALLY_MAX 128

/* Starts as {0}. */
typedef struct tally {
    double size[TALLY_MAX];
    int uses[TALLY_MAX];
    int count;
} tally;

static void tally_add(tally *t, const poly *p) {
    for (int i = 0; i < p->count; i++) {
        const double size = fabs(p->terms[i].coefficient);
        int k = 0;
        while (k < t->count && fabs(t->size[k] - size) > 1e-13 * size) {
            k++;
        }
        if (k == t->count && k < TALLY_MAX) {
            t->size[t->count++] = size;
        }
        if (k < t->count) {
            t->uses[k]++;
        }
    }
}

static double tally_favourite(const tally *t) {
    int best = -1;
    for (int k = 0; k < t->count; k++) {
        if (best < 0 || t->uses[k] > t->uses[best]) {
            best = k;
        }
    }
    return best < 0 ? 1.0 : t->size[best];
}

/* scale[i] for row and column i, and a common divisor, so that most coefficients become one. */
static double choose_scales(const linear_system *s, double *scale) {
    const int n = s->n;
    tally all = {.count = 0};
    bool any_turning = false;
    for (int i = 0; i < n; i++) {
        any_turning = any_turning || s->turning[i];
    }
    for (int i = 0; i < n; i++) {
        scale[i] = 1.0;
        if (any_turning && !s->turning[i]) {
            continue;
        }
        tally_add(&all, s->force[i]);
        for (int j = 0; j < n; j++) {
            if (!any_turning || s->turning[j]) {
                tally_add(&all, s->mass[i * n + j]);
            }
        }
    }
    const double common = tally_favourite(&all);
    for (int i = 0; i < n && any_turning; i++) {
        if (!s->turning[i]) {
            tally row = {.count = 0};
            for (int j = 0; j < n; j++) {
                if (s->turning[j]) {
                    tally_add(&row, s->mass[i * n + j]);
                }
            }
            scale[i] = row.count == 0 ? 1.0 : common / tally_favourite(&row);
        }
    }
    return common;
}

/* c * scale, put onto a simple fraction where it comes out a rounding error beside one: 1.0000000000000002 would
 * cost a product. */
static double scale_number(double c, double scale) {
    const double scaled = folding_product(c, scale);
    const double nearest = number_floor(scaled * 48.0 + 0.5) / 48.0;
    return nearest != 0.0 && folding_same(scaled, nearest, 1e-15) ? nearest : scaled;
}

static const poly *scale_simply(algebra *a, const poly *p, double scale) {
    return poly_each_number(a, p, scale_number, scale);
}

/* --- symbolic elimination ------------------------------------------------------------------------*/

static bool number_at(const poly *const *mass, int n, int i, double *value) {
    return poly_is_number(mass[i * n + i], value) && *value != 0.0;
}

/* Eliminate unknown k from the others in symbols. False, with nothing changed, if it would grow. */
static bool eliminate_symbolic(algebra *a, int n, const poly **mass, const poly **force,
                               const bool *gone, int k) {
    double diagonal;
    if (!number_at(mass, n, k, &diagonal)) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (mass[i * n + k]->count * mass[k * n + j]->count > SYMBOLIC_TERMS_MAX) {
                return false;
            }
        }
    }
    for (int i = 0; i < n; i++) {
        if (gone[i] || i == k || poly_is_zero(mass[i * n + k])) {
            continue;
        }
        const poly *part = poly_scale(a, mass[i * n + k], 1.0 / diagonal);
        for (int j = 0; j < n; j++) {
            if (!gone[j] && j != k) {
                mass[i * n + j] = poly_sub(a, mass[i * n + j], poly_mul(a, part, mass[k * n + j]));
            }
        }
        force[i] = poly_sub(a, force[i], poly_mul(a, part, force[k]));
    }
    return true;
}

/* Of those that are eliminated, in their order, who is not wanted and whom nobody that is wanted is made from: their
 * equations need not be computed, and what sines stand in no other one need not be taken. */
static void forget_unwanted(algebra *a, const linear_system *s, const poly **mass,
                            const poly **force, const int *order, int eliminated) {
    const int n = s->n;
    for (int e = 0; e < eliminated && !s->wanted[order[e]]; e++) {
        const int k = order[e];
        for (int i = 0; i < n; i++) {
            if (i != k) {
                mass[k * n + i] = mass[i * n + k] = poly_number(a, 0.0);
            }
        }
        force[k] = poly_number(a, 0.0);
    }
}

/* What is left by symbols divided by the size that most of its numbers have: they become one. */
static void scale_what_is_left(algebra *a, int n, const poly **mass, const poly **force,
                               const bool *gone) {
    tally all = {.count = 0};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (!gone[j]) {
                tally_add(&all, mass[i * n + j]);
            }
        }
        if (!gone[i]) {
            tally_add(&all, force[i]);
        }
    }
    const double scale = 1.0 / tally_favourite(&all);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !gone[i]; j++) {
            if (!gone[j]) {
                mass[i * n + j] = scale_simply(a, mass[i * n + j], scale);
            }
        }
        if (!gone[i]) {
            force[i] = scale_simply(a, force[i], scale);
        }
    }
}

/* --- one arrangement -----------------------------------------------------------------------------*/

static arranged arranged_room(int n) {
    arranged w = {.n = n, .polys = n * n + n + n * (n + 1)};
    w.mass = room(w.polys, sizeof *w.mass);
    w.force = w.mass + n * n;
    w.across = w.force + n;
    w.inverse = room(n, sizeof *w.inverse);
    w.scale = room(n, sizeof *w.scale);
    w.gone = room(n, sizeof *w.gone);
    w.order = room(n, sizeof *w.order);
    return w;
}

void arranged_free(arranged *w) {
    free(w->mass);
    free(w->inverse);
    free(w->scale);
    free(w->gone);
    free(w->order);
}

static void scale_all(algebra *a, const linear_system *s, const arrangement *how, arranged *w) {
    const int n = s->n;
    double common = 1.0;
    for (int i = 0; i < n; i++) {
        w->scale[i] = 1.0;
    }
    if (how->scaled) {
        common = choose_scales(s, w->scale);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double factor_ij = w->scale[i] * w->scale[j] / common;
            w->mass[i * n + j] =
                how->scaled ? scale_simply(a, s->mass[i * n + j], factor_ij) : s->mass[i * n + j];
        }
        w->force[i] =
            how->scaled ? scale_simply(a, s->force[i], w->scale[i] / common) : s->force[i];
    }
    for (int i = 0; i < n * (n + 1); i++) {
        w->across[i] = poly_number(a, 0.0);
    }
}

static void put_away(arranged *w, int k) {
    w->gone[k] = true;
    w->order[w->eliminated++] = k;
}

/* Is unknown k on none of the hinges so far? */
static bool off_hinges(const arranged *w, int k) {
    bool off = true;
    for (int h = 0; h < w->hinges; h++) {
        off = off && poly_is_zero(w->across[h * (w->n + 1) + k]);
    }
    return off;
}

/* All that hang on hinges, in the order. False: none does. */
static bool eliminate_hinged(algebra *a, const linear_system *s, const arrangement *how,
                             arranged *w) {
    const int n = s->n;
    for (int i = 0; i < n; i++) {
        const int k = how->order[i];
        const poly **across = w->across + w->hinges * (n + 1);
        double own;
        if (off_hinges(w, k) &&
            hinge_eliminate(a, n, w->mass, w->force, w->gone, k, s->unknown[k], &own, across)) {
            w->inverse[w->hinges++] = 1.0 / own;
            put_away(w, k);
        }
    }
    return w->hinges > 0;
}

/* What is left of the equations of unknown i, and of its column, times a number: what else is said of it (across) too. */
static void scale_unknown(algebra *a, arranged *w, int i, double scale) {
    const int n = w->n;
    for (int j = 0; j < n; j++) {
        w->mass[i * n + j] = scale_simply(a, w->mass[i * n + j], scale);
        w->mass[j * n + i] = scale_simply(a, w->mass[j * n + i], scale);
    }
    for (int h = 0; h < w->hinges; h++) {
        const poly **across = &w->across[h * (n + 1) + i];
        *across = scale_simply(a, *across, scale);
    }
    w->force[i] = scale_simply(a, w->force[i], scale);
    w->scale[i] *= scale;
}

/* So that most numbers that the hinges left become one: all equations, then rows and columns of unknowns that are no
 * angles. */
static void scale_beside_hinges(algebra *a, const linear_system *s, arranged *w) {
    const int n = s->n;
    const double common = 1.0 / w->inverse[0];
    for (int h = 0; h < w->hinges; h++) {
        w->inverse[h] = scale_number(w->inverse[h], common);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n && !w->gone[i]; j++) {
            if (!w->gone[j]) {
                w->mass[i * n + j] = scale_simply(a, w->mass[i * n + j], common);
            }
        }
        if (!w->gone[i]) {
            w->force[i] = scale_simply(a, w->force[i], common);
        }
    }
    for (int i = 0; i < n; i++) {
        if (w->gone[i] || s->turning[i]) {
            continue;
        }
        tally row = {.count = 0};
        for (int h = 0; h < w->hinges; h++) {
            tally_add(&row, w->across[h * (n + 1) + i]);
        }
        tally_add(&row, w->force[i]);
        for (int j = 0; j < n; j++) {
            if (j != i) {
                tally_add(&row, w->mass[i * n + j]);
            }
        }
        scale_unknown(a, w, i, 1.0 / tally_favourite(&row));
    }
}

bool arrange(algebra *a, const linear_system *s, const arrangement *how, arranged *w) {
    const int n = s->n;
    *w = arranged_room(n);
    scale_all(a, s, how, w);
    if (how->hinged && !eliminate_hinged(a, s, how, w)) {
        return false;
    }
    for (int i = 0; i < n && how->first != -1; i++) {
        const int k = how->order[i];
        if ((how->first == -2 || how->first == k) &&
            eliminate_symbolic(a, n, w->mass, w->force, w->gone, k)) {
            put_away(w, k);
        }
    }
    if (how->hinged && how->rescaled) {
        scale_beside_hinges(a, s, w);
    } else if (how->rescaled && w->eliminated > 0) {
        scale_what_is_left(a, n, w->mass, w->force, w->gone);
    }
    if (s->sparing) {
        forget_unwanted(a, s, w->mass, w->force, w->order, w->eliminated);
    }
    int entered = w->eliminated;
    for (int i = 0; i < n; i++) {
        if (!w->gone[how->order[i]]) {
            w->order[entered++] = how->order[i];
        }
    }
    return true;
}
