/* firstlight.c: `whirl firstlight`: the record of a board's first light compared with the interpreter's runs, and with the
 * emulator's record; a row for docs/silicon.md. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "commands.h"
#include "host/base/written.h"
#include "host/monitor/light.h"
#include "host/monitor/port.h"
#include "interrupts.h"
#include "light_expect.h"
#include "light_page.h"
#include "target.h"

#define ASK_S 3.0
enum { WAIT_MS = 100, BYTES_MOST = 1 << 20 };

typedef struct firstlight_options {
    common_options common; /* none of them is taken */
    const char *source;
    const char *page;
    const char *board;
    const char *emulated;
    const char *keep;
    double wait_s;
    double baud;
} firstlight_options;

static const command_usage firstlight_usage = {
    .head =
        "usage: whirl firstlight FILE|PORT [options]\n"
        "\n"
        "Reads the record that the image firstlight prints, from a file or a serial line. Compares each\n"
        "field with the interpreter's runs of the same scenes, and appends a row to the table of\n" LIGHT_PAGE
        ".\n"
        "A field that the board or emulator cannot give is `none`, and is named.\n"
        "\n",
    .tail =
        "  --board B         the record is to be of this board\n"
        "  --emulated FILE   the emulator's record of the same image: board, compiler and stack beside it\n"
        "  --page FILE       the page that gets the row (default: " LIGHT_PAGE
        ", of silicon alone)\n"
        "  --keep FILE       the record, as it was read\n"
        "  --wait S          so many seconds for a record on a line (default: 60)\n"
        "  --baud B          the line's speed (default: 115200)\n",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "no field differs",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] =
                "a field differs, no record came, or the row could not be written",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "no whole record, too",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    firstlight_options *o = options;
    const number_option numbers[] = {
        {"--wait", &o->wait_s, 0.1, 86400.0, false, "in seconds: --wait 60"},
        {"--baud", &o->baud, 1.0, 1e7, false, "9600 to 230400: --baud 115200"}};
    const struct {
        const char *word;
        const char **value;
    } files[] = {{"--board", &o->board},
                 {"--emulated", &o->emulated},
                 {"--page", &o->page},
                 {"--keep", &o->keep}};
    for (size_t i = 0; i < sizeof files / sizeof files[0] && !*bad; i++) {
        const char *value = options_value(count, words, at, files[i].word, bad);
        if (value != NULL) {
            *files[i].value = value;
            return true;
        }
    }
    return !*bad && options_take_number("firstlight", numbers, sizeof numbers / sizeof numbers[0],
                                        count, words, at, bad);
}

/* --- the record ------------------------------------------------------------------------------------------------- */

static double now_s(void) {
    struct timespec now;
    return clock_gettime(CLOCK_MONOTONIC, &now) == 0
               ? (double)now.tv_sec + (double)now.tv_nsec / 1e9
               : 0.0;
}

static int say_wrong(const char *name, const char *why, const char *hint) {
    fprintf(stderr, "%s: error: %s\nhint: %s\n", name, why, hint);
    return EXIT_BAD_INPUT;
}

/* All that a file has; or of a line the first record that is whole, asked for again and again. */
static int listen(port *line, const firstlight_options *o, const char *from_name, light *l) {
    static char bytes[BYTES_MOST];
    size_t count = 0;
    const double began_s = now_s();
    double asked_s = began_s - ASK_S;
    const char *hint = "is it the board's console, is --baud its speed, does firstlight run there?";
    const char *why = "no record came; --wait S waits longer";
    int code = EXIT_RUN_FAILED;
    bool ended = false;
    while (!ended && code != EXIT_DONE && !interrupted &&
           (!line->is_line || now_s() - began_s < o->wait_s)) {
        if (line->is_line && now_s() - asked_s >= ASK_S) {
            (void)port_write(line, "\r", 1);
            asked_s = now_s();
        }
        const int more =
            port_read(line, (uint8_t *)bytes + count, BYTES_MOST - count, WAIT_MS, NULL);
        count += more > 0 ? (size_t)more : 0;
        ended = more < 0 || (!line->is_line && count == BYTES_MOST);
        const char *from = line->is_line ? light_begin(bytes, count) : NULL;
        const char *end = from != NULL ? light_end(from, bytes + count) : NULL;
        if (ended || end != NULL) {
            from = from != NULL ? from : bytes;
            why = light_read(l, from, (size_t)((end != NULL ? end : bytes + count) - from), &hint);
            code = why == NULL ? EXIT_DONE : ended ? EXIT_BAD_INPUT : EXIT_RUN_FAILED;
        }
        count = end != NULL || count == BYTES_MOST ? 0 : count;
    }
    if (code != EXIT_DONE && interrupted) {
        return EXIT_INTERRUPTED;
    }
    if (code != EXIT_DONE) {
        (void)say_wrong(from_name, line->failed != 0 ? strerror(line->failed) : why, hint);
    }
    return code;
}

static int read_record(const firstlight_options *o, const char *from_name, light *l) {
    port line;
    if (!port_open(&line, from_name, o->baud)) {
        port_say_unopened(from_name, "build/BOARD/firstlight.txt is that of make firstlight");
        return EXIT_BAD_INPUT;
    }
    interrupts_catch_waiting();
    const int code = listen(&line, o, from_name, l);
    port_close(&line);
    return code;
}

