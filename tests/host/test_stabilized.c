/* test_stabilized.c: energy restored by --stabilized (core/step/stabilize.h), for random chains of pendulums on a
 * cart. The test computes the energy from positions and velocities. Also motions that must not change. */
#include "host/cli/commands.h"

#include "command.h"
#include "motion.h"

/* === suite stabilized ========================================================================= */

enum {
    LINKS = 3,
    TEXT = 4096,
    GO = 41,
    WINDOW = 25
}; /* readings are GO steps apart; WINDOW readings are 1024 steps */
#define GRAVITY 9.81

/* Point masses on rods in a chain, which hangs from a cart on a spring. Angles count from the vertical. */
typedef struct chain {
    int links;
    double cart_kg;
    double spring_Npm;
    double mass_kg[LINKS];
    double length_m[LINKS];
    double start_rad[LINKS];
    double fastest; /* upper bound of the angular frequencies, rad/s */
} chain;

static chain drawn_chain(dice *d) {
    chain c = {.links = 1 + (int)dice_one_of(d, LINKS),
               .cart_kg = dice_between(d, 0.5, 4.0),
               .spring_Npm = dice_between(d, 1.0, 40.0)};
    for (int i = 0; i < c.links; i++) {
        c.mass_kg[i] = dice_between(d, 0.5, 2.0);
        c.length_m[i] = dice_between(d, 0.3, 1.2);
        c.start_rad[i] = dice_between(d, -1.3, 1.3);
        c.fastest += sqrt(GRAVITY / c.length_m[i]);
    }
    c.fastest += sqrt(c.spring_Npm / c.cart_kg);
    return c;
}

static void write_chain(const chain *c, char text[static TEXT]) {
    int at = snprintf(text, TEXT, "mechanism chain\ncoordinate s [m]\n");
    for (int i = 0; i < c->links; i++) {
        at += snprintf(text + at, TEXT - (size_t)at, "coordinate q%d [rad]\n", i);
    }
    char vx[512] = "s'";
    char vy[512] = "0 [m/s]";
    char height[512] = "0 [m]";
    char kinetic[2048];
    char stored[1024];
    int t = snprintf(kinetic, sizeof kinetic, "T = %.17g [kg]*s'^2/2", c->cart_kg);
    int v = snprintf(stored, sizeof stored, "V = %.17g [N/m]*s^2/2", c->spring_Npm);
    for (int i = 0; i < c->links; i++) {
        char one[64];
        snprintf(one, sizeof one, " + %.17g [m]*q%d'*cos(q%d)", c->length_m[i], i, i);
        strcat(vx, one);
        snprintf(one, sizeof one, " + %.17g [m]*q%d'*sin(q%d)", c->length_m[i], i, i);
        strcat(vy, one);
        snprintf(one, sizeof one, " - %.17g [m]*cos(q%d)", c->length_m[i], i);
        strcat(height, one);
        t += snprintf(kinetic + t, sizeof kinetic - (size_t)t, " + %.17g [kg]*((%s)^2 + (%s)^2)/2",
                      c->mass_kg[i], vx, vy);
        v += snprintf(stored + v, sizeof stored - (size_t)v, " + %.17g [N]*(%s)",
                      c->mass_kg[i] * GRAVITY, height);
    }
    at += snprintf(text + at, TEXT - (size_t)at, "%s\n%s\nscene moves {\nstart ", kinetic, stored);
    for (int i = 0; i < c->links; i++) {
        at += snprintf(text + at, TEXT - (size_t)at, "%sq%d = %.17g [rad]", i > 0 ? ", " : "", i,
                       c->start_rad[i]);
    }
    snprintf(text + at, TEXT - (size_t)at, "\nstep 1 [ms]\nuntil 1e6 [s]\n}\n");
}

static double energy_J(const chain *c, const motion *m) {
    const double x = motion_value(m, "s");
    double vx = motion_value(m, "s'");
    double vy = 0.0;
    double height = 0.0;
    double sum = c->cart_kg * vx * vx / 2.0 + c->spring_Npm * x * x / 2.0;
    for (int i = 0; i < c->links; i++) {
        char name[8];
        snprintf(name, sizeof name, "q%d", i);
        const double q = motion_value(m, name);
        snprintf(name, sizeof name, "q%d'", i);
        const double rate = motion_value(m, name);
        vx += c->length_m[i] * rate * cos(q);
        vy += c->length_m[i] * rate * sin(q);
        height += 2.0 * c->length_m[i] * sin(q / 2.0) * sin(q / 2.0);
        sum += c->mass_kg[i] * ((vx * vx + vy * vy) / 2.0 + GRAVITY * height);
    }
    return sum;
}

