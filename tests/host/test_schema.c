/* test_schema.c: what a rig's telemetry says of itself (host/monitor/schema.h): drawn channels, states and rates are read as
 * they were written; a line that lacks something, or in which one thing is wrong, is refused and changes nothing. */
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "host/monitor/schema.h"
#include "unity.h"

void suite_schema(void);

enum { LINE = 600, PIECES = 5 };

static dice die;

/* A channel, and its line in pieces, so that one of them can be left out or be another. */
typedef struct written {
    schema_channel channel;
    unsigned index;
    char piece[PIECES][LINE]; /* channel, name, period_ticks, once, each */
} written;

static void draw_word(char *to, unsigned longest) {
    const unsigned length = 1U + dice_one_of(&die, longest);
    for (unsigned i = 0; i < length; i++) {
        to[i] = (char)('a' + (char)dice_one_of(&die, 26));
    }
    to[length] = '\0';
}

/* Fields between commas; the last of them without an offset now and then. */
static void draw_fields(schema_field *fields, int count, char *text) {
    static const unsigned sizes[] = {1, 2, 4};
    size_t at = strlen(text);
    for (int i = 0; i < count; i++) {
        schema_field *f = &fields[i];
        char word[20];
        const bool has_unit = dice_one_of(&die, 2) != 0;
        draw_word(word, 12);
        *f = (schema_field){.size = sizes[dice_one_of(&die, 3)],
                            .is_signed = dice_one_of(&die, 2) != 0,
                            .scale = dice_between(&die, -3.0, 3.0),
                            .offset =
                                dice_one_of(&die, 2) != 0 ? dice_between(&die, -9.0, 9.0) : 0.0};
        snprintf(f->name, sizeof f->name, has_unit ? "%s [N]" : "%s", word);
        at += (size_t)snprintf(text + at, LINE - at, "%s%s%s:%c%u:%.17g", i > 0 ? "," : "", word,
                               has_unit ? "[N]" : "", f->is_signed ? 'i' : 'u', f->size, f->scale);
        if (f->offset != 0.0) {
            at += (size_t)snprintf(text + at, LINE - at, ":%.17g", f->offset);
        }
    }
}

static void draw_channel(written *w) {
    schema_channel *c = &w->channel;
    memset(w, 0, sizeof *w);
    w->index = dice_one_of(&die, SCHEMA_CHANNELS);
    c->known = true;
    draw_word(c->name, SCHEMA_NAME - 2);
    c->period_ticks = dice_one_of(&die, 3) != 0 ? dice_one_of(&die, 100000) : UINT32_MAX;
    c->onces = (int)dice_one_of(&die, SCHEMA_FIELDS + 1);
    c->eaches = (int)dice_one_of(&die, SCHEMA_FIELDS + 1);
    snprintf(w->piece[0], LINE, "channel=%u", w->index);
    snprintf(w->piece[1], LINE, "name=%s", c->name);
    snprintf(w->piece[2], LINE, "period_ticks=%lu", (unsigned long)c->period_ticks);
    snprintf(w->piece[3], LINE, "once=");
    draw_fields(c->once, c->onces, w->piece[3]);
    snprintf(w->piece[4], LINE, "each=");
    draw_fields(c->each, c->eaches, w->piece[4]);
}

static void join(const written *w, int left_out, char *line) {
    size_t at = (size_t)snprintf(line, (size_t)PIECES * LINE, "OK");
    for (int i = 0; i < PIECES; i++) {
        if (i != left_out) {
            at += (size_t)snprintf(line + at, (size_t)PIECES * LINE - at, " %s", w->piece[i]);
        }
    }
}

static void expect_fields(const schema_field *wanted, const schema_field *found, int count) {
    for (int i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_STRING(wanted[i].name, found[i].name);
        TEST_ASSERT_EQUAL_UINT(wanted[i].size, found[i].size);
        TEST_ASSERT_EQUAL(wanted[i].is_signed, found[i].is_signed);
        TEST_ASSERT_TRUE(wanted[i].scale == found[i].scale && wanted[i].offset == found[i].offset);
    }
}

static void expect_refused(const schema *s, const char *line) {
    schema tried = *s;
    TEST_ASSERT_FALSE_MESSAGE(schema_take(&tried, line), line);
    TEST_ASSERT_TRUE_MESSAGE(memcmp(&tried, s, sizeof tried) == 0, line);
}

static void test_channels_are_as_written(void) {
    static schema s;
    die = dice_of("schema", 61);
    memset(&s, 0, sizeof s);
    for (unsigned i = 0; i < 300U; i++) {
        written w;
        static char line[PIECES * LINE];
        draw_channel(&w);
        join(&w, -1, line);
        TEST_ASSERT_TRUE_MESSAGE(schema_take(&s, line), line);
        const schema_channel *c = &s.channel[w.index];
        TEST_ASSERT_TRUE(c->known);
        TEST_ASSERT_EQUAL_STRING(w.channel.name, c->name);
        TEST_ASSERT_EQUAL_UINT32(w.channel.period_ticks, c->period_ticks);
        TEST_ASSERT_EQUAL_INT(w.channel.onces, c->onces);
        TEST_ASSERT_EQUAL_INT(w.channel.eaches, c->eaches);
        expect_fields(w.channel.once, c->once, c->onces);
        expect_fields(w.channel.each, c->each, c->eaches);
    }
}

