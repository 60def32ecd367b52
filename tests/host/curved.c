/* curved.c: drawing of curved contacts. Coordinate a is an angle, b and c are lengths. */
#include "curved.h"

#include "derived.h"

typedef struct writing {
    char *text;
    size_t size;
    size_t length;
} writing;

__attribute__((format(printf, 2, 3))) static void put(writing *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int more = vsnprintf(w->text + w->length, w->size - w->length, format, arguments);
    va_end(arguments);
    w->length += more > 0 ? (size_t)more : 0U;
    if (w->length >= w->size) {
        w->length = w->size - 1;
    }
}

/* A function of a, b and c, zero on a surface: `f(a) - other coordinate`, a circle or a square. With its value at the
 * start. */
typedef struct surface {
    char text[160];
    double value;
} surface;

static surface random_surface(uint64_t *seed, int coordinates, const double q[3]) {
    surface s = {.value = 0.0};
    const double e = random_between(seed, 0.05, 0.3);
    const int k = 1 + (int)(random_bits(seed) % 3U);
    const int family = (int)(random_bits(seed) % (coordinates == 3 ? 6U : 4U));
    switch (family) {
    case 0:
        snprintf(s.text, sizeof s.text, "b - %.17g [m]*cos(%d*a)", e, k);
        s.value = q[1] - e * cos(k * q[0]);
        break;
    case 1:
        snprintf(s.text, sizeof s.text, "b - %.17g [m]*sin(a)^2", e);
        s.value = q[1] - e * sin(q[0]) * sin(q[0]);
        break;
    case 2:
        snprintf(s.text, sizeof s.text, "b + %.17g [m]*sin(%d*a)", e, k);
        s.value = q[1] + e * sin(k * q[0]);
        break;
    case 3: /* connecting rod of length 1 m */
        snprintf(s.text, sizeof s.text,
                 "b - %.17g [m]*cos(a) - sqrt(1 [m^2] - %.17g [m^2]*sin(a)^2)", e, e * e);
        s.value = q[1] - e * cos(q[0]) - sqrt(1.0 - e * e * sin(q[0]) * sin(q[0]));
        break;
    case 4: /* bead over a round hill */
        snprintf(s.text, sizeof s.text, "sqrt(b^2 + (c - 2 [m])^2)");
        s.value = hypot(q[1], q[2] - 2.0);
        break;
    default:
        snprintf(s.text, sizeof s.text, "c - %.17g [1/m]*b^2 + %.17g [m]*sin(a)", 2.0 * e, e);
        s.value = q[2] - 2.0 * e * q[1] * q[1] + e * sin(q[0]);
        break;
    }
    return s;
}

double curved_text(uint64_t of, double step_s, double until_s, char *text, size_t size) {
    uint64_t seed = of * 0x9e3779b97f4a7c15U + 1U;
    writing w = {text, size, 0};
    const int n = random_bits(&seed) % 2U != 0 ? 3 : 2;
    const double J = exp(random_between(&seed, log(0.02), log(0.5)));
    const double m = exp(random_between(&seed, log(0.3), log(3.0)));
    const double mc = exp(random_between(&seed, log(0.3), log(3.0)));
    const double kb = random_between(&seed, 20.0, 200.0);
    const double kc = random_between(&seed, 20.0, 200.0);
    const double couple = random_between(&seed, -0.6, 0.6);
    const bool turning = random_bits(&seed) % 2U != 0; /* inertia that depends on the angle */
    double q[3] = {random_between(&seed, -3.0, 3.0), random_between(&seed, -0.3, 0.3),
                   random_between(&seed, -0.3, 0.3)};
    const double v[3] = {random_between(&seed, -20.0, 20.0), random_between(&seed, -2.0, 2.0),
                         random_between(&seed, -2.0, 2.0)};
    const double ab = couple * sqrt(J * m);
    const double bc = couple * sqrt(m * mc);

    put(&w, "mechanism curved\ncoordinate a [rad]\ncoordinate b [m]\n%s",
        n == 3 ? "coordinate c [m]\n" : "");
    put(&w, "T = %.17g [kg*m^2]*a'^2/2 + %.17g [kg]*b'^2/2 + %.17g [kg*m]*a'*b'%s", J, m, ab,
        turning ? "*cos(a)" : "");
    if (n == 3) {
        put(&w, " + %.17g [kg]*c'^2/2 + %.17g [kg]*b'*c'", mc, bc);
    }
    put(&w, "\nV = %.17g [N/m]*b^2/2 + %.17g [N]*b", kb, 9.81 * m);
    if (n == 3) {
        put(&w, " + %.17g [N/m]*c^2/2", kc);
    }
    put(&w, "\n");

    const surface s = random_surface(&seed, n, q);
    const bool holds = random_bits(&seed) % 3U == 0;
    const bool above = random_bits(&seed) % 2U != 0;
    const bool touching = random_bits(&seed) % 2U != 0;
    const double gap = touching ? 0.0 : random_between(&seed, 0.0, 0.1);
    const double restitution = random_bits(&seed) % 2U != 0 ? 0.0 : random_between(&seed, 0.0, 1.0);
    if (holds) {
        put(&w, "hold %s while %s\n", s.text, touching ? "b > -100 [m]" : "a' > 0 or b > 0");
    } else {
        put(&w, "stop %s %s %.17g [m] restitution %.17g\n", s.text,
            above ? ">=" : "<=", above ? s.value - gap - 1e-15 : s.value + gap + 1e-15,
            restitution);
    }
    const double mu = random_between(&seed, 0.05, 0.6);
    const char *const on[] = {"b", "c", "a"};
    const int which = (int)(random_bits(&seed) % 8U);
    const int rubs = which == 0 ? 2 : which < 4 && n == 3 ? 1 : 0;
    put(&w, "friction %s static %.17g kinetic %.17g normal %.17g [%s]\n", on[rubs], mu,
        mu * (random_bits(&seed) % 2U != 0 ? 1.0 : random_between(&seed, 0.5, 1.0)),
        rubs == 2 ? random_between(&seed, 0.1, 1.0) : random_between(&seed, 1.0, 10.0),
        rubs == 2 ? "N*m" : "N");
    put(&w,
        "scene s {\n  with ledger\n  start a = %.17g, b = %.17g [m], a' = %.17g [rad/s], b' = "
        "%.17g [m/s]\n",
        q[0], q[1], v[0], v[1]);
    if (n == 3) {
        put(&w, "  start c = %.17g [m], c' = %.17g [m/s]\n", q[2], v[2]);
    }
    put(&w, "  step %.17g [s]\n  until %.17g [s]\n}\n", step_s, until_s);
    double energy = 0.5 * (J * v[0] * v[0] + m * v[1] * v[1]) +
                    ab * v[0] * v[1] * (turning ? cos(q[0]) : 1.0) + 0.5 * kb * q[1] * q[1];
    if (n == 3) {
        energy += 0.5 * (mc * v[2] * v[2] + kc * q[2] * q[2]) + bc * v[1] * v[2];
    }
    return energy;
}
