/* test_cli.c: the number and the times of a run's steps, in integer arithmetic, for steps from nanoseconds to hours
 * and runs from one step to 50 years. WH_COUNTS=N sets the number of random pairs of step and end time. */
#include "core/frame.h"
#include "core/version.h"
#include "host/cli/commands.h"
#include "host/emit/emit.h"
#include "host/monitor/light.h"

#include "command.h"
#include "derived.h"

/* === suite counts ============================================================================= */

__extension__ typedef unsigned __int128 wide;

static uint64_t seed_now;

/* the random generator xorshift64 (Marsaglia, 2003) */
static uint64_t random_below(uint64_t most) {
    seed_now ^= seed_now << 13;
    seed_now ^= seed_now >> 7;
    seed_now ^= seed_now << 17;
    return seed_now % most;
}

/* A duration of digits/in seconds, and its text. */
typedef struct duration {
    uint64_t digits;
    uint64_t in; /* units of the last digit per second */
    char text[64];
} duration;

/* The number `digits` with `places` decimals, in a unit `of` that is 1/per seconds long. */
static duration duration_of(uint64_t digits, int places, const char *of, uint64_t per) {
    duration d = {digits, per, ""};
    char number[32];
    int length = snprintf(number, sizeof number, "%0*" PRIu64, places + 1, digits);
    snprintf(d.text, sizeof d.text, "%.*s%s%s [%s]", length - places, number, places > 0 ? "." : "",
             number + length - places, of);
    for (int i = 0; i < places; i++) {
        d.in *= 10;
    }
    return d;
}

static uint64_t number_behind(const char *in, const char *what) {
    const char *at = strstr(in, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    return strtoull(at + strlen(what), NULL, 10);
}

/* The number of steps in generated code must be until/step, computed from the decimal numbers in the text, with ties
 * rounded down. */
static void expect_count(const duration *step, const duration *until) {
    char text[320];
    char message[160];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nscene s { step %s; until %s }\n",
             step->text, until->text);
    snprintf(message, sizeof message, "step %s, until %s", step->text, until->text);
    const wide over = (wide)until->digits * step->in;
    const wide under = (wide)step->digits * until->in;
    const wide wanted = (2 * over + under - 1) / (2 * under);
    if (wanted == 0 || wanted >> 63 != 0) {
        return; /* refused pairs are not tested here */
    }
    derived d = derived_scene(text, "s");
    derived_expect(&d, message);
    char *c = derived_written(emit_c, d.image);
    TEST_ASSERT_TRUE_MESSAGE(wanted == number_behind(c, ".steps = UINT64_C("), message);
    const uint64_t numerator = number_behind(c, ".step = {UINT64_C(");
    const uint64_t denominator = number_behind(strstr(c, ".step = {") + 9, "), UINT64_C(");
    TEST_ASSERT_TRUE_MESSAGE((wide)numerator * step->in == (wide)denominator * step->digits,
                             message);
    free(c);
    derived_free(&d);
}

TEST(counts, counts_are_exact) {
    static const struct {
        const char *name;
        uint64_t per;
    } units[] = {{"ns", 1000000000}, {"us", 1000000}, {"ms", 1000}, {"s", 1}};
    const char *wanted = getenv("WH_COUNTS");
    const int pairs = wanted != NULL ? (int)strtol(wanted, NULL, 10) : 400;
    const uint64_t seed = UINT64_C(0x5eed0010);
    seed_now = seed;
    printf("  %d pairs, seed %" PRIx64 "\n", pairs, seed);
    /* one year, 50 years, and just above 2^32 ms */
    static const uint64_t long_s[] = {31536000, 1577880000, 4294968};
    for (unsigned i = 0; i < 3; i++) {
        const duration until = duration_of(long_s[i], 0, "s", 1);
        const duration milli = duration_of(1, 0, "ms", 1000);
        const duration nano = duration_of(1, 0, "ns", 1000000000);
        expect_count(&milli, &until);
        expect_count(&nano, &until);
    }
    for (int i = 0; i < pairs; i++) {
        const unsigned k = (unsigned)random_below(4);
        uint64_t most = 10;
        for (uint64_t more = random_below(6); more > 0; more--) {
            most *= 10;
        }
        const duration step =
            duration_of(1 + random_below(most), (int)random_below(4), units[k].name, units[k].per);
        /* the number of steps is log-uniform, and the end is within 50 years */
        const double span_s = (double)step.digits / (double)step.in;
        const double count = exp(log(1.6e9 / span_s) * (double)random_below(1000) / 1000.0);
        const double end_s = floor(count + 1.0) * span_s;
        if (end_s > 1.6e9 && count > 2.0) {
            continue;
        }
        int places = 0; /* the end has up to 13 digits, which a double represents exactly */
        double digits = end_s;
        while (places < 12 && digits < 1e12) {
            digits *= 10.0;
            places++;
        }
        const duration until = duration_of((uint64_t)digits, places, "s", 1);
        expect_count(&step, &until);
        if (step.digits < 1000 && count < 1e9) { /* also an end after whole steps */
            const duration whole =
                duration_of((uint64_t)floor(count + 1.0) * step.digits, 0, "s", step.in);
            int behind = 0;
            for (uint64_t in = step.in; in > 1; in /= 10) {
                behind++;
            }
            const duration exactly = duration_of(whole.digits, behind, "s", 1);
            expect_count(&step, &exactly);
        }
    }
}

