/* fault.h: injected faults in a run in the loop. The controller's code is not changed. A fault is
 * KIND[:CHANNEL][=SIZE][@WHEN][+DURATION]. CHANNEL counts edges or samples from 1. The default is all edges, or sample
 * channel 1. WHEN is the TIME at which the fault begins, by default 0, or NOTE=VALUE[~TIME]. With NOTE=VALUE~TIME, the
 * fault begins TIME after the firmware's note equals VALUE. Without DURATION, the fault lasts to the end. */
#ifndef PIL_FAULT_H
#define PIL_FAULT_H

#include "host/pil/lockstep.h"

typedef enum fault_place {
    FAULT_EDGES,
    FAULT_SAMPLES,
    FAULT_INPUT,     /* an input of the scene (table in fault.c) */
    FAULT_ORDERS,    /* the firmware's orders, or the time to compute them */
    FAULT_LINE,      /* messages lost on the line */
    FAULT_PARAMETER, /* a parameter, for the whole run: see fault_parameter() */
    FAULT_SENSORS,   /* edge positions and jitter */
    FAULT_PROCESSOR  /* the processor restarts */
} fault_place;

/* X(which, word, place, default size, least, most, unit, words). If least == most, this kind has no size. */
#define FAULT_EDGE_ROWS(X) \
    X(FAULT_EDGE_DEAD, "edge-dead", FAULT_EDGES, 0, 0, 0, "", "no pulses come") \
    X(FAULT_EDGE_LOST, "edge-lost", FAULT_EDGES, 1, 1, 1e6, "", "this number of pulses is lost") \
    X(FAULT_EDGE_DOUBLE, "edge-double", FAULT_EDGES, 1e-3, 1e-6, 10, "s", \
      "each pulse is repeated after this time") \
    X(FAULT_EDGE_INVENTED, "edge-invented", FAULT_EDGES, 1, 1, 1e6, "", \
      "this number of false pulses, up to 0.1 s apart") \
    X(FAULT_EDGE_STORM, "edge-storm", FAULT_EDGES, 5e3, 1, 1e6, "Hz", \
      "false pulses appear at " \
      "this rate") \
    X(FAULT_EDGE_SWAPPED, "edge-swapped", FAULT_EDGES, 0, 0, 0, "", \
      "the first and the second sensor are exchanged") \
    X(FAULT_EDGE_STAMP, "edge-stamp", FAULT_EDGES, 1e-6, -10, 10, "s", \
      "time stamps have this error; positive: too late") \
    X(FAULT_EDGE_LATE, "edge-late", FAULT_EDGES, 5e-3, 0, 10, "s", \
      "pulses arrive late, with correct stamps")
#define FAULT_SENSOR_ROWS(X) \
    X(FAULT_EDGE_PLACE, "edge-place", FAULT_SENSORS, 2, -180, 180, "deg", "a sensor is displaced") \
    X(FAULT_EDGE_JITTER, "edge-jitter", FAULT_SENSORS, 60e-6, 0, 1, "s", \
      "random errors of the pulses' times with this standard deviation")
