/* reread.h: formulas as `whirl derive` prints them, parsed by the language's own parser and compared with their
 * expressions at random states. */
#ifndef TESTS_HOST_REREAD_H
#define TESTS_HOST_REREAD_H

#include "derived.h"

enum { REREAD_COORDINATES = 4, REREAD_CONSTANTS = 6, REREAD_PARAMETERS = 3, REREAD_STATES = 4 };

/* Names in these tests' mechanisms: coordinates or states, then parameters and inputs. Natural names, Greek letters,
 * indices and odd underscores. */
extern const char *const reread_coordinates[REREAD_COORDINATES];
extern const char *const reread_constants[REREAD_CONSTANTS];

typedef struct state {
    double q[REREAD_COORDINATES][3]; /* value, rate, acceleration */
    double constant[REREAD_CONSTANTS];
} state;

state random_values(uint64_t *seed);
/* Callback of poly_evaluate() with a state as context. */
double value_here(void *context, const symbol *sym, int primes);

typedef struct read_back {
    diags *said;
    whirl_model *model;
    instance *instance; /* NULL after a refusal, which has been printed */
} read_back;

/* The formulas as outputs of a mechanism with all names as inputs. */
read_back parse_back(const char *const *formulas, int count);
void drop_back(read_back *b);
double back_value(const read_back *b, int which, const state *s);

/* An expected formula: its value at a state, and the size of its terms. */
typedef struct quantity {
    double (*value)(const struct quantity *of, const state *at, double *size);
    algebra *algebra;
    const poly *poly;
    const equations *equations;
    int unknown;
} quantity;

/* Value of of->poly; NaN if cancellation leaves it no reliable digit. */
double poly_here(const quantity *of, const state *at, double *size);
/* Are all parts of the expression in range? 1/(1 + x) would hide an infinite x, and sin(x) that a large x has no digits. */
bool is_in_range(const poly *p, double most, state *s);

/* Compares the formula (minus formula `right`, if not -1) with the quantity at random states. Returns the number of
 * states with a value. `text` is for messages. */
int compare(const quantity *q, const char *text, const read_back *b, int which, int right,
            uint64_t *seed);

/* The formula must be valid LaTeX (latex.h). */
void expect_compiles(const char *latex);

#endif
