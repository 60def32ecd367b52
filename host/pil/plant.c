/* plant.c: sensors and actuators of a scene. */
#include "plant.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/noise.h"
#include "host/base/alloc.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

#define TURN_RAD 6.283185307179586477
#define TURN_DEG 360.0
/* A step end counts as reaching an instant if only round-off separates them. */
#define NEARLY 1e-6

/* --- start and end ----------------------------------------------------------------------------------------*/

static int components(const plant *p) { return p->image->angles + p->image->reals; }

bool plant_read_places(const char *text, plant_wish *to) {
    unsigned count = 0;
    for (const char *at = text; at != NULL;) {
        const char *end = at;
        const double number = decimal_read(at, &end);
        if (end == at || (*end != '\0' && *end != ',') || !isfinite(number) ||
            count == WH_SIGNALS_MAX) {
            fprintf(stderr,
                    "whirl pil: error: --place '%s': numbers between commas, one an edge\n"
                    "hint: --place 0,2.5 puts the second edge 2.5 degrees on\n",
                    text);
            return false;
        }
        to->place[count++] = number;
        at = *end == ',' ? end + 1 : NULL;
    }
    to->places = count;
    return true;
}

static void record(const plant *p) {
    if (p->wish.rows != NULL) {
        recorded_enter(p->wish.rows, p->run, p->steps);
    }
}

static void look(const plant *p, double *state, double *output) {
    engine_double.state(p->run, state, state + p->image->angles);
    if (p->sees_outputs) {
        engine_double.outputs(p->run, output);
    }
}

void plant_start(plant *p, const image *im, const binding *b, const wh_hello *hello,
                 const plant_wish *wish) {
    *p = (plant){.image = im,
                 .binding = b,
                 .wish = *wish,
                 .run = engine_double.start(im),
                 .step_ticks = im->step_s * (double)hello->ticks_per_s,
                 .start_ticks = hello->start_ticks,
                 .timer_ticks = hello->start_ticks,
                 .reset = {.at_ticks = (double)INFINITY}};
    p->wish.jitter_s *= (double)hello->ticks_per_s;
    p->wish.delay_s *= (double)hello->ticks_per_s;
    p->before = alloc(components(p), sizeof *p->before);
    p->after = alloc(components(p), sizeof *p->after);
    p->output = alloc(im->outputs, sizeof *p->output);
    p->output_after = alloc(im->outputs, sizeof *p->output_after);
    for (unsigned i = 0; i < b->count; i++) {
        const bound *one = &b->bound[i];
        p->sees_outputs =
            p->sees_outputs || (one->signal.kind == WH_SIGNAL_EDGE && one->place == BOUND_OUTPUT);
        if (one->signal.kind == WH_SIGNAL_EDGE && one->turns) {
            p->wish.place[one->channel] *= TURN_RAD / TURN_DEG;
        }
        if (one->signal.kind == WH_SIGNAL_SAMPLE) {
            p->period[one->channel] = one->signal.period_ticks;
            p->due[one->channel] = one->signal.period_ticks;
        }
        if (one->signal.kind == WH_SIGNAL_OUTPUT) {
            engine_double.set_input(p->run, one->index, 0.0);
        }
    }
    look(p, p->after, p->output_after);
    record(p);
}

void plant_stop(plant *p) {
    if (p->run != NULL) {
        engine_double.stop(p->run);
    }
    free(p->before);
    free(p->after);
    free(p->output);
    free(p->output_after);
    *p = (plant){.run = NULL};
}

double plant_now(const plant *p) { return (double)p->steps * p->step_ticks; }

bool plant_has_reached(const plant *p, double ticks) { return plant_now(p) + NEARLY >= ticks; }

/* A timer has whole ticks, and wraps. */
static uint32_t shown(const plant *p, double ticks) {
    return p->start_ticks + (uint32_t)(uint64_t)number_floor(ticks + NEARLY);
}

uint32_t plant_ticks(const plant *p) { return shown(p, plant_now(p)); }

/* --- outputs of the controller ----------------------------------------------------------------------------- */

static void set_inputs(plant *p) {
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (b->signal.kind == WH_SIGNAL_OUTPUT) {
            const double value = (double)p->orders.output[b->channel];
            const double low = (double)b->signal.low;
            const double high = (double)b->signal.high;
            const double held = value > high ? high : value >= low ? value : low; /* low for NaN */
            const double now = p->cut || p->reset.now ? 0.0 : held;
            engine_double.set_input(p->run, b->index, now);
            if (now != p->in_effect[b->channel]) {
                p->in_effect[b->channel] = now;
                p->since_ticks[b->channel] = plant_now(p);
            }
        }
    }
}

