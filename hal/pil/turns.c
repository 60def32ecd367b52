/* turns.c: the controller's side of the exchange. */
#include "turns.h"

#include "hal/link.h"

static void send(hal_turns *turns, uint8_t kind, uint16_t sequence, unsigned length) {
    const wh_frame frame = {.kind = kind,
                            .sequence = sequence,
                            .ticks = turns->ticks,
                            .payload = turns->payload,
                            .length = length};
    const unsigned count = wh_frame_write(&frame, turns->coded, sizeof turns->coded);
    hal_link_write(turns->coded, count);
}

/* Receives the next good frame. A read may return part of a frame, or several frames. */
static void receive(hal_turns *turns, wh_frame *frame) {
    for (;;) {
        while (turns->line_at < turns->line_end) {
            if (wh_frame_take(&turns->reader, turns->line[turns->line_at++], frame)) {
                return;
            }
        }
        turns->line_end = hal_link_read(turns->line, sizeof turns->line);
        turns->line_at = 0;
    }
}

/* Removes the readings before turns->edge and turns->sample, and appends `news`. */
static void keep(hal_turns *turns, const wh_readings *news) {
    wh_readings *all = &turns->readings;
    unsigned edges = 0;
    unsigned samples = 0;
    for (unsigned i = turns->edge; i < all->edges; i++) {
        all->edge[edges++] = all->edge[i];
    }
    for (unsigned i = turns->sample; i < all->samples; i++) {
        all->sample[samples++] = all->sample[i];
    }
    for (unsigned i = 0; i < news->edges; i++) {
        if (edges < WH_EDGES_MAX) {
            all->edge[edges++] = news->edge[i];
        } else {
            turns->lost++;
        }
    }
    for (unsigned i = 0; i < news->samples; i++) {
        if (samples < WH_SAMPLES_MAX) {
            all->sample[samples++] = news->sample[i];
        } else {
            turns->lost++;
        }
    }
    all->flags = news->flags;
    all->edges = edges;
    all->samples = samples;
    turns->edge = 0;
    turns->sample = 0;
}

/* Waits for readings. If hello_bytes > 0, answers each WH_FRAME_ASK meanwhile with the hello in turns->payload. */
static void hear(hal_turns *turns, unsigned hello_bytes) {
    wh_frame frame;
    wh_readings news;
    do {
        receive(turns, &frame);
        /* The plant sends the cause of the start before the first readings. */
        if (frame.version == WH_FRAME_VERSION && frame.kind == WH_FRAME_RESET &&
            !wh_reset_get(&turns->reset, frame.payload, frame.length)) {
            turns->reset = (wh_reset){.cause = WH_RESET_OTHER};
        }
        if (hello_bytes > 0 && frame.kind == WH_FRAME_ASK) {
            send(turns, WH_FRAME_HELLO, 0, hello_bytes);
        }
    } while (frame.version != WH_FRAME_VERSION || frame.kind != WH_FRAME_READINGS ||
             frame.sequence != turns->sequence ||
             !wh_readings_get(&news, frame.payload, frame.length));
    turns->ticks = frame.ticks;
    turns->acted = false;
    keep(turns, &news);
    turns->arrived_timer = hal_link_timer();
}

bool hal_turns_start(hal_turns *turns, const wh_hello *hello) {
    wh_hello full = *hello;
    *turns = (hal_turns){.ticks = hello->start_ticks};
    wh_frame_reader_start(&turns->reader, turns->frame, sizeof turns->frame);
    for (unsigned i = 0; i < hello->signals; i++) {
        turns->outputs += hello->signal[i].kind == WH_SIGNAL_OUTPUT;
        turns->orders.outputs +=
            hello->signal[i].kind == WH_SIGNAL_OUTPUT || hello->signal[i].kind == WH_SIGNAL_NOTE;
    }
    full.board = hal_link_board();
    full.timer_per_s = hal_link_timer_per_s();
    const unsigned length = wh_hello_put(&full, turns->payload, sizeof turns->payload);
    if (length == 0 || !hal_link_open()) {
        return false;
    }
    hal_turns_step_begins(turns);
    hal_turns_step_ends(turns);
    turns->nothing_timer = turns->orders.step_timer;
    turns->orders.step_timer = 0;
    send(turns, WH_FRAME_HELLO, 0, length);
    hear(turns, length);
    return true;
}

void hal_turns_end(hal_turns *turns, int status) {
    wh_bytes bytes = {.to = turns->payload, .room = sizeof turns->payload};
    wh_bytes_put(&bytes, (uint32_t)status, 4);
    send(turns, WH_FRAME_END, turns->sequence, bytes.at);
}

void hal_turns_set(hal_turns *turns, unsigned channel, float value) {
    if (channel < turns->outputs) {
        turns->orders.output[channel] = value;
        turns->orders.acted_timer = hal_link_timer() - turns->arrived_timer;
        turns->acted = true;
    }
}

void hal_turns_note(hal_turns *turns, unsigned channel, float value) {
    if (channel < turns->orders.outputs - turns->outputs) {
        turns->orders.output[turns->outputs + channel] = value;
    }
}

void hal_turns_step_begins(hal_turns *turns) { turns->step_timer = hal_link_timer(); }

void hal_turns_step_ends(hal_turns *turns) {
    const uint32_t took = hal_link_timer() - turns->step_timer - turns->nothing_timer;
    if ((int32_t)(took - turns->orders.step_timer) > 0) {
        turns->orders.step_timer = took;
    }
}

/* This function's duration is not computing time, because real hardware does not send these bytes. */
void hal_turns_remember(hal_turns *turns, const uint8_t *bytes, unsigned count) {
    const uint32_t begun_timer = hal_link_timer();
    const unsigned all = count < WH_REMEMBER_MAX ? count : WH_REMEMBER_MAX;
    for (unsigned i = 0; i < all; i++) {
        turns->payload[i] = bytes[i];
    }
    send(turns, WH_FRAME_REMEMBER, turns->sequence, all);
    turns->arrived_timer += hal_link_timer() - begun_timer;
}

void hal_turns_wait(hal_turns *turns, uint32_t until_ticks) {
    wh_orders *orders = &turns->orders;
    orders->until_ticks = until_ticks;
    orders->busy_timer = hal_link_timer() - turns->arrived_timer;
    if (!turns->acted) {
        orders->acted_timer = orders->busy_timer;
    }
    send(turns, WH_FRAME_ORDERS, turns->sequence,
         wh_orders_put(orders, turns->payload, sizeof turns->payload));
    orders->flags = 0;
    orders->step_timer = 0;
    turns->sequence++;
    hear(turns, 0);
}

bool hal_turns_take_edge(hal_turns *turns, wh_edge *edge) {
    if (turns->edge == turns->readings.edges) {
        return false;
    }
    *edge = turns->readings.edge[turns->edge++];
    return true;
}

bool hal_turns_take_sample(hal_turns *turns, wh_sample *sample) {
    if (turns->sample == turns->readings.samples) {
        return false;
    }
    *sample = turns->readings.sample[turns->sample++];
    return true;
}

void hal_turns_watch(hal_turns *turns, uint32_t timeout_ticks) {
    turns->orders.watchdog_ticks = timeout_ticks;
    hal_turns_alive(turns);
}

void hal_turns_alive(hal_turns *turns) { turns->orders.flags |= WH_ORDER_ALIVE; }

bool hal_turns_is_cut(const hal_turns *turns) {
    return (turns->readings.flags & WH_READING_CUT) != 0;
}
