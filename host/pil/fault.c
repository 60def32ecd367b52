/* fault.c: injected faults in a run in the loop. */
#include "host/pil/fault.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "core/noise.h"
#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

/* === faults of readings ======================================================================= */

/* Next random number of the fault, in [0, 1). */
static double fault_draw(const fault_plan *plan, fault_case *f) {
    uint64_t hash = wh_hash_u64(WH_HASH_START, plan->seed);
    hash = wh_hash_u64(hash, (uint64_t)(f - plan->fault));
    hash = wh_hash_u64(hash, f->draws++);
    return (double)(hash >> 11) * 0x1p-53;
}

#define HUM_HZ 60.0
#define TURN_RAD 6.283185307179586477
#define INVENTED_S 0.1 /* longest interval between false pulses */
#define SPIKES_ONE_IN 50.0
#define TOLD_S 1e-9

static bool is_of(const fault_case *f, unsigned channel) {
    const bool samples = fault_rows[f->kind].place == FAULT_SAMPLES;
    return f->channel < 0 ? !samples || channel == 0 : f->channel == (int)channel;
}

/* --- edges ---------------------------------------------------------------------------------------------------*/

/* Inserts the edge in order of time stamps, as a timer would deliver it. Drops it if there is no space. */
static void add_edge(wh_readings *r, wh_edge edge) {
    if (r->edges == WH_EDGES_MAX) {
        return;
    }
    unsigned at = r->edges++;
    for (; at > 0 && (int32_t)(r->edge[at - 1].ticks - edge.ticks) > 0; at--) {
        r->edge[at] = r->edge[at - 1];
    }
    r->edge[at] = edge;
}

static void tell_later(fault_case *f, fault_pending what) {
    if (f->pending_count < FAULT_PENDING) {
        f->pending[f->pending_count++] = what;
    }
}

static uint32_t ticks_of(const fault_plan *plan, double time_s) {
    return (uint32_t)(int64_t)number_floor(time_s * plan->ticks_per_s);
}

/* Returns false if the pulse is lost or delayed. */
static bool break_edge(const fault_plan *plan, fault_case *f, double time_s, wh_edge *edge) {
    fault_pending later = {.at_s = time_s + f->size, .is_edge = true, .edge = *edge};
    switch (f->kind) {
    case FAULT_EDGE_DEAD: return false;
    case FAULT_EDGE_LOST:
        if (f->left > 0) {
            f->left--;
            return false;
        }
        break;
    case FAULT_EDGE_SWAPPED: edge->channel ^= edge->channel < 2; break;
    case FAULT_EDGE_STAMP: edge->ticks += ticks_of(plan, f->size); break;
    case FAULT_EDGE_LATE: tell_later(f, later); return false;
    case FAULT_EDGE_DOUBLE:
        later.edge.ticks += ticks_of(plan, f->size);
        tell_later(f, later);
        break;
    case FAULT_EDGE_INVENTED:
    case FAULT_EDGE_STORM:
        FAULT_SENSOR_ROWS(FAULT_CASE)
        FAULT_SAMPLE_ROWS(FAULT_CASE)
        FAULT_PLANT_ROWS(FAULT_CASE)
        FAULT_ORDER_ROWS(FAULT_CASE)
        FAULT_LINE_ROWS(FAULT_CASE)
        break;
    }
    return true;
}

static void invent_edges(const fault_plan *plan, fault_case *f, double time_s, wh_readings *r) {
    const bool storm = f->kind == FAULT_EDGE_STORM;
    const uint32_t now_ticks = plant_ticks(plan->plant);
    while (f->next_s <= time_s && (storm || f->left > 0)) {
        if (f->next_s > f->begin_s || storm) {
            const int channel = f->channel >= 0 ? f->channel : fault_draw(plan, f) < 0.5 ? 0 : 1;
            add_edge(r, (wh_edge){.ticks = now_ticks - ticks_of(plan, time_s - f->next_s),
                                  .channel = (uint8_t)channel});
            f->left -= f->left > 0;
        }
        f->next_s += storm ? 1.0 / f->size : INVENTED_S * fault_draw(plan, f);
    }
}

static void break_edges(const fault_plan *plan, fault_case *f, double time_s, wh_readings *r) {
    const wh_readings all = *r;
    r->edges = 0;
    for (unsigned i = 0; i < all.edges; i++) {
        wh_edge edge = all.edge[i];
        if (!is_of(f, edge.channel) || break_edge(plan, f, time_s, &edge)) {
            add_edge(r, edge);
        }
    }
    if (f->kind == FAULT_EDGE_STORM || f->kind == FAULT_EDGE_INVENTED) {
        invent_edges(plan, f, time_s, r);
    }
}

