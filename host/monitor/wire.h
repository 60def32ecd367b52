/* wire.h: the byte stream of a rig: text mixed with telemetry frames (core/station/telemetry.h). */
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

/* All zeros at the start. */
typedef struct wire {
    uint8_t chunk[WIRE_ROOM]; /* bytes of a frame since the last zero */
    unsigned length;
    bool is_text;  /* the bytes since the last zero are text */
    bool is_frame; /* the bytes are a frame; if neither flag is set, this is not known yet */
    bool too_long;
    char line[WIRE_LINE + 1]; /* text received so far; complete after WIRE_TEXT */
    unsigned columns;
    bool line_done;
    bool torn; /* the line may begin with a part of a frame: a zero came within it, or it is the
                * first after wire_forget() */
    wire_frame frame; /* valid after WIRE_FRAME, until the next byte */
    uint64_t damaged; /* chunks between two zeros that are no frame */
} wire;

/* Take the next byte. A line of text ends with a line feed, which is not stored. */
wire_event wire_take(wire *w, uint8_t byte);

/* The number in bytes[size], the least significant first; size is at most 4. */
uint32_t wire_number(const uint8_t *bytes, unsigned size);

/* Discard an incomplete line or frame: the line was interrupted. */
void wire_forget(wire *w);

/* === questions before a recording ============================================================= */
/* The dialogue before a recording: it asks the rig for its telemetry's schema, then for telemetry. */

enum { DIALOGUE_LINE = 48, DIALOGUE_REFUSAL = 160 };

/* Number of answers until the rig is present (MET), was_off is known (LISTED), or earlier telemetry has ended (OFF). */
enum { DIALOGUE_MET = 1, DIALOGUE_LISTED = 3, DIALOGUE_OFF = 4 };

/* All zeros except `rate`: no question was asked yet. */
typedef struct dialogue {
    int rate;  /* samples a second */
    int asked; /* the current question */
    bool done;
    bool rate_refused;
    bool was_off; /* true: telemetry was off before, so the rig has restarted or is another one */
    char refused
        /* the first question with an answer other than OK, and this answer; or "" */
        [DIALOGUE_REFUSAL];
} dialogue;

/* The line to send now, with its end; NULL after the last answer. */
const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]);

/* Takes a received line. Returns true if the line belongs to the dialogue: an answer, or the echo of a question. Lines
 * from before the first question, and repeated answers, leave `asked` unchanged. */
bool dialogue_answer(dialogue *d, const char *line);

#endif
