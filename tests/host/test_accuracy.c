/* test_accuracy.c: accuracy of double runs against seed values, closed forms and invariants.
 *
 * A lower bound requires the method's own error to be visible. An error below Runge-Kutta's truncation would mean that
 * a run is compared with itself. "Printed" numbers were computed independently of Whirl with SymPy and high-order
 * integration and have 12 digits. */
#include "command.h"
#include "horizons.h"
#include "motion.h"

/* === accuracy ================================================================================= */

typedef struct printed_value {
    const char *name;
    double value;
} printed_value;

static double worst_of(const motion *m, const printed_value *printed, unsigned count) {
    double worst = 0.0;
    for (unsigned i = 0; i < count; i++) {
        worst = fmax(worst, fabs(motion_value(m, printed[i].name) - printed[i].value));
    }
    return worst;
}

static void expect_within(const char *what, double least, double most, double got) {
    printf("  %-58s %.3g (%.3g ... %.3g)\n", what, got, least, most);
    TEST_ASSERT_TRUE_MESSAGE(got >= least && got <= most, what);
}

/* --- the particle: free flight --------------------------------------------------------------------- */

TEST(accuracy, particle_flies_a_parabola) {
    /* The start of spherical_flight in Cartesian coordinates. */
    const double r = 5.0, theta = 1.25, phi = 0.5, r_ = 8.0, theta_ = -0.75, phi_ = 0.5, g = 9.81;
    const double s = sin(theta), c = cos(theta), sp = sin(phi), cp = cos(phi);
    const double vx = r_ * s * cp + r * theta_ * c * cp - r * phi_ * s * sp;
    const double vy = r_ * s * sp + r * theta_ * c * sp + r * phi_ * s * cp;
    const double vz = r_ * c - r * theta_ * s;
    double worst = 0.0;
    motion m;
    motion_open(&m, "spherical_flight", IN_DOUBLE);
    for (unsigned i = 1; i <= 200; i++) {
        const double t = 0.01 * i;
        motion_to(&m, t);
        worst = fmax(worst, fabs(motion_value(&m, "x") - (r * s * cp + vx * t)));
        worst = fmax(worst, fabs(motion_value(&m, "y") - (r * s * sp + vy * t)));
        worst = fmax(worst, fabs(motion_value(&m, "z") - (r * c + vz * t - g * t * t / 2.0)));
    }
    motion_close(&m);
    expect_within("S4 distance from the parabola over 2 s, m", 1e-13, 2e-11, worst);
}

/* --- two masses ------------------------------------------------------------------------------------ */

TEST(accuracy, two_masses_at_the_printed_times) {
    static const printed_value at_half_s[] = {{"x_1_in", 2.14780055387}, {"x_2_in", 4.30952721882}};
    static const printed_value at_2s[] = {{"x_1_in", 2.32102447395}, {"x_2_in", 4.37194168954}};
    static const char *const sets[] = {"two_mass_absolute", "two_mass_relative"};
    for (unsigned i = 0; i < 2; i++) {
        motion m;
        motion_open(&m, sets[i], IN_DOUBLE);
        motion_to(&m, 0.5);
        expect_within("S5 error at 0.5 s, in", 1e-11, 1e-8, worst_of(&m, at_half_s, 2));
        motion_to(&m, 2.0);
        expect_within("S5 error at 2 s, in", 1e-11, 1e-8, worst_of(&m, at_2s, 2));
        motion_close(&m);
    }
}

TEST(accuracy, two_masses_move_alike_in_both_coordinate_sets) {
    motion absolute;
    motion relative;
    double apart = 0.0;
    motion_open(&absolute, "two_mass_absolute", IN_DOUBLE);
    motion_open(&relative, "two_mass_relative", IN_DOUBLE);
    for (unsigned i = 0; i < 5000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&absolute, 1));
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&relative, 1));
        apart = fmax(apart, fabs(motion_value(&absolute, "x_1") - motion_value(&relative, "x_1")));
        apart = fmax(apart, fabs(motion_value(&absolute, "x_2") - motion_value(&relative, "x_2")));
    }
    motion_close(&absolute);
    motion_close(&relative);
    /* Round-off of half a unit in the last place of 0.13 m each step would give 7e-14; damping forgets old errors. Zero
     * would mean that both programs are the same. */
    expect_within("S5 both coordinate sets apart by, m", 1e-17, 7e-14, apart);
}

