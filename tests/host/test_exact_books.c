/* test_exact_books.c: a run with --matrix exact must be accepted with any step: its motion is exact, although the
 * energy balance is integrated too coarsely between long steps. Also scenes without external forces. */
#include "host/base/alloc.h"
#include "host/check/books.h"
#include "host/check/energy_residual.h"
#include "host/image/program.h"

#include "command.h"
#include "derived.h"
#include "motion.h"

/* === suite exact_books ======================================================================== */

static char *made_up(uint64_t *seed) {
    double r[8];
    for (int i = 0; i < 8; i++) {
        r[i] = random_between(seed, 0.5, 2.0);
    }
    return alloc_words(
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\ninput u = %.6f [N]\n"
        "T = %.6f [kg]*x'^2/2 + %.6f [kg]*y'^2/2\nV = %.6f [N/m]*x^2/2 + %.6f [N/m]*(x - y)^2/2\n"
        "F = %.6f [N*s/m]*(x' - y')^2/2\nQ(y) = u\n"
        "scene s { start x = %.6f [m], y' = %.6f [m/s]; until 10 [s] }\n",
        r[0], r[1], r[2], 90 * r[3], 60 * r[4], 0.3 * r[5], 0.02 * r[6], 0.3 * r[7]);
}

/* Largest error of x and y at the end, relative to a run in double with a fine step. *lost: did the energy balance
 * fail? */
static double try_one(const char *text, const engine_kind *kind, image_matrix_of matrix,
                      double step_s, bool *lost) {
    motion m;
    motion fine;
    bool diverged = false;
    motion_open_text(
        &m, text, (stepping){.kind = kind, .method = WH_RK4, .step_s = step_s, .matrix = matrix});
    motion_open_text(&fine, text,
                     (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = 1e-4});
    books *b = books_open(m.image);
    books_enter(b, kind, m.run);
    for (uint64_t k = 0; k < m.image->steps; k++) {
        diverged = diverged || motion_step(&m, 1) != WH_OK;
        if (!diverged) {
            books_enter(b, kind, m.run);
        }
    }
    motion_to(&fine, 10.0);
    const double off = fmax(fabs(motion_value(&m, "x") - motion_value(&fine, "x")),
                            fabs(motion_value(&m, "y") - motion_value(&fine, "y")));
    const energy_residual balance = energy_residual_of(b, kind, m.run);
    *lost = diverged || energy_residual_lost(&balance, ENERGY_RESIDUAL_LIMIT);
    books_close(b);
    motion_close(&m);
    motion_close(&fine);
    return off;
}

TEST(exact_books, long_exact_steps_cause_no_warning) {
    static const double step_s[] = {0.5, 0.2, 0.05, 0.01};
    uint64_t seed = 5;
    int coarse = 0;
    for (unsigned i = 0; i < usual_or(8, 4); i++) {
        char *text = made_up(&seed);
        for (size_t n = 0; n < sizeof step_s / sizeof step_s[0]; n++) {
            bool lost;
            for (int is_float = 0; is_float < 2; is_float++) {
                const double off = try_one(text, is_float ? &engine_float : &engine_double,
                                           MATRIX_EXACT, step_s[n], &lost);
                TEST_ASSERT_TRUE_MESSAGE(off < 1e-5, text);
                TEST_ASSERT_FALSE_MESSAGE(lost, text);
            }
            /* the same run by stages must not be accepted if its step is too long */
            const double off = try_one(text, &engine_double, MATRIX_NONE, step_s[n], &lost);
            coarse += lost;
            TEST_ASSERT_TRUE_MESSAGE(lost || off < 0.05, text);
        }
        free(text);
    }
    TEST_ASSERT_GREATER_THAN_INT((int)usual_or(8, 4), coarse);
}

/* === suite force_free ========================================================================= */
/* Scenes without external forces: momentum and centre of mass must stay constant with each scene's own step, apart from
 * the method's error.
 *
 * The deriver finds these scenes: the momentum of a length coordinate is conserved if no force, potential, loss or
 * contact acts on it. Explicit equations have no momenta; such a scene is included if it records its centre of mass. */

/* The project's limit for each such scene, in double: drift of the momenta [kg m/s] and of the centre of mass [m]
 * over the run. */
#define DRIFT_MOST 1e-8

/* Round-off: some hundred units in the last place of a metre. The drift must be below this if it has no other cause. */
#define ROUNDING 1e-13

typedef struct free_scene {
    const char *name;
    bool drifts; /* true: drifts by the method's error; false: only by round-off */
} free_scene;

static const free_scene FREE[] = {
    /* no force along x and y, whose rates are components of the state */
    {"cartesian_flight", false},
    {"cartesian_near_pole", false},
    {"epicyclic_from_rest", true},
    {"thomson_a", true},
    {"thomson_b", true},
    {"thomson_a_spin", true},
    {"thomson_b_spin", true},
    /* the carriage is recovered from its momentum */
    {"epicyclic_conserved", false},
    {"thomson_a_conserved", false},
    {"thomson_b_conserved", false},
    {"thomson_plane_conserved", false},
    {"thomson_plane_a", true},
    {"thomson_plane_b", true},
    {"thomson_pair_a", true},
    {"thomson_pair_b", true},
    /* the weights are equal, so their centre of mass is fixed on the carriage */
    {"laskowitz_shifted", false},
    {"laskowitz_centred", false},
    {"laskowitz_uneven", true},
    /* the momentum is a sum of constants times rates */
    {"laskowitz_shift", false},
    {"cuff_equal", false},
    {"cuff_uneven", true},
    {"carriage_free", true},
    {"carriage_ratio", true},
    {"halvorson_smooth", true},
    /* the hold acts between disc and carriage only */
    {"thomson_magnet", true},
    {"thomson_magnet_conserved", false},
    /* momentum of the belt, which keeps its speed under any friction */
    {"belt_stick_slip", false},
    {"belt_stiffening", false},
};

