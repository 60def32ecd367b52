/* test_folded.c: a light body, and a heavy one that a stiff spring holds and that is counted from the light one: k1 + k2, folded
 * to double, keeps few digits of the softer spring, which is all that the light body feels; and every run of the scene goes by
 * the same number. Given by energies or by equations, with parameters or numbers, with dampers or without, and a third body
 * between them at times. The reference never adds what belongs to two bodies: each by itself, in long double. What is off is
 * told; what is right is left alone. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "by_bodies.h"
#include "command.h"
#include "host/cli/commands.h"
#include "host/number/folding.h"
#include "host/number/functions.h"
#include "motion.h"
#include "unity.h"

void suite_folded(void);

enum { MOST = BODIES_MOST, LINKS = 4, GROUND = -1 };

typedef struct link {
    int of;
    int to; /* GROUND */
    double spring_Npm;
    double damper_Nspm;
} link;

/* Bodies 0 ... bodies - 1, each counted from the one before it, the first from the ground. */
typedef struct held {
    int bodies;
    int links;
    double mass_kg[MOST];
    link link[LINKS];
    double start[MOST]; /* of the coordinates */
    double step_s;
    int steps;
    bool by_equations;
    bool by_numbers; /* no parameters */
} held;

/* --- the text -------------------------------------------------------------------------------------------------------- */

/* The place of a body, or its rates. */
static void put_place(FILE *out, int body, const char *primes) {
    fputs("(0", out);
    for (int b = 0; b <= body; b++) {
        fprintf(out, " + q%d%s", b, primes);
    }
    fputc(')', out);
}

static void put_number(FILE *out, const held *h, const char *name, int i, double value,
                       const char *unit) {
    if (h->by_numbers) {
        fprintf(out, "%.17g [%s]", value, unit);
    } else {
        fprintf(out, "%s%d", name, i);
    }
}

static void put_length(FILE *out, const link *l, const char *primes) {
    fputc('(', out);
    put_place(out, l->of, primes);
    if (l->to != GROUND) {
        fputs(" - ", out);
        put_place(out, l->to, primes);
    }
    fputc(')', out);
}

static void put_energies(FILE *out, const held *h) {
    for (int b = 0; b < h->bodies; b++) {
        fputs(b == 0 ? "T = " : " + ", out);
        put_number(out, h, "m", b, h->mass_kg[b], "kg");
        fputc('*', out);
        put_place(out, b, "'");
        fputs("^2/2", out);
    }
    for (int i = 0; i < h->links; i++) {
        fputs(i == 0 ? "\nV = " : " + ", out);
        put_number(out, h, "k", i, h->link[i].spring_Npm, "N/m");
        fputc('*', out);
        put_length(out, &h->link[i], "");
        fputs("^2/2", out);
    }
    for (int i = 0; i < h->links; i++) {
        fputs(i == 0 ? "\nF = " : " + ", out);
        put_number(out, h, "c", i, h->link[i].damper_Nspm, "N*s/m");
        fputc('*', out);
        put_length(out, &h->link[i], "'");
        fputs("^2/2", out);
    }
    fputc('\n', out);
}

/* Lagrange's, multiplied out by hand. */
static void put_equations(FILE *out, const held *h) {
    for (int q = 0; q < h->bodies; q++) {
        fputs("equation 0 [N]", out);
        for (int b = q; b < h->bodies; b++) { /* those that are counted from it */
            fputs(" + ", out);
            put_number(out, h, "m", b, h->mass_kg[b], "kg");
            fputc('*', out);
            put_place(out, b, "''");
        }
        for (int i = 0; i < h->links; i++) {
            const link *l = &h->link[i];
            const int sign = (l->of >= q ? 1 : 0) - (l->to >= q ? 1 : 0);
            if (sign != 0) {
                fputs(sign > 0 ? " + " : " - ", out);
                put_number(out, h, "k", i, l->spring_Npm, "N/m");
                fputc('*', out);
                put_length(out, l, "");
                fputs(sign > 0 ? " + " : " - ", out);
                put_number(out, h, "c", i, l->damper_Nspm, "N*s/m");
                fputc('*', out);
                put_length(out, l, "'");
            }
        }
        fputs(" = 0 [N]\n", out);
    }
}