TEST(counts, times_are_rounded_once) {
    seed_now = UINT64_C(0x5eed0012);
    for (int i = 0; i < 30000; i++) {
        const whole_ratio r = {1 + random_below(1000000), 1 + random_below(UINT64_C(1) << 40)};
        const uint64_t count = random_below(UINT64_MAX) >> random_below(64);
        const double time = ratio_times(count, r);
        const wide exact = (wide)count * r.numerator; /* the product is below 2^84 */
        int places;
        const uint64_t digits = (uint64_t)ldexp(frexp(time, &places), 53);
        places -= 53; /* time = digits * 2^places */
        wide have = (wide)digits * r.denominator;
        wide want = exact;
        wide half = r.denominator;
        if (places > 0) {
            have <<= places;
            half <<= places;
        } else {
            want = exact == 0 ? 0 : exact << -places; /* about digits * denominator, below 2^94 */
        }
        const wide off = have > want ? have - want : want - have;
        TEST_ASSERT_TRUE(exact == 0 ? !(time > 0.0) : 2 * off <= half);
    }
}

/* A --every or --from that was computed in double differs from the end of a step by round-off. Whirl must take it
 * for the end of that step. */
TEST(counts, spacings_are_counted_in_steps) {
    for (int i = 0; i < (int)usual_or(20000, 5000); i++) {
        const whole_ratio step =
            ratio_of((double)(1 + random_below(999)) / (double)(1 + random_below(99999)));
        const double step_s = ratio_times(1, step);
        const uint64_t wanted = 1 + random_below(UINT64_C(1) << (1 + random_below(30)));
        const double time_s = (double)wanted * step_s;
        const double part = 0.1 + 0.8 * (double)random_below(1000) / 1000.0;
        uint64_t count = 0;
        TEST_ASSERT_TRUE(ratio_count_each(time_s, step, &count) && count == wanted);
        TEST_ASSERT_TRUE(ratio_count_from(time_s, step, &count) && count == wanted);
        TEST_ASSERT_TRUE(ratio_count_from(time_s + part * step_s, step, &count) &&
                         count == wanted + 1);
        TEST_ASSERT_TRUE(ratio_count_from(time_s - part * step_s, step, &count) && count == wanted);
        const bool whole =
            ratio_count_each((double)(1 + wanted % 1000) * step_s + part * step_s, step, &count);
        TEST_ASSERT_TRUE(!whole);
    }
    uint64_t count = 7;
    TEST_ASSERT_TRUE(!ratio_count_each(0.0, ratio_of(1e-3), &count));
    TEST_ASSERT_TRUE(!ratio_count_each(-1.0, ratio_of(1e-3), &count));
    TEST_ASSERT_TRUE(!ratio_count_each(1e19, ratio_of(1e-3), &count));
    TEST_ASSERT_TRUE(ratio_count_from(0.0, ratio_of(1e-3), &count) && count == 0);
    TEST_ASSERT_TRUE(!ratio_count_from(1e18, ratio_of(1e-18), &count));
}

/* === suite firstlight ========================================================================= */
/* Random records of a board's first light (host/monitor/light.h). A record must be read as it was sent, even after
 * noise and with a terminal's carriage returns. A record that is cut short or has a changed byte must be refused.
 * `whirl firstlight` must name the field in which a record differs, and append a row to its page. */

enum { ROOM = 16384 };

static dice drawn;
static char record[ROOM];
static light read_one;

static size_t sealed(char *text) {
    const size_t body = strlen(text);
    snprintf(text + body, ROOM - body, WH_LIGHT_END "%08x\n",
             (unsigned)wh_frame_crc(0, (const uint8_t *)text, (unsigned)body));
    return strlen(text);
}

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

