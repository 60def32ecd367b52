/* test_rig_turn_angle.c: the derivatives of the angle within a turn with respect to the turn's measurements; the
 * intervals are computed from them. The reference is difference quotients between rotors whose inertia, or
 * uncompensated part of gravity, is found by bisection. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "draw.h"

#include "tests/suites.h"

#define LITTLE_RAD WH_R(0.004)

static uint64_t seed;

/* A turn: the nominal rotor, its speed, and its inertia or uncompensated part of gravity. */
typedef struct turn {
    wh_rotor_config rotor;
    wh_real speed_radps;
    bool compensated;
} turn;

static wh_turn_angle shaped(const turn *of, wh_real found) {
    wh_turn_angle angle;
    wh_turn_angle_start(&of->rotor, &angle);
    wh_turn_angle_compensate(&angle, of->compensated, WH_R(0.0625));
    angle.drive_V = of->rotor.damping_Nms * of->speed_radps / WH_R(0.0625);
    if (of->compensated) {
        angle.part = found;
    } else {
        angle.inertia_kgm2 = found;
    }
    for (unsigned i = 0; i < 3U; i++) {
        wh_turn_angle_shape(&of->rotor, &angle, of->speed_radps);
    }
    return angle;
}

/* Returns the rotor's angle minus that of sensor 2, after the part `ratio` of the turn's time. */
static wh_real beyond(const turn *of, wh_real found, wh_real ratio) {
    const wh_turn_angle angle = shaped(of, found);
    return wh_turn_angle_at(&angle, ratio) - of->rotor.pulse_rad[1];
}

/* Returns base_rad of the turn in which sensor 2's pulse comes after the part `ratio` of the turn's time. Bisection,
 * near `about`, finds the turn's inertia or uncompensated part of gravity. */
static wh_real base_at(const turn *of, wh_real about, wh_real ratio) {
    wh_real low = about - WH_R(0.5) * (of->compensated ? WH_R(1.0) : about);
    wh_real high = about + WH_R(0.5) * (of->compensated ? WH_R(1.0) : about);
    const bool rises = beyond(of, high, ratio) > beyond(of, low, ratio);
    for (unsigned i = 0; i < 30U; i++) {
        const wh_real middle = WH_R(0.5) * (low + high);
        if ((beyond(of, middle, ratio) > WH_R(0.0)) == rises) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return shaped(of, WH_R(0.5) * (low + high)).base_rad;
}

static wh_real by_pulse(const turn *of, wh_real about, wh_real ratio) {
    turn more = *of;
    turn less = *of;
    more.rotor.pulse_rad[1] += LITTLE_RAD;
    less.rotor.pulse_rad[1] -= LITTLE_RAD;
    return (base_at(&more, about, ratio) - base_at(&less, about, ratio)) / (WH_R(2.0) * LITTLE_RAD);
}

/* Returns the derivative of base_rad with respect to the lag psi, which acts like another direction of gravity. */
static wh_real by_lag(const turn *of, wh_real about, wh_real ratio) {
    turn more = *of;
    turn less = *of;
    more.rotor.gravity_rad -= WH_R(4.0) * LITTLE_RAD;
    less.rotor.gravity_rad += WH_R(4.0) * LITTLE_RAD;
    return (base_at(&more, about, ratio) - base_at(&less, about, ratio)) / (WH_R(8.0) * LITTLE_RAD);
}

static void check_near(wh_real found, wh_real wanted, wh_real most) {
    TEST_ASSERT_TRUE(WH_ABS(found - wanted) <= most);
}

/* Derivatives of base_rad with respect to the quadrature ratio and to the lag. The ratio determines the inertia or the
 * uncompensated part of gravity. Gravity is along an axis, or some degrees away from it. */
TEST(rig_turn_angle, derivatives_equal_difference_quotients) {
    seed = 1;
    for (unsigned i = 0; i < 100U; i++) {
        turn of = {.rotor = wh_rig_standard.measure.rotor, .compensated = i % 2U == 1U};
        const wh_real about =
            of.compensated ? draw_between(&seed, WH_R(-0.3), WH_R(0.3))
                           : of.rotor.inertia_kgm2 * draw_between(&seed, WH_R(1.0), WH_R(2.0));
        of.speed_radps = draw_between(&seed, WH_R(28.0), WH_R(42.0));
        of.rotor.gravity_rad = WH_R(0.25) * WH_RIG_TWO_PI * draw_whole(&seed, 0, 3) +
                               draw_between(&seed, WH_R(-0.25), WH_R(0.25));
        of.rotor.pulse_rad[0] = draw_between(&seed, WH_R(-0.1), WH_R(0.1));
        of.rotor.pulse_rad[1] = of.rotor.pulse_rad[0] + draw_between(&seed, WH_R(1.5), WH_R(1.65));
        wh_real ratio = WH_R(0.25);
        for (unsigned k = 0; k < 30U; k++) {
            ratio -= beyond(&of, about, ratio) / WH_RIG_TWO_PI;
        }
        wh_turn_angle angle = shaped(&of, about);
        (void)wh_turn_angle_by_ratio(&of.rotor, &angle, ratio);
        const wh_real swing = WH_ABS(angle.ripple_rad);
        const wh_real steep = angle.base_per_quadrature * angle.base_per_quadrature;
        /* Terms of second order in the differences. */
        const wh_real bent = swing * (WH_R(1.0) + steep);
        check_near(by_pulse(&of, about, ratio), angle.base_per_ratio,
                   WH_R(0.003) + WH_R(0.25) * bent);
        const wh_real lag = by_lag(&of, about, ratio);
        check_near(lag, angle.base_per_lag, swing * (WH_R(0.003) + WH_R(0.4) * bent) + WH_R(2e-5));
        if (of.compensated) {
            /* A lag adds a ripple a quarter turn later, in proportion to the part of gravity. */
            check_near(WH_ABS(lag), swing * WH_ABS(angle.base_per_quadrature),
                       swing * (WH_R(0.003) + WH_R(0.5) * bent) + WH_R(2e-5));
        }
    }
}

/* One call, from zero, has nearly converged. (The program makes a call in each turn.) */
TEST(rig_turn_angle, a_shape_is_found_at_once) {
    seed = 31;
    wh_real worst = WH_R(0.0);
    for (unsigned i = 0; i < 500U; i++) {
        turn of = {.rotor = wh_rig_standard.measure.rotor,
                   .speed_radps =
                       draw_between(&seed, WH_R(170.0), WH_R(360.0)) * WH_RIG_RADPS_PER_RPM};
        of.rotor.gravity_rad = draw_between(&seed, WH_R(-3.0), WH_R(3.0));
        of.rotor.inertia_kgm2 *= draw_between(&seed, WH_R(0.7), WH_R(1.5));
        wh_turn_angle once;
        wh_turn_angle often;
        wh_turn_angle_start(&of.rotor, &once);
        wh_turn_angle_start(&of.rotor, &often);
        wh_turn_angle_shape(&of.rotor, &once, of.speed_radps);
        for (unsigned k = 0; k < 8U; k++) {
            wh_turn_angle_shape(&of.rotor, &often, of.speed_radps);
        }
        for (unsigned k = 0; k < 8U; k++) {
            const wh_real part = (wh_real)k / WH_R(8.0);
            const wh_real off =
                WH_ABS(wh_turn_angle_at(&once, part) - wh_turn_angle_at(&often, part));
            worst = off > worst ? off : worst;
        }
    }
    TEST_ASSERT_TRUE(worst < WH_R(2.5e-4));
}
