/* op_list_scaling.c: the search for factors that reduce the errors of constants rounded to float. */
#include "host/image/op_list_scaling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/gauss.h"

/* === the possible scalings ==================================================================== */
/* A scaling multiplies each operation by a power of one factor x. The operands of a sum need equal exponents; a product
 * has the sum of its operands' exponents; a constant accepts any exponent; a result has exponent 0. The scalings are
 * the solutions of these linear equations. */

/* An exponent below this size is round-off, because exponents are small whole numbers or halves. */
#define NOTHING 1e-9

typedef struct matrix {
    double *at;
    int rows;
    int columns;
} matrix;

static matrix matrix_new(int rows, int columns) {
    return (matrix){alloc((int64_t)rows * columns + 1, sizeof(double)), rows, columns};
}

static double *row_of(const matrix *m, int row) { return m->at + (size_t)row * (size_t)m->columns; }

/* Returns the vectors v with m v = 0, as rows, and frees m. */
static matrix kernel_of(matrix m) {
    int *lead = alloc((int64_t)m.rows + 1, sizeof *lead);
    bool *leads = alloc((int64_t)m.columns + 1, sizeof *leads);
    const int rank = gauss_reduce(m.at, m.rows, m.columns, m.columns, false, NOTHING, lead);
    matrix kernel = matrix_new(m.columns - rank, m.columns);
    int made = 0;
    for (int r = 0; r < rank; r++) {
        leads[lead[r]] = true;
    }
    for (int c = 0; c < m.columns; c++) {
        if (!leads[c]) {
            row_of(&kernel, made)[c] = 1.0;
            for (int r = 0; r < rank; r++) {
                const double part = -row_of(&m, r)[c] / row_of(&m, r)[lead[r]];
                row_of(&kernel, made)[lead[r]] = fabs(part) < NOTHING ? 0.0 : part;
            }
            made++;
        }
    }
    free(lead);
    free(leads);
    free(m.at);
    return kernel;
}

static bool is_raw(const op *o) {
    switch (op_rows[o->code].kind) {
    case OP_IS_LEAF:
    case OP_IS_WAVE:
    case OP_IS_LOOKUP:
    case OP_IS_CALL: return true;
    case OP_IS_CONSTANT:
    case OP_IS_PHASE:
    case OP_IS_CELL:
    case OP_IS_UNARY:
    case OP_IS_BINARY: break;
    }
    return o->code == OP_SIGN || o->code == OP_POW;
}

/* The unknown exponents: one for each operation (columns 0 .. of->count - 1), and one for each use of a raw value. */
typedef struct unknowns {
    const op_list *of;
    int *column; /* [of->count][2] column of each raw operand, a or b; 0: none */
    int *place;  /* [columns] inverse of `column`: 2 * operation, plus 1 for operand b */
    int columns;
} unknowns;

static bool is_constant(const op_list *t, int i) { return t->ops[i].code == OP_CONSTANT; }

static int operand_of(const op *o, int which) { return which == 0 ? o->a : o->b; }

static bool absorbs(const op_list *t, const op *o) {
    return (o->code == OP_MUL || o->code == OP_DIV) &&
           (is_constant(t, o->a) || is_constant(t, o->b));
}

static unknowns unknowns_of(const op_list *t) {
    unknowns u = {t, alloc(2 * (int64_t)t->count + 1, sizeof(int)),
                  alloc(3 * (int64_t)t->count + 1, sizeof(int)), t->count};
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const bool has = !is_raw(o) && o->code != OP_CONSTANT && o->code != OP_PHASE;
        for (int which = 0; has && !absorbs(t, o) && which < op_rows[o->code].values; which++) {
            if (is_raw(&t->ops[operand_of(o, which)])) {
                u.place[u.columns] = 2 * i + which;
                u.column[2 * i + which] = u.columns++;
            }
        }
    }
    return u;
}

static int column_of(const unknowns *u, int i, int which) {
    const int column = u->column[2 * i + which];
    return column != 0 ? column : operand_of(&u->of->ops[i], which);
}

