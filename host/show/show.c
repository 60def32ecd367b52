/* show.c: printing of polys: it collects terms by rates and accelerations, and factors them. */
#include "host/show/show.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/lexer.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

/* Would a name be shorter than p? */
static bool shortens(const poly *p) {
    double number;
    const mono *m = p->count == 1 ? p->terms[0].mono : NULL;
    return !poly_is_number(p, &number) &&
           (m == NULL ||
            (m->trig == TRIG_NONE && (m->count > 1 || m->factors[0].atom->kind != ATOM_SYMBOL)));
}

void show_lets_begin(show *s, const equations *e) {
    const mechanism *m = e->instance->mechanism;
    s->lets = alloc_tail(sizeof *s->lets, m->let_count, sizeof s->lets->row[0]);
    for (int i = 0; i < m->let_count; i++) {
        const symbol *let = m->lets[i];
        const poly *value =
            instance_has(e->instance, let->effect) ? poly_from_expr(s->algebra, let->value) : NULL;
        if (value != NULL && !algebra_overflow(s->algebra) && shortens(value)) {
            s->lets->row[s->lets->count++] = (let_row){let, value, false};
        }
    }
    s->lets->below = s->lets->count;
}

/* Sets *ratio so that p contains all terms of value * ratio. Returns false if no ratio does. */
static bool is_part(const poly *p, const poly *value, double *ratio) {
    int at = 0;
    for (int i = 0; i < value->count; i++) {
        while (at < p->count && p->terms[at].mono != value->terms[i].mono) {
            at++;
        }
        if (at == p->count) {
            return false;
        }
        const double here = p->terms[at].coefficient / value->terms[i].coefficient;
        *ratio = i == 0 ? here : *ratio;
        if (fabs(here - *ratio) > 1e-13 * fabs(here)) {
            return false;
        }
    }
    return true;
}

static const let_row *show_let(const show *s, const poly *p, bool whole, double *ratio) {
    let_row *best = NULL;
    for (int i = 0; s->lets != NULL && i < s->lets->below; i++) {
        let_row *r = &s->lets->row[i];
        double here = 1.0;
        if (r->value->count <= p->count && (r->value->count > 1 || whole) &&
            (!whole || r->value->count == p->count) &&
            (best == NULL || r->value->count > best->value->count) && is_part(p, r->value, &here)) {
            best = r;
            *ratio = here;
        }
    }
    if (best != NULL) {
        best->used = true;
    }
    return best;
}

static const symbol *show_let_factor(const show *s, const atom *x, double exponent) {
    for (int i = 0; s->lets != NULL && i < s->lets->below; i++) {
        let_row *r = &s->lets->row[i];
        const poly_term *t = &r->value->terms[0];
        if (r->value->count == 1 && t->coefficient == 1.0 && t->mono->count == 1 &&
            t->mono->factors[0].atom == x && t->mono->factors[0].exponent == exponent) {
            r->used = true;
            return r->let;
        }
    }
    return NULL;
}

/* === polys ==================================================================================== */

static bool is_greek(const char *name, size_t length) {
    static const char *const greek[] = {
        "alpha",  "beta",  "gamma", "delta", "epsilon", "zeta",  "eta",   "theta", "iota", "kappa",
        "lambda", "mu",    "nu",    "xi",    "rho",     "sigma", "tau",   "phi",   "chi",  "psi",
        "omega",  "Gamma", "Delta", "Theta", "Lambda",  "Xi",    "Sigma", "Phi",   "Psi",  "Omega"};
    for (size_t i = 0; i < sizeof greek / sizeof greek[0]; i++) {
        if (strlen(greek[i]) == length && strncmp(greek[i], name, length) == 0) {
            return true;
        }
    }
    return false;
}

static void latex_letters(FILE *out, const char *text) {
    for (; *text != '\0'; text++) {
        fprintf(out, *text == '_' ? "\\_" : "%c", *text);
    }
}