/* The emulator's record is of these scenes, too; then its board, compiler and stack are what is compared with. */
static int expect_emulated(const firstlight_options *o, light_expected *e) {
    static light emulated;
    const int code = read_record(o, o->emulated, &emulated);
    for (int i = 0; code == EXIT_DONE && i < LIGHT_FIELDS; i++) {
        const bool hash = strncmp(light_names[i], "hash.", 5) == 0;
        if (hash && strcmp(emulated.value[i], e->of[i]) != 0) {
            return say_wrong(o->emulated, "the emulator's record is not of these scenes",
                             "make firstlight BOARD=... makes it again");
        }
    }
    static const char *const same[] = {"board", "compiler", "stack"};
    for (int i = 0; code == EXIT_DONE && i < 3; i++) {
        const int field = light_field(same[i], "");
        (void)snprintf(e->of[field], LIGHT_EXPECTED, "%s", emulated.value[field]);
    }
    return code;
}

/* --- the comparison ------------------------------------------------------------------------------------------------ */

static const char *const verdict_words[] = {[LIGHT_EQUAL] = "equal",
                                            [LIGHT_DIFFERS] = "differs",
                                            [LIGHT_NONE] = "none",
                                            [LIGHT_TOLD] = "-"};

/* The names of fields with this light_verdict, parted by commas; "": there are none. */
static void list_of(const light_verdict *found, light_verdict which, char *names, size_t size) {
    size_t used = 0;
    names[0] = '\0';
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        if (found[i] == which && used < size) {
            used += (size_t)snprintf(names + used, size - used, "%s%s", used > 0 ? ", " : "",
                                     light_names[i]);
        }
    }
}

static void show(const light *l, const light_expected *e, const light_verdict *found) {
    printf("%-29s %-8s %s\n", "field", "verdict", "record");
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        printf("%-29s %-8s %s\n", light_names[i], verdict_words[found[i]], l->value[i]);
        if (found[i] == LIGHT_DIFFERS || (found[i] == LIGHT_TOLD && e->of[i][0] != '\0')) {
            printf("%-29s %-8s %s\n", "", found[i] == LIGHT_DIFFERS ? "expected" : "emulator",
                   e->of[i]);
        }
    }
}

/* An emulator counts no cycles. */
static bool is_emulated(const light *l) {
    return light_is_none(l->value[light_field("period_cycles", "")]);
}

static bool keep(const char *name, const light *l) {
    FILE *out = written_open(name);
    if (out != NULL) {
        fwrite(l->text, 1, l->length, out);
    }
    return out != NULL && written_close(out, name, true);
}

static int compare(const firstlight_options *o) {
    static light l;
    static light_expected e;
    light_verdict found[LIGHT_FIELDS];
    char names[600];
    int code = light_expect(&e);
    code = code == EXIT_DONE && o->emulated != NULL ? expect_emulated(o, &e) : code;
    if (o->board != NULL) {
        (void)snprintf(e.of[light_field("board", "")], LIGHT_EXPECTED, "%s", o->board);
    }
    code = code == EXIT_DONE ? read_record(o, o->source, &l) : code;
    if (code != EXIT_DONE || (o->keep != NULL && !keep(o->keep, &l))) {
        return code != EXIT_DONE ? code : EXIT_RUN_FAILED;
    }
    int equal = 0;
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        found[i] = light_judge(i, l.value[i], e.of[i]);
        equal += found[i] == LIGHT_EQUAL && strncmp(light_names[i], "hash.", 5) == 0;
    }
    show(&l, &e, found);
    printf("hashes: %d of %d equal\n", equal, LIGHT_SCENES);
    list_of(found, LIGHT_NONE, names, sizeof names);
    printf("none: %s\n", names[0] != '\0' ? names : "-");
    list_of(found, LIGHT_DIFFERS, names, sizeof names);
    printf("differs: %s\n", names[0] != '\0' ? names : "-");
    if (o->page == NULL && is_emulated(&l)) {
        puts("row: none, for an emulator counts no cycles either; --page FILE appends one");
    } else {
        char *row = light_row(&l, equal, names);
        code = light_append(o->page != NULL ? o->page : LIGHT_PAGE, row, l.crc);
        free(row);
    }
    return code == EXIT_DONE && names[0] != '\0' ? EXIT_RUN_FAILED : code;
}

int command_firstlight(int count, char **words) {
    static const char *const own[] = {"--board", "--emulated", "--page", "--keep",
                                      "--wait",  "--baud",     NULL};
    const target_reader reader = {
        .command = "firstlight", .own = own, .take = take_one, .one = "record"};
    firstlight_options o = {.common = options_defaults(), .wait_s = 60.0, .baud = 115200.0};
    if (options_help(count, words, &firstlight_usage)) {
        return EXIT_DONE;
    }
    int code = EXIT_BAD_INPUT;
    if (target_read(&reader, count, words, &o.common, &o, &o.source) &&
        target_is_there(o.source, &firstlight_usage)) {
        if (!port_has_speed(o.baud)) {
            (void)say_wrong("whirl firstlight", "--baud: no such speed", PORT_SPEEDS);
        } else {
            code = compare(&o);
        }
    }
    options_forget(&o.common);
    return code;
}
