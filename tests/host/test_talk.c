/* test_talk.c: a random firmware on a line (host/pil/lockstep.h). Messages that the host receives, stores and hashes
 * are compared with those sent, and each error of a firmware must have its message. Also tapes. */
#include <unistd.h>

#include "core/cobs.h"
#include "core/exchange.h"
#include "host/base/alloc.h"
#include "host/os/system.h"
#include "host/pil/lockstep.h"

#include "drawn_talk.h"
#include "test.h"

/* === suite talk =============================================================================== */

static void expect_same(const stream *wanted, const uint8_t *bytes, size_t length) {
    TEST_ASSERT_EQUAL_size_t(wanted->length, length);
    TEST_ASSERT_TRUE(memcmp(wanted->bytes, bytes, length) == 0);
}

/* The host must first request the hello, store everything on a tape, and answer the end with the same word. */
TEST(talk, answers_are_stored_on_tape) {
    for (unsigned c = 0; c < dice_cases(usual_or(30, 12)); c++) {
        static talk t;
        static stream heard;
        static stream wanted;
        char *kept = NULL;
        size_t length = 0;
        talk_draw();
        talk_tape_all(talk_drawn.turns);
        talk_say_all(talk_drawn.turns);
        const int status = (int)talk_one_of(256) - 128;
        talk_put_end(&talk_line, status, 4);
        talk_open_line(true);
        FILE *onto = alloc_text(&kept, &length);
        errors_catch();
        TEST_ASSERT_TRUE(talk_start(&t, &talk_request, &talk_report, onto));
        TEST_ASSERT_EQUAL_UINT(talk_drawn.outputs, t.outputs);
        TEST_ASSERT_TRUE(talk_is_same_hello(&talk_drawn.hello, &t.hello));
        for (unsigned i = 0; i < talk_drawn.turns; i++) {
            wh_orders orders;
            TEST_ASSERT_TRUE(talk_tell(&t, talk_drawn.ticks[i], &talk_drawn.readings[i]) &&
                             talk_hear(&t, &orders));
            TEST_ASSERT_EQUAL_HEX32(talk_drawn.orders[i].until_ticks, orders.until_ticks);
            TEST_ASSERT_EQUAL_HEX32(talk_drawn.orders[i].busy_timer, orders.busy_timer);
            talk_expect_report(LOCKSTEP_DONE, i + 1U);
            if (talk_drawn.remembers[i] != 99) {
                TEST_ASSERT_EQUAL_UINT(talk_drawn.remembers[i], t.remembered.count);
                TEST_ASSERT_TRUE(memcmp(t.remembered.remembered, talk_drawn.remembered[i],
                                        talk_drawn.remembers[i]) == 0);
            }
        }
        wh_orders none;
        TEST_ASSERT_FALSE(talk_hear(&t, &none));
        talk_end(&t);
        TEST_ASSERT_EQUAL_STRING("", errors_caught());
        talk_expect_report(LOCKSTEP_DONE, talk_drawn.turns);
        TEST_ASSERT_EQUAL_INT(status, talk_report.status.status);
        alloc_text_end(onto);
        expect_same(&talk_on_tape, (const uint8_t *)kept, length); /* taped as sent */
        free(kept);
        wanted.length = 0;
        talk_put(&wanted, WH_FRAME_ASK, 0, 0, NULL, 0);
        for (unsigned i = 0; i < talk_drawn.turns; i++) {
            talk_put_readings(&wanted, i);
        }
        talk_put(&wanted, WH_FRAME_ASK, 0, 0, NULL, 0);
        talk_close_line(&heard);
        expect_same(&wanted, heard.bytes, heard.length);
    }
}

/* After a good hello and a first exchange, the second exchange must end with this error. The line must contain what
 * the firmware sends. */
static void expect_unheard(lockstep_end end, const char *why, bool closed) {
    static talk t;
    static stream heard;
    wh_orders orders;
    talk_open_line(closed);
    errors_catch();
    TEST_ASSERT_TRUE(talk_start(&t, &talk_request, &talk_report, NULL));
    TEST_ASSERT_TRUE(talk_tell(&t, talk_drawn.ticks[0], &talk_drawn.readings[0]) &&
                     talk_hear(&t, &orders));
    TEST_ASSERT_FALSE(talk_tell(&t, talk_drawn.ticks[1], &talk_drawn.readings[1]) &&
                      talk_hear(&t, &orders));
    talk_end(&t);
    const char *told = errors_caught();
    TEST_ASSERT_EQUAL_INT(end, talk_report.end);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, why), told);
    const char *error = strstr(told, "error: ");
    TEST_ASSERT_TRUE_MESSAGE(error == NULL || strstr(error + 1, "error: ") == NULL, "told once");
    TEST_ASSERT_EQUAL_UINT64(1, talk_report.exchanges);
    talk_close_line(&heard);
}

