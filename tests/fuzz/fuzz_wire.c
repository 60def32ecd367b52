/* fuzz_wire.c: random bytes from a rig's line must crash no reader: text and frames, telemetry descriptions, records,
 * waves, and the core's decoders of frames and byte stuffing.
 *
 * The input is the bytes on the line. If the first byte is odd, a valid channel description comes before them. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/cobs.h"
#include "core/frame.h"
#include "host/monitor/recording.h"
#include "host/monitor/wire.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *const said[] = {
    "OK channel=0 name=run period_ticks=2000 once=speed[rpm]:u2:0.02,drive[V]:u2:0.001,state:u1:1 "
    "each=load[N]:i2:0.006787447520:0.000000: i2 -32768, u2 65535: none",
    "OK channel=1 name=event period_ticks=0 once=what:u1:1,value:u1:1 each=: what",
    "OK channel=2 name=ring period_ticks=0 once= each=ticks:u2:1,load[N]:i2:0.0067:0,"
    "drive[V]:u2:0.001,flags:u1:1,state:u1:1: flags",
    "OK 0=idle 1=armed 9=tare"};

static void must(bool holds) {
    if (!holds) {
        abort();
    }
}

/* Aborts if a description was accepted although its frames cannot be read. */
static void look(const schema *s) {
    for (int i = 0; i < SCHEMA_CHANNELS; i++) {
        const schema_channel *c = &s->channel[i];
        must(c->onces >= 0 && c->onces <= SCHEMA_FIELDS);
        must(c->eaches >= 0 && c->eaches <= SCHEMA_FIELDS);
        must(memchr(c->name, 0, SCHEMA_NAME) != NULL);
        for (int k = 0; k < c->eaches; k++) {
            const unsigned bytes = c->each[k].size;
            must(bytes == 1U || bytes == 2U || bytes == 4U);
            must(isfinite(c->each[k].scale) && isfinite(c->each[k].offset));
            must(memchr(c->each[k].name, 0, SCHEMA_NAME) != NULL);
        }
    }
}

static void read_core(const uint8_t *data, size_t size) {
    uint8_t *copy = malloc(size > 0 ? size : 1);
    uint8_t room[64];
    wh_frame_reader reader;
    must(copy != NULL);
    memcpy(copy, data, size);
    must(wh_cobs_decode(copy, (unsigned)size) <= size);
    free(copy);
    wh_frame_reader_start(&reader, room, sizeof room);
    for (size_t i = 0; i < size; i++) {
        wh_frame frame;
        must(!wh_frame_take(&reader, data[i], &frame) || frame.length <= sizeof room);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static FILE *nowhere;
    static schema known;
    static recording kept;
    if (nowhere == NULL) {
        nowhere = fopen("/dev/null", "w");
    }
    must(nowhere != NULL);
    wire w = {.length = 0};
    dialogue asked = {.rate = 500};
    memset(&known, 0, sizeof known);
    for (size_t i = 0; i < sizeof said / sizeof said[0] && size > 0 && (data[0] & 1U) != 0; i++) {
        must(schema_take(&known, said[i]));
    }
    recording_begin(&kept, nowhere, nowhere, nowhere, true);
    uint64_t frames = 0;
    for (size_t i = 0; i < size; i++) {
        const wire_event event = wire_take(&w, data[i]);
        if (event == WIRE_TEXT) {
            must(memchr(w.line, 0, sizeof w.line) != NULL);
            (void)schema_take(&known, w.line);
            if (dialogue_answer(&asked, w.line) && asked.was_off) {
                recording_anew(&kept);
            }
        } else if (event == WIRE_FRAME) {
            recording_frame(&kept, &known, &w.frame);
            frames++;
        }
    }
    look(&known);
    must(kept.counts.frames + kept.counts.strange >= frames);
    recording_end(&kept);
    read_core(data, size);
    return 0;
}
