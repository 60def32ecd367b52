/* turn_angle.c: the rotor's angle within a turn, from the two sensors' pulses and the rotor's equation of motion. */
#include "turn_angle.h"

#include "core/root.h"
#include "datasheet.h"
#include "polar.h"

/* Largest E for which the series in turn_angle.h is valid. With a larger E the rotor almost stops at the top. */
#define SWING_MOST WH_R(0.35)

/* E is not estimated if the quadrature ratio's derivative with respect to E is less than this. */
#define SLOPE_LEAST WH_R(0.15)

/* The first quadrature ratios correct a large error of the inertia by Newton's method. Later ratios are averaged. */
#define RATIOS_TO_FIND 3U

/* Limits value to -most ... most. If value is NaN, returns most. */
static wh_real within(wh_real value, wh_real most) {
    return value < most ? value > -most ? value : -most : most;
}

static wh_real small_arc(wh_real sine) {
    return sine * (WH_R(1.0) + WH_R(0.16666667) * sine * sine);
}

/* Returns theta - base - phi at the angle u. */
static wh_real added(const wh_turn_angle *angle, wh_wave u) {
    return angle->ripple_rad * u.sine + angle->second_sine * (WH_R(2.0) * u.sine * u.cosine) +
           angle->second_cosine * (WH_R(2.0) * u.cosine * u.cosine - WH_R(1.0));
}

void wh_turn_angle_start(const wh_rotor_config *config, wh_turn_angle *angle) {
    *angle = (wh_turn_angle){.inertia_kgm2 = config->inertia_kgm2, .part = WH_R(1.0)};
    angle->base_rad = config->pulse_rad[0];
    angle->begin_rad = config->pulse_rad[0] - config->gravity_rad;
}

void wh_turn_angle_compensate(wh_turn_angle *angle, bool compensated, wh_real stall_Nm_per_V) {
    angle->stall_Nm_per_V = stall_Nm_per_V;
    if (angle->compensated != compensated) {
        angle->compensated = compensated;
        angle->part = compensated ? WH_R(0.0) : WH_R(1.0);
        angle->ratios = 0;
    }
}

static void add_carriage(const wh_rotor_config *config, wh_turn_angle *angle, wh_real speed_radps) {
    const wh_real yields = config->yields_kgm2;
    const wh_real mean = angle->inertia_kgm2 - WH_R(0.5) * yields;
    if (!(yields > WH_R(0.0)) || !(mean > yields)) {
        angle->twice_rad = WH_R(0.0);
        return;
    }
    const wh_real tangent = config->damping_Nms / (WH_R(2.0) * mean * speed_radps);
    const wh_real cosine = WH_R(1.0) / WH_SQRT(WH_R(1.0) + tangent * tangent);
    const wh_real sine = tangent * cosine;
    const wh_real lambda = small_arc(sine);
    angle->twice_rad = WH_R(0.125) * yields / mean * cosine;
    const wh_wave turned = wh_wave_of(WH_R(2.0) * (config->gravity_rad - angle->lag_rad) + lambda);
    angle->second_sine -= angle->twice_rad * turned.cosine;
    angle->second_cosine -= angle->twice_rad * turned.sine;
}

/* Adds the effect of the torque that a clipped compensation leaves (turn_angle.h):
 * weight_Nm * max(0, -sin(theta - gamma) - held_Nm / weight_Nm). */
