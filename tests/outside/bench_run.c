/* A run of the firmware with a plant: hello, exchanges, and the verdict. */
#include "tests/outside/bench_run.h"
#include "tests/outside/bench_line.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MOST_SAMPLES = 24, MOST_EDGES = 16, SAMPLES = 6 };

/* The rig's signals in the sequence of docs/dev/pil.md, with the dials last: kind, name, and period in ms. */
static const struct {
    int kind;
    const char *name;
    uint32_t ms;
} page[] = {
    {0, "duty", 0},         {0, "enable", 0},      {2, "theta", 0},        {2, "theta", 0},
    {1, "cell_force", 2},   {1, "supply", 2},      {1, "stop_input", 2},   {3, "state", 0},
    {3, "trip", 0},         {3, "quality", 0},     {3, "amplitude", 0},    {3, "amplitude_half", 0},
    {3, "phase", 0},        {3, "phase_half", 0},  {3, "turns", 0},        {3, "reset", 0},
    {1, "dial_speed", 100}, {1, "dial_feed", 100}, {1, "dial_brakes", 100}};
enum { SIGNALS = sizeof page / sizeof page[0] };

typedef struct {
    uint32_t start;
    int samples;
    double low[SAMPLES], high[SAMPLES], per_count[SAMPLES];
} hello;

static void read_hello(message *m, hello *h) {
    const uint32_t kind = get(m, 1), sequence = get(m, 2), ticks = get(m, 4);
    get_string(m);
    get_string(m);
    const uint32_t hz = get(m, 4), timer = get(m, 4);
    h->start = get(m, 4);
    h->samples = 0;
    if (kind != HELLO || sequence != 0 || ticks != h->start || hz != 1000000 || timer != 0) {
        disagree("kind %u, sequence %u, %u ticks/s in place of a hello", kind, sequence, hz);
    }
    const int rows = (int)get(m, 1);
    for (int i = 0, row = 0; row < SIGNALS; row++) {
        const size_t before = m->at;
        const int is_kind = i < rows ? (int)get(m, 1) : -1;
        const char *name = is_kind >= 0 ? get_string(m) : "nothing";
        if (strncmp(page[row].name, "dial", 4) == 0 && strcmp(name, page[row].name) != 0) {
            m->at = before; /* this firmware has no dials */
            continue;
        }
        if (is_kind != page[row].kind || strcmp(name, page[row].name) != 0) {
            disagree("signal %d is %s, on the page %s", i, name, page[row].name);
        }
        get_string(m);
        const double low = get_float(m), high = get_float(m), per_count = get_float(m);
        const uint32_t period = get(m, 4);
        const double at = row == 2 ? 0 : PI / 2;
        if (period != 1000 * page[row].ms ||
            (is_kind == 2 && fmax(fabs(low - at + DEG), fabs(high - at - DEG)) > 1e-5)) {
            disagree("%s, %g to %g, every %u ticks", name, low, high, period);
        }
        if (is_kind == 1) {
            h->low[h->samples] = low;
            h->high[h->samples] = high;
            h->per_count[h->samples++] = per_count;
        }
        i++;
    }
    if (m->at != m->n) {
        disagree("%d signals and %zu bytes more in the hello", rows, m->n - m->at);
    }
}

static void blame(outcome *o, bool *rule, const char *format, ...) {
    va_list values;
    va_start(values, format);
    if (!o->wrong && !o->on) {
        vsnprintf(o->why, sizeof o->why, format, values);
    }
    *rule = true;
    va_end(values);
}

/* Compares a good result with the force's Fourier coefficient over as many turns. The turns end with the last one, or
 * up to two earlier. A result also counts as right if its only errors are those that no run can show (docs/rig.md).
 * These are a gain error below 5 %, sensor 1 less than 5 degrees from its place, a load train, and a pick-up once in
 * a turn. */
static void judge_result(const plant *p, outcome *o) {
    double least = NEVER;
    for (int known = 0; known < 2; known++) {
        const double gain = known == 1 && fabs(p->b->gain) < 0.05 ? 1 + p->b->gain : 1;
        const double place = known == 1 && fabs(p->b->place_1) < 5 ? p->b->place_1 * DEG : 0;
        for (int back = 0; back < 3 && o->turns + back <= fmin((double)p->turns, KEPT); back++) {
            turn sum = {.seconds = 0};
            for (long i = p->turns - back - o->turns; i < p->turns - back; i++) {
                sum.cosine[0] += p->past[i % KEPT].cosine[known] / o->turns;
                sum.sine[0] += p->past[i % KEPT].sine[known] / o->turns;
                sum.seconds += p->past[i % KEPT].seconds / o->turns;
            }
            if (known == 1) {
                sum.cosine[0] += p->b->pickup * cos(p->b->pickup_phase);
                sum.sine[0] -= p->b->pickup * sin(p->b->pickup_phase);
            }
            const double amplitude = gain * hypot(sum.cosine[0], sum.sine[0]);
            const double phase = atan2(-sum.sine[0], sum.cosine[0]) + place;
            const double off =
                (fabs(o->note[AMPLITUDE] - amplitude) - o->note[AMPLITUDE_HALF]) / amplitude;
            const double turned =
                fabs(remainder(o->note[PHASE] - phase, TURN)) - o->note[PHASE_HALF];
            if (fmax(off, turned) < least) {
                least = fmax(off, turned);
                o->amplitude = amplitude;
                o->phase = phase;
                o->rpm = TURN / sum.seconds / RPM;
            }
        }
    }
    if (o->quality == 0 && least > 0.01) {
        blame(o, &o->wrong, "good: %.3f +- %.3f N, %.2f +- %.2f deg; true are %.3f N, %.2f deg",
              o->note[AMPLITUDE], o->note[AMPLITUDE_HALF], o->note[PHASE] / DEG,
              o->note[PHASE_HALF] / DEG, o->amplitude, o->phase / DEG);
    }
}