static void held_text(const held *h, char *text, size_t size) {
    FILE *out = fmemopen(text, size, "w");
    TEST_ASSERT_NOT_NULL(out);
    fputs("mechanism held\n", out);
    for (int b = 0; b < h->bodies; b++) {
        fprintf(out, "%s q%d [m]\n", h->by_equations ? "state" : "coordinate", b);
    }
    for (int b = 0; b < h->bodies && !h->by_numbers; b++) {
        fprintf(out, "parameter m%d = %.17g [kg]\n", b, h->mass_kg[b]);
    }
    for (int i = 0; i < h->links && !h->by_numbers; i++) {
        fprintf(out, "parameter k%d = %.17g [N/m]\nparameter c%d = %.17g [N*s/m]\n", i,
                h->link[i].spring_Npm, i, h->link[i].damper_Nspm);
    }
    if (h->by_equations) {
        put_equations(out, h);
    } else {
        put_energies(out, h);
    }
    fputs("scene s { start ", out);
    for (int b = 0; b < h->bodies; b++) {
        fprintf(out, "%sq%d = %.17g [m]", b > 0 ? ", " : "", b, h->start[b]);
    }
    fprintf(out, "\nstep %.17g [s]\nuntil %.17g [s] }\n", h->step_s, h->step_s * h->steps);
    TEST_ASSERT_EQUAL_INT(0, fclose(out));
}

/* --- the reference ---------------------------------------------------------------------------------------------- */

static void accelerate(const void *of, const bodies_state *s, long double *a_mps2) {
    const held *h = of;
    for (int i = 0; i < h->links; i++) {
        const link *l = &h->link[i];
        const long double x = s->x_m[l->of] - (l->to != GROUND ? s->x_m[l->to] : 0.0L);
        const long double v = s->v_mps[l->of] - (l->to != GROUND ? s->v_mps[l->to] : 0.0L);
        const long double pull = (long double)l->spring_Npm * x + (long double)l->damper_Nspm * v;
        a_mps2[l->of] -= pull / (long double)h->mass_kg[l->of];
        if (l->to != GROUND) {
            a_mps2[l->to] += pull / (long double)h->mass_kg[l->to];
        }
    }
}

static void counted(const void *of, const long double *x, long double *q) {
    const held *h = of;
    for (int b = 0; b < h->bodies; b++) {
        q[b] = x[b] - (b > 0 ? x[b - 1] : 0.0L);
    }
}

/* With the scene's own step: the coordinates at the end, and the range of each. */
static void run_by_bodies(const held *h, long double *end, double *range) {
    const by_bodies b = {h, h->bodies, h->step_s, h->steps, accelerate, counted};
    long double start[MOST] = {0.0L};
    for (int i = 0; i < h->bodies; i++) {
        start[i] = (long double)h->start[i] + (i > 0 ? start[i - 1] : 0.0L);
    }
    by_bodies_run(&b, start, end, range);
}

/* --- what is said ------------------------------------------------------------------------------------------------ */

typedef struct seen {
    bool refused;
    bool told;    /* of what was folded */
    bool warned;  /* of anything */
    bool trusted; /* to the end */
    bool untold;  /* by the bound of what rounding does in a run */
    double off;   /* the most, of the coordinate's range */
} seen;

/* Whatever else is said: of two runs that go by the same numbers one would not know. */
static void no_trust_in(const char *text) {
    said what;
    command_say_model(command_trust, text, &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    TEST_ASSERT_NULL_MESSAGE(strstr(what.out, "trusted to the end"), what.out);
}

static seen see(const held *h) {
    char text[4000];
    said what;
    seen s = {.off = 0.0};
    long double wanted[MOST];
    double range[MOST];
    held_text(h, text, sizeof text);
    command_say_model(command_run, text, &what);
    s.refused = what.status == 2 && (strstr(what.err, "singular mass matrix") != NULL ||
                                     strstr(what.err, "cannot be solved") != NULL);
    if (s.refused) {
        return s;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    s.told = strstr(what.err, "[accuracy]") != NULL || strstr(what.err, "[constants]") != NULL;
    s.warned = strstr(what.err, "warning") != NULL;
    s.trusted = strstr(what.out, "to the end: every") != NULL;
    s.untold = strstr(what.out, "not to be told: double has") != NULL;
    TEST_ASSERT_TRUE_MESSAGE(!s.trusted || !s.warned, what.err);
    motion m;
    motion_open_text(&m, text, IN_DOUBLE);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, (uint64_t)h->steps));
    run_by_bodies(h, wanted, range);
    for (int b = 0; b < h->bodies; b++) {
        char name[8];
        snprintf(name, sizeof name, "q%d", b);
        const double off = fabs((double)((long double)motion_value(&m, name) - wanted[b]));
        s.off = range[b] > 1e-3 ? fmax(s.off, off / range[b]) : s.off;
    }
    motion_close(&m);
    if (s.off > 1e-3) {
        no_trust_in(text);
    }
    return s;
}

static double power_of_ten(dice *d, double low, double high) {
    return pow(10.0, dice_between(d, low, high));
}

