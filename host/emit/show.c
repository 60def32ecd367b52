/* show.c: polys for readers. */
#include "show.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/derive/pieces.h"

/* --- names and numbers ---------------------------------------------------------------------------*/

static bool is_greek(const char *name, size_t length) {
    static const char *const greek[] = {
        "alpha", "beta", "gamma", "delta", "epsilon", "zeta",  "eta",   "theta", "iota",  "kappa",
        "lambda", "mu",  "nu",    "xi",    "rho",     "sigma", "tau",   "phi",   "chi",   "psi",
        "omega", "Gamma", "Delta", "Theta", "Lambda", "Xi",    "Sigma", "Phi",   "Psi",   "Omega"};
    for (size_t i = 0; i < sizeof greek / sizeof greek[0]; i++) {
        if (strlen(greek[i]) == length && strncmp(greek[i], name, length) == 0) {
            return true;
        }
    }
    return false;
}

/* The name's letters, then what stands behind them as an index: theta1 -> \theta_{1}. */
static void latex_name(FILE *out, const char *name, int primes) {
    size_t stem = 0;
    while (isalpha((unsigned char)name[stem])) {
        stem++;
    }
    stem = stem == 0 ? strlen(name) : stem;
    const char *rest = name + stem + (name[stem] == '_' ? 1 : 0);
    fprintf(out, "%s", primes == 1 ? "\\dot{" : primes == 2 ? "\\ddot{" : primes > 2 ? "{" : "");
    if (is_greek(name, stem)) {
        fprintf(out, "\\%.*s", (int)stem, name);
    } else {
        fprintf(out, stem == 1 ? "%.*s" : "\\mathrm{%.*s}", (int)stem, name);
    }
    fprintf(out, "%s", primes > 0 ? "}" : "");
    if (*rest != '\0') {
        fprintf(out, "_{");
        for (; *rest != '\0'; rest++) {
            fprintf(out, *rest == '_' ? "\\_" : "%c", *rest);
        }
        fprintf(out, "}");
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
    fputs(sym->name, s->out);
    for (int i = 0; i < primes; i++) {
        fputc('\'', s->out);
    }
}

/* value = top / bottom with small whole numbers? */
static bool as_fraction(double value, double *top, double *bottom) {
    for (int whole = 1; whole <= 360; whole++) {
        const double q = whole;
        const double p = floor(value * q + 0.5);
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

static void show_number(const show *s, double value) {
    char text[40];
    int digits = 15;
    do { /* the fewest digits that give the number back */
        snprintf(text, sizeof text, "%.*g", digits, value);
        digits++;
    } while (strtod(text, NULL) != value && digits <= 17);
    char *e = strchr(text, 'e');
    if (e != NULL && s->style == SHOW_LATEX) {
        *e = '\0';
        fprintf(s->out, "%s \\cdot 10^{%d}", text, (int)strtol(e + 1, NULL, 10));
        return;
    }
    fputs(text, s->out);
}

/* --- factors -------------------------------------------------------------------------------------*/

static void show_call(const show *s, const char *name, const poly *x, const poly *y) {
    static const char *const own[] = {"sin", "cos", "tan", "exp", "min", "max"};
    bool has_own = false;
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        has_own = has_own || strcmp(name, own[i]) == 0;
    }
    if (s->style == SHOW_LATEX) {
        fprintf(s->out, has_own ? "\\%s\\left(" : "\\operatorname{%s}\\left(", name);
    } else {
        fprintf(s->out, "%s(", name);
    }
    show_poly(s, x);
    if (y != NULL) {
        fputs(", ", s->out);
        show_poly(s, y);
    }
    fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out);
}

static void show_grouped(const show *s, const poly *p) {
    fputs(s->style == SHOW_LATEX ? "\\left(" : "(", s->out);
    show_poly(s, p);
    fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out);
}

static void show_exponent(const show *s, double exponent) {
    double top;
    double bottom;
    if (exponent == 1.0) {
        return;
    }
    fputs(s->style == SHOW_LATEX ? "^{" : "^", s->out);
    if (as_fraction(exponent, &top, &bottom) && bottom != 1.0) {
        fprintf(s->out, s->style == SHOW_LATEX ? "%g/%g" : "(%g/%g)", top, bottom);
    } else {
        show_number(s, exponent);
    }
    fputs(s->style == SHOW_LATEX ? "}" : "", s->out);
}

