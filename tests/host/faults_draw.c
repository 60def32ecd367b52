/* faults_draw.c: random choice of a fault, its size, begin and duration. */
#include "core/hash.h"
#include "faults.h"
#include "test.h"

/* Noise of the cell in every run. */
#define NOISE "cell-noise=0.07"
#define GAIN_CALIBRATION 0.05 /* a smaller gain error is visible to calibration only */

typedef enum size_drawn {
    NO_SIZE,
    EVEN,   /* uniform from low to high */
    LOG,    /* uniform logarithm */
    EITHER, /* uniform logarithm, random sign */
    WHOLE,
    ONE_OF_INERTIA
} size_drawn;

enum { NO_CHANNEL, ANY_SENSOR, ONE_SENSOR, SUPPLY_CHANNEL, FEED_CHANNEL };
enum {
    DRIVES = 1,
    RUNS_AWAY = 2,
    CALIBRATION = 4,
    COUNTED_ONLY = 8,
    HEALTHY = 16,
    AFTER_TRIP = 32, /* another fault trips the rig first */
    STARVED = 64,    /* the watchdog resets and does not cut the power */
    DELAYS = 128,    /* the watchdog may cut the power */
    FED = 256,       /* gravity compensation in every run; with `dials`, from the start */
    TURNED = 512,    /* gravity compensation with the wrong sign */
    /* size as a share of the supply; half of the runs have stop pressed and a sensor that fails */
    SHARE = 1024
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
    {FAULT_RUNAWAY, EVEN, 0.2, 1, NO_CHANNEL, DRIVES | SHARE},
    {FAULT_STUCK, EVEN, 0.2, 1, NO_CHANNEL, DRIVES | SHARE},
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
    {FAULT_READS, EVEN, 0.7, 1.3, FEED_CHANNEL, FED},
    {FAULT_READS, EVEN, -1, -1, FEED_CHANNEL, FED | TURNED},
    {FAULT_EDGE_PLACE, EVEN, -3, 3, ANY_SENSOR, FED | CALIBRATION},
};
enum { ROWS = sizeof rows / sizeof rows[0], TWO_FAULTS = ROWS };
#define TWO_WORD "two faults"
#define TWO_PART 0.1 /* share of runs with a second fault */

/* May a row be the second fault? Only if it acts while the rig runs, and the verdict does not depend on the time at
 * which it begins. */
static bool may_be_second(unsigned row) {
    const fault_kind kind = rows[row].kind;
    return (rows[row].is &
            (RUNS_AWAY | COUNTED_ONLY | HEALTHY | AFTER_TRIP | STARVED | FED | SHARE)) == 0 &&
           kind != FAULT_STOP && kind != FAULT_RESET && fault_rows[kind].place != FAULT_PARAMETER;
}

#define NOMINAL_PART 0.25 /* share of runs at the rig's nominal speed */
#define SLOW_PART 0.25    /* share of runs that are too slow without gravity compensation */
#define FED_PART 0.2      /* share of the other runs with gravity compensation */
#define BRAKES_PART 0.3   /* share of all runs: the motor brakes */
#define SUPPLY_LEAST 0.5  /* as a share of 24 V; still allowed */
#define SUPPLY_MOST 1.5
#define SLOWEST_RPM 100.0
#define SLOW_RPM 170.0
#define FASTEST_RPM 360.0
#define RADPS_PER_RPM 0.10471975511965977

/* Faults that trip an armed or running rig at once, and an idle rig at the order `start`. */
static const char *const trips[] = {"cell-open",  "cell-dead", "edge-dead",
                                    "supply=0.3", "unkicked",  "jam"};

/* Factors of the inertia. There are few, because each needs its own plant. */
static const double inertias[] = {0.5, 0.7, 1.4, 2.0, 3.0, 4.0, 6.0};

unsigned campaign_rows(void) { return ROWS + 1; }