/* Adds the equation own * e(i) = a * e(operand a) + b * e(operand b) between exponents e. Constants have no term. */
static void equation(const unknowns *u, matrix *m, double own, int i, double a, double b) {
    const op *o = &u->of->ops[i];
    double *row = row_of(m, m->rows++);
    row[i] += own;
    if (a != 0.0 && !is_constant(u->of, o->a)) {
        row[column_of(u, i, 0)] -= a;
    }
    if (b != 0.0 && !is_constant(u->of, o->b)) {
        row[column_of(u, i, 1)] -= b;
    }
}

static void equations_of(const unknowns *u, int i, matrix *m) {
    const op *o = &u->of->ops[i];
    if (o->code == OP_ADD || o->code == OP_SUB || o->code == OP_MIN || o->code == OP_MAX) {
        if (!is_constant(u->of, o->a)) {
            equation(u, m, 1.0, i, 1.0, 0.0);
        }
        if (!is_constant(u->of, o->b)) {
            equation(u, m, 1.0, i, 0.0, 1.0);
        }
    } else if (o->code == OP_MUL || o->code == OP_DIV) {
        if (!absorbs(u->of, o)) {
            equation(u, m, 1.0, i, 1.0, o->code == OP_MUL ? 1.0 : -1.0);
        }
    } else if (o->code == OP_NEG || o->code == OP_ABS || o->code == OP_SQRT) {
        equation(u, m, o->code == OP_SQRT ? 2.0 : 1.0, i, 1.0, 0.0);
    } else {
        equation(u, m, 1.0, i, 0.0, 0.0); /* the value of operation i keeps the factor 1 */
    }
}

/* The rows span all vectors of exponents (op_list_scaling.h). */
static matrix all_freedoms(const unknowns *u) {
    const op_list *t = u->of;
    matrix m = matrix_new(2 * t->count + t->results, u->columns);
    m.rows = 0;
    for (int i = 0; i < t->count; i++) {
        equations_of(u, i, &m);
    }
    for (int i = 0; i < t->results; i++) {
        equation(u, &m, 1.0, t->result[i], 0.0, 0.0);
    }
    return kernel_of(m);
}

enum { PLACES = 64, SUBSETS_OF = 5 };

typedef struct chosen {
    int column[PLACES];
    int like[PLACES]; /* column of the first chosen use of the same value */
    int count;
} chosen;

static bool tells(const op_list *t, const double *e, const chosen *c) {
    bool all = true;
    bool changes = false;
    for (int k = 0; k < c->count; k++) {
        all = all && e[c->column[k]] != 0.0;
    }
    for (int i = 0; i < t->count; i++) {
        changes = changes || (e[i] != 0.0 && !absorbs(t, &t->ops[i]));
    }
    return all && changes;
}

static void normalise(double *e, int length) {
    double least = 0.0;
    for (int i = 0; i < length; i++) {
        e[i] = fabs(e[i]) < NOTHING ? 0.0 : e[i];
        if (e[i] != 0.0 && (least == 0.0 || fabs(e[i]) < fabs(least))) {
            least = e[i];
        }
    }
    for (int i = 0; i < length && least != 0.0; i++) {
        e[i] /= least;
    }
}

static void keep(op_list_freedoms *f, const unknowns *u, const double *e) {
    const int n = u->of->count;
    f->exponent = alloc_more(f->exponent, (f->count + 1) * f->length, sizeof *f->exponent);
    double *kept = f->exponent + (size_t)f->count * (size_t)f->length;
    for (int i = 0; i < f->length; i++) {
        const int column = i < n ? i : u->column[i - n];
        kept[i] = i < n || column != 0 ? e[column] : 0.0;
    }
    f->count++;
}

