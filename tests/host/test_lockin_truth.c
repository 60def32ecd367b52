/* test_lockin_truth.c: the rig's measurement compared with the truth, and how often its intervals contain the truth.
 *
 * The truth is the first Fourier coefficient, over the angle, of the force of a rotor that is integrated with small
 * steps in double (rig_orbit.c). The measurement has noise of the cell and jitter of the pulses. Seeds are fixed.
 * WHIRL_FULL=1 (`make rig-truth`) does 200 or 1,000 runs of each kind and prints the results; `make test` does
 * fewer. */
#include "command.h"
#include "core/rig/datasheet.h"
#include "hal/virtual/virtual_rig.h"
#include "rig_orbit.h"
#include "tests/scattered.h"

static void check_below(double bound, double value) {
    if (!(value < bound)) {
        printf("%.6g is not below %.6g\n", value, bound);
    }
    TEST_ASSERT_TRUE(value < bound);
}

#define DEG (180.0 / 3.14159265358979323846)
#define LEAD_RAD (1.0 / DEG)
/* turns before the record, more than the firmware waits for the speed to settle */
#define BEFORE 14U
#define TURNS 20U

static bool full(void) { return few_or_all(0, 1) == 1; }

static wh_result_config judged;
static wh_rotor_config rotor;
static wh_cell_config cell;
static rig_orbit orbit;

typedef struct tally {
    unsigned runs;
    unsigned good;
    unsigned covered[2]; /* number of intervals that contain the truth: amplitude, phase */
    double sum[2];       /* sums of errors: relative amplitude, phase in rad */
    double square[2];
    double half[2][1000]; /* half-widths of the intervals */
} tally;

static tally found;

static void count_run(const wh_measured *measured) {
    const double error[2] = {(double)measured->amplitude_N / orbit.amplitude_N - 1.0,
                             (double)measured->phase_rad - orbit.phase_rad};
    const double half[2] = {(double)measured->amplitude_half_N / orbit.amplitude_N,
                            (double)measured->phase_half_rad};
    for (unsigned i = 0; i < 2; i++) {
        found.covered[i] += fabs(error[i]) <= half[i] ? 1U : 0U;
        found.sum[i] += error[i];
        found.square[i] += error[i] * error[i];
        found.half[i][found.runs] = half[i];
    }
    found.good += measured->quality == WH_GOOD ? 1U : 0U;
    found.runs++;
}

static void measure_many(const rig_noise *noise, unsigned runs, uint64_t seed) {
    found = (tally){0};
    for (unsigned i = 0; i < runs; i++) {
        wh_measured measured;
        rig_measure(&orbit, noise, &rotor, BEFORE, TURNS, seed + i, &measured);
        TEST_ASSERT_EQUAL_UINT32(TURNS, measured.turns);
        count_run(&measured);
    }
}

static double bias(unsigned i) { return found.sum[i] / found.runs; }
static double rms(unsigned i) { return sqrt(found.square[i] / found.runs); }

static int compare(const void *x, const void *y) {
    const double a = *(const double *)x;
    const double b = *(const double *)y;
    return a < b ? -1 : a > b ? 1 : 0;
}

static double median_half(unsigned i) {
    qsort(found.half[i], found.runs, sizeof found.half[i][0], compare);
    return found.half[i][found.runs / 2U];
}

static void print_row(double rpm, const rig_noise *noise) {
    if (full()) {
        printf(
            "%4.0f rpm %4.2f N %2.0f us %4u runs: bias %+.4f %% %+.4f deg, rms %.4f %% %.4f deg, half %.4f %% "
            "%.4f deg, covered %.1f %% %.1f %%, good %u\n",
            rpm, noise->cell_N, 1e6 * noise->jitter_s, found.runs, 100.0 * bias(0), DEG * bias(1),
            100.0 * rms(0), DEG * rms(1), 100.0 * median_half(0), DEG * median_half(1),
            100.0 * found.covered[0] / found.runs, 100.0 * found.covered[1] / found.runs,
            found.good);
    }
}

/* A measurement of good quality must be right within its interval plus 1 %. */
static wh_quality check_no_lie(const rig_noise *noise, uint64_t seed) {
    wh_measured measured;
    rig_measure(&orbit, noise, &rotor, BEFORE, TURNS, seed, &measured);
    if (measured.quality == WH_GOOD) {
        const double off = fabs((double)measured.amplitude_N - orbit.amplitude_N);
        const double turned = fabs((double)measured.phase_rad - orbit.phase_rad);
        check_below((double)measured.amplitude_half_N + 0.01 * orbit.amplitude_N, off);
        check_below((double)measured.phase_half_rad + 0.01, turned);
    }
    return measured.quality;
}

