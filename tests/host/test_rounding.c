/* test_rounding.c: the error of float: with the usual step, its growth with the number of steps, the gain by
 * compensated sums, and angles after a million turns. Also whether compensated float keeps the energy.
 *
 * Bounds come from a model of round-off, not from the runs. u = 2^-24 is half a unit in the last place of 1. A plain
 * sum of N steps walks at random: sqrt(N/3) u times the power of two of the sum. A compensated sum keeps the rate to
 * about u of itself, and the angle has a relative error of u. The constants of the step (its length, phase units in
 * a radian) are rounded by as much. */
#include "command.h"
#include "motion.h"

#define U 0x1p-24

static void expect_within(const char *what, double least, double most, double got) {
    printf("  %-62s %.3g (%.3g ... %.3g)\n", what, got, least, most);
    TEST_ASSERT_TRUE_MESSAGE(got >= least && got <= most, what);
}

static double error_at(const char *name, const char *time, stepping how) {
    motion m;
    motion_open(&m, name, how);
    motion_to(&m, strtod(time, NULL));
    const double error = motion_error(&m, "tests/reference/trajectory.txt", name, time);
    motion_close(&m);
    return error;
}

/* Error of theta at 9 s in `steps` steps: 9 s/sqrt(3) times the error of theta' at the end, whose sum walks at
 * random (theta' is 16 to 32 rad/s there). */
static double gear_walk(double steps) { return sqrt(steps / 3.0) * 16.0 * U * 9.0 / sqrt(3.0); }

TEST(rounding, float_on_the_epicyclic_gear) {
    const double theta_at_9s = 89.63;
    const double plain = error_at("epicyclic_from_rest", "9.0", IN_FLOAT);
    const double compensated = error_at("epicyclic_from_rest", "9.0", IN_FLOAT_COMPENSATED);
    expect_within("S6 float, 1 ms, error at 9 s, four states", theta_at_9s * U,
                  2.0 * gear_walk(9000), plain);
    expect_within("S6 float compensated, the same", 0.1 * theta_at_9s * U, theta_at_9s * U,
                  compensated);
    expect_within("S6 gain", 10.0, 1000.0, plain / compensated);
}

/* A change of the start is 6e3 times larger after 5 s (thomson_is_chaotic). theta2' reaches 16 rad/s, so each step
 * rounds it by up to 8 U. */
TEST(rounding, float_on_thomson_device) {
    const double amplified = 6e3 * U;
    const double plain = error_at("thomson_a", "5.0", IN_FLOAT_STEP(1e-3));
    const double compensated = error_at("thomson_a", "5.0", IN_FLOAT_COMPENSATED_STEP(1e-3));
    expect_within("S8 float, 1 ms, error at 5 s, six states", amplified,
                  amplified * 8.0 * sqrt(5000.0 / 3.0), plain);
    expect_within("S8 float compensated, the same", 0.01 * amplified, amplified, compensated);
    expect_within("S8 gain", 10.0, 10000.0, plain / compensated);
}

/* Largest error of any component at the end. The reference is double with a step of 1/16 ms. */
static double whole_error(const char *name, const char *start, double until_s, double step_s) {
    double value[2][3 * IMAGE_COMPONENTS_MAX];
    double worst = 0.0;
    int count = 0;
    for (int exact = 0; exact < 2; exact++) {
        const stepping how = {.kind = exact ? &engine_double : &engine_float,
                              .method = WH_RK4,
                              .compensated = true,
                              .start = start,
                              .step_s = exact ? 1e-3 / 16 : step_s};
        motion m;
        motion_open(&m, name, how);
        motion_to(&m, until_s);
        m.kind->state(m.run, value[exact], value[exact] + m.image->angles);
        count = m.image->angles + m.image->reals;
        motion_close(&m);
    }
    for (int i = 0; i < count; i++) {
        worst = fmax(worst, fabs(value[0][i] - value[1][i]));
    }
    return worst;
}

enum { STARTS = 9 };

/* The median error for starts that differ by up to 4e-5 rad. Chaos makes a change 2e4 times larger, so a single run
 * says little. */
static double middle_error(const char *name, double until_s, double step_s) {
    double error[STARTS];
    for (int i = 0; i < STARTS; i++) {
        char start[40];
        snprintf(start, sizeof start, "theta1=%de-5", i - STARTS / 2);
        const double one = whole_error(name, start, until_s, step_s);
        int at = i;
        for (; at > 0 && error[at - 1] > one; at--) {
            error[at] = error[at - 1];
        }
        error[at] = one;
    }
    return error[STARTS / 2];
}

