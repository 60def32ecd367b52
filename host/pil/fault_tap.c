/* fault_tap.c: when faults begin and end, and what they do to the plant and to orders. */
#include <math.h>
#include <string.h>

#include "fault.h"

/* Which of the scene's inputs, and what becomes of its healthy value. */
static const struct {
    fault_kind kind;
    const char *input;
    bool times;   /* its value is multiplied; else it takes the size, */
    double value; /* or this, if not 0 */
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

/* --- before it begins ----------------------------------------------------------------------------------------*/

static int input_of(const image *im, const char *name) {
    for (int i = 0; i < im->inputs; i++) {
        if (strcmp(im->input[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static bool find_inputs(const fault_case *f, const image *im) {
    for (int i = 0; i < INPUTS; i++) {
        if (inputs[i].kind == f->kind && input_of(im, inputs[i].input) < 0) {
            fprintf(stderr,
                    "whirl pil: error: --fault %s: '%s' has no input '%s'\n"
                    "hint: docs/plants/rig.whirl has\n",
                    fault_rows[f->kind].word, im->name, inputs[i].input);
            return false;
        }
    }
    return true;
}

/* Notes stand behind the outputs, in their order. */
static bool find_note(fault_case *f, const wh_hello *hello) {
    int at = 0;
    for (unsigned i = 0; i < hello->signals; i++) {
        at += hello->signal[i].kind == WH_SIGNAL_OUTPUT;
    }
    for (unsigned i = 0; i < hello->signals && f->note[0] != '\0'; i++) {
        const wh_signal *s = &hello->signal[i];
        if (s->kind == WH_SIGNAL_NOTE && strcmp(s->name, f->note) == 0) {
            f->note_at = at;
            return true;
        }
        at += s->kind == WH_SIGNAL_NOTE;
    }
    if (f->note[0] != '\0') {
        fprintf(stderr, "whirl pil: error: --fault %s@%s=...: the firmware tells no '%s'\n",
                fault_rows[f->kind].word, f->note, f->note);
    }
    return f->note[0] == '\0';
}

static bool has_channel(const fault_case *f, const plant *p) {
    const fault_place at = fault_rows[f->kind].place;
    const unsigned count = at == FAULT_SAMPLES ? p->binding->samples : p->binding->edges;
    const bool asks = at == FAULT_SAMPLES || at == FAULT_EDGES || at == FAULT_SENSORS;
    if (asks && f->channel >= (int)count) {
        fprintf(stderr, "whirl pil: error: --fault %s:%d: the firmware has %u such channels\n",
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
        const int at = input_of(im, inputs[i].input);
        const double healthy = im->input[at].value;
        const double size = inputs[i].value != 0.0 ? inputs[i].value : f->size;
        const double wrong = inputs[i].times ? healthy * size : size;
        engine_double.set_input(plan->plant->run, at, broken ? wrong : healthy);
    }
}

/* Where a sensor stands: degrees of an angle, else SI. */
static void set_sensors(const fault_plan *plan, const fault_case *f, bool broken) {
    plant *p = plan->plant;
    if (f->kind == FAULT_EDGE_JITTER) {
        p->wish.jitter_s += (broken ? 1.0 : -1.0) * f->size * plan->ticks_per_s;
        return;
    }
    for (unsigned i = 0; i < p->binding->count; i++) {
        const bound *b = &p->binding->bound[i];
        if (b->signal.kind == WH_SIGNAL_EDGE && (f->channel < 0 || f->channel == (int)b->channel)) {
            const double off = b->turns ? f->size * 0.017453292519943295 : f->size;
            p->wish.place[b->channel] += broken ? off : -off;
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

static double due_ticks(const fault_plan *plan, const fault_case *f) {
    return (f->begin_s + f->after_s) * plan->ticks_per_s;
}

/* There was a reset: what was on its way is lost, outputs are 0, and who asked for it is served. */
static void see_reset(fault_plan *plan) {
    const double then_ticks = plan->plant->reset.last_ticks;
    plan->last = (wh_orders){.outputs = plan->last.outputs};
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        f->pending_count = 0;
        if (f->kind == FAULT_RESET && f->reached && !f->happened &&
            due_ticks(plan, f) <= then_ticks) {
            f->happened = true;
            f->begin_s = then_ticks / plan->ticks_per_s;
        }
    }
}

/* The plant is told of the next one beforehand: it need not be when anybody speaks. */
static void order_reset(fault_plan *plan, const fault_case *f) {
    plant_resets *r = &plan->plant->reset;
    if (f->kind == FAULT_RESET && f->reached && !f->happened && due_ticks(plan, f) < r->at_ticks) {
        r->at_ticks = due_ticks(plan, f);
        r->takes_ticks = f->size * plan->ticks_per_s;
    }
    if (f->kind == FAULT_WATCHDOG_RESETS && f->active) {
        r->by_watchdog = true;
        r->watchdog_ticks = f->size * plan->ticks_per_s;
    }
}

static void look_for_resets(fault_plan *plan) {
    plant_resets *r = &plan->plant->reset;
    if (r->count != plan->resets) {
        plan->resets = r->count;
        see_reset(plan);
    }
    r->at_ticks = (double)INFINITY;
    r->by_watchdog = false;
    for (unsigned i = 0; i < plan->count; i++) {
        order_reset(plan, &plan->fault[i]);
    }
}

/* Begins a fault whose time has come, and ends one whose time is over. */
static void look_at_time(fault_plan *plan, double time_s) {
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        if (fault_rows[f->kind].place == FAULT_PARAMETER) {
            f->happened = true;
        } else if (f->kind == FAULT_RESET) {
            continue; /* the plant does it */
        } else if (!f->happened && f->reached && time_s >= f->begin_s + f->after_s) {
            change(plan, f, time_s, true);
        } else if (f->active && time_s >= f->begin_s + f->duration_s) {
            change(plan, f, time_s, false);
        }
    }
    look_for_resets(plan);
}

/* --- as a tap ------------------------------------------------------------------------------------------------*/

static bool tap_start(void *of, const wh_hello *hello, plant *p) {
    fault_plan *plan = of;
    plan->plant = p;
    plan->ticks_per_s = (double)hello->ticks_per_s;
    for (unsigned i = 0; i < plan->count; i++) {
        fault_case *f = &plan->fault[i];
        if (!find_inputs(f, p->image) || !find_note(f, hello) || !has_channel(f, p)) {
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
    if (f->kind == FAULT_SLOW) {
        orders->acted_timer = times(orders->acted_timer, f->size);
        orders->busy_timer = times(orders->busy_timer, f->size);
    } else if (f->kind == FAULT_LATE) {
        *late_s += f->size;
    } else if (f->kind == FAULT_HANG && f->left > 0) {
        *late_s += f->size;
        f->left = 0;
    } else if (f->kind == FAULT_UNKICKED) {
        orders->flags &= (uint8_t)~WH_ORDER_ALIVE;
    } else if (f->kind == FAULT_UNWATCHED) {
        orders->watchdog_ticks = 0;
    }
}

/* What was lost says neither what the outputs are nor that anybody is alive. */
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
        if (f->active || f->pending_count > 0) {
            fault_readings(plan, f, time_s, readings);
        }
    }
}

tap fault_tap(fault_plan *plan) {
    return (tap){.name = "faults",
                 .of = plan,
                 .start = tap_start,
                 .orders = tap_orders,
                 .readings = tap_readings};
}
