/* test_arm.c: arms with six joints. The derived equations are compared with the recursion of Newton and Euler (Luh,
 * Walker and Paul 1980) in world coordinates, which uses no energies. */
#include "test.h"

#include "host/base/alloc.h"
#include "host/cli/commands.h"

#include "command.h"
#include "derived.h"
#include "linkage.h"
#include "motion.h"

/* === suite arm ================================================================================ */

enum { JOINTS = 6 };
#define G 9.81

typedef struct arm_arm {
    int axis[JOINTS]; /* axis of the joint, in its own frame: 0, 1 or 2 */
    /* distance from the previous joint along the z axis of the previous frame, m */
    double offset[JOINTS];
    double centre[JOINTS];     /* distance of the centre of mass along z, m */
    double mass[JOINTS];       /* kg */
    double inertia[JOINTS][3]; /* moments of inertia about the centre of mass, kg m^2 */
} arm_arm;

static arm_arm draw_arm(dice *d) {
    static const int axes[3][JOINTS] = {{2, 1, 1, 2, 1, 2}, {2, 1, 1, 0, 1, 0}, {2, 0, 1, 2, 0, 2}};
    const int *axis = axes[dice_one_of(d, 3)];
    arm_arm a;
    for (int i = 0; i < JOINTS; i++) {
        a.axis[i] = axis[i];
        a.offset[i] = dice_one_of(d, 3) == 0 ? 0.0 : dice_between(d, 0.05, 0.5);
        a.centre[i] = dice_between(d, 0.02, 0.3);
        a.mass[i] = dice_between(d, 0.3, 8.0);
        for (int k = 0; k < 3; k++) {
            a.inertia[i][k] = a.mass[i] * dice_between(d, 0.001, 0.02);
        }
    }
    return a;
}

/* Entry of the rotation matrix from frame i to the previous frame: "cos(q1)", "-sin(q1)", "1" or "0". */
static const char *entry(const arm_arm *a, int i, int row, int column, char text[20]) {
    const int k = a->axis[i];
    if (row == k || column == k) {
        return row == column ? "1" : "0";
    }
    const bool minus = column == (row + 1) % 3;
    snprintf(text, 20, "%s%s(q%d)", minus ? "-" : "", row == column ? "cos" : "sin", i);
    return text;
}

/* Writes the arm as users of SymPy would: rotated frames, positions of the centres in the world, and derivatives of
 * these. */
static char *text_of(const arm_arm *a) {
    char *text;
    size_t length;
    char e[20];
    FILE *out = alloc_text(&text, &length);
    fputs("mechanism arm\n", out);
    for (int i = 0; i < JOINTS; i++) {
        fprintf(out, "coordinate q%d [rad]\n", i);
    }
    for (int i = 0; i < JOINTS; i++) {
        for (int row = 0; row < 3;
             row++) { /* R: the axes of link i in the world; p: its joint; c: its centre of mass */
            for (int k = 0; k < 3; k++) {
                fprintf(out, "let R%d_%d%d = 0", i, row, k);
                for (int j = 0; j < 3 && i > 0; j++) {
                    fprintf(out, " + R%d_%d%d*(%s)", i - 1, row, j, entry(a, i, j, k, e));
                }
                fprintf(out, " + (%s)\n", i == 0 ? entry(a, i, row, k, e) : "0");
            }
            fprintf(out, "let p%d_%d = 0 [m]", i, row);
            if (i > 0) {
                fprintf(out, " + p%d_%d + %.17g [m]*R%d_%d2", i - 1, row, a->offset[i], i - 1, row);
            }
            fprintf(out, "\nlet c%d_%d = p%d_%d + %.17g [m]*R%d_%d2\n", i, row, i, row,
                    a->centre[i], i, row);
        }
    }
    fputs("T = (0 [J]", out);
    for (int i = 0; i < JOINTS; i++) {
        fprintf(out, "\n  + %.17g [kg]*(c%d_0'^2 + c%d_1'^2 + c%d_2'^2)/2", a->mass[i], i, i, i);
        for (int k = 0; k < 3; k++) {
            /* the rate of axis b along axis c is the angular velocity about axis k */
            const int b = (k + 1) % 3;
            const int c = (k + 2) % 3;
            fprintf(
                out,
                " + %.17g [kg*m^2]/2*(R%d_0%d'*R%d_0%d + R%d_1%d'*R%d_1%d + R%d_2%d'*R%d_2%d)^2",
                a->inertia[i][k], i, b, i, c, i, b, i, c, i, b, i, c);
        }
    }
    fputs(")\nV = (0 [J]", out);
    for (int i = 0; i < JOINTS; i++) {
        fprintf(out, " + %.17g [N]*c%d_2", a->mass[i] * G, i);
    }
    fputs(")\n", out);
    alloc_text_end(out);
    return text;
}

