#include "made_run.h"
#include "test.h"

made_up_run made_run;

void made_run_draw(dice *d, bool powers, bool magnetic) {
    made_run.mx = dice_between(d, 1.0, 3.0);
    made_run.my = dice_between(d, 1.0, 3.0);
    made_run.coupled = dice_between(d, -0.6, 0.6);
    made_run.k = dice_between(d, 0.5, 4.0);
    made_run.h = dice_between(d, 0.5, 4.0);
    made_run.damping = powers ? dice_between(d, 0.2, 1.0) : 0.0;
    made_run.push = powers ? dice_between(d, 1.0, 3.0) : 0.0;
    made_run.magnetic = magnetic ? dice_between(d, 0.5, 1.5) : 0.0;
    made_run.step_s = dice_between(d, 0.01, 0.1);
}

derived made_run_derive(void) {
    char text[900];
    char field_text[120] = "";
    if (made_run.magnetic > 0.0) {
        snprintf(field_text, sizeof field_text, " + %.17g [kg/s]*(x*y' - y*x')", made_run.magnetic);
    }
    char powers[120] = "";
    if (made_run.damping > 0.0) {
        snprintf(powers, sizeof powers, "F = %.17g [N*s/m]*x'^2/2\nQ(y) = u\n", made_run.damping);
    }
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\ncoordinate y [mm]\ninput u = %.17g [N]\n"
             "T = %.17g [kg]*x'^2/2 + %.17g [kg]*y'^2/2 + %.17g [kg]*x'*y'%s\n"
             "V = %.17g [N/m]*x^2/2 + %.17g [N/m]*(x - y)^2/2\n%s"
             "scene s { step %.17g [s]; until 9 [s] }\n",
             made_run.push, made_run.mx, made_run.my, made_run.coupled, field_text, made_run.k,
             made_run.h, powers, made_run.step_s);
    derived d = derived_scene(text, "s");
    derived_expect(&d, text);
    return d;
}

/* Places and rates in a random walk; in every second run some of them change by next to nothing. */
void made_run_states(dice *d, uint64_t steps) {
    const unsigned still = dice_one_of(d, 2) == 0 ? dice_one_of(d, 1U << N) : 0;
    for (uint64_t k = 0; k <= steps; k++) {
        for (int i = 0; i < N; i++) {
            const double before = k == 0 ? dice_between(d, -2.0, 2.0) : made_run.state[k - 1][i];
            made_run.state[k][i] =
                before + (still >> i & 1U ? 1e-5 : 1.0) * dice_between(d, -1.0, 1.0);
        }
    }
}

double made_run_kinetic(const double *s) {
    return made_run.mx * s[VX] * s[VX] / 2.0 + made_run.my * s[VY] * s[VY] / 2.0 +
           made_run.coupled * s[VX] * s[VY];
}

double made_run_odd(const double *s) { return made_run.magnetic * (s[X] * s[VY] - s[Y] * s[VX]); }

double made_run_stored(const double *s) {
    return made_run.k * s[X] * s[X] / 2.0 + made_run.h * (s[X] - s[Y]) * (s[X] - s[Y]) / 2.0;
}

double made_run_energy(const double *s) { return made_run_kinetic(s) + made_run_stored(s); }

double made_run_power(const double *s, int which) {
    return which == 0 ? made_run.push * s[VY] : made_run.damping * s[VX] * s[VX];
}

double made_run_momentum(const double *s, int i, bool whole) {
    const double magnetic = whole ? made_run.magnetic : 0.0;
    return i == 0 ? made_run.mx * s[VX] + made_run.coupled * s[VY] - magnetic * s[Y]
                  : made_run.my * s[VY] + made_run.coupled * s[VX] + magnetic * s[X];
}

void made_run_slope(const double *s, double *slope) {
    const double fx = -made_run.k * s[X] - made_run.h * (s[X] - s[Y]) - made_run.damping * s[VX] +
                      2.0 * made_run.magnetic * s[VY];
    const double fy = made_run.h * (s[X] - s[Y]) + made_run.push - 2.0 * made_run.magnetic * s[VX];
    const double det = made_run.mx * made_run.my - made_run.coupled * made_run.coupled;
    slope[X] = s[VX];
    slope[Y] = s[VY];
    slope[VX] = (made_run.my * fx - made_run.coupled * fy) / det;
    slope[VY] = (made_run.mx * fy - made_run.coupled * fx) / det;
}

/* One step in `parts` substeps of Runge-Kutta 4. */
void made_run_go(double *s, int parts) {
    const double h = made_run.step_s / parts;
    for (int part = 0; part < parts; part++) {
        static const double ahead[] = {0.0, 0.5, 0.5, 1.0};
        static const double weight[] = {1.0, 2.0, 2.0, 1.0};
        double slope[N] = {0};
        double sum[N] = {0};
        for (int stage = 0; stage < 4; stage++) {
            double there[N];
            for (int i = 0; i < N; i++) {
                there[i] = s[i] + h * ahead[stage] * slope[i];
            }
            made_run_slope(there, slope);
            for (int i = 0; i < N; i++) {
                sum[i] += weight[stage] * slope[i];
            }
        }
        for (int i = 0; i < N; i++) {
            s[i] += h / 6.0 * sum[i];
        }
    }
}

int made_run_place(int i) {
    for (int k = 0; k < N; k++) {
        const component c = image_component(made_run.image, k);
        if (c.unknown + 2 * c.primes == i) {
            return k;
        }
    }
    return -1;
}

static void state(const void *run, double *angle_rad, double *real) {
    (void)run;
    (void)angle_rad;
    for (int i = 0; i < N; i++) {
        real[made_run_place(i)] = made_run.state[made_run.at][i];
    }
}

static uint64_t steps(const void *run) {
    (void)run;
    return made_run.at;
}

const engine_kind made_run_kind = {.name = "made up", .state = state, .steps = steps};
