/* firstlight.c: `whirl firstlight`: a board's record, compared with records of the interpreter and an emulator. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/engine/loop.h"
#include "host/monitor/light.h"
#include "host/os/atomic_file.h"
#include "host/os/port.h"
#include "host/os/system.h"

/* === the expected record ====================================================================== */

enum { LIGHT_EXPECTED = 100 };

/* The expected value of a field, or "". */
typedef char light_expected[LIGHT_EXPECTED];

typedef enum light_verdict {
    LIGHT_EQUAL,
    LIGHT_DIFFERS,
    LIGHT_NONE, /* the board or emulator does not provide this value */
    LIGHT_TOLD  /* nothing is expected */
} light_verdict;

/* Bounds on the measured length of a control period, which should be 2 ms (hal/clock.h). */
#define PERIOD_LEAST_US 1900
#define PERIOD_MOST_US 2100

/* Index of the field `name` + `more`, which must exist. */
static int light_field(const char *name, const char *more) {
    char whole[LIGHT_EXPECTED];
    (void)snprintf(whole, sizeof whole, "%s%s", name, more);
    int i = 0;
    while (strcmp(light_names[i], whole) != 0) {
        i++;
    }
    return i;
}

/* Runs the scene in float, as the boards do, and notes the hashes that their records must have. */
static int run_scene(const char *name, light_expected *e) {
    const common_options plain = options_defaults();
    source_model from;
    loaded made = {.image = NULL};
    int code = source_open(&from, name);
    if (code == EXIT_DONE) {
        code = target_load(&made, &from, &plain,
                           (load_request){.use = IMAGE_TO_WRITE, .scene = true, .conserve = true});
    }
    if (code == EXIT_DONE) {
        void *run = engine_float.start(made.image);
        const wh_status status = loop_steps(&engine_float, run, made.image->steps);
        (void)snprintf(e[light_field("model.", name)], LIGHT_EXPECTED, "0x%016" PRIx64,
                       made.image->hash);
        (void)snprintf(e[light_field("hash.", name)], LIGHT_EXPECTED,
                       "0x%016" PRIx64 " %" PRIu64 " steps, %s", engine_float.hash(run),
                       engine_float.steps(run), wh_status_text(status));
        engine_float.stop(run);
    }
    unload(&made);
    source_close(&from);
    return code;
}

static int light_expect(light_expected *e) {
#define SCENE_NAME(scene) #scene,
    static const char *const scenes[] = {WH_LIGHT_SCENES(SCENE_NAME)};
    int code = EXIT_DONE;
    for (int i = 0; i < LIGHT_SCENES && code == EXIT_DONE; i++) {
        code = run_scene(scenes[i], e);
    }
    static const char *const known[][2] = {
        {"version", WH_VERSION}, {"clock", "crystal"}, {"stop", "released"}, {"selftest", "good"}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        (void)snprintf(e[light_field(known[i][0], "")], LIGHT_EXPECTED, "%s", known[i][1]);
    }
    (void)snprintf(e[light_field("period_us", "")], LIGHT_EXPECTED, "%d %d", PERIOD_LEAST_US,
                   PERIOD_MOST_US);
    return code;
}

static light_verdict light_judge(int field, const char *value, const char *wanted) {
    const char *name = light_names[field];
    const bool may_be_none = strncmp(name, "model.", 6) != 0 && strncmp(name, "hash.", 5) != 0 &&
                             strcmp(name, "version") != 0 && strcmp(name, "board") != 0 &&
                             strcmp(name, "compiler") != 0;
    if (light_is_none(value) && may_be_none) {
        return LIGHT_NONE;
    }
    if (wanted[0] == '\0' || strcmp(name, "stack") == 0) {
        return LIGHT_TOLD; /* `stack` is not compared, because interrupts of a real board use it, too */
    }
    if (strcmp(name, "period_us") == 0) {
        char *end = NULL;
        const long least = strtol(value, &end, 10);
        const bool two = *end == ' ';
        const long most = two ? strtol(end + 1, &end, 10) : 0;
        return two && *end == '\0' && least >= PERIOD_LEAST_US && most <= PERIOD_MOST_US &&
                       least <= most
                   ? LIGHT_EQUAL
                   : LIGHT_DIFFERS;
    }
    if (strcmp(name, "selftest") == 0) { /* compare only the first word */
        return strncmp(value, "good ", 5) == 0 ? LIGHT_EQUAL : LIGHT_DIFFERS;
    }
    return strcmp(value, wanted) == 0 ? LIGHT_EQUAL : LIGHT_DIFFERS;
}

/* === the page of first lights: a table with a row for each record ============================= */

#define LIGHT_PAGE "docs/silicon.md"

