/* wire.h: a rig's line, as it comes: text here, frames of telemetry there (core/station/telemetry.h). */
#ifndef MONITOR_WIRE_H
#define MONITOR_WIRE_H

#include <stdbool.h>
#include <stdint.h>

enum { WIRE_ROOM = 512, WIRE_HEAD = 9, WIRE_LINE = 512 };

typedef struct wire_frame {
    unsigned channel;
    uint16_t sequence;
    uint16_t dropped;
    uint32_t ticks;
    const uint8_t *payload;
    unsigned length;
} wire_frame;

typedef enum wire_event { WIRE_NOTHING, WIRE_TEXT, WIRE_FRAME } wire_event;

/* All zeros: nothing heard. */
typedef struct wire {
    uint8_t chunk[WIRE_ROOM]; /* of a frame, since the last zero */
    unsigned length;
    bool is_text;  /* what has come since the last zero, */
    bool is_frame; /* or a frame's; neither: not known yet */
    bool too_long;
    char line[WIRE_LINE + 1]; /* of text, as far as it has come; whole after WIRE_TEXT */
    unsigned columns;
    bool line_done;
    wire_frame frame; /* after WIRE_FRAME, until the next byte */
    uint64_t damaged; /* what stood between two zeros and was no frame */
} wire;

/* The next byte. A line of text ends with a line feed, and has no end of its own here. */
wire_event wire_take(wire *w, uint8_t byte);

/* Nothing of what was begun will go on: the line was broken off. */
void wire_forget(wire *w);

/* === questions before a recording ============================================================= */
/* What a rig is asked before it is recorded: what its telemetry holds, then for it. */

enum { DIALOGUE_LINE = 48, DIALOGUE_REFUSAL = 160 };

/* So many are answered, and the rig is known to be there; was_off is known; telemetry of a time before has ended. */
enum { DIALOGUE_MET = 1, DIALOGUE_LISTED = 3, DIALOGUE_OFF = 4 };

/* All zeros but `rate`: nothing asked yet. */
typedef struct dialogue {
    int rate;  /* samples a second */
    int asked; /* the question that waits for its answer */
    bool done;
    bool rate_refused;
    bool was_off; /* telemetry was off: the rig is new, or another one */
    char refused
        [DIALOGUE_REFUSAL]; /* the first question that was not answered with OK, and what was; if any */
} dialogue;

/* The line that is to be sent now, with its end; NULL when all are answered. */
const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]);

/* A line that came. True when it was an answer, or the echo of a question: nobody else's. What was in the line before the
 * first question, and answers that come twice, since somebody has asked again, answer nothing: `asked` stays. */
bool dialogue_answer(dialogue *d, const char *line);

#endif
