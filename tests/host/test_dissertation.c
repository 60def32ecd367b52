/* test_dissertation.c: the dissertation's simulated figures, chapters I to III, with two-sided thresholds and their
 * source. "dissertation" is its text or a figure's caption. The others are a closed form, or "independent": computed
 * without Whirl by matrix exponential, or by high-order integration of equations derived with SymPy.
 *
 * test_devices.c has the patents' devices and the plane; test_trajectory.c checks accuracy. */
#include "ranges.h"
#include "test.h"

#define PI 3.14159265358979323846
#define LBF_N 4.4482216152605
#define INCH_M 0.0254

TEST(dissertation, figure_19_force_on_the_load_frame) {
    range r[] = {{.name = "pin_force"}, {.name = "cell_force"}};
    ranges_of("carriage_fixed", IN_DOUBLE, 2.0, 1e-3, r, 2);
    /* dissertation: 9.3 lbf in the computer model, 9.5 lbf measured (figures 17 and 19) */
    expect_between("fig 19: peak force, lbf", 9.3, 9.5, r[0].most / LBF_N);
    /* closed form: sum of m r w^2 = 2 (0.152 x 3.625 + 0.15 x 6.5) lb in at 330 rpm */
    const double w = 330.0 * 2.0 * PI / 60.0;
    const double S = 2.0 * (0.152 * 3.625 + 0.15 * 6.5) * 0.45359237 * INCH_M;
    expect_between("fig 19: peak / (m r w^2)", 1.0 - 1e-6, 1.0 + 1e-6, r[0].most / (S * w * w));
    /* dissertation: the force fully reverses. Sampled every 12 degrees of the arm's turn. */
    expect_between("fig 17, 19: -least / peak", 0.9999, 1.0001, -r[0].least / r[0].most);
    /* the load cell also carries the weight, 12 lb and the masses */
    expect_between("fig 19: tare, lbf", 12.604 - 1e-3, 12.604 + 1e-3,
                   (r[1].most + r[1].least) / 2.0 / LBF_N);
}

TEST(dissertation, figure_19_frequency) {
    motion m;
    unsigned crossings = 0;
    double before = 1.0;
    motion_open(&m, "carriage_fixed", IN_DOUBLE);
    for (unsigned i = 1; i < 2000; i++) {
        motion_to(&m, 1e-3 * i);
        const double now = motion_value(&m, "pin_force");
        crossings += (now < 0.0) != (before < 0.0);
        before = now;
    }
    motion_close(&m);
    /* dissertation: 5.5 rev/s; eleven turns in 2 s cross zero 22 times */
    TEST_ASSERT_EQUAL_UINT(22, crossings);
}

/* Fixed force from the rig on its frame, pin force from the moving carriage. */
static double pin_force_ratio(double ratio) {
    range fixed[] = {{.name = "pin_force"}};
    range moving[] = {{.name = "pin_force"}, {.name = "x_cm"}};
    char set[32];
    snprintf(set, sizeof set, "ratio=%.17g", ratio);
    stepping how = IN_DOUBLE;
    how.set = set;
    ranges_of("carriage_fixed", IN_DOUBLE, 2.0, 1e-3, fixed, 1);
    ranges_of("carriage_ratio", how, 2.0, 1e-3, moving, 2);
    TEST_ASSERT_TRUE(range_drift(&moving[1]) <= 1e-8);
    return range_width(&moving[0]) / range_width(&fixed[0]);
}

TEST(dissertation, figure_20_pin_force_against_weight_ratio) {
    for (unsigned i = 0; i <= 10; i++) {
        const double ratio = 0.1 * i;
        /* closed form at constant speed: 1/(1 + ratio); to 0.1 % */
        const double wanted = 1.0 / (1.0 + ratio);
        expect_between("fig 20: pin force, free / fixed", 0.999 * wanted, 1.001 * wanted,
                       pin_force_ratio(ratio));
    }
    /* dissertation: the force varies between 100 % and 75 % at a weight ratio of 1/3 */
    expect_between("fig 20: at a third", 0.749, 0.751, pin_force_ratio(1.0 / 3.0));
    expect_between("fig 20: carriage too heavy to move", 0.999999, 1.000001, pin_force_ratio(0.0));
}