/* The constants of the step have two parts; those of the lists are floats. The error must not grow if steps become
 * shorter, nor with steps that float does not represent. The gear without its carriage has one rounded constant,
 * 25/9, whose error no further operation can remove. */
TEST(rounding, no_step_is_too_small_for_compensated_sums) {
    static const double step_s[] = {1e-3, 0.9e-4, 1e-5};
    const double theta_at_9s = 89.63;
    const unsigned steps = few_or_all(1, sizeof step_s / sizeof step_s[0]);
    for (unsigned i = 0; i < steps && i < sizeof step_s / sizeof step_s[0]; i++) {
        char what[100];
        snprintf(what, sizeof what, "S6 compensated, %g ms, whole state at 9 s", step_s[i] * 1e3);
        expect_within(what, 0.0, 1e-6, whole_error("epicyclic_from_rest", NULL, 9.0, step_s[i]));
        snprintf(what, sizeof what, "S6c compensated, %g ms, whole state at 9 s", step_s[i] * 1e3);
        expect_within(what, 0.0, theta_at_9s * U,
                      whole_error("epicyclic_conserved", NULL, 9.0, step_s[i]));
        snprintf(what, sizeof what, "S8c compensated, %g ms, whole state at 8 s", step_s[i] * 1e3);
        if (i != 1) { /* the step 0.9e-4 s does not divide 8 s */
            expect_within(what, 5e-6, 1e-4, middle_error("thomson_a_conserved", 8.0, step_s[i]));
        }
    }
}

TEST(rounding, a_million_steps) {
    stepping how = IN_FLOAT;
    how.step_s = 9e-6;
    const double plain = error_at("epicyclic_from_rest", "9.0", how);
    how.compensated = true;
    const double compensated = error_at("epicyclic_from_rest", "9.0", how);
    expect_within("S6 float, 1e6 steps of 9 us, error at 9 s", 0.1 * gear_walk(1e6),
                  2.0 * gear_walk(1e6), plain);
    expect_within("S6 float compensated, the same", 0.1 * 89.63 * U, 89.63 * U, compensated);
}

static const char rotor[] = "mechanism rotor\n"
                            "coordinate theta [rad]\n"
                            "parameter I = 1 [kg*m^2]\n"
                            "T = I*theta'^2/2\n"
                            "scene spin {\n"
                            "  start theta' = 2500 [rad/s]\n"
                            "  step 0.9765625 [ms]\n"
                            "  until 1 [s]\n"
                            "}\n";

/* theta = rate * time. After a million turns, the error must be that of one product. A sum in radians in float would
 * resolve only half a radian there. */
TEST(rounding, a_million_turns_at_constant_rate) {
    const double step_rad = 2500.0 / 1024.0; /* exact in float */
    const unsigned steps = 2573593;
    const double wanted = step_rad * steps;
    motion m;
    motion_open_text(&m, rotor, IN_FLOAT);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, steps));
    const double got = motion_value(&m, "theta");
    const double before = got;
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    const double last_step = motion_value(&m, "theta") - before;
    motion_close(&m);

    float radians = 0.0f;
    for (unsigned i = 0; i < steps; i++) {
        radians += (float)step_rad;
    }
    expect_within("turns of a free rotor", 1e6, 1.001e6, got / 6.283185307179586);
    expect_within("relative error of its angle", 0.0, 2.0 * U, fabs(got / wanted - 1.0));
    expect_within("relative error of its last step", 0.0, 2.0 * U,
                  fabs(last_step / step_rad - 1.0));
    expect_within("relative error of the sum in float radians", 1e-3, 1.0,
                  fabs((double)radians / wanted - 1.0));
}

static const char started[] = "mechanism started_rotor\n"
                              "coordinate theta [rad]\n"
                              "parameter I = 1 [kg*m^2]\n"
                              "parameter M = 0.00006103515625 [N*m]\n"
                              "T = I*theta'^2/2\n"
                              "Q(theta) = M\n"
                              "scene spin_up {\n"
                              "  step 0.9765625 [ms]\n"
                              "  until 100 [s]\n"
                              "}\n";

/* theta = a t^2/2 with a = 2^-14 rad/s^2 and h = 2^-10 s: every rate is exact, so only the angle is rounded. Rounded
 * to nearest, the angle walks by sqrt(N/12) units of 1.5e-9 rad. Truncation would lose half a unit in each of 1e5
 * steps, or 7e-5 rad. The constants of the step add 2 U of the angle. */
