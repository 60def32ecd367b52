/* station.h: the rig's console: one line in, one line out.
 *
 *     OK name=value name=value: words         ERR number words
 *
 * The console never waits: bytes go through rings, and an answer that does not fit is dropped as a whole and counted.
 *
 *     every control step, after wh_rig_step() and the motor's command:
 *         wh_station_see(&station, &config, &rig, &seen)  for telemetry, if compiled in
 *         wh_station_take(&station, bytes, count)         the received bytes
 *         wh_station_step(&station, &rig)                 at most the work of one line
 *         count = wh_station_peek(&station, bytes, room)  bytes to send
 *         wh_station_drop(&station, sent)                 removes the bytes that were sent
 *
 * Orders go through wh_rig_post(), and the rig answers them. Escape drops the waiting input and acts as `stop`. */
#ifndef WH_STATION_STATION_H
#define WH_STATION_STATION_H

#include "conf.h"
#include "core/rig/rig.h"
#include "line.h"
#include "ring.h"
#include "step_inputs.h"
#include "telemetry.h"

#define WH_TEL_FOLLOWS " list|schema CHANNEL|rate N|off|fmt FORMAT|ring [pulse|fault|off|read]"

/* The commands: X(name, maximum number of arguments, arguments in the help, description) */
#define WH_COMMAND_ROWS(X) \
    X(help, 1, " [COMMAND]", "list the commands, or explain one") \
    X(id, 0, "", "program, board, version of this dialogue") \
    X(arm, 0, "", "allow a start, for a minute") \
    X(start, 1, " RPM", "a test run at this set-point") \
    X(set, 1, " RPM", "change the set-point during a run") \
    X(stop, 0, "", "motor off; also the Escape key, at once") \
    X(status, 0, "", "state, speeds, voltage, trip, verdict, losses, run and its end") \
    X(measure, 0, "", "result, intervals and verdict of the last run") \
    X(fault, 0, "", "the latched trip, the values at that moment, and how the last run ended") \
    X(clear, 0, "", "release a trip whose cause is gone") \
    X(conf, 3, " list [FROM]|get NAME|set NAME VALUE|save|default", \
      "settings; only while idle: set, save, default") \
    X(tel, 2, WH_TEL_FOLLOWS, "telemetry on the same line; off after a reset") \
    X(selftest, 0, "", "test at rest: arithmetic, cell, supply, stop input") \
    X(host, 1, " SECONDS", \
      "a run ends after this time without a byte; overrides the setting host until a reset") \
    X(talk, 1, " on|off", "echo typed characters, report each new state")

/* 0 omits telemetry, for small chips: station->tel stays NULL. */
#ifndef WH_STATION_TELEMETRY
#define WH_STATION_TELEMETRY 1
#endif

/* Bytes in the rings for input and output. Telemetry fills at most half of the output ring. */
#ifndef WH_STATION_IN_BYTES
#define WH_STATION_IN_BYTES 256U
#endif
#ifndef WH_STATION_OUT_BYTES
#define WH_STATION_OUT_BYTES 1024U
#endif

/* Do not copy a started station: its rings point into it. Large members come last to make the code shorter. */
typedef struct wh_station {
    bool talks;
    bool escaped;        /* Escape was received: the next order is `stop` */
    bool spoils;         /* a received byte was lost: the rest of its line is invalid */
    bool waits;          /* the console waits for the rig's answer to an order */
    uint32_t answers;    /* rig->answers before the order; another value means an answer */
    const char *program; /* the caller's string */
    const char *board;
    wh_conf *conf;               /* NULL: no settings */
    wh_tel *tel;                 /* NULL: no telemetry */
    const wh_rig_config *config; /* configuration of the last step */
    const wh_step_inputs *seen;  /* observations of the last step */
    uint32_t steps_per_s;        /* calls of wh_station_step() per second */
    unsigned stage;              /* the stage that was reported last */
    uint32_t lost_bytes;         /* number of received bytes that did not fit into `in` */
    uint32_t lost_answers;       /* number of answers that did not fit into `out` */
    bool host_given;             /* host_steps replaces the setting `host` */
    /* the host is lost after this many steps without a byte; 0: never */
    uint32_t host_steps;
    uint32_t silent_steps;
    uint32_t host_losses;
    wh_ring in;
    wh_ring out;
    wh_line line;
    char in_bytes[WH_STATION_IN_BYTES];
    char out_bytes[WH_STATION_OUT_BYTES];
} wh_station;

/* Starts the console. `steps_per_s` is the rate of wh_station_step(). Afterwards the caller sets conf and tel. */
void wh_station_start(wh_station *station, const char *program, const char *board,
                      uint32_t steps_per_s);

/* Takes received bytes. An Escape immediately drops the bytes before it. */
void wh_station_take(wh_station *station, const char *bytes, unsigned count);

/* Passes the last step to telemetry and self-test. *config and *seen must stay unchanged until the next step. */
void wh_station_see(wh_station *station, const wh_rig_config *config, const wh_rig *rig,
                    const wh_step_inputs *seen);

/* Executes the oldest line, if the previous line is answered. If the host has been silent for the time set by `host`,
 * posts WH_EVENT_HOST_LOST once; the configuration decides whether the run ends. */
void wh_station_step(wh_station *station, wh_rig *rig);

/* Copies the oldest bytes to send, at most `room`, and returns their number. */
static inline unsigned wh_station_peek(const wh_station *station, char *bytes, unsigned room) {
    return (unsigned)wh_ring_peek(&station->out, bytes, room);
}

static inline void wh_station_drop(wh_station *station, unsigned count) {
    wh_ring_drop(&station->out, count);
}

#endif
