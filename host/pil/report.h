/* report.h: the settings of a run in the loop, and its results. */
#ifndef PIL_REPORT_H
#define PIL_REPORT_H

#include <stdio.h>

#include "host/os/guest.h"
#include "host/pil/plant.h"

/* The interface for faults (fault.h) and observers, which may read and change messages. Its functions are called before
 * the first message, after each message of the firmware, and before each message to the firmware. orders() may add
 * *late_s to the time of the answer. A tape has the messages as the firmware received and sent them. NULL: no call. */
typedef struct tap {
    const char *name;
    void *of;
    bool (*start)(void *of, const wh_hello *hello, plant *plant); /* false: reported */
    void (*orders)(void *of, double time_s, wh_orders *orders, double *late_s);
    void (*readings)(void *of, double time_s, wh_readings *readings);
    void (*watch)(void *of, double time_s,
                  const plant *plant); /* called at least every millisecond of plant time */
} tap;

typedef struct lockstep_wish {
    guest_wish guest;
    plant_wish plant;
    const char *renames;  /* see bind_signals() */
    double until_s;       /* the end of the run, if the firmware has not ended */
    double instruction_s; /* time for one instruction */
    FILE *tape;           /* NULL: no tape */
    double every_s;       /* interval of the plant's records; 0: not given */
    const tap *taps;      /* [tap_count] */
    int tap_count;
} lockstep_wish;

typedef enum lockstep_end {
    LOCKSTEP_DONE,      /* the firmware ended, with `status` */
    LOCKSTEP_LET_GO,    /* the run reached until_s, or the tape its end */
    LOCKSTEP_BAD,       /* the settings are impossible: reported */
    LOCKSTEP_FAILED,    /* reported */
    LOCKSTEP_DIFFERENT, /* the orders differ from the tape's: reported */
    LOCKSTEP_STOPPED    /* interrupted */
} lockstep_end;

/* The maximum of a quantity, and its time. */
typedef struct peak {
    double value;
    double at_s;
} peak;

/* The last value of a firmware's note. */
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
    bool cut;              /* the watchdog has cut the outputs */
    double cut_s;          /* time of the cut */
    unsigned resets;       /* resets of the firmware's processor */
    double reset_s;        /* time of the last reset */
    uint64_t hash;         /* hash of all orders, without instruction counts */
    uint64_t op_list_hash; /* hash of the tape's orders */
    uint64_t plant_hash;   /* hash of the last state of the plant */
} lockstep_report;

/* === in words ================================================================================= */

/* `im` is the plant's; NULL for a tape. */
void pil_print(FILE *out, const lockstep_wish *wish, const image *im, const lockstep_report *r);

#endif