/* --- epicyclic gear -------------------------------------------------------------------------------- */

TEST(accuracy, epicyclic_gear_at_9s) {
    static const printed_value at_9s[] = {{"theta", 89.6342558332},
                                          {"X", 0.329611268310},
                                          {"theta'", 22.2610447620},
                                          {"X'", 6.64570198845}};
    motion m;
    double off_centre = 0.0;
    double energy = 0.0;
    double least = 1.0;
    double most = 0.0;
    motion_open(&m, "epicyclic_from_rest", IN_DOUBLE);
    for (unsigned i = 0; i < 9000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double a = motion_value(&m, "theta");
        const double v = motion_value(&m, "theta'");
        const double X = motion_value(&m, "X");
        const double X_ = motion_value(&m, "X'");
        const double vx = X_ - 0.6 * v * sin(a);
        const double vy = 0.6 * v * cos(a);
        const double T = X_ * X_ + (vx * vx + vy * vy) + 0.09 * 2.0 * v * v;
        off_centre = fmax(off_centre, fabs(X + 0.3 * cos(a) - 0.3));
        energy = fmax(energy, fabs(T - 2.0 * a));
        least = fmin(least, X);
        most = fmax(most, X);
    }
    expect_within("S6 error at 9 s, four states", 1e-9, 5e-8, worst_of(&m, at_9s, 4));
    expect_within("S6 centre of mass off 0.3 m, m", 1e-12, 1e-9, off_centre);
    expect_within("S6 T - M theta, J (T reaches 179 J)", 1e-10, 1e-6, energy);
    expect_within("S6 least X, m", 0.0, 1e-6, least);
    expect_within("S6 largest X, m", 0.6 - 1e-4, 0.6 + 1e-9, most);
    motion_close(&m);
}

/* --- disc on a driven hinge ------------------------------------------------------------------------- */

TEST(accuracy, driven_hinge_at_5s) {
    static const printed_value at_5s[] = {{"theta1", -48.3378303236}, {"theta2", -47.1025341932}};
    motion m;
    motion_open(&m, "driven_hinge_from_rest", IN_DOUBLE);
    motion_to(&m, 5.0);
    expect_within("S7 error at 5 s, rad", 1e-6, 3e-5, worst_of(&m, at_5s, 2));
    motion_close(&m);
}

/* Turning points define the swing: at exactly 6 s it is moving back from one at 5.997 s, and 1.287 rad out. */
TEST(accuracy, driven_hinge_goes_on_swinging) {
    motion m;
    double before = 0.0;
    double last = 0.0;
    double largest = 0.0;
    unsigned turns = 0;
    motion_open(&m, "driven_hinge_from_rest", IN_DOUBLE);
    motion_to(&m, 6.0);
    for (unsigned i = 0; i < 4000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double now = fabs(motion_value(&m, "theta1") - motion_value(&m, "theta2"));
        if (i >= 2 && last > before && last >= now) {
            largest = fmax(largest, last);
            turns++;
        }
        before = last;
        last = now;
    }
    motion_close(&m);
    expect_within("S7 largest swing after 6 s, rad", 1.24, 1.28, largest);
    TEST_ASSERT_TRUE(turns > 40);
}

/* --- Thomson's device -------------------------------------------------------------------------------- */

/* The references: momentum gives X, work gives T. m = 2, r = 0.3, M = -2. */
static double thomson_off_closed_form(const motion *m) {
    const double a = motion_value(m, "theta1");
    const double b = motion_value(m, "theta2");
    return motion_value(m, "X") - 0.1 * (6.0 - 4.0 * cos(a) - cos(2.0 * a) - cos(b));
}

typedef struct thomson_error {
    double positions_at_5s;
    double states_at_5s;
    double states_at_8s;
    double off_closed_form_m;
    double off_work_J;
} thomson_error;

