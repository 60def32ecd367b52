/* test_energy_kept.c: conservative mechanisms of constant mass, drawn: by every method of order two and up, compensated
 * float keeps their energy as double does. What rounding leaves does not lead one way (core/step/step_end.h, wh_square_short). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command.h"
#include "motion.h"

#include "unity.h"

void suite_energy_kept(void);

enum { COORDINATES = 2, STEPS = 20000, LOOKS = 200, APART = 7 };

/* Coordinates by themselves, -a cos q or a q^2/2 + b q^4/4, and one potential of both. */
typedef struct swinging {
    int coordinates;
    bool turns[COORDINATES]; /* an angle */
    double inertia[COORDINATES], a[COORDINATES], b[COORDINATES], start[COORDINATES];
    double both;
    double fastest_radps; /* at most, of small motions */
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

/* What part of its energy it gained over the steps, the mean of some looks; NAN: it was refused. */
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

/* Stages that stand 4.8e-8 of their way too far, as those of a step of a millisecond do, would lead by (h w)^2 times half of
 * that in every step; scatter is h w times a float's last place over the square root of the steps. Methods that take energy
 * themselves take less of it where h w is small. */
static void test_energy_does_not_leak_by_rounding(void) {
    static const struct {
        wh_method method;
        double least, most; /* h w */
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
    TEST_ASSERT_TRUE(sqrt(sum / cases) > 1e-10 &&
                     sqrt(sum / cases) < 1e-8); /* 2.7e-8 where stages are left short */
}

void suite_energy_kept(void) { RUN_TEST(test_energy_does_not_leak_by_rounding); }