/* The part after the letters is an index: theta1 -> \theta_{1}, no_load -> \mathrm{no}_{\mathrm{load}}. */
static void latex_name(FILE *out, const char *name, int primes) {
    size_t stem = 0;
    while (isalpha((unsigned char)name[stem])) {
        stem++;
    }
    const bool index = name[stem] == '_' && name[stem + 1] != '\0';
    const char *rest = stem == 0 ? "" : name + stem + (index ? 1 : 0);
    fprintf(out, "%s", primes == 1 ? "\\dot{" : primes == 2 ? "\\ddot{" : primes > 2 ? "{" : "");
    if (stem == 0) {
        fprintf(out, "\\mathrm{");
        latex_letters(out, name);
        fprintf(out, "}");
    } else if (is_greek(name, stem)) {
        fprintf(out, "\\%.*s", (int)stem, name);
    } else {
        fprintf(out, stem == 1 ? "%.*s" : "\\mathrm{%.*s}", (int)stem, name);
    }
    fprintf(out, "%s", primes > 0 ? "}" : "");
    if (*rest != '\0') {
        const bool word = isalpha((unsigned char)rest[0]) && isalpha((unsigned char)rest[1]);
        fprintf(out, word ? "_{\\mathrm{" : "_{");
        latex_letters(out, rest);
        fprintf(out, word ? "}}" : "}");
    }
    if (primes > 2) {
        fprintf(out, "^{(%d)}", primes);
    }
}

void show_symbol(const show *s, const symbol *sym, int primes) {
    if (s->style == SHOW_LATEX) {
        latex_name(s->out, sym->name, primes);
        return;
    }
    if (s->name != NULL) {
        fputs(s->name(s->names, sym, primes), s->out);
        return;
    }
    fputs(sym->name, s->out);
    for (int i = 0; i < primes; i++) {
        fputc('\'', s->out);
    }
}

/* value = top / bottom with small whole numbers; if impossible, top is the value and bottom is 1. */
static bool show_as_fraction(double value, double *top, double *bottom) {
    for (int whole = 1; whole <= 360; whole++) {
        const double q = whole;
        const double p = number_floor(value * q + 0.5);
        if (fabs(value * q - p) <= 1e-13 * fabs(value * q) && fabs(p) < 1e9 && p != 0.0) {
            *top = p;
            *bottom = q;
            return true;
        }
    }
    *top = value;
    *bottom = 1.0;
    return false;
}

void show_number(const show *s, double value) {
    char text[NUMBER_SIZE];
    char *e = strchr(number_shortest(value, text), 'e');
    if (e != NULL && s->style == SHOW_LATEX) {
        *e = '\0';
        fprintf(s->out, "%s \\cdot 10^{%d}", text, (int)strtol(e + 1, NULL, 10));
        return;
    }
    fputs(text, s->out);
}

static void show_open(const show *s) { fputs(s->style == SHOW_LATEX ? "\\left(" : "(", s->out); }
static void show_close(const show *s) { fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out); }

static void show_exponent(const show *s, double exponent);

static bool has_power_before(function_id f) {
    return f == FN_SIN || f == FN_COS || f == FN_TAN || f == FN_SINH || f == FN_COSH ||
           f == FN_TANH;
}

/* LaTeX needs no parentheses around a symbol. */
static bool is_symbol(const poly *p) {
    return p != NULL && p->count == 1 && p->terms[0].coefficient == 1.0 &&
           p->terms[0].mono->trig == TRIG_NONE && p->terms[0].mono->count == 1 &&
           p->terms[0].mono->factors[0].exponent == 1.0 &&
           p->terms[0].mono->factors[0].atom->kind == ATOM_SYMBOL;
}

/* Prints a call with its exponent: sin(x)^2, \sin^{2} x. */
static void show_call(const show *s, function_id function, const poly *x, const poly *y,
                      double exponent) {
    const bool latex = s->style == SHOW_LATEX;
    const bool before = latex && has_power_before(function);
    fputs(latex ? function_latex(function) : function_name(function), s->out);
    if (before) {
        show_exponent(s, exponent);
    }
    if (before && is_symbol(x) && !s->bracketed) {
        fputs(" ", s->out);
        show_poly(s, x);
        return;
    }
    show_open(s);
    show_poly(s, x);
    if (y != NULL) {
        fputs(", ", s->out);
        show_poly(s, y);
    }
    show_close(s);
    if (!before) {
        show_exponent(s, exponent);
    }
}

