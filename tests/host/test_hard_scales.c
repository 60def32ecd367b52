/* test_hard_scales.c: random planar linkages with units of mass, length and time that differ by factors from 1e-12
 * to 1e12. Powers of two change no digit of a product or quotient, so the motion must be the same, except for the
 * sequence of sums. At the end of float's range, a run must report this and never change silently. */
#include "command.h"
#include "host/cli/commands.h"
#include "linkage.h"
#include "motion.h"

enum { STEPS = 50 };

static unsigned cases(void) { return dice_cases(few_or_all(3, 30)); }

typedef struct moved {
    wh_status status;
    double value[2 * LINKAGE_BODIES]; /* coordinates, then rates, in SI units */
} moved;

typedef struct units {
    double mass, length, time;
} units;

static linkage in_units(const linkage *of, units u) {
    linkage s = *of;
    const double force = u.mass * u.length / (u.time * u.time);
    for (int axis = 0; axis < 2; axis++) {
        s.gravity_mps2[axis] *= u.length / (u.time * u.time);
    }
    for (int k = 0; k < s.bodies; k++) {
        linkage_body *b = &s.body[k];
        const double way = b->slides ? u.length : 1.0; /* factor of the coordinate's unit */
        const double load = b->slides ? force : force * u.length;
        b->at_m *= u.length;
        b->centre_m *= u.length;
        b->mass_kg *= u.mass;
        b->inertia_kgm2 *= u.mass * u.length * u.length;
        b->stiffness *= load / way;
        b->rest *= way;
        b->damping *= load * u.time / way;
        b->drive *= load;
        b->wave /= way;
        b->drag_Nspm *= u.mass / u.time;
        s.start[k] *= way;
        s.start_rate[k] *= way / u.time;
    }
    for (int k = 0; k < s.springs; k++) {
        s.spring[k].x_m *= u.length;
        s.spring[k].y_m *= u.length;
        s.spring[k].length_m *= u.length;
        s.spring[k].stiffness_Npm *= u.mass / (u.time * u.time);
    }
    return s;
}

static const char *text_of(const linkage *of, units u) {
    static char text[LINKAGE_TEXT];
    linkage_write(of, "scaled",
                  (linkage_writing){.forces = LINKAGE_INSIDE, .until_s = 500.0 / 1024.0 * u.time},
                  text);
    return text;
}

static moved run_of(const linkage *of, units u, const engine_kind *kind, image_angles angles) {
    const linkage s = in_units(of, u);
    motion m;
    moved end = {.status = WH_OK};
    motion_open_text(&m, text_of(&s, u),
                     (stepping){.kind = kind, .method = WH_RK4, .angles = angles});
    end.status = motion_step(&m, STEPS);
    for (int k = 0; k < of->bodies; k++) {
        const double way = of->body[k].slides ? u.length : 1.0;
        char name[20];
        snprintf(name, sizeof name, "q%d", k);
        end.value[k] = motion_value(&m, name) / way;
        snprintf(name, sizeof name, "q%d'", k);
        end.value[LINKAGE_BODIES + k] = motion_value(&m, name) / (way / u.time);
    }
    motion_close(&m);
    return end;
}

static double apart(const moved *a, const moved *b) {
    double most = 0.0;
    for (int k = 0; k < 2 * LINKAGE_BODIES; k++) {
        most = fmax(most, fabs(a->value[k] - b->value[k]));
    }
    return most;
}

static double power_of_two(dice *d, int most) {
    return ldexp(1.0, (int)dice_one_of(d, (unsigned)(2 * most + 1)) - most);
}

static bool warns(const char *text) {
    static said what;
    COMMAND_SAY(command_run, &what, model_keep(text), "--number", "float", "--quiet");
    model_drop();
    return what.status == said_owes(what.err) && strstr(what.err, "float cannot represent") != NULL;
}

