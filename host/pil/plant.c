/* plant.c: a scene as the hardware of a controller. */
#include "host/pil/plant.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/noise.h"
#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/io/plot.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"

/* Are the units equal, if rad counts as 1, and rad/s as 1/s? */
static bool is_same_unit(const char *one, const char *other) {
    char both[2][BOUND_NAME];
    const char *const of[2] = {one, other};
    for (int i = 0; i < 2; i++) {
        const bool is_rad = strncmp(of[i], "rad", 3) == 0;
        snprintf(both[i], sizeof both[i], "%s%s", is_rad ? "1" : "", of[i] + (is_rad ? 3 : 0));
    }
    return strcmp(both[0], both[1]) == 0;
}

static bool is_output(const bound *b) { return b->signal.kind == WH_SIGNAL_OUTPUT; }

const char *bind_read(bound *b, const image *im, const char *name) {
    for (int i = 0; i < im->own_outputs; i++) {
        if (strcmp(im->output[i].name, name) == 0) {
            b->index = i;
            b->of_output = true;
            b->rate = -1;
            b->turns = false;
            return im->output[i].unit.si;
        }
    }
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        const image_unknown *u = &im->unknown[c.unknown];
        const size_t length = strlen(u->name);
        const size_t primes = (size_t)c.primes; /* theta' is the rate of theta */
        if (strncmp(name, u->name, length) == 0 && strlen(name) == length + primes &&
            strspn(name + length, "'") == primes) {
            b->index = i;
            b->of_output = false;
            b->rate = image_find_component(im, c.unknown, c.primes + 1);
            b->turns = c.primes == 0 && u->is_angle;
            return u->unit[c.primes].si;
        }
    }
    return NULL;
}

int bind_input(const image *im, const char *name) {
    int i = im->inputs - 1;
    while (i >= 0 && strcmp(im->input[i].name, name) != 0) {
        i--;
    }
    return i;
}

/* `name`: the scene's name for the signal */
static void say_unknown(const bound *b, const image *im, const char *name) {
    const char *kind = is_output(b) ? "input" : "output or coordinate";
    nearest search = nearest_start(name, strlen(name));
    fprintf(stderr, "whirl pil: error: the firmware %s '%s', but '%s' has no %s '%s'\nhint: ",
            is_output(b) ? "sets" : "reads", b->signal.name, im->name, kind, name);
    const int count = is_output(b) ? im->inputs : im->own_outputs;
    const image_quantity *of = is_output(b) ? im->input : im->output;
    if (count == 0 && is_output(b)) {
        fputs("the mechanism needs an input for it (`input NAME = 0 [UNIT]`)\n", stderr);
        return;
    }
    fprintf(stderr, "bind '%s' to one of:", b->signal.name);
    for (int i = 0; i < count; i++) {
        fprintf(stderr, " %s", of[i].name);
        nearest_offer(&search, of[i].name);
    }
    for (int i = 0; i < im->count && !is_output(b); i++) {
        fprintf(stderr, " %s", im->unknown[i].name);
        nearest_offer(&search, im->unknown[i].name);
    }
    fprintf(stderr, " (--bind %s=%s)\n", b->signal.name,
            search.best != NULL ? search.best : "NAME");
}

static bool has_good_range(const bound *b) {
    const wh_signal *s = &b->signal;
    const double count = (double)s->per_count;
    bool good = isfinite(s->low) && isfinite(s->high) && s->low <= s->high;
    if (s->kind == WH_SIGNAL_SAMPLE) {
        good = good && s->period_ticks > 0 && count > 0.0 && isfinite(count) &&
               (double)s->low / count >= (double)INT32_MIN &&
               (double)s->high / count <= (double)INT32_MAX;
    }
    if (!good) {
        fprintf(
            stderr,
            "whirl pil: error: the firmware declares '%s' with the range %g to %g, %g per "
            "count, every %u ticks\nhint: declare low <= high; for a sample, also declare a period "
            "above zero, a value per count above zero, and a range that fits into 32-bit counts\n",
            s->name, (double)s->low, (double)s->high, (double)s->per_count,
            (unsigned)s->period_ticks);
    }
    return good;
}

