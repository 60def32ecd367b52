/* guard.h: the reasons to stop the rig, checked in every state. The first reason stays until it is cleared. */
#ifndef WH_RIG_GUARD_H
#define WH_RIG_GUARD_H

#include "cell.h"
#include "datasheet.h"
#include "pulses.h"

WH_C_BEGIN

/* Reasons to stop: X(name, number, words). Consoles and records use the numbers, so no number is ever changed or
 * reused. The words have at most 95 characters: one line of the report. */
#define WH_TRIP_ROWS(X) \
    X(WH_TRIP_NONE, 0, "no fault") \
    X(WH_TRIP_OVERSPEED, 2, "over-speed") \
    X(WH_TRIP_PULSES, 3, "slot pulses are missing, too many or out of order") \
    X(WH_TRIP_STALLED, 4, "the rotor does not start, or the sensors do not see it") \
    X(WH_TRIP_LOAD_CELL, 5, "the load cell is silent, stuck, overloaded or disconnected") \
    X(WH_TRIP_WATCHDOG, 6, "the watchdog cut the motor") \
    X(WH_TRIP_MOVING, 7, "the rig was not at rest for the tare") \
    X(WH_TRIP_UNSETTLED, 8, "the speed does not settle, or does not stay settled") \
    X(WH_TRIP_RECORD, 9, "the record lacks load samples or counted turns") \
    X(WH_TRIP_RUNS_ON, 10, \
      "the rotor turns with the motor off: the stage ignores its enable, or somebody turns the rotor") \
    X(WH_TRIP_SUPPLY, 11, "the motor's supply is out of its range, or too low for the speed") \
    X(WH_TRIP_UNBRAKED, 12, \
      "the rotor does not slow when the motor brakes: the stage ignores its PWM duty or cannot brake") \
    X(WH_TRIP_FASTER, 14, \
      "a speed above the motor's limit: check no_load_speed, rated_voltage, the supply's divider") \
    X(WH_TRIP_ORDER, 15, \
      "slot pulses in the wrong order: the motor runs backwards, or the sensors are swapped")

#define WH_TRIP_NAME(name, number, words) name = (number),
typedef enum wh_trip { WH_TRIP_ROWS(WH_TRIP_NAME) } wh_trip;
#undef WH_TRIP_NAME

typedef struct wh_guard_config {
    wh_real target_min_radps; /* smallest set-point (docs/rig.md) */
    wh_real target_min_compensated_radps;
    wh_real target_max_radps; /* largest set-point */
    wh_real limit_radps;      /* largest mean speed of a turn */
    /* largest speed divided by mean speed, minus 1, within a turn at limit_radps */
    wh_real ripple;
    wh_real over; /* allowed excess over the commanded speed, as a fraction */
    /* Largest sum of wh_pulses.climb_radps and .climb_before_radps, as a fraction of the turn's speed. */
    wh_real climb;
    wh_real climb_start_radps2;  /* largest rise of speed per second as the loop takes over */
    wh_real climb_behind_radps2; /* largest rise per second while the speed lags behind */
    wh_real behind_radps;        /* climb_behind_radps2 applies above this lag */
    wh_real climb_there_radps2;  /* largest rise otherwise */
    wh_real fall_radps;          /* after a fall from the top: 2 sqrt(unbalance * g / inertia) */
    uint32_t lost_max;           /* number of pulses that may be lost in a run */
    unsigned doubt_max;          /* largest wh_pulses.doubt */
    uint32_t rejected_max;       /* number of pulses that may be rejected in a run */
    wh_real silence_max_s;       /* longest time without a pulse, in closed loop */
    wh_real slow_silence_max_s;  /* the same while the rotor starts */
    wh_real load_silence_max_s;  /* longest time without a load sample */
    /* The load counts as constant if it changes by less than this number times the square of the speed. */
    wh_real load_still_kgm;
    uint32_t stuck_pulses; /* a load that is constant over this many pulses is stuck */
    wh_real supply_min_V;
    wh_real supply_max_V;
    wh_real rest_s;       /* a rotor without a pulse for this long is at rest */
    wh_real braked_radps; /* least loss of speed of a braked rotor in a turn */
    wh_real hand_radps;   /* fastest rotor that a hand can turn */
} wh_guard_config;