static thomson_error thomson_error_of(stepping how) {
    static const printed_value at_5s[] = {
        {"theta1", -10.6144740124}, {"theta2", -17.0959717051}, {"X", 0.8392858098}};
    thomson_error e = {0};
    motion m;
    motion_open(&m, "thomson_a", how);
    for (unsigned i = 1; i <= 8000; i++) {
        motion_to(&m, 1e-3 * i);
        e.off_closed_form_m = fmax(e.off_closed_form_m, fabs(thomson_off_closed_form(&m)));
        e.off_work_J =
            fmax(e.off_work_J, fabs(thomson_kinetic_J(&m) + 2.0 * motion_value(&m, "theta1")));
        if (i == 5000) {
            e.positions_at_5s = worst_of(&m, at_5s, 3);
            e.states_at_5s = motion_error(&m, "thomson_a", "5.0");
        }
    }
    e.states_at_8s = motion_error(&m, "thomson_a", "8.0");
    motion_close(&m);
    return e;
}

/* 1 ms is fine enough for the dissertation's figures. */
TEST(accuracy, thomson_at_5s_and_8s_with_1_ms) {
    const thomson_error e = thomson_error_of(IN_DOUBLE_STEP(1e-3));
    expect_within("S8 error at 5 s, 1 ms, three positions", 1e-8, 5e-6, e.positions_at_5s);
    expect_within("S8 error at 5 s, 1 ms, six states", 1e-7, 5e-6, e.states_at_5s);
    expect_within("S8 error at 8 s, 1 ms, six states", 1e-7, 1e-5, e.states_at_8s);
    expect_within("S8 X off its closed form to 8 s, 1 ms, m", 1e-9, 1e-6, e.off_closed_form_m);
    expect_within("S8 T - M theta1 to 8 s, 1 ms, J (T reaches 49 J)", 1e-9, 2e-6, e.off_work_J);
}

/* A fifth of that step reduces the error by 5^4 = 625, and the bounds with it. The printed positions have ten
 * decimals. */
TEST(accuracy, thomson_at_5s_and_8s) {
    const thomson_error e = thomson_error_of(IN_DOUBLE);
    expect_within("S8 error at 5 s, three positions", 1e-10, 5e-6 / 625.0, e.positions_at_5s);
    expect_within("S8 error at 5 s, six states", 1e-10, 5e-6 / 625.0, e.states_at_5s);
    expect_within("S8 error at 8 s, six states", 1e-10, 1e-5 / 625.0, e.states_at_8s);
    expect_within("S8 X off its closed form to 8 s, m", 1e-12, 1e-6 / 625.0, e.off_closed_form_m);
    expect_within("S8 T - M theta1 to 8 s, J (T reaches 49 J)", 1e-12, 2e-6 / 625.0, e.off_work_J);
}

/* To 10 s, when no trajectory is accurate any more: the centre of mass stays, and momentum limits X to `widest` either
 * side of `middle`. Set B rotates four times as fast. */
static void thomson_stays(const char *name, double centre, double middle, double widest,
                          double least_width) {
    motion m;
    double off = 0.0;
    double lowest = middle;
    double highest = middle;
    motion_open(&m, name, IN_DOUBLE);
    const uint64_t steps = (uint64_t)floor(10.0 / m.instance->step_s + 0.5);
    for (uint64_t i = 0; i < steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double X = motion_value(&m, "X");
        const double a = motion_value(&m, "theta1");
        const double b = motion_value(&m, "theta2");
        const double x_33 = X + 0.6 * cos(a) + 0.3 * cos(2.0 * a) + 0.3 * cos(b);
        off = fmax(off, fabs((X + (X + 0.6 * cos(a)) + x_33) / 3.0 - centre));
        lowest = fmin(lowest, X);
        highest = fmax(highest, X);
    }
    motion_close(&m);
    printf("  %s\n", name);
    expect_within("S8 centre of mass off its place to 10 s, m", 1e-12, 1e-8, off);
    expect_within("S8 X to the left, m", least_width, widest + 1e-6, middle - lowest);
    expect_within("S8 X to the right, m", least_width, widest + 1e-6, highest - middle);
}

/* X = centre - r/3 (4 cos theta1 + cos 2 theta1 + cos theta2) lies between centre - 0.6 and centre + 0.4 m. The runs
 * come within 1.4 mm of both limits. Printed for set A: 0.9987 m. */
TEST(accuracy, thomson_stays_where_it_is) {
    thomson_stays("thomson_a", 0.6, 0.5, 0.5, 0.4986);
    thomson_stays("thomson_b", 0.5, 0.4, 0.5, 0.4986);
}