static void show_atom(const show *s, const atom *x, double exponent) {
    static const char *const names[FN_COUNT] = {
        "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt",
        "exp", "log", "abs", "sign", "min",  "max"};
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
    switch (x->kind) {
    case ATOM_SYMBOL:
        if (x->primes > 0 && exponent != 1.0 && s->style == SHOW_LATEX) {
            fputs("{", s->out);
        }
        show_symbol(s, x->symbol, x->primes);
        if (x->primes > 0 && exponent != 1.0 && s->style == SHOW_LATEX) {
            fputs("}", s->out);
        }
        break;
    case ATOM_CALL: show_call(s, names[x->function], x->argument[0], x->argument[1]); break;
    case ATOM_GROUP: show_grouped(s, x->argument[0]); break;
    case ATOM_POWER:
        show_grouped(s, x->argument[0]);
        fputs("^", s->out);
        show_grouped(s, x->argument[1]);
        break;
    }
    show_exponent(s, exponent);
}

/* What a factor is, for the order in which a product is written. */
static int rank_of(const atom *x) {
    if (x->kind != ATOM_SYMBOL) {
        return 3;
    }
    switch (x->symbol->kind) {
    case SYM_PARAMETER: return 0;
    case SYM_INPUT: return 1;
    default: return x->primes == 0 ? 2 : 3 + x->primes; /* sines stand at 3 */
    }
}

static void separate(const show *s, bool *first) {
    if (!*first) {
        fputs(s->style == SHOW_LATEX ? " \\, " : "*", s->out);
    }
    *first = false;
}

/* The factors of one side of the fraction bar: +1 above, -1 below. Returns how many there are. */
static int show_factors(const show *s, const piece *p, int side, bool *first) {
    int count = 0;
    for (int rank = 0; rank < 16; rank++) {
        for (int i = 0; i < p->mono->count; i++) {
            const factor *f = &p->mono->factors[i];
            if (rank_of(f->atom) == rank && (f->exponent > 0.0) == (side > 0)) {
                separate(s, first);
                show_atom(s, f->atom, fabs(f->exponent));
                count++;
            }
        }
        if (rank == 3 && side > 0 && p->trig != TRIG_NONE) {
            separate(s, first);
            show_call(s, p->trig == TRIG_SIN ? "sin" : "cos", p->angle, NULL);
            show_exponent(s, p->squared ? 2.0 : 1.0);
            count++;
        }
    }
    return count;
}

static int count_below(const piece *p) {
    int count = 0;
    for (int i = 0; i < p->mono->count; i++) {
        count += p->mono->factors[i].exponent < 0.0;
    }
    return count;
}

/* |coefficient| times the factors: 2*m*r*sin(a)/3. A lone number is written, a factor 1 is not. */
static void show_product(const show *s, const piece *p, double size) {
    double top;
    double bottom;
    as_fraction(size, &top, &bottom);
    const int below = count_below(p);
    const bool bar = bottom != 1.0 || below > 0;
    if (bar && s->style == SHOW_LATEX) {
        fputs("\\frac{", s->out);
    }
    bool first = true;
    const bool has_factors = p->mono->count > below || p->trig != TRIG_NONE;
    if (top != 1.0 || !has_factors) {
        separate(s, &first);
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
        separate(s, &first);
        show_number(s, bottom);
    }
    show_factors(s, p, -1, &first);
    fputs(s->style == SHOW_LATEX ? "}" : many ? ")" : "", s->out);
}

/* --- sums ----------------------------------------------------------------------------------------*/

static void show_sign(const show *s, bool negative, bool first) {
    if (first) {
        fputs(negative ? "-" : "", s->out);
    } else {
        fputs(negative ? " - " : " + ", s->out);
    }
}

static void show_sum(const show *s, const poly *p) {
    piece *pieces = calloc((size_t)p->count + 1, sizeof *pieces);
    if (pieces == NULL) {
        abort();
    }
    const int count = pieces_of(s->algebra, p, pieces);
    for (int i = 0; i < count; i++) {
        show_sign(s, pieces[i].coefficient < 0.0, i == 0);
        show_product(s, &pieces[i], fabs(pieces[i].coefficient));
    }
    free(pieces);
}

/* A number that all coefficients are small whole multiples of, or 1. */
static double common_number(const piece *pieces, int count) {
    double smallest = (double)INFINITY;
    for (int i = 0; i < count; i++) {
        smallest = fmin(smallest, fabs(pieces[i].coefficient));
    }
    for (int i = 0; i < count; i++) {
        const double ratio = fabs(pieces[i].coefficient) / smallest;
        if (fabs(ratio - floor(ratio + 0.5)) > 1e-12 * ratio || ratio > 100.0) {
            return 1.0;
        }
    }
    return smallest;
}

/* The factors that every term has, as a term of its own. */
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

