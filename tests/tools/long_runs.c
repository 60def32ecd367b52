/* long_runs.c: energy and momentum drift over long runs. `long_runs [STEPS [WAY [SUBJECT]]]` swings a pendulum from 1 rad and
 * turns the epicyclic gear without torque, for STEPS steps of 1 ms (default 10^7). For every decade of steps it prints the largest
 * relative energy error, the drift of the gear's centre of mass in m, and their growth. Energies are formulas of this file, in
 * double. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/host/motion.h"

#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

#define STEP_S 1e-3
#define STABILIZED(number, by) \
    { .kind = &(number), .method = (by), .compensated = true, .stabilized = true, .step_s = STEP_S }
enum { DECADES = 12 };

typedef struct subject {
    const char *what;
    double (*energy_J)(const motion *m);
    const char *text;
    bool rates;    /* the gear: its accelerations depend on rates; its centre is measured */
    bool no_books; /* a coordinate is integrated from its momentum */
} subject;

static double pendulum_J(const motion *m) {
    const double half = sin(motion_value(m, "th") / 2.0);
    const double rate = motion_value(m, "th'");
    return rate * rate / 2.0 + 2.0 * 9.81 * half * half;
}

/* m = 2 kg, r = 0.3 m, I = m r^2/2. */
static double gear_J(const motion *m) {
    const double theta = motion_value(m, "theta");
    const double turns = motion_value(m, "theta'");
    const double vx = motion_value(m, "X'") - 0.6 * turns * sin(theta);
    const double vy = 0.6 * turns * cos(theta);
    const double vX = motion_value(m, "X'");
    return vX * vX + vx * vx + vy * vy + 0.09 * 4.0 * turns * turns / 2.0;
}

static double centre_m(const motion *m) {
    return motion_value(m, "X") + 0.3 * cos(motion_value(m, "theta"));
}

#define GEAR \
    "mechanism g\ncoordinate theta [rad]\ncoordinate X [m]\nparameter m = 2 [kg]\n" \
    "parameter r = 0.3 [m]\nparameter I = m*r^2/2\nlet vx = X' - 2*r*theta'*sin(theta)\n" \
    "let vy = 2*r*theta'*cos(theta)\nT = m*X'^2/2 + m*(vx^2 + vy^2)/2 + I*(2*theta')^2/2\n"

static const subject subjects[] = {
    {"pendulum, 1 rad", pendulum_J,
     "mechanism p\ncoordinate th [rad]\nT = 1 [kg*m^2]*th'^2/2\nV = -9.81 [J]*cos(th)\n"
     "scene s { start th = 1 [rad]\nstep 1 [ms]\nuntil 1e12 [s] }\n",
     false, false},
    {"gear, no torque", gear_J,
     GEAR "scene s { start theta' = 5 [rad/s]\nstep 1 [ms]\nuntil 1e12 [s] }\n", true, false},
    {"gear, X conserved", gear_J,
     GEAR "scene s { conserve X\nstart theta' = 5 [rad/s]\nstep 1 [ms]\nuntil 1e12 [s] }\n", true,
     false},
    /* The force is zero but depends on X. Therefore X is integrated, from the rate that its momentum gives; otherwise
     * X would be a function of angle and time. */
    {"gear, X' conserved", gear_J,
     GEAR
     "input pull = 0 [N]\nQ(theta) = pull*X\nscene s { conserve X\nstart theta' = 5 [rad/s]\nstep 1 [ms]\n"
     "until 1e12 [s] }\n",
     true, true}};

typedef struct seen {
    double energy; /* largest |E/E_0 - 1| */
    double last;   /* the last E/E_0 - 1 */
    double centre; /* largest drift of the centre of mass, m */
} seen;