TEST(dissertation, figure_20_from_the_energies_too) {
    range by_energy[] = {{.name = "pin_force"}, {.name = "X"}, {.name = "carriage_force"}};
    range outright[] = {{.name = "pin_force"}, {.name = "X"}};
    ranges_of("carriage_free", IN_DOUBLE, 2.0, 1e-3, by_energy, 3);
    ranges_of("carriage_ratio", IN_DOUBLE, 2.0, 1e-3, outright, 2);
    for (unsigned i = 0; i < 2; i++) {
        const double same = range_width(&outright[i]) / range_width(&by_energy[i]);
        expect_between("fig 20: outright / by energy", 1.0 - 1e-12, 1.0 + 1e-12, same);
    }
    /* Newton's third law */
    expect_between("fig 18: force on the carriage / pin force", 1.0 - 1e-12, 1.0 + 1e-12,
                   range_width(&by_energy[2]) / range_width(&by_energy[0]));
    /* closed form: 2 m r/(m + M) = 2 x 3.05200 lb in/0.604 lb x 1/4 */
    const double swing_m = 2.0 * (0.152 * 3.625 + 0.15 * 6.5) / (0.152 + 0.15) * INCH_M / 4.0;
    expect_between("carriage swing / closed form", 0.99999, 1.00001,
                   range_width(&by_energy[1]) / swing_m);
}

/* Independent: extremes of exp(St) at the full milliseconds, in inches from the equilibria. */
static void check_swing(const char *what, range early, range late, const double wanted[4],
                        double rest_in) {
    const double got[4] = {early.least, early.most, late.least, late.most};
    printf("  %s\n", what);
    for (unsigned i = 0; i < 4; i++) {
        const double in = got[i] / INCH_M - rest_in;
        expect_between("  extreme, in", wanted[i] - 1e-8, wanted[i] + 1e-8, in);
    }
}

static void two_windows(const char *which, range early[2], range late[2]) {
    motion m;
    motion_open(&m, which, IN_DOUBLE);
    for (unsigned i = 0; i <= 5000; i++) {
        motion_to(&m, 1e-3 * i);
        for (unsigned k = 0; k < 2; k++) {
            range *r = i <= 1000 ? &early[k] : &late[k];
            const double value = motion_value(&m, r->name);
            const bool first = i == 0 || i == 4000;
            if (i <= 1000 || i >= 4000) {
                r->least = first ? value : fmin(r->least, value);
                r->most = first ? value : fmax(r->most, value);
            }
        }
    }
    motion_close(&m);
}

static const double FIRST_MASS[4] = {-0.21833082934304, 0.33786709968658, -0.05770491154748,
                                     0.04281500632119};
static const double SECOND_MASS[4] = {-0.34526931991867, 0.5, -0.09543060600656, 0.07220046799739};

TEST(dissertation, figures_32_and_34_absolute_positions) {
    static const char *const scenes[] = {"two_mass_absolute", "two_mass_relative"};
    for (unsigned s = 0; s < 2; s++) {
        range early[] = {{.name = "x_1"}, {.name = "x_2"}};
        range late[] = {{.name = "x_1"}, {.name = "x_2"}};
        two_windows(scenes[s], early, late);
        check_swing(scenes[s], early[0], late[0], FIRST_MASS, 2.35);
        check_swing(scenes[s], early[1], late[1], SECOND_MASS, 4.35);
    }
}

TEST(dissertation, figure_33_stretches) {
    range early[] = {{.name = "X"}, {.name = "Y"}};
    range late[] = {{.name = "X"}, {.name = "Y"}};
    two_windows("two_mass_relative", early, late);
    check_swing("first spring", early[0], late[0], FIRST_MASS, 0.0);
    expect_between("fig 33: second spring at first, in", 0.5 - 1e-12, 0.5 + 1e-12,
                   early[1].most / INCH_M);
    /* independent: exp(St) */
    expect_between("fig 33: second spring's least, in", -0.275170131, -0.275170111,
                   early[1].least / INCH_M);
}

TEST(dissertation, figures_36_to_40_epicyclic_gear) {
    range r[] = {{.name = "theta"},
                 {.name = "X"},
                 {.name = "projection"},
                 {.name = "x_2"},
                 {.name = "x_cm"}};
    ranges_of("epicyclic_from_rest", IN_DOUBLE, 9.0, 1e-3, r, 5);
    /* independent: 89.6342558332 rad at 9 s; a constant torque never reverses the arm */
    expect_between("fig 36: theta at 9 s, rad", 89.63425, 89.63426, r[0].last);
    expect_between("fig 36: theta never falls", -1e-12, 1e-12, r[0].least);
    /* dissertation: the carriage moves between 0 and 0.6 m; closed form 2 r */
    expect_between("fig 37: X from, m", -1e-9, 1e-9, r[1].least);
    expect_between("fig 37: X to, m", 0.5995, 0.6 + 1e-9, r[1].most);
    /* closed form: the arm is 2 r long */
    expect_between("fig 38: projection from, m", -0.6 - 1e-12, -0.5995, r[2].least);
    expect_between("fig 38: projection to, m", 0.5995, 0.6 + 1e-12, r[2].most);
    /* closed form: equal masses, so the planet mirrors the carriage */
    expect_between("fig 39: x_2 from, m", -1e-9, 5e-4, r[3].least);
    expect_between("fig 39: x_2 to, m", 0.5995, 0.6 + 1e-9, r[3].most);
    /* dissertation: the centre of mass does not move */
    expect_between("fig 40: drift of the centre of mass, m", 0.0, 1e-8, range_drift(&r[4]));
    expect_between("fig 40: centre of mass, m", 0.3 - 1e-9, 0.3 + 1e-9, r[4].last);
}

