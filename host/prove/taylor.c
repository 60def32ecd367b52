/* taylor.c: recurrences of Taylor coefficients. Coefficient k of a node is computed from coefficients 0 to k of
 * its operands u and v, and from its own coefficients 0 to k - 1. */
#include "host/prove/taylor.h"

#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/enclosure.h"

/* === enclosures with derivatives ============================================================== */
/* An array of `width` enclosures: entry 0 is the value, and the others, if any, are its derivatives by the states. */

static void dual_zero(enclosure *to, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_of(0.0);
    }
}

/* to += a */
static void dual_add(enclosure *to, const enclosure *a, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_add(to[j], a[j]);
    }
}

/* to = a - to */
static void dual_take_from(enclosure *to, const enclosure *a, int width) {
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

/* The value: to += x b. The derivatives: to += x b + y a. */
static void add_products(enclosure *to, enclosure x, const enclosure *b, enclosure y,
                         const enclosure *a, int width) {
    add_product(&to[0], x, b[0]);
    for (int j = 1; j < width; j++) {
        add_product(&to[j], a[j], y);
        add_product(&to[j], x, b[j]);
    }
}

/* to += a b */
static void dual_add_product(enclosure *to, const enclosure *a, const enclosure *b, int width) {
    add_products(to, a[0], b, b[0], a, width);
}

/* to += number a b */
static void dual_add_products(enclosure *to, enclosure number, const enclosure *a,
                              const enclosure *b, int width) {
    add_products(to, enclosure_mul(number, a[0]), b, enclosure_mul(number, b[0]), a, width);
}

static void dual_scale(enclosure *to, enclosure number, int width) {
    for (int j = 0; j < width; j++) {
        to[j] = enclosure_mul(to[j], number);
    }
}

/* to /= a: (u / v)' = (u' - (u / v) v') / v */
static void dual_divide(enclosure *to, const enclosure *a, int width) {
    const enclosure by = a[0];
    to[0] = enclosure_div(to[0], by);
    for (int j = 1; j < width; j++) {
        to[j] = enclosure_div(enclosure_sub(to[j], enclosure_mul(to[0], a[j])), by);
    }
}

/* The chain rule: `slope` is the derivative of a function by a[0]. */
static void dual_chain(enclosure *to, enclosure slope, const enclosure *a, int width) {
    for (int j = 1; j < width; j++) {
        to[j] = enclosure_mul(slope, a[j]);
    }
}

/* === Taylor coefficients ====================================================================== */

taylor *taylor_new(const exact_motion *m, int order, int slopes_to) {
    taylor *t = alloc(1, sizeof *t);
    t->motion = m;
    t->order = order;
    t->slopes_to = slopes_to;
    t->width = slopes_to >= 0 ? 1 + m->states : 1;
    t->value = alloc((int64_t)m->nodes * (order + 1) * t->width, sizeof *t->value);
    return t;
}

void taylor_free(taylor *t) {
    if (t != NULL) {
        free(t->value);
        free(t);
    }
}

static enclosure *at(const taylor *t, int which, int k) {
    return &t->value[((int64_t)which * (t->order + 1) + k) * t->width];
}

const enclosure *taylor_of(const taylor *t, int i, int k) { return at(t, i, k); }

static enclosure whole(int value) { return enclosure_of((double)value); }

/* The number of enclosures in coefficient k of a node: the value and its derivatives. */
static int width_of(const taylor *t, int k) { return k <= t->slopes_to ? t->width : 1; }

/* to = sum of u_j v_(k-j) */
static void product(const taylor *t, const node *n, int k, enclosure *to) {
    for (int j = 0; j <= k; j++) {
        dual_add_product(to, at(t, n->left, j), at(t, n->right, k - j), width_of(t, k));
    }
}

static void square(const taylor *t, const node *n, int k, enclosure *to) {
    const int width = width_of(t, k);
    for (int j = 0; 2 * j < k; j++) {
        dual_add_products(to, whole(2), at(t, n->left, j), at(t, n->left, k - j), width_of(t, k));
    }
    if (k % 2 == 0) {
        const enclosure *middle = at(t, n->left, k / 2);
        to[0] = enclosure_add(to[0], enclosure_square(middle[0]));
        for (int j = 1; j < width; j++) {
            const enclosure slope = enclosure_mul(enclosure_mul(whole(2), middle[0]), middle[j]);
            to[j] = enclosure_add(to[j], slope);
        }
    }
}

/* w v = u: v_0 w_k = u_k - sum of w_j v_(k-j) over j < k */
static void ratio(const taylor *t, const node *n, int self, int k, enclosure *to) {
    for (int j = 0; j < k; j++) {
        dual_add_product(to, at(t, self, j), at(t, n->right, k - j), width_of(t, k));
    }
    dual_take_from(to, at(t, n->left, k), width_of(t, k));
    dual_divide(to, at(t, n->right, 0), width_of(t, k));
}

/* s' = u' c, c' = -u' s: k s_k = sum of j u_j c_(k-j), and -k c_k = sum of j u_j s_(k-j). */
static void waves(const taylor *t, const node *n, int self, int k) {
    enclosure *sine = at(t, self - 1, k);
    enclosure *cosine = at(t, self, k);
    const enclosure *u = at(t, n->left, 0);
    if (k == 0) {
        sine[0] = enclosure_sine(u[0]);
        cosine[0] = enclosure_cosine(u[0]);
        dual_chain(sine, cosine[0], u, width_of(t, k));
        dual_chain(cosine, enclosure_neg(sine[0]), u, width_of(t, k));
        return;
    }
    dual_zero(sine, width_of(t, k));
    for (int j = 1; j <= k; j++) {
        const enclosure *slope = at(t, n->left, j);
        dual_add_products(sine, whole(j), slope, at(t, self, k - j), width_of(t, k));
        dual_add_products(cosine, whole(-j), slope, at(t, self - 1, k - j), width_of(t, k));
    }
    const enclosure part = enclosure_div(whole(1), whole(k));
    dual_scale(sine, part, width_of(t, k));
    dual_scale(cosine, part, width_of(t, k));
}

/* e' = u' e */
static void exponential(const taylor *t, const node *n, int self, int k, enclosure *to) {
    if (k == 0) {
        to[0] = enclosure_exp(at(t, n->left, 0)[0]);
        dual_chain(to, to[0], at(t, n->left, 0), width_of(t, k));
        return;
    }
    for (int j = 1; j <= k; j++) {
        dual_add_products(to, whole(j), at(t, n->left, j), at(t, self, k - j), width_of(t, k));
    }
    dual_scale(to, enclosure_div(whole(1), whole(k)), width_of(t, k));
}

/* l' u = u': k u_0 l_k = k u_k - sum of j l_j u_(k-j) over 0 < j < k */
static void logarithm(const taylor *t, const node *n, int self, int k, enclosure *to) {
    const enclosure *u = at(t, n->left, 0);
    if (k == 0) {
        to[0] = enclosure_log(u[0]);
        dual_chain(to, enclosure_div(whole(1), u[0]), u, width_of(t, k));
        return;
    }
    for (int j = 1; j < k; j++) {
        dual_add_products(to, whole(-j), at(t, self, j), at(t, n->left, k - j), width_of(t, k));
    }
    dual_scale(to, enclosure_div(whole(1), whole(k)), width_of(t, k));
    dual_add(to, at(t, n->left, k), width_of(t, k));
    dual_divide(to, u, width_of(t, k));
}

/* w = u^a: k u_0 w_k = sum of (a (k - j) - j) w_j u_(k-j) over j < k */
static void power(const taylor *t, const node *n, int self, int k, enclosure *to) {
    const enclosure *u = at(t, n->left, 0);
    if (k == 0) {
        to[0] = enclosure_power(u[0], n->number);
        dual_chain(to, enclosure_mul(n->number, enclosure_div(to[0], u[0])), u, width_of(t, k));
        return;
    }
    for (int j = 0; j < k; j++) {
        const enclosure factor = enclosure_sub(enclosure_mul(n->number, whole(k - j)), whole(j));
        dual_add_products(to, factor, at(t, self, j), at(t, n->left, k - j), width_of(t, k));
    }
    dual_scale(to, enclosure_div(whole(1), whole(k)), width_of(t, k));
    dual_divide(to, u, width_of(t, k));
}

/* x_k = (x')_(k-1) / k */
static void variable(const taylor *t, const node *n, int k, enclosure *to) {
    if (k > 0) {
        dual_add(to, at(t, t->motion->rate[n->left], k - 1), width_of(t, k));
        for (int j = 0; j < width_of(t, k); j++) {
            to[j] = enclosure_div(to[j], whole(k));
        }
    }
}

static void find(const taylor *t, int self, int k) {
    const node *n = &t->motion->node[self];
    enclosure *to = at(t, self, k);
    if (n->kind == NODE_SINE || (n->kind == NODE_VARIABLE && k == 0)) {
        return; /* taylor_find() sets a variable's start; waves() computes a sine with its cosine */
    }
    dual_zero(to, width_of(t, k));
    switch (n->kind) {
    case NODE_NUMBER: to[0] = k == 0 ? n->number : enclosure_of(0.0); break;
    case NODE_VARIABLE: variable(t, n, k, to); break;
    case NODE_SUM:
        dual_add(to, at(t, n->left, k), width_of(t, k));
        dual_add(to, at(t, n->right, k), width_of(t, k));
        break;
    case NODE_DIFFERENCE:
        dual_add(to, at(t, n->right, k), width_of(t, k));
        dual_take_from(to, at(t, n->left, k), width_of(t, k));
        break;
    case NODE_PRODUCT: product(t, n, k, to); break;
    case NODE_MULTIPLE:
        for (int j = 0; j < width_of(t, k); j++) {
            add_product(&to[j], n->number, at(t, n->left, k)[j]);
        }
        break;
    case NODE_SQUARE: square(t, n, k, to); break;
    case NODE_RATIO: ratio(t, n, self, k, to); break;
    case NODE_SINE: break;
    case NODE_COSINE: waves(t, n, self, k); break;
    case NODE_EXP: exponential(t, n, self, k, to); break;
    case NODE_LOG: logarithm(t, n, self, k, to); break;
    case NODE_POWER: power(t, n, self, k, to); break;
    }
}

bool taylor_find(taylor *t, const enclosure *x) {
    for (int i = 0; i < t->motion->states; i++) {
        enclosure *to = at(t, i, 0);
        dual_zero(to, t->width);
        to[0] = x[i];
        if (t->width > 1) {
            to[1 + i] = enclosure_of(1.0);
        }
    }
    for (int k = 0; k <= t->order; k++) {
        for (int i = 0; i < t->motion->nodes; i++) {
            find(t, i, k);
        }
    }
    const int64_t count = (int64_t)t->motion->nodes * (t->order + 1) * t->width;
    bool finite = true;
    for (int64_t i = 0; i < count && finite; i++) {
        finite = enclosure_is_finite(t->value[i]);
    }
    return finite;
}

/* The number of products in a node's coefficients 0 .. order: coefficient k has k + 1 products. */
static double products_to(int order) { return 0.5 * (double)(order + 1) * (double)(order + 2); }

double taylor_products(const taylor *t) {
    double sums = 0.0;
    for (int i = 0; i < t->motion->nodes; i++) {
        const node_kind kind = t->motion->node[i].kind;
        const bool is_sum = kind == NODE_NUMBER || kind == NODE_VARIABLE || kind == NODE_SUM ||
                            kind == NODE_DIFFERENCE || kind == NODE_MULTIPLE;
        sums += is_sum ? 0.0 : 1.0;
    }
    return sums * (products_to(t->order) +
                   2.0 * (double)(t->width - 1) * (t->width > 1 ? products_to(t->slopes_to) : 0.0));
}