/* --- samples -------------------------------------------------------------------------------------------------*/

static void set_value(const fault_plan *plan, wh_sample *s, double value, bool added) {
    const wh_signal *of = hello_signal(plan->hello, WH_SIGNAL_SAMPLE, s->channel);
    uint8_t status;
    s->raw =
        hello_count(of, value + (added ? (double)s->raw * (double)of->per_count : 0.0), &status);
    s->status = s->status != WH_SAMPLE_DISCONNECTED ? status : s->status;
}

static void change_value(const fault_plan *plan, fault_case *f, double time_s, wh_sample *s) {
    const double hum = f->size * number_sine(TURN_RAD * HUM_HZ * time_s);
    switch (f->kind) {
    case FAULT_CELL_PICKUP: set_value(plan, s, hum, false); break;
    case FAULT_CELL_HUM: set_value(plan, s, hum, true); break;
    case FAULT_CELL_NOISE:
        set_value(plan, s, f->size * (double)wh_noise(plan->seed ^ 0x6E6F6973U, f->draws++), true);
        break;
    case FAULT_CELL_SPIKES:
        if (fault_draw(plan, f) * SPIKES_ONE_IN < 1.0) {
            set_value(plan, s, fault_draw(plan, f) < 0.5 ? f->size : -f->size, true);
        }
        break;
    case FAULT_READS: set_value(plan, s, f->size, false); break;
    case FAULT_CELL_SATURATED: set_value(plan, s, (double)INFINITY, false); break;
    case FAULT_CELL_OPEN: *s = (wh_sample){s->ticks, 0, s->channel, WH_SAMPLE_DISCONNECTED}; break;
    case FAULT_CELL_FROZEN:
        f->held = f->holds ? f->held : s->raw;
        f->holds = true;
        s->raw = f->held;
        s->status = WH_SAMPLE_GOOD;
        break;
    case FAULT_CELL_DEAD:
    case FAULT_CELL_LOST:
    case FAULT_CELL_REPEATED:
    case FAULT_CELL_LATE:
        FAULT_EDGE_ROWS(FAULT_CASE)
        FAULT_SENSOR_ROWS(FAULT_CASE)
        FAULT_PLANT_ROWS(FAULT_CASE)
        FAULT_ORDER_ROWS(FAULT_CASE)
        FAULT_LINE_ROWS(FAULT_CASE)
        break;
    }
}

static void add_sample(wh_readings *r, wh_sample sample) {
    if (r->samples < WH_SAMPLES_MAX) {
        r->sample[r->samples++] = sample;
    }
}

static void break_samples(const fault_plan *plan, fault_case *f, double time_s, wh_readings *r) {
    const wh_readings all = *r;
    r->samples = 0;
    for (unsigned i = 0; i < all.samples; i++) {
        wh_sample s = all.sample[i];
        if (!is_of(f, s.channel)) {
            add_sample(r, s);
            continue;
        }
        if (f->kind == FAULT_CELL_DEAD ||
            (f->kind == FAULT_CELL_LOST && fault_draw(plan, f) < f->size)) {
            continue;
        }
        if (f->kind == FAULT_CELL_LATE) {
            tell_later(f, (fault_pending){.at_s = time_s + f->size, .sample = s});
            continue;
        }
        change_value(plan, f, time_s, &s);
        add_sample(r, s);
        if (f->kind == FAULT_CELL_REPEATED) {
            add_sample(r, s);
        }
    }
}

static void tell_pending(fault_case *f, double time_s, wh_readings *r) {
    unsigned kept = 0;
    for (unsigned i = 0; i < f->pending_count; i++) {
        const fault_pending *p = &f->pending[i];
        if (p->at_s > time_s + TOLD_S) {
            f->pending[kept++] = *p;
        } else if (p->is_edge) {
            add_edge(r, p->edge);
        } else {
            add_sample(r, p->sample);
        }
    }
    f->pending_count = kept;
}

/* === when faults begin and end ================================================================ */