#define FAULT_SAMPLE_ROWS(X) \
    X(FAULT_CELL_DEAD, "cell-dead", FAULT_SAMPLES, 0, 0, 0, "", "no samples come") \
    X(FAULT_CELL_LOST, "cell-lost", FAULT_SAMPLES, 0.1, 0, 1, "", \
      "this share of the samples is lost") \
    X(FAULT_CELL_FROZEN, "cell-frozen", FAULT_SAMPLES, 0, 0, 0, "", "the last value repeats") \
    X(FAULT_CELL_OPEN, "cell-open", FAULT_SAMPLES, 0, 0, 0, "", \
      "the cell is disconnected, and the converter says so") \
    X(FAULT_CELL_PICKUP, "cell-pickup", FAULT_SAMPLES, 5, 0, 1e6, "N", \
      "the cell is disconnected, and its line picks up 60 Hz of this amplitude about zero") \
    X(FAULT_CELL_HUM, "cell-hum", FAULT_SAMPLES, 5, 0, 1e6, "N", \
      "60 Hz of this amplitude is added") \
    X(FAULT_CELL_NOISE, "cell-noise", FAULT_SAMPLES, 1, 0, 1e6, "N", \
      "noise with this standard deviation is added") \
    X(FAULT_CELL_SPIKES, "cell-spikes", FAULT_SAMPLES, 50, 0, 1e6, "N", \
      "one sample in 50 has this error, of either sign") \
    X(FAULT_CELL_SATURATED, "cell-saturated", FAULT_SAMPLES, 0, 0, 0, "", \
      "samples are at the end of the range, and the converter says so") \
    X(FAULT_CELL_REPEATED, "cell-repeated", FAULT_SAMPLES, 0, 0, 0, "", "each sample comes twice") \
    X(FAULT_CELL_LATE, "cell-late", FAULT_SAMPLES, 10e-3, 0, 10, "s", \
      "samples arrive late, with correct stamps") \
    X(FAULT_READS, "reads", FAULT_SAMPLES, 0, -1e6, 1e6, "SI", "all samples have this value")
#define FAULT_PLANT_ROWS(X) \
    X(FAULT_CELL_TURNED, "cell-turned", FAULT_INPUT, 0, 0, 0, "", "the polarity is reversed") \
    X(FAULT_CELL_GAIN, "cell-gain", FAULT_INPUT, 0.5, -100, 100, "", \
      "the gain is multiplied by this factor") \
    X(FAULT_CELL_OFFSET, "cell-offset", FAULT_INPUT, 10, -1e6, 1e6, "N", \
      "the zero jumps by this force") \
    X(FAULT_SUPPLY, "supply", FAULT_INPUT, 0.5, 0, 10, "", \
      "the supply's voltage is multiplied by this factor") \
    X(FAULT_FREEWHEEL, "freewheel", FAULT_INPUT, 0, 0, 0, "", "the drive stage cannot brake") \
    X(FAULT_RUNAWAY, "runaway", FAULT_INPUT, 1, 0.01, 1, "", \
      "the drive stage ignores the duty, applies this share of the supply, and obeys its enable line") \
    X(FAULT_STUCK, "stuck", FAULT_INPUT, 1, 0.01, 1, "", \
      "like 'runaway', but the drive stage also ignores its enable line") \
    X(FAULT_MOTOR, "motor", FAULT_INPUT, 0.5, 0, 10, "", \
      "the motor's torque is multiplied by this factor") \
    X(FAULT_FRICTION, "friction", FAULT_INPUT, 0.2, 0, 1e3, "N*m", \
      "the arms' bearings have this friction") \
    X(FAULT_JAM, "jam", FAULT_INPUT, 20, 0, 1e3, "N*m", "friction holds the arms") \
    X(FAULT_COUPLING, "coupling", FAULT_INPUT, 0.1, 0, 100, "", \
      "the coupling's stiffness is multiplied by this factor") \
    X(FAULT_INERTIA, "inertia", FAULT_PARAMETER, 2, 0.01, 100, "", \
      "the inertia is multiplied by this factor, for the whole run") \
    X(FAULT_STOP, "stop", FAULT_INPUT, 0, 0, 0, "", "somebody presses stop") \
    X(FAULT_RESET, "reset", FAULT_PROCESSOR, 0.01, 0, 10, "s", \
      "the controller is reset, and starts again after this time") \
    X(FAULT_WATCHDOG_RESETS, "watchdog-resets", FAULT_PROCESSOR, 0.01, 0, 10, "s", \
      "without kicks, the watchdog resets the controller, and the controller starts again after this time")
