/* test_firstlight.c: records of a board's first light (host/monitor/light.h), drawn: each is read as its board meant it, with
 * noise before it and a terminal's carriage returns; each cut, changed byte, lost, doubled or swapped line is refused. And
 * `whirl firstlight` on records that differ in one field, and on its page. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "core/frame.h"
#include "host/cli/commands.h"
#include "host/monitor/light.h"
#include "unity.h"

void suite_firstlight(void);

enum { ROOM = 16384 };

static dice drawn;
static char record[ROOM];
static light read_one;

/* The line that ends it. */
static size_t sealed(char *text) {
    const size_t body = strlen(text);
    snprintf(text + body, ROOM - body, WH_LIGHT_END "%08x\n",
             (unsigned)wh_frame_crc(0, (const uint8_t *)text, (unsigned)body));
    return strlen(text);
}

/* A record of any printable values. */
static size_t draw(char *text) {
    size_t length = (size_t)snprintf(text, ROOM, WH_LIGHT_BEGIN "\n");
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        length += (size_t)snprintf(text + length, ROOM - length, "%s ", light_names[i]);
        for (unsigned k = 1U + dice_one_of(&drawn, 60); k > 0; k--) {
            text[length++] = (char)('!' + dice_one_of(&drawn, '~' - '!' + 1));
        }
        text[length++] = '\n';
    }
    text[length] = '\0';
    return sealed(text);
}

static const char *wrong(const char *bytes, size_t count) {
    const char *hint = NULL;
    const char *why = light_read(&read_one, bytes, count, &hint);
    TEST_ASSERT_TRUE(why == NULL || (hint != NULL && hint[0] != '\0'));
    return why;
}
static void refused(const char *bytes, size_t count, const char *what, size_t at) {
    char words[100];
    snprintf(words, sizeof words, "%s %zu is taken for right", what, at);
    TEST_ASSERT_NOT_NULL_MESSAGE(wrong(bytes, count), words);
}
static void taken(const char *bytes, size_t count) {
    TEST_ASSERT_NULL(wrong(bytes, count));
    TEST_ASSERT_EQUAL_STRING(record, read_one.text);
}

static void test_whole_records(void) {
    static char other[ROOM];
    for (unsigned i = 0; i < dice_cases(100); i++) {
        const size_t length = draw(record);
        taken(record, length);
        size_t count = 0; /* noise, without a begin of its own */
        for (unsigned k = dice_one_of(&drawn, 300); k > 0; k--) {
            other[count++] = (char)dice_one_of(&drawn, 256);
        }
        const unsigned returns = dice_one_of(&drawn, 3);
        for (size_t k = 0; k < length; k++) {
            for (unsigned r = 0; r < returns && record[k] == '\n'; r++) {
                other[count++] = '\r';
            }
            other[count++] = record[k];
        }
        taken(other, count);
    }
}

/* Offsets of lines, up to the end of the text. */
static size_t lines_of(const char *text, size_t *from) {
    size_t lines = 0;
    for (const char *at = text; *at != '\0'; at = strchr(at, '\n') + 1) {
        from[lines++] = (size_t)(at - text);
    }
    from[lines] = strlen(text);
    return lines;
}

static void test_broken_records(void) {
    static char other[2 * ROOM];
    size_t from[LIGHT_FIELDS + 3];
    for (unsigned i = 0; i < dice_cases(1); i++) {
        const size_t length = draw(record);
        for (size_t k = 0; k < length; k++) {
            refused(record, k, "a record cut at byte", k);
            refused(record + k + 1, length - k - 1, "a record from byte", k + 1);
            memcpy(other, record, length);
            for (unsigned n = 0; n < 12;
                 n++) { /* each bit, then any byte, then what lines end with */
                other[k] = n < 8     ? (char)(record[k] ^ 1 << n)
                           : n == 8  ? (char)dice_one_of(&drawn, 256)
                           : n == 9  ? '\n'
                           : n == 10 ? '\r'
                                     : '\0';
                if (other[k] != record[k]) {
                    refused(other, length, "a record with another byte", k);
                }
            }
        }
        const size_t lines = lines_of(record, from);
        TEST_ASSERT_EQUAL(LIGHT_FIELDS + 2, lines);
        for (size_t k = 0; k < lines; k++) {
            const size_t line = from[k + 1] - from[k];
            memcpy(other, record, from[k + 1]);
            memcpy(other + from[k + 1], record + from[k], length - from[k]);
            refused(other, length + line, "a record with a doubled line", k);
            memcpy(other + from[k], record + from[k + 1], length - from[k + 1]);
            refused(other, length - line, "a record without line", k);
            if (k + 1 < lines) {
                const size_t next = from[k + 2] - from[k + 1];
                memcpy(other, record, length);
                memcpy(other + from[k], record + from[k + 1], next);
                memcpy(other + from[k] + next, record + from[k], line);
                refused(other, length, "a record with a swapped line", k);
            }
        }
        memcpy(other, record, length);
        memcpy(other + length, record, length);
        refused(other, 2 * length, "two records:", i);
        other[length] = ' ';
        refused(other, length + 1, "text behind:", i);
    }
}

