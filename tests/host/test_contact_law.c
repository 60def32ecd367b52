/* test_contact_law.c: random mechanisms with a constant mass matrix, whose contacts all act at one moment, against
 * the laws of core/contact/contact_lcp.h and core/contact/contact_resolve.h, solved here another way: every case is tried (which
 * contacts hold, which are at a limit), and the one that meets all conditions is the answer. Rates, places, and what
 * each contact gives to the energy and to each momentum. */
#include "command.h"
#include "contacts.h"
#include "derived.h"
#include "drawn.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "unity.h"

void suite_contact_law(void);

/* --- impacts --------------------------------------------------------------------------------------------------- */

/* Stops that are all reached at one moment, stops that rest, one hold, and friction whose normal force is zero. */
static bool draw_impact(uint64_t *seed, double impact_s, drawn *b) {
    static const double restitutions[] = {0.0, 0.25, 0.5, 1.0};
    *b = drawn_body(seed);
    for (int i = 0; i < b->n; i++) {
        b->rate[i] = drawn_whole(seed, -3, 3);
    }
    b->rate[0] = random_bits(seed) % 2U != 0 ? 0.0 : b->rate[0]; /* where friction may stick */
    const int hits = 1 + (int)(random_bits(seed) % 3U);
    for (int k = 0; k < hits; k++) {
        drawn_contact *of = drawn_add(b, 's');
        drawn_row(b, seed, of->row);
        const double speed = drawn_along(b, k, b->rate);
        if (speed == 0.0) {
            return false;
        }
        for (int i = 0; i < b->n && speed > 0.0; i++) {
            of->row[i] = -of->row[i];
        }
        of->restitution = restitutions[random_bits(seed) % 4U];
        of->offset = -fabs(speed) * impact_s;
        of->target = of->restitution * fabs(speed);
    }
    if (random_bits(seed) % 2U != 0) {
        drawn_row_at_rest(b, seed, drawn_add(b, 's')->row);
    }
    if (random_bits(seed) % 2U != 0) { /* every third the other way round what rests already */
        drawn_contact *of = drawn_add(b, 'h');
        const bool repeats = of[-1].offset == 0.0 && random_bits(seed) % 3U == 0;
        drawn_row_at_rest(b, seed, of->row);
        for (int i = 0; i < b->n && repeats; i++) {
            of->row[i] = -of[-1].row[i];
        }
    }
    if (random_bits(seed) % 2U != 0) {
        drawn_add(b, 'f')->row[random_bits(seed) % (uint64_t)b->n] = 1.0;
    }
    return true;
}

/* A hold that captures at the moment, beside stops that rest and may be let go. */
static bool draw_capture(uint64_t *seed, double impact_s, drawn *b) {
    *b = drawn_body(seed);
    for (int i = 0; i < b->n; i++) {
        b->rate[i] = drawn_whole(seed, -3, 3);
    }
    const int stops = (int)(random_bits(seed) % 3U);
    for (int k = 0; k < stops; k++) {
        drawn_row_at_rest(b, seed, drawn_add(b, 's')->row);
    }
    drawn_contact *of = drawn_add(b, 'h');
    drawn_row(b, seed, of->row);
    drawn_row(b, seed, of->since);
    double speed = 0.0;
    for (int i = 0; i < b->n; i++) {
        speed += of->since[i] * b->rate[i];
    }
    of->since_m = speed * impact_s;
    return speed > 0.0;
}

static double apart(double got, double wanted) { return fabs(got - wanted) / (1.0 + fabs(wanted)); }

/* What the books have of contact k: the energy, then each momentum. */
static double books_apart(const motion *m, const drawn *b, int k, double energy, double impulse) {
    double total[64] = {0.0};
    double left[DRAWN_MOST + 1] = {0.0};
    m->kind->ledger(m->run, total, left);
    const double *entry = total + m->image->ledger.smooth + k * (1 + b->n);
    double worst = apart(entry[0], energy);
    for (int i = 0; i < b->n; i++) {
        worst = fmax(worst, apart(entry[1 + i], impulse * b->contact[k].row[i]));
    }
    return worst;
}