void show_grouped(const show *s, const poly *p) {
    double ratio;
    const let_row *named = show_let(s, p, true, &ratio);
    if (named != NULL && ratio == 1.0) {
        show_symbol(s, named->let, 0);
        return;
    }
    show_open(s);
    show_poly(s, p);
    show_close(s);
}

/* A name, a whole number or a call needs no parentheses before an exponent. */
static bool is_primary(const poly *p) {
    double value;
    if (poly_is_number(p, &value)) {
        return value >= 0.0 && value < 1e5 && value == number_floor(value);
    }
    const mono *m = p->terms[0].mono;
    if (p->count > 1 || p->terms[0].coefficient != 1.0) {
        return false;
    }
    if (m->trig != TRIG_NONE) {
        return m->count == 0;
    }
    return m->count == 1 && m->factors[0].exponent == 1.0 &&
           (m->factors[0].atom->kind == ATOM_SYMBOL || m->factors[0].atom->kind == ATOM_CALL);
}

/* Prints base^exponent. In text, a side that is not primary gets parentheses, because `^` binds from the right. In
 * LaTeX, a base with primes gets braces, because a base has only one superscript. */
static void show_power(const show *s, const poly *base, const poly *exponent) {
    const bool latex = s->style == SHOW_LATEX;
    if (is_primary(base)) {
        const mono *m = base->count == 0 ? NULL : base->terms[0].mono;
        const bool dotted = latex && m != NULL && m->count == 1 && m->factors[0].atom->primes > 0;
        fputs(dotted ? "{" : "", s->out);
        show_poly(s, base);
        fputs(dotted ? "}" : "", s->out);
    } else {
        show_grouped(s, base);
    }
    fputs(latex ? "^{" : "^", s->out);
    if (latex || is_primary(exponent)) {
        show_poly(s, exponent);
    } else {
        show_grouped(s, exponent);
    }
    fputs(latex ? "}" : "", s->out);
}

static void show_exponent(const show *s, double exponent) {
    double top;
    double bottom;
    if (exponent == 1.0) {
        return;
    }
    fputs(s->style == SHOW_LATEX ? "^{" : "^", s->out);
    if (show_as_fraction(exponent, &top, &bottom) && bottom != 1.0) {
        fputs(s->style == SHOW_LATEX ? "" : "(", s->out);
        show_number(s, top);
        fputs("/", s->out);
        show_number(s, bottom);
        fputs(s->style == SHOW_LATEX ? "" : ")", s->out);
    } else {
        show_number(s, exponent);
    }
    fputs(s->style == SHOW_LATEX ? "}" : "", s->out);
}

static void show_atom(const show *s, const atom *x, double exponent) {
    const symbol *let = show_let_factor(s, x, exponent);
    if (let != NULL) {
        show_symbol(s, let, 0);
        return;
    }
    if (exponent == 0.5) {
        fputs(s->style == SHOW_LATEX ? "\\sqrt{" : "sqrt(", s->out);
        if (x->kind == ATOM_GROUP) {
            show_poly(s, x->argument[0]);
        } else {
            show_atom(s, x, 1.0);
        }
        fputs(s->style == SHOW_LATEX ? "}" : ")", s->out);
        return;
    }
    const bool raised = exponent != 1.0;
    bool braced = false;
    switch (x->kind) {
    case ATOM_SYMBOL:
        braced = raised && x->primes > 0 && s->style == SHOW_LATEX;
        fputs(braced ? "{" : "", s->out);
        show_symbol(s, x->symbol, x->primes);
        fputs(braced ? "}" : "", s->out);
        break;
    case ATOM_CALL: show_call(s, x->function, x->argument[0], x->argument[1], exponent); return;
    case ATOM_GROUP: show_grouped(s, x->argument[0]); break;
    case ATOM_POWER:
        if (raised) {
            show_open(s);
        }
        show_power(s, x->argument[0], x->argument[1]);
        if (raised) {
            show_close(s);
        }
        break;
    }
    show_exponent(s, exponent);
}