/* The scatter may be 1.3 times the effect of the cell's noise and of jitter. Jitter adds to the phase the error of
 * the mean of TURNS pulses. Jitter also changes the measured speed ripple E by dE, and so the amplitude by
 * 3/2 E dE. */
static void check_scatter(const rig_noise *noise) {
    const double samples = TURNS * orbit.turn_s / 0.002;
    const double cells = 1.3 * noise->cell_N * sqrt(2.0 / samples) / orbit.amplitude_N;
    const double marks =
        1.3 * noise->jitter_s * 2.0 * 3.14159265358979323846 / (orbit.turn_s * sqrt((double)TURNS));
    const double few = full() ? 1.0 : 1.3; /* with few runs the scatter is uncertain */
    check_below(fabs(bias(0)) + few * hypot(cells, 1.5 * orbit.swing * marks), rms(0));
    check_below(fabs(bias(1)) + few * hypot(cells, marks), rms(1));
}

/* A cell with noise, and one with a 12-bit converter (STM32F405): 64 conversions in 2 ms, 109 mN a count, noise of
 * half a count. A converter without noise repeats one value at a crest for longer than a working cell would; the
 * result must still be right. */
TEST(lockin_truth, bias_and_scatter) {
    static const double rpm[] = {170.0, 200.0, 260.0, 330.0, 360.0};
    static const rig_noise cells[] = {
        {.cell_N = 0.0},
        {.conversions = 64,
         .conversion_N = 2.0 * (double)HAL_LOADCELL_FULL_SCALE_N / 4096.0,
         .conversion_counts = 0.5}};
    for (unsigned k = 0; k < 5; k++) {
        rig_orbit_find(&rig_plant_nominal, rpm[k], LEAD_RAD, &orbit);
        for (unsigned i = 0; i < 8; i++) {
            rig_noise noise = cells[i / 4U];
            noise.cell_N = i % 2U == 0 ? 0.07 : 1.0;
            noise.jitter_s = i % 4U < 2U ? 0.0 : 60e-6;
            measure_many(&noise, few_or_all(i < 4U ? 10 : 2, 200), 1000U * k + 250U * (i % 4U));
            print_row(rpm[k], &noise);
            TEST_ASSERT_DOUBLE_WITHIN(0.005, 0.0, bias(0));
            TEST_ASSERT_DOUBLE_WITHIN(0.5 / DEG, 0.0, bias(1));
            check_scatter(&noise);
        }
        rig_noise still = cells[1];
        still.conversion_counts = 0.0;
        for (unsigned i = 0; i < few_or_all(2, 50); i++) {
            check_no_lie(&still, 800000U + 1000U * k + i);
        }
    }
}

/* At 330 rpm, 93 to 97 % of 1,000 runs must have the truth in their interval, so the intervals are not wider than
 * needed. */
TEST(lockin_truth, intervals_cover_the_truth) {
    static const double cells_N[] = {0.5, 1.0, 3.0};
    rig_orbit_find(&rig_plant_nominal, 330.0, LEAD_RAD, &orbit);
    for (unsigned i = 0; i < 6; i++) {
        const rig_noise noise = {.cell_N = cells_N[i % 3U], .jitter_s = i < 3U ? 0.0 : 60e-6};
        const unsigned runs = few_or_all(60, 1000);
        measure_many(&noise, runs, 100000U + 2000U * i);
        print_row(330.0, &noise);
        for (unsigned what = 0; what < 2; what++) {
            const double part = (double)found.covered[what] / runs;
            TEST_ASSERT_TRUE(part >= (full() ? 0.93 : 0.85));
            TEST_ASSERT_TRUE(part <= (full() ? 0.97 : 1.0));
            check_below(3.0 * rms(what), median_half(what));
            check_below(median_half(what), 1.6 * rms(what));
        }
        TEST_ASSERT_EQUAL_UINT(runs, found.good);
    }
}

/* With the cell's own noise, the intervals have their least width. At least 95 % of the runs must have the truth in
 * their interval, within 0.1 % and 0.1 degrees. */
TEST(lockin_truth, intervals_where_floors_rule) {
    rig_orbit_find(&rig_plant_nominal, 330.0, LEAD_RAD, &orbit);
    for (unsigned i = 0; i < 2; i++) {
        const rig_noise noise = {.cell_N = 0.07, .jitter_s = i == 0 ? 0.0 : 60e-6};
        const unsigned runs = few_or_all(40, 1000);
        measure_many(&noise, runs, 200000U + 2000U * i);
        print_row(330.0, &noise);
        for (unsigned what = 0; what < 2; what++) {
            /* with jitter, the interval of the phase is wider than its least width */
            const double least = !full() ? 0.85 : i == 1 && what == 1 ? 0.93 : 0.95;
            TEST_ASSERT_TRUE((double)found.covered[what] / runs >= least);
        }
        check_below(0.001, median_half(0));
        check_below(0.1 / DEG, median_half(1));
    }
}

