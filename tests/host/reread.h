/* reread.h: reads formulas that `whirl derive` prints with the language's own parser, and compares them with the
 * expressions at random states. */
#ifndef TESTS_HOST_REREAD_H
#define TESTS_HOST_REREAD_H

#include "derived.h"

enum { REREAD_COORDINATES = 4, REREAD_CONSTANTS = 6, REREAD_PARAMETERS = 3, REREAD_STATES = 4 };

/* The names in the mechanisms of these tests: coordinates or states, then parameters and inputs. They include
 * natural names, Greek letters, indices and odd underscores. */
extern const char *const reread_coordinates[REREAD_COORDINATES];
extern const char *const reread_constants[REREAD_CONSTANTS];

typedef struct state {
    double q[REREAD_COORDINATES][3]; /* [coordinate]: value, rate, acceleration */
    double constant[REREAD_CONSTANTS];
} state;

state random_values(uint64_t *seed);
/* Callback for poly_evaluate(). `context` is a state. */
double value_here(void *context, const symbol *sym, int primes);

typedef struct read_back {
    diags *said;
    whirl_model *model;
    instance *instance; /* NULL if the formulas were refused; the errors have been printed */
} read_back;

/* Parses the formulas as outputs of a mechanism in which all names are inputs. */
read_back parse_back(const char *const *formulas, int count);
void drop_back(read_back *b);
double back_value(const read_back *b, int which, const state *s);

/* The expected value of a formula at a state. *size: the sum of its absolute terms. */
typedef struct quantity {
    double (*value)(const struct quantity *of, const state *at, double *size);
    algebra *algebra;
    const poly *poly;
    const equations *equations;
    int unknown;
} quantity;

/* The value of of->poly; NaN if a part of the expression is out of range. *size: the sum of the absolute terms. */
double poly_here(const quantity *of, const state *at, double *size);
/* Is the expression smaller than `most`, and all its arguments smaller than 1e5? 1/(1 + x) would hide an infinite x,
 * and sin(x) of a large x has no digits. */
bool is_in_range(const poly *p, double most, state *s);

/* Compares formula `which` with the quantity at random states. If right >= 0, formula `right` is first subtracted.
 * Returns the number of states with a value. `text` is used in messages only. */
int compare(const quantity *q, const char *text, const read_back *b, int which, int right,
            uint64_t *seed);

/* Fails the test if the formula is not valid LaTeX (latex.h). */
void expect_compiles(const char *latex);

#endif
