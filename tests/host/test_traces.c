/* test_traces.c: waveform files of a run (host/io/records.h). The unit of time has its bounds,
 * names with those of random scenes, and times of contacts with closed forms, to one unit of time. Also VCD. */
#include "test.h"

#include <unistd.h>

#include "host/base/alloc.h"
#include "host/io/records.h"
#include "host/io/vcd.h"
#include "host/study/simulate.h"

#include "command.h"
#include "derived.h"

/* === suite traces ============================================================================= */

enum { POWERS = 16, NAME = 60, CHANGES = 4000, SIGNALS = 60 };

static dice die;

/* The unit must give a step a thousand units and the end less than 2^52; a coarser one must not. */
TEST(traces, units) {
    unsigned found[POWERS + 1] = {0};
    for (unsigned c = 0; c < 5000U; c++) {
        const image im = {.step_s = exp(dice_between(&die, -40.0, 5.0)),
                          .until_s = exp(dice_between(&die, -40.0, 43.0))};
        int power = -2;
        const bool is = traces_power(&im, &power);
        TEST_ASSERT_TRUE(power >= 0 && power < POWERS);
        const double per_s = pow(10.0, power);
        TEST_ASSERT_EQUAL(im.step_s * per_s >= 1.0 && im.until_s * per_s < 0x1p52, is);
        TEST_ASSERT_TRUE(im.step_s * per_s >= 1e3 * (1.0 - 1e-12) || power == POWERS - 1 ||
                         10.0 * im.until_s * per_s >= 0x1p52 * (1.0 - 1e-12));
        TEST_ASSERT_TRUE(power == 0 || im.step_s * per_s < 1e4 * (1.0 + 1e-12));
        found[is ? power : POWERS]++;
    }
    for (int k = 0; k <= POWERS; k++) {
        TEST_ASSERT_TRUE(found[k] > 0);
    }
}

typedef struct told_change {
    int64_t time;
    int signal;
    double value;
} told_change;

static struct {
    char *head;
    char name[SIGNALS][NAME];
    int signals;
    told_change change[CHANGES];
    int changes;
    int64_t end;
} dump;

/* With so few signals, each identifier code is a single character. */
static void read_dump(const char *path) {
    char line[400];
    char mark[SIGNALS] = {0};
    size_t length = 0;
    FILE *in = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL(in);
    dump.signals = 0;
    dump.changes = 0;
    dump.end = -1;
    FILE *head = alloc_text(&dump.head, &length);
    while (fgets(line, sizeof line, in) != NULL && strstr(line, "$enddefinitions") == NULL) {
        fputs(line, head);
        if (strncmp(line, "$var ", 5) == 0) {
            char kind[20];
            char width[20];
            char code[20];
            TEST_ASSERT_TRUE(dump.signals < SIGNALS);
            const char *at = said_word(said_word(line + 5, kind, sizeof kind), width, sizeof width);
            at = said_word(said_word(at, code, sizeof code), dump.name[dump.signals], NAME);
            TEST_ASSERT_EQUAL_STRING(" $end\n", at);
            TEST_ASSERT_EQUAL_size_t(1, strlen(code));
            mark[dump.signals++] = code[0];
        }
    }
    alloc_text_end(head);
    while (fgets(line, sizeof line, in) != NULL) {
        if (line[0] == '#') {
            dump.end = strtoll(line + 1, NULL, 10);
            continue;
        }
        const char *code = line + strlen(line) - 2;
        TEST_ASSERT_TRUE(dump.changes < CHANGES);
        told_change *c = &dump.change[dump.changes++];
        c->time = dump.end;
        c->value = strtod(line[0] == 'r' ? line + 1 : (const char[]){line[0], '\0'}, NULL);
        for (c->signal = 0; c->signal < dump.signals && mark[c->signal] != *code; c->signal++) {
        }
        TEST_ASSERT_TRUE(c->signal < dump.signals);
    }
    fclose(in);
}

static int signal_named(const char *name) {
    for (int i = 0; i < dump.signals; i++) {
        if (strcmp(dump.name[i], name) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(name);
    return -1;
}

/* Compares the changes of a signal: values, and times to one unit. */
static void expect_changes(const char *name, const double *time_s, const double *value, int count,
                           double units_per_s) {
    const int signal = signal_named(name);
    int at = 0;
    for (int i = 0; i < dump.changes; i++) {
        if (dump.change[i].signal == signal) {
            TEST_ASSERT_TRUE_MESSAGE(at < count, name);
            TEST_ASSERT_TRUE_MESSAGE(
                fabs((double)dump.change[i].time - time_s[at] * units_per_s) <= 1.0, name);
            TEST_ASSERT_TRUE_MESSAGE(dump.change[i].value == value[at], name);
            at++;
        }
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(count, at, name);
}

static const char *in_head(const char *words) {
    const char *at = strstr(dump.head, words);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, words);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, words), words);
    return at;
}