static void add_cut(const wh_rotor_config *config, wh_turn_angle *angle, wh_real speed_radps) {
    const wh_real weight_Nm = config->unbalance_kgm * config->gravity_mps2;
    const wh_real held_Nm = angle->drive_V * angle->stall_Nm_per_V;
    if (!angle->compensated || !(held_Nm < weight_Nm)) {
        angle->cut = WH_R(0.0);
        return;
    }
    const wh_real cut = WH_R(1.0) - held_Nm / weight_Nm;
    const wh_real second = WH_R(0.6) * cut * WH_SQRT(cut) * (WH_R(1.0) - WH_R(0.72) * cut);
    angle->cut = cut;
    const wh_real turning = WH_R(2.0) * angle->inertia_kgm2 * speed_radps;
    const wh_real sum = WH_SQRT(turning * turning + config->damping_Nms * config->damping_Nms);
    const wh_real size = weight_Nm * second / (WH_R(2.0) * speed_radps * sum);
    const wh_real sine = config->damping_Nms / sum;
    const wh_real lambda = small_arc(sine);
    const wh_wave turned = wh_wave_of(lambda - WH_R(2.0) * angle->lag_rad);
    angle->second_cosine += size * turned.cosine;
    angle->second_sine -= size * turned.sine;
}

WH_INLINE void shape_swing(const wh_rotor_config *config, wh_turn_angle *angle,
                           wh_real speed_radps) {
    const wh_real weight_Nm = config->unbalance_kgm * config->gravity_mps2;
    const wh_real turning = angle->inertia_kgm2 * speed_radps;
    const wh_real sum = WH_SQRT(turning * turning + config->damping_Nms * config->damping_Nms);
    angle->whole_rad = weight_Nm / (speed_radps * sum);
    angle->ripple_rad = within(angle->part * angle->whole_rad, SWING_MOST);
    const wh_real sine = config->damping_Nms / sum;
    const wh_real square = sine * sine;
    /* Arc sine by a series; below 0.5 its error is at most 1e-4. */
    angle->lag_rad =
        sine *
        (WH_R(1.0) + square * (WH_R(0.16666667) + square * (WH_R(0.075) + square * WH_R(0.0446))));
    const wh_real second = WH_R(0.125) * angle->ripple_rad * angle->ripple_rad;
    const wh_real half = WH_R(0.5) * angle->lag_rad;
    angle->second_sine = second * (WH_R(1.0) - WH_R(0.5) * half * half);
    angle->second_cosine = -second * half * (WH_R(1.0) - half * half * (WH_R(1.0) / WH_R(6.0)));
    add_carriage(config, angle, speed_radps);
    add_cut(config, angle, speed_radps);
}

WH_INLINE void shape_begin(const wh_rotor_config *config, wh_turn_angle *angle) {
    /* Newton's method for theta = pulse_rad[0] at the start of the turn, with u = base + psi - gamma. */
    const wh_real begins = config->pulse_rad[0] + angle->lag_rad - config->gravity_rad;
    for (unsigned round = 0; round < 2U; round++) {
        const wh_wave u = wh_wave_of(angle->begin_rad);
        angle->begin_rad -= (angle->begin_rad + added(angle, u) - begins) /
                            (WH_R(1.0) + angle->ripple_rad * u.cosine);
    }
}

WH_INLINE void shape_base(const wh_rotor_config *config, wh_turn_angle *angle) {
    angle->base_rad = config->pulse_rad[0] - added(angle, wh_wave_of(angle->begin_rad));
}

void wh_turn_angle_shape(const wh_rotor_config *config, wh_turn_angle *angle, wh_real speed_radps) {
    shape_swing(config, angle, speed_radps);
    shape_begin(config, angle);
    shape_base(config, angle);
}

#if WH_RIG_SMALL_PIECES
void wh_turn_angle_shape_piece(const wh_rotor_config *config, wh_turn_angle *angle,
                               wh_real speed_radps, unsigned piece) {
    if (piece == 0) {
        shape_swing(config, angle, speed_radps);
    } else if (piece == 1U) {
        shape_begin(config, angle);
    } else {
        shape_base(config, angle);
    }
}
#endif

