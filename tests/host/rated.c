#include "rated.h"
#include "test.h"

#include "host/number/functions.h"

/* The reference's step, s: 1/32 of the run's step, but not below 0.1 ms and not above 1/4 of the run's step. */
static double finer_s(double step_s) {
    return number_least(step_s / 4.0, number_most(step_s / 32.0, 1e-4));
}
#define GRAVITY 9.81

/* Draws a number with three decimals, because the text of the scene shows only three. */
static double of(dice *d, double low, double high) {
    return number_nearest(dice_between(d, low, high) * 1000.0) / 1000.0;
}

static void spring_slope(const double *p, const long double *x, long double *slope) {
    slope[0] = x[1];
    const long double m = (long double)p[0], k = (long double)p[1];
    const long double hard = (long double)p[2], damping = (long double)p[3];
    slope[1] = -(k * x[0] + hard * x[0] * x[0] * x[0] + damping * x[1]) / m;
}

static void draw_spring(dice *d, rated *r) {
    const double p[4] = {of(d, 0.5, 3), of(d, 5, 40), of(d, 0, 60), of(d, 0, 0.4)};
    r->states = 2;
    r->slope = spring_slope;
    r->start[0] = of(d, 0.3, 1.5);
    memcpy(r->number_of, p, sizeof p);
    snprintf(r->text, sizeof r->text,
             "mechanism m\ncoordinate x [m]\nT = %g [kg]*x'^2/2\n"
             "V = %g [N/m]*x^2/2 + %g [N/m^3]*x^4/4\nF = %g [N*s/m]*x'^2/2\n"
             "scene s { start x = %g [m]\n",
             p[0], p[1], p[2], p[3], r->start[0]);
}

/* A double pendulum: masses p and q on strings of lengths l and k. The angles count from straight down. */
static void pendulum_slope(const double *n, const long double *x, long double *slope) {
    const long double p = (long double)n[0], q = (long double)n[1];
    const long double l = (long double)n[2], k = (long double)n[3];
    const long double c = q * l * k * cosl(x[0] - x[1]);
    const long double s = q * l * k * sinl(x[0] - x[1]);
    const long double aa = (p + q) * l * l;
    const long double bb = q * k * k;
    const long double ra = -s * x[3] * x[3] - (p + q) * (long double)GRAVITY * l * sinl(x[0]);
    const long double rb = s * x[2] * x[2] - q * (long double)GRAVITY * k * sinl(x[1]);
    const long double det = aa * bb - c * c;
    slope[0] = x[2];
    slope[1] = x[3];
    slope[2] = (ra * bb - c * rb) / det;
    slope[3] = (aa * rb - c * ra) / det;
}

static void draw_pendulum(dice *d, rated *r) {
    const double n[4] = {of(d, 0.3, 3), of(d, 0.3, 3), of(d, 0.2, 1.5), of(d, 0.2, 1.5)};
    r->states = 4;
    r->slope = pendulum_slope;
    r->start[0] = of(d, -2.5, 2.5);
    r->start[1] = of(d, -2.5, 2.5);
    memcpy(r->number_of, n, sizeof n);
    snprintf(r->text, sizeof r->text,
             "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\n"
             "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter l = %g [m]\n"
             "parameter k = %g [m]\nparameter g = 9.81 [m/s^2]\n"
             "let vx = l*a'*cos(a) + k*b'*cos(b)\nlet vy = l*a'*sin(a) + k*b'*sin(b)\n"
             "T = p*(l*a')^2/2 + q*(vx^2 + vy^2)/2\n"
             "V = -p*g*l*cos(a) - q*g*(l*cos(a) + k*cos(b))\n"
             "scene s { start a = %g, b = %g\n",
             n[0], n[1], n[2], n[3], r->start[0], r->start[1]);
}

static void orbit_slope(const double *n, const long double *x, long double *slope) {
    slope[0] = x[2];
    slope[1] = x[3];
    slope[2] = x[0] * x[3] * x[3] - (long double)n[1] / ((long double)n[0] * x[0] * x[0]);
    slope[3] = -2.0L * x[2] * x[3] / x[0];
}

static void draw_orbit(dice *d, rated *r) {
    const double n[2] = {of(d, 0.5, 3), of(d, 2, 8)};
    r->states = 4;
    r->slope = orbit_slope;
    r->start[0] = of(d, 0.8, 1.2);
    r->start[3] = of(d, 0.8, 1.2) * sqrt(n[1] / n[0]);
    r->start[3] = number_nearest(r->start[3] * 1000.0) / 1000.0;
    memcpy(r->number_of, n, sizeof n);
    snprintf(r->text, sizeof r->text,
             "mechanism m\ncoordinate r [m]\ncoordinate t [rad]\n"
             "T = %g [kg]*(r'^2 + r^2*t'^2)/2\nV = -%g [J*m]/r\n"
             "scene s { start r = %g [m], t' = %g [rad/s]\n",
             n[0], n[1], r->start[0], r->start[3]);
}

