/* free_swing.h: where the sensors stand, from the swing in which a rotor comes to rest.
 *
 * Nothing that a run measures tells a sensor that stands off its place from a force that is out of line with the masses:
 * the phase is off by as much. What tells is where the arms hang. Once the motor's leads are open nothing but gravity
 * and friction moves the rotor (free_rotor.h). With q(t) -q(t) is a motion of it, too: between two passages of q = 0 it
 * takes as long on the right as on the left, friction or not, but for what a swing loses to the next. A sensor at p is
 * passed at p - lead to the right and at p + lead to the left, since pulses come at the slot's leading edge. So the lead
 * cancels, and half a swing on the right is shorter than one on the left by 4 p/v, v the speed at the bottom: a slow rotor
 * shows most.
 *
 * That takes v beside times, thus an amplitude A. By the pendulum's first integral v^2 = 4 g sin^2(A/2), and half a swing
 * takes 2 K(sin(A/2))/sqrt(g), K the complete elliptic integral of the first kind. The last swings are small: their
 * period gives g = S g0/I, the first one's time then its amplitude, and how many there are the friction. This is a guess within
 * some 10 %, from pulses alone. Made exact it is by regression: Gauss's, of the times of all pulses, for q, q' at the
 * first passage of the bottom backwards, g, Coulomb's and viscous friction over I, and both sensors' places, along the
 * equation of motion, forwards to the swings and backwards to the last turns. There, and where the amplitude is above 90 deg,
 * sensor 2 is passed, and two angles are known instead of one. Pulses that are far off end a pass; the first passes count
 * all of them as uncertain by some degrees, less from pass to pass: in one go it would not always get there.
 *
 * The interval is that of the regression, wider by what the pulses are off more than they should be, and the floor.
 *
 * While the rotor swings its pulses are kept. Once it rests each control step does a piece of a pass: three steps of the
 * equation, or one pulse, or a part of the equations' solution; in all that is some seconds. */
#ifndef WH_RIG_FREE_SWING_H
#define WH_RIG_FREE_SWING_H

#include "free_rotor.h"
#include "normal.h"
#include "result.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_SWING_SENSORS 2U
#define WH_SWING_TURNING 6U /* pulses that are kept from before the swing, */
#define WH_SWING_PULSES 36U /* and in all */
#define WH_SWING_LAST 10U   /* of sensor 1's last */

/* Pieces of the work: on the way to a pulse or at it, the equations in two, another pass, another guess, the end. */
typedef enum wh_swing_piece {
    WH_SWING_GOES,
    WH_SWING_FACTORS,
    WH_SWING_SOLVES,
    WH_SWING_PASSES,
    WH_SWING_GUESSES,
    WH_SWING_ENDS
} wh_swing_piece;

/* What became of it: X(name, words). */
#define WH_SWING_ROWS(X) \
    X(WH_SWING_NONE, "no run has ended in a free swing") \
    X(WH_SWING_SWINGS, "the rotor is not at rest yet") \
    X(WH_SWING_WORKS, "its pulses are being looked at") \
    X(WH_SWING_FOUND, "found") \
    X(WH_SWING_NOT_FREE, "the rotor did not come to rest freely") \
    X(WH_SWING_FEW, "too few swings: friction stops the rotor") \
    X(WH_SWING_MISFIT, "the pulses are not those of a free swing") \
    X(WH_SWING_SIDES, "nothing tells right from left: sensor 2 was not passed") \
    X(WH_SWING_WIDE, "the swings do not tell it: the interval is too wide")

#define WH_SWING_NAME(name, words) name,
typedef enum wh_swing_why { WH_SWING_ROWS(WH_SWING_NAME) WH_SWING_WHYS } wh_swing_why;
#undef WH_SWING_NAME

