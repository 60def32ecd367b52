/* test_lockin.c: the load's once-per-turn component, turn by turn, for imitated loads with known components.
 * tests/host/test_lockin_truth.c has a rotor with speed ripple as reference, and compares the intervals with noise. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/lockin.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"

#include "tests/suites.h"

#define PERIOD_TICKS UINT32_C(2000) /* an AVR's unsigned has 16 bits */
#define TURN_TICKS UINT32_C(181818) /* 330 rpm */
#define DEG WH_R(0.017453292519943295)
#define PI WH_R(3.141592653589793)

/* A rotor with constant speed, with the load mean + amplitude cos(order theta + phase). At the pulses of sensor 1,
 * theta is pulse_rad. Faults may be added. Samples and turns are counted from the start. */
typedef struct made_up {
    uint32_t first_ticks; /* time of the first sample */
    uint32_t late_ticks;  /* time from the first sample to the first pulse */
    unsigned order;
    wh_real mean_N;
    wh_real amplitude_N;
    wh_real phase_rad;
    wh_real third_N; /* amplitude of the third order */
    /* Number of the pulse that sensor 1, and that sensor 2, loses; 0: none. */
    unsigned lost_pulse[2];
    unsigned spoilt;       /* number of the first spoilt sample; 0: none */
    unsigned spoilt_count; /* number of spoilt samples */
    wh_real spoilt_N;      /* offset of the spoilt samples */
    wh_load_status status; /* status of the spoilt samples */
    bool frozen;           /* the spoilt samples repeat the first of them */
    unsigned slower_turn;  /* from this turn on, each turn takes a 40th longer */
    unsigned bumpy_turn;   /* from this turn on, each turn has a bump of 20 N, five samples wide */
} made_up;

static wh_rotor_config rotor;
static wh_cell_config cell;
static wh_lockin lockin;
#define TURNS_MOST 12U
static wh_lockin_turn turns[TURNS_MOST];
static unsigned turns_done;

static wh_real cosine_of(wh_real rad) { return wh_wave_of(rad).cosine; }

static void settings(void) {
    rotor = wh_rig_standard.measure.rotor;
    rotor.gravity_mps2 = WH_R(0.0);
    rotor.pulse_rad[0] = WH_R(0.0);
    rotor.pulse_rad[1] = WH_R(0.5) * PI;
    cell = (wh_cell_config){
        .newton_per_count = WH_R(0.01), .period_ticks = PERIOD_TICKS, .raw_max = INT32_C(32767)};
}

static uint32_t turn_ticks_of(const made_up *made, unsigned turn) {
    return TURN_TICKS + (made->slower_turn > 0 && turn >= made->slower_turn
                             ? (turn - made->slower_turn + 1U) * (TURN_TICKS / 40U)
                             : 0U);
}

static wh_real load_of(const made_up *made, wh_real part) {
    const wh_real theta = rotor.pulse_rad[0] + WH_RIG_TWO_PI * part;
    return made->mean_N +
           made->amplitude_N * cosine_of((wh_real)made->order * theta + made->phase_rad) +
           made->third_N * cosine_of(WH_R(3.0) * theta);
}

/* Checks that a control step does at most one piece of the work. */
static void check_one_piece(wh_lockin_stage stage) {
    const wh_lockin_stage now = lockin.stage;
    const bool sums = stage == WH_LOCKIN_BEGINS || stage == WH_LOCKIN_SUMS;
    TEST_ASSERT_TRUE(stage == WH_LOCKIN_WAITS  ? now == stage
                     : stage == WH_LOCKIN_ENDS ? now == WH_LOCKIN_WAITS
                     : sums                    ? now >= stage && now <= WH_LOCKIN_ENDS
                                               : now == stage + 1);
    TEST_ASSERT_TRUE(stage != WH_LOCKIN_RESHAPES || lockin.place == WH_LOCKIN_NOWHERE);
}