static double state_apart(const motion *m, const drawn *b, const double *at, const double *rate) {
    double worst = 0.0;
    for (int i = 0; i < b->n; i++) {
        const char name[] = {'x', (char)('0' + i), '\'', '\0'};
        const char value[] = {'x', (char)('0' + i), '\0'};
        worst = fmax(worst, apart(motion_value(m, name), rate[i]));
        worst = fmax(worst, apart(motion_value(m, value), at[i]) / DRAWN_STEP_S);
    }
    return worst;
}

static long wanted_runs(long usual) {
    const char *wanted = getenv("WHIRL_LAW_RUNS");
    const long count = wanted != NULL ? strtol(wanted, NULL, 10) : 0;
    return count > 0 ? count : usual;
}

typedef bool draw_moment(uint64_t *seed, double impact_s, drawn *b);

static void check_impacts(draw_moment *draw, const engine_kind *kind, double bound) {
    const long runs = wanted_runs((long)few_or_all(12, 40));
    uint64_t seed = 79;
    double worst = 0.0;
    double worst_books = 0.0;
    int unsolved = 0;
    int booked = 0;
    for (long done = 0; done < runs;) {
        const double impact_s = DRAWN_STEP_S * (double)(1U + random_bits(&seed) % 7U) / 8.0;
        drawn b;
        motion m;
        double lambda[DRAWN_CONTACTS] = {0.0};
        double after[DRAWN_MOST] = {0.0};
        double spot[DRAWN_MOST] = {0.0};
        if (!draw(&seed, impact_s, &b)) {
            continue;
        }
        done++;
        if (!drawn_solved(&b, b.rate, lambda, after)) {
            unsolved++;
            continue;
        }
        for (int i = 0; i < b.n; i++) {
            spot[i] = b.rate[i] * impact_s + after[i] * (DRAWN_STEP_S - impact_s);
        }
        drawn_open(&m, &b, kind);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double off = state_apart(&m, &b, spot, after);
        if (off > bound) {
            printf("  %s: case %ld is off by %.1e\n", kind->name, done, off);
        }
        worst = fmax(worst, off);
        const bool single = drawn_independent(&b);
        booked += single;
        for (int k = 0; k < b.contacts && single; k++) {
            const double mean = (drawn_along(&b, k, b.rate) + drawn_along(&b, k, after)) / 2.0;
            worst_books = fmax(worst_books, books_apart(&m, &b, k, lambda[k] * mean, lambda[k]));
        }
        motion_close(&m);
    }
    printf("%s: %ld impacts, off by %.1e, their books by %.1e (%d); %d without an answer here\n",
           kind->name, runs, worst, worst_books, booked, unsolved);
    TEST_ASSERT_TRUE(worst <= bound && worst_books <= 10.0 * bound);
    TEST_ASSERT_TRUE(unsolved <= runs / 20 && booked >= runs / 6);
}

static void test_impacts_follow_newtons_law(void) {
    check_impacts(draw_impact, &engine_double, 1e-11);
}
static void test_impacts_follow_newtons_law_in_float(void) {
    check_impacts(draw_impact, &engine_float, 1e-4);
}

static void test_holds_capture_by_their_law(void) {
    check_impacts(draw_capture, &engine_double, 1e-11);
}

/* --- forces ---------------------------------------------------------------------------------------------------- */

/* At rest on its stops, held and stuck, then the loads act. */
static void draw_rest(uint64_t *seed, drawn *b) {
    *b = drawn_body(seed);
    for (int i = 0; i < b->n; i++) {
        b->load[i] = drawn_whole(seed, -6, 6);
    }
    const int stops = 1 + (int)(random_bits(seed) % 3U);
    for (int k = 0; k < stops; k++) {
        drawn_row(b, seed, drawn_add(b, 's')->row);
    }
    if (random_bits(seed) % 2U != 0) {
        drawn_row(b, seed, drawn_add(b, 'h')->row);
    }
    for (int i = 0; i < b->n && b->contacts < DRAWN_CONTACTS; i++) {
        if (random_bits(seed) % 2U != 0) {
            drawn_contact *of = drawn_add(b, 'f');
            of->row[i] = 1.0;
            of->limit = drawn_whole(seed, 1, 4);
        }
    }
}