static bool bind_one(bound *b, const image *im) {
    if (b->signal.kind == WH_SIGNAL_NOTE) {
        return true;
    }
    const char *name = b->renamed[0] != '\0' ? b->renamed : b->signal.name;
    const char *unit = NULL;
    if (!is_output(b)) {
        unit = bind_read(b, im, name);
    } else if ((b->index = bind_input(im, name)) >= 0) {
        unit = im->input[b->index].unit.si;
    }
    if (unit == NULL) {
        say_unknown(b, im, name);
        return false;
    }
    if (!is_same_unit(unit, b->signal.unit)) {
        fprintf(stderr,
                "whirl pil: error: the firmware's '%s' is in %s, but '%s' of '%s' is in %s\nhint: "
                "use SI units in the firmware and in the scene\n",
                b->signal.name, b->signal.unit, name, im->name, unit);
        return false;
    }
    return has_good_range(b);
}

/* Reads the words NAME=OTHER of --bind. Returns false (reported) if one is invalid, or NAME is unknown or repeated. */
static bool take_renames(binding *b, const char *renames) {
    for (const char *at = renames; at != NULL;) {
        const size_t length = strcspn(at, ",");
        const size_t name = strcspn(at, "=");
        bound *one = NULL;
        for (unsigned i = 0; i < b->count; i++) {
            const char *known = b->bound[i].signal.name;
            one = strlen(known) == name && strncmp(at, known, name) == 0 ? &b->bound[i] : one;
        }
        const char *why = name == 0 || name + 1U >= length ? "this is not NAME=OTHER"
                          : one == NULL ? "the firmware has no signal of that name"
                          : one->renamed[0] != '\0'
                              ? "--bind already renames this signal of the firmware"
                              : NULL;
        if (why != NULL) {
            fprintf(stderr,
                    "whirl pil: error: --bind '%.*s': %s\n"
                    "hint: write --bind NAME=OTHER, with the firmware's name first\n",
                    (int)length, at, why);
            return false;
        }
        snprintf(one->renamed, sizeof one->renamed, "%.*s", (int)(length - name - 1U),
                 at + name + 1);
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return true;
}

unsigned hello_channels(const wh_hello *hello, wh_signal_kind kind) {
    unsigned count = 0;
    while (hello_signal(hello, kind, count) != NULL) {
        count++;
    }
    return count;
}

const wh_signal *hello_signal(const wh_hello *hello, wh_signal_kind kind, unsigned channel) {
    for (unsigned i = 0; i < hello->signals; i++) {
        if (hello->signal[i].kind == kind && channel-- == 0) {
            return &hello->signal[i];
        }
    }
    return NULL;
}

bool bind_signals(binding *b, const wh_hello *hello, const image *im, const char *renames) {
    *b = (binding){.count = hello->signals};
    unsigned channels[WH_SIGNAL_NOTE + 1] = {0};
    for (unsigned i = 0; i < b->count; i++) {
        b->bound[i].signal = hello->signal[i];
        b->bound[i].channel = channels[hello->signal[i].kind]++;
    }
    bool good = take_renames(b, renames);
    for (unsigned i = 0; i < b->count && good; i++) {
        good = bind_one(&b->bound[i], im);
    }
    return good;
}

/* === records of the plant as comma-separated values ============================================ */

#define EVERY_S 1e-3

bool recorded_open(recorded *r, const char *name, const image *im, double every_s) {
    *r = (recorded){.name = name, .every = 1};
    if (name == NULL) {
        return true;
    }
    const bool is_whole = ratio_count_each(every_s >= 0.0 ? every_s : EVERY_S, im->step, &r->every);
    if (!is_whole && every_s >= 0.0) {
        fprintf(
            stderr,
            "whirl pil: error: --every %.9g s is not a multiple of the step\nhint: use a multiple of the plant's step, %.9g s\n",
            every_s, im->step_s);
        return false;
    }
    r->every = is_whole ? r->every : 1;
    r->file = atomic_file_open(name);
    if (r->file == NULL) {
        return false;
    }
    r->rows = records_open(r->file, im, &engine_double);
    records_header(r->rows);
    return true;
}

bool recorded_close(recorded *r) {
    const char *scene = r->rows != NULL ? r->rows->image->name : "";
    records_close(r->rows);
    return plot_run_csv_end(r->file, r->name, true, "pil", scene);
}

/* === sensors and actuators ==================================================================== */

#define TURN_RAD 6.283185307179586477
#define TURN_DEG 360.0
#define NEARLY 1e-6 /* ticks: tolerance for round-off when times are compared */

bool plant_read_places(const char *text, plant_request *to) {
    unsigned count = 0;
    for (const char *at = text; at != NULL;) {
        const char *end = at;
        const double number = decimal_read(at, &end);
        if (end == at || (*end != '\0' && *end != ',') || !isfinite(number) ||
            count == WH_SIGNALS_MAX) {
            fprintf(
                stderr,
                "whirl pil: error: --place '%s': give numbers with commas between them, one per edge\n"
                "hint: --place 0,2.5 moves the second edge by 2.5 degrees\n",
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
    const recorded *r = p->request.rows;
    if (r != NULL && r->rows != NULL && p->steps % r->every == 0) {
        records_read(r->rows, p->run, ratio_times(p->steps, p->image->step));
        (void)records_write(r->rows);
    }
}

static void look(const plant *p, double *state, double *output) {
    engine_double.state(p->run, state, state + p->image->angles);
    if (p->sees_outputs) {
        engine_double.outputs(p->run, output);
    }
}

void plant_start(plant *p, const image *im, const binding *b, const wh_hello *hello,
                 const plant_request *request) {
    *p = (plant){.image = im,
                 .binding = b,
                 .request = *request,
                 .run = engine_double.start(im),
                 .step_ticks = im->step_s * (double)hello->ticks_per_s,
                 .start_ticks = hello->start_ticks,
                 .timer_ticks = hello->start_ticks,
                 .reset = {.at_ticks = (double)INFINITY}};
    p->request.jitter_s *= (double)hello->ticks_per_s;
    p->request.delay_s *= (double)hello->ticks_per_s;
    p->before = alloc(im->angles + im->reals, sizeof *p->before);
    p->after = alloc(im->angles + im->reals, sizeof *p->after);
    p->output = alloc(im->outputs, sizeof *p->output);
    p->output_after = alloc(im->outputs, sizeof *p->output_after);
    for (unsigned i = 0; i < b->count; i++) {
        const bound *one = &b->bound[i];
        if (one->signal.kind == WH_SIGNAL_EDGE) {
            p->sees_outputs = p->sees_outputs || one->of_output;
            p->request.place[one->channel] *= one->turns ? TURN_RAD / TURN_DEG : 1.0;
        } else if (one->signal.kind == WH_SIGNAL_SAMPLE) {
            p->period[one->channel] = one->signal.period_ticks;
            p->due[one->channel] = one->signal.period_ticks;
        } else if (is_output(one)) {
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
    free(p->edges.event);
    free(p->samples.event);
    *p = (plant){.run = NULL};
}

double plant_now(const plant *p) { return (double)p->steps * p->step_ticks; }

bool plant_has_reached(const plant *p, double ticks) { return plant_now(p) + NEARLY >= ticks; }

/* The controller's timer: whole ticks, which wrap. */
static uint32_t shown(const plant *p, double ticks) {
    return p->start_ticks + (uint32_t)(uint64_t)number_floor(ticks + NEARLY);
}

uint32_t plant_ticks(const plant *p) { return shown(p, plant_now(p)); }

/* --- outputs of the controller ----------------------------------------------------------------------------- */

static void set_inputs(plant *p) {
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (is_output(b)) {
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

/* If a reset is due, begins it, drops waiting orders, and returns true. */
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

static void enqueue(plant_queue *q, plant_event event) {
    q->event = alloc_more(q->event, q->count + 1, sizeof *q->event);
    unsigned at = q->count++;
    for (; at > 0 && q->event[at - 1].at_ticks > event.at_ticks; at--) {
        q->event[at] = q->event[at - 1];
    }
    q->event[at] = event;
}

/* An edge's quantity at both ends of a step: its values, and its slopes, which are rates times the step's length. */
typedef struct span_of_step {
    double from;
    double to;
    double slope_from;
    double slope_to;
} span_of_step;

static span_of_step span_of(const plant *p, const bound *b) {
    const double from = (b->of_output ? p->output : p->before)[b->index];
    const double to = (b->of_output ? p->output_after : p->after)[b->index];
    const double h = p->image->step_s;
    return (span_of_step){from, to, b->rate >= 0 ? p->before[b->rate] * h : to - from,
                          b->rate >= 0 ? p->after[b->rate] * h : to - from};
}

static double at_part(const span_of_step *s, double part) {
    const double way = s->to - s->from;
    const double a = s->slope_from + s->slope_to - 2.0 * way;
    const double b = 3.0 * way - 2.0 * s->slope_from - s->slope_to;
    return s->from + ((a * part + b) * part + s->slope_from) * part;
}

/* Bisection: returns the part of the step at which the cubic equals `level`. The cubic's ends must enclose it. */
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

/* Does the quantity enter the edge's range in this step? *level gets the value at which it enters the range. */
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
        if (enters(&s, b, p->request.place[b->channel], &level)) {
            double ticks = ((double)p->steps + part_at(&s, level)) * p->step_ticks;
            if (p->request.jitter_s > 0.0) {
                ticks += p->request.jitter_s *
                         (double)wh_noise(p->request.seed + b->channel, p->edges_made);
                ticks = ticks > 0.0 ? ticks : 0.0;
            }
            p->edges_made++;
            enqueue(&p->edges, (plant_event){.at_ticks = ticks,
                                             .ticks = shown(p, ticks),
                                             .channel = (uint8_t)b->channel});
        }
    }
}

int32_t hello_count(const wh_signal *s, double value, uint8_t *status) {
    const double low = (double)s->low;
    const double high = (double)s->high;
    const bool good = value > low && value < high;
    *status = good ? WH_SAMPLE_GOOD : WH_SAMPLE_SATURATED;
    value = good ? value : value <= low ? low : high; /* high for NaN */
    /* int32_t has space for the result, because has_good_range() checked the range. */
    return (int32_t)number_floor(value / (double)s->per_count + 0.5);
}

static void take_samples(plant *p) {
    bool observed = p->sees_outputs;
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (b->signal.kind != WH_SIGNAL_SAMPLE ||
            !plant_has_reached(p, (double)p->due[b->channel])) {
            continue;
        }
        if (b->of_output && !observed) {
            engine_double.outputs(p->run, p->output_after);
            observed = true;
        }
        const double *of = b->of_output ? p->output_after : p->after;
        plant_event e = {.channel = (uint8_t)b->channel};
        e.raw = hello_count(&b->signal, of[b->index], &e.status);
        e.at_ticks = plant_now(p) + p->request.delay_s;
        e.ticks = shown(p, e.at_ticks);
        enqueue(&p->samples, e);
        while (plant_has_reached(p, (double)p->due[b->channel])) {
            p->due[b->channel] += p->period[b->channel];
        }
    }
}

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

/* *there gets the number of due readings. Returns how many of them are delivered: at most `most`. */
static unsigned leave(plant *p, plant_queue *q, unsigned most, unsigned *there) {
    *there = 0;
    while (*there < q->count && plant_has_reached(p, q->event[*there].at_ticks)) {
        ++*there;
    }
    p->lost += *there > most ? *there - most : 0;
    return *there > most ? most : *there;
}

static void shift(plant_queue *q, unsigned gone) {
    q->count -= gone;
    if (gone > 0) { /* memmove() must not get NULL, and an empty queue may have no array */
        memmove(q->event, q->event + gone, q->count * sizeof q->event[0]);
    }
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