enum { RANKS = 4 + PRIMES_MAX }; /* number of results of show_rank() */

/* Order of factors in a product: 0 parameters, 1 inputs, 2 coordinates, then the others. */
static int show_rank(const atom *x) {
    if (x->kind != ATOM_SYMBOL) {
        return 3;
    }
    switch (x->symbol->kind) {
    case SYM_PARAMETER: return 0;
    case SYM_INPUT: return 1;
    case SYM_COORDINATE:
    case SYM_STATE: return x->primes == 0 ? 2 : 3 + x->primes; /* sines have rank 3 */
    case SYM_LET:                                              /* expressions, not atoms */
    case SYM_OUTPUT:
    case SYM_RECORD: break;
    }
    return 2;
}

void show_times(const show *s) { fputs(s->style == SHOW_LATEX ? " \\, " : "*", s->out); }

static void show_separate(const show *s, bool *first) {
    if (!*first) {
        show_times(s);
    }
    *first = false;
}

/* Prints the factors above (side 1) or below (-1) the fraction bar. */
static void show_factors(const show *outer, const piece *p, int side, bool *first) {
    show inner = *outer;
    const show *s = &inner;
    for (int i = 0; i < p->mono->count; i++) {
        const atom_kind kind = p->mono->factors[i].atom->kind;
        inner.bracketed = inner.bracketed || kind == ATOM_GROUP || kind == ATOM_POWER;
    }
    for (int rank = 0; rank < RANKS; rank++) {
        for (int i = 0; i < p->mono->count; i++) {
            const mono_factor *f = &p->mono->factors[i];
            if (show_rank(f->atom) == rank && (f->exponent > 0.0) == (side > 0)) {
                show_separate(s, first);
                show_atom(s, f->atom, fabs(f->exponent));
            }
        }
        for (int function = 0; function < 2 && rank == 3 && side > 0; function++) {
            const int exponent = function == 0 ? p->sines : p->cosines;
            if (exponent > 0) {
                show_separate(s, first);
                show_call(s, function == 0 ? FN_SIN : FN_COS, p->angle, NULL, exponent);
            }
        }
    }
}

static int show_count_below(const piece *p) {
    int count = 0;
    for (int i = 0; i < p->mono->count; i++) {
        count += p->mono->factors[i].exponent < 0.0;
    }
    return count;
}

/* Prints the fraction bar, and number and factors below it. */
static void show_below(const show *s, const piece *p, double bottom) {
    const bool many = show_count_below(p) + (bottom != 1.0) > 1;
    bool first = true;
    fputs(s->style == SHOW_LATEX ? "}{" : many ? "/(" : "/", s->out);
    if (bottom != 1.0) {
        show_separate(s, &first);
        show_number(s, bottom);
    }
    show_factors(s, p, -1, &first);
    fputs(s->style == SHOW_LATEX ? "}" : many ? ")" : "", s->out);
}

/* Prints a product such as 2*m*r*sin(a)/3, without the sign. */
static void show_product(const show *s, const piece *p) {
    double top;
    double bottom;
    show_as_fraction(fabs(p->coefficient), &top, &bottom);
    const int below = show_count_below(p);
    const bool bar = bottom != 1.0 || below > 0;
    if (bar && s->style == SHOW_LATEX) {
        fputs("\\frac{", s->out);
    }
    bool first = true;
    const bool has_factors = p->mono->count > below || p->angle != NULL;
    if (top != 1.0 || !has_factors) {
        show_separate(s, &first);
        show_number(s, top);
    }
    show_factors(s, p, 1, &first);
    if (bar) {
        show_below(s, p, bottom);
    }
}

/* === sums ===================================================================================== */

show show_start(FILE *out, show_style style, algebra *a) {
    return (show){.out = out, .style = style, .algebra = a};
}

static void show_sign(const show *s, bool negative, bool first) {
    if (first) {
        fputs(negative ? "-" : "", s->out);
    } else {
        fputs(negative ? " - " : " + ", s->out);
    }
}

/* The factor sin(angle)^sines * cos(angle)^cosines; 1 if angle is NULL. */
typedef struct wave {
    const poly *angle;
    int sines;
    int cosines;
} wave;

