/* turns.h: a controller and its plant, which take turns over a line (link.h, core/exchange.h). Simulated time advances
 * only in hal_turns_wait(), which sends the outputs and returns with the time and the readings. A program declares its
 * signals and uses this file, or a HAL based on it (rig_frames.c). */
#ifndef HAL_PIL_TURNS_H
#define HAL_PIL_TURNS_H

#include "core/exchange.h"

WH_C_BEGIN

#define HAL_HELLO_BYTES 768U /* maximum length of a hello */

typedef struct hal_turns {
    uint32_t ticks;         /* time now */
    uint32_t arrived_timer; /* link timer when the last readings arrived */
    uint16_t sequence;      /* sequence number of the next readings */
    bool acted;             /* outputs were set since the last readings */
    uint32_t step_timer;    /* link timer at the begin of the control step */
    uint32_t nothing_timer; /* duration of an empty control step, in counts of the link timer */
    unsigned outputs;       /* number of outputs in orders.output; the notes follow them */
    wh_orders orders;
    wh_readings readings;
    unsigned edge;   /* index of the next edge to take */
    unsigned sample; /* index of the next sample to take */
    uint32_t lost;   /* number of edges and samples lost because `readings` was full */
    wh_reset reset;  /* cause of the start (0: power-on), and remembered bytes */
    wh_frame_reader reader;
    uint8_t line[64]; /* bytes read but not yet processed */
    unsigned line_at;
    unsigned line_end;
    uint8_t payload[HAL_HELLO_BYTES];
    uint8_t coded[WH_FRAME_BYTES(HAL_HELLO_BYTES)];
    uint8_t frame[WH_FRAME_BYTES(WH_READINGS_BYTES)];
} hal_turns;

/* Opens the line, sends the hello and waits for the plant's first message. The caller fills in the hello's program,
 * ticks_per_s, start_ticks and signals; the board adds the rest. Outputs are 0 at first. Returns false if there is no
 * line, or if the hello is too long. */
bool hal_turns_start(hal_turns *turns, const wh_hello *hello);

/* Sends the program's exit status (WH_FRAME_END), because on some lines the plant cannot see that a program ends. */
void hal_turns_end(hal_turns *turns, int status);

/* Sets an output from now on. */
void hal_turns_set(hal_turns *turns, unsigned channel, float value);

/* Sets a note, a value that the controller reports about itself. This takes no simulated time. */
void hal_turns_note(hal_turns *turns, unsigned channel, float value);

/* Call these at the begin and at the end of each control step. hal_turns_wait() reports the longest step. */
void hal_turns_step_begins(hal_turns *turns);
void hal_turns_step_ends(hal_turns *turns);

/* Sets the bytes that survive a reset; count <= WH_REMEMBER_MAX. After the restart they are in turns->reset. */
void hal_turns_remember(hal_turns *turns, const uint8_t *bytes, unsigned count);

/* Sends the outputs and waits for the next readings. The readings are from `until_ticks`, or from the end of the
 * computing time if the computing ends later. */
void hal_turns_wait(hal_turns *turns, uint32_t until_ticks);

/* Takes the oldest edge or sample. Returns false if there is none. WH_EDGES_MAX edges and WH_SAMPLES_MAX samples are
 * stored; more are lost. */
bool hal_turns_take_edge(hal_turns *turns, wh_edge *edge);
bool hal_turns_take_sample(hal_turns *turns, wh_sample *sample);

/* The plant's watchdog sets the outputs to zero `timeout_ticks` after the last hal_turns_alive(); 0: no watchdog. */
void hal_turns_watch(hal_turns *turns, uint32_t timeout_ticks);
void hal_turns_alive(hal_turns *turns);
bool hal_turns_is_cut(const hal_turns *turns);

WH_C_END

#endif
