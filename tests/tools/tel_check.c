/* tel_check.c: reads a rig's line as stored by `whirl monitor --raw` with the tests' own decoder (tests/core/wire.h).
 * Prints a line of counts, and with --csv the samples.
 *
 * frames F samples S pulses P missing M dropped D twice T damaged B gaps G
 *
 * missing:  frames, by the sequence numbers
 * dropped:  for want of room on the rig, since the first frame
 * twice:    frames with a repeated sequence number
 * gaps:     samples missing by their time stamps, at 2,000 ticks each */
#include "tests/core/wire.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 4, PERIOD = 2000 };

typedef struct counts {
    uint64_t frames, samples, pulses, missing, dropped, twice, gaps;
    bool any[CHANNELS];
    uint16_t next[CHANNELS];
    uint16_t before[CHANNELS];
    bool timed;
    uint32_t due;
    int64_t time;
    uint32_t first;
} counts;

static void take_samples(counts *c, const wire_frame *frame, bool csv, double scale) {
    const unsigned many = (frame->count - 5U) / 2U;
    if (c->timed) {
        c->gaps += (frame->ticks - c->due + PERIOD / 2) / PERIOD;
    } else {
        c->first = frame->ticks;
    }
    c->timed = true;
    c->samples += many;
    c->due = frame->ticks + many * PERIOD;
    for (unsigned i = 0; i < many && csv; i++) {
        const int16_t load = (int16_t)wire_number(frame->payload + 5U + 2U * i, 2);
        printf("%.6f,%.6g\n", (double)(frame->ticks + i * PERIOD - c->first) / 1e6, load * scale);
    }
}

static void take(counts *c, const wire_frame *frame, bool csv, double scale) {
    if (frame->channel >= CHANNELS) {
        c->twice++; /* there is no such channel */
        return;
    }
    const uint16_t gap = (uint16_t)(frame->sequence - c->next[frame->channel]);
    if (c->any[frame->channel]) {
        c->missing += gap < 0x8000U ? gap : 0U;
        c->twice += gap < 0x8000U ? 0U : 1U;
        c->dropped += (uint16_t)(frame->dropped - c->before[frame->channel]);
    }
    c->any[frame->channel] = true;
    c->next[frame->channel] = (uint16_t)(frame->sequence + 1U);
    c->before[frame->channel] = frame->dropped;
    c->frames++;
    if (frame->channel == 0) {
        take_samples(c, frame, csv, scale);
    } else if (frame->channel == 1U && frame->payload[0] == 0) {
        c->pulses++;
    }
}

int main(int count, char **words) {
    static wire heard;
    static counts c;
    const bool csv = count == 4 && strcmp(words[2], "--csv") == 0;
    if (count != 2 && !csv) {
        fputs("usage: tel_check RAW [--csv NEWTON_PER_COUNT]\n", stderr);
        return 2;
    }
    FILE *file = fopen(words[1], "rb");
    if (file == NULL) {
        fprintf(stderr, "tel_check: cannot open %s\n", words[1]);
        return 2;
    }
    const double scale = csv ? strtod(words[3], NULL) : 1.0;
    for (int byte = getc(file); byte != EOF; byte = getc(file)) {
        wire_frame frame;
        heard.text_count = 0; /* text is ignored */
        if (wire_take(&heard, (uint8_t)byte, &frame)) {
            take(&c, &frame, csv, scale);
        }
    }
    fclose(file);
    fprintf(csv ? stderr : stdout,
            "frames %" PRIu64 " samples %" PRIu64 " pulses %" PRIu64 " missing %" PRIu64
            " dropped %" PRIu64 " twice %" PRIu64 " damaged %u gaps %" PRIu64 "\n",
            c.frames, c.samples, c.pulses, c.missing, c.dropped, c.twice, heard.bad, c.gaps);
    return 0;
}