static void take_effect(plant *p) {
    if (p->waits) {
        p->waits = false;
        set_inputs(p);
    }
}

void plant_order(plant *p, const wh_orders *orders, double late_ticks) {
    take_effect(p);
    p->orders = *orders;
    p->waits = true;
    p->act_ticks = plant_now(p) + late_ticks;
    if ((orders->flags & WH_ORDER_ALIVE) != 0) {
        p->alive_ticks = (uint64_t)plant_now(p);
    }
}

static void watch(plant *p) {
    if (!p->cut && p->orders.watchdog_ticks > 0 &&
        plant_now(p) - (double)p->alive_ticks > (double)p->orders.watchdog_ticks) {
        if (p->reset.by_watchdog) {
            p->reset.starved = true;
            p->reset.at_ticks = plant_now(p);
            p->reset.takes_ticks = p->reset.watchdog_ticks;
            return;
        }
        p->cut = true;
        p->cut_ticks = plant_now(p);
        set_inputs(p);
    }
}

/* --- a reset of the controller ----------------------------------------------------------------------------*/

/* True in a reset. Pending orders then never take effect. */
static bool is_reset(plant *p) {
    if (!p->reset.now && plant_has_reached(p, p->reset.at_ticks)) {
        p->reset.now = true;
        p->reset.at_ticks = (double)INFINITY;
        p->reset.last_ticks = plant_now(p);
        p->reset.count++;
        p->waits = false;
        p->cut = false;
        p->orders = (wh_orders){.watchdog_ticks = 0};
        set_inputs(p);
        return true;
    }
    return false;
}

void plant_restart(plant *p) {
    p->reset.now = false;
    p->reset.starved = false;
    p->start_ticks = p->timer_ticks - (uint32_t)(uint64_t)number_floor(plant_now(p) + NEARLY);
    p->edges.count = 0;
    p->samples.count = 0;
}

/* --- inputs of the controller ------------------------------------------------------------------------------ */

static void enqueue(plant *p, plant_queue *q, plant_event event) {
    if (q->count == PLANT_PENDING) {
        p->lost++;
        return;
    }
    unsigned at = q->count++;
    for (; at > 0 && q->event[at - 1].at_ticks > event.at_ticks; at--) {
        q->event[at] = q->event[at - 1];
    }
    q->event[at] = event;
}

/* The watched quantity of an edge over a step: both ends, and the rates times the step. */
typedef struct span_of_step {
    double from;
    double to;
    double slope_from;
    double slope_to;
} span_of_step;

static span_of_step span_of(const plant *p, const bound *b) {
    if (b->place == BOUND_OUTPUT) {
        const double from = p->output[b->index];
        const double to = p->output_after[b->index];
        return (span_of_step){from, to, to - from, to - from};
    }
    span_of_step s = {p->before[b->index], p->after[b->index], 0.0, 0.0};
    const double h = p->image->step_s;
    s.slope_from = b->rate >= 0 ? p->before[b->rate] * h : s.to - s.from;
    s.slope_to = b->rate >= 0 ? p->after[b->rate] * h : s.to - s.from;
    return s;
}

static double at_part(const span_of_step *s, double part) {
    const double way = s->to - s->from;
    const double a = s->slope_from + s->slope_to - 2.0 * way;
    const double b = 3.0 * way - 2.0 * s->slope_from - s->slope_to;
    return s->from + ((a * part + b) * part + s->slope_from) * part;
}

/* The position where the cubic meets `level`, which is between its ends: bisection to a double's last bits. */
static double part_at(const span_of_step *s, double level) {
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 50; i++) {
        const double middle = (low + high) / 2.0;
        const bool before =
            s->to > s->from ? at_part(s, middle) < level : at_part(s, middle) > level;
        low = before ? middle : low;
        high = before ? high : middle;
    }
    return high;
}

/* The level that the step crosses on its way into the range: upwards at its lower end, downwards at the upper. For an
 * angle, the level in the present turn. */
static bool enters(const span_of_step *s, const bound *b, double off, double *level) {
    const bool up = s->to > s->from;
    *level = (double)(up ? b->signal.low : b->signal.high) + off;
    if (b->turns) {
        const double turns = (s->from - *level) / TURN_RAD;
        *level += TURN_RAD * (up ? number_floor(turns) + 1.0 : number_ceiling(turns) - 1.0);
    }
    return up ? s->from < *level && *level <= s->to : s->to <= *level && *level < s->from;
}