static const struct {
    fault_kind kind;
    const char *input;
    bool times;   /* true: multiply the input by the fault's size; false: replace the input */
    double value; /* used instead of the fault's size, if not 0 */
} inputs[] = {
    {FAULT_CELL_TURNED, "cell_gain", false, -1.0},
    {FAULT_CELL_GAIN, "cell_gain", true, 0.0},
    {FAULT_CELL_OFFSET, "cell_offset", false, 0.0},
    {FAULT_SUPPLY, "volts", true, 0.0},
    {FAULT_FREEWHEEL, "freewheel", false, 1.0},
    {FAULT_RUNAWAY, "runaway", false, 0.0},
    {FAULT_STUCK, "runaway", false, 0.0},
    {FAULT_STUCK, "enable_stuck", false, 1.0},
    {FAULT_MOTOR, "stall", true, 0.0},
    {FAULT_FRICTION, "bearing_friction", false, 0.0},
    {FAULT_JAM, "bearing_friction", false, 0.0},
    {FAULT_COUPLING, "k", true, 0.0},
    {FAULT_STOP, "stop_pressed", false, 1.0},
};
enum { INPUTS = sizeof inputs / sizeof inputs[0] };

/* --- before a fault begins -----------------------------------------------------------------------------------*/

static bool find_inputs(const fault_case *f, const image *im) {
    for (int i = 0; i < INPUTS; i++) {
        if (inputs[i].kind == f->kind && bind_input(im, inputs[i].input) < 0) {
            fprintf(stderr,
                    "whirl pil: error: --fault %s: '%s' has no input '%s', which this fault "
                    "needs\nhint: use a plant that has it, such as docs/plants/rig.whirl\n",
                    fault_rows[f->kind].word, im->name, inputs[i].input);
            return false;
        }
    }
    return true;
}

/* Sets f->note_at, the note's index in orders.output[]: notes follow the outputs there. */
static bool find_note(fault_case *f, const wh_hello *hello) {
    const unsigned outputs = hello_channels(hello, WH_SIGNAL_OUTPUT);
    const wh_signal *s;
    for (unsigned i = 0; (s = hello_signal(hello, WH_SIGNAL_NOTE, i)) != NULL; i++) {
        if (strcmp(s->name, f->note) == 0) {
            f->note_at = (int)(outputs + i);
            return true;
        }
    }
    if (f->note[0] != '\0') {
        fprintf(stderr, "whirl pil: error: --fault %s@%s=...: the firmware declares no note '%s'\n",
                fault_rows[f->kind].word, f->note, f->note);
    }
    return f->note[0] == '\0';
}

static bool has_channel(const fault_case *f, const wh_hello *hello) {
    const fault_place at = fault_rows[f->kind].place;
    const unsigned count =
        hello_channels(hello, at == FAULT_SAMPLES ? WH_SIGNAL_SAMPLE : WH_SIGNAL_EDGE);
    const bool asks = at == FAULT_SAMPLES || at == FAULT_EDGES || at == FAULT_SENSORS;
    if (asks && f->channel >= (int)count) {
        fprintf(stderr,
                "whirl pil: error: --fault %s:%d: the firmware has only %u channels of "
                "this kind\n",
                fault_rows[f->kind].word, f->channel + 1, count);
        return false;
    }
    return true;
}

/* --- the plant -----------------------------------------------------------------------------------------------*/

static void set_inputs(const fault_plan *plan, const fault_case *f, bool broken) {
    const image *im = plan->plant->image;
    for (int i = 0; i < INPUTS; i++) {
        if (inputs[i].kind != f->kind) {
            continue;
        }
        const int at = bind_input(im, inputs[i].input);
        const double healthy = im->input[at].value;
        const double size = inputs[i].value != 0.0 ? inputs[i].value : f->size;
        const double wrong = inputs[i].times ? healthy * size : size;
        engine_double.set_input(plan->plant->run, at, broken ? wrong : healthy);
    }
}

/* FAULT_EDGE_PLACE: the size is in degrees if the sensor reads an angle, else in SI units. */
static void set_sensors(const fault_plan *plan, const fault_case *f, bool broken) {
    plant *p = plan->plant;
    if (f->kind == FAULT_EDGE_JITTER) {
        p->request.jitter_s += (broken ? 1.0 : -1.0) * f->size * plan->ticks_per_s;
        return;
    }
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (b->signal.kind == WH_SIGNAL_EDGE && (f->channel < 0 || f->channel == (int)b->channel)) {
            const double off = b->turns ? f->size * 0.017453292519943295 : f->size;
            p->request.place[b->channel] += broken ? off : -off;
        }
    }
}

