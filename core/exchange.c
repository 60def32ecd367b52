/* exchange.c: writes and reads the payloads of exchange.h, field by field. */
#include "exchange.h"

static unsigned written(const wh_bytes *out) { return out->over ? 0 : out->at; }
static bool is_read(const wh_bytes *in) { return !in->over && in->at == in->room; }

unsigned wh_hello_put(const wh_hello *hello, uint8_t *bytes, unsigned room) {
    wh_bytes out = {.to = bytes, .room = room};
    wh_bytes_put_words(&out, hello->program);
    wh_bytes_put_words(&out, hello->board);
    wh_bytes_put(&out, hello->ticks_per_s, 4);
    wh_bytes_put(&out, hello->timer_per_s, 4);
    wh_bytes_put(&out, hello->start_ticks, 4);
    wh_bytes_put(&out, hello->signals, 1);
    for (unsigned i = 0; i < hello->signals; i++) {
        const wh_signal *s = &hello->signal[i];
        wh_bytes_put(&out, (uint32_t)s->kind, 1);
        wh_bytes_put_words(&out, s->name);
        wh_bytes_put_words(&out, s->unit);
        wh_bytes_put_float(&out, s->low);
        wh_bytes_put_float(&out, s->high);
        wh_bytes_put_float(&out, s->per_count);
        wh_bytes_put(&out, s->period_ticks, 4);
    }
    return written(&out);
}

bool wh_hello_get(wh_hello *hello, wh_signal *signal, const uint8_t *bytes, unsigned length) {
    wh_bytes in = {.from = bytes, .room = length};
    hello->program = wh_bytes_get_words(&in);
    hello->board = wh_bytes_get_words(&in);
    hello->ticks_per_s = wh_bytes_get(&in, 4);
    hello->timer_per_s = wh_bytes_get(&in, 4);
    hello->start_ticks = wh_bytes_get(&in, 4);
    hello->signals = (unsigned)wh_bytes_get(&in, 1);
    hello->signal = signal;
    if (hello->signals > WH_SIGNALS_MAX) {
        return false;
    }
    for (unsigned i = 0; i < hello->signals; i++) {
        const uint32_t kind = wh_bytes_get(&in, 1);
        if (kind > WH_SIGNAL_NOTE) {
            return false;
        }
        signal[i].kind = (wh_signal_kind)kind;
        signal[i].name = wh_bytes_get_words(&in);
        signal[i].unit = wh_bytes_get_words(&in);
        signal[i].low = wh_bytes_get_float(&in);
        signal[i].high = wh_bytes_get_float(&in);
        signal[i].per_count = wh_bytes_get_float(&in);
        signal[i].period_ticks = wh_bytes_get(&in, 4);
    }
    return is_read(&in);
}

unsigned wh_orders_put(const wh_orders *orders, uint8_t *bytes, unsigned room) {
    wh_bytes out = {.to = bytes, .room = room};
    wh_bytes_put(&out, orders->until_ticks, 4);
    wh_bytes_put(&out, orders->acted_timer, 4);
    wh_bytes_put(&out, orders->busy_timer, 4);
    wh_bytes_put(&out, orders->step_timer, 4);
    wh_bytes_put(&out, orders->watchdog_ticks, 4);
    wh_bytes_put(&out, orders->flags, 1);
    wh_bytes_put(&out, orders->outputs, 1);
    for (unsigned i = 0; i < orders->outputs; i++) {
        wh_bytes_put_float(&out, orders->output[i]);
    }
    return written(&out);
}

bool wh_orders_get(wh_orders *orders, const uint8_t *bytes, unsigned length) {
    wh_bytes in = {.from = bytes, .room = length};
    orders->until_ticks = wh_bytes_get(&in, 4);
    orders->acted_timer = wh_bytes_get(&in, 4);
    orders->busy_timer = wh_bytes_get(&in, 4);
    orders->step_timer = wh_bytes_get(&in, 4);
    orders->watchdog_ticks = wh_bytes_get(&in, 4);
    orders->flags = (uint8_t)wh_bytes_get(&in, 1);
    orders->outputs = (unsigned)wh_bytes_get(&in, 1);
    if (orders->outputs > WH_SIGNALS_MAX) {
        return false;
    }
    for (unsigned i = 0; i < orders->outputs; i++) {
        orders->output[i] = wh_bytes_get_float(&in);
    }
    return is_read(&in);
}

unsigned wh_readings_put(const wh_readings *readings, uint8_t *bytes, unsigned room) {
    wh_bytes out = {.to = bytes, .room = room};
    wh_bytes_put(&out, readings->flags, 1);
    wh_bytes_put(&out, readings->edges, 1);
    wh_bytes_put(&out, readings->samples, 1);
    for (unsigned i = 0; i < readings->edges; i++) {
        wh_bytes_put(&out, readings->edge[i].ticks, 4);
        wh_bytes_put(&out, readings->edge[i].channel, 1);
    }
    for (unsigned i = 0; i < readings->samples; i++) {
        wh_bytes_put(&out, readings->sample[i].ticks, 4);
        wh_bytes_put(&out, (uint32_t)readings->sample[i].raw, 4);
        wh_bytes_put(&out, readings->sample[i].channel, 1);
        wh_bytes_put(&out, readings->sample[i].status, 1);
    }
    return written(&out);
}

bool wh_readings_get(wh_readings *readings, const uint8_t *bytes, unsigned length) {
    wh_bytes in = {.from = bytes, .room = length};
    readings->flags = (uint8_t)wh_bytes_get(&in, 1);
    readings->edges = (unsigned)wh_bytes_get(&in, 1);
    readings->samples = (unsigned)wh_bytes_get(&in, 1);
    if (readings->edges > WH_EDGES_MAX || readings->samples > WH_SAMPLES_MAX) {
        return false;
    }
    for (unsigned i = 0; i < readings->edges; i++) {
        readings->edge[i].ticks = wh_bytes_get(&in, 4);
        readings->edge[i].channel = (uint8_t)wh_bytes_get(&in, 1);
    }
    for (unsigned i = 0; i < readings->samples; i++) {
        readings->sample[i].ticks = wh_bytes_get(&in, 4);
        readings->sample[i].raw = (int32_t)wh_bytes_get(&in, 4);
        readings->sample[i].channel = (uint8_t)wh_bytes_get(&in, 1);
        readings->sample[i].status = (uint8_t)wh_bytes_get(&in, 1);
    }
    return is_read(&in);
}

unsigned wh_reset_put(const wh_reset *reset, uint8_t *bytes, unsigned room) {
    wh_bytes out = {.to = bytes, .room = room};
    wh_bytes_put(&out, reset->cause, 1);
    for (unsigned i = 0; i < reset->count; i++) {
        wh_bytes_put(&out, reset->remembered[i], 1);
    }
    return written(&out);
}

bool wh_reset_get(wh_reset *reset, const uint8_t *bytes, unsigned length) {
    wh_bytes in = {.from = bytes, .room = length};
    if (length < 1U || length > WH_RESET_BYTES) {
        return false;
    }
    reset->cause = (uint8_t)wh_bytes_get(&in, 1);
    reset->count = length - 1U;
    for (unsigned i = 0; i < reset->count; i++) {
        reset->remembered[i] = (uint8_t)wh_bytes_get(&in, 1);
    }
    return is_read(&in) && (reset->cause == WH_RESET_WATCHDOG || reset->cause == WH_RESET_OTHER);
}