TEST(rounding, angle_steps_are_rounded_not_cut) {
    const double N = 1e5;
    const double t = N / 1024.0;
    const double wanted = t * t / 32768.0;
    for (unsigned compensated = 0; compensated < 2; compensated++) {
        motion m;
        motion_open_text(&m, started, compensated ? IN_FLOAT_COMPENSATED : IN_FLOAT);
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, (uint64_t)N));
        const double error = fabs(motion_value(&m, "theta") - wanted);
        motion_close(&m);
        expect_within("slow rotor, 1e5 steps, error of the angle, rad", 0.0,
                      3.0 * sqrt(N / 12.0) * 1.5e-9 + 2.0 * U * wanted, error);
    }
}

/* A gear that starts a million turns from zero must move with the same bits as a gear that starts at zero. */
TEST(rounding, motion_after_a_million_turns) {
    static const char *const others[] = {"X", "theta'", "X'"};
    stepping how = IN_FLOAT;
    motion m;
    motion turned;
    motion_open(&m, "epicyclic_from_rest", how);
    how.start = "theta=1000000 [rev]";
    motion_open(&turned, "epicyclic_from_rest", how);
    for (unsigned i = 0; i < 9000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&turned, 1));
        for (unsigned k = 0; k < 3; k++) {
            TEST_ASSERT_TRUE(motion_value(&m, others[k]) == motion_value(&turned, others[k]));
        }
    }
    TEST_ASSERT_DOUBLE_WITHIN(2e-9, 1e6 * 6.283185307179586,
                              motion_value(&turned, "theta") - motion_value(&m, "theta"));
    TEST_ASSERT_TRUE(motion_value(&m, "theta") > 80.0);
    motion_close(&m);
    motion_close(&turned);
}

/* === suite energy_kept ======================================================================== */
/* Random conservative mechanisms with constant mass. For every method of order two or higher, compensated float must
 * conserve energy as well as double does. Its remaining round-off is unbiased (core/step/step_end.h,
 * wh_square_short). */

enum { COORDINATES = 2, STEPS = 20000, LOOKS = 200, APART = 7 };

/* A mechanism with the potential -a cos q or a q^2/2 + b q^4/4 for each coordinate, and one potential of both
 * coordinates. */
typedef struct swinging {
    int coordinates;
    bool turns[COORDINATES]; /* is the coordinate an angle? */
    double inertia[COORDINATES], a[COORDINATES], b[COORDINATES], start[COORDINATES];
    double both;
    double fastest_radps; /* upper bound for small motions */
} swinging;

static swinging drawn(dice *d) {
    swinging s = {.coordinates = 1 + (int)dice_one_of(d, 2)};
    for (int i = 0; i < s.coordinates; i++) {
        s.turns[i] = dice_one_of(d, 2) == 0;
        s.inertia[i] = dice_between(d, 0.5, 2.0);
        s.a[i] = s.inertia[i] * pow(10.0, dice_between(d, 0.0, 2.0));
        s.b[i] = s.turns[i] ? 0.0 : s.a[i] * dice_between(d, 0.0, 0.5);
        s.start[i] = dice_between(d, 0.4, 1.2);
    }
    if (s.coordinates == 2) {
        s.both = 0.2 * dice_between(d, 0.2, 1.0) * fmin(s.a[0], s.a[1]);
    }
    for (int i = 0; i < s.coordinates; i++) {
        s.fastest_radps =
            fmax(s.fastest_radps, sqrt((s.a[i] + 2.0 * s.b[i] + 2.0 * s.both) / s.inertia[i]));
    }
    return s;
}

static void text_of(const swinging *s, char *text, size_t size) {
    FILE *out = fmemopen(text, size, "w");
    fputs("mechanism m\n", out);
    for (int i = 0; i < s->coordinates; i++) {
        fprintf(out, "coordinate q%d [%s]\n", i, s->turns[i] ? "rad" : "m");
    }
    fputs("T = 0 [J]", out);
    for (int i = 0; i < s->coordinates; i++) {
        fprintf(out, " + %.17g [%s]*q%d'^2/2", s->inertia[i], s->turns[i] ? "kg*m^2" : "kg", i);
    }
    fputs("\nV = 0 [J]", out);
    for (int i = 0; i < s->coordinates; i++) {
        if (s->turns[i]) {
            fprintf(out, " + %.17g [J]*(1 - cos(q%d))", s->a[i], i);
        } else {
            fprintf(out, " + %.17g [N/m]*q%d^2/2 + %.17g [N/m^3]*q%d^4/4", s->a[i], i, s->b[i], i);
        }
    }
    if (s->coordinates == 2) {
        static const char *const of_both[] = {" + %.17g [N/m]*(q0 - q1)^2/2",
                                              " + %.17g [N]*q1*sin(q0)", " + %.17g [N]*q0*sin(q1)",
                                              " + %.17g [J]*(1 - cos(q0 - q1))"};
        fprintf(out, of_both[(s->turns[0] ? 1 : 0) + (s->turns[1] ? 2 : 0)], s->both);
    }
    fputs("\nscene s {\n", out);
    for (int i = 0; i < s->coordinates; i++) {
        fprintf(out, "start q%d = %.17g [%s]\n", i, s->start[i], s->turns[i] ? "rad" : "m");
    }
    fputs("step 1 [ms]\nuntil 1e6 [s] }\n", out);
    fclose(out);
}