static wave common_wave(algebra *a, const poly *p) {
    piece *pieces = alloc(p->count, sizeof *pieces);
    const int count = pieces_of(a, p, pieces);
    wave common = {pieces[0].angle, pieces[0].sines, pieces[0].cosines};
    for (int i = 1; i < count; i++) {
        const piece *each = &pieces[i];
        if (each->angle != common.angle) {
            common = (wave){NULL, 0, 0};
        }
        common.sines = each->sines < common.sines ? each->sines : common.sines;
        common.cosines = each->cosines < common.cosines ? each->cosines : common.cosines;
    }
    free(pieces);
    return common.sines + common.cosines > 0 ? common : (wave){NULL, 0, 0};
}

static void show_named(const show *s, const symbol *let, double ratio, bool leading) {
    show_sign(s, ratio < 0.0, leading);
    double top;
    double bottom;
    show_as_fraction(fabs(ratio), &top, &bottom);
    const mono none = {0};
    const piece number = {ratio, &none, NULL, 0, 0};
    if (top != 1.0 || bottom != 1.0) {
        show_product(s, &number);
        show_times(s);
    }
    show_symbol(s, let, 0);
}

/* Prints lets for terms of *p, and removes these terms from *p. Returns false if no term remains. */
static bool show_let_parts(const show *s, const poly **p, bool *leading) {
    algebra *a = s->algebra;
    double ratio;
    const let_row *named;
    while ((named = show_let(s, *p, false, &ratio)) != NULL) {
        show_named(s, named->let, ratio, *leading);
        *leading = false;
        *p = poly_sub(a, *p, poly_scale(a, named->value, ratio));
    }
    return !poly_is_zero(*p);
}

/* Prints the terms of p, without the common factor `without`. */
static void show_sum(const show *s, const poly *p, wave without, bool leading) {
    if (without.angle == NULL && !show_let_parts(s, &p, &leading)) {
        return;
    }
    piece *pieces = alloc(p->count, sizeof *pieces);
    const int count = pieces_of(s->algebra, p, pieces);
    for (int i = 0; i < count; i++) {
        pieces[i].sines -= without.sines;
        pieces[i].cosines -= without.cosines;
        pieces[i].angle = pieces[i].sines + pieces[i].cosines > 0 ? pieces[i].angle : NULL;
        show_sign(s, pieces[i].coefficient < 0.0, leading && i == 0);
        show_product(s, &pieces[i]);
    }
    free(pieces);
}

/* Returns the smallest coefficient if dividing the others by it yields whole numbers up to 100; else 1. */
static double common_multiple(const piece *pieces, int count) {
    double smallest = (double)INFINITY;
    for (int i = 0; i < count; i++) {
        smallest = number_least(smallest, fabs(pieces[i].coefficient));
    }
    for (int i = 0; i < count; i++) {
        const double ratio = fabs(pieces[i].coefficient) / smallest;
        if (fabs(ratio - number_floor(ratio + 0.5)) > 1e-12 * ratio || ratio > 100.0) {
            return 1.0;
        }
    }
    return smallest;
}

static double common_divisor(double a, double b) {
    while (b != 0.0) {
        const double rest = number_remainder(a, b);
        a = b;
        b = rest;
    }
    return a;
}

double show_common_number(const piece *pieces, int count, bool whole) {
    double tops = 0.0;
    double bottoms = whole ? 1.0 : 0.0;
    for (int i = 0; i < count; i++) {
        double top;
        double bottom;
        if (!show_as_fraction(fabs(pieces[i].coefficient), &top, &bottom) || bottom > 36.0 ||
            bottoms > 1e6) {
            return common_multiple(pieces, count);
        }
        tops = common_divisor(tops, top);
        const double shared = common_divisor(bottoms, bottom);
        bottoms = whole ? bottoms / shared * bottom : shared;
    }
    return tops / bottoms;
}

