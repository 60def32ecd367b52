/* test_rig_slope.c: the second order of the load shows a motor's torque slope that differs from the configured one.
 * Rotors with random slopes are integrated over their angle. A lock-in with the configured slope measures them. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"
#include "draw.h"

#include "tests/suites.h"

#define STEPS 512U /* angle steps per turn */
#define PERIOD_TICKS 2000U
#define BEFORE 14U /* turns until the inertia is found */
#define TURNS 8U
#define DEG (WH_R(1.0) / WH_RIG_DEG_PER_RAD)

static uint64_t seed;
static wh_rotor_config rotor; /* the measurement's settings */
static wh_lockin lockin;
static wh_measured measured;

static wh_real drawn_between(wh_real least, wh_real most) {
    return least + (most - least) * draw_whole(&seed, 0, 65535) / WH_R(65535.0);
}

typedef struct plant {
    wh_real speed_radps; /* deviation of the speed from its mean */
    wh_real inertia_kgm2;
    wh_real slope_Nms;
    wh_real gravity_rad;
    uint32_t late_ticks; /* delay of the samples that their time stamps do not include */
    wh_real gain;        /* gain of the cell */
} plant;

/* The steady turn: values at STEPS equal angles, beginning at sensor 1's pulse. */
static wh_real part_at[STEPS + 1U]; /* part of the turn's time */
static wh_real force_N[STEPS + 1U];
static wh_real turn_s;
static wh_real along_rad;  /* sine part of the angle's ripple over time */
static wh_real across_rad; /* cosine part of the same ripple */
/* Unbalance times mean square of the speed: the load's first order over the angle, in line with the masses. */
static wh_real truth_N;

static wh_real acceleration(const plant *p, wh_real theta, wh_real speed) {
    const wh_real weight_Nm = rotor.unbalance_kgm * rotor.gravity_mps2;
    return (p->slope_Nms * (p->speed_radps - speed) -
            weight_Nm * wh_wave_of(theta - p->gravity_rad).sine) /
           p->inertia_kgm2;
}

static wh_real bend(const plant *p, wh_real theta, wh_real speed) {
    return acceleration(p, theta, speed) / speed;
}

/* Returns the speed at the end of a turn that begins with `speed`. */
static wh_real turn(const plant *p, wh_real speed) {
    const wh_real h = WH_RIG_TWO_PI / (wh_real)STEPS;
    const wh_real from = rotor.pulse_rad[0];
    wh_real time = WH_R(0.0);
    truth_N = WH_R(0.0);
    for (unsigned i = 0; i <= STEPS; i++) {
        const wh_real theta = from + h * (wh_real)i;
        const wh_wave at = wh_wave_of(theta);
        part_at[i] = time;
        force_N[i] = rotor.unbalance_kgm *
                     (speed * speed * at.cosine + acceleration(p, theta, speed) * at.sine);
        if (i == STEPS) {
            break;
        }
        truth_N += rotor.unbalance_kgm * speed * speed / (wh_real)STEPS;
        const wh_real half = WH_R(0.5) * h;
        const wh_real k1 = bend(p, theta, speed);
        const wh_real k2 = bend(p, theta + half, speed + half * k1);
        const wh_real k3 = bend(p, theta + half, speed + half * k2);
        const wh_real k4 = bend(p, theta + h, speed + h * k3);
        const wh_real next = speed + h / WH_R(6.0) * (k1 + WH_R(2.0) * (k2 + k3) + k4);
        const wh_real middle = WH_R(0.5) * (speed + next) +
                               h / WH_R(8.0) * (k1 - bend(p, theta + h, next)); /* Hermite cubic */
        time += h / WH_R(6.0) * (WH_R(1.0) / speed + WH_R(4.0) / middle + WH_R(1.0) / next);
        speed = next;
    }
    turn_s = time;
    return speed;
}