static void see_edges(plant *p) {
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (b->signal.kind != WH_SIGNAL_EDGE) {
            continue;
        }
        const span_of_step s = span_of(p, b);
        double level;
        if (enters(&s, b, p->wish.place[b->channel], &level)) {
            double ticks = ((double)p->steps + part_at(&s, level)) * p->step_ticks;
            if (p->wish.jitter_s > 0.0) {
                ticks +=
                    p->wish.jitter_s * (double)wh_noise(p->wish.seed + b->channel, p->edges_made);
                ticks = ticks > 0.0 ? ticks : 0.0;
            }
            p->edges_made++;
            enqueue(p, &p->edges,
                    (plant_event){.at_ticks = ticks,
                                  .ticks = shown(p, ticks),
                                  .channel = (uint8_t)b->channel});
        }
    }
}

static plant_event convert(const bound *b, double value) {
    plant_event e = {.channel = (uint8_t)b->channel, .status = WH_SAMPLE_GOOD};
    const double low = (double)b->signal.low;
    const double high = (double)b->signal.high;
    if (!(value < high)) {
        value = high;
        e.status = WH_SAMPLE_SATURATED;
    } else if (value <= low) {
        value = low;
        e.status = WH_SAMPLE_SATURATED;
    }
    e.raw = (int32_t)number_floor(value / (double)b->signal.per_count + 0.5); /* in range: bind.c */
    return e;
}

static void take_samples(plant *p) {
    bool observed = p->sees_outputs;
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (b->signal.kind != WH_SIGNAL_SAMPLE ||
            plant_now(p) + NEARLY < (double)p->due[b->channel]) {
            continue;
        }
        if (b->place == BOUND_OUTPUT && !observed) {
            engine_double.outputs(p->run, p->output_after);
            observed = true;
        }
        plant_event e =
            convert(b, b->place == BOUND_OUTPUT ? p->output_after[b->index] : p->after[b->index]);
        e.at_ticks = plant_now(p) + p->wish.delay_s;
        e.ticks = shown(p, e.at_ticks);
        enqueue(p, &p->samples, e);
        while ((double)p->due[b->channel] <= plant_now(p) + NEARLY) {
            p->due[b->channel] += p->period[b->channel];
        }
    }
}

/* --- advancing time ------------------------------------------------------------------------------------------- */

static bool step(plant *p) {
    double *const state = p->before;
    double *const output = p->output;
    p->before = p->after;
    p->after = state;
    p->output = p->output_after;
    p->output_after = output;
    p->status = engine_double.step(p->run);
    if (p->status != WH_OK) {
        return false;
    }
    look(p, p->after, p->output_after);
    see_edges(p);
    p->steps++;
    record(p);
    take_samples(p);
    return true;
}

bool plant_advance(plant *p, double until_ticks) {
    while (!plant_has_reached(p, until_ticks)) {
        if (p->waits && plant_has_reached(p, p->act_ticks)) {
            take_effect(p);
        }
        watch(p);
        if (is_reset(p)) {
            return true;
        }
        if (!step(p)) {
            return false;
        }
    }
    return true;
}

/* Take the due entries of a queue, `most` at most; further due ones are lost. */
static unsigned leave(plant *p, plant_queue *q, unsigned most, unsigned *there) {
    *there = 0;
    while (*there < q->count && q->event[*there].at_ticks <= plant_now(p) + NEARLY) {
        ++*there;
    }
    p->lost += *there > most ? *there - most : 0;
    return *there > most ? most : *there;
}

static void shift(plant_queue *q, unsigned gone) {
    q->count -= gone;
    memmove(q->event, q->event + gone, q->count * sizeof q->event[0]);
}

void plant_read(plant *p, wh_readings *readings) {
    unsigned there;
    *readings = (wh_readings){.flags = p->cut ? WH_READING_CUT : 0};
    readings->edges = leave(p, &p->edges, WH_EDGES_MAX, &there);
    for (unsigned i = 0; i < readings->edges; i++) {
        const plant_event *e = &p->edges.event[i];
        readings->edge[i] = (wh_edge){.ticks = e->ticks, .channel = e->channel};
    }
    shift(&p->edges, there);
    readings->samples = leave(p, &p->samples, WH_SAMPLES_MAX, &there);
    for (unsigned i = 0; i < readings->samples; i++) {
        const plant_event *e = &p->samples.event[i];
        readings->sample[i] = (wh_sample){
            .ticks = e->ticks, .raw = e->raw, .channel = e->channel, .status = e->status};
    }
    shift(&p->samples, there);
    p->edges_seen += readings->edges;
    p->samples_seen += readings->samples;
}