static void change(fault_plan *plan, fault_case *f, double time_s, bool begins) {
    f->active = begins;
    if (begins) {
        f->happened = true;
        f->begin_s = time_s;
        f->next_s = time_s;
        f->left =
            f->kind == FAULT_EDGE_LOST || f->kind == FAULT_EDGE_INVENTED ? (uint32_t)f->size : 1;
    }
    if (fault_rows[f->kind].place == FAULT_INPUT) {
        set_inputs(plan, f, begins);
    } else if (fault_rows[f->kind].place == FAULT_SENSORS) {
        set_sensors(plan, f, begins);
    }
}

/* --- the processor --------------------------------------------------------------------------------------------*/

/* Handles a reset that has happened. Then sets the next one in advance: it may come between two messages. */
static void look_for_resets(fault_plan *plan) {
    plant_resets *r = &plan->plant->reset;
    const bool was_reset = r->count != plan->resets;
    if (was_reset) {
        plan->resets = r->count;
        plan->last = (wh_orders){.outputs = plan->last.outputs};
    }
    r->at_ticks = (double)INFINITY;
    r->by_watchdog = false;
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        const double due_ticks = (f->begin_s + f->after_s) * plan->ticks_per_s;
        const bool waits = f->kind == FAULT_RESET && f->reached && !f->happened;
        f->pending_count = was_reset ? 0 : f->pending_count;
        if (waits && was_reset && due_ticks <= r->last_ticks) {
            f->happened = true;
            f->begin_s = r->last_ticks / plan->ticks_per_s;
        } else if (waits && due_ticks < r->at_ticks) {
            r->at_ticks = due_ticks;
            r->takes_ticks = f->size * plan->ticks_per_s;
        } else if (f->kind == FAULT_WATCHDOG_RESETS && f->active) {
            r->by_watchdog = true;
            r->watchdog_ticks = f->size * plan->ticks_per_s;
        }
    }
}

/* Begins and ends faults that are due. */
static void look_at_time(fault_plan *plan, double time_s) {
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        if (fault_rows[f->kind].place == FAULT_PARAMETER) {
            f->happened = true;
        } else if (f->kind == FAULT_RESET) {
            continue; /* see look_for_resets() */
        } else if (!f->happened && f->reached && time_s >= f->begin_s + f->after_s) {
            change(plan, f, time_s, true);
        } else if (f->active && time_s >= f->begin_s + f->duration_s) {
            change(plan, f, time_s, false);
        }
    }
    look_for_resets(plan);
}

static bool tap_start(void *of, const wh_hello *hello, plant *p) {
    fault_plan *plan = of;
    plan->plant = p;
    plan->hello = hello;
    plan->ticks_per_s = (double)hello->ticks_per_s;
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        if (!find_inputs(f, p->image) || !find_note(f, hello) || !has_channel(f, hello)) {
            return false;
        }
        f->reached = f->note_at < 0;
    }
    look_at_time(plan, 0.0);
    return true;
}

static uint32_t times(uint32_t count, double size) {
    const double many = (double)count * size;
    return many < 4e9 ? (uint32_t)many : 4000000000U;
}

static void take_time(fault_case *f, wh_orders *orders, double *late_s) {
    switch (f->kind) {
    case FAULT_SLOW:
        orders->acted_timer = times(orders->acted_timer, f->size);
        orders->busy_timer = times(orders->busy_timer, f->size);
        break;
    case FAULT_LATE: *late_s += f->size; break;
    case FAULT_HANG:
        *late_s += f->left > 0 ? f->size : 0.0;
        f->left = 0;
        break;
    case FAULT_UNKICKED: orders->flags &= (uint8_t)~WH_ORDER_ALIVE; break;
    case FAULT_UNWATCHED:
        orders->watchdog_ticks = 0;
        break;
        FAULT_EDGE_ROWS(FAULT_CASE)
        FAULT_SENSOR_ROWS(FAULT_CASE)
        FAULT_SAMPLE_ROWS(FAULT_CASE)
        FAULT_PLANT_ROWS(FAULT_CASE)
        FAULT_LINE_ROWS(FAULT_CASE)
        break;
    }
}

/* Lost orders neither set outputs nor feed the watchdog. */
static void lose_orders(fault_plan *plan, wh_orders *orders) {
    const wh_orders sent = *orders;
    *orders = plan->last;
    orders->until_ticks = sent.until_ticks;
    orders->acted_timer = sent.acted_timer;
    orders->busy_timer = sent.busy_timer;
    orders->outputs = sent.outputs;
    orders->flags = 0;
}