/* --- four bodies: one falls, one slides, one passes, one is held --- */

static void run_to(const char *path, const image *im, const engine_kind *kind, uint64_t every) {
    const simulation_settings s = {.kind = kind, .every = every, .vcd = path, .quiet = true};
    simulation_trust trust;
    errors_catch();
    const simulation_result result = simulate(im, &s, &trust);
    const char *told = errors_caught();
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIMULATION_DONE, result, told);
}

typedef struct bodies {
    double height_m;
    double restitution;
    double slides_mps;
    double normal_N;
    double passes_mps;
    double holds_m;
    double crosses_m;
    double turns_radps;
    unsigned step_ms;
    uint64_t every;
    bool titled;
    bool inputs;
} bodies;

/* In one third of the cases, the held body is released and the passing body crosses in the first step. In another
 * third the passing body crosses before the first hit, in the same step. */
static bodies draw_bodies(unsigned c) {
    bodies b = {.height_m = dice_between(&die, 0.5, 0.7),
                .restitution = dice_between(&die, 0.5, 0.9),
                .slides_mps = dice_between(&die, 0.3, 0.5),
                .normal_N = dice_between(&die, 1.5, 3.0),
                .passes_mps = dice_between(&die, 1.0, 2.0),
                .holds_m = dice_between(&die, 0.1, 0.4),
                .crosses_m = dice_between(&die, 0.5, 0.9),
                .turns_radps = dice_between(&die, 2.0, 9.0),
                .step_ms = 1 + dice_one_of(&die, 10),
                .every = 1 + dice_one_of(&die, 30),
                .titled = c % 2U == 0,
                .inputs = c % 3U != 0};
    if (c % 3U == 1) {
        b.holds_m = b.passes_mps * dice_between(&die, 1e-4, 4e-4);
        b.crosses_m = b.passes_mps * dice_between(&die, 5e-4, 9e-4);
    }
    while (900 % b.step_ms != 0) {
        b.step_ms--;
    }
    if (c % 3U == 2) {
        const double hit_s = sqrt(2.0 * b.height_m / 10.0);
        const double begin_s = 1e-3 * b.step_ms * floor(1e3 * hit_s / b.step_ms);
        b.crosses_m = b.passes_mps * (begin_s + dice_between(&die, 0.2, 0.8) * (hit_s - begin_s));
        b.holds_m = fmin(b.holds_m, 0.5 * b.crosses_m);
    }
    return b;
}

static derived scene_of_bodies(const bodies *b) {
    char text[1500];
    snprintf(text, sizeof text,
             "mechanism m\ncoordinate x [m] \"falls\"\ncoordinate y [mm] \"slides\"\n"
             "coordinate z [m]\ncoordinate w [rad] \"is held\"\n%s"
             "T = 1 [kg]*(x'^2 + y'^2 + z'^2)/2 + 1 [kg*m^2]*w'^2/2\nV = 10 [N]*x\n"
             "output twice [m] = 2*z \"of z\"\noutput turns [deg] = w\n"
             "stop z <= 90 [m] restitution 0.5\nstop x >= 0 [m] restitution %.9f\n"
             "friction y static 0.5 kinetic 0.5 normal %.9f [N]\n"
             "hold w while z < %.9f [m]\n"
             "when z crosses %.9f [m] rising { set w' = %.9f [rad/s] }\n"
             "scene s%s { start x = %.9f [m], y' = %.9f [m/s], z' = %.9f [m/s]\n"
             "step %u [ms]; until 0.9 [s] }\n",
             b->inputs ? "input u = 3 [kN] \"pulls\"\ninput v = 2\n"
                         "input r rate q = 1 [m]\ninput q = 0.25 [m/s]\n"
                         "input g rate h = 1 [m]\ninput h rate k = 0 [m/s]\ninput k = 1 [m/s^2]\n"
                       : "",
             b->restitution, b->normal_N, b->holds_m, b->crosses_m, b->turns_radps,
             b->titled ? " \"a title\"" : "", b->height_m, b->slides_mps, b->passes_mps,
             b->step_ms);
    derived d = derived_surely(derived_scene(text, "s"), text);
    return d;
}