static void try_one(const subject *of, stepping how, const char *number, uint64_t steps) {
    motion m;
    seen decade[DECADES] = {{0}};
    motion_open_text(&m, of->text, how);
    const double begin_J = of->energy_J(&m);
    const double begin_m = of->rates ? centre_m(&m) : 0.0;
    uint64_t end = 1000;
    int at = 0;
    const uint64_t go = 37; /* steps between two measurements; it does not divide the period */
    for (uint64_t k = 0; k + go <= steps;) {
        if (motion_step(&m, go) != WH_OK) {
            printf("%-18s %-18s %-10s refused\n", of->what, number, wh_methods[how.method].word);
            break;
        }
        k += go;
        if (k > end && at + 1 < DECADES) {
            end *= 10;
            at++;
        }
        const double off = of->energy_J(&m) / begin_J - 1.0;
        decade[at].energy = fmax(decade[at].energy, fabs(off));
        decade[at].last = off;
        if (of->rates) {
            decade[at].centre = fmax(decade[at].centre, fabs(centre_m(&m) - begin_m));
        }
    }
    printf("%-18s %-18s %-10s energy", of->what, number, wh_methods[how.method].word);
    for (int i = 1; i <= at; i++) {
        printf(" %8.1e", decade[i].energy);
    }
    if (at > 1) {
        printf("  last %+.1e, grows with steps^%.2f", decade[at].last,
               log10(decade[at].energy / decade[at - 1].energy));
    }
    if (of->rates) {
        printf("\n%49s centre", "");
        for (int i = 1; i <= at; i++) {
            printf(" %8.1e", decade[i].centre);
        }
        printf("  grows with steps^%.2f", log10(decade[at].centre / decade[at - 1].centre));
    }
    printf("\n");
    fflush(stdout);
    motion_close(&m);
}

int main(int count, char **words) {
    const double wanted = count > 1 ? strtod(words[1], NULL) : 1e7;
    const int only = count > 2 ? (int)strtol(words[2], NULL, 10) : -1;
    const int only_subject = count > 3 ? (int)strtol(words[3], NULL, 10) : -1;
    static const struct {
        const char *number;
        stepping how;
    } ways[] = {
        {"float", {.kind = &engine_float, .method = WH_RK4, .step_s = STEP_S}},
        {"float compensated",
         {.kind = &engine_float, .method = WH_RK4, .compensated = true, .step_s = STEP_S}},
        {"double", {.kind = &engine_double, .method = WH_RK4, .step_s = STEP_S}},
        {"double compensated",
         {.kind = &engine_double, .method = WH_RK4, .compensated = true, .step_s = STEP_S}},
        {"double", {.kind = &engine_double, .method = WH_NYSTROEM5, .step_s = STEP_S}},
        {"double compensated",
         {.kind = &engine_double, .method = WH_NYSTROEM5, .compensated = true, .step_s = STEP_S}},
        {"float compensated",
         {.kind = &engine_float, .method = WH_NYSTROEM5, .compensated = true, .step_s = STEP_S}},
        {"float compensated",
         {.kind = &engine_float, .method = WH_LEAPFROG, .compensated = true, .step_s = STEP_S}},
        {"double", {.kind = &engine_double, .method = WH_LEAPFROG, .step_s = STEP_S}},
        {"float compensated, stabilized", STABILIZED(engine_float, WH_RK4)},
        {"double compensated, stabilized", STABILIZED(engine_double, WH_RK4)},
        {"double compensated, stabilized", STABILIZED(engine_double, WH_NYSTROEM5)}};
    if (!(wanted >= 1e5 && wanted <= 1e11)) {
        fputs("usage: long_runs [STEPS [WAY [SUBJECT]]], 1e5 to 1e11; both from 0, -1: all\n",
              stderr);
        return 2;
    }
    printf("largest in each decade of steps, from 10^3 to 10^4 on; %.0e steps of 1 ms\n", wanted);
    for (size_t s = 0; s < sizeof subjects / sizeof subjects[0]; s++) {
        for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
            const bool takes =
                (!subjects[s].rates || wh_methods[ways[w].how.method].takes != WH_NO_RATES) &&
                !(subjects[s].no_books && ways[w].how.stabilized);
            const bool asked =
                (only < 0 || only == (int)w) && (only_subject < 0 || only_subject == (int)s);
            if (takes && asked) {
                try_one(&subjects[s], ways[w].how, ways[w].number, (uint64_t)wanted);
            }
        }
    }
    return 0;
}