const poly *show_common(algebra *a, const poly *p) {
    const poly *common = poly_number(a, 1.0);
    const mono *first = p->terms[0].mono;
    for (int k = 0; k < first->count; k++) {
        double lowest = first->factors[k].exponent;
        for (int i = 1; i < p->count; i++) {
            const mono *m = p->terms[i].mono;
            double here = 0.0;
            for (int j = 0; j < m->count; j++) {
                here = m->factors[j].atom == first->factors[k].atom ? m->factors[j].exponent : here;
            }
            lowest = (here > 0.0) == (lowest > 0.0) && here != 0.0
                         ? (fabs(here) < fabs(lowest) ? here : lowest)
                         : 0.0;
        }
        if (lowest != 0.0) {
            common = poly_mul(a, common, poly_of_atom(a, first->factors[k].atom, lowest));
        }
    }
    return common;
}

/* Returns the parameter that occurs in the most terms, at least in two; else NULL. */
static const atom *shared_parameter(const poly *p) {
    const atom *best = NULL;
    int best_uses = 1;
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < p->terms[i].mono->count; k++) {
            const atom *x = p->terms[i].mono->factors[k].atom;
            int uses = 0;
            for (int j = 0; j < p->count && show_rank(x) == 0; j++) {
                for (int m = 0; m < p->terms[j].mono->count; m++) {
                    uses += p->terms[j].mono->factors[m].atom == x;
                }
            }
            if (uses > best_uses) {
                best = x;
                best_uses = uses;
            }
        }
    }
    return best;
}

static bool has_symbols_only(const poly *p) {
    bool only = true;
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < p->terms[i].mono->count; k++) {
            const mono_factor *f = &p->terms[i].mono->factors[k];
            only = only && f->atom->kind == ATOM_SYMBOL && f->exponent > 0.0;
        }
    }
    return only && shared_parameter(p) != NULL;
}

static void show_group(const show *s, const poly *p, const poly *key, bool leading);

/* Prints p with shared parameters factored out: K1*(X - L1) + K2*(...). */
static void show_parted(const show *s, const poly *p, bool leading) {
    if (!show_let_parts(s, &p, &leading)) {
        return;
    }
    const atom *shared = shared_parameter(p);
    algebra *a = s->algebra;
    const poly *one = poly_number(a, 1.0);
    if (shared == NULL) {
        for (int i = 0; i < p->count; i++) {
            const poly *t = poly_of_term(a, p->terms[i].coefficient, p->terms[i].mono);
            show_group(s, t, one, leading && i == 0);
        }
        return;
    }
    const poly *with = poly_number(a, 0.0);
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < p->terms[i].mono->count; k++) {
            if (p->terms[i].mono->factors[k].atom == shared) {
                with =
                    poly_add(a, with, poly_of_term(a, p->terms[i].coefficient, p->terms[i].mono));
            }
        }
    }
    const poly *without = poly_sub(a, p, with);
    if (!poly_is_zero(without)) {
        show_group(s, with, one, leading);
        show_group(s, without, one, false);
        return;
    }
    show_sum(s, p, (wave){NULL, 0, 0}, leading);
}

/* Prints "*key", unless the key is 1. */
static void show_behind(const show *s, const poly *key) {
    if (key->terms[0].mono->count > 0) {
        const piece behind = {1.0, key->terms[0].mono, NULL, 0, 0};
        show_times(s);
        show_product(s, &behind);
    }
}