static matrix limits_of(const unknowns *u, const matrix *all, const chosen *c) {
    matrix m = matrix_new(u->columns, all->rows);
    m.rows = 0;
    for (int column = u->of->count; column < u->columns; column++) {
        int like = -1;
        for (int k = 0; k < c->count; k++) {
            like = c->column[k] == column ? c->like[k] : like;
        }
        for (int k = 0; k < all->rows && like != column; k++) {
            row_of(&m, m.rows)[k] =
                row_of(all, k)[column] - (like >= 0 ? row_of(all, k)[like] : 0.0);
        }
        m.rows += like != column;
    }
    return m;
}

static void add_freedoms(const unknowns *u, const matrix *all, const chosen *c,
                         op_list_freedoms *f) {
    const matrix shares = kernel_of(limits_of(u, all, c));
    double *e = alloc((int64_t)u->columns + 1, sizeof *e);
    for (int s = 0; s < shares.rows; s++) {
        for (int i = 0; i < u->columns; i++) {
            e[i] = 0.0;
            for (int k = 0; k < all->rows; k++) {
                e[i] += row_of(&shares, s)[k] * row_of(all, k)[i];
            }
        }
        normalise(e, u->columns);
        if (tells(u->of, e, c)) {
            keep(f, u, e);
        }
    }
    free(e);
    free(shares.at);
}

/* Bit k of `which` chooses use k of operation `raw`. The last bit chooses all further uses. */
static chosen choose(const unknowns *u, chosen c, int raw, unsigned which) {
    int first = -1;
    int seen = 0;
    for (int column = u->of->count; column < u->columns && c.count < PLACES; column++) {
        const int place = u->place[column];
        if (operand_of(&u->of->ops[place / 2], place % 2) == raw) {
            if ((which >> (seen < SUBSETS_OF ? seen : SUBSETS_OF - 1) & 1U) != 0) {
                first = first < 0 ? column : first;
                c.column[c.count] = column;
                c.like[c.count++] = first;
            }
            seen++;
        }
    }
    return c;
}

static int places_of(const unknowns *u, int raw) {
    return choose(u, (chosen){.count = 0}, raw, ~0U).count;
}

op_list_freedoms op_list_freedoms_of(const op_list *t) {
    op_list_freedoms f = {NULL, 0, 3 * t->count};
    const unknowns u = unknowns_of(t);
    const matrix all = all_freedoms(&u);
    const chosen none = {.count = 0};
    add_freedoms(&u, &all, &none, &f);
    for (int i = 0; i < t->count && all.rows > 0; i++) {
        const int places = is_raw(&t->ops[i]) ? places_of(&u, i) : 0;
        const unsigned subsets = 1U << (places < SUBSETS_OF ? places : SUBSETS_OF);
        for (unsigned which = 1; which < subsets; which++) {
            const chosen one = choose(&u, none, i, which);
            add_freedoms(&u, &all, &one, &f);
        }
        for (int k = 0; k < i && places > 0; k++) {
            if (is_raw(&t->ops[k]) && places_of(&u, k) > 0) {
                const chosen both = choose(&u, choose(&u, none, k, ~0U), i, ~0U);
                add_freedoms(&u, &all, &both, &f);
            }
        }
    }
    free(u.column);
    free(u.place);
    free(all.at);
    return f;
}

/* === multiplication of a list's values ======================================================== */

typedef struct multiplied {
    const op_list *from;
    const double *times; /* [3 * from->count] */
    op_list *to;
    /* [from->count] number of the operation in `to`; -1: taken() enters it again at each use */
    int *made;
} multiplied;

/* Enters a constant. A value that differs from a float only by double's round-off becomes that float. */
static int constant(op_list *t, double value) {
    const double nearest = (double)(float)value;
    return op_list_constant(t, fabs(value - nearest) <= 1e-15 * fabs(value) ? nearest : value);
}

static int taken(const multiplied *m, int i, double times) {
    const op *o = &m->from->ops[i];
    double number;
    if (o->code == OP_CONSTANT) {
        return constant(m->to, o->value * times);
    }
    if (o->code == OP_MUL && op_list_is_constant(m->from, o->a, &number)) {
        return taken(m, o->b, number * times);
    }
    const double has = is_raw(o) ? 1.0 : m->times[i];
    return op_list_mul(m->to, constant(m->to, times / has), m->made[i]);
}

