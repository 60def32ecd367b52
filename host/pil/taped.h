/* taped.h: reading what `whirl pil --tape` has kept: the frames that went over the line, in their order: hello, then readings
 * and orders in turns; hello and a reset where the firmware was started again. */
#ifndef PIL_TAPED_H
#define PIL_TAPED_H

#include <stdio.h>

#include "core/exchange.h"
#include "guest.h"

typedef struct taped {
    const char *name;
    FILE *file;
    wh_hello hello; /* whose firmware it was */
    wh_signal signal[WH_SIGNALS_MAX];
    uint64_t hash;  /* of all orders so far, and of what was to be remembered */
    uint64_t turns; /* read so far */
    uint16_t sequence;
    double before_s; /* the last reset */
    bool failed;     /* it cannot be read, or is broken: reported */
    wh_frame_reader reader;
    bool endless; /* no frame where there had to be one */
    uint8_t bytes[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
    uint8_t words[GUEST_LINE_BYTES]; /* of the hello */
} taped;

/* What the firmware heard at `ticks`, and what it said to that; or a reset, with which its timer begins anew. */
typedef struct taped_turn {
    uint32_t ticks;
    double time_s; /* of the plant */
    bool is_reset; /* then there is nothing of the rest but this: */
    wh_reset reset;
    wh_readings readings;
    bool answered; /* false: the firmware had ended, or was let go */
    wh_orders orders;
} taped_turn;

/* Reads the hello. False: reported. taped_close() in any case. */
bool taped_open(taped *t, const char *name);
void taped_close(taped *t);

/* False at its end, and when it is broken, which is reported and t->failed then. */
bool taped_next(taped *t, taped_turn *turn);

/* Signals of the kind: its channels. */
unsigned taped_channels(const taped *t, wh_signal_kind kind);

#endif
