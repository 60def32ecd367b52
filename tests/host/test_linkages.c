/* test_linkages.c: random planar linkages: what is derived from their energies as text, against the same energies
 * differentiated in numbers (linkage.h): accelerations, and whole motions; and what must not matter: which way up the
 * plane is looked at, the order of the file, whether forces stand in the mechanism or in effects. The books balance.
 * WHIRL_CASES=10000 WHIRL_SEED=...: so many, others. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "derived.h"
#include "linkage.h"
#include "motion.h"
#include "unity.h"

void suite_linkages(void);

enum { STATES = 10, STEPS = 100 };

static unsigned cases(void) { return dice_cases(few_or_all(usual_or(6, 3), 200)); }

/* What must not matter is asked of every third of them. */
enum { ONE_IN = 3 };

/* The k-th of a seed's. */
static linkage drawn_linkage(dice *d, unsigned k) {
    uint64_t seed = d->state + 1000003U * k;
    return linkage_draw(&seed);
}

static const char *text_of(const linkage *of, linkage_writing how) {
    static char text[LINKAGE_TEXT];
    linkage_write(of, "linkage", how, text);
    return text;
}

static const linkage_writing as_usual = {.forces = LINKAGE_INSIDE};
static const linkage_writing backwards = {.forces = LINKAGE_INSIDE, .backwards = true};

/* Fails with the text. */
static void expect(bool holds, const char *what, double figure, const char *text) {
    if (!holds) {
        char line[120];
        printf("%s\n", text);
        snprintf(line, sizeof line, "%s: %.3e", what, figure);
        TEST_FAIL_MESSAGE(line);
    }
}

/* --- accelerations ------------------------------------------------------------------------------------------- */

/* Which unknown is q0, q1, ... */
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

/* How far off the list's accelerations are at random states, of the largest. */
static double worst_acceleration(const linkage *of, linkage_writing how, uint64_t *seed) {
    derived d = derived_text(text_of(of, how));
    double worst = 0.0;
    derived_expect(&d, text_of(of, how));
    for (int i = 0; i < STATES; i++) {
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

static void test_accelerations_are_those_of_the_energies(void) {
    dice d = dice_of("linkages", 14);
    uint64_t seed = d.state;
    double worst = 0.0;
    for (unsigned k = 0; k < cases(); k++) {
        const linkage of = drawn_linkage(&d, k);
        const double off = worst_acceleration(&of, k % 2 == 0 ? as_usual : backwards, &seed);
        expect(off < 1e-10, "off, of the largest acceleration", off, text_of(&of, as_usual));
        worst = fmax(worst, off);
    }
    printf("  off by at most %.1e of the largest acceleration\n", worst);
    TEST_ASSERT_TRUE(worst > 0.0);
}

/* --- motions ------------------------------------------------------------------------------------------------- */

typedef struct moved {
    double value[2 * LINKAGE_BODIES]; /* values, then rates */
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
    motion_open_text(&m, text_of(of, how), by);
    TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, STEPS), text_of(of, how));
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

/* Where sines are looked up at each stage a run is the method's, to rounding; where they are turned it is within a
 * hundredth of what that method errs by itself (docs/dev/numerics.md). */
static void test_motions_are_those_of_the_energies(void) {
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
        expect(off < 1e-10, "off after 100 steps", off, text_of(&of, as_usual));
        worst = fmax(worst, off);
        const moved turned = run_of(&of, as_usual, &engine_double);
        const double more = apart(&of, &turned, &wanted);
        expect(more < 1e-10 + 1e-2 * own, "turned off after 100 steps", more,
               text_of(&of, as_usual));
        share = fmax(share, more / (1e-8 + own));
    }
    printf("  off by at most %.1e after %d steps; turned by %.1e of the method's own error\n",
           worst, STEPS, share);
    TEST_ASSERT_TRUE(worst > 0.0);
}

/* --- what must not matter ------------------------------------------------------------------------------------ */

static void test_a_mirror_image_moves_as_the_mirror_image(void) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    for (unsigned k = 0; k < cases(); k += ONE_IN) {
        const linkage of = drawn_linkage(&d, k);
        const linkage other = linkage_mirrored(&of);
        const moved found = run_of(&of, as_usual, &engine_double);
        moved mirrored = run_of(&other, as_usual, &engine_double);
        for (int i = 0; i < of.bodies; i++) {
            const double sign = of.body[i].slides ? 1.0 : -1.0;
            mirrored.value[i] *= sign;
            mirrored.value[LINKAGE_BODIES + i] *= sign;
        }
        const double off = apart(&of, &found, &mirrored);
        expect(off < 1e-9, "the mirror image is off", off, text_of(&of, as_usual));
        worst = fmax(worst, off);
    }
    printf("  the mirror image is off by at most %.1e\n", worst);
}