/* A right CRC does not make a record of what is none: other lines, bytes that are no text, too much of it. */
static void test_sealed_nonsense(void) {
    static char before[ROOM];
    size_t from[LIGHT_FIELDS + 3];
    for (unsigned i = 0; i < dice_cases(200); i++) {
        size_t length = draw(record) - sizeof "end 0x01234567";
        strcpy(before, record);
        const size_t first = sizeof WH_LIGHT_BEGIN;
        const size_t at = first + dice_one_of(&drawn, (unsigned)(length - first));
        switch (dice_one_of(&drawn, 4)) {
        case 0: /* a control byte, or a line's end */
            record[at] = (char)(1 + dice_one_of(&drawn, 31));
            break;
        case 1: /* fields are missing */
            (void)lines_of(record, from);
            length = from[1U + dice_one_of(&drawn, LIGHT_FIELDS)];
            break;
        case 2: record[at] = (char)(127 + dice_one_of(&drawn, 129)); break;
        default:
            memset(record + at, 'x', LIGHT_ROOM);
            length = at + LIGHT_ROOM;
            break;
        }
        if (record[length - 1] != '\n') {
            record[length++] = '\n';
        }
        record[length] = '\0';
        const size_t whole = sealed(record);
        if (strcmp(record, before) != 0) { /* a line's end in the place of one */
            refused(record, whole, "nonsense", i);
        }
    }
}

static void test_any_bytes(void) {
    static const char begin_line[] = WH_LIGHT_BEGIN "\n";
    static char bytes[1024];
    for (unsigned i = 0; i < dice_cases(usual_or(3000, 600)); i++) {
        size_t count = 0;
        for (unsigned pieces = dice_one_of(&drawn, 12); pieces > 0; pieces--) {
            static const char *const piece[] = {
                WH_LIGHT_BEGIN, begin_line, "\r", "\n", "end 0x", "end 0x00000000\n", "board x\n"};
            const unsigned which = dice_one_of(&drawn, 9);
            if (which < 7) {
                memcpy(bytes + count, piece[which], strlen(piece[which]));
                count += strlen(piece[which]);
            } else {
                bytes[count++] = (char)dice_one_of(&drawn, 256);
            }
        }
        TEST_ASSERT_NOT_NULL(wrong(bytes, count));
    }
}

/* --- the command ---------------------------------------------------------------------------------------------------- */

static char files[2][64];
static void put(const char *name, const char *text) {
    FILE *out = fopen(name, "wb");
    TEST_ASSERT_NOT_NULL(out);
    fputs(text, out);
    TEST_ASSERT_EQUAL(0, fclose(out));
}
static const char *got(const char *name) {
    static char text[ROOM];
    FILE *in = fopen(name, "rb");
    TEST_ASSERT_NOT_NULL(in);
    text[fread(text, 1, sizeof text - 1, in)] = '\0';
    fclose(in);
    return text;
}

/* A board of its own as it should be: the interpreter's hashes, as the last answer of the command has them. */
static const char *right_value(const char *name, const said *hashes) {
    static const struct {
        const char *name;
        const char *value;
    } known[] = {{"board", "feather-f405"},
                 {"chip", "0x10076413"},
                 {"compiler", "12.2.1"},
                 {"stack", "1700 of 4096 bytes"},
                 {"clock", "crystal"},
                 {"period_us", "1999 2001"},
                 {"stop", "released"},
                 {"period_cycles", "335900 336100"},
                 {"supply", "12.00 V"},
                 {"load", "-9 -2 5 counts, 999 samples, 0 bad"},
                 {"version", "0.1.0"},
                 {"slots", "0 0 edges, 0 lost"},
                 {"selftest", "good arithmetic=good"}};
    static char value[100];
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strcmp(name, known[i].name) == 0) {
            return known[i].value;
        }
    }
    if (strncmp(name, "cycles.", 7) == 0) {
        return "800 812 1900";
    }
    const char *line = strstr(hashes->out, name);
    line = line != NULL ? strstr(line, "expected ") : NULL;
    TEST_ASSERT_NOT_NULL_MESSAGE(line, name);
    TEST_ASSERT_EQUAL(1, sscanf(line, "expected %99[^\n]", value));
    return value;
}

/* The record, with another value of one field. */
static void write_record(const said *hashes, const char *other, const char *value) {
    size_t length = (size_t)snprintf(record, ROOM, WH_LIGHT_BEGIN "\n");
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        const bool is = other != NULL && strcmp(other, light_names[i]) == 0;
        length += (size_t)snprintf(record + length, ROOM - length, "%s %s\n", light_names[i],
                                   is               ? value
                                   : hashes == NULL ? "0"
                                                    : right_value(light_names[i], hashes));
    }
    (void)sealed(record);
    put(files[0], record);
}