/* Runs until `wanted` turns are finished, but at most three turns longer. */
static void run(const made_up *made, unsigned wanted) {
    lockin = (wh_lockin){0};
    wh_lockin_forget(&rotor, &lockin);
    turns_done = 0;
    unsigned turn = 0;                       /* number of the pulse that ends the present turn */
    unsigned second = 0;                     /* number of sensor 2's next pulse */
    uint32_t pulse_ticks = made->late_ticks; /* time of pulse `turn`, from the first sample on */
    uint32_t before = pulse_ticks - TURN_TICKS;
    wh_real kept_N = WH_R(0.0);
    for (uint32_t i = 0; turn < wanted + 4U && turns_done < TURNS_MOST; i++) {
        const uint32_t now = i * PERIOD_TICKS;
        const uint32_t second_ticks = before + (pulse_ticks - before) / 4U;
        if (turn > 0 && second < turn && (int32_t)(now - second_ticks) >= 0) {
            if (turn != made->lost_pulse[1]) {
                wh_lockin_pulse(&lockin, 1, made->first_ticks + second_ticks,
                                UINT32_MAX - 16U + 4U * turn + 1U);
            }
            second = turn;
        }
        if ((int32_t)(now - pulse_ticks) >= 0) {
            turn++;
            if (turn != made->lost_pulse[0] || turn == 0) {
                wh_lockin_pulse(&lockin, 0, made->first_ticks + pulse_ticks,
                                UINT32_MAX - 16U + 4U * turn);
            }
            before = pulse_ticks;
            pulse_ticks += turn_ticks_of(made, turn);
        }
        const wh_real part = (wh_real)(int32_t)(now - before) / (wh_real)(pulse_ticks - before);
        wh_real force_N = load_of(made, part);
        wh_load load = {.ticks = made->first_ticks + now, .status = WH_LOAD_OK};
        const bool spoilt = made->spoilt > 0 && i >= made->spoilt &&
                            i < (uint32_t)made->spoilt + made->spoilt_count;
        if (spoilt) {
            force_N += made->spoilt_N;
            kept_N = i == made->spoilt ? force_N : kept_N;
            force_N = made->frozen ? kept_N : force_N;
            load.status = made->status;
        }
        if (made->bumpy_turn > 0 && turn >= made->bumpy_turn && part > WH_R(0.6) &&
            part < WH_R(0.655)) {
            force_N += WH_R(20.0);
        }
        load.force_N = force_N;
        wh_lockin_load(&lockin, &load);
        const wh_lockin_stage stage = lockin.stage;
        const bool done = wh_lockin_work(&rotor, &cell, &lockin, WH_LOCKIN_HALVES_AT_ONCE);
        check_one_piece(stage);
        if (done) {
            turns[turns_done++] = lockin.turn;
        }
    }
}

/* Checks a turn: amplitude within 0.01 %, phase within 0.01 degrees. */
static void check_turn(const wh_lockin_turn *turn, const made_up *made) {
    wh_real amplitude;
    wh_real phase;
    wh_polar(turn->force_N.at[1], -turn->force_N.at[2], &amplitude, &phase);
    CHECK_NEAR(1e-4f * (float)made->amplitude_N, made->amplitude_N, amplitude);
    CHECK_NEAR(0.01f, made->phase_rad / DEG, phase / DEG);
    CHECK_NEAR(0.01f, made->mean_N, turn->force_N.at[0]);
    CHECK_NEAR(0.01f, made->mean_N, turn->mean_N);
}

/* All turns count except turn 1, which has no turn before it. */
static void check_all(const made_up *made, unsigned wanted) {
    TEST_ASSERT_TRUE(turns_done >= wanted);
    for (unsigned i = 0; i < turns_done; i++) {
        const wh_turn_fault fault = i == 0 ? WH_TURN_UNSTEADY : i == 1 ? WH_TURN_FIRST : WH_TURN_OK;
        TEST_ASSERT_EQUAL_INT(fault, turns[i].fault);
        TEST_ASSERT_EQUAL_UINT32(TURN_TICKS, turns[i].turn_ticks);
        if (i >= 2) {
            check_turn(&turns[i], made);
        }
    }
}

static const made_up plain = {
    .late_ticks = 77, .order = 1, .mean_N = WH_R(80.0), .amplitude_N = WH_R(60.0)};

TEST(lockin, known_phase_and_amplitude_are_found) {
    static const wh_real degrees[] = {WH_R(0.0), WH_R(30.0), WH_R(-30.0), WH_R(90.0), WH_R(170.0)};
    settings();
    for (unsigned i = 0; i < 5U * 4U; i++) {
        made_up made = plain;
        made.phase_rad = degrees[i % 5U] * DEG;
        made.late_ticks = 77U + (i / 5U) * 600U; /* the turn begins between two samples */
        /* the timer wraps within a turn */
        made.first_ticks = i % 2U == 0 ? 0U : UINT32_MAX - 600000U;
        run(&made, 6);
        check_all(&made, 6);
        CHECK_NEAR(0.01f, 0.0f, turns[5].residual_N);
        TEST_ASSERT_TRUE(turns[5].samples >= 90U && turns[5].samples <= 91U);
        /* the load at the sensors, interpolated linearly between two samples */
        for (unsigned sensor = 0; sensor < 2; sensor++) {
            const wh_real at = load_of(&made, (wh_real)sensor * WH_R(0.25));
            CHECK_NEAR(0.05f, at, turns[5].at_pulse_N[sensor]);
        }
    }
}

