/* free_swing.h: the sensors' positions, found from the free swing of a rotor that comes to rest.
 *
 * A driven run cannot distinguish a misplaced sensor from a force out of line with the masses: both shift the phase
 * equally. A rotor that swings freely shows the direction in which the arms hang, and so the positions of the sensors.
 * With the motor's leads open, only gravity and friction move the rotor (see "the rotor" below). Without friction,
 * half swings to the right and to the left would take equally long. A pulse comes at the slot's leading edge. For a
 * sensor at the angle p, the arms are then at p - lead on the way to the right, and at p + lead on the way to the left.
 * So the lead cancels, and a half swing on the right seems shorter than one on the left by 4 p/v, with v the speed at
 * the bottom. The difference is largest for a slow rotor.
 *
 * The first guess needs v, and thus an amplitude A. By the pendulum's first integral v^2 = 4 g sin^2(A/2). A half swing
 * takes 2 K(sin(A/2))/sqrt(g), with K the complete elliptic integral of the first kind. The last swings are small, so
 * their period gives g = S g0/I. The duration of the first swing then gives its amplitude, and the number of swings
 * gives the friction. This guess has an error of some 10 %.
 *
 * Gauss's regression refines the guess. The unknowns are q and q' at the first backward passage of the bottom, g,
 * Coulomb and viscous friction over I, and both sensors' positions. The data are the times of all pulses. In the last
 * turns, and at amplitudes above 90 deg, the rotor passes sensor 2, which gives a second known angle. Large residuals
 * could prevent convergence. So the first passes (iterations) add a variance to each pulse, less from pass to pass.
 *
 * The confidence interval is that of the regression, widened by floor_rad, and by large residuals of the pulses. After
 * the rotor has come to rest, each control step does a part of a pass; the whole takes some seconds. */
#ifndef WH_RIG_FREE_SWING_H
#define WH_RIG_FREE_SWING_H

#include "core/real.h"
#include "datasheet.h"
#include "result.h"

WH_C_BEGIN

/* === normal equations ======================================================================== */
/* Linear least squares: normal equations that grow row by row, solved by Cholesky factorization. Each unknown is scaled
 * by its initial uncertainty, which enters as one row with the weight 1. So the matrix is the unit matrix plus the
 * other rows, and never singular. */

#define WH_NORMAL_UNKNOWNS 7

typedef struct wh_normal {
    wh_real matrix[WH_NORMAL_UNKNOWNS][WH_NORMAL_UNKNOWNS]; /* lower triangle, later Cholesky's L */
    wh_real right[WH_NORMAL_UNKNOWNS];                      /* right side, then the solution */
    wh_real misfit; /* sum of squared residuals over their variances, at the guess */
} wh_normal;

/* Begin with the prior alone: each unknown equals its `guess`, with a standard deviation of 1. */
void wh_normal_start(wh_normal *normal, const wh_real guess[WH_NORMAL_UNKNOWNS]);

/* Add a measurement: the scalar product of `row` and the unknowns is `off`, with the variance 1/weight. */
void wh_normal_add(wh_normal *normal, const wh_real row[WH_NORMAL_UNKNOWNS], wh_real off,
                   wh_real weight);

/* Factor the matrix, in some 1,000 instructions. After that, wh_normal_solve() writes the unknowns to normal->right. */
void wh_normal_factor(wh_normal *normal);
void wh_normal_solve(wh_normal *normal);

wh_real wh_normal_deviation(const wh_normal *normal, unsigned which);

/* === the rotor =============================================================================== */
/* A rotor under gravity and friction alone, and the derivatives of its motion with respect to the initial state, g, f
 * and c.
 *
 *      q'' = -g sin q - f sign q' - c q'
 *
 * q is the angle from hanging. g is gravity's largest torque, f is the torque of Coulomb friction, and c is the
 * coefficient of viscous friction, each divided by the rotor's inertia. A step uses Stoermer's method, forwards or
 * backwards in time. A reversal multiplies the derivatives by the ratio of the later to the earlier acceleration. */

