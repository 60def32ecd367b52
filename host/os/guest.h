/* guest.h: the process that runs a firmware image (the guest), and two pipes to it. The guest has them as descriptors
 * HAL_LINK_DOWN and HAL_LINK_UP (hal/link.h). They are not named pipes: opening those can block, and leaves a file. On
 * Linux, the guest is killed when this process ends. */
#ifndef OS_GUEST_H
#define OS_GUEST_H

#include <stdbool.h>
#include <sys/types.h>

#include "core/exchange.h"

#define GUEST_LINE_BYTES 4096

/* An instruction in QEMU takes 2^GUEST_SHIFT = 64 ns of guest time: more than one count of a 25 MHz timer (40 ns). */
#define GUEST_SHIFT 6

/* Exit status if a program cannot be run, as in shells. */
#define GUEST_NOT_RUN 127

typedef struct guest_request {
    bool by_line; /* starts no process: the firmware is at the other end of `line` */
    int line;
    const char *image; /* an ELF file, for Arm or for this machine */
    const char *board; /* QEMU's machine */
    bool mute;         /* hide the guest's console */
    double patience_s; /* longest wait for a message, and for the exit */
} guest_request;

typedef struct guest {
    guest_request request;
    bool emulated;
    pid_t pid; /* 0: no process */
    int up;    /* -1: closed */
    int down;
    uint8_t line[GUEST_LINE_BYTES]; /* received, not yet decoded */
    unsigned line_at;
    unsigned line_end;
    wh_frame_reader reader;
    uint8_t frame[WH_FRAME_BYTES(GUEST_LINE_BYTES)];
} guest;

typedef enum guest_heard {
    GUEST_FRAME,
    GUEST_ENDED,  /* the guest closed the line: it is exiting, or dead */
    GUEST_SILENT, /* no message for patience_s */
    GUEST_STOPPED /* the user interrupted */
} guest_heard;

/* Sets `machine` to BOARD_MACHINE in ./boards/BOARD/board.mk. Returns false if the file or the value is missing. */
#define GUEST_MACHINE_BYTES 64
bool guest_machine_of(const char *board, char machine[GUEST_MACHINE_BYTES]);

/* Starts the guest. Returns false (reported) if the image cannot be run. Call guest_end() in any case. */
bool guest_start(guest *g, const guest_request *request);

/* Both return GUEST_FRAME on success. */
guest_heard guest_receive(guest *g, wh_frame *frame);
guest_heard guest_send(guest *g, const uint8_t *bytes, unsigned count);

typedef struct guest_end_status {
    bool killed;       /* the process did not exit, so guest_end() killed it */
    int status;        /* exit status, or -1 */
    int signal_number; /* the signal that ended the process, or 0 */
    const char *signal_name;
} guest_end_status;

/* Closes the pipes, but not request.line. Kills the process if it still runs after patience_s. May be repeated. */
guest_end_status guest_end(guest *g);

#endif