/* Finds the periodic turn by secants; then the ripple of its angle over time. */
static void integrate(const plant *p) {
    wh_real speed = p->speed_radps;
    for (unsigned round = 0; round < 6U; round++) {
        const wh_real off = turn(p, speed) - speed;
        const wh_real more = speed * WH_R(1.01);
        const wh_real slope = (turn(p, more) - more - off) / (more - speed);
        speed -= off / slope;
    }
    TEST_ASSERT_TRUE(WH_ABS(turn(p, speed) - speed) < WH_R(3e-5) * speed);
    for (unsigned i = 0; i < STEPS; i++) {
        part_at[i] /= turn_s;
    }
    part_at[STEPS] = WH_R(1.0);
    /* integrates by the trapezoidal rule; `base` makes the mean of the ripple zero */
    wh_real base = WH_R(0.0);
    const wh_real from = rotor.pulse_rad[0];
    for (unsigned pass = 0; pass < 2U; pass++) {
        wh_real sum[3] = {WH_R(0.0), WH_R(0.0), WH_R(0.0)};
        for (unsigned i = 0; i < STEPS; i++) {
            const wh_real before = i == 0 ? part_at[STEPS - 1U] - WH_R(1.0) : part_at[i - 1U];
            const wh_real weight = WH_R(0.5) * (part_at[i + 1U] - before);
            const wh_real even = base + WH_RIG_TWO_PI * part_at[i];
            const wh_real rest = from + WH_RIG_TWO_PI / (wh_real)STEPS * (wh_real)i - even;
            const wh_wave at = wh_wave_of(even);
            sum[0] += weight * rest;
            sum[1] += WH_R(2.0) * weight * rest * at.sine;
            sum[2] += WH_R(2.0) * weight * rest * at.cosine;
        }
        base += sum[0];
        along_rad = sum[1];
        across_rad = sum[2];
    }
}