/* Loads are constant, so are the accelerations: rates a h, places a h^2/2, each contact's impulse lambda h. */
static void check_forces(const engine_kind *kind, double bound) {
    const long runs = wanted_runs((long)few_or_all(12, 40));
    uint64_t seed = 72;
    double worst = 0.0;
    double worst_books = 0.0;
    int unsolved = 0;
    int booked = 0;
    for (long done = 0; done < runs; done++) {
        drawn b;
        motion m;
        double free[DRAWN_MOST];
        double lambda[DRAWN_CONTACTS] = {0.0};
        double accel[DRAWN_MOST];
        double spot[DRAWN_MOST] = {0.0};
        double rate[DRAWN_MOST] = {0.0};
        draw_rest(&seed, &b);
        drawn_inverse(&b, b.load, free);
        if (!drawn_solved(&b, free, lambda, accel)) {
            unsolved++;
            continue;
        }
        for (int i = 0; i < b.n; i++) {
            rate[i] = accel[i] * DRAWN_STEP_S;
            spot[i] = accel[i] * DRAWN_STEP_S * DRAWN_STEP_S / 2.0;
        }
        drawn_open(&m, &b, kind);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double off = state_apart(&m, &b, spot, rate) / DRAWN_STEP_S;
        if (off > bound) {
            printf("  %s: case %ld is off by %.1e\n", kind->name, done, off);
        }
        worst = fmax(worst, off);
        const bool single = drawn_independent(&b);
        booked += single;
        for (int k = 0; k < b.contacts && single; k++) {
            const double work = lambda[k] * drawn_along(&b, k, spot);
            worst_books = fmax(worst_books, books_apart(&m, &b, k, work, lambda[k] * DRAWN_STEP_S) /
                                                DRAWN_STEP_S);
        }
        motion_close(&m);
    }
    printf("%s: %ld loads, off by %.1e, their books by %.1e (%d); %d without an answer here\n",
           kind->name, runs, worst, worst_books, booked, unsolved);
    TEST_ASSERT_TRUE(worst <= bound && worst_books <= 10.0 * bound);
    TEST_ASSERT_TRUE(unsolved <= runs / 20 && booked >= runs / 6);
}

static void test_forces_share_a_load_by_their_law(void) { check_forces(&engine_double, 1e-11); }
static void test_forces_share_a_load_by_their_law_in_float(void) {
    check_forces(&engine_float, 1e-4);
}

/* --- both ------------------------------------------------------------------------------------------------------ */

/* The same with loads that press and lift, and speeds from fast to hardly any, so that some hops are too short. */
static bool draw_mixed(uint64_t *seed, drawn *b) {
    if (!draw_impact(seed, DRAWN_STEP_S / 2.0, b)) {
        return false;
    }
    const double slow = 1.0 / (double)(1U << random_bits(seed) % 14U);
    for (int i = 0; i < b->n; i++) {
        b->rate[i] *= slow;
        b->load[i] = drawn_whole(seed, -6, 6);
    }
    for (int k = 0; k < b->contacts; k++) {
        drawn_contact *of = &b->contact[k];
        of->offset *= slow;
        of->limit = of->kind == 'f' ? drawn_whole(seed, 0, 3) / 4.0 : 0.0;
    }
    return true;
}

