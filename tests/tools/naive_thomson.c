/* naive_thomson.c: Thomson's device with libm's sine and cosine of every angle that occurs. */
#include <math.h>

#include "naive_sines.h"

#define NAME "naive_thomson"

static void sines_of(double a, double b, sines *s) {
    s->sin_a = sin(a);
    s->cos_a = cos(a);
    s->sin_b = sin(b);
    s->cos_b = cos(b);
    s->sin_2a = sin(2.0 * a);
    s->cos_2a = cos(2.0 * a);
    s->sin_a_b = sin(a - b);
    s->cos_a_b = cos(a - b);
    s->sin_2a_b = sin(2.0 * a - b);
    s->cos_2a_b = cos(2.0 * a - b);
}

#include "naive_thomson.h"
