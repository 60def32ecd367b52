/* pil_line.c: pil_dialled.c over the board's own serial line (boards/shared/link_console.c), for `whirl pil --port`. A
 * message reports the program's end, which the plant cannot detect otherwise. */
#include "boards/board.h"
#include "hal/link.h"
#include "hal/pil/rig_frames.h"

static _Noreturn void tell_and_exit(int status) {
    uint8_t heard;
    hal_frames_end(status);
    (void)hal_link_read(&heard, 1); /* a byte shows that the other side has read the message */
    board_exit(status);
}

#define board_exit tell_and_exit
#include "pil_dialled.c" // NOLINT(bugprone-suspicious-include): the same program
