/* test_contact_centres.c: dry friction on a coordinate b = f(a) that has a dead centre: cam, Scotch yoke, slider-crank,
 * bead on a hill. Each machine has one degree of freedom, a. The reference is one equation, integrated in long double
 * from dead centre to dead centre:
 *
 *   (J + m f'^2) a'' = torque - m f' f'' a'^2 - f' (m g + k (f + 2 e) + F sign(f' a'))
 *
 * The slider-crank has the inertia of its rod, in addition to m f'^2; the rod turns by p with sin p = sin(a)/4. */
#include "command.h"
#include "contacts.h"
#include "derived.h"

typedef enum machine_kind { CAM, YOKE, SLIDER, LINKAGE, HILL, MACHINES } machine_kind;

static const char *const NAMES[MACHINES] = {"cam", "yoke", "slider", "linkage", "hill"};

typedef struct machine {
    machine_kind kind;
    double J, m, e, k, friction_N, torque_Nm;
    double J_rod;   /* inertia of a slider-crank's rod; 0 for other machines */
    double a, rate; /* angle and its rate at the start */
} machine;

#define G 9.81L

static long double wide(double x) { return (long double)x; }

/* f, f' and f''. The hill is a bell over a, of height e and 1 rad wide. The slider-crank's rod is 4 e long. */
static void law(const machine *c, long double a, long double f[3]) {
    const long double e = wide(c->e);
    if (c->kind == HILL) {
        const long double q = 1.0L + a * a;
        f[0] = e / q;
        f[1] = -2.0L * e * a / (q * q);
        f[2] = e * (6.0L * a * a - 2.0L) / (q * q * q);
        return;
    }
    f[0] = e * cosl(a);
    f[1] = -e * sinl(a);
    f[2] = -e * cosl(a);
    if (c->kind == SLIDER || c->kind == LINKAGE) {
        const long double s = e * e * sinl(a) * cosl(a);
        const long double l = sqrtl(16.0L * e * e - e * e * sinl(a) * sinl(a));
        f[0] += l;
        f[1] -= s / l;
        f[2] -= e * e * cosl(2.0L * a) / l + s * s / (l * l * l);
    }
}

static long double acceleration(const machine *c, long double a, long double v, long double way) {
    long double f[3];
    law(c, a, f);
    const long double s = sinl(a) / 4;
    const long double root = sqrtl(1 - s * s);
    const long double p1 = cosl(a) / 4 / root;
    const long double p2 =
        -s / root + s * p1 * p1 / root; /* cos(p) p'' - sin(p) p'^2 = -sin(a)/4 */
    const long double push =
        wide(c->m) * G + wide(c->k) * (f[0] + 2.0L * wide(c->e)) + wide(c->friction_N) * way;
    const long double inertia = wide(c->J) + wide(c->m) * f[1] * f[1] + wide(c->J_rod) * p1 * p1;
    const long double turning = wide(c->m) * f[1] * f[2] + wide(c->J_rod) * p1 * p2;
    return (wide(c->torque_Nm) - turning * v * v - f[1] * push) / inertia;
}

static void rk4(const machine *c, long double h, long double way, long double s[2]) {
    const long double a1 = acceleration(c, s[0], s[1], way);
    const long double v2 = s[1] + h / 2 * a1;
    const long double a2 = acceleration(c, s[0] + h / 2 * s[1], v2, way);
    const long double v3 = s[1] + h / 2 * a2;
    const long double a3 = acceleration(c, s[0] + h / 2 * v2, v3, way);
    const long double v4 = s[1] + h * a3;
    const long double a4 = acceleration(c, s[0] + h * v3, v4, way);
    s[0] += h / 6 * (s[1] + 2 * v2 + 2 * v3 + v4);
    s[1] += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
}

/* The sign of b'. At a dead centre, b' is zero, and the sign just afterwards counts. */
static long double way_of(const machine *c, const long double s[2]) {
    long double f[3];
    law(c, s[0], f);
    const long double b = f[1] * s[1];
    const long double then = f[2] * s[1] * s[1] + f[1] * acceleration(c, s[0], s[1], 0.0L);
    const long double next = b != 0.0L ? b : then;
    return next > 0.0L ? 1.0L : next < 0.0L ? -1.0L : f[2] > 0.0L ? 1.0L : -1.0L;
}