/* A pulse 5 degrees before the sensor: angles are counted from the arms' position at the pulse. */
TEST(lockin, angle_of_the_pulse_counts) {
    settings();
    made_up made = plain;
    made.phase_rad = WH_R(30.0) * DEG;
    rotor.pulse_rad[0] -= WH_R(5.0) * DEG;
    rotor.pulse_rad[1] -= WH_R(5.0) * DEG;
    run(&made, 6);
    check_all(&made, 6);
}

TEST(lockin, harmonics_do_not_affect_the_result) {
    settings();
    for (unsigned order = 0; order <= 5; order++) {
        if (order == 1) {
            continue;
        }
        made_up made = plain;
        made.order = order;
        made.phase_rad = WH_R(0.7);
        run(&made, 6);
        for (unsigned i = 2; i < turns_done; i++) {
            CHECK_NEAR(0.06f, 0.0f, turns[i].force_N.at[1]); /* 0.1 % */
            CHECK_NEAR(0.06f, 0.0f, turns[i].force_N.at[2]);
            /* Orders 0 to 2 are not part of the residual; the higher orders are. */
            CHECK_NEAR(order > 2 ? 0.3f : 0.05f, order > 2 ? 43.65f : 0.0f,
                       turns[i].residual_N); /* 60/sqrt(2) sqrt(91/86) */
        }
    }
}

/* After a lost pulse of sensor 1, the two turns between the neighbouring pulses are skipped. After a lost pulse of
 * sensor 2, only the load at sensor 2 is wrong. */
TEST(lockin, lost_pulses_affect_neighbouring_turns_only) {
    settings();
    for (unsigned sensor = 0; sensor < 2; sensor++) {
        made_up made = plain;
        made.phase_rad = WH_R(30.0) * DEG;
        made.lost_pulse[sensor] = 5;
        run(&made, 8);
        check_all(&made, 6);
        TEST_ASSERT_EQUAL_UINT32(sensor == 0 ? 2U : 0U, lockin.skipped);
        unsigned unseen = 0;
        for (unsigned i = 0; i < turns_done; i++) {
            unseen += turns[i].second_seen ? 0U : 1U;
        }
        TEST_ASSERT_EQUAL_UINT(sensor, unseen);
    }
}

TEST(lockin, a_gap_costs_one_turn) {
    settings();
    run(&plain, 3);
    const uint32_t skipped = lockin.skipped;
    wh_lockin_gap(&lockin);
    wh_lockin_gap(&lockin);
    TEST_ASSERT_EQUAL_UINT32(skipped + 1U, lockin.skipped);
    TEST_ASSERT_FALSE(lockin.open);
    wh_lockin_pulse(&lockin, 1, 1000, 77);
    TEST_ASSERT_FALSE(lockin.second_seen);
    wh_lockin_pulse(&lockin, 0, 2000, 80);
    TEST_ASSERT_TRUE(lockin.open && !lockin.second_seen && lockin.begin_ticks == 2000U);
}

/* Two missing samples are bridged. With three, the turn has no result. */
TEST(lockin, missing_samples) {
    settings();
    for (unsigned missing = 1; missing <= 5; missing++) {
        made_up made = plain;
        made.phase_rad = WH_R(30.0) * DEG;
        made.spoilt = 91U * 5U + 30U;
        made.spoilt_count = missing;
        made.status = WH_LOAD_DISCONNECTED;
        run(&made, 8);
        TEST_ASSERT_EQUAL_UINT32(missing, lockin.refused);
        const bool gap = missing > 2U;
        unsigned counted = 0;
        for (unsigned i = 2; i < turns_done; i++) {
            counted += turns[i].fault == WH_TURN_OK ? 1U : 0U;
            if (turns[i].fault == WH_TURN_OK) {
                check_turn(&turns[i], &made);
            }
        }
        TEST_ASSERT_EQUAL_UINT(turns_done - (gap ? 3U : 2U), counted);
        TEST_ASSERT_EQUAL_INT(gap ? WH_TURN_GAP : WH_TURN_OK, turns[5].fault);
    }
}

/* Outliers are counted but not used. A turn has 91 samples. Eight successive outliers leave a gap; nine, a tenth of
 * the samples, are too many. */