/* Does wh_turn_angle_by_ratio(), given the sines and cosines of u at the start of the turn and at sensor 2's pulse. */
WH_INLINE wh_real ratio_by(const wh_rotor_config *config, wh_turn_angle *angle, wh_real passed,
                           wh_wave from, wh_wave to) {
    const wh_real off = config->pulse_rad[1] - (angle->base_rad + passed + added(angle, to));
    const wh_real swing = angle->ripple_rad;
    if (!(angle->whole_rad > WH_R(0.0))) {
        return off;
    }
    const wh_real sine = angle->lag_rad * (WH_R(1.0) - angle->lag_rad * angle->lag_rad / WH_R(6.0));
    const wh_real cosine2 = WH_R(1.0) - sine * sine;
    const wh_real bends = WH_R(1.0) / (WH_R(1.0) + swing * from.cosine);
    const wh_real turns = to.cosine - from.cosine;
    /* d lag/d swing = tan(lag)/swing, because the inertia determines lag and swing. */
    const wh_real lag_per_swing =
        angle->compensated ? WH_R(0.0) : sine / (WH_SQRT(cosine2) * swing);
    const wh_real begin_per_swing = (lag_per_swing - from.sine) * bends;
    const wh_real ratio_per_ripple = (to.sine - from.sine) + swing * turns * begin_per_swing;
    const wh_real base_per_swing = -from.sine - swing * from.cosine * begin_per_swing;
    if (!(WH_ABS(ratio_per_ripple) > SLOPE_LEAST)) {
        /* A large to.sine - from.sine shows that the inertia is too small. */
        if (!angle->compensated && WH_ABS(to.sine - from.sine) > WH_R(2.0) * SLOPE_LEAST) {
            angle->inertia_kgm2 *= WH_R(1.25);
        }
        return off;
    }
    angle->base_per_ratio = base_per_swing / ratio_per_ripple;
    angle->base_per_quadrature = WH_R(1.0) / ratio_per_ripple;
    angle->base_per_lag = -swing * bends * (from.cosine + angle->base_per_ratio * turns);

    angle->ratios += angle->ratios < WH_TURN_ANGLE_PATIENCE + RATIOS_TO_FIND ? 1U : 0U;
    const uint32_t turns_averaged =
        angle->ratios > RATIOS_TO_FIND ? angle->ratios - RATIOS_TO_FIND : 1U;
    if (angle->compensated) {
        angle->part = within(
            angle->part + off / (ratio_per_ripple * angle->whole_rad * (wh_real)turns_averaged),
            WH_R(1.0));
        return off;
    }
    /* d ln E / d ln I = -cos^2 psi */
    const wh_real change = within(-off / (ratio_per_ripple * swing * cosine2), WH_R(0.5));
    angle->inertia_kgm2 *= WH_R(1.0) + change / (wh_real)turns_averaged;
    return off;
}

wh_real wh_turn_angle_by_ratio(const wh_rotor_config *config, wh_turn_angle *angle, wh_real ratio) {
    const wh_real passed = WH_RIG_TWO_PI * ratio;
    return ratio_by(config, angle, passed, wh_wave_of(angle->begin_rad),
                    wh_wave_of(angle->begin_rad + passed));
}

#if WH_RIG_SMALL_PIECES
void wh_turn_angle_ratio_waves(wh_turn_angle *angle, wh_real ratio) {
    angle->at_begin = wh_wave_of(angle->begin_rad);
    angle->at_second = wh_wave_of(angle->begin_rad + WH_RIG_TWO_PI * ratio);
}

wh_real wh_turn_angle_ratio_rest(const wh_rotor_config *config, wh_turn_angle *angle,
                                 wh_real ratio) {
    return ratio_by(config, angle, WH_RIG_TWO_PI * ratio, angle->at_begin, angle->at_second);
}
#endif

wh_real wh_turn_angle_at(const wh_turn_angle *angle, wh_real part) {
    const wh_real passed = WH_RIG_TWO_PI * part;
    return angle->base_rad + passed + added(angle, wh_wave_of(angle->begin_rad + passed));
}