TEST(traces, moments) {
    for (unsigned c = 0; c < dice_cases(usual_or(12, 8)); c++) {
        const bodies b = draw_bodies(c);
        derived d = scene_of_bodies(&b);
        const engine_kind *kind = c % 4U < 3U ? &engine_double : &engine_float;
        int power = -1;
        TEST_ASSERT_TRUE(traces_power(d.image, &power));
        char unit[60];
        const double units_per_s = pow(10.0, power);
        snprintf(unit, sizeof unit, "$timescale %d%s $end\n",
                 power % 3 == 0   ? 1
                 : power % 3 == 2 ? 10
                                  : 100,
                 (const char *const[]){"s", "ms", "us", "ns"}[(power + 2) / 3]);
        char path[] = "/tmp/whirl-traces-XXXXXX";
        const int file = mkstemp(path);
        TEST_ASSERT_TRUE(file >= 0);
        close(file);
        run_to(path, d.image, kind, b.every);
        read_dump(path);
        (void)remove(path);
        in_head(unit);

        double hits_s[40];
        double ones[40];
        int hits = 0;
        double next_s = sqrt(2.0 * b.height_m / 10.0);
        double speed_mps = 10.0 * next_s;
        for (; next_s < 0.9; hits++) {
            hits_s[hits] = next_s;
            ones[hits] = 1.0;
            speed_mps *= b.restitution;
            next_s += 2.0 * speed_mps / 10.0;
            TEST_ASSERT_TRUE(hits < 39);
        }
        const double rests_s =
            sqrt(2.0 * b.height_m / 10.0) * (1.0 + 2.0 * b.restitution / (1.0 - b.restitution));
        const double sticks_s[] = {0.0, b.slides_mps / (0.5 * b.normal_N)};
        const double holds_s[] = {0.0, b.holds_m / b.passes_mps};
        const double above_s[] = {0.0, b.crosses_m / b.passes_mps};
        static const double rises[] = {0.0, 1.0};
        static const double falls[] = {1.0, 0.0};
        const bool exact = kind == &engine_double; /* in float, x is rounded */
        if (exact && rests_s > 0.95 && fabs(next_s - 0.9) > 1e-3 &&
            (hits == 0 || fabs(hits_s[hits - 1] - 0.9) > 1e-3)) {
            expect_changes("stop2_hit", hits_s, ones, hits, units_per_s);
        }
        if (exact) {
            expect_changes("friction1_sticks", sticks_s, rises, 2, units_per_s);
            expect_changes("hold1_holds", holds_s, falls, 2, units_per_s);
            expect_changes("when1_above", above_s, rises, 2, units_per_s);
            expect_changes("when1_crossed", &above_s[1], &rises[1], 1, units_per_s);
        }
        expect_changes("stop1_rests", sticks_s, rises, 1, units_per_s);
        if (b.inputs) {
            static const double at_start = 0.0;
            expect_changes("u_kN", &at_start, (const double[]){3.0}, 1, units_per_s);
            expect_changes("v", &at_start, (const double[]){2.0}, 1, units_per_s);
            expect_changes("q", &at_start, (const double[]){0.25}, 1, units_per_s);
            in_head(" r $end\n"); /* once: the input with a rate is a column */
            TEST_ASSERT_NULL(strstr(dump.head, " h $end\n")); /* its changes are in der(g) */
            in_head(" k $end\n");
            const int moves = signal_named("r");
            double last = 1.0;
            for (int i = 0; i < dump.changes; i++) {
                last = dump.change[i].signal == moves ? dump.change[i].value : last;
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-6 + 0.25e-3 * b.step_ms * (double)b.every, 1.225, last);
        }
        TEST_ASSERT_TRUE(fabs((double)dump.end - 0.9 * units_per_s) <= 1.0);
        free(dump.head);
        derived_free(&d);
    }
}

SUITE(traces) { die = dice_of("traces", 64); }

/* === suite vcd ================================================================================ */
/* Value change dumps (host/io/vcd.h), read by the test. Random changes of many signals, slightly out of sequence,
 * must appear sorted and once each. Late changes must not be lost, and notes must follow their signals. */

enum { VCD_SIGNALS = 100, VCD_CHANGES = 400, VCD_VALUE = 40, JITTER = 20 };
typedef enum kind_of { WIRE, REAL, EVENT } kind_of;

typedef struct happening {
    int64_t time;
    int signal;
    char value[VCD_VALUE];
} happening;

static happening made[VCD_CHANGES];
static happening read_back[VCD_CHANGES + 1];
static char mark[VCD_SIGNALS][8];

static kind_of kind(int signal) { return (kind_of)(signal % 3); }