/* The heavy body is `ratio` times as heavy; each moves at a rate of its own where it is held. */
static held draw(dice *d, double ratio) {
    held h = {.bodies = 2 + (dice_one_of(d, 4) == 0 ? 1 : 0),
              .links = 2,
              .by_equations = dice_one_of(d, 3) == 0,
              .by_numbers = dice_one_of(d, 2) == 0};
    const int heavy = h.bodies - 1;
    h.mass_kg[0] = power_of_ten(d, -6.0, 2.0);
    h.mass_kg[heavy] = h.mass_kg[0] * ratio;
    const double slow_radps = power_of_ten(d, 0.0, 0.5);
    const double fast_radps = power_of_ten(d, 0.5, 1.5);
    h.link[0] = (link){heavy, GROUND, h.mass_kg[heavy] * fast_radps * fast_radps, 0.0};
    h.link[1] =
        (link){0, dice_one_of(d, 3) == 0 ? GROUND : heavy, h.mass_kg[0] * slow_radps * slow_radps,
               dice_one_of(d, 2) * 0.02 * h.mass_kg[0] * slow_radps};
    h.start[0] = 0.1;
    h.start[heavy] = -0.1; /* in its place */
    if (heavy == 2) {
        h.mass_kg[1] = h.mass_kg[0] * power_of_ten(d, 0.0, 4.0);
        h.link[h.links++] = (link){1, 2, h.mass_kg[1] * slow_radps * slow_radps, 0.0};
        h.start[1] = dice_between(d, -0.05, 0.05);
        h.start[2] = -h.start[0] - h.start[1];
    }
    if (dice_one_of(d, 3) == 0) {
        h.start[heavy] += dice_between(d, -0.1, 0.1) * power_of_ten(d, -10.0, 0.0);
    }
    h.step_s = 0.05 / fast_radps;
    h.steps = 2000 << dice_one_of(d, 4);
    return h;
}

static void test_what_is_lost_is_told(void) {
    dice d = dice_of("folded", 1);
    const unsigned cases = dice_cases(usual_or(few_or_all(60, 600), 6));
    unsigned off = 0;
    unsigned told = 0;
    unsigned ended = 0;
    unsigned right = 0;
    unsigned told_right = 0;
    unsigned ended_right = 0;
    double worst_trusted = 0.0;
    for (unsigned k = 0; k < cases; k++) {
        const double decades = dice_between(&d, 4.0, 10.5);
        const held h = draw(&d, pow(10.0, decades));
        const seen s = see(&h);
        char words[200];
        snprintf(words, sizeof words,
                 "case %u: a ratio of 10^%.2f, off by %.2e of its range, %s, %s", k, decades, s.off,
                 s.told ? "told" : "not told", s.trusted ? "trusted" : "not trusted");
        TEST_ASSERT_TRUE_MESSAGE(s.refused || s.off < 1e-3 || !s.trusted, words);
        TEST_ASSERT_FALSE_MESSAGE(s.told && decades < 6.0, words);
        off += s.off > 1e-3 ? 1U : 0U;
        told += s.told ? 1U : 0U;
        ended += !s.trusted && !s.warned && !s.untold ? 1U : 0U;
        if (!s.refused && s.off < 1e-4) {
            right++;
            told_right += s.told ? 1U : 0U;
            ended_right += !s.trusted && !s.warned && !s.untold ? 1U : 0U;
        }
        worst_trusted = s.trusted ? fmax(worst_trusted, s.off) : worst_trusted;
    }
    printf(
        "  %u bodies that are held: %u off by more than a thousandth; %u told of, trust in %u more ends; "
        "trusted to the end, off by at most %.1e. %u are right to a ten-thousandth: %u of them told of, trust "
        "in %u more ends\n",
        cases, off, told, ended, worst_trusted, right, told_right, ended_right);
    TEST_ASSERT_TRUE(cases < 60 || (off > 0 && told > 0 && right > 0));
    TEST_ASSERT_TRUE(10 * (told_right + ended_right) <= right);
}

/* --- what is no more than rounding -------------------------------------------------------------------------------- */

/* In how many other ways it was folded. */
static int ways_of(const char *text) {
    motion m;
    motion_open_text(&m, text, IN_DOUBLE);
    const int ways = m.image->ways;
    motion_close(&m);
    return ways;
}

/* A mass on an arm from a carriage, where the arm's zero is quarter turns off, which leave their cosines' last digits, and a
 * spring whose decimals leave theirs; `k` stands beside it. */
