/* plant.h: a scene as a controller's hardware. The scene runs in double, with sensors and actuators around it. Time is
 * in ticks of the controller's timer since the plant's start. An edge occurs when a quantity enters its signal's range.
 * A cubic through values and rates at both ends of the step gives the edge's time. A sample is taken at the first step
 * end at or after the sample's due time. Outputs change only at ends of steps. */
#ifndef PIL_PLANT_H
#define PIL_PLANT_H

#include "core/exchange.h"
#include "host/image/image.h"
#include "host/io/records.h"

/* === assignment of a firmware's signals to a scene's quantities, by name and unit ============= */

enum { BOUND_NAME = 80 };

typedef struct bound {
    wh_signal signal;         /* its texts are in the hello */
    char renamed[BOUND_NAME]; /* the signal's name in the scene; "": the same as in the firmware */
    unsigned channel;
    int index;      /* index of the scene's input, output or state component (angles come first) */
    bool of_output; /* reads an output of the scene, not a component */
    int rate;       /* index of the state component that is this quantity's rate, or -1 */
    bool turns;     /* an angle: the reading repeats every turn */
} bound;

typedef struct binding {
    unsigned count;
    bound bound[WH_SIGNALS_MAX]; /* in the order of the hello's signals */
} binding;

unsigned hello_channels(const wh_hello *hello, wh_signal_kind kind); /* the number of signals */
/* Returns the signal of a channel, or NULL. */
const wh_signal *hello_signal(const wh_hello *hello, wh_signal_kind kind, unsigned channel);
/* Returns the value in counts, limited to the signal's range. *status: WH_SAMPLE_GOOD or WH_SAMPLE_SATURATED. */
int32_t hello_count(const wh_signal *s, double value, uint8_t *status);

/* The index of the input, or -1. */
int bind_input(const image *im, const char *name);

/* Binds an output, coordinate or rate: sets index, of_output, rate and turns. Returns its unit, or NULL. */
const char *bind_read(bound *b, const image *im, const char *name);

/* `renames`: NAME=OTHER,... binds the firmware's NAME to the scene's OTHER. Returns false after an error (reported). */
bool bind_signals(binding *b, const wh_hello *hello, const image *im, const char *renames);

/* === records ================================================================================= */
/* Records of the plant as comma-separated values, in the columns of host/io/records.h. */

typedef struct recorded {
    const char *name; /* "-": standard output */
    FILE *file;
    records *rows;
    uint64_t every; /* steps between rows */
} recorded;

/* Records a row every every_s seconds, which must be a multiple of the step. If every_s < 0, uses 1 ms, or
 * the step if 1 ms is not a multiple of it. If `name` is NULL, records nothing. Returns false (reported) on error. */
bool recorded_open(recorded *r, const char *name, const image *im, double every_s);
/* Returns false (reported) if the file is incomplete. */
bool recorded_close(recorded *r);

typedef struct plant_request {
    double place[WH_SIGNALS_MAX]; /* position error of an edge's sensor; deg for angles, else SI */
    unsigned places;
    double jitter_s; /* standard deviation of edge times; plant_start() converts it to ticks */
    double delay_s;  /* delay of samples; plant_start() converts it to ticks */
    uint32_t seed;   /* of the jitter */
    recorded *rows;  /* NULL: no recording */
} plant_request;

typedef struct plant_event {
    double at_ticks; /* when the controller gets the edge or sample */
    uint32_t ticks;  /* the time stamp */
    int32_t raw;
    uint8_t channel;
    uint8_t status;
} plant_event;

/* Ordered by at_ticks. */
typedef struct plant_queue {
    plant_event *event; /* [count] */
    unsigned count;
} plant_queue;

/* Resets of the controller's processor, during which the plant's inputs are 0. */
typedef struct plant_resets {
    double at_ticks;    /* the next reset begins at the first step end at or after this time */
    double takes_ticks; /* length of the next reset */
    bool by_watchdog;   /* the watchdog resets the processor (true) or cuts the outputs (false) */
    double watchdog_ticks; /* length of the watchdog's reset */
    bool now;              /* the processor is reset: the caller must call plant_restart() */
    bool starved;          /* the watchdog caused the reset */
    unsigned count;
    double last_ticks; /* time of the last reset */
} plant_resets;

typedef struct plant {
    const image *image;
    const binding *binding;
    plant_request request;
    void *run; /* a run of engine_double */
    wh_status status;
    uint64_t steps;
    double step_ticks;
    uint32_t start_ticks;            /* the timer shows this plus the plant time */
    uint32_t timer_ticks;            /* the timer's value after a reset */
    double *before;                  /* [components] at the step's beginning, angles first */
    double *after;                   /* [components] */
    double *output;                  /* [outputs] */
    double *output_after;            /* [outputs] */
    bool sees_outputs;               /* an edge depends on an output */
    uint64_t period[WH_SIGNALS_MAX]; /* interval of samples, ticks, by channel */
    uint64_t due[WH_SIGNALS_MAX];    /* next sample, ticks, by channel */
    wh_orders orders;                /* the last orders */
    bool waits;                      /* the last orders have not taken effect yet */
    double act_ticks;                /* when the last orders take effect */
    uint64_t alive_ticks;            /* time of the watchdog's last kick */
    bool cut;                        /* the watchdog has cut the outputs */
    double cut_ticks;
    plant_resets reset;
    double in_effect[WH_SIGNALS_MAX];   /* the plant's inputs, by channel */
    double since_ticks[WH_SIGNALS_MAX]; /* when each of these inputs was set */
    plant_queue edges;
    plant_queue samples;
    uint64_t edges_made;
    uint64_t edges_seen; /* delivered to the controller */
    uint64_t samples_seen;
    uint64_t lost; /* readings that were dropped because a message was full */
} plant;

/* Reads --place: a number for each edge, separated by commas. Returns false after an error (reported). */
bool plant_read_places(const char *text, plant_request *to);

/* The image must outlive the plant. */
void plant_start(plant *p, const image *im, const binding *b, const wh_hello *hello,
                 const plant_request *request);
void plant_stop(plant *p);

double plant_now(const plant *p);     /* plant time in ticks */
uint32_t plant_ticks(const plant *p); /* the present value of the controller's timer */
/* Has the plant reached this time, up to round-off? */
bool plant_has_reached(const plant *p, double ticks);

/* The orders take effect after late_ticks, or at the next call of plant_order() if that is earlier. */
void plant_order(plant *p, const wh_orders *orders, double late_ticks);

/* Runs to the first step end at or after until_ticks, or to a reset. Returns false if a step fails (p->status). */
bool plant_advance(plant *p, double until_ticks);

/* Restarts the timer, and drops pending readings. */
void plant_restart(plant *p);

/* Moves the due readings from the plant's queues to `readings`. Readings beyond WH_EDGES_MAX edges or WH_SAMPLES_MAX
 * samples are lost. */
void plant_read(plant *p, wh_readings *readings);

#endif