static void print_value(happening *h, double value) {
    switch (kind(h->signal)) {
    case WIRE:
        snprintf(h->value, VCD_VALUE, "%s", isnan(value) ? "x" : value != 0.0 ? "1" : "0");
        break;
    case REAL: snprintf(h->value, VCD_VALUE, "r%.4g", value); break;
    case EVENT: snprintf(h->value, VCD_VALUE, "1"); break;
    }
}

/* Reads the identifier codes, such as "!" in "$var wire 1 ! s0 $end". Returns the text after the head. */
static const char *read_head(const char *text) {
    char line[80];
    for (int i = 0; i < VCD_SIGNALS; i++) {
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
    for (int i = 0; i < VCD_SIGNALS; i++) {
        if (strcmp(mark[i], code) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(code);
    return -1;
}

/* Reads the changes, whose times must rise. Returns the number of changes; *end: the last time. */
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
        TEST_ASSERT_TRUE(count <= VCD_CHANGES && now >= 0);
        char *code = line[0] == 'r' ? strchr(line, ' ') : line + 1;
        TEST_ASSERT_NOT_NULL(code);
        h->signal = signal_of(line[0] == 'r' ? code + 1 : code);
        *code = line[0] == 'r' ? '\0' : *code;
        snprintf(h->value, VCD_VALUE, "%.*s", line[0] == 'r' ? VCD_VALUE - 1 : 1, line);
        h->time = now;
    }
    *end = now;
    return count;
}

static int64_t draw_time(dice *d, int64_t now) {
    const int64_t time = now - (int64_t)dice_one_of(d, JITTER);
    return time > 0 ? time : 0;
}

static void add_signals(vcd *v) {
    for (int i = 0; i < VCD_SIGNALS; i++) {
        char name[20];
        const char *note = i % 4 == 0 ? "m" : i % 4 == 1 ? "a note" : i % 4 == 2 ? "" : NULL;
        snprintf(name, sizeof name, "s%d", i);
        static const vcd_kind kinds[] = {[WIRE] = VCD_WIRE, [REAL] = VCD_REAL, [EVENT] = VCD_EVENT};
        const int number = vcd_add(v, kinds[kind(i)], name, note);
        TEST_ASSERT_EQUAL_INT(i, number);
    }
}

/* Sorts the changes as the file must have them: by time, then by arrival. Leaves out values that do not change,
 * except those of events. Returns the number of changes. */
static int sort_made(int count) {
    char last[VCD_SIGNALS][VCD_VALUE];
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
            memcpy(last[h.signal], h.value, VCD_VALUE);
            made[kept++] = h;
        }
    }
    return kept;
}

TEST(vcd, changes_are_in_order) {
    dice d = dice_of("vcd", 51);
    for (unsigned round = 0; round < 20U; round++) {
        char *text = NULL;
        size_t length = 0;
        int64_t now = round % 2U == 0 ? 0 : 1000;
        int64_t end = 0;
        int64_t highest = 0;
        FILE *out = alloc_text(&text, &length);
        vcd *v = vcd_new(out, "made up", 6, "top", 4);
        const int count = round < 4U ? (int)round : VCD_CHANGES;
        add_signals(v);
        for (int i = 0; i < count; i++) {
            happening *h = &made[i];
            const unsigned which = dice_one_of(&d, 5);
            const double value = which == 0   ? 0.0
                                 : which == 1 ? (double)NAN
                                              : dice_between(&d, -1e3, 1e3);
            memset(h, 0, sizeof *h);
            h->time = draw_time(&d, now);
            h->signal = (int)dice_one_of(&d, i % 2 == 0 ? 6 : VCD_SIGNALS);
            print_value(h, kind(h->signal) == REAL && isnan(value) ? 0.5 : value);
            vcd_change(v, h->signal, i % 7 == 0 && h->time == 0 ? -3 : h->time,
                       kind(h->signal) == REAL && isnan(value) ? 0.5 : value);
            highest = h->time > highest ? h->time : highest;
            now += (int64_t)dice_one_of(&d, 4);
            if (dice_one_of(&d, 10) == 0) {
                vcd_settle(v, now - JITTER); /* nothing earlier follows */
                highest = now - JITTER > highest ? now - JITTER : highest;
            }
        }
        vcd_end(v);
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

/* A late change must appear at the last written time. */
TEST(vcd, late_changes_are_written) {
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
        vcd_end(v);
        alloc_text_end(out);
        TEST_ASSERT_EQUAL_INT(1 + late, read_changes(read_head(text), &end));
        TEST_ASSERT_EQUAL_INT64(100, end);
        free(text);
    }
    vcd_end(NULL);
}