TEST(lockin, outliers_are_not_used) {
    static const unsigned counts[] = {1, 8, 9, 14};
    settings();
    for (unsigned k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        const unsigned many = counts[k];
        made_up made = plain;
        made.phase_rad = WH_R(30.0) * DEG;
        made.spoilt = 91U * 5U + 30U;
        made.spoilt_count = many;
        made.spoilt_N = WH_R(-20.0);
        run(&made, 8);
        TEST_ASSERT_EQUAL_UINT(many, turns[5].outliers);
        TEST_ASSERT_EQUAL_INT(many > 8   ? WH_TURN_OUTLIERS
                              : many > 1 ? WH_TURN_GAP
                                         : WH_TURN_OK,
                              turns[5].fault);
        TEST_ASSERT_TRUE(turns[4].outliers == 0 && turns[6].outliers == 0);
        for (unsigned i = 2; i < turns_done; i++) {
            if (turns[i].fault == WH_TURN_OK) {
                check_turn(&turns[i], &made);
            }
        }
    }
}

/* From turn 5 on, the load has a bump in each turn. The first of these turns does not count, because the bump's
 * samples are outliers and leave a gap. The next turn is the first one of a new prediction. */
TEST(lockin, lasting_bumps_are_predicted) {
    settings();
    made_up made = plain;
    made.bumpy_turn = 5;
    run(&made, 10);
    TEST_ASSERT_TRUE(turns_done >= 10U);
    for (unsigned i = 2; i < turns_done; i++) {
        const wh_turn_fault fault = i == 4U ? WH_TURN_GAP : i == 5U ? WH_TURN_FIRST : WH_TURN_OK;
        TEST_ASSERT_EQUAL_INT(fault, turns[i].fault);
        TEST_ASSERT_EQUAL_UINT(i == 4U ? 5U : 0U, turns[i].outliers);
    }
}

/* Nine equal samples in succession cannot come from a turning rotor. */
TEST(lockin, a_frozen_load_does_not_count) {
    settings();
    for (unsigned held = 6; held <= 12; held += 3) {
        made_up made = plain;
        made.mean_N = WH_R(0.0);
        made.spoilt = 91U * 5U + 88U; /* near the peak, where the load changes least */
        made.spoilt_count = held;
        made.frozen = true;
        run(&made, 8);
        unsigned frozen = 0;
        for (unsigned i = 0; i < turns_done; i++) {
            frozen += turns[i].fault == WH_TURN_FROZEN ? 1U : 0U;
        }
        TEST_ASSERT_TRUE(held < 9U ? frozen == 0 : frozen >= 1U);
    }
}

TEST(lockin, a_speed_that_changes_does_not_count) {
    settings();
    made_up made = plain;
    made.slower_turn = 5;
    run(&made, 8);
    for (unsigned i = 2; i < turns_done; i++) {
        TEST_ASSERT_TRUE((turns[i].fault == WH_TURN_OK) == (turns[i].turn_ticks == TURN_TICKS));
    }
}

TEST(lockin, samples_out_of_order_are_refused) {
    settings();
    lockin = (wh_lockin){0};
    wh_lockin_forget(&rotor, &lockin);
    wh_load load = {.ticks = 5000, .force_N = WH_R(1.0), .status = WH_LOAD_OK};
    wh_lockin_load(&lockin, &load);
    wh_lockin_load(&lockin, &load);
    load.ticks = 4000;
    wh_lockin_load(&lockin, &load);
    load.ticks = 6000;
    for (wh_load_status status = WH_LOAD_SATURATED; status < WH_LOAD_STATUSES; status++) {
        load.status = status;
        wh_lockin_load(&lockin, &load);
    }
    TEST_ASSERT_EQUAL_UINT32(6, lockin.refused);
    TEST_ASSERT_TRUE(lockin.taken && lockin.taken_ticks == 5000U && lockin.count == 0);
}

