/* careful_thomson.c: naive_thomson.c with libm's sine and cosine of two angles only. The addition theorems give the others. */
#include <math.h>

#include "naive_sines.h"

#define NAME "careful_thomson"

static void sines_of(double a, double b, sines *s) {
    s->sin_a = sin(a);
    s->cos_a = cos(a);
    s->sin_b = sin(b);
    s->cos_b = cos(b);
    s->sin_2a = 2.0 * s->sin_a * s->cos_a;
    s->cos_2a = 2.0 * s->cos_a * s->cos_a - 1.0;
    s->sin_a_b = s->sin_a * s->cos_b - s->cos_a * s->sin_b;
    s->cos_a_b = s->cos_a * s->cos_b + s->sin_a * s->sin_b;
    s->sin_2a_b = s->sin_2a * s->cos_b - s->cos_2a * s->sin_b;
    s->cos_2a_b = s->cos_2a * s->cos_b + s->sin_2a * s->sin_b;
}

#include "naive_thomson.h"
