/* test_figures_thomson.c: figures 50 to 58 of the dissertation: Thomson's device on the slider and free in the plane.
 * Thresholds and sources as in test_dissertation.c.
 *
 * The device is chaotic. Limits on whole runs hold for every trajectory near it (ranges, invariants), and single times
 * are early enough to be accurate. */
#include "ranges.h"
#include "test.h"

#define PI 3.14159265358979323846

enum { TURNS_MAX = 16 };

/* Times at which the arm completes its turns, X then, and X's span up to the first. */
typedef struct turns {
    unsigned count;
    double at_s[TURNS_MAX];
    double X[TURNS_MAX];
    range first_cycle;
} turns;

static turns count_turns(const char *which, double step_s, double until_s) {
    turns t = {0};
    motion m;
    motion_open(&m, which, IN_DOUBLE_STEP(step_s));
    const unsigned steps = (unsigned)floor(until_s / step_s + 0.5);
    for (unsigned i = 1; i <= steps; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        const double X = motion_value(&m, "X");
        if (t.count == 0) {
            t.first_cycle.least = fmin(t.first_cycle.least, X);
            t.first_cycle.most = fmax(t.first_cycle.most, X);
        }
        if (motion_value(&m, "theta1") <= -2.0 * PI * (t.count + 1) && t.count < TURNS_MAX) {
            t.at_s[t.count] = step_s * i;
            t.X[t.count++] = X;
        }
    }
    motion_close(&m);
    return t;
}

TEST(figures_thomson, figure_50_five_turns_of_the_arm) {
    const turns t = count_turns("thomson_a", 0.125e-3, 9.5);
    TEST_ASSERT_EQUAL_UINT(5, t.count);
    /* dissertation: about 9.4 s; independent: 9.28 to 9.39 s */
    expect_between("fig 50: five turns, s", 9.27, 9.39, t.at_s[4]);
    /* independent: 3.545 s, long before chaos shows */
    expect_between("fig 50: first turn, s", 3.54, 3.55, t.at_s[0]);
}

TEST(figures_thomson, figure_53_back_within_a_fifth_of_a_metre_each_turn) {
    const turns t = count_turns("thomson_a", 0.125e-3, 9.5);
    for (unsigned i = 0; i < t.count; i++) {
        /* dissertation: back at its first place. Closed form at a full turn, from the momentum: X = (r/3)(1 - cos
         * theta2), zero only if disc 33 points outwards. */
        expect_between("fig 53: X at a full turn, m", 0.0, 0.2, t.X[i]);
    }
}

TEST(figures_thomson, figures_51_to_53_ranges) {
    range r[] = {{.name = "X"}, {.name = "projection"}, {.name = "X'"}, {.name = "theta1'"}};
    ranges_of("thomson_a", IN_DOUBLE_STEP(0.25e-3), 10.0, 1e-3, r, 4);
    /* independent: 0 to 0.9987 m; momentum limits it to 0 to 1 m */
    expect_between("fig 53: X from, m", -1e-8, 1e-8, r[0].least);
    expect_between("fig 53: X to, m", 0.998, 1.0 + 1e-8, r[0].most);
    /* closed form: 2 r to either side */
    expect_between("fig 53: projection from, m", -0.6 - 1e-12, -0.599, r[1].least);
    expect_between("fig 53: projection to, m", 0.6 - 1e-12, 0.6 + 1e-12, r[1].most);
    /* energy limits the rates: T = M theta1 < 2 x 5.9 x 2 pi J, carriage and discs 2 kg each */
    expect_between("fig 51: |X'|, m/s", 2.0, 8.6, fmax(r[2].most, -r[2].least));
    expect_between("fig 52: |theta1'|, rad/s", 5.0, 20.0, fmax(r[3].most, -r[3].least));
}

TEST(figures_thomson, figure_54_shifted_not_larger) {
    range a[] = {{.name = "X"}};
    range b[] = {{.name = "X"}, {.name = "x_cm"}};
    ranges_of("thomson_a", IN_DOUBLE_STEP(0.25e-3), 10.0, 1e-3, a, 1);
    ranges_of("thomson_b_conserved", IN_DOUBLE, 10.0, 1e-3, b, 2);
    /* dissertation: the amplitude is unchanged, both ends are shifted alike. Closed form: by the centre of mass, from
     * 0.6 to 0.5 m. Independent: -0.0998 to 0.8999 m. */
    expect_between("fig 54: X's width, set B / set A", 0.99, 1.01,
                   range_width(&b[0]) / range_width(&a[0]));
    expect_between("fig 54: X from, m", -0.1 - 1e-9, -0.099, b[0].least);
    expect_between("fig 54: X to, m", 0.899, 0.9 + 1e-9, b[0].most);
    /* dissertation, figure 55: the centre of mass stays at 0.5 m */
    expect_between("fig 55: centre of mass, m", 0.5 - 1e-12, 0.5 + 1e-12, b[1].last);
    expect_between("fig 55: its drift, m", 0.0, 1e-12, range_drift(&b[1]));
}