TEST(dissertation, figure_37_a_swing_each_turn) {
    motion m;
    unsigned maxima = 0;
    double before = 0.0;
    double last = 0.0;
    motion_open(&m, "epicyclic_from_rest", IN_DOUBLE);
    for (unsigned i = 1; i <= 9000; i++) {
        motion_to(&m, 1e-3 * i);
        const double X = motion_value(&m, "X");
        maxima += last > before && last >= X;
        before = last;
        last = X;
    }
    motion_close(&m);
    /* closed form: X = r(1 - cos theta) has its maxima at odd half turns; 14 in 89.63 rad */
    TEST_ASSERT_EQUAL_UINT(14, maxima);
}

TEST(dissertation, figures_44_and_45_look_alike_and_are_not) {
    range r[] = {{.name = "theta1"}, {.name = "theta2"}, {.name = "theta3"}};
    ranges_of("driven_hinge_from_rest", IN_DOUBLE, 10.0, 1e-3, r, 3);
    /* dissertation: both angles seem to be identical */
    expect_between("fig 44, 45: theta2/theta1 at 10 s", 0.99, 1.01, r[1].last / r[0].last);
    /* dissertation: they are not. The first swing is the largest; the hinge never overtakes the disc by half a turn. */
    expect_between("fig 46: largest swing, rad", 2.8, PI, fmax(r[2].most, -r[2].least));
}

TEST(dissertation, figure_46_the_swing_falls_without_a_loss) {
    enum { PEAKS_MAX = 200 };
    double at_s[PEAKS_MAX];
    double peak_rad[PEAKS_MAX];
    unsigned peaks = 0;
    double before = 0.0;
    double last = 0.0;
    motion m;
    /* At 0.25 ms: at the scene's 1 ms RK4 itself loses 1e-5 of the energy in 10 s. */
    motion_open(&m, "driven_hinge_from_rest", IN_DOUBLE_STEP(0.25e-3));
    for (unsigned i = 1; i <= 10000; i++) {
        motion_to(&m, 1e-3 * i);
        const double now = fabs(motion_value(&m, "theta3"));
        if (last > before && last >= now) {
            TEST_ASSERT_TRUE(peaks < PEAKS_MAX);
            at_s[peaks] = 1e-3 * (i - 1);
            peak_rad[peaks++] = last;
        }
        before = last;
        last = now;
    }
    const double work = -2.0 * motion_value(&m, "theta1");
    const double a_ = motion_value(&m, "theta1'");
    const double b_ = motion_value(&m, "theta2'");
    const double kinetic =
        0.09 * a_ * a_ + 0.135 * b_ * b_ + 0.18 * a_ * b_ * cos(motion_value(&m, "theta3"));
    motion_close(&m);
    /* dissertation: some 1.25 rad to either side at 6.3 s; printed to two decimals of a curve whose peaks alternate
     * between 1.236 and 1.276 there */
    for (unsigned i = 0; i < peaks; i++) {
        if (at_s[i] > 6.1 && at_s[i] < 6.4) {
            expect_between("fig 46: peak near 6.3 s, rad", 1.23, 1.28, peak_rad[i]);
        }
    }
    /* dissertation: the amplitude falls without damping (test: every second peak is below the last, while all of the
     * motor's work is still present) */
    TEST_ASSERT_TRUE(peaks > 80);
    for (unsigned i = 6; i < peaks; i++) {
        TEST_ASSERT_TRUE(peak_rad[i] < peak_rad[i - 2]);
    }
    expect_between("fig 46: last peak before 10 s, rad", 1.04, 1.07, peak_rad[peaks - 1]);
    expect_between("fig 46: energy / motor's work", 1.0 - 1e-6, 1.0 + 1e-6, kinetic / work);
    /* dissertation: the swings get faster with the hinge */
    const double early_s = at_s[2] - at_s[1];
    const double late_s = at_s[peaks - 1] - at_s[peaks - 2];
    expect_between("fig 46: first half swing / last half swing", 4.0, 10.0, early_s / late_s);
}

/* The dissertation has theta1' = -8.5 and X' = 0 at 9.4 s; its equations give -5.24 and 2.66. */
TEST(dissertation, thomson_at_9_4s) {
    motion m;
    motion_open(&m, "thomson_a", IN_DOUBLE_STEP(0.125e-3));
    motion_to(&m, 9.4);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, -5.24, motion_value(&m, "theta1'"));
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 2.66, motion_value(&m, "X'"));
    motion_close(&m);
}