static int make_phase(const multiplied *m, const op *o) {
    double *multiple = alloc(m->from->angles, sizeof *multiple);
    for (int k = 0; k < m->from->angles; k++) {
        multiple[k] = (o->turns != NULL ? o->turns[k] : 0) + (o->parts != NULL ? o->parts[k] : 0.0);
    }
    const int radians = o->b >= 0 ? taken(m, o->b, 1.0) : -1;
    const int made = op_list_phase(m->to, multiple, o->value, radians);
    free(multiple);
    return made;
}

/* The factor of an operand. Each use of a raw value has its own factor. */
static double times_of(const multiplied *m, int i, int which) {
    const op *o = &m->from->ops[i];
    const int operand = operand_of(o, which);
    return is_raw(&m->from->ops[operand]) ? m->times[m->from->count + 2 * i + which]
                                          : m->times[operand];
}

/* Enters the product or quotient i, multiplied by times[i]. Only one argument of a call may enter operations, because
 * C does not fix the order in which arguments are evaluated. */
static int make_product(const multiplied *m, int i) {
    const op *o = &m->from->ops[i];
    const double a = times_of(m, i, 0);
    const double b = times_of(m, i, 1);
    const double wanted = m->times[i];
    if (o->code == OP_DIV && m->from->ops[o->a].code == OP_CONSTANT) {
        const int below = taken(m, o->b, b);
        return op_list_div(m->to, taken(m, o->a, wanted * b), below);
    }
    const int x = taken(m, o->a, a);
    const int y = taken(m, o->b, b);
    const bool divides = o->code == OP_DIV;
    const int made = divides ? op_list_div(m->to, x, y) : op_list_mul(m->to, x, y);
    return op_list_mul(m->to, constant(m->to, divides ? wanted * b / a : wanted / (a * b)), made);
}

/* Enters an operation whose operands are multiplied by `times`. Operand b is entered before operand a. */
static int make_of_operands(const multiplied *m, const op *o, double times) {
    const int second = o->b >= 0 ? taken(m, o->b, times) : -1;
    const int first = taken(m, o->a, times);
    return o->code == OP_ADD   ? op_list_add(m->to, first, second)
           : o->code == OP_SUB ? op_list_sub(m->to, first, second)
           : o->code == OP_POW ? op_list_pow(m->to, first, second)
                               : op_list_call(m->to, op_list_function(o), first, second);
}

static int make(const multiplied *m, int i) {
    const op *o = &m->from->ops[i];
    const double times = m->times[i];
    switch (op_rows[o->code].kind) {
    case OP_IS_CONSTANT: return -1; /* a constant is entered at each use */
    case OP_IS_LEAF:
        return o->code == OP_NOISE ? op_list_noise(m->to, (uint32_t)o->value)
                                   : op_list_leaf(m->to, o->code, o->a);
    case OP_IS_PHASE: return make_phase(m, o);
    case OP_IS_WAVE: return op_list_unary(m->to, o->code, m->made[o->a]);
    case OP_IS_UNARY:
        return op_list_unary(m->to, o->code,
                             taken(m, o->a,
                                   o->code == OP_SQRT   ? times * times
                                   : o->code == OP_SIGN ? times_of(m, i, 0)
                                                        : times));
    case OP_IS_BINARY:
        if (o->code == OP_MUL || o->code == OP_DIV) {
            const bool at_use = o->code == OP_MUL && is_constant(m->from, o->a);
            return at_use ? -1 : make_product(m, i);
        }
        return make_of_operands(m, o, o->code == OP_POW ? 1.0 : times);
    case OP_IS_CALL: return make_of_operands(m, o, 1.0);
    case OP_IS_CELL:
    case OP_IS_LOOKUP: break; /* lists with tables are never scaled */
    }
    abort();
}

