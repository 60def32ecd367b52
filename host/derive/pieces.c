/* pieces.c: half angles. */
#include "pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Coefficients that differ by less than this part count as equal: they come from the same number. */
#define SAME 1e-13

static bool same_factors(const mono *x, const mono *y) {
    return x->count == y->count &&
           memcmp(x->factors, y->factors, (size_t)x->count * sizeof(factor)) == 0;
}

static bool halves_to_whole(const poly *angle) {
    for (int i = 0; i < angle->count; i++) {
        if (fmod(angle->terms[i].coefficient, 2.0) != 0.0) {
            return false;
        }
    }
    return true;
}

int pieces_of(algebra *a, const poly *p, piece *pieces) {
    int count = 0;
    bool *used = calloc((size_t)p->count + 1, sizeof *used);
    if (used == NULL) {
        abort();
    }
    for (int i = 0; i < p->count; i++) {
        const poly_term *turning = &p->terms[i];
        if (turning->mono->trig != TRIG_COS || !halves_to_whole(turning->mono->angle)) {
            continue;
        }
        for (int j = 0; j < p->count; j++) {
            const poly_term *flat = &p->terms[j];
            if (used[j] || flat->mono->trig != TRIG_NONE ||
                !same_factors(flat->mono, turning->mono) ||
                fabs(fabs(flat->coefficient) - fabs(turning->coefficient)) >
                    SAME * fabs(flat->coefficient)) {
                continue;
            }
            const bool like = (flat->coefficient < 0.0) == (turning->coefficient < 0.0);
            pieces[count++] =
                (piece){2.0 * flat->coefficient, turning->mono, like ? TRIG_COS : TRIG_SIN,
                        poly_scale(a, turning->mono->angle, 0.5), true};
            used[i] = used[j] = true;
            break;
        }
    }
    for (int i = 0; i < p->count; i++) {
        if (!used[i]) {
            const mono *m = p->terms[i].mono;
            pieces[count++] = (piece){p->terms[i].coefficient, m, m->trig, m->angle, false};
        }
    }
    free(used);
    return count;
}
