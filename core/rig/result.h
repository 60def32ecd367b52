/* result.h: turns merged into a measurement with its uncertainty and its quality.
 *
 * The half-widths of the intervals are for 95 %. A half-width is the root of the sum of squares of these parts:
 *
 * - scatter: Student's factor times the standard error of the mean over the turns.
 * - pulses (phase): jitter of the pulse times, found from their second differences. The scatter contains only half of
 * the jitter's variance, because successive turns share a pulse. This part is the remaining half.
 * - quadrature ratio (phase): jitter also changes the quadrature ratio (turn_angle.h).
 * - angle: the damping has a tolerance, and the angle's model neglects the third order. With gravity compensation, the
 * compensation's angle may be wrong, and the motor may brake less than commanded.
 * - carriage (amplitude): the configured inertia has a tolerance.
 * - drift (phase): the speed may change within a turn, but the angle is computed for a constant mean speed.
 * - floors: the configured calibration uncertainties. Before calibration they are 0.5 % and 0.5 degrees. */
#ifndef WH_RIG_RESULT_H
#define WH_RIG_RESULT_H

#include "lockin.h"

WH_C_BEGIN

typedef enum wh_quality { WH_GOOD, WH_DOUBTFUL, WH_REFUSED } wh_quality;

/* Reasons, beginning with the strongest: X(name, quality, words). */
#define WH_WHY_ROWS(X) \
    X(WH_WHY_NONE, WH_GOOD, "no reason to doubt it") \
    X(WH_WHY_FEW_TURNS, WH_REFUSED, "fewer than three turns are usable") \
    X(WH_WHY_POLARITY, WH_REFUSED, \
      "the force points opposite to the masses: check the cell's polarity and the sensors") \
    X(WH_WHY_AMPLITUDE, WH_REFUSED, \
      "the force differs from the value expected from masses, speed and mount") \
    X(WH_WHY_PHASE, WH_REFUSED, \
      "the force does not point along the masses: check the sensors and delays") \
    X(WH_WHY_UNSURE, WH_REFUSED, "the result's interval is wider than a quarter of the force") \
    X(WH_WHY_AMPLITUDE_OFF, WH_DOUBTFUL, \
      "the force differs a little from the value expected from masses, speed and mount") \
    X(WH_WHY_PHASE_OFF, WH_DOUBTFUL, "the force points slightly beside the masses") \
    X(WH_WHY_PLACE, WH_DOUBTFUL, "sensor 1 is not where the arms hang: the phase has an error") \
    X(WH_WHY_LEFT_OUT, WH_DOUBTFUL, "more than a quarter of the turns could not be used") \
    X(WH_WHY_OUTLIERS, WH_DOUBTFUL, "more than one sample in a hundred was left out") \
    X(WH_WHY_RESIDUAL, WH_DOUBTFUL, \
      "noise or forces at other frequencies than the rotor's are large") \
    X(WH_WHY_ROTOR, WH_DOUBTFUL, "the second sensor's pulses do not fit the rotor's motion") \
    X(WH_WHY_FED, WH_DOUBTFUL, "1/7 or more of gravity's torque remains uncompensated") \
    X(WH_WHY_MEAN, WH_DOUBTFUL, "the mean force is not zero: the tare has moved") \
    X(WH_WHY_WIDE, WH_DOUBTFUL, "the result's interval is wider than a twentieth of the force") \
    X(WH_WHY_SWING, WH_DOUBTFUL, "within a turn, the load's speed differs from the rotor's") \
    X(WH_WHY_REPEATS, WH_DOUBTFUL, \
      "the residual repeats each turn: clipping, play, a nonlinear gain, or a torque twice per turn")

#define WH_WHY_NAME(name, quality, words) name,
typedef enum wh_why { WH_WHY_ROWS(WH_WHY_NAME) WH_WHYS } wh_why;
#undef WH_WHY_NAME

typedef struct wh_result_config {
    wh_real mount_factor; /* force / (force on a fixed mount); carriage: M/(M + m) (rig.h) */
    /* Calibration uncertainties at 95 %: a fraction of the force, and an angle. 0: uncalibrated. */
    wh_real amplitude_floor;
    wh_real phase_floor_rad;
    /* Limits: fractions of the expected force, or rad. If a value exceeds a `wrong` limit, the result is refused. If a
     * value exceeds an `off` or `large` limit, the result is doubtful. */
    wh_real amplitude_off;
    wh_real amplitude_wrong;
    wh_real phase_off_rad;
    wh_real phase_wrong_rad;
    wh_real residual_large;
    wh_real mean_off;
    wh_real inertia_off; /* allowed difference from the configured inertia, as a fraction */
} wh_result_config;