static double energy_J(const swinging *s, const motion *m) {
    double q[COORDINATES] = {0.0};
    double sum = 0.0;
    for (int i = 0; i < s->coordinates; i++) {
        char name[20];
        snprintf(name, sizeof name, "q%d", i);
        q[i] = motion_value(m, name);
        snprintf(name, sizeof name, "q%d'", i);
        const double rate = motion_value(m, name);
        sum += s->inertia[i] * rate * rate / 2.0;
        sum += s->turns[i] ? s->a[i] * (1.0 - cos(q[i]))
                           : s->a[i] * q[i] * q[i] / 2.0 + s->b[i] * pow(q[i], 4.0) / 4.0;
    }
    if (s->coordinates == 2) {
        const double apart = q[0] - q[1];
        sum += s->both * (s->turns[0] != s->turns[1]
                              ? (s->turns[0] ? q[1] * sin(q[0]) : q[0] * sin(q[1]))
                          : s->turns[0] ? 1.0 - cos(apart)
                                        : apart * apart / 2.0);
    }
    return sum;
}

/* Relative gain of energy over the run, as the mean of some samples; NaN if the run is refused. */
static double gained(const swinging *s, const char *text, stepping how) {
    motion m;
    motion_open_text(&m, text, how);
    const double begin_J = energy_J(s, &m);
    double sum = motion_step(&m, STEPS) == WH_OK ? 0.0 : (double)NAN;
    for (int i = 0; i < LOOKS; i++) {
        sum += motion_step(&m, APART) == WH_OK ? energy_J(s, &m) / begin_J - 1.0 : (double)NAN;
    }
    motion_close(&m);
    return sum / LOOKS;
}

/* If the length of a stage is wrong by a relative 4.8e-8, as with steps of 1 ms, each step changes the energy by
 * 4.8e-8 (h w)^2/2. The random part is h w times one unit in the last place of a float, divided by the square root of
 * the number of steps. With a small h w, the methods themselves lose less. */
TEST(energy_kept, energy_does_not_leak_by_rounding) {
    static const struct {
        wh_method method;
        double least, most; /* range of h w in rad a step */
    } tried[] = {{WH_NYSTROEM5, 0.15, 0.3}, {WH_LEAPFROG, 0.15, 0.3},
                 {WH_RK4, 0.1, 0.12},       {WH_SEMI_IMPLICIT_EULER, 0.15, 0.3},
                 {WH_RK38, 0.1, 0.12},      {WH_NYSTROEM4, 0.1, 0.12}};
    enum { TRIED = sizeof tried / sizeof tried[0] };
    dice d = dice_of("energy_kept", 1401);
    const unsigned cases = dice_cases(few_or_all(6, 60));
    double worst = 0.0;
    double sum = 0.0;
    for (unsigned k = 0; k < cases; k++) {
        char text[1500];
        char decimals[40];
        const swinging s = drawn(&d);
        const unsigned t = k % TRIED;
        const double turn = dice_between(&d, tried[t].least, tried[t].most);
        snprintf(decimals, sizeof decimals, "%.2g", turn / s.fastest_radps);
        stepping how = {.kind = &engine_float,
                        .method = tried[t].method,
                        .compensated = true,
                        .step_s = strtod(decimals, NULL)};
        text_of(&s, text, sizeof text);
        const double in_float = gained(&s, text, how);
        how.kind = &engine_double;
        const double leak = (in_float - gained(&s, text, how)) / STEPS / (turn * turn);
        TEST_ASSERT_TRUE_MESSAGE(fabs(leak) < 2.5e-8, text);
        worst = fmax(worst, fabs(leak));
        sum += leak * leak;
    }
    printf(
        "  (h w)^2 times at most %.1e of the energy a step, %.1e at the root of the mean square\n",
        worst, sqrt(sum / cases));
    TEST_ASSERT_TRUE(sqrt(sum / cases) > 1e-10 && sqrt(sum / cases) < 1e-8); /* biased: 2.7e-8 */
}
