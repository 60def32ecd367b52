/* turns.h: remote hardware: a controller and its plant take turns over a line (link.h, core/exchange.h). Time advances
 * only while the controller waits: hal_turns_wait() sends the outputs and returns with the time and the sensors'
 * readings. A program declares its signals and uses this file, or a HAL based on this file (rig_frames.c). */
#ifndef HAL_FRAMES_TURNS_H
#define HAL_FRAMES_TURNS_H

#include "core/exchange.h"

WH_C_BEGIN

#define HAL_HELLO_BYTES 768U /* maximum length of a hello */

typedef struct hal_turns {
    uint32_t ticks;         /* time now */
    uint32_t arrived_timer; /* link timer at the arrival of the last readings */
    uint16_t sequence;      /* sequence number of the next readings */
    bool acted;             /* outputs were set since the last readings */
    uint32_t step_timer;    /* link timer when the control step in progress began */
    uint32_t nothing_timer; /* link timer counts of an empty control step */
    unsigned outputs;       /* number of outputs in orders.output; the notes follow them */
    wh_orders orders;
    /* the last readings; `edge` and `sample` are indices of the next ones to take */
    wh_readings readings;
    unsigned edge;
    unsigned sample;
    uint32_t lost;  /* number of edges and samples lost for lack of room */
    wh_reset reset; /* cause of the start, and remembered bytes; cause 0: a power-on */
    wh_frame_reader reader;
    uint8_t line[64]; /* bytes read but not yet processed */
    unsigned line_at;
    unsigned line_end;
    uint8_t payload[HAL_HELLO_BYTES];
    uint8_t coded[WH_FRAME_BYTES(HAL_HELLO_BYTES)];
    uint8_t frame[WH_FRAME_BYTES(WH_READINGS_BYTES)];
} hal_turns;

/* Opens the line, sends the hello and waits for the plant's first message. The caller fills in the hello's program,
 * ticks_per_s, start_ticks and signals; the board adds the rest. Initially the outputs are 0. Returns false if there is
 * no line, or if the hello is too long. */
bool hal_turns_start(hal_turns *turns, const wh_hello *hello);

/* Report that the program ends with this status, for lines that do not show an end otherwise (WH_FRAME_END). */
void hal_turns_end(hal_turns *turns, int status);

/* Set output `channel` to `value` from now on. */
void hal_turns_set(hal_turns *turns, unsigned channel, float value);

/* Set note `channel`: a value that the controller reports about itself. This takes no simulated time. */
void hal_turns_note(hal_turns *turns, unsigned channel, float value);

/* Call these at the begin and at the end of each control step. The orders report the longest duration of a step,
 * without the other work between two waits. */
void hal_turns_step_begins(hal_turns *turns);
void hal_turns_step_ends(hal_turns *turns);

/* Set the bytes that survive a reset; count <= WH_REMEMBER_MAX. After the restart they are in turns->reset. */
void hal_turns_remember(hal_turns *turns, const uint8_t *bytes, unsigned count);

/* Send the outputs and wait until `until_ticks`. If that time has passed, wait for the next message. */
void hal_turns_wait(hal_turns *turns, uint32_t until_ticks);

/* Take the oldest edge or sample that was not taken before, in the order of time. Returns false if there is none.
 * WH_EDGES_MAX edges and WH_SAMPLES_MAX samples are stored; if more come, the newest are lost. */
bool hal_turns_take_edge(hal_turns *turns, wh_edge *edge);
bool hal_turns_take_sample(hal_turns *turns, wh_sample *sample);

/* Set the timeout of the plant's watchdog; 0: no watchdog. If hal_turns_alive() is not called for a longer time, the
 * watchdog sets the outputs to zero. */
void hal_turns_watch(hal_turns *turns, uint32_t timeout_ticks);
void hal_turns_alive(hal_turns *turns);
bool hal_turns_is_cut(const hal_turns *turns);

WH_C_END

#endif