static void cycles_of(const light *l, char *cell, size_t size) {
    size_t used = 0;
    cell[0] = '\0';
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        char median[16] = WH_LIGHT_NONE;
        if (strncmp(light_names[i], "cycles.", 7) == 0 && used < size) {
            (void)sscanf(l->value[i], "%*s %15s", median);
            used +=
                (size_t)snprintf(cell + used, size - used, "%s%s", used > 0 ? " / " : "", median);
        }
    }
}

/* The record's row of the table, to be freed. `equal`: number of correct hashes; `differ`: names of wrong fields. */
static char *light_row(const light *l, int equal, const char *differ) {
    char cycles[120];
    char date[16] = "";
    const time_t now = time(NULL);
    const struct tm *day = localtime(&now);
    if (day != NULL) {
        (void)strftime(date, sizeof date, "%Y-%m-%d", day);
    }
    cycles_of(l, cycles, sizeof cycles);
#define VALUE(name) l->value[light_field(name, "")]
    char *row = alloc_words(
        "| %s | %s | %s | %s | %d of %d | %s | %s | %s | %.4s | %s%s | 0x%08" PRIx32 " |\n", date,
        VALUE("board"), VALUE("chip"), VALUE("clock"), equal, LIGHT_SCENES, cycles, VALUE("stack"),
        VALUE("period_us"), VALUE("selftest"), differ[0] != '\0' ? "differs: " : "equal", differ,
        l->crc);
#undef VALUE
    return row;
}

/* Appends the row to the page, unless the page already has the value `crc`. Returns an exit status. */
static int light_append(const char *page, const char *row, uint32_t crc) {
    size_t length = 0;
    char seen[24];
    char *text = read_all(page, MODEL_BYTES_MAX, &length);
    if (text == NULL) {
        fputs("hint: give the page as --page FILE; " LIGHT_PAGE " exists only in the project's "
              "root folder\n",
              stderr);
        return EXIT_RUN_FAILED;
    }
    (void)snprintf(seen, sizeof seen, "| 0x%08" PRIx32 " |", crc);
    bool good = true;
    if (strstr(text, seen) != NULL) {
        printf("row: not added, because %s already has this record\n", page);
    } else if (length < 2 || strcmp(text + length - 2, "|\n") != 0) {
        fprintf(
            stderr,
            "%s: error: the row was not added, because this page does not end with a table\nhint: " LIGHT_PAGE
            " does\n",
            page);
        good = false;
    } else {
        good = atomic_file_print(page, "%s%s", text, row);
        if (good) {
            printf("row: appended to %s\n", page);
        }
    }
    free(text);
    return good ? EXIT_DONE : EXIT_RUN_FAILED;
}

/* === the command ============================================================================== */

#define ASK_S 3.0
enum { WAIT_MS = 100, BYTES_MOST = 1 << 20 };

typedef struct firstlight_options {
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
        "Reads the record that the program firstlight printed, from a file or a serial line\n"
        "(docs/firstlight.md), and compares each field with Whirl's own runs in float. The line `none:`\n"
        "lists the fields for which the board has no value, such as cycles without a cycle counter.\n"
        "\n",
    .tail =
        "  --board B            fail if the record is of another board\n"
        "  --emulated FILE      the emulator's record of the same program, for the same board and compiler\n"
        "  --page FILE          add a record with cycles to the table of this page (default:\n"
        "                       " LIGHT_PAGE ")\n"
        "  --keep FILE          keep the record, as it was read\n"
        "  --wait S             seconds to wait for a record on a line (default: 60)\n"
        "  --baud B             the speed of the line, 9600 to 230400 (default: 115200)\n",
    .why = {"no field differs", "a field differs, no record came, or the row could not be written",
            "wrong options, or an incomplete record", ""}};

static int say_wrong(const char *name, const char *why, const char *hint) {
    fprintf(stderr, "%s: error: %s\nhint: %s\n", name, why, hint);
    return EXIT_BAD_INPUT;
}

