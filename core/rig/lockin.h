/* lockin.h: digital lock-in: the load's once-per-turn component, turn by turn, as samples arrive.
 *
 * Almesallmy (2006), I.3.3 and I.3.4, read the phase off an oscilloscope: sensor 1's spike sits on the load's peak.
 * Here the load is multiplied by the cosine and sine of the rotor's angle and integrated over the angle of whole turns,
 * from one pulse of sensor 1 to its next:
 *
 *     in_phase = 1/pi times the integral of F cos(theta) d theta; quadrature: the same with the sine
 *
 * A turn's result is the first Fourier coefficient over the angle (order tracking). The load is positive along the
 * loading-train axis towards the mass at theta = 0, and
 *     load(theta) = mean + amplitude cos(theta + phase) + the residual.
 * At phase 0 the load peaks when the mass is on the axis; at a positive phase it peaks before that.
 *
 * Samples wait until the pulse that ends their turn. Then each control step evaluates a few of them, to bound its work.
 * The prediction from the previous turn (mean, first and second order) is subtracted first and added again at the end.
 * So the trapezoidal rule integrates only small differences. A sample far from the prediction is an outlier: it is
 * counted and not used. */
#ifndef WH_RIG_LOCKIN_H
#define WH_RIG_LOCKIN_H

#include "cell.h"
#include "datasheet.h"
#include "turn_angle.h"

WH_C_BEGIN

/* === what repeats from turn to turn ========================================================== */
/* Harmonics 3 to 6 of the load that repeat in each turn, by synchronous averaging (Braun, Acustica 32 (1975) 69).
 *
 * The load's residual after orders 0 to 2 is summed at each angle of the rotor over the turns of a record. Noise and
 * mains hum average out. Clipping, backlash or a nonlinear gain of the cell causes harmonics 3 to 6. A torque that acts
 * twice per turn changes the speed, and so causes a third harmonic.
 *
 * A rigid rotor on a fixed mount has the speed w with w^2 = A + B cos(theta + psi - gamma). The force F = S (w^2
 * cos theta + w' sin theta) has only the orders 0, 1 and 2. Damping and the angle's third-order terms (result.c) add
 * little. The noise is estimated from differences of successive residuals. So hum and slow changes do not count as
 * noise. */

/* Number of angles at which the residual is summed. Hum at harmonic 26 of the turn (50 Hz at 115 rpm) is aliased to
 * harmonic 6, with a fifth of the hum's amplitude. */
#define WH_REPEATS_BINS 32U

/* The evaluated harmonics. (result.h uses the second harmonic to check the speed ripple.) */
#define WH_REPEATS_FIRST 3U
#define WH_REPEATS_LAST 6U

typedef struct wh_repeats {
    uint32_t samples;               /* samples in the merged turns */
    wh_real changes_N2;             /* sum of squared differences of successive residuals */
    wh_real bin_N[WH_REPEATS_BINS]; /* integral of the residual over the angle */
} wh_repeats;

/* Adds residual_Nrad (a residual times an angle step) to the bin of theta_rad, which is at most about 2 pi. */
WH_INLINE void wh_repeats_add(wh_repeats *repeats, wh_real theta_rad, wh_real residual_Nrad) {
    const wh_real bins = (wh_real)WH_REPEATS_BINS;
    const wh_real bin = theta_rad * (bins / WH_RIG_TWO_PI) + bins;
    if (!(WH_ABS(bin) < WH_R(3.0) * bins)) {
        return; /* out of range or NaN */
    }
    repeats->bin_N[(uint32_t)(int32_t)bin % WH_REPEATS_BINS] += residual_Nrad;
}

void wh_repeats_merge(wh_repeats *sum, const wh_repeats *turn, uint32_t samples);

/* Averages the turns' residual at each angle. Returns the squared amplitude of a harmonic of this average. */
wh_real wh_repeats_power_N2(const wh_repeats *sum, uint32_t turns, unsigned harmonic);

#ifndef WH_LOCKIN_SAMPLES
/* Maximum number of waiting samples: 1.25 turns at 100 rpm and 500 samples/s. A small chip's build may set less. */
#define WH_LOCKIN_SAMPLES 384U
#endif
/* Limits per control step. A step may do half of the work for a node (a sample or pulse), the next step the rest. */
#define WH_LOCKIN_HALVES_AT_ONCE 3U /* half nodes */
#define WH_LOCKIN_STALE_AT_ONCE 8U  /* samples dropped because they are older than the turn */

/* Reasons why a turn does not count. */
typedef enum wh_turn_fault {
    WH_TURN_OK,
    WH_TURN_FIRST, /* no previous turn to compare with */
    WH_TURN_GAP,   /* load samples are missing */
    WH_TURN_OUTLIERS,
    WH_TURN_FROZEN,  /* the load never changes */
    WH_TURN_UNSTEADY /* the speed changes */
} wh_turn_fault;

/* Fourier coefficients of the load over the angle, up to the second order. */
#define WH_LOCKIN_ORDERS 5U
typedef struct wh_lockin_orders {
    wh_real at[WH_LOCKIN_ORDERS]; /* mean, coefficients of cos, sin, cos 2 theta, sin 2 theta */
} wh_lockin_orders;

