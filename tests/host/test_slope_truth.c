/* test_slope_truth.c: the rig's measurement with noise, jitter, and motors whose torque slope differs from the
 * configured one. The reference is a rotor that is integrated finely in double (rig_orbit.c). Seeds are fixed.
 * WHIRL_FULL=1 (`make rig-truth`) does 200 runs of each kind and prints the loads. */
#include "command.h"
#include "rig_orbit.h"

#define LEAD_RAD (3.14159265358979323846 / 180.0)
#define BEFORE 14U
#define TURNS 7U

static wh_rotor_config rotor;
static rig_orbit orbit;

typedef struct tally {
    unsigned good;
    unsigned doubted;   /* results that are doubtful because of the speed ripple */
    unsigned lies;      /* good results with an error above the interval plus 1 % */
    unsigned prevented; /* doubtful results with an error above the interval plus 1 % */
    double said_rad;    /* sum of the reported loads */
    double phase_rad;   /* sum of the phase errors */
} tally;

static bool is_off(const wh_measured *measured) {
    const double amplitude_N = fabs((double)measured->amplitude_N - orbit.amplitude_N);
    const double phase_rad = fabs((double)measured->phase_rad - orbit.phase_rad);
    return amplitude_N > (double)measured->amplitude_half_N + 0.01 * orbit.amplitude_N ||
           phase_rad > (double)measured->phase_half_rad + 0.01;
}

static void turn(double rpm, double slope) {
    rig_plant plant = rig_plant_nominal;
    plant.line_Nms *= slope;
    rig_orbit_find(&plant, rpm, LEAD_RAD, &orbit);
}

static tally measure_many(double cell_N, unsigned runs, uint64_t seed) {
    const rig_noise noise = {.cell_N = cell_N, .jitter_s = 60e-6};
    tally found = {0};
    for (unsigned i = 0; i < runs; i++) {
        wh_measured measured;
        rig_measure(&orbit, &noise, &rotor, BEFORE, TURNS, seed + i, &measured);
        const bool off = is_off(&measured);
        found.good += measured.quality == WH_GOOD ? 1U : 0U;
        found.doubted += measured.why == WH_WHY_SWING ? 1U : 0U;
        found.lies += off && measured.quality == WH_GOOD ? 1U : 0U;
        found.prevented += off && measured.why == WH_WHY_SWING ? 1U : 0U;
        found.said_rad += (double)measured.ripple_off_rad / runs;
        found.phase_rad += ((double)measured.phase_rad - orbit.phase_rad) / runs;
    }
    return found;
}

/* With the cell's own noise, every good result must be right. With more noise, a 95 % interval misses some, whatever
 * the motor. The right slope must never cause a doubt. */
TEST(slope_truth, wrong_slopes) {
    static const double rpms[] = {170.0, 200.0, 260.0, 330.0};
    static const double slopes[] = {0.0, 0.3, 0.5, 0.8, 1.0, 1.3, 1.5};
    static const double cells_N[] = {0.07, 1.0, 3.0};
    const unsigned runs = few_or_all(2, 200);
    unsigned prevented = 0;
    for (unsigned i = 0; i < 4U * 7U * 3U; i++) {
        const double rpm = rpms[i / 21U];
        const double slope = slopes[i / 3U % 7U];
        const double cell_N = cells_N[i % 3U];
        if (i % 3U == 0) {
            turn(rpm, slope);
        }
        const tally found = measure_many(cell_N, runs, 800000U + 1000U * i);
        if (runs > 2U) {
            printf(
                "%.0f rpm, %.2f N, slope %.1f: the load says %.4f rad, phase off by %+.4f rad; of %u good %u, lies "
                "%u, doubted for it %u\n",
                rpm, cell_N, slope, found.said_rad, found.phase_rad, runs, found.good, found.lies,
                found.doubted);
        }
        TEST_ASSERT_TRUE(found.lies <= (cell_N > 0.5 ? 1U + runs / 50U : 0U));
        TEST_ASSERT_FALSE(i / 3U % 7U == 4U && found.doubted > 0);
        prevented += found.prevented;
    }
    TEST_ASSERT_TRUE(prevented > 10U);
}

SUITE(slope_truth) {
    wh_result_config unused;
    wh_cell_config unused_cell;
    rig_measure_config(&unused, &rotor, &unused_cell);
}
