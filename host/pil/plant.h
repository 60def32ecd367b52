/* plant.h: a scene as a controller's hardware: it runs in double, and sensors stand around it.
 *
 * Time is in ticks of the controller's timer since the plant's start. The scene runs in its own steps, which are finer;
 * edges are located within a step, on the cubic through its ends, of what is on one side of the level at one end and on the
 * other at the next (the cubic alone does not tell a turn within the step from a stop or a blow); samples are those of the first step's end at or after
 * their instant, and so are changes of the outputs. */
#ifndef PIL_PLANT_H
#define PIL_PLANT_H

#include "bind.h"
#include "recorded.h"

#define PLANT_PENDING 64

/* What is not in the scene: where sensors stand, what they add, how late they are. */
typedef struct plant_wish {
    double place[WH_SIGNALS_MAX]; /* of each edge: so far its place is off; degrees of an angle,
                                   * else SI */
    unsigned places;              /* so many of them were given */
    double jitter_s;              /* standard deviation of an edge's time */
    double delay_s;               /* of every sample */
    uint32_t seed;                /* of the jitter */
    recorded *rows;               /* the plant is recorded there; NULL: it is not */
} plant_wish;

typedef struct plant_event {
    double at_ticks; /* when it is there */
    uint32_t ticks;  /* the stamp */
    int32_t raw;
    uint8_t channel;
    uint8_t status;
} plant_event;

/* In order of at_ticks. */
typedef struct plant_queue {
    plant_event event[PLANT_PENDING];
    unsigned count;
} plant_queue;

/* Of the controller's processor: in a reset its pins float, and the plant's inputs are 0. */
typedef struct plant_resets {
    double at_ticks;    /* it is reset at the first step at or after; infinite: not at all */
    double takes_ticks; /* so long it is in it */
    bool by_watchdog;   /* a watchdog that is starved resets it, instead of cutting the outputs, */
    double watchdog_ticks; /* for so long */
    bool now;              /* it is in it: somebody has to start it again, see plant_restart() */
    bool starved;          /* and the watchdog was it */
    unsigned count;
    double last_ticks; /* it was reset */
} plant_resets;

typedef struct plant {
    const image *image;
    const binding *binding;
    plant_wish wish;
    void *run; /* of engine_double */
    wh_status status;
    uint64_t steps;
    double step_ticks;
    uint32_t start_ticks; /* the controller's timer at the start, were it not set back since */
    uint32_t timer_ticks; /* what it begins with */
    double *before;       /* [components] angles first */
    double *after;        /* [components] */
    double *output;       /* [outputs] */
    double *output_after; /* [outputs] */
    bool sees_outputs;    /* an edge is on one */
    uint64_t period[WH_SIGNALS_MAX]; /* of each sample: ticks, */
    uint64_t due[WH_SIGNALS_MAX];    /* and when the next is */
    wh_orders orders;                /* the last, */
    bool waits;                      /* which have not yet taken effect: */
    double act_ticks;                /* then they do */
    uint64_t alive_ticks;            /* the watchdog was kicked */
    bool cut;                        /* it has cut, */
    double cut_ticks;                /* then */
    plant_resets reset;
    double in_effect[WH_SIGNALS_MAX];   /* of each output: what it is, */
    double since_ticks[WH_SIGNALS_MAX]; /* since then */
    plant_queue edges;
    plant_queue samples;
    uint64_t edges_made;
    uint64_t edges_seen; /* handed out */
    uint64_t samples_seen;
    uint64_t lost; /* for which there was no room */
} plant;

/* --place: numbers between commas, one an edge. False: it is something else, which was reported. */
bool plant_read_places(const char *text, plant_wish *to);

/* The image must outlive it. */
void plant_start(plant *p, const image *im, const binding *b, const wh_hello *hello,
                 const plant_wish *wish);
void plant_stop(plant *p);

/* Now, in ticks since the start and as the controller's timer shows it. */
double plant_now(const plant *p);
uint32_t plant_ticks(const plant *p);
/* Is it there, but for rounding? */
bool plant_has_reached(const plant *p, double ticks);

/* Orders that were sent now and take effect `late_ticks` later, or at the next orders if those come before. */
void plant_order(plant *p, const wh_orders *orders, double late_ticks);

/* To the first step's end at or after until_ticks, or until the processor is reset, whichever is first. False: the scene
 * diverged; plant.status says how. */
bool plant_advance(plant *p, double until_ticks);

/* The processor starts again: its timer begins anew, the watchdog hears of no one, and what was not handed out is lost. */
void plant_restart(plant *p);

/* What is there by now and was not handed out yet. */
void plant_read(plant *p, wh_readings *readings);

#endif