static double drawn(double least, double most) {
    return least + (most - least) * ((double)(scattered() >> 11) + 0.5) * 0x1p-53;
}

/* Rotors whose inertia and friction are wrong by up to 30 %, at the slowest set-point. */
TEST(lockin_truth, drawn_rotors) {
    for (unsigned i = 0; i < 2; i++) {
        const rig_noise noise = {.cell_N = i == 0 ? 0.07 : 1.0, .jitter_s = i == 0 ? 0.0 : 60e-6};
        const unsigned runs = few_or_all(20, 1000);
        found = (tally){0};
        uint64_t seed = UINT64_C(0x5eed0170);
        for (unsigned k = 0; k < runs; k++) {
            scattered_state = seed;
            rig_plant plant = rig_plant_nominal;
            plant.inertia_kgm2 *= drawn(0.7, 1.3);
            plant.drag_Nms *= drawn(0.7, 1.3);
            seed = scattered_state;
            rig_orbit_find(&plant, 170.0, LEAD_RAD, &orbit);
            wh_measured measured;
            rig_measure(&orbit, &noise, &rotor, BEFORE, TURNS, 300000U + k, &measured);
            count_run(&measured);
        }
        print_row(170.0, &noise);
        for (unsigned what = 0; what < 2; what++) {
            TEST_ASSERT_TRUE((double)found.covered[what] / runs >= (full() ? 0.93 : 0.8));
            TEST_ASSERT_DOUBLE_WITHIN(what == 0 ? 0.005 : 0.5 / DEG, 0.0, bias(what));
        }
    }
}

/* Gravity compensation of a rotor whose parameters differ from the controller's. `part`, `inertia` and `drag` are
 * factors. Friction (`drag`) helps the motor to brake. */
typedef struct fed_kind {
    double part;
    double late_rad;
    double inertia;
    double drag;
} fed_kind;

static void feed(const fed_kind *kind, double rpm) {
    rig_plant plant = rig_plant_nominal;
    plant.inertia_kgm2 *= kind->inertia;
    plant.drag_Nms *= kind->drag;
    plant.fed_Nm = kind->part * plant.unbalance_kgm * plant.gravity_mps2;
    plant.fed_late_rad = kind->late_rad;
    rig_orbit_find(&plant, rpm, LEAD_RAD, &orbit);
}

static void print_fed(const fed_kind *kind, double rpm, const rig_noise *noise) {
    if (full()) {
        printf("fed %.2f, late %+.3f rad, inertia %.1f, drag %.1f, swing %.4f: ", kind->part,
               kind->late_rad, kind->inertia, kind->drag, orbit.swing);
    }
    print_row(rpm, noise);
}

/* At speeds at which the motor can brake as much as required, the result must be within 1 % and 1 degree. The
 * compensation may be wrong by up to 30 %, the inertia 50 % too high or 30 % too low. At lower speeds the motor cannot
 * brake enough, so only the right compensation is tested there. */
TEST(lockin_truth, compensation_does_not_affect_results) {
    static const double rpm[] = {100.0, 107.0, 115.0, 123.0, 130.0, 170.0, 250.0, 330.0};
    static const fed_kind kinds[] = {
        {1.0, 0.0, 1.0, 1.0},   {1.1, 0.0, 1.0, 1.0}, {0.7, 0.0, 1.0, 1.0}, {1.0, 0.02, 1.0, 1.0},
        {1.0, -0.02, 1.0, 1.0}, {0.9, 0.0, 1.5, 1.0}, {1.1, 0.0, 0.7, 1.0}, {1.0, 0.0, 1.0, 3.0}};
    rotor.compensation_tolerance_rad = (wh_real)0.02;
    for (unsigned k = 0; k < 8; k++) {
        const bool slow = rpm[k] < 125.0;
        for (unsigned i = 0; i < 16; i += slow && i % 8U == 0 ? 7U : 1U) {
            const fed_kind *kind = &kinds[i % 8U];
            const rig_noise noise = {.cell_N = i < 8U ? 0.07 : 1.0, .jitter_s = 60e-6};
            feed(kind, rpm[k]);
            measure_many(&noise, few_or_all(3, 200), 600000U + 1000U * k + 100U * i);
            print_fed(kind, rpm[k], &noise);
            TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.0, bias(0));
            TEST_ASSERT_DOUBLE_WITHIN(1.0 / DEG, 0.0, bias(1));
            check_scatter(&noise);
            if (slow) { /* here the compensation is right, with one or three times the friction */
                TEST_ASSERT_DOUBLE_WITHIN(0.4 / DEG, 0.0, bias(1));
                TEST_ASSERT_TRUE(found.covered[1] >= found.runs * 9U / 10U);
                TEST_ASSERT_TRUE(found.covered[0] >= found.runs * 9U / 10U);
            }
        }
    }
}