/* Checks of the pulses while the motor is off or brakes. They do not depend on the commands. A turn is the time between
 * two pulses of one sensor. Gravity does no work in a turn:
 *
 * - While the motor brakes, the mean speed falls by 2 pi c/I per turn. c is the damping of the torque line. If the
 * speed falls by less than braked_radps, the enable goes off until the next run (`released`). braked_radps is half the
 * fall at six times the configured I.
 * - With the enable off, only friction acts. If a speed above hand_radps rises from turn to turn, the rig trips.
 *
 * A rotor that swings about its hanging position fires a sensor twice in each swing. The intervals between these pulses
 * are no turns. An interval counts as a turn in three cases:
 *
 * - The pulses alternate between the sensors. After an interval of sensor 1, sensor 2 must also fire next: a swing that
 * reverses in sensor 2's slot gives the pulses 1, 2, 1, too.
 * - Only one sensor fires, and two successive intervals show a speed above WH_GUARD_LIGHTER * fall_radps. In a swing,
 * two successive intervals last at least 2 pi sqrt(I/(S g)), so one of them is slower.
 * - After `released`, only one sensor fires, and its intervals get longer by at least 2 % three times in succession. A
 * swing that friction stops does this at most twice. */
typedef struct wh_off {
    bool released;
    bool doubted;      /* released while only one sensor fired */
    bool asks;         /* the rig trips unless `sensor` also gives the next pulse */
    uint8_t sensor;    /* number of the last pulse's sensor, 1 or 2; 0: no pulse yet */
    uint8_t alternate; /* successive pulses, each preceded by a pulse of the other sensor */
    uint8_t alone;     /* successive pulses, each preceded by a pulse of the same sensor */
    struct wh_off_turns {
        uint32_t ticks;
        uint32_t turn_ticks;  /* time between the sensor's last two pulses; 0: fewer than two */
        uint32_t first_ticks; /* duration of the last turn before the speed began to rise */
        uint8_t faster;       /* number of successive turns faster than the one before */
        uint8_t longer;       /* number of successive turns slower by the factor LONGER */
        bool seen;
    } of[WH_RIG_SENSORS];
} wh_off;

typedef struct wh_guard {
    wh_trip trip;
    bool quiet;     /* no pulse for rest_s */
    bool load_good; /* the last load sample was ok and is recent */
    uint32_t pulses_seen;
    uint32_t pulse_ticks;     /* time of the last pulse, accepted or not, or of the start */
    uint32_t lost_before;     /* lost pulses when the motor began to drive */
    uint32_t rejected_before; /* rejected pulses when the motor began to drive */
    uint32_t load_ticks;      /* time of the last load sample, or of the start */
    uint32_t load_pulses;     /* accepted pulses at the last load sample */
    uint32_t still_pulses;    /* load samples with a new pulse, since the load's last change */
    wh_real still_N;          /* the load at its last change */
    wh_off off;
} wh_guard;

void wh_guard_start(wh_guard *guard, uint32_t now_ticks);

/* True if a set-point is within its configured limits. `compensated`: with gravity compensation. NaN gives false. */
bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps, bool compensated);

/* Factor on wh_guard_config.fall_radps if the inertia may be half the configured one: sqrt(2), plus a margin. */
#define WH_GUARD_LIGHTER WH_R(1.5)

/* Returns a bound on the mean speed between two pulses, in rad/s: sqrt(a^2 + b^2), but at most config->limit_radps
 * (1 + config->ripple). a is limit_radps (1 + config->over). b is gravity's part, `falls` times config->fall_radps. */
wh_real wh_guard_bound_radps(const wh_guard_config *config, wh_real limit_radps, wh_real falls);

/* Returns the limit on the rise of a turn's speed, rad/s^2. behind_radps is the commanded speed minus the speed. The
 * limit is negative if the speed exceeds the commanded speed by config->behind_radps or more. */
WH_INLINE wh_real wh_guard_climb_radps2(const wh_guard_config *config, wh_real behind_radps,
                                        bool is_led) {
    if (is_led && behind_radps > config->behind_radps) {
        return config->climb_behind_radps2;
    }
    return behind_radps > -config->behind_radps ? config->climb_there_radps2
                                                : WH_R(-2.0) * config->climb_there_radps2;
}

/* Stop for this reason, unless the rig already has one. */
void wh_guard_trip(wh_guard *guard, wh_trip reason);

/* Clears guard->off. Call this when the motor begins to drive. */
void wh_guard_drives(wh_guard *guard);

/* Checks a pulse with the motor off, and may trip the rig or release the brake. `brakes`: the enable is on. */
void wh_guard_off_pulse(const wh_guard_config *config, wh_guard *guard, bool brakes,
                        unsigned sensor, uint32_t ticks);