typedef struct vector {
    double x[3];
} vector;

static vector plus(vector a, double scale, vector b) {
    return (vector){{a.x[0] + scale * b.x[0], a.x[1] + scale * b.x[1], a.x[2] + scale * b.x[2]}};
}

static vector cross(vector a, vector b) {
    return (vector){{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
                     a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

static double dot(vector a, vector b) {
    return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/* The torque of each joint, N m. *size: the sum of the absolute terms. */
static void torques(const arm_arm *a, const state_values *s, double *torque, double *size) {
    vector frame[JOINTS][3]; /* axes of each link, in the world */
    vector joint[JOINTS];
    /* the force that accelerates link i, and the moment about its centre of mass */
    vector force[JOINTS];
    vector moment[JOINTS];
    vector at[JOINTS]; /* position of the centre of mass */
    vector axes[3] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    vector w = {{0}};
    vector turn = {{0}}; /* angular acceleration of the link */
    vector p = {{0}};
    vector lift = {{0, 0, G}}; /* acceleration of the joint, plus that of gravity */
    for (int i = 0; i < JOINTS; i++) {
        const int k = a->axis[i];
        const double q = s->value[i][0];
        if (i > 0) {
            const vector arm_to = plus((vector){{0}}, a->offset[i], axes[2]);
            lift = plus(plus(lift, 1.0, cross(turn, arm_to)), 1.0, cross(w, cross(w, arm_to)));
            p = plus(p, 1.0, arm_to);
        }
        const vector one = axes[(k + 1) % 3];
        const vector two = axes[(k + 2) % 3];
        axes[(k + 1) % 3] = plus(plus((vector){{0}}, cos(q), one), sin(q), two);
        axes[(k + 2) % 3] = plus(plus((vector){{0}}, cos(q), two), -sin(q), one);
        turn = plus(plus(turn, s->value[i][2], axes[k]), s->value[i][1], cross(w, axes[k]));
        w = plus(w, s->value[i][1], axes[k]);
        memcpy(frame[i], axes, sizeof axes);
        joint[i] = p;
        const vector out = plus((vector){{0}}, a->centre[i], axes[2]);
        const vector accel = plus(plus(lift, 1.0, cross(turn, out)), 1.0, cross(w, cross(w, out)));
        at[i] = plus(p, 1.0, out);
        force[i] = plus((vector){{0}}, a->mass[i], accel);
        vector spin = {{0}};
        moment[i] = (vector){{0}};
        for (int j = 0; j < 3; j++) {
            spin = plus(spin, a->inertia[i][j] * dot(w, axes[j]), axes[j]);
            moment[i] = plus(moment[i], a->inertia[i][j] * dot(turn, axes[j]), axes[j]);
        }
        moment[i] = plus(moment[i], 1.0, cross(w, spin));
    }
    for (int i = 0; i < JOINTS; i++) {
        torque[i] = 0.0;
        size[i] = 0.0;
        for (int j = i; j < JOINTS; j++) {
            const vector about = plus(moment[j], 1.0, cross(plus(at[j], -1.0, joint[i]), force[j]));
            torque[i] += dot(about, frame[i][a->axis[i]]);
            size[i] += fabs(dot(about, frame[i][a->axis[i]]));
        }
    }
}

TEST(arm, six_joint_arms_match_newton_euler) {
    dice d = dice_of("arm", 4701);
    double worst = 0.0;
    for (unsigned c = 0; c < few_or_all(1, 4); c++) {
        const arm_arm a = draw_arm(&d);
        char *text = text_of(&a);
        diags *errors = diags_new();
        derived made = {.model = model_parse("arm.whirl", text, strlen(text), errors)};
        TEST_ASSERT_NOT_NULL_MESSAGE(made.model, text);
        made.instance = instance_make(made.model->mechanisms[0], NULL, NULL, errors);
        made.equations = equations_derive(made.instance, errors);
        diags_flush(errors, stdout);
        TEST_ASSERT_NOT_NULL(made.equations);
        for (unsigned long k = 0; k < 5; k++) {
            state_values s = {.instance = made.instance};
            double torque[JOINTS];
            double size[JOINTS];
            double accel[JOINTS];
            for (int i = 0; i < JOINTS; i++) {
                for (int primes = 0; primes < 3; primes++) {
                    s.value[i][primes] = dice_between(&d, -3.0, 3.0);
                }
                accel[i] = s.value[i][2];
            }
            torques(&a, &s, torque, size);
            for (int i = 0; i < JOINTS; i++) {
                double of_terms;
                const double is = derived_rest(&made, &s, accel, i, &of_terms);
                worst = fmax(worst, fabs(is - torque[i]) / (1.0 + size[i] + of_terms));
            }
        }
        derived_free(&made);
        diags_free(errors);
        free(text);
    }
    printf("  off by at most %.2g of the terms\n", worst);
    TEST_ASSERT_TRUE(worst < 1e-13);
}

/* === suite residual_invariance ================================================================ */
/* The energy residual (host/check/energy_residual.h) must not depend on choices that have no effect on the motion:
 * the origin, and the vector potential of a magnetic field, which adds terms linear in the rates to T. */

typedef struct charge {
    double mass_kg;
    double field_kgps;
    double speed_mps;
    double spring_Npm; /* stiffness of a spring to the starting point */
    const char *method;
    double step_s;
} charge;

/* Three forms of the kinetic term of a magnetic field that give the same motion. */
static const char *const potentials[] = {"B*(x*y' - y*x')/2", "B*x*y'", "-B*y*x'"};
enum { POTENTIALS = sizeof potentials / sizeof potentials[0] };

/* The energy residual that Whirl reports, relative to the largest entry; 1 if the run diverges. *warned: did Whirl
 * warn of the residual or the divergence? */
static double left_over_leans(const charge *c, const char *potential, double x0, bool *warned) {
    char text[700];
    said what;
    snprintf(text, sizeof text,
             "mechanism charge\ncoordinate x [m]\ncoordinate y [m]\nparameter m = %.17g [kg]\n"
             "parameter B = %.17g [kg/s]\nparameter k = %.17g [N/m]\nparameter a = %.17g [m]\n"
             "T = m*(x'^2 + y'^2)/2 + %s\nV = k*((x - a)^2 + y^2)/2\n"
             "scene s { start x = %.17g [m], y' = %.17g [m/s]\nstep %.17g [s]\nuntil %.17g [s] }\n",
             c->mass_kg, c->field_kgps, c->spring_Npm, x0, potential, x0, c->speed_mps, c->step_s,
             300.0 * c->step_s);
    COMMAND_SAY(command_run, &what, model_keep(text), "--method", c->method);
    if (what.status == 1 && strstr(what.err, "the run diverged") != NULL) {
        *warned = true;
        return 1.0;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    const char *at = strstr(what.out, "\nenergy residual ");
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what.out);
    *warned = strstr(what.err, "energy balance fails") != NULL;
    return strtod(at + strlen("\nenergy residual "), NULL);
}

TEST(residual_invariance, origins_and_potentials) {
    static const char *const methods[] = {"nystroem5", "rk4", "heun", "semi-implicit-euler"};
    dice d = dice_of("residual_invariance", 61);
    unsigned told = 0;
    const unsigned runs = dice_cases(few_or_all(12, 60));
    for (unsigned k = 0; k < runs; k++) {
        charge c = {.mass_kg = dice_between(&d, 0.5, 2.0),
                    .field_kgps = dice_between(&d, 5.0, 40.0),
                    .speed_mps = dice_between(&d, 0.1, 1.0),
                    .method = methods[k % 4U]};
        c.spring_Npm = k % 3U == 0 ? dice_between(&d, 1.0, 50.0) : 0.0;
        c.step_s = dice_between(&d, 0.1, 0.6) * c.mass_kg / c.field_kgps;
        bool warned;
        const double by_itself = left_over_leans(&c, potentials[0], 0.0, &warned);
        told += warned;
        for (int i = 0; i < POTENTIALS; i++) {
            bool too;
            const double far_m = pow(10.0, dice_between(&d, -1.0, 2.5));
            const double other = left_over_leans(&c, potentials[i], far_m, &too);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(2e-3 * by_itself + 1e-9, by_itself, other, c.method);
            TEST_ASSERT_EQUAL_MESSAGE(warned, too, c.method);
        }
    }
    model_drop();
    printf("  %u of %u charges told\n", told, runs);
    TEST_ASSERT_TRUE(told > 0 && told < runs);
}

/* === suite linkages =========================================================================== */
/* Random planar linkages. Accelerations and motions derived from their text are compared with numeric derivatives of
 * the same energies (linkage.h). Forces written in effects must give the same motion as forces in the mechanism. The
 * residual of the energy balance must be small. WHIRL_CASES=N and WHIRL_SEED=N choose other cases. */

enum { LINKAGES_STATES = 10, STEPS = 100 };

static unsigned cases(void) { return dice_cases(few_or_all(usual_or(6, 3), 200)); }

/* One linkage in three has the test of effects. */
enum { ONE_IN = 3 };

static linkage drawn_linkage(dice *d, unsigned k) {
    uint64_t seed = d->state + 1000003U * k;
    return linkage_draw(&seed);
}

static const char *text_of_linkages(const linkage *of, linkage_writing how) {
    static char text[LINKAGE_TEXT];
    linkage_write(of, "linkage", how, text);
    return text;
}

static const linkage_writing as_usual = {.forces = LINKAGE_INSIDE};
static const linkage_writing backwards = {.forces = LINKAGE_INSIDE, .backwards = true};

static void expect(bool holds, const char *what, double figure, const char *text) {
    if (!holds) {
        char line[120];
        printf("%s\n", text);
        snprintf(line, sizeof line, "%s: %.3e", what, figure);
        TEST_FAIL_MESSAGE(line);
    }
}

static int unknown_of(const derived *d, int k) {
    char name[8];
    snprintf(name, sizeof name, "q%d", k);
    for (int i = 0; i < d->equations->count; i++) {
        if (strcmp(d->equations->unknowns[i].symbol->name, name) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(name);
    return 0;
}

/* Worst error of the accelerations of the operation list at random states, relative to the largest acceleration. */
static double worst_acceleration(const linkage *of, linkage_writing how, uint64_t *seed) {
    derived d = derived_text(text_of_linkages(of, how));
    double worst = 0.0;
    derived_expect(&d, text_of_linkages(of, how));
    for (int i = 0; i < LINKAGES_STATES; i++) {
        state_values s = {.instance = d.instance};
        linkage_numbers at;
        long double q[LINKAGE_BODIES];
        long double rate[LINKAGE_BODIES];
        double found[LINKAGE_BODIES];
        long double wanted[LINKAGE_BODIES];
        long double most = 0.0L;
        for (int k = 0; k < of->bodies; k++) {
            double *value = s.value[unknown_of(&d, k)];
            q[k] = (long double)(value[0] = random_between(seed, -1.5, 1.5));
            rate[k] = (long double)(value[1] = random_between(seed, -3.0, 3.0));
        }
        derived_run(d.image->list[IMAGE_STEP], &d, &s, found);
        linkage_evaluate(of, q, rate, &at);
        linkage_solve(of, &at, at.force, wanted);
        for (int k = 0; k < of->bodies; k++) {
            most = fmaxl(most, fabsl(wanted[k]));
        }
        for (int k = 0; k < of->bodies; k++) {
            const long double got = (long double)found[d.image->place[unknown_of(&d, k)]];
            worst = fmax(worst, (double)(fabsl(got - wanted[k]) / fmaxl(most, 1e-300L)));
        }
    }
    derived_free(&d);
    return worst;
}

TEST(linkages, accelerations_are_those_of_the_energies) {
    dice d = dice_of("linkages", 14);
    uint64_t seed = d.state;
    double worst = 0.0;
    for (unsigned k = 0; k < cases(); k++) {
        const linkage of = drawn_linkage(&d, k);
        const double off = worst_acceleration(&of, k % 2 == 0 ? as_usual : backwards, &seed);
        expect(off < 1e-10, "off, of the largest acceleration", off,
               text_of_linkages(&of, as_usual));
        worst = fmax(worst, off);
    }
    printf("  off by at most %.1e of the largest acceleration\n", worst);
    TEST_ASSERT_TRUE(worst > 0.0);
}

typedef struct moved {
    double value[2 * LINKAGE_BODIES]; /* coordinates, then rates */
} moved;

static double apart(const linkage *of, const moved *a, const moved *b) {
    double most = 0.0;
    for (int k = 0; k < of->bodies; k++) {
        most = fmax(most, fabs(a->value[k] - b->value[k]));
        most = fmax(most, fabs(a->value[LINKAGE_BODIES + k] - b->value[LINKAGE_BODIES + k]));
    }
    return most;
}

static moved run_by(const linkage *of, linkage_writing how, stepping by) {
    motion m;
    moved end = {{0}};
    motion_open_text(&m, text_of_linkages(of, how), by);
    TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, STEPS), text_of_linkages(of, how));
    for (int k = 0; k < of->bodies; k++) {
        char name[8];
        snprintf(name, sizeof name, "q%d", k);
        end.value[k] = motion_value(&m, name);
        snprintf(name, sizeof name, "q%d'", k);
        end.value[LINKAGE_BODIES + k] = motion_value(&m, name);
    }
    motion_close(&m);
    return end;
}

static moved run_of(const linkage *of, linkage_writing how, const engine_kind *kind) {
    return run_by(of, how, (stepping){.kind = kind, .method = WH_RK4});
}

static moved integrated(const linkage *of, double step_s, int steps) {
    linkage_motion wanted;
    moved end = {{0}};
    linkage_integrate(of, step_s, steps, &wanted);
    for (int i = 0; i < 2 * LINKAGE_BODIES; i++) {
        end.value[i] = (double)wanted.state[i];
    }
    return end;
}

/* If sines are evaluated at each stage, the error is round-off. If they are rotated from stage to stage, the error
 * is below a hundredth of the method's own error (docs/dev/numerics.md). */
TEST(linkages, motions_are_those_of_the_energies) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    double share = 0.0;
    for (unsigned k = 0; k < cases(); k++) {
        const linkage of = drawn_linkage(&d, k);
        const moved wanted = integrated(&of, 1e-3, STEPS);
        const moved finer = integrated(&of, 5e-4, 2 * STEPS);
        const double own = apart(&of, &wanted, &finer);
        const moved found =
            run_by(&of, as_usual,
                   (stepping){.kind = &engine_double, .method = WH_RK4, .angles = ANGLES_LOOKUP});
        const double off = apart(&of, &found, &wanted);
        expect(off < 1e-10, "off after 100 steps", off, text_of_linkages(&of, as_usual));
        worst = fmax(worst, off);
        const moved turned = run_of(&of, as_usual, &engine_double);
        const double more = apart(&of, &turned, &wanted);
        expect(more < 1e-10 + 1e-2 * own, "turned off after 100 steps", more,
               text_of_linkages(&of, as_usual));
        share = fmax(share, more / (1e-8 + own));
    }
    printf("  off by at most %.1e after %d steps; turned by %.1e of the method's own error\n",
           worst, STEPS, share);
    TEST_ASSERT_TRUE(worst > 0.0);
}

/* An effect that is off changes no bit. An effect that is on changes the sequence of a sum, and so the last bits of
 * the coefficients. */
TEST(linkages, forces_may_stand_in_effects) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    for (unsigned k = 2; k < cases(); k += ONE_IN) {
        const linkage of = drawn_linkage(&d, k);
        const engine_kind *kind = k % 2 == 0 ? &engine_double : &engine_float;
        const moved bare = run_of(&of, (linkage_writing){.forces = LINKAGE_BARE}, kind);
        const moved off = run_of(&of, (linkage_writing){.forces = LINKAGE_EFFECTS_OFF}, kind);
        expect(memcmp(&bare, &off, sizeof bare) == 0, "other bits with effects that are off",
               apart(&of, &bare, &off), text_of_linkages(&of, as_usual));
        const moved inside = run_of(&of, as_usual, &engine_double);
        const moved on =
            run_of(&of, (linkage_writing){.forces = LINKAGE_EFFECTS_ON}, &engine_double);
        const double other = apart(&of, &inside, &on);
        expect(other < 1e-9, "with its forces in effects it is off", other,
               text_of_linkages(&of, as_usual));
        worst = fmax(worst, other);
    }
    printf("  with its forces in effects it is off by at most %.1e\n", worst);
}

/* The energy residual after 100 ms. *turnover: the largest entry of the energy balance, at least 1 J. */
static double left_over_linkages(const linkage *of, double step_s, double *turnover) {
    enum { ENTRIES_MAX = 200, ACCOUNTS_MAX = 1 + LINKAGE_BODIES };
    double total[ENTRIES_MAX] = {0};
    double left[ACCOUNTS_MAX] = {0};
    motion m;
    motion_open_text(
        &m, text_of_linkages(of, as_usual),
        (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s, .ledger = true});
    TEST_ASSERT_TRUE(m.image->ledger.entries <= ENTRIES_MAX);
    TEST_ASSERT_TRUE(m.image->ledger.accounts <= ACCOUNTS_MAX);
    motion_to(&m, 0.1);
    m.kind->ledger(m.run, total, left);
    *turnover = 1.0;
    for (int i = 0; i < m.image->ledger.entries; i++) {
        *turnover = fmax(*turnover, fabs(total[i]));
    }
    motion_close(&m);
    return fabs(left[0]);
}

TEST(linkages, the_energy_is_accounted_for) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    unsigned fell = 0;
    unsigned known = 0;
    unsigned fast = 0;
    for (unsigned k = 0; k < cases(); k++) {
        const linkage of = drawn_linkage(&d, k);
        double turnover;
        const double coarse = left_over_linkages(&of, 2e-3, &turnover);
        const double fine = left_over_linkages(&of, 5e-4, &turnover);
        double least = fine;
        double step_s = 5e-4;
        while (!(least < 1e-7 * turnover)) {
            /* if the step is too long for the motion, the residual is the method's error */
            const double coarser = least;
            step_s /= 4.0;
            fast += coarser == fine ? 1U : 0U;
            least = left_over_linkages(&of, step_s, &turnover);
            expect(least < coarser / 64.0, "left over in a quarter of the step, J", least,
                   text_of_linkages(&of, as_usual));
        }
        worst = fmax(worst, fine / turnover);
        if (coarse > 1e-9 * turnover) { /* above round-off, the residual must fall with the step */
            known++;
            fell += fine < coarse / 64.0 ? 1U : 0U;
        }
    }
    printf("  left over at most %.1e of what went through; of %u above rounding %u fell by 64 and "
           "more with a quarter of the step\n",
           worst, known, fell);
    TEST_ASSERT_TRUE(fell * 10 >= known * 9 && fast * 300 <= cases());
}
