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
    uint8_t chunk[WIRE_ROOM]; /* bytes since the last zero */
    unsigned length;
    bool is_text;
    bool is_frame; /* is_text and is_frame are false until the chunk's kind is known */
    bool too_long;
    char line[WIRE_LINE + 1]; /* received text; complete after WIRE_TEXT */
    unsigned columns;
    bool line_done;
    bool torn;        /* the line may begin with a frame's bytes */
    wire_frame frame; /* valid after WIRE_FRAME, until the next byte */
    uint64_t damaged; /* number of invalid chunks so far */
} wire;

/* Takes the next byte. The line feed that ends a text is not stored. */
wire_event wire_take(wire *w, uint8_t byte);

/* The number in bytes[size], lowest byte first; size <= 4. */
uint32_t wire_number(const uint8_t *bytes, unsigned size);

/* Drops an incomplete line or frame after an interruption. */
void wire_forget(wire *w);

/* === questions before a recording ============================================================= */
/* The dialogue asks the rig for its telemetry's schema, then for telemetry. */

enum { DIALOGUE_LINE = 48, DIALOGUE_REFUSAL = 160 };

/* Values of `asked` after the answers to "id" (MET), "tel list" (LISTED) and "tel off" (OFF). */
enum { DIALOGUE_MET = 1, DIALOGUE_LISTED = 3, DIALOGUE_OFF = 4 };

/* All zeros, except `rate`, before the first question. */
typedef struct dialogue {
    int rate;  /* samples a second */
    int asked; /* number of the current question */
    bool done;
    bool rate_refused;
    bool was_off; /* telemetry was off. During a recording, this shows a restart */
    char refused[DIALOGUE_REFUSAL]; /* the first refused question, and its answer; or "" */
} dialogue;

/* The line to send, with its end; NULL after the last answer. */
const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]);

/* Takes a received line. Returns true if it is an answer or the echo of a question. Repeated answers, and lines from
 * before the first question, leave `asked` unchanged. */
bool dialogue_answer(dialogue *d, const char *line);

#endif