/* After stop, a trip or the end of a run, the firmware must order no voltage. If a stage that
 * sticks drives the rotor, the enable line must go off within 1 s of the first turn that shows the drive. Such a turn
 * is not slower than the one before or, in a run, exceeds 408 rpm. */
typedef struct {
    double off_since, drives_since, shown, angle_0, last_at, last_took;
    long turns;
    bool ran, from_rest;
} safety;

static void judge_motor(safety *s, const plant *p, outcome *o) {
    const bool on = p->enable > 0.5;
    s->ran = s->ran || o->state == RUNNING || o->state >= SPIN_UP;
    const bool off = p->stop_told || o->state == TRIPPED || o->state == STOPPING ||
                     o->state == COAST || (o->state == IDLE && s->ran);
    s->off_since = off && s->off_since == NEVER ? p->t : s->off_since;
    if (s->off_since < NEVER && on && p->duty > 0) {
        blame(o, &o->on, "duty %.3f in state %d at %.3f s, off since %.3f s", p->duty, o->state,
              p->t, s->off_since);
    }
    if (p->stuck && s->drives_since == NEVER && s->off_since < NEVER) {
        s->drives_since = s->last_at = p->t;
        s->angle_0 = p->y[ANGLE];
        s->from_rest = fabs(p->y[SPEED]) < 1;
    }
    if (s->drives_since < NEVER && p->y[ANGLE] >= s->angle_0 + TURN * (double)(s->turns + 1)) {
        const double took = p->t - s->last_at;
        if (s->shown == NEVER && (s->turns > 0 ? took <= s->last_took * 1.01 : s->from_rest)) {
            s->shown = p->t;
        }
        s->turns++;
        s->last_at = p->t;
        s->last_took = took;
    }
    if (p->turns > 0) {
        o->fastest = fmax(o->fastest, TURN / p->past[(p->turns - 1) % KEPT].seconds / RPM);
    }
    s->shown = p->stuck && on && o->fastest > 408 ? fmin(s->shown, p->t) : s->shown;
    o->shown = s->shown < NEVER;
    if (on && p->stuck && o->shown) {
        o->on_s = p->t - s->shown;
        if (o->on_s > 1) {
            blame(o, &o->on,
                  "enable on 1 s after a turn shows drive, at %.2f s; off: %.2f s; %d, %.0f rpm",
                  s->shown, fmin(s->off_since, 999), o->state, p->y[SPEED] / RPM);
        }
    }
}

static void read_orders(message *m, plant *p, outcome *o, uint32_t *until, uint32_t *watchdog,
                        bool *kicked) {
    double value[FLOATS];
    *until = get(m, 4);
    get(m, 4), get(m, 4), get(m, 4);
    *watchdog = get(m, 4);
    *kicked = (get(m, 1) & 1U) != 0;
    if (get(m, 1) != FLOATS) {
        disagree("%zu bytes of orders", m->n);
    }
    for (int i = 0; i < FLOATS; i++) {
        value[i] = get_float(m);
        if (!isfinite(value[i])) {
            disagree("float %d of orders is %g", i, value[i]);
        }
    }
    p->duty = p->cut ? 0 : fmin(1, fmax(0, value[DUTY]));
    p->enable = p->cut ? 0 : value[ENABLE];
    o->state_before = o->state;
    o->state = (int)value[STATE];
    o->trip = (int)value[TRIP];
    if (o->state == TRIPPED && !o->tripped) {
        o->tripped = true;
        o->trip_state = o->state_before;
    }
    if (o->turns == 0 && value[MEASURED] > 0) {
        memcpy(o->note, value, sizeof value);
        o->turns = (int)value[MEASURED];
        o->quality = (int)value[QUALITY];
        judge_result(p, o);
    }
}

static void watch(event *e, double t, int state, bool stopped) {
    if (e->at == NEVER &&
        (e->state == BY_TIME || e->state == state || (e->state == AFTER_STOP && stopped))) {
        e->at = e->state == BY_TIME ? e->delay : t + e->delay;
    }
}

