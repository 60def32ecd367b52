/* lockin.h: digital lock-in: the load's once-per-turn component, turn by turn, as samples arrive.
 *
 * Almesallmy (2006), I.3.3 and I.3.4, read the phase off an oscilloscope: sensor 1's spike sits on the load's peak.
 * Here the load is multiplied by the cosine and sine of the rotor's angle and integrated over the angle of whole turns,
 * from one pulse of sensor 1 to its next:
 *
 *     in_phase = 1/pi of the integral of F cos(theta) d theta, quadrature: the same with the sine
 *
 * A turn's result is the first Fourier coefficient over the angle (order tracking). Signs: the load is positive along
 * the loading-train axis towards the mass at theta = 0, and
 *     load(theta) = mean + amplitude cos(theta + phase) + the residual.
 * At phase 0 the load peaks with the mass on the axis; at a positive phase it peaks before the mass.
 *
 * Samples wait until the pulse that ends their turn. Then each control step evaluates a few of them, to bound its work.
 * The prediction from the previous turn (mean, first and second order) is subtracted first and added again at the end.
 * So the trapezoidal rule integrates only the small differences. A sample far from the prediction is an outlier: it is
 * left out and counted.
 *
 *     every control step:
 *         wh_lockin_pulse() for each slot pulse that was taken, wh_lockin_load() for each sample
 *         if (wh_lockin_work(...)) lockin.turn is the result of another turn */
#ifndef WH_RIG_LOCKIN_H
#define WH_RIG_LOCKIN_H

#include "cell.h"
#include "datasheet.h"
#include "turn_angle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* === what repeats from turn to turn ========================================================== */
/* The part of the load's residual that repeats from turn to turn, in harmonics 3 to 6.
 *
 * Synchronous averaging (Braun, Acustica 32 (1975) 69): the residual of orders 0 to 2 is summed by the rotor's angle over
 * the turns of a record. Noise and mains hum average out. The errors of a cell with clipping, backlash or a nonlinear gain
 * do not. Neither does a torque twice a turn, which changes the speed and so gives the force a third harmonic.
 *
 * A rigid rotor on a fixed mount has no such harmonics: with w^2 = A + B cos(theta + psi - gamma), the force F = S (w^2
 * cos theta + w' sin theta) has only the orders 0, 1 and 2. Damping's effect on w^2 and the angle's third order add a
 * little (result.c).
 *
 * The noise is estimated from successive differences, as for the tare: hum and slow changes do not count. */

/* Hum that is locked to the turn aliases from harmonic 26 on (115 rpm, 50 Hz), with a fifth of its amplitude. */
#define WH_REPEATS_BINS 32U

/* The harmonics. The second serves to check the speed ripple (result.h). */
#define WH_REPEATS_FIRST 3U
#define WH_REPEATS_LAST 6U

typedef struct wh_repeats {
    uint32_t samples;   /* number of samples in the merged turns */
    wh_real changes_N2; /* sum of squared differences of successive samples' residuals */
    wh_real bin_N[WH_REPEATS_BINS]; /* integral of the residual over the angle */
} wh_repeats;

#define wh_repeats_merge WH_NAME(wh_repeats_merge)
#define wh_repeats_power_N2 WH_NAME(wh_repeats_power_N2)

/* Adds the residual at an angle, multiplied by the angle that it represents. theta_rad is within about one turn. */
WH_INLINE void wh_repeats_add(wh_repeats *repeats, wh_real theta_rad, wh_real residual_Nrad) {
    const wh_real bins = (wh_real)WH_REPEATS_BINS;
    const wh_real bin = theta_rad * (bins / WH_RIG_TWO_PI) + bins;
    if (!(WH_ABS(bin) < WH_R(3.0) * bins)) {
        return; /* the angle is NaN, for example */
    }
    repeats->bin_N[(uint32_t)(int32_t)bin % WH_REPEATS_BINS] += residual_Nrad;
}

