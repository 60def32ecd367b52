/* test_vcd.c: value change dumps (host/io/vcd.h), read back by a reader of the test's own: drawn changes of many signals,
 * a little out of order, come out in order, each once; what is too late is counted; notes stand behind their signals. */
#include "host/io/vcd.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/base/alloc.h"
#include "unity.h"

void suite_vcd(void);

enum { SIGNALS = 100, CHANGES = 400, VALUE = 40, JITTER = 20 };
typedef enum kind_of { WIRE, REAL, EVENT } kind_of;

/* As it must be printed. */
typedef struct happening {
    int64_t time;
    int signal;
    char value[VALUE];
} happening;

static happening made[CHANGES];
static happening read_back[CHANGES + 1];
static char mark[SIGNALS][8];

static kind_of kind(int signal) { return (kind_of)(signal % 3); }

static void print_value(happening *h, double value) {
    switch (kind(h->signal)) {
    case WIRE:
        snprintf(h->value, VALUE, "%s", isnan(value) ? "x" : value != 0.0 ? "1" : "0");
        break;
    case REAL: snprintf(h->value, VALUE, "r%.4g", value); break;
    case EVENT: snprintf(h->value, VALUE, "1"); break;
    }
}

/* "$var wire 1 ! s0 $end": the marks. Notes: of one character, of several, and none. */
static const char *read_head(const char *text) {
    char line[80];
    for (int i = 0; i < SIGNALS; i++) {
        static const char *const of[] = {"wire 1", "real 64", "event 1"};
        char name[20];
        snprintf(line, sizeof line, "$var %s ", of[kind(i)]);
        snprintf(name, sizeof name, " s%d $end\n", i);
        const char *end = strstr(text, name);
        TEST_ASSERT_NOT_NULL_MESSAGE(end, name);
        const char *begin = end;
        while (begin[-1] != ' ') {
            begin--;
        }
        TEST_ASSERT_TRUE((size_t)(end - begin) < sizeof mark[0]);
        memset(mark[i], 0, sizeof mark[i]);
        memcpy(mark[i], begin, (size_t)(end - begin));
        TEST_ASSERT_EQUAL_STRING_LEN(line, begin - strlen(line), strlen(line));
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_TRUE(strcmp(mark[i], mark[k]) != 0);
        }
        const char *next = end + strlen(name);
        snprintf(line, sizeof line, "$comment %s $end\n", i % 4 == 0 ? "m" : "a note");
        TEST_ASSERT_EQUAL(i % 4 < 2, strncmp(next, line, strlen(line)) == 0);
        TEST_ASSERT_EQUAL(i % 4 < 2, strncmp(next, "$comment", 8) == 0);
    }
    const char *body = strstr(text, "$enddefinitions $end\n");
    TEST_ASSERT_NOT_NULL(body);
    return strchr(body, '\n') + 1;
}