/* Encodes the last frame of the line again, with another version. */
static void make_version(uint8_t version, unsigned from) {
    uint8_t plain[2000];
    uint8_t room[2000];
    wh_frame frame = {.length = 0};
    wh_frame_reader reader;
    wh_frame_reader_start(&reader, room, sizeof room);
    for (unsigned i = from; i < talk_line.length; i++) {
        (void)wh_frame_take(&reader, talk_line.bytes[i], &frame);
    }
    wh_bytes out = {.to = plain, .room = sizeof plain};
    wh_bytes_put(&out, version, 1);
    wh_bytes_put(&out, frame.kind, 1);
    wh_bytes_put(&out, frame.sequence, 2);
    wh_bytes_put(&out, frame.ticks, 4);
    TEST_ASSERT_TRUE(frame.payload != NULL && frame.length < sizeof plain / 2);
    for (unsigned i = 0; frame.payload != NULL && i < frame.length; i++) {
        plain[out.at + i] = frame.payload[i];
    }
    out.at += frame.length;
    wh_bytes_put(&out, wh_frame_crc(0, plain, out.at), 4);
    wh_cobs cobs;
    wh_cobs_start(&cobs, talk_line.bytes + from, STREAM - from);
    for (unsigned i = 0; i < out.at; i++) {
        wh_cobs_put(&cobs, plain[i]);
    }
    talk_line.length = from + wh_cobs_end(&cobs);
}

TEST(talk, wrong_words) {
    static const struct {
        lockstep_end end;
        const char *why;
    } rows[] = {
        {LOCKSTEP_FAILED, "error: the firmware sent a message that is not an answer in exchange "
                          "1\n"},
        {LOCKSTEP_FAILED, "a message that is not an answer in exchange 1\n"},
        {LOCKSTEP_FAILED, "invalid orders in exchange 1\n"},
        {LOCKSTEP_FAILED, "invalid orders in exchange 1\n"},
        {LOCKSTEP_FAILED, "too many bytes to keep over a reset in exchange 1\n"},
        {LOCKSTEP_FAILED, "an invalid end message in exchange 1\n"},
        {LOCKSTEP_FAILED, "whirl pil: error: the serial line is disconnected\n"},
        {LOCKSTEP_BAD, "the firmware uses version 2 of the protocol, but whirl uses version 1\n"},
        {LOCKSTEP_FAILED, "a message that is not an answer in exchange 1\n"},
        {LOCKSTEP_DONE, ""},
        {LOCKSTEP_FAILED, "the firmware has sent no message for 0.05 s\n"},
    };
    enum { SILENT = sizeof rows / sizeof rows[0] - 1 };
    for (unsigned c = 0; c < dice_cases(usual_or(30, 22)); c++) {
        uint8_t payload[WH_ORDERS_BYTES + 4];
        const unsigned way = c % (SILENT + 1);
        if (way == SILENT && c > SILENT) {
            continue; /* tried once, because waiting takes long */
        }
        talk_draw();
        talk_drawn.remembers[1] = 99;
        talk_say_all(1);
        const unsigned from = talk_line.length;
        const unsigned length = wh_orders_put(&talk_drawn.orders[1], payload, sizeof payload);
        switch (way) {
        case 0: talk_put_orders(&talk_line, 1, 2); break;
        case 1: talk_put(&talk_line, WH_FRAME_READINGS, 1, 0, payload, length); break;
        case 2: talk_put(&talk_line, WH_FRAME_ORDERS, 1, 0, payload, length - 1U); break;
        case 3:
            talk_drawn.orders[1].outputs++;
            talk_put_orders(&talk_line, 1, 1);
            break;
        case 4:
            talk_put(&talk_line, WH_FRAME_REMEMBER, 1, 0, talk_drawn.remembered[1],
                     WH_REMEMBER_MAX + 1U);
            talk_put_orders(&talk_line, 1, 1);
            break;
        case 5: talk_put_end(&talk_line, 0, talk_one_of(2) == 0 ? 3 : 5); break;
        case 7:
            talk_put_orders(&talk_line, 1, 1);
            make_version(WH_FRAME_VERSION + 1U, from);
            break;
        case 8: talk_put_hello(&talk_line, &talk_drawn.hello); break;
        case 9: talk_put_end(&talk_line, 3, 4); break;
        }
        expect_unheard(rows[way].end, rows[way].why, way != SILENT);
        TEST_ASSERT_TRUE(rows[way].end != LOCKSTEP_DONE || talk_report.status.status == 3);
    }
}