/* The angle of the compensation has a normal error, and the configured tolerance is two standard deviations. The
 * interval must contain the truth as often as promised. */
TEST(lockin_truth, intervals_while_fed) {
    const rig_noise noise = {.cell_N = 1.0, .jitter_s = 60e-6};
    rotor.compensation_tolerance_rad = (wh_real)0.02;
    const unsigned runs = few_or_all(40, 1000);
    const fed_kind right = {1.0, 0.0, 1.0, 1.0};
    found = (tally){0};
    uint64_t seed = UINT64_C(0x5eed0fed);
    for (unsigned k = 0; k < runs; k++) {
        scattered_state = seed;
        fed_kind kind = right;
        kind.part = drawn(0.9, 1.1);
        kind.inertia = drawn(0.8, 1.2);
        kind.drag = drawn(1.0, 5.0);
        /* the sum of four uniform numbers is nearly normal */
        for (unsigned i = 0; i < 4; i++) {
            kind.late_rad += drawn(-0.0085, 0.0085);
        }
        seed = scattered_state;
        feed(&kind, 170.0);
        wh_measured measured;
        rig_measure(&orbit, &noise, &rotor, BEFORE, TURNS, 700000U + k, &measured);
        count_run(&measured);
    }
    print_fed(&right, 170.0, &noise);
    for (unsigned what = 0; what < 2; what++) {
        TEST_ASSERT_TRUE((double)found.covered[what] / runs >= (full() ? 0.93 : 0.85));
        check_below(4.0 * rms(what), median_half(what));
    }
}

/* Faults of the cell, at all speeds. A result of good quality must be right within its interval plus 1 %. Gain
 * errors below 5 % are exempt, because only a calibration can find them. Some results must be good. */
TEST(lockin_truth, no_fault_is_called_good) {
    static const rig_noise faults[] = {
        {.cell_N = 0.07, .frozen_s = 0.1},
        {.cell_N = 0.0, .frozen_s = 0.1},
        {.cell_N = 1.0, .frozen_s = 0.1},
        {.cell_N = 0.07, .frozen_s = 0.5},
        {.cell_N = 0.07, .mute = true, .hum_N = 5.0},
        {.cell_N = 0.07, .mute = true, .hum_N = 40.0},
        {.cell_N = 3.0, .mute = true},
        {.cell_N = 0.07, .gain_off = -2.0},
        {.cell_N = 0.07, .gain_off = -0.5},
        {.cell_N = 0.07, .gain_off = -0.07},
        {.cell_N = 0.07, .gain_off = 0.07},
        {.cell_N = 0.07, .gain_off = 1.0},
        {.cell_N = 0.07, .hum_N = 2.0},
        {.cell_N = 0.07, .hum_N = 20.0},
        {.cell_N = 0.07, .spikes = 0.002, .spike_N = 60.0},
        {.cell_N = 0.07, .spikes = 0.02, .spike_N = 60.0},
        {.cell_N = 0.07, .spikes = 0.2, .spike_N = 60.0},
        {.cell_N = 0.07, .turned_by = 0.03},
        {.cell_N = 0.07, .turned_by = -0.25},
        {.cell_N = 0.07, .turned_by = 0.5},
    };
    static const double rpm[] = {170.0, 330.0, 360.0};
    unsigned good = 0;
    unsigned doubtful = 0;
    const unsigned many = sizeof faults / sizeof faults[0];
    for (unsigned k = 0; k < 3; k++) {
        rig_orbit_find(&rig_plant_nominal, rpm[k], LEAD_RAD, &orbit);
        for (unsigned i = 0; i < many * few_or_all(2, 50); i++) {
            const rig_noise *noise = &faults[i % many];
            const wh_quality quality = check_no_lie(noise, 400000U + 1000U * k + i);
            good += quality == WH_GOOD ? 1U : 0U;
            doubtful += quality == WH_DOUBTFUL ? 1U : 0U;
        }
    }
    if (full()) {
        printf("%u faults of the cell: good %u, doubtful %u\n", 3U * many * few_or_all(2, 50), good,
               doubtful);
    }
    TEST_ASSERT_TRUE(good > 0 && doubtful > 0);
}

SUITE(lockin_truth) { rig_measure_config(&judged, &rotor, &cell); }
