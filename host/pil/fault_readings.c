/* fault_readings.c: what faults of sensors, of the load cell and of the line make of what the plant says. */
#include <math.h>

#include "core/noise.h"
#include "fault.h"
#include "host/number/functions.h"

#define HUM_HZ 60.0
#define TURN_RAD 6.283185307179586477
#define INVENTED_S 0.1 /* from one to the next, at most */
#define SPIKES_ONE_IN 50.0
#define TOLD_S 1e-9 /* of rounding */

static bool is_of(const fault_case *f, unsigned channel) {
    const bool samples = fault_rows[f->kind].place == FAULT_SAMPLES;
    return f->channel < 0 ? !samples || channel == 0 : f->channel == (int)channel;
}

/* --- edges ---------------------------------------------------------------------------------------------------*/

/* In order of time, as a timer hands them out; none when there is no room. */
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

/* One pulse. False: it does not come. */
static bool break_edge(const fault_plan *plan, fault_case *f, double time_s, wh_edge *edge) {
    if (f->kind == FAULT_EDGE_DEAD) {
        return false;
    }
    if (f->kind == FAULT_EDGE_LOST && f->left > 0) {
        f->left--;
        return false;
    }
    if (f->kind == FAULT_EDGE_SWAPPED && edge->channel < 2) {
        edge->channel ^= 1U;
    }
    if (f->kind == FAULT_EDGE_STAMP) {
        edge->ticks += ticks_of(plan, f->size);
    }
    if (f->kind == FAULT_EDGE_LATE || f->kind == FAULT_EDGE_DOUBLE) {
        const bool again = f->kind == FAULT_EDGE_DOUBLE;
        fault_pending later = {.at_s = time_s + f->size, .is_edge = true, .edge = *edge};
        later.edge.ticks += again ? ticks_of(plan, f->size) : 0;
        tell_later(f, later);
        return again;
    }
    return true;
}

/* Pulses of nothing, since the last readings. */
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

static const wh_signal *signal_of(const fault_plan *plan, unsigned channel) {
    const binding *b = plan->plant->binding;
    for (unsigned i = 0; i < b->count; i++) {
        if (b->bound[i].signal.kind == WH_SIGNAL_SAMPLE && b->bound[i].channel == channel) {
            return &b->bound[i].signal;
        }
    }
    return NULL;
}

static void set_value(const fault_plan *plan, wh_sample *s, double value, bool added) {
    const wh_signal *of = signal_of(plan, s->channel);
    const double count = (double)of->per_count;
    const double counts = value / count + (added ? (double)s->raw : 0.0);
    const double low = (double)of->low / count;
    const double high = (double)of->high / count;
    const double held = counts < low ? low : counts > high ? high : counts;
    s->raw = (int32_t)number_floor(held + 0.5);
    if (s->status != WH_SAMPLE_DISCONNECTED) {
        s->status = counts <= low || counts >= high ? WH_SAMPLE_SATURATED : WH_SAMPLE_GOOD;
    }
}

static void change_value(const fault_plan *plan, fault_case *f, double time_s, wh_sample *s) {
    const double hum = f->size * number_sine(TURN_RAD * HUM_HZ * time_s);
    if (f->kind == FAULT_CELL_PICKUP || f->kind == FAULT_CELL_HUM) {
        set_value(plan, s, hum, f->kind == FAULT_CELL_HUM);
    } else if (f->kind == FAULT_CELL_NOISE) {
        set_value(plan, s, f->size * (double)wh_noise(plan->seed ^ 0x6E6F6973U, f->draws++), true);
    } else if (f->kind == FAULT_CELL_SPIKES && fault_draw(plan, f) * SPIKES_ONE_IN < 1.0) {
        set_value(plan, s, fault_draw(plan, f) < 0.5 ? f->size : -f->size, true);
    } else if (f->kind == FAULT_READS) {
        set_value(plan, s, f->size, false);
    } else if (f->kind == FAULT_CELL_SATURATED) {
        set_value(plan, s, (double)INFINITY, false);
    } else if (f->kind == FAULT_CELL_OPEN) {
        s->raw = 0;
        s->status = WH_SAMPLE_DISCONNECTED;
    } else if (f->kind == FAULT_CELL_FROZEN) {
        f->held.raw = f->holds ? f->held.raw : s->raw;
        f->holds = true;
        s->raw = f->held.raw;
        s->status = WH_SAMPLE_GOOD;
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

/* --- both ----------------------------------------------------------------------------------------------------*/

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

void fault_readings(fault_plan *plan, fault_case *f, double time_s, wh_readings *r) {
    const fault_place at = fault_rows[f->kind].place;
    if (f->active && at == FAULT_EDGES) {
        break_edges(plan, f, time_s, r);
    } else if (f->active && at == FAULT_SAMPLES) {
        break_samples(plan, f, time_s, r);
    } else if (f->active && f->kind == FAULT_READINGS_LOST && fault_draw(plan, f) < f->size) {
        r->edges = 0;
        r->samples = 0;
    }
    tell_pending(f, time_s, r);
}
