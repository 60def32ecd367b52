/* derived.h: parses and derives a text or a built-in scene and keeps all reports, for tests of host/algebra,
 * host/derive and host/emit. Also a random generator with the same numbers on every host. */
#ifndef TESTS_HOST_DERIVED_H
#define TESTS_HOST_DERIVED_H

#include "test.h"

#include "host/derive/lagrange.h"
#include "host/image/image_make.h"

typedef struct derived {
    whirl_model *model;
    instance *instance;
    equations *equations; /* NULL if the derivation was refused */
    image *image;         /* NULL if the derivation was refused */
    char *errors;         /* errors as text, "" if there are none */
    char *text;           /* text of the file, for source places; NULL without derived_file() */
} derived;

/* Parses `text` without deriving it and returns the errors, "" if there are none. The next call overwrites the
 * result. */
enum { REPORT_OF_TEXT_SIZE = 8000 };
const char *report_of_text(const char *text);

/* The default settings of these tests, with the Runge-Kutta method of order 4. */
extern const image_settings plainly;

derived derived_text(const char *text);
derived derived_scene(const char *text, const char *name);
derived derived_builtin(const char *name);
/* Calls `check` for every built-in scene. Returns the sum of its results. */
typedef int scene_check(const scene *s);
int each_builtin_scene(scene_check *check);
derived derived_file(const char *path);
void derived_free(derived *d);
/* Fails the test with the errors of `d` if the derivation was refused. */
void derived_expect(const derived *d, const char *what);
derived derived_surely(derived d, const char *what);

/* Capacity of state_values: UNKNOWNS coordinates, each with its value and ORDERS_MAX - 1 derivatives. */
enum { UNKNOWNS = 16, ORDERS_MAX = 6 };

/* A value for every symbol, by kind and index. Both sides of a comparison are evaluated with these values. */
typedef struct state_values {
    const instance *instance;
    double value[UNKNOWNS][ORDERS_MAX]; /* [coordinate][number of time derivatives] */
} state_values;

/* Callback for poly_evaluate(). `context` is a state_values. */
double state_value(void *context, const symbol *sym, int primes);

/* Residual of equation i, M q'' - force, with the given accelerations. *size: the sum of the absolute terms, plus 1. */
double derived_rest(const derived *d, state_values *s, const double *accel, int i, double *size);

/* Draws a state with positive lengths and with angles far from poles, so that no singular point occurs. */
void random_state(state_values *s, const derived *d, uint64_t *seed);

/* Evaluates the operation list `t` at the state `s`. Writes result[t->results]. */
void derived_run(const op_list *t, const derived *d, const state_values *s, double *result);
/* Like derived_run(), and off[t->results] receives a bound on the round-off of each result, in units of 2^-53
 * (host/engine/rounding.h). */
void derived_run_known(const op_list *t, const derived *d, const state_values *s, double *result,
                       double *off);

/* Returns the text that a writer of host/emit produces for an image of the file x.whirl. The caller frees the text. */
char *derived_written(void (*write)(FILE *out, const image *im, const char *file), const image *im);

/* Writes the Octave form that `whirl derive` prints, with a description of the contacts. */
void derived_octave(FILE *out, const derived *d, const char *file, bool folded);

/* random_bits(): 64 random bits. random_one_of(): an integer from 0 to bound - 1. random_between(): a number from
 * low to high. */
uint64_t random_bits(uint64_t *seed);
unsigned random_one_of(uint64_t *seed, unsigned bound);
double random_between(uint64_t *seed, double low, double high);

/* Returns `front`, then `times` copies of `piece`, then `tail`. In each piece, # becomes the piece's number, from 1,
 * and @ becomes that number minus 1. */
char *repeated(const char *front, const char *piece, int times, const char *tail);

/* Solves A x = b by elimination with pivots. `a` has n rows of `width` numbers: the first n numbers of a row are A,
 * the next is b. The function overwrites `a`. */
void dense_solve(int n, int width, long double *a, long double *x);

#endif