static void test_the_order_of_the_file_does_not_matter(void) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    for (unsigned k = 1; k < cases(); k += ONE_IN) {
        const linkage of = drawn_linkage(&d, k);
        const moved found = run_of(&of, as_usual, &engine_double);
        const moved other = run_of(&of, backwards, &engine_double);
        const double off = apart(&of, &found, &other);
        expect(off < 1e-9, "written backwards it is off", off, text_of(&of, as_usual));
        worst = fmax(worst, off);
    }
    printf("  written backwards it is off by at most %.1e\n", worst);
}

/* What an effect that is off would add leaves no trace, not in a bit; what one adds that is on is the same sum taken in
 * another order, and so are its coefficients' last bits. */
static void test_forces_may_stand_in_effects(void) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    for (unsigned k = 2; k < cases(); k += ONE_IN) {
        const linkage of = drawn_linkage(&d, k);
        const engine_kind *kind = k % 2 == 0 ? &engine_double : &engine_float;
        const moved bare = run_of(&of, (linkage_writing){.forces = LINKAGE_BARE}, kind);
        const moved off = run_of(&of, (linkage_writing){.forces = LINKAGE_EFFECTS_OFF}, kind);
        expect(memcmp(&bare, &off, sizeof bare) == 0, "other bits with effects that are off",
               apart(&of, &bare, &off), text_of(&of, as_usual));
        const moved inside = run_of(&of, as_usual, &engine_double);
        const moved on =
            run_of(&of, (linkage_writing){.forces = LINKAGE_EFFECTS_ON}, &engine_double);
        const double other = apart(&of, &inside, &on);
        expect(other < 1e-9, "with its forces in effects it is off", other, text_of(&of, as_usual));
        worst = fmax(worst, other);
    }
    printf("  with its forces in effects it is off by at most %.1e\n", worst);
}

/* --- books --------------------------------------------------------------------------------------------------- */

/* What is left over of the energy after 100 ms, and how much went through the books. */
static double left_over(const linkage *of, double step_s, double *turnover) {
    enum { ENTRIES_MAX = 200, ACCOUNTS_MAX = 1 + LINKAGE_BODIES };
    double total[ENTRIES_MAX] = {0};
    double left[ACCOUNTS_MAX] = {0};
    motion m;
    motion_open_text(
        &m, text_of(of, as_usual),
        (stepping){.kind = &engine_double, .method = WH_RK4, .step_s = step_s, .ledger = true});
    TEST_ASSERT_TRUE(m.image->ledger.entries <= ENTRIES_MAX);
    TEST_ASSERT_TRUE(m.image->ledger.accounts <= ACCOUNTS_MAX);
    motion_to(&m, 0.1);
    m.kind->ledger(m.run, total, left);
    *turnover = 1.0; /* J */
    for (int i = 0; i < m.image->ledger.entries; i++) {
        *turnover = fmax(*turnover, fabs(total[i]));
    }
    motion_close(&m);
    return fabs(left[0]);
}

static void test_the_energy_is_accounted_for(void) {
    dice d = dice_of("linkages", 14);
    double worst = 0.0;
    unsigned fell = 0;
    unsigned known = 0;
    unsigned fast = 0;
    for (unsigned k = 0; k < cases(); k++) {
        const linkage of = drawn_linkage(&d, k);
        double turnover;
        const double coarse = left_over(&of, 2e-3, &turnover);
        const double fine = left_over(&of, 5e-4, &turnover);
        double least = fine;
        double step_s = 5e-4;
        while (!(least < 1e-7 * turnover)) { /* too fast for the step: the method's own error */
            const double coarser = least;
            step_s /= 4.0;
            fast += coarser == fine ? 1U : 0U;
            least = left_over(&of, step_s, &turnover);
            expect(least < coarser / 64.0, "left over in a quarter of the step, J", least,
                   text_of(&of, as_usual));
        }
        worst = fmax(worst, fine / turnover);
        if (coarse > 1e-9 * turnover) { /* above rounding: it falls with the step */
            known++;
            fell += fine < coarse / 64.0 ? 1U : 0U;
        }
    }
    printf("  left over at most %.1e of what went through; of %u above rounding %u fell by 64 and "
           "more with a quarter of the step\n",
           worst, known, fell);
    TEST_ASSERT_TRUE(fell * 10 >= known * 9 && fast * 300 <= cases());
}

void suite_linkages(void) {
    RUN_TEST(test_accelerations_are_those_of_the_energies);
    RUN_TEST(test_motions_are_those_of_the_energies);
    RUN_TEST(test_a_mirror_image_moves_as_the_mirror_image);
    RUN_TEST(test_the_order_of_the_file_does_not_matter);
    RUN_TEST(test_forces_may_stand_in_effects);
    RUN_TEST(test_the_energy_is_accounted_for);
}