/* A hello that is missing, malformed or without a clock must close the line. Words from before a good hello must be
 * ignored. */
TEST(talk, hellos) {
    for (unsigned c = 0; c < 5; c++) {
        static talk t;
        static stream heard;
        static const char *const words[] = {
            "the firmware's first message (hello) has not come over the line in 0.05 s\n",
            "the firmware sent an invalid hello in exchange 0\n",
            "the firmware sent an invalid hello in exchange 0\n", "", ""};
        static const lockstep_end why[] = {LOCKSTEP_BAD, LOCKSTEP_FAILED, LOCKSTEP_FAILED,
                                           LOCKSTEP_DONE, LOCKSTEP_STOPPED};
        talk_draw();
        talk_line.length = 0;
        talk_put_orders(&talk_line, 0, 0);
        talk_put_end(&talk_line, 0, 4);
        talk_drawn.hello.ticks_per_s = c == 2 ? 0 : 1000000;
        if (c == 1) {
            talk_put(&talk_line, WH_FRAME_HELLO, 0, 0, talk_drawn.remembered[0], 20);
        } else if (c == 2 || c == 3) {
            talk_put_hello(&talk_line, &talk_drawn.hello);
        }
        talk_open_line(c != 4);
        interrupted = c == 4;
        errors_catch();
        const bool good = talk_start(&t, &talk_request, &talk_report, NULL);
        const char *told = errors_caught();
        interrupted = 0;
        TEST_ASSERT_TRUE(good == (c == 3));
        TEST_ASSERT_EQUAL_INT(why[c], talk_report.end);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, words[c]), told);
        TEST_ASSERT_TRUE(c != 3 || t.guest.request.patience_s == 0.05);
        talk_close_line(&heard);
    }
}

TEST(talk, interrupted) {
    for (int closed = 0; closed < 2; closed++) {
        static talk t;
        static stream heard;
        wh_orders orders;
        talk_draw();
        talk_say_all(1);
        talk_open_line(closed == 1);
        talk_request.guest.patience_s = 20.0;
        errors_catch();
        TEST_ASSERT_TRUE(talk_start(&t, &talk_request, &talk_report, NULL));
        TEST_ASSERT_TRUE(talk_hear(&t, &orders));
        interrupted = 1;
        TEST_ASSERT_FALSE(talk_hear(&t, &orders));
        talk_end(&t);
        interrupted = 0;
        TEST_ASSERT_EQUAL_STRING("", errors_caught());
        TEST_ASSERT_EQUAL_INT(LOCKSTEP_STOPPED, talk_report.end);
        talk_close_line(&heard);
    }
}

TEST(talk, no_reset) {
    static talk t;
    static stream heard;
    talk_draw();
    talk_say_all(0);
    talk_open_line(true);
    errors_catch();
    TEST_ASSERT_TRUE(talk_start(&t, &talk_request, &talk_report, NULL));
    TEST_ASSERT_FALSE(talk_restart(&t, 5, &(wh_reset){.cause = WH_RESET_WATCHDOG}));
    const char *told = errors_caught();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, "a reset, which is not possible"), told);
    TEST_ASSERT_EQUAL_INT(LOCKSTEP_FAILED, talk_report.end);
    talk_close_line(&heard);
}

/* A change of any relevant field must make a hello another one. The name and the counts are not relevant. */
TEST(talk, same_hello) {
    for (unsigned c = 0; c < dice_cases(usual_or(40, 20)); c++) {
        wh_signal signal[WH_SIGNALS_MAX];
        talk_draw();
        for (int change = 0; change < 14; change++) {
            wh_hello other = talk_drawn.hello;
            memcpy(signal, talk_drawn.signal, sizeof signal);
            other.signal = signal;
            wh_signal *s = &signal[talk_one_of(talk_drawn.hello.signals)];
            switch (change) {
            case 0: break;
            case 1: other.board = "another"; break;
            case 2: other.timer_per_s++; break;
            case 3: other.program = "another"; break;
            case 4: other.ticks_per_s++; break;
            case 5: other.start_ticks++; break;
            case 6: other.signals--; break;
            case 7: s->kind = s->kind == WH_SIGNAL_EDGE ? WH_SIGNAL_SAMPLE : WH_SIGNAL_EDGE; break;
            case 8: s->name = "another"; break;
            case 9: s->unit = "m"; break;
            case 10: s->low = nextafterf(s->low, 0.0F); break;
            case 11: s->high = nextafterf(s->high, 0.0F); break;
            case 12: s->per_count = nextafterf(s->per_count, 0.0F); break;
            default: s->period_ticks++;
            }
            TEST_ASSERT_EQUAL(change < 3, talk_is_same_hello(&talk_drawn.hello, &other));
            TEST_ASSERT_EQUAL(change < 3, talk_is_same_hello(&other, &talk_drawn.hello));
        }
        /* an instruction takes 64 ns */
        const double per_s = 1e3 + 1e4 * talk_one_of(100000);
        talk_drawn.hello.timer_per_s = (uint32_t)per_s;
        TEST_ASSERT_TRUE(fabs(talk_instructions_per_count(&talk_drawn.hello) *
                                  (double)talk_drawn.hello.timer_per_s -
                              15625000.0) < 1.0);
        talk_drawn.hello.timer_per_s = 0;
        TEST_ASSERT_TRUE(talk_instructions_per_count(&talk_drawn.hello) == 0.0);
    }
}