typedef struct wh_swing_config {
    wh_real lead_rad;  /* pulses come so far before the sensor, from either side */
    wh_real most_rad;  /* sensors stand within this off their places, at 95 % */
    wh_real jitter_s;  /* of the pulses, standard deviation */
    wh_real rough_rad; /* what else is off at a pulse, ditto: a coupling's twist */
    wh_real floor_rad; /* calibration, 95 %: slot, lead, friction that is not the same either way */
    wh_real wide_rad;  /* a wider interval says nothing */
    wh_real off_rad; /* a sensor 1 off its place by this and its interval makes a result doubtful */
    unsigned swings_least; /* half ones */
} wh_swing_config;

typedef struct wh_swung {
    wh_swing_why why;
    wh_real place_rad[WH_SWING_SENSORS]; /* when found: how far on a sensor stands, */
    wh_real half_rad[WH_SWING_SENSORS];  /* half-widths of the intervals, 95 % */
    unsigned swings;                     /* half ones, from which that comes */
} wh_swung;

typedef struct wh_swing {
    wh_swung result;
    bool free;    /* motor off, its leads open, since the last step */
    bool any;     /* there was a pulse, */
    bool forward; /* passed this way, */
    uint8_t sensor;
    bool swings; /* the rotor has passed sensor 1 backwards: at kept[first], */
    unsigned first;
    unsigned passed; /* and then so often, kept or not */
    uint32_t kept_ticks[WH_SWING_PULSES];
    uint8_t kept_sensor[WH_SWING_PULSES];
    unsigned kept;
    uint32_t last_ticks[WH_SWING_LAST]; /* sensor 1's, the newest first */

    wh_real x
        [WH_NORMAL_UNKNOWNS]; /* q - place and q' at the first passage, g, f, c, the sensors' places, */
    wh_real guess[WH_NORMAL_UNKNOWNS];  /* as they were guessed, */
    wh_real within[WH_NORMAL_UNKNOWNS]; /* and how well: standard deviations */
    wh_free_rotor way;                  /* where the rotor is on a pass, at `ticks` */
    uint32_t ticks;
    unsigned start; /* guesses before this one led nowhere */
    unsigned pass;
    unsigned at;          /* the pulse that is next */
    wh_swing_piece piece; /* of the work, that is next */
    wh_normal normal;     /* equations of this pass, in units of `within` */
    wh_real soft_rad2;    /* variance that pulses are given beside their own */
    unsigned fits;        /* pulses that were taken on this pass, */
    unsigned strays;      /* that cannot be, */
    unsigned swung;       /* of sensor 1, */
    unsigned sided; /* of sensor 2: a swing seen from sensor 1 alone could be its mirror image */
} wh_swing;

#define wh_swing_pulse WH_NAME(wh_swing_pulse)
#define wh_swing_step WH_NAME(wh_swing_step)
#define wh_swing_doubt WH_NAME(wh_swing_doubt)
#define wh_swing_text WH_NAME(wh_swing_text)

/* A pulse of sensor 0 or 1 as it comes, in order of time. */
void wh_swing_pulse(wh_swing *swing, unsigned sensor, uint32_t ticks);

/* Every control step. `swings`: the rotor turned forwards, or has by now swung out, after a run, and since then the motor's leads
 * are open. Once they are not, it rests if `rests`; else it was stopped, and that was no free swing. A bounded
 * piece of the work is done in each step in which it rests, while wh_swing_works(). */
void wh_swing_step(const wh_swing_config *config, const wh_rotor_config *rotor, wh_swing *swing,
                   bool swings, bool rests);

/* There are pulses that are still being looked at. */
WH_INLINE bool wh_swing_works(const wh_swing *swing) { return swing->result.why == WH_SWING_WORKS; }

/* Where sensor 1 was found off its place a good result is doubtful: its phase is off by as much. */
void wh_swing_doubt(const wh_swing_config *config, const wh_swing *swing, wh_measured *measured);

/* In words, for consoles. */
const char *wh_swing_text(wh_swing_why why);

#ifdef __cplusplus
}
#endif

#endif