void wh_repeats_merge(wh_repeats *sum, const wh_repeats *turn, uint32_t samples);

/* Squared amplitude of a harmonic, averaged over the turns. */
wh_real wh_repeats_power_N2(const wh_repeats *sum, uint32_t turns, unsigned harmonic);

/* A small chip's build may set these: it has less memory, and less time in a control step. */
#ifndef WH_LOCKIN_SAMPLES
#define WH_LOCKIN_SAMPLES 384U /* waiting samples: 1.25 turns at 100 rpm, one per 2 ms */
#endif
/* Limits per control step: half nodes (a sample or pulse is placed, or weighed), and samples of no turn that are dropped. */
#define WH_LOCKIN_HALVES_AT_ONCE 3U
#define WH_LOCKIN_STALE_AT_ONCE 8U

/* Reasons why a turn does not count: X(name, words). */
#define WH_TURN_ROWS(X) \
    X(WH_TURN_OK, "ok") \
    /* there is no earlier turn to compare the turn with */ \
    X(WH_TURN_FIRST, "first") \
    X(WH_TURN_GAP, "load samples are missing") \
    X(WH_TURN_OUTLIERS, "too many outliers") \
    X(WH_TURN_FROZEN, "the load stands still") \
    X(WH_TURN_UNSTEADY, "the speed changes")

#define WH_TURN_NAME(name, words) name,
typedef enum wh_turn_fault { WH_TURN_ROWS(WH_TURN_NAME) WH_TURN_FAULTS } wh_turn_fault;
#undef WH_TURN_NAME

/* Fourier coefficients of the load over the angle, up to the second order. */
#define WH_LOCKIN_ORDERS 5U
typedef struct wh_lockin_orders {
    wh_real at[WH_LOCKIN_ORDERS]; /* mean, cosine, sine, cosine of twice the angle, sine of it */
} wh_lockin_orders;

typedef struct wh_lockin_turn {
    uint32_t begin_ticks; /* time of sensor 1's pulse */
    uint32_t turn_ticks;
    wh_turn_fault fault;
    bool second_seen; /* sensor 2's pulse was seen */
    uint16_t samples;
    uint16_t outliers;
    uint32_t second_ticks;    /* time of sensor 2's pulse, if seen */
    wh_lockin_orders force_N; /* at[1]: amplitude cos(phase); at[2]: -amplitude sin(phase) */
    wh_real mean_N;           /* mean over the time */
    wh_real residual_N;       /* rms after orders 0 to 2 */
    wh_real at_pulse_N[2];    /* load at each sensor's pulse */
} wh_lockin_turn;

typedef enum wh_lockin_stage {
    WH_LOCKIN_WAITS, /* waits for a pulse; lockin->piece counts the finished pieces of a stage */
    WH_LOCKIN_SHAPES,
    WH_LOCKIN_CORRECTS,
    WH_LOCKIN_RESHAPES,
    WH_LOCKIN_BEGINS,
    WH_LOCKIN_SUMS,
    WH_LOCKIN_ENDS
} wh_lockin_stage;

/* Where a node is in the turn; its place is known, its weight not yet. */
typedef enum wh_lockin_place {
    WH_LOCKIN_NOWHERE,
    WH_LOCKIN_BEGIN,
    WH_LOCKIN_WITHIN,
    WH_LOCKIN_END
} wh_lockin_place;

/* A point of the load's curve within the turn. */
typedef struct wh_lockin_node {
    wh_real part; /* share of the turn's time */
    wh_real theta_rad;
    wh_real force_N;
    wh_real rest_N;         /* residual: force minus the prediction */
    wh_lockin_orders waves; /* factor of each order's coefficient at this node */
} wh_lockin_node;

