/* guest.h: the process that runs a firmware image, and the line to it.
 *
 * Two pipes that only this process and the guest know, as descriptors HAL_LINK_DOWN and HAL_LINK_UP of the guest
 * (hal/link.h): they have no name, so neither the order of opening can block nor is anything left behind. The guest dies
 * with this process, however that ends; a guest that does not end by itself once the line is closed is killed. */
#ifndef PIL_GUEST_H
#define PIL_GUEST_H

#include <signal.h>
#include <stdbool.h>
#include <sys/types.h>

#include "core/exchange.h"

#define GUEST_LINE_BYTES 4096

/* How QEMU counts: an instruction is 2^GUEST_SHIFT ns of the guest's time, so that a timer of 25 MHz tells them apart. */
#define GUEST_SHIFT 6

/* Exit status of what could not be run, as shells have it. */
#define GUEST_NOT_RUN 127

typedef struct guest_wish {
    bool
        by_line; /* there is no process: it is at the other end of the line `line`, which stays the caller's */
    int line;
    const char *image;                 /* an ELF file: for Arm, or a program of this machine */
    const char *board;                 /* QEMU's machine */
    bool mute;                         /* what it says to people is not shown */
    double patience_s;                 /* so long it may be silent, or take to end */
    const volatile sig_atomic_t *stop; /* NULL: nobody interrupts */
} guest_wish;

typedef struct guest {
    guest_wish wish;
    bool emulated;
    pid_t pid; /* 0: there is none */
    int up;    /* -1: closed */
    int down;
    uint8_t line[GUEST_LINE_BYTES]; /* read, not yet looked at */
    unsigned line_at;
    unsigned line_end;
    wh_frame_reader reader;
    uint8_t frame[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
} guest;

typedef enum guest_heard {
    GUEST_FRAME,
    GUEST_ENDED,  /* it closed the line: it ends, or has died */
    GUEST_SILENT, /* longer than the patience */
    GUEST_STOPPED /* somebody interrupts us */
} guest_heard;

/* The machine that BOARD_MACHINE names in boards/NAME/board.mk, below the working directory. False: there is none. */
#define GUEST_MACHINE_BYTES 64
bool guest_machine_of(const char *board, char machine[GUEST_MACHINE_BYTES]);

/* False, reported, when the image cannot be run. In any case guest_end() follows. */
bool guest_start(guest *g, const guest_wish *wish);

guest_heard guest_receive(guest *g, wh_frame *frame);
/* GUEST_FRAME: it is on its way. */
guest_heard guest_send(guest *g, const uint8_t *bytes, unsigned count);

typedef struct guest_end_status {
    bool killed;       /* by us: it did not end by itself */
    int status;        /* its exit status, or -1 */
    int signal_number; /* that ended it, or 0 */
} guest_end_status;

/* Closes the line, waits as long as the patience has it, then kills; the process is gone when it returns. May be called
 * again, and after a start that failed: then it does nothing. */
guest_end_status guest_end(guest *g);

#endif
