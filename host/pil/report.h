/* report.h: what is wished of a run in the loop, and what became of it. */
#ifndef PIL_REPORT_H
#define PIL_REPORT_H

#include <stdio.h>

#include "host/pil/guest.h"
#include "host/pil/plant.h"

/* The seam for faults (fault.h), and for whoever watches: asked in turn, before the first word, after the firmware has
 * spoken and before it is spoken to. What they make of a message is what the other side hears; the answer may take
 * *late_s longer. A tape has what the firmware heard and said. NULL: not asked. */
typedef struct tap {
    const char *name;
    void *of;
    bool (*start)(void *of, const wh_hello *hello, plant *plant); /* false: reported */
    void (*orders)(void *of, double time_s, wh_orders *orders, double *late_s);
    void (*readings)(void *of, double time_s, wh_readings *readings);
    void (*watch)(void *of, double time_s,
                  const plant *plant); /* every millisecond of the plant's */
} tap;

typedef struct lockstep_wish {
    guest_wish guest;
    plant_wish plant;
    const char *renames;  /* see bind_signals() */
    double until_s;       /* the firmware is let go then, if it has not ended */
    double instruction_s; /* what an instruction takes */
    FILE *tape;           /* NULL: none is kept */
    double every_s;       /* spacing of the plant's records; 0: not said */
    const tap *taps;      /* [tap_count] */
    int tap_count;
} lockstep_wish;

typedef enum lockstep_end {
    LOCKSTEP_DONE,      /* the firmware ended: status */
    LOCKSTEP_LET_GO,    /* until_s, or the tape's end */
    LOCKSTEP_BAD,       /* what was asked for cannot be: reported */
    LOCKSTEP_FAILED,    /* reported */
    LOCKSTEP_DIFFERENT, /* from the tape: reported */
    LOCKSTEP_STOPPED    /* interrupted */
} lockstep_end;

/* The most of something, and when it was. */
typedef struct peak {
    double value;
    double at_s;
} peak;

/* What a firmware tells of itself: the last value. */
typedef struct told_note {
    char name[32];
    char unit[16];
    double value;
} told_note;

typedef struct lockstep_report {
    lockstep_end end;
    guest_end_status status;
    char program[40];
    char board[40];
    uint64_t exchanges;
    told_note note[WH_SIGNALS_MAX];
    unsigned notes;
    double time_s; /* of the plant */
    double wall_s;
    bool counted; /* the firmware counts what it computes */
    peak acted;   /* instructions until the outputs were set, */
    peak busy;    /* and until it waited */
    uint64_t overruns;
    peak late_s; /* beyond when it wanted to hear again */
    uint64_t edges;
    uint64_t samples;
    uint64_t lost;
    bool cut;            /* the watchdog has cut the outputs, */
    double cut_s;        /* then */
    unsigned resets;     /* of the firmware's processor, */
    double reset_s;      /* the last then */
    uint64_t hash;       /* of all orders, but for what was counted */
    uint64_t tape_hash;  /* of a tape's */
    uint64_t plant_hash; /* of the scene's last state */
} lockstep_report;

/* === in words ================================================================================= */

/* `im` is the plant's; NULL: it was a tape. */
void pil_print(FILE *out, const lockstep_wish *wish, const image *im, const lockstep_report *r);

#endif