static void tap_orders(void *of, double time_s, wh_orders *orders, double *late_s) {
    fault_plan *plan = of;
    bool lost = false;
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        if (!f->reached && orders->output[f->note_at] == (float)f->value) {
            f->reached = true;
            f->begin_s = time_s;
        }
    }
    look_at_time(plan, time_s);
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        if (f->active && fault_rows[f->kind].place == FAULT_ORDERS) {
            take_time(f, orders, late_s);
        }
        lost = lost || (f->active && f->kind == FAULT_ORDERS_LOST && fault_draw(plan, f) < f->size);
    }
    if (lost) {
        lose_orders(plan, orders);
    } else {
        plan->last = *orders;
    }
}

static void tap_readings(void *of, double time_s, wh_readings *readings) {
    fault_plan *plan = of;
    look_at_time(plan, time_s);
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        const fault_place at = fault_rows[f->kind].place;
        if (f->active && at == FAULT_EDGES) {
            break_edges(plan, f, time_s, readings);
        } else if (f->active && at == FAULT_SAMPLES) {
            break_samples(plan, f, time_s, readings);
        } else if (f->active && f->kind == FAULT_READINGS_LOST && fault_draw(plan, f) < f->size) {
            readings->edges = 0;
            readings->samples = 0;
        }
        tell_pending(f, time_s, readings);
    }
}

bool fault_all_occurred(const fault_plan *plan) {
    bool all = true;
    for (unsigned i = 0; i < plan->count; i++) {
        const fault_case *f = &plan->fault[i];
        if (!f->happened) {
            fprintf(stderr,
                    "whirl pil: error: the fault '%s' did not occur: ", fault_rows[f->kind].word);
            if (f->reached) {
                fputs("the run ended before the fault's time\n"
                      "hint: use an earlier time, or a longer --until\n",
                      stderr);
            } else {
                fprintf(stderr,
                        "the note '%s' never had the value %g\n"
                        "hint: read the notes in the run's report, or all values of the notes on "
                        "a tape (--tape FILE)\n",
                        f->note, f->value);
            }
            all = false;
        }
    }
    return all;
}

tap fault_tap(fault_plan *plan) {
    return (tap){.of = plan, .start = tap_start, .orders = tap_orders, .readings = tap_readings};
}

/* === faults in words ========================================================================== */

#define FAULT_ROW(which, word, place, size, least, most, unit, words) \
    {word, place, size, least, most, unit, words},
const fault_row fault_rows[FAULT_KINDS] = {FAULT_ROWS(FAULT_ROW)};
#undef FAULT_ROW

/* The text of one fault, and the reading position in it. */
typedef struct words_of_fault {
    const char *begin;
    const char *at;
} words_of_fault;

static bool wrong(const words_of_fault *w, const char *what, const char *hint) {
    fprintf(stderr, "whirl pil: error: --fault %s: %s\nhint: %s\n", w->begin, what, hint);
    return false;
}

static bool takes(words_of_fault *w, char mark) {
    const bool is = *w->at == mark;
    w->at += is;
    return is;
}

static bool read_number(words_of_fault *w, double *number) {
    const char *begin = w->at;
    *number = decimal_read(begin, &w->at);
    return w->at > begin && isfinite(*number);
}