/* The largest energy term, relative to the energy at the start, when all is at rest. This ratio limits the digits of
 * the balance. V counts from the cart's height, so it is large if all links hang down. */
static double terms_of(const chain *c) {
    double terms = 0.0;
    double begin = 0.0;
    double deep = 0.0;
    double height = 0.0;
    for (int i = 0; i < c->links; i++) {
        deep += c->length_m[i];
        height += c->length_m[i] * (1.0 - cos(c->start_rad[i]));
        terms += c->mass_kg[i] * GRAVITY * deep;
        begin += c->mass_kg[i] * GRAVITY * height;
    }
    return terms / begin;
}

typedef struct drift {
    double first; /* largest relative energy error in the first half */
    double second;
    double whole;
    double last;
    double steepest; /* largest change of energy within a window */
} drift;

static drift drift_of(const chain *c, stepping how, uint64_t steps) {
    char text[TEXT];
    motion m;
    drift seen = {0.0, 0.0, 0.0, 0.0, 0.0};
    double before[WINDOW] = {0.0};
    write_chain(c, text);
    motion_open_text(&m, text, how);
    const double begin_J = energy_J(c, &m);
    for (uint64_t k = 0; k < steps; k += GO) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, GO));
        const double off = energy_J(c, &m) / begin_J - 1.0;
        double *half = k < steps / 2 ? &seen.first : &seen.second;
        *half = fmax(*half, fabs(off));
        double *kept = &before[k / GO % WINDOW];
        seen.steepest = fmax(seen.steepest, fabs(off - *kept));
        *kept = off;
        seen.last = off;
    }
    motion_close(&m);
    seen.whole = fmax(seen.first, seen.second);
    return seen;
}

/* Each step restores a thousandth of the drift. So the loss must stay below a few times the loss of a thousand
 * steps, however long the run. */
TEST(stabilized, energy_stays) {
    static const struct {
        const engine_kind *kind;
        bool compensated;
        double rounds; /* round-off relative to the energy terms */
    } numbers[] = {
        {&engine_float, true, 5e-7}, {&engine_double, true, 1e-12}, {&engine_double, false, 1e-12}};
    dice d = dice_of("stabilized", 20261128);
    const unsigned cases = usual_or(dice_cases(few_or_all(3, 60)), 3);
    const uint64_t steps = usual_or(200000, 40000);
    double most[3] = {0.0, 0.0, 0.0};
    double without = 0.0;
    unsigned bursts = 0; /* chaotic motions that lose more in their second half */
    for (unsigned i = 0; i < cases; i++) {
        const chain c = drawn_chain(&d);
        /* a step so coarse that RK4 loses energy */
        const double step_s = 0.06 / c.fastest;
        const unsigned n = i % 3;
        const stepping plain = {.kind = numbers[n].kind,
                                .method = WH_RK4,
                                .compensated = numbers[n].compensated,
                                .step_s = step_s};
        stepping with = plain;
        with.stabilized = true;
        const drift lost = drift_of(&c, plain, steps);
        const drift kept = drift_of(&c, with, steps);
        const double rounds = numbers[n].rounds * (1.0 + terms_of(&c));
        char what[256];
        snprintf(what, sizeof what, "case %u, %s: %.2e, then %.2e; without %.2e", i,
                 numbers[n].kind->name, kept.first, kept.second, lost.whole);
        TEST_ASSERT_TRUE_MESSAGE(kept.whole <= 4.0 * lost.steepest + rounds, what);
        bursts += kept.second > 4.0 * kept.first + rounds ? 1U : 0U;
        most[n] = fmax(most[n], kept.whole);
        without = fmax(without, fabs(lost.last));
    }
    printf("energies of %u chains: at most %.1e off in compensated float, %.1e and %.1e in double; "
           "without, %.1e\n",
           cases, most[0], most[1], most[2], without);
    TEST_ASSERT_TRUE(without > 1e-5 && bursts <= cases / 20);
}

