/* show_term.c: one product for readers: names, numbers, functions, fractions. */
#include "show_term.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/lang/lexer.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

/* --- names and numbers ---------------------------------------------------------------------------*/

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

/* The name's letters, then the rest as an index: theta1 -> \theta_{1}, no_load -> \mathrm{no}_{\mathrm{load}}. */
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

/* value = top / bottom with small whole numbers? */
bool show_as_fraction(double value, double *top, double *bottom) {
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
    char text[40];
    int digits = 15;
    do { /* the fewest digits that give the number back */
        snprintf(text, sizeof text, "%.*g", digits, value);
        digits++;
    } while (decimal_read(text, NULL) != value && digits <= 17);
    char *e = strchr(text, 'e');
    if (e != NULL && s->style == SHOW_LATEX) {
        *e = '\0';
        fprintf(s->out, "%s \\cdot 10^{%d}", text, (int)strtol(e + 1, NULL, 10));
        return;
    }
    fputs(text, s->out);
}

/* --- factors -------------------------------------------------------------------------------------*/

static void show_open(const show *s) { fputs(s->style == SHOW_LATEX ? "\\left(" : "(", s->out); }
static void show_close(const show *s) { fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out); }

static void show_exponent(const show *s, double exponent);

static bool has_power_before(function_id f) {
    static const function_id of[] = {FN_SIN, FN_COS, FN_TAN, FN_SINH, FN_COSH, FN_TANH};
    bool found = false;
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        found = found || f == of[i];
    }
    return found;
}

/* One symbol, which needs no parentheses in LaTeX. */
static bool is_symbol(const poly *p) {
    return p != NULL && p->count == 1 && p->terms[0].coefficient == 1.0 &&
           p->terms[0].mono->trig == TRIG_NONE && p->terms[0].mono->count == 1 &&
           p->terms[0].mono->factors[0].exponent == 1.0 &&
           p->terms[0].mono->factors[0].atom->kind == ATOM_SYMBOL;
}

/* A call with its exponent: sin(x)^2, \sin^{2} x. */
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
    const poly *rest;
    const symbol *let = show_let(s, p, true, &rest, &ratio);
    if (let != NULL && ratio == 1.0) {
        show_symbol(s, let, 0);
        return;
    }
    show_open(s);
    show_poly(s, p);
    show_close(s);
}

/* A name, a whole number, one call: what takes an exponent without parentheses. */
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

/* base^exponent, both expressions. In text `^` binds from the right: what is not a primary stands in
 * parentheses on either side. LaTeX takes one superscript on a base: braces keep those of primes and
 * dots inside. */
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

enum { RANKS = 4 + PRIMES_MAX }; /* of show_rank() */

/* What a factor is, for the order in which a product is written. */
int show_rank(const atom *x) {
    if (x->kind != ATOM_SYMBOL) {
        return 3;
    }
    switch (x->symbol->kind) {
    case SYM_PARAMETER: return 0;
    case SYM_INPUT: return 1;
    case SYM_COORDINATE:
    case SYM_STATE: return x->primes == 0 ? 2 : 3 + x->primes; /* sines stand at 3 */
    case SYM_LET:                                              /* expressions: no atoms */
    case SYM_OUTPUT:
    case SYM_RECORD: break;
    }
    return 2;
}

void show_separate(const show *s, bool *first) {
    if (!*first) {
        fputs(s->style == SHOW_LATEX ? " \\, " : "*", s->out);
    }
    *first = false;
}

/* The factors of one side of the fraction bar: +1 above, -1 below. */
void show_factors(const show *outer, const piece *p, int side, bool *first) {
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
        for (int wave = 0; wave < 2 && rank == 3 && side > 0; wave++) {
            const int exponent = wave == 0 ? p->sines : p->cosines;
            if (exponent > 0) {
                show_separate(s, first);
                show_call(s, wave == 0 ? FN_SIN : FN_COS, p->angle, NULL, exponent);
            }
        }
    }
}

int show_count_below(const piece *p) {
    int count = 0;
    for (int i = 0; i < p->mono->count; i++) {
        count += p->mono->factors[i].exponent < 0.0;
    }
    return count;
}

/* |coefficient| times the factors: 2*m*r*sin(a)/3. A lone number is written, a factor 1 is not. */
void show_product(const show *s, const piece *p, double size) {
    double top;
    double bottom;
    show_as_fraction(size, &top, &bottom);
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
    if (!bar) {
        return;
    }
    const bool many = below + (bottom != 1.0) > 1;
    fputs(s->style == SHOW_LATEX ? "}{" : many ? "/(" : "/", s->out);
    first = true;
    if (bottom != 1.0) {
        show_separate(s, &first);
        show_number(s, bottom);
    }
    show_factors(s, p, -1, &first);
    fputs(s->style == SHOW_LATEX ? "}" : many ? ")" : "", s->out);
}