static void arm_text(dice *d, double k, char *text, size_t size) {
    static const char *const angle[] = {"90 [deg]",  "pi/2",      "180 [deg]",
                                        "-90 [deg]", "270 [deg]", "pi"};
    static const char *const spring[] = {"(0.1 + 0.2 - 0.3)", "(1.1 - 1 - 0.1)",
                                         "(4.35*100 - 435)"};
    const char *const alpha = angle[dice_one_of(d, 6)];
    const char *const left = spring[dice_one_of(d, 3)];
    const double m_kg = dice_between(d, 0.5, 2.0);
    const double k_Npm = dice_between(d, 10.0, 100.0);
    snprintf(
        text, size,
        "mechanism arm\ncoordinate x [m]\ncoordinate theta [rad]\nparameter m = %.17g [kg]\n"
        "parameter r = 0.3 [m]\nparameter alpha = %s\n"
        "T = m*x'^2/2 + m*((x' - r*theta'*sin(theta + alpha))^2 + (r*theta'*cos(theta + alpha))^2)/2\n"
        "V = %.17g [N/m]*x^2/2 + %s*%.17g [N/m]*x^2/2 + %.17g [N/m]*x^2/2 "
        "+ m*9.81 [m/s^2]*(0.5 [m] + r*sin(alpha)*cos(alpha))*cos(theta)\n"
        "scene s { start x = 0.1 [m], theta = 1 [rad]\nstep 1 [ms]\nuntil 1 [s] }\n",
        m_kg, alpha, k_Npm, left, k_Npm, k);
}

static void test_rounding_alone_is_nothing_lost(void) {
    dice d = dice_of("folded", 2);
    const unsigned cases = dice_cases(usual_or(few_or_all(20, 200), 2));
    unsigned asked = 0;
    for (unsigned k = 0; k < cases; k++) {
        char text[2000];
        const dice before = d;
        arm_text(&d, 0.0, text, sizeof text);
        asked += ways_of(text) > 0 ? 1U : 0U;
        d = before;
        arm_text(&d, 1e-6 * dice_between(&d, 1e-7, 1e-3), text, sizeof text);
        TEST_ASSERT_TRUE_MESSAGE(ways_of(text) > 0, text);
    }
    printf("  %u arms with last digits alone: %u derived in other ways\n", cases, asked);
    TEST_ASSERT_TRUE(20 * asked <= cases); /* where roundings add up to more */
}

/* The other way about: numbers that vanish beside a rest are lost, and rests that vanish beside numbers are not. */
static void test_numbers_beside_a_rest(void) {
    dice d = dice_of("folded", 3);
    for (unsigned k = 0; k < dice_cases(200); k++) {
        const double angle_rad = 1.5707963267948966 * (1.0 + 2.0 * dice_one_of(&d, 5));
        const double number = power_of_ten(&d, -3.0, 3.0);
        folding kept = {.way = FOLDING_NEAREST};
        folding *const before = folding_use(&kept);
        const double rest = folding_product(folding_call(FN_COS, angle_rad, 0.0), number);
        (void)folding_sum(number, rest);
        folding lost = kept;
        (void)folding_use(&lost);
        (void)folding_sum(rest * power_of_ten(&d, -9.0, -7.0), rest);
        (void)folding_use(before);
        TEST_ASSERT_TRUE(kept.lost < 1e-9 && lost.lost > 1e-9);
    }
}

/* Two stiff springs, one pulling and one pushing, that differ by 20 to 80 last digits: nothing to the nearest way of folding, as
 * decimals leave it, but all of what moves the mass. */
static void test_what_is_nearly_the_same(void) {
    dice d = dice_of("folded", 4);
    for (unsigned k = 0; k < dice_cases(usual_or(40, 5)); k++) {
        char text[600];
        said what;
        const double stiff = power_of_ten(&d, 10.0, 14.0);
        const double other = stiff * (1.0 + dice_between(&d, 2.5e-15, 9e-15));
        const double soft = other - stiff; /* exact */
        snprintf(text, sizeof text,
                 "mechanism pair\ncoordinate x [m]\nparameter K = %.17g [N/m]\n"
                 "parameter L = %.17g [N/m]\nT = %.17g [kg]*x'^2/2\nV = L*x^2/2 - K*x^2/2\n"
                 "scene s { start x = 0.1 [m]\nstep 10 [ms]\nuntil 4 [s] }\n",
                 stiff, other, soft);
        command_say_model(command_run, text, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
        motion m;
        motion_open_text(&m, text, IN_DOUBLE);
        motion_to(&m, 4.0);
        const double off = fabs(motion_value(&m, "x") - 0.1 * cos(4.0)) / 0.2;
        motion_close(&m);
        TEST_ASSERT_TRUE_MESSAGE(off < 1e-3 || strstr(what.out, "to the end: every") == NULL, text);
    }
}

void suite_folded(void) {
    RUN_TEST(test_what_is_lost_is_told);
    RUN_TEST(test_rounding_alone_is_nothing_lost);
    RUN_TEST(test_numbers_beside_a_rest);
    RUN_TEST(test_what_is_nearly_the_same);
}