/* Prints p * key as +-number*common*(inside)*key/below, without factors 1. */
static void show_group(const show *s, const poly *p, const poly *key, bool leading) {
    algebra *a = s->algebra;
    double ratio;
    const let_row *named = show_let(s, p, true, &ratio);
    if (named != NULL) {
        show_named(s, named->let, ratio, leading);
        show_behind(s, key);
        return;
    }
    piece *pieces = alloc(p->count, sizeof *pieces);
    const int count = pieces_of(a, p, pieces);
    const double number = show_common_number(pieces, count, false);
    bool negative = true;
    for (int i = 0; i < count; i++) {
        negative = negative && pieces[i].coefficient < 0.0;
    }
    if (count == 1) {
        const poly *whole = poly_mul(a, p, key);
        if (!algebra_overflow(a) && pieces_of(a, whole, pieces) == 1) {
            show_sign(s, pieces[0].coefficient < 0.0, leading);
            show_product(s, &pieces[0]);
            free(pieces);
            return;
        }
    }
    free(pieces);
    const poly *common = show_common(a, p);
    const poly *inside = poly_mul(a, p, poly_pow(a, common, -1.0));
    inside = poly_scale(a, inside, (negative ? -1.0 : 1.0) / number);
    if (algebra_overflow(a)) { /* no more factoring */
        show_sign(s, false, leading);
        show_grouped(s, p);
        show_behind(s, key);
        return;
    }
    const mono *outside = common->terms[0].mono;
    const wave turning = common_wave(a, inside);
    const bool plain = outside->count == 0 && number == 1.0 && turning.angle == NULL;
    if (key->terms[0].mono->count == 0 && plain && !negative) {
        show_parted(s, p, leading);
        return;
    }
    const piece front = {number, outside, turning.angle, turning.sines, turning.cosines};
    const bool latex = s->style == SHOW_LATEX;
    bool first = true;
    double top;
    double bottom;
    show_as_fraction(number, &top, &bottom);
    show_sign(s, negative, leading);
    if (latex && !plain) {
        show before = *s;
        before.bracketed = true;
        show_product(&before, &front);
        first = false;
    } else if (!plain) {
        if (top != 1.0) {
            show_separate(s, &first);
            show_number(s, top);
        }
        show_factors(s, &front, 1, &first);
    }
    show_separate(s, &first);
    if (turning.angle == NULL && show_let(s, inside, true, &ratio) != NULL) {
        show_grouped(s, inside);
    } else {
        show_open(s);
        if (turning.angle == NULL && has_symbols_only(inside)) {
            show_parted(s, inside, true);
        } else {
            show_sum(s, inside, turning, true);
        }
        show_close(s);
    }
    show_behind(s, key);
    if (!latex && show_count_below(&front) + (bottom != 1.0) > 0) {
        show_below(s, &front, bottom);
    }
}

/* Returns the product of a term's rates and accelerations. *highest: order of the highest derivative in the product. */
static const poly *motion_of(algebra *a, const mono *m, int *highest) {
    const poly *key = poly_number(a, 1.0);
    *highest = 0;
    for (int i = 0; i < m->count; i++) {
        const atom *x = m->factors[i].atom;
        if (x->kind == ATOM_SYMBOL && x->primes > 0 && m->factors[i].exponent > 0.0) {
            key = poly_mul(a, key, poly_of_atom(a, x, m->factors[i].exponent));
            *highest = x->primes > *highest ? x->primes : *highest;
        }
    }
    return key;
}

typedef struct collected {
    const poly *key;
    const poly *terms;
    int highest; /* order of the highest derivative in the key */
} collected;

static int collect(algebra *a, const poly *p, collected *groups) {
    int count = 0;
    for (int i = 0; i < p->count; i++) {
        int highest;
        int at = 0;
        const poly *key = motion_of(a, p->terms[i].mono, &highest);
        while (at < count && groups[at].key != key) {
            at++;
        }
        if (at == count) {
            groups[count++] = (collected){key, poly_number(a, 0.0), highest};
        }
        const poly *t = poly_of_term(a, p->terms[i].coefficient, p->terms[i].mono);
        groups[at].terms = poly_add(a, groups[at].terms, poly_mul(a, t, poly_pow(a, key, -1.0)));
    }
    return count;
}

void show_poly(const show *s, const poly *p) {
    algebra *a = s->algebra;
    if (poly_is_zero(p)) {
        fputs("0", s->out);
        return;
    }
    collected *groups = alloc(p->count, sizeof *groups);
    const int count = collect(a, p, groups);
    if (algebra_overflow(a)) { /* the groups are invalid: print the terms as they are */
        show_sum(s, p, (wave){NULL, 0, 0}, true);
    } else {
        bool leading = true;
        for (int rank = PRIMES_MAX; rank >= 0; rank--) {
            for (int i = 0; i < count; i++) {
                if (groups[i].highest == rank) {
                    show_group(s, groups[i].terms, groups[i].key, leading);
                    leading = false;
                }
            }
        }
    }
    free(groups);
}
