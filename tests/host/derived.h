/* derived.h: a text or a built-in name, parsed and derived, with all reports; and a random generator that is the same
 * on every host. For tests of host/algebra, host/derive and host/emit. */
#ifndef TESTS_HOST_DERIVED_H
#define TESTS_HOST_DERIVED_H

#include "test.h"

#include "host/derive/image_make.h"
#include "host/derive/lagrange.h"

typedef struct derived {
    whirl_model *model;
    instance *instance;
    equations *equations; /* NULL after a refusal */
    image *image;         /* NULL after a refusal */
    char *errors;         /* "" without errors */
    char *text;           /* text of derived_file(), to which source places point; else NULL */
} derived;

/* The report on a text, "" if the language accepts it; overwritten by the next call. Nothing is derived. */
enum { REPORT_OF_TEXT_SIZE = 8000 };
const char *report_of_text(const char *text);

/* The default settings of these tests: Runge-Kutta 4. */
extern const image_settings plainly;

derived derived_text(const char *text);
derived derived_scene(const char *text, const char *name);
derived derived_builtin(const char *name);
/* Calls `check` for every built-in scene. Returns the sum of its results. */
typedef int scene_check(const scene *s);
int each_builtin_scene(scene_check *check);
derived derived_file(const char *path);
void derived_free(derived *d);
/* Fails the test with the errors after a refusal. */
void derived_expect(const derived *d, const char *what);
derived derived_surely(derived d, const char *what);

/* Capacity of a state_values: the coordinates; for each, its value and derivatives. */
enum { UNKNOWNS = 16, ORDERS_MAX = 6 };

/* Numbers for every symbol, by kind and index: the state of a comparison. */
typedef struct state_values {
    const instance *instance;
    double value[UNKNOWNS][ORDERS_MAX]; /* [coordinate][primes] */
} state_values;

/* Callback of poly_evaluate() with a state_values as context. */
double state_value(void *context, const symbol *sym, int primes);

/* Residual of equation i with these accelerations: M q'' - force. *size is the sum of the absolute terms, plus 1. */
double derived_rest(const derived *d, state_values *s, const double *accel, int i, double *size);

/* Draws a state with positive lengths, and angles far from poles, to avoid singular points. */
void random_state(state_values *s, const derived *d, uint64_t *seed);

/* Evaluates a list of the image at a state: result[t->results]. */
void derived_run(const op_list *t, const derived *d, const state_values *s, double *result);
/* As derived_run(); off[t->results] receives a bound on the round-off of each result, in units of 2^-53
 * (host/engine/rounding.h). */
void derived_run_known(const op_list *t, const derived *d, const state_values *s, double *result,
                       double *off);

/* The output of a writer of host/emit for an image of x.whirl; to be freed. */
char *derived_written(void (*write)(FILE *out, const image *im, const char *file), const image *im);

/* The Octave form as `whirl derive` writes it, with its contacts in words. */
void derived_octave(FILE *out, const derived *d, const char *file, bool folded);

/* 64 random bits; an integer below the bound; a number between the bounds. */
uint64_t random_bits(uint64_t *seed);
unsigned random_one_of(uint64_t *seed, unsigned bound);
double random_between(uint64_t *seed, double low, double high);

/* Builds `front`, then `piece` `times` times, then `tail`. In a piece, # becomes its number, from 1, and @ one less. */
char *repeated(const char *front, const char *piece, int times, const char *tail);

/* x of A x = b by elimination with pivots: a has n rows of `width` numbers, of which the first n are A and the next is b.
 * It is overwritten. */
void dense_solve(int n, int width, long double *a, long double *x);

#endif