/* Reads 20us, 1.5ms, 0.2s, or 0.2 (seconds). */
static bool read_time(words_of_fault *w, double *time_s) {
    static const struct {
        const char *word;
        double s;
    } units[] = {{"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}};
    if (!read_number(w, time_s)) {
        return false;
    }
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        const size_t length = strlen(units[i].word);
        if (strncmp(w->at, units[i].word, length) == 0) {
            *time_s *= units[i].s;
            w->at += length;
            break;
        }
    }
    return *time_s >= 0.0;
}

static bool read_kind(words_of_fault *w, fault_case *f) {
    const size_t length = strcspn(w->begin, ":=@+");
    nearest search = nearest_start(w->begin, length);
    for (int i = 0; i < FAULT_KINDS; i++) {
        const char *word = fault_rows[i].word;
        nearest_offer(&search, word);
        if (strlen(word) == length && strncmp(word, w->begin, length) == 0) {
            f->kind = (fault_kind)i;
            f->size = fault_rows[i].size;
            w->at = w->begin + length;
            return true;
        }
    }
    char hint[80];
    nearest_hint(&search, hint, sizeof hint);
    return wrong(w, "this kind of fault does not exist",
                 hint[0] != '\0' ? hint : "whirl pil --faults lists the kinds");
}

static bool read_channel(words_of_fault *w, fault_case *f) {
    const fault_place at = fault_rows[f->kind].place;
    double number;
    f->channel = -1;
    if (!takes(w, ':')) {
        return true;
    }
    if (at != FAULT_EDGES && at != FAULT_SAMPLES && at != FAULT_SENSORS) {
        return wrong(w, "this kind has no channels", "leave :CHANNEL out");
    }
    if (!read_number(w, &number) || !(number >= 1.0 && number <= (double)WH_SIGNALS_MAX) ||
        number != number_floor(number)) {
        return wrong(w, "not a valid channel", "use a channel number from 1 on, as in edge-dead:2");
    }
    f->channel = (int)number - 1;
    return true;
}

static bool read_size(words_of_fault *w, fault_case *f) {
    const fault_row *row = &fault_rows[f->kind];
    if (!takes(w, '=')) {
        return true;
    }
    if (!(row->least < row->most)) {
        return wrong(w, "this kind has no size", "leave =SIZE out");
    }
    if (!(strcmp(row->unit, "s") == 0 && *w->at != '-' ? read_time(w, &f->size)
                                                       : read_number(w, &f->size)) ||
        !(f->size >= row->least && f->size <= row->most)) {
        char hint[80];
        snprintf(hint, sizeof hint, "use a number from %g to %g%s%s", row->least, row->most,
                 row->unit[0] != '\0' ? " " : "", row->unit);
        return wrong(w, "not a valid size", hint);
    }
    return true;
}

static bool read_when(words_of_fault *w, fault_case *f) {
    static const char hint[] = "use @1.5s, @state=4, or @state=4~200ms (200 ms after state=4)";
    if (!takes(w, '@')) {
        return true;
    }
    if (fault_rows[f->kind].place == FAULT_PARAMETER) {
        return wrong(w, "this fault always lasts from the start to the end", "leave @WHEN out");
    }
    const size_t length = strcspn(w->at, "=+~");
    if (w->at[length] != '=') {
        return read_time(w, &f->after_s) || wrong(w, "not a valid time", hint);
    }
    if (length == 0 || length >= sizeof f->note) {
        return wrong(w, "not a valid note", hint);
    }
    memcpy(f->note, w->at, length);
    w->at += length + 1;
    return (read_number(w, &f->value) && (!takes(w, '~') || read_time(w, &f->after_s))) ||
           wrong(w, "not a valid time", hint);
}

static bool read_duration(words_of_fault *w, fault_case *f) {
    f->duration_s = (double)INFINITY;
    if (!takes(w, '+')) {
        return true;
    }
    const bool lasts = fault_rows[f->kind].place != FAULT_PARAMETER && f->kind != FAULT_RESET;
    return (lasts && read_time(w, &f->duration_s)) ||
           wrong(w, "not a valid duration", "use a time such as +500ms");
}

static bool read_one(fault_plan *plan, words_of_fault *w) {
    fault_case *f = &plan->fault[plan->count];
    if (plan->count == FAULTS_MAX) {
        return wrong(w, "too many faults", "give at most sixteen faults");
    }
    *f = (fault_case){.note_at = -1};
    if (!read_kind(w, f) || !read_channel(w, f) || !read_size(w, f) || !read_when(w, f) ||
        !read_duration(w, f)) {
        return false;
    }
    plan->count++;
    return *w->at == '\0' || wrong(w, "unknown text after the fault",
                                   "write KIND[:CHANNEL][=SIZE][@WHEN][+DURATION]");
}

bool fault_read(fault_plan *plan, const char *text) {
    bool good = true;
    for (const char *at = text; at != NULL && good;) {
        const size_t length = strcspn(at, ",");
        char *one = alloc_copy(at, length);
        good = read_one(plan, &(words_of_fault){one, one});
        free(one);
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return good;
}

char *fault_parameter(const fault_plan *plan, unsigned i) {
    const fault_case *f = &plan->fault[i];
    const fault_row *row = &fault_rows[f->kind];
    return row->place == FAULT_PARAMETER ? alloc_words("%s=%.17g", row->word, f->size) : NULL;
}

void fault_print_kinds(FILE *out) {
    for (int i = 0; i < FAULT_KINDS; i++) {
        const fault_row *row = &fault_rows[i];
        char size[48] = "";
        if (row->least < row->most) {
            snprintf(size, sizeof size, "=%g%s%s", row->size, row->unit[0] != '\0' ? " " : "",
                     row->unit);
        }
        fprintf(out, "    %-16s%-10s %s\n", row->word, size, row->words);
    }
}
