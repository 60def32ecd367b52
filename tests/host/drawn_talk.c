
#include "test.h"

#include "drawn_talk.h"

#include <sys/socket.h>
#include <unistd.h>

#include "core/hash.h"

drawn_talk talk_drawn;
stream talk_line;
stream talk_on_tape;
lockstep_report talk_report;
lockstep_request talk_request;

static dice die;
static int ends[2];

void talk_die(dice with) { die = with; }
unsigned talk_one_of(unsigned count) { return dice_one_of(&die, count); }

static uint32_t drawn_32(void) {
    return dice_one_of(&die, 65536U) << 16 | dice_one_of(&die, 65536U);
}
static float drawn_float(void) { return (float)dice_between(&die, -100.0, 100.0); }

void talk_draw(void) {
    static const char *const names[] = {"a", "b", "load", "slot", "speed", "c7", "x"};
    talk_drawn = (drawn_talk){.hello = {.program = "drawn",
                                        .board = "of no kind",
                                        .ticks_per_s = 1000000,
                                        .timer_per_s = 25000000,
                                        .start_ticks = drawn_32(),
                                        .signal = talk_drawn.signal}};
    talk_drawn.hello.signals = 2 + dice_one_of(&die, 5);
    for (unsigned i = 0; i < talk_drawn.hello.signals; i++) {
        const wh_signal_kind kind =
            i == 0 ? WH_SIGNAL_OUTPUT : (wh_signal_kind)dice_one_of(&die, 4);
        talk_drawn.signal[i] = (wh_signal){.kind = kind,
                                           .name = names[i],
                                           .unit = "N",
                                           .low = drawn_float(),
                                           .high = 200.0F,
                                           .per_count = 0.5F,
                                           .period_ticks = 1000};
        talk_drawn.notes += kind == WH_SIGNAL_NOTE;
        talk_drawn.outputs += kind == WH_SIGNAL_NOTE || kind == WH_SIGNAL_OUTPUT;
    }
    talk_drawn.turns = 2 + dice_one_of(&die, TURNS_MOST - 1);
    for (unsigned i = 0; i < talk_drawn.turns; i++) {
        talk_drawn.ticks[i] = talk_drawn.hello.start_ticks + 1000U * i + dice_one_of(&die, 1000);
        talk_drawn.readings[i].flags = (uint8_t)dice_one_of(&die, 2);
        talk_drawn.orders[i] = (wh_orders){.until_ticks = drawn_32(),
                                           .acted_timer = drawn_32(),
                                           .busy_timer = drawn_32(),
                                           .step_timer = drawn_32(),
                                           .watchdog_ticks = drawn_32(),
                                           .flags = (uint8_t)dice_one_of(&die, 2),
                                           .outputs = talk_drawn.outputs};
        for (unsigned k = 0; k < talk_drawn.outputs; k++) {
            talk_drawn.orders[i].output[k] = drawn_float();
        }
        talk_drawn.remembers[i] =
            dice_one_of(&die, 3) == 0 ? dice_one_of(&die, WH_REMEMBER_MAX + 1U) : 99;
        for (unsigned k = 0; k < WH_REMEMBER_MAX; k++) {
            talk_drawn.remembered[i][k] = (uint8_t)drawn_32();
        }
    }
}

void talk_put(stream *s, unsigned kind, unsigned sequence, uint32_t ticks, const uint8_t *payload,
              unsigned length) {
    const wh_frame frame = {.kind = (uint8_t)kind,
                            .sequence = (uint16_t)sequence,
                            .ticks = ticks,
                            .payload = payload,
                            .length = length};
    const unsigned count = wh_frame_write(&frame, s->bytes + s->length, STREAM - s->length);
    TEST_ASSERT_TRUE(count > 0);
    s->length += count;
}

void talk_put_hello(stream *s, const wh_hello *hello) {
    uint8_t payload[1000];
    talk_put(s, WH_FRAME_HELLO, 0, 0, payload, wh_hello_put(hello, payload, sizeof payload));
}

void talk_put_readings(stream *s, unsigned i) {
    uint8_t payload[WH_READINGS_BYTES];
    talk_put(s, WH_FRAME_READINGS, i, talk_drawn.ticks[i], payload,
             wh_readings_put(&talk_drawn.readings[i], payload, sizeof payload));
}