TEST(figures_thomson, figure_54_quicker) {
    const turns a = count_turns("thomson_a", 0.125e-3, 5.0);
    const turns b = count_turns("thomson_b", 0.125e-3, 2.0);
    TEST_ASSERT_TRUE(a.count >= 1 && b.count >= 1);
    /* dissertation: the magnet raises the frequency. The cause is the arm's speed at the start: independent, 0.6065 s
     * for the first turn instead of 3.5455 s. */
    expect_between("fig 54: first turn, set B, s", 0.606, 0.607, b.at_s[0]);
    expect_between("fig 54: first turn, set A / set B", 5.8, 5.9, a.at_s[0] / b.at_s[0]);
    /* dissertation: the carriage moves by -0.1 m within the first cycle */
    expect_between("fig 54: X's least in the first turn, m", -0.1, -0.09, b.first_cycle.least);
}

TEST(figures_thomson, figure_57_on_the_slider_as_a_rigid_body) {
    range r[] = {{.name = "X"}, {.name = "x_cm"}};
    ranges_of("thomson_b_spin", IN_DOUBLE_STEP(0.125e-3), 10.0, 1e-3, r, 2);
    /* dissertation: a harmonic motion in X only. Closed form: within 0.4 +- 0.5 m. */
    expect_between("fig 57: X from, m", -0.1 - 1e-8, -0.09, r[0].least);
    expect_between("fig 57: X to, m", 0.89, 0.9 + 1e-8, r[0].most);
    expect_between("fig 57: drift of the centre of mass, m", 0.0, 1e-8, range_drift(&r[1]));
}

static void check_plane(const char *which, double x_cm, double y_cm) {
    motion m;
    double nearest = 1.0;
    double furthest = 0.0;
    double off = 0.0;
    double turned = 0.0;
    double before = 0.0;
    motion_open(&m, which, IN_DOUBLE);
    for (unsigned i = 0; i <= 10000; i++) {
        motion_to(&m, 1e-3 * i);
        const double x = motion_value(&m, "X") - x_cm;
        const double y = motion_value(&m, "Y") - y_cm;
        const double direction = atan2(y, x);
        turned += i == 0 ? 0.0 : remainder(direction - before, 2.0 * PI);
        before = direction;
        nearest = fmin(nearest, hypot(x, y));
        furthest = fmax(furthest, hypot(x, y));
        off = fmax(off, hypot(motion_value(&m, "x_cm") - x_cm, motion_value(&m, "y_cm") - y_cm));
    }
    const double arm = fabs(motion_value(&m, "theta1"));
    motion_close(&m);
    printf("  %s\n", which);
    expect_between("fig 58: centre of mass off its place in the plane, m", 0.0, 1e-8, off);
    /* closed form: |4 e^(i theta1) + e^(2 i theta1) + e^(i theta2)| r/3 is between 0.2 and 0.6 m */
    expect_between("fig 58: carriage from the centre of mass, nearest, m", 0.2 - 1e-8, 0.21,
                   nearest);
    expect_between("fig 58: the same, furthest, m", 0.59, 0.6 + 1e-8, furthest);
    /* dissertation: it moves in a circle, as often as the arm does, within a turn. */
    expect_between("fig 58: turns round the centre of mass / turns of the arm", 0.9, 1.1,
                   fabs(turned) / arm);
    TEST_ASSERT_TRUE(arm > 5.0 * 2.0 * PI);
}

TEST(figures_thomson, figure_58_round_and_round_in_the_plane) {
    check_plane("thomson_plane_a", 0.6, 0.0);
    check_plane("thomson_plane_b", 0.5, -0.1);
    check_plane("thomson_plane_conserved", 0.5, -0.1);
}

static void check_pair(const char *which, stepping how, double cm_bound) {
    range r[] = {{.name = "X"}, {.name = "Y"}, {.name = "x_cm"}, {.name = "y_cm"}};
    ranges_of(which, how, 10.0, 1e-3, r, 4);
    printf("  %s\n", which);
    /* by symmetry; the bound is the project's */
    expect_between("pair: |Y|, m", 0.0, 1e-12, range_drift(&r[1]));
    expect_between("pair: drift of the centre of mass, m", 0.0, cm_bound, range_drift(&r[2]));
    /* as on the slider: 1 m from end to end */
    expect_between("pair: X's width, m", 0.99, 1.0 + 2.0 * cm_bound, range_width(&r[0]));
}

TEST(figures_thomson, mirrored_pair_moves_along_its_line_only) {
    check_pair("thomson_pair_a", IN_DOUBLE, 1e-8);
    check_pair("thomson_pair_b", IN_DOUBLE, 1e-8);
    check_pair("thomson_pair_a", IN_FLOAT_COMPENSATED, 1e-5);
}
