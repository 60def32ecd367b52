/* test_force_free.c: the scenes that feel no force from outside: their momentum and their centre of
 * mass stay, at the step each scene names, and what is left is the method's error.
 *
 * Which scenes these are is not the list's word: a scene belongs here when the deriver finds the
 * momentum of a length coordinate conserved (no force, potential, loss or contact acts on it), or,
 * for equations given outright, which have no momenta, when it records its centre of mass. */
#include "derived.h"
#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "host/check/books.h"

#include "unity.h"

void suite_force_free(void);

/* What the project asks of every such scene: drift of the momenta [kg m/s] and of the centre of mass
 * [m] over the scene's whole run, in double. */
#define DRIFT_MOST 1e-8

/* Rounding: some hundred units in the last place of a metre. A drift below that has no order, and a
 * scene whose design leaves nothing to drift must stay below it. */
#define ROUNDING 1e-13

typedef struct free_scene {
    const char *name;
    /* Where the order is measured: at this step and at a quarter of it, up to a time at which the
     * motion is not chaotic yet. Zeros: nothing can drift but by rounding. */
    double step_s;
    double until_s;
} free_scene;

static const free_scene FREE[] = {
    /* no force along x and y, where the speed is a component of the state */
    {"cartesian_flight", 0.0, 0.0},
    {"cartesian_near_pole", 0.0, 0.0},
    {"epicyclic_from_rest", 4e-3, 9.0},
    {"thomson_a", 0.8e-3, 8.0},
    {"thomson_b", 0.25e-3, 4.0},
    {"thomson_a_spin", 1e-3, 8.0},
    {"thomson_b_spin", 0.25e-3, 4.0},
    /* the carriage from its momentum */
    {"epicyclic_conserved", 0.0, 0.0},
    {"thomson_a_conserved", 0.0, 0.0},
    {"thomson_b_conserved", 0.0, 0.0},
    {"thomson_plane_conserved", 0.0, 0.0},
    {"thomson_plane_a", 2e-3, 8.0},
    {"thomson_plane_b", 0.5e-3, 4.0},
    {"thomson_pair_a", 1e-3, 8.0},
    {"thomson_pair_b", 0.5e-3, 4.0},
    /* equal weights: their centre of mass rests on the carriage */
    {"laskowitz_shifted", 0.0, 0.0},
    {"laskowitz_centred", 0.0, 0.0},
    {"laskowitz_uneven", 8e-3, 5.0},
    /* the momentum is a sum of constants times rates */
    {"laskowitz_shift", 0.0, 0.0},
    {"cuff_equal", 0.0, 0.0},
    {"cuff_uneven", 8e-3, 5.0},
    {"carriage_free", 4e-3, 2.0},
    {"carriage_ratio", 4e-3, 2.0},
    /* the fourth-order error comes and goes with every turn; what adds up later is of the fifth */
    {"halvorson_smooth", 1.6e-3, 1.0},
    /* the hold acts between disc and carriage */
    {"thomson_magnet", 1e-3, 5.0},
    {"thomson_magnet_conserved", 0.0, 0.0},
    /* the belt's own momentum: it runs on, whatever rubs on it */
    {"belt_stick_slip", 0.0, 0.0},
    {"belt_stiffening", 0.0, 0.0},
};

enum { FREE_COUNT = sizeof FREE / sizeof FREE[0] };

/* --- which scenes are free of outside forces ------------------------------------------------------- */

static bool is_length(const symbol *s) {
    for (int i = 0; i < DIM_BASES; i++) {
        if (s->dim.twelfths[i] != (i == DIM_LENGTH ? DIM_DENOMINATOR : 0)) {
            return false;
        }
    }
    return !s->is_angle;
}

/* A coordinate along which nothing pushes the mechanism as a whole. */
static bool is_free_along(const equations *e, int i) {
    return e->conserved != NULL && e->conserved[i] && is_length(e->unknowns[i].symbol);
}

