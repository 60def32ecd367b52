/* state_machine.h: the rig's life cycle: its states, the events that each state allows, and the refusals.
 *
 *      IDLE --arm--> ARMED --start--> RUNNING --done, stop--> STOPPING --rested--> IDLE
 *        \_____________\________________\_______trip___________/--> TRIPPED --clear--> IDLE
 *
 * The motor moves only after `arm` and then `start`. One table has every pair of state and event. Further conditions of
 * an event (supply in range, rig at rest) are tested in rig.c; their refusals are listed here. */
#ifndef WH_RIG_STATE_MACHINE_H
#define WH_RIG_STATE_MACHINE_H

#include "core/real.h"

WH_C_BEGIN

/* The states: X(name, words) */
#define WH_RIG_STATE_ROWS(X) \
    X(WH_RIG_IDLE, "idle")         /* motor off; the guard checks the rotor */ \
    X(WH_RIG_ARMED, "armed")       /* motor off; `start` is allowed for a minute */ \
    X(WH_RIG_RUNNING, "running")   /* a test run: phases.h has its phases */ \
    X(WH_RIG_STOPPING, "stopping") /* phase `ramp down` or `coast`, until the rotor rests */ \
    X(WH_RIG_TRIPPED, "tripped")   /* motor off; latched until `clear` */

/* Events: X(name, words). The orders from outside come first, then the rig's own events. */
#define WH_EVENT_ROWS(X) \
    X(WH_EVENT_ARM, "arm") \
    X(WH_EVENT_START, "start")         /* value: set-point, rad/s */ \
    X(WH_EVENT_SET, "set")             /* value: another set-point, rad/s */ \
    X(WH_EVENT_STOP, "stop")           /* motor off at once */ \
    X(WH_EVENT_CLEAR, "clear")         /* the user has removed the trip's cause */ \
    X(WH_EVENT_HOST_LOST, "host lost") /* the sender of orders is gone: stop if so configured */ \
    X(WH_EVENT_DONE, "done")           /* the run is complete */ \
    X(WH_EVENT_RESTED, "rested")       /* the rotor rests */ \
    X(WH_EVENT_EXPIRED, "expired")     /* armed for too long */ \
    X(WH_EVENT_TRIP, "trip")           /* the guard has a reason to stop */

/* Refusals: X(name, number, words). Numbers are for consoles and records, and never change. */
#define WH_REFUSAL_ROWS(X) \
    X(WH_ALLOWED, 0, "done") \
    X(WH_REFUSED_NOT_ARMED, 1, "the rig is not armed") \
    X(WH_REFUSED_ARMED, 2, "the rig is armed already") \
    X(WH_REFUSED_RUNNING, 3, "the rig is running") \
    X(WH_REFUSED_STOPPING, 4, "the rig is stopping") \
    X(WH_REFUSED_TRIPPED, 5, "a trip is latched: clear it first") \
    X(WH_REFUSED_NO_TRIP, 6, "there is no trip to clear") \
    X(WH_REFUSED_NOT_RUNNING, 7, "the rig is not running") \
    X(WH_REFUSED_STOP_INPUT, 8, "the stop input is pressed") \
    X(WH_REFUSED_SUPPLY, 9, "the motor's supply is out of its range") \
    X(WH_REFUSED_CLOCK, 10, "the fallback clock is in use: speeds would be wrong") \
    X(WH_REFUSED_TURNING, 11, "the rotor is not at rest") \
    X(WH_REFUSED_LOAD_CELL, 12, "the load cell has no valid samples") \
    X(WH_REFUSED_WATCHDOG, 13, "the watchdog has cut the drive: reset the board") \
    X(WH_REFUSED_TARGET, 14, \
      "the set-point is too low for the control loop or too high for the shaft") \
    X(WH_REFUSED_VOLTAGE, 15, "the supply is too low for the set-point") \
    X(WH_REFUSED_QUEUE, 16, "too many commands at once") \
    X(WH_REFUSED_EVENT, 17, "unknown command")

/* How the last run ended: X(name, words). Reset at the next start. */
#define WH_END_ROWS(X) \
    X(WH_END_NONE, "none") /* no run since the reset, or a run in progress */ \
    X(WH_END_DONE, "done") \
    X(WH_END_STOP_INPUT, "stop input") \
    X(WH_END_DRIVE_FAULT, "drive fault") \
    X(WH_END_STOP_OR_FAULT, "stop input or drive fault") /* one wire signals either */ \
    X(WH_END_STOP, "stop command") \
    X(WH_END_HOST_LOST, "host lost") \
    X(WH_END_TRIP, "trip")

#define WH_RIG_STATE_NAME(name, words) name,
#define WH_REFUSAL_NAME(name, number, words) name = (number),
typedef enum wh_rig_state { WH_RIG_STATE_ROWS(WH_RIG_STATE_NAME) WH_RIG_STATES } wh_rig_state;
typedef enum wh_rig_event { WH_EVENT_ROWS(WH_RIG_STATE_NAME) WH_EVENTS } wh_rig_event;
typedef enum wh_rig_end { WH_END_ROWS(WH_RIG_STATE_NAME) WH_ENDS } wh_rig_end;
typedef enum wh_refusal { WH_REFUSAL_ROWS(WH_REFUSAL_NAME) WH_REFUSALS } wh_refusal;
#undef WH_RIG_STATE_NAME
#undef WH_REFUSAL_NAME

typedef struct wh_rig_transition {
    wh_rig_state next;  /* the state after the event, unless rig.c refuses the event */
    wh_refusal refusal; /* if it is not WH_ALLOWED, `next` is the present state */
} wh_rig_transition;

/* Look up the table. An unknown event or state gives a refusal. */
wh_rig_transition wh_rig_transition_of(wh_rig_state state, wh_rig_event event);

const char *wh_rig_state_text(wh_rig_state state);
const char *wh_rig_event_text(wh_rig_event event);
const char *wh_refusal_text(wh_refusal refusal);
const char *wh_rig_end_text(wh_rig_end end);

WH_C_END

#endif
