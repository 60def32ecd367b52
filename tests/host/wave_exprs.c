/* wave_exprs.c: random expressions of sines, and bounds on their errors. The bounds follow from documented values:
 * the sine's worst error, the phase unit, and one rounding for each operation (docs/dev/numerics.md). */
#include "wave_exprs.h"

#include "derived.h"

static const char *const names[WAVE_SYMBOLS] = {"a", "b", "c", "u"};

static const struct {
    const char *text;
    long double over, under;
} forms[] = {
    {"%s", 1, 1},           {"2*%s", 2, 1},       {"-%s", -1, 1},          {"3*%s", 3, 1},
    {"%s/2", 1, 2},         {"-%s/2", -1, 2},     {"3*%s/2", 3, 2},        {"%s/3", 1, 3},
    {"-4*%s/3", -4, 3},     {"%s*(2/3)", 2, 3},   {"1.5*%s", 3, 2},        {"12.25*%s", 49, 4},
    {"%s/7", 1, 7},         {"0.37*%s", 37, 100}, {"-2.71*%s", -271, 100}, {"%s/1000", 1, 1000},
    {"100.1*%s", 1001, 10}, {"sqrt(2)*%s", 0, 1}, {"pi*%s", 0, 2}};
enum { FORMS = sizeof forms / sizeof forms[0], FORM_ROOT = FORMS - 2, FORM_PI };

static int any(uint64_t *seed, int count) { return (int)(random_bits(seed) % (unsigned)count); }

static wave_argument make_argument(uint64_t *seed) {
    wave_argument made = {.pieces = 1 + any(seed, WAVE_PIECES)};
    const int first = any(seed, WAVE_SYMBOLS);
    for (int i = 0; i < made.pieces; i++) { /* draws each symbol once */
        wave_piece *p = &made.piece[i];
        p->symbol = (first + i) % WAVE_SYMBOLS;
        p->form = any(seed, FORMS);
        p->number = p->form == FORM_ROOT ? sqrtl(2.0L)
                    : p->form == FORM_PI ? acosl(-1.0L)
                                         : forms[p->form].over / forms[p->form].under;
    }
    made.offset_rad = any(seed, 3) == 0 ? floor(random_between(seed, -400.0, 400.0)) / 128.0 : 0.0;
    return made;
}

static wave_factor make_factor(uint64_t *seed) {
    wave_factor made = {.argument = make_argument(seed), .product = -1};
    made.function = any(seed, 5) == 0 ? WAVE_TAN : any(seed, 2) == 0 ? WAVE_SIN : WAVE_COS;
    made.has_inner = any(seed, 6) == 0;
    made.inner = make_argument(seed);
    if (any(seed, 8) == 0) {
        made.product = any(seed, WAVE_ANGLES);
    }
    return made;
}

static size_t print_argument(char *at, const wave_argument *of) {
    char *start = at;
    for (int i = 0; i < of->pieces; i++) {
        char piece[64];
        char form[32];
        snprintf(form, sizeof form, "%s", forms[of->piece[i].form].text);
        char *hole = strstr(form, "%s");
        *hole = '\0';
        snprintf(piece, sizeof piece, "%s%s%s", form, names[of->piece[i].symbol], hole + 2);
        at += sprintf(at, "%s(%s)", i > 0 ? " + " : "", piece);
    }
    if (of->offset_rad != 0.0) {
        at += sprintf(at, " + (%.9g)", of->offset_rad);
    }
    return (size_t)(at - start);
}