/* If a pulse never comes, the newest samples wait, and none is stored outside the buffer. */
TEST(lockin, samples_stay_in_their_room) {
    settings();
    lockin = (wh_lockin){0};
    wh_lockin_forget(&rotor, &lockin);
    wh_lockin_pulse(&lockin, 0, 0, 0);
    for (uint32_t i = 1; i <= 3U * WH_LOCKIN_SAMPLES + 7U; i++) {
        const wh_load load = {.ticks = i * PERIOD_TICKS, .force_N = (wh_real)i};
        wh_lockin_load(&lockin, &load);
        TEST_ASSERT_TRUE(lockin.first < WH_LOCKIN_SAMPLES && lockin.count <= WH_LOCKIN_SAMPLES);
        TEST_ASSERT_FALSE(wh_lockin_work(&rotor, &cell, &lockin, WH_LOCKIN_HALVES_AT_ONCE));
    }
    TEST_ASSERT_EQUAL_UINT(WH_LOCKIN_SAMPLES, lockin.count);
    TEST_ASSERT_EQUAL_UINT32((2U * WH_LOCKIN_SAMPLES + 7U) * PERIOD_TICKS, lockin.taken_ticks);
    TEST_ASSERT_EQUAL_UINT32((2U * WH_LOCKIN_SAMPLES + 8U) * PERIOD_TICKS,
                             lockin.ticks[lockin.first]);
}

/* The angle begins at the pulse's angle and ends one turn later. The quadrature ratio alone corrects an inertia that is
 * wrong by up to 40 %, for any direction of gravity except the diagonal: there the ratio does not depend on the
 * inertia. */
TEST(lockin, the_inertia_is_found_from_the_split) {
    static const wh_real gravities[] = {WH_R(0.0), WH_R(90.0), WH_R(180.0), WH_R(-90.0)};
    static const wh_real rpm[] = {WH_R(170.0), WH_R(330.0), WH_R(360.0)};
    for (unsigned k = 0; k < 4U * 3U * 2U; k++) {
        if (k % 12U == 2U) { /* with gravity upwards at 170 rpm, two inertias have the same ratio */
            continue;
        }
        settings();
        rotor.gravity_mps2 = WH_RIG_GRAVITY_MPS2;
        rotor.gravity_rad = gravities[k % 4U] * DEG;
        rotor.pulse_rad[0] = -DEG;
        rotor.pulse_rad[1] = WH_R(89.0) * DEG;
        const wh_real speed = rpm[k / 4U % 3U] * WH_RIG_RADPS_PER_RPM;
        wh_turn_angle wanted;
        wh_turn_angle_start(&rotor, &wanted);
        wh_turn_angle_shape(&rotor, &wanted, speed);
        wh_turn_angle_shape(&rotor, &wanted, speed);
        CHECK_NEAR(1e-6f, rotor.pulse_rad[0], wh_turn_angle_at(&wanted, WH_R(0.0)));
        CHECK_NEAR(3e-6f, rotor.pulse_rad[0] + WH_RIG_TWO_PI, wh_turn_angle_at(&wanted, WH_R(1.0)));
        /* Part of the turn's time before sensor 2's angle. */
        wh_real ratio = WH_R(0.25);
        for (unsigned i = 0; i < 30; i++) {
            ratio -= (wh_turn_angle_at(&wanted, ratio) - rotor.pulse_rad[1]) / WH_RIG_TWO_PI;
        }
        wh_rotor_config said = rotor;
        said.inertia_kgm2 *= k < 12U ? WH_R(0.6) : WH_R(1.4);
        wh_turn_angle found;
        wh_turn_angle_start(&said, &found);
        for (unsigned i = 0; i < 8; i++) {
            wh_turn_angle_shape(&said, &found, speed);
            wh_turn_angle_by_ratio(&said, &found, ratio);
        }
        CHECK_NEAR(2e-4f, 1.0f, found.inertia_kgm2 / rotor.inertia_kgm2);
        wh_turn_angle_shape(&said, &found, speed);
        for (unsigned i = 0; i <= 16; i++) {
            const wh_real part = (wh_real)i / WH_R(16.0);
            CHECK_NEAR(5e-5f, wh_turn_angle_at(&wanted, part), wh_turn_angle_at(&found, part));
        }
    }
}

/* Without gravity in the arms' plane there is no ripple, and the quadrature ratio does not depend on the inertia. */
TEST(lockin, level_arms_turn_evenly) {
    settings();
    wh_turn_angle angle;
    wh_turn_angle_start(&rotor, &angle);
    wh_turn_angle_shape(&rotor, &angle, WH_R(30.0));
    CHECK_NEAR(1e-4f, 0.1f,
               wh_turn_angle_by_ratio(&rotor, &angle, WH_R(0.25) - WH_R(0.1) / WH_RIG_TWO_PI));
    TEST_ASSERT_TRUE(angle.inertia_kgm2 == rotor.inertia_kgm2 && angle.ratios == 0);
    for (unsigned i = 0; i <= 8; i++) {
        CHECK_NEAR(1e-6f, 6.2831853f * (float)i / 8.0f,
                   wh_turn_angle_at(&angle, (wh_real)i / WH_R(8.0)));
    }
}