/* With X recovered from its momentum, the other coordinates move as before. Only round-off moves the centre of mass. */
TEST(accuracy, thomson_with_the_carriage_from_its_momentum) {
    motion m;
    double off = 0.0;
    motion_open(&m, "thomson_a_conserved", IN_DOUBLE);
    for (unsigned i = 1; i <= 10000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        off = fmax(off, fabs(thomson_off_closed_form(&m)));
        if (i == 5000) {
            expect_within("S8 conserved, error at 5 s, six states", 1e-7, 5e-6,
                          motion_error(&m, "thomson_a", "5.0"));
        }
    }
    motion_close(&m);
    expect_within("S8 conserved, X off its closed form to 10 s, m", 0.0, 2e-15, off);
}

/* Growth of an initial change of 1e-9 rad. Printed: 6e3 by 5 s, 2e4 by 9 s, 1e9 by 10 s. */
TEST(accuracy, thomson_is_chaotic) {
    static const char *const names[] = {"theta1", "theta2", "X", "theta1'", "theta2'", "X'"};
    static const struct {
        double time_s;
        double growth;
    } printed[] = {{5.0, 6e3}, {9.0, 2e4}, {10.0, 1e9}};
    stepping how = IN_DOUBLE_STEP(0.25e-3);
    motion m;
    motion changed;
    motion_open(&m, "thomson_a", how);
    how.start = "theta1=1e-9";
    motion_open(&changed, "thomson_a", how);
    for (unsigned k = 0; k < 3; k++) {
        double apart = 0.0;
        motion_to(&m, printed[k].time_s);
        motion_to(&changed, printed[k].time_s);
        for (unsigned i = 0; i < 6; i++) {
            apart =
                fmax(apart, fabs(motion_value(&m, names[i]) - motion_value(&changed, names[i])));
        }
        printf("  at %g s:", printed[k].time_s);
        expect_within("S8 growth of a change of 1e-9 rad", printed[k].growth / 2.0,
                      printed[k].growth * 2.0, apart / 1e-9);
    }
    motion_close(&m);
    motion_close(&changed);
}

/* The dissertation has theta1' = -8.5 and X' = 0 at 9.4 s; its equations give -5.24 and 2.66. */
TEST(accuracy, thomson_at_9_4s) {
    motion m;
    motion_open(&m, "thomson_a", IN_DOUBLE_STEP(0.125e-3));
    motion_to(&m, 9.4);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, -5.24, motion_value(&m, "theta1'"));
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 2.66, motion_value(&m, "X'"));
    motion_close(&m);
}

/* === trust drawn ============================================================================== */
/* Time until which chaotic runs are accurate, on random mechanisms. They are pendulums of two and three links, on
 * carriages and springs, turning arms, and planetary gears with a disc on a hinge. Masses, lengths, springs, starts,
 * number format and method vary. `make trust-check` takes thirty and prints them.
 *
 * The same mechanisms measure an alternative for boards: twin runs in the board's own arithmetic
 * (docs/dev/stability.md). */

/* --- drawing ---------------------------------------------------------------------------------------*/

enum { TEXT = 3000, KINDS = 6 };

static double of(dice *d, double low, double high) {
    return number_nearest(dice_between(d, low, high) * 1000.0) / 1000.0;
}

static int double_pendulum(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"double pendulum\"\ncoordinate a [rad]\ncoordinate b [rad]\n"
                    "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter l = %g [m]\n"
                    "parameter k = %g [m]\nparameter g = 9.81 [m/s^2]\n"
                    "let vx = l*a'*cos(a) + k*b'*cos(b)\nlet vy = l*a'*sin(a) + k*b'*sin(b)\n"
                    "T = p*(l*a')^2/2 + q*(vx^2 + vy^2)/2\n"
                    "V = -p*g*l*cos(a) - q*g*(l*cos(a) + k*cos(b)) + %g [J]*cos(a - b)\n"
                    "scene s {\n  start a = %g, b = %g, a' = %g [rad/s]\n",
                    of(d, 0.3, 3), of(d, 0.3, 3), of(d, 0.2, 1.5), of(d, 0.2, 1.5), of(d, 0, 2),
                    of(d, 2, 3), of(d, -3, 3), of(d, -2, 2));
}