/* Units are multiplied by powers of two up to 2^most. The other members are the results of the runs. */
typedef struct reach {
    const int most;
    unsigned same; /* number of runs with identical bits */
    unsigned none; /* number of runs that were refused or had a warning */
    double worst;  /* largest error of the other runs */
} reach;

/* Runs a linkage in random units and compares the motion with that in SI units. */
static void held_against(const moved *plain, const linkage *of, const engine_kind *kind, units u,
                         double most_off, reach *r) {
    const moved scaled = run_of(of, u, kind, ANGLES_TURNED);
    const linkage s = in_units(of, u);
    const double off = apart(plain, &scaled);
    const bool within = off <= most_off;
    if (scaled.status != WH_OK || (!within && kind == &engine_float && warns(text_of(&s, u)))) {
        r->none++;
        return;
    }
    if (!within) {
        char line[160];
        printf("%s\n", text_of(&s, u));
        snprintf(line, sizeof line, "masses by %g, lengths by %g, times by %g: off by %.2e", u.mass,
                 u.length, u.time, off);
        TEST_FAIL_MESSAGE(line);
    }
    r->worst = fmax(r->worst, off);
    r->same += memcmp(plain, &scaled, sizeof scaled) == 0 ? 1U : 0U;
}

enum { REACHES = 3 };

/* Runs each linkage in units of each range. The error must be within `most_off`; or the run must be refused or, in
 * float, warn. */
static void in_all_units(const engine_kind *kind, double most_off, reach *reached) {
    dice d = dice_of("hard_scales", 16);
    uint64_t seed = d.state;
    for (unsigned k = 0; k < cases(); k++) {
        const linkage of = linkage_draw(&seed);
        const moved plain = run_of(&of, (units){1.0, 1.0, 1.0}, kind, ANGLES_TURNED);
        TEST_ASSERT_EQUAL_INT(WH_OK, plain.status);
        for (int i = 0; i < REACHES; i++) {
            const int most = reached[i].most;
            const units u = {power_of_two(&d, most), power_of_two(&d, most),
                             power_of_two(&d, most)};
            held_against(&plain, &of, kind, u, most_off, &reached[i]);
        }
    }
    for (int i = 0; i < REACHES; i++) {
        printf("  up to 2^%d: %u of %u in the same bits, off by at most %.1e; %u refused or warned "
               "of\n",
               reached[i].most, reached[i].same, cases(), reached[i].worst, reached[i].none);
    }
}

TEST(hard_scales, units_do_not_matter_in_double) {
    reach reached[REACHES] = {{.most = 4}, {.most = 20}, {.most = 40}};
    in_all_units(&engine_double, 1e-11, reached);
    TEST_ASSERT_EQUAL_UINT(0, reached[0].none);
    TEST_ASSERT_EQUAL_UINT(0, reached[1].none);
    TEST_ASSERT_TRUE(reached[2].none * 4 <= cases());
}

TEST(hard_scales, units_do_not_matter_in_float) {
    reach reached[REACHES] = {{.most = 4}, {.most = 12}, {.most = 40}};
    in_all_units(&engine_float, 1e-4, reached);
    TEST_ASSERT_EQUAL_UINT(0, reached[0].none);
    TEST_ASSERT_TRUE(reached[1].none * 4 <= cases());
    TEST_ASSERT_TRUE(reached[2].none * 4 <= cases());
}

/* The reference in long double, from the energies in numbers, with the same method and step but without rotated
 * sines. *least: the result of linkage_solve(). */
static moved by_numbers(const linkage *of, double *least) {
    linkage_motion wanted;
    moved end = {.status = WH_OK};
    linkage_integrate(of, 1.0 / 1024.0, STEPS, &wanted);
    for (int i = 0; i < 2 * LINKAGE_BODIES; i++) {
        end.value[i] = (double)wanted.state[i];
    }
    *least = (double)wanted.least;
    return end;
}

