/* test_rk4.c: the paths of the method `rk4` compared with the plain step of core/rk4.h: one step of each built-in scene
 * without contacts, from drawn moments of its run, with sines turned on, looked up, and with the books kept. */
#include <float.h>
#include <math.h>

#include "derived.h"
#include "motion.h"

#include "unity.h"

void suite_rk4(void);

enum { DRAWS = 5, VALUES = 3 * IMAGE_COMPONENTS_MAX };

static uint64_t seed;
static int compared; /* steps */

/* One step in numbers of this kind from a state, angles first, in rad. False: the step is refused. */
static bool step_from(const motion *m, const engine_kind *kind, const double *from, double *to) {
    for (int i = 0; i < m->image->angles; i++) {
        m->image->start_rad[i] = from[i];
        m->image->start_turns[i] = 0;
    }
    for (int i = 0; i < m->image->reals; i++) {
        m->image->start_real[i] = from[m->image->angles + i];
    }
    void *run = kind->start(m->image);
    TEST_ASSERT_NOT_NULL(run);
    const bool done = kind->step(run) == WH_OK;
    kind->state(run, to, to + m->image->angles);
    kind->stop(run);
    return done;
}

static double largest(const double *from, const double *to, int begin, int end) {
    double size = 0.0;
    for (int k = begin; k < end; k++) {
        size = fmax(size, fmax(fabs(from[k]), fabs(to[k])));
    }
    return size;
}

/* The largest size of a component of i's kind, angles, positions or rates, before and after a step, and of a position's
 * way: where terms cancel, a component is small and its rounding is not. */
static double size_of(const image *im, int i, const double *from, const double *to) {
    const int count = im->angles + im->reals;
    const int rates = im->form == WH_SECOND_ORDER ? im->coordinates : im->angles;
    const double way = im->step_s * largest(from, to, rates, count);
    return i < im->angles ? fmax(way, largest(from, to, 0, im->angles))
           : i < rates    ? fmax(way, largest(from, to, im->angles, rates))
                          : largest(from, to, rates, count);
}

static void compare(const motion *path, const motion *plain, const engine_kind *kind,
                    const double *from, double within, const char *name) {
    double one[VALUES];
    double other[VALUES];
    const bool done = step_from(path, kind, from, one);
    TEST_ASSERT_EQUAL_INT_MESSAGE(done, step_from(plain, kind, from, other), name);
    for (int i = 0; i < plain->image->angles + plain->image->reals; i++) {
        const double size = size_of(plain->image, i, from, other);
        TEST_ASSERT_TRUE_MESSAGE(fabs(one[i] - other[i]) <= within * size, name);
    }
    compared++;
}

static int paths_of_a_scene(const scene *s) {
    stepping how = {.kind = &engine_double, .method = WH_RK4_PLAIN};
    motion plain;
    motion_open(&plain, s->name, how);
    how.method = WH_RK4;
    for (int i = 0; i < 3 && plain.image->contacts == 0; i++) {
        how.angles = i == 1 ? ANGLES_LOOKUP : ANGLES_TURNED;
        how.ledger = i == 2;
        if (how.ledger && !plain.image->has_energies) {
            continue;
        }
        motion path;
        motion_open(&path, s->name, how);
        for (int k = 0; k < DRAWS && motion_step(&plain, 1 + random_bits(&seed) % 50) == WH_OK;
             k++) {
            double from[VALUES];
            plain.kind->state(plain.run, from, from + plain.image->angles);
            compare(&path, &plain, &engine_double, from, 1e-13, s->name);
            compare(&path, &plain, &engine_float, from, 4.0 * (double)FLT_EPSILON, s->name);
        }
        motion_close(&path);
    }
    motion_close(&plain);
    return 1;
}

static void test_all_paths_step_as_the_plain_one(void) {
    each_builtin_scene(paths_of_a_scene);
    TEST_ASSERT_TRUE(compared > 500);
}

void suite_rk4(void) {
    seed = 20261129;
    RUN_TEST(test_all_paths_step_as_the_plain_one);
}