/* Integrates until until_s. Returns false if the machine comes to rest, or if its stop would have to pull. */
static bool reference(const machine *c, long double until_s, long double s[2]) {
    const long double h = 5e-5L;
    long double t = 0.0L;
    s[0] = wide(c->a);
    s[1] = wide(c->rate);
    long double way = way_of(c, s);
    while (t < until_s) {
        long double next[2] = {s[0], s[1]};
        long double f[3];
        long double span = fminl(h, until_s - t);
        rk4(c, span, way, next);
        law(c, next[0], f);
        if (f[1] * next[1] * way < 0.0L) { /* b' has changed its sign: locates that moment */
            long double low = 0.0L;
            for (int i = 0; i < 70; i++) {
                const long double middle = (low + span) / 2;
                long double probe[2] = {s[0], s[1]};
                rk4(c, middle, way, probe);
                law(c, probe[0], f);
                *(f[1] * probe[1] * way < 0.0L ? &span : &low) = middle;
            }
            memcpy(next, s, sizeof next);
            rk4(c, span, way, next);
            way = -way;
            law(c, next[0], f);
            /* b' = f[1] a' is zero here. If f[1] is not zero, then a' is zero: the machine may stick, which is not tested */
            if (fabsl(f[1]) > 1e-9L * wide(c->e)) {
                return false;
            }
        }
        memcpy(s, next, sizeof next);
        t += span;
        law(c, s[0], f);
        const long double bends = f[1] * acceleration(c, s[0], s[1], way) + f[2] * s[1] * s[1];
        const long double presses = wide(c->m) * bends + wide(c->m) * G +
                                    wide(c->k) * (f[0] + 2.0L * wide(c->e)) +
                                    wide(c->friction_N) * way;
        if ((c->kind == CAM || c->kind == HILL) && presses < 0.0L) {
            return false;
        }
    }
    return true;
}

static const char two_holds[] = "hold b - e*cos(a) - 4*e*cos(psi) while b > -100 [m]\n"
                                "hold e*sin(a) - 4*e*sin(psi) while b > -100 [m]\n";

static void write_machine(const machine *c, char *text, size_t size) {
    static const char *const closed[MACHINES] = {
        "stop b - e*cos(a) >= 0 restitution 0\n", "hold b - e*cos(a) while b > -100 [m]\n",
        "hold b - e*cos(a) - sqrt(16*e^2 - e^2*sin(a)^2) while b > -100 [m]\n", two_holds,
        "stop b - e/(1 + a^2) >= 0 restitution 0\n"};
    long double f[3];
    law(c, wide(c->a), f);
    const bool linkage = c->kind == LINKAGE;
    const double psi = asin(sin(c->a) / 4.0);
    char rod[160];
    char rod_T[80] = "";
    if (linkage) {
        snprintf(rod_T, sizeof rod_T, " + %.17g [kg*m^2]*psi'^2/2", c->J_rod);
    }
    snprintf(rod, sizeof rod, "  start psi = %.17g, psi' = %.17g [rad/s]\n", psi,
             cos(c->a) / (4.0 * cos(psi)) * c->rate);
    snprintf(text, size,
             "mechanism %s\ncoordinate a [rad]\ncoordinate b [m]\n%s"
             "parameter e = %.17g [m]\n"
             "T = %.17g [kg*m^2]*a'^2/2 + %.17g [kg]*b'^2/2%s\n"
             "V = %.17g [N]*b + %.17g [N/m]*(b + 2*e)^2/2\nQ(a) = %.17g [N*m]\n%s"
             "friction b static %.17g kinetic %.17g normal 5 [N]\n"
             "scene s {\n  with ledger\n  start a = %.17g, a' = %.17g [rad/s]\n"
             "  start b = %.17g [m], b' = %.17g [m/s]\n%s  until 2 [s]\n}\n",
             NAMES[c->kind], linkage ? "coordinate psi [rad]\n" : "", c->e, c->J, c->m, rod_T,
             c->m * (double)G, c->k, c->torque_Nm, closed[c->kind], c->friction_N / 5.0,
             c->friction_N / 5.0, c->a, c->rate, (double)f[0], (double)f[1] * c->rate,
             linkage ? rod : "");
}

typedef struct outcome {
    double off_rad, left_J;
    uint64_t overruns;
} outcome;

static outcome run(const machine *c, const engine_kind *kind, double h, double until_s,
                   const long double s[2]) {
    char text[1500];
    motion m;
    double total[64] = {0.0};
    double left[8] = {0.0};
    write_machine(c, text, sizeof text);
    motion_open_text(&m, text, (stepping){.kind = kind, .method = WH_RK4, .step_s = h});
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, (uint64_t)(until_s / h + 0.5)));
    m.kind->ledger(m.run, total, left);
    const outcome o = {fabs(motion_value(&m, "a") - (double)s[0]), fabs(left[0]),
                       contacts_overruns(&m)};
    motion_close(&m);
    return o;
}