static int triple_pendulum(dice *d, char *to) {
    return snprintf(
        to, TEXT,
        "mechanism drawn \"triple pendulum\"\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate c [rad]\n"
        "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter r = %g [kg]\nparameter l = %g [m]\n"
        "parameter k = %g [m]\nparameter n = %g [m]\nparameter g = 9.81 [m/s^2]\n"
        "let x2 = l*a'*cos(a) + k*b'*cos(b)\nlet y2 = l*a'*sin(a) + k*b'*sin(b)\n"
        "let x3 = x2 + n*c'*cos(c)\nlet y3 = y2 + n*c'*sin(c)\n"
        "T = p*(l*a')^2/2 + q*(x2^2 + y2^2)/2 + r*(x3^2 + y3^2)/2\n"
        "V = -g*((p + q + r)*l*cos(a) + (q + r)*k*cos(b) + r*n*cos(c))\n"
        "scene s {\n  start a = %g, b = %g, c = %g\n",
        of(d, 0.3, 2), of(d, 0.3, 2), of(d, 0.3, 2), of(d, 0.3, 1), of(d, 0.3, 1), of(d, 0.3, 1),
        of(d, 1.5, 3), of(d, -3, 3), of(d, -3, 3));
}

static int on_a_carriage(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"double pendulum on a sprung carriage\"\ncoordinate x [m]\n"
                    "coordinate a [rad]\ncoordinate b [rad]\n"
                    "parameter M = %g [kg]\nparameter p = %g [kg]\nparameter q = %g [kg]\n"
                    "parameter l = %g [m]\nparameter k = %g [m]\nparameter s = %g [N/m]\n"
                    "parameter g = 9.81 [m/s^2]\n"
                    "let x1 = x' + l*a'*cos(a)\nlet y1 = l*a'*sin(a)\n"
                    "let x2 = x1 + k*b'*cos(b)\nlet y2 = y1 + k*b'*sin(b)\n"
                    "T = M*x'^2/2 + p*(x1^2 + y1^2)/2 + q*(x2^2 + y2^2)/2\n"
                    "V = -p*g*l*cos(a) - q*g*(l*cos(a) + k*cos(b)) + s*x^2/2\n"
                    "scene s {\n  start a = %g, b = %g, x = %g [m]\n",
                    of(d, 0.5, 4), of(d, 0.3, 2), of(d, 0.3, 2), of(d, 0.3, 1), of(d, 0.3, 1),
                    of(d, 5, 80), of(d, 2, 3), of(d, -3, 3), of(d, -0.5, 0.5));
}

static int on_a_spring(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"pendulum below an elastic one\"\ncoordinate x [m]\n"
                    "coordinate y [m]\ncoordinate a [rad]\n"
                    "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter k = %g [N/m]\n"
                    "parameter L = %g [m]\nparameter l = %g [m]\nparameter g = 9.81 [m/s^2]\n"
                    "let s = sqrt(x^2 + y^2 + 0.01 [m^2])\n"
                    "let vx = x' + l*a'*cos(a)\nlet vy = y' + l*a'*sin(a)\n"
                    "T = p*(x'^2 + y'^2)/2 + q*(vx^2 + vy^2)/2\n"
                    "V = k*(s - L)^2/2 + p*g*y + q*g*(y - l*cos(a))\n"
                    "scene s {\n  start x = %g [m], y = %g [m], a = %g\n",
                    of(d, 0.3, 1.5), of(d, 0.3, 1.5), of(d, 40, 200), of(d, 0.5, 1), of(d, 0.3, 1),
                    of(d, 0.6, 1.2), of(d, -0.3, 0.6), of(d, 1.5, 3));
}

static int on_an_arm(dice *d, char *to) {
    return snprintf(
        to, TEXT,
        "mechanism drawn \"two pendulums on a turning arm\"\ncoordinate w [rad]\n"
        "coordinate a [rad]\ncoordinate b [rad]\n"
        "parameter J = %g [kg*m^2]\nparameter R = %g [m]\nparameter p = %g [kg]\n"
        "parameter l = %g [m]\nparameter q = %g [kg]\nparameter k = %g [m]\n"
        "parameter g = 9.81 [m/s^2]\n"
        "T = (J*w'^2/2 + p*((R*w' + l*a'*cos(a))^2 + (l*a'*sin(a))^2 + (l*w'*sin(a))^2)/2\n"
        "     + q*((R*w' + k*b'*cos(b))^2 + (k*b'*sin(b))^2 + (k*w'*sin(b))^2)/2)\n"
        "V = -p*g*l*cos(a) - q*g*k*cos(b) + %g [J]*cos(a - b)\n"
        "scene s {\n  start a = %g, b = %g, w' = %g [rad/s]\n",
        of(d, 0.02, 0.2), of(d, 0.2, 0.6), of(d, 0.3, 1), of(d, 0.2, 0.6), of(d, 0.3, 1),
        of(d, 0.2, 0.6), of(d, 0, 2), of(d, 2, 3), of(d, -3, 3), of(d, -4, 4));
}