/* The parameter that most terms contain, if at least two do. */
static const atom *shared_parameter(const poly *p) {
    const atom *best = NULL;
    int best_uses = 1;
    for (int i = 0; i < p->count; i++) {
        for (int k = 0; k < p->terms[i].mono->count; k++) {
            const atom *x = p->terms[i].mono->factors[k].atom;
            int uses = 0;
            for (int j = 0; j < p->count && rank_of(x) == 0; j++) {
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

static void show_group(const show *s, const poly *p, const poly *key, bool leading);

/* A sum without rates and without a factor common to all: K1*(X - L1) + K2*(...). */
static void show_parted(const show *s, const poly *p, bool leading) {
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
                with = poly_add(a, with,
                                poly_of_term(a, p->terms[i].coefficient, p->terms[i].mono));
            }
        }
    }
    const poly *without = poly_sub(a, p, with);
    if (!poly_is_zero(without)) {
        show_group(s, with, one, leading);
        show_group(s, without, one, false);
        return;
    }
    if (!leading) {
        fputs(" + ", s->out);
    }
    show_sum(s, p); /* every term has it, in powers of different signs */
}

/* sign and size * common * (inside) * key / below, each part left out where it is one. */
static void show_group(const show *s, const poly *p, const poly *key, bool leading) {
    algebra *a = s->algebra;
    piece *pieces = calloc((size_t)p->count + 1, sizeof *pieces);
    if (pieces == NULL) {
        abort();
    }
    const int count = pieces_of(a, p, pieces);
    const double number = common_number(pieces, count);
    bool negative = true;
    for (int i = 0; i < count; i++) {
        negative = negative && pieces[i].coefficient < 0.0;
    }
    if (count == 1) { /* a single product: write it with its key */
        const poly *whole = poly_mul(a, p, key);
        if (pieces_of(a, whole, pieces) == 1) {
            show_sign(s, pieces[0].coefficient < 0.0, leading);
            show_product(s, &pieces[0], fabs(pieces[0].coefficient));
            free(pieces);
            return;
        }
    }
    free(pieces);
    const poly *common = show_common(a, p);
    const mono *outside = common->terms[0].mono;
    const bool bare = key->terms[0].mono->count == 0;
    if (bare && outside->count == 0 && number == 1.0 && !negative) {
        show_parted(s, p, leading);
        return;
    }
    const poly *inside = poly_mul(a, p, poly_pow(a, common, -1.0));
    inside = poly_scale(a, inside, (negative ? -1.0 : 1.0) / number);
    double top;
    double bottom;
    as_fraction(number, &top, &bottom);
    show_sign(s, negative, leading);
    const piece front = {top, outside, TRIG_NONE, NULL, false};
    bool first = true;
    if (top != 1.0) {
        separate(s, &first);
        show_number(s, top);
    }
    show_factors(s, &front, 1, &first);
    separate(s, &first);
    fputs(s->style == SHOW_LATEX ? "\\left(" : "(", s->out);
    show_sum(s, inside);
    fputs(s->style == SHOW_LATEX ? "\\right)" : ")", s->out);
    if (!bare) {
        separate(s, &first);
        const piece behind = {1.0, key->terms[0].mono, TRIG_NONE, NULL, false};
        show_product(s, &behind, 1.0);
    }
    const int below = count_below(&front) + (bottom != 1.0);
    if (below > 0) {
        fputs(below > 1 ? "/(" : "/", s->out);
        first = true;
        if (bottom != 1.0) {
            separate(s, &first);
            show_number(s, bottom);
        }
        show_factors(s, &front, -1, &first);
        fputs(below > 1 ? ")" : "", s->out);
    }
}

/* The rates and accelerations of a term: what its coefficient is collected by. */
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

int show_size(const poly *p) { return p->count; }

void show_poly(const show *s, const poly *p) {
    algebra *a = s->algebra;
    if (poly_is_zero(p)) {
        fputs("0", s->out);
        return;
    }
    const poly **keys = calloc((size_t)p->count, sizeof *keys);
    int *highest = calloc((size_t)p->count, sizeof *highest);
    if (keys == NULL || highest == NULL) {
        abort();
    }
    for (int i = 0; i < p->count; i++) {
        keys[i] = motion_of(a, p->terms[i].mono, &highest[i]);
    }
    bool leading = true;
    for (int rank = 9; rank >= 0; rank--) {
        for (int i = 0; i < p->count; i++) {
            if (keys[i] == NULL || highest[i] != rank) {
                continue;
            }
            const poly *key = keys[i];
            const poly *group = poly_number(a, 0.0);
            for (int j = i; j < p->count; j++) {
                if (keys[j] == key) {
                    const poly *t = poly_of_term(a, p->terms[j].coefficient, p->terms[j].mono);
                    group = poly_add(a, group, poly_mul(a, t, poly_pow(a, key, -1.0)));
                    keys[j] = NULL;
                }
            }
            show_group(s, group, key, leading);
            leading = false;
        }
    }
    free(keys);
    free(highest);
}