enum { WH_FREE_Q, WH_FREE_RATE, WH_FREE_GRAVITY, WH_FREE_FRICTION, WH_FREE_DRAG, WH_FREE_CAUSES };

typedef struct wh_free_rotor {
    wh_real q_rad; /* -pi ... pi */
    wh_real rate_radps;
    wh_real q_by[WH_FREE_CAUSES]; /* derivatives with respect to each WH_FREE_ value */
    wh_real rate_by[WH_FREE_CAUSES];
} wh_free_rotor;

void wh_free_rotor_start(wh_free_rotor *rotor, wh_real q_rad, wh_real rate_radps);

/* Steps by h seconds, backwards if h < 0. |h| must be much shorter than a swing. Reads only g, f and c of cause[]. */
void wh_free_rotor_step(const wh_real *cause, wh_free_rotor *rotor, wh_real h);

/* Wraps an angle into -pi ... pi by at most one turn; returns 0 for larger angles and NaN. */
WH_SHARED wh_real wh_free_angle(wh_real rad) {
    const wh_real half = WH_R(0.5) * WH_RIG_TWO_PI;
    const wh_real near = rad > half ? rad - WH_RIG_TWO_PI : rad < -half ? rad + WH_RIG_TWO_PI : rad;
    return near >= -half && near <= half ? near : WH_R(0.0);
}

/* === the state of an evaluation ============================================================== */

/* Index of sensor 1's position in wh_swing.x[]. The next element is sensor 2's position. */
#define WH_SWING_PLACE WH_FREE_CAUSES

#define WH_SWING_TURNING 6U /* maximum number of pulses stored from the turns before the swings */
#define WH_SWING_PULSES 36U /* maximum number of pulses stored altogether */
#define WH_SWING_LAST 10U   /* number of stored pulse times of sensor 1 */

/* Pieces of work. WH_SWING_GOES takes many control steps. Any other piece takes one control step. */
typedef enum wh_swing_piece {
    WH_SWING_GOES,
    WH_SWING_FACTORS,
    WH_SWING_SOLVES,
    WH_SWING_PASSES,
    WH_SWING_GUESSES,
    WH_SWING_ENDS
} wh_swing_piece;

/* The outcome of an evaluation: X(name, words). */
#define WH_SWING_ROWS(X) \
    X(WH_SWING_NONE, "no run has ended in a free swing") \
    X(WH_SWING_SWINGS, "the rotor is not at rest yet") \
    X(WH_SWING_WORKS, "the pulses of the swing are being analysed") \
    X(WH_SWING_FOUND, "found") \
    X(WH_SWING_NOT_FREE, "the rotor did not come to rest freely") \
    X(WH_SWING_FEW, "too few swings: friction stops the rotor") \
    X(WH_SWING_MISFIT, "the pulses do not fit a free swing") \
    X(WH_SWING_SIDES, "right and left look the same: the arms did not pass sensor 2") \
    X(WH_SWING_WIDE, "the swings do not determine the sensors' angles: the intervals are too wide")

#define WH_SWING_NAME(name, words) name,
typedef enum wh_swing_why { WH_SWING_ROWS(WH_SWING_NAME) WH_SWING_WHYS } wh_swing_why;
#undef WH_SWING_NAME

typedef struct wh_swing_config {
    wh_real lead_rad;  /* a pulse comes when the arms are this angle before the sensor */
    wh_real most_rad;  /* 95 % of sensors are nearer than this to the nominal position */
    wh_real jitter_s;  /* standard deviation of the pulse times */
    wh_real rough_rad; /* further standard deviation of a pulse's angle: a coupling's twist etc. */
    wh_real floor_rad; /* calibration uncertainty of a sensor's position, 95 % */
    wh_real wide_rad;  /* largest half_rad[0] of a useful result */
    wh_real off_rad;   /* a result is doubtful if |place_rad[0]| - half_rad[0] exceeds this */
    unsigned swings_least; /* least number of half swings */
} wh_swing_config;

