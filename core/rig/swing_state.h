/* swing_state.h: the state of a free swing's evaluation (free_swing.h). */
#ifndef WH_RIG_SWING_STATE_H
#define WH_RIG_SWING_STATE_H

#include "free_rotor.h"
#include "normal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The unknowns' places. */
enum wh_swing_unknown {
    WH_SWING_Q = WH_FREE_Q,
    WH_SWING_RATE = WH_FREE_RATE,
    WH_SWING_GRAVITY = WH_FREE_GRAVITY,
    WH_SWING_FRICTION = WH_FREE_FRICTION,
    WH_SWING_DRAG = WH_FREE_DRAG,
    WH_SWING_PLACE = WH_FREE_CAUSES, /* of sensor 1; then of sensor 2 */
};

#define WH_SWING_SENSORS 2U
#define WH_SWING_TURNING 6U /* pulses stored from before the swing, */
#define WH_SWING_PULSES 36U /* and in all */
#define WH_SWING_LAST 10U   /* of sensor 1's last */

/* Pieces of the work: before a pulse or at it, the equations in two, another pass, another guess, the end. */
typedef enum wh_swing_piece {
    WH_SWING_GOES,
    WH_SWING_FACTORS,
    WH_SWING_SOLVES,
    WH_SWING_PASSES,
    WH_SWING_GUESSES,
    WH_SWING_ENDS
} wh_swing_piece;

/* The outcome: X(name, words). */
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
    wh_real lead_rad;  /* pulses come this far before the sensor, from either side */
    wh_real most_rad;  /* sensors are within this of their positions, at 95 % */
    wh_real jitter_s;  /* of the pulses, standard deviation */
    wh_real rough_rad; /* further error of a pulse, ditto: a coupling's twist */
    wh_real floor_rad; /* calibration, 95 %: slot, lead, friction that differs with the direction */
    wh_real wide_rad;  /* limit of a useful interval */
    wh_real off_rad; /* limit of sensor 1's error and its interval: beyond, results are doubtful */
    unsigned swings_least; /* half ones */
} wh_swing_config;

typedef struct wh_swung {
    wh_swing_why why;
    wh_real place_rad[WH_SWING_SENSORS]; /* when found: the sensor's position, */
    wh_real half_rad[WH_SWING_SENSORS];  /* half-widths of the intervals, 95 % */
    unsigned swings;                     /* half swings used */
} wh_swung;

typedef struct wh_swing {
    wh_swung result;
    bool free;    /* motor off, its leads open, since the last step */
    bool any;     /* there was a pulse, */
    bool forward; /* passed this way, */
    uint8_t sensor;
    bool swings;          /* the rotor has passed sensor 1 backwards: at kept[first], */
    wh_swing_piece piece; /* the next piece of the work */
    unsigned first;
    unsigned passed; /* and its later passages, stored or not */
    unsigned kept;
    unsigned start; /* guesses before this one that failed */
    unsigned pass;
    unsigned at;     /* the next pulse */
    unsigned fits;   /* pulses used in this pass, */
    unsigned strays; /* that cannot be, */
    /* and their number for each sensor: a swing seen by sensor 1 alone could be its mirror image */
    unsigned fits_of[WH_SWING_SENSORS];
    uint32_t ticks;                     /* of `way` */
    wh_real soft_rad2;                  /* variance added to the pulses' own */
    wh_free_rotor way;                  /* the rotor during a pass */
    uint32_t last_ticks[WH_SWING_LAST]; /* sensor 1's, the newest first */
    wh_real x[WH_NORMAL_UNKNOWNS];      /* q - place and q' at the first passage, g, f, c, sensor
                                    * positions, */
    wh_real guess[WH_NORMAL_UNKNOWNS];  /* as they were guessed, */
    wh_real within[WH_NORMAL_UNKNOWNS]; /* and their standard deviations */
    uint32_t kept_ticks[WH_SWING_PULSES];
    uint8_t kept_sensor[WH_SWING_PULSES];
    wh_normal normal; /* equations of this pass, in units of `within` */
} wh_swing;

#ifdef __cplusplus
}
#endif

#endif
