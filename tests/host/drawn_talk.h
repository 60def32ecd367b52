/* drawn_talk.h: what a firmware and who runs it say to each other, drawn: as a line on which all that the firmware will say
 * stands in a socket before it is asked, and as a tape of the same. */
#ifndef TESTS_HOST_DRAWN_TALK_H
#define TESTS_HOST_DRAWN_TALK_H

#include "command.h"
#include "host/pil/lockstep.h"

enum { TURNS_MOST = 12, STREAM = 20000 };

typedef struct stream {
    uint8_t bytes[STREAM];
    unsigned length;
} stream;

/* What is told and answered, in turns. */
typedef struct drawn_talk {
    wh_signal signal[WH_SIGNALS_MAX];
    wh_hello hello;
    unsigned outputs; /* notes behind them: */
    unsigned notes;
    unsigned turns;
    uint32_t ticks[TURNS_MOST];
    wh_readings readings[TURNS_MOST];
    wh_orders orders[TURNS_MOST];
    unsigned remembers[TURNS_MOST]; /* bytes, before the orders; 99: nothing */
    uint8_t remembered[TURNS_MOST][WH_REMEMBER_MAX + 8];
} drawn_talk;

extern drawn_talk talk_drawn;
extern stream talk_line; /* from the firmware */
extern stream talk_on_tape;
extern lockstep_report talk_report;
extern lockstep_wish talk_wish;

void talk_die(dice with); /* which all is drawn with */
unsigned talk_one_of(unsigned count);

/* talk_drawn anew: a hello, and turns. */
void talk_draw(void);

/* Frames, behind what is there. Orders of turn i, and what is to be remembered before them. */
void talk_put(stream *s, unsigned kind, unsigned sequence, uint32_t ticks, const uint8_t *payload,
              unsigned length);
void talk_put_hello(stream *s, const wh_hello *hello);
void talk_put_readings(stream *s, unsigned i);
void talk_put_orders(stream *s, unsigned i, unsigned sequence);
void talk_put_end(stream *s, int status, unsigned length);

/* So many turns as a tape, talk_on_tape; and what the firmware says of them, talk_line. */
void talk_tape_all(unsigned turns);
void talk_say_all(unsigned turns);

/* What the firmware says is on its way, as talk_wish asks for it; behind it the line is closed, or silent. Then, of a line that
 * is not used any more: what the firmware has heard. */
void talk_open_line(bool closed);
void talk_close_line(stream *heard);

/* The hash of so many turns' answers: everything but what was counted, and what was to be remembered, in its order. */
uint64_t talk_hash_of(unsigned turns);

/* talk_report tells of so many turns. */
void talk_expect_report(lockstep_end end, unsigned turns);

#endif
