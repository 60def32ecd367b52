/* tape_freedom.c: which operations of a list may be multiplied together.
 *
 * Each operation is multiplied by x to some exponent of its own. Sums want equal exponents of what they add, products add
 * them, constants and products with constants have whichever is wanted, results have none. These are linear
 * equations, and the solutions are the freedom. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"
#include "tape_gauge.h"

/* Exponents are small whole numbers and halves, and so are all entries: what is below is zero. */
#define NOTHING 1e-9

/* Rows of `columns` numbers. */
typedef struct matrix {
    double *at;
    int rows;
    int columns;
} matrix;

static matrix matrix_new(int rows, int columns) {
    return (matrix){room((int64_t)rows * columns + 1, sizeof(double)), rows, columns};
}

static double *row_of(const matrix *m, int row) { return m->at + (size_t)row * (size_t)m->columns; }

static void swap_rows(const matrix *m, int x, int y) {
    for (int c = 0; c < m->columns; c++) {
        const double kept = row_of(m, x)[c];
        row_of(m, x)[c] = row_of(m, y)[c];
        row_of(m, y)[c] = kept;
    }
}

/* Subtract row `of`, whose entry in column c is one, from all others, so that these have none there. */
static void clear_column(const matrix *m, int of, int c) {
    for (int r = 0; r < m->rows; r++) {
        const double factor = r != of ? row_of(m, r)[c] : 0.0;
        for (int k = 0; k < m->columns && factor != 0.0; k++) {
            double *entry = &row_of(m, r)[k];
            *entry -= factor * row_of(m, of)[k];
            *entry = fabs(*entry) < NOTHING ? 0.0 : *entry;
        }
    }
}

/* Gauss and Jordan: lead[row] is its leading column. Returns how many rows are left. */
static int reduce(const matrix *m, int *lead) {
    int rank = 0;
    for (int c = 0; c < m->columns && rank < m->rows; c++) {
        int best = rank;
        for (int r = rank; r < m->rows; r++) {
            best = fabs(row_of(m, r)[c]) > fabs(row_of(m, best)[c]) ? r : best;
        }
        const double pivot = row_of(m, best)[c];
        if (pivot == 0.0) {
            continue;
        }
        swap_rows(m, best, rank);
        for (int k = 0; k < m->columns; k++) {
            row_of(m, rank)[k] /= pivot;
        }
        clear_column(m, rank, c);
        lead[rank++] = c;
    }
    return rank;
}

/* The vectors that m turns into zero, as rows; m is destroyed. */
static matrix kernel_of(const matrix *m) {
    int *lead = room((int64_t)m->rows + 1, sizeof *lead);
    bool *leads = room((int64_t)m->columns + 1, sizeof *leads);
    const int rank = reduce(m, lead);
    matrix kernel = matrix_new(m->columns - rank, m->columns);
    int made = 0;
    for (int r = 0; r < rank; r++) {
        leads[lead[r]] = true;
    }
    for (int c = 0; c < m->columns; c++) {
        if (!leads[c]) {
            row_of(&kernel, made)[c] = 1.0;
            for (int r = 0; r < rank; r++) {
                row_of(&kernel, made)[lead[r]] = -row_of(m, r)[c];
            }
            made++;
        }
    }
    free(lead);
    free(leads);
    return kernel;
}

/* --- the equations of a list -----------------------------------------------------------------------------------*/

/* The unknowns: an exponent for each operation, and one for each place where a sum, a product or the like takes a
 * raw value, for it may take this as it is or multiplied. */
typedef struct unknowns {
    const tape *of;
    int *column; /* [2 * count] of the places, by operation, a before b; 0: none */
    int *place;  /* [columns] 2 * operation, or that and one */
    int columns;
} unknowns;

static bool is_constant(const tape *t, int i) { return t->ops[i].code == OP_CONSTANT; }

static int operand_of(const op *o, int which) { return which == 0 ? o->a : o->b; }

/* Does it take constants by itself? Then it asks nothing. */
static bool absorbs(const tape *t, const op *o) {
    return (o->code == OP_MUL || o->code == OP_DIV) &&
           (is_constant(t, o->a) || is_constant(t, o->b));
}

static bool has_exponent(const tape *t, int i) {
    const op *o = &t->ops[i];
    return !tape_is_raw(o) && o->code != OP_CONSTANT && o->code != OP_PHASE;
}