/* Draws a machine. Some start at rest at a dead centre and are driven; others pass the dead centre slowly or fast. */
static machine random_machine(uint64_t *seed, machine_kind kind, int how) {
    machine c = {.kind = kind};
    c.J = random_between(seed, 0.05, 0.4);
    c.J_rod = kind == LINKAGE ? random_between(seed, 0.001, 0.02) : 0.0;
    c.m = random_between(seed, 0.5, 2.0);
    c.e = random_between(seed, 0.05, 0.15);
    c.k = random_between(seed, 50.0, 300.0);
    c.friction_N = random_between(seed, 0.2, 5.0);
    c.a = random_between(seed, -3.0, 3.0);
    c.rate = random_between(seed, 3.0, 15.0) * (random_bits(seed) % 2U != 0 ? 1.0 : -1.0);
    c.torque_Nm = 0.0;
    if (how == 1) { /* at rest at the dead centre, and driven */
        c.a = 0.0;
        c.rate = 0.0;
        c.torque_Nm = random_between(seed, 5.0, 12.0);
    } else if (how == 2) { /* in motion at the dead centre */
        c.a = 0.0;
    } else if (how == 3) { /* a heavy wheel creeps over the dead centre */
        c.J = random_between(seed, 1e3, 1e5);
        c.rate = exp(random_between(seed, log(1e-3), log(0.3)));
        c.a = -random_between(seed, 0.2, 1.5) * c.rate;
    }
    return c;
}

static void check_machines(int how, const char *words, double until_s, unsigned each) {
    uint64_t seed = 77;
    for (int kind = 0; kind < MACHINES; kind++) {
        outcome worst[2] = {{0}};
        int done = 0;
        for (unsigned i = 0; i < each; i++) {
            const machine c = random_machine(&seed, (machine_kind)kind, how);
            long double s[2];
            if (!reference(&c, wide(until_s), s)) {
                /* skips machines that come to rest or leave their stop: other tests cover these */
                continue;
            }
            done++;
            for (int n = 0; n < 2; n++) {
                const outcome o = run(&c, n ? &engine_float : &engine_double, 5e-4, until_s, s);
                if (o.off_rad > (n ? 1e-2 : 1e-6)) {
                    char text[1500];
                    write_machine(&c, text, sizeof text);
                    printf("%s%s off by %g\n", text, n ? "float" : "double", o.off_rad);
                }
                worst[n].off_rad = fmax(worst[n].off_rad, o.off_rad);
                worst[n].left_J = fmax(worst[n].left_J, o.left_J);
                worst[n].overruns += o.overruns;
            }
        }
        printf(
            "  %s, %s: %d, worst %.1e rad, left over %.1e J; float %.1e rad, %.1e J; overruns %d, %d\n",
            NAMES[kind], words, done, worst[0].off_rad, worst[0].left_J, worst[1].off_rad,
            worst[1].left_J, (int)worst[0].overruns, (int)worst[1].overruns);
        TEST_ASSERT_TRUE_MESSAGE(done >= 1, words);
        TEST_ASSERT_TRUE(worst[0].off_rad < 1e-6);
        TEST_ASSERT_TRUE(worst[1].off_rad < 1e-2);
        TEST_ASSERT_EQUAL_UINT64(0, worst[0].overruns);
    }
}

TEST(contact_centres, centres_passed) {
    check_machines(0, "passing centres", 2.0, few_or_all(4, 12));
}
TEST(contact_centres, centres_from_rest) {
    check_machines(1, "from rest at the centre", 0.4, few_or_all(4, 12));
}
TEST(contact_centres, centres_from_motion) {
    check_machines(2, "in motion at the centre", 2.0, few_or_all(3, 6));
}
TEST(contact_centres, centres_crept_over) {
    check_machines(3, "creeping over the centre", 2.0, few_or_all(3, 6));
}

/* Checks a scene of docs/hard/dead_centre.whirl against the slider-crank with that file's numbers. */
static void check_scene(const char *name, const machine *c, double until_s) {
    long double s[2];
    TEST_ASSERT_TRUE(reference(c, wide(until_s), s));
    for (int n = 0; n < 2; n++) {
        motion m;
        motion_open_file(&m, "docs/hard/dead_centre.whirl", "", name, n ? IN_FLOAT : IN_DOUBLE);
        motion_to(&m, until_s);
        const double off_rad = fabs(motion_value(&m, "a") - (double)s[0]);
        printf("  %s, %s: %.9g rad, off by %.1e\n", name, m.kind->name, (double)s[0], off_rad);
        TEST_ASSERT_TRUE(off_rad < (n ? 1e-2 : 1e-6));
        TEST_ASSERT_EQUAL_UINT64(0, contacts_overruns(&m));
        motion_close(&m);
    }
}

TEST(contact_centres, the_scenes_of_the_catalogue) {
    machine c = {LINKAGE, 0.1, 1.0, 0.1, 100.0, 1.0, 0.0, 0.005, 0.5, 10.0};
    check_scene("crank_turns", &c, 2.0);
    c.torque_Nm = 8.0;
    c.a = 0.0;
    c.rate = 0.0;
    check_scene("crank_starts", &c, 0.4);
}
