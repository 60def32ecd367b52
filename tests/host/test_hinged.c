/* test_hinged.c: bodies on hinges, which derivation eliminates by what their hinges see (host/derive/solve.c): random
 * carriages, arms and hinged bodies, whose accelerations must fulfil the equations they were solved from. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "command.h"
#include "derived.h"

#include "unity.h"

void suite_hinged(void);

enum { MECHANISMS = 160, STATES = 12, BODIES_MOST = 3 };

static bool chance(uint64_t *seed, int percent) {
    return random_between(seed, 0.0, 100.0) < percent;
}

/* Written only where it is wanted. */
__attribute__((format(printf, 3, 4))) static void maybe(FILE *out, bool wanted, const char *format,
                                                        ...) {
    va_list arguments;
    va_start(arguments, format);
    if (wanted) {
        vfprintf(out, format, arguments);
    }
    va_end(arguments);
}

/* A carriage, or two directions of it, an arm or none on it, bodies on the arm's end, on each other or on the carriage;
 * gravity, springs, dampers, torques, inputs; angles from the vertical or from the body above. */
static char *written(uint64_t *seed) {
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    const bool plane = chance(seed, 30);
    const bool fixed = !plane && chance(seed, 25);
    const bool arm = chance(seed, 60);
    const int bodies = 1 + (int)random_between(seed, 0.0, BODIES_MOST - 0.001);
    fputs("mechanism hinged \"Hinged\"\n", out);
    fputs(fixed ? "" : "coordinate x [m]\n", out);
    fputs(plane ? "coordinate y [m]\n" : "", out);
    fprintf(out, "let ux = %s\nlet uy = %s\n", fixed ? "0 [m/s]" : "x'", plane ? "y'" : "0 [m/s]");
    fputs(arm ? "coordinate b [rad]\n" : "", out);
    const double turns = chance(seed, 30) ? 2.0 : 1.0;
    const double reach = arm ? random_between(seed, 0.1, 0.9) : 0.0;
    if (arm) {
        fprintf(out, "let ex = ux - %.3f [m]*b'*(sin(b) + %g*sin(%g*b))\n", reach, turns - 1.0,
                turns);
        fprintf(out, "let ey = uy + %.3f [m]*b'*(cos(b) + %g*cos(%g*b))\n", reach, turns - 1.0,
                turns);
    } else {
        fputs("let ex = ux\nlet ey = uy\n", out);
    }
    int on[BODIES_MOST];
    bool relative[BODIES_MOST];
    for (int k = 0; k < bodies; k++) {
        const double rod = random_between(seed, 0.1, 0.8);
        on[k] = k > 0 && chance(seed, 40) ? k - 1 : -1;
        relative[k] = on[k] >= 0 && chance(seed, 30);
        fprintf(out, "coordinate a%d [rad]\ninput M%d = %.2f [N*m]\n", k, k,
                random_between(seed, -1, 1));
        fprintf(out, "let w%d = a%d'%s", k, k, relative[k] ? " + w" : "\n");
        maybe(out, relative[k], "%d\n", on[k]);
        fprintf(out, "let t%d = a%d%s", k, k, relative[k] ? " + t" : "\n");
        maybe(out, relative[k], "%d\n", on[k]);
        char above[2][8] = {"ex", "ey"};
        if (on[k] >= 0) {
            snprintf(above[0], sizeof above[0], "px%d", on[k]);
            snprintf(above[1], sizeof above[1], "py%d", on[k]);
        }
        fprintf(out, "let px%d = %s - %.3f [m]*w%d*sin(t%d)\n", k, above[0], rod, k, k);
        fprintf(out, "let py%d = %s + %.3f [m]*w%d*cos(t%d)\n", k, above[1], rod, k, k);
    }
    fprintf(out, "T = %.2f [kg]*(ux^2 + uy^2)", random_between(seed, 0.5, 3.0));
    maybe(out, arm, " + %.2f [kg*m^2]*b'^2 + %.2f [kg]*(ex^2 + ey^2)",
          random_between(seed, 0.01, 0.5), random_between(seed, 0.0, 1.0));
    for (int k = 0; k < bodies; k++) {
        fprintf(out, " + %.2f [kg]*(px%d^2 + py%d^2)", random_between(seed, 0.1, 2.0), k, k);
        maybe(out, chance(seed, 50), " + %.3f [kg*m^2]*w%d^2", random_between(seed, 0.0, 0.1), k);
    }
    fputs("\nV = 0 [J]", out);
    for (int k = 0; k < bodies && chance(seed, 60); k++) {
        fprintf(out, " + %.2f [J]*sin(t%d)", random_between(seed, 0.5, 9.0), k);
        maybe(out, chance(seed, 30), " + 1 [J]*a%d^2", k);
    }
    fputs(fixed ? "\n" : " + 7 [N/m]*x^2\n", out);
    for (int k = 0; k < bodies; k++) {
        fprintf(out, "Q(a%d) = M%d\n", k, k);
    }
    maybe(out, chance(seed, 50), "F = %.2f [N*m*s]*a0'^2\n", random_between(seed, 0.1, 1.0));
    fclose(out);
    return text;
}

/* The largest part of an equation that an image's accelerations leave over. */
static double left_over(const derived *d, uint64_t *seed) {
    double worst = 0.0;
    for (int i = 0; i < STATES; i++) {
        state_values s;
        double found[UNKNOWNS];
        double accel[UNKNOWNS];
        random_state(&s, d, seed);
        derived_run(d->image->list[IMAGE_STEP], d, &s, found);
        for (int u = 0; u < d->image->count; u++) {
            accel[u] = found[d->image->place[u]];
        }
        for (int u = 0; u < d->image->count; u++) {
            double size;
            const double rest = derived_rest(d, &s, accel, u, &size);
            worst = fmax(worst, fabs(rest) / size);
        }
    }
    return worst;
}

static void test_accelerations_fulfil_their_equations(void) {
    uint64_t seed = 20261122;
    double worst = 0.0;
    const unsigned mechanisms = usual_or(MECHANISMS, 40);
    for (unsigned m = 0; m < mechanisms; m++) {
        char *text = written(&seed);
        derived d = derived_text(text);
        derived_expect(&d, text);
        const double left = left_over(&d, &seed);
        TEST_ASSERT_TRUE_MESSAGE(left <= 1e-10, text);
        worst = fmax(worst, left);
        derived_free(&d);
        free(text);
    }
    char words[80];
    snprintf(words, sizeof words, "%u mechanisms: at most %.1e of an equation is left over",
             mechanisms, worst);
    TEST_MESSAGE(words);
    TEST_ASSERT_TRUE(worst > 0.0);
}

void suite_hinged(void) { RUN_TEST(test_accelerations_fulfil_their_equations); }
