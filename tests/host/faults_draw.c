/* faults_draw.c: which fault, how much of it, when and for how long. */
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "core/hash.h"
#include "faults.h"

/* The noise of the cell that every run has. */
#define NOISE "cell-noise=0.07"
#define GAIN_CALIBRATION 0.05 /* a gain that is off by less only calibration can tell */

typedef enum size_drawn {
    NO_SIZE,
    EVEN,   /* evenly from low to high */
    LOG,    /* its logarithm evenly */
    EITHER, /* the same, with either sign */
    WHOLE,
    ONE_OF_INERTIA
} size_drawn;

enum { NO_CHANNEL, ANY_SENSOR, ONE_SENSOR, SUPPLY_CHANNEL };
enum {
    DRIVES = 1,
    RUNS_AWAY = 2,
    CALIBRATION = 4,
    COUNTED_ONLY = 8,
    HEALTHY = 16,
    AFTER_TRIP = 32, /* something else trips the rig first */
    STARVED = 64,    /* the watchdog resets, and does not cut */
    DELAYS = 128     /* so that the watchdog may cut */
};

static const struct {
    fault_kind kind;
    size_drawn how;
    double low;
    double high;
    int channel;
    unsigned is;
} rows[] = {
    {FAULT_EDGE_JITTER, NO_SIZE, 0, 0, NO_CHANNEL, HEALTHY},
    {FAULT_EDGE_DEAD, NO_SIZE, 0, 0, ANY_SENSOR, 0},
    {FAULT_EDGE_LOST, WHOLE, 1, 6, ANY_SENSOR, 0},
    {FAULT_EDGE_DOUBLE, LOG, 1e-4, 0.05, ANY_SENSOR, 0},
    {FAULT_EDGE_INVENTED, WHOLE, 1, 5, ANY_SENSOR, 0},
    {FAULT_EDGE_STORM, LOG, 50, 8000, ANY_SENSOR, 0},
    {FAULT_EDGE_SWAPPED, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_EDGE_STAMP, EITHER, 1e-6, 0.01, ANY_SENSOR, CALIBRATION},
    {FAULT_EDGE_LATE, LOG, 1e-3, 0.05, ANY_SENSOR, 0},
    {FAULT_EDGE_PLACE, EVEN, -5, 5, ONE_SENSOR, CALIBRATION},
    {FAULT_EDGE_JITTER, LOG, 1e-4, 2e-3, NO_CHANNEL, 0},
    {FAULT_CELL_DEAD, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_CELL_LOST, EVEN, 0.01, 0.95, NO_CHANNEL, 0},
    {FAULT_CELL_FROZEN, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_CELL_OPEN, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_CELL_PICKUP, LOG, 0.05, 30, NO_CHANNEL, 0},
    {FAULT_CELL_HUM, LOG, 0.1, 30, NO_CHANNEL, 0},
    {FAULT_CELL_NOISE, LOG, 0.2, 5, NO_CHANNEL, 0},
    {FAULT_CELL_SPIKES, LOG, 1, 200, NO_CHANNEL, 0},
    {FAULT_CELL_SATURATED, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_CELL_REPEATED, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_CELL_LATE, LOG, 1e-3, 0.1, NO_CHANNEL, 0},
    {FAULT_CELL_TURNED, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_CELL_GAIN, EVEN, 0.3, 2, NO_CHANNEL, 0},
    {FAULT_CELL_OFFSET, EITHER, 1, 150, NO_CHANNEL, 0},
    {FAULT_READS, EVEN, 0, 60, SUPPLY_CHANNEL, 0},
    {FAULT_SUPPLY, EVEN, 0.5, 1.5, NO_CHANNEL, 0},
    {FAULT_FREEWHEEL, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_RUNAWAY, NO_SIZE, 0, 0, NO_CHANNEL, DRIVES | RUNS_AWAY},
    {FAULT_STUCK, NO_SIZE, 0, 0, NO_CHANNEL, DRIVES | RUNS_AWAY},
    {FAULT_MOTOR, EVEN, 0.2, 1.2, NO_CHANNEL, 0},
    {FAULT_FRICTION, EVEN, 0, 0.2, NO_CHANNEL, 0},
    {FAULT_JAM, LOG, 0.5, 20, NO_CHANNEL, 0},
    {FAULT_COUPLING, LOG, 0.03, 1, NO_CHANNEL, 0},
    {FAULT_INERTIA, ONE_OF_INERTIA, 0, 0, NO_CHANNEL, 0},
    {FAULT_SLOW, LOG, 5, 50, NO_CHANNEL, COUNTED_ONLY | DELAYS},
    {FAULT_LATE, LOG, 0.5e-3, 0.03, NO_CHANNEL, DELAYS},
    {FAULT_HANG, LOG, 5e-3, 1, NO_CHANNEL, DELAYS},
    {FAULT_UNKICKED, NO_SIZE, 0, 0, NO_CHANNEL, DELAYS},
    {FAULT_READINGS_LOST, EVEN, 0.01, 0.6, NO_CHANNEL, DELAYS},
    {FAULT_ORDERS_LOST, EVEN, 0.01, 0.6, NO_CHANNEL, DELAYS},
    {FAULT_STOP, NO_SIZE, 0, 0, NO_CHANNEL, 0},
    {FAULT_RESET, LOG, 1e-3, 0.1, NO_CHANNEL, 0},
    {FAULT_RESET, LOG, 1e-3, 0.1, NO_CHANNEL, AFTER_TRIP | DELAYS},
    {FAULT_HANG, LOG, 5e-3, 1, NO_CHANNEL, STARVED | DELAYS},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* What trips a rig that is armed or in a run, and an idle one at the latest when it is ordered to be. */
static const char *const trips[] = {"cell-open",  "cell-dead", "edge-dead",
                                    "supply=0.3", "unkicked",  "jam"};

/* Few, since each is a plant of its own. */
static const double inertias[] = {0.5, 0.7, 1.4, 2.0, 3.0, 4.0, 6.0};

unsigned campaign_rows(void) { return ROWS; }

const char *campaign_row_word(unsigned row) {
    return (rows[row].is & HEALTHY) != 0         ? "none"
           : (rows[row].is & AFTER_TRIP) != 0    ? "reset-tripped"
           : (rows[row].is & STARVED) != 0       ? "hang-resets"
           : rows[row].channel == SUPPLY_CHANNEL ? "supply-reads"
                                                 : fault_rows[rows[row].kind].word;
}

typedef struct drawing {
    uint64_t hash;
    uint64_t count;
} drawing;

/* From 0 to below 1. */
static double draw(drawing *d) {
    const uint64_t bits = wh_hash_u64(wh_hash_u64(d->hash, d->count++), 0x64726177U);
    return (double)(bits >> 11) * 0x1p-53;
}

static unsigned draw_of(drawing *d, unsigned count) { return (unsigned)(draw(d) * count); }

static double draw_log(drawing *d, double low, double high) {
    return low * exp(draw(d) * log(high / low));
}

static double draw_size(drawing *d, unsigned row) {
    const double low = rows[row].low;
    const double high = rows[row].high;
    switch (rows[row].how) {
    case NO_SIZE: return 0.0;
    case EVEN: return low + draw(d) * (high - low);
    case LOG: return draw_log(d, low, high);
    case EITHER: return (draw(d) < 0.5 ? -1.0 : 1.0) * draw_log(d, low, high);
    case WHOLE: return low + draw_of(d, (unsigned)(high - low) + 1U);
    case ONE_OF_INERTIA: return inertias[draw_of(d, sizeof inertias / sizeof inertias[0])];
    }
    return 0.0;
}

typedef struct text {
    char *at;
    size_t room;
} text;

__attribute__((format(printf, 2, 3))) static void put(text *t, const char *format, ...) {
    va_list values;
    va_start(values, format);
    const int count = vsnprintf(t->at, t->room, format, values);
    va_end(values);
    const size_t most = t->room > 0 ? t->room - 1 : 0;
    const size_t length = (size_t)count < most ? (size_t)count : most;
    t->at += length;
    t->room -= length;
}

static void put_channel(text *t, drawing *d, int channel) {
    const unsigned which = channel == ANY_SENSOR       ? draw_of(d, 3)
                           : channel == ONE_SENSOR     ? 1 + draw_of(d, 2)
                           : channel == SUPPLY_CHANNEL ? 2
                                                       : 0;
    if (which > 0) {
        put(t, ":%u", which);
    }
}

static void put_time(text *t, drawing *d, const rig_stage *stage) {
    put(t, "@%s", stage->when);
    put(t, "~%.6g", draw(d) * stage->span_s);
}

static void put_duration(text *t, drawing *d) {
    if (draw(d) < 0.5) {
        put(t, "+%.3g", draw_log(d, 0.02, 3.0));
    }
}

bool campaign_is_emulated(const campaign *c) { return strstr(c->firmware, ".elf") != NULL; }

void campaign_draw(campaign_case *one, const campaign *c, unsigned i) {
    drawing d = {.hash = wh_hash_u64(wh_hash_u64(WH_HASH_START, c->seed), i)};
    rig_stage stage[RIG_STAGES_MAX];
    const unsigned stages = rig_stages(stage);
    *one = (campaign_case){.seed = (uint32_t)(wh_hash_u64(d.hash, 0x73656564U) >> 32)};
    do {
        one->row = draw_of(&d, ROWS);
    } while ((!campaign_is_emulated(c) && (rows[one->row].is & COUNTED_ONLY) != 0) ||
             (c->only != NULL && strcmp(c->only, campaign_row_word(one->row)) != 0));
    const fault_kind kind = rows[one->row].kind;
    const unsigned is = rows[one->row].is;
    one->stage = draw_of(&d, stages);
    text t = {one->words, sizeof one->words};
    put(&t, NOISE);
    if (c->also != NULL) {
        put(&t, ",%s", c->also);
        one->drives = true;
    }
    if ((is & HEALTHY) != 0) {
        return;
    }
    if ((is & AFTER_TRIP) != 0) {
        put(&t, ",%s", trips[draw_of(&d, sizeof trips / sizeof trips[0])]);
        put_time(&t, &d, &stage[one->stage]);
    } else if ((is & STARVED) != 0) {
        put(&t, ",%s", fault_rows[FAULT_WATCHDOG_RESETS].word);
    }
    const double size = draw_size(&d, one->row);
    put(&t, ",%s", fault_rows[kind].word);
    put_channel(&t, &d, rows[one->row].channel);
    if (rows[one->row].how != NO_SIZE) {
        put(&t, "=%.4g", size);
    }
    if ((is & AFTER_TRIP) != 0) {
        put(&t, "@%s~%.6g", rig_tripped_when(), draw_log(&d, 1e-3, 5.0));
    } else if (fault_rows[kind].place != FAULT_PARAMETER) {
        put_time(&t, &d, &stage[one->stage]);
        if (kind != FAULT_RESET) {
            put_duration(&t, &d);
        }
    }
    one->runs_away = (is & RUNS_AWAY) != 0;
    one->delays = (is & DELAYS) != 0 || c->also != NULL;
    one->drives = one->drives || (is & DRIVES) != 0 ||
                  ((kind == FAULT_SUPPLY || kind == FAULT_MOTOR) && size > 1.0);
    one->calibration =
        (is & CALIBRATION) != 0 || (kind == FAULT_CELL_GAIN && fabs(size - 1.0) < GAIN_CALIBRATION);
}