static void print(wave_expr *e) {
    static const char *const functions[] = {"sin", "cos", "tan"};
    char *at = e->text;
    for (int i = 0; i < e->terms; i++) {
        const wave_term *t = &e->term[i];
        at += sprintf(at, "%s(%.9g)", i > 0 ? " + " : "", t->size);
        for (int k = 0; k < t->factors; k++) {
            const wave_factor *f = &t->factor[k];
            at += sprintf(at, "*%s(", functions[f->function]);
            at += print_argument(at, &f->argument);
            if (f->has_inner) {
                at += sprintf(at, " + 0.3*sin(");
                at += print_argument(at, &f->inner);
                at += sprintf(at, ")");
            }
            if (f->product >= 0) {
                at += sprintf(at, " + u*%s/100", names[f->product]);
            }
            at += sprintf(at, ")");
        }
        if (t->divided) {
            at += sprintf(at, "/(2 + cos(");
            at += print_argument(at, &t->below);
            at += sprintf(at, "))");
        }
        if (t->outside >= 0) {
            at += sprintf(at, "*%s", names[t->outside]);
        }
    }
}

wave_expr wave_expr_make(uint64_t *seed) {
    wave_expr e = {.terms = 1 + any(seed, WAVE_TERMS)};
    for (int i = 0; i < e.terms; i++) {
        wave_term *t = &e.term[i];
        t->size = floor(random_between(seed, -4.0, 4.0) * 64.0) / 64.0 + 1.0 / 128.0;
        t->factors = 1 + any(seed, WAVE_FACTORS);
        for (int k = 0; k < t->factors; k++) {
            t->factor[k] = make_factor(seed);
        }
        t->divided = any(seed, 6) == 0;
        t->below = make_argument(seed);
        t->outside = any(seed, 8) == 0 ? any(seed, WAVE_SYMBOLS) : -1;
    }
    print(&e);
    return e;
}

wave_expr wave_expr_plain(uint64_t *seed) {
    wave_expr e = {.terms = 1};
    e.term[0] = (wave_term){.size = 1.0, .factors = 1, .outside = -1};
    wave_factor *f = &e.term[0].factor[0];
    *f = (wave_factor){.function = any(seed, 2) == 0 ? WAVE_SIN : WAVE_COS, .product = -1};
    do {
        f->argument = make_argument(seed);
    } while (f->argument.piece[0].symbol >= WAVE_ANGLES);
    f->argument.pieces = 1;
    f->argument.offset_rad = 0.0;
    print(&e);
    return e;
}

typedef struct arithmetic {
    long double unit;      /* relative error of a rounding */
    long double sine;      /* worst error of a sine */
    long double phase_rad; /* rounding of a phase; 0 for numbers in radians */
} arithmetic;

static const arithmetic in_float = {0x1p-24L, 6.3e-8L, 1.463e-9L};
static const arithmetic in_double = {0x1p-53L, 1.4e-16L, 0.0L};

/* An argument and its error bound, and whether its sine may be computed from other sines. */
typedef struct reckoned {
    long double value;
    long double error;
    long double size;
    long double beside; /* error of the angles whose sines may give this sine */
    /* the argument contains a fraction of a turn angle, so its sine is not computed from other sines */
    bool evaluated;
} reckoned;

static reckoned reckon(const wave_argument *of, const long double *state, const arithmetic *in) {
    reckoned r = {.value = (long double)of->offset_rad, .error = in->phase_rad};
    long double added = fabsl(r.value);
    for (int i = 0; i < of->pieces; i++) {
        const wave_piece *p = &of->piece[i];
        const long double part = p->number * state[p->symbol];
        const bool turns = p->symbol < WAVE_ANGLES;
        r.value += part;
        r.size += fabsl(p->number) * (turns ? 1.0L : 3.0L);
        r.evaluated = r.evaluated || (turns && p->number != rintl(p->number));
        if (turns && in->phase_rad > 0.0L) {
            /* one unit for the product with any integer, whose error is up to 0.75 units; the number is a double */
            r.error += in->phase_rad + 0x1p-53L * fabsl(part);
        } else {
            added += fabsl(part);
        }
    }
    r.error += 4.0L * in->unit * added;
    /* sin(3 u) may come from u + b and 2 u - b: in double, both have the round-off of a large b */
    for (int i = 0; i < WAVE_SYMBOLS; i++) {
        r.beside += in->phase_rad > 0.0L ? in->phase_rad : 4.0L * in->unit * fabsl(state[i]);
    }
    return r;
}