static const char page_head[] = "# A page\n\n| date | record |\n|---|---|\n";
static void ask(said *what) {
    const char *const words[] = {files[0], "--page", files[1], NULL};
    command_say(command_firstlight, words, what);
}

static void test_command(void) {
    static said hashes;
    static said what;
    char line[200];
    snprintf(files[0], sizeof files[0], "%s", model_keep(""));
    snprintf(files[1], sizeof files[1], "%s.md", files[0]);
    put(files[1], page_head);
    write_record(NULL, NULL, NULL); /* of zeros: what is expected is told */
    ask(&hashes);
    TEST_ASSERT_EQUAL(1, hashes.status);
    TEST_ASSERT_NOT_NULL(strstr(hashes.out, "hashes: 0 of 5 equal\n"));

    put(files[1], "# A page\n\n| date | record |\n|---|---|\n\nno row yet\n\nThe end.\n");
    write_record(&hashes, NULL, NULL);
    ask(&what);
    TEST_ASSERT_EQUAL_STRING("", what.err);
    TEST_ASSERT_EQUAL(0, what.status);
    TEST_ASSERT_NOT_NULL(
        strstr(what.out, "hashes: 5 of 5 equal\nnone: -\ndiffers: -\nrow: appended"));
    snprintf(line, sizeof line,
             " | feather-f405 | 0x10076413 | crystal | 5 of 5 | 812 / 812 / 812 / 812 / 812 | "
             "1700 of 4096 bytes | 1999 2001 | good | equal | %.10s |\n\nThe end.\n",
             strstr(record, "end ") + 4);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(got(files[1]), line), got(files[1]));
    TEST_ASSERT_NULL(strstr(got(files[1]), "no row yet"));
    ask(&what); /* the same once more */
    TEST_ASSERT_EQUAL(0, what.status);
    TEST_ASSERT_NOT_NULL(strstr(what.out, "has this record already"));

    /* one field that differs, or is none: named, in the row, too */
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        const char *name = light_names[i];
        const bool judged = strncmp(name, "model.", 6) == 0 || strncmp(name, "hash.", 5) == 0 ||
                            strcmp(name, "version") == 0 || strcmp(name, "clock") == 0 ||
                            strcmp(name, "period_us") == 0 || strcmp(name, "stop") == 0 ||
                            strcmp(name, "selftest") == 0;
        const bool hash = strncmp(name, "hash.", 5) == 0 || strncmp(name, "model.", 6) == 0 ||
                          strcmp(name, "version") == 0;
        put(files[1], page_head);
        write_record(&hashes, name, "1899 2150");
        ask(&what);
        snprintf(line, sizeof line, "\ndiffers: %s\n", judged ? name : "-");
        TEST_ASSERT_EQUAL_MESSAGE(judged ? 1 : 0, what.status, name);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, line), name);
        snprintf(line, sizeof line, "| differs: %s |", name);
        TEST_ASSERT_EQUAL_MESSAGE(judged, strstr(got(files[1]), line) != NULL, name);
        if (strcmp(name, "board") != 0 && strcmp(name, "compiler") != 0) {
            write_record(&hashes, name, WH_LIGHT_NONE);
            ask(&what);
            snprintf(line, sizeof line, "\n%s: %s\n", hash ? "differs" : "none", name);
            TEST_ASSERT_EQUAL_MESSAGE(hash ? 1 : 0, what.status, name);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, line), what.out);
        }
    }

    put(files[1], "no table\n");
    ask(&what);
    TEST_ASSERT_EQUAL(1, what.status);
    TEST_ASSERT_EQUAL_STRING("no table\n", got(files[1]));
    const char *const other_board[] = {files[0], "--board", "netduinoplus2",
                                       "--page", files[1],  NULL};
    command_say(command_firstlight, other_board, &what);
    TEST_ASSERT_NOT_NULL(strstr(what.out, "\ndiffers: board\n"));
    record[strlen(record) / 2] = '\0';
    put(files[0], record);
    put(files[1], page_head);
    ask(&what);
    TEST_ASSERT_EQUAL(2, what.status);
    TEST_ASSERT_NOT_NULL(strstr(what.err, "error: the record is cut"));
    TEST_ASSERT_NOT_NULL(strstr(what.err, "\nhint: "));
    TEST_ASSERT_EQUAL_STRING(page_head, got(files[1]));
    (void)remove(files[1]);
    model_drop();
}

void suite_firstlight(void) {
    drawn = dice_of("firstlight", 1);
    RUN_TEST(test_whole_records);
    RUN_TEST(test_broken_records);
    RUN_TEST(test_sealed_nonsense);
    RUN_TEST(test_any_bytes);
    RUN_TEST(test_command);
}
