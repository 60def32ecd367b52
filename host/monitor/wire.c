/* wire.c: the byte stream of a rig: text mixed with telemetry frames (core/station/telemetry.h). */
#include "host/monitor/wire.h"

#include <stdio.h>
#include <string.h>

#include "core/cobs.h"

static wire_event add_text(wire *w, char byte) {
    if (w->line_done) {
        w->columns = 0;
        w->line_done = false;
        w->torn = false;
    }
    if (byte == '\n') {
        w->line_done = true;
        w->line[w->columns] = '\0';
        return WIRE_TEXT;
    }
    if (byte != '\r' && w->columns < WIRE_LINE) {
        w->line[w->columns++] = byte;
    }
    return WIRE_NOTHING;
}

uint32_t wire_number(const uint8_t *bytes, unsigned size) {
    uint32_t value = 0;
    for (unsigned i = 0; i < size; i++) {
        value |= (uint32_t)bytes[i] << 8 * i;
    }
    return value;
}

static wire_event end_chunk(wire *w) {
    const unsigned length = w->too_long ? 0 : wh_cobs_decode(w->chunk, w->length);
    if (length < WIRE_HEAD + 2 || w->chunk[0] < 0x80U ||
        wh_crc16(WH_CRC16_START, w->chunk, length - 2U) != wire_number(w->chunk + length - 2U, 2)) {
        w->damaged++;
        return WIRE_NOTHING;
    }
    w->frame = (wire_frame){.channel = w->chunk[0] - 0x80U,
                            .sequence = (uint16_t)wire_number(w->chunk + 1, 2),
                            .dropped = (uint16_t)wire_number(w->chunk + 3, 2),
                            .ticks = wire_number(w->chunk + 5, 4),
                            .payload = w->chunk + WIRE_HEAD,
                            .length = length - WIRE_HEAD - 2U};
    return WIRE_FRAME;
}

/* Adds a byte. The two bytes that follow a zero begin a frame if the second one is at least 0x80, else text. */
static wire_event add(wire *w, uint8_t byte) {
    if (!w->is_frame && w->length == 1U) {
        w->is_frame = byte >= 0x80U;
        w->is_text = !w->is_frame;
        if (w->is_text) {
            w->length = 0;
            const wire_event first = add_text(w, (char)w->chunk[0]);
            const wire_event second = add_text(w, (char)byte);
            return first == WIRE_TEXT ? first : second;
        }
    }
    if (w->length < WIRE_ROOM) {
        w->chunk[w->length++] = byte;
    } else {
        w->too_long = true;
    }
    return WIRE_NOTHING;
}

static void begin_chunk(wire *w) {
    w->length = 0;
    w->is_text = false;
    w->is_frame = false;
    w->too_long = false;
    w->torn = true;
}

wire_event wire_take(wire *w, uint8_t byte) {
    if (byte != 0) {
        return w->is_text ? add_text(w, (char)byte) : add(w, byte);
    }
    wire_event event = WIRE_NOTHING;
    if (w->is_frame) {
        event = end_chunk(w);
    } else if (w->length == 1U) { /* one byte of text between frames, such as an echo */
        event = add_text(w, (char)w->chunk[0]);
    }
    begin_chunk(w);
    return event;
}

void wire_forget(wire *w) {
    begin_chunk(w);
    w->columns = 0;
}

/* === questions before a recording ============================================================= */

/* "id" comes first, because no other answer begins with "OK program=". "tel rate" comes last, because it starts the
 * frames, which cannot be read without the schema. */
static const struct {
    const char *words;
    const char *answer; /* beginning of the answer */
} questions[] = {{"id", "OK program="},
                 {"talk off", "OK"},
                 {"tel list", "OK rate="},
                 {"tel off", "OK"},
                 {"tel fmt frames", "OK fmt="},
                 {"tel schema run", "OK channel=0"},
                 {"tel schema event", "OK channel=1"},
                 {"tel schema ring", "OK channel=2"},
                 {"tel schema states", "OK 0="},
                 {"tel rate", "OK rate="}};
enum { QUESTIONS = sizeof questions / sizeof questions[0], LIST = 2, RATE = QUESTIONS - 1 };

const char *dialogue_question(const dialogue *d, char line[DIALOGUE_LINE]) {
    if (d->asked >= (int)QUESTIONS) {
        return NULL;
    }
    if (d->asked == RATE) {
        snprintf(line, DIALOGUE_LINE, "%s %d\n", questions[RATE].words, d->rate);
    } else {
        snprintf(line, DIALOGUE_LINE, "%s\n", questions[d->asked].words);
    }
    return line;
}

/* Returns true if the line begins with the answer. The answer "OK" must be the whole line. */
static bool begins(const char *line, const char *answer) {
    return strcmp(answer, "OK") == 0 ? strcmp(line, answer) == 0
                                     : strncmp(line, answer, strlen(answer)) == 0;
}

bool dialogue_answer(dialogue *d, const char *line) {
    char question[DIALOGUE_LINE];
    if (d->done || dialogue_question(d, question) == NULL) {
        return false;
    }
    question[strcspn(question, "\n")] = '\0';
    if (strcmp(line, question) == 0) {
        return true; /* the echo */
    }
    const bool met = d->asked >= DIALOGUE_MET;
    const char *from =
        met ? line
            : strstr(line, questions[0].answer); /* the first answer may follow a partial frame */
    const bool good = from != NULL && begins(from, questions[d->asked].answer);
    const bool refuses = met && strncmp(line, "ERR ", 4) == 0;
    if (!good && !refuses) {
        return strncmp(line, "OK", 2) == 0 || strncmp(line, "ERR ", 4) == 0;
    }
    if (refuses && d->refused[0] == '\0') {
        snprintf(d->refused, sizeof d->refused, "%s: %s", question, line);
    }
    d->rate_refused = d->rate_refused || (refuses && d->asked == RATE);
    if (d->asked == LIST) {
        d->was_off = strstr(line, " rate=0 ") != NULL;
    }
    d->asked++;
    d->done = d->asked == (int)QUESTIONS;
    return true;
}