/* Error of a sine of r or, if `multiplied`, of r plus the angle of another factor. If the sine is computed from
 * other sines, errors add up, and become four times larger with each doubling of an angle. */
static long double sine_error(const reckoned *r, const arithmetic *in, bool multiplied) {
    const bool evaluated = r->evaluated && !multiplied;
    const long double growth = evaluated ? 1.0L : (1.0L + r->size) * (1.0L + r->size);
    return growth * (in->sine + in->unit) + r->error * (evaluated ? 1.0L : 2.0L) +
           (evaluated ? 0.0L : (1.0L + r->size) * r->beside);
}

typedef struct share {
    long double value;
    long double most; /* the largest size of the argument in any form */
    long double error;
} share;

static share factor_share(const wave_factor *f, const long double *state, const arithmetic *in,
                          const reckoned *beside) {
    reckoned r = reckon(&f->argument, state, in);
    if (f->has_inner) {
        const reckoned inner = reckon(&f->inner, state, in);
        r.value += 0.3L * sinl(inner.value);
        r.error += 0.3L * sine_error(&inner, in, false) + in->phase_rad + in->unit;
    }
    if (f->product >= 0) { /* in radians, round-off is relative to the size of the product */
        const long double product = state[WAVE_ANGLES] * state[f->product] / 100.0L;
        r.value += product;
        r.error += 6.0L * in->unit * fabsl(product) + in->phase_rad;
    }
    const bool multiplied = beside != NULL && f->function != WAVE_TAN;
    if (multiplied) { /* the operation list makes a product of sines a sum of sines */
        r.error += beside->error;
        r.size += beside->size;
    }
    const long double error = sine_error(&r, in, multiplied);
    if (f->function != WAVE_TAN) {
        return (share){f->function == WAVE_SIN ? sinl(r.value) : cosl(r.value), 1.0L, error};
    }
    const long double t = tanl(r.value);
    const long double slope = 1.0L + t * t;
    return (share){t, fabsl(t), 1.5L * slope * error + 2.0L * in->unit * fabsl(t)};
}

static share term_share(const wave_term *t, const long double *state, const arithmetic *in) {
    share all = {(long double)t->size, fabsl((long double)t->size), 0.0L};
    for (int k = 0; k < t->factors; k++) {
        reckoned beside = {0};
        const wave_factor *other = t->factors > 1 ? &t->factor[1 - k] : NULL;
        if (other != NULL) {
            beside = reckon(&other->argument, state, in);
            beside.error += other->has_inner ? 0.3L * in->sine : 0.0L;
        }
        const bool joined = other != NULL && other->function != WAVE_TAN;
        const share one = factor_share(&t->factor[k], state, in, joined ? &beside : NULL);
        all.error = all.error * one.most + one.error * all.most;
        all.value *= one.value;
        all.most *= one.most;
    }
    if (t->divided) {
        const reckoned below = reckon(&t->below, state, in);
        const long double d = 2.0L + cosl(below.value);
        const long double error = sine_error(&below, in, false) + 2.0L * in->unit;
        all.error = all.error / d + all.most * error / (d * d);
        all.value /= d;
        all.most /= d;
    }
    if (t->outside >= 0) {
        all.error *= fabsl(state[t->outside]);
        all.value *= state[t->outside];
        all.most *= fabsl(state[t->outside]);
    }
    all.error += 8.0L * in->unit * all.most;
    return all;
}

wave_value wave_expr_value(const wave_expr *e, const long double *state, bool is_float) {
    const arithmetic *in = is_float ? &in_float : &in_double;
    wave_value sum = {0};
    for (int i = 0; i < e->terms; i++) {
        const share one = term_share(&e->term[i], state, in);
        sum.value += one.value;
        sum.scale += one.most;
        sum.bound += one.error + 2.0L * in->unit * one.most;
    }
    return sum;
}