/* Largest difference of a coordinate at the end from a run in double with an eighth of the step. */
static double way_off(const char *text, const chain *c, stepping how, double end_s) {
    double end[2][LINKS + 1];
    stepping fine = {.kind = &engine_double, .method = WH_NYSTROEM5, .compensated = true};
    fine.step_s = how.step_s / 8.0;
    for (int run = 0; run < 2; run++) {
        motion m;
        const stepping *by = run == 0 ? &how : &fine;
        motion_open_text(&m, text, *by);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, (uint64_t)lround(end_s / by->step_s)));
        for (int i = 0; i < c->links; i++) {
            char name[8];
            snprintf(name, sizeof name, "q%d", i);
            end[run][i] = motion_value(&m, name);
        }
        end[run][c->links] = motion_value(&m, "s");
        motion_close(&m);
    }
    double most = 0.0;
    for (int i = 0; i <= c->links; i++) {
        most = fmax(most, fabs(end[0][i] - end[1][i]));
    }
    return most;
}

/* A motion that is driven and damped, and whose energy balance is right. The error with --stabilized must be about
 * that without it. */
TEST(stabilized, driven_motion_does_not_change) {
    dice d = dice_of("stabilized motions", 20261129);
    const unsigned cases = usual_or(dice_cases(few_or_all(16, 80)), 4);
    double worst = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        chain c = drawn_chain(&d);
        char text[TEXT];
        for (int k = 0; k < c.links; k++) { /* small swings, so that there is no chaos */
            c.start_rad[k] *= 0.2;
        }
        write_chain(&c, text);
        const bool is_float = i % 2 == 0;
        const stepping plain = {.kind = is_float ? &engine_float : &engine_double,
                                .method = WH_RK4,
                                .compensated = true,
                                .step_s = 1.0 / 1024.0};
        stepping with = plain;
        with.stabilized = true;
        const double off = way_off(text, &c, plain, 8.0);
        const double off_with = way_off(text, &c, with, 8.0);
        const double rounds = (is_float ? 1e-6 : 1e-12) * (1.0 + terms_of(&c));
        char what[160];
        snprintf(what, sizeof what, "case %u: %.2e off, without %.2e", i, off_with, off);
        TEST_ASSERT_TRUE_MESSAGE(off_with <= 4.0 * off + rounds, what);
        worst = fmax(worst, off_with);
    }
    printf("%u motions: at most %.1e off after 8 s\n", cases, worst);
}

/* At rest there is no rate to correct, so nothing must be restored. */
TEST(stabilized, rest_stays_rest) {
    dice d = dice_of("stabilized rests", 20261130);
    for (unsigned i = 0; i < 10; i++) {
        chain c = drawn_chain(&d);
        char text[TEXT];
        motion m;
        memset(c.start_rad, 0, sizeof c.start_rad);
        write_chain(&c, text);
        const stepping how = {.kind = i % 2 == 0 ? &engine_float : &engine_double,
                              .compensated = i % 3 == 0,
                              .method = WH_RK4,
                              .stabilized = true};
        motion_open_text(&m, text, how);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 5000));
        TEST_ASSERT_TRUE(motion_value(&m, "s") == 0.0 && motion_value(&m, "s'") == 0.0);
        TEST_ASSERT_TRUE(motion_value(&m, "q0") == 0.0 && motion_value(&m, "q0'") == 0.0);
        motion_close(&m);
    }
}

static void run_with(const char *text, const char *const *options, said *what) {
    const char *words[8] = {model_keep(text)};
    for (int k = 0; options[k] != NULL; k++) {
        words[k + 1] = options[k];
    }
    command_say(command_run, words, what);
    model_drop();
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what->err), what->status, what->err);
}

/* --stabilized must not hide a coarse step: a loss of a hundredth in a thousand steps must still cause the warning. */
TEST(stabilized, coarse_steps_are_warned_of) {
    dice d = dice_of("stabilized springs", 20261201);
    for (unsigned i = 0; i < usual_or(8, 2); i++) {
        const double swing = dice_between(&d, 0.3, 1.5); /* angle in a step, rad */
        char text[TEXT];
        said what;
        snprintf(text, sizeof text,
                 "mechanism spring\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N/m]*x^2/2\n"
                 "scene swings {\nstart x = %.17g [m]\nstep 1 [ms]\nuntil 10 [s]\n}\n",
                 1e6 * swing * swing, dice_between(&d, 0.01, 1.0));
        static const char *const words[2][6] = {
            {"--stabilized", "--quiet", NULL},
            {"--stabilized", "--quiet", "--number", "float", "--compensated", NULL}};
        run_with(text, words[i % 2], &what);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "energy balance fails"), text);
    }
}

/* Two masses have a slow common oscillation, and a relative one that is too fast for the step and loses energy.
 * --stabilized gives this energy to both oscillations. The warning must be that of a run without it. */
