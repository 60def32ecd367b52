/* lockstep.h: a firmware image and a plant (or a tape in its place) that compute alternately until the firmware ends.
 * Each waits while the other computes, so a run is reproducible at any speed. The firmware's computing costs plant
 * time: its counted instructions times the seconds for each. This delays its outputs, and its next readings. */
#ifndef PIL_LOCKSTEP_H
#define PIL_LOCKSTEP_H

#include "host/pil/report.h"

/* === frames ===================================================================================== */
/* The common part of a run in the loop and the replay of a tape: receiving the firmware's messages, and recording them. */

typedef struct talk {
    const lockstep_wish *wish;
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

/* Start the guest and receive its hello. False, reported: report->end has the reason. */
bool talk_start(talk *t, const lockstep_wish *wish, lockstep_report *report, FILE *onto);

/* Restart the processor after a reset: a new guest, which knows only the data of the reset; `ticks` goes on the tape.
 * Returns false, and reports the reason, if it does not start, sends another hello, or the user interrupts. */
bool talk_restart(talk *t, uint32_t ticks, const wh_reset *reset);

/* Send readings at `ticks`. Returns false if the guest is gone, or the user interrupts; report->end has the reason. */
bool talk_tell(talk *t, uint32_t ticks, const wh_readings *readings);

/* Receive the orders that answer the last readings. False as above, and also after the firmware's end, which is no error. */
bool talk_hear(talk *t, wh_orders *orders);

/* End the guest; an abnormal end is reported. */
void talk_end(talk *t);

/* Mix orders into a hash of all of them: everything except instruction counts. */
uint64_t talk_hash(uint64_t hash, const wh_orders *orders);

/* Mix the remembered data into the hash. */
uint64_t talk_hash_bytes(uint64_t hash, const uint8_t *bytes, unsigned count);

/* Are program, ticks and signals equal? The timer that counts instructions may differ. */
bool talk_is_same_hello(const wh_hello *one, const wh_hello *other);

/* If the firmware's timer counts instructions, the number of instructions in a tick; else 0. */
double talk_instructions_per_count(const wh_hello *hello);

/* Run firmware and plant; the firmware's process is gone on return. */
void lockstep_run(const lockstep_wish *wish, const image *im, lockstep_report *report);

/* Run the firmware again on the readings of a tape. Each of its orders must equal the tape's, except for instruction counts. */
void lockstep_replay(const lockstep_wish *wish, const char *file, lockstep_report *report);

#endif