typedef struct wh_lockin_turn {
    uint32_t begin_ticks; /* pulse of sensor 1 */
    uint32_t turn_ticks;
    wh_turn_fault fault;
    bool second_seen;
    uint16_t samples;
    uint16_t outliers;
    uint32_t second_ticks;    /* pulse of sensor 2, if seen */
    wh_lockin_orders force_N; /* at[1]: amplitude cos(phase); at[2]: -amplitude sin(phase) */
    wh_real mean_N;           /* mean over time */
    wh_real residual_N;       /* rms of the residual after orders 0 to 2 */
    wh_real at_pulse_N[2];    /* load at each sensor's pulse */
} wh_lockin_turn;

typedef enum wh_lockin_stage {
    WH_LOCKIN_WAITS, /* waits for a pulse */
    WH_LOCKIN_SHAPES,
    WH_LOCKIN_CORRECTS,
    WH_LOCKIN_RESHAPES,
    WH_LOCKIN_BEGINS,
    WH_LOCKIN_SUMS,
    WH_LOCKIN_ENDS
} wh_lockin_stage;

typedef enum wh_lockin_place {
    WH_LOCKIN_NOWHERE,
    WH_LOCKIN_BEGIN,
    WH_LOCKIN_WITHIN,
    WH_LOCKIN_END
} wh_lockin_place;

/* A point of the load's curve: a sample or a pulse. */
typedef struct wh_lockin_node {
    wh_real part; /* time from the turn's begin to the node, as a fraction of the turn's time */
    wh_real theta_rad;
    wh_real force_N;
    wh_real residual_N;     /* force minus the prediction */
    wh_lockin_orders waves; /* 1, cos theta, sin theta, cos 2 theta, sin 2 theta */
} wh_lockin_node;

/* Small members come first: some processors have short instructions that reach only the start of a struct. */
typedef struct wh_lockin {
    wh_lockin_stage stage;
    uint8_t piece;

    /* The turn in progress; if `open` is false, there is none. */
    bool open;
    bool second_seen;
    bool taken; /* a sample was taken out of the queue: taken_ticks and taken_N are valid */
    bool any;   /* a sample was put into the queue: newest_ticks and newest_N are valid */
    bool expects;
    wh_lockin_place place;
    uint32_t begin_ticks;
    uint32_t begin_quarter;
    uint32_t second_ticks;
    uint32_t skipped; /* turns that could not be evaluated */

    /* Queue of samples: index of the oldest one, and number of samples. */
    uint16_t first;
    uint16_t count;
    uint16_t equal; /* successive samples that equal the one before */
    uint16_t most_equal;
    uint32_t taken_ticks;
    wh_real taken_N;
    uint32_t newest_ticks;
    wh_real newest_N;
    uint32_t refused; /* samples not used: not ok, or out of order */

    wh_lockin_turn next;
    uint16_t next_equal;
    wh_real part_per_tick;
    wh_lockin_orders expected_N;
    wh_real outlier_N;
    wh_lockin_orders sum;
    wh_real square;
    wh_real mean;
    wh_real widest;     /* widest gap between two nodes, as a fraction of the turn */
    wh_real before_rad; /* angle of the node before `last` */
    wh_real before_part;
    wh_lockin_node last;   /* its weight depends on the next node */
    wh_lockin_node placed; /* node in progress, unless `place` is WH_LOCKIN_NOWHERE */
    wh_repeats repeats;    /* valid until the next turn's sums begin */

    wh_lockin_turn turn; /* the last finished turn */
    wh_turn_angle angle;
    wh_real force_N[WH_LOCKIN_SAMPLES];
    uint32_t ticks[WH_LOCKIN_SAMPLES];
} wh_lockin;

/* Start a zeroed lock-in, or restart one. The counters `skipped` and `refused` keep their values. The arrays of samples
 * are not cleared, because that would take too long in a control step. */
void wh_lockin_forget(const wh_rotor_config *rotor, wh_lockin *lockin);

/* Take a pulse of sensor 0 or 1 at `ticks`. `quarter` is the number of quarter turns so far, wrapping. */
void wh_lockin_pulse(wh_lockin *lockin, unsigned sensor, uint32_t ticks, uint32_t quarter);

/* As wh_turn_angle_compensate(). If `compensated` changes, the turn in progress does not count. */
void wh_lockin_compensate(wh_lockin *lockin, bool compensated, wh_real stall_Nm_per_V);

/* Call this when the count of quarter turns has restarted: the turn in progress does not count. */
void wh_lockin_gap(wh_lockin *lockin);

/* Take a sample, in the order of time. A sample that is not ok, or not newer than the last one, is not used. */
void wh_lockin_load(wh_lockin *lockin, const wh_load *load);

/* Call this once per control step. The call does one piece of the work. Each sample or pulse is summed in two parts; a
 * call sums at most `halves` parts. Returns true if this call has finished another lockin->turn. */
bool wh_lockin_work(const wh_rotor_config *rotor, const wh_cell_config *cell, wh_lockin *lockin,
                    unsigned halves);

WH_C_END

#endif
