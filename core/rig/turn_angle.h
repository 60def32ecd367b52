/* turn_angle.h: the rotor's angle within a turn, from the two sensors' marks and the rotor's lag.
 *
 * Arms that turn in a vertical plane do not turn evenly. With phi rising evenly and u = phi + psi - gamma,
 *
 *     theta = base + phi + E [sin u + (E/8) sin(2u - psi/2)]
 *
 * solves I theta'' = -S g sin(theta - gamma) + c (omega - theta') to the second order in E, where
 *
 *     E = S g / (omega sqrt(I^2 omega^2 + c^2))      sin psi = c / sqrt(I^2 omega^2 + c^2)
 *
 * S is the sum of mass times radius, gamma the direction in which gravity pulls, c the slope of the motor's
 * torque line with the bearings' drag, I the rotor's inertia. An even angle (E = 0) is off by 2.6 % and 2.0
 * degrees of the force at 170 rpm. I is not asked of the user but found: how a turn is split by sensor 2's
 * mark gives E, thus I. What stays assumed is c, which the split does not show.
 *
 * Where gravity is fed forward (feed.h) a part of it is left, of either sign: E is that part of the above. The split then
 * tells the part, and I stays what it was found to be before. A motor that gets no voltage below 0 cannot take away more
 * than the drive's own voltage gives: where that is less than S g it is cut off, and more than a sine is left.
 *
 * On a carriage of mass M that gives way along theta = 0, the arms, of mass m, turn the more easily the more they lie across:
 * by D = S^2/(M + m) at most, as I - D sin^2 theta. They then speed up twice a turn, and to the first order theta has
 *
 *     -A sin(2 (base + phi) + lambda)     A = D/(8 J) cos lambda    tan lambda = c/(2 J omega)    J = I - D/2
 *
 * in it as well. Neither sensor's mark tells of it: D and I are asked of the user, and the arms must turn in a level plane
 * (what gravity's swing and this wave do to each other is not in it). On a
 * carriage three times as heavy as the arms an even angle makes the force 0.9 % too large, and its phase 0.11 degrees. */
#ifndef WH_RIG_TURN_ANGLE_H
#define WH_RIG_TURN_ANGLE_H

#include "core/angle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where a float's product takes 200 cycles (1): one half node in a control step, and what is one piece of work elsewhere is done in
 * several, in steps without a sample. Other pieces, the same numbers. */
#ifndef WH_RIG_SMALL_PIECES
#define WH_RIG_SMALL_PIECES 0
#endif

typedef struct wh_rotor_config {
    wh_real mass_moment_kgm;   /* S */
    wh_real gravity_mps2;      /* within the arms' plane; 0: it lies level */
    wh_real gravity_rad;       /* gamma: the angle theta at which the arms hang */
    wh_real damping_Nms;       /* c */
    wh_real damping_tolerance; /* c may be off by this fraction, at 95 % */
    wh_real fed_tolerance_rad; /* gravity may be fed at an angle that is off by this, at 95 % */
    wh_real inertia_kgm2;      /* to begin with */
    wh_real mark_rad[2];       /* angle theta of the arms at a pulse of each sensor */
    wh_real yields_kgm2;       /* D, with no gravity; 0: the mount is fixed */
    wh_real yields_tolerance;  /* D or I may be off by this fraction, at 95 % */
} wh_rotor_config;

#define WH_TURN_ANGLE_PATIENCE 32U /* turns over which the inertia is averaged */

typedef struct wh_turn_angle {
    wh_real inertia_kgm2; /* as found so far */
    bool fed;
    wh_real stall_Nm_per_V; /* while fed; */
    wh_real held_V;    /* the drive's voltage less what is fed: kept up to date by whoever drives */
    wh_real part;      /* of gravity that is left, as found so far: 1 when it is not fed */
    uint32_t splits;   /* turns that inertia or part come from */
    wh_real whole_rad; /* E of all of gravity */
    wh_real cut;       /* part of S g for which a motor that is fed cannot brake enough */
    wh_real swing_rad; /* E */
    wh_real lag_rad;   /* psi */
    wh_real begin_rad; /* u at the turn's begin */
    wh_real base_rad;
    wh_real twice_rad;   /* A */
    wh_real second_sine; /* of sin 2u and cos 2u */
    wh_real second_cosine;
    wh_real base_per_split; /* how base_rad follows the split, with the lag that goes with it */
    wh_real base_per_lag;   /* and a lag that does not, the split kept; */
    /* and a swing a quarter turn on from E, which the split takes for E */
    wh_real base_per_quadrature;
#if WH_RIG_SMALL_PIECES
    wh_wave split_from; /* of u, at the turn's begin and where it is split */
    wh_wave split_to;
#endif
} wh_turn_angle;

#define wh_turn_angle_start WH_NAME(wh_turn_angle_start)
#define wh_turn_angle_feed WH_NAME(wh_turn_angle_feed)
#define wh_turn_angle_shape WH_NAME(wh_turn_angle_shape)
#define wh_turn_angle_shape_piece WH_NAME(wh_turn_angle_shape_piece)
#define wh_turn_angle_split WH_NAME(wh_turn_angle_split)
#define wh_turn_angle_split_waves WH_NAME(wh_turn_angle_split_waves)
#define wh_turn_angle_split_rest WH_NAME(wh_turn_angle_split_rest)
#define wh_turn_angle_at WH_NAME(wh_turn_angle_at)

/* Forget what was found. */
void wh_turn_angle_start(const wh_rotor_config *config, wh_turn_angle *angle);

/* From now on gravity is fed forward, or no longer: what is left of it is found anew, the inertia kept. Without a change
 * that stays. stall_Nm_per_V > 0: the motor's torque at standstill. */
void wh_turn_angle_feed(wh_turn_angle *angle, bool fed, wh_real stall_Nm_per_V);

/* The angle's shape at a mean speed > 0, with the inertia as found so far. Bounded work; each call takes
 * begin_rad closer, and from one turn to the next little is left to do. */
void wh_turn_angle_shape(const wh_rotor_config *config, wh_turn_angle *angle, wh_real speed_radps);

#if WH_RIG_SMALL_PIECES
/* The same in pieces, each once, in their order: 0 ... WH_TURN_ANGLE_SHAPES - 1. */
#define WH_TURN_ANGLE_SHAPES 3U
void wh_turn_angle_shape_piece(const wh_rotor_config *config, wh_turn_angle *angle,
                               wh_real speed_radps, unsigned piece);
#endif

/* Sensor 2's mark came when the part `split` (0 to 1) of the turn's time was over: correct the inertia, or the
 * part of gravity that is left, for which the shape must be that of this turn's speed. Returns by how much the mark was
 * off, rad. */
wh_real wh_turn_angle_split(const wh_rotor_config *config, wh_turn_angle *angle, wh_real split);

#if WH_RIG_SMALL_PIECES
/* The same in two pieces: first its waves, then the rest. */
void wh_turn_angle_split_waves(wh_turn_angle *angle, wh_real split);
wh_real wh_turn_angle_split_rest(const wh_rotor_config *config, wh_turn_angle *angle,
                                 wh_real split);
#endif

/* theta when the part `part` (0 to 1) of the turn's time is over. */
wh_real wh_turn_angle_at(const wh_turn_angle *angle, wh_real part);

#ifdef __cplusplus
}
#endif

#endif