static double largest_of(const moved *m) {
    double largest = 1.0;
    for (int i = 0; i < 2 * LINKAGE_BODIES; i++) {
        const double size = fabs(m->value[i]);
        largest = isfinite(size) ? fmax(largest, size) : (double)INFINITY;
    }
    return largest;
}

/* Multiplies the masses, inertias and forces of each body by 1, 10^decades or 10^-decades at random. */
static void make_unequal(linkage *of, double decades, dice *d) {
    of->springs = 0;
    for (int i = 0; i < of->bodies; i++) {
        const double factor = pow(10.0, decades * ((double)dice_one_of(d, 3) - 1.0));
        of->body[i].mass_kg *= factor;
        of->body[i].inertia_kgm2 *= factor;
        of->body[i].stiffness *= factor;
        of->body[i].damping *= factor;
        of->body[i].drag_Nspm *= factor;
        of->body[i].drive *= factor;
    }
}

/* How much a relative change `share` of the start changes the final state. */
static double carried(const linkage *of, const moved *wanted, double share) {
    linkage near = *of;
    double least;
    for (int k = 0; k < of->bodies; k++) {
        near.start[k] *= 1.0 + share;
        near.start_rate[k] *= 1.0 - share;
    }
    const moved other = by_numbers(&near, &least);
    return apart(wanted, &other);
}

/* If the reference exceeds this, the run diverges: the step is too long, as for a heavy body's damper on a light
 * body. */
#define GROWN 1e12

/* Runs with unequal masses. The expected relative error of an acceleration is one unit in the last place (`last`),
 * divided by the smallest ratio of a pivot to its diagonal entry. */
typedef struct unequal {
    double worst; /* largest relative error of runs whose pivot ratios all exceed 1e-4 */
    /* runs whose error exceeds 100 times the expected one, and the effect of an equal change of the start */
    unsigned beyond;
    unsigned plain; /* number of runs that count in `worst` */
} unequal;

static unequal of_unequal(const engine_kind *kind, double decades, double last) {
    dice d = dice_of("hard_scales", 17);
    uint64_t seed = d.state;
    unequal sum = {0.0, 0, 0};
    unsigned grown = 0;
    for (unsigned k = 0; k < cases(); k++) {
        double least;
        linkage of = linkage_draw(&seed);
        make_unequal(&of, decades, &d);
        const moved wanted = by_numbers(&of, &least);
        const moved found = run_of(&of, (units){1.0, 1.0, 1.0}, kind, ANGLES_LOOKUP);
        const double largest = largest_of(&wanted);
        const double off = apart(&wanted, &found);
        if (!(largest < GROWN)) {
            /* the run must diverge, too, or agree with the reference within a half */
            grown++;
            TEST_ASSERT_TRUE(found.status != WH_OK || (isfinite(largest) && off < 0.5 * largest));
            continue;
        }
        TEST_ASSERT_EQUAL_INT(WH_OK, found.status);
        const double share = 100.0 * last / least;
        if (off > share * largest && off > carried(&of, &wanted, share)) {
            printf("%s# off by %.2e, of %.3g left\n", text_of(&of, (units){1.0, 1.0, 1.0}), off,
                   least);
            sum.beyond++;
        }
        if (least > 1e-4) {
            sum.plain++;
            sum.worst = fmax(sum.worst, off / largest);
        }
    }
    TEST_ASSERT_TRUE(grown * 10 <= cases());
    printf("  %.3g decades: %u grow; %u keep four digits and are off by at most %.1e\n", decades,
           grown, sum.plain, sum.worst);
    return sum;
}

TEST(hard_scales, masses_of_very_different_size) {
    const unequal in_double = of_unequal(&engine_double, 3.0, DBL_EPSILON);
    const unequal in_float = of_unequal(&engine_float, 1.5, (double)FLT_EPSILON);
    TEST_ASSERT_EQUAL_UINT(0, in_double.beyond);
    TEST_ASSERT_EQUAL_UINT(0, in_float.beyond);
    TEST_ASSERT_TRUE(in_double.plain > 0 && in_float.plain > 0);
}
