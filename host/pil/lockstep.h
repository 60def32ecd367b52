/* lockstep.h: a firmware image and a plant (or a tape in its place) that compute alternately until the firmware ends.
 * Each waits while the other computes, so a run is reproducible at any speed. The firmware's computing costs plant
 * time: its counted instructions times the seconds for each. This delays its outputs, and its next readings. */
#ifndef PIL_LOCKSTEP_H
#define PIL_LOCKSTEP_H

#include <stdio.h>

#include "host/os/guest.h"
#include "host/pil/plant.h"

/* The interface for faults (fault.h) and observers, which may read and change messages. Its functions are called before
 * the first message, after each message of the firmware, and before each message to the firmware. orders() may add
 * *late_s to the time of the answer. A tape has the messages as the firmware received and sent them. NULL: no call. */
typedef struct tap {
    void *of;
    bool (*start)(void *of, const wh_hello *hello, plant *plant); /* false: reported */
    void (*orders)(void *of, double time_s, wh_orders *orders, double *late_s);
    void (*readings)(void *of, double time_s, wh_readings *readings);
    void (*watch)(void *of, double time_s,
                  const plant *plant); /* called at least every millisecond of plant time */
} tap;

typedef struct lockstep_request {
    guest_request guest;
    plant_request plant;
    const char *renames;  /* see bind_signals() */
    double until_s;       /* the end of the run, if the firmware has not ended */
    double instruction_s; /* time for one instruction */
    FILE *tape;           /* NULL: no tape */
    const tap *taps;      /* [tap_count] */
    int tap_count;
} lockstep_request;

typedef enum lockstep_end {
    LOCKSTEP_DONE,      /* the firmware ended, with `status` */
    LOCKSTEP_LET_GO,    /* the run reached until_s, or the tape ended */
    LOCKSTEP_BAD,       /* impossible settings (reported) */
    LOCKSTEP_FAILED,    /* reported */
    LOCKSTEP_DIFFERENT, /* the orders differ from the tape's (reported) */
    LOCKSTEP_STOPPED    /* interrupted */
} lockstep_end;

/* The maximum of a quantity, and its time. */
typedef struct peak {
    double value;
    double at_s;
} peak;

/* A note of the firmware, which is a value that it reports about itself: name, unit and last value. */
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
    double time_s; /* time of the plant, s */
    double wall_s;
    bool counted; /* the firmware counts its instructions */
    peak acted;   /* instructions from the readings until the outputs were set */
    peak busy;    /* instructions until the firmware waited again */
    uint64_t overruns;
    peak late_s; /* delay after the requested time of the next readings */
    uint64_t edges;
    uint64_t samples;
    uint64_t lost;
    bool cut;            /* the watchdog has cut the outputs */
    double cut_s;        /* time of the cut */
    unsigned resets;     /* resets of the firmware's processor */
    double reset_s;      /* time of the last reset */
    uint64_t hash;       /* hash of all orders, without instruction counts */
    uint64_t plant_hash; /* hash of the last state of the plant */
} lockstep_report;

/* === frames ===================================================================================== */
/* The common part of a run in the loop and the replay of a tape: receiving the firmware's messages, and recording them. */

typedef struct talk {
    const lockstep_request *request;
    lockstep_report *report;
    guest guest;
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    uint8_t words[GUEST_LINE_BYTES]; /* texts of the hello */
    unsigned outputs;                /* declared outputs, followed by notes */
    uint16_t sequence;               /* number of the last readings */
    wh_reset remembered;             /* data that the firmware wants to find after a reset */
    bool said_end;                   /* the firmware sent WH_FRAME_END with end_status */
    int end_status;
    FILE *tape; /* file for the tape, or NULL */
} talk;

/* Start the guest and receive its hello. Returns false after an error, which it has reported; report->end has the
 * reason. */
bool talk_start(talk *t, const lockstep_request *request, lockstep_report *report, FILE *onto);

/* Restart the processor after a reset: a new guest, which knows only the data of the reset; `ticks` goes on the tape.
 * Returns false, and reports the reason, if it does not start, sends another hello, or the user interrupts. */
bool talk_restart(talk *t, uint32_t ticks, const wh_reset *reset);

/* Send readings at `ticks`. Returns false if the guest is gone, or the user interrupts; report->end has the reason. */
bool talk_tell(talk *t, uint32_t ticks, const wh_readings *readings);

/* Receive the orders that answer the last readings. Returns false as talk_tell() does, and also after the firmware's
 * end, which is no error. */
bool talk_hear(talk *t, wh_orders *orders);

/* End the guest; an abnormal end is reported. */
void talk_end(talk *t);

/* Mixes orders, except their instruction counts, into a hash. */
uint64_t talk_hash(uint64_t hash, const wh_orders *orders);

/* Mix the remembered data into the hash. */
uint64_t talk_hash_bytes(uint64_t hash, const uint8_t *bytes, unsigned count);

/* Are program, ticks and signals equal? The timer that counts instructions may differ. */
bool talk_is_same_hello(const wh_hello *one, const wh_hello *other);

/* If the firmware's timer counts instructions, the number of instructions in a tick; else 0. */
double talk_instructions_per_count(const wh_hello *hello);

/* Run firmware and plant; the firmware's process is gone on return. */
void lockstep_run(const lockstep_request *request, const image *im, lockstep_report *report);

/* Run the firmware again on the readings of a tape. Each of its orders must equal the tape's, except for instruction counts. */
void lockstep_replay(const lockstep_request *request, const char *file, lockstep_report *report);

/* The report. `im` is the plant's; NULL for a tape. */
void pil_print(FILE *out, const lockstep_request *request, const image *im,
               const lockstep_report *r);

/* Prints a tape as a table: a row for each input and output of the firmware. Its columns:
 *
 *   the event's time, by its stamp, and the time when the firmware received or sent it, s since the plant's time 0.
 *   the kind: edge, sample, output, note; cut: the watchdog has cut the outputs.
 *   the channel of that kind, from 1, and its signal.
 *   value and unit.
 *   a sample's quality: good, saturated, disconnected.
 *
 * An edge has no value. Outputs and notes have a row at each change. `csv` NULL or "-": standard output. Returns false,
 * and reports the reason, if reading or writing is incomplete. */
bool taped_show(const char *name, const char *csv);

#endif
