/* hinge.c: the part of a mass that its hinge can push.
 *
 * A body on a hinge, q its angle: its row of the equations is
 *
 *     A q'' + sum_j P_j x_j = f,        P_j = Re(z_j exp(i c q)),    f = Re(w exp(i c q)) + rest
 *
 * with z_j and w that q is not part of. Gauss's elimination leaves -P_i P_j / A beside the others' m_ij, where all
 * stands that the body does to them. With the quadratures P~_j = Im(z_j exp(i c q)),
 *
 *     P_i P_j = Re(z_i conj(z_j)) - P~_i P~_j
 *
 * and the first part, in which q is no longer, comes together with m_ij in the normal form. What is left of the body is
 * what it is seen as from the hinge: a mass along the rod. So it is with the forces, where the rod's pull is one
 * factor for all. A P~ is minus the derivative of P by q, over c. */
#include "hinge.h"

#include <math.h>

static const poly *bend(algebra *a, const poly *p, const symbol *q) {
    return poly_derivative(a, poly_derivative(a, p, q, 0), q, 0);
}

/* c^2 where p'' = -c^2 p and p is not zero; else 0. */
static double frequency_squared(algebra *a, const poly *p, const symbol *q) {
    const poly *bent = bend(a, p, q);
    if (poly_is_zero(p) || bent->count != p->count) {
        return 0.0;
    }
    const double squared = -bent->terms[0].coefficient / p->terms[0].coefficient;
    const poly *rest = poly_add(a, bent, poly_scale(a, p, squared));
    return squared > 0.0 && poly_is_zero(rest) ? squared : 0.0;
}

typedef struct wave_of {
    const poly *here;   /* Re(z exp(i c q)) */
    const poly *across; /* Im */
} wave_of;

static wave_of wave_make(algebra *a, const poly *p, const symbol *q, double c) {
    return (wave_of){p, poly_scale(a, poly_derivative(a, p, q, 0), -1.0 / c)};
}

/* Re(z_x conj(z_y)) */
static const poly *without_turn(algebra *a, wave_of x, wave_of y) {
    return poly_add(a, poly_mul(a, x.here, y.here), poly_mul(a, x.across, y.across));
}

/* The frequency that all entries of row k share, or 0. */
static double shared_frequency(algebra *a, int n, const poly *const *mass, const bool *gone, int k,
                               const symbol *q) {
    double squared = 0.0;
    for (int j = 0; j < n; j++) {
        const poly *entry = mass[k * n + j];
        if (j == k || gone[j] || poly_is_zero(entry)) {
            continue;
        }
        const double own = frequency_squared(a, entry, q);
        if (own == 0.0 || (squared != 0.0 && fabs(own - squared) > 1e-12 * squared)) {
            return 0.0;
        }
        squared = own;
    }
    return number_root(squared);
}

/* What the turning's own rate pulls with: the others' forces have g across_i q'^2, with one g for all. Takes it out
 * of them; g. */
static double take_pull(algebra *a, int n, const poly **force, const poly *const *across,
                        const poly *rate_squared) {
    double g = 0.0;
    for (int i = 0; i < n; i++) {
        if (poly_is_zero(across[i])) {
            continue;
        }
        const poly *one = poly_mul(a, across[i], rate_squared);
        double own = 0.0;
        for (int t = 0; t < force[i]->count && one->count > 0; t++) {
            if (force[i]->terms[t].mono == one->terms[0].mono) {
                own = force[i]->terms[t].coefficient / one->terms[0].coefficient;
            }
        }
        const poly *rest = poly_sub(a, force[i], poly_scale(a, one, own));
        if (own == 0.0 || rest->count > force[i]->count - one->count ||
            (g != 0.0 && fabs(own - g) > 1e-12 * fabs(g))) {
            return 0.0;
        }
        g = own;
    }
    for (int i = 0; i < n; i++) {
        const poly *one = poly_mul(a, across[i], rate_squared);
        force[i] = poly_sub(a, force[i], poly_scale(a, one, g));
    }
    return g;
}

bool hinge_eliminate(algebra *a, int n, const poly **mass, const poly **force, const bool *gone,
                     int k, const symbol *turning, double *own, const poly **across) {
    if (!poly_is_number(mass[k * n + k], own) || *own <= 0.0) {
        return false;
    }
    const double c = shared_frequency(a, n, mass, gone, k, turning);
    if (c == 0.0) {
        return false;
    }
    const poly *waving = poly_scale(a, bend(a, force[k], turning), -1.0 / (c * c));
    const poly *still = poly_sub(a, force[k], waving);
    if (poly_contains(still, turning, 0)) {
        return false;
    }
    const wave_of pull = wave_make(a, waving, turning, c);
    for (int i = 0; i < n; i++) {
        const bool left = i != k && !gone[i];
        across[i] = left ? wave_make(a, mass[k * n + i], turning, c).across : poly_number(a, 0.0);
    }
    const poly *rate = poly_symbol(a, turning, 1);
    const poly *rate_squared = poly_mul(a, rate, rate);
    const double g = take_pull(a, n, force, across, rate_squared);
    across[n] = poly_add(a, pull.across, poly_scale(a, rate_squared, g * *own));
    for (int i = 0; i < n; i++) {
        if (i == k || gone[i]) {
            continue;
        }
        const wave_of beside = {mass[k * n + i], across[i]};
        for (int j = 0; j < n; j++) {
            const wave_of above = {mass[k * n + j], across[j]};
            if (j != k && !gone[j]) {
                const poly *taken = poly_scale(a, without_turn(a, beside, above), 1.0 / *own);
                mass[i * n + j] = poly_sub(a, mass[i * n + j], taken);
            }
        }
        const poly *taken = without_turn(a, beside, pull);
        taken = poly_add(a, taken, poly_mul(a, beside.here, still));
        force[i] = poly_sub(a, force[i], poly_scale(a, taken, 1.0 / *own));
    }
    return true;
}