typedef struct wh_swung {
    wh_swing_why why;
    wh_real place_rad[WH_RIG_SENSORS]; /* each sensor's distance from its nominal position */
    wh_real half_rad[WH_RIG_SENSORS];  /* half-widths of the intervals, 95 % */
    unsigned swings;                   /* half swings used */
} wh_swung;

typedef struct wh_swing {
    wh_swung result;
    bool free; /* argument `swings` of the last wh_swing_step() */
    bool any;
    bool forward; /* the rotor turned forwards at the last pulse */
    uint8_t sensor;
    bool swings; /* the rotor has passed sensor 1 backwards */
    wh_swing_piece piece;
    unsigned first;  /* index in kept_ticks of the first backward pulse of sensor 1 */
    unsigned passed; /* number of sensor 1's pulses from the first backward one on, stored or not */
    unsigned kept;
    unsigned start; /* number of failed guesses */
    unsigned pass;
    unsigned at;     /* index of the next pulse */
    unsigned fits;   /* pulses used in this pass */
    unsigned strays; /* pulses not used in this pass: too far from the predicted angle */
    /* Number of pulses used, by sensor. A result needs at least one pulse of sensor 2. */
    unsigned fits_of[WH_RIG_SENSORS];
    uint32_t ticks;
    wh_real soft_rad2;                  /* additional variance of each pulse */
    wh_free_rotor way;                  /* the rotor at the time `ticks` of a pass */
    uint32_t last_ticks[WH_SWING_LAST]; /* times of sensor 1's last pulses, the newest first */
    wh_real x[WH_NORMAL_UNKNOWNS];      /* x[WH_FREE_Q] counts from the angle at sensor 1's pulse */
    wh_real guess[WH_NORMAL_UNKNOWNS];
    wh_real within[WH_NORMAL_UNKNOWNS]; /* standard deviations of the guess */
    uint32_t kept_ticks[WH_SWING_PULSES];
    uint8_t kept_sensor[WH_SWING_PULSES];
    wh_normal normal; /* equations of this pass, scaled by `within` */
} wh_swing;

/* === the first guess ========================================================================= */

#define WH_SWING_STARTS 3U /* guesses that are tried, one after the other */

/* Drops swings near the top: their amplitude depends too steeply on their duration for a guess. */
void wh_swing_leave_top(const wh_swing_config *config, wh_swing *swing);

/* Sets x and its uncertainty for guess number swing->start. */
void wh_swing_guess(const wh_swing_config *config, wh_swing *swing);

/* === the evaluation ========================================================================== */

/* A small chip's build may set 0: then swings are not evaluated. */
#ifndef WH_RIG_SWINGS
#define WH_RIG_SWINGS 1
#endif

/* Take a pulse of sensor 0 or 1, in order of time. */
void wh_swing_pulse(wh_swing *swing, unsigned sensor, uint32_t ticks);

/* Call this in every control step. `swings` is true while the motor's leads are open after a run. The leads must open
 * while the rotor still turns forwards. `rests` is true while the rotor is at rest. If `swings` ends before the rotor
 * rests, the result is WH_SWING_NOT_FREE. While wh_swing_works(), each step at rest does a bounded part of the work. */
void wh_swing_step(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing,
                   bool swings, bool rests);

WH_INLINE bool wh_swing_works(const wh_swing *swing) { return swing->result.why == WH_SWING_WORKS; }

/* Makes a good result doubtful if sensor 1 was found out of place, which shifts the result's phase. */
void wh_swing_doubt(const wh_swing_config *config, const wh_swing *swing, wh_measured *measured);

const char *wh_swing_text(wh_swing_why why);

WH_C_END

#endif
