/* tel_bench.h: a station with telemetry on made-up samples and pulses, and who hears it: for the suites of telemetry. */
#ifndef TESTS_CORE_TEL_BENCH_H
#define TESTS_CORE_TEL_BENCH_H

#include "core/station/station.h"
#include "even_rig.h"
#include "wire.h"

#define STEPS_PER_S (WH_RIG_TICKS_PER_S / EVEN_STEP_TICKS)
#define FREE 4096U /* bytes a step: a line that is never full */
#define AT_115200 23U
/* Of a chip whose int has 16 bits no type is as large; what it has room for does not run there. */
#define TRUTHS (sizeof(int) > 2U ? 1024U : 64U)

/* What was sent, and has not been heard yet. */
typedef struct tel_truth {
    uint32_t ticks[TRUTHS];
    int32_t value[TRUTHS];
    unsigned put;
    unsigned taken;
} tel_truth;

typedef struct tel_counts {
    unsigned frames;
    uint32_t gaps;    /* in the sequences of all channels */
    uint32_t dropped; /* as frames say */
    uint16_t before[WH_TEL_CHANNELS];
    unsigned loads;
    bool broken; /* the line loses frames, too */
    bool uneven; /* samples do not come evenly */
    bool blind;  /* what frames hold is not looked at */
    bool any[WH_TEL_CHANNELS];
    uint16_t next[WH_TEL_CHANNELS];
} tel_counts;

typedef struct tel_bench {
    even_rig even;
    wh_station station;
    wh_tel tel;
    wh_seen seen; /* in the last step */
    wire heard;
    uint64_t seed; /* of what is drawn */
    uint32_t cell_ticks;
    tel_truth samples;
    tel_truth pulses;
    tel_counts got;
} tel_bench;

extern tel_bench bench;

/* At rest, telemetry off, nothing heard. */
void tel_begin(void);

/* A line. */
void tel_type(const char *line);

/* The line takes so many bytes; what they say is held against what was sent. */
void tel_hear(unsigned bytes);
void tel_hear_frame(const wire_frame *frame);

/* What this step sees: a sample a step, evenly; or now and then two, none, one that is late or none at all. And pulses. */
void tel_draw_seen(bool evenly);

/* The station with what this step has seen. */
void tel_step(void);

/* One control period of the firmware, of which the line takes so many bytes. */
void tel_period(bool evenly, unsigned bytes);

/* By this order; all that comes from now on is held against what is sent. */
void tel_turn_on(const char *rate);

#endif
