/* derived.h: for the tests of host/algebra, host/derive and host/emit: a text or a built-in name, parsed
 * and derived, with whatever was reported; and a random generator that is the same everywhere. */
#ifndef TESTS_HOST_DERIVED_H
#define TESTS_HOST_DERIVED_H

#include "host/derive/image_make.h"
#include "host/derive/lagrange.h"

typedef struct derived {
    whirl_model *model;
    instance *instance;
    equations *equations; /* NULL when it could not be derived */
    image *image;         /* NULL as well */
    char *errors;         /* "" when there are none */
    char *text;           /* of derived_file(), which places point into; else NULL */
} derived;

/* What the language says about a text, "" when it accepts it; overwritten by the next call. Nothing is derived. */
enum { REPORT_OF_TEXT_SIZE = 8000 };
const char *report_of_text(const char *text);

/* How tests integrate that do not mind: with Runge-Kutta 4. */
extern const image_settings plainly;

/* The first mechanism of a text. */
derived derived_text(const char *text);
/* A scene of a text. */
derived derived_scene(const char *text, const char *name);
/* A text whose scene `s` declares ranges: pull -2 to 4 kN, x -1.5 to 3 m, a' 1 to 2 rad/s. */
extern const char derived_ranged[];
/* A built-in mechanism or scene. */
derived derived_builtin(const char *name);
/* Calls `check` for every built-in scene; the sum of what it returns. */
typedef int scene_check(const scene *s);
int each_builtin_scene(scene_check *check);
/* The first mechanism of a file. */
derived derived_file(const char *path);
void derived_free(derived *d);
/* Fails the test, with the errors, when it could not be derived. */
void derived_expect(const derived *d, const char *what);

/* The component of the image's state which is this derivative of the unknown of that name; fails the test where there is
 * none. */
int derived_component(const image *im, const char *name, int primes);

/* What a state_values has room for: coordinates, and derivatives of each, the value included. */
enum { UNKNOWNS = 16, ORDERS_MAX = 6 };

/* Numbers for every symbol, by kind and index: the state of one comparison. */
typedef struct state_values {
    const instance *instance;
    double value[UNKNOWNS][ORDERS_MAX]; /* [coordinate][primes] */
} state_values;

/* For poly_evaluate(), with a state_values as context. */
double state_value(void *context, const symbol *sym, int primes);

/* What equation i leaves over with these accelerations, M q'' - force, at a state; *size: of its terms, and 1. */
double derived_rest(const derived *d, state_values *s, const double *accel, int i, double *size);

/* A random state: lengths stay positive and angles off the poles; singular points are not the matter. */
void random_state(state_values *s, const derived *d, uint64_t *seed);

/* What a list of the image gives at a state: result[t->results]. */
void derived_run(const op_list *t, const derived *d, const state_values *s, double *result);
/* And how far off each may be for the rounding of the list's operations, in units of 2^-53 (host/engine/rounding.h):
 * off[t->results]. */
void derived_run_known(const op_list *t, const derived *d, const state_values *s, double *result,
                       double *off);

/* What one of host/emit's writers makes of an image of x.whirl; to be freed. */
char *derived_written(void (*write)(FILE *out, const image *im, const char *file), const image *im);

/* The Octave form, with its contacts in words, as `whirl derive` writes it. */
void derived_octave(FILE *out, const derived *d, const char *file, bool folded);

/* Next random 64 bits; a number between the bounds. */
uint64_t random_bits(uint64_t *seed);
double random_between(uint64_t *seed, double low, double high);

/* `front`, then `piece` with its number (twice, if it wants it) so many times, then `tail`. */
char *repeated(const char *front, const char *piece, int times, const char *tail);

#endif