static int signal_of(const char *code) {
    for (int i = 0; i < SIGNALS; i++) {
        if (strcmp(mark[i], code) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(code);
    return -1;
}

/* Times rise. Returns how many changes there are; the last time into *end. */
static int read_changes(const char *at, int64_t *end) {
    int count = 0;
    int64_t now = -1;
    while (*at != '\0') {
        char line[80];
        const char *stop = strchr(at, '\n');
        TEST_ASSERT_NOT_NULL(stop);
        TEST_ASSERT_TRUE((size_t)(stop - at) < sizeof line);
        memcpy(line, at, (size_t)(stop - at));
        line[stop - at] = '\0';
        at = stop + 1;
        if (line[0] == '#') {
            const int64_t time = strtoll(line + 1, NULL, 10);
            TEST_ASSERT_TRUE(time > now);
            now = time;
            continue;
        }
        happening *h = &read_back[count++];
        TEST_ASSERT_TRUE(count <= CHANGES && now >= 0);
        char *code = line[0] == 'r' ? strchr(line, ' ') : line + 1;
        TEST_ASSERT_NOT_NULL(code);
        h->signal = signal_of(line[0] == 'r' ? code + 1 : code);
        *code = line[0] == 'r' ? '\0' : *code;
        snprintf(h->value, VALUE, "%.*s", line[0] == 'r' ? VALUE - 1 : 1, line);
        h->time = now;
    }
    *end = now;
    return count;
}

/* A change's time is at least 0. */
static int64_t draw_time(dice *d, int64_t now) {
    const int64_t time = now - (int64_t)dice_one_of(d, JITTER);
    return time > 0 ? time : 0;
}

static void add_signals(vcd *v) {
    for (int i = 0; i < SIGNALS; i++) {
        char name[20];
        const char *note = i % 4 == 0 ? "m" : i % 4 == 1 ? "a note" : i % 4 == 2 ? "" : NULL;
        snprintf(name, sizeof name, "s%d", i);
        const int number = kind(i) == WIRE   ? vcd_wire(v, name, note)
                           : kind(i) == REAL ? vcd_real(v, name, note)
                                             : vcd_event(v, name, note);
        TEST_ASSERT_EQUAL_INT(i, number);
    }
}

/* What must come out: by time, at one time as it came; what is as before is left out, but events. */
static int sort_made(int count) {
    char last[SIGNALS][VALUE];
    int kept = 0;
    memset(last, 0, sizeof last);
    for (int i = 1; i < count; i++) {
        const happening h = made[i];
        int at = i;
        for (; at > 0 && made[at - 1].time > h.time; at--) {
            made[at] = made[at - 1];
        }
        made[at] = h;
    }
    for (int i = 0; i < count; i++) {
        const happening h = made[i];
        if (kind(h.signal) == EVENT || strcmp(last[h.signal], h.value) != 0) {
            memcpy(last[h.signal], h.value, VALUE);
            made[kept++] = h;
        }
    }
    return kept;
}

static void test_changes_come_in_order(void) {
    dice d = dice_of("vcd", 51);
    for (unsigned round = 0; round < 20U; round++) {
        char *text = NULL;
        size_t length = 0;
        int64_t now = round % 2U == 0 ? 0 : 1000;
        int64_t end = 0;
        int64_t highest = 0;
        FILE *out = alloc_text(&text, &length);
        vcd *v = vcd_new(out, "made up", 6, "top", 4);
        const int count = round < 4U ? (int)round : CHANGES;
        add_signals(v);
        for (int i = 0; i < count; i++) {
            happening *h = &made[i];
            const unsigned which = dice_one_of(&d, 5);
            const double value = which == 0   ? 0.0
                                 : which == 1 ? (double)NAN
                                              : dice_between(&d, -1e3, 1e3);
            memset(h, 0, sizeof *h);
            h->time = draw_time(&d, now);
            h->signal = (int)dice_one_of(&d, i % 2 == 0 ? 6 : SIGNALS);
            print_value(h, kind(h->signal) == REAL && isnan(value) ? 0.5 : value);
            vcd_change(v, h->signal, i % 7 == 0 && h->time == 0 ? -3 : h->time,
                       kind(h->signal) == REAL && isnan(value) ? 0.5 : value);
            highest = h->time > highest ? h->time : highest;
            now += (int64_t)dice_one_of(&d, 4);
            if (dice_one_of(&d, 10) == 0) {
                vcd_settle(v, now - JITTER); /* nothing earlier comes */
                highest = now - JITTER > highest ? now - JITTER : highest;
            }
        }
        TEST_ASSERT_EQUAL_UINT64(0, vcd_end(v));
        alloc_text_end(out);
        const int wanted = sort_made(count);
        TEST_ASSERT_EQUAL_INT(wanted, read_changes(read_head(text), &end));
        for (int i = 0; i < wanted; i++) {
            TEST_ASSERT_EQUAL_INT64(made[i].time, read_back[i].time);
            TEST_ASSERT_EQUAL_INT(made[i].signal, read_back[i].signal);
            TEST_ASSERT_EQUAL_STRING(made[i].value, read_back[i].value);
        }
        TEST_ASSERT_EQUAL_INT64(highest, end);
        free(text);
    }
}

/* Behind what is written already: at the last time that was, and told. */
static void test_what_is_late_is_counted(void) {
    dice d = dice_of("vcd", 52);
    for (unsigned round = 0; round < 10U; round++) {
        char *text = NULL;
        size_t length = 0;
        int64_t end = 0;
        FILE *out = alloc_text(&text, &length);
        vcd *v = vcd_new(out, "made up", 6, "top", 4);
        const int late = 1 + (int)dice_one_of(&d, 9);
        add_signals(v);
        vcd_change(v, 1, 100, 1.0);
        vcd_settle(v, 100);
        for (int i = 0; i < late; i++) {
            vcd_change(v, 2, (int64_t)dice_one_of(&d, 100), 1.0);
        }
        TEST_ASSERT_EQUAL_UINT64((uint64_t)late, vcd_end(v));
        alloc_text_end(out);
        TEST_ASSERT_EQUAL_INT(1 + late, read_changes(read_head(text), &end));
        TEST_ASSERT_EQUAL_INT64(100, end);
        free(text);
    }
    TEST_ASSERT_EQUAL_UINT64(0, vcd_end(NULL));
}

void suite_vcd(void) {
    RUN_TEST(test_changes_come_in_order);
    RUN_TEST(test_what_is_late_is_counted);
}