/* Each piece left out, and each in a way that is none. */
static void test_what_is_wrong_is_refused(void) {
    static const char *const wrong[PIECES][6] = {
        {"channel=8", "channel=-1", "channel=x", "channel=", "channel=1e9", "channel=nan"},
        {"name=", "name=:", "name=abcdefghijklmnopqrstuvwxyzabcdef", "named=a", "nam=a",
         "name = a"},
        {"period_ticks=-1", "period_ticks=4294967296", "period_ticks=x",
         "period_ticks=", "period_ticks=nan", "ticks=1"},
        {"once=a", "once=a:u3:1", "once=a:f4:1", "once=a:u1", "once=a:u1:x", "once=a:u1:inf"},
        {"each=a:u1:", "each=a:u1:1:x", "each=a:u1:1:inf", "each=a,b", "each=a[b:u1:1,c:u0:1",
         "each=a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1,a:u1:1"}};
    static schema s;
    die = dice_of("schema", 62);
    memset(&s, 0, sizeof s);
    for (unsigned i = 0; i < 40U; i++) {
        written w;
        static char line[PIECES * LINE];
        draw_channel(&w);
        join(&w, -1, line);
        TEST_ASSERT_TRUE_MESSAGE(schema_take(&s, line),
                                 line); /* and the next ones change nothing */
        for (int k = 0; k < PIECES; k++) {
            char kept[LINE];
            join(&w, k, line);
            expect_refused(&s, line);
            memcpy(kept, w.piece[k], LINE);
            for (int n = 0; n < 6; n++) {
                snprintf(w.piece[k], LINE, "%s", wrong[k][n]);
                join(&w, -1, line);
                expect_refused(&s, line);
            }
            memcpy(w.piece[k], kept, LINE);
        }
    }
}

/* Of channel 0, once it is known; nothing else of it changes. */
static void test_rates(void) {
    static schema s;
    die = dice_of("schema", 63);
    memset(&s, 0, sizeof s);
    expect_refused(&s, "OK rate=100 period_ticks=10000");
    written w;
    static char line[PIECES * LINE];
    do {
        draw_channel(&w);
    } while (w.index != 0);
    join(&w, -1, line);
    TEST_ASSERT_TRUE(schema_take(&s, line));
    for (unsigned i = 0; i < 50U; i++) {
        schema wanted = s;
        const unsigned ticks = dice_one_of(&die, 1000000);
        wanted.channel[0].period_ticks = ticks;
        snprintf(line, sizeof line, "OK rate=%u period_ticks=%u", 1U + ticks / 7U, ticks);
        TEST_ASSERT_TRUE(schema_take(&s, line));
        TEST_ASSERT_TRUE(memcmp(&wanted, &s, sizeof s) == 0);
        expect_refused(&s, "OK rate=5");
        expect_refused(&s, "OK rate=5 period_ticks=-1");
        expect_refused(&s, "OK rate=5 period_ticks=4294967296");
    }
}

/* Those that are told are all that there are. */
static void test_states(void) {
    static schema s;
    die = dice_of("schema", 64);
    memset(&s, 0, sizeof s);
    for (unsigned i = 0; i < 100U; i++) {
        char state[SCHEMA_STATES][SCHEMA_NAME] = {{0}};
        char line[SCHEMA_STATES * 40];
        size_t at = (size_t)snprintf(line, sizeof line, "OK");
        for (unsigned k = 0; k < SCHEMA_STATES; k++) {
            if (k == 0 || dice_one_of(&die, 3) < i % 3U) {
                draw_word(state[k], SCHEMA_NAME - 2);
                at += (size_t)snprintf(line + at, sizeof line - at, " %u=%s", k, state[k]);
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(schema_take(&s, line), line);
        TEST_ASSERT_TRUE(s.states_known && memcmp(state, s.state, sizeof state) == 0);
        static const char *const wrong[] = {" 32=a", " -1=a", " x=a", " 3", " 3=", " 3:a"};
        for (unsigned k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
            snprintf(line + at, sizeof line - at, "%s", wrong[k]);
            expect_refused(&s, line);
        }
    }
    expect_refused(&s, "OK");
    expect_refused(&s, "OK 1=a");
    expect_refused(&s, "ERR 0=a");
}

void suite_schema(void) {
    RUN_TEST(test_channels_are_as_written);
    RUN_TEST(test_what_is_wrong_is_refused);
    RUN_TEST(test_rates);
    RUN_TEST(test_states);
}