TEST(stabilized, misplaced_energy_is_warned_of) {
    dice d = dice_of("stabilized pairs", 20261202);
    const unsigned cases = usual_or(16, 3);
    unsigned told = 0;
    for (unsigned i = 0; i < cases; i++) {
        static const char *const words[2][3] = {{"--quiet", NULL},
                                                {"--stabilized", "--quiet", NULL}};
        const double fast = dice_between(&d, 0.12, 0.3); /* angle in a step, rad */
        const double share = dice_between(&d, 0.001, 0.1);
        char text[TEXT];
        said what[2];
        snprintf(text, sizeof text,
                 "mechanism pair\ncoordinate a [m]\ncoordinate b [m]\nparameter K = %.17g [N/m]\n"
                 "T = 1 [kg]*(a'^2 + b'^2)/2\nV = 1 [N/m]*(a^2 + b^2)/2 + K*(a - b)^2/2\n"
                 "scene swings {\nstart a = 1 [m], b = 1 [m], a' = %.17g [m/s], b' = %.17g [m/s]\n"
                 "step 1 [ms]\nuntil 60 [s]\n}\n",
                 1e6 * fast * fast / 2.0, sqrt(share), -sqrt(share));
        for (int way = 0; way < 2; way++) {
            run_with(text, words[way], &what[way]);
        }
        const bool plain = strstr(what[0].err, "energy balance fails") != NULL;
        const bool with = strstr(what[1].err, "energy balance fails") != NULL;
        TEST_ASSERT_TRUE_MESSAGE(plain == with, text);
        told += with;
    }
    printf("%u of %u pairs are told of, with it and without\n", told, cases);
    TEST_ASSERT_TRUE(told > 0);
}

/* The error of `name` at the end that --stabilized causes, relative to the run without it, which is right. */
static double apart(const char *text, const char *name, stepping plain, double end_s) {
    double end[2];
    for (int way = 0; way < 2; way++) {
        motion m;
        plain.stabilized = way == 1;
        motion_open_text(&m, text, plain);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, (uint64_t)lround(end_s / plain.step_s)));
        end[way] = motion_value(&m, name);
        motion_close(&m);
    }
    return fabs(end[0] - end[1]);
}

/* Two cases that must not be trusted. First, an oscillation that is too fast even for half the step loses energy, and
 * --stabilized gives it to another oscillation, whose period depends on its energy. Second, a light pendulum beside a
 * heavy one depends on the last digits of the heavy one's energy. */
TEST(stabilized, wrong_results_are_not_trusted) {
    dice d = dice_of("stabilized wrongly", 20261203);
    const unsigned cases = usual_or(few_or_all(4, 16), 2);
    unsigned wrong = 0;
    for (unsigned i = 0; i < cases; i++) {
        static const char *const words[2][5] = {
            {"--stabilized", NULL}, {"--stabilized", "--number", "float", "--compensated", NULL}};
        const bool is_heavy = i % 2 == 1;
        const double fast = dice_between(&d, 1.0, 1.8); /* angle in a step, rad */
        const double step_s = 0.0125;
        char text[TEXT];
        if (is_heavy) {
            const double heavy = pow(10.0, dice_between(&d, 4.5, 6.0));
            snprintf(text, sizeof text,
                     "mechanism beside\ncoordinate a [rad]\ncoordinate x [rad]\n"
                     "T = %.17g [kg*m^2]*a'^2/2 + 1 [kg*m^2]*x'^2/2\nV = -%.17g [J]*cos(a) - 1 "
                     "[J]*cos(x)\nscene swings {\nstart x = 1 [rad]\nstep 12.5 [ms]\nuntil 400 "
                     "[s]\n}\n",
                     heavy, heavy);
        } else {
            snprintf(text, sizeof text,
                     "mechanism inside\ncoordinate x [m]\ncoordinate u [m]\nparameter w = %.17g "
                     "[1/s]\nT = 1 [kg]*x'^2/2 + 5000 [kg]*(u' - x')^2/2\nV = 1 [N/m^3]*x^4/4 + "
                     "5000 [kg]*w^2*(u - x)^2/2\nscene swings {\nstart x = 1 [m], u = %.17g [m]\n"
                     "step 12.5 [ms]\nuntil 1500 [s]\n}\n",
                     fast / step_s, 1.0 + dice_between(&d, 1.5e-6, 3e-6) * 0.008 / step_s);
        }
        const stepping plain = {.kind = is_heavy ? &engine_float : &engine_double,
                                .method = WH_RK4,
                                .compensated = is_heavy,
                                .step_s = step_s};
        const double off = apart(text, "x", plain, is_heavy ? 400.0 : 1500.0);
        said what;
        run_with(text, words[is_heavy], &what);
        const bool trusted = strstr(what.out, "to the end") != NULL && what.err[0] == '\0';
        TEST_ASSERT_TRUE_MESSAGE(off < 0.004 || !trusted, text);
        wrong += off >= 0.004;
    }
    printf("%u of %u are made wrong, and none of these is trusted\n", wrong, cases);
    TEST_ASSERT_TRUE(2 * wrong >= cases);
}