/* Thomson's device with discs of any size. */
static int planet(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"planet gear with a disc on its rim\"\ncoordinate a [rad]\n"
                    "coordinate b [rad]\ncoordinate X [m]\n"
                    "parameter m = %g [kg]\nparameter n = %g [kg]\nparameter r = %g [m]\n"
                    "parameter l = %g [m]\nparameter I = m*r^2/2\nparameter k = %g [N/m]\n"
                    "let bx = X' - 2*r*a'*sin(a)\nlet by = 2*r*a'*cos(a)\n"
                    "let dx = X' - 2*r*a'*(sin(a) + sin(2*a)) - l*b'*sin(b)\n"
                    "let dy = 2*r*a'*(cos(a) + cos(2*a)) + l*b'*cos(b)\n"
                    "T = m*X'^2/2 + m*(bx^2 + by^2)/2 + 2*I*a'^2 + n*(dx^2 + dy^2)/2\n"
                    "V = k*X^2/2\nQ(a) = %g [N*m]\n"
                    "scene s {\n  start a = %g, b = %g, a' = %g [rad/s]\n",
                    of(d, 1, 3), of(d, 0.5, 3), of(d, 0.1, 0.4), of(d, 0.1, 0.4), of(d, 0, 30),
                    of(d, -0.2, 0.2), of(d, -3, 3), of(d, -3, 3), of(d, 2, 6));
}

static int (*const kinds[KINDS])(dice *, char *) = {double_pendulum, triple_pendulum, on_a_carriage,
                                                    on_a_spring,     on_an_arm,       planet};

/* --- settings ----------------------------------------------------------------------------------------*/

typedef struct drawn_setting {
    const char *name;
    horizons_setting how;
    double step_ms;
} drawn_setting;

