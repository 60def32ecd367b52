#include "dual.h"

void dual_zero(enclosure *to, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_of(0.0);
    }
}

void dual_add(enclosure *to, const enclosure *a, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_add(to[j], a[j]);
    }
}

void dual_take_from(enclosure *to, const enclosure *a, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_sub(a[j], to[j]);
    }
}

/* to += a b; zeros are skipped */
static void add_product(enclosure *to, enclosure a, enclosure b) {
    if (!enclosure_is_zero(a) && !enclosure_is_zero(b)) {
        *to = enclosure_add(*to, enclosure_mul(a, b));
    }
}

void dual_add_multiple(enclosure *to, enclosure number, const enclosure *a, int width) {
    for (int j = 0; j < width; j++) {
        add_product(&to[j], number, a[j]);
    }
}

void dual_add_product(enclosure *to, const enclosure *a, const enclosure *b, int width) {
    const enclosure x = a[0];
    const enclosure y = b[0];
    add_product(&to[0], x, y);
    for (int j = 1; j < width; j++) {
        add_product(&to[j], a[j], y);
        add_product(&to[j], x, b[j]);
    }
}

void dual_add_products(enclosure *to, enclosure number, const enclosure *a, const enclosure *b,
                       int width) {
    const enclosure x = enclosure_mul(number, a[0]);
    const enclosure y = enclosure_mul(number, b[0]);
    add_product(&to[0], x, b[0]);
    for (int j = 1; j < width; j++) {
        add_product(&to[j], a[j], y);
        add_product(&to[j], x, b[j]);
    }
}

void dual_scale(enclosure *to, enclosure number, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_mul(to[j], number);
    }
}

/* (u / v)' = (u' - (u / v) v') / v */
void dual_divide(enclosure *to, const enclosure *a, int width) {
    const enclosure by = a[0];
    to[0] = enclosure_div(to[0], by);
    for (int j = 1; j < width; j++) {
        to[j] = enclosure_div(enclosure_sub(to[j], enclosure_mul(to[0], a[j])), by);
    }
}

void dual_chain(enclosure *to, enclosure slope, const enclosure *a, int width) {
    for (int j = 1; j < width; j++) {
        to[j] = enclosure_mul(slope, a[j]);
    }
}