/* Small members come first, because a processor's short instructions reach only them. */
typedef struct wh_lockin {
    wh_lockin_stage stage;
    uint8_t piece;

    /* the turn in progress: since this pulse */
    bool open;
    bool second_seen;
    bool taken; /* a sample was taken from the queue */
    bool any;   /* a sample was accepted into the queue */
    bool expects;
    wh_lockin_place place;
    uint32_t begin_ticks;
    uint32_t begin_quarter;
    uint32_t second_ticks;
    uint32_t skipped; /* turns without a pulse of both sensors */

    /* waiting samples: index of the oldest; the last one evaluated; the newest */
    uint16_t first;
    uint16_t count;
    uint16_t equal; /* successive samples equal to the previous one */
    uint16_t most_equal;
    uint32_t taken_ticks;
    wh_real taken_N;
    uint32_t newest_ticks;
    wh_real newest_N;
    uint32_t refused; /* samples that were not ok, or out of order: left out */

    /* the turn being evaluated */
    wh_lockin_turn next;
    uint16_t next_equal;
    wh_real part_per_tick;
    wh_lockin_orders expected_N;
    wh_real outlier_N;
    wh_lockin_orders sum;
    wh_real square;
    wh_real mean;
    wh_real widest;     /* widest gap between two nodes, as a share of the turn */
    wh_real before_rad; /* angle of the node before the last */
    wh_real before_part;
    wh_lockin_node last;   /* the last node; its weight depends on the next one */
    wh_lockin_node placed; /* the node being evaluated, unless `place` is nowhere */
    wh_repeats repeats;    /* valid until the next turn's sums begin */

    wh_lockin_turn turn; /* the last finished turn */
    wh_turn_angle angle;
    wh_real force_N[WH_LOCKIN_SAMPLES];
    uint32_t ticks[WH_LOCKIN_SAMPLES];
} wh_lockin;

#define wh_lockin_start WH_NAME(wh_lockin_start)
#define wh_lockin_forget WH_NAME(wh_lockin_forget)
#define wh_lockin_pulse WH_NAME(wh_lockin_pulse)
#define wh_lockin_compensate WH_NAME(wh_lockin_compensate)
#define wh_lockin_gap WH_NAME(wh_lockin_gap)
#define wh_lockin_load WH_NAME(wh_lockin_load)
#define wh_lockin_work WH_NAME(wh_lockin_work)
#define wh_turn_text WH_NAME(wh_turn_text)

void wh_lockin_start(const wh_rotor_config *rotor, wh_lockin *lockin);

/* Restart without resetting the counters. For use in a control step, in which clearing the samples' memory would take
 * too long. */
void wh_lockin_forget(const wh_rotor_config *rotor, wh_lockin *lockin);

/* The rotor passed sensor 0 or 1 at `ticks`, after `quarter` quarter turns (wrapping). */
void wh_lockin_pulse(wh_lockin *lockin, unsigned sensor, uint32_t ticks, uint32_t quarter);

/* Switches gravity compensation on or off in the model: see wh_turn_angle_compensate(). If it changes, the turn in progress
 * does not count. */
void wh_lockin_compensate(wh_lockin *lockin, bool fed, wh_real stall_Nm_per_V);

/* The count of quarter turns has restarted: the turn in progress does not count. */
void wh_lockin_gap(wh_lockin *lockin);

/* Take a sample of the load, in order of time. A sample that is not ok, or not newer than the last one, is left out. */
void wh_lockin_load(wh_lockin *lockin, const wh_load *load);

/* Does a bounded piece of the work, once a control step: `halves` half nodes of a turn's sums, or
 * WH_LOCKIN_HALVES_AT_ONCE if the step has no other work. Returns true if this call has finished another
 * lockin->turn. */
bool wh_lockin_work(const wh_rotor_config *rotor, const wh_cell_config *cell, wh_lockin *lockin,
                    unsigned halves);

/* Why a turn does not count, in words. */
const char *wh_turn_text(wh_turn_fault fault);

#ifdef __cplusplus
}
#endif

#endif
