/* recording.h: what comes of a rig's telemetry: records, waves, what is plotted, and how much was lost. */
#ifndef MONITOR_RECORDING_H
#define MONITOR_RECORDING_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "host/monitor/wire.h"
#include "host/plot/vcd.h"
#include "schema.h"

/* What was lost, and where. */
typedef struct recording_counts {
    uint64_t frames;
    uint64_t samples;
    uint64_t pulses;
    uint64_t lost;         /* frames that did not come, */
    uint64_t dropped;      /* of which the rig had no room for so many */
    uint64_t lost_samples; /* by their times */
    uint64_t strange;      /* frames that no schema is known of */
    uint64_t restarts;     /* the rig began anew */
} recording_counts;

typedef struct recording_channel {
    bool any;
    uint16_t next;
    uint16_t dropped;
} recording_channel;

typedef struct recording {
    FILE *csv;   /* may be NULL, */
    FILE *waves; /* and this */
    FILE *ring;
    vcd *vcd;
    bool plots;
    bool headed;
    bool ring_headed;
    recording_channel channel[SCHEMA_CHANNELS];
    bool timed;
    uint32_t ticks;  /* the last that was told, */
    int64_t time_us; /* and what time that was, since the first */
    bool expects;    /* a sample at: */
    int64_t expected_us;
    int signal[2 * SCHEMA_FIELDS]; /* of the run's fields; then */
    int pulse[2];
    bool ends;    /* of pulses are told, */
    bool high[2]; /* and one is still to come */
    int trip;
    double *row; /* what is plotted: rows of `columns`, thinned out where they are too many */
    int64_t rows;
    int64_t room;
    int columns;
    int64_t every;
    int64_t skipped;
    recording_counts counts;
} recording;

/* The run's channel, the events' and the ring's, as core/station/telemetry.h numbers them. */
enum { RECORDING_RUN, RECORDING_EVENT, RECORDING_RING };

void recording_begin(recording *r, FILE *csv, FILE *waves, FILE *ring, bool plots);

/* The rig began anew: its clock and its counts have nothing to do with what was before. */
void recording_anew(recording *r);

/* Somebody has asked for samples anew, perhaps at another rate: none of those until the next that come was sent. */
void recording_asked(recording *r);

void recording_frame(recording *r, const schema *s, const wire_frame *frame);

/* Draws, where it plots; false when that failed, told. */
bool recording_plot(const recording *r, const schema *s, const char *file);

/* What waits is written, and what it holds given back. */
void recording_end(recording *r);

#endif