SUITE(talk) { talk_die(dice_of("talk", 49)); }

/* === suite taped ============================================================================== */
/* Invalid tapes: channels that their hello does not have, words that would break a row, times beyond a wrap of the
 * timer. */

static char name[] = "/tmp/whirl_taped_XXXXXX";
static char rows[8192];
static unsigned first;   /* number of the hello's first signal in the list of write_tape() */
static int reset_before; /* the watchdog resets the processor before this exchange; -1: never */

static void write_frame(FILE *to, uint8_t kind, uint16_t sequence, uint32_t ticks,
                        const uint8_t *payload, unsigned length) {
    uint8_t coded[WH_FRAME_BYTES(1024U)];
    const wh_frame frame = {
        .kind = kind, .sequence = sequence, .ticks = ticks, .payload = payload, .length = length};
    const unsigned count = wh_frame_write(&frame, coded, sizeof coded);
    TEST_ASSERT_TRUE(count > 0 && fwrite(coded, 1, count, to) == count);
}

/* Writes a tape at 1 kHz with an output, a note, an edge and a sample. It has `turns` exchanges, one second apart,
 * with these readings. */
static void write_tape(const char *word, const wh_readings *readings, unsigned outputs,
                       unsigned turns) {
    const wh_signal each[] = {{.kind = WH_SIGNAL_OUTPUT, .name = word, .unit = "1"},
                              {.kind = WH_SIGNAL_NOTE, .name = "state", .unit = word},
                              {.kind = WH_SIGNAL_EDGE, .name = word, .unit = "rad"},
                              {.kind = WH_SIGNAL_SAMPLE,
                               .name = "load",
                               .unit = "N",
                               .per_count = 0.5f,
                               .period_ticks = 1}};
    wh_signal signal[4];
    for (unsigned i = 0; i < 4U; i++) {
        signal[i] = each[(first + i) % 4U];
    }
    const wh_hello hello = {.program = "made up",
                            .board = "none",
                            .ticks_per_s = 1000,
                            .start_ticks = UINT32_MAX - 499U,
                            .signal = signal,
                            .signals = 4};
    uint8_t payload[1024];
    FILE *to = fopen(name, "wb");
    TEST_ASSERT_NOT_NULL(to);
    write_frame(to, WH_FRAME_HELLO, 0, 0, payload, wh_hello_put(&hello, payload, sizeof payload));
    uint32_t ticks = hello.start_ticks;
    uint16_t sequence = 0;
    for (unsigned i = 0; i < turns; i++, ticks += 1000U, sequence++) {
        if ((int)i == reset_before) {
            const wh_reset reset = {.cause = WH_RESET_WATCHDOG};
            write_frame(to, WH_FRAME_HELLO, 0, ticks, payload,
                        wh_hello_put(&hello, payload, sizeof payload));
            write_frame(to, WH_FRAME_RESET, 0, ticks, payload,
                        wh_reset_put(&reset, payload, sizeof payload));
            ticks = hello.start_ticks;
            sequence = 0;
        }
        wh_readings heard = *readings;
        for (unsigned k = 0; k < heard.edges; k++) {
            heard.edge[k].ticks += ticks;
        }
        for (unsigned k = 0; k < heard.samples; k++) {
            heard.sample[k].ticks += ticks;
        }
        write_frame(to, WH_FRAME_READINGS, sequence, ticks, payload,
                    wh_readings_put(&heard, payload, sizeof payload));
        const wh_orders orders = {.outputs = outputs, .output = {0.25f, 3.0f, 0.0f}};
        write_frame(to, WH_FRAME_ORDERS, sequence, ticks, payload,
                    wh_orders_put(&orders, payload, sizeof payload));
    }
    fclose(to);
}

