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

/* One more equation: `own` times the exponent of i is that of a, times x, and that of b, times y. Constants, which have
 * any, leave their sums open; nothing is asked then of a product. */
static void equation(matrix *m, double own, int i, double x, int a, double y, int b) {
    double *row = row_of(m, m->rows++);
    row[i] += own;
    row[a] -= x;
    if (y != 0.0) {
        row[b] -= y;
    }
}

static bool is_constant(const tape *t, int i) { return t->ops[i].code == OP_CONSTANT; }

static void equations_of(const tape *t, int i, matrix *m) {
    const op *o = &t->ops[i];
    switch (o->code) {
    case OP_ADD:
    case OP_SUB:
    case OP_MIN:
    case OP_MAX:
        if (!is_constant(t, o->a)) {
            equation(m, 1.0, i, 1.0, o->a, 0.0, 0);
        }
        if (!is_constant(t, o->b)) {
            equation(m, 1.0, i, 1.0, o->b, 0.0, 0);
        }
        break;
    case OP_MUL:
    case OP_DIV:
        if (!is_constant(t, o->a) && !is_constant(t, o->b)) {
            equation(m, 1.0, i, 1.0, o->a, o->code == OP_MUL ? 1.0 : -1.0, o->b);
        }
        break;
    case OP_NEG:
    case OP_ABS: equation(m, 1.0, i, 1.0, o->a, 0.0, 0); break;
    case OP_SQRT: equation(m, 2.0, i, 1.0, o->a, 0.0, 0); break;
    case OP_PHASE:
    case OP_CONSTANT: equation(m, 1.0, i, 0.0, i, 0.0, 0); break; /* none */
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_SIN:
    case OP_COS:
    case OP_SIGN:
    case OP_CALL:
    case OP_POW: break; /* raw */
    }
}

/* All solutions, raw values multiplied by whatever it takes. */
static matrix all_freedoms(const tape *t) {
    matrix m = matrix_new(2 * t->count + t->results, t->count);
    m.rows = 0;
    for (int i = 0; i < t->count; i++) {
        equations_of(t, i, &m);
    }
    for (int i = 0; i < t->results; i++) {
        if (!tape_is_raw(&t->ops[t->result[i]])) {
            equation(&m, 1.0, t->result[i], 0.0, 0, 0.0, 0);
        }
    }
    const matrix kernel = kernel_of(&m);
    free(m.at);
    return kernel;
}

/* --- those that multiply few raw values --------------------------------------------------------------------------*/

/* Does this solution name every one of these raw values, and does it change anything? A product with a constant is
 * made anew wherever it is taken. */
static bool tells(const tape *t, const double *e, const int *allowed, int count) {
    bool all = true;
    bool changes = false;
    for (int k = 0; k < count; k++) {
        all = all && e[allowed[k]] != 0.0;
    }
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        changes = changes || (e[i] != 0.0 && !tape_is_raw(o) &&
                              !(o->code == OP_MUL && is_constant(t, o->a)));
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

static void keep(tape_freedoms *f, const double *e) {
    f->exponent =
        room_more(f->exponent, (f->count + 1) * f->length, sizeof *f->exponent);
    memcpy(f->exponent + (size_t)f->count * (size_t)f->length, e,
           (size_t)f->length * sizeof *f->exponent);
    f->count++;
}

/* Combinations of `all` that multiply no raw value but the allowed, and all of these. */
static void add_freedoms(const tape *t, const matrix *all, const int *allowed, int count,
                         tape_freedoms *f) {
    matrix m = matrix_new(t->count, all->rows);
    m.rows = 0;
    for (int i = 0; i < t->count; i++) {
        const bool may = count > 0 && (i == allowed[0] || i == allowed[count - 1]);
        if (tape_is_raw(&t->ops[i]) && !may) {
            for (int k = 0; k < all->rows; k++) {
                row_of(&m, m.rows)[k] = row_of(all, k)[i];
            }
            m.rows++;
        }
    }
    const matrix shares = kernel_of(&m);
    double *e = room((int64_t)t->count + 1, sizeof *e);
    for (int s = 0; s < shares.rows; s++) {
        for (int i = 0; i < t->count; i++) {
            e[i] = 0.0;
            for (int k = 0; k < all->rows; k++) {
                e[i] += row_of(&shares, s)[k] * row_of(all, k)[i];
            }
        }
        normalise(e, t->count);
        if (tells(t, e, allowed, count)) {
            keep(f, e);
        }
    }
    free(e);
    free(shares.at);
    free(m.at);
}

tape_freedoms tape_freedoms_of(const tape *t) {
    tape_freedoms f = {NULL, 0, t->count};
    const matrix all = all_freedoms(t);
    int *raw = room((int64_t)t->count + 1, sizeof *raw);
    int raws = 0;
    for (int i = 0; i < t->count; i++) {
        if (tape_is_raw(&t->ops[i])) {
            raw[raws++] = i;
        }
    }
    add_freedoms(t, &all, NULL, 0, &f);
    for (int i = 0; i < raws && all.rows > 0; i++) {
        add_freedoms(t, &all, (int[]){raw[i]}, 1, &f);
        for (int k = 0; k < i; k++) {
            add_freedoms(t, &all, (int[]){raw[k], raw[i]}, 2, &f);
        }
    }
    free(raw);
    free(all.at);
    return f;
}

void tape_freedoms_free(tape_freedoms *f) {
    free(f->exponent);
    f->exponent = NULL;
    f->count = 0;
}