enum { FREE_COUNT = sizeof FREE / sizeof FREE[0] };

static bool is_length(const symbol *s) {
    for (int i = 0; i < DIM_BASES; i++) {
        if (s->dim.twelfths[i] != (i == DIM_LENGTH ? DIM_DENOMINATOR : 0)) {
            return false;
        }
    }
    return !s->is_angle;
}

/* Is unknown i a length along which no external force acts? */
static bool is_free_along(const equations *e, int i) {
    return e->conserved != NULL && e->conserved[i] && is_length(e->unknowns[i].symbol);
}

/* Is `output` the centre of mass ("x_cm") along a coordinate ("X" or "x") without external force? */
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

/* Returns 1 if the scene has no external forces. Fails the test if the list above says otherwise. */
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

TEST(force_free, no_force_free_scene_is_forgotten) {
    TEST_ASSERT_EQUAL_INT(FREE_COUNT, each_builtin_scene(check_listed));
}

enum { QUANTITIES_MAX = 8 };

/* Momenta along the free coordinates, then positions of the centre of mass. */
typedef struct drifts {
    unsigned count;
    unsigned momenta; /* number of momenta */
    char name[QUANTITIES_MAX][32];
    double drift[QUANTITIES_MAX]; /* largest difference from the start, SI */
} drifts;

static void look(const motion *m, const char *const *centre, unsigned centres, const double *start,
                 double *worst) {
    for (unsigned i = 0; i < centres; i++) {
        const double value = motion_value(m, centre[i]);
        TEST_ASSERT_TRUE_MESSAGE(isfinite(value), centre[i]);
        worst[i] = fmax(worst[i], fabs(value - start[i]));
    }
}

/* Runs the scene with its own step. Takes a sample every millisecond, or every step if the step is longer. */
static drifts drifts_of(const char *name) {
    motion m;
    drifts d = {0};
    const char *centre[QUANTITIES_MAX];
    double start[QUANTITIES_MAX];
    double worst[QUANTITIES_MAX] = {0.0};
    unsigned centres = 0;
    motion_open(&m, name, IN_DOUBLE);
    const mechanism *of = m.instance->mechanism;
    for (int i = 0; i < of->output_count; i++) {
        if (is_free_centre(m.equations, of->outputs[i])) {
            TEST_ASSERT_TRUE(centres < QUANTITIES_MAX);
            centre[centres] = of->outputs[i]->name;
            start[centres] = motion_value(&m, centre[centres]);
            centres++;
        }
    }
    /* this test reads only momenta, so the ledger need not be told of every step */
    books *b = books_open(m.image);
    const double own_step_s = m.instance->step_s;
    const uint64_t steps = (uint64_t)floor(m.instance->until_s / own_step_s + 0.5);
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
            /* a centre of mass can only be constant if the momentum is zero */
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

TEST(force_free, momentum_and_centre_are_constant) {
    for (unsigned i = 0; i < FREE_COUNT; i++) {
        const double most = FREE[i].drifts ? DRIFT_MOST : ROUNDING;
        const drifts d = drifts_of(FREE[i].name);
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

/* === suite ledger_scenes ====================================================================== */
/* The energy balance must not change the run of a built-in scene. test_contact.c tests the entries. */

static int check_bits_with_books(const scene *s) {
    static const engine_kind *const kinds[] = {&engine_float, &engine_double};
    if (s->mechanism->is_system) {
        return 0;
    }
    for (int k = 0; k < 2; k++) {
        uint64_t hash[2];
        for (int with = 0; with < 2; with++) {
            motion m;
            motion_open(&m, s->name,
                        (stepping){.kind = kinds[k], .method = WH_RK4, .ledger = with});
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 400));
            hash[with] = m.kind->hash(m.run);
            motion_close(&m);
        }
        TEST_ASSERT_TRUE_MESSAGE(hash[0] == hash[1], s->name);
    }
    return 1;
}

/* Each scene must give the same bits with and without the energy balance, in float and double. */
TEST(ledger_scenes, ledger_changes_no_bit) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_bits_with_books) > 40);
}

/* A system of equations has no energies. Its energy balance must be refused instead of printed as zero. */
TEST(ledger_scenes, systems_have_no_ledger) {
    static const char text[] = "mechanism decay\nstate x\nparameter k = 1 [1/s]\n"
                               "equation x' = -k*x\nscene d {\n  with ledger\n  start x = 1\n}\n";
    diags *errors = diags_new();
    whirl_model *all = model_parse("t", text, strlen(text), errors);
    TEST_ASSERT_NOT_NULL(all);
    instance *inst = instance_make(all->mechanisms[0], all->scenes[0], NULL, errors);
    equations *e = inst != NULL ? equations_derive(inst, errors) : NULL;
    image *p = e != NULL ? image_make(e, NULL, &plainly, IMAGE_TO_RUN, errors) : NULL;
    TEST_ASSERT_NULL(p);
    TEST_ASSERT_TRUE(diags_count(errors) == 1);
    equations_free(e);
    instance_free(inst);
    model_free(all);
    diags_free(errors);
}
