/* talk.h: what a run in the loop and the replay of a tape have in common: hearing the firmware, and what is kept of it. */
#ifndef PIL_TALK_H
#define PIL_TALK_H

#include "host/pil/report.h"

typedef struct talk {
    const lockstep_wish *wish;
    lockstep_report *report;
    guest guest;
    wh_hello hello;
    wh_signal signal[WH_SIGNALS_MAX];
    uint8_t words[GUEST_LINE_BYTES]; /* of the hello */
    unsigned outputs;                /* that it declares, and notes behind them */
    uint16_t sequence;               /* of the last readings */
    wh_reset remembered;             /* what the firmware wants to find after a reset */
    bool said_end;                   /* the firmware, with this status: WH_FRAME_END */
    int end_status;
    FILE *tape; /* or NULL */
} talk;

/* Starts the guest and hears its hello. False: report->end says why, and it was reported. */
bool talk_start(talk *t, const lockstep_wish *wish, lockstep_report *report, FILE *onto);

/* The processor was reset and starts again: another guest, which knows nothing but what the reset tells it; `ticks` goes on
 * the tape. False, reported: it does not start, says another hello, or somebody interrupts. */
bool talk_restart(talk *t, uint32_t ticks, const wh_reset *reset);

/* Sends readings at `ticks`. False: the guest is gone, or somebody interrupts; report->end says. */
bool talk_tell(talk *t, uint32_t ticks, const wh_readings *readings);

/* Hears the orders that answer the last readings. False as above, and when the firmware has ended, which is no error. */
bool talk_hear(talk *t, wh_orders *orders);

/* Ends the guest; what is wrong with how it ended is reported. */
void talk_end(talk *t);

/* Mixes orders into a hash of them all: everything but what was counted. */
uint64_t talk_hash(uint64_t hash, const wh_orders *orders);

/* Mixes what is to be remembered into it. */
uint64_t talk_hash_bytes(uint64_t hash, const uint8_t *bytes, unsigned count);

/* All that matters to the exchange; not who speaks, nor how it counts. */
bool talk_is_same_hello(const wh_hello *one, const wh_hello *other);

/* Is the time of the firmware's timer counted, and how many instructions is one count? 0: it is not. */
double talk_instructions_per_count(const wh_hello *hello);

#endif
