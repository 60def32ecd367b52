/* reread.h: for the tests of what is printed: formulas as `whirl derive` prints them, read by the language's own
 * parser, and compared with what they should be at random states. */
#ifndef TESTS_HOST_REREAD_H
#define TESTS_HOST_REREAD_H

#include "derived.h"

enum { REREAD_COORDINATES = 4, REREAD_CONSTANTS = 6, REREAD_PARAMETERS = 3, REREAD_STATES = 4 };

/* What the mechanisms of these tests may name: coordinates or states, then parameters and inputs; names as people
 * give them, Greek, with indices and underscores in odd places. */
extern const char *const reread_coordinates[REREAD_COORDINATES];
extern const char *const reread_constants[REREAD_CONSTANTS];

typedef struct state {
    double q[REREAD_COORDINATES][3]; /* value, rate, acceleration */
    double constant[REREAD_CONSTANTS];
} state;

state random_values(uint64_t *seed);
/* For poly_evaluate(), with a state as context. */
double value_here(void *context, const symbol *sym, int primes);

typedef struct read_back {
    diags *said;
    whirl_model *model;
    instance *instance; /* NULL when a formula was refused; that was printed */
} read_back;

/* The formulas, each as an output of a mechanism whose inputs are all the names. */
read_back parse_back(const char *const *formulas, int count);
void drop_back(read_back *b);
double back_value(const read_back *b, int which, const state *s);

/* What a formula should be: its value at a state, and the size of what it is the sum of. */
typedef struct quantity {
    double (*value)(const struct quantity *of, const state *at, double *size);
    algebra *algebra;
    const poly *poly;
    const equations *equations;
    int unknown;
} quantity;

/* Of ->poly; NaN where it cannot be told to some digits. */
double poly_here(const quantity *of, const state *at, double *size);
/* No part of it is out of range there: 1/(1 + x) hides that x was infinite, sin(x) that no digit of a large x was
 * left. */
bool is_in_range(const poly *p, double most, state *s);

/* The formula's value (less that of formula `right`, if not -1) must be that of the quantity at random states.
 * Returns at how many it had one. `text` is for messages. */
int compare(const quantity *q, const char *text, const read_back *b, int which, int right,
            uint64_t *seed);

/* The formula must be LaTeX that compiles (latex.h). */
void expect_compiles(const char *latex);

#endif
