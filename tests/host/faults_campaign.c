/* faults_campaign.c: the fault campaign. It draws random faults, judges each run and prints the campaign in
 * Markdown. */
#include "core/hash.h"
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "faults.h"
#include "host/base/alloc.h"
#include "host/pil/lockstep.h"
#include "test.h"

/* === the controller's words ==================================================================== */

typedef struct rig_stage {
    unsigned of;   /* the value of the note `state` */
    double span_s; /* mean duration of the state in a healthy run, s */
} rig_stage;

#define PHASE(phase) (WH_RIG_STAGE_OF_PHASE + (unsigned)(phase))

/* A healthy run to 330 rpm. */
static const rig_stage healthy[] = {
    {WH_RIG_IDLE, 1.4},
    {PHASE(WH_PHASE_TARE), 0.5},
    {PHASE(WH_PHASE_SPIN_UP), 0.6},
    {PHASE(WH_PHASE_RAMP), 2.8},
    {PHASE(WH_PHASE_SETTLE), 3.2},
    {PHASE(WH_PHASE_RECORD), 2.0},
    {PHASE(WH_PHASE_RAMP_DOWN), 2.2},
    {PHASE(WH_PHASE_OFF), 2.5},
};
enum { STAGES = sizeof healthy / sizeof healthy[0] };

/* Index of the stage that the notes show; -1 if they show no stage. */
static int rig_stage_of(const float *note) {
    for (int i = 0; i < STAGES; i++) {
        if (healthy[i].of == (unsigned)note[HAL_NOTE_STATE]) {
            return i;
        }
    }
    return -1;
}

static bool rig_is_tripped(const float *note) {
    return (int)note[HAL_NOTE_STATE] == (int)WH_RIG_TRIPPED;
}

static bool rig_is_idle(const float *note) { return (int)note[HAL_NOTE_STATE] == (int)WH_RIG_IDLE; }

static bool rig_may_drive(const float *note) {
    const unsigned stage = (unsigned)note[HAL_NOTE_STATE];
    return stage >= PHASE(WH_PHASE_SPIN_UP) && stage <= PHASE(WH_PHASE_RAMP_DOWN);
}

/* The controller must stop a drive that ignores the voltage within TURNS and one control period: then two slot pulses
 * have come too early. A pulse in the first sixth of a turn does not count as early (docs/rig.md). */
#define CAUGHT_RPM 470.0
#define TURNS (7.0 / 6.0)
#define LAG_S 0.23 /* time constant of the rotor at full voltage */
#define FULL_RPM 568.0
#define STEP_S 1e-5
#define PERIOD_STEPS 200 /* simulated steps in a control period of 2 ms */
#define INERTIA_KGM2 5.77e-3

/* The greatest speed that is allowed before the enable line is off, if the drive ignores the voltage in a run at
 * target_rpm: full voltage for that time, plus the speed that gravity adds. At least CAUGHT_RPM. */
static double rig_caught_rpm(double target_rpm) {
    const double weight_Nm = (double)(WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2);
    double rpm = target_rpm;
    double turns = 0.0;
    for (unsigned late = 0; late < PERIOD_STEPS; late += turns >= TURNS) {
        rpm += (FULL_RPM - rpm) / LAG_S * STEP_S;
        turns += rpm / 60.0 * STEP_S;
    }
    const double per_radps = (double)WH_RIG_RADPS_PER_RPM;
    const double fastest = rpm + weight_Nm / (INERTIA_KGM2 * rpm * per_radps) / per_radps;
    return fastest > CAUGHT_RPM ? fastest : CAUGHT_RPM;
}

/* === random faults ============================================================================= */

/* Noise of the load cell, N, in every run. */
#define NOISE "cell-noise=0.07"
#define GAIN_CALIBRATION 0.05 /* only a calibration can show a smaller gain error */