/* What must hold at any time, whatever happened: by how much contact k is beyond it. */
static double broken(const motion *m, const drawn *b, int k, double time_s) {
    const drawn_contact *of = &b->contact[k];
    double total[64] = {0.0};
    double left[DRAWN_MOST + 1] = {0.0};
    double gap = -of->offset;
    double rate = 0.0;
    double impulse = 0.0;
    int must = 0;
    for (int i = 0; i < b->n; i++) {
        const char name[] = {'x', (char)('0' + i), '\'', '\0'};
        const char value[] = {'x', (char)('0' + i), '\0'};
        gap += of->row[i] * motion_value(m, value);
        rate += of->row[i] * motion_value(m, name);
        must = of->row[i] != 0.0 ? i : must;
    }
    m->kind->ledger(m->run, total, left);
    const double *entry = total + m->image->ledger.smooth + k * (1 + b->n);
    impulse = entry[1 + must] / of->row[must];
    const double gave_J = entry[0]; /* no contact gives energy */
    if (of->kind == 's') {          /* pushes only, and is not passed */
        return fmax(fmax(gave_J, -impulse), -gap);
    }
    if (of->kind == 'f') { /* takes no more than it can: no impulse */
        return fmax(gave_J, fabs(impulse) - of->limit * time_s);
    }
    return fmax(fmax(gave_J, fabs(gap)), fabs(rate));
}

static void test_no_contact_does_more_than_it_can(void) {
    const long runs = wanted_runs((long)few_or_all(12, 40));
    uint64_t seed = 73;
    double worst = 0.0;
    int over = 0;
    for (long done = 0; done < runs;) {
        drawn b;
        motion m;
        if (!draw_mixed(&seed, &b)) {
            continue;
        }
        done++;
        drawn_open(&m, &b, &engine_double);
        for (int step = 1; step <= 8; step++) {
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            for (int k = 0; k < b.contacts; k++) {
                const double off =
                    contacts_overruns(&m) == 0 ? broken(&m, &b, k, step * DRAWN_STEP_S) : 0.0;
                if (off > 1e-11) {
                    printf("  case %ld, step %d: contact %d by %.1e\n", done, step, k, off);
                }
                worst = fmax(worst, off);
            }
        }
        over += contacts_overruns(&m) > 0;
        motion_close(&m);
    }
    printf("%ld mechanisms: beyond what they can by %.1e; %d with overruns\n", runs, worst, over);
    TEST_ASSERT_TRUE(worst <= 1e-11 && over <= runs / 10);
}

/* A hold and a stop at rest that say the same, the other way round: the impacts let the stop go, and it rests on, as
 * nothing throws it off. Friction that stuck at x0 has no part in that: its normal force is zero. */
static void test_friction_takes_no_impulse_when_a_stop_rests_on(void) {
    drawn b = {.n = 3,
               .contacts = 5,
               .mass = {{4, -1, 1}, {-1, 2, -1}, {1, -1, 4}},
               .rate = {0, 2, 3},
               .contact = {{.kind = 's',
                            .row = {1, -2, 1},
                            .offset = -0.875 * DRAWN_STEP_S,
                            .restitution = 0.25,
                            .target = 0.25},
                           {.kind = 's',
                            .row = {-2, 1, -2},
                            .offset = -3.5 * DRAWN_STEP_S,
                            .restitution = 1,
                            .target = 4},
                           {.kind = 's', .row = {0, -3, 2}},
                           {.kind = 'h', .row = {0, 3, -2}},
                           {.kind = 'f', .row = {1, 0, 0}}}};
    const double after[DRAWN_MOST] = {-0.5, -1.5, -2.25};
    const double at[DRAWN_MOST] = {-0.5 / 8 * DRAWN_STEP_S, 12.5 / 8 * DRAWN_STEP_S,
                                   18.75 / 8 * DRAWN_STEP_S};
    motion m;
    drawn_open(&m, &b, &engine_double);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    TEST_ASSERT_TRUE(state_apart(&m, &b, at, after) <= 1e-12);
    motion_close(&m);
}

void suite_contact_law(void) {
    RUN_TEST(test_friction_takes_no_impulse_when_a_stop_rests_on);
    RUN_TEST(test_no_contact_does_more_than_it_can);
    RUN_TEST(test_impacts_follow_newtons_law);
    RUN_TEST(test_impacts_follow_newtons_law_in_float);
    RUN_TEST(test_holds_capture_by_their_law);
    RUN_TEST(test_forces_share_a_load_by_their_law);
    RUN_TEST(test_forces_share_a_load_by_their_law_in_float);
}