/* The turns merged so far. All zeros: no turns. */
typedef struct wh_merge {
    bool follows; /* the last turn was used */
    bool second_follows;
    uint32_t turns;
    uint32_t left_out;
    uint32_t samples;
    uint32_t outliers;
    uint32_t second_turns; /* number of turns that gave at_pulse_N[1] */
    wh_real jitter_s2;     /* sum of squares of the second differences of the pulse times */
    uint32_t jitters;      /* number of second differences in jitter_s2 */
    uint32_t first_ticks;  /* duration of the first used turn */
    uint32_t last_ticks;   /* duration of the last used turn */
    uint32_t second_turn_ticks;
    uint32_t begin_ticks;
    uint32_t second_ticks;
    wh_real repeats_N2; /* squared amplitudes of the harmonics evaluated so far */
    wh_real third_N2;   /* squared amplitude of the third harmonic */
    wh_repeats repeats;
    wh_real in_phase_N; /* components of the first order, means over the turns */
    wh_real quadrature_N;
    wh_real second_N[2]; /* components of the second order: cosine, sine */
    /* sums of x^2, x y, y^2; x: deviation of a turn from in_phase_N, y: deviation from quadrature_N */
    wh_real scatter_N2[3];
    wh_real mean_N;
    wh_real residual_N2;
    wh_real expected_N;
    wh_real ripple_rad;
    wh_real turn_s;
    wh_real turn_s2; /* sum of squared deviations from turn_s */
    wh_real at_pulse_N[2];
} wh_merge;

typedef struct wh_measured {
    wh_quality quality;
    wh_why why;
    bool calibrated; /* the calibration uncertainties of force and angle were entered */
    uint32_t turns;
    uint32_t left_out;
    uint32_t outliers;
    wh_real speed_radps;
    wh_real scatter_radps; /* standard deviation over turns */
    wh_real mean_N;        /* mean over time, minus the tare */
    wh_real amplitude_N;
    wh_real amplitude_half_N; /* half-width of the interval, 95 % */
    wh_real phase_rad;        /* -pi ... pi */
    wh_real phase_half_rad;
    wh_real expected_N; /* amplitude expected from masses, speed and mount */
    wh_real residual_N; /* rms of the load without its orders 0 to 2 */
    /* amplitude of the repeating residual: max(amplitude of harmonics 3 to 6, 1.27 * amplitude of harmonic 3) */
    wh_real repeats_N;
    wh_real repeats_limit_N; /* largest repeats_N that noise and a healthy rig cause */
    wh_real jitter_s;        /* standard deviation of the pulse times */
    wh_real inertia_kgm2;
    wh_real ripple_off_rad; /* error of the modelled speed ripple, from the load's second order */
    /* Remaining fraction of gravity's torque, >= 0, in a compensated run. 0 in a run without compensation. */
    wh_real uncompensated_part;
    wh_real at_pulse_N[2]; /* load at each sensor's pulse, minus the tare */
} wh_measured;

/* Half-widths before calibration, for a commercial load cell and sensors in their nominal positions. */
#define WH_UNCALIBRATED_PART WH_R(0.005)
#define WH_UNCALIBRATED_RAD (WH_R(0.5) / WH_RIG_DEG_PER_RAD)

WH_INLINE bool wh_result_is_calibrated(const wh_result_config *config) {
    return config->amplitude_floor > WH_R(0.0) && config->phase_floor_rad > WH_R(0.0);
}

/* Add a turn that was evaluated with `angle`. An unusable turn ends a series of successive turns. */
void wh_merge_add(const wh_result_config *config, const wh_rotor_config *rotor, wh_merge *merge,
                  const wh_lockin_turn *turn, const wh_turn_angle *angle);

/* Evaluate a harmonic of the repeating residual, WH_REPEATS_FIRST to WH_REPEATS_LAST, after the last turn. */
void wh_merge_harmonic(wh_merge *merge, unsigned harmonic);

#define WH_MERGE_MEAN_PIECES 6U
/* Compute means and half-widths. Call this once for each `piece`, 0 to WH_MERGE_MEAN_PIECES - 1, in order. Before the
 * last piece, *measured is incomplete. mean_N and at_pulse_N are without tare_N. With one turn, half-widths are 0. */
void wh_merge_mean_piece(const wh_result_config *config, const wh_rotor_config *rotor,
                         const wh_merge *merge, const wh_turn_angle *angle, wh_real tare_N,
                         wh_measured *measured, unsigned piece);

/* After the last piece: evaluate ripple error, repeating residual and scatter of the speed. */
void wh_merge_compare(const wh_rotor_config *rotor, const wh_merge *merge,
                      const wh_turn_angle *angle, wh_measured *measured);

/* After wh_merge_compare(): decide on quality and reason. */
void wh_merge_judge(const wh_result_config *config, const wh_rotor_config *rotor,
                    const wh_merge *merge, const wh_turn_angle *angle, wh_measured *measured);

/* Returns Student's two-sided factor for 95 %, within 0.3 % for 2 or more degrees of freedom; 0 if `freedom` is 0. */
wh_real wh_student(uint32_t freedom);

const char *wh_why_text(wh_why why);
const char *wh_quality_text(wh_quality quality);

WH_C_END

#endif