/* Reads a file; or asks a serial line for a record every ASK_S seconds, and reads the first complete one. */
static int listen(port *line, const firstlight_options *o, const char *from_name, light *l) {
    static char bytes[BYTES_MOST];
    size_t count = 0;
    const double began_s = system_now_s();
    double asked_s = began_s - ASK_S;
    const char *hint =
        "check that this line is the board's console, that --baud is its speed, and that the board runs the program firstlight";
    const char *why = "no record came; --wait S waits longer";
    int code = EXIT_RUN_FAILED;
    bool ended = false;
    while (!ended && code != EXIT_DONE && !interrupted &&
           (!line->is_line || system_now_s() - began_s < o->wait_s)) {
        if (line->is_line && system_now_s() - asked_s >= ASK_S) {
            (void)port_write(line, "\r", 1);
            asked_s = system_now_s();
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
        port_say_unopened(from_name, "`make firstlight` writes its record to "
                                     "build/BOARD/firstlight.txt");
        return EXIT_BAD_INPUT;
    }
    interrupts_catch_waiting();
    const int code = listen(&line, o, from_name, l);
    port_close(&line);
    return code;
}

/* Reads the emulator's record, compares its hashes with `e`, and copies its board, compiler and stack into `e`. */
static int expect_emulated(const firstlight_options *o, light_expected *e) {
    static light emulated;
    const int code = read_record(o, o->emulated, &emulated);
    for (int i = 0; code == EXIT_DONE && i < LIGHT_FIELDS; i++) {
        const bool hash = strncmp(light_names[i], "hash.", 5) == 0;
        if (hash && strcmp(emulated.value[i], e[i]) != 0) {
            return say_wrong(o->emulated, "the emulator's record belongs to other scenes",
                             "make the record again: make firstlight BOARD=...");
        }
    }
    static const char *const same[] = {"board", "compiler", "stack"};
    for (int i = 0; code == EXIT_DONE && i < 3; i++) {
        const int field = light_field(same[i], "");
        (void)snprintf(e[field], LIGHT_EXPECTED, "%s", emulated.value[field]);
    }
    return code;
}

static const char *const verdict_words[] = {[LIGHT_EQUAL] = "equal",
                                            [LIGHT_DIFFERS] = "differs",
                                            [LIGHT_NONE] = "none",
                                            [LIGHT_TOLD] = "-"};

/* The names of fields with this verdict, separated by commas. */
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
        if (found[i] == LIGHT_DIFFERS || (found[i] == LIGHT_TOLD && e[i][0] != '\0')) {
            printf("%-29s %-8s %s\n", "", found[i] == LIGHT_DIFFERS ? "expected" : "emulator",
                   e[i]);
        }
    }
}

static bool keep(const char *name, const light *l) {
    FILE *out = atomic_file_open(name);
    if (out != NULL) {
        fwrite(l->text, 1, l->length, out);
    }
    return out != NULL && atomic_file_close(out, name, true);
}

static int compare(void *options) {
    const firstlight_options *o = options;
    static light l;
    static light_expected e[LIGHT_FIELDS];
    light_verdict found[LIGHT_FIELDS];
    char names[600];
    if (!port_has_speed(o->baud)) {
        return say_wrong("whirl firstlight", "--baud: this speed is not supported", PORT_SPEEDS);
    }
    int code = light_expect(e);
    code = code == EXIT_DONE && o->emulated != NULL ? expect_emulated(o, e) : code;
    if (o->board != NULL) {
        (void)snprintf(e[light_field("board", "")], LIGHT_EXPECTED, "%s", o->board);
    }
    code = code == EXIT_DONE ? read_record(o, o->source, &l) : code;
    if (code != EXIT_DONE || (o->keep != NULL && !keep(o->keep, &l))) {
        return code != EXIT_DONE ? code : EXIT_RUN_FAILED;
    }
    int equal = 0;
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        found[i] = light_judge(i, l.value[i], e[i]);
        equal += found[i] == LIGHT_EQUAL && strncmp(light_names[i], "hash.", 5) == 0;
    }
    show(&l, e, found);
    printf("hashes: %d of %d equal\n", equal, LIGHT_SCENES);
    list_of(found, LIGHT_NONE, names, sizeof names);
    printf("none: %s\n", names[0] != '\0' ? names : "-");
    list_of(found, LIGHT_DIFFERS, names, sizeof names);
    printf("differs: %s\n", names[0] != '\0' ? names : "-");
    if (o->page == NULL && light_is_none(l.value[light_field("period_cycles", "")])) {
        puts("row: not added, because an emulator counts no cycles; --page FILE adds a row anyway");
    } else {
        char *row = light_row(&l, equal, names);
        code = light_append(o->page != NULL ? o->page : LIGHT_PAGE, row, l.crc);
        free(row);
    }
    return code == EXIT_DONE && names[0] != '\0' ? EXIT_RUN_FAILED : code;
}

int command_firstlight(int count, char **words) {
    firstlight_options o = {.wait_s = 60.0, .baud = 115200.0};
    const own_option own[] = {
        {.word = "--board", .text = &o.board},
        {.word = "--emulated", .text = &o.emulated},
        {.word = "--page", .text = &o.page},
        {.word = "--keep", .text = &o.keep},
        OWN_NUMBER("--wait", o.wait_s, 0.1, 86400.0, "a number of seconds: --wait 60"),
        OWN_NUMBER("--baud", o.baud, 1.0, 1e7, "9600 to 230400: --baud 115200"),
        {.word = NULL}};
    const target_reader reader = {.command = "firstlight",
                                  .usage = &firstlight_usage,
                                  .table = own,
                                  .one = "record",
                                  .work = compare};
    return target_command(&reader, count, words, NULL, &o, &o.source);
}
