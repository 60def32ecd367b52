/* lockstep.h: runs in which firmware and plant (or a tape) take turns. Each side waits for the other, so a run is
 * reproducible. Each instruction of the firmware takes instruction_s of plant time. This delays the firmware's outputs,
 * and can delay its next readings. */
#ifndef PIL_LOCKSTEP_H
#define PIL_LOCKSTEP_H

#include <stdio.h>

#include "host/os/guest.h"
#include "host/pil/plant.h"

/* The interface for faults (fault.h) and observers. start() is called before the first message. orders() may change
 * each message of the firmware, and delay it by adding to *late_s. readings() may change each message to the firmware.
 * A tape has the original orders, but the changed readings. A NULL function is not called. */
typedef struct tap {
    void *of;
    bool (*start)(void *of, const wh_hello *hello,
                  plant *plant); /* false after an error (reported) */
    void (*orders)(void *of, double time_s, wh_orders *orders, double *late_s);
    void (*readings)(void *of, double time_s, wh_readings *readings);
    void (*watch)(void *of, double time_s,
                  const plant *plant); /* at least every millisecond of plant time */
} tap;

typedef struct lockstep_request {
    guest_request guest;
    plant_request plant;
    const char *renames;  /* see bind_signals() */
    double until_s;       /* end of the run, unless the firmware ends before */
    double instruction_s; /* time of one instruction */
    FILE *tape;           /* NULL: no tape */
    const tap *taps;      /* [tap_count] */
    int tap_count;
} lockstep_request;

typedef enum lockstep_end {
    LOCKSTEP_DONE,      /* the firmware ended, with `status` */
    LOCKSTEP_LET_GO,    /* the run reached until_s, or the end of the tape */
    LOCKSTEP_BAD,       /* impossible settings (reported) */
    LOCKSTEP_FAILED,    /* reported */
    LOCKSTEP_DIFFERENT, /* the orders differ from the tape's (reported) */
    LOCKSTEP_STOPPED    /* interrupted */
} lockstep_end;

/* A maximum, and its time. */
typedef struct peak {
    double value;
    double at_s;
} peak;

/* The last value of a note that the firmware reports. */
typedef struct last_note {
    char name[32];
    char unit[16];
    double value;
} last_note;

typedef struct lockstep_report {
    lockstep_end end;
    guest_end_status status;
    char program[40];
    char board[40];
    uint64_t exchanges;
    last_note note[WH_SIGNALS_MAX];
    unsigned notes;
    double time_s; /* plant time */
    double wall_s;
    bool counted; /* instructions are counted */
    peak acted;   /* instructions from the readings to the outputs */
    peak busy;    /* instructions from the readings to the firmware's next wait */
    uint64_t overruns;
    peak late_s; /* delay of readings after the requested time */
    uint64_t edges;
    uint64_t samples;
    uint64_t lost;
    bool cut; /* the watchdog has cut the outputs */
    double cut_s;
    unsigned resets;     /* resets of the processor */
    double reset_s;      /* of the last reset */
    uint64_t hash;       /* of all orders, without instruction counts */
    uint64_t plant_hash; /* of the plant's last state */
} lockstep_report;

/* === frames ===================================================================================== */
/* Receives and records the firmware's messages, for a run in the loop and for the replay of a tape. */

typedef struct talk {
    const lockstep_request *request;
    lockstep_report *report;
    guest guest;
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    uint8_t words[GUEST_LINE_BYTES]; /* texts of the hello */
    unsigned outputs;                /* number of outputs and notes */
    uint16_t sequence;               /* number of the present exchange, from 0 after each start */
    wh_reset remembered;             /* data that the firmware keeps over a reset */
    bool said_end;                   /* the firmware sent WH_FRAME_END with end_status */
    int end_status;
    FILE *tape;
} talk;

/* Starts the guest and receives its hello. Returns false after an error (reported; reason in report->end). */
bool talk_start(talk *t, const lockstep_request *request, lockstep_report *report, FILE *onto);

/* Ends the guest, starts a new one, and sends it `reset` with the time `ticks`. Returns false after an
 * error (reported) or an interrupt (reason in report->end). */
bool talk_restart(talk *t, uint32_t ticks, const wh_reset *reset);

/* Sends readings at `ticks`. Returns false if the guest is gone, or the user interrupts (reason in report->end). */
bool talk_tell(talk *t, uint32_t ticks, const wh_readings *readings);

/* Receives the answer to the last readings. Returns false like talk_tell(), and at the firmware's normal end. */
bool talk_hear(talk *t, wh_orders *orders);

/* Ends the guest. An abnormal end is reported. */
void talk_end(talk *t);

/* Adds orders, without their instruction counts, to a hash. */
uint64_t talk_hash(uint64_t hash, const wh_orders *orders);

/* Adds `count` and the bytes to a hash. */
uint64_t talk_hash_bytes(uint64_t hash, const uint8_t *bytes, unsigned count);

/* Are program, ticks_per_s, start_ticks and signals equal? Ignores timer_per_s and the board. */
bool talk_is_same_hello(const wh_hello *one, const wh_hello *other);

/* Instructions per tick, if the firmware's timer counts them; else 0. */
double talk_instructions_per_count(const wh_hello *hello);

/* Runs firmware and plant. The firmware's process has ended on return. */
void lockstep_run(const lockstep_request *request, const image *im, lockstep_report *report);

/* Runs the firmware on a tape's readings. Its orders must equal the tape's, except for instruction counts. */
void lockstep_replay(const lockstep_request *request, const char *file, lockstep_report *report);

/* Prints the report. `im` is the plant's image, or NULL after a replay of a tape. */
void pil_print(FILE *out, const lockstep_request *request, const image *im,
               const lockstep_report *r);

/* Prints a tape as a table with these columns:
 *
 *   time: when the event occurred, s since the plant's time 0.
 *   heard: when the firmware received or sent it, s since the plant's time 0.
 *   kind: edge, sample, output, note, reset, or cut (the watchdog has cut the outputs).
 *   channel (from 1 in each kind), signal, value, unit. An edge has no value.
 *   status: good, saturated or disconnected for a sample; watchdog or other for a reset.
 *
 * An output or note has a row only when it changes. If `csv` is NULL or "-", prints to standard output. Returns false
 * (reported) if reading or writing is incomplete. */
bool taped_show(const char *name, const char *csv);

#endif