static void draw_linear(dice *d, rated *r) {
    const linear_kind kind = {.stiff = 0, .coupled = dice_one_of(d, 2) == 0};
    uint64_t seed = d->state;
    linear_draw(&seed, 1 + (int)dice_one_of(d, 3), kind, r->text, sizeof r->text, &r->linear);
    r->states = r->linear.states;
    memcpy(r->start, r->linear.start, sizeof r->linear.start);
    char *step = strstr(r->text, "step ");
    TEST_ASSERT_NOT_NULL(step);
    *step = '\0'; /* the text ends before its step, so that callers can append another step */
}

void rated_draw(dice *d, rated *r) {
    static void (*const kinds[])(dice *, rated *) = {draw_linear, draw_spring, draw_pendulum,
                                                     draw_orbit};
    static const char *const methods[] = {"rk4",       "rk4",  "rk38",  "nystroem3",
                                          "nystroem4", "heun", "euler", "nystroem5"};
    static const double steps_s[] = {0.002, 0.005, 0.01, 0.02};
    *r = (rated){.method = methods[dice_one_of(d, sizeof methods / sizeof methods[0])],
                 .number = dice_one_of(d, 2) == 0 ? "float" : "double",
                 .compensated = dice_one_of(d, 4) == 0,
                 .step_s = steps_s[dice_one_of(d, 4)],
                 .until_s = 0.04 * (double)(40 + dice_one_of(d, 60))};
    kinds[dice_one_of(d, sizeof kinds / sizeof kinds[0])](d, r);
    const size_t used = strlen(r->text);
    snprintf(r->text + used, sizeof r->text - used, "step %g [s]; until %g [s] }\n", r->step_s,
             r->until_s);
}

static void runge_kutta(const rated *r, long double h, long double *x) {
    static const long double part[] = {0.0L, 0.5L, 0.5L, 1.0L};
    static const long double weight[] = {1.0L, 2.0L, 2.0L, 1.0L};
    long double slope[RATED_STATES] = {0};
    long double sum[RATED_STATES] = {0};
    for (int stage = 0; stage < 4; stage++) {
        long double at[RATED_STATES];
        for (int i = 0; i < r->states; i++) {
            at[i] = x[i] + part[stage] * h * slope[i];
        }
        r->slope(r->number_of, at, slope);
        for (int i = 0; i < r->states; i++) {
            sum[i] += weight[stage] * slope[i];
        }
    }
    for (int i = 0; i < r->states; i++) {
        x[i] += h / 6.0L * sum[i];
    }
}

static void move_linear(const linear *of_it, quad step[LINEAR_STATES][LINEAR_COLUMNS],
                        long double *x) {
    const double input[LINEAR_INPUTS] = {0.5, 0.5};
    quad now[LINEAR_STATES];
    for (int i = 0; i < of_it->states; i++) {
        now[i] = (quad)x[i];
    }
    linear_move(of_it, step, input, now);
    for (int i = 0; i < of_it->states; i++) {
        x[i] = (long double)now[i];
    }
}

long double *rated_motion(const rated *r, double spacing_s, int records) {
    static quad step[LINEAR_STATES][LINEAR_COLUMNS];
    const size_t states = (size_t)r->states;
    long double *row = calloc((size_t)(records + 1) * states, sizeof *row);
    TEST_ASSERT_NOT_NULL(row);
    const int each = (int)number_ceiling(spacing_s / finer_s(r->step_s) - 1e-9);
    linear spaced = r->linear;
    /* the step as the run reads it: the decimal number itself, not the nearest double */
    char text[40];
    snprintf(text, sizeof text, "%.9g", spacing_s);
    spaced.h = (quad)strtold(text, NULL);
    const long double h = strtold(text, NULL) / each;
    if (r->slope == NULL) {
        linear_step(&spaced, 0, step);
    }
    for (size_t i = 0; i < states; i++) {
        row[i] = (long double)r->start[i];
    }
    for (int k = 0; k < records; k++) {
        long double *next = row + (size_t)(k + 1) * states;
        memcpy(next, next - states, states * sizeof *row);
        if (r->slope == NULL) {
            move_linear(&spaced, step, next);
        }
        for (int i = 0; i < each && r->slope != NULL; i++) {
            runge_kutta(r, h, next);
        }
    }
    return row;
}