op_list *op_list_multiplied(const op_list *t, const double *times) {
    multiplied m = {t, times, op_list_new(t->angles, t->results), alloc(t->count, sizeof(int))};
    m.to->folding = t->folding;
    for (int i = 0; i < t->count; i++) {
        m.made[i] = make(&m, i);
    }
    for (int i = 0; i < t->results; i++) {
        m.to->result[i] = taken(&m, t->result[i], 1.0);
    }
    free(m.made);
    op_list_prune(m.to);
    op_list_order(m.to);
    return m.to;
}

/* === the bias of constants that are rounded to float ========================================== */

enum { SIZES = 3, STATES = 6 };

/* The rates are multiplied by these factors. With 0, forces and torques dominate; with 10, terms with rates. */
static const double size_of_rates[SIZES] = {0.0, 1.0, 10.0};

/* A reproducible value from -1 to 1 for this leaf in this state. */
static double drawn(op_code code, int which, int state) {
    uint64_t x = (uint64_t)code * 7919U + (uint64_t)which * 131U + (uint64_t)state * 1000003U + 1U;
    for (int i = 0; i < 3; i++) {
        x = (x ^ (x >> 31)) * UINT64_C(0x9e3779b97f4a7c15);
    }
    return (double)(x >> 11) * 0x1p-52 - 1.0;
}

static double phase_at(const op_list *t, const op *o, int state, double radians) {
    double sum = o->value + radians;
    for (int k = 0; k < t->angles; k++) {
        const double turns = o->turns != NULL ? o->turns[k] : 0.0;
        const double parts = o->parts != NULL ? o->parts[k] : 0.0;
        sum += (turns + parts) * 3.2 * drawn(OP_PHASE, k, state);
    }
    return sum;
}

static double value_at(const op_list *t, const op *o, int state, double rates, bool as_float,
                       const double *v) {
    const op_row *row = &op_rows[o->code];
    const double a = row->values > 0 ? v[o->a] : 0.0;
    const double b = (row->values > 1 || row->kind == OP_IS_PHASE) && o->b >= 0 ? v[o->b] : 0.0;
    switch (row->kind) {
    case OP_IS_CONSTANT: return as_float ? (double)(float)o->value : o->value;
    case OP_IS_PHASE: return phase_at(t, o, state, b);
    case OP_IS_LEAF:
    case OP_IS_CELL:
    case OP_IS_LOOKUP: {
        const double number = drawn(o->code, o->a, state);
        return o->code == OP_LINEAR ? number : o->code == OP_RATE ? rates * number : 2.0 + number;
    }
    case OP_IS_WAVE:
    case OP_IS_UNARY:
    case OP_IS_BINARY:
    case OP_IS_CALL: break;
    }
    return o->code == OP_ADD   ? a + b
           : o->code == OP_SUB ? a - b
           : o->code == OP_MUL ? a * b
           : o->code == OP_DIV ? a / b
           : o->code == OP_NEG ? -a
           : o->code == OP_POW ? number_power(a, b)
                               : number_call(op_list_function(o), a, b);
}

/* Computes result[t->results] in a state. */
static void results_at(const op_list *t, int state, double rates, bool as_float, double *v,
                       double *result) {
    for (int i = 0; i < t->count; i++) {
        v[i] = value_at(t, &t->ops[i], state, rates, as_float, v);
    }
    for (int i = 0; i < t->results; i++) {
        result[i] = v[t->result[i]];
    }
}

/* Weight of a result in op_list_bias() if the list does not read the result's component; otherwise 1. */
#define UNREAD (1.0 / 64.0)

static void weigh_results(const op_list *t, double *weight) {
    for (int i = 0; i < t->results; i++) {
        weight[i] = UNREAD;
    }
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const int component = o->code == OP_RATE     ? o->a
                              : o->code == OP_LINEAR ? t->angles + o->a
                                                     : t->results;
        if (component < t->results) {
            weight[component] = 1.0;
        }
        for (int k = 0; k < t->angles && k < t->results && o->turns != NULL; k++) {
            weight[k] = o->turns[k] != 0 ? 1.0 : weight[k];
        }
    }
}