void talk_put_orders(stream *s, unsigned i, unsigned sequence) {
    uint8_t payload[WH_ORDERS_BYTES];
    if (talk_drawn.remembers[i] != 99) {
        talk_put(s, WH_FRAME_REMEMBER, sequence, 7, talk_drawn.remembered[i],
                 talk_drawn.remembers[i]);
    }
    talk_put(s, WH_FRAME_ORDERS, sequence, 9, payload,
             wh_orders_put(&talk_drawn.orders[i], payload, sizeof payload));
}

void talk_put_end(stream *s, int status, unsigned length) {
    uint8_t payload[8] = {0};
    wh_bytes out = {.to = payload, .room = sizeof payload};
    wh_bytes_put(&out, (uint32_t)status, 4);
    talk_put(s, WH_FRAME_END, 0, 0, payload, length);
}

static void begin_line(void) {
    talk_line.length = 0;
    talk_put_hello(&talk_line, &talk_drawn.hello);
    if (dice_one_of(&die, 2) == 0) { /* a firmware that was asked twice says hello twice */
        talk_put_hello(&talk_line, &talk_drawn.hello);
    }
}

void talk_tape_all(unsigned turns) {
    talk_on_tape.length = 0;
    talk_put_hello(&talk_on_tape, &talk_drawn.hello);
    for (unsigned i = 0; i < turns; i++) {
        talk_put_readings(&talk_on_tape, i);
        talk_put_orders(&talk_on_tape, i, i);
    }
}

void talk_say_all(unsigned turns) {
    begin_line();
    for (unsigned i = 0; i < turns; i++) {
        talk_put_orders(&talk_line, i, i);
    }
}

void talk_open_line(bool closed) {
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_STREAM, 0, ends));
    TEST_ASSERT_EQUAL_INT64(talk_line.length, write(ends[1], talk_line.bytes, talk_line.length));
    if (closed) {
        TEST_ASSERT_EQUAL_INT(0, shutdown(ends[1], SHUT_WR));
    }
    talk_request =
        (lockstep_request){.guest = {.by_line = true, .line = ends[0], .patience_s = 0.05}};
    talk_report = (lockstep_report){.end = LOCKSTEP_DONE};
}

void talk_close_line(stream *heard) {
    close(ends[0]);
    heard->length = 0;
    for (ssize_t count = 1; count > 0;) {
        count = read(ends[1], heard->bytes + heard->length, STREAM - heard->length);
        heard->length += count > 0 ? (unsigned)count : 0;
    }
    close(ends[1]);
}

uint64_t talk_hash_of(unsigned turns) {
    uint64_t hash = WH_HASH_START;
    for (unsigned i = 0; i < turns; i++) {
        const wh_orders *o = &talk_drawn.orders[i];
        if (talk_drawn.remembers[i] != 99) {
            hash = wh_hash_u64(hash, talk_drawn.remembers[i]);
            for (unsigned k = 0; k < talk_drawn.remembers[i]; k++) {
                hash = wh_hash_u64(hash, talk_drawn.remembered[i][k]);
            }
        }
        hash = wh_hash_u64(wh_hash_u64(wh_hash_u64(hash, o->until_ticks), o->watchdog_ticks),
                           o->flags);
        for (unsigned k = 0; k < o->outputs; k++) {
            uint32_t bits;
            memcpy(&bits, &o->output[k], sizeof bits);
            hash = wh_hash_u64(hash, bits);
        }
    }
    return hash;
}

void talk_expect_report(lockstep_end end, unsigned turns) {
    TEST_ASSERT_EQUAL_INT(end, talk_report.end);
    TEST_ASSERT_EQUAL_UINT64(turns, talk_report.exchanges);
    TEST_ASSERT_EQUAL_HEX64(talk_hash_of(turns), talk_report.hash);
    TEST_ASSERT_EQUAL_STRING("drawn", talk_report.program);
    TEST_ASSERT_EQUAL_STRING("of no kind", talk_report.board);
    TEST_ASSERT_EQUAL_UINT(talk_drawn.notes, talk_report.notes);
    for (unsigned i = 0; i < talk_drawn.notes && turns > 0; i++) {
        TEST_ASSERT_TRUE(
            talk_report.note[i].value ==
            (double)talk_drawn.orders[turns - 1].output[talk_drawn.outputs - talk_drawn.notes + i]);
        TEST_ASSERT_EQUAL_STRING("N", talk_report.note[i].unit);
    }
    for (unsigned i = 0, note = 0; i < talk_drawn.hello.signals; i++) {
        if (talk_drawn.signal[i].kind == WH_SIGNAL_NOTE) {
            TEST_ASSERT_EQUAL_STRING(talk_drawn.signal[i].name, talk_report.note[note++].name);
        }
    }
}