/* Writes the tape's rows to `rows`. The caller handles standard error. */
static bool show(void) {
    char csv[sizeof name + 4];
    snprintf(csv, sizeof csv, "%s.csv", name);
    const bool good = taped_show(name, csv);
    FILE *from = fopen(csv, "rb");
    TEST_ASSERT_NOT_NULL(from);
    rows[fread(rows, 1, sizeof rows - 1, from)] = '\0';
    fclose(from);
    (void)remove(csv);
    return good;
}

static const wh_readings heard = {
    .edges = 1,
    .samples = 2,
    .edge = {{.ticks = UINT32_MAX, .channel = 0}}, /* one tick before the reading at 0 */
    .sample = {{.ticks = UINT32_MAX - 2U, .raw = -3, .channel = 0},
               {.raw = 5, .channel = 0, .status = WH_SAMPLE_DISCONNECTED}}};

/* Signals may have any sequence in the hello. Here, there is one of each kind. */
static void test_rows(void) {
    static const char *const wanted = "time,heard,kind,channel,signal,value,unit,status\n"
                                      "-0.003,0.000,sample,1,load,-1.5,N,good\n"
                                      "-0.001,0.000,edge,1,push,,,\n"
                                      "0.000,0.000,sample,1,load,2.5,N,disconnected\n"
                                      "0.000,0.000,output,1,push,0.25,1,\n"
                                      "0.000,0.000,note,1,state,3,push,\n"
                                      "0.997,1.000,sample,1,load,-1.5,N,good\n"
                                      "0.999,1.000,edge,1,push,,,\n"
                                      "1.000,1.000,sample,1,load,2.5,N,disconnected\n"
                                      "1.997,2.000,sample,1,load,-1.5,N,good\n"
                                      "1.999,2.000,edge,1,push,,,\n"
                                      "2.000,2.000,sample,1,load,2.5,N,disconnected\n";
    /* channels in the sequence of the hello: the output, then the note */
    static const unsigned firsts[] = {0, 2, 3};
    for (unsigned i = 0; i < sizeof firsts / sizeof firsts[0]; i++) {
        first = firsts[i];
        write_tape("push", &heard, 2, 3);
        TEST_ASSERT_TRUE(show());
        TEST_ASSERT_EQUAL_STRING(wanted, rows);
    }
    first = 0;
}

static void test_a_reset(void) {
    const char *at = rows;
    unsigned outputs = 0;
    reset_before = 2;
    write_tape("push", &heard, 2, 4);
    reset_before = -1;
    TEST_ASSERT_TRUE(show());
    TEST_ASSERT_NOT_NULL(strstr(rows, "2.000,2.000,reset,,,,,watchdog\n"));
    while ((at = strstr(at, "output,1,push,0.25")) != NULL) {
        outputs++;
        at++;
    }
    TEST_ASSERT_EQUAL_UINT(2, outputs);
}

static void test_words_that_break_rows(void) {
    write_tape("a,b\"c\nd\x7f", &heard, 2, 1);
    TEST_ASSERT_TRUE(show());
    TEST_ASSERT_NOT_NULL(strstr(rows, "output,1,a_b_c_d_,0.25,1,\n"));
    TEST_ASSERT_NOT_NULL(strstr(rows, "edge,1,a_b_c_d_,,,\n"));
    TEST_ASSERT_NOT_NULL(strstr(rows, "note,1,state,3,a_b_c_d_,\n"));
}

static void test_channels_that_are_none(void) {
    wh_readings other = heard;
    other.edge[0].channel = 1;
    write_tape("push", &other, 2, 1);
    TEST_ASSERT_FALSE(show());
    other = heard;
    other.sample[1].channel = 255;
    write_tape("push", &other, 2, 1);
    TEST_ASSERT_FALSE(show());
    write_tape("push", &heard, 1, 1);
    TEST_ASSERT_FALSE(show());
    write_tape("push", &heard, 3, 1);
    TEST_ASSERT_FALSE(show());
    write_tape("push", &heard, 2, 0);
    TEST_ASSERT_TRUE(show());
}

SUITE(taped) {
    const int file = mkstemp(name);
    TEST_ASSERT_TRUE(file >= 0);
    close(file);
    reset_before = -1;
    RUN_TEST(test_rows);
    RUN_TEST(test_a_reset);
    RUN_TEST(test_words_that_break_rows);
    RUN_TEST(test_channels_that_are_none);
    (void)remove(name);
}