double op_list_bias(const op_list *t, const op_list *like) {
    const int n = t->results;
    double *v = alloc((int64_t)t->count + like->count, sizeof *v);
    double *off = alloc(5 * (int64_t)n, sizeof *off);
    double *size = off + n;
    double *now = off + 2 * n;
    double *meant = off + 3 * n;
    double *weight = off + 4 * n;
    double squares = 0.0;
    double entries = 0.0;
    weigh_results(like, weight);
    for (int s = 0; s < SIZES; s++) {
        for (int i = 0; i < n; i++) {
            off[i] = size[i] = 0.0;
        }
        for (int state = 0; state < STATES; state++) {
            results_at(t, state, size_of_rates[s], true, v, now);
            results_at(like, state, size_of_rates[s], false, v, meant);
            for (int i = 0; i < n; i++) {
                /* a result that is not finite in a state, such as the root of a negative number, is skipped there */
                const bool known = isfinite(now[i]) && isfinite(meant[i]);
                off[i] += known ? fabs(now[i] - meant[i]) : 0.0;
                size[i] += known ? fabs(meant[i]) : 0.0;
            }
        }
        for (int i = 0; i < n; i++) {
            if (size[i] > 0.0) {
                const double relative = weight[i] * off[i] / size[i];
                squares += relative * relative;
                entries += weight[i] * weight[i];
            }
        }
    }
    free(v);
    free(off);
    return entries > 0.0 ? number_root(squares / entries) : (double)NAN;
}

/* === the search for numbers that suit float =================================================== */

enum {
    LONGEST = 250, /* most operations of a list that is examined */
    FIVES = 6,     /* largest exponents of the primes 5, 3 and 7 */
    THREES = 3,
    SEVENS = 1,
    REALS = 512,      /* number of tried factors between one and two */
    VANISHING = 24,   /* number of tried factors that make a constant 1 or -1 */
    ROUNDS = 3,       /* most rounds; each starts from the result of the previous round */
    PATIENCE = 150000 /* operations of all tried lists together, after which a round ends */
};

#define CLEARLY 0.5 /* a clearly better list's bias is less than CLEARLY times the best bias */
#define LESS 0.99   /* a better list's bias is less than LESS times the best bias */

int op_list_scaling_price(const op_list *t) { return 1 + op_list_operations(t) / 40; }

/* `bias` and `operations` are those of the best list in all rounds so far; at first, of `like`. */
typedef struct scaling_search {
    const op_list *like;
    const op_list *from; /* result of the previous round; at first, `like` */
    int most;            /* largest allowed number of operations */
    op_list *best;       /* NULL: none found yet */
    double bias;
    int operations;
    double *times; /* [3 * from->count] */
    int64_t tried; /* total operations of tried lists */
} scaling_search;

/* Returns x^e. Products of small whole numbers are exact. */
static double power(double x, double e) {
    if (e == number_floor(e) && fabs(e) <= 4.0) {
        double product = 1.0;
        for (int k = 0; k < (int)fabs(e); k++) {
            product *= x;
        }
        return e < 0.0 ? 1.0 / product : product;
    }
    return number_power(x, e);
}

static bool is_better(const scaling_search *s, double bias, int operations) {
    return bias < CLEARLY * s->bias || (bias < LESS * s->bias && operations <= s->operations) ||
           (bias <= s->bias && operations < s->operations);
}

static op_list *scaled_by(scaling_search *s, const double *exponent, double x) {
    for (int i = 0; i < 3 * s->from->count; i++) {
        s->times[i] = power(x, exponent[i]);
    }
    return op_list_multiplied(s->from, s->times);
}