TEST(firstlight, whole_records) {
    static char other[ROOM];
    for (unsigned i = 0; i < dice_cases(100); i++) {
        const size_t length = draw(record);
        taken(record, length);
        size_t count = 0; /* noise without the words that begin a record */
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

TEST(firstlight, broken_records) {
    static char other[2 * ROOM];
    for (unsigned i = 0; i < dice_cases(1); i++) {
        const size_t length = draw(record);
        for (size_t k = 0; k < length; k++) {
            refused(record, k, "a record cut at byte", k);
            refused(record + k + 1, length - k - 1, "a record from byte", k + 1);
            memcpy(other, record, length);
            /* changes each bit of the byte; then the byte becomes random, a line end or zero */
            for (unsigned n = 0; n < 12; n++) {
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
        memcpy(other, record, length);
        memcpy(other + length, record, length);
        refused(other, 2 * length, "two records:", i);
        other[length] = ' ';
        refused(other, length + 1, "text behind:", i);
    }
}

/* Writes the offset of each line and of the text's end to from[]. Returns the number of lines. */
static size_t lines_of(const char *text, size_t *from) {
    size_t lines = 0;
    for (const char *at = text; *at != '\0'; at = strchr(at, '\n') + 1) {
        from[lines++] = (size_t)(at - text);
    }
    from[lines] = strlen(text);
    return lines;
}

/* A valid CRC does not make a valid record. The test seals changed lines, control bytes and too long a text with a
 * CRC. */
TEST(firstlight, sealed_nonsense) {
    static char before[ROOM];
    size_t from[LIGHT_FIELDS + 3];
    for (unsigned i = 0; i < dice_cases(200); i++) {
        size_t length = draw(record) - sizeof "end 0x01234567";
        strcpy(before, record);
        const size_t first = sizeof WH_LIGHT_BEGIN;
        const size_t at = first + dice_one_of(&drawn, (unsigned)(length - first));
        switch (dice_one_of(&drawn, 4)) {
        case 0: /* a control byte or a line end */
            record[at] = (char)(1 + dice_one_of(&drawn, 31));
            break;
        case 1: /* missing fields */
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
        if (strcmp(record, before) != 0) { /* equal only if a line end replaced a line end */
            refused(record, whole, "nonsense", i);
        }
    }
}

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

/* The value that a correct board sends for a field. `hashes` is a printed answer of the command, which contains the
 * expected hashes. */
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
                 {"version", WH_VERSION},
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
static void ask(said *what) { COMMAND_SAY(command_firstlight, what, files[0], "--page", files[1]); }

TEST(firstlight, command) {
    static said hashes;
    static said what;
    char line[200];
    snprintf(files[0], sizeof files[0], "%s", model_keep(""));
    snprintf(files[1], sizeof files[1], "%s.md", files[0]);
    put(files[1], page_head);
    /* for a record of zeros, the command prints the expected values */
    write_record(NULL, NULL, NULL);
    ask(&hashes);
    TEST_ASSERT_EQUAL(1, hashes.status);
    TEST_ASSERT_NOT_NULL(strstr(hashes.out, "hashes: 0 of 5 equal\n"));

    write_record(&hashes, NULL, NULL);
    ask(&what);
    TEST_ASSERT_EQUAL_STRING("", what.err);
    TEST_ASSERT_EQUAL(0, what.status);
    TEST_ASSERT_NOT_NULL(
        strstr(what.out, "hashes: 5 of 5 equal\nnone: -\ndiffers: -\nrow: appended"));
    snprintf(line, sizeof line,
             " | feather-f405 | 0x10076413 | crystal | 5 of 5 | 812 / 812 / 812 / 812 / 812 | "
             "1700 of 4096 bytes | 1999 2001 | good | equal | %.10s |\n",
             strstr(record, "end ") + 4);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(got(files[1]), line), got(files[1]));
    TEST_ASSERT_EQUAL_INT(0, strncmp(got(files[1]), page_head, sizeof page_head - 1));
    ask(&what); /* runs the command again with this record */
    TEST_ASSERT_EQUAL(0, what.status);
    TEST_ASSERT_NOT_NULL(strstr(what.out, "already has this record"));

    /* the output and the row must name a field that differs or is missing */
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

    put(files[1], "no table at the end\n");
    ask(&what);
    TEST_ASSERT_EQUAL(1, what.status);
    TEST_ASSERT_EQUAL_STRING("no table at the end\n", got(files[1]));
    COMMAND_SAY(command_firstlight, &what, files[0], "--board", "netduinoplus2", "--page",
                files[1]);
    TEST_ASSERT_NOT_NULL(strstr(what.out, "\ndiffers: board\n"));
    record[strlen(record) / 2] = '\0';
    put(files[0], record);
    put(files[1], page_head);
    ask(&what);
    TEST_ASSERT_EQUAL(2, what.status);
    TEST_ASSERT_NOT_NULL(strstr(what.err, "error: the record is incomplete"));
    TEST_ASSERT_NOT_NULL(strstr(what.err, "\nhint: "));
    TEST_ASSERT_EQUAL_STRING(page_head, got(files[1]));
    (void)remove(files[1]);
    model_drop();
}

SUITE(firstlight) { drawn = dice_of("firstlight", 1); }
