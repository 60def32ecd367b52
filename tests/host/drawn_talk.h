/* drawn_talk.h: a random exchange of frames between a firmware and its host, as bytes on a line and as a tape. All
 * answers of the firmware are in the socket before the host sends its first request. */
#ifndef TESTS_HOST_DRAWN_TALK_H
#define TESTS_HOST_DRAWN_TALK_H

#include "command.h"
#include "host/pil/lockstep.h"

enum { TURNS_MOST = 12, STREAM = 20000 };

typedef struct stream {
    uint8_t bytes[STREAM];
    unsigned length;
} stream;

typedef struct drawn_talk {
    wh_signal signal[WH_SIGNALS_MAX];
    wh_hello hello;
    unsigned outputs; /* number of outputs; the last `notes` of these are notes */
    unsigned notes;
    unsigned turns;
    uint32_t ticks[TURNS_MOST];
    wh_readings readings[TURNS_MOST];
    wh_orders orders[TURNS_MOST];
    /* size in bytes of the remembered values that precede the orders; 99: no such frame */
    unsigned remembers[TURNS_MOST];
    uint8_t remembered[TURNS_MOST][WH_REMEMBER_MAX + 8];
} drawn_talk;

extern drawn_talk talk_drawn;
extern stream talk_line; /* bytes sent by the firmware */
extern stream talk_on_tape;
extern lockstep_report talk_report;
extern lockstep_request talk_request;

void talk_die(dice with); /* sets the random generator of all functions here */
unsigned talk_one_of(unsigned count);

void talk_draw(void);

/* Each function appends a frame to `s`. talk_put_orders() first appends the frame of remembered values, if turn i
 * has one. */
void talk_put(stream *s, unsigned kind, unsigned sequence, uint32_t ticks, const uint8_t *payload,
              unsigned length);
void talk_put_hello(stream *s, const wh_hello *hello);
void talk_put_readings(stream *s, unsigned i);
void talk_put_orders(stream *s, unsigned i, unsigned sequence);
void talk_put_end(stream *s, int status, unsigned length);

/* talk_tape_all() writes the exchange to talk_on_tape. talk_say_all() writes the firmware's answers to talk_line. */
void talk_tape_all(unsigned turns);
void talk_say_all(unsigned turns);

/* talk_open_line() puts the firmware's answers into a socket, and the socket into talk_request. If `closed`, the line
 * ends after the answers, else it stays silent. talk_close_line() closes the socket. *heard: the bytes that the host
 * sent. */
void talk_open_line(bool closed);
void talk_close_line(stream *heard);

/* Hash of the orders of the first `turns` turns, without counts and remembered values. */
uint64_t talk_hash_of(unsigned turns);

/* Fails the test unless talk_report has this end and this number of turns. */
void talk_expect_report(lockstep_end end, unsigned turns);

#endif