#define FAULT_ORDER_ROWS(X) \
    X(FAULT_SLOW, "slow", FAULT_ORDERS, 20, 0, 1e6, "", "computing is slower by this factor") \
    X(FAULT_LATE, "late", FAULT_ORDERS, 3e-3, 0, 10, "s", "every answer comes later by this time") \
    X(FAULT_HANG, "hang", FAULT_ORDERS, 0.1, 0, 100, "s", "one answer comes later by this time") \
    X(FAULT_UNKICKED, "unkicked", FAULT_ORDERS, 0, 0, 0, "", \
      "the firmware's kicks do not reach " \
      "the watchdog") \
    X(FAULT_UNWATCHED, "unwatched", FAULT_ORDERS, 0, 0, 0, "", \
      "the watchdog never cuts the outputs")
#define FAULT_LINE_ROWS(X) \
    X(FAULT_READINGS_LOST, "readings-lost", FAULT_LINE, 0.1, 0, 1, "", \
      "this share of the readings arrives empty") \
    X(FAULT_ORDERS_LOST, "orders-lost", FAULT_LINE, 0.1, 0, 1, "", \
      "this share of the commands to the outputs is lost")
#define FAULT_ROWS(X) \
    FAULT_EDGE_ROWS(X) \
    FAULT_SENSOR_ROWS(X) \
    FAULT_SAMPLE_ROWS(X) \
    FAULT_PLANT_ROWS(X) \
    FAULT_ORDER_ROWS(X) \
    FAULT_LINE_ROWS(X)

#define FAULT_NAME(which, word, place, size, least, most, unit, words) which,
typedef enum fault_kind { FAULT_ROWS(FAULT_NAME) } fault_kind;
#undef FAULT_NAME
#define FAULT_ONE(which, word, place, size, least, most, unit, words) +1
enum { FAULT_KINDS = FAULT_ROWS(FAULT_ONE) };
#undef FAULT_ONE
/* A case label. The switches over faults have no default, so that the compiler reports a missing fault. */
#define FAULT_CASE(which, word, place, size, least, most, unit, words) case which:

typedef struct fault_row {
    const char *word;
    fault_place place;
    double size;
    double least;
    double most;
    const char *unit;
    const char *words;
} fault_row;

extern const fault_row fault_rows[FAULT_KINDS];

#define FAULTS_MAX 16
#define FAULT_PENDING 64

/* Delayed readings. */
typedef struct fault_pending {
    double at_s;
    bool is_edge;
    wh_edge edge;
    wh_sample sample;
} fault_pending;

typedef struct fault_case {
    fault_kind kind;
    int channel; /* -1: not given */
    double size;
    char note[32]; /* "": no note */
    double value;  /* the note's value that begins the fault */
    double after_s;
    double duration_s;
    /* During a run: */
    int note_at;  /* the note's index in orders.output */
    bool reached; /* the note has reached `value`, or there is no note */
    bool active;
    bool happened; /* active at least once */
    double begin_s;
    uint64_t draws;
    uint32_t left; /* pulses still to be lost or added */
    double next_s; /* time of the next false pulse */
    bool holds;    /* `held` is the last good sample's value */
    int32_t held;
    unsigned pending_count;
    fault_pending pending[FAULT_PENDING];
} fault_case;

typedef struct fault_plan {
    uint32_t seed;
    unsigned count;
    fault_case fault[FAULTS_MAX];
    /* During a run: */
    plant *plant;
    const wh_hello *hello;
    double ticks_per_s;
    wh_orders last;  /* the last orders that were not lost */
    unsigned resets; /* the plant's resets so far */
} fault_plan;

/* Adds the faults in `text`, separated by commas. Returns false after an error (reported). */
bool fault_read(fault_plan *plan, const char *text);

/* The --set option of fault i, such as "inertia=2", to be freed; NULL if it changes no parameter. */
char *fault_parameter(const fault_plan *plan, unsigned i);

/* The tap that applies the faults, for one run. */
tap fault_tap(fault_plan *plan);

/* After a run: reports faults that never occurred. Returns true if all occurred. */
bool fault_all_occurred(const fault_plan *plan);

void fault_print_kinds(FILE *out);

#endif