/* Is `output` the centre of mass ("x_cm") along a free coordinate ("X" or "x")? */
static bool is_free_centre(const equations *e, const symbol *output) {
    if (strcmp(output->name + 1, "_cm") != 0) {
        return false;
    }
    for (int i = 0; i < e->count; i++) {
        const char *name = e->unknowns[i].symbol->name;
        if (strlen(name) == 1 && (name[0] | 32) == output->name[0]) {
            return e->kinetic == NULL || is_free_along(e, i);
        }
    }
    return false;
}

static bool is_force_free(const equations *e) {
    const mechanism *m = e->instance->mechanism;
    bool found = false;
    for (int i = 0; i < e->count; i++) {
        found = found || is_free_along(e, i);
    }
    for (int i = 0; i < m->output_count; i++) {
        found = found || is_free_centre(e, m->outputs[i]);
    }
    return found;
}

static bool listed(const char *name) {
    for (unsigned i = 0; i < FREE_COUNT; i++) {
        if (strcmp(FREE[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* 1 if it is force-free. Fails if the list says otherwise. */
static int check_listed(const scene *s) {
    diags *errors = diags_new();
    instance *inst = instance_make(s->mechanism, s, &(overrides){0}, errors);
    equations *e = inst == NULL ? NULL : equations_derive(inst, errors);
    if (e == NULL) {
        TEST_FAIL_MESSAGE(s->name);
        return 0;
    }
    const bool is_free = is_force_free(e);
    if (is_free != listed(s->name)) {
        printf("  %s: %s\n", s->name,
               is_free ? "force-free, but not in the list" : "listed, but feels a force");
    }
    TEST_ASSERT_EQUAL_MESSAGE(is_free, listed(s->name), s->name);
    equations_free(e);
    instance_free(inst);
    diags_free(errors);
    return is_free;
}

/* The list has every scene that is free of outside forces, and no other. */
static void test_no_force_free_scene_is_forgotten(void) {
    TEST_ASSERT_EQUAL_INT(FREE_COUNT, each_builtin_scene(check_listed));
}

/* --- drift ------------------------------------------------------------------------------------------- */

enum { QUANTITIES_MAX = 8 };

/* The momenta, then the places of the centre of mass, along the free coordinates. */
typedef struct drifts {
    unsigned count;
    unsigned momenta; /* the first so many */
    char name[QUANTITIES_MAX][32];
    double drift[QUANTITIES_MAX]; /* largest distance from the start, SI */
} drifts;

static void look(const motion *m, const char *const *centre, unsigned centres, const double *start,
                 double *worst) {
    for (unsigned i = 0; i < centres; i++) {
        const double value = motion_value(m, centre[i]);
        TEST_ASSERT_TRUE_MESSAGE(isfinite(value), centre[i]);
        worst[i] = fmax(worst[i], fabs(value - start[i]));
    }
}

/* A run of the scene, looked at every millisecond or at every step, whichever is longer; zeros: the
 * scene's own step and end. */
static drifts drifts_of(const char *name, double step_s, double until_s) {
    motion m;
    drifts d = {0};
    const char *centre[QUANTITIES_MAX];
    double start[QUANTITIES_MAX];
    double worst[QUANTITIES_MAX] = {0.0};
    unsigned centres = 0;
    motion_open(&m, name, IN_DOUBLE_STEP(step_s));
    const mechanism *of = m.instance->mechanism;
    for (int i = 0; i < of->output_count; i++) {
        if (is_free_centre(m.equations, of->outputs[i])) {
            TEST_ASSERT_TRUE(centres < QUANTITIES_MAX);
            centre[centres] = of->outputs[i]->name;
            start[centres] = motion_value(&m, centre[centres]);
            centres++;
        }
    }
    /* Only the books' momenta are read, which need not be entered at every step. */
    books *b = books_open(m.image);
    const double own_step_s = m.instance->step_s;
    const double end_s = until_s > 0.0 ? until_s : m.instance->until_s;
    const uint64_t steps = (uint64_t)floor(end_s / own_step_s + 0.5);
    const uint64_t stride = own_step_s < 1e-3 ? (uint64_t)floor(1e-3 / own_step_s + 0.5) : 1;
    TEST_ASSERT_TRUE(steps > 100);
    if (b != NULL) {
        books_enter(b, m.kind, m.run);
    }
    for (uint64_t done = 0; done < steps; done += stride) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, stride));
        look(&m, centre, centres, start, worst);
        if (b != NULL) {
            books_enter(b, m.kind, m.run);
        }
    }
    for (int i = 0; i < m.equations->count; i++) {
        if (b != NULL && is_free_along(m.equations, i)) {
            TEST_ASSERT_TRUE(d.count + centres < QUANTITIES_MAX);
            snprintf(d.name[d.count], sizeof d.name[0], "momentum of %.16s",
                     m.equations->unknowns[i].symbol->name);
            d.drift[d.count++] = b->drift[i];
            /* where it is not zero, the centre of mass moves on as it should */
            TEST_ASSERT_TRUE_MESSAGE(centres == 0 || fabs(b->momentum[i]) <= ROUNDING, name);
        }
    }
    d.momenta = d.count;
    for (unsigned i = 0; i < centres; i++) {
        snprintf(d.name[d.count], sizeof d.name[0], "%.31s", centre[i]);
        d.drift[d.count++] = worst[i];
    }
    books_close(b);
    motion_close(&m);
    TEST_ASSERT_TRUE_MESSAGE(d.count > 0, name);
    return d;
}

static void test_momentum_and_centre_of_mass_stay_at_each_scenes_own_step(void) {
    for (unsigned i = 0; i < FREE_COUNT; i++) {
        const double most = FREE[i].step_s > 0.0 ? DRIFT_MOST : ROUNDING;
        const drifts d = drifts_of(FREE[i].name, 0.0, 0.0);
        printf("  %-24s", FREE[i].name);
        for (unsigned k = 0; k < d.count; k++) {
            printf(" %s %.2g", d.name[k], d.drift[k]);
        }
        printf("\n");
        for (unsigned k = 0; k < d.count; k++) {
            TEST_ASSERT_TRUE_MESSAGE(d.drift[k] <= most, FREE[i].name);
        }
    }
}

/* Runge-Kutta's error at a step and at a quarter of it: 2^8 lies between, give or take what a sum of
 * thousands of steps' errors, which partly cancel, makes of it. What is below rounding at the coarse
 * step already (Y of the mirrored pair) has no order, but must stay there. */
static void test_drift_falls_at_fourth_order(void) {
    for (unsigned i = 0; i < FREE_COUNT; i++) {
        const free_scene *f = &FREE[i];
        if (f->step_s <= 0.0) {
            continue;
        }
        const drifts coarse = drifts_of(f->name, f->step_s, f->until_s);
        const drifts fine = drifts_of(f->name, f->step_s / 4.0, f->until_s);
        unsigned measured = 0;
        printf("  %-20s %g and %g ms, to %g s:", f->name, 1e3 * f->step_s, 250.0 * f->step_s,
               f->until_s);
        for (unsigned k = 0; k < coarse.count; k++) {
            if (coarse.drift[k] <= ROUNDING) {
                printf(" %s none", coarse.name[k]);
                TEST_ASSERT_TRUE_MESSAGE(fine.drift[k] <= ROUNDING, f->name);
                continue;
            }
            const double order = log2(coarse.drift[k] / fine.drift[k]) / 2.0;
            printf(" %s %.3f", coarse.name[k], order);
            measured++;
            TEST_ASSERT_TRUE_MESSAGE(order >= 3.7 && order <= 4.3, f->name);
        }
        printf("\n");
        TEST_ASSERT_TRUE_MESSAGE(measured > 0, f->name);
    }
}

void suite_force_free(void) {
    RUN_TEST(test_no_force_free_scene_is_forgotten);
    RUN_TEST(test_momentum_and_centre_of_mass_stay_at_each_scenes_own_step);
    RUN_TEST(test_drift_falls_at_fourth_order);
}