/* Updates guard->quiet. Call this in each step, in every state. pulses_ever is the total number of pulses. */
WH_INLINE void wh_guard_quiet(const wh_guard_config *config, wh_guard *guard, uint32_t pulses_ever,
                              uint32_t now_ticks) {
    if (pulses_ever != guard->pulses_seen) {
        guard->pulses_seen = pulses_ever;
        guard->pulse_ticks = now_ticks;
        guard->quiet = false;
    } else if ((wh_real)(int32_t)(now_ticks - guard->pulse_ticks) >=
               config->rest_s * (wh_real)WH_RIG_TICKS_PER_S) {
        guard->quiet = true;
    }
}

/* Checks for over-speed. Call this in each step, in every state. The rig trips with `reason` if a turn is faster than
 * limit_radps, or if two successive pulse intervals are faster than pulses->bound_radps. One such interval suffices if
 * the speed rises faster than pulses->climb_radps2 at two successive pulses.
 *
 * `alternate` is the number of successive pulses that must alternate between the sensors. A rotor that swings with the
 * motor off can fire one sensor repeatedly. `alternate` is 0 while the motor drives. */
#define WH_GUARD_BRAKES 1U /* `alternate` while the motor brakes */
/* `alternate` with the enable off. One false pulse can corrupt several turns, so several pulses must alternate. */
#define WH_GUARD_COASTS 6U
WH_INLINE void wh_guard_speed(const wh_guard_config *config, wh_guard *guard,
                              const wh_pulses *pulses, wh_trip reason, unsigned alternate) {
    const wh_speed *speed = &pulses->speed;
    if (pulses->alternate < alternate) {
        return;
    }
    /* A pulse that is not yet confirmed may be a disturbance. */
    const bool sure = !pulses->waits || pulses->fast > 0;
    const bool climbs =
        pulses->fast > 0 && pulses->climb_before_radps > WH_R(0.0) &&
        pulses->climb_radps > WH_R(0.0) &&
        pulses->climb_before_radps + pulses->climb_radps > config->climb * speed->turn_radps;
    if ((speed->known && sure && speed->turn_radps > config->limit_radps) || pulses->fast >= 2U ||
        climbs) {
        wh_guard_trip(guard, reason);
    }
}

/* Checks while the motor drives: trips if too many pulses are lost, rejected or doubtful, or if none comes for longer
 * than silence_max_s. */
WH_INLINE void wh_guard_pulses(const wh_guard_config *config, wh_guard *guard,
                               const wh_pulses *pulses, wh_real silence_max_s, uint32_t now_ticks) {
    if (pulses->speed.lost - guard->lost_before > config->lost_max ||
        pulses->rejected - guard->rejected_before > config->rejected_max ||
        pulses->doubt > config->doubt_max ||
        wh_speed_silence_s(&pulses->speed, now_ticks) > silence_max_s) {
        wh_guard_trip(guard, WH_TRIP_PULSES);
    }
}

/* True if the supply is in its range; NaN is not. */
WH_INLINE bool wh_guard_supply(const wh_guard_config *config, wh_real supply_V) {
    return supply_V >= config->supply_min_V && supply_V <= config->supply_max_V;
}

/* Checks a load sample, in every state. `turning`: the rotor turns, so the load must change. If `needed`, a bad sample
 * trips the rig. A repeated sample is ignored. */
WH_INLINE void wh_guard_load(const wh_guard_config *config, wh_guard *guard, const wh_speed *speed,
                             const wh_load *load, bool turning, bool needed) {
    if (load->status == WH_LOAD_REPEATED) {
        return;
    }
    guard->load_ticks = load->ticks;
    guard->load_good = load->status != WH_LOAD_SATURATED && load->status != WH_LOAD_DISCONNECTED;
    if (needed && !guard->load_good) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
    /* A jammed rotor gives no pulses, so its constant load does not raise still_pulses. */
    guard->still_pulses += speed->taken != guard->load_pulses ? 1U : 0U;
    guard->load_pulses = speed->taken;
    const wh_real still_N = config->load_still_kgm * speed->turn_radps * speed->turn_radps;
    if (!turning || !(WH_ABS(load->force_N - guard->still_N) <= still_N)) {
        guard->still_pulses = 0;
        guard->still_N = load->force_N;
    } else if (guard->still_pulses >= config->stuck_pulses) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
}

WH_SHARED bool wh_guard_load_comes(const wh_guard_config *config, const wh_guard *guard,
                                   uint32_t now_ticks) {
    /* signed: a time stamp may be later than the time at which the step read the timer */
    return (wh_real)(int32_t)(now_ticks - guard->load_ticks) <=
           config->load_silence_max_s * (wh_real)WH_RIG_TICKS_PER_S;
}

const char *wh_trip_text(wh_trip reason);

WH_C_END

#endif
