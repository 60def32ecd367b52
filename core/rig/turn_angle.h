/* turn_angle.h: the rotor's angle within a turn, from the two sensors' pulses and the rotor's equation of motion.
 *
 * Arms in a vertical plane do not turn at a constant speed. Their equation of motion is
 *
 *     I theta'' = -S g sin(theta - gamma) + c (omega - theta')
 *
 * Its solution to the second order in E, with a constant `base` and with phi rising at a constant rate, is
 *
 *     theta = base + phi + E [sin u + (E/8) sin(2u - psi/2)]      u = base + phi + psi - gamma
 *     E = S g / (omega sqrt(I^2 omega^2 + c^2))      sin psi = c / sqrt(I^2 omega^2 + c^2)
 *
 * S is the sum of mass times radius, gamma the direction of gravity, c the slope of the motor's torque line plus the
 * bearings' drag, I the rotor's inertia. If the ripple is neglected (E = 0), the force has errors of 2.6 % and 2.0
 * degrees at 170 rpm. E, and thus I, is estimated from the quadrature ratio: the fraction of a turn's time before
 * sensor 2's pulse. The ratio does not show c, so c is configured.
 *
 * Gravity compensation (gravity_compensation.h) multiplies gravity's torque, and thus E, by a factor near 0: `part`.
 * `part` can be negative. With compensation, the quadrature ratio gives `part`, and I stays at its last estimate. The
 * motor's voltage cannot go below 0, so the compensation can remove at most the torque that the drive's own voltage
 * gives. If this torque is less than S g, the compensation is clipped, and the remaining torque is not sinusoidal.
 *
 * A carriage of mass M moves along theta = 0. The effective inertia of the arms, of mass m, is I - D sin^2 theta,
 * with D of at most S^2/(M + m). The inertia is least when the arms are across the rail, so the arms speed up twice a
 * turn. To the first order theta has the further term
 *
 *     -A sin(2 (base + phi) + lambda)     A = D/(8 J) cos lambda    tan lambda = c/(2 J omega)    J = I - D/2
 *
 * The pulses do not show this term, so D and I are configured. The arms must turn in a level plane, because products of
 * gravity's ripple with this term are neglected. If the term is neglected for a carriage three times as heavy as the
 * arms, the force is 0.9 % too large, and its phase error is 0.11 degrees. */
#ifndef WH_RIG_TURN_ANGLE_H
#define WH_RIG_TURN_ANGLE_H

#include "core/angle.h"

WH_C_BEGIN

/* 1 on a chip with slow float products (200 cycles): cuts a control step's work into smaller pieces. */
#ifndef WH_RIG_SMALL_PIECES
#define WH_RIG_SMALL_PIECES 0
#endif

typedef struct wh_rotor_config {
    wh_real unbalance_kgm;              /* S */
    wh_real gravity_mps2;               /* gravity in the arms' plane; 0: the plane is level */
    wh_real gravity_rad;                /* gamma: the angle theta at which the arms hang */
    wh_real damping_Nms;                /* c */
    wh_real damping_tolerance;          /* relative error of c, at 95 % */
    wh_real compensation_tolerance_rad; /* error of the compensation's angle, at 95 % */
    wh_real inertia_kgm2;               /* inertia before the first estimate */
    wh_real pulse_rad[2];               /* angle theta of the arms at a pulse of each sensor */
    wh_real yields_kgm2;                /* D, the largest decrease of inertia; 0: fixed mount */
    wh_real yields_tolerance;           /* relative error of the quotient D / inertia, at 95 % */
} wh_rotor_config;

#define WH_TURN_ANGLE_PATIENCE 32U /* turns over which the inertia is averaged */

typedef struct wh_turn_angle {
    wh_real inertia_kgm2; /* present estimate */
    bool compensated;
    wh_real stall_Nm_per_V; /* if compensated: motor torque at standstill per volt */
    wh_real drive_V;        /* drive's voltage without the compensation, set by the caller */
    wh_real part;           /* uncompensated part of gravity; 1 without compensation */
    uint32_t ratios;        /* number of turns used to estimate the inertia or `part` */
    wh_real whole_rad;      /* E without gravity compensation */
    /* Fraction of S g that the compensation cannot remove, because the motor's voltage cannot go below 0. */
    wh_real cut;
    wh_real ripple_rad; /* E */
    wh_real lag_rad;    /* psi */
    wh_real begin_rad;  /* u at the start of the turn */
    wh_real base_rad;
    wh_real twice_rad;   /* A, rad */
    wh_real second_sine; /* coefficients of sin 2u and cos 2u in theta */
    wh_real second_cosine;
    wh_real base_per_ratio; /* derivative of base_rad with respect to the quadrature ratio */
    wh_real base_per_lag;   /* derivative of base_rad with respect to psi, at a fixed ratio */
    /* Derivative of base_rad with respect to a ripple in quadrature with E sin u (result.c). */
    wh_real base_per_quadrature;
#if WH_RIG_SMALL_PIECES
    wh_wave at_begin; /* sine and cosine of u at the start and at sensor 2's pulse */
    wh_wave at_second;
#endif
} wh_turn_angle;

void wh_turn_angle_start(const wh_rotor_config *config, wh_turn_angle *angle);

/* Switches gravity compensation on or off in the model. If this is a change, `part` is estimated again, but the inertia
 * is kept. stall_Nm_per_V > 0 is the motor's torque at standstill per volt. */
void wh_turn_angle_compensate(wh_turn_angle *angle, bool compensated, wh_real stall_Nm_per_V);

/* Computes the angle's shape at a mean speed > 0, with the present inertia. The work is bounded: each call does two
 * iterations for begin_rad, which converges over a few turns. */
void wh_turn_angle_shape(const wh_rotor_config *config, wh_turn_angle *angle, wh_real speed_radps);

#if WH_RIG_SMALL_PIECES
/* wh_turn_angle_shape() in pieces: call it for 0 to WH_TURN_ANGLE_SHAPES - 1, in order. */
#define WH_TURN_ANGLE_SHAPES 3U
void wh_turn_angle_shape_piece(const wh_rotor_config *config, wh_turn_angle *angle,
                               wh_real speed_radps, unsigned piece);
#endif

/* Corrects the inertia, or `part` if gravity is compensated, from a turn's quadrature ratio (0 to 1). First call
 * wh_turn_angle_shape() with this turn's speed. Returns the error of the angle at sensor 2's pulse, rad. */
wh_real wh_turn_angle_by_ratio(const wh_rotor_config *config, wh_turn_angle *angle, wh_real ratio);

#if WH_RIG_SMALL_PIECES
/* wh_turn_angle_by_ratio() in two pieces: sines, correction. */
void wh_turn_angle_ratio_waves(wh_turn_angle *angle, wh_real ratio);
wh_real wh_turn_angle_ratio_rest(const wh_rotor_config *config, wh_turn_angle *angle,
                                 wh_real ratio);
#endif

/* Returns theta at the fraction `part` (0 to 1) of the turn's time. */
wh_real wh_turn_angle_at(const wh_turn_angle *angle, wh_real part);

WH_C_END

#endif