static wh_real force_at(wh_real part) {
    unsigned low = 0;
    unsigned high = STEPS;
    while (high - low > 1U) {
        const unsigned middle = (low + high) / 2U;
        if (part_at[middle] <= part) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const wh_real way = (part - part_at[low]) / (part_at[low + 1U] - part_at[low]);
    return force_N[low] + way * (force_N[low + 1U] - force_N[low]);
}

static void measure(const plant *p) {
    wh_result_config calibrated = wh_rig_standard.measure.result;
    calibrated.amplitude_floor = WH_R(1e-4);
    calibrated.phase_floor_rad = WH_R(0.01) * DEG;
    const wh_result_config *config = &calibrated;
    const wh_cell_config cell = {
        .newton_per_count = WH_R(0.01), .period_ticks = PERIOD_TICKS, .raw_max = INT32_C(32767)};
    const uint32_t turn_ticks = (uint32_t)(turn_s * (wh_real)WH_RIG_TICKS_PER_S);
    const uint32_t second_ticks = (uint32_t)(part_at[STEPS / 4U] * (wh_real)turn_ticks);
    const uint32_t begin = (uint32_t)draw_bits(&seed) * 2U; /* begin of the first turn */
    wh_merge merge = {.turns = 0};
    uint32_t due = 0; /* ticks from `begin` to the next pulse */
    uint32_t pulses = 0;
    unsigned done = 0;
    lockin = (wh_lockin){0};
    wh_lockin_forget(&rotor, &lockin);
    for (uint32_t now = 777U; done < BEFORE + TURNS; now += PERIOD_TICKS) {
        while (due <= now) {
            wh_lockin_pulse(&lockin, pulses % 2U, begin + due, pulses / 2U * 4U + pulses % 2U);
            pulses++;
            due = pulses / 2U * turn_ticks + (pulses % 2U) * second_ticks;
        }
        const uint32_t then = (now + turn_ticks - p->late_ticks) % turn_ticks;
        const wh_load load = {.ticks = begin + now,
                              .force_N = WH_R(56.0) +
                                         p->gain * force_at((wh_real)then / (wh_real)turn_ticks),
                              .status = WH_LOAD_OK};
        wh_lockin_load(&lockin, &load);
        if (wh_lockin_work(&rotor, &cell, &lockin, WH_LOCKIN_HALVES_AT_ONCE) && ++done > BEFORE) {
            wh_merge_add(config, &rotor, &merge, &lockin.turn, &lockin.angle);
        }
        TEST_ASSERT_TRUE(now < 60U * turn_ticks);
    }
    for (unsigned i = 0; i < WH_MERGE_MEAN_PIECES; i++) {
        wh_merge_mean_piece(config, &rotor, &merge, &lockin.angle, WH_R(56.0), &measured, i);
    }
    wh_merge_compare(&rotor, &merge, &lockin.angle, &measured);
    wh_merge_judge(config, &rotor, &merge, &lockin.angle, &measured);
    TEST_ASSERT_EQUAL_UINT32(TURNS, measured.turns);
}

static void believe(wh_real gravity, wh_real gravity_rad) {
    rotor = wh_rig_standard.measure.rotor;
    rotor.gravity_mps2 *= gravity;
    rotor.pulse_rad[0] = -DEG;
    rotor.pulse_rad[1] = WH_R(0.25) * WH_RIG_TWO_PI - DEG;
    rotor.gravity_rad = gravity_rad;
}

/* Draws a speed from 165 to 360 rpm, and an arms' plane that is upright or inclined, with `line` times the configured
 * slope. */
static plant draw_plant(wh_real line) {
    believe(draw_one_in(&seed, 2) ? WH_R(1.0) : drawn_between(WH_R(0.5), WH_R(1.0)),
            drawn_between(WH_R(-0.05), WH_R(0.05)));
    return (plant){.speed_radps = draw_one_in(&seed, 3) ? drawn_between(WH_R(24.0), WH_R(38.0))
                                                        : drawn_between(WH_R(18.0), WH_R(24.0)),
                   .inertia_kgm2 = rotor.inertia_kgm2 * drawn_between(WH_R(0.85), WH_R(1.4)),
                   .slope_Nms = rotor.damping_Nms * line,
                   .gravity_rad = rotor.gravity_rad,
                   .gain = WH_R(1.0)};
}

/* Returns the size of the difference between the lock-in's ripple and the rotor's, as vectors. */
static wh_real arrow_off(void) {
    const wh_wave lag = wh_wave_of(lockin.angle.lag_rad - rotor.gravity_rad);
    const wh_real along = lockin.angle.ripple_rad * lag.cosine - along_rad;
    const wh_real across = lockin.angle.ripple_rad * lag.sine - across_rad;
    return WH_SQRT(along * along + across * across);
}

/* The rotor's slope is 0.2 to 1.6 times the configured one. The ripple found from the second order is that of the
 * integrated rotor, except for terms of third order, which the model of the angle omits. Good results are right. With
 * the right slope no result is doubtful. */
TEST(rig_slope, wrong_slope_is_detected) {
    unsigned good = 0;
    unsigned doubted = 0;
    unsigned would_lie = 0;
    seed = 51;
    for (unsigned run = 0; run < 60U; run++) {
        const bool right = run % 4U == 0;
        const plant p = draw_plant(right ? drawn_between(WH_R(0.95), WH_R(1.05))
                                         : drawn_between(WH_R(0.2), WH_R(1.6)));
        integrate(&p);
        measure(&p);
        const wh_real swing = lockin.angle.ripple_rad;
        const wh_real differ = arrow_off();
        TEST_ASSERT_TRUE(WH_ABS(measured.ripple_off_rad - differ) <
                         WH_R(1e-3) + WH_R(0.08) * differ + WH_R(0.6) * swing * swing * swing);
        const wh_real amplitude_off =
            WH_ABS(measured.amplitude_N - truth_N) / truth_N - measured.amplitude_half_N / truth_N;
        const wh_real phase_off = WH_ABS(measured.phase_rad) - measured.phase_half_rad;
        const bool lies = amplitude_off > WH_R(0.01) || phase_off > WH_R(0.01);
        TEST_ASSERT_TRUE(!lies || measured.quality != WH_GOOD);
        TEST_ASSERT_TRUE(!right || measured.why == WH_WHY_NONE);
        good += measured.quality == WH_GOOD ? 1U : 0U;
        doubted += measured.why == WH_WHY_SWING ? 1U : 0U;
        would_lie += lies && measured.why == WH_WHY_SWING ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(good >= 15U && doubted >= 8U && would_lie >= 4U);
}

/* A delay, or a wrong gain of the cell, neither looks like a wrong slope nor hides one. */
TEST(rig_slope, calibration_does_not_matter) {
    seed = 52;
    for (unsigned run = 0; run < 16U; run++) {
        plant p = draw_plant(run % 2U == 0 ? WH_R(1.0) : WH_R(0.5));
        integrate(&p);
        measure(&p);
        const wh_real before = measured.ripple_off_rad;
        const wh_real phase_rad = measured.phase_rad;
        const wh_real swing = lockin.angle.ripple_rad;
        p.late_ticks = (uint32_t)draw_whole(&seed, 0, 1800);
        p.gain = drawn_between(WH_R(0.97), WH_R(1.03));
        measure(&p);
        const wh_real late_rad =
            WH_RIG_TWO_PI * (wh_real)p.late_ticks / (wh_real)WH_RIG_TICKS_PER_S / turn_s;
        CHECK_NEAR(1e-3f + 0.06f * (float)late_rad, -late_rad, measured.phase_rad - phase_rad);
        /* If the rotor's speed ripples, a delay changes the angle by a varying amount. Half of this variation shows. */
        const wh_real shows = WH_R(0.35) * swing * late_rad + WH_R(3e-4);
        CHECK_NEAR(shows, before, measured.ripple_off_rad);
    }
}

/* If the arms turn in a level plane, there is no ripple to compare. */
TEST(rig_slope, level_plane_has_no_check) {
    seed = 53;
    for (unsigned run = 0; run < 4U; run++) {
        plant p = draw_plant(drawn_between(WH_R(0.3), WH_R(1.5)));
        rotor.gravity_mps2 = WH_R(0.0);
        integrate(&p);
        measure(&p);
        TEST_ASSERT_TRUE(measured.why == WH_WHY_NONE);
        CHECK_NEAR(0.0f, 0.0f, measured.ripple_off_rad);
    }
}