static unknowns unknowns_of(const tape *t) {
    unknowns u = {t, room(2 * (int64_t)t->count + 1, sizeof(int)),
                  room(3 * (int64_t)t->count + 1, sizeof(int)), t->count};
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        for (int which = 0; has_exponent(t, i) && !absorbs(t, o) && which < op_rows[o->code].values;
             which++) {
            if (tape_is_raw(&t->ops[operand_of(o, which)])) {
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

/* One more equation: `own` times the exponent of i is that of its operand a, and `b` times that of operand b. Constants have
 * any. */
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
    switch (o->code) {
    case OP_ADD:
    case OP_SUB:
    case OP_MIN:
    case OP_MAX:
        if (!is_constant(u->of, o->a)) {
            equation(u, m, 1.0, i, 1.0, 0.0);
        }
        if (!is_constant(u->of, o->b)) {
            equation(u, m, 1.0, i, 0.0, 1.0);
        }
        break;
    case OP_MUL:
    case OP_DIV:
        if (!absorbs(u->of, o)) {
            equation(u, m, 1.0, i, 1.0, o->code == OP_MUL ? 1.0 : -1.0);
        }
        break;
    case OP_NEG:
    case OP_ABS: equation(u, m, 1.0, i, 1.0, 0.0); break;
    case OP_SQRT: equation(u, m, 2.0, i, 1.0, 0.0); break;
    case OP_PHASE:
    case OP_CONSTANT:
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_SIN:
    case OP_COS:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC:
    case OP_SIGN:
    case OP_CALL:
    case OP_POW: equation(u, m, 1.0, i, 0.0, 0.0); break; /* as they are */
    }
}

/* All solutions, raw values multiplied wherever it takes that. */
static matrix all_freedoms(const unknowns *u) {
    const tape *t = u->of;
    matrix m = matrix_new(2 * t->count + t->results, u->columns);
    m.rows = 0;
    for (int i = 0; i < t->count; i++) {
        equations_of(u, i, &m);
    }
    for (int i = 0; i < t->results; i++) {
        equation(u, &m, 1.0, t->result[i], 0.0, 0.0);
    }
    const matrix kernel = kernel_of(&m);
    free(m.at);
    return kernel;
}

/* --- those that multiply few raw values --------------------------------------------------------------------------*/

enum { PLACES = 64, SUBSETS_OF = 5 };

/* Places of raw values that are multiplied, those of one value alike. */
typedef struct chosen {
    int column[PLACES];
    int like[PLACES]; /* an earlier column of the same value, or itself */
    int count;
} chosen;

/* Does this solution multiply at each of these places, and does it change anything? */
static bool tells(const tape *t, const double *e, const chosen *c) {
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

/* So that the least exponent is one. */
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

static void keep(tape_freedoms *f, const unknowns *u, const double *e) {
    const int n = u->of->count;
    f->exponent = room_more(f->exponent, (f->count + 1) * f->length, sizeof *f->exponent);
    double *kept = f->exponent + (size_t)f->count * (size_t)f->length;
    for (int i = 0; i < f->length; i++) {
        const int column = i < n ? i : u->column[i - n];
        kept[i] = i < n || column != 0 ? e[column] : 0.0;
    }
    f->count++;
}

/* What of `all` multiplies raw values at the chosen places only, those of one value alike. */
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

static void add_freedoms(const unknowns *u, const matrix *all, const chosen *c, tape_freedoms *f) {
    const matrix m = limits_of(u, all, c);
    const matrix shares = kernel_of(&m);
    double *e = room((int64_t)u->columns + 1, sizeof *e);
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
    free(m.at);
}

/* Choose the places of raw value `raw` whose bits are set, too. */
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

tape_freedoms tape_freedoms_of(const tape *t) {
    tape_freedoms f = {NULL, 0, 3 * t->count};
    const unknowns u = unknowns_of(t);
    const matrix all = all_freedoms(&u);
    const chosen none = {.count = 0};
    add_freedoms(&u, &all, &none, &f);
    for (int i = 0; i < t->count && all.rows > 0; i++) {
        const int places = tape_is_raw(&t->ops[i]) ? places_of(&u, i) : 0;
        const unsigned subsets = 1U << (places < SUBSETS_OF ? places : SUBSETS_OF);
        for (unsigned which = 1; which < subsets; which++) {
            const chosen one = choose(&u, none, i, which);
            add_freedoms(&u, &all, &one, &f);
        }
        for (int k = 0; k < i && places > 0; k++) {
            if (tape_is_raw(&t->ops[k]) && places_of(&u, k) > 0) {
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

void tape_freedoms_free(tape_freedoms *f) {
    free(f->exponent);
    f->exponent = NULL;
    f->count = 0;
}