/* Runs the plant until its timer shows `until`. Writes the readings of its sensors into the message. */
static void advance(plant *p, const hello *h, uint32_t until, bool recording, message *m) {
    message taken = {.n = 0};
    uint32_t edges = 0, samples = 0;
    const int32_t ahead = (int32_t)(until - (h->start + (uint32_t)p->now_us));
    const uint64_t end = p->now_us + (uint64_t)(ahead > 0 ? ahead : 0);
    while (p->now_us < end) {
        uint64_t to = (p->now_us / STEP_US + 1) * STEP_US; /* samples are on this grid, too */
        to = to < end ? to : end;
        plant_step(p, (double)(to - p->now_us) * 1e-6);
        p->now_us = to;
        p->t = (double)to * 1e-6;
        p->pressed = p->t >= p->b->stop.at && p->t < p->b->release.at;
        p->stopped = p->stopped || p->pressed;
        p->stuck = p->t >= p->b->stuck.at;
        p->cut = p->cut || (p->watchdog_us > 0 && to - p->kicked_us > p->watchdog_us);
        p->duty = p->cut ? 0 : p->duty;
        p->enable = p->cut ? 0 : p->enable;
        for (int i = 0; i < h->samples && to % 2000 == 0 && samples < MOST_SAMPLES; i++) {
            if ((i > 2 && to % 100000 != 0) || (i == 0 && p->t >= p->b->silent.at)) {
                continue;
            }
            const double value = plant_sample(p, i, recording);
            const double held = fmin(fmax(value, h->low[i]), h->high[i]);
            put(&taken, h->start + (uint32_t)to, 4);
            put(&taken, (uint32_t)(int32_t)nearbyint(held / h->per_count[i]), 4);
            put(&taken, (uint32_t)i, 1);
            put(&taken, value >= h->high[i] || value <= h->low[i], 1);
            samples++;
            p->stop_told = p->stop_told || (i == 2 && p->pressed);
        }
    }
    m->n = 11;
    for (; edges < MOST_EDGES && p->queued > 0 && p->queue[0].seconds <= p->t; edges++) {
        put(m, h->start + (uint32_t)(uint64_t)(p->queue[0].seconds * 1e6), 4);
        put(m, p->queue[0].channel, 1);
        memmove(p->queue, p->queue + 1, (size_t)--p->queued * sizeof p->queue[0]);
    }
    memcpy(m->byte + m->n, taken.byte, taken.n);
    m->n += taken.n;
    m->byte[8] = p->cut;
    m->byte[9] = (uint8_t)edges;
    m->byte[10] = (uint8_t)samples;
}

void run(const char *firmware, bench *b, outcome *o, bool verbose) {
    line l;
    message m;
    hello h;
    plant p;
    uint32_t until = 0;
    safety s = {.off_since = NEVER, .drives_since = NEVER, .shown = NEVER};
    line_start(&l, firmware);
    if (!line_hear(&l, &m)) {
        disagree("%s ends without a hello, status %d", firmware, line_end(&l));
    }
    read_hello(&m, &h);
    plant_start(&p, b);
    until = h.start;
    for (uint32_t sequence = 0;; sequence = (sequence + 1) & 0xFFFFU) {
        advance(&p, &h, until, o->state == RECORD, &m);
        const uint32_t ticks = h.start + (uint32_t)p.now_us;
        const size_t n = m.n;
        m.n = 0;
        put(&m, 1, 1);
        put(&m, READINGS, 1);
        put(&m, sequence, 2);
        put(&m, ticks, 4);
        m.n = n;
        line_say(&l, &m);
        uint32_t kind = REMEMBER;
        while (kind == REMEMBER && !o->ended) {
            o->ended = !line_hear(&l, &m);
            kind = o->ended ? 0 : get(&m, 1);
        }
        if (o->ended) {
            break;
        }
        if (kind != ORDERS || get(&m, 2) != sequence || get(&m, 4) != ticks) {
            disagree("kind %u in place of orders %u at %u", kind, sequence, ticks);
        }
        bool kicked = false;
        read_orders(&m, &p, o, &until, &p.watchdog_us, &kicked);
        p.kicked_us = kicked ? p.now_us : p.kicked_us;
        if (o->state != o->state_before && verbose) {
            printf("%9.3f s  state %d, trip %d, %.1f rpm, enable %.0f\n", p.t, o->state, o->trip,
                   p.y[SPEED] / RPM, p.enable);
        }
#define X(name) watch(&b->name, p.t, o->state, p.stopped);
        EVENTS(X)
#undef X
        judge_motor(&s, &p, o);
        if (p.t > 300 || p.t > b->stuck.at + 60 || o->on) {
            break;
        }
    }
    if (p.enable > 0.5 && (p.stuck || p.duty > 0)) {
        blame(o, &o->on, "%s at %.3f s with enable on, duty %.3f, state %d%s",
              o->ended ? "ends" : "does not end", p.t, p.duty, o->state, p.stuck ? ", stuck" : "");
    }
    o->status = line_end(&l);
    if (o->ended && (o->status < 0 || o->status > 2)) {
        disagree("the firmware ends with status %d", o->status);
    }
    o->seconds = p.t;
    o->energy_off = p.energy_off;
    o->peak_high = p.peak_high;
    o->peak_low = p.peak_low;
}
