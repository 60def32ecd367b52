/* plant.h: a scene as a controller's hardware: the scene runs in double, surrounded by sensors. Time is in ticks of the
 * controller's timer since the plant's start. The scene has its own, finer steps. An edge is located within a step, on
 * the cubic through its ends, if the two ends are on different sides of the level. If the quantity crosses
 * the level and returns within the step, there is no edge: the cubic cannot distinguish that from an impact. A sample is
 * taken at the first end of a step at or after its instant. Changes of outputs take effect at ends of steps, too. */
#ifndef PIL_PLANT_H
#define PIL_PLANT_H

#include "core/exchange.h"
#include "host/image/image.h"
#include "host/io/records.h"

/* === assignment of a firmware's signals to a scene's quantities, by name and unit ============= */

typedef enum bound_place { BOUND_INPUT, BOUND_OUTPUT, BOUND_COMPONENT, BOUND_NOWHERE } bound_place;

enum { BOUND_NAME = 80 };

typedef struct bound {
    wh_signal signal;         /* the signal's texts are in the hello */
    char renamed[BOUND_NAME]; /* the scene's name for the signal; "": the firmware's */
    unsigned channel;
    bound_place place;
    int index;  /* index of the input, the output or the state component (angles first) */
    int rate;   /* component of the quantity's rate, or -1 */
    bool turns; /* true: an angle, whose reading repeats every turn */
} bound;

typedef struct binding {
    unsigned count;
    bound bound[WH_SIGNALS_MAX]; /* bindings, in the order of the hello; notes are not bound */
} binding;

unsigned hello_channels(const wh_hello *hello,
                        wh_signal_kind kind); /* number of signals of a kind */
/* Returns the signal of a channel, or NULL if there is none. */
const wh_signal *hello_signal(const wh_hello *hello, wh_signal_kind kind, unsigned channel);
/* A sample's count of the value, within the signal's range, and its status. */
int32_t hello_count(const wh_signal *s, double value, uint8_t *status);

/* The index of the input of that name, or -1. */
int bind_input(const image *im, const char *name);

/* Binds an output, coordinate or rate of that name: sets place, index, rate and turns. Returns its unit, or NULL if
 * there is none. */
const char *bind_read(bound *b, const image *im, const char *name);

/* `renames` are words NAME=OTHER between commas, or NULL: the firmware's NAME is the scene's OTHER. Returns false after
 * an error, which it has reported. */
bool bind_signals(binding *b, const wh_hello *hello, const image *im, const char *renames);

/* === records ================================================================================= */
/* Records of the plant of a run in the loop as comma-separated values, in the columns of host/io/records.h. */

typedef struct recorded {
    const char *name; /* name of the file; "-": standard output */
    FILE *file;
    records *rows;
    uint64_t every; /* steps between rows */
} recorded;

/* Records a row every every_s seconds. With every_s < 0: every millisecond, or each step if a millisecond is not a
 * whole number of steps. If `name` is NULL, nothing is recorded. Returns false, and reports the reason, if every_s is
 * not a whole number of steps, or the file cannot be written. */
bool recorded_open(recorded *r, const char *name, const image *im, double every_s);
/* Returns false, and reports the reason, if the file is incomplete. */
bool recorded_close(recorded *r);

/* Settings outside the scene: positions, noise and delay of the sensors. */
typedef struct plant_request {
    double place[WH_SIGNALS_MAX]; /* position error of each edge's sensor; degrees for an angle,
                                   * else SI */
    unsigned places;              /* number of given positions */
    double jitter_s;              /* standard deviation of an edge's time */
    double delay_s;               /* delay of every sample */
    uint32_t seed;                /* seed of the jitter */
    recorded *rows;               /* recording of the plant, or NULL */
} plant_request;

typedef struct plant_event {
    double at_ticks; /* time at which the controller gets the edge or the sample */
    uint32_t ticks;  /* the stamp */
    int32_t raw;
    uint8_t channel;
    uint8_t status;
} plant_event;

/* A queue, in order of at_ticks. */
typedef struct plant_queue {
    plant_event *event; /* [count] */
    unsigned count;
} plant_queue;

/* Resets of the controller's processor: its pins float, and the plant's inputs are 0. */
typedef struct plant_resets {
    double at_ticks;    /* a reset begins at the end of the step that reaches this time */
    double takes_ticks; /* length of a reset */
    bool by_watchdog; /* a starved watchdog resets the processor, instead of cutting the outputs */
    double watchdog_ticks; /* the watchdog's timeout */
    /* a reset is due: the caller has to restart the processor, see plant_restart() */
    bool now;
    bool starved; /* true: the watchdog caused the reset */
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
    /* the timer shows start_ticks plus the time since the plant's start */
    uint32_t start_ticks;
    uint32_t timer_ticks;            /* the timer's value after a reset */
    double *before;                  /* [components] angles first */
    double *after;                   /* [components] */
    double *output;                  /* [outputs] */
    double *output_after;            /* [outputs] */
    bool sees_outputs;               /* an edge watches an output */
    uint64_t period[WH_SIGNALS_MAX]; /* interval of each sample, ticks */
    uint64_t due[WH_SIGNALS_MAX];    /* next time of each sample, ticks */
    wh_orders orders;                /* the last orders */
    bool waits;                      /* the last orders have not taken effect yet */
    double act_ticks;                /* time when the last orders take effect */
    uint64_t alive_ticks;            /* time of the watchdog's last kick */
    bool cut;                        /* the watchdog has cut the outputs */
    double cut_ticks;                /* time of the cut */
    plant_resets reset;
    double in_effect[WH_SIGNALS_MAX];   /* present value of each output */
    double since_ticks[WH_SIGNALS_MAX]; /* time when that value was set */
    plant_queue edges;
    plant_queue samples;
    uint64_t edges_made;
    uint64_t edges_seen; /* delivered to the controller */
    uint64_t samples_seen;
    uint64_t lost; /* more readings than a message can hold */
} plant;

/* --place: one number for each edge, separated by commas. Returns false, and reports the reason, for any other text. */
bool plant_read_places(const char *text, plant_request *to);

/* The image must outlive the plant. */
void plant_start(plant *p, const image *im, const binding *b, const wh_hello *hello,
                 const plant_request *request);
void plant_stop(plant *p);

/* The present time, in ticks since the start and as the controller's timer shows it. */
double plant_now(const plant *p);
uint32_t plant_ticks(const plant *p);
/* Has the plant reached this time, up to round-off? */
bool plant_has_reached(const plant *p, double ticks);

/* Orders sent now, which take effect `late_ticks` later, or with the next orders if those come first. */
void plant_order(plant *p, const wh_orders *orders, double late_ticks);

/* Run to the first step end at or after until_ticks, or to a reset of the processor. Returns false if the scene
 * diverged; plant.status has the reason. */
bool plant_advance(plant *p, double until_ticks);

/* Restart the processor: its timer and the watchdog restart, and pending readings are lost. */
void plant_restart(plant *p);

/* The pending readings up to now. */
void plant_read(plant *p, wh_readings *readings);

#endif