SUITE(stabilized) { UnitySetTestFile(__FILE__); }

/* === suite stabilized_beside ================================================================== */
/* The effect of --stabilized on a slow motion (a free wheel or cart with little energy) beside a swing. With
 * Runge-Kutta 4, the swing loses (h w)^6/72 of its energy in each step. All rates must get the same relative
 * correction. If the correction were larger at the turning points of the swing, the slow motion would get most of
 * the energy. */

typedef struct beside {
    double step_s;
    double angular_radps; /* angular frequency of the swing */
    double slow;          /* speed of the slow motion, relative to the largest rate of the swing */
    double start_m;
    double start_mps;
    bool is_angle; /* the slow coordinate is an angle, not a length */
} beside;

static beside drawn(dice *d) {
    beside b = {.step_s = pow(10.0, dice_between(d, -4.0, -1.0)),
                .slow = pow(10.0, dice_between(d, -4.0, -1.0)),
                .start_m = dice_between(d, 0.2, 1.0),
                .is_angle = dice_one_of(d, 2) == 0};
    b.angular_radps = dice_between(d, 0.06, 0.1) / b.step_s;
    b.start_mps = dice_between(d, -1.0, 1.0) * b.angular_radps * b.start_m;
    return b;
}

static double amplitude_m(const beside *b) {
    const double other_m = b->start_mps / b->angular_radps;
    return sqrt(b->start_m * b->start_m + other_m * other_m);
}

static double slow_off(const beside *b, stepping how, uint64_t steps) {
    char text[900];
    motion m;
    const double slow = b->slow * b->angular_radps * amplitude_m(b);
    snprintf(text, sizeof text,
             "mechanism beside\ncoordinate x [m]\ncoordinate y [%s]\n"
             "T = 1 [kg]*x'^2/2 + 1 [%s]*y'^2/2\nV = %.17g [N/m]*x^2/2\n"
             "scene s { start x = %.17g [m], x' = %.17g [m/s], y' = %.17g [%s]\n"
             "step %.17g [s]\nuntil 1e9 [s] }\n",
             b->is_angle ? "rad" : "m", b->is_angle ? "kg*m^2" : "kg",
             b->angular_radps * b->angular_radps, b->start_m, b->start_mps, slow,
             b->is_angle ? "rad/s" : "m/s", b->step_s);
    how.step_s = b->step_s;
    how.stabilized = true;
    motion_open_text(&m, text, how);
    double most = 0.0;
    for (uint64_t k = 0; k < steps; k += 1000) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1000));
        most = fmax(most, fabs(motion_value(&m, "y'") / slow - 1.0));
    }
    motion_close(&m);
    return most;
}

TEST(stabilized_beside, slow_oscillation_gets_its_share) {
    dice d = dice_of("stabilized beside", 20261204);
    const unsigned cases = usual_or(dice_cases(few_or_all(16, 100)), 4);
    const uint64_t steps = 200000;
    double least = (double)INFINITY;
    double most = 0.0;
    for (unsigned i = 0; i < cases; i++) {
        const beside b = drawn(&d);
        const bool is_float = i % 3 == 2;
        const double lost =
            (double)steps * pow(b.angular_radps * b.step_s, 6.0) / 72.0; /* of the energy */
        const stepping how = {.kind = is_float ? &engine_float : &engine_double,
                              .method = WH_RK4,
                              .compensated = is_float};
        const double part = slow_off(&b, how, steps) / lost;
        char what[200];
        snprintf(what, sizeof what, "case %u, %s, slow %.2g: %.3g of the %.2e that is lost", i,
                 how.kind->name, b.slow, part, lost);
        TEST_ASSERT_TRUE_MESSAGE(part > 0.5 && part < 2.0, what);
        least = fmin(least, part);
        most = fmax(most, part);
    }
    printf("  %u pairs: the slow one's rate changes by %.2f to %.2f of the part that is lost\n",
           cases, least, most);
}
