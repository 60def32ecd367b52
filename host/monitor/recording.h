/* recording.h: the recording of a rig's telemetry: records, waves, plot, and counts of losses. */
#ifndef MONITOR_RECORDING_H
#define MONITOR_RECORDING_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "host/io/minmax_decimation.h"
#include "host/io/vcd.h"
#include "host/monitor/wire.h"

/* === the schema of a rig's telemetry, as the rig describes it (`tel schema`) ================== */

enum { SCHEMA_CHANNELS = 8, SCHEMA_FIELDS = 8, SCHEMA_NAME = 32 };

typedef struct schema_field {
    char name[SCHEMA_NAME]; /* "load [N]" */
    unsigned size;          /* bytes */
    bool is_signed;
    double scale;
    double offset;
} schema_field;

typedef struct schema_channel {
    bool known;
    char name[SCHEMA_NAME];
    uint32_t period_ticks; /* period of frames; 0: not periodic */
    schema_field once[SCHEMA_FIELDS];
    int onces;
    schema_field each[SCHEMA_FIELDS];
    int eaches;
} schema_channel;

typedef struct schema {
    schema_channel channel[SCHEMA_CHANNELS];
} schema;

/* Takes a console's answer about a channel, the rate or the states. Returns false if the answer has another subject. */
bool schema_take(schema *s, const char *line);

unsigned schema_bytes(const schema_field *fields, int count);

typedef struct recording_counts {
    uint64_t frames;
    uint64_t samples;
    uint64_t pulses;
    uint64_t lost;         /* missing frames */
    uint64_t dropped;      /* missing frames that the rig dropped for lack of space */
    uint64_t lost_samples; /* missing samples, from gaps between time stamps */
    uint64_t strange;      /* frames that fit no known schema */
    uint64_t restarts;     /* restarts of the rig */
} recording_counts;

typedef struct recording_channel {
    bool any;
    uint16_t next;
    uint16_t dropped;
} recording_channel;

typedef struct recording {
    FILE *csv;   /* optional */
    FILE *waves; /* optional */
    FILE *ring;
    vcd *vcd;
    bool plots;
    bool headed;
    bool ring_headed;
    recording_channel channel[SCHEMA_CHANNELS];
    bool timed;
    uint32_t ticks;  /* of the last frame */
    int64_t time_us; /* from the first frame to the last one */
    bool expects;    /* the next sample is expected at expected_us */
    int64_t expected_us;
    int signal[2 * SCHEMA_FIELDS]; /* VCD signals of a sample's fields */
    int pulse[2];
    bool ends;    /* the rig reports the ends of pulses */
    bool high[2]; /* the pulse of slot 1 or 2 has not ended yet */
    int trip;
    int columns;      /* the time and the run's fields */
    decimation *plot; /* rows for a picture, or NULL */
    recording_counts counts;
} recording;

/* Channels, numbered as in core/station/telemetry.h. */
enum { RECORDING_RUN, RECORDING_EVENT, RECORDING_RING };

void recording_begin(recording *r, FILE *csv, FILE *waves, FILE *ring, bool plots);

/* The rig has restarted: its clock and counts begin again. */
void recording_anew(recording *r);

/* Samples were requested again: the gap before the next one is no loss. */
void recording_asked(recording *r);

void recording_frame(recording *r, const schema *s, const wire_frame *frame);

/* Draws the plot, if there is one. Returns false after a failure (reported). */
bool recording_plot(const recording *r, const schema *s, const char *file);

/* Writes pending data and frees all memory. */
void recording_end(recording *r);

#endif