static void try_number(scaling_search *s, const double *exponent, double x) {
    if (s->tried >= PATIENCE) {
        return;
    }
    op_list *made = scaled_by(s, exponent, x);
    s->tried += made->count;
    const int operations = op_list_operations(made);
    if (operations <= s->most && op_list_not_finite(made) < 0) {
        const double bias = op_list_bias(made, s->like);
        if (is_better(s, bias, operations)) {
            op_list_free(s->best);
            s->best = made;
            s->bias = bias;
            s->operations = operations;
            return;
        }
    }
    op_list_free(made);
}

/* Tries products of small primes, the simplest first. Powers of 5 make decimals exact in float; 3 makes thirds exact.
 * A factor 2 would not change the round-off. */
static void try_primes(scaling_search *s, const double *exponent) {
    for (int all = 1; all <= FIVES + THREES + SEVENS; all++) {
        for (int fives = -FIVES; fives <= FIVES; fives++) {
            for (int threes = -THREES; threes <= THREES; threes++) {
                const int sevens = all - abs(fives) - abs(threes);
                for (int sign = -1; sign <= 1 && sevens >= 0 && sevens <= SEVENS; sign += 2) {
                    const int cubes = fives / 3;
                    const double x = power(125.0, cubes) * power(5.0, fives % 3) *
                                     power(3.0, threes) * power(7.0, -sign * sevens);
                    try_number(s, exponent, x);
                }
            }
        }
    }
}

/* Tries numbers that make the constant of a product 1 or -1. */
static void try_vanishing(scaling_search *s, const double *exponent) {
    int tried = 0;
    double number;
    for (int i = 0; i < s->from->count && tried < VANISHING; i++) {
        const op *o = &s->from->ops[i];
        if (o->code == OP_MUL && op_list_is_constant(s->from, o->a, &number)) {
            const double factor = is_raw(&s->from->ops[o->b]) ? 0.0 : exponent[o->b];
            const double e = factor - exponent[i];
            if (e != 0.0) {
                try_number(s, exponent, number_power(fabs(number), 1.0 / e));
                tried++;
            }
        }
    }
}

static void try_reals(scaling_search *s, const double *exponent) {
    const double golden = 0.6180339887498949;
    for (int k = 1; k <= REALS; k++) {
        try_number(s, exponent, 1.0 + number_remainder(k * golden, 1.0));
    }
}

/* Tries simple numbers with all exponent vectors before other numbers, because PATIENCE may end the round early. */
static void search_round(scaling_search *s) {
    op_list_freedoms f = op_list_freedoms_of(s->from);
    bool *can = alloc((int64_t)f.count + 1, sizeof *can);
    s->tried = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < f.count; k++) {
            const double *exponent = f.exponent + (size_t)k * (size_t)f.length;
            if (pass == 0) {
                try_vanishing(s, exponent);
                /* does an arbitrary factor need too many operations? */
                op_list *made = scaled_by(s, exponent, 1.2345678901);
                can[k] = op_list_operations(made) <= s->most;
                op_list_free(made);
            }
            if (can[k]) {
                (pass == 0 ? try_primes : try_reals)(s, exponent);
            }
        }
    }
    free(can);
    free(f.exponent);
}

void op_list_scale(op_list **t, int price) {
    const double bias = op_list_bias(*t, *t);
    if ((*t)->count > LONGEST || !(bias > 0.0)) {
        return;
    }
    op_list *found = NULL;
    scaling_search s = {.like = *t,
                        .from = *t,
                        .most = op_list_operations(*t) + price,
                        .bias = bias,
                        .operations = op_list_operations(*t)};
    for (int round = 0; round < ROUNDS; round++) {
        s.times = alloc(3 * (int64_t)s.from->count + 1, sizeof *s.times);
        search_round(&s);
        free(s.times);
        if (s.best == NULL) {
            break;
        }
        op_list_free(found);
        found = s.best;
        s.from = found;
        s.best = NULL;
    }
    if (found != NULL && s.bias <= CLEARLY * bias) {
        op_list_free(*t);
        *t = found;
    } else {
        op_list_free(found);
    }
}
