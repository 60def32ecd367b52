/* taping.h: what a rig's control steps saw and answered, from its telemetry's channel `tape`, as a tape that `whirl pil --replay`
 * gives to its controller again (core/step_tape.h, core/exchange.h). It ends where the first frame of them is missing. */
#ifndef MONITOR_TAPING_H
#define MONITOR_TAPING_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "core/step_tape.h"
#include "wire.h"

/* All zeros but `out`: nothing has come. */
typedef struct taping {
    FILE *out;  /* stays the caller's */
    bool asked; /* a hello is on it, */
    bool began; /* and the controller's start */
    bool over;
    bool lost;       /* it ends before it should */
    const char *why; /* it is over */
    bool any;
    uint16_t next;     /* the channel's */
    uint16_t sequence; /* the tape's */
    uint32_t begin_ticks;
    int64_t length_ticks;
    uint64_t steps;
    wh_taped_before before;
    wh_readings start; /* settings, so far as they are not on the tape */
} taping;

/* A frame of the channel. */
void taping_frame(taping *t, const wire_frame *frame);

/* The rig began anew: so no more belongs to this tape. */
void taping_anew(taping *t);

#endif
