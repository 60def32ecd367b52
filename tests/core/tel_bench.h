/* tel_bench.h: a station with telemetry that gets random samples and pulses, and a receiver of its line, for the suites
 * of telemetry. */
#ifndef TESTS_CORE_TEL_BENCH_H
#define TESTS_CORE_TEL_BENCH_H

#include "core/station/station.h"
#include "even_rig.h"
#include "wire.h"

#define STEPS_PER_S (WH_RIG_TICKS_PER_S / EVEN_STEP_TICKS)
#define FREE 4096U /* bytes per step of a line that is never full */
#define AT_115200 23U
/* Maximum number of items that wait for the receiver. A chip with a 16-bit int allows no larger array; tests that need
 * more items do not run on it. */
#define TRUTHS (sizeof(int) > 2U ? 1024U : 64U)

/* An item that was sent and has not been received yet. */
typedef struct tel_truth {
    uint32_t ticks[TRUTHS];
    int32_t value[TRUTHS];
    unsigned put;
    unsigned taken;
} tel_truth;

typedef struct tel_counts {
    unsigned frames;
    uint32_t gaps;    /* number of gaps in the sequences of all channels */
    uint32_t dropped; /* number of dropped items that the frames report */
    uint16_t before[WH_TEL_CHANNELS];
    unsigned loads;
    bool broken; /* the line loses frames */
    bool uneven; /* samples come unevenly */
    bool blind;  /* the receiver does not check the frames' contents */
    bool any[WH_TEL_CHANNELS];
    uint16_t next[WH_TEL_CHANNELS];
} tel_counts;

typedef struct tel_bench {
    even_rig even;
    wh_station station;
    wh_tel tel;
    wh_step_inputs seen; /* inputs of the last step */
    wire heard;
    uint64_t seed; /* seed of the random draws */
    uint32_t cell_ticks;
    tel_truth samples;
    tel_truth pulses;
    tel_counts got;
} tel_bench;

extern tel_bench bench;

/* Begins with the rig at rest, telemetry off, and nothing received. */
void tel_begin(void);

void tel_type(const char *line);

/* The line transmits `bytes` bytes. The receiver compares them with the sent data. */
void tel_hear(unsigned bytes);
void tel_hear_frame(const wire_frame *frame);

/* Draws the input of this step. If `evenly`, it has one sample. Otherwise it sometimes has two, none, a late or an
 * invalid one. It may also have a pulse. */
void tel_draw_seen(bool evenly);

void tel_step(void);

/* One control period of the firmware. The line transmits `bytes` bytes in it. */
void tel_period(bool evenly, unsigned bytes);

/* Turns telemetry on at this rate. From then on all output is compared with the sent data. */
void tel_turn_on(const char *rate);

#endif