typedef enum size_drawn {
    NO_SIZE,
    EVEN,   /* uniform from low to high */
    LOG,    /* logarithm uniform from low to high */
    EITHER, /* logarithm uniform from low to high, with a random sign */
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
    AFTER_TRIP = 32, /* the fault acts only after another fault has tripped the rig */
    STARVED = 64,    /* the watchdog resets the controller and does not cut the power */
    DELAYS = 128,    /* the watchdog may cut the power */
    FED = 256,       /* with gravity compensation and a fault from the start; needs dials */
    TURNED = 512,    /* gravity compensation with the wrong sign */
    /* the size is a share of the supply; half of the runs have stop pressed, half have a dead sensor */
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

/* May this row be the second fault of a run? Only if the fault acts while the rig runs and the verdict does not
 * depend on the time at which the fault begins. */
static bool may_be_second(unsigned row) {
    const fault_kind kind = rows[row].kind;
    return (rows[row].is &
            (RUNS_AWAY | COUNTED_ONLY | HEALTHY | AFTER_TRIP | STARVED | FED | SHARE)) == 0 &&
           kind != FAULT_STOP && kind != FAULT_RESET && fault_rows[kind].place != FAULT_PARAMETER;
}

#define NOMINAL_PART 0.25 /* share of runs at the rig's nominal speed */
/* share of runs at speeds that are too slow without gravity compensation */
#define SLOW_PART 0.25
#define FED_PART 0.2     /* share of runs with gravity compensation, unless the row always has it */
#define BRAKES_PART 0.3  /* share of all runs in which the motor brakes */
#define SUPPLY_LEAST 0.5 /* lowest supply voltage, as a share of 24 V */
#define SUPPLY_MOST 1.5
#define SLOWEST_RPM 100.0
#define SLOW_RPM 170.0
#define FASTEST_RPM 360.0
#define RADPS_PER_RPM 0.10471975511965977

/* Faults that trip an armed or running rig at once, and an idle rig when `start` is ordered. */
static const char *const trip_words[] = {"cell-open",  "cell-dead", "edge-dead",
                                         "supply=0.3", "unkicked",  "jam"};

/* Factors of the inertia. There are few, because each factor needs a plant of its own. */
static const double inertias[] = {0.5, 0.7, 1.4, 2.0, 3.0, 4.0, 6.0};

static const char *campaign_row_word(unsigned row) {
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

/* Returns a random number in [0, 1). Stafford's thirteenth mix is needed because the hash alone is almost linear in
 * the run's number: if two runs were equal in one draw, all their draws would be equal. */
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
    put(t, "@state=%u~%.6g", stage->of, draw(d) * stage->span_s);
}

static void put_duration(text *t, drawing *d) {
    if (draw(d) < 0.5) {
        put(t, "+%.3g", draw_log(d, 0.02, 3.0));
    }
}

/* Does the board's firmware run in an emulator, which counts instructions? */
static bool campaign_is_emulated(const campaign *c) { return strstr(c->firmware, ".elf") != NULL; }

static bool campaign_is_alone(const campaign_case *one) { return one->row != TWO_FAULTS; }

static bool campaign_has_dials(const campaign *c) {
    return strstr(c->firmware, "pil_dialled") != NULL;
}

/* Draws the operator's dials, which the firmware reads as samples 4 to 6: speed, gravity compensation, braking. */
static void put_dials(text *t, drawing *d, campaign_case *one, bool compensated) {
    const double which = draw(d);
    one->target_rpm = which < NOMINAL_PART ? (double)WH_RIG_NOMINAL_RPM
                      : which < NOMINAL_PART + SLOW_PART
                          ? SLOWEST_RPM + draw(d) * (SLOW_RPM - SLOWEST_RPM)
                          : SLOW_RPM + draw(d) * (FASTEST_RPM - SLOW_RPM);
    put(t, ",%s:4=%.4f", fault_rows[FAULT_READS].word, one->target_rpm * RADPS_PER_RPM);
    if (draw(d) < FED_PART || compensated) {
        put(t, ",%s:5=1", fault_rows[FAULT_READS].word);
    }
    if (draw(d) < BRAKES_PART) {
        put(t, ",%s:6=1", fault_rows[FAULT_READS].word);
    }
}

/* Writes a power stage that drives with a random share of the supply, whatever the controller orders. In half of the
 * runs stop is pressed. In half of the runs a sensor is dead. */
static void put_share(text *t, drawing *d, unsigned row, const rig_stage *stage,
                      campaign_case *one) {
    const double after_s = draw(d) * stage->span_s;
    const double supply = SUPPLY_LEAST + draw(d) * (SUPPLY_MOST - SUPPLY_LEAST);
    const unsigned dead = draw_of(d, 4);
    put(t, ",%s=%.4g", fault_rows[FAULT_SUPPLY].word, supply);
    if (draw(d) < 0.5) {
        put(t, ",%s@state=%u~%.6g", fault_rows[FAULT_STOP].word, stage->of, after_s);
    }
    one->blind = dead > 1;
    if (one->blind) {
        put(t, ",%s:%u@state=%u~%.6g", fault_rows[FAULT_EDGE_DEAD].word, dead - 1U, stage->of,
            after_s);
    }
    put(t, ",%s=%.4g@state=%u~%.6g", fault_rows[rows[row].kind].word, draw_size(d, row), stage->of,
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
        put(t, "@state=%d~%.6g", (int)WH_RIG_TRIPPED, draw_log(d, 1e-3, 5.0));
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

/* Writes a second fault before the fault of row `first`. If the controller must stop the motor by a deadline, the
 * second fault must not delay the controller. */
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
    *one = (campaign_case){.seed = (uint32_t)(wh_hash_u64(d.hash, 0x73656564U) >> 32),
                           .target_rpm = (double)WH_RIG_NOMINAL_RPM,
                           .drives = c->also != NULL,
                           .delays = c->also != NULL};
    do {
        one->row = draw_of(&d, ROWS);
    } while (!may_be_first(c, one->row));
    const unsigned row = one->row;
    const unsigned is = rows[row].is;
    one->stage = draw_of(&d, STAGES);
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
        put_share(&t, &d, row, &healthy[one->stage], one);
        return;
    }
    put_second(&t, &d, c, row, &healthy[one->stage], one);
    if ((is & AFTER_TRIP) != 0) {
        put(&t, ",%s", trip_words[draw_of(&d, sizeof trip_words / sizeof trip_words[0])]);
        put_time(&t, &d, &healthy[one->stage]);
    } else if ((is & STARVED) != 0) {
        put(&t, ",%s", fault_rows[FAULT_WATCHDOG_RESETS].word);
    }
    put_fault(&t, &d, row, &healthy[one->stage], one);
}

/* === verdicts ================================================================================== */

#define TURN_RAD 6.283185307179586477
#define RPM_PER_RADPS 9.5492965855137202
#define OFF_SHARE 0.01 /* a result of good quality may be this far outside its interval */
#define LASTING_S 1.0
#define HALT_S 2e-3  /* for a control period after a stop or reset, the motor may drive */
#define WATCH_S 1e-3 /* time between two calls of watch() */
#define WATCHED_S 12.0
/* if turns show a drive, the enable must be off, or a trip reported, within this time */
#define SHOWN_S 1.0
#define HAND_RPM 61.0 /* a hand can turn the rotor at most this fast */
/* with the motor off, three successive rises of the speed with this total ratio show a drive */
#define RISE 1.05
/* a result may be for turns that ended 0, 1 or 2 turns ago */
#define SHIFTS 3
enum { GOOD, DOUBTFUL, REFUSED }; /* the values of wh_quality */

/* --- outputs and notes ------------------------------------------------------------------------------------------ */

static bool find_outputs(judge *j, const wh_hello *hello) {
    static const char *const notes[] = {
#define WORD(name, word, unit) word,
        HAL_NOTE_ROWS(WORD)
#undef WORD
    };
    int outputs = 0;
    int note = 0;
    j->at_duty = -1;
    j->at_enable = -1;
    memset(j->at_note, -1, sizeof j->at_note);
    for (unsigned i = 0; i < hello->signals; i++) {
        const wh_signal *s = &hello->signal[i];
        if (s->kind == WH_SIGNAL_OUTPUT) {
            j->at_duty = strcmp(s->name, "duty") == 0 ? outputs : j->at_duty;
            j->at_enable = strcmp(s->name, "enable") == 0 ? outputs : j->at_enable;
            outputs++;
        }
    }
    for (unsigned i = 0; i < hello->signals; i++) {
        const wh_signal *s = &hello->signal[i];
        for (int n = 0; s->kind == WH_SIGNAL_NOTE && n < HAL_NOTES; n++) {
            j->at_note[n] = strcmp(s->name, notes[n]) == 0 ? outputs + note : j->at_note[n];
        }
        note += s->kind == WH_SIGNAL_NOTE;
    }
    bool all = j->at_duty >= 0 && j->at_enable >= 0;
    for (int n = 0; n < HAL_NOTES; n++) {
        all = all && j->at_note[n] >= 0;
    }
    return all;
}

static bool start(void *of, const wh_hello *hello, plant *p) {
    judge *j = of;
    j->plant = p;
    j->per_count = talk_instructions_per_count(hello);
    j->ticks_per_s = (double)hello->ticks_per_s;
    const bool good = find_outputs(j, hello) && bind_read(&j->angle, p->image, "theta") != NULL &&
                      bind_read(&j->rate, p->image, "theta'") != NULL &&
                      bind_read(&j->force, p->image, "pin_force") != NULL;
    if (!good) {
        fprintf(stderr,
                "faults: error: no rig on its bench: theta, pin_force, duty, enable, notes\n");
    }
    return good;
}

/* --- the true force and speed
 * ----------------------------------------------------------------------------------------------------- */

/* Integrates the force times the cosine and sine of the angle, by the trapezoidal rule. A sample each millisecond is
 * fine enough: at 330 rpm the arms turn by two degrees. */
static void add_up(judge *j, double from, double force_from, double to, double force_to) {
    const double half = (to - from) / 2.0;
    j->sum.cosine_N += half * (force_from * cos(from) + force_to * cos(to));
    j->sum.sine_N += half * (force_from * sin(from) + force_to * sin(to));
}

/* Called at the end of a complete turn in which the motor must not drive. Notes the time if turns show a drive. */
static void see_undriven(judge *j, double at_s, double rpm) {
    const bool faster = rpm > j->rpm;
    j->on_turns++;
    if (j->on_turns > 1 && faster && j->on_shown_s < 0.0) {
        j->on_shown_s = at_s;
    }
    j->rises = faster ? j->rises + 1U : 0U;
    j->rises_rpm = j->rises == 1U ? j->rpm : j->rises_rpm;
    if (j->rises > 2U && j->rpm > HAND_RPM && rpm > RISE * j->rises_rpm && j->off_shown_s < 0.0) {
        j->off_shown_s = at_s;
    }
    j->rpm = rpm;
}

static void end_turn(judge *j, double at_s) {
    verdict *v = &j->verdict;
    if (j->whole && j->off) {
        see_undriven(j, at_s, TURN_RAD / (at_s - j->begun_s) * RPM_PER_RADPS);
    }
    j->off = !rig_may_drive(j->told);
    if (j->whole) {
        true_turn *t = &j->turn[j->turns++ % JUDGE_TURNS];
        *t = (true_turn){j->sum.cosine_N * 2.0 / TURN_RAD, j->sum.sine_N * 2.0 / TURN_RAD};
        const double rpm = TURN_RAD / (at_s - j->begun_s) * RPM_PER_RADPS;
        v->turn_rpm = rpm > v->turn_rpm ? rpm : v->turn_rpm;
    }
    j->sum = (true_turn){0.0, 0.0};
    j->begun_s = at_s;
    j->whole = true;
}

/* Time in ticks since which the motor has not been driven; infinity if the motor still drives. */
static double off_since_ticks(const judge *j, const plant *p) {
    const int at[] = {j->at_duty, j->at_enable};
    double since = (double)INFINITY;
    for (int i = 0; i < 2; i++) {
        if (!(p->in_effect[at[i]] > 0.0) && p->since_ticks[at[i]] < since) {
            since = p->since_ticks[at[i]];
        }
    }
    return since;
}

/* After a stop or reset nothing may drive the motor: the controller must not start by itself. */
static void watch_halt(judge *j, double time_s, const plant *p) {
    const fault_case *f = &j->plan->fault[j->plan->count - 1U];
    verdict *v = &j->verdict;
    const bool reset = p->reset.count > 0;
    if (!v->halted && (reset || (f->kind == FAULT_STOP && f->happened))) {
        v->halted = true;
        j->halted_s = reset ? p->reset.last_ticks / j->ticks_per_s : f->begin_s;
    }
    if (!v->halted || v->halted_s < 0.0) {
        return;
    }
    const double off_s = off_since_ticks(j, p) / j->ticks_per_s;
    if (!isfinite(off_s)) {
        v->halted_s = time_s > j->halted_s + HALT_S + WATCH_S / 2.0 ? -1.0 : 0.0;
    } else if (off_s > j->halted_s) {
        v->halted_s = off_s - j->halted_s;
    }
}

/* While the motor must not drive: reports an enable line that stays on although turns show a drive, or a missing
 * trip. */
static void watch_off(judge *j, double time_s, const plant *p) {
    const bool on = p->in_effect[j->at_enable] > 0.0;
    if (rig_may_drive(j->told)) {
        j->off = false;
        j->rpm = (double)INFINITY;
        j->on_shown_s = -1.0;
        j->off_shown_s = -1.0;
    }
    if (!j->off || !on) {
        j->on_turns = 0;
        j->on_shown_s = -1.0;
    }
    if (!j->off || rig_is_tripped(j->told)) {
        j->rises = 0;
        j->off_shown_s = -1.0;
    }
    j->verdict.stays_on =
        j->verdict.stays_on || (j->on_shown_s >= 0.0 && time_s > j->on_shown_s + SHOWN_S);
    j->verdict.untold =
        j->verdict.untold || (campaign_is_alone(j->of) && !j->of->blind && j->off_shown_s >= 0.0 &&
                              time_s > j->off_shown_s + SHOWN_S);
}

static void watch(void *of, double time_s, const plant *p) {
    judge *j = of;
    double output[64];
    watch_halt(j, time_s, p);
    engine_double.outputs(p->run, output);
    const double theta = p->after[j->angle.index];
    const double force = output[j->force.index];
    const double rpm = fabs(p->after[j->rate.index]) * RPM_PER_RADPS;
    const double turn = floor(theta / TURN_RAD);
    const double turn_before = floor(j->theta / TURN_RAD);
    j->speed_rpm = rpm;
    j->verdict.peak_rpm = rpm > j->verdict.peak_rpm ? rpm : j->verdict.peak_rpm;
    if (turn == turn_before) {
        add_up(j, j->theta, j->force_N, theta, force);
    } else {
        const double edge = TURN_RAD * (turn > turn_before ? turn : turn_before);
        const double part = (edge - j->theta) / (theta - j->theta);
        const double there = j->force_N + part * (force - j->force_N);
        add_up(j, j->theta, j->force_N, edge, there);
        j->whole = j->whole && turn > turn_before;
        end_turn(j, j->last_s + part * (time_s - j->last_s));
        j->whole = turn > turn_before;
        add_up(j, edge, there, theta, force);
    }
    j->theta = theta;
    j->force_N = force;
    j->last_s = time_s;
    watch_off(j, time_s, p);
}

/* How far a result is outside its interval plus 1 %: relative for the amplitude, in rad for the phase, whichever is
 * larger. The result may be for turns that ended 0 to SHIFTS - 1 turns ago; the smallest value counts. */
static double off_by(const judge *j, unsigned turns) {
    const double amplitude = (double)j->told[HAL_NOTE_AMPLITUDE];
    const double phase = (double)j->told[HAL_NOTE_PHASE];
    double least = (double)INFINITY;
    for (unsigned shift = 0; shift < SHIFTS; shift++) {
        true_turn mean = {0.0, 0.0};
        if (turns + shift > j->turns || turns + shift > JUDGE_TURNS) {
            break;
        }
        for (unsigned i = 0; i < turns; i++) {
            const true_turn *t = &j->turn[(j->turns - 1U - shift - i) % JUDGE_TURNS];
            mean.cosine_N += t->cosine_N / turns;
            mean.sine_N += t->sine_N / turns;
        }
        const double truth = hypot(mean.cosine_N, mean.sine_N);
        const double angle = remainder(phase - atan2(-mean.sine_N, mean.cosine_N), TURN_RAD);
        const double amplitude_off =
            (fabs(amplitude - truth) - (double)j->told[HAL_NOTE_AMPLITUDE_HALF]) / truth -
            OFF_SHARE;
        const double phase_off = fabs(angle) - (double)j->told[HAL_NOTE_PHASE_HALF] - OFF_SHARE;
        const double most = amplitude_off > phase_off ? amplitude_off : phase_off;
        least = most < least ? most : least;
    }
    return isfinite(least)
               ? least
               : 1.0; /* the judge does not have all turns of the result: a large error */
}

/* --- the controller's messages -------------------------------------------------------------------------------- */

static void look_for_fault(judge *j) {
    const fault_case *f = &j->plan->fault[j->plan->count - 1U];
    if (j->of->breaks && f->happened && !j->began) {
        const bool always = j->of->from_start || fault_rows[f->kind].place == FAULT_PARAMETER;
        j->began = true;
        j->verdict.happened = true;
        j->verdict.stage = always ? -1 : rig_stage_of(j->told);
    }
}

/* Judges the first message after a reset. The notes from before the reset are still in j->told. */
static void look_for_reset(judge *j, const wh_orders *orders) {
    float now[HAL_NOTES];
    if (j->plant->reset.count == j->resets) {
        return;
    }
    j->resets = j->plant->reset.count;
    for (int n = 0; n < HAL_NOTES; n++) {
        now[n] = orders->output[j->at_note[n]];
    }
    const bool tripped = rig_is_tripped(j->told);
    const bool knows = tripped ? rig_is_tripped(now) && now[HAL_NOTE_TRIP] == j->told[HAL_NOTE_TRIP]
                               : rig_is_idle(now);
    j->verdict.latched = j->verdict.latched || (tripped && knows);
    j->verdict.forgets = j->verdict.forgets || !knows || now[HAL_NOTE_RESET] == 0.0F;
}

static bool is_of_result(int note) {
    return note == HAL_NOTE_QUALITY || note == HAL_NOTE_AMPLITUDE || note == HAL_NOTE_PHASE ||
           note == HAL_NOTE_AMPLITUDE_HALF || note == HAL_NOTE_PHASE_HALF || note == HAL_NOTE_TURNS;
}

static void take_notes(judge *j, const wh_orders *orders) {
    bool changed = false;
    for (int n = 0; n < HAL_NOTES; n++) {
        const float value = orders->output[j->at_note[n]];
        changed = changed || (is_of_result(n) && value != j->told[n]);
        j->told[n] = value;
    }
    const unsigned turns = (unsigned)j->told[HAL_NOTE_TURNS];
    if (j->told[HAL_NOTE_TRIP] != 0.0F) {
        j->verdict.trip = (int)j->told[HAL_NOTE_TRIP];
    }
    j->has_result = turns > 0;
    if (changed && turns > 0 && (int)j->told[HAL_NOTE_QUALITY] == GOOD && !j->of->calibration) {
        const double off = off_by(j, turns);
        j->verdict.lie = off > j->verdict.lie ? off : j->verdict.lie;
    }
}

/* Counts the control step that this message reports. The first message reports no step; its instructions are those of
 * the start. */
static void count_step(judge *j, double time_s, const wh_orders *orders) {
    const double instructions = (double)orders->step_timer * j->per_count;
    const double loop = (double)orders->busy_timer * j->per_count;
    verdict *v = &j->verdict;
    if (instructions > 0.0) {
        const unsigned bin = (unsigned)(instructions / STEP_BIN);
        v->steps[bin < STEP_BINS ? bin : STEP_BINS - 1]++;
        v->most_s = instructions > v->most ? time_s : v->most_s;
        v->most = instructions > v->most ? instructions : v->most;
        v->loop = loop > v->loop ? loop : v->loop;
    } else {
        v->start = loop > v->start ? loop : v->start;
    }
}

/* Ends the run WATCHED_S after a trip if the motor is off. The controller alone might go on for long. */
static void let_go(judge *j, double time_s) {
    if (!rig_is_tripped(j->told) || j->driven) {
        j->off_since_s = -1.0;
    } else if (j->off_since_s < 0.0) {
        j->off_since_s = time_s;
    } else if (time_s > j->off_since_s + WATCHED_S && *j->until_s > time_s) {
        *j->until_s = time_s;
    }
}

static void hear(void *of, double time_s, wh_orders *orders, double *late_s) {
    (void)late_s;
    judge *j = of;
    look_for_fault(j);
    look_for_reset(j, orders);
    take_notes(j, orders);
    count_step(j, time_s, orders);
    const bool enabled = orders->output[j->at_enable] > 0.0F && !j->plant->cut;
    j->enabled_s = enabled && !j->enabled ? time_s : j->enabled_s;
    j->enabled = enabled;
    const fault_case *f = &j->plan->fault[j->plan->count - 1U];
    const bool ignores = j->of->runs_away && f->active;
    j->driven = enabled && (orders->output[j->at_duty] > 0.0F || ignores);
    let_go(j, time_s);
    if (ignores && enabled && j->ignored_s < 0.0) {
        j->ignored_s = f->begin_s > j->enabled_s ? f->begin_s : j->enabled_s;
        /* if there are two faults, the time at which the controller must detect this one is not defined */
        j->verdict.lasting =
            campaign_is_alone(j->of) && f->begin_s + f->duration_s - j->ignored_s >= LASTING_S;
        j->verdict.began_rpm = j->speed_rpm;
    }
    if (j->verdict.lasting && !enabled && j->verdict.off_s < 0.0) {
        j->verdict.off_s = time_s - j->ignored_s;
        j->verdict.caught_rpm = j->verdict.peak_rpm;
    }
}

tap judge_tap(judge *j, const campaign_case *of, const fault_plan *plan, double *until_s) {
    *j = (judge){
        .of = of,
        .plan = plan,
        .until_s = until_s,
        .off_since_s = -1.0,
        .ignored_s = -1.0,
        .rpm = (double)INFINITY,
        .on_shown_s = -1.0,
        .off_shown_s = -1.0,
        .verdict = {.row = of->row, .target_rpm = of->target_rpm, .stage = -1, .off_s = -1.0}};
    return (tap){.of = j, .start = start, .orders = hear, .watch = watch};
}

void judge_end(judge *j, const lockstep_report *report) {
    verdict *v = &j->verdict;
    const int quality = (int)j->told[HAL_NOTE_QUALITY];
    v->time_s = report->time_s;
    v->overruns = report->overruns;
    const bool off = report->end == LOCKSTEP_LET_GO && !j->driven;
    if (report->end != LOCKSTEP_DONE && !off) {
        v->outcome = OUTCOME_HANG;
    } else if (rig_is_tripped(j->told)) {
        v->outcome = OUTCOME_TRIPPED;
    } else if (j->has_result) {
        v->outcome = quality == GOOD       ? OUTCOME_GOOD
                     : quality == DOUBTFUL ? OUTCOME_DOUBTFUL
                                           : OUTCOME_REFUSED;
    } else {
        v->outcome = OUTCOME_NONE;
    }
    v->runs_on = (j->enabled && !rig_may_drive(j->told)) ||
                 (j->driven && j->speed_rpm > (double)WH_RIG_SHAFT_LIMIT_RPM);
    v->overspeed = !j->of->drives && v->turn_rpm > (double)WH_RIG_SHAFT_LIMIT_RPM;
    v->cut = report->cut && !j->of->delays;
}

/* === summary =================================================================================== */

#define OVERSPEED_SHARE 0.02 /* allowed share of runs with over-speed */
/* if the drive ignores the voltage, the enable must be off within this time */
#define CAUGHT_S 0.25
#define CAUGHT_REST_S 0.35 /* deadline if the fault begins below TURNING_RPM */
#define TURNING_RPM 250.0
enum { WORST = 10, LONGEST = 20, TRIPS = 32 };

static bool is_lie(const verdict *v) { return v->lie > 0.0; }
static bool is_hang(const verdict *v) { return v->outcome == OUTCOME_HANG; }
static bool runs_on(const verdict *v) { return v->runs_on; }
static bool stays_on(const verdict *v) { return v->stays_on; }
static bool is_untold(const verdict *v) { return v->untold; }
static bool is_overspeed(const verdict *v) { return v->overspeed; }
static bool is_cut(const verdict *v) { return v->cut; }
static bool is_not_caught(const verdict *v) {
    const double most_s = v->began_rpm < TURNING_RPM ? CAUGHT_REST_S : CAUGHT_S;
    return v->lasting && !(v->off_s >= 0.0 && v->off_s <= most_s &&
                           v->caught_rpm <= rig_caught_rpm(v->target_rpm));
}

static bool is_not_halted(const verdict *v) { return v->halted && v->halted_s < 0.0; }
static bool forgets(const verdict *v) { return v->forgets; }

static double by_lie(const verdict *v) { return v->lie; }
static double by_off(const verdict *v) { return v->off_s < 0.0 ? 1e9 : v->off_s; }
static double by_speed(const verdict *v) { return v->turn_rpm; }

static const struct {
    const char *what;
    bool (*is)(const verdict *v);
    double (*by)(const verdict *v); /* the worst run has the largest value */
    double share;                   /* allowed share of the runs */
} violations[] = {
    {"Does not end, or is silent", is_hang, by_speed, 0.0},
    {"Ends with the motor on", runs_on, by_speed, 0.0},
    {"Has the enable on, though turns show a drive", stays_on, by_speed, 0.0},
    {"Is driven with the motor off, and does not trip", is_untold, by_speed, 0.0},
    {"Called good, and is not", is_lie, by_lie, 0.0},
    {"Too fast, and the controller's doing", is_overspeed, by_speed, OVERSPEED_SHARE},
    {"Cut by the watchdog, and nothing was late", is_cut, by_speed, 0.0},
    {"Ignores the voltage, and is not off in time", is_not_caught, by_off, 0.0},
    {"Drives after stop or a reset", is_not_halted, by_speed, 0.0},
    {"A reset loses the trip, or is not known of", forgets, by_speed, 0.0},
};
enum { VIOLATIONS = sizeof violations / sizeof violations[0] };

static bool is_violation(const verdict *v) {
    bool is = false;
    for (int i = 0; i < VIOLATIONS; i++) {
        is = is || violations[i].is(v);
    }
    return is;
}

static void campaign_print_command(FILE *out, const campaign *c, unsigned i) {
    campaign_case one;
    campaign_draw(&one, c, i);
    fprintf(out, "build/whirl pil %s --firmware %s", c->plant, c->firmware);
    if (campaign_is_emulated(c)) {
        fprintf(out, " --board %s", c->board);
    }
    fprintf(out, " --step %s --jitter " CAMPAIGN_JITTER " --seed %u --fault %s", c->step, one.seed,
            one.words);
}

typedef struct cell_count {
    unsigned of[OUTCOMES];
    unsigned runs;
    unsigned wrong;
} cell_count;

static void count_in(cell_count *cell, const verdict *v) {
    cell->runs++;
    cell->of[v->outcome]++;
    cell->wrong += is_violation(v);
}

static void print_cell(FILE *out, const cell_count *cell) {
    if (cell->runs == 0) {
        fputs(" |", out);
        return;
    }
    fprintf(out, " %u·%u·%u·%u", cell->of[OUTCOME_TRIPPED], cell->of[OUTCOME_GOOD],
            cell->of[OUTCOME_DOUBTFUL], cell->of[OUTCOME_REFUSED] + cell->of[OUTCOME_NONE]);
    if (cell->wrong > 0) {
        fprintf(out, " **%u**", cell->wrong);
    }
    fputs(" |", out);
}

static void print_matrix(FILE *out, const verdict *all, unsigned count) {
    fputs("| fault |", out);
    for (unsigned s = 0; s < STAGES; s++) {
        fprintf(out, " %s |", wh_rig_stage_text(healthy[s].of));
    }
    fputs(" else |\n|---|", out);
    for (unsigned s = 0; s <= STAGES; s++) {
        fputs("---|", out);
    }
    fputc('\n', out);
    for (unsigned row = 0; row < ROWS + 1; row++) {
        cell_count cell[STAGES + 1] = {{.runs = 0}};
        unsigned runs = 0;
        for (unsigned i = 0; i < count; i++) {
            if (all[i].row == row) {
                count_in(&cell[all[i].stage >= 0 ? (unsigned)all[i].stage : STAGES], &all[i]);
                runs++;
            }
        }
        if (runs > 0) {
            fprintf(out, "| %s |", campaign_row_word(row));
            for (unsigned s = 0; s <= STAGES; s++) {
                print_cell(out, &cell[s]);
            }
            fputc('\n', out);
        }
    }
}

static void print_trips(FILE *out, const verdict *all, unsigned count) {
    fputs("\n| fault | runs | fastest turn, rpm | trips: number, runs |\n|---|---|---|---|\n", out);
    for (unsigned row = 0; row < ROWS + 1; row++) {
        unsigned trips[TRIPS] = {0};
        unsigned runs = 0;
        double fastest = 0.0;
        for (unsigned i = 0; i < count; i++) {
            if (all[i].row == row) {
                runs++;
                trips[all[i].trip >= 0 && all[i].trip < TRIPS ? all[i].trip : 0]++;
                fastest = all[i].turn_rpm > fastest ? all[i].turn_rpm : fastest;
            }
        }
        if (runs == 0) {
            continue;
        }
        fprintf(out, "| %s | %u | %.0f |", campaign_row_word(row), runs, fastest);
        for (int t = 1; t < TRIPS; t++) {
            if (trips[t] > 0) {
                fprintf(out, " %d: %u", t, trips[t]);
            }
        }
        fputs(" |\n", out);
    }
    fputs("\n| trip | runs | |\n|---|---|---|\n", out);
    for (int t = 1; t < TRIPS; t++) {
        unsigned runs = 0;
        for (unsigned i = 0; i < count; i++) {
            runs += all[i].trip == t;
        }
        if (runs > 0) {
            fprintf(out, "| %d | %u | %s |\n", t, runs, wh_trip_text((wh_trip)t));
        }
    }
}

/* The worst run that has not been printed yet; `count` if all have been printed. */
static unsigned next_worst(const verdict *all, unsigned count, bool (*is)(const verdict *v),
                           double (*by)(const verdict *v), bool *shown) {
    unsigned worst = count;
    for (unsigned i = 0; i < count; i++) {
        if (is(&all[i]) && !shown[i] && (worst == count || by(&all[i]) > by(&all[worst]))) {
            worst = i;
        }
    }
    if (worst < count) {
        shown[worst] = true;
    }
    return worst;
}

/* Prints the worst runs with this violation. Returns whether the campaign allows their number. */
static bool print_worst(FILE *out, const campaign *c, const verdict *all, unsigned count,
                        int violation) {
    bool (*const is)(const verdict *v) = violations[violation].is;
    double (*const by)(const verdict *v) = violations[violation].by;
    bool *shown = alloc(count, sizeof *shown);
    unsigned found = 0;
    for (unsigned i = 0; i < count; i++) {
        found += is(&all[i]);
    }
    fprintf(out, "\n%s: %u of %u runs\n", violations[violation].what, found, count);
    for (unsigned n = 0; n < found && n < WORST; n++) {
        const verdict *v = &all[next_worst(all, count, is, by, shown)];
        fprintf(out, "\n    # run %u: ", v->run);
        if (is == is_lie) {
            fprintf(out, "off by %.3g %% more than it may be", 100.0 * v->lie);
        } else if (is == is_not_caught && v->off_s < 0.0) {
            fputs("never off", out);
        } else if (is == is_not_caught) {
            fprintf(out, "off after %.3f s, from %.1f rpm, by then up to %.1f rpm", v->off_s,
                    v->began_rpm, v->caught_rpm);
        } else {
            fprintf(out, "fastest turn %.1f rpm, fastest instant %.1f rpm", v->turn_rpm,
                    v->peak_rpm);
        }
        fputs("\n    ", out);
        campaign_print_command(out, c, v->run);
        fputc('\n', out);
    }
    free(shown);
    return found <= violations[violation].share * count;
}

/* Prints, for runs in which the drive ignored the voltage for long, the time until the enable line was off and the
 * greatest speed until then. */
static void print_runaways(FILE *out, const verdict *all, unsigned count) {
    fputs("\n| the drive ignores the voltage, from | runs | never off | off after, s, at most | "
          "fastest instant until then, rpm |\n|---|---|---|---|---|\n",
          out);
    for (unsigned s = 0; s < STAGES; s++) {
        unsigned runs = 0;
        unsigned never = 0;
        double off_s = 0.0;
        double rpm = 0.0;
        for (unsigned i = 0; i < count; i++) {
            const verdict *v = &all[i];
            if (v->lasting && v->stage == (int)s) {
                runs++;
                never += v->off_s < 0.0;
                off_s = v->off_s > off_s ? v->off_s : off_s;
                rpm = v->caught_rpm > rpm ? v->caught_rpm : rpm;
            }
        }
        if (runs > 0) {
            fprintf(out, "| %s | %u | %u | %.3f | %.0f |\n", wh_rig_stage_text(healthy[s].of), runs,
                    never, off_s, rpm);
        }
    }
}

/* Prints how long the motor drove after a stop or reset, and how many runs still reported their trip after a reset. */
static void print_halts(FILE *out, const verdict *all, unsigned count) {
    bool any = false;
    for (unsigned row = 0; row < ROWS + 1; row++) {
        unsigned runs = 0;
        unsigned latched = 0;
        double off_s = 0.0;
        for (unsigned i = 0; i < count; i++) {
            const verdict *v = &all[i];
            if (v->row == row && v->halted) {
                runs++;
                latched += v->latched;
                off_s = v->halted_s > off_s ? v->halted_s : off_s;
            }
        }
        if (runs > 0) {
            fputs(
                any ? ""
                    : "\n| stopped or reset | runs | motor off after, ms, at most | trips that were "
                      "latched, and are |\n|---|---|---|---|\n",
                out);
            fprintf(out, "| %s | %u | %.3g | %u |\n", campaign_row_word(row), runs, 1e3 * off_s,
                    latched);
            any = true;
        }
    }
}

static bool takes_time(const verdict *v) {
    /* one of "two faults" may be a hang with resets */
    static const char *const words[] = {"slow", "late", "hang", "two faults"};
    const char *word = campaign_row_word(v->row);
    bool takes = false;
    for (int i = 0; i < 4; i++) {
        takes = takes || strncmp(word, words[i], strlen(words[i])) == 0;
    }
    return takes;
}

static bool has_steps(const verdict *v) { return v->most > 0.0; }
static double by_step(const verdict *v) { return v->most; }

/* Each run is printed with the command that repeats it. */
static void print_longest(FILE *out, const campaign *c, const verdict *all, unsigned count) {
    bool *shown = alloc(count, sizeof *shown);
    fprintf(out, "\nThe longest control steps of %d runs:\n", LONGEST);
    for (unsigned n = 0; n < LONGEST; n++) {
        const unsigned i = next_worst(all, count, has_steps, by_step, shown);
        if (i < count) {
            fprintf(out, "\n    # run %u: step of %.0f instructions, at t = %.3f s\n    ",
                    all[i].run, all[i].most, all[i].most_s);
            campaign_print_command(out, c, all[i].run);
            fputc('\n', out);
        }
    }
    free(shown);
}

/* Prints the histogram of instructions per control step. Only the emulator counts instructions. */
static void print_steps(FILE *out, const campaign *c, const verdict *all, unsigned count) {
    uint64_t steps[STEP_BINS] = {0};
    uint64_t sum = 0;
    uint64_t overruns = 0;
    double loop = 0.0;
    double start = 0.0;
    for (unsigned i = 0; i < count; i++) {
        const verdict *v = &all[i];
        for (int bin = 0; bin < STEP_BINS; bin++) {
            steps[bin] += v->steps[bin];
            sum += v->steps[bin];
        }
        if (!takes_time(v)) {
            overruns += v->overruns;
            loop = v->loop > loop ? v->loop : loop;
            start = v->start > start ? v->start : start;
        }
    }
    if (sum == 0) {
        return;
    }
    fputs("\n| instructions of a control step | steps |\n|---|---|\n", out);
    for (int bin = 0; bin < STEP_BINS; bin++) {
        fprintf(out, "| %s%d | %llu |\n", bin == STEP_BINS - 1 ? "from " : "below ",
                STEP_BIN * (bin + (bin < STEP_BINS - 1)), (unsigned long long)steps[bin]);
    }
    fprintf(out,
            "\nWhere nothing takes time by itself: with HAL and printing between two waits at most "
            "%.0f, before the first step %.0f; overruns: %llu.\n",
            loop, start, (unsigned long long)overruns);
    print_longest(out, c, all, count);
}

int campaign_print(FILE *out, const campaign *c, const verdict *all, unsigned count) {
    print_matrix(out, all, count);
    print_trips(out, all, count);
    print_runaways(out, all, count);
    print_halts(out, all, count);
    print_steps(out, c, all, count);
    bool good = true;
    for (int i = 0; i < VIOLATIONS; i++) {
        good = print_worst(out, c, all, count, i) && good;
    }
    fprintf(out, "\n%u runs, seed %u, %s: %s\n", count, c->seed, c->firmware,
            good ? "nothing is wrong" : "there are violations");
    return good ? 0 : 1;
}
