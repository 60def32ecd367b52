/* turns.h: hardware that is somewhere else: a controller and its plant take turns over a line (link.h, core/exchange.h).
 *
 * Time goes on only while the controller waits: hal_turns_wait() sends what the outputs are and comes back with the time
 * and with what the sensors gave. A program declares its signals and uses this, or a HAL made of it (rig_frames.c). */
#ifndef HAL_FRAMES_TURNS_H
#define HAL_FRAMES_TURNS_H

#include "core/exchange.h"

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_HELLO_BYTES 768U /* the longest hello */

typedef struct hal_turns {
    uint32_t ticks;         /* now */
    uint32_t arrived_timer; /* the last readings */
    uint16_t sequence;      /* of the readings that are waited for */
    bool acted;             /* outputs were set since */
    uint32_t step_timer;    /* the control step that is under way began */
    uint32_t nothing_timer; /* what is counted round nothing */
    unsigned outputs;       /* of orders.output; behind them stand the notes */
    wh_orders orders;
    wh_readings readings; /* what is not yet taken begins at: */
    unsigned edge;
    unsigned sample;
    uint32_t lost;  /* edges and samples for which there was no room */
    wh_reset reset; /* why we start; cause 0: a power-on */
    wh_frame_reader reader;
    uint8_t line[64]; /* read, not yet looked at */
    unsigned line_at;
    unsigned line_end;
    uint8_t payload[HAL_HELLO_BYTES];
    uint8_t coded[WH_FRAME_BYTES(HAL_HELLO_BYTES)];
    uint8_t frame[WH_FRAME_BYTES(WH_READINGS_BYTES)];
} hal_turns;

/* Opens the line, says who we are and waits for the plant's first word. `hello` needs program, ticks_per_s, start_ticks
 * and signals; the rest is the board's. Outputs are 0. False: there is no line, or the hello is too long. */
bool hal_turns_start(hal_turns *turns, const wh_hello *hello);

/* The program ends, with this status: of one whose end the line does not tell (WH_FRAME_END). */
void hal_turns_end(hal_turns *turns, int status);

/* An output from now on, of this channel. */
void hal_turns_set(hal_turns *turns, unsigned channel, float value);

/* What the controller tells of itself, from now on: a note, of this channel. It takes no time. */
void hal_turns_note(hal_turns *turns, unsigned channel, float value);

/* Round each control step: orders tell what the longest took, apart from the rest that is done between two waits. */
void hal_turns_step_begins(hal_turns *turns);
void hal_turns_step_ends(hal_turns *turns);

/* What outlives a reset, from now on: then turns->reset has it when we start again. count <= WH_REMEMBER_MAX. */
void hal_turns_remember(hal_turns *turns, const uint8_t *bytes, unsigned count);

/* Hand over the outputs and wait until `until_ticks`, or for the next word if that is past already. */
void hal_turns_wait(hal_turns *turns, uint32_t until_ticks);

/* The oldest edge or sample not yet taken, in order of time; false when there is none. WH_EDGES_MAX and WH_SAMPLES_MAX
 * are kept; when more came, the newest are lost. */
bool hal_turns_take_edge(hal_turns *turns, wh_edge *edge);
bool hal_turns_take_sample(hal_turns *turns, wh_sample *sample);

/* The plant's watchdog takes the outputs to zero when hal_turns_alive() stays away for longer; 0: there is none. */
void hal_turns_watch(hal_turns *turns, uint32_t timeout_ticks);
void hal_turns_alive(hal_turns *turns);
bool hal_turns_is_cut(const hal_turns *turns);

#ifdef __cplusplus
}
#endif

#endif