const char *campaign_row_word(unsigned row) {
    if (row == TWO_FAULTS) {
        return TWO_WORD;
    }
    if ((rows[row].is & FED) != 0) {
        return (rows[row].is & TURNED) != 0        ? "feed-turned"
               : rows[row].channel == FEED_CHANNEL ? "feed-part"
                                                   : "edge-place-fed";
    }
    return (rows[row].is & HEALTHY) != 0                                    ? "none"
           : (rows[row].is & AFTER_TRIP) != 0                               ? "reset-tripped"
           : (rows[row].is & STARVED) != 0                                  ? "hang-resets"
           : rows[row].kind == FAULT_RUNAWAY && (rows[row].is & SHARE) != 0 ? "runaway-share"
           : rows[row].kind == FAULT_STUCK && (rows[row].is & SHARE) != 0   ? "stuck-share"
           : rows[row].channel == SUPPLY_CHANNEL                            ? "supply-reads"
                                                 : fault_rows[rows[row].kind].word;
}

typedef struct drawing {
    uint64_t hash;
    uint64_t count;
} drawing;

/* Uniform in [0, 1). The hash alone is almost linear in the run's number: runs that are equal in one draw would be
 * equal in all. Stafford's thirteenth mix removes this dependence. */
static double draw(drawing *d) {
    uint64_t bits = wh_hash_u64(wh_hash_u64(d->hash, d->count++), 0x64726177U);
    bits = (bits ^ (bits >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ (bits >> 27)) * UINT64_C(0x94D049BB133111EB);
    bits ^= bits >> 31;
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
                           : channel == FEED_CHANNEL   ? 5
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

bool campaign_is_alone(const campaign_case *one) { return one->row != TWO_FAULTS; }

bool campaign_has_dials(const campaign *c) { return strstr(c->firmware, "pil_dialled") != NULL; }

/* The operator's dials are samples 4 to 6. */
static void put_dials(text *t, drawing *d, campaign_case *one, bool fed) {
    const double which = draw(d);
    one->target_rpm = which < NOMINAL_PART ? rig_nominal_rpm()
                      : which < NOMINAL_PART + SLOW_PART
                          ? SLOWEST_RPM + draw(d) * (SLOW_RPM - SLOWEST_RPM)
                          : SLOW_RPM + draw(d) * (FASTEST_RPM - SLOW_RPM);
    put(t, ",%s:4=%.4f", fault_rows[FAULT_READS].word, one->target_rpm * RADPS_PER_RPM);
    if (draw(d) < FED_PART || fed) {
        put(t, ",%s:5=1", fault_rows[FAULT_READS].word);
    }
    if (draw(d) < BRAKES_PART) {
        put(t, ",%s:6=1", fault_rows[FAULT_READS].word);
    }
}

/* Writes a fault of a power stage that is stuck at any part of the supply, sometimes with stop pressed or a sensor that
 * fails. */
static void put_share(text *t, drawing *d, unsigned row, const rig_stage *stage,
                      campaign_case *one) {
    const double after_s = draw(d) * stage->span_s;
    const double supply = SUPPLY_LEAST + draw(d) * (SUPPLY_MOST - SUPPLY_LEAST);
    const unsigned dead = draw_of(d, 4);
    put(t, ",%s=%.4g", fault_rows[FAULT_SUPPLY].word, supply);
    if (draw(d) < 0.5) {
        put(t, ",%s@%s~%.6g", fault_rows[FAULT_STOP].word, stage->when, after_s);
    }
    one->blind = dead > 1;
    if (one->blind) {
        put(t, ",%s:%u@%s~%.6g", fault_rows[FAULT_EDGE_DEAD].word, dead - 1U, stage->when, after_s);
    }
    put(t, ",%s=%.4g@%s~%.6g", fault_rows[rows[row].kind].word, draw_size(d, row), stage->when,
        after_s);
    one->drives = true;
}

static void put_fault(text *t, drawing *d, unsigned row, const rig_stage *stage,
                      campaign_case *one) {
    const fault_kind kind = rows[row].kind;
    const unsigned is = rows[row].is;
    const double size = draw_size(d, row);
    put(t, ",%s", fault_rows[kind].word);
    put_channel(t, d, rows[row].channel);
    if (rows[row].how != NO_SIZE) {
        put(t, "=%.4g", size);
    }
    if ((is & AFTER_TRIP) != 0) {
        put(t, "@%s~%.6g", rig_tripped_when(), draw_log(d, 1e-3, 5.0));
    } else if (fault_rows[kind].place != FAULT_PARAMETER && (is & FED) == 0) {
        put_time(t, d, stage);
        if (kind != FAULT_RESET) {
            put_duration(t, d);
        }
    }
    one->delays = one->delays || (is & DELAYS) != 0;
    one->drives = one->drives || (is & DRIVES) != 0 ||
                  ((kind == FAULT_SUPPLY || kind == FAULT_MOTOR) && size > 1.0);
    one->calibration = one->calibration || (is & CALIBRATION) != 0 ||
                       (kind == FAULT_CELL_GAIN && fabs(size - 1.0) < GAIN_CALIBRATION);
}

/* Adds a second fault before that of row `first`. If the controller must stop by a deadline, the second must not delay
 * it. */
static void put_second(text *t, drawing *d, const campaign *c, unsigned first,
                       const rig_stage *stage, campaign_case *one) {
    const bool two = draw(d) < TWO_PART;
    const bool asked = c->only != NULL && strcmp(c->only, TWO_WORD) == 0;
    const fault_kind kind = rows[first].kind;
    const bool halts = kind == FAULT_STOP || kind == FAULT_RESET || (rows[first].is & STARVED) != 0;
    if (!asked && (!two || c->only != NULL)) {
        return;
    }
    unsigned row = 0;
    do {
        row = draw_of(d, ROWS);
    } while (!may_be_second(row) || (halts && (rows[row].is & DELAYS) != 0));
    put_fault(t, d, row, stage, one);
    one->row = TWO_FAULTS;
}

static bool may_be_first(const campaign *c, unsigned row) {
    const unsigned is = rows[row].is;
    const bool two = c->only != NULL && strcmp(c->only, TWO_WORD) == 0;
    return (campaign_is_emulated(c) || (is & COUNTED_ONLY) == 0) &&
           (campaign_has_dials(c) || (is & FED) == 0) &&
           (two               ? (is & HEALTHY) == 0
            : c->only != NULL ? strcmp(c->only, campaign_row_word(row)) == 0
                              : true);
}

bool campaign_has_any(const campaign *c) {
    bool any = false;
    for (unsigned row = 0; row < ROWS; row++) {
        any = any || may_be_first(c, row);
    }
    return any;
}

void campaign_draw(campaign_case *one, const campaign *c, unsigned i) {
    drawing d = {.hash = wh_hash_u64(wh_hash_u64(WH_HASH_START, c->seed), i)};
    rig_stage stage[RIG_STAGES_MAX];
    const unsigned stages = rig_stages(stage);
    *one = (campaign_case){.seed = (uint32_t)(wh_hash_u64(d.hash, 0x73656564U) >> 32),
                           .target_rpm = rig_nominal_rpm(),
                           .drives = c->also != NULL,
                           .delays = c->also != NULL};
    do {
        one->row = draw_of(&d, ROWS);
    } while (!may_be_first(c, one->row));
    const unsigned row = one->row;
    const unsigned is = rows[row].is;
    one->stage = draw_of(&d, stages);
    text t = {one->words, sizeof one->words};
    put(&t, NOISE);
    if (campaign_has_dials(c)) {
        put_dials(&t, &d, one, (is & FED) != 0 && rows[row].channel != FEED_CHANNEL);
    }
    if (c->also != NULL) {
        put(&t, ",%s", c->also);
    }
    if ((is & HEALTHY) != 0) {
        return;
    }
    one->breaks = true;
    one->from_start = (is & FED) != 0;
    one->runs_away = (is & RUNS_AWAY) != 0;
    if ((is & SHARE) != 0) {
        put_share(&t, &d, row, &stage[one->stage], one);
        return;
    }
    put_second(&t, &d, c, row, &stage[one->stage], one);
    if ((is & AFTER_TRIP) != 0) {
        put(&t, ",%s", trips[draw_of(&d, sizeof trips / sizeof trips[0])]);
        put_time(&t, &d, &stage[one->stage]);
    } else if ((is & STARVED) != 0) {
        put(&t, ",%s", fault_rows[FAULT_WATCHDOG_RESETS].word);
    }
    put_fault(&t, &d, row, &stage[one->stage], one);
}
