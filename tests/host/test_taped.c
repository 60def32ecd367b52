/* test_taped.c: tapes that no run has made: channels that their hello does not have, words that would break a row, times
 * beyond a wrap of the timer. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/exchange.h"
#include "host/pil/taped.h"

#include "unity.h"

void suite_taped(void);

static char name[] = "/tmp/whirl_taped_XXXXXX";
static char rows[8192];
static unsigned first;   /* signal of the hello, in its order below */
static int reset_before; /* which turn, or -1; by the watchdog */

static void write_frame(FILE *to, uint8_t kind, uint16_t sequence, uint32_t ticks,
                        const uint8_t *payload, unsigned length) {
    uint8_t coded[WH_FRAME_BYTES(1024U)];
    const wh_frame frame = {
        .kind = kind, .sequence = sequence, .ticks = ticks, .payload = payload, .length = length};
    const unsigned count = wh_frame_write(&frame, coded, sizeof coded);
    TEST_ASSERT_TRUE(count > 0 && fwrite(coded, 1, count, to) == count);
}

/* An output, a note, an edge and a sample, at 1 kHz; `turns` exchanges a second apart with these readings. */
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

/* Into `rows`; what is said on standard error is the caller's affair. */
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
    .edge = {{.ticks = UINT32_MAX, .channel = 0}}, /* a tick before */
    .sample = {{.ticks = UINT32_MAX - 2U, .raw = -3, .channel = 0},
               {.raw = 5, .channel = 0, .status = WH_SAMPLE_DISCONNECTED}}};

/* Whatever stands first in the hello: of each kind there is one. */
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
    static const unsigned firsts[] = {
        0, 2, 3}; /* what is set comes in the hello's order: the output, the note */
    for (unsigned i = 0; i < sizeof firsts / sizeof firsts[0]; i++) {
        first = firsts[i];
        write_tape("push", &heard, 2, 3);
        TEST_ASSERT_TRUE(show());
        TEST_ASSERT_EQUAL_STRING(wanted, rows);
    }
    first = 0;
}

/* Its timer begins anew, and what was set is told again. */
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

void suite_taped(void) {
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