static drawn_setting setting_of(dice *d) {
    static const drawn_setting all[] = {
        {"float", {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"float compensated", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"double", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"double, nystroem5", {&engine_double, false, WH_NYSTROEM5, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"float, heun", {&engine_float, false, WH_HEUN, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"float, nystroem4", {&engine_float, false, WH_NYSTROEM4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"double compensated, rk38",
         {&engine_double, true, WH_RK38, TABLES_NONE, MATRIX_NONE},
         1.0},
    };
    static const double steps_ms[] = {0.5, 1.0, 1.0, 2.0};
    drawn_setting s = all[dice_one_of(d, sizeof all / sizeof all[0])];
    s.step_ms = steps_ms[dice_one_of(d, 4)];
    return s;
}

/* --- twin runs for boards --------------------------------------------------------------------------- */

typedef enum board_twin { TWIN_PERTURBED, TWIN_HALF, TWIN_METHOD, TWINS } board_twin;
static const char *const twin_names[TWINS] = {"start off by one rounding", "half the step",
                                              "another method"};

/* Time at which two runs in one arithmetic first differ by the tolerance, relative to the truth. */
static double twin_ratio(const horizons *h, board_twin which) {
    const engine_kind *kind = h->twins->shape->kind;
    image other = *h->image;
    double start_rad[IMAGE_COMPONENTS_MAX];
    int64_t start_turns[IMAGE_COMPONENTS_MAX];
    uint64_t each = 1;
    switch (which) {
    case TWIN_PERTURBED:
        memcpy(start_rad, other.start_rad, (size_t)other.angles * sizeof *start_rad);
        memcpy(start_turns, other.start_turns, (size_t)other.angles * sizeof *start_turns);
        start_rad[0] += kind == &engine_float ? 0x1p-24 : 0x1p-52;
        start_turns[0] += 41; /* 2^-24 rad by 2^-32 turns */
        other.start_rad = start_rad;
        other.start_turns = start_turns;
        break;
    case TWIN_HALF:
        other.step.denominator *= 2U;
        other.step_s *= 0.5;
        each = 2;
        break;
    case TWIN_METHOD:
        other.settings.method = other.settings.method == WH_RK38 ? WH_RK4 : WH_RK38;
        break;
    case TWINS: break;
    }
    records *a = records_open(NULL, h->image, kind);
    records *b = records_open(NULL, &other, kind);
    void *run = kind->start(h->image);
    void *beside = kind->start(&other);
    uint64_t step = 0;
    bool same = true;
    while (same && step < h->image->steps && kind->step(run) == WH_OK) {
        for (uint64_t i = 0; i < each; i++) {
            same = kind->step(beside) == WH_OK && same;
        }
        step++;
        records_read(a, run, 0.0);
        records_read(b, beside, 0.0);
        for (int k = 1; k < h->twins->columns; k++) {
            same = same && fabs(a->row[k] - b->row[k]) <=
                               h->estimate.tolerance * h->estimate.column[k].range;
        }
    }
    kind->stop(run);
    kind->stop(beside);
    records_close(a);
    records_close(b);
    return ratio_times(step, h->image->step) / h->true_until_s;
}

/* --- the measurement ---------------------------------------------------------------------------------*/

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

static void spread_of(const char *what, double *ratio, unsigned count) {
    qsort(ratio, count, sizeof *ratio, by_size);
    printf("  %-28s %u ratios: least %.3f, tenth %.3f, middle %.3f, ninth tenth %.3f, most %.3f\n",
           what, count, ratio[0], ratio[count / 10], ratio[count / 2],
           ratio[count - 1 - count / 10], ratio[count - 1]);
}

enum { MOST_CASES = 400 };

TEST(trust_drawn, drawn_mechanisms) {
    static double ratio[MOST_CASES];
    static double twin[TWINS][MOST_CASES];
    dice d = dice_of("trust_drawn", 14);
    const unsigned wanted = dice_cases(few_or_all(3, 12));
    unsigned count = 0;
    unsigned near = 0;
    unsigned regular = 0;
    unsigned beyond = 0;
    for (unsigned i = 0; count < wanted && count < MOST_CASES && i < 3 * wanted + 10; i++) {
        char text[TEXT + 200];
        const int length = kinds[i % KINDS](&d, text);
        const drawn_setting s = setting_of(&d);
        TEST_ASSERT_TRUE(length > 0 && length < TEXT);
        snprintf(text + length, sizeof text - (size_t)length, "  step %g [ms]\n  until 30 [s]\n}\n",
                 s.step_ms);
        horizons h = horizons_of(text, "s", s.how, HORIZON_TOLERANCE);
        char what[60] = "";
        sscanf(text, "mechanism drawn \"%59[^\"]", what);
        if (h.known >= 0.05) { /* the references differ earlier: not accurate enough */
            beyond++;
        } else if (h.estimate.to_the_end && h.true_until_s >= h.twins->end_s) {
            regular++; /* both accurate to the end */
        } else {
            ratio[count] = horizons_ratio(&h);
            near += ratio[count] >= 0.8 && ratio[count] <= 1.2;
            printf("  %2u %-40s %-24s %g ms: %.5g s, true %.5g s: %.3f;", count, what, s.name,
                   s.step_ms, h.estimate.until_s, h.true_until_s, ratio[count]);
            for (int k = 0; k < TWINS; k++) {
                twin[k][count] = twin_ratio(&h, (board_twin)k);
                printf(" %.2f", twin[k][count]);
            }
            printf("\n");
            TEST_ASSERT_TRUE_MESSAGE(ratio[count] > 0.5 && ratio[count] <= 1.3, text);
            count++;
        }
        horizons_free(&h);
    }
    printf("  %u chaotic, %u right to the end by both, %u beyond the references\n", count, regular,
           beyond);
    TEST_ASSERT_EQUAL_UINT(wanted, count);
    TEST_ASSERT_TRUE_MESSAGE(10 * near >= 9 * count, "nine of ten within 0.8 ... 1.2");
    TEST_ASSERT_TRUE_MESSAGE(beyond <= count / 5, "the references know too little");
    spread_of("whirl trust", ratio, count);
    for (int k = 0; k < TWINS; k++) {
        spread_of(twin_names[k], twin[k], count);
    }
}
